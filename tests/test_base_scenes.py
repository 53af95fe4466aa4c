"""Scenes of pucks on bases that are not round: known runs, floors, rest, and what is refused."""

import math
import tomllib
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from base_judge import Judge
from golden.make_body_starts import BOX, K, LawJudge, stribeck
from rarely import thorough
from rays_judge import border, friction_of, sides, within

from puck_tables import (
    Base,
    CurlingLaw,
    Edge,
    Floor,
    Force,
    InputError,
    Launch,
    Patch,
    Puck,
    Scene,
    StribeckLaw,
    Strips,
    Wall,
)
from puck_tables.contact.law_moments import law_moments, packed_law
from puck_tables.errors import ContactError
from puck_tables.kernels.base_clipping import whole_contour
from puck_tables.kernels.base_friction import REACH, base_sums, packed
from puck_tables.kernels.elliptic_sums import Ellipse
from puck_tables.kernels.law_sums import law_sums
from puck_tables.scene.library import as_toml
from puck_tables.world.floor_forces import friction_at

TRIANGLE = [(-0.04, -0.03), (0.08, -0.03), (-0.04, 0.06)]
# launch and end (t, x, y, angle), by an independent program: DOP853 in dt/Q at 1e-12, with another
# form of the integral
KNOWN = {
    "triangle": (
        Puck(base=Base.polygon(TRIANGLE), friction=0.25),
        Floor(),
        Launch(velocity=(0.8, 0.0), spin=-15.0),
        (0.4234099378, 0.1608519283, 0.0011112212, -3.4301195933),
    ),
    "box": (
        Puck(base="box:0.2x0.1", friction=0.3),
        Floor(),
        Launch(velocity=(1.0, 0.0), spin=10.0, orientation=math.pi / 6),
        (0.4421850099, 0.2097666929, 0.0019267285, 3.0053561162),
    ),
    "disc off its middle": (
        Puck(base="disc:0.05@0.01,0", friction=0.2, gyration=math.sqrt(0.00125 - 0.0001)),
        Floor(),
        Launch(velocity=(1.0, 0.0), spin=20.0),
        (0.6756148494, 0.3187052185, -0.0001404809, 7.3656062776),
    ),
    "tall box under a law": (
        Puck(base="box:0.2x0.1", height=0.06),
        Floor(law=StribeckLaw(0.3, 0.1, speed=0.3, exponent=1.0)),
        Launch(velocity=(1.0, 0.3), spin=10.0),
        (0.9900376044, 0.5309459399, 0.1504629936, 6.3631281671),
    ),
}
BASES = {
    "bar": Base.box(0.3, 0.02),
    "L": Base.polygon([(0, 0), (0.2, 0), (0.2, 0.05), (0.05, 0.05), (0.05, 0.1), (0, 0.1)]),
    "frame": Base.polygon(
        [(0, 0), (0.2, 0), (0.2, 0.1), (0, 0.1)],
        holes=[[(0.05, 0.02), (0.15, 0.02), (0.15, 0.08), (0.05, 0.08)]],
    ),
    "feet": Base.feet([(0.08, 0.0), (-0.05, 0.05), (-0.05, -0.05)], 0.01),
    "washer": Base.annulus(0.08, 0.05, centre=(0.01, 0.0)),
}


@pytest.mark.parametrize("name", KNOWN)
def test_known_runs(name: str) -> None:
    puck, floor, launch, end = KNOWN[name]
    run = Scene(puck, floor, launch=launch).simulate([0.0])
    found = (run.end_time, *(run.last[key] for key in ("x", "y", "orientation")))
    gap = np.abs(np.subtract(found, end)) * [1.0, 1.0, 1.0, puck.radius]
    assert gap.max() < 2e-10
    assert run.end == "at rest" and run.error_estimate < 1e-9
    assert abs(run.energy_residual) < 1e-12


