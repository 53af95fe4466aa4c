"""Claims about the contact patch: the five integrals, and where the pressure stays positive."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from paper.claim import Claim, at_least, equal, less, more
from paper.root import root
from puck_tables._core.arrays import FloatArray
from puck_tables.contact import closed_form, quadrature
from puck_tables.contact.closed_form import moment_balance, pressure_tilt
from puck_tables.contact.integrals import PatchIntegrals, slip_direction
from puck_tables.contact.pressure import PressureLaw

Integrals = Callable[[npt.ArrayLike], PatchIntegrals]

PHI = np.linspace(0.0, 0.5 * np.pi, 2001)
HEIGHTS = np.linspace(0.0, 1.0, 101)

# Table 4.6 by columns; for φ = 0, π/4, π/2 how the paper writes the entry, and its value
_ROOT = math.sqrt(2.0) / math.pi
TABLE_4_6 = {
    "a": (("1", 1.0), ("8 sqrt2/(3 pi)", 8 / 3 * _ROOT), ("1", 1.0)),
    "b": (("1/4", 0.25), ("32 sqrt2/(45 pi)", 32 / 45 * _ROOT), ("1/3", 1 / 3)),
    "c": (("0", 0.0), ("-8 sqrt2/(45 pi)", -8 / 45 * _ROOT), ("-1/3", -1 / 3)),
    "d": (("1/4", 0.25), ("8 sqrt2/(9 pi)", 8 / 9 * _ROOT), ("2/3", 2 / 3)),
    "e": (("-1/4", -0.25), ("-8 sqrt2/(15 pi)", -8 / 15 * _ROOT), ("0", 0.0)),
}
ANGLES = (("0", 0.0), ("pi/4", 0.25 * math.pi), ("pi/2", 0.5 * math.pi))


def claims(integrals: Integrals = closed_form.integrals) -> list[Claim]:
    """All claims of this file, for the program's integrals or others put to the test."""
    return [
        *table_4_6(integrals), *positive(integrals), *symmetries(integrals), *negative(integrals),
        *positive_pressure(integrals), *critical_heights(integrals), *pressure_laws(),
    ]  # fmt: skip


def table_4_6(integrals: Integrals) -> list[Claim]:
    """The 15 entries of table 4.6."""
    found = integrals([phi for _, phi in ANGLES])
    return [
        equal("table 4.6", f"p_{name} at phi = {angle}", value, float(column[i]), 1e-14, text)
        for name, column in zip(TABLE_4_6, found, strict=True)
        for i, ((angle, _), (text, value)) in enumerate(
            zip(ANGLES, TABLE_4_6[name], strict=True)
        )
    ]  # fmt: skip


def positive(integrals: Integrals) -> list[Claim]:
    """Corollary 1: which integrals are positive."""
    p = integrals(PHI)
    return [
        more("Cor. 1", f"p_{name} > 0 at every phi (smallest)", 0.0, float(column.min()))
        for name, column in (("a", p.a), ("b", p.b), ("d", p.d))
    ]


def negative(integrals: Integrals) -> list[Claim]:
    """Corollary 3: which integrals are negative but for one zero, and p_Δ ≥ 1 from that.

    p_c has a double zero at φ = 0 and p_e at π/2: divided by sin²φ and cos²φ they stay away from 0.
    """
    inside = PHI[1:-1]
    p = integrals(inside)
    c, e = -p.c / np.sin(inside) ** 2, -p.e / np.cos(inside) ** 2
    determinant = balance_determinant(integrals, PHI[:, None], np.linspace(0.0, 4.0, 101))
    return [
        more("Cor. 3", "p_c < 0 but for phi = 0 (smallest -p_c/sin^2)", 0.0, float(c.min())),
        more("Cor. 3", "p_e < 0 but for phi = pi/2 (smallest -p_e/cos^2)", 0.0, float(e.min())),
        at_least("Cor. 3", "so p_Delta >= 1, delta from 0 to 4 (smallest)", 1.0,
                 float(determinant.min()), 1e-14),
    ]  # fmt: skip


