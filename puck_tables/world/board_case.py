"""A board of which only launches still vary: where all pucks end, of many launches."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import PuckError
from puck_tables.scene.entries import is_batch, launch_paths
from puck_tables.scene.loop import AT_REST, EVENT_LIMIT, OVER_EDGE, STEP_LIMIT, TIME_UP
from puck_tables.scene.outcome import IMPACTS_WITHOUT_END, TOO_FAST, UNSOLVED
from puck_tables.scene.run import STATE, residual
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import called, pieces_of, refuse_endless
from puck_tables.world.bulk import Ends, follow_all
from puck_tables.world.engine import CROWDED, OFF_TABLE, PUSHING, REACHED, TANGLED, TOO_SHORT
from puck_tables.world.ledger import energies_of
from puck_tables.world.outcome import ways_of
from puck_tables.world.prepare import game_of, order_of
from puck_tables.world.rim_laws import rule_of
from puck_tables.world.simulate import MISSED
from puck_tables.world.world import World

_LAUNCH = re.compile(r"(?:puck\[(\d+)\]\.)?launch\.(velocity\[[01]\]|spin)")
_PARTS = ("velocity[0]", "velocity[1]", "spin")
_ENDS = {
    CROWDED: EVENT_LIMIT,
    TANGLED: IMPACTS_WITHOUT_END,
    OFF_TABLE: TOO_FAST,
    TOO_SHORT: STEP_LIMIT,
}
_FAILED = -1  # beside how the engine ends: a run of its own that failed


class BoardCase:
    """A board of which only launches still vary.

    ``model``, ``explanation``: how its pucks are moved.

    Raises
    ------
    InputError
        If nothing on it ever comes to rest, and no time is given.
    """

    def __init__(self, scene: SceneSpec) -> None:
        self.scene, self.pieces = scene, pieces_of(scene)
        refuse_endless(scene)
        count = len(self.pieces)
        self.model = f"{count} puck{'s' if count > 1 else ''} from impact to impact"
        self.explanation = f"{ways_of(scene)}\n{rule_of(scene)}"
        self.until = math.inf if scene.time is None else scene.time
        order = order_of(scene)
        self.game, room = game_of(scene, order)
        self.first, self.place = room.states.copy(), np.argsort(order)

    @staticmethod
    def names(scene: SceneSpec) -> tuple[str, ...]:
        """What its pucks are called; of a scene of one puck none, it has no dimension of them."""
        return tuple(called(piece, number) for number, piece in enumerate(scene.pucks))

    @staticmethod
    def columns(scene: SceneSpec) -> dict[str, tuple[int, ...]]:
        """What is known of an end, by name, and its shape."""
        each: tuple[int, ...] = (len(scene.pucks),) if scene.pucks else ()
        found = dict.fromkeys((*STATE, "in_play"), each)
        return found | dict.fromkeys(("end_time", "impacts"), ())

    @staticmethod
    def launches(scene: SceneSpec, path: str) -> tuple[str, ...]:
        """The velocities and spins that an axis changes, if it changes nothing else.

        At the start: of later launches more depends on it than a velocity.
        """
        paths: tuple[str, ...] = (path,)
        if is_batch(path):
            values = scene.ranges[path]
            if (values[:, 3:] != values[0, 3:]).any():
                return ()
            paths = launch_paths(path)[:3]
        pieces, found = pieces_of(scene), []
        for one in paths:
            match = _LAUNCH.fullmatch(one)
            piece = pieces[int(match[1] or 0)] if match is not None else None
            if piece is None or piece.launch.time > 0.0 or piece.path or piece.constraint:
                return ()
            found.append(one)
        return tuple(found)

    @staticmethod
    def advice(scene: SceneSpec, code: int) -> str:
        """What to do about runs that have no end."""
        return "run it alone, which says what to do"

    def ends(
        self, launches: Mapping[str, FloatArray], count: int
    ) -> tuple[dict[str, FloatArray], npt.NDArray[np.int8]]:
        """Results (count, …) and how it ended.

        Raises
        ------
        InputError
            If one of these launches is too fast for what can be told.
        """
        parts = {path: _part(path) for path in launches}
        numbers = sorted({number for number, _ in parts.values()})
        starts = np.empty((count, len(numbers), 3))
        for m, number in enumerate(numbers):
            launch = self.pieces[number].launch
            starts[:, m] = *(launch.velocity or (0.0, 0.0)), launch.spin
        for path, values in launches.items():
            number, part = parts[path]
            starts[:, numbers.index(number), part] = values
        discs = self.place[np.array(numbers, np.int64)]
        ends = follow_all(self.game, self.first, discs, starts, self.until)
        for run in np.flatnonzero(ends.how == PUSHING).tolist():  # or much happens
            self._run({path: float(values[run]) for path, values in launches.items()}, run, ends)
        return self._columns(ends)

    def _columns(self, ends: Ends) -> tuple[dict[str, FloatArray], npt.NDArray[np.int8]]:
        states = np.concatenate([ends.states, ends.in_play[:, :, None]], axis=2)[:, self.place]
        moving = (states[:, :, 3:6] != 0.0).any(axis=(1, 2))
        status = np.where(moving, TIME_UP, AT_REST).astype(np.int8)
        for how, code in (_ENDS | {_FAILED: UNSOLVED}).items():
            status[ends.how == how] = code
        each = states if self.scene.pucks else states[:, 0]
        out = {name: each[..., n] for n, name in enumerate((*STATE, "in_play"))}
        out |= {"end_time": ends.time, "impacts": ends.impacts.astype(np.float64)}
        for values in out.values():
            values[status > OVER_EDGE] = np.nan
        return out, status

    def _run(self, numbers: Mapping[str, float], run: int, ends: Ends) -> None:
        """A run in which pucks push each other, or in which very much happens."""
        try:
            world = World(self.scene.at(numbers))
            world.advance(self.until)
            if world.groups > 0:  # what simulate refuses by its ledger
                now = energies_of(world, np.array([world.time]))
                if not residual(now) <= MISSED:
                    raise PuckError
        except PuckError:
            ends.how[run] = _FAILED
            return
        order, last = np.argsort(self.place), world.state()
        last[~world.moving, 3:] = 0.0
        ends.states[run], ends.in_play[run] = last[order], world.in_play[order]
        ends.time[run] = min(world.last_motion, self.until)
        ends.impacts[run] = sum(event.what == "impact" for event in world.events_since(0.0))
        ends.how[run] = REACHED


def _part(path: str) -> tuple[int, int]:
    """Which puck a number of a launch is of, and which of its velocities and spin it is."""
    match = _LAUNCH.fullmatch(path)
    assert match is not None
    return int(match[1] or 0), _PARTS.index(match[2])
