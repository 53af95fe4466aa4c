"""CONTRIBUTING's recipe for a kind of table: one class and one line, and everything serves it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import KW_ONLY, dataclass, replace
from functools import partial
from typing import Any, ClassVar

import numpy as np
import pytest
from commands import invoke

from puck_tables import SpeedLaw, Table
from puck_tables._core import lazy
from puck_tables.io.columns import Variable
from puck_tables.table.build import Goal, built
from puck_tables.table.check import Accuracy, CheckReport, Route, judged
from puck_tables.table.table_store import fetch


@dataclass(frozen=True, eq=False, repr=False)
class WaveTable(Table):
    """sin(pitch φ), straight between nodes."""

    _: KW_ONLY
    pitch: float
    law: SpeedLaw  # of no use: any field is kept

    kind = "waves"
    algorithm = "numpy; 1"
    functions: ClassVar[dict[str, str]] = {"wave": "sin(pitch phi)"}
    quantities = ("wave",)
    second = "nothing"
    words: ClassVar[dict[str, str]] = {"title": "Waves", "interpretation": "a toy", "method": "sin"}

    grid = property(lambda self: f"{len(self.values)} nodes")
    valid_range = "0 <= phi <= 1"
    axes = property(
        lambda self: {"phi": Variable(np.linspace(0, 1, len(self.values)), ("phi",), "rad", "φ")}
    )

    @classmethod
    def is_of(cls, of: object) -> bool:
        return isinstance(of, complex)

    @classmethod
    def built(cls, of: complex, accuracy: float | None = None, **how: Any) -> WaveTable:
        law = SpeedLaw([0.0, of.imag], [0.2, 0.3])

        def at(cells: int) -> WaveTable:
            nodes = np.sin(of.real * np.linspace(0.0, 1.0, cells + 1))
            return cls(nodes[:, None], pitch=of.real, law=law)

        return built(at, cls.measured, Goal(1e-4, 1e-9, "of a wave", 1.0, 1 << 16), accuracy, None)

    def off(self, phi: np.ndarray, second: np.ndarray) -> np.ndarray:
        nodes = self.axes["phi"].values
        return np.interp(phi, nodes, self.values[:, 0])[None] - np.sin(self.pitch * phi)

    def measured(self) -> Accuracy:
        phi = np.linspace(0.0, 1.0, 1001)
        return Accuracy.of(np.abs(self.off(phi, phi)), phi, 0.0 * phi, None)

    def validate(self, progress: Any = None, points: int = 2000) -> CheckReport:
        phi = np.random.default_rng().random(points)
        routes = [Route("numpy", self.quantities, phi, phi, self.off, self.tolerance)]
        return judged(self.source, self.tolerance, routes, progress)


@pytest.fixture(autouse=True)
def told(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The one line."""
    monkeypatch.setitem(lazy._ABOVE, "table of waves", "test_new_kind:WaveTable")
    yield


@pytest.mark.parametrize("seed", range(3))
def test_a_new_kind_is_built_saved_loaded_told_judged_and_kept(seed, tmp_path, monkeypatch):
    rng = np.random.default_rng(seed)
    pitch, top = rng.uniform(1.0, 5.0), rng.uniform(0.1, 9.0)
    table = Table.build(complex(pitch, top), 1e-5)
    assert isinstance(table, WaveTable)
    path = tmp_path / "waves.h5"
    table.save(path)
    loaded = Table.load(path)
    assert isinstance(loaded, WaveTable)
    assert (loaded.pitch, loaded.law) == (pitch, table.law)
    np.testing.assert_array_equal(loaded.values, table.values)
    told = invoke("info", path)
    assert "holds       waves (wave); uniform pressure" in told.stdout
    assert invoke("validate", path).exit_code == 0
    bent = table.values.copy()
    bent[rng.integers(1, len(bent) - 1, 9)] += 1e-4
    replace(table, values=bent).save(path, overwrite=True)
    assert invoke("validate", path).exit_code == 3

    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    builds: list[float] = []

    def build(pitch: float) -> WaveTable:
        builds.append(pitch)
        return WaveTable.build(complex(pitch, top), 1e-4)

    for asked in (pitch, pitch, 2.0 * pitch):
        kept = fetch("wave", {"pitch": asked}, partial(build, asked))
        assert kept.pitch == asked
    assert builds == [pitch, 2.0 * pitch]
    assert invoke("tables").stdout.count("waves") == 2
