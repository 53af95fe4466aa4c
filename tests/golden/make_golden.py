"""Golden values of the contact integrals and the friction resultants, at 32 digits, by mpmath.

Usage, from anywhere (about 25 seconds, needs mpmath only; nothing of puck_tables is imported):

    python tests/golden/make_golden.py            # verify itself, write resultants.json next to it
    python tests/golden/make_golden.py FILE.json  # the same, another file

Seeded and deterministic: a second run writes the same bytes.  tests/test_golden_script.py repeats
it without the slow part of the verification.

What is computed, for a flat puck under uniform pressure (Salnikova, Treschev, Gallyamov 2012,
eq. 4.3-4.6, 5.2 and section 6): the integrals p_a ... p_e by complete elliptic integrals in the
modulus min(cot φ, tan φ), the resultants by the moment balance, and the limit angle φ₀(δ), the
root of ρ_∥ = ρ_ω.

How far it may be trusted:

* the inputs are exact doubles, written as hexadecimal strings;
* the elliptic formulas cancel: towards φ = 0 the terms of p_e are of order s⁴ and those of p_c of
  order s³ against a result of order s⁻³ (s = cot φ), towards π/2 those of p_c and p_e of order s⁻²
  and s⁻¹ against 1 and s³.  So the working precision is 60 digits + 8 |log10 s|, which leaves 60
  good ones everywhere and makes series or limit values needless even at φ = 5e-324 (2650 digits);
* everything is computed twice, the second time with 40 % more digits, and must agree to 45 digits;
* p_c = p_b - p_d and p_e = p_d - 2 p_b, all five computed on their own, must hold to 45 digits;
* at the angles of VERIFIED the defining double integrals over the disc, by mpmath's quad, must
  agree with the elliptic formulas to 1e-17, and so must the resultants with those got from these
  integrals by solving the two moment equations themselves.

File: {"digits", "angles": [{"phi", "p": {"a" ... "e"}, "resultants": [{"delta", "parallel",
"perpendicular", "spin"}, ...]}, ...], "limit_angles": [{"delta", "phi"}, ...]}; "phi" and "delta"
of the inputs are float.fromhex strings, every result is a decimal string.
"""

from __future__ import annotations

import json
import math
import random
import sys
from functools import cache
from pathlib import Path
from typing import Any

from mpmath import mp, mpf

DIGITS = 32
AGREEMENT = mpf(10) ** -45
SEED = 2012
RANDOM_ANGLES = 60
SPECIAL_DELTAS = [0.0, 5e-324, 1e-8, 0.3, 0.5, 1.0 - 2.0**-53, 1.0]
LIMIT_DELTAS = [0.0, 0.25, 0.5, 0.75, 1.0]
VERIFIED = [0.05, 0.2, 0.55, 0.75, 0.85, 1.0, 1.1, 1.4, 1.55]  # on both sides of π/4
VERIFY_TOLERANCE = mpf(10) ** -17
NAMES = "abcde"

Integrals = dict[str, Any]


def angles() -> list[float]:
    """Every φ of the file: the points where double precision is hardest, then random ones."""
    quarter, half = 0.25 * math.pi, 0.5 * math.pi
    near = [10.0**-n for n in range(2, 17)]
    corners = [0.0, 5e-324, 1e-300, 1e-100, 1e-16, 1e-8, 1e-3]
    corners += [quarter, math.nextafter(quarter, 0.0), math.nextafter(quarter, 1.0)]
    corners += [quarter - gap for gap in near] + [quarter + gap for gap in near]
    corners += [half, math.nextafter(half, 0.0)] + [half - gap for gap in near]
    rng = random.Random(SEED)
    points = [sign * phi for phi in corners for sign in (1.0, -1.0)]
    points += [rng.uniform(-half, half) for _ in range(RANDOM_ANGLES)]
    return list(dict.fromkeys(points))  # once each; 0.0 and -0.0 count as one


def working_digits(phi: float) -> int:
    """Decimal digits that leave 60 good ones after the cancellation towards 0 and π/2."""
    mp.dps = 30
    return 60 + int(8 * abs(mp.log10(mp.cot(abs(mpf(phi))))))


