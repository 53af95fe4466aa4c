"""What pictures and movies show of a motion: bodies on their ways, the board, what happens.

The way of a body is a few knots: time, place, angle and their rates.  Between two of them it is the
cubic polynomial through both (Hermite's), which misses it by less than is seen.  Impacts are knots,
one just before and one just after.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.colours import brightness, on_white
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.plot.base_outlines import MARK, outline_of
from puck_tables.plot.board_parts import (
    Painted,
    RoundPart,
    StraightPart,
    painted_on,
    rounds_of,
    straight_parts,
)
from puck_tables.plot.floor_axes import Box
from puck_tables.plot.titles import out_of_sight
from puck_tables.result import TimedResult
from puck_tables.scene.parts import Floor
from puck_tables.scene.run import STATE, Run
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.sides import line_of
from puck_tables.trajectory import Trajectory
from puck_tables.world.agreement import frictions_under
from puck_tables.world.named_pucks import called, pucks_of, start_of
from puck_tables.world.paths import rows_of

# dark and light by turns, so that neighbours differ in grey as well (Okabe and Ito)
PALETTE = (
    "#0072b2", "#e69f00", "#000000", "#56b4e9", "#d55e00", "#f0e442", "#009e73", "#cc79a7",
)  # fmt: skip
_STATES = 1500  # at which a way is known before its knots are chosen
# of the only puck of a scene at least so many, so many a turn, and so many at the most
_OF_ONE, _A_TURN, _MOST = 2000, 60, 50_000
_UNSEEN = (1e-4, 0.01)  # of the size of what is in sight, and of the smallest radius
_FAR = 3.0  # sizes of the ways: corners of the board farther off are left out of sight

_DARK = 0.45  # brightness: a mark on it is white


class MovingDisc(NamedTuple):
    """A disc and its way: knots (n, 7) of t, x, y, angle, vx, vy, spin; ``gone`` s, or inf.

    ``outline``: of a base that is not round, as :mod:`puck_tables.plot.base_outlines` has it;
    ``radius`` is then its reach.
    """

    name: str
    radius: float
    colour: str
    driven: bool
    knots: FloatArray
    gone: float
    outline: tuple[FloatArray, ...] = ()

    @property
    def line(self) -> str:
        """The colour of its ways, which are seen on white."""
        return on_white(self.colour)

    @property
    def mark(self) -> str:
        """The colour of a mark that is seen on it."""
        return "white" if brightness(self.colour) < _DARK and not self.driven else "black"

    @property
    def mark_length(self) -> float:
        """How far a mark goes from its centre, m."""
        return MARK * self.radius if self.outline else self.radius


class Happening(NamedTuple):
    """An impact, or a fall into a pocket or over an edge: when, what, and where."""

    time: float
    what: str
    x: float
    y: float


class Animation(NamedTuple):
    """All that is shown."""

    title: str
    end: str
    end_time: float
    bodies: list[MovingDisc]
    lines: list[StraightPart]
    rounds: list[RoundPart]
    painted: list[Painted]
    happenings: Sequence[Happening]
    box: Box
    floor: Floor
    frictions: tuple[float, ...]  # all that there are on it
    hidden: str = ""  # walls and edges out of sight, in words


def film_of(result: TimedResult) -> Animation:
    """The film of a run of a scene of one or several pucks, or of a trajectory.

    >>> from puck_tables import Puck
    >>> film = film_of(Puck.similar().simulate((1.0, 0.0), 5.0))
    >>> len(film.bodies), film.bodies[0].knots[-1, 1].round(6).item()
    (1, 2.213952)
    """
    if isinstance(result, Trajectory):
        run = result(np.linspace(0.0, result.stop_time, _STATES))
        columns = [run.time, run.x, run.y, run.orientation, run.vx, run.vy, run.spin]
        return _film("Puck", "at rest", run.stop_time, [_body("puck", run.puck, columns)])
    if isinstance(result, Run) and result.scene.pucks:
        return _film_of_several(result)
    if isinstance(result, Run):
        return film_of_one(result, states_drawn(result))
    raise TypeError(f"{type(result).__name__} has no film")


def film_of_one(run: Run, columns: dict[str, FloatArray], shape: float = 0.0) -> Animation:
    """The film of a scene of one puck, from its states close to each other, (n,) by name.

    ``shape``: the width of what is in sight over its height, 0: as it comes.
    """
    scene = run.scene
    body = _body("puck", scene.puck, [columns[name] for name in ("time", *STATE)])
    happenings = [Happening(e.time, e.what, e.x, e.y) for e in run.events if e.what == "impact"]
    return _film(scene.title, run.end, run.end_time, [body], happenings, scene, shape)


def states_drawn(run: Run) -> dict[str, FloatArray]:
    """States of a run so close that lines between them are its curves, before and after events."""
    scene = run.scene
    turns = (
        abs(run.last["orientation"] - scene.launch.orientation)
        + (abs(scene.launch.spin) + abs(scene.floor.turning)) * run.end_time
    ) / (2.0 * math.pi)
    count = int(min(max(_OF_ONE, _A_TURN * turns), _MOST))
    events = np.array([event.time for event in run.events])
    times = np.concatenate(
        [np.linspace(0.0, run.end_time, count), np.nextafter(events, 0.0), events]
    )
    times = np.unique(times[times <= run.end_time])
    return dict(run(times).columns)


def _film_of_several(run: Run) -> Animation:
    scene, pucks = run.scene, pucks_of(run.scene)
    kinks = [rows_of(puck.path)[:, 0] for puck in pucks if puck.path]
    sudden = np.concatenate([[event.time for event in run.events], *kinks])
    sudden = sudden[(sudden > 0.0) & (sudden <= run.end_time)]
    times = [np.linspace(0.0, run.end_time, _STATES), sudden, np.nextafter(sudden, -np.inf)]
    in_view = run(np.unique(np.concatenate(times)))
    gone = dict.fromkeys(run.names, math.inf)
    gone |= {
        event.puck: event.time for event in run.events if event.what in ("pocket", "edge", "tip")
    }
    bodies = [
        _body(name, puck, [in_view.time, *(in_view[n][column] for column in STATE)], gone[name],
              puck.colour, bool(puck.path))
        for n, (name, puck) in enumerate(zip(run.names, pucks, strict=True))
    ]  # fmt: skip
    happenings = [
        Happening(event.time, event.what, event.x, event.y)
        for event in run.events if event.what in ("impact", "pocket", "edge", "tip")
    ]  # fmt: skip
    return _film(scene.title, run.end, run.end_time, bodies, happenings, scene)


def at_start(scene: SceneSpec) -> Animation:
    """A board with its pucks where they are at the start, without their motion.

    >>> from puck_tables import Scene
    >>> len(at_start(Scene.load("crokinole")).bodies)
    4
    """
    bodies = [
        _body(called(puck, n), puck,
              list(np.array([[0.0, *start_of(puck), puck.launch.orientation, 0.0, 0.0, 0.0]]).T),
              math.inf, puck.colour, bool(puck.path))
        for n, puck in enumerate(pucks_of(scene))
    ]  # fmt: skip
    return _film(scene.title, "", 0.0, bodies, scene=scene)


def _body(
    name: str, puck: PuckSpec, columns: Sequence[FloatArray], gone: float = math.inf,
    colour: str = "", driven: bool = False,
) -> MovingDisc:  # fmt: skip
    """A puck with its states close to each other, for knots."""
    outline = () if puck.shape is None else tuple(outline_of(puck))
    return MovingDisc(name, puck.radius, colour, driven, np.stack(columns, axis=1), gone, outline)


def _film(
    title: str, end: str, end_time: float, bodies: list[MovingDisc],
    happenings: Sequence[Happening] = (), scene: SceneSpec | None = None, shape: float = 0.0,
) -> Animation:  # fmt: skip
    """A film of bodies with states close to each other for knots, some without a colour."""
    rounds = [] if scene is None else rounds_of(scene)
    painted = [] if scene is None else painted_on(scene)
    planes = [] if scene is None else _half_planes(scene)
    sides = [] if scene is None else straight_parts(scene)
    box = _sight(bodies, rounds, [*painted, *sides])
    box = _with_corners(box, [plane for _, plane in planes])
    if shape > 0.0:
        wide, high = 0.5 * (box.right - box.left), 0.5 * (box.high - box.low)
        x, y = box.left + wide, box.low + high
        wide, high = max(wide, shape * high), max(high, wide / shape)
        box = Box(x - wide, x + wide, y - high, y + high)
    size, smallest = max(box[1] - box[0], box[3] - box[2]), min(body.radius for body in bodies)
    unseen = min(_UNSEEN[0] * size, _UNSEEN[1] * smallest)
    lines = [*sides, *_lines(planes, box)]
    colours = (colour_of(number) for number in range(len(bodies)))
    frictions = [] if scene is None else [
        friction for puck in pucks_of(scene) for friction in frictions_under(scene, puck)
    ]  # fmt: skip
    return Animation(
        title, end, end_time,
        [
            body._replace(colour=body.colour or next(colours),
                          knots=_knots(body.knots, body.radius, unseen))
            for body in bodies
        ],
        lines, rounds, painted, happenings, box, Floor() if scene is None else scene.floor,
        tuple(frictions), out_of_sight(planes, lines[len(sides) :]),
    )  # fmt: skip


def colour_of(number: int) -> str:
    """A colour for the ``number``-th puck that has none: of the palette, then lighter, darker.

    >>> colour_of(0), colour_of(8)
    ('#0072b2', '#73b1d5')
    """
    plain, turn = PALETTE[number % len(PALETTE)], number // len(PALETTE) % 3
    towards, share = (255.0, 0.45) if turn == 1 else (0.0, 0.35)
    parts = [int(plain[n : n + 2], 16) for n in (1, 3, 5)]
    if turn:
        parts = [round(part + share * (towards - part)) for part in parts]
    return "#" + "".join(f"{part:02x}" for part in parts)


def between(knots: FloatArray, times: FloatArray) -> FloatArray:
    """X, y and angle on the way through knots, array (times, 3).

    >>> knots = np.array([[0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0], [2.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]])
    >>> between(knots, np.array([1.0]))[0, 0].item()
    0.75
    """
    row = np.clip(np.searchsorted(knots[:, 0], times, side="right") - 1, 0, len(knots) - 1)
    after = np.minimum(row + 1, len(knots) - 1)
    one, two = knots[row], knots[after]
    span = (two[:, 0] - one[:, 0])[:, None]
    share = np.divide(
        (times - one[:, 0])[:, None], span, out=np.zeros_like(span), where=span > 0.0
    ).clip(0.0, 1.0)
    rest = 1.0 - share
    return np.asarray(
        rest * rest * ((1.0 + 2.0 * share) * one[:, 1:4] + share * span * one[:, 4:])
        + share * share * ((3.0 - 2.0 * share) * two[:, 1:4] - rest * span * two[:, 4:])
    )


def path_of(body: MovingDisc, until: float = math.inf) -> FloatArray:
    """Places of a body so close that lines between them are its way, array (n, 2)."""
    times, until = body.knots[:, 0], min(until, body.knots[-1, 0])
    starts = times[: np.searchsorted(times, until, side="right")]
    ends = np.append(starts[1:], until)  # also within the piece that it is on
    fine = starts[:, None] + np.linspace(0.0, 1.0, 12) * (ends - starts)[:, None]
    return between(body.knots, fine.ravel())[:, :2]


def _knots(states: FloatArray, radius: float, unseen: float) -> FloatArray:
    """The fewest states that tell the others to what is not seen, on a rim the angle included."""
    sudden = np.flatnonzero(_leaps(states))  # the states just before
    chosen = {0, len(states) - 1, *sudden.tolist(), *(sudden + 1).tolist()}
    waiting = list(itertools.pairwise(sorted(chosen)))
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        middle = states[first + 1 : last]
        gap = np.abs(between(states[[first, last]], middle[:, 0]) - middle[:, 1:4])
        missed = np.hypot(gap[:, 0], gap[:, 1]) + radius * gap[:, 2]
        if missed.max() > unseen:
            worst = first + 1 + int(np.argmax(missed))
            chosen.add(worst)
            waiting += [(first, worst), (worst, last)]
    return states[sorted(chosen)]


def _leaps(states: FloatArray) -> npt.NDArray[np.bool_]:
    """Where rates change from one moment to the very next one, as in an impact, array (n - 1,)."""
    at_once = states[1:, 0] <= np.nextafter(states[:-1, 0], np.inf)
    rates = states[:, 4:]
    scale = np.abs(rates).max(axis=0) + 1e-300
    return np.asarray(at_once & (np.abs(np.diff(rates, axis=0)) > 1e-9 * scale).any(axis=1))


def _sight(
    bodies: list[MovingDisc], rounds: list[RoundPart], lines: list[Painted | StraightPart]
) -> Box:
    """What ways, round parts of the board and lines with ends cover."""
    low = np.min([one.knots[:, 1:3].min(axis=0) - one.radius for one in bodies], axis=0)
    high = np.max([one.knots[:, 1:3].max(axis=0) + one.radius for one in bodies], axis=0)
    for one in rounds:
        centre = np.array([one.x, one.y])
        low, high = np.minimum(low, centre - one.radius), np.maximum(high, centre + one.radius)
    for line in lines:
        low = np.minimum(low, [min(line.x), min(line.y)])
        high = np.maximum(high, [max(line.x), max(line.y)])
    return Box(float(low[0]), float(high[0]), float(low[1]), float(high[1]))


def _half_planes(scene: SceneSpec) -> list[tuple[str, FloatArray]]:
    """Walls and edges without ends as unit normals into the field, and places along them."""
    walls = [("wall", line_of(wall)) for wall in scene.walls if wall.point is not None]
    edges = [("edge", line_of(edge)) for edge in scene.edges]
    return [(kind, np.array(line)) for kind, line in walls + edges]


def _with_corners(box: Box, planes: list[FloatArray]) -> Box:
    """The box with the corners and sides of the board in it, but those far away; and a margin."""
    left, right, low, high = box
    size = max(right - left, high - low)
    points = []
    for n, one in enumerate(planes):
        middle = np.array([0.5 * (left + right), 0.5 * (low + high)])
        points.append(middle - (one[:2] @ middle - one[2]) * one[:2])
        for other in planes[:n]:
            across = one[0] * other[1] - one[1] * other[0]
            if abs(across) > 1e-9:
                points.append(np.linalg.solve(np.array([one[:2], other[:2]]), [one[2], other[2]]))
    for x, y in points:
        inside = all(plane[0] * x + plane[1] * y >= plane[2] - 1e-6 * size for plane in planes)
        if inside and max(left - x, x - right, low - y, y - high) <= _FAR * size:
            left, right, low, high = min(left, x), max(right, x), min(low, y), max(high, y)
    margin = 0.03 * max(right - left, high - low)
    sides = left - margin, right + margin, low - margin, high + margin
    return Box(*map(float, sides))


def _lines(planes: list[tuple[str, FloatArray]], box: Box) -> list[StraightPart]:
    """The parts of walls and edges that are in sight and border the field."""
    left, right, low, high = box
    sides: list[Any] = [(1.0, 0.0, left), (-1.0, 0.0, -right), (0.0, 1.0, low), (0.0, -1.0, -high)]
    lines = []
    for kind, plane in planes:
        nx, ny, at = plane
        start, end = -math.inf, math.inf
        others = [other for _, other in planes if other is not plane]
        for ox, oy, other_at in [*others, *sides]:  # along (-ny, nx) from the foot of the line
            slope = oy * nx - ox * ny
            over = other_at - at * (ox * nx + oy * ny)
            if abs(slope) < 1e-12:
                inside = over <= 1e-9 * (right - left)
                start, end = (start, end) if inside else (math.inf, -math.inf)
            elif slope > 0.0:
                start = max(start, over / slope)
            else:
                end = min(end, over / slope)
        if start < end:
            ends = np.array([start, end])
            x, y = at * nx - ends * ny, at * ny + ends * nx
            lines.append(StraightPart(kind, (float(x[0]), float(x[1])), (float(y[0]), float(y[1]))))
    return lines
