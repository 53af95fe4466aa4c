"""Launches as a caller gave them: looked at, not copied, and read block by block."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast, finite_array, real_view, velocity_array
from puck_tables._core.executor import run_chunks, usable_cores
from puck_tables._core.fields import Unsaid
from puck_tables.contact.closed_form import checked_delta
from puck_tables.errors import InputError
from puck_tables.kernels.compile import BLOCK, inlined, into_row, kernel, patience

COLUMNS = 6  # numbers of a launch
VX, VY, SPIN, DELTA, DECEL, RADIUS = range(COLUMNS)  # rows of a block of launches
CHUNK = 1 << 15  # launches that a thread takes at a time
COPIED = 1 << 14  # launches up to which a copy costs nothing that counts
_UNITS = {"spin": "rad/s", "delta": "units of 2 f h / r", "decel": "m/s^2", "radius": "m"}

TOO_LARGE = (
    "velocity, spin, radius and decel give a motion too large for floating point: use larger units"
)
_NUMBERS = frozenset((float, int, Unsaid))

Columns = tuple[FloatArray, FloatArray, int, FloatArray, FloatArray, FloatArray, FloatArray]


@dataclass(eq=False)
class Launches:
    """Launches of one shape.

    ``shape``: that of all of them; ``vx``, ``vy``: flat arrays, of which every ``step``-th number
    is a component, m/s; ``step`` 0: the first, for all launches; ``spin``, ``delta``, ``decel``,
    ``radius``: arrays (n,), or (1,): the same for all launches; ``is_held``: whether some of them
    is an array of the caller, who may change it.
    """

    shape: tuple[int, ...]
    vx: FloatArray
    vy: FloatArray
    step: int
    spin: FloatArray
    delta: FloatArray
    decel: FloatArray
    radius: FloatArray
    is_held: bool = False

    def __post_init__(self) -> None:
        self.size = math.prod(self.shape) if self.shape else 1  # how many

    @property
    def tallest(self) -> float:
        """The largest δ; NaN where one is none, 0 of no launches."""
        if self.delta.size == 1:
            return self.delta.item()
        return float(self.delta.max()) if self.delta.size else 0.0

    def part(self, start: int, stop: int) -> Columns:
        """Some of them, as compiled code takes them."""
        vx, vy, step = self.vx, self.vy, self.step
        if start == 0 and stop == self.size:
            return vx, vy, step, self.spin, self.delta, self.decel, self.radius
        if step:
            vx, vy = vx[step * start : step * stop], vy[step * start : step * stop]
        spin, delta, decel, radius = (
            one if one.size == 1 else one[start:stop]
            for one in (self.spin, self.delta, self.decel, self.radius)
        )
        return vx, vy, step, spin, delta, decel, radius

    @cached_property
    def matrix(self) -> FloatArray:
        """A copy, (6, n): vx, vy, ω, δ, J, r."""
        return self.rows(0, self.size)

    def rows(self, start: int, stop: int) -> FloatArray:
        """A copy of some of them, (6, n)."""
        vx, vy, step, *others = self.part(start, stop)
        n = stop - start
        rows = np.empty((6, n))
        step = step or n + 1
        rows[0], rows[1] = vx[::step][:n], vy[::step][:n]
        rows[2], rows[3], rows[4], rows[5] = others
        return rows

    def mark(self) -> int:
        """A number that changes with their bits."""
        parts = range(0, self.size, CHUNK)
        ends = [(start, min(start + CHUNK, self.size)) for start in parts]
        return smallest_mark((a, mark_of(*self.part(a, b), b - a)) for a, b in ends)

    def refuse_changed(self, mark: int) -> None:
        """Refuse launches that are no longer those of a mark: their arrays are the caller's."""
        if self.is_held and self.mark() != mark:
            raise InputError(
                "the arrays of launches have been changed since their stops were looked up: call "
                "stop again, or give it copies of them"
            )

    def refuse_bad(self) -> None:
        """Refuse numbers that are not finite, heights below 0, J and r that are not above."""
        step = self.step or 1
        speeds = (("velocity", self.vx[::step]), ("velocity", self.vy[::step]), ("spin", self.spin))
        for name, values in speeds:
            if not np.isfinite(values).all():
                finite_array(name, values, "rad/s" if name == "spin" else "m/s")
        checked_delta(self.delta)
        for name, values in (("decel", self.decel), ("radius", self.radius)):
            positive_array(name, values, _UNITS[name])


