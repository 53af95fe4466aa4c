"""Tracks that hold impacts with walls: cut where they bend, and what the bends say of the walls.

A track is cut between two frames where its velocity jumps by far more than it changes nearby.  The
pieces are fitted together, as slides of one puck with launches of their own.  From the
state before an impact and the one after follow, per unit of mass,

    P_t = −(k²/R) Δω ,   P_n = √(|Δv|² − P_t²) ,   e = P_n/u_n − 1 ,

with n the direction to the wall, so that −Δv = P_n n + P_t t, and u_n the speed of approach: the
restitution e, and P_t/P_n, which is the friction coefficient of the rim where it slid all the time.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.certainty import Z95, Certainty
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.launched import path_of
from puck_tables.fitting.numbers import FOLLOWS, Number
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.seen import FEWEST, Seen
from puck_tables.fitting.starts import robust_parabola

_WINDOW, _WIDER = 5, 15  # frames to either side
_USUAL, _NOISY, _LEAST = 6.0, 6.0, 0.15  # times the usual jump, the noise of one, the speed
_TOP = 0.95  # of the largest jump around: in the middle of these is the kink
_STEP = 1e-5
_INSTANT = 1e-4  # s, over which velocities are differences


class Impact(NamedTuple):
    """An impact with a wall.

    ``track``: its name; ``time`` s; ``place`` (x, y) m of the centre; ``wall`` rad: the direction
    from the centre to the wall; ``restitution`` e, ``rim`` P_t/P_n.
    """

    track: str
    time: float
    place: tuple[float, float]
    wall: float
    restitution: Number
    rim: Number


def kinks(film: Seen, noise: float) -> list[int]:
    """Frames after which the velocity of a track jumps.

    Examples
    --------
    >>> t = np.arange(80.0) / 100.0
    >>> x = np.where(t < 0.395, t, 0.79 - t)
    >>> place = np.stack([x, 0.0 * x], axis=1)
    >>> kinks(Seen("a", 0.0, t, place, None, np.arange(80)), 1e-5)
    [39]
    """
    count = film.time.size
    places = range(_WINDOW - 1, count - _WINDOW)
    if len(places) < 2 * _WINDOW:
        return []
    before = np.array([_velocity(film, i - _WINDOW + 1, i + 1) for i in places])
    after = np.array([_velocity(film, i + 1, i + 1 + _WINDOW) for i in places])
    change, speed = after - before, np.hypot(*before.T)
    jump = np.hypot(*(change - _around(change)).T)
    error = noise * math.sqrt(48.0 / _WINDOW**3) / film.usual_step
    high = max(_USUAL * float(np.median(jump)), _NOISY * error)
    found = []
    for n, size in enumerate(jump.tolist()):
        near = jump[max(0, n - _WINDOW) : n + _WINDOW + 1]
        top = max(0, n - _WINDOW) + np.flatnonzero(near >= _TOP * near.max())
        highest = n == int(top[top.size // 2])
        if highest and size > max(high, _LEAST * float(speed[n])):
            found.append(n + _WINDOW - 1)
    ends = [-1, *found, count - 1]
    return [
        ends[k] for k in range(1, len(ends) - 1)
        if _jumps(film, noise, ends[k - 1] + 1, ends[k] + 1, ends[k + 1] + 1)
    ]  # fmt: skip


def _jumps(film: Seen, noise: float, start: int, middle: int, stop: int) -> bool:
    """Whether robust parabolas over more frames tell a jump, too: several outliers are none."""
    start, stop = max(start, middle - _WIDER), min(stop, middle + _WIDER)
    if min(middle - start, stop - middle) < FEWEST:
        return True
    before = robust_parabola(film.time, film.place, start, middle)
    after = robust_parabola(film.time, film.place, middle, stop)
    at = 0.5 * (film.time[middle - 1] + film.time[middle])
    jump = math.hypot(*(after[1] - before[1] + 2.0 * at * (after[2] - before[2])))
    span = min(middle - start, stop - middle)
    error = noise * math.sqrt(2.0 * 192.0 / span**3) / film.usual_step
    return jump > max(_NOISY * error, _LEAST * math.hypot(*(before[1] + 2.0 * at * before[2])))


def _around(change: FloatArray) -> FloatArray:
    """What friction changes near each frame (n, 2): the median of frames beside it."""
    count = len(change)
    out = np.empty_like(change)
    for n in range(count):
        beside = np.r_[
            max(0, n - 3 * _WINDOW) : max(0, n - _WINDOW),
            min(count, n + _WINDOW + 1) : min(count, n + 3 * _WINDOW + 1),
        ]
        out[n] = np.median(change[beside], axis=0)
    return out


def _velocity(film: Seen, start: int, stop: int) -> FloatArray:
    """The median of the slopes between any two frames, which one outlier in five does not move."""
    time, place = film.time[start:stop], film.place[start:stop]
    one, two = np.triu_indices(time.size, 1)
    velocity: FloatArray = np.median(
        (place[two] - place[one]) / (time[two] - time[one])[:, None], axis=0
    )
    return velocity


def cut(films: tuple[Seen, ...], noise: float) -> tuple[Seen, ...]:
    """The tracks cut at their kinks; a piece too short to be fitted is left out."""
    pieces = []
    for film in films:
        ends = [0, *(n + 1 for n in kinks(film, noise)), film.time.size]
        number = np.arange(film.time.size)
        for k, (start, stop) in enumerate(pairwise(ends)):
            if stop - start < FEWEST + 2:
                continue
            piece = film.part((number >= start) & (number < stop))
            name = film.name if len(ends) == 2 else f"{film.name}, slide {k + 1}"
            pieces.append(Seen(
                name, piece.start, piece.time, piece.place, piece.angle, piece.frame
            ))  # fmt: skip
    return tuple(pieces)


def impacts_of(found: Estimate, certainty: Certainty) -> tuple[Impact, ...]:
    """The impacts between pieces of one track that follow each other."""
    problem, x = found.problem, found.x
    impacts = []
    for n in range(len(problem.films) - 1):
        one, two = problem.films[n], problem.films[n + 1]
        if one.name.rpartition(", slide ")[0] != two.name.rpartition(", slide ")[0] or (
            ", slide " not in one.name
        ):
            continue
        values = _impact(problem, x, n)
        if values is None:
            continue
        slopes = np.zeros((2, x.size))
        for k in range(x.size):
            step = _STEP * certainty.plausible[k]
            ends = []
            for side in (1.0, -1.0):
                moved = x.copy()
                moved[k] += side * step
                ends.append(_impact(problem, moved, n))
            if ends[0] is not None and ends[1] is not None:
                slopes[:, k] = (ends[0][:2] - ends[1][:2]) / (2.0 * step)
        numbers = []
        for value, slope in zip(values[:2].tolist(), slopes, strict=True):
            error = certainty.error_of(slope, 1.0)
            numbers.append(
                Number(value, error, value - Z95 * error, value + Z95 * error, "1", FOLLOWS)
            )
        _, _, time, px, py, wall = values.tolist()
        name = one.name.rpartition(", slide ")[0]
        impacts.append(Impact(name, time, (px, py), wall, numbers[0], numbers[1]))
    return tuple(impacts)


def _impact(problem: Problem, x: FloatArray, n: int) -> FloatArray | None:
    """e, P_t/P_n, time, x, y and wall of the impact after piece ``n``; None if there is none."""
    before, after = problem.films[n], problem.films[n + 1]
    one, two = problem.launches(x)[n : n + 2]
    gap = after.start - before.start
    earlier = gap - before.time[-1]
    # straight lines through both ends of the gap meet nearest where the impact was
    end = _state(problem, x, one, gap - earlier)
    start = _state(problem, x, two, 0.0)
    slow = _state(problem, x, two, 10.0 * _INSTANT)[3:6]
    change = (slow - start[3:6]) / (10.0 * _INSTANT)
    apart = start[:2] - start[3:5] * earlier - end[:2]
    closing = end[3:5] - start[3:5]
    since = float(apart @ closing) / float(closing @ closing)
    since = min(max(since, -earlier), 2.0 * earlier)
    incoming = _state(problem, x, one, gap - earlier + since)
    outgoing = start[3:6] - change * (earlier - since)
    kick = incoming[3:5] - outgoing[:2]
    found, moving = problem.found(x), problem.moving(problem.found(x))
    gyration = {**problem.asked.known(), **found}["gyration"] * moving.radius
    rub = (incoming[5] - outgoing[2]) * gyration**2 / moving.radius
    push = math.sqrt(max(float(kick @ kick) - rub * rub, 0.0))
    wall = math.atan2(kick[1], kick[0]) - math.atan2(rub, push)
    approach = float(incoming[3:5] @ [math.cos(wall), math.sin(wall)])
    if not (approach > 0.0 and push > 0.0):
        return None
    time = before.start + gap - earlier + since
    return np.array([push / approach - 1.0, rub / push, time, *incoming[:2], wall])


def _state(problem: Problem, x: FloatArray, launch: FloatArray, time: float) -> FloatArray:
    """Place, angle, velocity and spin at a time after a launch."""
    moving = problem.moving(problem.found(x))
    times = np.array([max(time - _INSTANT, 0.0), time, time + _INSTANT])
    path = path_of(moving, launch[2:4], float(launch[4]), times) + launch[[0, 1, 5], None]
    if time <= 0.0:
        return np.concatenate([path[:, 1], launch[2:5]])
    rate = (path[:, 2] - path[:, 0]) / (times[2] - times[0])
    return np.concatenate([path[:, 1], rate])
