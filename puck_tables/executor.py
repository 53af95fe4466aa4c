"""The one seam for parallel work: chunks of independent items on threads."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager

Progress = Callable[[int, int], None]


def run_chunks(
    work: Callable[[int, int], None],
    items: int,
    chunk: int,
    threads: int | None = None,
    progress: Progress | None = None,
) -> None:
    """Call ``work(start, stop)`` for all chunks of ``range(items)``, on several threads.

    Parameters
    ----------
    work : callable (start, stop)
        Must release the GIL to gain anything, and must not depend on the cutting.
    items, chunk : int
    threads : int, optional
        As many as the process may use cores, if left out.
    progress : callable (done items, all items), optional

    Raises
    ------
    Exception
        The first that a chunk raises; chunks not yet begun are dropped, also on Ctrl-C.

    Examples
    --------
    >>> seen = []
    >>> run_chunks(lambda a, b: seen.append((a, b)), 5, 2, threads=1)
    >>> seen
    [(0, 2), (2, 4), (4, 5)]
    """
    if items <= chunk:
        work(0, items)
        if progress is not None:
            progress(items, items)
        return
    count = usable_cores() if threads is None else threads
    with _interrupt_noted() as check:
        _run(work, items, chunk, count, progress, check)


def _run(
    work: Callable[[int, int], None],
    items: int,
    chunk: int,
    count: int,
    progress: Progress | None,
    check: Callable[[], None],
) -> None:
    pool = ThreadPoolExecutor(max_workers=count)
    waiting: set[Future[None]] = set()
    sizes: dict[Future[None], int] = {}
    done_items = 0
    try:
        for start in range(0, items, chunk):
            stop = min(start + chunk, items)
            future = pool.submit(work, start, stop)
            waiting.add(future)
            sizes[future] = stop - start
            if len(waiting) < 2 * count and stop < items:
                continue
            while len(waiting) >= 2 * count or (stop == items and waiting):
                check()
                finished, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for one in finished:
                    one.result()
                    done_items += sizes.pop(one)
                if progress is not None:
                    progress(done_items, items)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


@contextmanager
def _interrupt_noted() -> Iterator[Callable[[], None]]:
    """Ctrl-C is noted, and raised between chunks.

    Raised at once it could strike where Python swallows it, such as in a weak reference's callback
    inside the thread pool, and the work would go on.
    """
    if threading.current_thread() is not threading.main_thread():
        yield lambda: None
        return
    noted = False

    def note(number: int, frame: object) -> None:
        nonlocal noted
        noted = True

    def check() -> None:
        if noted:
            raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, note)
    try:
        yield check
    finally:
        signal.signal(signal.SIGINT, before)
    check()


def usable_cores() -> int:
    """Cores this process may run on.

    Examples
    --------
    >>> usable_cores() >= 1
    True
    """
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
