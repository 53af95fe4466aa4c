"""Claims about motions from launch to stop."""

from __future__ import annotations

import math

import numpy as np

from paper.claim import Claim, equal, farthest, less, more
from paper.friction import decline, excess
from paper.root import power
from paper.runs import Simulate, launch, simulate, slip_ratio, time_left, velocity
from puck_tables._core.arrays import FloatArray
from puck_tables.contact.closed_form import by_closed_form
from puck_tables.trajectory import Trajectory

RATIOS = (-20.0, -2.0, -0.5, 0.05, 0.3, 1.0, 3.0, 8.0)
DELTAS = (0.0, 0.5, 1.0)
RANDOM_LAUNCHES = 200


def claims(run: Simulate = simulate) -> list[Claim]:
    """All claims of this file, for the program's motions or others put to the test."""
    motions = [launch(run, ratio, delta) for delta in DELTAS for ratio in RATIOS]
    return [
        *equations(run), *symmetry(run), *quadrature(run), *random_launches(run),
        *spin_keeps_its_sign(motions), *special_launches(run), *simultaneous_stop(run),
        *bending(motions),
    ]  # fmt: skip


def acceleration(
    velocity: FloatArray, rim: FloatArray, delta: float
) -> tuple[FloatArray, FloatArray]:
    """The right-hand sides of eq. 6.2 (r = J = 1): of (v_x, v_y), shape (…, 2), and of rω."""
    speed = np.hypot(velocity[..., 0], velocity[..., 1])
    phi = np.arctan2(rim, speed)
    rho = by_closed_form(phi, delta)
    along = velocity / speed[..., None]
    left = np.stack([-along[..., 1], along[..., 0]], axis=-1)
    across = np.sin(phi) * np.cos(phi) * rho.perpendicular
    return (
        -(np.cos(phi) * rho.parallel)[..., None] * along - across[..., None] * left,
        -np.sin(phi) * rho.spin,
    )


def equations(run: Simulate) -> list[Claim]:
    """Eq. 6.2: the states have the accelerations that friction gives, by differences of order 4."""
    step = 1e-3
    stencil = np.array([-2, -1, 0, 1, 2])
    shares = np.linspace(0.1, 0.9, 17)[:, None] - step * stencil
    worst = 0.0
    for delta in DELTAS:
        for ratio in RATIOS:
            motion = launch(run, ratio, delta, heading=0.7, shares=shares.ravel())
            state = np.column_stack([velocity(motion), motion.spin]).reshape(-1, 5, 3)
            difference = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / (12.0 * step * motion.stop_time)
            rate = np.einsum("k,nkj->nj", difference, state)
            here = state[:, 2]
            linear, angular = acceleration(here[:, :2], here[:, 2], delta)
            worst = max(worst, float(np.abs(rate - np.column_stack([linear, angular])).max()))
    return [equal("eq. 6.2", "24 motions obey it (largest difference /J)", 0.0, worst, 1e-5)]


def random_launches(run: Simulate) -> list[Claim]:
    """Results 0 and 3: every launch stops in finite time, and almost every one is of type B or C.

    Q falls at least at the rate J const of corollary 5, so that it lasts at most Q/(J const).
    """
    rng = np.random.default_rng(2012)
    runs = []
    for _ in range(RANDOM_LAUNCHES):
        v0, w0, delta = rng.normal(size=2), rng.normal(scale=3.0), rng.random()
        runs.append(run(v0, float(w0), delta=float(delta), frames=1))
    bound = 1.0 / float(decline(by_closed_form).min())
    duration = max(r.stop_time / float(r.slip_speed[0]) for r in runs)
    generic = sum(r.regime in ("B", "C") for r in runs)
    return [
        less("result 0", "200 random launches stop before Q/(J const) (longest J/Q)", bound,
             duration),
        equal("result 3", "200 random launches are of type B or C", RANDOM_LAUNCHES,
              float(generic), 0.0),
    ]  # fmt: skip


def special_launches(run: Simulate) -> list[Claim]:
    """Result 3: the special motions keep what makes them special."""
    spinning = [launch(run, math.inf, delta) for delta in DELTAS]
    sliding = [launch(run, 0.0, delta) for delta in DELTAS]
    # next to the limit ratio, where the integrator runs, and not the solution of type D
    off = 1e-9
    near = []
    for delta in DELTAS:
        limit = math.tan(launch(run, 1.0, delta, shares=[1.0]).limit_angle)
        motion = launch(run, limit * (1.0 + off), delta, shares=np.logspace(0.0, -9.0, 40))
        near.append(float(np.abs(slip_ratio(motion) / limit - 1.0).max()))
    return [
        equal("result 3", "type B0 only spins (largest v)", 0.0,
              max(float(r.speed.max()) for r in spinning), 1e-15),
        equal("Cor. 6", "phi = 0 stays: type C0 only slides (largest r w)", 0.0,
              max(float(np.abs(r.spin).max()) for r in sliding), 0.0),
        equal("result 5", "type D keeps r w/v = tan(phi0) (launched 1e-9 off)", 0.0,
              max(near), 2.0 * off),
    ]  # fmt: skip


def spin_keeps_its_sign(motions: list[Trajectory]) -> list[Claim]:
    """Result 1, corollary 6: ω never changes its sign.

    Measured as sin φ(t)/sin φ(0), which stays away from zero as long as the puck moves.
    """
    smallest = min(
        float((np.sin(r.slip_angle[r.slip_speed > 0.0]) / np.sin(r.slip_angle[0])).min())
        for r in motions
    )
    return [more("result 1", "w keeps its sign (smallest sin phi(t)/sin phi(0))", 0.0, smallest)]