def by_definition(phi: float) -> PatchIntegrals:
    """The five integrals as defined (eq. 4.3 to 4.5), by sums over 200 × 400 elements, any φ.

    Slow and rough (about 1e-4), but it knows of no symmetry and no range of φ.
    """
    radius = ((np.arange(200) + 0.5) / 200)[:, None]
    theta = (np.arange(400) + 0.5) / 400 * 2.0 * np.pi
    sine, cosine = np.sin(theta), np.cos(theta)
    alpha, beta = math.cos(phi), math.sin(phi)
    along, about = alpha - beta * radius * sine, beta * radius - alpha * sine
    element = radius / (200 * 200) / np.hypot(along, beta * radius * cosine)

    def mean(integrand: FloatArray) -> npt.NDArray[np.float64]:
        return np.asarray((integrand * element).sum())

    return PatchIntegrals(
        a=mean(along) / alpha, b=mean(beta * radius**2 * cosine**2) / beta,
        c=mean(along * radius * sine) / beta, d=mean(about * radius) / beta,
        e=mean(about * radius**2 * sine) / alpha,
    )  # fmt: skip


def symmetries(integrals: Integrals) -> list[Claim]:
    """Corollary 2 and the identity in eq. 4.5, against the definition and by quadrature."""
    angles = np.linspace(0.1, 1.5, 8)
    p = np.stack(integrals(angles))

    def off(image: Callable[[float], float]) -> float:
        defined = [np.stack(by_definition(image(phi))) for phi in angles.tolist()]
        return float(np.abs(np.stack(defined, axis=1) - p).max())

    independent = quadrature.integrals(PHI[::20])
    identity = np.abs(independent.c - independent.b + independent.d).max()
    return [
        equal("Cor. 2", "the p are even: definition at -phi less p(phi)", 0.0,
              off(lambda phi: -phi), 1e-4),
        equal("Cor. 2", "and pi-periodic: definition at phi + pi less p(phi)", 0.0,
              off(lambda phi: phi + math.pi), 1e-4),
        equal("eq. 4.5", "p_c = p_b - p_d, each by its own quadrature", 0.0, float(identity),
              1e-13),
    ]  # fmt: skip


def tilt(integrals: Integrals, phi: npt.ArrayLike, delta: npt.ArrayLike) -> FloatArray:
    """Relative tilt of the pressure; at 1 the pressure touches zero on the rim."""
    direction = slip_direction(phi)
    return pressure_tilt(moment_balance(integrals(phi), direction, delta), direction, delta)


def balance_determinant(
    integrals: Integrals, phi: npt.ArrayLike, delta: npt.ArrayLike
) -> FloatArray:
    """p_Δ = 1 − δ² sin²φ p_b p_c (eq. 5.2), read off ρ_∥ = p_a/p_Δ."""
    p = integrals(phi)
    return np.asarray(p.a / moment_balance(p, slip_direction(phi), delta).parallel)


def pressure_reserve(integrals: Integrals, phi: npt.ArrayLike, delta: npt.ArrayLike) -> FloatArray:
    """p_Δ² − δ² cos²φ p_a² (1 + δ² sin²φ p_b²), the function of Fig. 8.

    The pressure is nowhere negative where this is not (eq. 5.3): it is p_Δ² (1 − tilt²).
    """
    determinant = balance_determinant(integrals, phi, delta)
    reserve: FloatArray = determinant**2 * (1.0 - tilt(integrals, phi, delta) ** 2)
    return reserve


