"""A board of which only launches still vary: where all pucks end, of many launches."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import ContactError, InputError, PuckError, SpeedError
from puck_tables.scene.by_speed import end_of_laws
from puck_tables.scene.entries import is_batch, launch_paths
from puck_tables.scene.run import (
    AT_REST,
    CARRIED_AWAY,
    CARRIED_ROUND,
    ENDS,
    EVENT_LIMIT,
    IMPACTS_WITHOUT_END,
    IN_POCKET,
    LAST_END,
    NO_END,
    OVER_EDGE,
    STATE,
    STEP_LIMIT,
    TIME_UP,
    TIPPED,
    TOO_FAST,
    UNSOLVED,
    ledger,
    residual,
)
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import refuse_endless
from puck_tables.world.bulk import Ends, follow_all
from puck_tables.world.engine_state import Engine, Whole, copy_of
from puck_tables.world.floor_under import SURE, law_goes_to, moves_along
from puck_tables.world.floors import velocities_under
from puck_tables.world.lasting import LEADS_ON, NEVER_ENDS, ROUND
from puck_tables.world.layout import RADIUS
from puck_tables.world.ledger import NAMES, energies_of, energy_scale, kinetic_of, ledgers_of
from puck_tables.world.named_pucks import names_of, pucks_of
from puck_tables.world.plan import plan_of
from puck_tables.world.prepare import prepared, with_law_up_to
from puck_tables.world.record import reactions
from puck_tables.world.setting_off import CROWDED, OFF_TABLE, PUSHING, TANGLED, TOO_SHORT
from puck_tables.world.simulate import MISSED, columns_of, run_on
from puck_tables.world.world import World

_LAUNCH = re.compile(r"(?:puck\[(\d+)\]\.)?launch\.(velocity\[[01]\]|spin)")
_PARTS = ("velocity[0]", "velocity[1]", "spin")
_ENDS = {
    CROWDED: EVENT_LIMIT,
    TANGLED: IMPACTS_WITHOUT_END,
    OFF_TABLE: TOO_FAST,
    TOO_SHORT: STEP_LIMIT,
    ROUND: CARRIED_ROUND,
    NEVER_ENDS: NO_END,
    LEADS_ON: NO_END,
}
_ON_EDGE = 1e-6  # of the radius: who left play there left it over an edge, or into a pocket


class BoardCase:
    """A board of which only launches still vary.

    ``runs``: of how many launches; ``model``, ``explanation``: how its pucks are moved.

    Raises InputError if nothing on it ever comes to rest, and no time is given.
    """

    def __init__(self, scene: SceneSpec, runs: int = 1) -> None:
        self.scene, self.pucks, self.runs = scene, pucks_of(scene), runs
        refuse_endless(scene)
        self.model, self.explanation = plan_of(scene)
        self.until = math.inf if scene.time is None else scene.time
        start = prepared(scene, runs=runs)
        self.engine, self.first, self.order = start.engine, start.states, start.order
        self.place = np.argsort(start.order)
        self._farther: dict[float, Engine] = {}  # by how far its friction law goes, m/s

    @staticmethod
    def names(scene: SceneSpec) -> tuple[str, ...]:
        """What its pucks are called; of a scene of one puck none, it has no dimension of them."""
        return names_of(scene) if scene.pucks else ()

    @staticmethod
    def columns(scene: SceneSpec) -> dict[str, tuple[int, ...]]:
        """What is known of an end, by name, and its shape."""
        each: tuple[int, ...] = (len(scene.pucks),) if scene.pucks else ()
        result = dict.fromkeys((*STATE, "in_play", "carried", "kinetic_energy"), each)
        if any(puck.constraint for puck in pucks_of(scene)):
            result |= dict.fromkeys(("lambda_1", "lambda_2"), each)
        shared = (*NAMES, "energy_residual", "end_time", "impacts")
        return result | dict.fromkeys(shared, ())

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
        pucks = pucks_of(scene)
        for one in paths:
            match = _LAUNCH.fullmatch(one)
            puck = pucks[int(match[1] or 0)] if match is not None else None
            if puck is None or puck.launch.time > 0.0 or puck.path or puck.constraint:
                return ()
        return paths

    @staticmethod
    def advice(scene: SceneSpec, code: int) -> str:
        """What to do about runs that have no end."""
        if code == NO_END:
            return "none by a hundred times its time scale, it may never stop; give a time"
        return "run it alone, which says what to do"

    def ends(
        self, launches: Mapping[str, FloatArray], count: int
    ) -> tuple[dict[str, FloatArray], npt.NDArray[np.int8]]:
        """Results (count, …) and how it ended.

        Raises InputError if one of these launches is too fast for what can be told.
        """
        parts = {path: _part(path) for path in launches}
        numbers = sorted({number for number, _ in parts.values()})
        starts = np.empty((count, len(numbers), 3))
        for m, number in enumerate(numbers):
            launch = self.pucks[number].launch
            starts[:, m] = *(launch.velocity or (0.0, 0.0)), launch.spin
        for path, values in launches.items():
            number, part = parts[path]
            starts[:, numbers.index(number), part] = values
        discs = self.place[np.array(numbers, np.int64)]
        ends = follow_all(self.engine, self.first, discs, starts, self.until)
        self._follow_faster(discs, starts, ends)
        status = self._status(ends)
        for run in np.flatnonzero(ends.how == PUSHING).tolist():  # or much happens
            numbers_of = {path: float(values[run]) for path, values in launches.items()}
            status[run] = self._run(numbers_of, run, ends)
        return self._columns(ends, status), status

    def _follow_faster(self, discs: Whole, starts: FloatArray, ends: Ends) -> None:
        """Follow those that set off faster than a friction law by name is tabulated.

        Its tables go to powers of two, so that no run depends on which others there are.
        """
        engine, top = self.engine, law_goes_to(self.engine.regions)
        end = math.inf if top == math.inf else end_of_laws(self.scene)[0]
        if top >= end:
            return
        slips = starts - velocities_under(engine, self.first)[discs]
        rims = engine.discs[discs, RADIUS] * np.abs(slips[..., 2])
        fastest = (np.hypot(slips[..., 0], slips[..., 1]) + rims).max(axis=1, initial=0.0) / SURE
        tops = np.minimum(np.exp2(np.ceil(np.log2(np.maximum(fastest, top)))), end)
        for farther in np.unique(tops[fastest >= top]).tolist():
            if farther not in self._farther:
                try:
                    own = with_law_up_to(
                        copy_of(engine), self.scene, self.order, farther, self.runs
                    )
                except ContactError:  # it lifts part of a base: a run alone says so
                    continue
                self._farther[farther] = own
            runs = np.flatnonzero((fastest >= top) & (tops == farther))
            faster = follow_all(self._farther[farther], self.first, discs, starts[runs], self.until)
            for into, part in zip(ends, faster, strict=True):
                into[runs] = part

    def _status(self, ends: Ends) -> npt.NDArray[np.int8]:
        """How each run ends, a place in :data:`puck_tables.scene.run.ENDS`."""
        moves = (ends.states[:, :, 3:6] != 0.0).any(axis=2) & (ends.in_play > 0.0)
        is_held = (ends.carried > 0.0) | ~moves
        if not moves_along(self.engine.surface):
            is_held[:] = False
        status = np.where(is_held.all(axis=1), CARRIED_AWAY, TIME_UP).astype(np.int8)
        status[~moves.any(axis=1)] = AT_REST
        if len(self.pucks) == 1:
            gone, places = ends.in_play[:, 0] == 0.0, ends.states[:, 0, :2]
            status[gone] = TIPPED
            for pocket in self.scene.pockets:
                away = np.hypot(*(places - pocket.point).T) - pocket.radius
                status[gone & (away <= _ON_EDGE * self.pucks[0].radius)] = IN_POCKET
            for edge in self.scene.edges:
                off = (places - edge.point) @ edge.normal / math.hypot(*edge.normal)
                near = off <= _ON_EDGE * self.pucks[0].radius
                status[gone & near] = OVER_EDGE
        for how, code in _ENDS.items():
            status[ends.how == how] = code
        return status

    def _columns(self, ends: Ends, status: npt.NDArray[np.int8]) -> dict[str, FloatArray]:
        columns = {name: ends.states[..., n] for n, name in enumerate(STATE)}
        columns |= {"in_play": ends.in_play, "carried": ends.carried}
        columns["kinetic_energy"] = kinetic_of(self.engine, ends.states)
        if any(puck.constraint for puck in self.pucks):
            forces = reactions(self.engine, ends.time, ends.states, ends.in_play)
            columns |= {"lambda_1": forces[..., 0], "lambda_2": forces[..., 1]}
        out = {
            name: values[:, self.place] if self.scene.pucks else values[:, 0]
            for name, values in columns.items()
        }
        out |= {name: ends.ledgers[:, n] for name, n in NAMES.items()}
        missing, largest = ledger(out)
        least = energy_scale(self.engine)
        out["energy_residual"] = missing / np.maximum(largest, least)
        out |= {"end_time": ends.time, "impacts": ends.impacts.astype(np.float64)}
        for values in out.values():
            values[status > LAST_END] = np.nan
        return out

    def _run(self, numbers: Mapping[str, float], run: int, ends: Ends) -> int:
        """A run in which pucks push each other, or in which very much happens; how it ends."""
        try:
            world = World(self.scene.at(numbers))
            end, ends.time[run] = run_on(world, None)
            if world.groups > 0:  # what simulate refuses by its ledger
                now = energies_of(world, np.array([world.time]), world.state()[None])
                if not residual(now, energy_scale(world._engine)) <= MISSED:
                    raise PuckError
        except SpeedError:
            return TOO_FAST
        except InputError:
            return NO_END
        except PuckError:
            return UNSOLVED
        order, last = np.argsort(self.place), columns_of(world, np.zeros(0), ends.time[run])
        for n, name in enumerate(STATE):
            ends.states[run, :, n] = last[name][-1, order]
        ends.in_play[run] = last["in_play"][-1, order]
        ends.carried[run] = last["carried"][-1, order]
        gone = len(self.pucks) == 1 and not world.in_play[0]
        when = np.nextafter(ends.time[run], 0.0) if gone else ends.time[run]
        ends.ledgers[run] = ledgers_of(world, np.array([min(when, world.time)]))[0]
        ends.impacts[run] = sum(event.what == "impact" for event in world.events_since(0.0))
        return ENDS.index(end)


def _part(path: str) -> tuple[int, int]:
    """Which puck a number of a launch is of, and which of its velocities and spin it is."""
    match = _LAUNCH.fullmatch(path)
    assert match is not None
    return int(match[1] or 0), _PARTS.index(match[2])