def launches_of(
    velocity: npt.ArrayLike, spin: npt.ArrayLike, delta: npt.ArrayLike, decel: npt.ArrayLike,
    radius: npt.ArrayLike,
) -> Launches:  # fmt: skip
    """Launches from what a caller passes, broadcast; whether the numbers are good is not asked.

    >>> launches_of([[1.0, 0.0], [2.0, 0.0]], 5.0, 0.5, 1.0, 1.0).matrix[:3].tolist()
    [[1.0, 2.0], [0.0, 0.0], [5.0, 5.0]]
    """
    others = (spin, delta, decel, radius)
    if isinstance(velocity, tuple | list) and len(velocity) == 2:
        numbers = (*velocity, *others)
        if _NUMBERS.issuperset(map(type, numbers)):  # one launch, as cheap as can be
            try:
                row = np.array(numbers, np.float64).reshape(COLUMNS, 1)
                return Launches((), row[0], row[1], 0, row[2], row[3], row[4], row[5])
            except OverflowError:  # an integer: said below
                pass
    pairs = real_view("velocity", velocity, "m/s")
    if pairs.ndim == 0 or pairs.shape[-1] != 2:
        velocity_array(velocity)
    arrays = [
        real_view(name, values, unit)
        for (name, unit), values in zip(_UNITS.items(), others, strict=True)
    ]
    try:
        shape = np.broadcast(pairs[..., 0], *arrays).shape
    except ValueError:
        broadcast(velocity=pairs[..., 0], **dict(zip(_UNITS, arrays, strict=True)))
        raise
    vx, vy, step, is_held = _components(pairs, shape, pairs is not velocity)
    columns = []
    for array, values in zip(arrays, others, strict=True):
        column, held = flat_column(array, shape, array is not values)
        columns.append(column)
        is_held |= held
    turns, heights, decels, radii = columns
    return Launches(shape, vx, vy, step, turns, heights, decels, radii, is_held)


def launches_in(rows: FloatArray, shape: tuple[int, ...] | None = None) -> Launches:
    """Checked launches (6, n): vx, vy, ω, δ, J, r, of another shape if it is given."""
    vx, vy, spin, delta, decel, radius = (np.ascontiguousarray(row) for row in rows)
    return Launches(
        (vx.size,) if shape is None else shape, vx, vy, 1, spin, delta, decel, radius
    )  # fmt: skip


def flat_column(array: FloatArray, shape: tuple[int, ...], is_own: bool) -> tuple[FloatArray, bool]:
    """An array that broadcasts to a shape as (n,) or (1,), and whether it is the caller's.

    Read-only ones are copied: compiled code would be compiled once more for them.
    """
    if array.size != 1 and array.shape != shape:
        return np.broadcast_to(array, shape).reshape(-1), False
    if is_own or not array.flags.c_contiguous:
        return array.reshape(-1), False
    if array.size <= COPIED or not array.flags.writeable:
        return array.reshape(-1).copy(), False
    return array.reshape(-1), True


def _components(
    pairs: FloatArray, shape: tuple[int, ...], is_own: bool
) -> tuple[FloatArray, FloatArray, int, bool]:
    """Flat vx, vy, the step between their numbers, and whether they are the caller's."""
    if pairs.size == 2:
        both = pairs.reshape(2).copy()
        return both[:1], both[1:], 0, False
    if pairs.shape[:-1] != shape:
        pairs, is_own = np.broadcast_to(pairs, (*shape, 2)).copy(), True
    held = not is_own and pairs.size > 2 * COPIED and pairs.flags.writeable
    vx, vy = pairs[..., 0], pairs[..., 1]
    if held and vx.flags.c_contiguous and vy.flags.c_contiguous:  # components apart
        return vx.reshape(-1), vy.reshape(-1), 1, True
    if not pairs.flags.c_contiguous or not (is_own or held):
        pairs, held = pairs.copy("C"), False
    both = pairs.reshape(-1)
    return both, both[1:], 2, held


def in_chunks(work: Callable[[int, int], None], size: int, threads: int | None) -> None:
    """Call ``work(start, stop)`` for chunks of launches; on this thread where one does it all."""
    if size <= CHUNK or (usable_cores() if threads is None else threads) > 1:
        run_chunks(work, size, CHUNK, threads)
        return
    for start in range(0, size, CHUNK):
        work(start, min(start + CHUNK, size))


