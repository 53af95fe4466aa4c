"""Constraints with friction: Chetaev's equations against Lagrange's, derived by hand for each."""

from __future__ import annotations

import numpy as np
import pytest
from rarely import few
from scipy.integrate import solve_ivp
from scipy.interpolate import make_interp_spline

from puck_tables import stop
from puck_tables.chetaev import ConstrainedSystem, constrained_motion, patch_stop, patch_system
from puck_tables.errors import AccuracyError, InputError

TIMES = np.linspace(0.0, 3.0, 31)
G = 9.81


def twin(slope, start, times=TIMES):
    """A Lagrangian twin, integrated by another method and a finer tolerance."""
    return solve_ivp(
        slope, (times[0], times[-1]), start, method="Radau" if len(start) < 3 else "RK45",
        t_eval=times, rtol=1e-11, atol=1e-12,
    ).y  # fmt: skip


def since_start(power):
    """Its integral from the first of TIMES."""
    return make_interp_spline(TIMES, power, k=7).antiderivative()(TIMES)


def sound(run, scale: float = 1.0) -> None:
    """What must hold of every motion."""
    assert run.residual < 1e-12 * scale
    assert run.drift < 1e-7 * scale
    assert run.energy_residual < 1e-7 * scale


# A bead on a straight rail that is moved obliquely: x = q u + s(t) d, s = sin t.
U, ACROSS = np.array([np.cos(0.4), np.sin(0.4)]), np.array([-np.sin(0.4), np.cos(0.4)])
D, M, MU = np.array([0.3, 1.1]), 1.7, -0.6


def moved_rail(s_rate):
    return lambda x, t: ([[ACROSS]], [-s_rate(t) * (ACROSS @ D)])


@pytest.mark.parametrize(
    ("s", "s_rate", "s_second"),
    [
        (lambda t: 0.7 * t, lambda t: 0.7 + 0.0 * t, lambda t: 0.0 * t),
        (np.sin, np.cos, lambda t: -np.sin(t)),
    ],
    ids=["steady", "shaken"],
)
def test_a_bead_on_a_moving_rail(s, s_rate, s_second):
    system = ConstrainedSystem([M], moved_rail(s_rate), [[0.0, -M * G]], [MU])
    q0, p0 = 0.2, 1.5
    start = [q0 * U + s(0.0) * D], [p0 * U + s_rate(0.0) * D]
    run = constrained_motion(system, *start, TIMES, tol=1e-11)
    sound(run, 30.0)

    def lagrange(t, z):  # T = m (q'^2 + 2 q' s' u.d + s'^2 d.d)/2, f = −μ (the same)/m
        return [z[1], -G * U[1] - U @ D * s_second(t) + MU / M * (z[1] + s_rate(t) * (U @ D))]

    q = twin(lagrange, [q0, p0])[0]
    place = q[:, None] * U + s(TIMES)[:, None] * D
    assert np.abs(run.position[:, 0] - place).max() < 1e-8
    # (4.1): f₂ = −μ q'²/2, f₁ = −μ q' s' u·d, T₂ − T₀ = m (q'² − s'² d·d)/2.  The paper leaves out
    # ∂T/∂t, which belongs on the left where the support does not move steadily.
    going, by = (run.velocity[:, 0] - s_rate(TIMES)[:, None] * D) @ U, s_rate(TIMES) * (U @ D)
    account = 0.5 * M * (going**2 - s_rate(TIMES) ** 2 * (D @ D))
    explicit = M * s_second(TIMES) * (going * (U @ D) + s_rate(TIMES) * (D @ D))
    power = -M * G * U[1] * going + MU * going**2 + MU * going * by
    change = since_start(power - explicit)
    assert np.abs(account - account[0] - change).max() < 1e-6
    as_printed = since_start(power)
    off = np.abs(account - account[0] - as_printed).max()
    assert (off < 1e-6) == (np.abs(explicit).max() == 0.0)


