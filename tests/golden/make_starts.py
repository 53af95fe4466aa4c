"""Where and when 2000 adversarial launches stop, to 1e-13; and 1000 others that the program ships.

    python tests/golden/make_starts.py

writes ``tests/golden/starts.npz`` and ``tables/starts.npz`` (other seed, other heights): arrays
``u`` = ln(rω/v), ``delta``, and T, X, Y in units of Q/J and Q²/J, Q = hypot(v, rω), launched along
x.  Nothing of the program is used.

Along every motion, with s = −ln Q and the friction ratios σ = ρ_ω/ρ_∥, ρ_⊥/ρ_∥, 1/ρ_∥,

    ds = (c² + s²σ)/(1 − σ) du,   T = ∫ e^(−s) ds / [ρ_∥ (c² + s²σ)],
    X + iY = ∫ e^(−2s + iψ) cos φ ds / [ρ_∥ (c² + s²σ)],   dψ = −sin φ (ρ_⊥/ρ_∥) ds/(c² + s²σ)

(Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7), where u runs to u₀, σ(u₀) = 1.  The friction
comes from the textbook combinations of elliptic integrals, at 80 digits and more for those that
cancel; the integrals are Gauss–Legendre on panels halved towards u = 0 (φ = π/4), in u
away from u₀ and in −ln|u − u₀| near it, summed backwards from the stop:
T_a = ∫_a^b + e^(−(s_b − s_a)) T_b.
"""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import numpy as np
from mpmath import mp, mpf

HERE = Path(__file__).resolve().parent
TARGETS = (
    (HERE / "starts.npz", 2012, 40),
    (HERE.parent.parent / "tables" / "starts.npz", 1960, 20),
)
PER_HEIGHT = 50
SPECIAL_HEIGHTS = (0.0, 1e-9, 0.02, 0.5, 0.98, 1.0 - 2.0**-53, 1.0)
FAR = 40.0  # beyond it a start is pure sliding or pure spin to rounding

NODES = 16
X, W = np.polynomial.legendre.leggauss(NODES)
_VANDERMONDE = np.polynomial.legendre.legvander(X, NODES - 1)
_UP_TO = np.stack(
    [
        np.polynomial.legendre.legval(X, np.polynomial.legendre.legint(row, lbnd=-1))
        for row in np.eye(NODES)
    ],
    axis=-1,
)
RUNNING = _UP_TO @ np.linalg.inv(_VANDERMONDE)  # values at the nodes → integrals from −1 to them


def ratios(u, delta):
    """cos φ, sin φ, 1/ρ_∥, ρ_⊥/ρ_∥, ρ_ω/ρ_∥ at u = ln tan φ."""
    s = mp.exp(-u)
    sine = 1 / mp.sqrt(1 + s * s)
    cosine = s * sine
    if s == 1:
        E, K = mpf(1), mpf(0)  # K is multiplied by zero there
    elif s < 1:
        E, K = mp.ellipe(s * s), mp.ellipk(s * s)
    else:
        E, K = mp.ellipe(1 / s**2), mp.ellipk(1 / s**2)
    if s <= 1:
        a = mpf(4) / 3 * ((s + 1 / s) * E + (s - 1 / s) * K)
        b = mpf(4) / 45 * ((7 - 2 * s**2 + 3 / s**2) * E + (2 + s**2 - 3 / s**2) * K)
        d = mpf(4) / 9 * ((4 - 2 * s**2) * E + (s**2 - 1) * K)
    else:
        a = mpf(4) / 3 * ((1 + s**2) * E + (1 - s**2) * K)
        b = mpf(4) / 45 * ((7 * s - 2 * s**3 + 3 / s) * E + (-8 * s + 2 * s**3 + 6 / s) * K)
        d = mpf(4) / 9 * ((4 * s - 2 * s**3) * E + (-5 * s + 2 * s**3 + 3 / s) * K)
    a, b, d = a / (mp.pi * cosine), b / (mp.pi * sine), d / (mp.pi * sine)
    inverse = (1 - delta**2 * sine**2 * b * (b - d)) / a
    spin = 2 * (d * inverse + delta**2 * cosine**2 * b * (d - 2 * b))
    return cosine, sine, inverse, delta * b, spin


def digits(u):
    """Set the working precision for a friction at u."""
    mp.dps = 80 + int(2 * abs(u))


def limit(delta):
    """u₀ where ρ_ω = ρ_∥."""
    mp.dps = 80
    return mp.findroot(lambda u: ratios(u, delta)[4] - 1, (mpf("0.38"), mpf("0.44")))


