"""Friction resultants, in closed form: the smallest and the most exact table is none."""

from __future__ import annotations

from math import cos, pi, sin, sqrt

from puck_tables.export.program.intrinsics import Out, room
from puck_tables.export.program.launch_motion import refused
from puck_tables.export.program.look_ups import TALLEST

MOST_STEPS = 9  # of the arithmetic-geometric mean, each of which doubles its digits
HALF_PI = 0.5 * pi  # of φ and θ: pure spin


def shape_integrals(ratio: float, fast: bool, p: Out) -> None:
    """p_a, p_b and p_d, by the arithmetic-geometric mean."""
    m: float = ratio * ratio
    m1: float = (1.0 - ratio) * (1.0 + ratio)
    geometric: float = sqrt(m1 + 1e-32)
    x: float = 1.0
    y: float = geometric
    mean: float = 0.5 + 0.5 * geometric
    geometric = sqrt(geometric)
    inverse: float = 1.0 / mean
    c_over_m: float = 0.25 * inverse
    c: float = m * c_over_m
    power: float = 2.0
    total: float = 2.0 * c_over_m * c_over_m
    rounds: int = 0
    while rounds < MOST_STEPS and mean - geometric > 1e-16 * mean:
        x_before: float = x
        x = x + y * inverse
        y = y + x_before * geometric
        mean_before: float = mean
        mean = 0.5 * (mean + geometric)
        geometric = sqrt(mean_before * geometric)
        inverse = 1.0 / mean
        c_over_m = 0.25 * c_over_m * c * inverse
        c = 0.25 * c * c * inverse
        power = 2.0 * power
        total = total + power * c_over_m * c_over_m
        rounds = rounds + 1
    k: float = HALF_PI * inverse
    b: float = 0.5 * HALF_PI * (x + y * inverse) * inverse / power
    g: float = k * total
    d: float = 0.5 * (k + m * g)
    m1_d: float = m1 * d
    factor: float = 0.5 * sqrt(1.0 + m) / HALF_PI
    p[0] = 4.0 / 3.0 * factor * (2.0 * b + m1_d)
    if fast:
        p[1] = factor * ((36.0 - 4.0 * m) * b + (24.0 - 8.0 * m) * m1_d) / 45.0
        p[2] = factor * ((12.0 - 4.0 * m) * b + (12.0 - 8.0 * m) * m1_d) / 9.0
    else:
        p[1] = factor * (36.0 * b + 12.0 * m1_d + 4.0 * (g - d)) / 45.0
        p[2] = factor * (12.0 * b + 4.0 * (g - d)) / 9.0


def resultants(phi: float, delta: float, out: Out) -> int:
    """rho_parallel, rho_perpendicular and rho_omega, into out[3].

    phi = atan2(r w, v) from -pi/2 to pi/2, delta = 2 f h / r from 0 to TALLEST.  Force on the puck
    -f N cos(phi) rho_parallel along its velocity and -f N sin(phi) cos(phi) rho_perpendicular to
    its left, torque -(f N r / 2) sin(phi) rho_omega.  Returns 0, or 1 and NaN where an argument is
    not in its range.
    """
    p = room(3)
    if not (abs(phi) <= HALF_PI and delta >= 0.0 and delta <= TALLEST):
        return refused(out, 3, 1)
    cosine: float = abs(cos(phi))
    sine: float = abs(sin(phi))
    fast: bool = sine > cosine
    shape_integrals(cosine / sine if fast else sine / cosine, fast, p)
    cos2: float = cosine * cosine
    sin2: float = sine * sine
    share: float = delta / TALLEST
    d2: float = share * share
    parallel: float = p[0] / (1.0 - d2 * sin2 * p[1] * (p[1] - p[2]))
    out[0] = parallel
    out[1] = share * parallel * p[1]
    out[2] = 2.0 * (p[2] + d2 * cos2 * parallel * p[1] * (p[2] - 2.0 * p[1]))
    return 0
