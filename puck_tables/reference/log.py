"""The log of an engine: one puck's motion from a table, in SI units and the axes of the cases."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, instance, real
from puck_tables._core.quantities import TIME
from puck_tables._core.read_columns import list_of
from puck_tables._core.safe_read import beginning, refuse_no_text
from puck_tables._core.text import TextForm, text_form_of
from puck_tables._core.text_rows import LARGEST, read_columns
from puck_tables._core.units import EXAMPLES, parted, unit_size
from puck_tables._core.wording import counted
from puck_tables.errors import InputError
from puck_tables.film.column_roles import headed, name_of
from puck_tables.film.headings import heading
from puck_tables.reference.log_headings import LogHeading, log_heading

_SLOW = 1.0  # s between rows: more, and times are hardly in seconds
_FEWEST = 3  # rows that are compared
_MOST_TIMES = 1 << 26  # bytes of a file of times
_QUATERNION = ("qw", "qx", "qy", "qz")
UP = ("y", "z")
_UNIT = 2e-3  # of lengths: what three digits leave
_TILTED = math.radians(20.0)


@dataclass(frozen=True)
class LogHow:
    """What the user says of a log.

    ``columns``: headings in place of those in the file; ``unit``, ``angle_unit``: of lengths and
    angles (and of velocities and spins, a second) where it says none; ``up``: the axis that points
    up, 'y' or 'z', where it has three; ``puck``: whose columns or rows, ``number``: the same by its
    number from 0; ``launch_time`` s: when the launch stands in it.
    """

    columns: str | None = None
    unit: str | None = None
    angle_unit: str | None = None
    up: str | None = None
    puck: str | None = None
    launch_time: float = 0.0
    number: int | None = None

    def __post_init__(self) -> None:
        for name in ("columns", "unit", "angle_unit", "up", "puck"):
            instance(name, getattr(self, name), str, type(None))
        real("launch_time", self.launch_time, "s")
        if self.up is not None and self.up not in UP:
            raise InputError(f"up must be y or z, the axis that points up, got {self.up!r:.20}")
        for name, kind in (("unit", "length"), ("angle_unit", "angle")):
            value = getattr(self, name)
            if value is not None and unit_size(value, kind) is None:
                known = (
                    "m, dm, cm, mm, um, km, in, ft, yd" if kind == "length" else "rad, deg, turn"
                )
                raise InputError(f"{name} = {value!r:.40} is not known: one of {known}")

    def size(self, kind: str) -> float | None:
        """The unit that it says for a kind, in SI units."""
        whole = {"length": self.unit, "angle": self.angle_unit}
        whole |= {"velocity": self.unit, "spin": self.angle_unit}
        unit = whole.get(kind)
        return (
            None
            if unit is None
            else unit_size(unit, {"velocity": "length", "spin": "angle"}.get(kind, kind))
        )


@dataclass(frozen=True)
class Log:
    """One run: arrays (n,) in s, m, rad, m/s and rad/s, from the launch on; None where it has none.

    ``step`` s: the median distance of its times; ``notes``: how it was read.
    """

    name: str
    time: FloatArray
    x: FloatArray
    y: FloatArray
    angle: FloatArray | None
    vx: FloatArray | None
    vy: FloatArray | None
    spin: FloatArray | None
    step: float
    notes: tuple[str, ...]


def read_log(path: str | Path, how: LogHow) -> Log:
    r"""Read the log of one run.

    Raises InputError if the file cannot be read, its columns, units or axes cannot be told, cells
    are empty, times do not increase, or quaternions are not normalised.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "a.csv")
    ...     _ = file.write_text("t [ms],y [mm],x [mm]\n0,0,0\n10,1,2\n20,1,3\n")
    ...     log = read_log(file, LogHow())
    >>> log.time.tolist(), log.x.tolist(), log.spin is None
    ([0.0, 0.01, 0.02], [0.0, 0.002, 0.003], True)
    """
    instance("path", path, str, Path)
    form, columns, ids = _columns(path, how)
    said = {one.role: n for n, one in columns.items()}
    floor = _floor_axes(path, form, said, how)
    wanted = ["time", *floor.values()]
    where, values = _numbers(
        path, form, columns, how, [said[role] for role in wanted if role in said], ids
    )
    time = values[said["time"]] - how.launch_time
    notes = [f"up is {how.up}"] if how.up else []
    if columns[said["time"]].unit is None:
        if time.size > 1 and np.median(np.diff(time)) > _SLOW:
            raise InputError(
                f"{path} does not say the unit of its times, and rows would be "
                f"{np.median(np.diff(time)):.4g} s apart: say it in the header, or with columns "
                "(--columns)"
            )
        notes.append("times taken as seconds, of which the file says nothing")
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if back.size:
        raise InputError(
            f"{where}: times must increase, but row {back[0] + 2} of its numbers stands at "
            f"{time[back[0] + 1]:.9g} s after {time[back[0]]:.9g} s"
        )
    if time.size < _FEWEST:
        raise InputError(
            f"{where} has {counted(time.size, 'row')} of numbers: at least three are compared"
        )
    signs = {"y": -1.0, "vy": -1.0} if how.up == "y" else {}
    series = {
        name: signs.get(name, 1.0) * values[said[role]]
        for name, role in floor.items() if role in said
    }  # fmt: skip
    angle = series.get("angle")
    if all(role in said for role in _QUATERNION):
        four = np.column_stack([values[said[role]] for role in _QUATERNION])
        angle = turned(where, four, 1 if how.up == "y" else 2)
        notes.append("angles from quaternions")
    return Log(
        Path(path).name, time, series["x"], series["y"], angle, series.get("vx"), series.get("vy"),
        series.get("spin"), float(np.median(np.diff(time))), tuple(notes),
    )  # fmt: skip


def times_in(path: str | Path) -> FloatArray:
    r"""The times (n,) in s of a file: one a line, or the column of times of a table.

    Raises InputError if it cannot be read, or holds no such column.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "a.txt").write_text("0\n0.1\n")
    ...     times_in(Path(folder, "a.txt")).tolist()
    [0.0, 0.1]
    """
    times = list_of(path, TIME, _MOST_TIMES)
    if times is not None:
        return times
    form, columns, _ = _columns(path, LogHow())
    clock = next((n for n, one in columns.items() if one.role == "time"), None)
    if clock is None:
        raise InputError(
            f"{path} holds no times: give one time in s a line, or a table with a column t"
        )
    return _numbers(path, form, columns, LogHow(), [clock], [])[1][clock]


def _columns(path: str | Path, how: LogHow) -> tuple[TextForm, dict[int, LogHeading], list[int]]:
    """How a table is written, what its columns are, and which say whose a row is."""
    if "\0" in str(path):
        raise InputError("the name of a file holds a NUL")
    try:
        head = beginning(path, LARGEST)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
    refuse_no_text(path, head)
    form = text_form_of(path, head)
    names = headed(path, form, how.columns)[-1]
    columns: dict[int, LogHeading] = {}
    for n, name in enumerate(names):
        try:
            one = log_heading(name, how.puck)
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
        if not one.role:
            continue
        if any(other.role == one.role for other in columns.values()):
            raise InputError(
                f"{path} has two columns of {one.role}: name the one that is meant with columns "
                "(--columns), - for the other" + ("" if how.puck else ", or the puck (--puck)")
            )
        columns[n] = one
    ids = [
        n for n, name in enumerate(names)
        if n not in columns and heading(parted(name)[0]).role == "id"
    ]  # fmt: skip
    return form, columns, ids


def _floor_axes(
    path: str | Path, form: TextForm, said: dict[str, int], how: LogHow
) -> dict[str, str]:
    """Which of its columns are x, y, angle, vx, vy and spin on the floor, seen from above."""
    flat = {"x": "x", "y": "y", "angle": "angle", "vx": "vx", "vy": "vy", "spin": "spin"}
    three = [role for role in ("z", "vz") if role in said]
    if three and how.up is None:
        raise InputError(
            f"{path} has a column {three[0]}: say which axis points up, with up (--up z or --up y)"
        )
    if how.up == "y":
        flat |= {"y": "z", "vy": "vz"}
    around = f"w{how.up or 'z'}"
    if around in said and "spin" not in said:
        flat["spin"] = around
    elif "spin" not in said and {"wx", "wy", "wz"} & said.keys():
        raise InputError(
            f"{path} has spins about other axes, and none about {around[1]}, which points up"
        )
    missing = [role for role in ("time", flat["x"], flat["y"]) if role not in said]
    if missing:
        names = ", ".join(name_of(form, n) for n in range(min(form.width, 12)))
        raise InputError(
            f"{path} has no column that is known as {' or '.join(missing)} (its columns are "
            f"{names:.90}): say what they are, such as columns='t [s],x [m],y [m],angle [rad],"
            "vx [m/s],vy [m/s],w [rad/s]' (--columns), - for those to leave out"
        )
    if (flat["vx"] in said) != (flat["vy"] in said):
        raise InputError(f"{path} has one component of the velocity, not both: name both, or none")
    quaternion = [role for role in _QUATERNION if role in said]
    if quaternion and len(quaternion) < 4:
        raise InputError(
            f"{path} has {', '.join(quaternion)} of a quaternion: name all of qw, qx, qy, qz with "
            "columns (--columns)"
        )
    return flat | {role: role for role in quaternion}


def _rows_of_one(
    path: str | Path, ids: list[tuple[str, npt.NDArray[Any], list[str]]], how: LogHow
) -> npt.NDArray[Any] | None:
    """Which rows are of the puck, by columns that say whose a row is; None: they are of one.

    ``ids``: name of the column, of each row the number of its text, texts.  Raises InputError if
    rows are of several pucks, and none is of this one.
    """
    telling = [one for one in ids if len(one[2]) * _FEWEST <= one[1].size]  # more: rows counted
    for mine in (how.puck, None if how.number is None else str(how.number)):
        for _, codes, texts in telling:
            if mine in texts:
                return np.flatnonzero(codes == texts.index(mine))
    for name, _, texts in telling:
        if len(texts) > 1:
            which = "one" if how.puck is None else f"the puck {how.puck}, and say which they are"
            raise InputError(
                f"{path} has rows of several pucks, by its column {name:.40} "
                f"({', '.join(texts):.60}): leave only those of {which}"
            )
    return None


def _numbers(
    path: str | Path, form: TextForm, columns: dict[int, LogHeading], how: LogHow, wanted:
    list[int], ids: list[int],
) -> tuple[str, dict[int, FloatArray]]:  # fmt: skip
    """Whose rows they are, for messages; and columns in SI units, every cell a number."""
    values, texts = read_columns(path, form, wanted, ids)
    rows = _rows_of_one(path, [(name_of(form, n), *texts[n]) for n in ids], how)
    where = str(path) if rows is None else f"{path} ({how.puck})"
    if rows is not None:
        values = {n: column[rows] for n, column in values.items()}
    numbers = {}
    for n in wanted:
        one = columns[n]
        gaps = np.flatnonzero(~np.isfinite(values[n]))
        if gaps.size:
            raise InputError(
                f"{where}: row {gaps[0] + 1} of its numbers has no {one.role}: leave out rows that "
                "are not whole"
            )
        size = one.unit
        if size is None and one.kind and one.kind != "time":
            size = how.size(one.kind)
            if size is None:
                option = (
                    "unit (--unit m)"
                    if one.kind in ("length", "velocity")
                    else "angle_unit (--angle-unit rad)"
                )
                raise InputError(
                    f"{path} does not say the unit of its column {one.role}: write it in the "
                    f"header, such as {one.role} [{EXAMPLES[one.kind]}], or give {option}"
                )
        numbers[n] = values[n] * (1.0 if size is None else size)
    return where, numbers


def turned(where: str, quaternions: FloatArray, up: int) -> FloatArray:
    """How far a body has turned about the vertical since the first row, rad, without leaps.

    Whatever axes the body has, the turn from the first row to another is about the vertical.

    ``where``: the file, for messages; ``quaternions``: ndarray (n, 4), w x y z; ``up``: 1 for y, 2
    for z: the axis that points up.  Raises InputError if one is not normalised, or the tilt has
    changed by over 20 degrees since the first row: then their order, or the axis, is another.

    >>> half = np.array([0.0, 0.4])
    >>> q = np.column_stack([np.cos(half), 0 * half, 0 * half, np.sin(half)])
    >>> turned("a.csv", q, 2).round(9).tolist()
    [0.0, 0.8]
    """
    lengths = np.sqrt((quaternions**2).sum(axis=1))
    off = np.flatnonzero(~(np.abs(lengths - 1.0) <= _UNIT))
    if off.size:
        row = int(off[0])
        raise InputError(
            f"{where}: the quaternion in row {row + 1} of its numbers has the length "
            f"{lengths[row]:.4g}, it must be 1: normalise them, or say with columns (--columns) "
            "which columns are qw, qx, qy, qz"
        )
    unit = quaternions / lengths[:, None]
    w0, v0 = unit[0, 0], unit[0, 1:]
    w, v = unit[:, 0], unit[:, 1:]
    # q times the conjugate of the first
    real = w * w0 + v @ v0
    vector = -w[:, None] * v0 + w0 * v - np.cross(v, v0)
    tilt = 2.0 * np.arccos(np.clip(np.hypot(real, vector[:, up]), 0.0, 1.0))
    if tilt.max() > _TILTED:
        row = int(np.argmax(tilt > _TILTED))
        raise InputError(
            f"{where}: by its quaternions the puck has tilted by {math.degrees(tilt[row]):.0f} "
            f"degrees from row 1 to row {row + 1}, which no case does: their order must be w, "
            "x, y, z, or say it with columns (--columns), or another axis points up (--up)"
        )
    return np.unwrap(2.0 * np.arctan2(vector[:, up], real))
