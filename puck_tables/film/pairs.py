"""Tracks that keep their distance: two marks on one puck that were taken for two pucks."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from puck_tables.film.puck_track import Track

_KEPT = 0.05  # of their distance, by which it varies
_MOVED = 2.0  # times their distance: how far they go
_FEWEST, _MOST = 8, 30  # frames; tracks that are compared


def marks_of_one(tracks: Sequence[Track], nearest: float = np.inf) -> str:
    """A sentence if two tracks look like marks on one puck; empty if none do.

    ``nearest`` m: as far apart as two pucks are at least.

    Examples
    --------
    >>> t = np.arange(20.0)
    >>> one, two = (Track(t, np.stack([t, 0.0 * t + y], axis=1), name=f"a: {y}") for y in (0, 1))
    >>> marks_of_one([one, two])[:66]
    'a: 0 and a: 1 keep a distance of 1 m: they look like two marks on '
    """
    for one, two in combinations(tracks[:_MOST], 2):
        _, first, second = np.intersect1d(one.time, two.time, return_indices=True)
        here, there = one.place[first], two.place[second]
        apart = np.hypot(*(here - there).T)
        known = np.isfinite(apart)
        if known.sum() < _FEWEST:
            continue
        usual = float(np.median(apart[known]))
        kept = float(np.median(np.abs(apart[known] - usual))) <= _KEPT * usual
        moved = float(np.ptp(here[known], axis=0).max()) > _MOVED * usual
        if kept and moved and 0.0 < usual < nearest:
            names = [track.name.rpartition(": ")[2] for track in (one, two)]
            return (
                f"{one.name} and {two.name} keep a distance of {usual:.3g} m: they look like two "
                f"marks on one puck, whose centre and angle they tell with centre and toward "
                f"(--centre {','.join(names)} --toward {names[0]})"
            )
    return ""
