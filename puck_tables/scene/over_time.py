"""What a scene gives over time: forces on a puck, how the floor moves, factors on its friction.

All that changes under one puck stands in one table, so that steps end at its rows: the time, force
and torque, the velocity and spin of the floor and how far it has turned since t = 0, the factor on
all friction, and one more for every stretch of the floor, its strips and then its patches.  A scene
of forces has the first four only.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.quantities import (
    FACTOR,
    FORCE_X,
    FORCE_Y,
    SPEED_X,
    SPEED_Y,
    SPIN,
    TIME,
    TORQUE,
    InputColumn,
)
from puck_tables._core.read_columns import numbers_of
from puck_tables.errors import InputError
from puck_tables.kernels.compile import inlined
from puck_tables.scene.floor_parts import count_parts, floor_part
from puck_tables.scene.parts import Floor, Force, Grip, Rows

MAX_DRIVE = 1 << 26  # bytes of a file of forces
_MOST_BYTES = 1 << 20  # of one of factors
FORCED = 4  # columns of forces alone
FLOOR_X, FLOOR_Y, FLOOR_SPIN, FLOOR_ANGLE = 4, 5, 6, 7  # of a floor that moves
ON_ALL, ON_PART = 8, 9  # of factors


def drive_of(path: str | Rows) -> FloatArray:
    """Rows (n, 4) of t, Fx, Fy and torque, given or from a CSV file; they may lack the torque.

    Raises InputError if it cannot be read, or is no such file.
    """
    return _rows_of(path, (TIME, FORCE_X, FORCE_Y, TORQUE), "force.over_time")


def motion_of(floor: Floor) -> FloatArray:
    """Rows (n, 4) of t, velocity and spin of a floor; they may lack the spin.

    Raises InputError if they cannot be read.
    """
    return _rows_of(floor.over_time, (TIME, SPEED_X, SPEED_Y, SPIN), "floor.over_time")


def moves_at(floor: Floor, time: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Velocity and spin (3, n) of a floor at times, s, and how fast they change.

    >>> tray = Floor(over_time=[[0.0, 0.0, 0.0], [2.0, 1.0, 0.0]])
    >>> [one.ravel().tolist() for one in moves_at(tray, np.array([1.0]))]
    [[0.5, 0.0, 0.0], [0.5, 0.0, 0.0]]
    """
    if not floor.over_time:
        steady = np.array([[*floor.velocity, floor.turning]]).T
        return np.repeat(steady, len(time), 1), np.zeros((3, len(time)))
    rows = motion_of(floor)
    times, columns = rows[:, 0], rows[:, 1:].T
    piece = np.searchsorted(times, time, "right")
    rates = np.pad(np.diff(columns) / np.diff(times), ((0, 0), (1, 1)))
    return np.stack([np.interp(time, times, one) for one in columns]), rates[:, piece]


def does_turn(floor: Floor) -> bool:
    """Whether a floor ever turns.

    >>> does_turn(Floor(turning=1.0)), does_turn(Floor(over_time=[[0, 0, 0], [1, 0.5, 0]]))
    (True, False)
    """
    return floor.turning != 0.0 or (bool(floor.over_time) and bool(motion_of(floor)[:, 3].any()))


def _rows_of(path: str | Rows, columns: tuple[InputColumn, ...], name: str) -> FloatArray:
    """Rows (n, 4) that may lack the last column, which is then 0."""
    numbers = numbers_of(path, columns, 3, MAX_DRIVE, name)
    numbers.refuse_unless_ascending("the times")
    rows = numbers.rows
    return np.pad(rows, ((0, 0), (0, 4 - rows.shape[1])))


