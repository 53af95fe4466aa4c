"""One-sided contact: opening, balance, resultants up to tipping, and where it is not unique."""

from __future__ import annotations

import math

import numpy as np
import pytest
import strips

from puck_tables.contact import closed_form, loaded_chord
from puck_tables.contact.closed_form import is_full_contact, moment_balance
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.loaded_chord import patch_rule, segment
from puck_tables.contact.one_sided import (
    FOLD_DELTA,
    balance,
    critical_delta,
    loaded_share,
    resultants,
)
from puck_tables.errors import ContactError, InputError

QUARTER, HALF = 0.25 * math.pi, 0.5 * math.pi


def full(phi, delta):
    return np.stack(moment_balance(closed_form.integrals(phi), slip_direction(phi), delta))


def scattered(count: int, upper: float) -> tuple[np.ndarray, np.ndarray]:
    """Random points of partial contact: anywhere, at φ → 0, around π/4, just above the opening."""
    rng = np.random.default_rng(36)
    phi = rng.uniform(0.0, 1.2, count)
    phi[::6] = 10.0 ** -rng.uniform(1, 300, phi[::6].size)
    phi[1::6] = QUARTER + rng.choice([-1, 1], phi[1::6].size) * 10.0 ** -rng.uniform(
        1, 17, phi[1::6].size
    )
    critical = critical_delta(phi)
    delta = critical + (upper - critical) * rng.random(count)
    near = critical[2::6]
    delta[2::6] = near + (upper - near) * 10.0 ** -rng.uniform(1, 15, near.size)
    kept = (delta > critical) & (delta <= upper)
    return phi[kept], delta[kept]


# --- the opening -----------------------------------------------------------------------------


def test_opening_curve():
    phi = np.random.default_rng(4).uniform(-HALF, HALF, 2000)
    critical = critical_delta(phi)
    opens = critical < 10.0  # beyond, the tilt hardly depends on δ
    assert 0.7 < opens.mean() < 0.9
    assert is_full_contact(phi[opens], critical[opens] * (1 - 1e-10)).all()
    assert not is_full_contact(phi[opens], critical[opens] * (1 + 1e-10)).any()
    assert is_full_contact(phi[np.isinf(critical)], 1e6).all()
    assert critical_delta(np.empty((0, 2))).shape == (0, 2)


def test_smoothness_across_the_opening():
    """Linear and one-sided law part like (δ − δ_c)^(5/2): twice differentiable, no more."""
    excess = 10.0 ** -np.linspace(1.5, 3.0, 7)
    for phi in (0.05, 0.6, QUARTER, 1.0, 1.15):
        delta = float(critical_delta(phi)) * (1.0 + excess)
        apart = np.abs(np.stack(resultants(phi, delta)) - full(phi, delta))
        order = np.diff(np.log(apart), axis=1) / np.diff(np.log(excess))
        assert np.abs(order[:, -1] - 2.5).max() < 0.02, (phi, order)


def test_the_only_other_singular_line_is_where_the_centre_crosses_the_rim():
    """φ = π/4, x² ln|x|, in partial contact too: the chord never cuts the centre off the load."""
    x, signs = 2.0 ** -np.arange(6, 11), np.array([1.0, -4.0, 6.0, -4.0, 1.0])

    def order(phi, delta):
        rho = np.stack(resultants(phi + x[:, None] * np.arange(-2, 3), delta))
        difference = np.abs(rho @ signs)
        return np.log2(difference[:, :-1] / difference[:, 1:]).mean(axis=1)

    for delta in (1.5, 2.0, 3.0):
        assert np.abs(order(QUARTER, delta) - 2.0).max() < 0.35
        assert order(0.5, delta).min() > 3.3 and order(0.84, delta).min() > 3.3
    phi, delta = scattered(1500, 3.9)
    phi, delta = phi[phi > QUARTER], delta[phi > QUARTER]
    chord = balance(phi, delta)[1]
    depth = np.sin(chord.bearing) / np.tan(phi) - chord.offset  # ξ at the centre
    assert phi.size > 200 and depth.min() > 0.03


# --- values ------------------------------------------------------------------------------------


def test_full_contact_is_left_alone():
    assert np.array_equal(np.array(resultants(1.3, 2.0)), full(1.3, 2.0))
    phi = np.random.default_rng(8).uniform(-HALF, HALF, 500)[:, None]
    np.testing.assert_array_equal(
        np.stack(resultants(phi, [0.0, 0.4, 1.0])), full(phi, np.array([0.0, 0.4, 1.0]))
    )


