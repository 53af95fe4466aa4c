"""What a run of a scene gives: states over time, events, and where the energy went."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.wording import meant
from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS, Dataset, Variable, derived, following, variable
from puck_tables.result import TimedResult
from puck_tables.scene.entries import tables_of, units_of
from puck_tables.scene.library import refuse_changed, scene_texts
from puck_tables.scene.pucks_and_posts import called_line
from puck_tables.scene.scene_spec import SceneSpec

ENDS = (
    "at rest", "carried by the floor", "carried round", "time is up", "over the edge",
    "in a pocket", "tipped over", "step limit", "events crowd together",
    "impacts without end", "unsolved", "faster than a law goes",
    "no end found", "refused",
)  # fmt: skip
# their places: those of a run that has ended, up to LAST_END; of one that failed; and of one of
# many, which go on
AT_REST, CARRIED_AWAY, CARRIED_ROUND, TIME_UP, OVER_EDGE, IN_POCKET, TIPPED = range(7)
LAST_END = TIPPED
STEP_LIMIT, EVENT_LIMIT = range(7, 9)
IMPACTS_WITHOUT_END, UNSOLVED, TOO_FAST, NO_END, REFUSED = range(9, 14)
EVENTS = "stick", "slip", "impact", "contact", "entry", "edge", "exit", "overhang", "line", "tip"

STATE = ("x", "y", "orientation", "vx", "vy", "spin")
HEATS = ("heat_dry", "heat_viscous", "heat_rims", "heat_impact")
WORK_NAMES = ("work_given", "work_support", "work_driven")
# numbers of a run as a whole over time; all other columns are of its pucks
SHARED = ("time", "energy_given", "energy_gone", *WORK_NAMES, *HEATS)
SLIPS = ("slip_speed", "slip_angle")  # in the laboratory


class Event(NamedTuple):
    """What happened: when (s), what, to which puck, with what.

    stick (it comes to rest on the floor), slip (it leaves that rest); impact; contact, which lasts;
    entry (its rim comes over a border, a patch or a painted line), exit (it has left it); line (its
    centre passes one); pocket or edge, where it leaves play; tip, where it tips over; overhang,
    where its rim comes over an edge (a base is then carried by what is left of it, or as if nothing
    of it hung in the air, as the report says); launch; of a world into which a hand reaches placed,
    removed, added, force.

    ``partner``: the puck, wall, post, arc, pocket, edge, border, patch or line that it meets, such
    as 'wall 0'; of tip, stick and slip the floor, or the strip under its centre.  ``x``, ``y`` m:
    where; ``approach``, ``slip`` m/s: how fast the rims came together and slid on each other before
    the first impact of this moment, or a line was passed; ``impulse``, ``rub`` N s: along the line
    from the puck to its partner and 90° to the left of it; ``lost`` J: kinetic energy lost.  Of
    several impacts at one moment impulses and losses are right in sum only.
    """

    time: float
    what: str
    puck: str
    partner: str
    x: float
    y: float
    approach: float = 0.0
    slip: float = 0.0
    impulse: float = 0.0
    rub: float = 0.0
    lost: float = 0.0


@dataclass(frozen=True, eq=False, repr=False)
class Run(TimedResult):
    """What happened in a scene.

    ``end``: 'at rest', 'carried by the floor' (at rest on a moving one), 'carried round' (at rest
    on one that turns, over the same borders again and again: a whole turn is followed), 'time is
    up', 'over the edge', 'in a pocket' or 'tipped over'; ``end_time`` s; ``names``: of the pucks;
    ``events``: see :class:`puck_tables.scene.run.Event`; ``model``, ``why``: how it was run, and
    why so.

    ``columns``: over time by name, each also an attribute (``run.x``); of a scene of one puck
    arrays (n,), of one with a list of pucks (n, pucks), where energies but kinetic ones are of all
    together, (n,).  A puck's are found by its name or number (``run["striker"]``).  ``last``: the
    same at the end.  One that has left play stays where it left, its ``in_play`` is 0.
    ``stop_times`` (pucks,) s: when each came to rest or left play; inf where it still moves.
    Work of slope and forces, of what moves under or leads the pucks, and of driven bodies; heat of
    dry friction, drag, rims that push each other, and impacts; energies given by launches and gone
    with who left play, J.  ``heading``, ``slip_speed`` and ``slip_angle`` are of the motion in the
    laboratory, 0 at rest there.

    ``energy_residual``: what this ledger misses, as a share of its largest entry.
    ``error_estimate``: of times in units of Q/a and of places in Q²/a, with ``speed_scale`` = Q in
    m/s and ``rate_scale`` = a in m/s² (the largest slip hypot(v, rω), and the largest of friction,
    forces and what a turning floor asks over the mass; without slip Q² = a r), from check runs with
    other steps or, among several pucks, other launches: those that differ by 1e-9.  It is above
    ``tol`` where the motion amplifies errors so much that tol cannot be kept; each impact of round
    pucks does: after many the launch decides the end by digits that it does not have.
    ``files``: what stood in the files that the scene names, by the path of the entry.  Called with
    times it gives the same run with its states there.
    """

    scene: SceneSpec
    model: str
    why: str
    end: str
    end_time: float
    names: tuple[str, ...]
    events: list[Event]
    stop_times: FloatArray = field(repr=False)
    energy_residual: float
    error_estimate: float
    speed_scale: float
    rate_scale: float
    steps: int
    last: Mapping[str, Any]
    columns: Mapping[str, FloatArray] = field(repr=False)
    simulated: Callable[[SceneSpec, npt.ArrayLike], Run] = field(repr=False)
    files: Mapping[str, str] = field(default_factory=dict, repr=False)

    picture: ClassVar[str] = "run"

    def __call__(self, times: npt.ArrayLike) -> Run:
        """The run with its states at other times, s, ascending, else InputError.

        Times after its end are left out, unless all rests there.  InputError, too, if a file that
        the scene names has changed since the run.
        """
        refuse_changed(self.scene, self.files)
        return self.simulated(self.scene, times)

    def __repr__(self) -> str:
        title = f"{self.scene.title}: " if self.scene.title else ""
        count = len(self.events)
        several = f"{len(self.names)} pucks, " if self.scene.pucks else ""
        where = ""
        if not self.scene.pucks:
            where = f" at ({self.last['x']:.6g}, {self.last['y']:.6g}) m"
        return (
            f"Run({title}{several}{self.end} after {self.end_time:.6g} s{where}, "
            f"{count} event{'s' if count != 1 else ''})"
        )

    def __getattr__(self, name: str) -> FloatArray:
        """A column by its name."""
        if name in SLIPS:
            return self._derived()[name]
        return column_of(self, name)

    def __getitem__(self, puck: int | str) -> dict[str, FloatArray]:
        """The columns of one puck, by its name or number, arrays (n,); InputError without it."""
        if isinstance(puck, str) and puck in COLUMNS and puck not in self.names:
            raise InputError(f"[{puck!r}] takes a puck: the column of all of them is .{puck}")
        number = number_of(puck, self.names)
        whole = {**self.columns, **self._derived()}
        return {name: row if row.ndim == 1 else row[:, number] for name, row in whole.items()}

    def last_of(self, puck: int | str) -> dict[str, float]:
        """The columns of one puck at the end, numbers.

        Raises
        ------
        InputError
            If there is no such puck.
        """
        number = number_of(puck, self.names)
        rows = {name: np.atleast_1d(row) for name, row in self.last.items()}
        return {
            name: float(row[0 if row.size == 1 else number]) for name, row in rows.items()
        }  # fmt: skip

    @property
    def main_events(self) -> list[Event]:
        """Its events, but for rims that come over painted lines or leave them."""
        lines = self.scene.lines
        names = {called_line(lines, number) for number in range(len(lines))}
        rims = ("entry", "exit")
        return [one for one in self.events if one.what not in rims or one.partner not in names]

    @property
    def impacts(self) -> int:
        """How many impacts there were."""
        return sum(event.what == "impact" for event in self.events)

    @property
    def end_error(self) -> float:
        """What places at the end may be wrong by, m."""
        length = self.speed_scale**2 / self.rate_scale if self.rate_scale > 0.0 else 0.0
        return self.error_estimate * length

    def _derived(self) -> dict[str, FloatArray]:
        columns = derived(self.columns)
        pucks = self.scene.pucks
        radius: Any = np.array([p.radius for p in pucks]) if pucks else self.scene.puck.radius
        rim = radius * self.columns["spin"]
        slips = np.hypot(columns["speed"], rim), np.arctan2(rim, columns["speed"])
        return {**columns, **dict(zip(SLIPS, slips, strict=True))}

    def explain(self) -> str:
        """The model that was taken, and why."""
        return self.why

    def summary(self) -> dict[str, Any]:
        """The scalars with what went in, and the units of all, ready for JSON.

        >>> from puck_tables import Launch, Puck, Scene
        >>> scene = Scene(Puck(0.04, friction=0.1), launch=Launch((1.0, 0.0)))
        >>> told = scene.simulate().summary()
        >>> told["end"], told["scene"]["launch"]["velocity"], told["units"]["scene.launch.velocity"]
        ('at rest', [1.0, 0.0], 'm/s')
        """
        own = [name for name in self.last if name not in SHARED]
        scalars = ("energy_residual", "error_estimate", "speed_scale", "rate_scale", "end_error")
        pucks = [
            {
                "name": name,
                **{key: self.last_of(number)[key] for key in own},
                "stop_time": stop if math.isfinite(stop) else None,
            }
            for number, (name, stop) in enumerate(
                zip(self.names, self.stop_times.tolist(), strict=True)
            )
        ]
        several = bool(self.scene.pucks)
        names = [*own, "stop_time"]
        return {
            "title": self.scene.title,
            "end": self.end,
            "end_time": self.end_time,
            **({"pucks": pucks} if several else {n: pucks[0][n] for n in names}),
            **{name: float(self.last[name]) for name in self.last if name in SHARED[1:]},
            "events": [event._asdict() for event in self.events],
            **{name: getattr(self, name) for name in scalars},
            "steps": self.steps,
            "model": self.model,
            "scene": tables_of(self.scene),
            "units": {
                **{name: COLUMNS[name].unit for name in ("end_time", *SHARED[1:], *scalars)},
                **{f"pucks.{n}" if several else n: COLUMNS[n].unit for n in names},
                **{f"events.{name}": COLUMNS[f"event_{name}"].unit for name in Event._fields},
                **{f"scene.{path}": unit for path, unit in units_of(self.scene).items()},
            },
        }

    def dataset(self) -> Dataset:
        """States over time (and pucks), and events; scalars as attributes; scene and files."""
        several = bool(self.scene.pucks)
        columns: dict[str, Variable] = {}
        axes = {"time": variable("time", self.columns["time"], ("time",))}
        if several:
            axes["puck"] = variable("puck", np.arange(len(self.names)), ("puck",))
            columns["name"] = variable("name", list(self.names), ("puck",))
            columns["stop_time"] = variable("stop_time", self.stop_times, ("puck",))
        for name, row in {**self.columns, **self._derived()}.items():
            if name != "time":
                columns[name] = variable(name, row, ("time", "puck")[: row.ndim])
        if self.events:
            axes["event"] = variable("event", np.arange(len(self.events)), ("event",))
            for name in Event._fields:
                values: Any = [getattr(event, name) for event in self.events]
                words = name in ("what", "puck", "partner")
                values = values if words else np.array(values)
                columns[f"event_{name}"] = variable(f"event_{name}", values, ("event",))
        left_out = (*columns, "pucks", "events", "scene", "units", "title")
        scalars = {
            name: value for name, value in self.summary().items()
            if name not in left_out and value is not None
        }  # fmt: skip
        attributes = {"title": self.scene.title or "Scene", **scalars}
        return Dataset(axes, columns, attributes, scene_texts(self.scene, self.files))


def ledger(columns: Mapping[str, Any]) -> tuple[FloatArray, FloatArray]:
    """What is missing in the energy ledger, and its largest entry, J, for every element.

    What is not there is 0.

    >>> found = {"energy_given": np.full(1, 4.0), "heat_dry": np.full(1, 2.0)}
    >>> ledger(found | {"kinetic_energy": np.ones(1)})
    (array([1.]), array([4.]))
    """
    energy = np.asarray(columns["kinetic_energy"])
    work = np.asarray(columns["energy_given"])
    left = energy.sum(axis=-1) if energy.ndim > work.ndim else energy  # of several pucks
    gains = [work, *(columns.get(name, 0.0) for name in WORK_NAMES)]
    losses = [left, *(columns.get(name, 0.0) for name in ("energy_gone", *HEATS))]
    missing = np.abs(sum(gains) - sum(losses))
    return missing, np.max(np.abs(np.broadcast_arrays(*gains, *losses)), axis=0)


def residual(columns: Mapping[str, Any], least: float = 0.0) -> float:
    """What the energy ledger misses at most, as a share of its largest entry, or of ``least`` J.

    >>> moment = dict.fromkeys((*SHARED, "kinetic_energy"), np.zeros(1))
    >>> residual(moment | {"energy_given": np.ones(1), "heat_dry": np.array([0.5])})
    0.5
    """
    missing, largest = (float(one.max()) for one in ledger(columns))
    return missing / max(largest, least) if largest > 0.0 else 0.0


def number_of(puck: int | str, names: Sequence[str]) -> int:
    """The number of a puck, from its name or number.

    Raises InputError if there is no such puck.

    >>> number_of("man", ("striker", "man")), number_of(0, ("striker", "man"))
    (1, 0)
    """
    if isinstance(puck, str) and puck in names:
        return list(names).index(puck)
    if isinstance(puck, int | np.integer) and 0 <= puck < len(names) and puck is not True:
        return int(puck)
    shown = ", ".join(names[:8]) + (", ..." if len(names) > 8 else "")
    raise InputError(f"no puck {puck!r}{meant(puck, names)}: there are {len(names)}, {shown}")


def column_of(result: Any, name: str) -> FloatArray:
    """A column as an attribute of a result of a scene.

    Raises AttributeError.
    """
    columns: Mapping[str, FloatArray] = result.__dict__.get("columns", {})
    return columns[name] if name in columns else following(result, name)