@pytest.mark.parametrize("velocity", [thorough((1.0, 0.0)), (0.2, 0.1)])
def test_rows_within_steps_keep_tol(velocity: tuple[float, float]) -> None:
    """A step is several pieces of the path: also where these are joined."""
    spin, g = 12.0, 9.80665
    scene = Scene(Puck(base="box:0.2x0.1"), Floor(law=StribeckLaw(0.35, 0.2, 0.1)),
                  launch=Launch(velocity, spin=spin))  # fmt: skip
    run = scene.simulate([0.0])
    times = run.end_time * (1.0 - np.append(np.linspace(0.98, 0.02, 97), 10.0 ** -np.arange(2, 5)))
    unit = math.hypot(*velocity, K * spin)
    judge = LawJudge(stribeck, [BOX], [], 0.0, K)
    judge.unit = unit
    truth = judge.states(velocity, spin, g, times)
    speed, rate = run.speed_scale, run.rate_scale
    length, reach = speed**2 / rate, math.hypot(0.1, 0.05)
    scales = np.array([length, length, length / reach, speed, speed, speed / reach])[:, None]
    for tol in (1e-6, 1e-9):
        found = replace(scene, tol=tol).simulate(times)
        rows = [found.columns[name] for name in ("x", "y", "orientation", "vx", "vy", "spin")]
        assert np.abs((np.stack(rows)[:, : times.size] - truth) / scales).max() <= tol


def on_floor(seed: int) -> dict[str, Any]:
    """A drawn floor, and what else acts."""
    rng = np.random.default_rng(seed)
    kinds: list[dict[str, Any]] = [
        {"floor": Floor(slope=float(rng.uniform(0.02, 0.12)))},
        {"floor": Floor(velocity=tuple(rng.normal(scale=0.4, size=2).tolist())), "time": 1.5},
        {"floor": Floor(turning=float(rng.normal()), centre=(0.2, 0.1)), "time": 1.0},
        {"force": Force(constant=(0.1, 0.2), torque=1e-3)},
        {"floor": Floor(strips=Strips((0.1, 0.18, 0.21), (0.2, 0.05, 0.4, 0.1), direction=0.4))},
        {"floor": Floor(law=StribeckLaw(0.25, 0.1, speed=0.4), velocity=(0.2, 0.0)), "time": 1.0},
        {"floor": Floor(law=CurlingLaw(0.2, 0.5, 0.02), slope=0.03)},
        {"floor": Floor(patches=[Patch(0.4, (0.1, 0.05), 0.06), Patch(0.05, (0.25, 0.0), 0.07)])},
        {
            "floor": Floor(
                patches=[Patch(0.1, corners=[(0.1, -1), (0.3, -1), (0.2, 0.06), (0.1, 1)])]
            )
        },
    ]
    return kinds[seed % len(kinds)]


@pytest.mark.parametrize("seed", [0, 4, *map(thorough, (1, 2, 3, 5, 6, 7, 8))])
def test_a_disc_by_its_base_is_the_round_puck(seed: int) -> None:
    height = 0.05 if seed % 2 else 0.0
    launch = Launch(velocity=(1.0, 0.2), spin=12.0)
    ends = []
    for puck in (Puck(0.05, height, 0.2), Puck(base="disc:0.05", height=height, friction=0.2)):
        run = Scene(puck, launch=launch, **on_floor(seed)).simulate([0.0])
        ends.append([run.end_time, *(run.last[key] for key in ("x", "y", "orientation"))])
    assert np.abs(np.subtract(*ends)).max() < 1e-9


ALIKE = Ellipse(1.0, 1.0, 1.0, 0.0)


def whole(shape: Any) -> tuple[Any, int, int, float]:
    """The contour of a packed base."""
    return shape, *whole_contour(shape, 0), shape[REACH]