def smallest_mark(parts: Iterable[tuple[int, int]]) -> int:
    """One mark from the starts of chunks and theirs.

    >>> smallest_mark([(0, 5), (CHUNK, 7)])
    26
    """
    return sum(int(mark) * (2 * (start // CHUNK) + 1) for start, mark in parts) % (1 << 64)


@inlined
def _bits_of(values: FloatArray) -> int:
    """A sum that changes with the bits of numbers, or with their order."""
    bits, mark = values.view(np.int64), 0
    for n in range(bits.size):
        mark += bits[n] * (2 * n + 1)
    return mark


@inlined
def _fetch(column: FloatArray, start: int, count: int, row: int, room: FloatArray) -> None:
    """A block of a column (n,) into a row; of (1,) nothing: it was filled before."""
    if column.size > 1:
        values, block = column[start : start + count], room[row * BLOCK : (row + 1) * BLOCK]
        for n in range(count):
            block[n] = values[n]


@inlined
def fill_constants(
    vx: FloatArray, vy: FloatArray, spin: FloatArray, delta: FloatArray, decel: FloatArray,
    radius: FloatArray, count: int, room: FloatArray,
) -> None:  # fmt: skip
    """The first numbers of all columns into ``count`` places of the first six rows of ``room``."""
    if delta.size > 0 and spin.size > 0 and vx.size > 0 and decel.size > 0 and radius.size > 0:
        for n in range(min(count, BLOCK)):
            into_row(room, VX, n, vx[0])
            into_row(room, VY, n, vy[0])
            into_row(room, SPIN, n, spin[0])
            into_row(room, DELTA, n, delta[0])
            into_row(room, DECEL, n, decel[0])
            into_row(room, RADIUS, n, radius[0])


@inlined
def fetch_block(
    vx: FloatArray, vy: FloatArray, step: int, spin: FloatArray, delta: FloatArray,
    decel: FloatArray, radius: FloatArray, start: int, count: int, room: FloatArray,
) -> None:  # fmt: skip
    """Launches from ``start`` on into the first six rows of ``room``."""
    if step == 2:
        pairs = vx[2 * start : 2 * (start + count)]
        for n in range(count):
            into_row(room, VX, n, pairs[2 * n])
            into_row(room, VY, n, pairs[2 * n + 1])
    elif step == 1:
        _fetch(vx, start, count, VX, room)
        _fetch(vy, start, count, VY, room)
    _fetch(spin, start, count, SPIN, room)
    _fetch(delta, start, count, DELTA, room)
    _fetch(decel, start, count, DECEL, room)
    _fetch(radius, start, count, RADIUS, room)


@inlined
def mark_block(
    vx: FloatArray, vy: FloatArray, step: int, spin: FloatArray, delta: FloatArray,
    decel: FloatArray, radius: FloatArray, start: int, count: int,
) -> int:  # fmt: skip
    """A number that changes with the bits of launches from ``start`` on, or with their order."""
    end, mark = start + count, 0
    if step == 2:
        mark += _bits_of(vx[2 * start : 2 * end])
    elif step == 1:
        mark += _bits_of(vx[start:end]) + 3 * _bits_of(vy[start:end])
    mark += 5 * _bits_of(spin[start:end]) if spin.size > 1 else 0
    mark += 7 * _bits_of(delta[start:end]) if delta.size > 1 else 0
    mark += 11 * _bits_of(decel[start:end]) if decel.size > 1 else 0
    mark += 13 * _bits_of(radius[start:end]) if radius.size > 1 else 0
    return mark * (2 * start + 1)


@kernel
def mark_of(
    vx: FloatArray, vy: FloatArray, step: int, spin: FloatArray, delta: FloatArray,
    decel: FloatArray, radius: FloatArray, size: int,
) -> int:  # fmt: skip
    """The sum of the marks of all blocks of ``size`` launches."""
    patience(size)
    mark = 0
    for start in range(0, size, BLOCK):
        count = min(BLOCK, size - start)
        mark += mark_block(vx, vy, step, spin, delta, decel, radius, start, count)
    return mark


def positive_array(name: str, values: npt.ArrayLike, unit: str) -> FloatArray:
    """An array of finite numbers greater than zero."""
    array = finite_array(name, values, unit)
    if not np.all(array > 0.0):
        raise InputError(
            f"{name} must be greater than 0 {unit}, got {array[array <= 0.0].flat[0]:g}"
        )
    return array


def fits(launches: FloatArray, longest: float = 2.0) -> npt.NDArray[np.bool_]:
    """Whether Q/J, Q²/J and Q²/(J r) of launches (6, n) are within floating point, (n,).

    ``longest``: how many times as large times, places and angles may get.

    >>> fits(np.array([[1.0, 1e200], [0, 0], [0, 0], [0, 0], [1, 1], [1, 1]])).tolist()
    [True, False]
    """
    vx, vy, spin, _, decel, radius = launches
    with np.errstate(over="ignore", invalid="ignore"):
        slip = np.hypot(np.hypot(vx, vy), radius * spin)
        size = longest * slip / decel * slip
        inside: npt.NDArray[np.bool_] = np.isfinite(size / radius + size)
    return inside
