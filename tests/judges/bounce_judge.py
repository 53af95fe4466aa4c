"""A smooth puck without spin among straight pieces: rays, offset lines and circles.

It slides straight, and stops after v²/2J; where its rim meets a piece the part of its velocity
along the normal is turned and scaled by e.  What it meets is the first of two lines, one on each
side of the piece at a distance of its radius, and two circles about the ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np


@dataclass
class Bounces:
    """Where its rim met which piece, and where it stopped."""

    hits: list[tuple[int, np.ndarray]] = field(default_factory=list)
    stop: np.ndarray | None = None


def nearest(a: np.ndarray, b: np.ndarray, p: np.ndarray) -> np.ndarray:
    """The place of the piece ab next to p."""
    share = float((p - a) @ (b - a)) / float((b - a) @ (b - a))
    return a + min(max(share, 0.0), 1.0) * (b - a)


def _along_ray(
    p: np.ndarray, d: np.ndarray, a: np.ndarray, b: np.ndarray, radius: float
) -> tuple[float, np.ndarray]:
    """How far to the first touch of the piece ab, and the place of it that is touched."""
    best, where = math.inf, p
    way = (b - a) / np.linalg.norm(b - a)
    normal = np.array([-way[1], way[0]])
    normal = normal if normal @ (p - a) > 0.0 else -normal
    closes = -(normal @ d)
    if closes > 0.0:
        far = (normal @ (p - a) - radius) / closes
        foot = way @ (p + far * d - a)
        if far > -1e-9 and 0.0 <= foot <= np.linalg.norm(b - a):
            best, where = far, a + foot * way
    for end in (a, b):
        off = p - end
        along, rest = off @ d, off @ off - radius**2
        root = along**2 - rest
        if along < 0.0 < root:
            far = rest / (-along + math.sqrt(root))
            if -1e-9 < far < best:
                best, where = far, end
    return best, where


def play(
    place: np.ndarray, velocity: np.ndarray, radius: float, decel: float,
    pieces: list[tuple[np.ndarray, np.ndarray, float]], most: int = 10**4,
) -> Bounces:  # fmt: skip
    """Follow it to its stop, or through so many impacts; pieces: start, end and e."""
    told, p, v = Bounces(), np.array(place, float), np.array(velocity, float)
    while len(told.hits) < most:
        speed = float(np.linalg.norm(v))
        d, left = v / speed, speed**2 / (2.0 * decel)
        found = [_along_ray(p, d, a, b, radius) for a, b, _ in pieces]
        which = int(np.argmin([far for far, _ in found]))
        far, where = found[which]
        if far >= left:
            told.stop = p + left * d
            return told
        p = p + far * d
        v = math.sqrt(max(speed**2 - 2.0 * decel * far, 0.0)) * d
        normal = (where - p) / np.linalg.norm(where - p)
        v = v - (1.0 + pieces[which][2]) * (v @ normal) * normal
        told.hits.append((which, where))
    return told
