"""The joint fit of slides that impacts join, and what it says of the impacts.

Slides are joined by one restitution and one friction of the rims for all impacts of a kind.  That
is a law, and it is judged: by how much χ² rises over that of slides with launches of their own, for
as many conditions as there are unknowns less.  Where it fails the slides stay as they are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.asked import Asked
from puck_tables.fitting.certainty import Certainty
from puck_tables.fitting.estimate import FARTHEST, FARTHEST_PLACE, Estimate, estimate
from puck_tables.fitting.impacts import Piece
from puck_tables.fitting.joined import Wall
from puck_tables.fitting.joining import Blow, Joined, Line, blows_of, joined
from puck_tables.fitting.numbers import FOLLOWS, Number, quadratic
from puck_tables.fitting.parameters import OF_PAIRS, OF_WALLS
from puck_tables.fitting.problem import Problem
from puck_tables.fitting.residual_tests import chi_square_tail
from puck_tables.fitting.seen import Seen
from puck_tables.fitting.timing import Known

_BY_CHANCE = 1e-5  # of the rise of χ²: less, and the law of impact is not that of these slides
_STEP = 1e-6
_SAME = 1e-9  # of the size of coordinates: a point lies on a wall

Values = Callable[[FloatArray], FloatArray]


class Impact(NamedTuple):
    """An impact with a wall, or of two pucks.

    ``track``: its name; ``partner``: that of the other puck, empty of a wall; ``time`` s; ``place``
    (x, y) m of the centre; ``wall`` rad: the direction from there to what is met; ``restitution``
    e; ``rim``: tangential over normal impulse, which is the friction of the rims where they slid
    all the time; ``mass_ratio``: of the partner's mass to that of the puck.
    """

    track: str
    partner: str
    time: float
    place: tuple[float, float]
    wall: float
    restitution: Number
    rim: Number
    mass_ratio: Number | None


def tie(
    slides: Estimate, pieces: tuple[Piece, ...], films: tuple[Seen, ...], asked: Asked,
    lines: Sequence[Line], known: Known,
) -> tuple[Estimate | None, str]:  # fmt: skip
    """The estimate of joined slides, and a sentence if it is none.

    Parameters
    ----------
    slides, pieces, films, asked, lines : as :func:`puck_tables.fitting.joining.joined`
    known : whether the noise of places and of angles is
    """
    whole = joined(slides, pieces, films, asked, lines)
    if whole is None:
        return None, ""
    found = estimate(whole.problem, whole.start, known)
    rise = _rise(slides, found, whole)
    conditions = slides.x.size - found.x.size
    if chi_square_tail(rise, max(conditions, 1)) < _BY_CHANCE:
        return None, (
            "The slides are not joined at the impacts: one law of impact for all of them, with "
            f"states that match, would raise chi^2 by {rise:.4g} for {conditions} "
            f"condition{'' if conditions == 1 else 's'}"
        )
    return found, ""


def not_met(impacts: Sequence[Impact], problem: Problem, lines: Sequence[Line]) -> tuple[str, ...]:
    """A sentence for each wall that was given and never met, or one if there is no impact at all.

    Parameters
    ----------
    impacts : that were found, where they were looked for
    problem : of the joined slides, with the walls that they meet
    lines : walls that were given, by two points each
    """
    if not impacts:
        return ("No impact was found: each track is taken for one slide",)
    if not problem.meetings:  # nothing is joined at walls
        return ()
    met = [wall for wall in problem.walls if wall is not None]
    return tuple(
        f"No impact was found on the wall through ({ax:g}, {ay:g}) and ({bx:g}, {by:g}): see that "
        "its points are in m, along the axes of the tracks"
        for (ax, ay), (bx, by) in lines
        if not any(_through(wall, ax, ay) and _through(wall, bx, by) for wall in met)
    )


def _through(wall: Wall, x: float, y: float) -> bool:
    off = x * math.cos(wall.angle) + y * math.sin(wall.angle) - wall.distance
    return abs(off) <= _SAME * max(abs(x), abs(y), abs(wall.distance))


def _rise(slides: Estimate, found: Estimate, whole: Joined) -> float:
    """By how much χ² is larger, over the frames of all slides, with the noise of these."""
    noise = slides.problem.noise
    apart = _frame_squares(slides.problem, slides.x)
    together = _frame_squares(found.problem.with_noise(noise, found.x, found.kept), found.x)
    rise = 0.0
    for n, (film, squares) in enumerate(zip(slides.problem.films, apart, strict=True)):
        track = whole.pieces[n]
        places = np.searchsorted(found.problem.films[track].frame, film.frame)
        rise += float((together[track][places] - squares).sum())
    return max(rise, 0.0)


def _frame_squares(problem: Problem, x: FloatArray) -> list[FloatArray]:
    """Squares of the residuals of each frame, an outlier as the farthest that is none."""
    rows, found = problem.residuals(x), []
    for film, (one, two, turn) in zip(problem.films, problem.each(), strict=True):
        squares = np.minimum(rows[one] ** 2 + rows[two] ** 2, FARTHEST_PLACE)
        if film.angle is not None:
            squares[np.isfinite(film.angle)] += np.minimum(rows[turn] ** 2, FARTHEST**2)
        found.append(squares)
    return found


def impacts_joined(
    found: Estimate, certainty: Certainty, numbers: dict[str, Number]
) -> tuple[Impact, ...]:
    """The impacts of a joint fit."""
    problem = found.problem

    def ratios(x: FloatArray) -> FloatArray:
        return np.array([hit.ratio for hit in problem.slides(x)[1]])

    slopes = _slopes(found, certainty, ratios)
    first = problem.films[0].start
    impacts = []
    hits = problem.slides(found.x)[1]
    for meeting, hit, slope in zip(problem.meetings, hits, slopes, strict=True):
        pair = meeting.wall < 0
        names = list(OF_PAIRS if pair else OF_WALLS)
        error = certainty.error_of(slope, 1.0)
        films = [problem.films[n].name for n in meeting.films]
        impacts.append(Impact(
            films[0], films[1] if pair else "", first + hit.time,
            (float(hit.place[0]), float(hit.place[1])), hit.toward, numbers[names[0]],
            quadratic(hit.ratio, error, "1", FOLLOWS, certainty.quantile),
            numbers[names[3]] if pair else None,
        ))  # fmt: skip
    return tuple(impacts)


def impacts_apart(
    slides: Estimate, pieces: tuple[Piece, ...], certainty: Certainty, names: Sequence[str]
) -> tuple[Impact, ...]:
    """The impacts between slides with launches of their own; ``names``: of the tracks."""
    problem = slides.problem
    blows = blows_of(slides, pieces, slides.x)

    def values(x: FloatArray) -> FloatArray:
        """Restitution, ratio and mass of each; as they are where an impact comes to nothing."""
        others = {_key(blow): blow for blow in blows_of(slides, pieces, x)}
        rows = [others.get(_key(blow), blow) for blow in blows]
        return np.array([[one.restitution, one.ratio, one.mass] for one in rows]).ravel()

    if not blows:
        return ()
    slopes = _slopes(slides, certainty, values).reshape(len(blows), 3, -1)
    impacts = []
    for blow, slope in zip(blows, slopes, strict=True):
        numbers = [
            quadratic(value, certainty.error_of(one, 1.0), "1", FOLLOWS, certainty.quantile)
            for value, one in zip((blow.restitution, blow.ratio, blow.mass), slope, strict=True)
            if math.isfinite(value)
        ]  # fmt: skip
        tracks = [names[pieces[bend.piece].track] for bend in blow.bends]
        x, y = blow.bends[0].before[:2].tolist()
        impacts.append(Impact(
            tracks[0], tracks[1] if len(tracks) > 1 else "",
            problem.films[0].start + blow.bends[0].time, (x, y), blow.toward, numbers[0],
            numbers[1], numbers[2] if len(tracks) > 1 else None,
        ))  # fmt: skip
    return tuple(impacts)


def _key(blow: Blow) -> tuple[int, ...]:
    return tuple(bend.piece for bend in blow.bends)


def _slopes(found: Estimate, certainty: Certainty, of: Values) -> FloatArray:
    """The derivatives of numbers to the unknowns, (numbers, m)."""
    columns = []
    low, high = found.problem.limits
    for k in range(found.x.size):
        step = _STEP * max(abs(float(found.x[k])), float(certainty.plausible[k]) * 1e-2)
        ends, values = [], []
        for side in (1.0, -1.0):
            moved = found.x.copy()
            moved[k] = min(max(moved[k] + side * step, low[k]), high[k])
            ends.append(moved[k])
            values.append(of(moved))
        with np.errstate(invalid="ignore"):
            columns.append(np.nan_to_num((values[0] - values[1]) / (ends[0] - ends[1])))
    return np.stack(columns, axis=1)
