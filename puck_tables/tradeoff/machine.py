"""The machine a measurement was made on, in words."""

from __future__ import annotations

import os
import platform
from importlib.metadata import version

from puck_tables._version import __version__


def describe() -> dict[str, str]:
    """Processor, system and versions.

    Examples
    --------
    >>> sorted(describe())[:3]
    ['cores', 'load', 'numba']
    """
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    load = f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"
    return {
        "processor": _processor(),
        "cores": str(cores),
        "load": f"{load} at the start",
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "numpy": version("numpy"),
        "numba": version("numba"),
        "scipy": version("scipy"),
        "puck-tables": __version__,
    }


def _processor() -> str:
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            for line in file:
                if line.startswith("model name"):
                    return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()
