"""The only door to outputs: HDF5 that xarray opens, CSV, JSON lines; whole or not at all."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._version import __version__
from puck_tables.aiming import Aim
from puck_tables.chetaev.asperity_curve import AsperityCurve
from puck_tables.errors import InputError
from puck_tables.front import Way, front_as_csv
from puck_tables.safe_write import write_bytes
from puck_tables.solvers import STATUS_MEANINGS
from puck_tables.stop_map import StopMap
from puck_tables.tradeoff.engine import TradeOff
from puck_tables.trajectory import Trajectory

FloatArray = npt.NDArray[np.float64]

TRAJECTORY_COLUMNS = {
    "time": ("s", "time since the launch"),
    "x": ("m", "displacement of the centre along x"),
    "y": ("m", "displacement of the centre along y"),
    "heading": ("rad", "direction of the velocity from x, counter-clockwise"),
    "orientation": ("rad", "angle the body has turned, counter-clockwise"),
    "speed": ("m/s", "speed of the centre, v"),
    "spin": ("rad/s", "angular velocity omega, counter-clockwise"),
    "slip_speed": ("m/s", "Q = hypot(v, r omega)"),
    "slip_angle": ("rad", "phi = atan2(r omega, v), 0 at rest"),
}
MAP_COLUMNS = {
    "stop_time": ("s", "time from launch to stop"),
    "stop_x": ("m", "displacement along x at the stop"),
    "stop_y": ("m", "displacement along y at the stop"),
    "path_length": ("m", "length of the path"),
    "turn_angle": ("rad", "turn of the heading until Q has fallen to 1/1000"),
    "body_angle": ("rad", "angle the body has turned"),
    "status": ("1", "0 stopped, 1 step limit, 2 overflow"),
}
MAP_AXES = {
    "delta": ("1", "dimensionless height 2 f h / r"),
    "speed": ("m/s", "launch speed along x"),
    "w0": ("rad/s", "launch spin, counter-clockwise"),
}
SUMMARY = (
    "regime", "stop_time", "stop_position", "path_length", "turn_angle", "turn_rate", "body_angle",
    "limit_angle", "loaded_share", "least_loaded_share", "contact_opens", "contact_closes",
    "kinetic_energy", "energy_residual", "method", "steps", "error_estimate",
    "v0", "w0", "radius", "delta", "decel", "mass", "pressure", "gyration",
)  # fmt: skip


def summary(run: Trajectory) -> dict[str, Any]:
    """The scalars of a trajectory, ready for JSON.

    Examples
    --------
    >>> from puck_tables import simulate
    >>> summary(simulate((1.0, 0.0), 0.0))["stop_position"]
    [0.5, 0.0]
    """
    values = {name: getattr(run, name) for name in SUMMARY}
    return {n: list(v) if isinstance(v, tuple) else v for n, v in values.items()}


def kind_of(path: str | Path, allowed: tuple[str, ...]) -> str:
    """The format that a file name asks for.

    Raises
    ------
    InputError
        If the ending is none of those allowed.

    Examples
    --------
    >>> kind_of("run.csv", (".h5", ".csv"))
    '.csv'
    """
    ending = Path(path).suffix.lower()
    if ending not in allowed:
        raise InputError(
            f"{path}: the ending of an output file chooses its format: one of {', '.join(allowed)}"
        )
    return ending


TRAJECTORY_KINDS = (".h5", ".csv", ".jsonl")
MAP_KINDS = (".h5", ".csv")
AIM_KINDS = (".csv",)


def save_trajectory(run: Trajectory, path: str | Path, overwrite: bool = False) -> None:
    """Write the states of a trajectory as HDF5, CSV or JSON lines, by the ending of the name.

    HDF5: dimension ``time``, a dataset a column with units, the scalars as attributes.
    CSV: a header line ``name[unit]``.  JSON lines: one object a state.

    Raises
    ------
    InputError
        If the ending is not .h5, .csv or .jsonl.
    OutputError
        If the file exists (without ``overwrite``) or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from puck_tables import simulate
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_trajectory(simulate((1.0, 0.0), 0.0, frames=2), folder + "/run.csv")
    ...     print(Path(folder, "run.csv").read_text().splitlines()[2][:11])
    1.0,0.5,0.0
    """
    kind = kind_of(path, TRAJECTORY_KINDS)
    columns = {name: getattr(run, name) for name in TRAJECTORY_COLUMNS}
    if kind == ".h5":
        scalars = {
            n: np.asarray(v) if isinstance(v, list) else v
            for n, v in summary(run).items()
            if v is not None  # contact that never opens or closes
        }
        content = as_hdf5(
            {"time": columns.pop("time")}, columns, TRAJECTORY_COLUMNS,
            {"title": "Trajectory of a sliding, spinning puck", **scalars},
        )  # fmt: skip
    elif kind == ".csv":
        rows = zip(*(column.tolist() for column in columns.values()), strict=True)
        content = as_csv(TRAJECTORY_COLUMNS, rows)
    else:
        rows = zip(*(column.tolist() for column in columns.values()), strict=True)
        lines = (json.dumps(dict(zip(columns, row, strict=True)), allow_nan=False) for row in rows)
        content = "".join(line + "\n" for line in lines).encode()
    write_bytes(path, content, overwrite)


def save_map(stops: StopMap, path: str | Path, overwrite: bool = False) -> None:
    """Write a map as labelled HDF5, or as CSV with one row a launch, by the ending of the name.

    Raises
    ------
    InputError
        If the ending is neither .h5 nor .csv.
    OutputError
        If the file exists (without ``overwrite``) or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from puck_tables import sweep
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_map(sweep([0.0, 1.0], 1.0), folder + "/map.csv")
    ...     print(Path(folder, "map.csv").read_text().splitlines()[0][:24])
    w0[rad/s],stop_time[s],s
    """
    if kind_of(path, MAP_KINDS) == ".csv":
        content = map_as_csv(stops).encode()
    else:
        attributes = {
            "title": "Stops of sliding, spinning pucks", **stops.fixed,
            "tol": stops.tol, "method": stops.method, "table": stops.table,
        }  # fmt: skip
        columns = {name: getattr(stops, name) for name in MAP_COLUMNS}
        content = as_hdf5(
            stops.axes, columns, {**MAP_AXES, **MAP_COLUMNS}, attributes,
            flags={"status": STATUS_MEANINGS},
        )  # fmt: skip
    write_bytes(path, content, overwrite)


def map_as_csv(stops: StopMap) -> str:
    """A map as CSV text: ranged quantities, then results; one row a launch.

    Examples
    --------
    >>> from puck_tables import sweep
    >>> len(map_as_csv(sweep([0.0, 1.0], 1.0)).splitlines())
    3
    """
    grids = np.meshgrid(*stops.axes.values(), indexing="ij") if stops.axes else []
    columns = [grid.ravel().tolist() for grid in grids]
    columns += [np.ravel(getattr(stops, name)).tolist() for name in MAP_COLUMNS]
    names = {name: MAP_AXES[name] for name in stops.axes}
    return as_csv({**names, **MAP_COLUMNS}, zip(*columns, strict=True)).decode()


AIM_COLUMNS = {
    "w0": ("rad/s", "launch spin, counter-clockwise"),
    "v0_x": ("m/s", "launch velocity along x"),
    "v0_y": ("m/s", "launch velocity along y"),
    "speed": ("m/s", "launch speed"),
    "direction": ("rad", "direction of the launch velocity from x, counter-clockwise"),
    "slip_angle": ("rad", "phi = atan2(r omega, v) at the launch"),
    "stop_time": ("s", "time from launch to stop"),
    "miss": ("m", "distance from the target at which an integration ends"),
}


def aim_columns(found: Aim) -> dict[str, FloatArray]:
    """The launches of an aim by column.

    Examples
    --------
    >>> from puck_tables import aim
    >>> aim_columns(aim((2.0, 0.0), w0=0.0))["speed"].round(6).tolist()
    [2.0]
    """
    columns: dict[str, Any] = {name: getattr(found, name, None) for name in AIM_COLUMNS}
    return {**columns, "v0_x": found.v0[:, 0], "v0_y": found.v0[:, 1]}


def save_aim(found: Aim, path: str | Path, overwrite: bool = False) -> None:
    """Write the launches of an aim to a CSV file.

    Raises
    ------
    InputError
        If the ending is not .csv.
    OutputError
        If the file exists (without ``overwrite``) or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from puck_tables import aim
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_aim(aim((2.0, 0.0), w0=0.0), folder + "/aim.csv")
    ...     print(Path(folder, "aim.csv").read_text().splitlines()[1][:8])
    0.0,2.0,
    """
    kind_of(path, AIM_KINDS)
    rows = zip(*(column.tolist() for column in aim_columns(found).values()), strict=True)
    write_bytes(path, as_csv(AIM_COLUMNS, rows), overwrite)


ASPERITY_COLUMNS = {
    "speed": ("m/s", "speed held along the support"),
    "crude": ("N", "Coulomb's force, load times a/b"),
    "greatest": ("N", "greatest force in contact, 0 where the point only hops"),
    "undriven": ("N", "the same for a point that is not driven"),
    "mean": ("N", "mean force with all landings"),
    "landing_phase": ("rad", "x/b of the landing before it slides, nan without one"),
    "flights_per_period": ("1", "flights in a wavelength"),
}


def save_asperity(curve: AsperityCurve, path: str | Path, overwrite: bool = False) -> None:
    """Write force against speed as labelled HDF5 or as CSV, by the ending of the name.

    Raises
    ------
    InputError
        If the ending is neither .h5 nor .csv.
    OutputError
        If the file exists (without ``overwrite``) or cannot be written.

    Examples
    --------
    >>> save_asperity(None, "curve.txt")
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: curve.txt: the ending of an output file chooses its format: one \
of .h5, .csv
    """
    if kind_of(path, MAP_KINDS) == ".csv":
        content = asperity_as_csv(curve).encode()
    else:
        columns = {name: getattr(curve, name) for name in ASPERITY_COLUMNS}
        support = curve.asperity
        content = as_hdf5({"speed": columns.pop("speed")}, columns, ASPERITY_COLUMNS, {
            "title": "Friction of a point on a wavy one-sided support", "load": support.load,
            "amplitude": support.amplitude, "length": support.length, "mass": support.mass,
            "lift_speed": support.lift_speed,
        })  # fmt: skip
    write_bytes(path, content, overwrite)


def asperity_as_csv(curve: AsperityCurve) -> str:
    """Force against speed as CSV text.

    Examples
    --------
    >>> from puck_tables import Asperity, asperity_curve
    >>> text = asperity_as_csv(asperity_curve(Asperity(1.0, 4.0, 1.0, 1.0), [0.0, 1.0]))
    >>> text.splitlines()[1]
    '0.0,0.25,0.25,0.23529411764705882,0.0,nan,0.0'
    """
    columns = [getattr(curve, name).tolist() for name in ASPERITY_COLUMNS]
    return as_csv(ASPERITY_COLUMNS, zip(*columns, strict=True)).decode()


WAY_COLUMNS = {
    "question": ("", "what was asked"),
    "method": ("", "how it was answered"),
    "setting": ("", "with which setting"),
    "outsider": ("1", "1 for what is not this program"),
    "error": ("1", "worst error: of resultants, or in units of Q/J and Q^2/J"),
    "median_error": ("1", "median error over all starts"),
    "time_error": ("1", "worst error of time"),
    "place_error": ("1", "worst error of place, or of the resultants"),
    "ns": ("ns", "median cost of one item on one thread"),
    "ns_spread": ("ns", "distance between the quartiles of the cost"),
    "bytes": ("1", "bytes it keeps"),
    "build_s": ("s", "time to make what it keeps"),
    "limit_ns": ("ns", "time the machine's peak would allow; 0: not counted"),
    "limit": ("", "which peak that is"),
}
GROWTH_COLUMNS = {
    "stop_ns": ("ns", "cost of one stop by look-up, in chunks"),
    "peak_bytes": ("1", "peak memory"),
}


def save_trade_off(measured: TradeOff, path: str | Path, overwrite: bool = False) -> None:
    """Write a measured trade-off as labelled HDF5, or its ways as CSV, by the ending of the name.

    Raises
    ------
    InputError
        If the ending is neither .h5 nor .csv.
    OutputError
        If the file exists (without ``overwrite``) or cannot be written.

    Examples
    --------
    >>> save_trade_off(None, "ways.txt")
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: ways.txt: the ending of an output file chooses its format: one \
of .h5, .csv
    """
    if kind_of(path, MAP_KINDS) == ".csv":
        content = front_as_csv(measured.ways).encode()
    else:
        content = as_hdf5(
            {"way": [f"{way.question}: {way.name}" for way in measured.ways],
             "stops": measured.stops},
            {name: _column(measured.ways, name) for name in WAY_COLUMNS}
            | {name: getattr(measured, name) for name in GROWTH_COLUMNS},
            {"way": ("", "question: method (setting)"), "stops": ("1", "stops in one sweep"),
             **WAY_COLUMNS, **GROWTH_COLUMNS},
            {"title": "Accuracy against cost of ways to friction resultants, stops and states",
             "repeats": measured.repeats, "seconds": measured.seconds,
             "peak_flops": measured.machine.flops, "peak_bandwidth": measured.machine.bandwidth,
             **{f"machine_{k}": v for k, v in measured.machine.description.items()},
             **{f"limit_ratio_{k}": v for k, v in measured.limit_ratios.items()}},
            {**dict.fromkeys(WAY_COLUMNS, ("way",)), **dict.fromkeys(GROWTH_COLUMNS, ("stops",))},
        )  # fmt: skip
    write_bytes(path, content, overwrite)


def _column(ways: tuple[Way, ...], name: str) -> Any:
    values = [getattr(way, name) for way in ways]
    return values if isinstance(values[0], str) else np.asarray(values)


def as_csv(names: dict[str, tuple[str, str]], rows: Iterator[tuple[Any, ...]]) -> bytes:
    """Rows as CSV with a header line ``name[unit]``.

    Examples
    --------
    >>> as_csv({"x": ("m", "place")}, iter([(1.5,)])).split()
    [b'x[m]', b'1.5']
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([f"{name}[{unit}]" for name, (unit, _) in names.items()])
    writer.writerows(rows)
    return text.getvalue().encode()