def factors_of(grip: Grip) -> FloatArray:
    """Rows (n, 2) of t and a factor; a time that stands twice is a jump.

    Raises InputError if they cannot be read, or a factor is below 0.
    """
    numbers = numbers_of(grip.over_time, (TIME, FACTOR), 2, _MOST_BYTES, "over_time")
    numbers.refuse_unless_ascending("the times", equal=True)
    wrong = np.flatnonzero(numbers.rows[:, 1] < 0.0)
    if wrong.size:
        row = int(wrong[0])
        raise InputError(
            f"{numbers.where(row)}: a factor of {numbers.rows[row, 1]:g}: must be >= 0"
        )
    return numbers.rows


def grip_faults(floor: Floor) -> list[str]:
    """What is wrong with the factors on friction over time.

    >>> grip_faults(Floor(grips=[Grip([[0.0, 1.0], [1.0, -1.0]])]))
    ['floor.grip[0]: row 2: a factor of -1: must be >= 0']
    """
    faults, taken = [], set()
    for i, grip in enumerate(floor.grips):
        try:
            if floor_part(floor, grip.where) in taken:
                raise InputError(f"where = {grip.where!r} stands twice: give one table of factors")
            taken.add(floor_part(floor, grip.where))
            factors_of(grip)
        except InputError as error:
            faults.append(f"floor.grip[{i}]: {error}")
    return faults


def largest_factors(floor: Floor) -> FloatArray:
    """By what friction is more, at most, on each stretch of a floor.

    >>> largest_factors(Floor(grips=[Grip([[0.0, 1.0], [1.0, 2.5]])])).tolist()
    [2.5]
    """
    return _on_parts(floor, np.max)


def last_factors(floor: Floor) -> FloatArray:
    """By what friction is more in the end, on each stretch of a floor.

    >>> last_factors(Floor(grips=[Grip([[0.0, 1.0], [1.0, 2.5]])])).tolist()
    [2.5]
    """
    return _on_parts(floor, lambda factors: factors[-1])


def _on_parts(floor: Floor, taken: Callable[[FloatArray], float]) -> FloatArray:
    factors = np.ones(count_parts(floor))
    for grip in floor.grips:
        place = floor_part(floor, grip.where)
        factor = taken(factors_of(grip)[:, 1])
        factors[place if place >= 0 else slice(None)] *= factor
    return factors


def over_time(floor: Floor, force: Force) -> FloatArray:
    """All that changes over time under a puck, in one table.

    Where something jumps a time stands twice.  Before and after its rows there is no force, and the
    floor goes on as it did.

    >>> over_time(Floor(grips=[Grip([[0.0, 1.0], [1.0, 0.5]])]), Force())[:, [0, 8, 9]].tolist()
    [[0.0, 1.0, 1.0], [1.0, 0.5, 1.0]]
    """
    drive = drive_of(force.over_time) if force.over_time else np.empty((0, FORCED))
    if not floor.grips and not floor.over_time:
        return drive
    width = ON_PART + count_parts(floor)
    tables: list[tuple[int, FloatArray]] = []
    if len(drive):
        ends = np.zeros((2, 4))
        ends[:, 0] = drive[[0, -1], 0]
        tables.append((1, np.vstack([ends[:1], drive, ends[1:]])))
    if floor.over_time:
        tables.append((FLOOR_X, motion_of(floor)))
    for grip in floor.grips:
        tables.append((ON_PART + floor_part(floor, grip.where), factors_of(grip)))
    rows: list[FloatArray] = []
    for t in np.unique(np.concatenate([table[:, 0] for _, table in tables])).tolist():
        for after in (False, True):
            row = np.ones(width)
            row[0], row[1:ON_ALL] = t, 0.0
            for column, table in tables:
                row[column : column + table.shape[1] - 1] = _just(table, t, after)
            if not (after and np.array_equal(row, rows[-1])):
                rows.append(row)
    return with_angles(np.array(rows))


