"""What is as faint as rounding changes nothing: nothing is passed unseen for it, no end moves."""

import math

import numpy as np
import pytest
from rarely import thorough

import puck_tables as pt

FAINT = 10.0 ** np.arange(-20.0, -10.0)  # N, on 1 kg: within 3 s it moves by 0.05 nm at most
SQUARE = np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])


def board(kind, rng):
    """Something to pass; the path begins beside it and leads through it."""
    x, y, size = rng.uniform(0.3, 0.6), rng.uniform(-0.05, 0.05), 10.0 ** rng.uniform(-1.7, -0.7)
    if kind == "strip":
        strips = pt.Strips(borders=(x, x + size), friction=(0.0, 0.0, 0.0))
        return {"floor": pt.Floor(strips=strips)}
    if kind == "round patch":
        return {"floor": pt.Floor(patches=[pt.Patch(0.0, (x, y), size)])}
    if kind == "polygon":
        corners = (size * SQUARE + (x, y)).tolist()
        return {"floor": pt.Floor(patches=[pt.Patch(0.0, corners=corners)])}
    if kind == "arc":
        return {"arcs": [pt.Arc((0.0, 0.0), x, restitution=1.0)]}
    if kind == "line":
        return {"lines": [pt.Line((x, -1.0), (x, 1.0))]}
    return {"lines": [pt.Line(centre=(x, y), radius=size)]}


def passed(parts, radius, velocity, force):
    puck = pt.Puck(radius=radius, friction=0.0, mass=1.0)
    scene = pt.Scene(puck, launch=pt.Launch(velocity), force=pt.Force(constant=force), time=3.0,
                     tol=1e-9, **parts)  # fmt: skip
    events = [(e.what, e.partner, e.time) for e in scene.simulate().events if e.time < 2.9]
    return [e[:2] for e in events], np.array([e[2] for e in events])


@pytest.mark.parametrize("draws", [2, thorough(12)])
@pytest.mark.parametrize("kind", ["strip", "round patch", "polygon", "arc", "line", "ring"])
def test_all_is_passed_that_is_passed_without_it(kind, draws):
    seen = 0
    for draw in range(draws):
        rng = np.random.default_rng(draw)
        parts, radius = board(kind, rng), 10.0 ** rng.uniform(-2.0, -1.0)
        heading, speed = rng.uniform(-0.08, 0.08), 10.0 ** rng.uniform(-0.3, 0.6)
        velocity = speed * math.cos(heading), speed * math.sin(heading)
        pull = rng.uniform(-math.pi, math.pi)
        names, times = passed(parts, radius, velocity, (0.0, 0.0))
        seen += len(names)
        for force in FAINT:
            way = force * math.cos(pull), force * math.sin(pull)
            others, then = passed(parts, radius, velocity, way)
            assert others == names, (draw, force)
            np.testing.assert_allclose(then, times, rtol=0.0, atol=1e-8)
    assert seen >= draws


STRIPS = pt.Strips(borders=(0.1, 0.2), friction=(0.2, 0.1, 0.3))


@pytest.mark.parametrize("faint", [1e-12, 1e-18, 1e-300])
@pytest.mark.parametrize("strips", [None, STRIPS])
@pytest.mark.parametrize(
    "parts",
    [
        lambda v: {"floor": {"slope": v}}, lambda v: {"floor": {"velocity": (v, -v)}},
        lambda v: {"drag": pt.Drag(sliding=v)}, lambda v: {"drag": pt.Drag(quadratic=v)},
        lambda v: {"force": pt.Force(constant=(v, -v))}, lambda v: {"force": pt.Force(torque=v)},
        lambda v: {"lateral": pt.Lateral(v)}, lambda v: {"height": v},
    ],
)  # fmt: skip
def test_a_number_as_faint_as_rounding_moves_no_end(parts, strips, faint):
    def end(v):
        more = parts(v)
        floor = pt.Floor(strips=strips, **more.pop("floor", {}))
        puck = pt.Puck(radius=0.05, friction=0.2, mass=0.5, height=more.pop("height", 0.0))
        launch = pt.Launch((1.0, 0.3), spin=8.0)
        last = pt.Scene(puck, floor=floor, launch=launch, tol=1e-9, **more).simulate().last
        return [last[name] for name in ("x", "y", "orientation")]

    np.testing.assert_allclose(end(faint), end(0.0), rtol=0.0, atol=1e-8)


@pytest.mark.parametrize("turning", [1e-12, -1e-300])
def test_a_turntable_slower_than_a_turn_in_200_years_is_refused(turning):
    with pytest.raises(pt.InputError, match="must be 0, or at least 1e-09 rad"):
        pt.Scene(pt.Puck(0.05), floor=pt.Floor(turning=turning))
