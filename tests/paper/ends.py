"""Claims about both ends of a motion: what it tends to at the stop, and far back in the past.

All motions of one type are one motion up to symmetry (proposition 8), so a launch at an extreme
ratio rω/v is that motion far back in time.
"""

from __future__ import annotations

import math

import numpy as np

from paper.claim import Claim, equal, farthest, more
from paper.root import power
from paper.runs import Simulate, curvature_radius, launch, simulate, slip_ratio, time_left
from puck_tables.contact.closed_form import Resultants, by_closed_form
from puck_tables.motion.limits import approach_exponent, curvature_slope, limit_angle
from puck_tables.trajectory import Trajectory

DELTAS = (0.0, 0.5, 1.0)
BENDING = (0.25, 0.5, 1.0)
# Shares of the stop time still left where remainders are pure powers, and above rounding
TAIL = np.logspace(-5.0, -6.0, 5)
END = np.logspace(-6.0, -8.0, 5)
THREE = np.array([1.02, 1.0, 0.98])  # next to one of them


def claims(run: Simulate = simulate) -> list[Claim]:
    """All claims of this file, for the program's motions or others put to the test."""
    return [
        *limit_ratios(run), *last_speeds(run), *last_curvature(run), *endless_turning(run),
        *far_past(run),
    ]  # fmt: skip


def friction_at_limit(delta: float) -> tuple[float, Resultants]:
    """φ₀(δ) and the resultants there."""
    angle = float(limit_angle(delta))
    return angle, by_closed_form(angle, delta)


def limit_ratios(run: Simulate) -> list[Claim]:
    """Result 4, corollary 9: rω/v → ± tan φ₀ at the stop, exponentially in τ (a power of Q)."""
    found = []
    for delta in DELTAS:
        limit = math.tan(friction_at_limit(delta)[0])
        last = [
            float(slip_ratio(launch(run, ratio, delta, shares=[1e-13]))[0] * np.sign(ratio))
            for ratio in (-5.0, -1.0, -0.2, 0.2, 1.0, 5.0)
        ]
        found.append(
            equal("result 4", f"r w/v -> +-tan(phi0) at the stop, delta = {delta:g} (6 motions)",
                  limit, farthest(last, limit), 1e-5)
        )  # fmt: skip
    rates = []
    for delta in DELTAS:
        motion = launch(run, 5.0, delta, shares=END)
        gap = slip_ratio(motion) - math.tan(friction_at_limit(delta)[0])
        rates.append(power(motion.slip_speed, gap) - float(approach_exponent(delta)))
    off = max(abs(rate) for rate in rates)
    found.append(
        equal("Cor. 9", "|phi - phi0| ~ Q^kappa, measured power less kappa", 0.0, off, 1e-3)
    )
    return found


def last_speeds(run: Simulate) -> list[Claim]:
    """Corollary 11: Q → ρ_∥(φ₀) J (t₀ − t); its remainder goes like (t₀ − t)^(1 + κ), κ < 1.

    The paper says O((t₀ − t)²); but φ − φ₀ falls only like Q^κ, and Q' depends on φ linearly.
    """
    speeds, powers, kappas = [], [], []
    for delta in DELTAS:
        along = float(friction_at_limit(delta)[1].parallel)
        last = launch(run, 5.0, delta, shares=END)
        speeds.append(float(last.slip_speed[-1] / time_left(last)[-1]) / along)
        motion = launch(run, 5.0, delta, shares=TAIL)
        left = time_left(motion)
        powers.append(power(left, motion.slip_speed - along * left))
        kappas.append(float(approach_exponent(delta)))
    off = max(abs(p - 1.0 - kappa) for p, kappa in zip(powers, kappas, strict=True))
    return [
        equal("Cor. 11", "Q/(J rho_par(phi0) (t0 - t)) at the stop (3 motions)", 1.0,
              farthest(speeds, 1.0), 1e-4),
        equal("Cor. 11", "with a remainder of power 2 in t0 - t (delta = 0)", 2.0, powers[0], 0.05,
              "O((t0 - t)^2)",
              erratum=f"the remainder has the power 1 + kappa (next row), {powers[0]:.2f} at "
              f"delta = 0 to {powers[-1]:.2f} at 1: phi - phi0 falls only like Q^kappa, and Q' "
              "depends on phi; the limit itself stands"),
        equal("Cor. 11", "with a remainder of power 1 + kappa (largest deviation)", 0.0, off, 5e-3,
              "-"),
    ]  # fmt: skip


def radius_slope(run: Trajectory) -> float:
    """dR/ds from three states of a motion close to each other.

    By eq. 6.5, ds = v dt = −Q g(φ) dQ/J with g = cos φ/(cos²φ ρ_∥ + sin²φ ρ_ω): with Q, not t, as
    variable no digits are lost next to the stop, where g is all but constant.
    """
    rho = by_closed_form(run.slip_angle, run.puck.delta)
    radius = curvature_radius(rho.perpendicular, run)
    cosine = np.cos(run.slip_angle)
    fall = (cosine**2 * rho.parallel + (1.0 - cosine**2) * rho.spin) * run.puck.decel
    mean = float((cosine / fall) @ (1.0, 4.0, 1.0)) / 6.0
    path = 0.5 * float(run.slip_speed[0] ** 2 - run.slip_speed[2] ** 2) * mean
    return float(radius[2] - radius[0]) / path


