"""How much memory is free."""

from __future__ import annotations

import math
import os

from puck_tables.errors import InputError

_ON_DISK = "use smaller counts, or a Zarr store (-o NAME.zarr, store=), which grows on disk"


def check_memory(
    shape: tuple[int, ...], per_item: int, advice: str = _ON_DISK, what: str = ""
) -> None:
    """Refuse a map that would not fit in memory, before anything is allocated.

    ``shape``: the sizes of the ranges; ``per_item``: bytes needed for each launch; ``advice``: what
    to do instead; ``what``: that is to be kept, if it is no map of launches.
    """
    needed = float(per_item) * math.prod(shape)
    available = _memory()
    if needed > available:
        what = what or f"a map of {' x '.join(str(n) for n in shape)} launches"
        raise InputError(
            f"{what} would need {needed / 2**30:,.1f} GiB of memory, "
            f"{available / 2**30:,.1f} GiB are free: {advice}"
        )


def _memory() -> float:
    """Free memory in bytes where the system tells it, else 4 GiB."""
    try:
        with open("/proc/meminfo") as file:
            for line in file:
                if line.startswith("MemAvailable"):
                    return 1024.0 * float(line.split()[1])
        return float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, AttributeError):
        return 4.0 * 2**30
