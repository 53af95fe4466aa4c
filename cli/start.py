"""Where the command ``puck`` begins: Ctrl-C ends it within a second, with a sentence, at any time.

So does SIGTERM, which batch systems and containers send.

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

from puck_tables.cli.endings import ENDINGS, end_at_once

if TYPE_CHECKING:  # the less is imported before the handler stands, the better
    from sys import UnraisableHookArgs

PATIENCE = 0.7  # s after a signal: then it is ended at once, whatever it does


def _watch() -> None:
    """End the process some time after Ctrl-C, unless it has ended by then."""
    import socket
    import threading
    import time

    hears, tells = socket.socketpair()
    tells.setblocking(False)

    def wait() -> None:
        while tells.fileno() >= 0 and (heard := hears.recv(1)):
            if heard[0] in ENDINGS:
                time.sleep(PATIENCE)
                end_at_once(heard[0], None)

    signal.set_wakeup_fd(tells.fileno(), warn_on_full_buffer=False)
    threading.Thread(target=wait, daemon=True).start()


def _ignored(what: UnraisableHookArgs) -> None:
    """A compiler may drop KeyboardInterrupt in a place that Python then talks about."""
    if not issubclass(what.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(what)


def main() -> None:
    """Import the commands and run one."""
    ours = [one for one, usual in ENDINGS.items() if signal.getsignal(one) is usual]
    for one in ours:  # unless they are ignored
        signal.signal(one, end_at_once)
    if ours:
        sys.unraisablehook = _ignored
        _watch()
    from puck_tables.cli.main import main as command

    try:
        command()
    except SystemExit as end:
        if end.code in [128 + one for one in ENDINGS]:  # all is said; libraries might tell what
            os._exit(end.code)  # they left undone
        raise


if __name__ == "__main__":
    main()
