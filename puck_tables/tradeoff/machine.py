"""The machine a measurement was made on: what it is, and the peaks that bound any loop."""

from __future__ import annotations

import os
import platform
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._version import __version__
from puck_tables.kernels.compile import kernel, patience

_WORKING_SET = 1 << 14  # doubles: 128 kB, what tables and blocks of the look-ups are held in
_ROUNDS = 400  # of the loop that is timed
HARD = 8.0  # adds or products that a division or a root counts for


@dataclass(frozen=True)
class Machine:
    """Words about the machine, and its peaks on one thread as compiled loops reach them.

    ``flops``: adds and products a second; ``bandwidth``: bytes a second, read from and written to a
    working set of 128 kB.
    """

    description: dict[str, str]
    flops: float
    bandwidth: float

    def limit(self, work: float, traffic: float) -> tuple[float, str]:
        """The least time in ns of so many flops and bytes, and what bounds it.

        Examples
        --------
        >>> Machine({}, flops=1e9, bandwidth=1e9).limit(work=3.0, traffic=1.0)
        (3.0, 'arithmetic')
        """
        if work == 0.0:
            return 0.0, ""
        arithmetic, memory = 1e9 * work / self.flops, 1e9 * traffic / self.bandwidth
        return max(arithmetic, memory), "arithmetic" if arithmetic >= memory else "memory"


@kernel
def _polynomials(x: FloatArray, out: FloatArray) -> None:
    """Degree 32 in Horner's scheme: 64 flops for two memory accesses."""
    patience(x.size)
    for i in range(x.size):
        t, total = x[i], 0.5
        for _ in range(32):
            total = total * t + 0.25
        out[i] = total


@kernel
def _triad(x: FloatArray, y: FloatArray, out: FloatArray) -> None:
    patience(x.size)
    for i in range(x.size):
        out[i] = x[i] + 0.5 * y[i]


def measured_machine() -> Machine:
    """Describe this machine and measure its peaks; a tenth of a second.

    Examples
    --------
    >>> measured_machine().flops > 1e8
    True
    """
    short = np.linspace(0.0, 0.5, 1024)
    x, y, out = (np.zeros(_WORKING_SET // 4) for _ in range(3))
    flops = 64 * short.size / _best(lambda: _polynomials(short, short.copy()))
    bandwidth = 24 * x.size / _best(lambda: _triad(x, y, out))
    return Machine(describe(), flops, bandwidth)


def _best(function: Callable[[], object]) -> float:
    function()
    times = []
    for _ in range(_ROUNDS):
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return min(times)


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
