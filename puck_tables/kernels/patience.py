"""How long kernels run as they are written, in Python, before they are compiled.

To compile what moves one puck takes longer than to move it.  So a kernel that is called from Python
runs as it is written until a second of computing is spent on it, or many items come; then it goes
on compiled, from the arguments as they were.  Loops look at the clock by a call of
:func:`patience`, of which nothing is left in compiled code.  What takes so long to compile that it
may run longer says so.
"""

from __future__ import annotations

import contextlib
import math
import os
import threading
import time
from collections.abc import Iterator

from puck_tables._core.own_folder import say

AT_FIRST = 1.5  # s of computing of each kernel
FEW = 64  # items; more are compiled for at once
A_MOTION = 4  # items: an integrated motion takes so much longer than a look-up


class OutOfPatience(BaseException):
    """What runs as it is written is to go on compiled."""


class _Thread(threading.local):
    """What holds in a thread: whether a kernel runs as it is written, and until when."""

    as_written = False
    until = math.inf
    silent_until = math.inf  # at most until then, and then it says
    sentence = ""
    at_once = os.environ.get("NUMBA_DISABLE_JIT") == "0"  # whether to compile without a try
    kept_first = True  # whether what was compiled before is quicker than a try


here = _Thread()


def patience(items: int) -> None:
    """Look at the clock, with so many items of work ahead; compiled code does not.

    Raises OutOfPatience where a kernel runs as it is written, and too long.

    >>> patience(1000)  # no kernel runs
    """
    if here.as_written and (items > FEW or time.thread_time() > here.silent_until):
        if items > FEW or here.silent_until >= here.until:
            raise OutOfPatience
        here.silent_until = here.until
        say(here.sentence)


@contextlib.contextmanager
def compiled_at_once() -> Iterator[None]:
    """Compile what this thread calls within, for what is measured or called often.

    >>> with compiled_at_once():
    ...     here.at_once
    True
    """
    before, here.at_once = here.at_once, True
    try:
        yield
    finally:
        here.at_once = before


@contextlib.contextmanager
def one_question() -> Iterator[None]:
    """Answer one question and end: what was compiled before is not loaded before it is needed.

    >>> with one_question():
    ...     here.kept_first
    False
    """
    before, here.kept_first = here.kept_first, False
    try:
        yield
    finally:
        here.kept_first = before
