"""Every quantity of a result by name: its unit, how a picture labels it, and what it is.

One name means one thing in all results, files, pictures and messages.  A column that follows from
others is a line here, and stands in every result that has those; any other is a line here and its
value in the result's ``dataset``.

A result itself is, in its neutral form, named arrays over named axes, with units and attributes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.safe_write import as_utf8
from puck_tables._core.wording import meant


@dataclass(frozen=True)
class Variable:
    """Values over axes.

    ``values``: an array, or a list of texts; ``dims``: the names of its axes; ``unit``: '1' for a
    pure number, '' for a text; ``flags``: what the values 0, 1, … mean, of a code.
    """

    values: Any
    dims: tuple[str, ...]
    unit: str
    long_name: str
    flags: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "flags", tuple(map(as_utf8, self.flags)))
        if isinstance(self.values, list) and self.values and isinstance(self.values[0], str):
            object.__setattr__(self, "values", list(map(as_utf8, self.values)))

    @property
    def attributes(self) -> dict[str, Any]:
        """Its unit, what it is, and what codes mean, as the CF conventions have them."""
        said: dict[str, Any] = {"units": self.unit or "1", "long_name": self.long_name}
        if self.flags:
            said["flag_values"] = np.arange(len(self.flags), dtype=np.int8)
            said["flag_meanings"] = " ".join(flag.replace(" ", "_") for flag in self.flags)
        return said

    def readable(self) -> npt.NDArray[Any]:
        """The values, codes as words."""
        if self.flags:
            words: npt.NDArray[Any] = np.asarray(self.flags)[np.asarray(self.values)]
            return words
        return np.asarray(self.values)


def variable(
    name: str, values: Any, dims: tuple[str, ...], flags: tuple[str, ...] = ()
) -> Variable:
    """A variable with the unit and the words that its name has in the registry of columns.

    >>> variable("stop_time", [1.0], ("launch",)).unit
    's'
    """
    column = COLUMNS[name]
    return Variable(values, dims, column.unit, column.long_name, flags)


@dataclass(frozen=True)
class Dataset:
    """Axes, columns over them, scalars, and texts of any length; all by name.

    The dimensions of the table that a text format writes are those of the first column that has
    most; columns over some of them are repeated, columns with others (the events of a scene) are in
    HDF5 and xarray only.
    """

    axes: Mapping[str, Variable]
    columns: Mapping[str, Variable]
    attributes: Mapping[str, Any] = field(default_factory=dict)
    texts: Mapping[str, tuple[str, str]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        held = {name: as_utf8(one) if isinstance(one, str) else one
                for name, one in self.attributes.items()}  # fmt: skip
        object.__setattr__(self, "attributes", held)
        texts = {name: (as_utf8(text), words) for name, (text, words) in self.texts.items()}
        object.__setattr__(self, "texts", texts)

    def table(self) -> dict[str, Variable]:
        """The columns of a flat table: the axes, repeated as needed, then the rest; one row each.

        >>> launches = variable("launch_spin", np.array([1.0, 2.0]), ("launch_spin",))
        >>> times = variable("stop_time", np.array([3.0, 4.0]), ("launch_spin",))
        >>> Dataset({"launch_spin": launches}, {"stop_time": times}).table()["stop_time"].values
        array([3., 4.])
        """
        main = max(self.columns.values(), key=lambda one: len(one.dims))
        dims, shape = main.dims, np.shape(main.values)
        axes = {name: self.axes[name] for name in dims if name in self.axes}
        whole = {}
        for name, column in {**axes, **self.columns}.items():
            if set(column.dims) <= set(dims):
                sizes = [
                    size if dim in column.dims else 1 for dim, size in zip(dims, shape, strict=True)
                ]
                values = column.readable().reshape(sizes)
                whole[name] = (column, np.broadcast_to(values, shape).ravel())
        return {
            name: Variable(values, ("row",), one.unit, one.long_name)
            for name, (one, values) in whole.items()
        }

    def rows(self) -> tuple[dict[str, Variable], Iterator[tuple[Any, ...]]]:
        """The flat table and its rows as Python numbers and texts."""
        table = self.table()
        columns: Sequence[list[Any]] = [one.values.tolist() for one in table.values()]
        return table, zip(*columns, strict=True)


class Column(NamedTuple):
    """Unit ('1': a pure number, '': a text), short label, and what it is.

    ``of``: the columns that it follows from; ``by``: how.
    """

    unit: str
    label: str
    long_name: str
    of: tuple[str, ...] = ()
    by: Callable[..., Any] | None = None

    @property
    def axis(self) -> str:
        """The label of an axis of a picture."""
        return self.label if self.unit in ("", "1") else f"{self.label} / {self.unit}"


COLUMNS = {
    # states
    "time": Column("s", "time", "time since the launch"),
    "x": Column("m", "x", "place of the centre along x, of a free puck from its launch"),
    "y": Column("m", "y", "place of the centre along y, of a free puck from its launch"),
    "vx": Column("m/s", "velocity x", "velocity of the centre along x"),
    "vy": Column("m/s", "velocity y", "velocity of the centre along y"),
    "speed": Column("m/s", "speed v", "speed of the centre, v", ("vx", "vy"), np.hypot),
    "heading": Column(
        "rad",
        "heading",
        "direction of the velocity from x, counter-clockwise",
        ("vx", "vy"),
        lambda vx, vy: np.arctan2(vy + 0.0, vx + 0.0),
    ),
    "orientation": Column("rad", "orientation", "angle of the body, counter-clockwise"),
    "spin": Column("rad/s", "spin ω", "angular velocity omega, counter-clockwise"),
    "slip_speed": Column("m/s", "Q", "Q = hypot(v, r omega)"),
    "slip_angle": Column("rad", "φ", "phi = atan2(r omega, v), 0 at rest"),
    # pucks and launches
    "radius": Column("m", "radius r", "radius of the base"),
    "height": Column("m", "height h", "height of the puck, twice that of its centre"),
    "friction": Column("1", "friction f", "Coulomb's coefficient"),
    "gravity": Column("m/s^2", "gravity g", "gravity"),
    "decel": Column("m/s^2", "deceleration fg", "f g"),
    "gyration": Column("1", "gyration k/r", "radius of gyration over the radius"),
    "pressure": Column("1", "pressure law", "pressure law"),
    "delta": Column("1", "height δ", "dimensionless height 2 f h / r"),
    "launch_vx": Column("m/s", "launch velocity x", "launch velocity along x"),
    "launch_vy": Column("m/s", "launch velocity y", "launch velocity along y"),
    "launch_speed": Column("m/s", "launch speed v₀", "launch speed"),
    "launch_spin": Column("rad/s", "launch spin ω₀", "launch spin, counter-clockwise"),
    "launch_heading": Column("rad", "launch heading", "direction of the launch velocity from x"),
    "launch_slip_angle": Column("rad", "launch φ", "phi = atan2(r omega, v) at the launch"),
    # stops
    "stop_time": Column("s", "stop time", "time from launch to stop"),
    "stop_x": Column("m", "stop x", "displacement along x at the stop"),
    "stop_y": Column("m", "stop y", "displacement along y at the stop"),
    "stop_distance": Column(
        "m", "stop distance", "distance from launch to stop", ("stop_x", "stop_y"), np.hypot
    ),
    "stop_bearing": Column(
        "rad",
        "bearing of the stop",
        "direction from launch to stop, from x",
        ("stop_x", "stop_y"),
        lambda x, y: np.arctan2(y + 0.0, x + 0.0),
    ),
    "path_length": Column("m", "path length", "length of the path"),
    "turn_angle": Column(
        "rad", "turn of heading", "turn of the heading until Q has fallen to 1/1000"
    ),
    "body_angle": Column("rad", "turn of body", "angle the body has turned"),
    "status": Column("1", "status", "what became of the launch"),
    "target_index": Column("1", "target", "which target, counted from 0"),
    "target_x": Column("m", "target x", "target, x from the launch"),
    "target_y": Column("m", "target y", "target, y from the launch"),
    "miss": Column("m", "miss", "distance from the target at which an integration ends"),
    # scenes
    "work_given": Column("J", "work of forces", "work of gravity and of given forces"),
    "heat_dry": Column(
        "J", "heat of dry friction", "heat of dry friction, of the floor and of a rim on a cushion"
    ),
    "heat_viscous": Column("J", "heat of drag", "heat of drag, 2 f2"),
    "work_support": Column("J", "work of supports", "work of moving floor and constraints, -f1"),
    "lambda_1": Column(
        "N", "reaction 1", "reaction of the constraint: across rail or blade, along x for a pivot"
    ),
    "lambda_2": Column("N", "reaction 2", "reaction of the pivot along y"),
    "carried": Column("1", "carried", "1: at rest on the floor, which then shares the reaction"),
    "heat_impact": Column("J", "energy lost in impacts", "energy lost in impacts"),
    "kinetic_energy": Column("J", "kinetic energy", "of the centre and of the spin"),
    "impacts": Column("1", "impacts", "impacts on walls"),
    "energy_residual": Column(
        "1", "energy residual", "what the energy ledger misses, of its largest entry"
    ),
    "end_time": Column("s", "end time", "when it ends"),
    "end": Column("1", "end", "how it ends"),
    "event": Column("1", "event", "number of the event"),
    "event_time": Column("s", "event time", "when it happens"),
    "event_what": Column("", "event", "what happens: an impact, an edge, a pocket, ..."),
    # several pucks
    "heat_rims": Column("J", "heat of the rims", "heat of rims that push each other"),
    "work_driven": Column("J", "work of driven bodies", "work of bodies driven along paths"),
    "energy_given": Column("J", "energy of launches", "kinetic energy given by launches"),
    "energy_gone": Column("J", "energy gone", "kinetic energy of pucks when they left play"),
    "end_error": Column("m", "error of the end", "what places at the end may be wrong by"),
    "error_estimate": Column("1", "error estimate", "of times in Q/a and of places in Q^2/a"),
    "speed_scale": Column("m/s", "scale of speed", "largest slip Q = hypot(v, r omega)"),
    "rate_scale": Column("m/s^2", "scale of deceleration", "a, of friction, forces and floor"),
    "per_degree": Column("m", "end per degree", "how far the end moves per degree of heading"),
    "per_percent": Column("m", "end per %", "how far the end moves per cent of launch speed"),
    "heading_width": Column("rad", "width of heading", "interval of headings that do"),
    "speed_width": Column("m/s", "width of speed", "interval of launch speeds that do"),
    "spin_width": Column("rad/s", "width of spin", "interval of launch spins that do"),
    "sequence": Column("", "sequence", "impacts that lead the puck to its end"),
    "puck": Column("1", "puck", "number of the puck"),
    "name": Column("", "puck", "name of the puck"),
    "in_play": Column("1", "in play", "1 until it falls into a pocket or over an edge"),
    "event_puck": Column("", "puck", "the puck to which it happens"),
    "event_partner": Column("", "partner", "puck, wall, post, arc, pocket or edge that it meets"),
    "event_x": Column("m", "x", "where it happens, along x"),
    "event_y": Column("m", "y", "where it happens, along y"),
    "event_approach": Column("m/s", "approach", "speed at which the rims come together"),
    "event_slip": Column("m/s", "slip", "speed at which the rims slide on each other"),
    "event_impulse": Column("N s", "impulse", "normal impulse, from the puck to its partner"),
    "event_rub": Column("N s", "rub", "tangential impulse, 90 degrees to the left of the normal"),
    "event_lost": Column("J", "energy lost", "kinetic energy lost in an impact"),
    # a puck found from tracks
    "track": Column("1", "track", "number of the track"),
    "frame": Column("1", "frame", "number of the frame in its track"),
    "seen_x": Column("m", "x", "place seen, along x"),
    "seen_y": Column("m", "y", "place seen, along y"),
    "seen_angle": Column("rad", "angle", "angle of the body seen, up to whole turns"),
    "fit_x": Column("m", "x", "place of the model, along x"),
    "fit_y": Column("m", "y", "place of the model, along y"),
    "fit_angle": Column("rad", "angle", "angle of the body of the model"),
    "counts_place": Column("1", "place counts", "0 for a place left out as an outlier"),
    "counts_angle": Column("1", "angle counts", "0 for an angle left out or not seen"),
    "number_name": Column("", "number", "name of a number of the puck"),
    "number_value": Column("1", "value", "its value, in SI units"),
    "number_error": Column(
        "1", "standard error", "its standard error; inf: not determined, nan: at its bound"
    ),
    "number_low": Column("1", "low", "lower end of its 95 % interval"),
    "number_high": Column("1", "high", "upper end of its 95 % interval"),
    # a limit surface
    "force_x": Column("N", "force along", "force along the slip, of a base along its x"),
    "force_y": Column("N", "force across", "force to the left of the slip, of a base along its y"),
    "torque": Column("N m", "torque", "torque that friction takes up, counter-clockwise"),
    "force": Column("N", "force", "size of the force", ("force_x", "force_y"), np.hypot),
    "normal_x": Column("1", "normal, force x", "outward normal in (F_x, F_y, M/l), part along F_x"),
    "normal_y": Column("1", "normal, force y", "outward normal in (F_x, F_y, M/l), part along F_y"),
    "normal_torque": Column("1", "normal, torque", "part of it along M/l, l = r, of a base k"),
    # a push by a finger or a fence
    "push_x": Column("N", "push x", "force of what pushes along x"),
    "push_y": Column("N", "push y", "force of what pushes along y"),
    "finger_x": Column("m", "finger x", "place of that force along x"),
    "finger_y": Column("m", "finger y", "place of that force along y"),
    "touch": Column("", "contact", "what the finger or the fence does"),
    # a point on a wavy support
    "held_speed": Column("m/s", "speed V", "speed held along the support"),
    "crude": Column("N", "Coulomb's force", "Coulomb's force, load times a/b"),
    "greatest": Column(
        "N", "greatest force", "greatest force in contact, 0 where the point only hops"
    ),
    "undriven": Column("N", "greatest force, not driven", "the same for a point not driven"),
    "mean": Column("N", "mean force", "mean force with all landings"),
    "landing_phase": Column(
        "rad", "landing θ₁", "x/b of the landing before it slides, nan without one"
    ),
    "flights_per_period": Column("1", "flights", "flights in a wavelength"),
    # cases to hold engines against
    "case": Column("", "case", "name and version of the case"),
    "epsilon": Column("1", "ε = v/(rω)", "v/(r omega) of the slip over the floor; nan at rest"),
    "slip_ratio": Column("1", "rω/v = 1/ε", "r omega/v of the slip over the floor; nan at rest"),
    "floor_fx": Column("N", "force on the floor x", "force of the puck on the floor along x"),
    "floor_fy": Column("N", "force on the floor y", "force of the puck on the floor along y"),
    "floor_torque": Column("N m", "torque on the floor", "its torque about the vertical"),
    "time_bound": Column("s", "bound of times", "what times may at most be wrong by"),
    "place_bound": Column(
        "m", "bound of places", "what places, and r times angles, may at most be wrong by"
    ),
    "speed_bound": Column(
        "m/s", "bound of speeds", "what speeds, and r times spins, may at most be wrong by"
    ),
    "force_along": Column("N", "force along", "force on the floor along the slip"),
    "force_across": Column("N", "force across", "force on the floor, to the left of the slip"),
    "share_along": Column("1", "F∥/(fN)", "force along over f N"),
    "share_across": Column("1", "F⊥/(fN)", "force across over f N"),
    "share_torque": Column("1", "M/(fNr)", "torque over f N r"),
    "share_bound": Column("1", "bound", "what these shares may at most be wrong by"),
    "run": Column("1", "run", "number of the run"),
    "file": Column("", "file", "the file of the run"),
    "step": Column("s", "step", "step of the engine"),
    "rest_time": Column("s", "time of rest", "when it is below the threshold of rest"),
    "rest_time_error": Column(
        "s", "error of the stop time", "that less the exact time of the same"
    ),
    "stop_place_error": Column("m", "error of the stop place", "distance from the exact stop"),
    "place_error_max": Column("m", "error of places", "largest error of places on the way"),
    "speed_error_max": Column("m/s", "error of velocities", "largest error of velocities"),
    "spin_error_max": Column("rad/s", "error of spins", "largest error of spins"),
    "angle_error_max": Column("rad", "error of angles", "largest error of angles"),
    "epsilon_seen": Column("1", "ε seen", "v/(r omega) at the threshold of rest"),
    "epsilon_error": Column("1", "error of ε", "that less the exact v/(r omega) of the same"),
    # the measured trade-off
    "contender": Column("", "contender", "question: method (setting)"),
    "question": Column("", "question", "what was asked"),
    "method": Column("", "method", "how it was answered"),
    "setting": Column("", "setting", "with which setting"),
    "outsider": Column("1", "outsider", "1 for what is not this program"),
    "error": Column("1", "error", "the worst: of resultants, or of Q/(f g) and Q^2/(f g)"),
    "median_error": Column("1", "median error", "median error over all starts"),
    "time_error": Column("1", "error of time", "worst error of time"),
    "place_error": Column("1", "error of place", "worst error of place, or of the resultants"),
    "ns": Column("ns", "cost", "median cost of one item on one thread"),
    "ns_spread": Column("ns", "spread of cost", "distance between the quartiles of the cost"),
    "bytes": Column("1", "bytes", "bytes it keeps"),
    "build_s": Column("s", "time to build", "time to make what it keeps"),
}


def derived(columns: Mapping[str, Any]) -> dict[str, Any]:
    """Columns that follow from those given and are not among them.

    >>> {name: float(value) for name, value in derived({"vx": 3.0, "vy": 4.0}).items()}["speed"]
    5.0
    """
    return {
        name: column.by(*(columns[one] for one in column.of))
        for name, column in COLUMNS.items()
        if column.by is not None and name not in columns and set(column.of) <= set(columns)
    }


def following(result: Any, name: str) -> FloatArray:
    """A column as an attribute of a result that has those from which it follows.

    Raises AttributeError if it follows from none.
    """
    column = COLUMNS.get(name)
    try:
        if column is None or column.by is None:
            raise AttributeError
        values: FloatArray = column.by(*(getattr(result, one) for one in column.of))
        return values
    except AttributeError:
        near = meant(name, result.__dict__.get("columns", ()))
        raise AttributeError(f"{type(result).__name__} has no {name}{near}") from None