def elliptic(phi: float, digits: int) -> Integrals:
    """p_a ... p_e at the exact double ``phi``, all five on their own.

    The closed forms are those of the integrals I_a = α p_a, I_b = β p_b, I_c = β p_c, I_d = β p_d,
    I_e = α p_e with α = cos φ, β = sin φ; s = cot φ = v/(rω).
    """
    quarter = mpf(1) / 4
    if phi == 0.0:  # s = ∞; the limits of the formulas for s > 1
        return dict(zip(NAMES, (mpf(1), quarter, mpf(0), quarter, -quarter), strict=True))
    mp.dps = digits
    angle = abs(mpf(phi))  # the integrals are even
    alpha, beta = mp.cos(angle), mp.sin(angle)
    s = alpha / beta
    m = s**2 if s < 1 else 1 / s**2
    E, K = mp.ellipe(m), mp.ellipk(m)
    if s < 1:  # the instantaneous centre of rotation lies inside the disc
        a = mpf(4) / 3 * ((s + 1 / s) * E + (s - 1 / s) * K)
        b = mpf(4) / 45 * ((7 - 2 * s**2 + 3 / s**2) * E + (2 + s**2 - 3 / s**2) * K)
        c = mpf(4) / 45 * ((-13 + 8 * s**2 + 3 / s**2) * E + (7 - 4 * s**2 - 3 / s**2) * K)
        d = mpf(4) / 9 * ((4 - 2 * s**2) * E + (s**2 - 1) * K)
        e = mpf(4) / 15 * ((-2 * s**3 + 2 * s - 2 / s) * E + (s**3 - 3 * s + 2 / s) * K)
    else:
        a = mpf(4) / 3 * ((1 + s**2) * E + (1 - s**2) * K)
        b = mpf(4) / 45 * ((7 * s - 2 * s**3 + 3 / s) * E + (-8 * s + 2 * s**3 + 6 / s) * K)
        c = mpf(4) / 45 * ((-13 * s + 8 * s**3 + 3 / s) * E + (17 * s - 8 * s**3 - 9 / s) * K)
        d = mpf(4) / 9 * ((4 * s - 2 * s**3) * E + (-5 * s + 2 * s**3 + 3 / s) * K)
        e = mpf(4) / 15 * ((-2 + 2 * s**2 - 2 * s**4) * E + (1 - 3 * s**2 + 2 * s**4) * K)
    along, around = mp.pi * alpha, mp.pi * beta
    return {"a": a / along, "b": b / around, "c": c / around, "d": d / around, "e": e / along}


