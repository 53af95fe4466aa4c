"""How the items of a work are cut into blocks that are boxes of its shape and runs of its items."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Blocks:
    """Blocks of at most ``size`` items (at least one) over a shape.

    Each is a box, as a store of arrays wants it, and a run of items in C order, as the work is
    done: the last axes are whole, one is cut evenly, those before it one by one.

    Examples
    --------
    >>> blocks = Blocks((3, 10), 6)
    >>> blocks.box, blocks.count, blocks.run(1), blocks.place(1)
    ((1, 5), 6, (5, 10), (0, 1))
    """

    shape: tuple[int, ...]
    size: int

    @property
    def box(self) -> tuple[int, ...]:
        """How many items along each axis."""
        cut, inner = self._blocked
        if cut < 0:
            return self.shape
        length = self.shape[cut]
        parts = -(-length // max(1, self.size // inner))
        return *(1 for _ in self.shape[:cut]), -(-length // parts), *self.shape[cut + 1 :]

    @property
    def _blocked(self) -> tuple[int, int]:
        """The axis that is cut, −1 for none, and how many items the axes behind it have."""
        inner = 1
        for axis in reversed(range(len(self.shape))):
            if inner * self.shape[axis] > self.size:
                return axis, inner
            inner *= self.shape[axis]
        return -1, inner

    @property
    def grid(self) -> tuple[int, ...]:
        """How many blocks along each axis."""
        return tuple(-(-n // one) for n, one in zip(self.shape, self.box, strict=True))

    @property
    def count(self) -> int:
        """How many blocks."""
        return math.prod(self.grid)

    def place(self, block: int) -> tuple[int, ...]:
        """Which block it is along each axis."""
        result = []
        for n in reversed(self.grid):
            block, rest = divmod(block, n)
            result.append(rest)
        return tuple(reversed(result))

    def slices(self, block: int) -> tuple[slice, ...]:
        """Its box."""
        return tuple(
            slice(place * one, min((place + 1) * one, n))
            for place, one, n in zip(self.place(block), self.box, self.shape, strict=True)
        )

    def run(self, block: int) -> tuple[int, int]:
        """Its first item, and the first behind it."""
        start, items = 0, 1
        for one, n in zip(self.slices(block), self.shape, strict=True):
            start = start * n + one.start
            items *= one.stop - one.start
        return start, start + items