def judged(base: Base, state: Any, lever: float, friction: Any, borders: list[Any]) -> np.ndarray:
    """Force and torque at N = 1 by points on rays; ``friction`` by place, with its ``borders``."""
    x, y, angle, *slip = state
    c, s = math.cos(angle), math.sin(angle)
    turn, middle = np.array([[c, -s], [s, c]]), np.array(base.middle)
    outlines = [((np.array(one) - middle) @ turn.T).tolist() for one in base.outlines]
    discs = [(*turn @ (np.array(one[:2]) - middle), *one[2:]) for one in base.discs]

    def inside(px: np.ndarray, py: np.ndarray) -> np.ndarray:
        there = [sign * (np.hypot(px - cx, py - cy) < r) for cx, cy, r, sign in discs]
        return within(outlines)(px, py) + sum(there) > 0

    def local(px: np.ndarray, py: np.ndarray, ex: np.ndarray, ey: np.ndarray) -> Any:
        f = friction(x + px, y + py)
        return f * ex, f * ey

    curves = [*(side for one in outlines for side in sides(one)), *(one[:3] for one in discs)]
    for one in borders:  # seen from the puck
        curves.append(tuple(np.subtract(one, (x, y, x, y) if len(one) == 4 else (x, y, 0.0))))
    return friction_of(curves, inside, local, slip, lever, 24)


STRIPS = Strips((-0.03, 0.02, 0.05), (0.2, 0.05, 0.3, 0.1), direction=0.7)
HOOK = [(0.0, 0.0), (0.09, -0.02), (0.08, 0.05), (0.03, 0.03), (0.02, 0.09)]
ROUND = ((-0.05, -0.02, 0.04), (0.05, -0.07, 0.02))


def on_strips(x: Any, y: Any) -> Any:
    across = math.cos(STRIPS.direction) * x + math.sin(STRIPS.direction) * y
    return np.array(STRIPS.friction)[np.searchsorted(STRIPS.borders, across)]


def on_patches(x: Any, y: Any) -> Any:
    f = np.full(x.shape, 0.2)
    for cx, cy, radius in ROUND:
        f[np.hypot(x - cx, y - cy) < radius] = 0.3
    f[within([HOOK])(x, y)] = 0.05
    return f


FLOORS: dict[str, tuple[Floor, Any, list[Any]]] = {
    "one": (Floor(), lambda x, y: np.full(x.shape, 0.2), []),
    "strips": (
        Floor(strips=STRIPS), on_strips, [border(STRIPS.direction, b) for b in STRIPS.borders]
    ),
    "patches": (
        Floor(patches=[Patch(0.05, corners=HOOK), *(Patch(0.3, (x, y), r) for x, y, r in ROUND)]),
        on_patches, [*sides(HOOK), *ROUND],
    ),
}  # fmt: skip


@pytest.mark.thorough
@pytest.mark.parametrize("floor", FLOORS)
@pytest.mark.parametrize("name", BASES)
def test_friction_is_that_of_points_over_the_base(name: str, floor: str) -> None:
    rng = np.random.default_rng(7)
    base = BASES[name]
    height = 1.9 * base.highest_lever / 0.3  # of which none of the frictions lifts it
    puck = Puck(base=base, friction=0.2, height=height, gravity=1.0, gyration=0.1)
    states = np.column_stack([
        rng.normal(scale=0.05, size=(4, 2)), rng.uniform(0.0, 6.0, 4),
        rng.normal(size=(4, 2)), rng.normal(scale=15.0, size=4),
    ])  # fmt: skip
    surface, friction, borders = FLOORS[floor]
    found = friction_at(Scene(puck, surface), states)
    for state, forces in zip(states.tolist(), found, strict=True):
        wanted = judged(base, state, 0.5 * height, friction, borders)
        assert (np.abs(forces - wanted) / [1.0, 1.0, base.reach]).max() < 1e-10


def drawn_states(seed: int, count: int, spread: float) -> np.ndarray:
    """States whose instantaneous centres are anywhere, from inside the base to far away."""
    rng = np.random.default_rng(seed)
    far = 10.0 ** rng.uniform(-2.0, 3.0, count)
    spin = far * rng.choice([-1.0, 1.0], count)
    places, velocities = rng.normal(scale=spread, size=(count, 2)), rng.normal(size=(count, 2))
    return np.column_stack([places, rng.uniform(0.0, 6.0, count), velocities, spin])