def test_a_bead_on_a_rotating_rail_keeps_the_account_with_all_three_parts():
    rate = 1.3

    def rail(x, t):
        return [[np.array([-np.sin(rate * t), np.cos(rate * t)])]], [
            -rate * (x[0, 0] * np.cos(rate * t) + x[0, 1] * np.sin(rate * t))
        ]

    system = ConstrainedSystem([M], rail, friction=[MU])
    run = constrained_motion(system, [[0.5, 0.0]], [[-0.4, 0.5 * rate]], TIMES, tol=1e-12)
    sound(run)
    roots = np.roots([1.0, -MU / M, -(rate**2)])  # q″ = Ω² q + μ q′/m
    c = np.linalg.solve([[1.0, 1.0], roots], [0.5, -0.4])
    powers = np.exp(np.outer(TIMES, roots))
    q, going = powers @ c, powers @ (c * roots)
    assert np.abs(np.hypot(*run.position[:, 0].T) - np.abs(q)).max() < 1e-9
    # T₂ − T₀ = m (q'² − Ω² q²)/2, 2 f₂ = −μ q'², f₁ = 0, f₀ = −μ Ω² q²/2
    account = 0.5 * M * (going**2 - rate**2 * q**2)
    exact = MU * ((c * roots)[:, None] * (c * roots) * _integrals(roots)).sum(axis=(1, 2))
    assert np.abs(account - account[0] - exact).max() < 1e-11
    side = 2.0 * M * rate * going - MU * rate * q  # λ: Coriolis' force and the friction across
    assert np.abs(run.multipliers[:, 0] - side).max() < 1e-8
    heat = exact + MU * rate**2 * (np.outer(c, c) * _integrals(roots)).sum(axis=(1, 2))
    assert np.abs(run.friction_work - heat).max() < 1e-9


def _integrals(roots):
    total = roots[:, None] + roots
    return (np.exp(TIMES[:, None, None] * total) - 1.0) / total


def test_a_pivoted_rod_with_friction():
    m, mu, arm = np.array([1.0, 0.6]), np.array([-0.3, -0.8]), np.array([0.5, 1.2])
    share = arm[1] / arm[0]

    def pivot(x, t):
        zero = np.zeros_like(x[0])
        e1, e2 = np.eye(2)
        return [[x[0], zero], [-share * e1, e1], [-share * e2, e2]], np.zeros(3)

    system = ConstrainedSystem(m, pivot, np.stack([0.0 * m, -m * G], axis=-1), mu)
    angle, spin = 2.0, -1.0
    down = np.array([np.sin(angle), -np.cos(angle)])
    across = np.array([np.cos(angle), np.sin(angle)])
    run = constrained_motion(
        system, arm[:, None] * down, spin * arm[:, None] * across, TIMES, tol=1e-12
    )
    sound(run, 30.0)
    inertia = m @ arm**2

    def lagrange(t, z):
        return [z[1], (-G * (m @ arm) * np.sin(z[0]) + (mu @ arm**2) * z[1]) / inertia]

    theta, _ = twin(lagrange, [angle, spin])
    exact = arm[:, None] * np.stack([np.sin(theta), -np.cos(theta)], axis=-1)[:, None, :]
    assert np.abs(run.position - exact).max() < 1e-7


def test_a_spherical_pendulum_in_space():
    def sphere(x, t):
        return [[x[0]]], [0.0 * t]

    system = ConstrainedSystem([M], sphere, [[0.0, 0.0, -M * G]], [MU])
    theta0, spin = 1.0, 1.7
    place = [[np.sin(theta0), 0.0, -np.cos(theta0)]]
    run = constrained_motion(system, place, [[0.0, np.sin(theta0) * spin, 0.0]], TIMES, tol=1e-12)
    sound(run, 20.0)

    def lagrange(t, z):  # θ from below, α about the vertical; f = −μ (θ'² + sin²θ α'²)/2
        theta, rate, _, turn = z
        sine, cosine = np.sin(theta), np.cos(theta)
        return [rate, sine * cosine * turn**2 - G * sine + MU / M * rate, turn,
                -2.0 * cosine / sine * rate * turn + MU / M * turn]  # fmt: skip

    theta, _, alpha, _ = twin(lagrange, [theta0, 0.0, 0.0, spin])
    exact = [np.sin(theta) * np.cos(alpha), np.sin(theta) * np.sin(alpha), -np.cos(theta)]
    assert np.abs(run.position[:, 0] - np.stack(exact, axis=-1)).max() < 1e-7
    assert run.c_displacements(5).shape == (1, 1, 3)  # along the sphere, across the velocity
    assert run.axiom_residual < 1e-12