def last_curvature(run: Simulate) -> list[Claim]:
    """Result 8, corollary 12: at the stop R = 0 and dR/ds = −Λ/δ, whatever the launch.

    The paper's remainder O(Q) is one like Q^κ, for the same reason as in corollary 11.
    """
    slopes, radii, powers, kappas = [], [], [], []
    for delta in BENDING:
        ends = [launch(run, ratio, delta, shares=1e-8 * THREE) for ratio in (0.2, 5.0)]
        for end in ends:
            across = by_closed_form(end.slip_angle, delta).perpendicular
            radii.append(float(curvature_radius(across, end).max()))
        final = -float(curvature_slope(delta)) / delta
        slopes.append(
            equal("Cor. 12", f"dR/ds -> -Lambda/delta at the stop, delta = {delta:g} (2 motions)",
                  final, farthest(map(radius_slope, ends), final), 1e-3)
        )  # fmt: skip
        pair = [launch(run, 5.0, delta, shares=share * THREE) for share in (1e-6, 1e-8)]
        powers.append(
            power([float(p.slip_speed[1]) for p in pair], [radius_slope(p) - final for p in pair])
        )
        kappas.append(float(approach_exponent(delta)))
    off = max(abs(p - kappa) for p, kappa in zip(powers, kappas, strict=True))
    return [
        equal("result 8", "R -> 0 at the stop (largest R at Q ~ 1e-8)", 0.0, max(radii), 1e-13),
        *slopes,
        equal("Cor. 12", f"with a remainder of power 1 in Q (delta = {BENDING[0]:g})", 1.0,
              powers[0], 0.05, "O(Q)",
              erratum=f"the remainder has the power kappa (next row), {powers[0]:.2f} at delta = "
              f"{BENDING[0]:g} to {powers[-1]:.2f} at {BENDING[-1]:g}; the limit itself stands"),
        equal("Cor. 12", "with a remainder of power kappa (largest deviation)", 0.0, off, 5e-3,
              "-"),
    ]  # fmt: skip


def endless_turning(run: Simulate) -> list[Claim]:
    """Result 6, corollary 13: the heading turns without end, by a fixed angle per decade of Q."""
    smallest, off = math.inf, 0.0
    for delta in BENDING:
        angle, rho = friction_at_limit(delta)
        rate = math.sin(angle) * float(rho.perpendicular / rho.parallel)
        for ratio in (0.2, 5.0):
            motion = launch(run, ratio, delta, shares=np.logspace(-6.0, -11.0, 6))
            turn = np.diff(motion.heading) / np.diff(np.log(motion.slip_speed))
            smallest = min(smallest, float(turn.min()))
            off = max(off, float(np.abs(turn / rate - 1.0).max()))
    return [
        more("Cor. 13", "turn for each factor e of Q, 5 last decades (smallest)", 0.0, smallest),
        equal("result 6", "it tends to sin(phi0) rho_perp/rho_par: turn ~ ln(t0 - t)", 0.0, off,
              1e-3),
    ]  # fmt: skip


def far_past(run: Simulate) -> list[Claim]:
    """Results 5 and 7, section 7: where motions of types B and C come from.

    With ε = rω/v, linear stability at φ = π/2 and 0 gives ε ~ Q^(1 − ρ_∥/ρ_ω) → ∞ for type B and
    ε ~ Q^(ρ_ω/ρ_∥ − 1) → 0 for type C as Q → ∞.
    """
    shares = np.linspace(1.0, 0.1, 10)
    found: dict[str, list[float]] = {name: [] for name in ("B", "B off", "C", "C off")}
    speed_b, speed_c, turn_b, turn_c, turn_off = [], [], [], [], 0.0
    for delta in DELTAS:
        from_spin, from_slide = (
            launch(run, ratio, delta, shares=shares) for ratio in (1e12, 1e-12)
        )
        spin, slide = by_closed_form(0.5 * math.pi, delta), by_closed_form(0.0, delta)
        growth = power(from_spin.slip_speed, slip_ratio(from_spin))
        decay = power(from_slide.slip_speed, slip_ratio(from_slide))
        found["B"].append(growth)
        found["B off"].append(abs(growth - 1.0 + float(spin.parallel / spin.spin)))
        found["C"].append(decay)
        found["C off"].append(abs(decay + 1.0 - float(slide.spin / slide.parallel)))
        speed_b.append(float(np.ptp(from_spin.slip_speed) / np.ptp(from_spin.time)))
        speed_c.append(float(np.ptp(from_slide.slip_speed) / np.ptp(from_slide.time)))
        if delta > 0.0:
            turn = np.diff(from_spin.heading) / np.diff(np.log(from_spin.slip_speed))
            turn_b.append(float(turn.min()))
            turn_off = max(
                turn_off, float(np.abs(turn / float(spin.perpendicular / spin.spin) - 1.0).max())
            )
            turn_c.append(abs(float(from_slide.heading[-1])))
    return [
        more("result 5", "type B back in time: power of r w/v in Q (smallest)", 0.0,
             min(found["B"])),
        equal("Cor. 9", "it is 1 - rho_par/rho_omega at pi/2", 0.0, max(found["B off"]), 1e-9),
        more("result 5", "type C back in time: power of v/(r w) in Q (smallest)", 0.0,
             -max(found["C"])),
        equal("Cor. 9", "it is 1 - rho_omega/rho_par at 0", 0.0, max(found["C off"]), 1e-9),
        equal("section 7", "type B: Q grows linearly back in time, at J 4/3", 4.0 / 3.0,
              farthest(speed_b, 4.0 / 3.0), 1e-9, "linear"),
        equal("section 7", "type C: Q grows linearly back in time, at J", 1.0,
              farthest(speed_c, 1.0), 1e-9, "linear"),
        more("result 7", "type B back: turn for each factor e of Q (smallest)", 0.0, min(turn_b)),
        equal("result 7", "it tends to rho_perp/rho_omega at pi/2: without bound", 0.0, turn_off,
              1e-9),
        equal("result 7", "type C back: turn at r w/v ~ 1e-12, direction kept", 0.0, max(turn_c),
              1e-10),
    ]  # fmt: skip
