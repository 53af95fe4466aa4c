"""Claims about the friction resultants and the flow of the slip angle φ that they drive."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from paper.claim import Claim, at_least, equal, less, more
from paper.patch import ANGLES, HEIGHTS, PHI
from paper.root import root
from puck_tables._core.arrays import FloatArray
from puck_tables.contact.closed_form import Resultants, by_closed_form
from puck_tables.motion.limits import approach_exponent, curvature_slope, limit_angle

Friction = Callable[[npt.ArrayLike, npt.ArrayLike], Resultants]

_PI45 = 45.0 * math.pi


def _q(delta: FloatArray) -> FloatArray:
    q: FloatArray = _PI45**2 + (16.0 * delta) ** 2
    return q


# Table 6.1: for each resultant, at φ = 0, π/4, π/2, how the paper writes it and its value at δ;
# q = (45 pi)^2 + (16 delta)^2.
TABLE_6_1: dict[str, tuple[tuple[str, Callable[[FloatArray], FloatArray]], ...]] = {
    "rho_par": (
        ("1", np.ones_like),
        ("5400 sqrt2 pi/q", lambda d: 5400 * math.sqrt(2) * math.pi / _q(d)),
        ("9/(9 + delta^2)", lambda d: 9 / (9 + d**2)),
    ),
    "rho_perp": (
        ("delta/4", lambda d: d / 4),
        ("7680 delta/q", lambda d: 7680 * d / _q(d)),
        ("3 delta/(9 + delta^2)", lambda d: 3 * d / (9 + d**2)),
    ),
    "rho_omega": (
        ("(4 - delta^2)/8", lambda d: (4 - d**2) / 8),
        ("16 sqrt2/(9 pi) * ...", lambda d: (
            16 * math.sqrt(2) / (9 * math.pi) * (_PI45**2 - 2 * (32 * d) ** 2) / _q(d)
        )),
        ("4/3", lambda d: np.full_like(d, 4 / 3)),
    ),
}  # fmt: skip


def claims(friction: Friction = by_closed_form) -> list[Claim]:
    """All claims of this file, for the program's resultants or others put to the test."""
    return [
        *table_6_1(friction), *signs(friction), *slip_angle_flow(friction), *unique_limit(friction),
        *reversal(friction), *limit_values(),
    ]  # fmt: skip


def table_6_1(friction: Friction) -> list[Claim]:
    """The nine entries of table 6.1: the value at δ = 1, the largest deviation for δ ≤ 1."""
    found = friction(np.array([phi for _, phi in ANGLES])[:, None], HEIGHTS)
    return [
        Claim(
            "table 6.1", f"{name} at phi = {angle} (computed: delta = 1)", text,
            float(values[i, -1]), float(np.abs(values[i] - formula(HEIGHTS)).max()), 1e-14,
        )
        for (name, row), values in zip(TABLE_6_1.items(), found, strict=True)
        for i, ((angle, _), (text, formula)) in enumerate(zip(ANGLES, row, strict=True))
    ]  # fmt: skip


def signs(friction: Friction) -> list[Claim]:
    """Corollaries 4 and 5: the resultants are positive, ρ_ω as long as δ < 2."""
    heights = HEIGHTS[1:]
    rho = friction(PHI[:, None], heights)
    small = friction(PHI, 0.01)
    wide = np.linspace(0.0, 1.999, 200)
    at_zero = friction(0.0, wide).spin
    share = (friction(PHI[:, None], wide).spin / at_zero).min()
    lost = root(lambda d: float(friction(PHI, d).spin.min()), 1.0, 3.0)
    return [
        more("Cor. 4", "rho_par > 0 (smallest, delta <= 1)", 0.0, float(rho.parallel.min())),
        more("Cor. 4", "rho_perp/delta > 0 (smallest, delta <= 1)", 0.0,
             float((rho.perpendicular / heights).min())),
        more("Cor. 4", "rho_omega > 0 for small delta (smallest, 0.01)", 0.0,
             float(small.spin.min())),
        at_least("Fig. 9", "rho_omega is smallest at phi = 0, delta < 2 (ratio)", 1.0,
                 float(share), 1e-12),
        equal("Fig. 9", "so rho_omega > 0 for delta < 2 (its sign is lost at)", 2.0, lost, 1e-9),
        more("Cor. 5", "-dQ/dt >= const > 0 (smallest/J)", 0.0, float(decline(friction).min())),
    ]  # fmt: skip


def decline(friction: Friction, delta: npt.ArrayLike = HEIGHTS) -> FloatArray:
    """−Q'/J = cos²φ ρ_∥ + sin²φ ρ_ω (eq. 6.5) over the grid of φ, shape (φ, δ)."""
    phi = PHI[:, None]
    rho = friction(phi, delta)
    return np.asarray(np.cos(phi) ** 2 * rho.parallel + np.sin(phi) ** 2 * rho.spin)


def excess(friction: Friction, phi: npt.ArrayLike, delta: npt.ArrayLike) -> FloatArray:
    """ρ_∥ − ρ_ω, whose sign drives φ away from 0 and π/2 and to φ₀."""
    rho = friction(phi, delta)
    return rho.parallel - rho.spin


def slip_angle_rate(friction: Friction, phi: npt.ArrayLike, delta: npt.ArrayLike) -> FloatArray:
    """dφ/dτ = sin φ cos φ (ρ_∥ − ρ_ω), Q dτ = J dt (eq. 7.2)."""
    angle = np.asarray(phi)
    return np.asarray(np.sin(angle) * np.cos(angle) * excess(friction, angle, delta))