@pytest.mark.parametrize("patch", ["round", "hook"])
def test_a_disc_over_a_patch_by_its_base_feels_what_a_round_puck_feels(patch: str) -> None:
    where = Patch(0.4, corners=HOOK) if patch == "hook" else Patch(0.4, (0.01, 0.02), 0.03)
    states = drawn_states(11, 40, 0.02)
    one, two = (
        friction_at(Scene(puck, Floor(patches=[where])), states)
        for puck in (Puck(0.05, 0.03, 0.2), Puck(base="disc:0.05", height=0.03, friction=0.2))
    )
    assert np.abs(one - two).max() < 1e-13


@pytest.mark.parametrize("name", BASES)
def test_a_patch_over_half_the_floor_is_a_strip(name: str) -> None:
    half = [(0.01, -9.0), (9.0, -9.0), (9.0, 9.0), (4.0, 1.0), (0.01, 9.0)]
    puck = Puck(base=BASES[name], friction=0.2, gravity=1.0, gyration=0.1)
    floors = (Floor(patches=[Patch(0.4, corners=half)]), Floor(strips=Strips((0.01,), (0.2, 0.4))))
    one, two = (friction_at(Scene(puck, floor), drawn_states(12, 40, 0.05)) for floor in floors)
    assert np.abs(one - two).max() < 1e-13


@pytest.mark.parametrize("name", BASES)
def test_polygons_tend_to_a_round_patch_at_order_two(name: str) -> None:
    puck = Puck(base=BASES[name], friction=0.2, gravity=1.0, gyration=0.1)
    states, (x, y, radius) = drawn_states(13, 10, 0.02), (0.02, 0.01, 0.05)
    whole = friction_at(Scene(puck, Floor(patches=[Patch(0.4, (x, y), radius)])), states)
    gaps = []
    for corners in (50, 100):
        turns = 2.0 * math.pi * np.arange(corners) / corners
        rows = np.stack([x + radius * np.cos(turns), y + radius * np.sin(turns)], axis=1)
        floor = Floor(patches=[Patch(0.4, corners=rows.tolist())])
        gaps.append(np.abs(friction_at(Scene(puck, floor), states) - whole).max())
    assert gaps[1] < 1e-3
    assert 3.0 < gaps[0] / gaps[1] < 5.0


@pytest.mark.thorough
def test_a_box_comes_to_rest_on_a_patch_as_on_a_strip() -> None:
    half = [(0.1, -9.0), (9.0, -9.0), (9.0, 9.0), (0.1, 9.0)]
    box = Puck(base="box:0.2x0.1", friction=0.2, height=0.02)
    ends = []
    for floor in (
        Floor(patches=[Patch(0.4, corners=half)]), Floor(strips=Strips((0.1,), (0.2, 0.4))),
    ):  # fmt: skip
        run = Scene(box, floor, launch=Launch(velocity=(1.0, 0.1), spin=8.0)).simulate([0.0])
        ends.append([run.end_time, *(run.last[key] for key in ("x", "y", "orientation"))])
        assert abs(run.energy_residual) < 1e-12
    assert np.abs(np.subtract(*ends)).max() < 1e-9


def test_a_law_is_integrated_as_exactly_as_a_constant() -> None:
    constant = packed_law(*law_moments(lambda u: 0.3 + 0.0 * u, np.array([0.0, 60.0])))
    rng = np.random.default_rng(3)
    for base in BASES.values():
        shape = packed(base, 0.0)
        unit = 0.3 * base.area * np.array([1.0] * 2 + [base.reach] * 4 + [base.reach**2] * 2)
        outermost = base.points() - np.array(base.middle)
        for _ in range(20):
            w, far = float(rng.choice([-5.0, 5.0])), 10.0 ** float(rng.uniform(-4.0, 2.0))
            rim = outermost[rng.integers(len(outermost))]  # C on a corner or a rim
            for ux, uy in (far * rng.normal(size=2) * 0.1, (w * rim[1], -w * rim[0])):
                own = base_sums(shape, ux, uy, w)
                law = law_sums(*whole(shape), constant, ALIKE, ux, uy, w)
                assert np.abs((np.array(law) - 0.3 * np.array(own)) / unit).max() < 1e-10


