"""Motions of every puck: part of the base lifted, any pressure law, any radius of gyration."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
from any_puck import stops_by_truth
from pucks import simulate
from rarely import nightly, thorough

from puck_tables import Puck, law_of
from puck_tables.contact import loaded_share, one_sided_resultants
from puck_tables.contact.laws import HOMOGENEOUS
from puck_tables.errors import AccuracyError, ContactError, InputError
from puck_tables.motion import limit_angle, limit_ratio, regime
from puck_tables.motion.body import body_of
from puck_tables.motion.friction_source import section_friction
from puck_tables.motion.steppers import DORMAND_PRINCE, RK4, Stepping
from puck_tables.motion.unit_motion import integrated
from puck_tables.table.friction_section import friction_section
from puck_tables.table.singular_lines import opening_angle
from puck_tables.table.slip_spline import graded
from puck_tables.trajectory import Trajectory

PUCKS = [
    ("uniform", 1.05, HOMOGENEOUS), ("uniform", 1.159, 0.4), ("uniform", 2.0, HOMOGENEOUS),
    ("uniform", 3.5, HOMOGENEOUS), ("uniform", 3.9, HOMOGENEOUS), ("ring", 1.0, 1.0),
    ("annulus:0.8", 1.6, 0.9), ("hertz", 0.5, 0.5), ("galin", 1.0, 1.5), ("uniform", 0.5, 2.0),
]  # fmt: skip


def launch(u: float) -> tuple[tuple[float, float], float]:
    """v0 and w0 with Q = r = 1 and rω/v = e^u."""
    q = math.hypot(1.0, math.exp(-abs(u)))
    large, small = 1.0 / q, math.exp(-abs(u)) / q
    return ((small, 0.0), large) if u > 0.0 else ((large, 0.0), small)


def numbers(run: Trajectory) -> np.ndarray:
    return np.array([run.stop_time, *run.stop_position, run.path_length, run.body_angle])


def starts(law: str, delta: float, gyration: float, rng: np.random.Generator) -> np.ndarray:
    """Next to every singular line and φ₀ on both sides, next to both ends, and anywhere."""
    lines = np.log(np.tan(friction_section(law_of(law), delta, 0.01).lines))
    ratio = float(limit_ratio(delta, law, gyration))
    centres = [*lines, math.log(ratio)] if 0.0 < ratio < math.inf else list(lines)
    near = [c + s * 10.0 ** -rng.uniform(0.5, 9.0) for c in centres for s in (-1.0, 1.0)]
    return np.array([-12.0, 9.0, *near, *rng.uniform(-3.0, 3.0, 2)])


@pytest.mark.parametrize(
    ("puck", "tolerances"),
    [*(thorough(PUCKS[n], (1e-5, 1e-9)) for n in (2, 6)),
     *(nightly(puck, 10.0 ** -np.arange(3.0, 11.0)) for puck in PUCKS)],
)  # fmt: skip
def test_stops_by_truth_friction(puck: tuple[str, float, float], tolerances: Iterable[float]):
    law, delta, gyration = puck
    u = starts(*puck, np.random.default_rng(4))
    truth = stops_by_truth(*puck, u)
    for tol in tolerances:
        for n, one in enumerate(u):
            v0, w0 = launch(one)
            run = simulate(v0, w0, delta=delta, pressure=law, gyration=gyration, tol=tol)
            error = np.abs(numbers(run) - truth[:, n])[:3].max()
            assert error <= tol, (puck, one, tol)
            assert run.error_estimate <= tol
            assert (
                error <= 3.0 * run.error_estimate + 1e-11
            )  # as of plain pucks; the judge is off 1e-11


@pytest.mark.parametrize("puck", PUCKS)
def test_a_friction_section_is_as_exact_as_it_says_and_of_order_4(puck: tuple[str, float, float]):
    law, delta, _ = puck
    pressure = law_of(law)
    found = friction_section(pressure, delta, 1e-5 if delta > 3.8 else 1e-7)
    rng = np.random.default_rng(1)
    distance = 10.0 ** -rng.uniform(0.3, 15.0, 60) * rng.choice([-1.0, 1.0], 60)
    phi = np.concatenate([
        rng.uniform(0.0, 0.5 * np.pi, 200), rng.choice([*found.lines, 0.0, 0.5 * np.pi], 60)
        + distance, found.lines, [0.0, 0.5 * np.pi],
    ])  # fmt: skip
    phi = phi[(phi >= 0.0) & (phi <= 0.5 * np.pi)]
    rho = pressure.friction(phi, delta)
    truth = np.stack([1.0 / rho.parallel, rho.perpendicular / rho.parallel,
                      rho.spin / rho.parallel], axis=-1)  # fmt: skip
    error = np.abs(found.ratios(phi) - truth).max()
    assert error <= 1.2 * found.error
    half = found.spline.coarser()
    # where the halved spline is worst: in the middle of its cells, every other node of the whole
    xi = np.arange(1, found.spline.cells, 2) / found.spline.cells
    between = graded(half.sides, xi).ravel()
    coarse = np.abs(half.at(between) - found.spline.values[:, 1::2].reshape(-1, 3)).max()
    assert 3.5 <= math.log2(coarse / found.error) <= 4.7


@pytest.mark.parametrize("puck", [*PUCKS[1:4], *PUCKS[5:9]])
def test_rk4_keeps_order_4_across_every_line(puck: tuple[str, float, float]):
    """From both ends of slip towards φ₀, every line on the way is crossed."""
    friction = section_friction(body_of(*puck), 1e-7)
    crossed = 0
    for u in (-4.0, 4.0):
        truth = integrated(u, friction, Stepping(DORMAND_PRINCE, 0.0, 1e-14))
        lines = friction.coefficients[::2, 2]
        crossed += sum(bool((truth.y[:, 0] == line).any()) for line in lines)
        counts = np.array([60.0, 85.0, 120.0, 170.0, 240.0, 340.0])
        stops = [integrated(u, friction, Stepping(RK4, n, 1.0)).stop for n in counts]
        errors = [np.abs(stop - truth.stop)[2:5].max() for stop in stops]
        order = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
        assert order >= 3.6, (puck, u, errors)
    # a line at φ₀ is never reached, and stands at infinity
    assert crossed == np.isfinite(lines).sum()


def test_limit_ratios_of_known_pucks():
    assert float(limit_ratio(0.0, "ring", 1.0)) == pytest.approx(1.0, abs=1e-14)
    for inner in (0.2, 0.6, 0.9, 0.99):
        gyration = math.sqrt(0.5 * (1.0 + inner**2))  # of a homogeneous washer
        ratio = float(limit_ratio(0.0, f"annulus:{inner}", gyration))
        assert 1.0 < ratio < 1.5313893722
        run = simulate((1, 0), 0.7, delta=0.0, pressure=f"annulus:{inner}", gyration=gyration)
        assert math.tan(run.limit_angle) == ratio
    # pressure towards the centre raises the limit, towards the rim lowers it (paper, section 3)
    uniform = float(limit_ratio(0.1))
    assert float(limit_ratio(0.1, "galin")) < uniform < float(limit_ratio(0.1, "hertz"))
    assert float(limit_ratio(0.0, "hertz")) == math.inf
    assert float(limit_ratio(0.0, "ring")) == 0.0
    assert float(limit_angle(0.0, "hertz")) == 0.5 * math.pi
    assert regime((1, 0), 100.0, 0.0, pressure="hertz") == "C"
    assert regime((1, 0), 1e-9, 0.0, pressure="ring") == "B"


@pytest.mark.parametrize("puck", PUCKS)
def test_near_the_stop_the_ratio_tends_to_its_limit(puck: tuple[str, float, float]):
    law, delta, gyration = puck
    options = {"delta": delta, "pressure": law, "gyration": gyration, "tol": 1e-6}
    for w0 in (0.2, 5.0):
        run = simulate((1, 0), w0, **options)
        near = simulate((1, 0), w0, times=run.stop_time * (1.0 - 10.0 ** -np.arange(1, 6.0)),
                        **options)  # fmt: skip
        gap = np.abs(near.slip_angle - run.limit_angle)
        assert np.all(np.diff(gap) < 1e-6)
        assert gap[-1] < 0.8 * gap[0]


@pytest.mark.parametrize("puck", PUCKS)
def test_pure_motions_in_closed_form(puck: tuple[str, float, float]):
    law, delta, gyration = puck
    options = {"delta": delta, "pressure": law, "gyration": gyration}
    slide = simulate((3, 4), 0.0, decel=2.0, **options)
    assert (slide.regime, slide.stop_time) == ("C0", pytest.approx(2.5, rel=1e-13))
    assert slide.stop_position == pytest.approx((3.75, 5.0), rel=1e-13)
    turning = float(law_of(law).friction(0.5 * math.pi, 0.0).spin)
    spin = simulate((0, 0), -3.0, decel=2.0, radius=0.5, **options)
    time = 2.0 * gyration**2 / turning * 0.5 * 3.0 / 2.0
    assert (spin.regime, spin.stop_time) == ("B0", pytest.approx(time, rel=1e-12))
    assert spin.body_angle == pytest.approx(-1.5 * time, rel=1e-12)
    assert spin.stop_position == (0.0, 0.0)
    assert spin.loaded_share == 1.0
    for tiny in (1e-9, 1e-100, 1e-300):
        nearly = simulate((1.0, 0.0), tiny, **options)
        assert abs(nearly.stop_time - 1.0) <= 3.0 * tiny + 1e-9
        spun = simulate((tiny, 0.0), 1.0, **options)
        assert abs(spun.stop_time - 2.0 * gyration**2 / turning) <= 10.0 * tiny + 1e-9
    assert simulate((0, 0), 0.0, **options).regime == "A"


@pytest.mark.parametrize("puck", PUCKS)
def test_the_limit_motion_is_a_spiral_in_closed_form(puck: tuple[str, float, float]):
    law, delta, gyration = puck
    ratio = float(limit_ratio(delta, law, gyration))
    if not 0.0 < ratio < math.inf:
        return
    options = {"delta": delta, "pressure": law, "gyration": gyration}
    on = simulate((1, 0), ratio, **options)
    assert on.regime == "D" == regime((1, 0), ratio, delta, 1.0, law, gyration)
    np.testing.assert_allclose(on.slip_angle[:-1], on.limit_angle, rtol=1e-12)
    along = float(law_of(law).friction(math.atan(ratio), delta).parallel)
    assert on.stop_time == pytest.approx(math.hypot(1.0, ratio) / along, rel=1e-9)
    for side, name in ((1 - 1e-9, "C"), (1 + 1e-9, "B")):
        beside = simulate((1, 0), side * ratio, **options)
        assert beside.regime == name
        assert np.abs(numbers(beside) - numbers(on)).max() <= 2e-8


@pytest.mark.parametrize("puck", PUCKS)
def test_energy_is_accounted_for_and_never_grows(puck: tuple[str, float, float]):
    law, delta, gyration = puck
    friction = section_friction(body_of(*puck), 1e-5)  # the account closes with any friction
    for u in (-12.0, -0.5, 0.3, 3.0):
        run = integrated(u, friction, Stepping(DORMAND_PRINCE, 0.0, 1e-12))
        assert run.energy_residual <= 1e-10
        energy = kinetic_energy_of(run.z, run.y[:, 0], gyration)
        assert np.all(np.diff(energy) < 0.0)
    options = {"delta": delta, "pressure": law, "gyration": gyration, "tol": 1e-6}
    for w0 in (0.0, 0.6, 20.0):
        run = simulate((1, 0.5), w0, **options)
        assert run.energy_residual <= 1e-5
        energy = 0.5 * (run.speed**2 + gyration**2 * run.spin**2)
        assert run.kinetic_energy == pytest.approx(energy[0], rel=1e-12)
        assert np.all(np.diff(energy) < 0.0)


def kinetic_energy_of(z: np.ndarray, u: np.ndarray, gyration: float) -> np.ndarray:
    return 0.5 * (1.0 - z) ** 8 * (1.0 + gyration**2 * np.exp(2.0 * u)) / (1.0 + np.exp(2.0 * u))


@pytest.mark.parametrize("puck", [PUCKS[2], PUCKS[6]])
def test_similarity(puck: tuple[str, float, float]):
    law, delta, gyration = puck
    options = {"delta": delta, "pressure": law, "gyration": gyration}
    base = simulate((0.6, 0.3), 0.8, **options)
    scaled = simulate((6.0, 3.0), 8.0 / 0.2, decel=5.0, radius=0.2, **options)
    assert scaled.stop_time == pytest.approx(2.0 * base.stop_time, rel=1e-14)
    assert scaled.stop_position == pytest.approx(np.multiply(20.0, base.stop_position), rel=1e-14)
    mirrored = simulate((0.6, 0.3), -0.8, **options)
    x, y = base.stop_position
    east, north = 0.6 / math.hypot(0.6, 0.3), 0.3 / math.hypot(0.6, 0.3)
    along, left = x * east + y * north, y * east - x * north
    assert mirrored.stop_time == base.stop_time
    assert mirrored.stop_position == pytest.approx(
        (along * east + left * north, along * north - left * east), rel=1e-14
    )
    turned = simulate((-0.3, 0.6), 0.8, **options)
    assert turned.stop_position == pytest.approx((-y, x), rel=1e-14)


def test_contact_opens_and_closes_where_the_pressure_touches_zero():
    angle = opening_angle(2.0)
    falling = simulate((1, 0), 5.0, delta=2.0)
    assert (falling.loaded_share, falling.contact_closes) == (1.0, None)
    at = simulate((1, 0), 5.0, delta=2.0, times=[falling.contact_opens])
    assert at.slip_angle[0] == pytest.approx(angle, abs=1e-9)
    assert falling.least_loaded_share == pytest.approx(
        float(loaded_share(falling.limit_angle, 2.0)), abs=1e-12
    )
    rising = simulate((1, 0), 0.3, delta=1.2)
    at = simulate((1, 0), 0.3, delta=1.2, times=[rising.contact_closes])
    assert at.slip_angle[0] == pytest.approx(opening_angle(1.2), abs=1e-9)
    assert rising.contact_opens is None
    assert rising.least_loaded_share == rising.loaded_share < 1.0
    for options in ({"delta": 0.9}, {"delta": 1.0, "pressure": "ring"}):
        run = simulate((1, 0), 0.3, **options)
        assert (run.loaded_share, run.least_loaded_share) == (1.0, 1.0)
        assert run.contact_opens is run.contact_closes is None
    assert simulate((1, 0), 0.0, delta=3.0).least_loaded_share == pytest.approx(
        float(loaded_share(0.0, 3.0))
    )


def test_continuous_through_delta_1_and_the_line_where_contact_opens():
    """Partial contact parts from full contact like the power 5/2: at 1e-6 beyond nothing shows."""
    for w0 in (0.0, 0.1, 1.0, 4.0):
        below = simulate((1, 0), w0, delta=1.0, exact=True, tol=1e-12)
        above = simulate((1, 0), w0, delta=1.0 + 1e-9, tol=1e-10)
        assert np.abs(numbers(above) - numbers(below)).max() <= 1e-8
    ratio = math.tan(opening_angle(2.0))
    found = [numbers(simulate((1, 0), ratio * (1.0 + e), delta=2.0)) for e in (-1e-9, 0.0, 1e-9)]
    assert np.abs(found[0] - found[1]).max() <= 2e-8
    assert np.abs(found[2] - found[1]).max() <= 2e-8
    for line in friction_section(law_of("annulus:0.5"), 0.5, 0.01).lines:
        on, off = (
            numbers(simulate((1, 0), math.tan(line) * e, delta=0.5, pressure="annulus:0.5"))
            for e in (1.0, 1.0 + 1e-10)
        )
        assert np.abs(on - off).max() <= 1e-8


def test_a_section_of_the_plain_puck_is_the_plain_puck():
    """A section against the closed forms, by the method of other pucks."""
    for w0 in (0.2, 5.0):
        plain = simulate((1, 0), w0, delta=0.7, exact=True, tol=1e-12)
        nearly = simulate((1, 0), w0, delta=0.7, gyration=HOMOGENEOUS + 1e-15, tol=1e-10)
        assert "section" in nearly.method
        assert np.abs(numbers(nearly) - numbers(plain)).max() <= 1e-10 * (1.0 + w0**2)


def test_refusals():
    for options, words in (
        ({"delta": 4.0}, "tips"), ({"delta": 3.97}, "more than one solution"),
        ({"pressure": "hertz", "delta": 0.81}, "full contact"),
        ({"gyration": math.nan}, "gyration = nan: must be a number"),
        ({"gyration": 20.0}, "from 0.1 to 10"), ({"pressure": 3}, "pressure = 3: must be"),
        ({"pressure": "ring", "exact": True}, "leave out"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=words):
            simulate((1, 0), 1.0, **options)
    with pytest.raises(ContactError):
        limit_ratio(4.0)
    with pytest.raises(AccuracyError, match="1e-11"):
        simulate((1, 0), 1.0, delta=2.0, tol=1e-12)
    assert simulate((1, 0), 1.0, delta=3.96, tol=1e-6).least_loaded_share < 0.4
    assert float(one_sided_resultants(0.0, 3.96).spin) > 0.0


def test_texts_of_numpy_are_texts(tmp_path: Path):
    puck = Puck(0.1, friction=0.1, pressure=np.array(["galin"])[0], name=np.array(["a"])[0])
    law = law_of(np.array(["hertz"])[0])
    assert {type(text) for text in (puck.pressure, puck.name, law.name)} == {str}
    puck.simulate((1.0, 0.0), 3.0).save(tmp_path / "run.h5")  # whose texts are no arrays