@cache
def integrals(phi: float) -> Integrals:
    """p_a ... p_e at the exact double ``phi``, confirmed at a second precision."""
    digits = working_digits(phi) if phi else 60
    p = elliptic(phi, digits)
    finer = elliptic(phi, digits + digits * 2 // 5)
    for name in NAMES:  # p_c and p_e vanish at one end: relative to their own size
        assert abs(p[name] - finer[name]) <= AGREEMENT * abs(finer[name]), (phi, name)
    assert abs(p["b"] - p["d"] - p["c"]) <= AGREEMENT, phi
    assert abs(p["d"] - 2 * p["b"] - p["e"]) <= AGREEMENT, phi
    return p


def resultants(phi: Any, p: Integrals, delta: Any) -> tuple[Any, Any, Any]:
    """ρ_∥, ρ_⊥, ρ_ω by the moment balance of full contact, at the working precision set."""
    height = mpf(delta)
    denominator = 1 - height**2 * mp.sin(mpf(phi)) ** 2 * p["b"] * p["c"]
    parallel = p["a"] / denominator
    tilt = height**2 * mp.cos(mpf(phi)) ** 2 * p["a"] * p["b"] * p["e"] / denominator
    return parallel, height * p["b"] * parallel, 2 * (p["d"] + tilt)


def limit_angle(delta: float) -> Any:
    """φ₀(δ), where ρ_∥ = ρ_ω; a root near 1, the interior attractor of every motion."""
    mp.dps = 60

    def gap(phi: Any) -> Any:
        parallel, _, spin = resultants(phi, elliptic(phi, 60), delta)
        return parallel - spin

    root = mp.findroot(gap, (mpf("0.9"), mpf("1.1")), solver="anderson", tol=mpf(10) ** -100)
    step = mpf(10) ** -40
    assert gap(root - step) > 0 > gap(root + step), delta
    return root


def by_definition(phi: float) -> Integrals:
    """p_a ... p_e by the defining double integrals over the disc.

    The integrands depend on θ through sin θ alone, so the half disc |θ| ≤ π/2 counts twice.  They
    are bounded and jump at the instantaneous centre ρ = cot φ, θ = π/2 only; when that lies in the
    disc it is made a corner of the pieces, where the nodes of the tanh-sinh rule pile up.
    """
    mp.dps = 20
    alpha, beta = mp.cos(mpf(phi)), mp.sin(mpf(phi))
    trigonometry = cache(lambda theta: (mp.sin(theta), mp.cos(theta)))
    centre = alpha / beta
    radii = [0, centre, 1] if centre < 1 else [0, 1]

    def half_disc(name: str) -> Any:
        def integrand(rho: Any, theta: Any) -> Any:
            sine, cosine = trigonometry(theta)
            along, across = alpha - beta * rho * sine, beta * rho - alpha * sine
            # w² = β²ρ² − 2αβρ sin θ + α², as a sum of squares
            w = mp.sqrt(across**2 + (alpha * cosine) ** 2)
            if name == "a":
                value = along
            elif name == "b":
                value = beta * (rho * cosine) ** 2
            elif name == "c":
                value = along * rho * sine
            elif name == "d":
                value = across * rho
            else:
                value = across * rho**2 * sine
            return value / w * rho

        return mp.quad(integrand, radii, [-mp.pi / 2, mp.pi / 2])

    divisor = {"a": alpha, "b": beta, "c": beta, "d": beta, "e": alpha}
    return {name: 2 * half_disc(name) / (mp.pi * divisor[name]) for name in NAMES}


def by_moments(phi: float, p: Integrals, delta: float) -> tuple[Any, Any, Any]:
    """ρ_∥, ρ_⊥, ρ_ω from the moment equations as they stand, without eliminating anything.

    Pressure (1 + b̂x + ĉy)/π, forces F in units fN and torque M in units fNr:
    F_∥ = α p_a + ĉ β p_c, F_⊥ = b̂ β p_b, M = β p_d + ĉ α p_e, b̂ = δ F_∥, ĉ = δ F_⊥.
    """
    alpha, beta, height = mp.cos(mpf(phi)), mp.sin(mpf(phi)), mpf(delta)
    matrix = mp.matrix([[1, -height * beta * p["c"]], [-height * beta * p["b"], 1]])
    b_hat, c_hat = mp.lu_solve(matrix, mp.matrix([height * alpha * p["a"], 0]))
    parallel = p["a"] + c_hat * beta * p["c"] / alpha
    perpendicular = b_hat * p["b"] / alpha
    return parallel, perpendicular, 2 * (p["d"] + c_hat * alpha * p["e"] / beta)


def verify() -> Any:
    """The largest distance between the formulas and the definitions; asserted."""
    worst = mpf(0)
    for phi in VERIFIED:
        p, direct = integrals(phi), by_definition(phi)
        mp.dps = 30
        off = max(abs(p[name] - direct[name]) for name in NAMES)
        for delta in (0.3, 1.0):
            pairs = zip(resultants(phi, p, delta), by_moments(phi, direct, delta), strict=True)
            off = max(off, *(abs(one - other) for one, other in pairs))
        print(f"definitions at phi = {phi}: largest difference {mp.nstr(off, 3)}", flush=True)
        assert off <= VERIFY_TOLERANCE, (phi, off)
        worst = max(worst, off)
    return worst


def golden() -> dict[str, Any]:
    """The content of the file."""
    rng = random.Random(SEED + 1)

    def text(value: Any) -> str:
        return str(mp.nstr(value, DIGITS, min_fixed=-5, max_fixed=5))

    entries = []
    points = angles()
    for number, phi in enumerate(points):
        p = integrals(phi)
        corner = number < len(points) - RANDOM_ANGLES
        if corner and math.copysign(1.0, phi) > 0.0:
            deltas = [*SPECIAL_DELTAS, rng.random()]
        else:
            deltas = [rng.choice(SPECIAL_DELTAS), rng.random()]
        mp.dps = 80
        rows = []
        for delta in deltas:
            rho = map(text, resultants(phi, p, delta))
            named = dict(zip(("parallel", "perpendicular", "spin"), rho, strict=True))
            rows.append({"delta": delta.hex(), **named})
        entries.append(
            {"phi": phi.hex(), "p": {name: text(p[name]) for name in NAMES}, "resultants": rows}
        )
    limits = [{"delta": delta.hex(), "phi": text(limit_angle(delta))} for delta in LIMIT_DELTAS]
    return {"digits": DIGITS, "angles": entries, "limit_angles": limits}


def as_text(content: dict[str, Any]) -> str:
    """The file's text: one line per integral set and per resultant, so that a diff can be read."""
    lines = []
    for entry in content["angles"]:
        rows = ",\n   ".join(json.dumps(row) for row in entry["resultants"])
        lines.append(
            f'  {{"phi": {json.dumps(entry["phi"])}, "p": {json.dumps(entry["p"])},\n'
            f'   "resultants": [\n   {rows}]}}'
        )
    limits = ",\n".join("  " + json.dumps(row) for row in content["limit_angles"])
    return (
        f'{{"digits": {content["digits"]},\n "angles": [\n' + ",\n".join(lines)
        + f'],\n "limit_angles": [\n{limits}]}}\n'
    )  # fmt: skip


def main() -> None:
    """Verify, compute, write."""
    target = Path(__file__).with_name("resultants.json")
    if len(sys.argv) > 1:
        target = Path(sys.argv[1])
    worst = verify()
    content = golden()
    target.write_text(as_text(content), encoding="utf-8", newline="\n")
    rows = sum(len(entry["resultants"]) for entry in content["angles"])
    print(
        f"{target}: {len(content['angles'])} angles, {rows} resultants; "
        f"formulas within {mp.nstr(worst, 3)} of the definitions"
    )


if __name__ == "__main__":
    main()
