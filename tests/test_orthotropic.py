"""A floor rougher one way than the other: resultants, motions, stops and what the floor holds."""

import math

import numpy as np
import pytest
from rays_judge import by_ellipse, friction_of, where_it_bends
from scipy.integrate import solve_ivp

import puck_tables as pt
from puck_tables.motion.body import STANDARD_GRAVITY as G
from puck_tables.scene.orthotropic import Elliptic, elliptic_demand, mean_friction

RADIUS, MASS = 0.04, 0.2


def law_of(friction, height_ratio=0.0):
    return Elliptic(*friction, 1.0, 0.0, height_ratio, 1.0)


def by_points_on_rays(friction, vx, vy, rim, height_ratio, panels=4):
    """Force and torque on a disc of radius 1; ``height_ratio``: 2 h/r."""
    slip = (vx, vy, rim)
    return friction_of(
        [(0.0, 0.0, 1.0), *where_it_bends(slip, [], [0.0])], lambda x, y: np.hypot(x, y) < 1.0,
        lambda x, y, ex, ey: by_ellipse(friction, 0.0, ex, ey), slip, height_ratio / 4.0, panels,
    )  # fmt: skip


@pytest.mark.parametrize("phi", [0.0, 1e-9, 0.3, math.pi / 4, 0.7854, 1.2, math.pi / 2])
def test_equal_friction_both_ways_is_the_plain_puck(phi):
    for delta in (0.0, 0.6):
        rho = pt.resultants(phi, delta)
        for side in (1.0, -1.0):
            vx, vy = math.cos(phi) * math.cos(2.0), math.cos(phi) * math.sin(2.0)
            found = mean_friction(law_of((0.3, 0.3), delta / 0.3), vx, vy, side * math.sin(phi))
            ahead = 0.3 * math.cos(phi) * float(rho.parallel)
            left = side * 0.3 * math.sin(phi) * math.cos(phi) * float(rho.perpendicular)
            truth = (
                -ahead * math.cos(2.0) + left * math.sin(2.0),
                -ahead * math.sin(2.0) - left * math.cos(2.0),
                -side * 0.15 * math.sin(phi) * float(rho.spin),
            )
            assert found == pytest.approx(truth, abs=1e-13)


@pytest.mark.parametrize("ratio", [0.0, 0.3, 0.8, 1.3, 4.0, 1e5])
@pytest.mark.parametrize("friction", [(0.1, 0.3), (0.4, 0.35)])
def test_resultants_are_those_of_a_grid_over_the_base(ratio, friction):
    for heading, height_ratio in ((0.4, 0.0), (2.5, 2.4)):
        vx, vy = ratio * math.cos(heading), ratio * math.sin(heading)
        truth = by_points_on_rays(friction, vx, vy, -1.0, height_ratio)
        found = mean_friction(law_of(friction, height_ratio), vx, vy, -1.0)
        assert found == pytest.approx(truth, abs=2e-12)


def test_what_is_slid_at_a_thousandth_of_the_other_friction_is_integrated_too():
    """Against panels so fine that they see the turn of friction."""
    friction = (0.001, 1.0)
    for heading in (0.0, 0.3, math.pi / 2):
        vx, vy = 0.5 * math.cos(heading), 0.5 * math.sin(heading)
        truth = by_points_on_rays(friction, vx, vy, 1.0, 0.5, panels=60)
        assert mean_friction(law_of(friction, 0.5), vx, vy, 1.0) == pytest.approx(truth, abs=1e-9)


def scene(friction=(0.1, 0.3), direction=0.4, launch=None, height=0.02, **more):
    floor = {"orthotropic": {"friction": list(friction), "direction": direction}}
    floor |= more.pop("floor", {})
    puck = {"radius": RADIUS, "height": height, "mass": MASS}
    launch = launch or {"velocity": [0.8, 0.3], "spin": 30.0}
    return pt.Scene.from_tables({"puck": puck, "floor": floor, "launch": launch, **more})


