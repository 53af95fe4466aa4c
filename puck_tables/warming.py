"""What a game or a service calls, compiled before anybody waits for it."""

from __future__ import annotations

import sys
from collections.abc import Callable

from puck_tables.bulk.spreads import Normal
from puck_tables.kernels.patience import compiled_at_once
from puck_tables.puck import Puck
from puck_tables.scene.parts import Floor, Launch, Patch, Wall
from puck_tables.world.scene import Scene
from puck_tables.world.worlds import Worlds

_PUCKS = [Puck(0.04, 0.02, 0.15), Puck(0.04, 0.02, 0.15, pressure="ring")]
_LAUNCH = (1.0, 0.2), 5.0  # m/s, rad/s: any that is neither pure sliding nor pure spin


def _motions() -> None:
    for puck in _PUCKS:
        for tol in (1e-9, 1e-4):
            puck.simulate(*_LAUNCH, tol=tol)


def _stops() -> None:
    for puck in _PUCKS:
        for jacobian in (False, True):
            puck.stop([_LAUNCH[0]] * 2, _LAUNCH[1], jacobian=jacobian)
        puck.stop([_LAUNCH[0]] * 100, _LAUNCH[1])  # another way than that for two
        puck.stop([_LAUNCH[0]] * 2, _LAUNCH[1], tol=1e-4)


def _states() -> None:
    for puck in _PUCKS:
        puck.states(*_LAUNCH, 0.1)
        for jacobian in (False, True):
            puck.states([_LAUNCH[0]] * 2, _LAUNCH[1], [0.1, 0.2], jacobian=jacobian)


def _aims() -> None:
    for puck in _PUCKS:
        puck.aim([(0.2, 0.1), (0.1, 0.0)], spin=1.0).explain()


def _scenes() -> None:
    scene = Scene(_PUCKS[0], floor=Floor(slope=0.02), launch=Launch(*_LAUNCH))
    scene.simulate()
    wet = Patch(0.05, centre=(0.2, 0.0), radius=0.1)  # a base over two frictions is summed
    Scene(_PUCKS[0], floor=Floor(patches=(wet,)), launch=Launch(*_LAUNCH)).simulate()
    scene.sample(2, 1, {"launch.spin": Normal(5.0, 0.1)})
    Scene.load("skate-blade").simulate()  # what a constraint gives is a column of its own


def _boards() -> None:
    for scene in (_board(), _table()):
        world = scene.world()
        world.advance(2.0)
        world.state()


def _boards_of_many() -> None:
    one, two = (Puck(0.04, friction=0.1, launch=Launch(position=(x, 0.0))) for x in (0.0, 0.2))
    Scene(pucks=(one, two)).aim((0.5, 0.0), puck=1, striker=0, max_speed=2.0)
    worlds = Worlds(_table(), 2)
    worlds.strike(0, (0.5, 0.0))
    worlds.advance(0.1)
    worlds.state()


def _board() -> Scene:
    """Two pucks that slide down to a cushion and push each other there."""
    sent, there = Launch((1.0, 0.0)), Launch(position=(0.1, 0.01))
    one, two = (Puck(0.04, friction=0.1, restitution=0.2, launch=n) for n in (sent, there))
    wall = Wall((0.3, 0.0), normal=(-1.0, 0.0), restitution=0.2)
    return Scene(pucks=(one, two), floor=Floor(slope=0.3), walls=(wall,))


def _table() -> Scene:
    """Two pucks that meet on a level floor."""
    sent, there = Launch((1.0, 0.0)), Launch(position=(0.2, 0.01))
    return Scene(pucks=tuple(Puck(0.04, friction=0.1, launch=n) for n in (sent, there)))


_PARTS: tuple[tuple[str, Callable[[], None]], ...] = (
    ("motions of a puck", _motions),
    ("stops", _stops),
    ("states", _states),
    ("aims", _aims),
    ("scenes of one puck", _scenes),
    ("boards, and pucks that push each other", _boards),
    ("many runs of a board, and aims on it", _boards_of_many),
)


def warm_up() -> None:
    """Compile what games and services call, once for this machine; stderr says how far it is.

    It takes some minutes, or a second where it was done before.  Without it nothing is missing: a
    question is answered at once, and what takes longer is compiled when it is first asked, with a
    line on stderr.
    """
    with compiled_at_once():
        for number, (what, part) in enumerate(_PARTS, 1):
            if sys.stderr is not None:
                sys.stderr.write(f"warming up, {number} of {len(_PARTS)}: {what}\n")
            part()
