"""A finger that pushes slowly: Mason's votes, the disc's known numbers, a tractrix, energy."""

from __future__ import annotations

import math

import numpy as np
import pytest

import puck_tables as pt

BOX = pt.Base.box(0.2, 0.1)
RING = pt.Puck(0.1, friction=0.2, pressure="ring")
SHAPES = {
    "box": BOX,
    "triangle": pt.Base.polygon([(0.0, 0.0), (0.12, 0.0), (0.0, 0.09)]),
    "disc": pt.Base.disc(0.05),
    "feet and box": pt.Base.union([pt.Base.box(0.1, 0.05), pt.Base.feet([(0.2, 0.0)], 0.01)]),
}


def on_outline(base: pt.Base, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """A place on an outline, and the normal into the base."""
    if not base.outlines:
        turn = rng.uniform(0.0, 2.0 * math.pi)
        way = np.array([math.cos(turn), math.sin(turn)])
        return base.discs[0][2] * way, -way
    corners = np.array(base.outlines[0])
    i = rng.integers(len(corners))
    one, other = corners[i], corners[(i + 1) % len(corners)]
    way = (other - one) / np.linalg.norm(other - one)
    return one + rng.uniform(0.02, 0.98) * (other - one), np.array([-way[1], way[0]])


def cross(a: np.ndarray, b: np.ndarray) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


@pytest.mark.parametrize("name", SHAPES)
def test_masons_votes(name: str):
    """The edges of the cone of friction and the push vote by the side on which they pass the centre
    of friction; the puck turns as two of three do (Mason 1986)."""
    base, rng = SHAPES[name], np.random.default_rng(1)
    puck, seen = pt.Puck(base=base, friction=0.3), set()
    for _ in range(150):
        place, normal = on_outline(base, rng)
        friction = rng.uniform(0.0, 0.8)
        lean = rng.uniform(-1.5, 1.5)
        way = math.cos(lean) * normal + math.sin(lean) * np.array([-normal[1], normal[0]])
        run = pt.push(puck, place, way, friction)
        arm = place - np.array(base.middle)
        edges = [normal + s * friction * np.array([-normal[1], normal[0]]) for s in (-1.0, 1.0)]
        votes = [np.sign(cross(arm, one)) for one in (*edges, way)]
        assert np.sign(run.spin[0]) == np.sign(sum(votes)) or friction == 0.0
        # forces lie in the cone, on its edge where the finger slides; friction balances them
        force = np.array([run.push_x[0], run.push_y[0]])
        pressed, dragged = float(force @ normal), cross(normal, force)
        assert pressed > 0.0 and abs(dragged) <= friction * pressed * (1.0 + 1e-9)
        moved = np.array([run.vx[0], run.vy[0]])
        found = puck.wrench(moved, run.spin[0])
        np.testing.assert_allclose(found.force, -force, atol=1e-9)
        assert float(found.torque) == pytest.approx(-cross(arm, force), abs=1e-9 * puck.radius)
        touch = moved + run.spin[0] * np.array([-arm[1], arm[0]])
        slide = cross(normal, way - touch)
        assert (way - touch) @ normal == pytest.approx(0.0, abs=1e-9)
        if run.contact[0] == "sticks":
            assert abs(slide) < 1e-9
        else:
            assert abs(dragged) == pytest.approx(friction * pressed, rel=1e-9)
            assert slide * dragged >= -1e-12 and (slide > 0.0) == (run.contact[0] == "slides left")
        seen.add(run.contact[0])
    assert seen == {"sticks", "slides left", "slides right"}


@pytest.mark.parametrize("friction", [0.36, 0.3])
def test_a_disc_that_turns_about_its_rim(friction: float):
    """Friction of a uniform disc that turns about a point of its rim is 8 f N/(3π), a third of the
    radius from the centre: a finger there, inside its cone, turns it so."""
    puck = pt.Puck(0.06, friction=0.25, mass=2.0)
    place = 0.06 * np.array([-math.sqrt(8.0), -1.0]) / 3.0
    velocity = 0.5 * np.array([0.06 * 4.0 / 3.0, -0.06 * math.sqrt(8.0) / 3.0])  # about (0, r)
    run = pt.push(puck, place, velocity, friction)
    needed = 1.0 / math.sqrt(8.0)  # tan of the angle between the force, along x, and the normal
    assert run.contact == (["sticks"] if friction > needed else ["slides right"])
    if friction > needed:
        assert run.spin[0] == pytest.approx(0.5, rel=1e-12)
        assert (run.vx[0], run.vy[0]) == pytest.approx((0.03, 0.0), abs=1e-14)
        unit = 0.25 * 2.0 * 9.80665
        assert run.push_x[0] == pytest.approx(unit * 8.0 / (3.0 * math.pi), rel=1e-12)


@pytest.mark.parametrize("lean", [0.3, -0.8])
def test_a_disc_under_a_smooth_finger_draws_a_tractrix(lean: float):
    """Without friction at the finger the force passes the centre, which moves along the line from
    the finger to it: tan(ψ/2) grows as e^(Ut/r), and the finger leaves at ψ = π/2."""
    radius, speed = 0.05, 0.02
    puck = pt.Puck(base=pt.Base.disc(radius), friction=0.3)
    place = -radius * np.array([math.cos(lean), math.sin(lean)])
    run = pt.push(puck, place, (speed, 0.0), 0.0, duration=1.5, frames=31)
    psi = 2.0 * np.arctan(math.tan(lean / 2.0) * np.exp(speed * run.time / radius))
    centre = np.stack([run.x, run.y], axis=-1)
    exact = place + speed * run.time[:, None] * [1.0, 0.0]
    exact = exact + radius * np.stack([np.cos(psi), np.sin(psi)], axis=-1)
    np.testing.assert_allclose(centre, exact, atol=1e-9 * radius)
    np.testing.assert_allclose(run.orientation, 0.0, atol=1e-12)
    long = pt.push(puck, place, (speed, 0.0), 0.0, duration=100.0)
    assert long.end == "the finger presses on no more"
    leaves = radius / speed * math.log(1.0 / math.tan(abs(lean) / 2.0))
    assert long.time[-1] == pytest.approx(leaves, rel=1e-6)


@pytest.mark.parametrize("height", [0.0, 0.03])
@pytest.mark.parametrize("friction", [0.1, 0.6])
def test_paths_of_a_box(height: float, friction: float):
    """What the finger gives the floor takes; no path depends on the speed; mirror images."""
    puck = pt.Puck(base=BOX, friction=0.3, height=height)
    how = {"duration": 2.0, "frames": 401}
    run = pt.push(puck, (-0.1, 0.02), (0.03, 0.005), friction, **how)
    given = 0.03 * run.push_x + 0.005 * run.push_y
    moved = np.stack([run.vx, run.vy], axis=-1)
    floor = puck.wrench(moved, run.spin, run.orientation)
    taken = -np.einsum("ni,ni->n", floor.force, moved) - floor.torque * run.spin
    sticks = np.array(run.contact) == "sticks"
    assert sticks[-1] and sticks[0] == (friction == 0.6)
    np.testing.assert_allclose(given[sticks], taken[sticks], rtol=1e-8)
    assert (given[~sticks] > taken[~sticks]).all()  # the rest goes into the contact
    fast = pt.push(puck, (-0.1, 0.02), (0.3, 0.05), friction, duration=0.2, frames=401)
    np.testing.assert_allclose(fast.x, run.x, atol=1e-9)
    np.testing.assert_allclose(fast.orientation, run.orientation, atol=1e-8)
    mirrored = pt.push(puck, (-0.1, -0.02), (0.03, -0.005), friction, **how)
    np.testing.assert_allclose(mirrored.y, -run.y, atol=1e-10)
    np.testing.assert_allclose(mirrored.orientation, -run.orientation, atol=1e-9)
    # the finger stays on its side
    turn = np.exp(-1j * run.orientation)
    own = turn * (run.finger_x + 1j * run.finger_y - run.x - 1j * run.y)
    np.testing.assert_allclose(own.real, -0.1, atol=1e-9)
    # the states are the integral of their velocities: Simpson's rule, order 4
    whole = sum(w * run.vx[i::2][: 200 + (i == 0)].sum() for i, w in ((0, 2.0), (1, 4.0)))
    whole -= run.vx[0] + run.vx[-1]
    assert whole * 0.005 / 3.0 == pytest.approx(run.x[-1], rel=1e-6)


def test_how_pushes_end(tmp_path):
    puck = pt.Puck(base=BOX, friction=0.3)
    off = pt.push(puck, (-0.1, 0.045), (0.01, 0.05), 0.05, duration=9.0)
    assert off.end == "the finger comes to a corner"
    last = np.exp(-1j * off.orientation[-1]) * complex(off.finger_x[-1] - off.x[-1],
                                                       off.finger_y[-1] - off.y[-1])  # fmt: skip
    assert last == pytest.approx(-0.1 + 0.05j, abs=1e-8)
    away = pt.push(puck, (-0.1, 0.01), (-1.0, 0.0), 0.3, duration=1.0)
    assert away.contact == ["apart"] and away.spin[0] == 0.0 == away.push_x[0]
    straight = pt.push(puck, (-0.1, 0.0), (0.05, 0.0), 0.3, duration=1.0, frames=3)
    assert straight.x[-1] == pytest.approx(0.05) and straight.end == "time is up"
    straight.save(tmp_path / "push.csv")
    rows = (tmp_path / "push.csv").read_text().splitlines()
    assert len(rows) == 4 and rows[1].endswith("sticks")
    straight.plot(tmp_path / "push.png")
    assert "Push(3 states, sticks" in repr(straight) and "quasi-static" in straight.explain()
    assert str(straight) == (
        "The puck moves by (0.05, 0) m and turns by 0 degrees in 1 s: time is up.\n"
        "The finger: sticks; its force is 2.942 to 2.942 N."
    )


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda p: pt.push(p, (0.0, 0.0), (1.0, 0.0), 0.3), "from the outline of the base"),
        (lambda p: pt.push(p, (-0.1, 0.05), (1.0, 0.0), 0.3), "at a corner"),
        (lambda p: pt.push(p, (-0.1, 0.0), (0.0, 0.0), 0.3), "velocity of what pushes is 0"),
        (lambda p: pt.push(p, (-0.1, 0.0), (1.0, 0.0), -0.3), "must not be negative"),
        (lambda p: pt.push(p, (-0.1, 0.0), (1.0, math.nan), 0.3), "velocity"),
        (lambda p: pt.push(p, (-0.1, 0.0), (1.0, 0.0), 0.3, duration=-1.0), "duration"),
        (lambda p: pt.push(p, (-0.1, 0.0), (1.0, 0.0), 0.3, frames=0), "frames"),
        (lambda p: pt.push(p, (-0.1, 0.0), (1.0, 0.0), 0.3, duration=1e9), "times the reach"),
        (lambda p: pt.push(p, -0.1, (1.0, 0.0), 0.3), "two numbers"),
        (lambda p: pt.push(RING, (0.1, 0.0), (1.0, 0.0), 0.3), "push knows pucks on a base"),
        (lambda p: pt.push(pt.Puck(base="box:1x1"), (0.5, 0.0), (1.0, 0.0), 0.3), "friction = 0"),
        (lambda p: pt.push("box", (0.5, 0.0), (1.0, 0.0), 0.3), "puck"),
    ],
)  # fmt: skip
def test_bad_input_is_one_sentence(ask, words: str):
    with pytest.raises(pt.InputError, match=words):
        ask(pt.Puck(base=BOX, friction=0.3))
