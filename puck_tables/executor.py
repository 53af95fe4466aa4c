"""The one seam for parallel work: chunks of independent items on threads."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait

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
    count = usable_cores() if threads is None else threads
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
                finished, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for one in finished:
                    one.result()
                    done_items += sizes.pop(one)
                if progress is not None:
                    progress(done_items, items)
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


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