def test_two_points_joined_by_a_rod():
    m, mu, half = np.array([1.0, 2.0]), np.array([-0.5, -0.2]), 0.4

    def rod(x, t):
        return [[x[0] - x[1], x[1] - x[0]]], [0.0]

    system = ConstrainedSystem(m, rod, friction=mu)
    along, across = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    start = np.array([half * along, -half * along])
    going = np.array([0.3, 1.0]) + 2.5 * half * np.array([across, -across])
    run = constrained_motion(system, start, going, TIMES, tol=1e-12)
    sound(run)
    assert run.c_displacements(3).shape[0] == 1
    assert run.axiom_residual < 1e-12

    def lagrange(t, z):  # q = (middle, θ): points at ± l (cos θ, sin θ)
        vx, vy, theta, w = z[2:]
        e, n = (np.array([np.cos(theta), np.sin(theta)]), np.array([-np.sin(theta), np.cos(theta)]))
        total, odd = m.sum(), half * (m[0] - m[1])
        matrix = np.array([[total, 0.0, odd * n[0]], [0.0, total, odd * n[1]],
                           [odd * n[0], odd * n[1], half**2 * total]])  # fmt: skip
        v = np.array([vx, vy])
        f_v = mu.sum() * v + half * (mu[0] - mu[1]) * w * n
        f_w = half * (mu[0] - mu[1]) * (n @ v) + half**2 * mu.sum() * w
        right = np.array([*(f_v + odd * w**2 * e), f_w])
        return [vx, vy, *np.linalg.solve(matrix, right)[:2], w, np.linalg.solve(matrix, right)[2]]

    z = twin(lagrange, [0.0, 0.0, 0.3, 1.0, 0.0, 2.5])
    # rows: x, y, vx, vy, θ, ω
    offset = half * np.stack([np.cos(z[4]), np.sin(z[4])], axis=-1)
    exact = z[:2].T[:, None] + np.stack([offset, -offset], axis=1)
    assert np.abs(run.position - exact).max() < 1e-8


def test_a_skate_on_one_blade():
    m, mu, half = np.array([2.0, 1.0]), np.array([-0.2, -0.1]), 0.3

    def blade(x, t):  # rigid rod; its middle moves along it
        e = x[0] - x[1]
        n = np.stack([-e[1], e[0]])
        return [[e, -e], [n, n]], np.zeros(2)

    u0, w0 = 1.2, 3.0
    start = np.array([[half, 0.0], [-half, 0.0]])
    going = np.array([[u0, half * w0], [u0, -half * w0]])
    run = constrained_motion(ConstrainedSystem(m, blade, friction=mu), start, going, TIMES,
                             tol=1e-12)  # fmt: skip
    sound(run)
    total, odd = m.sum(), m[0] - m[1]

    def sleigh(t, z):  # Chaplygin's sleigh: u along the blade, ω; friction as −∂f/∂u, −∂f/∂ω
        u, w, theta, _, _ = z
        return [(odd * half * w**2 + mu.sum() * u) / total,
                (-odd * u * w / half + mu.sum() * w) / total, w,
                u * np.cos(theta), u * np.sin(theta)]  # fmt: skip

    _, _, theta, x, y = twin(sleigh, [u0, w0, 0.0, 0.0, 0.0])
    offset = half * np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    middle = np.stack([x, y], axis=-1)
    assert np.abs(run.position - (middle[:, None] + np.stack([offset, -offset], 1))).max() < 1e-8