@pytest.mark.parametrize(
    ("phi", "delta"),
    [
        (0.3, 1.05), (0.5, 2.0), (0.7, 3.5), (0.25, 3.9), (QUARTER, 1.3), (QUARTER, 3.0),
        (QUARTER, 3.9), (0.7726, 3.9), (0.79, 3.8), (0.9, 2.0), (1.0, 3.9), (1.2, 3.9),
        (0.7, 3.99), (0.79, 3.99),
    ],
)  # fmt: skip
def test_against_strips(phi, delta):
    """The judge starts from its own guess: the chord rounded to two digits."""
    rho, chord = balance(np.array([phi]), np.array([delta]))
    start = round(float(chord.offset[0]), 2), round(float(chord.bearing[0]), 2)
    truth = strips.resultants(phi, delta, start)
    np.testing.assert_allclose(np.stack(rho)[:, 0], truth, rtol=0.0, atol=2e-12)


def test_the_same_balance_in_full_contact_is_the_linear_law():
    rng = np.random.default_rng(12)
    phi = np.concatenate([rng.uniform(0.0, 1.5, 300), 10.0 ** -rng.uniform(1, 300, 60)])
    delta = rng.uniform(0.01, 1.0, phi.size)
    rho, chord = balance(phi, delta)
    np.testing.assert_allclose(np.stack(rho), full(phi, delta), rtol=0.0, atol=2e-14)
    assert chord.offset.max() <= -1.0 + 1e-14
    phi = phi[phi < 1.2]
    critical = critical_delta(phi)
    rho, chord = balance(phi, critical)
    np.testing.assert_allclose(np.stack(rho), full(phi, critical), rtol=0.0, atol=2e-14)
    np.testing.assert_allclose(chord.offset, -1.0, rtol=0.0, atol=1e-13)


def test_quadrature_has_converged_and_does_so_exponentially(monkeypatch):
    phi, delta = scattered(600, 3.9)
    default = np.stack(balance(phi, delta)[0])

    def with_nodes(count: int, reach: float) -> np.ndarray:
        nodes, weights = loaded_chord._tanh_sinh(count, reach)
        monkeypatch.setattr(loaded_chord, "LINE_RULE", np.stack([nodes, weights]))
        return np.stack(balance(phi, delta)[0])

    truth = with_nodes(181, 3.6)
    assert np.abs(default - truth).max() <= 1e-13
    errors = [np.abs(with_nodes(n, 3.2) - truth).max() for n in (15, 25, 35, 45)]
    digits = -np.diff(np.log10(errors))
    assert digits.min() > 1.0 and errors[-1] < 1e-8, errors  # each ten nodes a digit and more


def test_scalars_shapes_signs_and_empty():
    phi, delta = np.array([[0.1], [-0.8], [1.4]]), np.array([0.5, 1.5, 3.0, 3.9])
    grid = np.stack(resultants(phi, delta))
    assert grid.shape == (3, 3, 4) and loaded_share(phi, delta).shape == (3, 4)
    np.testing.assert_array_equal(grid, np.stack(resultants(-phi, delta)))
    one = resultants(-0.8, 3.0)
    assert one.spin.shape == () and abs(float(one.spin) - grid[2, 1, 2]) < 1e-14
    assert resultants([], 2.0).spin.shape == (0,)


