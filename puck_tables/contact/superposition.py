"""Integrals of washers, rings and tabulated profiles from those of the uniform disc.

Every bounded pressure law is a pile of uniform discs: W(ρ) = ∫_{a>ρ} dμ(a).  A disc of radius a
sees the slip angle φ' with tan φ' = a tan φ, and with N = hypot(cos φ, a sin φ) its share is

    p_a: a² p_a(φ')/N,    p_b … p_e: a⁴ p_b(φ')/N … ,

so closed forms serve for all.  The thin ring is the limit of washers, an integral over its angle.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.closed_form import shape_integrals
from puck_tables.contact.integrals import PatchIntegrals, slip_direction
from puck_tables.contact.quadrature import FROM_END, WEIGHT

# Between the radii of a profile: tanh-sinh on [0, 1], at home where the centre of rotation lies on
# the edge of a disc, a = cot φ (x² ln|x|), to rounding, as
# test_a_profile_is_its_rings_by_elliptic_integrals tells
_COUNT = 41
_AT = np.linspace(-2.9, 2.9, _COUNT)
_T = 0.5 * np.pi * np.sinh(_AT)
_NODES = 0.5 * (1.0 + np.tanh(_T))
_SHARES = np.cosh(_AT) / np.cosh(_T) ** 2
_SHARES /= _SHARES.sum()
# and farther from there than half their width they are analytic
_FAR_NODES, _FAR_SHARES = 0.5 * (np.polynomial.legendre.leggauss(14) + np.array([[1.0], [0.0]]))
_CHUNK = 64  # points at once: their rules fit the cache
_KEPT = 100_000  # angles at once whose integrals are kept: 50 MB in all at most


def disc_integrals(phi: npt.ArrayLike, radius: FloatArray) -> FloatArray:
    """Shares of p_a, p_b, p_d of uniform discs, π/a² of their load on each, (3, …).

    ``phi``: array_like, radians, in [−π/2, π/2]; ``radius``: array, in (0, 1], broadcast against
    ``phi``.

    >>> disc_integrals(0.0, np.array([1.0, 0.5])).round(6).tolist()
    [[1.0, 0.25], [0.25, 0.015625], [0.25, 0.015625]]
    """
    direction = slip_direction(phi)
    ratio, fast = direction.ratio, direction.fast_spin
    outside = ratio > radius  # of fast pucks: the centre of rotation lies outside this disc
    large = np.where(outside, ratio, radius)
    seen = np.where(fast, np.where(outside, radius, ratio) / large, ratio * radius)
    p = shape_integrals(seen, np.where(fast & ~outside, 1.0, 0.0))
    norm = np.sqrt(direction.cos_squared + radius**2 * direction.sin_squared)
    return np.stack([radius**2 * p[0], radius**4 * p[1], radius**4 * p[2]]) / norm


def annulus_integrals(phi: npt.ArrayLike, inner: float) -> PatchIntegrals:
    """The five integrals of a washer with uniform pressure between ``inner`` and 1.

    ``phi``: array_like, radians, in [−π/2, π/2]; ``inner``: float, in (0, 1).  Returns
    PatchIntegrals: error 1e-15/(1 − inner).

    >>> float(annulus_integrals(0.0, 0.8).b.round(12))  # ⟨x²⟩ = (1 + 0.8²)/4
    0.41
    """
    whole, hole = disc_integrals(phi, np.ones(())), disc_integrals(phi, np.asarray(inner))
    return _five((whole - hole) / ((1.0 - inner) * (1.0 + inner)))


def ring_integrals(phi: npt.ArrayLike) -> PatchIntegrals:
    """The five integrals of a thin ring.

    With t the angle from the instantaneous centre, w² = (cos φ − sin φ)² + 2 sin 2φ sin²(t/2); what
    is odd in cos t has been taken off the numerators, so nothing cancels.

    ``phi``: array_like, radians, in [−π/2, π/2].  Returns PatchIntegrals: error 1e-14.

    >>> p = ring_integrals(np.pi / 4)
    >>> float((p.a - p.d).round(12))
    0.0
    """
    direction = slip_direction(phi)
    cos2, sin2 = direction.cos_squared[..., None], direction.sin_squared[..., None]
    product = np.sqrt(cos2 * sin2)
    # cos φ − sin φ and cos²φ − sin²φ through 1 − ratio
    sign = np.where(direction.fast_spin, -1.0, 1.0)[..., None]
    gap = sign * ((1.0 - direction.ratio) / np.sqrt(1.0 + direction.ratio**2))[..., None]
    split = gap * (np.sqrt(cos2) + np.sqrt(sin2))
    half_angle = FROM_END  # t/2, graded towards 0
    w = np.sqrt(gap**2 + 4.0 * product * np.sin(half_angle) ** 2)
    across = np.sin(2.0 * half_angle) ** 2
    weight = 2.0 / np.pi * WEIGHT
    a = ((split + 2.0 * sin2 * across) / w + 1.0) / (1.0 + w)
    d = ((2.0 * cos2 * across - split) / w + 1.0) / (1.0 + w)
    return _five(np.stack([(part * weight).sum(axis=-1) for part in (a, across / w, d)]))


def profile_integrals(
    phi: npt.ArrayLike, radii: FloatArray, pressure: FloatArray
) -> PatchIntegrals:
    """The five integrals of a pressure tabulated over the radius, straight in between.

    ``phi``: array_like, radians, in [−π/2, π/2]; ``radii``: array (n,), ascending to 1, no pressure
    inside the first; ``pressure``: array (n,), not negative, in any unit.

    >>> p = profile_integrals(0.3, np.array([0.0, 1.0]), np.array([1.0, 1.0]))
    >>> float(p.a.round(12)) == float(disc_integrals(0.3, np.ones(()))[0].round(12))
    True
    """
    angle = np.asarray(phi, dtype=np.float64)
    find = _sums if angle.size <= _KEPT else _sums.__wrapped__
    total = find(angle.tobytes(), radii.tobytes(), pressure.tobytes())
    # ∫ a² dμ(a) = 2 ∫ W ρ dρ of a profile straight between its radii
    (inner, outer), (first, last) = (radii[:-1], radii[1:]), (pressure[:-1], pressure[1:])
    share = first * (2.0 * inner + outer) + last * (inner + 2.0 * outer)
    load = float(((outer - inner) * share).sum() / 3.0)
    return _five(total.reshape(3, *angle.shape) / load)


@lru_cache(maxsize=16)  # pucks of many heights ask for the same angles
def _sums(*arrays: bytes) -> FloatArray:
    """The sums of all discs (3, n), of the bytes of angles, radii and pressures."""
    angle, radii, pressure = (np.frombuffer(one) for one in arrays)
    total = np.empty((3, angle.size))
    for start in range(0, angle.size, _CHUNK):
        part = angle[start : start + _CHUNK]
        total[:, start : start + _CHUNK] = _pile(part, radii, pressure)
    return total


def spread(radii: FloatArray, pressure: FloatArray) -> float:
    """Root mean square deviation of the radius at which the load of a profile stands.

    >>> round(spread(np.array([0.0, 1.0]), np.array([1.0, 1.0])) ** 2, 12)  # 1/2 − (2/3)²
    0.055555555556
    """
    node, weight = np.polynomial.legendre.leggauss(4)
    half = 0.5 * np.diff(radii)[:, None]
    rho = radii[:-1, None] + half * (1.0 + node)
    share = 0.5 * (1.0 + node)
    load = (pressure[:-1, None] * (1.0 - share) + pressure[1:, None] * share) * rho * half * weight
    load /= load.sum()
    return float(np.sqrt((load * (rho - (load * rho).sum()) ** 2).sum()))


def _pile(phi: FloatArray, radii: FloatArray, pressure: FloatArray) -> FloatArray:
    """Sum of the shares of all discs at angles (n,): the rim, the edge of a hole, the slopes."""
    total: FloatArray = pressure[-1] * disc_integrals(phi, np.ones(()))
    if radii[0] > 0.0:
        total -= pressure[0] * disc_integrals(phi, radii[0])
    slope = np.diff(pressure) / np.diff(radii)
    centre = np.abs(np.cos(phi)) / np.maximum(np.abs(np.sin(phi)), 1e-300)
    low, high = (np.broadcast_to(ends, (phi.size, slope.size)) for ends in (radii[:-1], radii[1:]))
    away = np.maximum(low - centre[:, None], centre[:, None] - high)
    far = away > 0.5 * (high - low)
    bounded = np.clip(centre[:, None], low, high)
    for first, last, chosen, nodes, shares in (
        (low, high, far, _FAR_NODES, _FAR_SHARES), (low, bounded, ~far, _NODES, _SHARES),
        (bounded, high, ~far, _NODES, _SHARES),
    ):  # fmt: skip
        which, between = np.nonzero(chosen & (last > first) & (slope != 0.0))
        start, length = first[which, between], (last - first)[which, between]
        radius = np.clip(start[:, None] + length[:, None] * nodes, 1e-300, 1.0)
        share = disc_integrals(phi[which, None], radius) @ shares * length * slope[between]
        for row, part in zip(total, share, strict=True):
            row -= np.bincount(which, part, phi.size)
    return total


def _five(abd: FloatArray) -> PatchIntegrals:
    a, b, d = abd
    return PatchIntegrals(a, b, b - d, d, d - 2.0 * b)
