from __future__ import annotations

from pathlib import Path

import pytest

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
