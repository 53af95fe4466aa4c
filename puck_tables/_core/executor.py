"""The one seam for parallel work: chunks of independent items on threads."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from queue import Empty, SimpleQueue
from typing import Any

from puck_tables._core.waiting import Progress

_FIRST_SLICE, _GROWTH = 4, 8.0  # items; times the slice before
_SLICE_TIME = 0.2  # s, about, of a slice: between two Ctrl-C is heard
_LOOK = 0.2  # s between two looks for Ctrl-C while all threads work
_this_thread = threading.local()  # holds the event that says that its run was given up


def run_chunks(
    work: Callable[[int, int], None], items: int, chunk: int, threads: int | None = None,
    progress: Progress | None = None,
) -> None:  # fmt: skip
    """Call ``work(start, stop)`` for all chunks of ``range(items)``, on several threads.

    ``work`` must release the GIL to gain anything, and must not depend on the cutting; ``threads``:
    as many as the process may use cores, if left out; ``progress``: callable (done items, all
    items).  Raises what a chunk raises first; chunks not yet begun are dropped, also on Ctrl-C, and
    those that run end where they next call :func:`keep_on`.

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


def in_slices(work: Callable[[int, int], None], items: int) -> None:
    """Call ``work(start, stop)`` for slices of ``range(items)`` that take some 0.2 s each.

    Compiled loops do not hear Ctrl-C; between the slices it is heard.

    ``work``: callable (start, stop), must not depend on the cutting; ``items``: int.

    >>> seen = []
    >>> in_slices(lambda a, b: seen.append((a, b)), 6)
    >>> seen[0], seen[-1][1]
    ((0, 4), 6)
    """
    start, size = 0, _FIRST_SLICE
    while start < items:
        stop = min(start + size, items)
        begin = time.perf_counter()
        work(start, stop)
        keep_on()
        took = max(time.perf_counter() - begin, 1e-9)
        size = max(1, int(min(_GROWTH, _SLICE_TIME / took) * (stop - start)))
        start = stop


def keep_on() -> None:
    """Do nothing, or end a chunk whose run was given up.

    Raises KeyboardInterrupt in a thread of :func:`run_chunks` that is not to finish its work.
    """
    interrupted = getattr(_this_thread, "interrupted", None)
    if interrupted is not None and interrupted.is_set():
        raise KeyboardInterrupt


def _run(
    work: Callable[[int, int], None], items: int, chunk: int, count: int, progress: Progress | None,
    check: Callable[[], None],
) -> None:  # fmt: skip
    interrupted, starts, lock = threading.Event(), iter(range(0, items, chunk)), threading.Lock()
    news: SimpleQueue[int | BaseException | None] = SimpleQueue()

    def take() -> None:
        """Chunk after chunk; the calling thread is woken only by what it wants to know."""
        _this_thread.interrupted = interrupted
        try:
            while not interrupted.is_set():
                with lock:
                    start = next(starts, items)
                if start == items:
                    break
                stop = min(start + chunk, items)
                work(start, stop)
                if progress is not None:
                    news.put(stop - start)
        except BaseException as error:
            interrupted.set()
            news.put(error)
        else:
            news.put(None)

    threads = [threading.Thread(target=take) for _ in range(min(count, -(-items // chunk)))]
    done, ended = 0, 0
    try:
        for thread in threads:
            thread.start()
        while ended < len(threads):
            check()
            try:
                word = news.get(timeout=_LOOK)
            except Empty:
                continue
            if isinstance(word, BaseException):
                raise word
            ended += word is None
            done += word or 0
            if progress is not None and word is not None:
                progress(done, items)
    finally:
        interrupted.set()
        for thread in threads:
            if thread.ident is not None:
                thread.join()


@contextmanager
def _interrupt_noted() -> Iterator[Callable[[], None]]:
    """Ctrl-C is noted, and raised between looks at the threads; so is SIGTERM, if it is heard.

    Raised at once it could strike where Python swallows it, such as in a weak reference's callback
    inside the thread pool, and the work would go on.
    """
    if threading.current_thread() is not threading.main_thread():
        yield keep_on  # a chunk of another run
        return
    noted: list[int] = []
    before: dict[int, Any] = {signal.SIGINT: signal.getsignal(signal.SIGINT)}
    if callable(term := signal.getsignal(signal.SIGTERM)):
        before[signal.SIGTERM] = term

    def check() -> None:
        if noted:
            if noted[0] == signal.SIGTERM:
                before[signal.SIGTERM](noted[0], None)
            raise KeyboardInterrupt

    for number in before:
        signal.signal(number, lambda number, frame: noted.append(number))
    try:
        yield check
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    check()


def usable_cores() -> int:
    """Cores this process may run on."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
