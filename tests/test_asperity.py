"""A point on a wavy support: events against closed forms, 30 digits and brute force."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest
from commands import invoke
from rarely import thorough
from scipy.integrate import quad
from scipy.optimize import brentq

from puck_tables import SpeedLaw
from puck_tables.chetaev import Asperity, asperity_curve, asperity_motion
from puck_tables.chetaev.asperity_forces import greatest_force, held_round
from puck_tables.errors import InputError, OutputError

UNIT = Asperity(amplitude=1.0, length=1.0, load=1.0, mass=1.0)


def test_the_exact_multiplier_keeps_the_point_on_the_support():
    asperity = Asperity(0.3, 0.7, 2.0, 1.4, pull=0.6)
    x, v = np.linspace(-3.0, 3.0, 13), 0.9
    lam = asperity.multipliers(x, v)[0]
    ax = (-lam * asperity.incline(x) + asperity.pull) / asperity.mass
    ay = (lam - asperity.load) / asperity.mass
    bend = asperity.amplitude / asperity.length**2 * np.cos(x / asperity.length)
    assert ay == pytest.approx(asperity.incline(x) * ax + bend * v**2, abs=1e-14)


def test_leading_terms_are_the_limit_of_flat_asperities():
    gaps = []
    for slope in (0.1, 0.05, 0.025):
        asperity = Asperity(slope, 1.0, 1.0, 1.0)
        exact, leading, crude = asperity.multipliers(1.1, 3.0)
        gaps.append(abs(float(exact - leading)) / slope**2)
        assert float(crude) == 1.0
    assert gaps[0] == pytest.approx(gaps[2], rel=0.4)


def test_the_crest_is_left_above_the_lift_speed():
    asperity = Asperity(2e-6, 5e-6, 3.0, 0.2)
    crest = math.pi * asperity.length
    span = 2.0 * asperity.length / asperity.lift_speed
    for share, kind in ((1.0 - 1e-9, "slide"), (1.0 + 1e-9, "fly")):
        run = asperity_motion(asperity, crest, share * asperity.lift_speed, [0.0, 1e-3 * span])
        assert run.arcs[0].kind == kind


def test_a_flight_off_the_crest_is_a_parabola():
    run = asperity_motion(UNIT, math.pi, 1.5, np.linspace(0.0, 1.9, 9))
    assert run.x == pytest.approx(math.pi + 1.5 * run.time, abs=1e-15)
    assert run.y == pytest.approx(1.0 - 0.5 * run.time**2, abs=1e-15)
    long = asperity_motion(UNIT, math.pi, 1.5, [0.0, 4.0])
    exact = mpmath.findroot(
        lambda t: 1 - t**2 / 2 + mpmath.cos(mpmath.pi + mpmath.mpf(1.5) * t), long.arcs[1].time
    )
    assert abs(long.arcs[1].time - exact) < 1e-12


def test_lift_off_comes_when_the_exact_multiplier_is_zero():
    """Sliding from the trough: energy gives x′(x), a quadrature of 30 digits the time."""
    asperity = Asperity(0.5, 1.0, 1.0, 1.0)
    start = 2.5
    run = asperity_motion(asperity, 0.0, start, [0.0, 2.0])
    assert [arc.kind for arc in run.arcs[:2]] == ["slide", "fly"]

    def squared(x):
        energy = mpmath.mpf(start) ** 2 / 2 - (1 - mpmath.cos(x)) / 2
        return 2 * energy / (1 + mpmath.sin(x) ** 2 / 4)

    with mpmath.workdps(30):
        leaves = mpmath.findroot(lambda x: 1 + squared(x) * mpmath.cos(x) / 2, 2.0)
        time = mpmath.quad(lambda x: 1 / mpmath.sqrt(squared(x)), [0, 1, leaves])
    assert abs(run.arcs[1].x - leaves) < 1e-12
    assert abs(run.arcs[1].time - time) < 1e-12


@pytest.mark.parametrize(
    ("speed", "pull"),
    [(0.4, -0.15), (3.0, 0.1), (-5.0, 0.0), thorough(3.0, -0.15), thorough(-5.0, 0.1)],
)
def test_energy_goes_in_landings_only_and_the_support_is_never_entered(speed, pull):
    asperity = Asperity(0.4, 1.0, 1.0, 1.0, pull=pull)
    run = asperity_motion(asperity, 0.3, speed, np.linspace(0.0, 25.0, 101))
    assert run.energy_residual < 1e-9 * (1.0 + run.vx[0] ** 2 + abs(pull * run.x).max())
    assert (run.y - asperity.height(run.x)).min() > -1e-12
    assert (run.multiplier >= 0.0).all()
    assert run.lost == pytest.approx(sum(arc.loss for arc in run.arcs))
    assert (run.time == np.linspace(0.0, 25.0, 101)).all()
    changes = [arc.time for arc in run.arcs[1:6]]  # asked for at the events themselves
    if changes:
        again = asperity_motion(asperity, 0.3, speed, [0.0, *changes])
        assert again.time == pytest.approx([0.0, *changes], abs=0.0)
    flights = [arc for arc in run.arcs if arc.kind == "fly"]
    assert (len(flights) == 0) == (abs(speed) < 1.0)


def test_a_motion_agrees_with_brute_force():
    """Small steps of free flight; what enters the support is put back, its normal speed taken."""
    asperity = Asperity(0.4, 1.0, 1.0, 1.0)
    exact = asperity_motion(asperity, 0.0, 2.6, [0.0, 4.5])
    assert len(exact.arcs) >= 3

    def error(steps: int) -> float:
        dt = 4.5 / steps
        x, y, vx, vy = 0.0, -0.4, 2.6, 0.0
        for _ in range(steps):
            vy -= dt
            x, y = x + dt * vx, y + dt * vy
            ground = -0.4 * math.cos(x)
            if y <= ground:
                y, incline = ground, 0.4 * math.sin(x)
                entering = min(vy - incline * vx, 0.0) / (1.0 + incline**2)
                vx, vy = vx + incline * entering, vy - entering
        return math.hypot(x - exact.x[-1], y - exact.y[-1])

    errors = [error(steps) for steps in (10_000, 40_000, 160_000)]
    assert errors[2] < 1e-3
    assert errors[0] / errors[2] > 8.0  # first order


# Speed held


def first_landing(w: float) -> float:
    """Where the parabola from θ₀ meets the support again: by scanning, then Brent."""
    start = math.pi - math.acos(1.0 / w)

    def gap(theta: float) -> float:
        t = theta - start
        return -math.cos(start) + math.sin(start) * t - t * t / (2.0 * w) + math.cos(theta)

    grid = np.linspace(start + 0.02, start + 2.5 * w * math.pi + 1.0, 200_000)
    values = np.array([gap(theta) for theta in grid])
    later = np.flatnonzero(values < 0.0)[0]
    return brentq(gap, grid[later - 1], grid[later], xtol=1e-14)


@pytest.mark.parametrize("ratio", [1.2, 1.5, 1.7, 2.5, 3.0])
def test_a_landing_at_held_speed(ratio):
    w = ratio**2
    theta, start = first_landing(w), math.pi - math.acos(1.0 / w)
    run = held_round(w)
    assert abs(run.landing) <= start  # and slides from there
    assert run.flights == 1
    assert math.remainder(theta - run.landing, 2 * math.pi) == pytest.approx(0.0, abs=1e-11)
    jump = math.sin(theta) - (math.sin(start) - (theta - start) / w)
    periods = math.ceil((theta - start) / (2 * math.pi))
    assert run.mean == pytest.approx(w * jump**2 / (4 * math.pi * periods), rel=1e-10)


@pytest.mark.parametrize("ratio", [1.2, 1.5, 1.7, 2.1, 2.5, 4.0])
def test_the_mean_is_that_of_the_reaction_and_the_mean_load_is_carried(ratio):
    """Another way to the mean: ∫λ κ sin θ in contact plus the blows, not the energy."""
    w = ratio**2
    run, start = held_round(w), math.pi - math.acos(1.0 / ratio**2)
    phase, pushes, carried, flown = start, 0.0, 0.0, 0.0
    for _ in range(run.flights):
        theta = first_landing(w) if phase == start else _landing_from(phase, w)
        jump = math.sin(theta) - (math.sin(phase) - (theta - phase) / w)
        pushes, carried = pushes + w * jump * math.sin(theta), carried + w * jump
        flown += theta - phase
        phase = math.remainder(theta, 2 * math.pi)
    pushes += quad(lambda t: (1 + w * math.cos(t)) * math.sin(t), phase, start)[0]
    carried += quad(lambda t: 1 + w * math.cos(t), phase, start)[0]
    length = 2 * math.pi * run.periods
    assert flown + start - phase == pytest.approx(length, abs=1e-9)
    assert pushes / length == pytest.approx(run.mean, abs=1e-9)
    assert carried / length == pytest.approx(1.0, abs=1e-9)  # vertical momentum: λ's mean is −Y


def _landing_from(start: float, w: float) -> float:
    def gap(theta: float) -> float:
        t = theta - start
        return -math.cos(start) + math.sin(start) * t - t * t / (2.0 * w) + math.cos(theta)

    grid = np.linspace(start + 0.05, start + 3.0 * w * math.pi, 200_000)
    later = np.flatnonzero(np.array([gap(theta) for theta in grid]) < 0.0)[0]
    return brentq(gap, grid[later - 1], grid[later], xtol=1e-14)


def test_flights_too_low_to_be_seen_lose_nothing():
    means = [held_round(1.0 + low).mean for low in (1e-3, 1e-4, 1e-6, 1e-9, 1e-10, 1e-12, 1e-15)]
    assert 900.0 < means[0] / means[1] < 1100.0  # like (w − 1)³
    assert max(means[2:]) < 1e-17


def test_hops_once_a_period_have_the_mean_that_they_must():
    for ratio in (1.85, 1.88, 1.9):
        run = held_round(ratio**2)
        assert math.isnan(run.landing)  # never slides
        assert run.flights == run.periods
        assert run.mean == pytest.approx(math.pi / ratio**2, rel=1e-9)
    assert held_round(1.95**2).flights == 2  # the period has doubled


def test_the_mean_force_is_never_above_coulombs():
    curve = asperity_curve(UNIT, np.linspace(0.0, 8.0, 400))
    assert (curve.mean <= curve.crude * (1.0 + 1e-12)).all()
    assert curve.mean.max() > 0.999
    assert (curve.mean[curve.held_speed <= 1.0] == 0.0).all()


def test_the_greatest_force_grows_from_coulombs_then_falls_after_the_landing_has_passed_it():
    asperity = Asperity(0.1, 1.0, 2.0, 0.5)
    speed = np.linspace(0.0, 1.8, 181) * asperity.lift_speed
    curve = asperity_curve(asperity, speed)
    assert curve.greatest[0] == pytest.approx(asperity.load * asperity.slope, rel=1e-14)
    peak = int(curve.greatest.argmax())
    assert (np.diff(curve.greatest[: peak + 1]) >= 0.0).all()
    assert (np.diff(curve.greatest[peak:]) < 0.0).all()
    w = (speed / asperity.lift_speed) ** 2
    place = np.arccos((np.sqrt(1 + 8 * w[1:] ** 2) - 1) / (4 * w[1:]))
    passed = speed[1:][curve.landing_phase[1:] > place][0]
    assert 0.97 < passed / speed[peak] < 1.0  # the paper: there; the force at θ₁ still grows a bit


@pytest.mark.parametrize("w", [0.0, 0.3, 1.0, 2.0, 3.0])
@pytest.mark.parametrize("slope", [0.0, 0.3, 2.0])
def test_the_greatest_force_is_the_greatest(w, slope):
    for first in (-math.pi, 0.2, 1.2):
        last = math.pi if w <= 1.0 else math.pi - math.acos(1.0 / w)
        theta = np.linspace(first, last, 200_001)
        force = (1 + w * np.cos(theta)) * np.sin(theta) / (1 + (slope * np.sin(theta)) ** 2)
        assert greatest_force(w, first, slope) == pytest.approx(force.max(), abs=1e-8)
        assert greatest_force(w, first, slope) >= force.max() - 1e-14


def test_a_free_point_on_flat_asperities_is_slowed_by_the_mean_force():
    """Energy per length of a motion without drive, as a/b → 0, against the held speed."""
    gaps = []
    for slope in (0.02, 0.01):
        asperity = Asperity(slope, 1.0, 1.0, slope)  # V₀ = 1/slope, kinetic energy ≫ a |Y|
        speed = 1.4 * asperity.lift_speed
        start = math.pi - math.acos(1.0 / 1.96)
        run = asperity_motion(asperity, start, speed, [0.0, 6.0 * math.pi / speed])
        lifts = [arc for arc in run.arcs if arc.kind == "fly"]
        first = next(arc for arc in run.arcs if arc.loss > 0.0)
        length = lifts[1].x - lifts[0].x
        mean = first.loss / length / slope
        gaps.append(abs(mean - held_round(1.96).mean))
    assert gaps[1] < 0.35 * gaps[0]  # order 2 in the slope
    assert gaps[0] < 0.01


# The law of speed


def test_a_law_is_that_of_scipy():
    """Which passes its points, overshoots none and converges with order three."""
    from scipy.interpolate import PchipInterpolator

    rng = np.random.default_rng(4)
    for _ in range(20):
        speeds = np.concatenate([[0.0], np.cumsum(rng.uniform(0.01, 1.0, 9))])
        values, u = rng.uniform(0.0, 1.0, 10), np.linspace(0.0, speeds[-1], 901)
        law, of_scipy = SpeedLaw(speeds, values), PchipInterpolator(speeds, values)
        assert law(u) == pytest.approx(of_scipy(u), abs=1e-14)
        assert SpeedLaw(speeds, values, "linear")(u) == pytest.approx(np.interp(u, speeds, values))


@pytest.mark.parametrize(
    ("speeds", "values", "kind", "message"),
    [
        ([0.0, 1.0], [0.1], "cubic", "one length"), ([-0.1, 1.0], [0.1, 0.1], "cubic", "from 0"),
        ([0.0, 1.0, 0.9], [0.1] * 3, "cubic", "ascend"), ([0.0, 1.0], [0.1, -0.1], "cubic", "neg"),
        ([0.0, np.nan], [0.1, 0.1], "cubic", "finite"), ([0.0, 1.0], [0.1, 0.1], "spline", "kind"),
    ],
)  # fmt: skip
def test_bad_laws_get_a_sentence(speeds, values, kind, message):
    with pytest.raises(InputError, match=message):
        SpeedLaw(speeds, values, kind)


def test_law_files(tmp_path):
    law = asperity_curve(UNIT, np.linspace(0.0, 1.7, 12)).law("mean")
    law.to_csv(tmp_path / "law.csv")
    again = SpeedLaw.from_csv(tmp_path / "law.csv")
    assert (again.values == law.values).all()
    with pytest.raises(OutputError):
        law.to_csv(tmp_path / "law.csv")
    for text, message in (
        ("0,0.1\n1,x\n", "line 2, column 2: 'x'"), ("", "empty"), ("0,1,2\n", "the columns v"),
        ("speed,f\n0,0.1\n1,-1\n", "negative"),
    ):  # fmt: skip
        (tmp_path / "bad.csv").write_text(text)
        with pytest.raises(InputError, match=message):
            SpeedLaw.from_csv(tmp_path / "bad.csv")
    (tmp_path / "bad.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="no rows of numbers"):
        SpeedLaw.from_csv(tmp_path / "bad.csv")


# Refusals and the command


def test_bad_input_gets_a_sentence():
    for change in ({"amplitude": 0.0}, {"load": -1.0}, {"mass": math.inf}, {"pull": math.nan}):
        with pytest.raises(InputError):
            Asperity(**{"amplitude": 1.0, "length": 1.0, "load": 1.0, "mass": 1.0, **change})
    for speeds in ([-1.0], [2.0, 1.0], [], [1e9], [math.nan]):
        with pytest.raises(InputError):
            asperity_curve(UNIT, speeds)
    with pytest.raises(InputError, match="pull must be 0"):
        asperity_curve(Asperity(1.0, 1.0, 1.0, 1.0, pull=0.1), [0.0])
    with pytest.raises(InputError, match="ascending"):
        asperity_motion(UNIT, 0.0, 1.0, [1.0, 0.0])
    with pytest.raises(InputError, match="which must be"):
        asperity_curve(UNIT, [0.0, 1.0]).law("other")


def puck(*words: str):
    return invoke("asperity", *words)


def test_the_command(tmp_path):
    done = puck("--speeds", "0:0.02:5", "--mass", "0.1", "--load", "2")
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    assert lines[0].startswith("held_speed[m/s],crude[N],greatest[N]")
    assert len(lines) == 6
    assert "V0 =" in done.stderr
    out = tmp_path / "curve.h5"
    assert (
        puck("-o", str(out), "--plot", str(tmp_path / "a.png"), "--speeds", "0:0.02:5").exit_code
        == 0
    )
    import xarray

    with xarray.open_dataset(out, engine="h5netcdf") as data:
        assert data["mean"].dims == ("held_speed",)
        assert data["mean"].attrs["units"] == "N"
        assert float(data.attrs["amplitude"]) == 1e-6
    assert (tmp_path / "a.png").stat().st_size > 20_000
    for words, code in (
        (["-o", str(out)], 1), (["--amplitude", "-1"], 2), (["--speeds", "0:1e9:3"], 2),
        (["--plot", str(tmp_path / "b.gif")], 2), (["--speeds", "1", "--plot", "c.png"], 2),
        (["-o", str(tmp_path / "x.txt")], 2), (["--speeds", "0:1:99999999"], 2),
    ):  # fmt: skip
        done = puck(*words)
        assert done.exit_code == code, done.output
        assert len(done.stderr.strip().splitlines()[-1:]) == 1
        assert "Traceback" not in done.output


@pytest.mark.parametrize("odd", [np.ones(3), [1.0], "a", None, np.nan, -1.0, 10**400])
@pytest.mark.parametrize("name", ["amplitude", "length", "load", "mass", "pull"])
def test_what_is_no_number_of_an_asperity_gets_a_sentence(name: str, odd: object):
    given: dict = {"amplitude": 1e-6, "length": 4e-6, "load": 1.0, "mass": 0.1, name: odd}
    if (name, odd is not np.nan and np.size(odd) == 1 and odd == -1.0) == ("pull", True):
        assert Asperity(**given).pull == -1.0
        return
    with pytest.raises(InputError, match=name):
        Asperity(**given)