def symmetry(run: Simulate) -> list[Claim]:
    """Result 2, Prop. 5: (v, ω, t) → (λ A v, λ det A ω, λ t), of the equations and of motions."""
    rng = np.random.default_rng(5)
    field = states = 0.0
    for delta in DELTAS:
        for _ in range(20):
            angle, scale, sign = rng.uniform(0.0, 6.0), rng.uniform(0.1, 10.0), rng.choice((-1, 1))
            cosine, sine = math.cos(angle), math.sin(angle)
            image = np.array([[cosine, -sign * sine], [sine, sign * cosine]])
            v0, w0 = rng.normal(size=2), rng.normal()
            v1, w1 = scale * image @ v0, scale * float(sign) * w0
            linear, angular = acceleration(v0, np.asarray(w0), delta)
            linear1, angular1 = acceleration(v1, np.asarray(w1), delta)
            field = max(
                field,
                float(np.abs(linear1 - image @ linear).max()),
                float(abs(angular1 - sign * angular)),
            )
            one = run(v0, w0, delta=delta)
            times = scale * one.time[:-1]
            two = run(v1, w1, delta=delta, times=times)
            expected = np.column_stack([velocity(one) @ image.T, sign * one.spin])[:-1]
            found = np.column_stack([velocity(two), two.spin])
            states = max(states, float(np.abs(found / scale - expected).max()))
    return [
        equal(
            "Prop. 5", "O(2) x R+ maps eq. 6.2 to itself (largest difference)", 0.0, field, 1e-13
        ),
        equal("result 2", "and its motions to motions (largest difference)", 0.0, states, 1e-10),
    ]


def quadrature(run: Simulate) -> list[Claim]:
    """Prop. 7: ln Q, ψ and t by quadratures over u = ln(rω/v), against the integrator.

    d ln Q/du = −(cos²φ ρ_∥ + sin²φ ρ_ω)/(ρ_∥ − ρ_ω), dψ/du = −sin φ ρ_⊥/(ρ_∥ − ρ_ω),
    dt/du = Q/(ρ_∥ − ρ_ω).
    """
    node, weight = np.polynomial.legendre.leggauss(40)
    worst = 0.0
    for delta in DELTAS:
        # arcs short of φ = π/4, where the resultants are not smooth
        for first, last in ((8.0, 2.0), (1.05, 1.3), (0.02, 0.9)):

            def rates(
                u: FloatArray, delta: float = delta
            ) -> tuple[FloatArray, FloatArray, FloatArray]:
                phi = np.arctan(np.exp(u))
                rho, speed = by_closed_form(phi, delta), excess(by_closed_form, phi, delta)
                fall = np.cos(phi) ** 2 * rho.parallel + np.sin(phi) ** 2 * rho.spin
                return -fall / speed, -np.sin(phi) * rho.perpendicular / speed, 1.0 / speed

            start, half = math.log(first), 0.5 * math.log(last / first)
            u = start + half * (node + 1.0)
            inner = 0.5 * (u - start)[:, None]  # from the start to each node
            log_q = (rates(start + inner * (node + 1.0))[0] * inner) @ weight
            fall, turn, pace = rates(u)
            q = math.exp(half * float(fall @ weight))
            psi = half * float(turn @ weight)
            time = half * float((np.exp(log_q) * pace) @ weight)
            v0 = 1.0 / math.hypot(1.0, first)
            end = run((v0, 0.0), first * v0, delta=delta,
                      times=[time])  # fmt: skip
            worst = max(
                worst, abs(float(end.slip_speed[0]) - q), abs(float(end.heading[0]) - psi),
                abs(float(slip_ratio(end)[0]) - last),
            )  # fmt: skip
    return [equal("Prop. 7", "quadratures give 9 motions (largest difference)", 0.0, worst, 1e-9)]


def simultaneous_stop(run: Simulate) -> list[Claim]:
    """Result 4: v and ω vanish together, each in proportion to the time left."""
    sliding, spinning = [], []
    for delta in DELTAS:
        for ratio in (0.1, 1.0, 10.0):
            motion = launch(run, ratio, delta, shares=[1e-7, 1e-9])
            sliding.append(power(time_left(motion), motion.speed))
            spinning.append(power(time_left(motion), motion.spin))
    return [
        equal("result 4", "v vanishes with w: power of t0 - t in v (9 motions)", 1.0,
              farthest(sliding, 1.0), 1e-3),
        equal("result 4", "w vanishes with v: power of t0 - t in w (9 motions)", 1.0,
              farthest(spinning, 1.0), 1e-3),
    ]  # fmt: skip


def bending(motions: list[Trajectory]) -> list[Claim]:
    """Result 6, corollary 10: straight for δ = 0, else to the right for ω > 0, left for ω < 0."""

    def turns(side: float) -> list[float]:
        """Steps of the heading between states, against the side they should go to."""
        return [
            float((-side * np.diff(r.heading[:-1])).min())
            for r in motions
            if r.puck.delta > 0.0 and r.launch_spin * side > 0.0
        ]

    straight = max(float(np.abs(r.y).max()) for r in motions if r.puck.delta == 0.0)
    found = [equal("result 6", "straight for delta = 0 (largest |y|)", 0.0, straight, 1e-15)]
    for side, sign, name in ((1.0, ">", "right"), (-1.0, "<", "left")):
        if steps := turns(side):
            found.append(
                more("Cor. 10", f"w {sign} 0 turns the path to the {name} (smallest step)", 0.0,
                     min(steps))
            )  # fmt: skip
    return found
