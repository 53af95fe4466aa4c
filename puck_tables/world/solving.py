"""Launches after which a puck stops at a place: Newton's method on each impact sequence."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.world.engine_state import Whole
from puck_tables.world.shots import Landings, Shots, TriedLaunches

Which = np.ndarray

_STEP = 1e-7  # of a difference, of the range of the heading or the speed
_NEAR = 2.0  # steps of the sample that a start may be from what it leads to
_INSIDE = 1.2  # half steps, of a cell of one sequence
_MOST_STARTS = 2000  # of Newton's method, those that end nearest to the place
_ITERATIONS, _HALVINGS = 30, 8  # of Newton's method; of one of its steps
_SAME = 1e-6  # of the ranges: launches closer than this are one
HEADINGS = 2.0 * math.pi  # rad: their range


class Roots(NamedTuple):
    """Launches (n, 2), where they land, and how far from the target (n,) m."""

    launches: FloatArray
    landings: Landings
    misses: FloatArray


def stops_at(
    shots: Shots, sample: TriedLaunches, fine: Which, target: tuple[float, float], close: float,
    low: float, high: float,
) -> Roots:  # fmt: skip
    """All launches found that end at a target to ``close`` m.

    ``fine``: the launches of the sample whose sequences count.  ``low``, ``high``: between which
    the speed (or spin) may be.
    """
    place = np.array(target)
    inside = _in_cells(sample, fine, place)
    others = _clear_of(shots, sample, fine, place, low, high)
    starts = np.vstack([inside, others])
    starts[:, 1] = np.clip(starts[:, 1], low, high)
    landings = shots.land(starts)
    return _merged(_newton(shots, starts, landings, place, close, low, high), high - low)


def _grid(sample: TriedLaunches) -> tuple[Whole, FloatArray]:
    """Launches whose heading all rows have, (rows, headings), and these headings."""
    rows = int(sample.rows[-1]) + 1
    values, counts = np.unique(sample.launches[:, 0], return_counts=True)
    common = values[counts == rows]
    kept = np.flatnonzero(np.isin(sample.launches[:, 0], common))
    return kept.reshape(rows, -1), common


def _in_cells(sample: TriedLaunches, fine: Which, place: FloatArray) -> FloatArray:
    """Starts in cells of four launches of one sequence whose ends surround the target."""
    grid, _ = _grid(sample)
    if grid.shape[0] < 2 or grid.shape[1] < 3:
        return np.empty((0, 2))
    right = np.roll(grid, -1, axis=1)
    corners = np.stack([grid[:-1], right[:-1], grid[1:], right[1:]], axis=-1).reshape(-1, 4)
    prints = sample.landings.prints[corners]
    one = (prints == prints[:, :1]).all(axis=1) & fine[corners].all(axis=1)
    corners = corners[one]
    ends = np.stack([sample.landings.x[corners], sample.landings.y[corners]], axis=2)
    launches = sample.launches[corners]
    wide = (launches[:, 1, 0] - launches[:, 0, 0]) % HEADINGS
    high = launches[:, 2, 1] - launches[:, 0, 1]
    slopes = np.empty((len(corners), 2, 2))
    slopes[:, :, 0] = 0.5 * (ends[:, 1] + ends[:, 3] - ends[:, 0] - ends[:, 2])
    slopes[:, :, 1] = 0.5 * (ends[:, 2] + ends[:, 3] - ends[:, 0] - ends[:, 1])
    steps, known = _solved(slopes, place - ends.mean(axis=1))
    near = known & (np.abs(steps) <= _INSIDE).all(axis=1)
    steps = np.clip(steps[near], -0.5, 0.5) + 0.5
    return np.stack(
        [launches[near, 0, 0] + steps[:, 0] * wide[near],
         launches[near, 0, 1] + steps[:, 1] * high[near]], axis=1,
    )  # fmt: skip


def _clear_of(
    shots: Shots, sample: TriedLaunches, fine: Which, place: FloatArray, low: float, high: float
) -> FloatArray:
    """Starts where sequences change, or close to it, by the slopes at launches themselves."""
    grid, common = _grid(sample)
    landings = sample.landings
    right, up = np.roll(grid, -1, axis=1), grid[1:]
    lonely = np.ones(len(sample.rows), bool)
    same = landings.prints[grid] == landings.prints[right]
    around = same & np.roll(same, 1, axis=1)
    level = landings.prints[grid[:-1]] == landings.prints[up]
    around[1:] &= level
    around[:-1] &= level
    lonely[grid[around]] = False
    places = np.flatnonzero(lonely & fine)
    gaps = np.hypot(landings.x[places] - place[0], landings.y[places] - place[1])
    places = places[np.argsort(gaps, kind="stable")[:_MOST_STARTS]]
    if not len(places):
        return np.empty((0, 2))
    launches, ends = sample.launches[places], landings.at(places)
    slopes = _slopes(shots, launches, ends, low, high)
    corrections, known = _solved(slopes, place - np.stack([ends.x, ends.y], axis=1))
    steps = np.array([_NEAR * np.diff(common).max(initial=0.0), _NEAR * (high - low) / len(grid)])
    near = known & (np.abs(corrections) <= steps).all(axis=1)
    return launches[near]


def _solved(slopes: FloatArray, wanted: FloatArray) -> tuple[FloatArray, Which]:
    """Solutions (n, 2) of equations (n, 2, 2), and which have one."""
    size = np.linalg.norm(slopes, axis=1)
    determinant = slopes[:, 0, 0] * slopes[:, 1, 1] - slopes[:, 0, 1] * slopes[:, 1, 0]
    known = np.abs(determinant) > 1e-12 * size[:, 0] * size[:, 1]
    known &= np.isfinite(slopes).all(axis=(1, 2))
    by = np.where(known, determinant, 1.0)
    steps = np.stack(
        [slopes[:, 1, 1] * wanted[:, 0] - slopes[:, 0, 1] * wanted[:, 1],
         slopes[:, 0, 0] * wanted[:, 1] - slopes[:, 1, 0] * wanted[:, 0]], axis=1,
    ) / by[:, None]  # fmt: skip
    return steps, known


def _slopes(
    shots: Shots, launches: FloatArray, ends: Landings, low: float, high: float
) -> FloatArray:
    """How the ends change with heading and speed (or spin), (n, 2, 2), on the same sequence."""
    steps = _STEP * np.array([HEADINGS, high - low])
    slopes = np.full((len(launches), 2, 2), np.nan)
    for column, step in enumerate(steps):
        left = np.arange(len(launches))
        for side in (step, -step):  # backwards where it may not be forwards
            tried = launches[left]
            tried[:, column] += side
            there, here = shots.land(tried), ends.at(left)
            same = there.prints == here.prints
            slopes[left[same], 0, column] = (there.x - here.x)[same] / side
            slopes[left[same], 1, column] = (there.y - here.y)[same] / side
            left = left[~same]
    return slopes


def _newton(
    shots: Shots, launches: FloatArray, landings: Landings, place: FloatArray, close: float,
    low: float, high: float,
) -> Roots:  # fmt: skip
    """Newton's method with halved steps, each on the sequence on which it began."""
    launches, landings = launches.copy(), landings.at(np.arange(len(launches)))
    misses = np.hypot(landings.x - place[0], landings.y - place[1])
    alive = np.ones(len(launches), bool)
    for _ in range(_ITERATIONS):
        now = np.flatnonzero(alive & (misses > 1e-3 * close))
        if not len(now):
            break
        here = landings.at(now)
        slopes = _slopes(shots, launches[now], here, low, high)
        steps, known = _solved(slopes, place - np.stack([here.x, here.y], axis=1))
        room = np.where(steps[:, 1] > 0.0, high - launches[now, 1], launches[now, 1] - low)
        over = np.abs(steps[:, 1]) > np.maximum(room, 0.0)
        shares = np.where(over, 0.9 * room / np.maximum(np.abs(steps[:, 1]), 1e-300), 1.0)
        shares = np.minimum(shares, 0.3 / np.maximum(np.abs(steps[:, 0]), 1e-300))
        waiting = known.copy()
        for _ in range(_HALVINGS):
            some = np.flatnonzero(waiting)
            if not len(some):
                break
            tried = launches[now[some]] + shares[some, None] * steps[some]
            ends = shots.land(tried)
            gaps = np.hypot(ends.x - place[0], ends.y - place[1])
            better = ends.prints == landings.prints[now[some]]
            better &= gaps <= (1.0 - 0.1 * shares[some]) * misses[now[some]]
            done = now[some[better]]
            launches[done], misses[done] = tried[better], gaps[better]
            for column, values in zip(landings, ends, strict=True):
                column[done] = values[better]
            waiting[some[better]] = False
            shares[some] *= 0.5
        alive[now[waiting | ~known]] = False
    there = misses <= close
    return Roots(launches[there], landings.at(there), misses[there])


def _merged(roots: Roots, span: float) -> Roots:
    """Each launch once, of those that are the same the one that misses least."""
    order = np.argsort(roots.misses, kind="stable")
    kept: list[int] = []
    for n in order.tolist():
        heading, second = roots.launches[n]
        for m in kept:
            turn = (heading - roots.launches[m, 0] + math.pi) % HEADINGS - math.pi
            gap = abs(second - roots.launches[m, 1])
            same = roots.landings.prints[n] == roots.landings.prints[m]
            if same and abs(turn) < _SAME * HEADINGS and gap < _SAME * span:
                break
        else:
            kept.append(n)
    which = np.array(kept, np.int64)
    return Roots(roots.launches[which], roots.landings.at(which), roots.misses[which])
