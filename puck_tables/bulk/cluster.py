"""The blocks of a store done by the workers of a Dask cluster; the one door to dask.

A worker is sent the work once, opens the store itself (a folder that all machines share) and does
whole blocks.  What a worker that ends had on hand the scheduler gives to another; what the store
holds already is not done again, so that a client that ends can begin anew.
"""

from __future__ import annotations

import contextlib
import logging
import os
import platform
import re
import time
import warnings
from collections import OrderedDict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from puck_tables._core.digest import program
from puck_tables._core.executor import Progress
from puck_tables.bulk.store import Store
from puck_tables.bulk.work import Tally, Work, same_program
from puck_tables.errors import ClusterError, InputError, MissingExtraError

try:
    import dask
    import distributed
    from distributed.comm.core import CommClosedError
    from distributed.protocol.pickle import dumps, loads
except ImportError:
    raise MissingExtraError(
        '--cluster (cluster=) needs dask and distributed: pip install "puck-tables[cluster]"'
    ) from None

MOST_WORKERS = 1024
_REACH, _PATIENCE = 5.0, 10.0  # s to reach a scheduler, to find a worker
_AHEAD = 4  # blocks given to each thread of the workers
_LOOK = 0.2  # s between two looks
# so much memory a worker keeps for the next block, which else it asks of the system anew
_KEPT = {
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 1 << 27,
    "distributed.nanny.pre-spawn-environ.MALLOC_MMAP_THRESHOLD_": 1 << 25,
}
_ADDRESS = re.compile(r"(tcp|tls)://[^\s/:]+:[0-9]{1,5}|(tcp|tls)://\[[0-9a-fA-F:.]+\]:[0-9]{1,5}")


def checked_address(where: object) -> int | str:
    """How many workers of one's own are to be started, or the address of a scheduler.

    Raises
    ------
    InputError

    Examples
    --------
    >>> checked_address("local:4"), checked_address("tcp://10.0.0.1:8786")
    (4, 'tcp://10.0.0.1:8786')
    """
    if isinstance(where, str):
        local = re.fullmatch(r"local:([0-9]{1,5})", where)
        if local is not None and 1 <= int(local[1]) <= MOST_WORKERS:
            return int(local[1])
        if _ADDRESS.fullmatch(where):
            return where
    raise InputError(
        f"the cluster '{where!s:.60}' must be local:N, with N workers from 1 to {MOST_WORKERS}, or "
        "the address of a scheduler, tcp://HOST:PORT"
    )


def by_cluster(client: Any, store: Store, progress: Progress | None) -> Tally:
    """Do all blocks of a store on a cluster.

    Parameters
    ----------
    client : of :func:`client_of`
    store : made, or gone on with
    progress : callable (done, total), optional

    Raises
    ------
    InputError
        If the workers run another program, or do not see the store.
    ClusterError
        If the scheduler is lost, or has no workers any more.
    """
    try:
        with client.as_current():
            return _done(client, store, progress)
    except (distributed.CancelledError, CommClosedError):
        raise ClusterError("the scheduler was lost: the same command goes on") from None
    except distributed.KilledWorker:
        raise ClusterError(
            "several workers ended at the same block: see whether they have enough memory; the "
            "same command goes on"
        ) from None


def _done(client: Any, store: Store, progress: Progress | None) -> Tally:
    sent = dumps((store.work, store.digest, program()))
    work = client.submit(_received, sent, key=f"puck-work-{store.digest}", pure=True)
    total, tally, next_block = store.work.size, Tally({}, {}), 0
    running: set[Any] = set()

    def give() -> None:
        nonlocal next_block
        threads = max(1, sum(client.nthreads().values()))
        while len(running) < _AHEAD * threads and next_block < store.blocks.count:
            one = client.submit(
                _block, work, str(store.path), next_block, pure=False, priority=-next_block
            )
            running.add(one)
            next_block += 1

    give()
    since = time.monotonic()
    while running:
        finished = {one for one in running if one.done()}
        if not finished:
            with contextlib.suppress(TimeoutError):
                distributed.wait(running, timeout=_LOOK, return_when="FIRST_COMPLETED")
            since = _refuse_none(client, since)
            continue
        for one in finished:
            tally += one.result()
        running -= finished
        since = time.monotonic()
        give()
        if progress is not None:
            progress(sum(tally.counts.values()), total)
    return tally


def _refuse_none(client: Any, since: float) -> float:
    """Give up when for some time there have been no workers; returns since when."""
    if client.status != "running":
        raise CommClosedError
    if client.nthreads():
        return time.monotonic()
    if time.monotonic() - since > _PATIENCE:
        raise ClusterError(
            "the scheduler has no workers any more: start some, the same command goes on"
        )
    return since


@contextlib.contextmanager
def client_of(given: str) -> Iterator[Any]:
    """A client of a cluster, which is closed again, as is a cluster of one's own.

    Parameters
    ----------
    given : see :func:`checked_address`

    Raises
    ------
    ClusterError
        If the scheduler cannot be reached, or has no workers.
    """
    where = checked_address(given)
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    with contextlib.ExitStack() as stack, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        address: Any = where
        if isinstance(where, int):
            stack.enter_context(dask.config.set(_KEPT))
            stack.enter_context(_quiet_children())
            cluster = distributed.LocalCluster(
                n_workers=where, threads_per_worker=1, processes=True, host="127.0.0.1",
                dashboard_address=None, silence_logs=logging.CRITICAL, memory_limit=0,
                preload="puck_tables.bulk.deaf_worker",
            )  # fmt: skip
            address = stack.enter_context(cluster)
        try:
            client = distributed.Client(address, timeout=_REACH, set_as_default=False)
        except (OSError, TimeoutError, ValueError) as error:
            raise ClusterError(
                f"no scheduler answers at {where} ({type(error).__name__}): start one with 'dask "
                "scheduler', and workers with 'dask worker'"
            ) from None
        stack.enter_context(client)
        try:
            client.wait_for_workers(1, timeout=_PATIENCE)
        except TimeoutError:
            raise ClusterError(
                f"the scheduler at {where} has no workers: start some with 'dask worker {where}'"
            ) from None
        yield client


@contextlib.contextmanager
def _quiet_children() -> Iterator[None]:
    """No warnings from the processes that are started meanwhile: after Ctrl-C they complain."""
    before = os.environ.get("PYTHONWARNINGS")
    os.environ["PYTHONWARNINGS"] = "ignore"
    try:
        yield
    finally:
        if before is None:
            del os.environ["PYTHONWARNINGS"]
        else:
            os.environ["PYTHONWARNINGS"] = before


# what runs on a worker


def _received(sent: bytes) -> tuple[Work, str]:
    """The work, on a worker that runs the same program."""
    work, digest, made_by = loads(sent)
    same_program(made_by, f"a worker ({platform.node()}, process {os.getpid()})")
    return work, digest


_open: OrderedDict[tuple[str, str], Store] = OrderedDict()  # stores this worker is at


def _block(received: tuple[Work, str], path: str, block: int) -> Tally:
    """Do one block of a store."""
    work, digest = received
    if (path, digest) not in _open:
        if not Path(path).is_dir():
            raise InputError(
                f"a worker does not see {path}: put the store into a folder that all machines share"
            )
        _open[path, digest] = Store(path, work)
        while len(_open) > 2:
            _open.popitem(last=False)
    return _open[path, digest].do(block)