def test_the_account_includes_what_a_moving_support_gives():
    system = ConstrainedSystem([M], moved_rail(np.cos), [[0.0, -M * G]], [MU])
    run = constrained_motion(system, [0.0 * U], [1.0 * D], TIMES, tol=1e-12)
    pushed = run.multipliers[:, 0] * np.cos(TIMES) * (ACROSS @ D)
    assert np.abs(run.support_work - since_start(pushed)).max() < 1e-6
    assert np.abs(run.support_work).max() > 1.0


def test_tolerance_is_kept_in_the_error():
    def error(tol: float) -> float:
        system = ConstrainedSystem([M], lambda x, t: ([[x[0]]], [0.0]), [[0.0, -M * G]], [0.0])
        run = constrained_motion(system, [[1.0, 0.0]], [[0.0, 0.0]], [0.0, 2.0], tol=tol)
        fine = constrained_motion(system, [[1.0, 0.0]], [[0.0, 0.0]], [0.0, 2.0], tol=1e-13)
        assert run.residual < 1e-12
        return float(np.abs(run.position - fine.position).max())

    errors = [error(tol) for tol in (1e-4, 1e-7, 1e-10)]
    assert errors[0] > 30.0 * errors[1] > 900.0 * errors[2]
    assert errors[2] < 1e-8


def test_a_rate_given_by_hand_does_what_the_complex_step_does():
    def plain(x, t):
        return [[np.abs(x[0])]], [0.0]  # in the first quadrant |x| = x, but not for complex numbers

    start = [[0.6, 0.8]], [[-0.8, 0.6]]
    with pytest.raises(InputError, match="analytic functions"):
        constrained_motion(ConstrainedSystem([1.0], plain), *start, [0.0, 0.2])
    by_hand = ConstrainedSystem([1.0], plain, rate=lambda x, v, t: [(v**2).sum()])
    run = constrained_motion(by_hand, *start, [0.0, 0.2])
    assert run.position[-1, 0] == pytest.approx(
        np.cos(np.arccos(0.6) + 0.2 + np.array([0.0, -np.pi / 2]))
    )
    wrong = ConstrainedSystem([1.0], plain, rate=lambda x, v, t: [0.5 * (v**2).sum()])
    with pytest.raises(InputError, match="changes otherwise"):
        constrained_motion(wrong, *start, [0.0, 0.2])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"masses": [1.0, -1.0]}, "greater than 0 kg"),
        ({"velocity": [[0.0, 1.0], [0.0, 1.0]]}, None),
        ({"velocity": [[1.0, 0.0], [0.0, 0.0]]}, "breaks constraint 1"),
        ({"position": [[1.0, 0.0]]}, r"shape \(2, 2\)"),
        ({"times": [1.0, 0.0]}, "ascending"),
        ({"times": [0.0]}, "two or more"),
        ({"constraints": lambda x, t: ([[x[0], x[1]]] * 2, [0.0, 0.0])}, "t 2 .* combined"),
        ({"constraints": lambda x, t: ([0.0 * x], [0.0])}, "leave it out"),
        ({"constraints": lambda x, t: ([x[0]], [0.0])}, r"shape \(s, n, d\)"),
        ({"constraints": lambda x, t: ([[x[0], float("nan") * x[1]]], [0.0])}, "must be finite"),
        ({"force": [[1.0]]}, "force must have the shape"),
        ({"friction": lambda x, v, t: [np.nan, 0.0]}, "friction at t = 0 s must be finite"),
        ({"tol": 1e-20}, "tol must be"),
    ],
)  # fmt: skip
def test_bad_input_gets_a_sentence(change, message):
    given = {
        "masses": [1.0, 1.0], "position": [[1.0, 0.0], [-1.0, 0.0]],
        "velocity": [[0.0, 1.0], [0.0, -1.0]], "times": [0.0, 1.0], "tol": 1e-9, "force": 0.0,
        "friction": 0.0,
        "constraints": lambda x, t: ([[x[0] - x[1], x[1] - x[0]]], [0.0]),
    } | change  # fmt: skip

    def move():
        system = ConstrainedSystem(
            given["masses"], given["constraints"], given["force"], given["friction"]
        )
        return constrained_motion(system, given["position"], given["velocity"], given["times"],
                                  tol=given["tol"])  # fmt: skip

    if message is None:
        assert move().residual < 1e-14
        return
    with pytest.raises((InputError, AccuracyError), match=message):
        move()