@pytest.mark.parametrize("turn", [2.0 * math.pi, math.pi])
def test_where_it_turns_far_away_a_disc_or_half_of_it_is_what_points_sum(turn: float) -> None:
    size, side = 0.1, 0.0 if turn > 4.0 else 1.0  # the left half of a disc: an arc and a side
    arc = [0.0, size, 0.0, 0.0, size, 0.5 * math.pi, 0.0, -size, turn]
    room = np.array([*arc, *(side * np.array([0.0, -size, 0.0, 1.0, 2.0 * size, 0, 0, size, 0]))])
    law = StribeckLaw(0.3, 0.1, speed=0.3, exponent=2.0)
    pack = packed_law(*law_moments(law, law.pieces(9.0)[0]))
    nodes, weights = np.polynomial.legendre.leggauss(60)
    r = 0.5 * size * (1.0 + nodes[:, None])
    angle = 0.5 * math.pi + 0.5 * turn * (1.0 + nodes)
    part = 0.25 * size * turn * r * np.outer(weights, weights)
    x, y = r * np.cos(angle), r * np.sin(angle)
    unit = 0.4 * part.sum() * np.array([1.0] * 2 + [size] * 4 + [size**2] * 2)
    rng = np.random.default_rng(8)
    for _ in range(40):
        speed, toward = 10.0 ** rng.uniform(-1.3, 0.3), rng.uniform(0.0, 2.0 * math.pi)
        w = speed / (size * 10.0 ** rng.uniform(math.log10(6.01), 1.5))
        ux, uy = speed * math.cos(toward), speed * math.sin(toward)
        vx, vy = ux - w * y, uy + w * x
        slip = np.hypot(vx, vy)
        f = part * law(slip.ravel()).reshape(slip.shape) / slip
        tx, ty = f * vx, f * vy
        turning = x * ty - y * tx
        terms = [tx, ty, tx * x, tx * y, ty * x, ty * y, turning * x, turning * y]
        truth = np.array([term.sum() for term in terms])
        last = len(room) if side else len(arc)
        found = np.array(law_sums(room, 0, last, size, pack, ALIKE, ux, uy, w))
        assert (np.abs(found - truth) < 1e-10 * unit).all(), (speed, w)


@pytest.mark.parametrize("draws", [8, thorough(40)])
@pytest.mark.parametrize("axes", [ALIKE, Ellipse(0.6, 0.05, 0.8, 0.6)])
def test_arrays_give_what_the_kernel_gives_before_it_is_compiled(axes: Ellipse, draws: int) -> None:
    def smooth(u: np.ndarray) -> np.ndarray:
        return 0.002 / (u + 0.06) + 0.006

    law = packed_law(*law_moments(smooth, np.array([0.0, 60.0])))
    rng = np.random.default_rng(4)
    for base in BASES.values():
        shape, outermost = packed(base, 0.0), base.points() - np.array(base.middle)
        for _ in range(draws):
            w, far = float(rng.choice([-5.0, 5.0])), 10.0 ** float(rng.uniform(-4.0, 2.0))
            rim = outermost[rng.integers(len(outermost))]
            slips = [(*(far * rng.normal(size=2) * 0.1), w), (w * rim[1], -w * rim[0], w)]
            for ux, uy, spin in [*slips, (1.0, 0.5, 0.0)]:
                one = law_sums.py_func(*whole(shape), law, axes, ux, uy, spin)
                two = law_sums.at_first(*whole(shape), law, axes, ux, uy, spin)
                unit = base.area * np.array([1.0] * 2 + [base.reach] * 4 + [base.reach**2] * 2)
                assert (np.abs(np.subtract(one, two)) < 1e-13 * unit).all()


def test_a_square_turns_when_the_torque_is_that_of_its_friction() -> None:
    side, friction, gravity = 0.1, 0.3, 10.0
    limit = (math.sqrt(2.0) + math.log(1.0 + math.sqrt(2.0))) / 6.0 * friction * gravity * side
    square = Puck(base=f"box:{side}x{side}", friction=friction, gravity=gravity)
    for share, end in ((1.0 - 1e-9, "at rest"), (1.0 + 1e-9, "time is up")):
        run = Scene(square, force=Force(torque=share * limit), time=1.0).simulate([0.0])
        assert run.end == end, share


