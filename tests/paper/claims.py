"""All claims of the paper, subject by subject."""

from __future__ import annotations

from collections.abc import Callable

from paper import ends, friction, motions, patch, shapes
from paper.claim import Claim

SUBJECTS: dict[str, Callable[[], list[Claim]]] = {
    "The contact patch": patch.claims, "Friction and the slip angle": friction.claims,
    "Motions": motions.claims, "At the stop, and far back in time": ends.claims,
    "Paths": shapes.claims,
}  # fmt: skip


def all_claims() -> dict[str, list[Claim]]:
    """Every claim of the paper that a number can decide, by subject."""
    return {name: subject() for name, subject in SUBJECTS.items()}
