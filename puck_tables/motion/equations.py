"""The equations of motion in a variable that reaches the stop smoothly.

Scales: Q = hypot(v, rω), start value Q₀, deceleration J = fg.  With speeds in Q₀, times in Q₀/J,
lengths in Q₀²/J, body angle in Q₀²/(Jr), energies in mQ₀² and

    s = ln(Q₀/Q),   u = ln(r|ω|/v),   q = e^(−s),
    N = 1/(cos²φ + sin²φ ρ_ω/ρ_∥),   tan φ = e^u,

the equations (Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7) become

    du/ds = (1 − ρ_ω/ρ_∥) N                     log slip ratio
    dψ/ds = −sin φ (ρ_⊥/ρ_∥) N                  heading (ω > 0; the mirror image for ω < 0)
    dt/ds = q N/ρ_∥                             time
    dz/ds = q² cos φ e^{iψ} N/ρ_∥               position x + iy
    dθ/ds = q² sin φ N/ρ_∥                      body angle
    dl/ds = q² cos φ N/ρ_∥                      path length
    dW/ds = q² (cos²φ + ½ sin²φ ρ_ω/ρ_∥) N      work of friction.

The stop is s → ∞: Q = 0 is never stepped across.  u keeps all digits near pure sliding (−∞) and
pure spin (+∞), where it moves at constant rate.  Only the three friction ratios of the table are
needed, and one division.

State vector: u, ψ, t, x, y, θ, l, W.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables.kernels.closed_form import friction_ratios
from puck_tables.kernels.compile import inlined, kernel
from puck_tables.kernels.spline import evaluate_cut

FloatArray = npt.NDArray[np.float64]

SIZE = 8
U, PSI, T, X, Y, THETA, LENGTH, WORK = range(SIZE)


@inlined
def slip_ratio(u: float) -> tuple[float, bool, float, float]:
    """min(v, r|ω|)/max(v, r|ω|), whether r|ω| > v, cos φ and sin φ, from u = ln tan φ."""
    k = math.exp(-abs(u))
    large = 1.0 / math.sqrt(1.0 + k * k)
    if u > 0.0:
        return k, True, k * large, large
    return k, False, large, k * large


@inlined
def ratios_at(k: float, fast: bool, cut: FloatArray, delta: float) -> tuple[float, float, float]:
    """The friction ratios at a slip ratio: from a table cut at δ, or exact if it is empty."""
    if cut.size == 0:
        return friction_ratios(k, 1.0 if fast else 0.0, delta)
    eta = math.sqrt(math.sqrt((1.0 - k) / (1.0 + k)))
    inverse, across, spin = evaluate_cut(cut, 1 if fast else 0, eta)
    return inverse, (across if delta > 0.0 else 0.0), spin  # a flat puck goes exactly straight


@kernel
def derivatives(s: float, y: FloatArray, cut: FloatArray, delta: float, out: FloatArray) -> None:
    """d/ds of the state vector into ``out``."""
    k, fast, cosine, sine = slip_ratio(y[U])
    inverse, across, spin = ratios_at(k, fast, cut, delta)
    cos2, sin2 = cosine * cosine, sine * sine
    norm = 1.0 / (cos2 + sin2 * spin)
    q = math.exp(-s)
    rate = q * inverse * norm
    out[U] = (1.0 - spin) * norm
    out[PSI] = -sine * across * norm
    out[T] = rate
    rate *= q
    out[X] = rate * cosine * math.cos(y[PSI])
    out[Y] = rate * cosine * math.sin(y[PSI])
    out[THETA] = rate * sine
    out[LENGTH] = rate * cosine
    out[WORK] = q * q * (cos2 + 0.5 * sin2 * spin) * norm


@kernel
def at_constant_angle(
    s: float, y: FloatArray, s_new: float, cut: FloatArray, delta: float, out: FloatArray
) -> None:
    """The exact motion with u constant, from (s, y) to s_new ≥ s (inf: the stop) into ``out``.

    Exact for pure spin, pure translation and the limit motion; near the stop every motion is one.
    With c = dψ/ds, the position is ∫ q² e^{i(ψ + c s)} ds, a self-similar spiral.
    """
    k, fast, cosine, sine = slip_ratio(y[U])
    inverse, across, spin = ratios_at(k, fast, cut, delta)
    cos2, sin2 = cosine * cosine, sine * sine
    norm = 1.0 / (cos2 + sin2 * spin)
    turn = -sine * across * norm if cosine > 0.0 else 0.0  # a puck that stands has no heading
    fall = s_new - s
    q = math.exp(-s)
    once = -math.expm1(-fall)
    twice = -0.5 * math.expm1(-2.0 * fall)
    rest = math.exp(-2.0 * fall)
    angle = turn * fall if rest > 0.0 else 0.0
    out[U] = y[U]
    out[PSI] = y[PSI] + angle
    out[T] = y[T] + q * inverse * norm * once
    rate = q * q * inverse * norm
    # e^{iψ} (1 − rest e^{i angle}) / (2 − i turn)
    real = 1.0 - rest * math.cos(angle)
    imaginary = -rest * math.sin(angle)
    scale = rate * cosine / (4.0 + turn * turn)
    along = scale * (2.0 * real - turn * imaginary)
    left = scale * (2.0 * imaginary + turn * real)
    out[X] = y[X] + along * math.cos(y[PSI]) - left * math.sin(y[PSI])
    out[Y] = y[Y] + along * math.sin(y[PSI]) + left * math.cos(y[PSI])
    out[THETA] = y[THETA] + rate * sine * twice
    out[LENGTH] = y[LENGTH] + rate * cosine * twice
    out[WORK] = y[WORK] + q * q * (cos2 + 0.5 * sin2 * spin) * norm * twice


@inlined
def kinetic_energy(s: float, u: float) -> float:
    """½ (v² + ½ r²ω²) in units of Q₀²."""
    _, _, cosine, sine = slip_ratio(u)
    return 0.5 * math.exp(-2.0 * s) * (cosine * cosine + 0.5 * sine * sine)
