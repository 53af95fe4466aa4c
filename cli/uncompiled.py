"""Short work runs as it is written, in Python: it is done before a compiler would be.

To compile a scene takes half a minute, once; to run one without takes a second or two, mostly.
What takes longer begins anew, compiled.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from collections.abc import Iterator

from puck_tables.cli import start

from puck_tables.errors import PuckError

AT_FIRST = 1.0  # s of computing, with patience

# modules that run a motion: their kernel that takes longest to compile, and how much longer to
# wait, in s, where it was not compiled before
_KERNELS = {
    "puck_tables.world.world": ("world-", 10.0),
    "puck_tables.scene.loop": ("scene-loop-follow-", 7.0),
}
_OTHERS = ("motion-path-integrate-", 3.0)

_SWITCH = "NUMBA_DISABLE_JIT"


@contextlib.contextmanager
def uncompiled() -> Iterator[None]:
    """Compute within, and write nothing: kernels run as they are written while patience lasts.

    A process that is not the command's own, or whose user set the switch, is left as it is.
    """
    if not start.alone or _SWITCH in os.environ or not hasattr(signal, "setitimer"):
        yield
        return
    os.environ[_SWITCH] = "1"
    import numpy as np

    from puck_tables.kernels.as_written import before_long_work

    np.seterr(all="ignore")  # as in compiled code
    before_long_work.append(_begin_compiled)
    signal.signal(signal.SIGPROF, _impatient)
    signal.setitimer(signal.ITIMER_PROF, AT_FIRST)
    try:
        yield
    # where compiled code has inf or NaN; a broken power of a negative number is complex here
    except (ArithmeticError, ValueError, TypeError) as error:
        if isinstance(error, PuckError):
            raise
        _begin_compiled()
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        before_long_work.clear()


def several_pucks() -> None:
    """Say that a board is to run: what is compiled already is quicker than the first second."""
    if signal.getsignal(signal.SIGPROF) is _impatient and _kept(
        _KERNELS["puck_tables.world.world"][0]
    ):
        _begin_compiled()


def _kept(kernel: str) -> bool:
    """Whether compiled code of a kernel is kept."""
    from puck_tables.kernels.cache import cache_folder

    folder = cache_folder()
    return folder is not None and any(folder.glob(f"puck_tables-{kernel}*.code"))


def _impatient(*_: object) -> None:
    """Go on for a while, if compiling would take longer."""
    kernel, wait = next((_KERNELS[name] for name in _KERNELS if name in sys.modules), _OTHERS)
    if _kept(kernel):
        _begin_compiled()
    signal.signal(signal.SIGPROF, _begin_compiled)
    signal.setitimer(signal.ITIMER_PROF, wait)


def _begin_compiled(*_: object) -> None:
    """Begin this command anew, compiled."""
    signal.setitimer(signal.ITIMER_PROF, 0.0)  # it would go on
    os.environ[_SWITCH] = "0"
    os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])
