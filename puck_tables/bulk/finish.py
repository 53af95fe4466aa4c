"""A work done: in memory, or into a store, by threads or by a cluster."""

from __future__ import annotations

import math
import os
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from puck_tables._core.arrays import checked_progress, instance, whole
from puck_tables._core.memory import check_memory
from puck_tables._core.waiting import Progress
from puck_tables.bulk.work import Tally, Work, in_memory
from puck_tables.errors import InputError, OutputError
from puck_tables.io.columns import Dataset
from puck_tables.io.formats import STORE
from puck_tables.result import Result

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COPIES = 3  # of the columns: as read, in their shape, and what follows from them


class Stored(Result):
    """A result in a Zarr store, too large for memory perhaps.

    ``path``; ``tally``: how many items have which code of :attr:`Work.code`, and the first of each.
    """

    def __init__(self, path: Path, work: Work, tally: Tally) -> None:
        self.path, self.work, self.tally = path, work, tally

    def __repr__(self) -> str:
        return f"Stored({self.path.name}: {' x '.join(map(str, self.work.shape))} items)"

    @property
    def is_sample(self) -> bool:
        """Whether it is of samples, which have a summary."""
        return self.work.is_sample

    def load(self) -> Result:
        """The result in memory.

        InputError if it does not fit, or blocks are damaged or missing; OutputError if the store
        holds other work by now.
        """
        from puck_tables.bulk.store import Store

        each = 1 + 8 * sum(math.prod(one) for one in self.work.columns.values())
        check_memory(self.work.shape, _COPIES * each)
        return self.work.result(Store(self.path, self.work).read())

    def dataset(self) -> Dataset:
        """That of the result in memory."""
        return self.load().dataset()

    def explain(self) -> str:
        """How it was got."""
        return self.work.explain(self.tally)

    def plot(
        self, path: str | Path | None = None, ax: Axes | None = None, overwrite: bool = False
    ) -> Figure:
        """Draw the result in memory, as :meth:`Result.plot`."""
        return self.load().plot(path, ax, overwrite)

    def to_xarray(self) -> xarray.Dataset:
        """The store as an xarray.Dataset, which reads what is asked of it, when it is asked."""
        from puck_tables.io.formats import open_store

        return open_store(self.path)


@dataclass(frozen=True)
class Doing:
    """How a work is done, and where its result goes.

    ``threads``: of this process, where there is no cluster; ``chunk``: so many items are computed
    at a time; ``progress``: callable (done, total), optional; ``store``: path of a Zarr store, made
    or gone on with, optional; ``cluster``: 'local:N' or 'tcp://HOST:PORT', optional; needs a store;
    ``overwrite``: whether it replaces a store of other work, when it is whole.
    """

    threads: int | None
    chunk: int
    progress: Progress | None
    store: str | Path | None
    cluster: str | None
    overwrite: bool

    def __post_init__(self) -> None:
        object.__setattr__(self, "chunk", whole("chunk", self.chunk, 1))


def finish(work: Work, how: Doing) -> Any:
    """The result of a work; with a store a :class:`Stored` one.

    Raises InputError, OutputError, MissingExtraError, ClusterError.
    """
    threads, store, cluster = how.threads, how.store, how.cluster
    checked_progress(how.progress)
    if store is None:
        work.refuse_memory()
        if cluster is not None:
            raise InputError(
                "a cluster writes to a Zarr store: give -o NAME.zarr (store='NAME.zarr') too"
            )
        return in_memory(work, threads, how.progress)
    instance("store", store, str, Path)
    if Path(store).suffix.lower() != STORE:
        raise InputError(f"{store}: a store must have the ending {STORE}")
    try:
        os.fsencode(store)
        if "\0" in str(store):
            raise ValueError("embedded null byte")
    except ValueError as error:
        raise OutputError(f"cannot write {store}: {error}") from None
    from puck_tables.bulk.store import Store, by_threads

    workers: Any = nullcontext()
    if cluster is not None:
        from puck_tables.bulk.cluster import by_cluster, client_of

        workers = client_of(cluster)
    with workers as client:
        tell = work.prepared(threads, how.progress)
        kept = Store(store, work, begin=True, overwrite=how.overwrite)
        try:
            if client is None:
                tally = by_threads(kept, threads, tell)
            else:
                tally = by_cluster(client, kept, tell)
            work.checked(tally)
        except InputError:  # the work is refused: a store that is there stays
            kept.place.withdraw()
            raise
        kept.place.complete()
    return Stored(kept.path, work, tally)
