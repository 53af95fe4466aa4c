"""Friction of slips and slips of frictions, against a quadrature, closed forms and each other."""

from __future__ import annotations

import math

import numpy as np
import pytest
from mpmath import asinh, mp, mpf, quad, sqrt

import puck_tables as pt
from puck_tables.kernels.base_friction import packed
from puck_tables.kernels.base_hessian import grip_slopes
from puck_tables.kernels.base_twist import base_twist

Base = pt.Base
G = 9.80665
TEE = Base.union([Base.box(0.2, 0.04), Base.polygon([(-0.02, -0.2), (0.02, -0.2), (0.02, -0.021),
                                                    (-0.02, -0.021)])])  # fmt: skip
BASES = {
    "box": Base.box(0.2, 0.1),
    "bar": Base.box(1.0, 0.01),
    "off-centre box": Base.box(0.2, 0.1, centre=(0.01, -0.01)),
    "triangle": Base.polygon([(0.0, 0.0), (0.12, 0.0), (0.0, 0.09)]),
    "tee": TEE,
    "frame": Base.polygon([(0, 0), (0.3, 0), (0.3, 0.2), (0, 0.2)],
                          holes=[[(0.1, 0.05), (0.1, 0.15), (0.2, 0.15), (0.2, 0.05)]]),
    "disc": Base.disc(0.05),
    "off-centre disc": Base.disc(0.05, centre=(0.01, 0.005)),
    "annulus": Base.annulus(0.05, 0.045),
    "feet": Base.feet([(0.05, 0.0), (-0.03, 0.04), (-0.03, -0.05)], 0.005),
    "points": Base.feet([(0.05, 0.0), (-0.03, 0.04), (-0.03, -0.05), (0.02, 0.0)], 1e-5),
    "foot and box": Base.union([Base.box(0.1, 0.05), Base.feet([(0.2, 0.0)], 0.01)]),
}  # fmt: skip
every_base = pytest.mark.parametrize("name", BASES)
heights = pytest.mark.parametrize("share", [0.0, 0.9])  # of the highest that stays down


def puck_on(name: str, share: float = 0.0, **numbers) -> pt.Puck:
    """A puck whose friction is 1 N where it slides without spin."""
    base = BASES[name]
    return pt.Puck(
        base=base, friction=0.5, mass=2.0 / G, height=4.0 * share * base.highest_lever,
        gyration=base.gyration, **numbers,
    )  # fmt: skip


