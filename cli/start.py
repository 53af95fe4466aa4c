"""Where the command ``puck`` begins: Ctrl-C ends it within a second, with a sentence, at any time.

Until a command runs, and when it has run, there is nothing to clean up: it ends at once.  In
between Python raises KeyboardInterrupt, but only when compiled code or a compiler gives it the
chance; for those that do not there is a thread that hears of the signal by itself.  What is on disk
is whole at every moment, so nothing is lost by it.
"""

from __future__ import annotations

import os
import signal
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # the less is imported before the handler stands, the better
    from collections.abc import Callable
    from sys import UnraisableHookArgs
    from types import FrameType

INTERRUPTED = 130
PATIENCE = 0.7  # s

# what is said on Ctrl-C, by the last of them; a command may have better ones
last_words: list[Callable[[], str]] = [lambda: "Interrupted: nothing more was written."]


def end_at_once(number: int, frame: FrameType | None) -> None:
    """What Ctrl-C does while nothing runs yet, or any more."""
    os.write(2, f"{last_words[-1]()}\n".encode())
    os._exit(INTERRUPTED)


def interrupt(number: int, frame: FrameType | None) -> None:
    """What Ctrl-C does while a command runs: numba, half imported, would tell of it as a fault."""
    if getattr(getattr(sys.modules.get("numba"), "__spec__", None), "_initializing", False):
        end_at_once(number, frame)
    signal.default_int_handler(number, frame)


def _watch() -> None:
    """End the process some time after Ctrl-C, unless it has ended by then."""
    import socket
    import threading
    import time

    hears, tells = socket.socketpair()
    tells.setblocking(False)

    def wait() -> None:
        while tells.fileno() >= 0 and (heard := hears.recv(1)):
            if heard[0] == signal.SIGINT:
                time.sleep(PATIENCE)
                end_at_once(signal.SIGINT, None)

    signal.set_wakeup_fd(tells.fileno(), warn_on_full_buffer=False)
    threading.Thread(target=wait, daemon=True).start()


def _ignored(what: UnraisableHookArgs) -> None:
    """A compiler may drop KeyboardInterrupt in a place that Python then talks about."""
    if not issubclass(what.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(what)


def main() -> None:
    """Import the commands and run one."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # unless it is ignored
        signal.signal(signal.SIGINT, end_at_once)
        sys.unraisablehook = _ignored
        _watch()
    from puck_tables.cli.main import main as command

    try:
        command()
    except SystemExit as end:
        if end.code == INTERRUPTED:  # all is said; libraries might tell what they left undone
            os._exit(INTERRUPTED)
        raise


if __name__ == "__main__":
    main()