# The puck


@pytest.mark.parametrize("delta", [0.0, 0.7])
def test_patches_with_all_constraints_move_as_after_lagrange(delta):
    system, points = patch_system(2, delta=delta, decel=2.0, radius=0.5, mass=3.0)
    spin, going = 4.0, np.array([1.0, 0.5])
    start = going + spin * np.stack([-points[:, 1], points[:, 0]], axis=-1)
    slow = 1e-6 * float(np.linalg.norm([*going, 0.5 * spin]))
    run = constrained_motion(
        system, points, start, [0.0, 0.3, 5.0], tol=1e-9,
        until=lambda x, v, t: float(np.abs(v).max()) - slow,
    )  # fmt: skip
    time, place = patch_stop(going, spin, 2, delta=delta, decel=2.0, radius=0.5)
    assert run.time[-1] == pytest.approx(time, abs=2e-6)
    assert run.position[-1].mean(axis=0) == pytest.approx(place, abs=1e-6)
    assert run.residual < 1e-12
    assert np.isnan(run.axiom_residual)  # no displacement of a turning body is across all slips
    assert run.multipliers.shape[1] == 2 * len(points) - 3


def test_patches_that_only_slide_can_be_displaced_sideways():
    system, points = patch_system(2)
    run = constrained_motion(system, points, np.tile([1.0, 0.0], (16, 1)), [0.0, 0.9])
    assert run.c_displacements(0) == pytest.approx(np.tile([0.0, 0.25], (1, 16, 1)), abs=1e-12)
    assert run.axiom_residual < 1e-12
    assert run.position[-1].mean(axis=0) == pytest.approx([0.9 - 0.405, 0.0])


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("velocity", "spin", "delta"),
    few(2, [((1, 0), 1.0, 0.0), ((0.6, -0.8), -5, 0.8), ((1, 0), 0.2, 0.0), ((1, 0), 1.0, 0.8)]),
)  # fmt: skip
def test_patches_converge_to_the_puck_with_order_one_in_their_number(velocity, spin, delta):
    exact = stop(velocity, spin, delta=delta, tol=1e-10)
    errors = []
    for rings in (4, 8, 16, 32):
        time, place = patch_stop(velocity, spin, rings, delta=delta)
        errors.append([abs(time - exact.stop_time), np.hypot(*(place - exact.stop_position))])
    order = np.log2(np.array(errors[:-1]) / errors[1:])  # in a patch's width: N quadruples
    assert (order > 1.7).all()
    assert (order < 2.15).all()
    assert np.abs(order.mean(axis=0) - 2.0).max() < 0.12


def test_bad_patches_get_a_sentence():
    for change in ({"rings": 0}, {"delta": 1.5}, {"decel": 0.0}, {"radius": float("nan")}):
        given = {"velocity": (1.0, 0.0), "spin": 1.0, "rings": 3} | change
        with pytest.raises(InputError):
            patch_stop(**given)
    with pytest.raises(InputError, match="finite"):
        patch_stop((1.0, np.inf), 0.0, 2)
    assert patch_stop((0.0, 0.0), 0.0, 2)[0] == 0.0


def test_an_instant_splits_the_reaction():
    slope = np.array([[[-0.6, 0.8]]])
    bead = ConstrainedSystem([1.0], lambda x, t: (slope, [0.0]), [[0.0, -5.0]], [-2.0])
    now = bead.instant(np.zeros((1, 2)), np.array([[0.8, 0.6]]), 0.0)
    assert now.smooth == pytest.approx(np.array([[-2.4, 3.2]]))
    assert now.friction == pytest.approx(np.array([[-1.6, -1.2]]))