def as_hdf5(
    axes: dict[str, Any],
    columns: dict[str, Any],
    names: dict[str, tuple[str, str]],
    attributes: dict[str, Any],
    dimensions: dict[str, tuple[str, ...]] | None = None,
    flags: dict[str, tuple[str, ...]] | None = None,
    texts: dict[str, str] | None = None,
) -> bytes:
    """A labelled HDF5 file; every column has all axes, or those that ``dimensions`` says.

    ``flags``: what the values 0, 1, … of a column mean; ``texts``: texts of any length by name.

    Examples
    --------
    >>> units = {"t": ("s", "time"), "x": ("m", "place")}
    >>> as_hdf5({"t": [0.0, 1.0]}, {"x": [2.0, 3.0]}, units, {"title": "a line"})[1:4]
    b'HDF'
    """
    import h5py

    buffer = io.BytesIO()
    with h5py.File(buffer, "w") as file:
        for name, values in axes.items():
            axis = file.create_dataset(name, data=values)
            axis.make_scale(name)
        for name, values in columns.items():
            data = file.create_dataset(name, data=values)
            for position, axis_name in enumerate(dimensions[name] if dimensions else axes):
                data.dims[position].attach_scale(file[axis_name])
        for name in (*axes, *columns):
            unit, text = names[name]
            file[name].attrs.update(units=unit, long_name=text)
        for name, meanings in (flags or {}).items():
            file[name].attrs["flag_values"] = np.arange(len(meanings), dtype=np.int8)
            words = (meaning.replace(" ", "_") for meaning in meanings)
            file[name].attrs["flag_meanings"] = " ".join(words)
        for name, text in (texts or {}).items():  # an attribute holds no more than 64 kB
            file.create_dataset(name, data=text, dtype=h5py.string_dtype())
            file[name].attrs["long_name"] = names[name][1]
        file.attrs.update({
            "Conventions": "CF-1.11", "source": f"puck-tables {__version__}",
            "created": datetime.now(UTC).isoformat(timespec="seconds"), **attributes,
        })  # fmt: skip
    return buffer.getvalue()
