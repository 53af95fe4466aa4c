"""What an aim on a board is at: which puck is sent off, and which is to end where.

And how likely a launch does what it is for, where nobody hits it exactly.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, positive, real, whole
from puck_tables.bulk.summary import Chance, chance_of
from puck_tables.errors import InputError, PuckError
from puck_tables.scene.parts import Floor, Force
from puck_tables.scene.pucks_and_posts import ScenePuck
from puck_tables.scene.run import number_of
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import disagreements, has_closed_forms, refuse_endless
from puck_tables.world.named_pucks import called, names_of, pucks_of, start_of
from puck_tables.world.obstacles import obstacle_names
from puck_tables.world.placement import TOUCH, obstructing
from puck_tables.world.worlds import Worlds

_LEAST_SHARE = 0.75  # of f m g, over the way of a puck with δ ≤ 1: what friction takes at least


class Target(NamedTuple):
    """The numbers of the striker, the puck, and of one to be hit (−1: any); where it is to end.

    ``place`` m: the centre of the pocket if ``pocket`` ≥ 0.
    """

    striker: int
    puck: int
    through: int
    place: tuple[float, float]
    pocket: int

    def obstacle(self, scene: SceneSpec) -> int:
        """The pocket as the engine calls it."""
        return -1 - obstacle_names(scene).index(f"pocket {self.pocket}")


def target_of(
    scene: SceneSpec, target: npt.ArrayLike | None, pocket: int | str | None,
    puck: int | str | None, striker: int | str | None, hits: int | str | None,
) -> Target:  # fmt: skip
    """The numbers of what a caller names.

    Raises InputError if there is no such thing, it is not clear which is meant, or nothing can lie
    there.
    """
    faults = disagreements(scene.single())
    if faults:
        raise InputError("\n  ".join(["aim on a board:", *faults]))
    refuse_endless(scene)
    if any(scene.floor.velocity) or scene.floor.turning != 0.0:
        raise InputError("aim is for boards on which pucks come to rest, not for a moving floor")
    pucks = pucks_of(scene)
    names = names_of(scene)
    sent = _striker(pucks, names, striker)
    aimed = _puck(pucks, names, puck, sent)
    through = -1
    if hits is not None:
        through = number_of(hits, names)
        if through in (aimed, sent):
            itself = "the striker" if through == sent else "the puck that is to end there"
            raise InputError(f"hits = {names[through]}: this is {itself} itself, name another")
    if (target is None) == (pocket is None):
        fault = "both are given" if target is not None else "neither is given"
        raise InputError(f"target or pocket says where {names[aimed]} is to end: {fault}, give one")
    if pocket is not None:
        number = _pocket(scene, pocket)
        return Target(sent, aimed, through, scene.pockets[number].point, number)
    place = finite_array("target", target if target is not None else (), "m")
    if place.shape != (2,):
        raise InputError(f"target must be one place (x, y) in m, got shape {place.shape}")
    x, y = place.tolist()
    _refuse_where_nothing_lies(scene, (x, y), pucks[aimed].radius, names[aimed])
    return Target(sent, aimed, through, (x, y), -1)


def _striker(pucks: tuple[ScenePuck, ...], names: tuple[str, ...], wanted: int | str | None) -> int:
    """The puck that is named, or the one that the scene sends off."""
    if wanted is None:
        moving = [
            number for number, puck in enumerate(pucks)
            if puck.launch.velocity not in (None, (0.0, 0.0)) or puck.launch.spin != 0.0
        ]  # fmt: skip
        if len(pucks) == 1:
            moving = [0]
        if len(moving) != 1:
            which = "none" if not moving else ", ".join(names[number] for number in moving)
            raise InputError(
                f"striker: which puck is to be sent off? The scene sends off {which}: name one"
            )
        number = moving[0]
    else:
        number = number_of(wanted, names)
    _refuse_driven(pucks, names, number, "be sent off")
    hold = pucks[number].constraint
    if hold is not None:
        raise InputError(
            f"striker {names[number]} is led by a {hold.kind}: aim is for pucks that go where they "
            "are sent"
        )
    if pucks[number].launch.time > 0.0:
        raise InputError(
            f"striker {names[number]} is sent off at {pucks[number].launch.time:g} s: aim is for "
            "launches at the start, set its launch.time to 0"
        )
    return number


def _puck(
    pucks: tuple[ScenePuck, ...], names: tuple[str, ...], wanted: int | str | None, striker: int
) -> int:
    """The puck that is named, or the only one that can be meant."""
    others = [n for n, puck in enumerate(pucks) if n != striker and not puck.path]
    if wanted is None:
        if len(others) > 1:
            raise InputError(
                f"puck: which is to end there? Name one of the {len(pucks)}, such as "
                f"{names[others[0]]}, or {names[striker]} itself"
            )
        return others[0] if others else striker
    number = number_of(wanted, names)
    _refuse_driven(pucks, names, number, "be aimed")
    return number


def _refuse_driven(
    pucks: tuple[ScenePuck, ...], names: tuple[str, ...], number: int, what: str
) -> None:
    if pucks[number].path:
        raise InputError(
            f"{names[number]} is driven along its path and cannot {what}: name another"
        )


def _pocket(scene: SceneSpec, wanted: int | str) -> int:
    """The number of a pocket, from itself or from 'pocket 2'."""
    count = len(scene.pockets)
    if not count:
        raise InputError("pocket: the board has none; give a target (x, y), or add [[pocket]]")
    text = str(wanted).removeprefix("pocket ").strip()
    if isinstance(wanted, bool) or not text.isascii() or not text.isdecimal() or int(text) >= count:
        numbers = "one, 0" if count == 1 else f"{count}, from 0 to {count - 1}"
        raise InputError(f"no pocket {wanted!r}: the board has {numbers}")
    return int(text)


def _refuse_where_nothing_lies(
    scene: SceneSpec, place: tuple[float, float], radius: float, name: str
) -> None:
    """Refuse a place in a cushion, a post, a pocket or over an edge."""
    for path, what, depth in obstructing(scene, place, radius, holes=True):
        hint = f", or ask for pocket {path[7:-1]}" if path.startswith("pocket") else ""
        raise InputError(
            f"target {list(place)}: {name} cannot rest there, with {path} in the way it {what} by "
            f"{depth:.3g} m: choose another place{hint}"
        )


def lying_there(scene: SceneSpec, target: Target) -> str:
    """Who lies so close to the target that it would have to be moved away; '' if nobody does."""
    pucks = pucks_of(scene)
    radius = pucks[target.puck].radius
    for number, puck in enumerate(pucks):
        if number in (target.puck, target.striker) or target.pocket >= 0 or puck.path:
            continue
        if math.dist(start_of(puck), target.place) < (radius + puck.radius) * (1.0 - TOUCH):
            return called(puck, number)
    return ""


def without_pocket(scene: SceneSpec, target: Target) -> SceneSpec | None:
    """The board without the pocket aimed at, None if none is.

    Launches that stop where its middle was fall in, also where few do.
    """
    if target.pocket < 0:
        return None
    left = scene.pockets[: target.pocket] + scene.pockets[target.pocket + 1 :]
    return replace(scene, pockets=left)


def out_of_reach(scene: SceneSpec, target: Target, speed: float, spin: float) -> str:
    """Why no launch up to a speed and spin can exist, in words; '' where that is not known.

    Friction takes at least f m g times the way that the mean slip of the base goes, and that is no
    shorter than (1 − δ²/4) of the way of the centre: 3/4 of it for a plain puck with δ ≤ 1, all of
    it for a flat one on any base.  No impact gives energy.
    """
    pucks = pucks_of(scene)
    striker, puck = pucks[target.striker], pucks[target.puck]
    others = [puck for number, puck in enumerate(pucks) if number != target.striker]
    at_rest = not any(
        one.path or one.launch.velocity not in (None, (0.0, 0.0)) or one.launch.spin
        for one in others
    )
    plain = all(
        one.height == 0.0 if one.shape is not None
        else has_closed_forms(one, one.friction) and one.delta <= 1.0
        for one in (striker, puck)
    )  # fmt: skip
    pushed = scene.floor != Floor() or any(one.force != Force() for one in pucks)
    if not (at_rest and plain) or pushed:
        return ""
    distance = math.dist(start_of(puck), target.place)
    if target.pocket >= 0:
        distance = max(distance - scene.pockets[target.pocket].radius, 0.0)
    legs = [(puck, distance)]
    if target.puck != target.striker:
        gaps = (
            math.dist(start_of(striker), start_of(one)) - striker.radius - one.radius
            for one in others
        )
        legs.append((striker, max(min(gaps), 0.0)))
    needed = sum(_LEAST_SHARE * one.decel * one.mass * length for one, length in legs)
    rim = striker.inertia_radius * spin
    energy = 0.5 * striker.mass * (speed * speed + rim * rim)
    if energy >= needed:
        return ""
    return (
        f"exists: friction takes at least {needed:.4g} J until {puck.name or 'the puck'} is there, "
        f"and such a launch has at most {energy:.4g} J"
    )


_TRIED = 400  # runs of each aim that is tried
_ROUNDS = 12  # of steps of the search, which are halved where none helps


class Odds(NamedTuple):
    """Chances of a launch as it was found, and of the best aim beside it.

    ``nominal`` and ``best``: shares of the same ``count`` scattered runs, with 95 % intervals;
    ``velocity`` (vx, vy) m/s and ``spin`` rad/s: what to aim at for the best.  ``failed``: runs
    that could not be followed to their end, which count as misses.
    """

    nominal: Chance
    best: Chance
    velocity: tuple[float, float]
    spin: float
    failed: int

    def __str__(self) -> str:
        (vx, vy), degrees = self.velocity, math.degrees(1.0)
        aim = f"{math.hypot(vx, vy):.6g} m/s, heading {degrees * math.atan2(vy, vx):.5g} deg"
        lost = f"\n{self.failed} runs could not be followed to their end: misses"
        return (
            f"scattered so, the launch does it with a chance of {_words(self.nominal)}\n"
            f"the best aim found, {aim}, spin {self.spin:.5g} rad/s, with {_words(self.best)}"
            f"{lost if self.failed else ''}"
        )

    def summary(self) -> dict[str, Any]:
        """Chances and aim, ready for JSON."""
        chances = {"nominal": self.nominal._asdict(), "best": self.best._asdict()}
        return self._asdict() | chances


def _words(chance: Chance) -> str:
    return f"{chance.value:.3g} (95 %: {chance.low:.3g} to {chance.high:.3g})"


class _Trials:
    """A board on which a launch is tried, scattered."""

    def __init__(
        self, scene: SceneSpec, wanted: Target, scatter: FloatArray, within: float
    ) -> None:
        self._start, self._wanted, self._scatter = Worlds(scene, 1), wanted, scatter
        self._within, self._until = within, math.inf if scene.time is None else scene.time
        self.failed = 0

    def hits(self, centre: FloatArray, draws: FloatArray) -> npt.NDArray[np.bool_]:
        """Which runs with heading, speed, spin about a centre (3,) do it; draws (runs, 3)."""
        heading, share, spin = (self._scatter * draws).T
        speed = centre[1] * (1.0 + share)
        boards, runs = self._start.copy(np.zeros(len(draws), int)), np.arange(len(draws))
        velocities = speed[:, None] * _along(centre[0] + heading)
        boards.strike(self._wanted.striker, velocities, centre[2] + spin)
        reached = np.zeros(len(draws), bool)
        while runs.size:
            try:
                boards.advance(self._until)
                reached[runs] = self._ends(boards)
                break
            except PuckError as error:
                if not error.boards:
                    raise
                left = np.setdiff1d(np.arange(len(runs)), error.boards)
                runs, boards = runs[left], boards.copy(left) if left.size else boards
        self.failed = len(draws) - len(runs)
        return reached

    def _ends(self, boards: Worlds) -> npt.NDArray[np.bool_]:
        """On which boards the puck is where it is to be."""
        wanted = self._wanted
        if wanted.pocket < 0:
            places = boards.state()[:, wanted.puck, :2]
            near = np.hypot(*(places - wanted.place).T) <= self._within
            return np.asarray(near & boards.in_play[:, wanted.puck])
        events, fallen = boards.events, np.zeros(len(boards), bool)
        mine = (events["what"] == "pocket") & (events["puck"] == boards.names[wanted.puck])
        mine &= events["partner"] == f"pocket {wanted.pocket}"
        fallen[events["board"][mine]] = True
        return fallen


def _along(heading: FloatArray) -> FloatArray:
    return np.stack([np.cos(heading), np.sin(heading)], axis=-1)


def odds_of(
    scene: SceneSpec, wanted: Target, start: FloatArray, heading: float, speed: float, spin: float,
    within: float | None, count: int, seed: int,
) -> Odds:  # fmt: skip
    """The odds of a launch (heading, speed, spin): see ``BoardAim.odds``."""
    pairs = (("heading", heading, "rad"), ("speed", speed, "1"), ("spin", spin, "rad/s"))
    scatter = np.array([real(name, value, unit) for name, value, unit in pairs])
    if (scatter < 0.0).any() or not scatter.any():
        raise InputError("heading, speed and spin scatter by 0 or more, and one of them by more")
    if (within is None) == (wanted.pocket < 0):
        words = "give within, m: how near" if within is None else "leave within out: a pocket is"
        raise InputError(f"{words} the puck is to end")
    near = 0.0 if within is None else positive("within", within, "m")
    count, seed = whole("count", count, _TRIED), whole("seed", seed, 0)
    if pucks_of(scene)[wanted.striker].launch.time > 0.0:
        raise InputError("odds are of a striker that is sent off at once: launch.time is 0")
    drawn = np.random.default_rng(seed).normal(size=(2, count, 3))
    boards = _Trials(scene, wanted, scatter, near)
    best = _climb(boards, start, scatter * [1.0, start[1], 1.0], drawn[0, :_TRIED])
    reached = boards.hits(start, drawn[1]).sum()
    failed, better = boards.failed, boards.hits(best, drawn[1]).sum()
    if better > reached:
        failed = boards.failed
    else:
        best, better = start, reached
    vx, vy = (best[1] * _along(best[:1])[0]).tolist()
    chances = chance_of(int(reached), count), chance_of(int(better), count)
    return Odds(*chances, (vx, vy), float(best[2]), failed)


def _climb(
    boards: _Trials, start: FloatArray, step: FloatArray, draws: FloatArray
) -> FloatArray:  # fmt: skip
    """The aim with the most hits of the same draws, from step to step."""
    centre, most = start, boards.hits(start, draws).sum()
    for _ in range(_ROUNDS):
        moves = [sign * row for row in np.diag(step) if row.any() for sign in (1.0, -1.0)]
        hits = [boards.hits(centre + move, draws).sum() for move in moves]
        if max(hits) > most:
            centre, most = centre + moves[int(np.argmax(hits))], max(hits)
        else:
            step = 0.5 * step
    return centre