def test_a_block_holds_on_a_slope_to_its_angle_of_friction() -> None:
    for base in ("box:0.3x0.02", "disc:0.05@0.005,0"):
        block = Puck(base=base, friction=0.25, height=0.02, gyration=0.05)
        for slope, end in ((math.atan(0.25) - 1e-9, "at rest"), (math.atan(0.25) + 1e-6, "moves")):
            run = Scene(block, Floor(slope=slope), time=0.5).simulate([0.0])
            assert (run.end == "at rest") == (end == "at rest"), (base, slope)


def test_a_stone_on_a_running_band_meets_a_wall_by_its_rim() -> None:
    stone = Puck(
        0.14, base="annulus:0.065x0.06", friction=0.1, gyration=0.1, restitution=0.8,
        launch=Launch(velocity=(1.0, 0.0), spin=2.0), name="stone",
    )  # fmt: skip
    run = Scene(pucks=[stone], walls=[Wall((0.3, 0.0), normal=(-1.0, 0.0))]).simulate()
    impact = next(event for event in run.events if event.what == "impact")
    assert abs(impact.x - 0.3) < 1e-9  # where they touch


def test_a_base_meets_no_wall_without_a_rim() -> None:
    with pytest.raises(InputError, match=r"puck.radius is missing"):
        Scene(Puck(base="box:0.2x0.1", friction=0.2), walls=[Wall((1.0, 0.0), normal=(-1.0, 0.0))])


def test_numbers_of_a_puck_on_a_base_are_checked() -> None:
    for numbers, words in (
        ({"base": "box:0.2x0.1@0.06,0", "friction": 0.3}, "part of it would lift"),
        ({"base": "box:0.2x0.1@0.01,0", "friction": 0.3}, "gyration is missing"),
        ({"base": "box:0.2x0.1", "radius": 0.1}, "not be less than the reach"),
        ({"base": "box:0.2x0.1", "pressure": "ring"}, "pressure laws are of round pucks"),
        ({"base": "boxes:0.2x0.1"}, "no base is called"),
        ({"base": "box:0.2"}, "box takes 2 lengths, an x between"),
        ({"base": "box:10cm,6cm"}, "box takes 2 lengths, an x between"),
        ({"base": "none.csv"}, "none.csv"),
        ({}, "radius is missing"),
    ):
        with pytest.raises((InputError, ContactError), match=words):
            Puck(**numbers)  # type: ignore[arg-type]


def test_a_base_goes_into_a_file_and_comes_back() -> None:
    scene = Scene.from_tables({
        "puck": {"base": "box:20cmx10cm", "friction": 0.3},
        "launch": {"velocity": [1.0, 0.0], "spin": 10.0, "orientation": math.pi / 6},
        "edge": [{"point": [5.0, 0.0], "normal": [-1.0, 0.0]}],
    })  # fmt: skip
    assert scene.edges == (Edge((5.0, 0.0), normal=(-1.0, 0.0)),)
    again = Scene.from_tables(tomllib.loads(as_toml(scene)))
    assert again == scene
    run = again.simulate([0.0])
    assert abs(run.end_time - KNOWN["box"][3][0]) < 2e-10


def test_a_slip_that_turns_at_last_stops_in_time() -> None:
    """With hardly a spin the slip turns into one only where it is nearly over."""
    width, depth, friction, k, launch = 0.0915, 0.056, 0.8, 0.0406, (-1.926, -1.337)
    puck = Puck(base=Base.box(width, depth), friction=friction, gyration=k)
    run = Scene(puck, launch=Launch(launch, spin=-9.34e-4), tol=1e-9).simulate([0.0])
    x, y = 0.5 * width, 0.5 * depth
    judge = Judge([[(-x, -y), (x, -y), (x, y), (-x, y)]], [], 0.0, k)
    time, *place = judge.slide(launch, -9.34e-4, friction * 9.80665)[:3]
    unit = run.speed_scale / run.rate_scale
    assert abs(run.end_time - time) <= 1e-9 * unit
    assert np.abs(np.subtract([run.last["x"], run.last["y"]], place)).max() <= 1e-9 * unit**2 * 7.8
