"""A thousand random scenes: an end with a name, finite states, a ledger that closes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from random_scenes import draw
from scenes import simulate_scene

from puck_tables.scene.run import ENDS


def _closes(seeds: range, folder: Path) -> set[str]:
    seen = set()
    for seed in seeds:
        run = simulate_scene(draw(seed, folder))
        assert run.end in (*ENDS[:5], "tipped over"), seed
        assert run.energy_residual <= 1e-8, (seed, run.energy_residual)
        for name, column in run.columns.items():
            assert np.isfinite(column).all(), (seed, name)
        times = [event[0] for event in run.events]
        assert times == sorted(times), seed
        assert all(0.0 <= t <= run.end_time for t in times), seed
        assert np.all(np.diff(run.columns["heat_dry"]) >= -1e-12 * run.columns["heat_dry"][-1])
        seen |= {run.end, *(event[1] for event in run.events)}
    return seen


@pytest.mark.thorough
def test_the_ledger_closes(tmp_path: Path) -> None:
    seen = _closes([*range(200), 469, 669, 633], tmp_path)  # over edges; twice to a dead cushion
    assert seen >= {
        "at rest", "time is up", "over the edge", "tipped over",
        "stick", "slip", "impact", "contact", "entry", "exit", "edge", "overhang",
    }  # fmt: skip


@pytest.mark.nightly
def test_the_ledger_closes_for_many(tmp_path: Path) -> None:
    _closes(range(200, 1200), tmp_path)