def slip_angle_flow(friction: Friction) -> list[Claim]:
    """Section 7, corollaries 7 and 8: which way φ moves; its trivial rests are unstable."""
    zero, quarter, right = (excess(friction, phi, HEIGHTS) for _, phi in ANGLES)
    step = 1e-6
    growth = slip_angle_rate(friction, step, HEIGHTS) / step
    growth_back = -slip_angle_rate(friction, 0.5 * math.pi - step, HEIGHTS) / step
    angle = limit_angle(HEIGHTS)
    return [
        more("section 7", "rho_par - rho_omega at 0 (smallest)", 0.0, float(zero.min())),
        more("section 7", "rho_par - rho_omega at pi/4 (smallest)", 0.0, float(quarter.min())),
        less("section 7", "rho_par - rho_omega at pi/2 (largest)", 0.0, float(right.max())),
        more("Cor. 7", "phi = 0 is unstable: growth rate (smallest)", 0.0, float(growth.min())),
        more("Cor. 7", "phi = pi/2 is unstable: growth rate (smallest)", 0.0,
             float(growth_back.min())),
        more("Cor. 8", "phi0 lies beyond pi/4 (smallest phi0)", 0.25 * math.pi,
             float(angle.min())),
        less("Cor. 8", "and before pi/2 (largest phi0)", 0.5 * math.pi, float(angle.max())),
        equal("Cor. 8", "there rho_par = rho_omega (largest difference)", 0.0,
              float(np.abs(excess(friction, angle, HEIGHTS)).max()), 1e-13),
    ]  # fmt: skip


def unique_limit(friction: Friction) -> list[Claim]:
    """Proposition 6: φ₀ is the only zero of ρ_∥ − ρ_ω in (0, π/2), and a simple one.

    One change of sign on the grid; away from φ₀ the difference, near φ₀ its slope keep off zero.
    """
    difference = excess(friction, PHI[:, None], HEIGHTS)
    changes = (np.diff(np.sign(difference), axis=0) != 0.0).sum(axis=0)
    before = limit_angle(HEIGHTS) - PHI[:, None]
    slope = np.diff(difference, axis=0) / np.diff(PHI)[:, None]
    near = np.abs(before) < 0.2
    worst = changes[np.argmax(np.abs(changes - 1))]
    return [
        equal("Prop. 6", "one zero in (0, pi/2) for each of 101 delta (changes)", 1.0,
              float(worst), 0.0),
        more("Prop. 6", "> 0 before phi0 - 0.2, < 0 beyond phi0 + 0.2 (smallest)", 0.0,
             float((np.sign(before) * difference)[~near].min())),
        less("Prop. 6", "its derivative where |phi - phi0| < 0.2 (largest)", 0.0,
             float(slope[near[1:] & near[:-1]].max())),
        less("Prop. 6", "its derivative at phi0 (largest)", 0.0, float(slope_at_limit(friction))),
    ]  # fmt: skip


def slope_at_limit(friction: Friction) -> float:
    """The largest d(ρ_∥ − ρ_ω)/dφ at φ₀(δ), δ ≤ 1, by a central difference."""
    angle, step = limit_angle(HEIGHTS), 1e-5
    change = excess(friction, angle + step, HEIGHTS) - excess(friction, angle - step, HEIGHTS)
    return float(change.max() / (2.0 * step))


def reversal(friction: Friction) -> list[Claim]:
    """Section 8: what φ → −φ does to the flow (8.1) of φ and heading ψ.

    Both components are odd in φ.  The paper reads that as reversibility; a reversal would turn the
    attractor φ₀ into a repeller −φ₀, so that their rates would add up to zero.
    """
    delta = HEIGHTS
    phi = PHI[:, None]

    def turning(angle: FloatArray) -> FloatArray:
        return np.asarray(-np.sin(angle) * friction(angle, delta).perpendicular)

    step = 1e-5

    def rate(angle: FloatArray) -> FloatArray:
        ahead, behind = (slip_angle_rate(friction, angle + s, delta) for s in (step, -step))
        return (ahead - behind) / (2.0 * step)

    angle = limit_angle(delta)
    odd = slip_angle_rate(friction, phi, delta) + slip_angle_rate(friction, -phi, delta)
    both = rate(angle) + rate(-angle)
    return [
        equal("section 8", "phi' is odd in phi (largest phi'(phi) + phi'(-phi))", 0.0,
              float(np.abs(odd).max()), 1e-14),
        equal("section 8", "psi' is odd in phi (largest psi'(phi) + psi'(-phi))", 0.0,
              float(np.abs(turning(phi) + turning(-phi)).max()), 1e-14),
        equal("section 8", "so reversible: rate at phi0 + rate at -phi0 (delta = 1)", 0.0,
              float(both[-1]), 1e-6,
              erratum="phi0 and -phi0 both attract, while a reversal would make one of them repel: "
              "(phi, psi) -> (-phi, -psi) is a symmetry of (8.1), not a reversal of time"),
    ]  # fmt: skip


def limit_values() -> list[Claim]:
    """Results 4 and 8: the limit ratio of a flat puck, and Λ about 7 and nearly constant."""
    slope = curvature_slope(HEIGHTS)
    return [
        # 0.65300... are the digits that stand; the next is not known
        equal("result 4", "1/tan(phi0) at delta = 0", 0.653005,
              1.0 / math.tan(float(limit_angle(0.0))), 5e-6, "0.65300..."),
        equal("result 8", "Lambda is about 7 (largest, delta <= 1)", 7.0, float(slope.max()), 0.5),
        equal("result 8", "Lambda is about 7 (smallest, delta <= 1)", 7.0, float(slope.min()), 0.5),
        more("Cor. 9", "phi -> phi0 at an exponential rate (smallest)", 0.0,
             float(approach_exponent(HEIGHTS).min())),
    ]  # fmt: skip
