"""Work of many independent items, and how it is done in memory, by threads.

Threads stay, beside the cluster: they share the tables, need no package and no start, and the
compiled loops release the GIL, so that nothing simpler uses all cores of one machine.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import checked_threads
from puck_tables._core.digest import program, work_digest
from puck_tables._core.executor import run_chunks
from puck_tables._core.waiting import Progress
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset
from puck_tables.result import Result

Columns = dict[str, npt.NDArray[Any]]


class Work(ABC):
    """Items numbered in C order over ``shape``, each computed from its number alone.

    ``columns``: names of the float64 columns, with the shape that one item has in each; ``code``:
    the int8 column that says what became of an item.  ``part``: so many items are computed at a
    time; ``block``: about so many are kept together in a store.  A work can be pickled.
    """

    shape: tuple[int, ...]
    columns: Mapping[str, tuple[int, ...]]
    code: str
    part: int
    block: int
    is_sample = False

    @property
    def size(self) -> int:
        """How many items."""
        return math.prod(self.shape)

    @property
    @abstractmethod
    def identity(self) -> Mapping[str, Any]:
        """What determines the bits, as :func:`puck_tables._core.digest.work_digest` takes it."""

    @abstractmethod
    def of(self, start: int, stop: int) -> Columns:
        """The columns (stop − start, …) of some items, with the code; whatever the cutting."""

    @abstractmethod
    def labelled(self, columns: Columns) -> Dataset:
        """Columns over the whole shape with names, axes and units, without what follows."""

    @abstractmethod
    def result(self, columns: Columns) -> Result:
        """The result that has these columns."""

    @abstractmethod
    def explain(self, tally: Tally) -> str:
        """How it is done, and why in that way."""

    @abstractmethod
    def checked(self, tally: Tally) -> None:
        """Refuse work of which nothing came, told by its codes."""

    @abstractmethod
    def refuse_memory(self) -> None:
        """Refuse what would not fit in memory."""

    def prepared(self, threads: int | None, progress: Progress | None) -> Progress | None:
        """Make what all items need; returns how to tell the progress of the items themselves."""
        return progress

    @property
    def digest(self) -> str:
        """Which work it is; what it is done by included."""
        return work_digest(**self.identity, block=self.block)

    def columns_of(self, items: int) -> Columns:
        """Room for the columns of so many items."""
        arrays: Columns = {name: np.empty((items, *one)) for name, one in self.columns.items()}
        return arrays | {self.code: np.empty(items, np.int8)}

    def virtual(self) -> Columns:
        """Columns of the whole shape that take no memory: for their labels."""
        arrays: Columns = {
            name: np.broadcast_to(np.nan, (*self.shape, *one)) for name, one in self.columns.items()
        }
        return arrays | {self.code: np.broadcast_to(np.int8(0), self.shape)}

    def filled(self, arrays: Columns, start: int, stop: int, first: int = 0) -> None:
        """Put the columns of some items in their places among those from ``first`` on."""
        for name, values in self.of(start, stop).items():
            arrays[name][start - first : stop - first] = values


@dataclass(frozen=True)
class Tally:
    """How many items have which code, and the number of the first of each."""

    counts: Mapping[int, int]
    first: Mapping[int, int]

    @classmethod
    def of(cls, codes: npt.NDArray[np.int8], start: int = 0) -> Tally:
        """That of the codes of items from ``start`` on.

        >>> Tally.of(np.array([0, 2, 2], np.int8), 10)
        Tally(counts={0: 1, 2: 2}, first={0: 10, 2: 11})
        """
        flat = codes.ravel()
        arrays = [(code, flat == code) for code in np.unique(flat).tolist()]
        return cls(
            {code: int(np.count_nonzero(mine)) for code, mine in arrays},
            {code: start + int(np.argmax(mine)) for code, mine in arrays},
        )

    def __add__(self, other: Tally) -> Tally:
        codes = sorted({*self.counts, *other.counts})
        far = 1 << 62
        return Tally(
            {code: self.counts.get(code, 0) + other.counts.get(code, 0) for code in codes},
            {code: min(self.first.get(code, far), other.first.get(code, far)) for code in codes},
        )


def in_memory(work: Work, threads: int | None, progress: Progress | None) -> Result:
    """The result of a work, in memory.

    Raises InputError if nothing came of it.
    """
    checked_threads(threads)
    tell = work.prepared(threads, progress)
    arrays = work.columns_of(work.size)
    run_chunks(
        lambda start, stop: work.filled(arrays, start, stop), work.size, work.part, threads, tell
    )
    work.checked(Tally.of(arrays[work.code]))
    shaped = {name: one.reshape((*work.shape, *one.shape[1:])) for name, one in arrays.items()}
    return work.result(shaped)


def same_program(version: tuple[str, ...], where: str) -> None:
    """Refuse another program than the one that a work was made by.

    Raises InputError.

    >>> same_program(program(), "worker 1")
    """
    if tuple(version) != program():
        raise InputError(
            f"{where} runs another version of puck-tables, Python, numba, numpy or scipy, or "
            "another processor: bits would differ; install the same everywhere"
        )
