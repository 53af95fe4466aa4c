"""Friction of a pressed disc by chords through the centre of rotation: the judge's own quadrature.

On a chord through the centre of rotation C the slip has one direction e and grows like the distance
R from C, which the element R dR dt cancels: what is left is a polynomial along the chord and one
smooth integral over chords.  The pressure is W(ρ) max(0, a + b x + c y); a, b, c follow from the
load and the two moments of friction at half the height (δ = 2 f h/r), by going from one loaded
region to the next.  :func:`tabled` keeps the result as piecewise Chebyshev series in φ.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numba import njit

UNIFORM, HERTZ, RING = 0, 1, 2
LAWS = {"uniform": UNIFORM, "hertz": HERTZ, "ring": RING}
NODES = 16
_X, _W = np.polynomial.legendre.leggauss(24)
_FINE = 1e-14


@njit(cache=True)
def _chord(law, half, low, high, m):
    """∫ ξ^j w dξ for j = 0..3 over part of a chord of half length ``half``."""
    m[:] = 0.0
    if high <= low:
        return
    if law == UNIFORM:
        for j in range(4):
            m[j] = (high ** (j + 1) - low ** (j + 1)) / ((j + 1) * math.pi)
        return
    first = math.asin(max(-1.0, min(1.0, low / half)))
    last = math.asin(max(-1.0, min(1.0, high / half)))
    for i in range(len(_X)):
        a = 0.5 * (first + last) + 0.5 * (last - first) * _X[i]
        weight = 0.5 * (last - first) * _W[i] * 1.5 / math.pi * (half * math.cos(a)) ** 2
        xi = half * math.sin(a)
        for j in range(4):
            m[j] += weight * xi**j


@njit(cache=True)
def _loaded(g, p, ex, ey, dx, dy, half):
    """The part of a chord where a + b x + c y > 0."""
    constant = g[0] + p * (g[1] * ex + g[2] * ey)
    slope = g[1] * dx + g[2] * dy
    low, high = -half, half
    if slope > 0.0:
        low = max(low, -constant / slope)
    elif slope < 0.0:
        high = min(high, -constant / slope)
    elif constant <= 0.0:
        high = low
    return low, high


@njit(cache=True)
def _panels(ends, count, first, last, close):
    """Ascending ends of panels between breaks, ever shorter towards first and last."""
    out = np.empty(200)
    ends[count], ends[count + 1] = first, last
    count += 2
    step = 0.25 * (last - first)
    while step > 0.3 * close and count < 150:
        ends[count], ends[count + 1] = first + step, last - step
        count += 2
        step *= 0.5
    ordered = np.sort(ends[:count])
    n = 0
    for value in ordered:
        if first <= value <= last and (n == 0 or value > out[n - 1] + 1e-14):
            out[n] = value
            n += 1
    return out, n


@njit(cache=True)
def _rim(g):
    """Directions of the points of the rim where the pressure ends; none: count 0."""
    tilt = math.hypot(g[1], g[2])
    if tilt <= abs(g[0]):
        return 0, 0.0, 0.0
    way, open_half = math.atan2(g[2], g[1]), math.acos(-g[0] / tilt)
    return 2, way - open_half, way + open_half


@njit(cache=True)
def gathered(law, cosine, sine, g):
    """E (2, 3), T (3,): ∫ w e g_j and ∫ w (r × e) g_j over the loaded part, g = 1, x, y."""
    force, torque, m = np.zeros((2, 3)), np.zeros(3), np.empty(4)
    cut, one, two = _rim(g)
    ends = np.empty(200)
    if law == RING:
        # every point of the rim by itself
        count = 0
        if cut == 2:
            low, high = one, two
        else:
            low, high = -0.5 * math.pi, 1.5 * math.pi
        close = abs(cosine - sine)
        for turn in range(-1, 3):
            top = 0.5 * math.pi + 2.0 * math.pi * turn
            step = 0.5
            ends[count] = top
            count += 1
            while step > 0.2 * close and step > 1e-9 and count < 190:
                ends[count], ends[count + 1] = top - step, top + step
                count += 2
                step *= 0.4
            if count > 150:
                break
        out, n = _panels(ends, count, low, high, 1.0)
        for i in range(n - 1):
            for k in range(len(_X)):
                a = 0.5 * (out[i] + out[i + 1]) + 0.5 * (out[i + 1] - out[i]) * _X[k]
                weight = 0.5 * (out[i + 1] - out[i]) * _W[k] / (2.0 * math.pi)
                x, y = math.cos(a), math.sin(a)
                ux, uy = cosine - sine * y, sine * x
                size = math.hypot(ux, uy)
                if size == 0.0:
                    continue
                ex, ey = ux / size, uy / size
                for j in range(3):
                    part = weight * (1.0 if j == 0 else (x if j == 1 else y))
                    force[0, j] += part * ex
                    force[1, j] += part * ey
                    torque[j] += part * (x * ey - y * ex)
        return force, torque
    far = cosine >= sine  # C outside
    ratio = sine / cosine if far else cosine / sine
    close = math.sqrt(max(1.0 - ratio, 1e-16))
    count = 0
    if cut == 2:
        for i in range(2):
            a = one if i == 0 else two
            px, py = math.cos(a), math.sin(a)
            if far:  # p = sin q of the chord through the point: p c' + ... solved by its direction
                # direction from C = (0, 1/ratio) to the point, in units where ratio may be 0
                vx, vy = ratio * px, ratio * py - 1.0
                size = math.hypot(vx, vy)
                # d = (p k, −c): p = vx/(k size); for k → 0 p = px
                p = px / size if ratio > 0.0 else px
                if abs(p) < 1.0:
                    ends[count] = math.asin(p)
                    count += 1
            else:
                t = math.atan2(py - ratio, px)
                ends[count] = t if t >= 0.0 else t + math.pi
                count += 1
        if not far:
            t = math.atan2(g[1], -g[2])  # chords along the end of the load
            ends[count] = t if t >= 0.0 else t + math.pi
            count += 1
    first, last = (-0.5 * math.pi, 0.5 * math.pi) if far else (0.0, math.pi)
    out, n = _panels(ends, count, first, last, close)
    for i in range(n - 1):
        for k in range(len(_X)):
            q = 0.5 * (out[i] + out[i + 1]) + 0.5 * (out[i + 1] - out[i]) * _X[k]
            weight = 0.5 * (out[i + 1] - out[i]) * _W[k]
            if far:
                p, half = math.sin(q), math.cos(q)
                c = math.sqrt(max(1.0 - (ratio * p) ** 2, 0.0))
                ex, ey, dx, dy = c, p * ratio, p * ratio, -c
                weight *= half
                base, lean = 1.0, ratio / c
            else:
                ex, ey, dx, dy = -math.sin(q), math.cos(q), math.cos(q), math.sin(q)
                p = ratio * dx
                half = math.sqrt(1.0 - p * p)
                base, lean = -ratio * dy, 1.0
            low, high = _loaded(g, p, ex, ey, dx, dy, half)
            _chord(law, half, low, high, m)
            # factor (base + lean ξ) of dp or dt; g_j = at foot + ξ d_j
            for j in range(3):
                foot = 1.0 if j == 0 else (p * ex if j == 1 else p * ey)
                way = 0.0 if j == 0 else (dx if j == 1 else dy)
                push = base * (foot * m[0] + way * m[1]) + lean * (foot * m[1] + way * m[2])
                turn = base * (foot * m[1] + way * m[2]) + lean * (foot * m[2] + way * m[3])
                force[0, j] += weight * push * ex
                force[1, j] += weight * push * ey
                torque[j] += weight * turn
    return force, torque


@njit(cache=True)
def moments(law, g):
    """S (3, 3): ∫ w g_i g_j over the loaded part."""
    s = np.zeros((3, 3))
    if _rim(g)[0] == 0:
        second = 0.25 if law == UNIFORM else (0.2 if law == HERTZ else 0.5)
        s[0, 0], s[1, 1], s[2, 2] = 1.0, second, second
        return s
    tilt = math.hypot(g[1], g[2])
    cx, cy = g[1] / tilt, g[2] / tilt
    reach = math.acos(-g[0] / tilt)  # ζ = cos a, a in (0, reach)
    for i in range(4):
        for k in range(len(_X)):
            a = 0.25 * reach * (i + 0.5 + 0.5 * _X[k])
            weight = 0.125 * reach * _W[k]
            z, h = math.cos(a), math.sin(a)
            if law == UNIFORM:
                w0, w2 = 2.0 * h * h / math.pi, 2.0 / 3.0 * h**4 / math.pi
            elif law == HERTZ:
                w0, w2 = 0.75 * h**3, 1.5 / 8.0 * h**5
            else:
                w0, w2 = 1.0 / math.pi, h * h / math.pi
            w0, w2 = weight * w0, weight * w2
            x, y = z * cx, z * cy
            s[0, 0] += w0
            s[0, 1] += w0 * x
            s[0, 2] += w0 * y
            s[1, 1] += w0 * x * x + w2 * cy * cy
            s[2, 2] += w0 * y * y + w2 * cx * cx
            s[1, 2] += w0 * x * y - w2 * cx * cy
    s[1, 0], s[2, 0], s[2, 1] = s[0, 1], s[0, 2], s[1, 2]
    return s


def resultants(law, delta, phi):
    """∫σ e_x, ∫σ e_y, ∫σ r × e for f N = r = 1, the slip along x, 0 ≤ φ ≤ π/2; and the misfit."""
    cosine, sine = math.cos(phi), math.sin(phi)
    g = np.array([1.0, 0.0, 0.0])
    matrix, right = np.empty((3, 3)), np.array([1.0, 0.0, 0.0])
    change = 1.0
    force, torque = gathered(law, cosine, sine, g)
    if delta > 0.0:
        share = 1.0
        for again in range(200):
            s = moments(law, g)
            force, torque = gathered(law, cosine, sine, g)
            for j in range(3):
                matrix[0, j] = s[0, j]
                matrix[1, j] = s[1, j] - 0.25 * delta * force[0, j]
                matrix[2, j] = s[2, j] - 0.25 * delta * force[1, j]
            better = np.linalg.solve(matrix, right)
            change = np.max(np.abs(better - g)) / np.max(np.abs(better))
            if again > 30:
                share = 0.5
            g = g + share * (better - g)
            if change < 1e-15:
                break
        force, torque = gathered(law, cosine, sine, g)
    else:
        change = 0.0
    return force[0] @ g, force[1] @ g, torque @ g, change


def ratios(law: int, delta: float, phi: float) -> tuple[np.ndarray, float]:
    """F_∥/cos φ, F_⊥/(sin φ cos φ), M/sin φ of f N = r = 1, and the misfit."""
    ahead, left, torque, miss = resultants(law, delta, phi)
    c, s = math.cos(phi), math.sin(phi)
    return np.array([ahead / c, left / (s * c), torque / s]), miss


_ANGLES = (np.arange(NODES) + 0.5) * math.pi / NODES
_COSINES = np.cos(_ANGLES)
_TRANSFORM = 2.0 / NODES * np.cos(np.outer(np.arange(NODES), _ANGLES))
_TRANSFORM[0] *= 0.5


@lru_cache(maxsize=256)
def tabled(pressure: str, delta: float) -> tuple[np.ndarray, np.ndarray]:
    """Ends of panels in φ (n + 1,), and Chebyshev coefficients (n, 3, 16) of :func:`ratios`."""
    law = LAWS[pressure]
    found: list[tuple[float, float, np.ndarray]] = []
    pending = [(0.25 * math.pi, 0.5 * math.pi), (0.0, 0.25 * math.pi)]
    while pending:
        low, high = pending.pop()
        phis = 0.5 * (low + high) + 0.5 * (high - low) * _COSINES
        values = []
        for phi in phis:
            ratio, miss = ratios(law, delta, phi)
            if not miss < 1e-11:
                raise ValueError(f"no balance at δ = {delta}, φ = {phi}: {miss:g}")
            values.append(ratio)
        series = (_TRANSFORM @ np.array(values)).T
        tail = np.max(np.abs(series[:, -3:]))
        if tail > _FINE * max(1.0, np.max(np.abs(series))) * 30 and high - low > 2e-6:
            middle = 0.5 * (low + high)
            pending += [(middle, high), (low, middle)]
        else:
            found.append((low, high, series))
    found.sort(key=lambda panel: panel[0])
    return (
        np.array([panel[0] for panel in found] + [0.5 * math.pi]),
        np.array([panel[2] for panel in found]),
    )


@njit(cache=True)
def tabled_friction(ends, series, count, ux, uy, rim, out):
    """Force and torque over f N and r, at relative velocity u and rim speed r ω; into ``out``."""
    speed = math.hypot(ux, uy)
    q = math.hypot(speed, rim)
    if q == 0.0:
        out[0], out[1], out[2] = 0.0, 0.0, 0.0
        return
    phi = math.atan2(abs(rim), speed)
    low, high = 0, count
    while high - low > 1:
        middle = (low + high) // 2
        if phi < ends[middle]:
            high = middle
        else:
            low = middle
    x = 2.0 * (2.0 * phi - ends[low] - ends[low + 1]) / (ends[low + 1] - ends[low])
    c = series[low]
    p1, p2, q1, q2, r1, r2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(NODES - 1, 0, -1):
        p1, p2 = c[0, j] + x * p1 - p2, p1
        q1, q2 = c[1, j] + x * q1 - q2, q1
        r1, r2 = c[2, j] + x * r1 - r2, r1
    along = c[0, 0] + 0.5 * x * p1 - p2
    across = c[1, 0] + 0.5 * x * q1 - q2
    turning = c[2, 0] + 0.5 * x * r1 - r2
    ex, ey, sine = ux / q, uy / q, rim / q
    out[0] = -along * ex + across * sine * ey
    out[1] = -along * ey - across * sine * ex
    out[2] = -turning * sine