def test_a_motion_is_that_of_scipy_with_friction_of_the_grid():
    friction, turned, height = (0.15, 0.3), 0.4, 0.01
    c, s = math.cos(turned), math.sin(turned)

    def rates(t, y):
        vx, vy, w = y[3:]
        ux, uy = c * vx + s * vy, c * vy - s * vx
        fx, fy, m = by_points_on_rays(friction, ux, uy, RADIUS * w, 2.0 * height / RADIUS, 2)
        return [vx, vy, w, G * (c * fx - s * fy), G * (s * fx + c * fy), 2.0 * G * m / RADIUS]

    # sliding fast, or spinning fast: there the grid is exact
    for velocity, spin in (((0.9, 0.4), 5.0), ((0.1, -0.05), 40.0)):
        times = [0.05, 0.1, 0.15]
        truth = solve_ivp(
            rates, (0.0, 0.15), [0.0, 0.0, 0.0, *velocity, spin], "DOP853", times, rtol=1e-11,
            atol=1e-12,
        ).y  # fmt: skip
        launch = {"velocity": list(velocity), "spin": spin}
        run = scene(friction, turned, launch, height).simulate(times)
        for name, row in zip(("x", "y", "orientation", "vx", "vy", "spin"), truth, strict=True):
            unit = 1.0 / RADIUS if name in ("orientation", "spin") else 1.0
            assert run.columns[name] == pytest.approx(row, abs=2e-9 * unit)


def test_a_scene_with_equal_friction_stops_where_the_plain_puck_does():
    run = scene((0.2, 0.2), tol=1e-11).simulate()
    stop = pt.Puck(RADIUS, 0.02, 0.2).stop((0.8, 0.3), 30.0)
    assert run.end_time == pytest.approx(float(stop.stop_time), abs=2e-10)
    assert [run.last["x"], run.last["y"]] == pytest.approx(stop.stop_position, abs=1e-10)
    assert run.energy_residual < 1e-11


@pytest.mark.parametrize(("axis", "f"), [(0.0, 0.1), (math.pi / 2, 0.3)])
def test_along_an_axis_it_slides_as_on_that_friction(axis, f):
    launch = {"velocity": [math.cos(0.4 + axis), math.sin(0.4 + axis)]}
    run = scene(launch=launch).simulate()
    assert run.end_time == pytest.approx(1.0 / (f * G), rel=1e-9)
    assert math.hypot(run.last["x"], run.last["y"]) == pytest.approx(0.5 / (f * G), rel=1e-9)


def test_a_slide_across_turns_towards_the_smooth_axis():
    """u_y/u_x^(f_y²/f_x²) stays what it is while u_x′ and u_y′ go with f_x² u_x and f_y² u_y."""
    launch = {"velocity": [0.6, 0.6]}
    run = scene((0.1, 0.15), 0.0, launch).simulate([0.1, 0.3, 0.5])
    assert run.vy / run.vx**2.25 == pytest.approx(0.6**-1.25, rel=1e-8)


def test_how_a_motion_ends_depends_on_how_much_rougher_it_is_across():
    """Next to rest ω/v goes with v^(f_y²/2f_x² − 1): spin dies first, or keeps step with v."""
    for friction, dies in (((0.1, 0.2), True), ((0.2, 0.22), False)):
        run = scene(friction, 0.0, height=0.0).simulate()
        late = run(run.end_time * (1.0 - np.array([1e-3, 1e-4, 1e-5])))
        ratio = RADIUS * np.abs(late.spin) / late.speed
        assert run.end == "at rest"
        assert run.error_estimate <= 1e-9
        if dies:  # v falls by tens, the ratio with its first power
            assert ratio[1:] / ratio[:-1] == pytest.approx([0.1, 0.1], rel=0.05)
        else:
            assert np.all(np.diff(late.spin) < 0.0)
            assert ratio.min() > 0.5