def test_pure_sliding_is_elementary_at_every_height():
    """φ = 0: ρ_∥ = 1, ρ_⊥ = δ/4 = ⟨x⟩, ρ_ω = 2⟨x²⟩ − δ²/8; tiny φ lose nothing."""
    delta = np.linspace(1.02, 3.98, 25)
    rho, chord = balance(np.zeros(25), delta)
    np.testing.assert_allclose(rho.parallel, 1.0, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(rho.perpendicular, delta / 4, rtol=0.0, atol=1e-12)
    for d, height, spin in zip(chord.offset, delta, rho.spin, strict=True):
        load, lever = strips.load_and_lever(d)
        t, w = np.polynomial.legendre.leggauss(40)
        t = 0.5 * math.acos(d) * (1 + t)
        x = np.cos(t)
        square = math.acos(d) * (w * (x - d) * x * x * np.sin(t) ** 2).sum() / load
        assert abs(lever - height / 4) < 2e-13
        assert abs(spin - 2 * square + height**2 / 8) < 1e-12
    for phi in (1e-9, 1e-100, 5e-324):
        near = np.stack(resultants(phi, delta))
        np.testing.assert_allclose(near, np.stack(rho), rtol=0.0, atol=2e-12)


# --- identities -----------------------------------------------------------------------------------


def test_load_stands_where_friction_tips_it_and_energy_closes():
    phi, delta = np.array([0.3, 0.7, 0.8, 1.1]), np.array([1.2, 3.5, 2.5, 3.8])
    rho, chord = balance(phi, delta)
    cosine, sine = np.cos(phi), np.sin(phi)
    lever = [strips.load_and_lever(d)[1] for d in chord.offset]
    along, across = 0.25 * delta * cosine * (rho.parallel, sine * rho.perpendicular)
    np.testing.assert_allclose(lever * np.cos(chord.bearing), along, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(lever * np.sin(chord.bearing), across, rtol=0.0, atol=1e-13)
    # power lost = ∫ σ |u|, |u| = sin φ times the distance from the instantaneous centre
    power = [
        math.sin(f) * strips.friction(f, d, g)[2]
        for f, d, g in zip(phi, *chord, strict=True)
    ]  # fmt: skip
    by_force = cosine**2 * rho.parallel + 0.5 * sine**2 * rho.spin
    np.testing.assert_allclose(by_force, power, rtol=0.0, atol=1e-12)


def test_segment_and_patch_rule():
    for d in (-3.0, -1.0, -0.999, -0.2, 0.5, 0.98):
        got = segment(np.array([d]))
        load, lever = strips.load_and_lever(d)
        np.testing.assert_allclose((got.load[0], got.lever[0]), (load, lever), rtol=2e-14, atol=0)
    # centre of rotation outside: all weights positive, so the rule also sums areas
    d, gamma = np.array([-2.0, -0.7, 0.1, 0.9]), np.array([0.3, 1.0, -2.0, 0.6])
    for ratio in (0.0, 0.6, 0.999):
        rule = patch_rule(np.full(4, ratio), np.zeros(4, dtype=bool), d, gamma)
        assert rule.weight.min() >= 0.0 and rule.depth[rule.weight > 0.0].min() >= -1e-15
        np.testing.assert_allclose(rule.weight.sum(-1), segment(d).area, rtol=0, atol=1e-12)
        load = (rule.weight * rule.depth).sum(-1)
        np.testing.assert_allclose(load, segment(d).load, rtol=0, atol=1e-12)
    # inside: the sign of the weights is that of the slip, so they sum torque and force, not area
    rule = patch_rule(np.zeros(1), np.ones(1, dtype=bool), np.array([-2.0]), np.zeros(1))
    assert abs((rule.weight * rule.along).sum() - 2 * math.pi / 3) < 1e-13


# --- over the whole range -----------------------------------------------------------------------


def test_friction_opposes_the_motion_and_the_limit_angle_is_unique():
    phi = np.unique(
        np.concatenate([np.linspace(0.0, HALF, 70), QUARTER + np.linspace(-0.02, 0.02, 21)])
    )
    limits = []
    for delta in [*np.linspace(0.05, 3.95, 27), FOLD_DELTA]:
        rho = resultants(phi, delta)
        assert min(rho.parallel.min(), rho.perpendicular.min(), rho.spin.min()) > 0.0
        sign = np.sign(rho.parallel - rho.spin)
        assert sign[0] > 0.0 and sign[-1] < 0.0 and (np.diff(sign) != 0).sum() == 1, delta
        limits.append(phi[np.flatnonzero(np.diff(sign))[0]])
    assert min(limits) > QUARTER and max(limits) < 1.0


def test_balance_has_one_solution_up_to_the_fold():
    """At given φ and d the bearing is unique, and the δ it belongs to grows with d."""
    phi = np.array([0.02, 0.3, 0.6, 0.74, 0.77, 0.7804, 0.7824, 0.79, 0.83, 0.95, 1.15])
    direction = slip_direction(phi)
    offset = np.concatenate([np.linspace(-0.95, 0.7, 6), 1.0 - np.geomspace(0.2, 0.022, 7)])
    gamma = np.linspace(-math.pi, math.pi, 41)

    def turning(which, d, g):
        """F × n and F·n at arrays of points."""
        rule = patch_rule(direction.ratio[which], direction.fast_spin[which], d, g)
        pressure = rule.weight * rule.depth
        x, y = (pressure * rule.cos_a).sum(-1), (pressure * rule.sin_a).sum(-1)
        load = segment(d)
        forward = (x * np.cos(g) + y * np.sin(g)) / load.load
        return (y * np.cos(g) - x * np.sin(g)) / load.load, 4.0 * load.lever / forward

    which, d, g = (a.ravel() for a in np.meshgrid(range(phi.size), offset, gamma, indexing="ij"))
    cross, height = (
        np.concatenate(parts).reshape(phi.size, offset.size, gamma.size)
        for parts in zip(
            *(
                turning(which[k : k + 100], d[k : k + 100], g[k : k + 100])
                for k in range(0, g.size, 100)
            ),
            strict=True,
        )
    )
    stable = (cross[..., :-1] > 0) & (cross[..., 1:] <= 0) & (height[..., :-1] > 0)
    possible = (height > 0.0) & (height < 4.3)
    others = (cross[..., :-1] < 0) & (cross[..., 1:] >= 0) & possible[..., :-1]
    found = stable.sum(-1) == 1
    assert (stable.sum(-1) <= 1).all() and not others.any()
    assert found[phi < QUARTER].all()  # where it spins faster, d stays bounded at every δ
    low = gamma[stable.argmax(-1)].ravel()
    high = low + gamma[1] - gamma[0]
    which, d = (a.ravel() for a in np.meshgrid(range(phi.size), offset, indexing="ij"))
    for _ in range(30):
        middle = 0.5 * (low + high)
        above = turning(which, d, middle)[0] > 0
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    height = turning(which, d, low)[1].reshape(phi.size, -1)
    grows = np.diff(height, axis=1) > 0
    below = found[:, 1:] & (height[:, 1:] < FOLD_DELTA)
    assert grows[below].all() and below.sum() >= 80
    assert not grows[phi == 0.7824][found[:, 1:][phi == 0.7824]].all()  # the fold is there


def test_balance_has_three_solutions_beyond_the_fold():
    """By strips alone; so the resultants are no function of φ and δ there, and are refused."""
    phi, delta = QUARTER - 0.003, 3.99
    found = [strips.balance(phi, delta, s) for s in ((0.99, 1.4), (0.974, 1.376), (0.922, 1.27))]
    assert found[0][0] > found[1][0] + 0.01 and found[1][0] > found[2][0] + 0.01
    with pytest.raises(ContactError, match="more than one solution"):
        resultants(phi, delta)
    # below the fold the same three starts lead to one
    found = [strips.balance(phi, 3.95, s) for s in ((0.95, 1.3), (0.90, 1.25), (0.86, 1.2))]
    assert np.ptp(np.array(found), axis=0).max() < 1e-9


def test_loaded_share():
    delta = np.linspace(0.5, 3.999, 40)
    share = loaded_share(0.5, delta)
    assert (share[delta < 1.0] == 1.0).all() and (np.diff(share) <= 0.0).all()
    assert share[-1] < 1e-3
    chord = balance(np.array([0.5]), np.array([2.0]))[1]
    x, y = np.random.default_rng(2).uniform(-1, 1, (2, 2_000_000))
    inside = np.hypot(x, y) < 1
    loaded = x * math.cos(chord.bearing[0]) + y * math.sin(chord.bearing[0]) > chord.offset[0]
    assert abs((loaded & inside).sum() / inside.sum() - loaded_share(0.5, 2.0)) < 2e-3


def test_towards_tipping_the_load_gathers_in_a_point_of_the_rim():
    """δ → 4, φ < π/4: at (√(1 − tan²φ), tan φ), so ρ → (√cos 2φ, 1, 0)/cos²φ; ρ_ω like (4 − δ)²."""
    phi, gap = np.array([[0.2], [0.5], [0.7]]), np.array([0.01, 0.005, 0.0025])
    rho = np.stack(resultants(phi, 4.0 - gap))
    limit = np.stack([np.sqrt(np.cos(2 * phi)), np.ones_like(phi), 0 * phi]) / np.cos(phi) ** 2
    order = np.diff(np.log(np.abs(rho - limit)), axis=2) / np.diff(np.log(gap))
    np.testing.assert_allclose(order[:2], 1.0, atol=0.03)
    np.testing.assert_allclose(order[2], 2.0, atol=0.03)
    # a puck that spins faster than it slides does not tip, not even at δ = 4
    spinning = loaded_share([0.8, 1.0], 3.9999)
    assert spinning.min() > 0.09


# --- refusals ------------------------------------------------------------------------------------


@pytest.mark.parametrize("function", [resultants, loaded_share])
@pytest.mark.parametrize("delta", [4.0, 5.0, 1e60])
def test_tipping_is_a_sentence(function, delta):
    with pytest.raises(ContactError, match=r"delta = .* tips over its leading edge"):
        function(0.3, [1.0, delta])


@pytest.mark.parametrize("function", [resultants, loaded_share])
@pytest.mark.parametrize(
    ("phi", "delta"),
    [
        (math.nan, 2.0),
        (1.6, 2.0),
        (0.5, math.nan),
        (0.5, -1.0),
        ("x", 2.0),
        (0.5, "y"),
        ([0.1, 0.2], [1.0, 2.0, 3.0]),
    ],
)
def test_refused(function, phi, delta):
    with pytest.raises(InputError) as caught:
        function(phi, delta)
    assert not isinstance(caught.value, ContactError)
