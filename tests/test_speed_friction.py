"""Friction coefficients that depend on the slip speed: quadrature, exact cases, table."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest
from commands import invoke
from rarely import few, nightly, thorough
from scipy.integrate import quad
from test_speed_pressure import brute

from puck_tables import SpeedLaw, Table, resultants
from puck_tables.contact import speed_resultants
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.laws import law_of
from puck_tables.contact.round_load import RoundLoad
from puck_tables.contact.speed_quadrature import speed_integrals
from puck_tables.errors import AccuracyError, ContactError, InputError, OutputError
from puck_tables.kernels.speed_quadrature_kernel import FINE, fill_integrals
from puck_tables.kernels.speed_spline import speed_ratios
from puck_tables.table import speed_build
from puck_tables.table.speed_grid import patches_of
from puck_tables.table.speed_patch import FilledPatch
from puck_tables.table.speed_table import SpeedTable

EVERY_PHI = np.array([
    0.0, 1e-14, 1e-8, 1e-4, 0.01, 0.3, 0.7, np.pi / 4 - 1e-8, np.pi / 4, np.pi / 4 + 1e-8, 0.8,
    1.2, 1.5, np.pi / 2 - 1e-9, np.pi / 2,
])  # fmt: skip
CUBIC = SpeedLaw([0.0, 0.3, 0.7, 1.0, 3.0], [0.3, 0.2, 0.25, 0.25, 0.1])
DISC = RoundLoad(law_of("uniform"))
LINEAR = SpeedLaw([0.0, 0.3, 0.7, 1.0, 3.0], [0.3, 0.2, 0.25, 0.25, 0.1], "linear")


def stribeck(u):
    return 0.2 + 0.15 * np.exp(-u / 0.2) + 0.01 * u


@pytest.mark.parametrize(
    ("phi", "speed", "law"),
    [
        (0.4, 0.6, stribeck), (1.1, 0.6, stribeck), thorough(0.6, 0.9, LINEAR),
        nightly(1.2, 1.1, CUBIC),
    ],
    ids=["outside", "inside", "corners", "knots"],
)  # fmt: skip
def test_integrals_by_brute_force(phi, speed, law):
    a, b, c, d, e = brute(law, "uniform", phi, speed)
    p = speed_integrals(phi, speed, law)
    cosine, sine = np.cos(phi), np.sin(phi)
    found = [p.a * cosine, p.b * sine, p.c * sine, p.d * sine, p.e * cosine]
    assert np.array(found, float) == pytest.approx([a, b, c, d, e], abs=1e-7)


@pytest.mark.parametrize("speed", [0.0, 1e-9, 1.0, 2e3])
def test_a_constant_coefficient_gives_the_closed_forms(speed):
    f, g = 0.3, 2.5
    found = speed_resultants(EVERY_PHI, speed, lambda u: f + 0.0 * u, g)
    exact = resultants(EVERY_PHI, f * g)
    assert np.stack(found) == pytest.approx(f * np.stack(exact), abs=1e-14)


def test_viscous_friction_is_exact():
    """f = c|u|: the force is c N u at each point; F = c N v, M = c N r² ω/2 for a level load."""
    c, Q = 0.2, 1.5
    p = speed_integrals(EVERY_PHI, Q, lambda u: c * u)
    for found, exact in zip(p, (1.0, 0.25, -0.25, 0.5, -0.25), strict=True):
        assert found == pytest.approx(np.full(EVERY_PHI.size, c * Q * exact), abs=1e-12)
    g = 1.7  # and with the load tilted
    rho = speed_resultants(EVERY_PHI, Q, lambda u: c * u, g)
    k = 0.25 * g * c * Q * np.sin(EVERY_PHI)
    parallel = c * Q / (1.0 + k**2)
    assert rho.parallel == pytest.approx(parallel, abs=1e-12)
    assert rho.perpendicular == pytest.approx(0.25 * g * c * Q * parallel, abs=1e-12)


def test_the_load_balances_the_moments_with_f_inside():
    phi, speed, g = 1.1, 0.6, 2.0
    cosine, sine = np.cos(phi), np.sin(phi)
    a, b, c, d, e = brute(stribeck, "uniform", phi, speed)
    rho = speed_resultants(phi, speed, stribeck, g)
    along, across = rho.parallel * cosine, rho.perpendicular * sine * cosine
    tilt, roll = g * along, g * across  # ∫σx = N tilt/4 = (h/2) F∥
    assert along == pytest.approx(a + roll * c, abs=2e-8)
    assert across == pytest.approx(tilt * b, abs=2e-8)
    assert 0.5 * sine * rho.spin == pytest.approx(d + roll * e, abs=2e-8)


def test_a_puck_that_only_slides_has_the_coefficient_of_its_speed():
    speeds = np.array([0.0, 0.1, 0.3, 0.5, 1.0, 2.9])
    for law in (CUBIC, LINEAR):
        rho = speed_resultants(0.0, speeds, law, 1.0)
        assert rho.parallel == pytest.approx(law(speeds), abs=1e-14)
    # a slow spin: f⟨x²⟩ across the velocity and u f′⟨y²⟩ along it
    rho = speed_resultants(0.0, speeds, lambda u: 0.2 + 0.3 * u**2, 0.0)
    exact = 0.5 * (0.2 + 0.3 * speeds**2 + speeds * 0.6 * speeds)
    assert rho.spin == pytest.approx(exact, abs=1e-9)


def test_a_puck_that_only_spins():
    f = speed_resultants(np.pi / 2, 2.0, CUBIC).spin
    exact = 4.0 * quad(lambda R: float(CUBIC(2.0 * R)) * R**2, 0.0, 1.0, epsabs=1e-13,
                       points=[0.15, 0.35, 0.5])[0]  # fmt: skip
    assert float(f) == pytest.approx(exact, abs=1e-12)


def test_too_high_or_too_fast_is_refused():
    with pytest.raises(ContactError, match="too high"):
        speed_resultants(0.0, 0.0, CUBIC, 3.4)
    speed_resultants(0.0, 0.0, CUBIC, 3.3)
    with pytest.raises(InputError, match="outside this friction law"):
        speed_resultants(np.pi / 4, 2.5, CUBIC)  # the rim is faster than the centre
    speed_resultants(0.0, 2.5, CUBIC)
    for phi, speed in ((2.0, 1.0), (0.0, -1.0), (0.0, np.nan)):
        with pytest.raises(InputError):
            speed_resultants(phi, speed, CUBIC)
    with pytest.raises(InputError, match="finite f"):
        speed_resultants(0.1, 1.0, lambda u: np.nan * u)
    with pytest.raises(InputError, match="height_ratio"):
        speed_resultants(0.1, 1.0, CUBIC, -1.0)


# The table


def gap(table, phi, speed, law):
    """Largest error of the four integrals as they enter the forces, over the largest f."""
    got, truth = table.integrals(phi, speed), speed_integrals(phi, speed, law)
    sine, cosine = np.abs(np.sin(phi)), np.cos(phi)
    return max(
        float(np.max(weight * np.abs(getattr(got, name) - getattr(truth, name))))
        for name, weight in zip("abde", (cosine, sine, sine, cosine), strict=True)
    ) / float(np.max(law(np.linspace(0.0, table.top, 2001))))  # fmt: skip


def slips(table, seed, count=2000):
    """φ and Q anywhere, next to 0, π/4, π/2, and where a rim slips at a corner of the law."""
    rng = np.random.default_rng(seed)
    near = rng.choice([0.0, np.pi / 4, np.pi / 2], count)
    near = np.clip(near + rng.normal(size=count) * 10.0 ** -rng.uniform(1, 12, count), 0, np.pi / 2)
    U = table.top * rng.random(2 * count) ** rng.choice([1.0, 3.0], 2 * count)
    corner = rng.choice(table.breaks[1:], count) * (1.0 - 10.0 ** -rng.uniform(0, 9, count))
    other = rng.choice(table.breaks[1:], count) * rng.random(count) ** 0.3
    fast, slow = np.maximum(corner, other), np.minimum(corner, other)
    about = np.pi / 4 + rng.choice([-1.0, 1.0], count) * np.arctan(slow / fast)
    phi = np.concatenate([rng.uniform(0.0, np.pi / 2, count), near, about])
    return phi, np.concatenate([U, fast]) / (np.cos(phi) + np.sin(phi)) * (1.0 - 1e-15)


@pytest.fixture(scope="module")
def fine():
    return Table.build(CUBIC, accuracy=1e-9)


@pytest.fixture(scope="module")
def smooth():
    return Table.build(stribeck, top_speed=2.0, scale=0.2, accuracy=1e-5)


@pytest.mark.parametrize("law", [CUBIC, LINEAR], ids=["cubic", "linear"])
def test_the_compiled_integrals_are_those_of_numpy(law):
    rng = np.random.default_rng(3)
    phi = np.concatenate([EVERY_PHI, rng.uniform(0.0, np.pi / 2, 300)])
    Q = 3.0 * rng.random(phi.size) ** 2 / (np.cos(phi) + np.sin(phi))
    direction = slip_direction(phi)
    out = np.empty((phi.size, 4))
    fill_integrals(*law.pieces(law.top_speed), direction.ratio, direction.fast_spin, Q, FINE, out)
    p, sine, cosine = speed_integrals(phi, Q, law), np.sin(phi), np.cos(phi)
    for found, truth, weight in zip(
        out.T, (p.a, p.b, p.d, p.e), (cosine, sine, sine, cosine), strict=True
    ):
        assert weight * found == pytest.approx(weight * truth, abs=1e-14)


@pytest.mark.thorough
def test_the_grid_is_cut_at_the_corners_so_that_order_four_holds():
    """On the patches of a law with corners, all halved alike."""
    errors = []
    for cells in (10, 20, 40):
        patches = enumerate(patches_of(CUBIC.speeds))
        parts = [FilledPatch(patch, CUBIC, DISC, 0.3, n, FINE) for n, patch in patches]
        for part in parts:
            part.cells = [cells, cells]
            part.fill()
        values = np.concatenate([part.values.reshape(-1, 4) for part in parts])
        sizes = np.array([part.cells for part in parts])
        breaks = np.asarray(CUBIC.speeds)
        table = SpeedTable(values, breaks=breaks, cells=sizes, law=CUBIC)
        errors.append(gap(table, *slips(table, 8), CUBIC))
    assert (np.log2(np.array(errors[:-1]) / errors[1:]) > 3.9).all()
    assert errors[-1] < 3e-7


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("law", "accuracy"),
    few(3, [
        (CUBIC, 1e-3), (CUBIC, 1e-9), (SpeedLaw([0.0, 1e-5, 2.0], [0.4, 0.2, 0.2]), 1e-6),
        (LINEAR, 1e-5), (SpeedLaw([0.0, 2.0], [0.2, 0.5]), 1e-12),
        (SpeedLaw([0.0, 0.5, 0.51, 2.0], [0.3, 0.3, 0.1, 0.1]), 1e-7),
        (SpeedLaw([0.0, 1.0, 2.0, 3.0], [0.0, 0.3, 0.0, 0.3]), 1e-7),
    ]),
    ids=["coarse", "fine", "steep start", "corners", "two", "step", "down to nothing"],
)  # fmt: skip
def test_the_table_keeps_the_accuracy_that_was_asked_for(law, accuracy):
    table = Table.build(law, accuracy=accuracy)
    assert table.accuracy.worst <= accuracy
    assert gap(table, *slips(table, 7), law) <= accuracy


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(12))
def test_so_do_tables_of_measured_laws(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 25))
    speeds = np.concatenate([[0.0], np.cumsum(rng.exponential(size=count) ** 2)])
    law = SpeedLaw(speeds, 0.2 * (1.0 + 0.1 * rng.normal(size=count + 1)).clip(0.0))
    accuracy = 1e-8
    try:
        table = Table.build(law, accuracy)
    except AccuracyError as refused:  # points that lie close: what it says can be reached, can
        accuracy = refused.reachable
        table = Table.build(law, accuracy)
    assert gap(table, *slips(table, seed), law) <= accuracy


@pytest.mark.thorough
def test_a_law_given_as_a_function(smooth):
    assert smooth.accuracy.worst <= 1e-5
    assert gap(smooth, *slips(smooth, 6), stribeck) <= 1e-5


def test_a_table_of_a_constant_coefficient_is_the_closed_form_at_every_height():
    table = Table.build(SpeedLaw([0.0, 3.0], [0.4, 0.4]), accuracy=1e-10)
    phi = np.linspace(-np.pi / 2, np.pi / 2, 801)
    weight = np.stack([np.cos(phi), np.sin(phi) * np.cos(phi), np.sin(phi)])
    for g in (0.0, 1.0, 2.5):
        found = np.stack(table.resultants(phi, 2.0, g))
        error = weight * (found - 0.4 * np.stack(resultants(phi, 0.4 * g)))
        assert np.abs(error).max() < 1e-9


def test_too_fine_is_refused_with_what_can_be_reached_and_that_can(monkeypatch):
    monkeypatch.setattr(speed_build, "MAX_NODES", 100_000)
    law = SpeedLaw([0.0, 0.3, 0.301, 2.0], [0.3, 0.3, 0.1, 0.1], "linear")
    with pytest.raises(AccuracyError, match="can be reached") as refused:
        Table.build(law, accuracy=1e-11)
    assert refused.value.reachable > 1e-11
    table = Table.build(law, accuracy=refused.value.reachable)
    assert table.accuracy.worst <= refused.value.reachable


@pytest.mark.thorough
def test_progress_rises_and_does_not_wait_at_the_end():
    heard = []

    def hear(done, total):
        heard.append((time.monotonic(), done / total))

    begin = time.monotonic()
    Table.build(CUBIC, accuracy=1e-10, progress=hear)
    times, shares = zip(*heard, strict=True)
    assert list(shares) == sorted(shares)
    assert 0.0 <= shares[0] < 0.5 < shares[-1] <= 1.0
    at_the_end = [moment for moment, share in heard if share >= 0.99]
    assert not at_the_end or times[-1] - at_the_end[0] < 0.5 * (time.monotonic() - begin)


def test_the_kernel_is_the_table_and_says_where_it_ends(fine):
    for phi, Q in ((0.3, 1.0), (1.2, 0.7), (np.pi / 4, np.sqrt(2.0)), (0.0, 2.0), (np.pi / 2, 0.0)):
        sine, cosine = np.sin(phi), np.cos(phi)
        k, fast = min(sine, cosine) / max(sine, cosine), bool(sine > cosine)
        found = speed_ratios(fine.compiled, 1.0, k, fast, Q)
        rho = fine.resultants(phi, Q, 1.0)
        assert found == pytest.approx([float(x) for x in rho], abs=1e-13)
    for beyond in (2.2, 1e300, np.inf, np.nan):
        assert np.isnan(speed_ratios(fine.compiled, 0.0, 1.0, False, beyond)).all()
    with pytest.raises(InputError, match="outside this table"):
        fine.resultants(np.pi / 4, 2.2)
    with pytest.raises(ContactError, match="too high"):
        fine.resultants(0.0, 0.0, 3.4)
    with pytest.raises(ContactError, match="too high"):
        fine.refuse_height(3.4)
    fine.refuse_height(3.0)
    assert fine.resultants([[0.1], [0.2]], [0.5, 0.6, 0.7]).spin.shape == (2, 3)


def test_at_rest_it_is_the_coefficient_at_rest(fine):
    phi = np.linspace(0.0, np.pi / 2, 50)
    found = np.stack(fine.resultants(phi, 0.0, 1.0)) / 0.3
    assert found == pytest.approx(np.stack(resultants(phi, 0.3)), abs=1e-8)


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"top_speed": None}, InputError, "needs top_speed"),
        ({"top_speed": -1.0}, InputError, "top_speed must be"),
        ({"scale": 0.0}, InputError, "scale must be"),
        ({"accuracy": 1e-14}, AccuracyError, "must be from"),
        ({"of": CUBIC, "top_speed": 4.0}, InputError, "outside this friction law"),
    ],
)
def test_bad_input_gets_a_sentence(change, error, message):
    given = {"of": stribeck, "top_speed": 2.0} | change
    with pytest.raises(error, match=message):
        Table.build(**given)


# Files and commands


@pytest.mark.thorough
def test_a_table_file_holds_the_law_and_is_judged_by_it(tmp_path):
    law = SpeedLaw([0.0, 1.0, 2.0], [0.0, 0.2, 0.1])  # f(0) = 0: friction vanishes at rest
    saved = Table.build(law, 1e-3).save(tmp_path / "speed.h5")
    many = SpeedLaw(np.arange(20_001.0), np.full(20_001, 0.1))  # more than an attribute holds
    assert replace(saved, law=many).save(tmp_path / "many.h5").law == many
    assert (saved.law.coefficients == law.coefficients).all()
    assert saved.validate().passed
    assert not replace(saved, values=saved.values * 1.01).validate().passed


@pytest.mark.thorough
def test_what_a_file_cannot_hold_is_refused(fine, smooth, tmp_path):
    with pytest.raises(OutputError, match="is a function"):
        smooth.save(tmp_path / "speed.h5")
    with pytest.raises(InputError, match="give it as law="):
        smooth.validate()
    assert list(tmp_path.iterdir()) == []


def test_the_commands(tmp_path):
    law, path = tmp_path / "law.csv", tmp_path / "speed.h5"
    law.write_text("speed,f\n0,0.3\n0.5,0.2\n2,0.2\n")

    def puck(*words):
        return invoke(*words)

    words = ["build-tables", "--speed-law", str(law), "-o", str(path)]
    done = puck(*words, "--accuracy", "1e-3")
    assert done.exit_code == 0, done.output
    assert "nodes in" in done.stdout
    assert "--accuracy 0.001" in done.stdout
    assert puck("info", str(path)).stdout == done.stdout
    judged = puck("validate", str(path))
    assert judged.exit_code == 0
    assert "FAIL" not in judged.stdout
    for bad, message in (
        ([*words, "--overwrite", "--cells", "9"], "--cells does not go with"),
        ([*words, "--overwrite", "--pressure", "sponge"], "no pressure law is called"),
        ([*words, "--overwrite", "--kind", "stops"], "goes with --kind resultants"),
        (["build-tables", "--speed-law", "none.csv", "-o", str(tmp_path / "x.h5")], "cannot read"),
        (["sweep", "--table", str(path), "--w0", "0:1:3"], "stops come from"),
    ):
        done = puck(*bad)
        assert done.exit_code in (1, 2), done.output
        assert message in done.stderr
        assert "Traceback" not in done.output
