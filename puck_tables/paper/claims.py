"""All claims of the paper, subject by subject."""

from __future__ import annotations

from collections.abc import Callable

from puck_tables.paper import ends, friction, motions, patch, shapes
from puck_tables.paper.claim import Claim

Progress = Callable[[int, int], None]

SUBJECTS: dict[str, Callable[[], list[Claim]]] = {
    "The contact patch": patch.claims,
    "Friction and the slip angle": friction.claims,
    "Motions": motions.claims,
    "At the stop, and far back in time": ends.claims,
    "Paths": shapes.claims,
}


def all_claims(progress: Progress | None = None) -> dict[str, list[Claim]]:
    """Every claim of the paper that a number can decide, by subject.

    Parameters
    ----------
    progress : callable (done, total), optional

    Returns
    -------
    dict of lists of Claim

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012.

    Examples
    --------
    >>> found = all_claims()
    >>> [claim.where for group in found.values() for claim in group if claim.erratum]
    ['eq. 5.3', 'section 8', 'Cor. 11', 'Cor. 12']
    """
    found = {}
    for done, (name, subject) in enumerate(SUBJECTS.items(), start=1):
        found[name] = subject()
        if progress is not None:
            progress(done, len(SUBJECTS))
    return found
