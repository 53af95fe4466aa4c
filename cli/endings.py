"""What the command ``puck`` does when Ctrl-C or SIGTERM ends it, and what it says then."""

from __future__ import annotations

import os
import signal
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # the less is imported before the handler stands, the better
    from collections.abc import Callable
    from types import FrameType

ENDINGS = {signal.SIGINT: signal.default_int_handler, signal.SIGTERM: signal.SIG_DFL}

received = signal.SIGINT  # the signal that ends it

# what is said then, by the last of them; a command may have better ones
last_words: list[Callable[[], str]] = [lambda: "Interrupted: nothing more was written."]


def end_at_once(number: int, frame: FrameType | None) -> None:
    """What Ctrl-C does while nothing runs yet, or any more."""
    os.write(2, f"{last_words[-1]()}\n".encode())
    if parts := sys.modules.get("puck_tables._core.partial_files"):
        parts.remove_own()
    os._exit(128 + number)  # as shells count


def interrupt(number: int, frame: FrameType | None) -> None:
    """What Ctrl-C does while a command runs: numba, half imported, would tell of it as a fault."""
    if getattr(getattr(sys.modules.get("numba"), "__spec__", None), "_initializing", False):
        end_at_once(number, frame)
    global received
    received = signal.Signals(number)
    signal.default_int_handler(number, frame)
