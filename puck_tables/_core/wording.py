"""What messages and reports say alike: how many there are, and what a name may have meant."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches


def counted(count: int, one: str, many: str = "") -> str:
    """A number of things in words.

    >>> counted(1, "edge"), counted(12000, "edge"), counted(2, "launch", "launches")
    ('1 edge', '12000 edges', '2 launches')
    """
    return f"{count} {one if count == 1 else many or one + 's'}"


def meant(name: object, known: Iterable[str], alike: float = 0.6) -> str:
    """What a misspelt name may have meant, in words; ``alike``: the share of signs that must be.

    >>> meant("airhockey", ["air-hockey", "carrom"]), meant("chess", ["carrom"])
    (" (did you mean 'air-hockey'?)", '')
    """
    near = get_close_matches(str(name), [*known], 1, alike)
    return f" (did you mean {near[0]!r}?)" if near else ""
