"""The equations of motion in a variable that reaches the stop smoothly.

Scales: Q = hypot(v, rω), start value Q₀, deceleration J = fg.  With speeds in Q₀, times in Q₀/J,
lengths in Q₀²/J, body angle in Q₀²/(Jr), energies in mQ₀² and

    q = Q/Q₀ = (1 − z)⁴,   u = ln(r|ω|/v),   tan φ = e^u,
    N = 4/[(1 − z) (cos²φ + sin²φ ρ_ω/ρ_∥)],

the equations (Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7) become

    du/dz = (1 − ρ_ω/ρ_∥) N                     log slip ratio
    dψ/dz = −sin φ (ρ_⊥/ρ_∥) N                  heading (ω > 0; the mirror image for ω < 0)
    dt/dz = q N/ρ_∥                             time
    dp/dz = q² cos φ e^{iψ} N/ρ_∥               position p = x + iy
    dθ/dz = q² sin φ N/ρ_∥                      body angle
    dl/dz = q² cos φ N/ρ_∥                      path length
    dW/dz = q² (cos²φ + ½ sin²φ ρ_ω/ρ_∥) N      work of friction.

The stop is z = 1, where Q = 0; the integration ends before it and is never stepped across.  The
fourth power makes the right-hand sides of time and place polynomial where φ is constant, which a
method of order 4 integrates almost exactly.  u keeps all digits near pure sliding (−∞) and pure
spin (+∞), where it moves at constant rate in ln Q.  Only the three friction ratios of the table
are needed, and one division.

That is a homogeneous puck.  With radius of gyration k about the vertical axis only the equation of
spin differs, r ω' = −(r²/2k²) J sin φ ρ_ω: then (r²/2k²) ρ_ω stands for ρ_ω, and in the work and
the kinetic energy k²/r² for ½.

Friction comes as a ``section``: the section of a table at one height, which carries its singular
lines and its inertia (:mod:`puck_tables.kernels.quadratic`); or, without rows, closed forms.

State vector: u, ψ, t, x, y, θ, l, W (:mod:`puck_tables.motion.state`).
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.closed_form_kernel import friction_ratios
from puck_tables.kernels.compile import inlined, kernel
from puck_tables.kernels.quadratic import INERTIA, LINE, section_ratios
from puck_tables.motion.state import LENGTH, PSI, THETA, WORK, T, U, X, Y


@inlined
def slip_ratio(u: float) -> tuple[float, bool, float, float]:
    """min(v, r|ω|)/max(v, r|ω|), whether r|ω| > v, cos φ and sin φ, from u = ln tan φ."""
    k = math.exp(-abs(u))
    large = 1.0 / math.sqrt(1.0 + k * k)
    if u > 0.0:
        return k, True, k * large, large
    return k, False, large, k * large


@inlined
def ratios_at(
    k: float, fast: bool, section: FloatArray, delta: float
) -> tuple[float, float, float]:
    """The friction ratios at a slip ratio: from a section, or exact if it is empty."""
    if section.shape[0] == 0:
        return friction_ratios(k, 1.0 if fast else 0.0, delta)
    inverse, across, spin = section_ratios(k, fast, section)
    return inverse, (across if delta > 0.0 else 0.0), spin  # a flat puck goes exactly straight


@inlined
def inertia(section: FloatArray) -> float:
    """The square of the radius of gyration over r."""
    return section[0, INERTIA] if section.shape[0] > 0 else 0.5


@inlined
def slowest_stop(section: FloatArray) -> float:
    """About the longest that any motion lasts, in units of Q/J: pure spin of much inertia, or 1."""
    return max(1.0, 2.0 * inertia(section))


@inlined
def crossed_line(u: float, new: float, section: FloatArray) -> tuple[bool, float]:
    """Whether a singular line lies strictly between u and ``new``, and the u of the first."""
    if section.shape[0] == 0:
        return u * new < 0.0, 0.0
    crossed, first = False, 0.0
    for row in range(0, section.shape[0], 2):
        line = section[row, LINE]
        between = (u - line) * (new - line) < 0.0
        if between and (not crossed or abs(line - u) < abs(first - u)):
            crossed, first = True, line
    return crossed, first


@inlined
def distance_to_line(u: float, section: FloatArray) -> float:
    """How far in u the nearest singular line is."""
    if section.shape[0] == 0:
        return abs(u)
    nearest = math.inf
    for row in range(0, section.shape[0], 2):
        nearest = min(nearest, abs(u - section[row, LINE]))
    return nearest


@kernel
def derivatives(
    z: float, y: FloatArray, section: FloatArray, delta: float, out: FloatArray
) -> None:
    """d/dz of the state vector into ``out``."""
    k, fast, cosine, sine = slip_ratio(y[U])
    inverse, across, spin = ratios_at(k, fast, section, delta)
    cos2, sin2 = cosine * cosine, sine * sine
    left = 1.0 - z
    q = left * left * left * left
    norm = 4.0 / (left * (cos2 + sin2 * spin))
    rate = q * inverse * norm
    out[U] = (1.0 - spin) * norm
    out[PSI] = -sine * across * norm
    out[T] = rate
    rate *= q
    out[X] = rate * cosine * math.cos(y[PSI])
    out[Y] = rate * cosine * math.sin(y[PSI])
    out[THETA] = rate * sine
    out[LENGTH] = rate * cosine
    out[WORK] = q * q * (cos2 + inertia(section) * sin2 * spin) * norm


@kernel
def at_constant_angle(
    q: float, y: FloatArray, q_new: float, section: FloatArray, delta: float, out: FloatArray
) -> None:
    """The exact motion with u constant, from (q, y) to q_new ≤ q (0: the stop) into ``out``.

    Exact for pure spin, pure translation and the limit motion; near the stop every motion is one.
    With c the turn for each factor e of Q, the position is ∫ q e^{i(ψ − c ln q)} dq, a self-similar
    spiral.
    """
    k, fast, cosine, sine = slip_ratio(y[U])
    inverse, across, spin = ratios_at(k, fast, section, delta)
    cos2, sin2 = cosine * cosine, sine * sine
    norm = 1.0 / (cos2 + sin2 * spin)
    turn = -sine * across * norm if cosine > 0.0 else 0.0  # a puck that stands has no heading
    ratio = q_new / q
    angle = -turn * math.log(ratio) if ratio > 0.0 else 0.0
    out[U] = y[U]
    out[PSI] = y[PSI] + angle
    out[T] = y[T] + (q - q_new) * inverse * norm
    rate = q * q * inverse * norm
    # e^{iψ} (1 − ratio² e^{i angle}) / (2 − i turn)
    real = 1.0 - ratio * ratio * math.cos(angle)
    imaginary = -ratio * ratio * math.sin(angle)
    scale = rate * cosine / (4.0 + turn * turn)
    along = scale * (2.0 * real - turn * imaginary)
    left = scale * (2.0 * imaginary + turn * real)
    out[X] = y[X] + along * math.cos(y[PSI]) - left * math.sin(y[PSI])
    out[Y] = y[Y] + along * math.sin(y[PSI]) + left * math.cos(y[PSI])
    half = 0.5 * (q - q_new) * (q + q_new)
    out[THETA] = y[THETA] + half * sine * inverse * norm
    out[LENGTH] = y[LENGTH] + half * cosine * inverse * norm
    out[WORK] = y[WORK] + half * (cos2 + inertia(section) * sin2 * spin) * norm


@inlined
def kinetic_energy(q: float, u: float, square: float) -> float:
    """½ (v² + k²ω²) in units of Q₀², ``square`` = k²/r²."""
    _, _, cosine, sine = slip_ratio(u)
    return 0.5 * q * q * (cosine * cosine + square * sine * sine)