def with_angles(rows: FloatArray) -> FloatArray:
    """Rows of all that changes over time, with how far the floor has turned at them, by its spin.

    >>> rows = over_time(Floor(over_time=[[1, 0, 0, 0], [3, 0, 0, 4]]), Force())
    >>> with_angles(rows)[:, FLOOR_ANGLE].tolist()
    [0.0, 4.0]
    """
    if rows.shape[1] > FORCED:
        spin = rows[:, FLOOR_SPIN]
        turned = 0.5 * (spin[1:] + spin[:-1]) * np.diff(rows[:, 0])
        rows[:, FLOOR_ANGLE] = [0.0, *np.cumsum(turned)]
        rows[:, FLOOR_ANGLE] -= turned_at(rows, rows_passed(rows, 0, len(rows), 0.0), 0.0)
    return rows


def _just(table: FloatArray, t: float, after: bool) -> FloatArray:
    """What a table has just before a time, or just after."""
    times = table[:, 0]
    one = int(np.searchsorted(times, t, "right")) - 1 if after else int(np.searchsorted(times, t))
    if 0 <= one < len(table) and times[one] == t:
        return table[one, 1:]
    if after:
        one += 1
    if one in (0, len(table)):
        return table[max(one - 1, 0), 1:]
    share = (t - times[one - 1]) / (times[one] - times[one - 1])
    return (1.0 - share) * table[one - 1, 1:] + share * table[one, 1:]


@inlined
def has_factors(drive: FloatArray) -> bool:
    """Whether friction changes over time."""
    return drive.shape[1] > FORCED and drive.shape[0] > 0


@inlined
def _share(drive: FloatArray, piece: int, t: float) -> float:
    """How much of the way from one row to the next is done; at a jump all."""
    begin, end = drive[piece - 1, 0], drive[piece, 0]
    return (t - begin) / (end - begin) if end > begin else 1.0


@inlined
def prescribed_by(drive: FloatArray, piece: int, t: float) -> tuple[float, float, float]:
    """Force and torque of rows over time alone, of which so many have passed."""
    if piece == 0 or piece == len(drive):
        return 0.0, 0.0, 0.0
    i, j = piece - 1, piece
    share = _share(drive, piece, t)
    return (
        drive[i, 1] + share * (drive[j, 1] - drive[i, 1]),
        drive[i, 2] + share * (drive[j, 2] - drive[i, 2]),
        drive[i, 3] + share * (drive[j, 3] - drive[i, 3]),
    )


@inlined
def rows_passed(forcing: FloatArray, first: int, last: int, t: float) -> int:
    """How many of the rows first … last − 1 have passed."""
    low, high = first, last
    while low < high:
        middle = (low + high) // 2
        if forcing[middle, 0] <= t:
            low = middle + 1
        else:
            high = middle
    return low - first


@inlined
def rate_at(drive: FloatArray, piece: int, column: int) -> float:
    """How fast a column changes on a piece, 1/s."""
    if piece == 0 or piece == len(drive):
        return 0.0
    h = drive[piece, 0] - drive[piece - 1, 0]
    return (drive[piece, column] - drive[piece - 1, column]) / h if h > 0.0 else 0.0


@inlined
def held_at(drive: FloatArray, piece: int, column: int, t: float) -> float:
    """What a column is at a time, on the piece that so many rows precede; held before and after."""
    if piece == 0 or piece == len(drive):
        return drive[max(piece - 1, 0), column]
    one, two = drive[piece - 1, column], drive[piece, column]
    # past the next row, if by a rounding, a factor that ends in 0 would be less than that
    return one + min(_share(drive, piece, t), 1.0) * (two - one)


@inlined
def turned_at(drive: FloatArray, piece: int, t: float) -> float:
    """How far the floor has turned at a time, on the piece that so many rows precede, rad."""
    row = max(piece - 1, 0)
    spin = 0.5 * (drive[row, FLOOR_SPIN] + held_at(drive, piece, FLOOR_SPIN, t))
    return drive[row, FLOOR_ANGLE] + spin * (t - drive[row, 0])