def breaks(starts, u0, side):
    """Ends of panels in x, u = u0 + side·(x for x ≥ 1, e^(x − 1) below), descending to the stop."""
    distance = np.abs(starts - u0)
    x = np.where(distance >= 1.0, distance, 1.0 + np.log(distance))
    crossing = 1.0 + math.log(u0) if side < 0 else -math.inf  # where u = 0
    grid = [1.0, *np.arange(1.0, FAR + 2.0, 0.7), *np.arange(1.0, -80.0, -0.7)]
    if side < 0:
        grid += [crossing, *(crossing + sign * 0.5**k for sign in (1, -1) for k in range(1, 24))]
    return np.unique(np.concatenate([x, np.array(grid)]))[::-1], x


def panel_functions(high, low, u0, side, delta):
    """At the Gauss nodes from high to low: ds/dx, and by s: T's and Z's rate, ψ's rate, cos φ."""
    out = np.empty((4, NODES))
    for i, node in enumerate(X):
        mp.dps = 80
        x = (mpf(float(high)) + mpf(float(low))) / 2 - (
            mpf(float(high)) - mpf(float(low))
        ) / 2 * mpf(float(node))
        gap = x if high > 1.0 else mp.exp(x - 1)
        u = u0 + side * gap
        digits(float(u))
        cosine, sine, inverse, across, spin = ratios(u, delta)
        norm = cosine**2 + sine**2 * spin
        speed = norm / (1 - spin) * -side  # −ds/du · side: s grows while the gap falls
        out[0, i] = speed if high > 1.0 else speed * gap
        out[1, i] = inverse / norm
        out[2, i] = -sine * across / norm
        out[3, i] = cosine
    return out


def stops(starts, delta):
    """T, X, Y (n, 3) of launches at u = starts and one height."""
    height = mpf(float(delta))
    u0 = limit(height)
    out = np.empty((len(starts), 3))
    pure = np.abs(starts) > FAR
    out[pure] = np.where(starts[pure, None] < 0.0, [1.0, 0.5, 0.0], [0.75, 0.0, 0.0])
    for side in (-1, 1):
        chosen = np.flatnonzero(~pure & (np.sign(starts - float(u0)) == side))
        ends, places = breaks(starts[chosen], float(u0), side)
        time, place = 1.0, 0.5 + 0.0j  # at the last end anything will do
        known = {}
        for low, high in itertools.pairwise(ends[::-1]):
            half = 0.5 * (high - low)
            rate, a, turn, cosine = panel_functions(high, low, u0, side, height)
            s, psi = half * RUNNING @ rate, half * RUNNING @ (turn * rate)
            whole, turned = half * W @ rate, half * W @ (turn * rate)
            weight = half * W * rate * a
            time = weight @ np.exp(-s) + math.exp(-whole) * time
            place = (
                weight @ (np.exp(-2 * s + 1j * psi) * cosine)
                + np.exp(-2 * whole + 1j * turned) * place
            )
            known[high] = time, place.real, place.imag
        for row, x in zip(chosen, places, strict=True):
            out[row] = known[x]
    return out


def heights(rng, count):
    """Heights: the special ones and random ones."""
    return np.concatenate([SPECIAL_HEIGHTS, rng.random(count - len(SPECIAL_HEIGHTS))])


def launches(rng, u0):
    """Slip ratios: ends, both sides of φ = π/4 and of the limit ratio, and random ones."""
    near = 10.0 ** -rng.uniform(0.5, 12.0, 5)
    limit_near = 10.0 ** -rng.uniform(0.5, 12.0, 3)
    return np.concatenate([
        [-math.inf, math.inf, 0.0], near, -near, u0 + limit_near, u0 - limit_near,
        rng.uniform(-FAR, FAR, 11), rng.normal(scale=2.0, size=PER_HEIGHT - 30),
    ])  # fmt: skip


def table(seed, count, only=None):
    """All launches of a seed, or those of some heights only: u, delta, T, X, Y, each (n,)."""
    rng = np.random.default_rng(seed)
    rows = []
    for number, delta in enumerate(heights(rng, count)):
        u = launches(rng, float(limit(mpf(float(delta)))))
        if only is None or number in only:
            rows.append(np.column_stack([u, np.full(len(u), delta), stops(u, delta)]))
    return dict(zip(("u", "delta", "T", "X", "Y"), np.concatenate(rows).T, strict=True))


if __name__ == "__main__":
    for path, seed, count in TARGETS:
        np.savez_compressed(path, **table(seed, count))
        print(path.name, path.stat().st_size, "bytes")
