"""What the benchmarks share: measuring per item, and a summary with ratios and errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest


@dataclass(frozen=True)
class Entry:
    """One measured line: seconds for each item (best round), and its error."""

    group: str
    name: str
    unit: str
    seconds: float
    error: float | None


ENTRIES = pytest.StashKey[list[Entry]]()


class Measure:
    """Runs a function under pytest-benchmark and books time per item and error."""

    def __init__(self, benchmark: Any, entries: list[Entry]) -> None:
        self.benchmark = benchmark
        self.entries = entries

    def __call__(
        self, name: str, function: Callable[[], Any], *, items: int = 1, unit: str,
        error: float | None = None,
    ) -> None:  # fmt: skip
        function()  # compiled and warm before the clock starts
        self.benchmark(function)
        self.book(name, items, unit, error)

    def book(self, name: str, items: int, unit: str, error: float | None = None) -> None:
        """Note what ``benchmark`` has just measured."""
        if error is not None:
            self.benchmark.extra_info["error"] = float(error)
        if self.benchmark.stats is None:  # --benchmark-disable
            return
        seconds = self.benchmark.stats.stats.min / items  # noise only ever adds
        if unit == "point":
            self.benchmark.extra_info["ns_per_point"] = 1e9 * seconds
        elif unit == "trajectory":
            self.benchmark.extra_info["trajectories_per_second"] = 1.0 / seconds
        else:
            self.benchmark.extra_info[f"seconds_per_{unit}"] = seconds
        self.entries.append(Entry(self.benchmark.group, name, unit, seconds, error))


@pytest.fixture
def measure(benchmark: Any, request: pytest.FixtureRequest) -> Measure:
    return Measure(benchmark, request.config.stash.setdefault(ENTRIES, []))


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20120601)


def pytest_terminal_summary(terminalreporter: Any, config: pytest.Config) -> None:
    """The summary: the ratio is to the first line of the group."""
    entries = config.stash.get(ENTRIES, [])
    for group in dict.fromkeys(entry.group for entry in entries):
        lines = [entry for entry in entries if entry.group == group]
        terminalreporter.write_sep("-", group)
        for entry in lines:
            error = "" if entry.error is None else f"   error {entry.error:.1e}"
            terminalreporter.write_line(
                f"{entry.name:<52} {_time(entry.seconds):>9} a {entry.unit}"
                f" {entry.seconds / lines[0].seconds:9.3g} x{error}"
            )


def _time(seconds: float) -> str:
    for scale, name in ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if seconds >= scale:
            return f"{seconds / scale:.3g} {name}"
    return f"{seconds * 1e9:.3g} ns"
