"""Logarithm, exponential, sine, cosine and angle that loops can do for several numbers at once.

Those of the machine's library are called for one number at a time, which costs more than all the
rest of a look-up.  These are sums and products alone, with errors of some 1e-16 of the value (of 1
for sine and cosine); what they take is said with each.
"""

from __future__ import annotations

from puck_tables.kernels.compile import bits_of, inlined, number_of

_SHIFT = 6755399441055744.0  # 1.5 × 2⁵²: a number added to it is rounded to an integer
_SHIFT_BITS = 0x4338000000000000  # bits of the number above
_HALF_ROOT = 0x3FE6A09E667F3BCD  # bits of √½
_ONE = 0x3FF0000000000000  # bits of 1.0
# ln 2 in two parts: the first has room to be multiplied exactly
_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
_LEAST = -708.0  # exp of less is subnormal


@inlined
def _split(x: float) -> tuple[float, float]:
    """E and m of x = 2ᵉ (1 + m), m from √½ − 1 to √2 − 1."""
    bits = bits_of(x)
    power = (bits - _HALF_ROOT) >> 52
    return number_of(power + _SHIFT_BITS) - _SHIFT, number_of(bits - (power << 52)) - 1.0


@inlined
def _merged(e: float, m: float, s: float) -> float:
    """The logarithm from s = m/(2 + m)."""
    z = s * s
    w = z * z
    odd = w * (0.3999999999940941908 + w * (0.2222219843214978396 + w * 0.1531383769920937332))
    even = 0.6666666666666735130 + w * (
        0.2857142874366239149 + w * (0.1818357216161805012 + w * 0.1479819860511658591)
    )
    half = 0.5 * m * m
    return e * _LN2_HIGH - ((half - (s * (half + odd + z * even) + e * _LN2_LOW)) - m)


@inlined
def log_of(x: float) -> float:
    """Ln of a normal number, x ≥ 2.3e-308."""
    e, m = _split(x)
    return _merged(e, m, m / (2.0 + m))


@inlined
def logs_of(x: float, y: float, z: float) -> tuple[float, float, float]:
    """Ln of three numbers by one division, which takes as long as half a logarithm."""
    ex, mx = _split(x)
    ey, my = _split(y)
    ez, mz = _split(z)
    dx, dy, dz = 2.0 + mx, 2.0 + my, 2.0 + mz
    one = 1.0 / (dx * dy * dz)
    return (
        _merged(ex, mx, mx * (one * (dy * dz))),
        _merged(ey, my, my * (one * (dx * dz))),
        _merged(ez, mz, mz * (one * (dx * dy))),
    )


@inlined
def exp_of(x: float) -> float:
    """Exp of x ≤ 709; below −708 that of −708."""
    y = x if x > _LEAST else _LEAST
    shifted = y * 1.4426950408889634074 + _SHIFT
    k = shifted - _SHIFT
    r = (y - k * _LN2_HIGH) - k * _LN2_LOW
    p = 1.0 / 6227020800.0
    p = p * r + 1.0 / 479001600.0
    p = p * r + 1.0 / 39916800.0
    p = p * r + 1.0 / 3628800.0
    p = p * r + 1.0 / 362880.0
    p = p * r + 1.0 / 40320.0
    p = p * r + 1.0 / 5040.0
    p = p * r + 1.0 / 720.0
    p = p * r + 1.0 / 120.0
    p = p * r + 1.0 / 24.0
    p = p * r + 1.0 / 6.0
    p = p * r + 0.5
    p = (p * r * r + r) + 1.0
    return p * number_of(((bits_of(shifted) - _SHIFT_BITS) << 52) + _ONE)


@inlined
def cosine_sine_of(x: float) -> tuple[float, float]:
    """Cos and sin of |x| ≤ 1e5; beyond, up to 1e15, with the error of x."""
    shifted = x * 0.63661977236758134308 + _SHIFT
    k = shifted - _SHIFT
    r = ((x - k * 1.57079632673412561417) - k * 6.07710050630396597660e-11) - k * (
        2.02226624879595063154e-21
    )
    z = r * r
    s = 1.58969099521155010221e-10
    s = s * z - 2.50507602534068634195e-08
    s = s * z + 2.75573137070700676789e-06
    s = s * z - 1.98412698298579493134e-04
    s = s * z + 8.33333333332248946124e-03
    s = s * z - 1.66666666666666324348e-01
    sine = r + r * z * s
    c = -1.13596475577881948265e-11
    c = c * z + 2.08757232129817482790e-09
    c = c * z - 2.75573143513906633035e-07
    c = c * z + 2.48015872894767294178e-05
    c = c * z - 1.38888888888741095749e-03
    c = c * z + 4.16666666666666019037e-02
    cosine = 1.0 - (0.5 * z - z * z * c)
    quarter = bits_of(shifted) & 3
    one, other = (sine, cosine) if quarter & 1 else (cosine, sine)
    return (-one if (quarter + 1) & 2 else one), (-other if quarter & 2 else other)


@inlined
def angle_of(y: float, x: float) -> float:
    """The angle of (x, y), x ≥ 0, between −π/2 and π/2; 0 of the origin (as Cephes has it)."""
    size, long = abs(y), max(abs(y), x)
    short = min(size, x)
    halved = short > 0.41421356237309504880 * long
    part, whole = (short - long, short + long) if halved else (short, long)
    r = part / (whole if whole > 0.0 else 1.0)
    z = r * r
    above = -8.750608600031904122785e-1
    above = above * z - 1.615753718733365076637e1
    above = above * z - 7.500855792314704667340e1
    above = above * z - 1.228866684490136173410e2
    above = above * z - 6.485021904942025371773e1
    below = z + 2.485846490142306297962e1
    below = below * z + 1.650270098316988542046e2
    below = below * z + 4.328810604912902668951e2
    below = below * z + 4.853903996359136964868e2
    below = below * z + 1.945506571482613964425e2
    angle = r + r * z * above / below
    angle = angle + 0.78539816339744830962 if halved else angle
    angle = 1.57079632679489661923 - angle if size > x else angle
    return -angle if y < 0.0 else angle


@inlined
def direction_of(y: float, x: float) -> float:
    """The angle of (x, y), between −π and π; 0 of the origin."""
    angle = angle_of(abs(y), abs(x))
    angle = 3.14159265358979323846 - angle if x < 0.0 else angle
    return -angle if y < 0.0 else angle
