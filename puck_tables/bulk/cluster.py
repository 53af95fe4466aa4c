"""The blocks of a store done by the workers of a Dask cluster; the one door to dask.

A worker is sent the work once, opens the store itself (a folder that all machines share) and does
whole blocks.  What a worker that ends had on hand the scheduler gives to another; what the store
holds already is not done again, so that a client that ends can begin anew.

A scheduler runs what anybody sends who reaches it.  One's own talks by TLS with those alone that
have its certificate, which is made for it, stays in memory and ends with it.
"""

from __future__ import annotations

import asyncio
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
from puck_tables._core.waiting import Progress, watched
from puck_tables.bulk.store import Store
from puck_tables.bulk.store_folder import sibling_of
from puck_tables.bulk.work import Tally, Work, same_program
from puck_tables.errors import ClusterError, InputError, MissingExtraError

try:
    import dask
    import distributed
    from distributed.comm.core import CommClosedError
    from distributed.protocol.pickle import dumps, loads
    from distributed.security import Security
except ImportError:
    raise MissingExtraError(
        "--cluster (cluster=) needs dask and distributed: pip install dask distributed"
    ) from None

MOST_WORKERS = 1024  # processes of one machine: more is a slip of the hand
_REACH, _PATIENCE = 5.0, 10.0  # s to reach a scheduler, to find a worker
_SILENT, _TIMEOUT = 5.0, 2.0  # s without a block until the scheduler is asked, and it may be silent
_AHEAD = 4  # blocks given to each thread of the workers
_LOOK = 0.2  # s between two looks
_OWN = {  # of a cluster of one's own
    # so much memory a worker keeps for the next block, which else it asks of the system anew
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 1 << 27,
    "distributed.nanny.pre-spawn-environ.MALLOC_MMAP_THRESHOLD_": 1 << 25,
    "distributed.scheduler.http.routes": [],  # no pages, for which nobody shows a certificate
    "distributed.worker.http.routes": [],
}
_ADDRESS = re.compile(r"(tcp|tls)://[^\s/:]+:[0-9]{1,5}|(tcp|tls)://\[[0-9a-fA-F:.]+\]:[0-9]{1,5}")


def checked_address(where: object) -> int | str:
    """How many workers of one's own are to be started, or the address of a scheduler.

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
        "the address of a scheduler, tcp://HOST:PORT or tls://HOST:PORT"
    )


def by_cluster(client: Any, store: Store, progress: Progress | None) -> Tally:
    """Do all blocks of a store on a cluster.

    ``client``: of :func:`client_of`; ``store``: made, or gone on with; ``progress``: callable
    (done, total), optional.  Raises InputError if the workers run another program, or do not see
    the store; ClusterError if the scheduler is lost, or has no workers any more.
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
        threads = max(1, _threads(client))
        while len(running) < _AHEAD * threads and next_block < store.blocks.count:
            one = client.submit(
                _block, work, str(store.path), next_block, pure=False, priority=-next_block
            )
            running.add(one)
            next_block += 1

    give()
    heard = time.monotonic()
    while running:
        finished = {one for one in running if one.done()}
        if not finished:
            with contextlib.suppress(TimeoutError):
                distributed.wait(running, timeout=_LOOK, return_when="FIRST_COMPLETED")
            if client.status != "running":
                raise CommClosedError
            if time.monotonic() - heard > _SILENT:
                store.place.refuse_lost()
                _wait_for_workers(client, " any more: start some, the same command goes on")
                heard = time.monotonic()
            continue
        for one in finished:
            tally += one.result()
        running -= finished
        heard = time.monotonic()
        give()
        if progress is not None:
            progress(sum(tally.counts.values()), total)
    return tally


def _threads(client: Any) -> int:
    """How many threads the workers have; the scheduler is waited for, but not for ever."""
    where = client.scheduler.address
    try:
        try:
            cores = client.sync(client.scheduler.ncores, callback_timeout=_TIMEOUT)
        except TimeoutError:
            with watched(f"waiting for the scheduler at {where}"):
                cores = client.sync(client.scheduler.ncores, callback_timeout=_PATIENCE)
    except (OSError, TimeoutError):
        raise ClusterError(
            f"the scheduler at {where} does not answer any more: the same command goes on"
        ) from None
    return sum(cores.values())