def test_the_whole_may_be_turned():
    one = scene(direction=0.0, launch={"velocity": [0.5, 0.4], "spin": 20.0}).simulate()
    a, c, s = 1.1, math.cos(1.1), math.sin(1.1)
    launch = {"velocity": [0.5 * c - 0.4 * s, 0.5 * s + 0.4 * c], "spin": 20.0}
    two = scene(direction=a, launch=launch).simulate()
    x, y = one.last["x"], one.last["y"]
    assert [two.last["x"], two.last["y"]] == pytest.approx([c * x - s * y, s * x + c * y], abs=1e-9)


@pytest.mark.parametrize("downhill", [0.0, 0.6, 1.5, -2.0])
def test_the_floor_holds_what_lies_in_its_ellipse(downhill):
    """A slope pulls with tan β of the load: held while it is within the ellipse of f_x, f_y."""
    along, across = math.cos(downhill - 0.4), math.sin(downhill - 0.4)
    steepest = 1.0 / math.hypot(along / 0.1, across / 0.3)
    for share, stays in ((0.999, True), (1.001, False)):
        floor = {"slope": math.atan(share * steepest), "downhill": downhill}
        run = scene(launch={"spin": 0.0}, floor=floor, time=0.3).simulate()
        assert (run.end == "at rest") is stays
        assert (run.last["x"] == 0.0) is stays


def test_what_holds_a_force_and_a_torque_is_the_friction_of_the_slip_that_begins():
    rng = np.random.default_rng(5)
    for _ in range(40):
        friction = rng.uniform(0.05, 0.5, 2)
        law = law_of(friction, rng.uniform() / max(friction))
        fx, fy, torque = rng.normal(size=3) * [1.0, 1.0, 0.1]
        share, heat, ux, uy, w = elliptic_demand(law, 0.2, fx, fy, torque, False)
        rx, ry, turning = mean_friction(law, ux, uy, 0.2 * w)
        assert share * np.array([rx, ry, 0.2 * turning]) == pytest.approx(
            [-fx, -fy, -torque], abs=1e-12 * math.hypot(fx, fy, torque)
        )
        assert heat == pytest.approx(-(rx * ux + ry * uy + 0.2 * turning * w), rel=1e-12)


def test_on_a_belt_and_between_cushions():
    moving = scene(floor={"velocity": [0.0, 0.3]}).simulate()
    assert moving.end == "carried by the floor"
    assert moving.energy_residual < 1e-9
    wall = {"point": [0.2, 0.0], "normal": [-1.0, 0.0], "restitution": 0.8, "tangential": 0.2}
    bounced = scene(wall=[wall]).simulate()
    assert bounced.impacts == 1
    assert bounced.energy_residual < 1e-9


def test_both_frictions_are_ranges():
    tables = {
        "puck": {"radius": RADIUS}, "launch": {"velocity": [0.8, 0.3], "spin": 30.0},
        "floor": {"orthotropic": {"friction": ["0.1:0.2:2", 0.2], "direction": [0.0, 1.0]}},
    }  # fmt: skip
    swept = pt.Scene.from_tables(tables).sweep()
    assert swept.x.shape == (2, 2)
    one = scene((0.2, 0.2), 0.0, height=0.0).simulate()
    assert swept.x[1] == pytest.approx([one.last["x"]] * 2, abs=1e-8)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"friction": (0.0, 0.3)}, r"floor.orthotropic.friction\[0\] = 0.0: must be a number > 0"),
        ({"friction": (1e-4, 0.3)}, "one must be at least 0.03 of the other"),
        ({"floor": {"law": [[0.0, 0.1], [1.0, 0.1]]}}, "leave floor.law out"),
    ],
)
def test_what_is_not_known_is_refused_by_name(more, words):
    with pytest.raises(pt.InputError, match=words):
        scene(**more)
