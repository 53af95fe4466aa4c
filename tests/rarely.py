"""Cases of which every run takes a few, and the nightly run all."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def few(count: int, cases: Iterable[Any]) -> list[Any]:
    """The first ``count`` cases as they are, the others for the nightly run."""
    found = list(cases)
    late = [
        pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.nightly)
        for case in found[count:]
    ]
    return found[:count] + late
