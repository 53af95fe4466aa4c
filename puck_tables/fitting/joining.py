"""From slides with launches of their own to slides that impacts join.

The states before and after a kink say what was met.  Two tracks that bend at the same moment, two
radii apart, are two pucks that meet; any other kink is a wall, one of those given or one to be
found.  From a wall follow, per unit of mass,

    P_t = −k² Δω/r ,   P_n = √(|Δv|² − P_t²) ,   e = P_n/u_n − 1 ,

with n the direction to the wall, so that −Δv = P_n n + P_t t, and u_n the speed of approach.  These
are the values that the joint fit begins with, or what is told where slides cannot be joined.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.asked import Asked
from puck_tables.fitting.impacts import Piece
from puck_tables.fitting.joined import Meeting, Slide, Wall, state_at
from puck_tables.fitting.parameters import OF_PAIRS, OF_WALLS
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.seen import Seen

_TOGETHER = 2.0  # steps between frames within which two tracks bend at one moment
_NEAR = 1.0  # radii: how far off two pucks, or a puck and a wall that was given, may seem to be
_BOUNCES = 1.5  # the largest restitution that noise may show
_GRIPS = 0.97  # of the impulse that stops the rims
_REACH, _REACH_FRAMES = 0.4, 4.0  # of the time between impacts, and at least

Line = tuple[tuple[float, float], tuple[float, float]]


class Bend(NamedTuple):
    """What is seen of an impact from the slides on both sides.

    ``piece``: the one before; ``time`` s after the start of the first track; ``before``,
    ``after``: x, y, vx, vy, spin of the puck there.
    """

    piece: int
    time: float
    before: FloatArray
    after: FloatArray


class Blow(NamedTuple):
    """An impact as both sides show it: of one bend with a wall, or of two."""

    bends: tuple[Bend, ...]
    toward: float
    restitution: float
    ratio: float
    grip: float
    mass: float


def blows_of(problem: Problem, pieces: tuple[Piece, ...], x: FloatArray) -> list[Blow]:
    """The impacts that slides show, in the order of time; ``x``: their unknowns."""
    bends = [
        _bend(problem, x, n) for n in range(len(pieces) - 1)
        if pieces[n].track == pieces[n + 1].track and pieces[n].slide + 1 == pieces[n + 1].slide
    ]  # fmt: skip
    radius = problem.asked.scales(problem.found(x))[2]
    step = max(film.usual_step for film in problem.films)
    taken: set[int] = set()
    blows = []
    near = [
        (abs(_apart(one, two) - 2.0 * radius), i, k)
        for (i, one), (k, two) in combinations(enumerate(bends), 2)
        if pieces[one.piece].track != pieces[two.piece].track
        and abs(one.time - two.time) <= _TOGETHER * step
    ]
    for off, i, k in sorted(near):
        if off < _NEAR * radius and not taken & {i, k}:
            blow = _of_two(problem, x, bends[i], bends[k])
            if blow is not None:
                blows.append(blow)
                taken |= {i, k}
    for k, bend in enumerate(bends):
        blow = None if k in taken else _of_wall(problem, x, bend)
        if blow is not None:
            blows.append(blow)
    return sorted(blows, key=lambda one: one.bends[0].time)


def _apart(one: Bend, two: Bend) -> float:
    return math.hypot(*(one.before[:2] - two.before[:2]))


def _bend(problem: Problem, x: FloatArray, n: int) -> Bend:
    """Between piece ``n`` and the next."""
    launches, found = problem.launches(x), problem.found(x)
    moving = problem.moving(found)
    first = problem.films[0].start
    one, two = problem.films[n], problem.films[n + 1]
    slides = [Slide(film.start - first, launches[k]) for k, film in ((n, one), (n + 1, two))]
    # straight lines through both ends of the gap meet nearest where the impact was
    last, start = slides[0].since + float(one.time[-1]), slides[1].since
    end, begin = state_at(moving, slides[0], last), slides[1].launch
    closing = end[2:4] - begin[2:4]
    apart = begin[:2] - begin[2:4] * (start - last) - end[:2]
    size = float(closing @ closing)
    since = float(apart @ closing) / size if size > 0.0 else 0.5 * (start - last)
    gap = start - last
    time = last + min(max(since, -gap), 2.0 * gap)
    # before its launch a slide goes on as it slows
    later = state_at(moving, slides[1], start + gap)
    back = begin[2:5] - (later[2:5] - begin[2:5]) * (start - time) / gap
    before = state_at(moving, slides[0], max(time, slides[0].since))
    return Bend(n, time, before[:5], np.concatenate([begin[:2], back]))


def _numbers(problem: Problem, x: FloatArray) -> tuple[float, float]:
    """Radius of the puck and its radius of gyration over it."""
    found = problem.found(x)
    return problem.asked.scales(found)[2], {**problem.asked.known(), **found}["gyration"]


def _of_wall(problem: Problem, x: FloatArray, bend: Bend) -> Blow | None:
    """An impact with a wall; None if nothing pushed the puck back."""
    radius, gyration = _numbers(problem, x)
    kick = bend.before[2:4] - bend.after[2:4]
    rub = float(bend.before[4] - bend.after[4]) * gyration**2 * radius
    if not abs(rub) < 0.7 * math.hypot(*kick):  # without angles spin is hardly known
        rub = 0.0
    push = math.sqrt(max(float(kick @ kick) - rub * rub, 0.0))
    toward = math.atan2(kick[1], kick[0]) - math.atan2(rub, push)
    normal = np.array([math.cos(toward), math.sin(toward)])
    approach = float(bend.before[2:4] @ normal)
    if not (approach > 0.0 and approach < push < (1.0 + _BOUNCES) * approach):
        return None
    slip = float(bend.before[3] * normal[0] - bend.before[2] * normal[1])
    slip += radius * float(bend.before[4])
    grip = rub * (1.0 + gyration**-2) / slip if slip != 0.0 else 1.0
    return Blow((bend,), toward, push / approach - 1.0, rub / push, grip, math.inf)


def _of_two(problem: Problem, x: FloatArray, one: Bend, two: Bend) -> Blow | None:
    """An impact of two pucks; None if they were not pushed apart."""
    radius, gyration = _numbers(problem, x)
    across = two.before[:2] - one.before[:2]
    normal = across / (math.hypot(*across) or 1.0)
    tangent = np.array([-normal[1], normal[0]])
    kick, other = one.before[2:4] - one.after[2:4], two.after[2:4] - two.before[2:4]
    push, answer = float(kick @ normal), float(other @ normal)
    approach = float((one.before[2:4] - two.before[2:4]) @ normal)
    if not (push > 0.0 and answer > 0.0 and approach > 0.0):
        return None
    leaving = float((two.after[2:4] - one.after[2:4]) @ normal)
    slip = float((one.before[2:4] - two.before[2:4]) @ tangent)
    slip += radius * float(one.before[4] + two.before[4])
    rub, mass = float(kick @ tangent), push / answer
    lightness = (1.0 + gyration**-2) * (1.0 + 1.0 / mass)
    grip = rub * lightness / slip if slip != 0.0 else 1.0
    toward = math.atan2(normal[1], normal[0])
    return Blow((one, two), toward, leaving / approach, rub / push, grip, mass)


class Joined(NamedTuple):
    """Slides that are joined: what least squares are asked, unknowns to begin with.

    ``pieces``: for each piece its track in ``problem``, and the first of its frames there.
    """

    problem: Problem
    start: FloatArray
    pieces: tuple[int, ...]


def joined(
    problem: Problem, x: FloatArray, pieces: tuple[Piece, ...], films: tuple[Seen, ...],
    asked: Asked, lines: Sequence[Line],
) -> list[Joined]:  # fmt: skip
    """The problem of slides that impacts join; none where there is no impact.

    Where rims seem to stop on what they meet in each of several impacts there is another, in which
    they may slide.

    Parameters
    ----------
    problem, x : of slides, each with a launch of its own, and a way in which they may move
    pieces : which they are
    films : the tracks, uncut
    asked : with the numbers of impacts
    lines : walls that are given, by two points each
    """
    blows = blows_of(problem, pieces, x)
    if not blows:
        return []
    follows = {bend.piece + 1 for blow in blows for bend in blow.bends}
    chains: list[list[int]] = []
    for n in range(len(pieces)):
        if n in follows:
            chains[-1].append(n)
        else:
            chains.append([n])
    tracks, home = [], {}
    for k, chain in enumerate(chains):
        first, last = problem.films[chain[0]], problem.films[chain[-1]]
        whole = films[pieces[chain[0]].track]
        inside = (whole.frame >= first.frame[0]) & (whole.frame <= last.frame[-1])
        name = whole.name if len(chain) > 1 else first.name
        tracks.append(replace(whole.part(inside), name=name))
        home.update(dict.fromkeys(chain, k))
    walls: list[Wall | None] = []
    starts: list[Wall] = []
    meetings = []
    shift = problem.films[0].start - tracks[0].start
    radius = _numbers(problem, x)[0]
    step = max(film.usual_step for film in problem.films)
    known = dict(enumerate(lines))
    numbers: dict[int, int] = {}
    for blow in blows:
        bend = blow.bends[0]
        ends = [problem.films[one.piece].time[-1] for one in blow.bends]
        ends += [problem.films[one.piece + 1].time[-1] for one in blow.bends]
        number = -1
        if len(blow.bends) == 1:
            given = _given(known, bend, radius)
            if given is None or given[0] not in numbers:
                if given is not None:
                    numbers[given[0]] = len(walls)
                met = given[1] if given else _wall(blow, radius)
                number = len(walls)
                walls.append(given[1] if given else None)
                starts.append(met)
            else:
                number = numbers[given[0]]
        films_met = tuple(home[one.piece] for one in blow.bends)
        reach = max(_REACH * float(min(ends)), _REACH_FRAMES * step)
        meetings.append(Meeting(bend.time + shift, reach, films_met, number))
    sizes = {len(blow.bends) for blow in blows}
    grip = all(abs(blow.grip) > _GRIPS for blow in blows)
    ways = [asked.joined(sizes, grip)]
    if grip and len(blows) > 1:
        ways += [other for other in [asked.joined(sizes, False)] if other.free != ways[0].free]
    launches = problem.launches(x)[[chain[0] for chain in chains]]
    found = []
    for one in ways:
        tied = Problem(
            one, tuple(tracks), problem.noise, problem.tall,
            rests=tuple(problem.rests[chain[0]] for chain in chains) if problem.rests else (),
            walls=tuple(walls), meetings=tuple(meetings),
        )  # fmt: skip
        values = {**problem.found(x), **_begin(one, blows)}
        for name in one.free:
            low, high = one.limits(name)
            values[name] = min(max(values[name], low), high)
        start = tied.unknowns(values, launches, tuple(starts))
        found.append(Joined(tied, start, tuple(home[n] for n in range(len(pieces)))))
    return found


def _begin(asked: Asked, blows: list[Blow]) -> dict[str, float]:
    """Values of the numbers of impacts to begin with."""
    found = {}
    for names, count in ((OF_WALLS, 1), (OF_PAIRS, 2)):
        mine = [blow for blow in blows if len(blow.bends) == count]
        if not mine:
            continue
        e, mu, turned, *mass = names
        found[e] = float(np.median([blow.restitution for blow in mine]))
        found[mu] = max(abs(blow.ratio) for blow in mine)  # rims that grip rub less
        found[turned] = float(np.median([blow.grip for blow in mine])) - 1.0
        if mass:
            found[mass[0]] = float(np.median([blow.mass for blow in mine]))
    return {name: asked.start.get(name, value) for name, value in found.items()}


def _wall(blow: Blow, radius: float) -> Wall:
    """The wall where an impact was."""
    normal = np.array([math.cos(blow.toward), math.sin(blow.toward)])
    return Wall(blow.toward, float(blow.bends[0].before[:2] @ normal) + radius)


def _given(lines: dict[int, Line], bend: Bend, radius: float) -> tuple[int, Wall] | None:
    """The given wall that a puck touched, and its number; None if it was none of them."""
    best: tuple[float, int, Wall] | None = None
    for n, (one, two) in lines.items():
        along = np.subtract(two, one)
        normal = np.array([along[1], -along[0]]) / math.hypot(*along)
        if float((np.array(one) - bend.before[:2]) @ normal) < 0.0:
            normal = -normal
        distance = float(np.array(one) @ normal)
        off = abs(distance - float(bend.before[:2] @ normal) - radius)
        closes = float(bend.before[2:4] @ normal) > 0.0
        if closes and off < _NEAR * radius and (best is None or off < best[0]):
            best = off, n, Wall(math.atan2(normal[1], normal[0]), distance)
    return None if best is None else best[1:]