def positive_pressure(integrals: Integrals) -> list[Claim]:
    """Proposition 4: the pressure is nowhere negative exactly when δ ≤ 1.

    Away from its one zero, at φ = 0 and δ = 1, the reserve is a multiple of 1 − δ² + sin²φ.
    """
    phi, delta = PHI[:, None], HEIGHTS
    reserve = pressure_reserve(integrals, phi, delta)
    away = 1.0 - delta**2 + np.sin(phi) ** 2
    share = (reserve[away > 0.0] / away[away > 0.0]).min()
    beyond = (1.0 - tilt(integrals, 0.0, np.linspace(1.001, 4.0, 101))).max()
    return [
        at_least("Prop. 4", "pressure >= 0 if delta <= 1 (smallest of Fig. 8)", 0.0,
                 float(reserve.min()), 1e-14),
        more("Prop. 4", "zero only at delta = 1, phi = 0 (/(1 - delta^2 + sin^2))", 0.0,
             float(share)),
        equal("Prop. 4", "there it is zero at one point of the rim (tilt)", 1.0,
              float(tilt(integrals, 0.0, 1.0)), 1e-14),
        less("Prop. 4", "negative somewhere at phi = 0, delta >= 1.001 (largest)", 0.0,
             float(beyond)),
    ]  # fmt: skip


def critical_heights(integrals: Integrals) -> list[Claim]:
    """Section 5: up to which δ the pressure stays positive at φ = 0, π/4, π/2; and toppling.

    The paper's 1.1263 at π/4 solves (5.3) with sin²φ left out in front of p_b².
    """

    def condition(phi: float) -> float:
        return root(lambda delta: float(tilt(integrals, phi, delta)) - 1.0, 0.0, 2.0)

    quarter = 0.25 * math.pi
    p = integrals(quarter)

    def without_sine(delta: float) -> float:
        # tilt² = (δ cos φ ρ_∥)² (1 + δ² sin²φ p_b²); here without the sin²φ
        along = delta * math.cos(quarter) * float(p.a)
        determinant = float(balance_determinant(integrals, quarter, delta))
        return along * math.hypot(1.0, delta * float(p.b)) / determinant - 1.0

    # the load of a linear pressure acts at tilt r/4 from the centre (second moment of the disc)
    toppling = root(lambda delta: 0.25 * float(tilt(integrals, 0.0, delta)) - 1.0, 0.0, 10.0)
    return [
        equal("eq. 5.3", "critical delta at phi = 0", 1.0, condition(0.0), 1e-12),
        equal("eq. 5.3", "critical delta at phi = pi/4", 1.1263, condition(quarter), 5e-5,
              "1.1263...",
              erratum=f"(5.3) itself gives {condition(quarter):.4f}; what is printed is its root "
              "with the sin^2 phi in front of p_b^2 left out (next row)"),
        equal("eq. 5.3", "the same with sin^2 phi left out before p_b^2", 1.1263,
              root(without_sine, 0.0, 2.0), 5e-5, "1.1263..."),
        less("eq. 5.3", "no critical delta at pi/2 (tilt there at delta = 4)", 1.0,
             float(tilt(integrals, 0.5 * math.pi, 4.0))),
        equal("section 1", "delta at which a sliding puck topples", 4.0, toppling, 1e-12),
    ]  # fmt: skip


def pressure_laws() -> list[Claim]:
    """Section 3: how the limit ratio ε₀ = rω/v of a flat puck depends on where the load is.

    For δ = 0 it solves p_a = 2 p_d with the integrals weighted by the pressure law.
    """
    centre = PressureLaw("centre", lambda rho: (4.0 - 2.0 * rho**2) / 3.0)
    rim = PressureLaw("rim", lambda rho: (2.0 + 2.0 * rho**2) / 3.0)

    def ratio(law: PressureLaw) -> float:
        def excess(epsilon: float) -> float:
            p = quadrature.integrals(math.atan(epsilon), law)
            return float(p.a - 2.0 * p.d)

        return root(excess, 0.1, 50.0)

    return [
        more("section 3", "more load at the centre, ~ 2 - rho^2: limit ratio", 1.531,
             ratio(centre)),
        less("section 3", "more load at the rim, ~ 1 + rho^2: limit ratio", 1.531, ratio(rim)),
    ]  # fmt: skip
