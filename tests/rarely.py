"""Cases of which every run takes a few, and the nightly run all."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def thorough(*case: Any) -> Any:
    return pytest.param(*case, marks=pytest.mark.thorough)


def nightly(*case: Any) -> Any:
    return pytest.param(*case, marks=pytest.mark.nightly)


def few(count: int, cases: Iterable[Any]) -> list[Any]:
    """The first ``count`` cases for every run, the others for the nightly; tuples are spread."""
    return [
        pytest.param(
            *(case if isinstance(case, tuple) else (case,)),
            marks=[pytest.mark.nightly] if n >= count else [],
        )
        for n, case in enumerate(cases)
    ]
