"""The benchmark cases: each a scene with a name and a version.

A new case is one entry in ``CASES``.  What a case says must never change under its version: whoever
has published an error against it must be able to compute it again.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from copy import deepcopy
from typing import Any, NamedTuple

from puck_tables._core.wording import meant
from puck_tables.errors import InputError
from puck_tables.world.scene import Scene

TOL = 1e-11  # of Q/J and Q²/J


class ReferenceCase(NamedTuple):
    """A motion to be held against.

    ``name``, ``version``; ``title``: a line; ``tests``: what an engine gets wrong in it, in a
    sentence; ``tables``: the scene, as a scene file has it, in SI units.  Its ``height`` is the
    full height of a homogeneous body, whose centre of mass lies half as high.
    """

    name: str
    version: int
    title: str
    tests: str
    tables: Mapping[str, Any]

    @property
    def label(self) -> str:
        """Name and version, as files carry them."""
        return f"{self.name} (version {self.version})"

    def scene(self) -> Scene:
        """The case as a scene, computed to ``TOL``.

        >>> case_named("coin").scene().launch.spin
        12.0
        """
        tables = deepcopy(dict(self.tables))
        tables["title"] = self.title
        tables["tol"] = TOL
        return Scene.from_tables(tables, f"case {self.name}")


_DISC = {"radius": 0.05, "height": 0.002, "friction": 0.2, "gravity": 9.81, "mass": 0.1}
_TALL = {**_DISC, "friction": 0.5}
_STONE = {**_DISC, "restitution": 0.9, "tangential": 0.0, "rim": 0.1}
_BODY = {"friction": 0.3, "gravity": 9.81, "mass": 0.5}
_DOWN = -0.5 * math.pi  # along −y


def _thrown(ratio: float) -> ReferenceCase:
    """A flat disc at 0.5 m/s with a rim that is ``ratio`` times as fast."""
    return ReferenceCase(
        f"slide-spin-{ratio:g}", 1, f"Flat disc, rim {ratio:g} times as fast as its centre",
        "sliding and spinning brake each other: two separate frictions stop at two moments",
        {"puck": _DISC, "launch": {"velocity": [0.5, 0.0], "spin": ratio * 0.5 / 0.05}},
    )  # fmt: skip


def _tall(delta: float, more: str) -> ReferenceCase:
    """A cylinder as high as δ = 2 f h/r says: with f = 0.5, h = δ r."""
    return ReferenceCase(
        f"tall-{delta:g}", 1, f"Cylinder with delta = {delta:g}: it presses harder in front",
        f"the pressure tilts and the path bends{more}",
        {"puck": {**_TALL, "height": delta * 0.05},
         "launch": {"velocity": [1.0, 0.0], "spin": 20.0}},
    )  # fmt: skip


def _incline(name: str, over: float, words: str, tests: str, time: float | None) -> ReferenceCase:
    """A spinning disc sent across and up a slope whose tangent is ``over`` times f."""
    tables: dict[str, Any] = {
        "puck": _DISC, "floor": _slope(over * 0.2),
        "launch": {"velocity": [0.5, 0.3], "spin": 20.0},
    }  # fmt: skip
    if time is not None:
        tables |= {"time": time}
    return ReferenceCase(f"incline-{name}", 1, f"Spinning disc on a slope {words}", tests, tables)


def _slope(tangent: float) -> dict[str, float]:
    return {"slope": math.atan(tangent), "downhill": _DOWN}


def _broken_away(what: str, ramp: list[list[float]], tests: str) -> ReferenceCase:
    """A box at rest that is pushed harder and harder for a second, then left."""
    return _body(
        f"break-away-{what}", "box:0.2x0.1", f"Box at rest under a {what} that grows", tests,
        launch={"orientation": 0.5}, force={"over_time": ramp},
    )  # fmt: skip


def _over_edge(
    name: str, title: str, tests: str, puck: dict[str, Any], borders: list[float],
    friction: list[float], direction: float, launch: dict[str, Any],
) -> ReferenceCase:  # fmt: skip
    """A puck that lies on several strips at once, at least for a while."""
    strips = {"borders": borders, "friction": friction, "direction": direction}
    return ReferenceCase(
        f"astride-{name}", 1, title, tests,
        {"puck": puck, "floor": {"strips": strips}, "launch": launch},
    )  # fmt: skip


def _body(
    name: str, base: str, title: str, tests: str, height: float = 0.0, **more: Any
) -> ReferenceCase:  # fmt: skip
    """A body on a base that is not round, thrown with a spin, or as ``more`` says."""
    launch = {"velocity": [1.0, 0.2], "spin": 12.0, "orientation": 0.5}
    puck = {"base": base, "height": height, **_BODY, **more.pop("puck", {})}
    return ReferenceCase(name, 1, title, tests, {"puck": puck, "launch": launch, **more})


CASES = (
    ReferenceCase(
        "coin", 1, "Masterjohn's coin: a quarter dollar that slides and spins",
        "the ratio v/(r w) at a finite spin is not yet that of the limit",
        {
            "puck": {"radius": 0.01213, "height": 0.00175, "friction": 0.2, "gravity": 9.81,
                     "mass": 0.00567},
            "launch": {"velocity": [0.2, 0.0], "spin": 12.0},
        },
    ),
    ReferenceCase(
        "spin", 1, "Flat disc that only spins", "torque 2/3 f m g r, stop after 3/4 r w/(f g)",
        {"puck": _DISC, "launch": {"velocity": [0.0, 0.0], "spin": 20.0}},
    ),
    ReferenceCase(
        "slide", 1, "Flat disc that only slides", "force f m g, stop after v/(f g)",
        {"puck": _DISC, "launch": {"velocity": [1.0, 0.0]}},
    ),
    *map(_thrown, (0.2, 0.5, 1.0, 2.0, 5.0)),
    _tall(0.5, ""),
    _tall(1.0, "; in a pure slide the rear edge would just carry nothing"),
    _tall(2.0, "; at first part of the base carries nothing"),
    ReferenceCase(
        "annulus", 1, "Washer with a hole half as wide",
        "friction and inertia of a ring: another limit of v/(r w)",
        {
            "puck": {**_DISC, "pressure": "annulus:0.5", "gyration": math.sqrt((1 + 0.25) / 2)},
            "launch": {"velocity": [0.5, 0.0], "spin": 20.0},
        },
    ),
    _incline("below", 0.5, "that holds it", "it stops, and stays where it stopped", None),
    _incline("at", 1.0, "of just its friction",
             "spin uses up friction; what is left at the end is a slide of constant speed", 1.5),
    _incline("above", 1.5, "that does not hold it", "it slides off ever faster", 1.0),
    ReferenceCase(
        "belt", 1, "Spinning disc set on a belt",
        "friction against a moving floor: its slip starts along the belt",
        {"puck": _DISC, "floor": {"velocity": [0.5, 0.0]},
         "launch": {"velocity": [0.0, 0.2], "spin": 20.0}},
    ),
    ReferenceCase(
        "turntable", 1, "Disc set on a turntable that throws it off",
        "a floor whose velocity differs from place to place, and turns",
        {"puck": _DISC, "floor": {"turning": 4.0},
         "launch": {"velocity": [0.0, 0.0], "position": [0.2, 0.0]}, "time": 1.0},
    ),
    ReferenceCase(
        "turntable-speeds-up", 1, "Disc on a turntable that turns ever faster",
        "it is carried until force and torque together ask for more than friction, then thrown off",
        {"puck": _DISC, "floor": {"over_time": [[0.0, 0.0, 0.0, 0.0], [2.0, 0.0, 0.0, 8.0]]},
         "launch": {"position": [0.2, 0.0]}, "time": 1.5},
    ),
    _over_edge(
        "spin", "Flat disc that spins on the border of two frictions",
        "it is pushed along the border, at first by (f1 - f2) g/pi = 0.3501 m/s^2",
        {**_DISC, "height": 0.0, "friction": 0.78, "gravity": 10.0}, [0.0], [0.78, 0.67], 0.0,
        {"velocity": [0.0, 0.0], "spin": 20.0},
    ),
    _over_edge(
        "crossing", "Cylinder slides and spins over a border aslant",
        "each friction acts under its own part of the base, the pressure tilted by both",
        {**_DISC, "height": 0.05}, [0.1], [0.2, 0.35], 0.4,
        {"velocity": [1.0, 0.3], "spin": 20.0},
    ),
    _over_edge(
        "stop", "Disc slides and spins onto a strip narrower than itself, and stops there",
        "three frictions under one base for a while, two to the very stop",
        _DISC, [0.1, 0.16], [0.15, 0.4, 0.1], 0.0,
        {"velocity": [0.75, 0.1], "spin": -20.0},
    ),
    _body("box", "box:0.2x0.1", "Box that slides and spins",
          "it stops turning and sliding together; the path bends as its long side turns"),
    _body("box-straight", "box:0.2x0.1", "Box thrown without a spin, its long side aslant",
          "a flat body that does not turn is not made to: no torque, whatever its base",
          launch={"velocity": [1.0, 0.2], "orientation": 0.5}),
    _body("box-tall", "box:0.2x0.1", "Box 8 cm high",
          "the pressure tilts by two balances, along the box and across it", 0.08),
    _body("bar", "box:0.3x0.01", "Bar, thirty times as long as wide",
          "friction across and along a bar differ once it spins"),
    _body("triangle", "polygon:-0.05,-0.05;0.1,-0.05;-0.05,0.1", "Right-angled triangle",
          "no symmetry: a force across the motion although the base is flat"),
    _body("off-centre", "disc:0.05@0.01,0", "Disc whose centre of mass is 1 cm off its middle",
          "friction acts in the middle, inertia 1 cm beside it", puck={"gyration": 0.036}),
    _body("three-feet", "feet:0.005;0.08,0;-0.05,0.06;-0.05,-0.06", "Body on three round feet",
          "each foot carries a third, and slips its own way"),
    _body("box-slope", "box:0.2x0.1", "Box across and up a slope that holds it",
          "a spin uses up friction: it slides farther down than without one",
          floor={"slope": 0.2, "downhill": _DOWN}),
    _body("box-slope-below", "box:0.2x0.1", "Box on a slope of 0.95 of its friction",
          "it stops late: what holds it is a twentieth of its friction", floor=_slope(0.285)),
    _body("box-slope-at", "box:0.2x0.1", "Box on a slope of just its friction",
          "what is left at the end is a slide of constant speed, straight down",
          floor=_slope(0.3), time=2.0),
    _body("box-slope-above", "box:0.2x0.1", "Box on a slope of 1.05 of its friction",
          "it never stops, as slow as it gets", floor=_slope(0.315), time=2.0),
    _broken_away("force", [[0.0, 0.0, 0.0], [1.0, 2.0, 0.0]],
                 "it stays until f m g, at 0.73575 s, and comes to rest again"),
    _broken_away("torque", [[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.1]],
                 "it stays until f m g times the mean arm of the box, at 0.873 s"),
    _body("box-belts", "box:0.2x0.1", "Box from a fast belt to a slow one",
          "each belt acts under its own part of the base, at its own slip",
          launch={"velocity": [0.5, 0.0], "position": [-0.15, 0.0], "orientation": 0.3},
          floor={"strips": {"borders": [0.0], "friction": [0.3, 0.3], "across": [0.5, 0.2]}},
          time=0.6),
    ReferenceCase(
        "rebound", 1, "Spinning disc off a cushion",
        "restitution 0.8; the rim stops on the cushion or rubs with 0.2 of the impulse",
        {
            "puck": _DISC, "launch": {"velocity": [1.0, 0.5], "spin": 20.0},
            "wall": [{"point": [0.2, 0.0], "normal": [-1.0, 0.0], "restitution": 0.8,
                      "tangential": 0.0, "friction": 0.2}],
        },
    ),
    ReferenceCase(
        "take-out", 1, "Spinning disc hits another that lies",
        "restitution 0.9, rims with friction 0.1, then two motions to their stops",
        {
            "puck": [
                {**_STONE, "name": "red", "colour": "firebrick",
                 "launch": {"velocity": [1.0, 0.0], "spin": 10.0}},
                {**_STONE, "name": "yellow", "colour": "gold",
                 "launch": {"position": [0.25, 0.03]}},
            ],
        },
    ),
)  # fmt: skip


def case_named(name: str) -> ReferenceCase:
    """The case of a name.

    Raises InputError if there is none, with the nearest and a list.

    >>> case_named("coin").label
    'coin (version 1)'
    """
    named = {case.name: case for case in CASES}
    if not isinstance(name, str) or name not in named:
        hint = meant(str(name).lower(), named)
        raise InputError(f"there is no case {name!r:.40}{hint}. Cases: {', '.join(named)}")
    return named[name]
