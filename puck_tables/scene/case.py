"""A scene of which only the launch still varies: the ends of many launches."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.scene.agreement import launch_velocity
from puck_tables.scene.bulk import ENDS_COLUMNS
from puck_tables.scene.by_speed import FARTHER, FARTHEST
from puck_tables.scene.entries import BATCH, LAUNCH, launch_paths
from puck_tables.scene.equations import SIZE
from puck_tables.scene.friction import SPIN, THETA, VX, VY, X, Y
from puck_tables.scene.outcome import (
    AT_REST,
    CARRIED_AWAY,
    LEDGER,
    NO_END,
    NOT_FINITE,
    OVER_EDGE,
    TIME_UP,
)
from puck_tables.scene.plan import plan_for
from puck_tables.scene.prepare import Prepared, prepare
from puck_tables.scene.run import ledger
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.simulate import FAILURES, is_endless
from puck_tables.stopping.stops import stop

STATE = (VX, VY, SPIN, X, Y, THETA)  # where the numbers of LAUNCH stand in a state
RESULTS = (*LEDGER[1:], "in_play", "impacts", "energy_residual", "end_time")


class Case:
    """A scene of which only the launch still varies.

    ``model``, ``explanation``: the model that is taken, and why.

    Raises
    ------
    InputError
        If no model holds for it.
    """

    def __init__(self, scene: SceneSpec) -> None:
        plan = plan_for(scene)
        by_look_up = plan.plain and scene.time is None
        self.scene, self.explanation = scene, plan.why
        self.model = "free pucks: stop look-up" if by_look_up else plan.model
        self.endless = is_endless(scene)
        self.prepared: Prepared | None = None if by_look_up else prepare(scene)

    @staticmethod
    def names(scene: SceneSpec) -> tuple[str, ...]:
        """None: its results have no dimension of pucks."""
        return ()

    @staticmethod
    def columns(scene: SceneSpec) -> dict[str, tuple[int, ...]]:
        """What is known of an end, by name, and its shape."""
        return dict.fromkeys(RESULTS, ())

    @staticmethod
    def launches(scene: SceneSpec, path: str) -> tuple[str, ...]:
        """The numbers of the launch that an axis changes, if nothing has to be checked for them."""
        moves = path.startswith("launch.position") or path == BATCH
        fixed = moves and bool(scene.walls or scene.edges)
        if path not in (*LAUNCH, BATCH) or scene.constraint is not None or fixed:
            return ()
        return launch_paths(path) if path == BATCH else (path,)

    @staticmethod
    def advice(scene: SceneSpec, code: int) -> str:
        """What to do about runs that have no end."""
        if code == NO_END:
            return "none by a thousand times its time scale, it may never stop; give a time"
        if code == NOT_FINITE and scene.floor.law:
            return "its rim slips faster than the friction law goes; give the law more speeds"
        return FAILURES[code].partition(": ")[2] or FAILURES[code]

    def ends(
        self, launches: Mapping[str, FloatArray], count: int
    ) -> tuple[dict[str, FloatArray], npt.NDArray[np.int8]]:
        """Results (count,) and how it ended.

        Raises
        ------
        InputError
            If one of these launches is no launch of this scene.
        """
        scene = self.scene
        states = np.zeros((count, SIZE))
        states[:, [X, Y]], states[:, THETA] = scene.launch.position, scene.launch.orientation
        states[:, [VX, VY]], states[:, SPIN] = launch_velocity(scene), scene.launch.spin
        for path, values in launches.items():
            states[:, STATE[LAUNCH.index(path)]] = values
        mass = scene.puck.mass
        inertia = mass * (scene.puck.gyration * scene.puck.radius) ** 2
        with np.errstate(over="ignore"):  # of launches that leave floating point
            energy = 0.5 * mass * (states[:, VX] ** 2 + states[:, VY] ** 2)
            energy += 0.5 * inertia * states[:, SPIN] ** 2
        status = np.empty(count, np.int8)
        rows = np.empty((ENDS_COLUMNS, count))
        if self.endless:
            status[:] = NO_END
        elif self.prepared is None:
            self._look_up(states, rows, status)
        else:
            self.prepared.follow_all(states, rows, status)
            self._farther(states, rows, status)
            if scene.time is None:
                status[status == TIME_UP] = NO_END
        rows[:, status > OVER_EDGE] = np.nan  # how it failed stands in ``end``
        last = dict(zip(LEDGER[:-1], rows[:-1], strict=True))
        last["kinetic_energy"] = 0.5 * mass * (last["vx"] ** 2 + last["vy"] ** 2)
        last["kinetic_energy"] += 0.5 * inertia * last["spin"] ** 2
        if self.prepared is None:  # nothing is integrated: heat is what else is not there
            last["heat_dry"][:] = energy + last["work_support"] - last["kinetic_energy"]
        with np.errstate(all="ignore"):  # runs that failed are not a number
            missing, largest = ledger({**last, "energy_given": energy})
            residual = missing / np.where(largest > 0.0, largest, 1.0)
        in_play = (status != OVER_EDGE).astype(np.float64)
        in_play[status > OVER_EDGE] = np.nan
        last |= {"in_play": in_play, "impacts": rows[-1], "energy_residual": residual}
        last["end_time"] = last.pop("time")
        return last, status

    def _farther(self, states: FloatArray, rows: FloatArray, status: npt.NDArray[np.int8]) -> None:
        """Those that slip faster than the table of a friction law by name, by one that goes on."""
        reach = 1.0
        while isinstance(self.scene.floor.law, FrictionLaw) and reach < FARTHEST:
            beyond = np.flatnonzero(status == NOT_FINITE)
            if not beyond.size:
                return
            reach *= FARTHER
            part, how = np.empty((len(rows), beyond.size)), np.empty(beyond.size, np.int8)
            prepare(self.scene, reach=reach).follow_all(states[beyond], part, how)
            rows[:, beyond], status[beyond] = part, how

    def _look_up(self, states: FloatArray, rows: FloatArray, status: npt.NDArray[np.int8]) -> None:
        belt = self.scene.floor.velocity
        velocities, spins = states[:, [VX, VY]] - belt, states[:, SPIN]
        stops = stop(velocities, spins, **self.scene.puck.arguments(), tol=self.scene.tol)
        rows[...] = 0.0
        last = dict(zip(LEDGER[:-1], rows[:-1], strict=True))
        last["time"][:] = stops.stop_time
        for i, name in enumerate(("x", "y")):
            last[name][:] = states[:, i] + stops.stop_position[:, i] + belt[i] * stops.stop_time
            last["v" + name][:] = belt[i]
            last["work_support"][:] += (
                self.scene.puck.mass * belt[i] * (belt[i] - states[:, VX + i])
            )
        last["orientation"][:] = states[:, THETA] + stops.body_angle
        last["carried"][:] = 1.0
        status[:] = np.where(stops.status == 0, CARRIED_AWAY if any(belt) else AT_REST, NOT_FINITE)


def told_apart(puck: PuckSpec) -> dict[str, Any]:
    """What tells a pressure law that is given as an object from another."""
    law = puck.body.law
    ratios = np.stack(law.friction(np.linspace(0.0, 0.5 * np.pi, 99), 0.0))
    return {"name": law.name, "edges": law.edges, "profile": law.profile, "friction": ratios}
