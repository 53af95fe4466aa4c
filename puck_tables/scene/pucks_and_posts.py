"""What stands on a board besides straight cushions: pucks, posts, arcs and pockets.

Plain records, checked when a :class:`puck_tables.Scene` is made of them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from puck_tables._core.doubts import OF_A_PUCK
from puck_tables._core.fields import of, specs
from puck_tables._core.reading import entries_in, written
from puck_tables.errors import InputError
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.scene.parts import Constraint, Force, Launch, Rows
from puck_tables.scene.restitution import Restitution, restitution_of

_NOT_FREE = {"path", "force", "constraint"}  # what moves a puck besides friction


@dataclass(frozen=True, repr=False)
class ScenePuck(PuckSpec):
    """A puck as a board has it: named, sent, with a rim; :class:`puck_tables.Puck` adds verbs."""

    name: str = of("text", "")
    colour: str = of("colour", "", doc="in pictures and movies")
    launch: Launch = of("part", Launch(), part=Launch)
    restitution: float | str | Restitution = restitution_of(1.0, doc="of its rim")
    tangential: float = of(
        "number", -1.0, low=-1.0, high=1.0,
        doc="-1: smooth, 0: the rims stop on each other, 1: their slip reverses",
    )  # fmt: skip
    rim: float = of("number", math.inf, low=0.0, doc="friction of its rim")
    path: str | Rows = of(
        "rows", "", file="", doc="CSV or rows of t, x, y and perhaps angle: it is driven there"
    )
    force: Force = of("part", Force(), part=Force)
    constraint: Constraint | None = of("part", None, part=Constraint)

    def __repr__(self) -> str:
        """What it was given."""
        return written(self)

    @cached_property
    def only_on_boards(self) -> dict[str, Any]:
        """What it was given besides the numbers of a free puck, by name.

        >>> ScenePuck(0.02, friction=0.1, name="red").only_on_boards
        {'name': 'red'}
        """
        own = specs(PuckSpec)
        return {name: value for name, value in entries_in(self).items() if name not in own}

    def refuse_unless_free(self) -> None:
        """Refuse what asks how it slides by friction alone, where it would not."""
        super().refuse_unless_free()
        self.refuse_moved()

    def refuse_moved(self) -> None:
        """Refuse a puck that more than friction moves, where that would be left out."""
        for name in _NOT_FREE & self.only_on_boards.keys():
            raise InputError(
                f"this puck has a {name}, which acts in a scene alone: "
                "Scene(pucks=[puck]).simulate() follows it"
            )

    def __post_init__(self) -> None:
        launch = self.launch
        if not _is_many(launch):
            super().__post_init__()
            return
        # many launches are read, and checked, by the scene whose axis they are
        object.__setattr__(self, "launch", Launch())
        super().__post_init__()
        object.__setattr__(self, "launch", launch)
        object.__delattr__(self, "_checked")


def _is_many(launch: Any) -> bool:
    """Whether a launch has rows of velocities, or of places."""
    pairs = (getattr(launch, name, None) for name in ("velocity", "position"))
    return any(
        isinstance(pair, list | tuple | np.ndarray) and len(pair) > 0 and np.ndim(pair[0]) == 1
        for pair in pairs
    )


@dataclass(frozen=True)
class Post:
    """A round peg that the rims of pucks bounce off."""

    point: tuple[float, float] = of("pair", unit="m", doc="its centre")
    radius: float = of("number", unit="m", low=0.0, above=True, usual=OF_A_PUCK)
    restitution: float | str | Restitution = restitution_of(1.0)
    tangential: float = of("number", -1.0, low=-1.0, high=1.0, doc="as of a wall")
    friction: float = of("number", math.inf, low=0.0, doc="limits the tangential impulse")


@dataclass(frozen=True)
class Arc:
    """A round cushion that pucks bounce off from inside: a whole circle, or a part of one."""

    point: tuple[float, float] = of("pair", unit="m", doc="its centre")
    radius: float = of("number", unit="m", low=0.0, above=True)
    start: float = of("number", 0.0, "rad", doc="where it begins, seen from the centre, from x")
    span: float = of(
        "number", 2.0 * math.pi, "rad", low=0.0, high=2.0 * math.pi, above=True,
        doc="how far it goes, counter-clockwise",
    )  # fmt: skip
    restitution: float | str | Restitution = restitution_of(1.0)
    tangential: float = of("number", -1.0, low=-1.0, high=1.0, doc="as of a wall")
    friction: float = of("number", math.inf, low=0.0, doc="limits the tangential impulse")


@dataclass(frozen=True)
class Pocket:
    """A hole: a puck whose centre passes its rim leaves play.

    That is right for a puck much smaller than its hole.  One of radius r at a round hole of radius
    a rests on the chord between the points where the two rims cross, and tips when its centre
    passes that chord: at √(a² − r²) from the middle of the hole, which is then the radius to give.
    One as large as the hole does not fall.
    """

    point: tuple[float, float] = of("pair", unit="m", doc="its centre")
    radius: float = of("number", unit="m", low=0.0, above=True)


@dataclass(frozen=True)
class Line:
    """A line painted on the floor, straight or round, that tells who passes it and changes nothing.

    It is a goal mouth, a hog line, a ring of the house.  Events are "line", where the centre of a
    puck passes it, "entry" and "exit", where the rim comes over it and has left it.  Their
    ``approach`` is the speed across it in m/s, positive to the left of the way from start to end,
    or inwards: a goal is an "exit" with one of the right sign.

    >>> hog = Line((-6.401, -2.375), (-6.401, 2.375), name="hog line")
    >>> house = Line(centre=(0.0, 0.0), radius=1.829, name="house")
    """

    start: tuple[float, float] | None = of("pair", None, "m", doc="of a straight one")
    end: tuple[float, float] | None = of("pair", None, "m", doc="of a straight one")
    centre: tuple[float, float] = of("pair", (0.0, 0.0), "m", doc="of a round one")
    radius: float = of("number", 0.0, "m", low=0.0, doc="of a round one")
    name: str = of("text", "", doc="in events and pictures")
    colour: str = of("colour", "", doc="in pictures and movies")


def called_line(lines: Sequence[Line], number: int) -> str:
    """A line in an event.

    >>> called_line([Line((0.0, 0.0), (1.0, 0.0)), Line((0.0, 1.0), (1.0, 1.0), name="goal")], 1)
    'goal'
    """
    return lines[number].name or f"line {number}"


@dataclass(frozen=True)
class Rim:
    """How two meet, in place of what each of them says.

    Where several fit a pair the last of the list counts.

    Parameters
    ----------
    puck : name of a puck, or colour of several
    partner : the same, or a cushion: 'wall 0', 'post 1', 'arc 0', or 'wall', 'post', 'arc' for all
    restitution, tangential, friction : optional
        As of a puck (whose ``rim`` is called friction here); what is left out is as without it.

    Examples
    --------
    >>> Rim("striker", "black", restitution=0.6).friction is None
    True
    """

    puck: str = of("text", doc="name of a puck, or colour of several")
    partner: str = of("text", doc="the same, or 'wall 0', 'post 1', 'arc 0', or 'wall' for all")
    restitution: float | str | Restitution | None = restitution_of(None)
    tangential: float | None = of("number", None, low=-1.0, high=1.0, doc="as of a puck")
    friction: float | None = of("number", None, low=0.0, doc="limits the tangential impulse")
