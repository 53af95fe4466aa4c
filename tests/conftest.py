from __future__ import annotations

import gc
import math
import os
import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, settings
from paper.claim import Claim
from paper.claims import all_claims

from puck_tables import Table
from puck_tables.kernels.patience import here

QUARTER, HALF = 0.25 * math.pi, 0.5 * math.pi
ROOT = Path(__file__).resolve().parent.parent
# of workers, one a core: decompositions by several threads each take up to thirty times as long
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


type(here).at_once = True  # tests ask often; kernels as they are written have tests of their own

COMPILES = "test_scene_entries.py"


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """One worker compiles scenes and boards first, while the others do what needs none of them.

    Else each would compile the same for a minute.
    """
    ranks: dict[Path, int] = {}

    def rank(item: pytest.Item) -> int:
        path = item.path
        if path not in ranks:
            scenes = re.search("scene|world|reference|aim|compare", path.read_text("utf-8").lower())
            ranks[path] = 0 if path.name == COMPILES else 1 + bool(scenes)
        return ranks[path]

    items.sort(key=rank)


def pytest_collection_finish() -> None:
    """What is collected stays; to look for garbage among it takes a fifth of the time of tests."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)


@pytest.fixture(scope="session")
def table() -> Table:
    """The default table."""
    return Table.shipped()


@pytest.fixture(scope="session")
def rough_table() -> Table:
    """A small table, not saved."""
    return Table.build(accuracy=1e-6)


def near(point: float) -> np.ndarray:
    """Doubles on both sides of a point, ever closer, inside [0, π/2]."""
    gap = 10.0 ** -np.linspace(0.5, 16.0, 63)
    around = np.concatenate([point - gap, [np.nextafter(point, -1.0), point], point + gap])
    return around[(around >= 0.0) & (around <= HALF)]


@pytest.fixture(scope="session")
def corners() -> np.ndarray:
    """Angles where double precision is hardest, both signs."""
    tiny = [5e-324, 2.2e-308, 1e-300, 1e-155, 1e-100, 1e-30]
    phi = np.concatenate([tiny, near(0.0), near(QUARTER), near(HALF)])
    return np.concatenate([phi, -phi])


@pytest.fixture(scope="session")
def subjects() -> dict[str, list[Claim]]:
    """The paper's claims, computed once, by subject."""
    return all_claims()


@pytest.fixture(scope="session")
def claims(subjects: dict[str, list[Claim]]) -> list[Claim]:
    return [claim for group in subjects.values() for claim in group]


@pytest.fixture(scope="session")
def scattered() -> np.ndarray:
    return np.random.default_rng(46).uniform(-HALF, HALF, 2000)


settings.register_profile("default", max_examples=60, deadline=None, derandomize=True)
settings.register_profile(
    "nightly", max_examples=1700, deadline=None, suppress_health_check=list(HealthCheck)
)
settings.load_profile("default")
