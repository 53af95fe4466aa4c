"""What a worker of a cluster of one's own loads first.

A terminal sends Ctrl-C to all processes: the client answers it, and workers end with the client.
"""

from __future__ import annotations

import signal
from typing import Any


def dask_setup(worker: Any) -> None:
    """Leave Ctrl-C to the client; Dask calls this by its name."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