def slips(count: int, length: float, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Velocities and spins of every kind."""
    rng = np.random.default_rng(seed)
    velocity, spin = rng.normal(size=(count, 2)), rng.normal(size=count) / length
    spin *= 10.0 ** rng.uniform(-4.0, 4.0, count)
    spin[: count // 20] = 0.0
    return velocity, spin


# --- an own quadrature of a box: over x by elementary integrals, over y by tanh-sinh


def quadrant(a, b) -> dict[str, mpf]:
    """∫∫ of what friction needs over 0 < x < a, 0 < y < b, distances from C; of any signs."""
    sign_x, sign_y, a, b = (1 if a >= 0 else -1), (1 if b >= 0 else -1), abs(a), abs(b)
    if a == 0 or b == 0:
        return dict.fromkeys(("x/R", "y/R", "R", "xx/R", "xy/R", "yy/R", "xR", "yR"), mpf(0))

    def radius(y):
        return sqrt(a * a + y * y)

    def sine(y):
        return asinh(a / y) if y > 0 else mpf(0)

    inner = {
        "x/R": lambda y: radius(y) - y, "y/R": lambda y: y * sine(y),
        "R": lambda y: (a * radius(y) + y * y * sine(y)) / 2,
        "xx/R": lambda y: (a * radius(y) - y * y * sine(y)) / 2,
        "xy/R": lambda y: y * (radius(y) - y), "yy/R": lambda y: y * y * sine(y),
        "xR": lambda y: (radius(y) ** 3 - y**3) / 3,
        "yR": lambda y: y * (a * radius(y) + y * y * sine(y)) / 2,
    }  # fmt: skip
    cuts = [mpf(0), *[c for c in (a / 10, a, 10 * a) if c < b], b]
    # signs: of an integrand odd in x the integral to −a is that to a, of an even one minus that
    return {
        name: quad(part, cuts)
        * (1 if name[0] == "x" and name[:2] != "xx" else sign_x)
        * (1 if "y" in name and "yy" not in name else sign_y)
        for name, part in inner.items()
    }


def friction_of_box(length, width, lever, c, sense) -> list[float]:
    """Force and torque over f N that keep a turn about C going, and |u| has no part in it."""
    cx, cy = mpf(c[0]), mpf(c[1])
    sums = dict.fromkeys(("x/R", "y/R", "R", "xx/R", "xy/R", "yy/R", "xR", "yR"), mpf(0))
    half, wide = mpf(length) / 2, mpf(width) / 2
    for a, one in ((half - cx, 1), (-half - cx, -1)):
        for b, other in ((wide - cy, 1), (-wide - cy, -1)):
            for name, value in quadrant(a, b).items():
                sums[name] += one * other * value
    # e = sense (−Y, X)/R from C; x = c + X
    ex, ey = -sense * sums["y/R"], sense * sums["x/R"]
    exx, exy = -sense * sums["xy/R"] + cx * ex, -sense * sums["yy/R"] + cy * ex
    eyx, eyy = sense * sums["xx/R"] + cx * ey, sense * sums["xy/R"] + cy * ey
    turn = eyx - exy
    # ∫ x (x × e) = c ∫ x × e + ∫ X (X × e) + ∫ X (c × e)
    turn_x = cx * turn + sense * sums["xR"] + cx * (eyx - cx * ey) - cy * (exx - cx * ex)
    turn_y = cy * turn + sense * sums["yR"] + cx * (eyy - cy * ey) - cy * (exy - cy * ex)
    area, z = mpf(length) * mpf(width), mpf(lever)
    xx, yy = area * mpf(length) ** 2 / 12, area * mpf(width) ** 2 / 12
    balance = mp.matrix([
        [area, 0, 0], [-z * ex, xx - z * exx, -z * exy], [-z * ey, -z * eyx, yy - z * eyy],
    ])  # fmt: skip
    a, bx, by = mp.lu_solve(balance, mp.matrix([1, 0, 0]))
    return [float(a * ex + bx * exx + by * exy), float(a * ey + bx * eyx + by * eyy),
            float(a * turn + bx * turn_x + by * turn_y)]  # fmt: skip


CENTRES = [
    (0.0, 0.0), (0.5, 0.0), (0.5, 0.5), (0.1, 0.5), (0.3, 0.2), (0.5 + 1e-9, 0.5),
    (0.2, 0.5 - 1e-12), (-0.7, 0.5), (0.9, 3.0), (5.9, 1.0), (6.1, -2.0),
    (-40.0, 30.0), (3e3, 1e3), (1e7, -3e6),
]  # fmt: skip


@pytest.mark.thorough
@pytest.mark.parametrize("ratio", [1.0, 2.0, 100.0])
@pytest.mark.parametrize("centre", CENTRES)
def test_a_box_with_its_centre_of_rotation_anywhere(ratio: float, centre: tuple[float, float]):
    """On sides and corners, next to them, inside, far away: 1e-13 of f N, and of its torque."""
    width = 0.2 / ratio
    base = Base.box(0.2, width)
    far = max(map(abs, centre)) > 5.0
    place = (0.2 * centre[0], (0.2 if far else width) * centre[1])
    for share, sense in ((0.0, 1.0), (0.9, -1.0)):
        lever = share * base.highest_lever
        puck = pt.Puck(base=base, friction=0.5, mass=2.0 / G, height=4.0 * lever)
        velocity, spin = (sense * place[1], -sense * place[0]), sense
        mine = puck.wrench(velocity, spin)
        with mp.workdps(60):
            # where C is after rounding; the height is that of the puck
            place_exact = (mpf(velocity[1]) / -sense, mpf(velocity[0]) / sense)
            truth = friction_of_box(0.2, width, puck.lever, place_exact, sense)
        np.testing.assert_allclose(-mine.force, truth[:2], rtol=0.0, atol=1e-13)
        assert abs(-float(mine.torque) - truth[2]) <= 1e-13 * base.reach


@heights
@every_base
def test_a_slide_without_spin_needs_one_newton_and_of_flat_bodies_no_torque(name, share):
    puck = puck_on(name, share)
    angle = np.linspace(0.0, 6.0, 7)
    velocity = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    found = puck.wrench(3.0 * velocity, 0.0, 0.7)
    np.testing.assert_allclose(found.force, -velocity, atol=1e-14)  # a bar loses a digit
    if share == 0.0:
        np.testing.assert_allclose(found.torque, 0.0, atol=1e-14 * puck.radius)
    barely = puck.wrench(3.0 * velocity, 1e-9 / puck.radius, 0.7)
    np.testing.assert_allclose(barely.force, found.force, atol=1e-9)
    np.testing.assert_allclose(barely.torque, found.torque, atol=1e-9 * puck.radius)


@pytest.mark.parametrize(("law", "base"), [
    ("uniform", Base.disc(0.05)), ("annulus:0.6", Base.annulus(0.05, 0.03)),
])  # fmt: skip
@pytest.mark.parametrize("delta", [0.0, 0.7])
def test_round_bases_are_round_pucks(law: str, base: Base, delta: float):
    """Against the resultants of the law, which share no code with sums over a base."""
    numbers = {"friction": 0.5, "mass": 2.0 / G, "height": 0.05 * delta}
    surface = pt.Puck(0.05, pressure=law, **numbers).limit_surface(301)
    phi = surface.slip_angle
    velocity = np.cos(phi)[:, None] * [0.0, 1.0]  # along y: the force across is along −x
    found = pt.Puck(base=base, **numbers).wrench(velocity, np.sin(phi) / 0.05, 0.3)
    np.testing.assert_allclose(-found.force[:, 1], surface.force_x, atol=1e-12)
    np.testing.assert_allclose(found.force[:, 0], surface.force_y, atol=1e-12)
    np.testing.assert_allclose(-found.torque, surface.torque, atol=1e-12 * 0.05)


def test_a_square_turned_in_place():
    square = pt.Puck(base="box:0.1x0.1", friction=0.4, mass=3.0)
    exact = 0.4 * 3.0 * G * 0.1 * (math.sqrt(2.0) + math.asinh(1.0)) / 6.0
    assert -float(square.wrench((0.0, 0.0), 2.0).torque) == pytest.approx(exact, rel=1e-14)
    assert float(square.holds((0.0, 0.0), 1.0).margin) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("along", [0.0, 0.3, 0.5, 2.0])
def test_a_thin_bar_tends_to_a_line(along: float):
    """A line of length 1 that turns about a point ``along`` it from its middle."""
    force = min(2.0 * along, 1.0)
    torque = max(0.25 - along**2, 0.0)
    gaps = []
    for width in (1e-2, 2.5e-3, 6.25e-4):
        bar = pt.Puck(base=Base.box(1.0, width), friction=0.5, mass=2.0 / G)
        found = bar.wrench((0.0, -along), 1.0)
        gaps.append(math.hypot(float(found.force[1]) - force, float(found.torque) + torque))
    # a square of the width times its logarithm; at the end of the line the width
    assert gaps[-1] < (1e-3 if along == 0.5 else 1e-5)
    assert gaps[0] / gaps[1] > (3.0 if along == 0.5 else 10.0)
    assert gaps[1] / gaps[2] > (3.0 if along == 0.5 else 10.0)


@heights
@every_base
def test_derivatives_are_those_of_differences_and_these_converge(name: str, share: float):
    puck = puck_on(name, share)
    length = puck.inertia_radius
    velocity, spin = slips(60, length)
    size = np.hypot(np.hypot(*velocity.T), length * spin)
    angle = np.linspace(0.0, 7.0, 60)
    slopes = puck.wrench(velocity, spin, angle, jacobian=True).jacobian
    scale = np.array([1.0, 1.0, 1.0 / length])

    def missed(step: float) -> np.ndarray:
        worst = np.zeros(60)
        for j in range(3):
            change = np.zeros((60, 3))
            change[:, j] = step * size * (1.0 if j < 2 else 1.0 / length)
            pair = [puck.wrench(velocity + k * change[:, :2], spin + k * change[:, 2], angle)
                    for k in (1.0, -1.0)]  # fmt: skip
            width = 2.0 * change[:, j]
            force = (pair[0].force - pair[1].force) / width[:, None] - slopes[:, :2, j]
            torque = (pair[0].torque - pair[1].torque) / width - slopes[:, 2, j]
            gap = np.hypot(np.hypot(*force.T), torque / length) * scale[j] * size
            worst = np.maximum(worst, gap)
        return worst / (1.0 + np.abs(slopes * scale * scale[:, None]).max(axis=(1, 2)) * size)

    coarse, fine = missed(2e-3), missed(1e-3)
    if name != "points":  # their steps are 1e-4 of a foot's
        assert 3.3 < np.median(coarse[coarse > 1e-9] / fine[coarse > 1e-9]) < 4.3
        assert np.median(missed(1e-5)) < 3e-9
    # friction depends on no size of the slip; and of a flat body the derivatives are a Hessian
    twist = np.column_stack([velocity, spin])
    assert np.abs(np.einsum("nij,nj->ni", slopes, twist)).max() < 1e-13 / scale.min()
    if share == 0.0:
        np.testing.assert_allclose(slopes, slopes.transpose(0, 2, 1), rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("law", ["hertz", "ring", "annulus:0.5", "uniform"])
def test_derivatives_under_round_laws(law: str):
    puck = pt.Puck(0.05, 0.03 if law != "uniform" else 0.15, 0.5, mass=2.0 / G, pressure=law)
    velocity, spin = np.array([[1.0, 0.3], [0.2, -1.0], [0.0, 0.0], [1.0, 2.0]]), [9, -70, 5, 0.0]
    slopes = puck.wrench(velocity, spin, jacobian=True).jacobian
    for j in range(3):
        step = np.eye(3)[j] * [1e-4, 1e-4, 2e-3]
        more = puck.wrench(velocity + step[:2], np.add(spin, step[2]))
        less = puck.wrench(velocity - step[:2], np.add(spin, -step[2]))
        force = (more.force - less.force) / (2.0 * step[j])
        np.testing.assert_allclose(slopes[:, :2, j], force, atol=2e-4 * np.abs(force).max())
        torque = (more.torque - less.torque) / (2.0 * step[j])
        np.testing.assert_allclose(slopes[:, 2, j], torque, atol=2e-4 * np.abs(torque).max())


@pytest.mark.thorough
@heights
@every_base
def test_every_wrench_has_its_slip(name: str, share: float):
    """Of 10,000 at random none fails, and friction in each is along it, to 1e-11 of f m g."""
    puck = puck_on(name, share)
    rng = np.random.default_rng(7)
    rows = rng.normal(size=(10_000, 3))
    rows[:, 2] *= puck.inertia_radius * 10.0 ** rng.uniform(-3.0, 3.0, 10_000)
    rows[:300, 2], rows[300:400, :2] = 0.0, 0.0
    found = puck.twist(rows[:, :2], rows[:, 2])
    back = puck.wrench(found.velocity, found.spin)
    scale = np.array([1.0, 1.0, 1.0 / puck.inertia_radius])
    mine = np.column_stack([back.force, back.torque]) * scale
    wanted = rows * scale
    along = np.einsum("ni,ni->n", mine, wanted) / np.einsum("ni,ni->n", wanted, wanted)
    assert (along > 0.0).all()
    assert np.abs(mine - along[:, None] * wanted).max() < (1e-9 if name == "bar" else 1e-11)
    np.testing.assert_allclose(puck.holds(-rows[:, :2], -rows[:, 2]).margin, along, rtol=1e-9)


@heights
@every_base
def test_wrench_and_twist_are_inverse(name: str, share: float):
    """Where the slip is determined well, by less than 1e-9; next to facets of feet it is not."""
    puck = puck_on(name, share)
    length = puck.inertia_radius
    velocity, spin = slips(500, length, seed=3)
    angle = np.linspace(-9.0, 9.0, 500)
    found = puck.twist(*puck.wrench(velocity, spin, angle)[:2], angle)
    size = np.hypot(np.hypot(*velocity.T), length * spin)
    gap = np.hypot(*(found.velocity - velocity / size[:, None]).T)
    gap = np.hypot(gap, length * (found.spin - spin / size))
    assert np.median(gap) < (1e-9 if name == "points" else 1e-12)
    assert gap.max() < {"points": 1e-4, "bar": 1e-6, "annulus": 1e-9}.get(name, 1e-9)


@pytest.mark.parametrize("law", ["uniform", "hertz", "galin", "ring", "annulus:0.5"])
@pytest.mark.parametrize("delta", [0.0, 0.7, 2.0])
def test_wrench_and_twist_of_round_pucks_are_inverse(law: str, delta: float):
    if delta > 1.0 and law != "uniform":
        delta = 0.3
    puck = pt.Puck.similar(delta=delta, radius=0.1, pressure=law)
    velocity, spin = slips(200, 0.1, seed=4)
    found = puck.twist(*puck.wrench(velocity, spin)[:2])
    size = np.hypot(np.hypot(*velocity.T), 0.1 * spin)
    np.testing.assert_allclose(found.velocity, velocity / size[:, None], atol=1e-9)
    np.testing.assert_allclose(0.1 * found.spin, 0.1 * spin / size, atol=1e-9)


@every_base
def test_a_flat_body_takes_the_most_power_by_its_own_wrench(name: str):
    """So its slips are the normals of the limit surface, which is convex."""
    puck = puck_on(name)
    velocity, spin = slips(300, puck.inertia_radius, seed=5)
    size = np.hypot(np.hypot(*velocity.T), puck.inertia_radius * spin)
    slip = np.column_stack([velocity, spin]) / size[:, None]
    force, torque, _ = puck.wrench(velocity, spin)
    power = slip @ -np.column_stack([force, torque]).T
    assert (np.diag(power) > 0.0).all()
    assert (power <= np.diag(power)[:, None] + 1e-14).all()
    # the margin of what is held is the least of power over power among all slips
    rows = np.random.default_rng(6).normal(size=(50, 3)) * [1.0, 1.0, puck.inertia_radius]
    margin = puck.holds(rows[:, :2], rows[:, 2]).margin
    drive = rows @ slip.T
    bound = np.where(drive > 0.0, np.diag(power) / np.maximum(drive, 1e-300), np.inf).min(axis=1)
    assert (margin <= bound * (1.0 + 1e-12)).all() and (margin > 0.5 * bound).all()


@heights
def test_mirror_images_and_turns(share: float):
    corners = np.array([(0.0, 0.0), (0.12, 0.0), (0.03, 0.09)])
    height = 4.0 * share * Base.polygon(corners).highest_lever
    numbers = {"friction": 0.5, "height": height}
    one = pt.Puck(base=Base.polygon(corners), **numbers)
    mirrored = pt.Puck(base=Base.polygon((corners * [1, -1])[::-1]), **numbers)
    velocity, spin = slips(50, 0.04)
    a, b = one.wrench(velocity, spin), mirrored.wrench(velocity * [1, -1], -spin)
    np.testing.assert_allclose(a.force * [1, -1], b.force, atol=1e-14)
    np.testing.assert_allclose(-a.torque, b.torque, atol=1e-15)
    turn = np.array([[math.cos(0.4), math.sin(0.4)], [-math.sin(0.4), math.cos(0.4)]])
    turned = one.wrench(velocity @ turn, spin, 0.4)
    np.testing.assert_allclose(turned.force, a.force @ turn, atol=1e-14)
    np.testing.assert_allclose(turned.torque, a.torque, atol=1e-15)
    held = one.holds(a.force @ turn, a.torque, 0.4).margin
    np.testing.assert_allclose(held, one.holds(a.force, a.torque).margin, rtol=1e-11)


def test_slips_and_wrenches_of_any_size():
    for puck in (puck_on("box"), puck_on("feet", 0.5), pt.Puck.similar(pressure="ring")):
        sizes = 10.0 ** np.array([-300.0, -160.0, 0.0, 160.0, 300.0])
        found = puck.wrench(sizes[:, None] * [0.3, -0.4], 0.2 * sizes)
        np.testing.assert_allclose(found.force, found.force[[2] * 5], rtol=1e-14)
        back = puck.twist(sizes[:, None] * [0.3, -0.4], 0.01 * sizes)
        np.testing.assert_allclose(back.velocity, back.velocity[[2] * 5], rtol=1e-9)
        margin = puck.holds(sizes[:, None] * [0.3, -0.4], 0.01 * sizes).margin
        np.testing.assert_allclose(margin * sizes, margin[2], rtol=1e-12)


def test_all_broadcasts():
    puck = puck_on("box")
    found = puck.wrench(np.ones((3, 1, 2)), np.ones(4), jacobian=True)
    assert found.force.shape == (3, 4, 2) and found.torque.shape == (3, 4)
    assert found.jacobian.shape == (3, 4, 3, 3)
    slip = puck.twist((1.0, 0.0), np.ones(5), np.ones((2, 1)))
    assert slip.velocity.shape == (2, 5, 2) and slip.spin.shape == (2, 5)
    assert puck.holds((1.0, 0.0), np.ones(5)).held.shape == (5,)
    assert puck.wrench((1.0, 0.0)).jacobian is None


def test_kernels_run_as_they_are_written():
    for name in ("box", "off-centre disc", "points"):
        puck = puck_on(name, 0.5)
        base, slip, slopes = packed(BASES[name], puck.lever), np.empty(3), np.empty((3, 3))
        share = base_twist(base, 0.4, -0.3, 0.01, slip, slopes)
        assert share == pytest.approx(float(puck.holds((0.4, -0.3), 0.01).margin), rel=1e-12)
        grip_slopes(base, *slip, slopes)
        compiled = -puck.wrench(slip[:2], slip[2], jacobian=True).jacobian
        np.testing.assert_allclose(slopes, compiled, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda p: p.wrench((0.0, 0.0)), "velocity and spin are both 0"),
        (lambda p: p.wrench((1.0, math.nan)), "velocity must be finite"),
        (lambda p: p.wrench(1.0), "two components"),
        (lambda p: p.wrench((1.0, 0.0), math.inf), "spin must be finite"),
        (lambda p: p.wrench((1.0, 0.0), 0.0, math.inf), "angle must be finite"),
        (lambda p: p.wrench(np.zeros((3, 2)), np.zeros(2)), "do not broadcast"),
        (lambda p: p.twist((0.0, 0.0)), "force and torque are both 0"),
        (lambda p: p.twist((0.0, math.nan)), "force must be finite"),
        (lambda p: p.twist((0.0, 1.0), "strong"), "torque"),
        (lambda p: pt.Puck(1.0).twist((1.0, 0.0)), "friction = 0"),
        (lambda p: pt.Puck(base="box:1x1").holds((1.0, 0.0)), "friction = 0"),
    ],
)
def test_bad_input_is_one_sentence(ask, words: str):
    with pytest.raises(pt.InputError, match=words):
        ask(puck_on("box"))