def _wait_for_workers(client: Any, otherwise: str) -> None:
    """Wait until there are some, but not for ever."""
    if _threads(client):
        return
    end = time.monotonic() + _PATIENCE
    with watched("waiting for workers"):
        while not _threads(client):
            if time.monotonic() > end:
                raise ClusterError(
                    f"the scheduler at {client.scheduler.address} has no workers{otherwise}"
                )
            time.sleep(_LOOK)


@contextlib.contextmanager
def client_of(name_or_place: str) -> Iterator[Any]:
    """A client of a cluster, which is closed again, as is a cluster of one's own.

    ``name_or_place``: see :func:`checked_address`.  Raises ClusterError if the scheduler cannot be
    reached, or has no workers.
    """
    where = checked_address(name_or_place)
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    with contextlib.ExitStack() as stack, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        address: Any = where
        security: Any = None
        if isinstance(where, int):
            address = stack.enter_context(_own(where))
        else:
            security = _security(where)
            with watched(f"waiting for the scheduler at {where}"):
                _refuse_others(where, security)
        try:
            client = distributed.Client(
                address, security=security, timeout=_REACH, set_as_default=False
            )
        except (OSError, TimeoutError, ValueError) as error:
            raise _no_scheduler(name_or_place, error) from None
        stack.enter_context(client)
        _wait_for_workers(client, f": start some with 'dask worker {name_or_place}'")
        yield client


def _security(where: str) -> Any:
    """What Dask's configuration says of certificates, for an address.

    Raises ClusterError if they are needed and missing.
    """
    try:
        security = Security()
        context = security.get_connection_args("client")["ssl_context"]
    except (OSError, ValueError) as error:
        raise ClusterError(
            f"the certificates that Dask's configuration names cannot be used: {error}"
        ) from None
    if where.startswith("tls") and context is None:
        raise ClusterError(
            f"{where} needs certificates: name them in Dask's configuration, distributed.comm.tls."
            "ca-file, .client.cert and .client.key (in ~/.config/dask/distributed.yaml, or as "
            "DASK_DISTRIBUTED__COMM__TLS__CA_FILE and so on)"
        )
    return security


def _refuse_others(where: str, security: Any) -> None:
    """Refuse an address where no scheduler answers soon: a client would wait, or read anything."""

    async def identity() -> Any:
        how = security.get_connection_args("client")
        async with distributed.rpc(where, connection_args=how) as one:
            return await one.identity()

    try:
        kind = asyncio.run(asyncio.wait_for(identity(), _REACH)).get("type")
    except Exception as error:  # what another program answers may be read as anything
        raise _no_scheduler(where, error) from None
    if kind != "Scheduler":
        raise ClusterError(
            f"at {where} is no scheduler, but a {kind}: give the scheduler's address"
        )


def _no_scheduler(where: object, error: Exception) -> ClusterError:
    return ClusterError(
        f"no scheduler answers at {where} ({type(error).__name__}): start one with 'dask "
        "scheduler', and workers with 'dask worker'"
    )


@contextlib.contextmanager
def _own(workers: int) -> Iterator[Any]:
    """A cluster of this process."""
    try:
        security = Security.temporary()
    except ImportError:
        raise MissingExtraError(
            "--cluster local:N needs cryptography: pip install cryptography"
        ) from None
    with contextlib.ExitStack() as stack:
        stack.enter_context(dask.config.set(_OWN))
        stack.enter_context(_silent_children())
        try:
            with watched(f"starting {workers} workers"):
                cluster = distributed.LocalCluster(
                    n_workers=workers, threads_per_worker=1, processes=True, host="127.0.0.1",
                    dashboard_address=None, silence_logs=logging.CRITICAL, memory_limit=0,
                    preload="puck_tables.bulk.deaf_worker", security=security, protocol="tls://",
                )  # fmt: skip
        except (OSError, RuntimeError, TimeoutError) as error:
            raise ClusterError(
                f"the {workers} workers could not be started ({type(error).__name__}): see whether "
                "there is memory for them; the same command begins again"
            ) from None
        yield stack.enter_context(cluster)


@contextlib.contextmanager
def _silent_children() -> Iterator[None]:
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
    if (path, digest) not in _open or not _open[path, digest].place.is_mine:
        _open.pop((path, digest), None)
        if not (Path(path).is_dir() or sibling_of(Path(path)).is_dir()):
            raise InputError(
                f"a worker does not see {path}: put the store into a folder that all machines share"
            )
        _open[path, digest] = Store(path, work)
        while len(_open) > 2:
            _open.popitem(last=False)
    return _open[path, digest].do(block)
