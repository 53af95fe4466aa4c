from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from puck_tables import Table, build_table, load_table

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def table() -> Table:
    """The default table."""
    return load_table()


@pytest.fixture(scope="session")
def rough_table() -> Table:
    """A small table, not saved."""
    return build_table(accuracy=1e-6)


settings.register_profile("default", max_examples=60, deadline=None, derandomize=True)
settings.register_profile(
    "nightly", max_examples=1700, deadline=None, suppress_health_check=list(HealthCheck)
)
settings.load_profile("default")
