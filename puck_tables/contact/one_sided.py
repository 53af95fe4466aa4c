"""Resultants of one-sided contact: the floor pushes and never pulls (uniform pressure).

Beyond the height at which contact first opens the pressure is σ = max(0, a + b x + c y) with
∫σ = N, ∫σ x = (h/2) F_∥, ∫σ y = (h/2) F_⊥.  By the symmetry of the disc the first equation and the
direction drop out: with σ ∝ ξ = n·(x, y) − d on the loaded part, ⟨f⟩ = ∫ξ f/∫ξ and δ = 2fh/r,

    ⟨(x, y)⟩ = m(d) n(γ) = (δ/4) ⟨u/|u|⟩ ,

two equations for the chord (d, γ), solved by Newton's method; the derivatives are sums over the
same points, ∂ξ/∂d = −1 and ∂ξ/∂γ = the position along the chord.

δ = 4 is the end: |⟨u/|u|⟩| ≤ 1 and m < 1, and where the puck slides faster than it spins (φ < π/4)
the load gathers at sin γ = tan φ on the rim as δ → 4, and the puck tips.  Below :data:`FOLD_DELTA`
the balance has one solution for every slip angle.  Above it the balance has three solutions in a
sliver just below φ = π/4 (see tests/test_partial.py); there it is refused.

Contact opens where the tilted pressure touches zero.  The linear pressure of full contact is
nowhere negative while b̂² + ĉ² ≤ 1.  With δ = 2fh/r and Δ = 1 − δ² sin²φ p_b p_c (Salnikova,
Treschev, Gallyamov 2012, eq. 5.2 and 5.3) that is

    Δ² ≥ δ² cos²φ p_a² (1 + δ² sin²φ p_b²),

a quadratic equation in Y = 1/δ² at its limit.  Towards φ = π/2 it has no positive root: a puck that
spins fast enough keeps its whole base loaded at every height.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast
from puck_tables.contact import closed_form
from puck_tables.contact.closed_form import Resultants, checked_delta, integrals, moment_balance
from puck_tables.contact.integrals import SlipDirection, checked_phi, slip_direction
from puck_tables.contact.loaded_chord import (
    Chord,
    PatchRule,
    chord_residual,
    patch_rule,
    segment,
    solved_chord,
)
from puck_tables.errors import ContactError

TIPPING_DELTA = 4.0  # δ/4 is the lever of the load as it slides: at 1 it has reached the rim
# The cusp of the balance: (φ, δ) = (π/4 − 0.00500, 3.96380), rounded towards safety.
FOLD_DELTA = 3.9637
_FOLD_ANGLES = (0.25 * np.pi - 0.00502, 0.25 * np.pi)

_CHUNK = 64  # points at once: their rules fit the cache


def critical_delta(phi: npt.ArrayLike) -> FloatArray:
    """The height δ_c(φ) up to which the whole base stays loaded (uniform pressure).

    Parameters
    ----------
    phi : array_like, radians, any shape, in [−π/2, π/2]

    Returns
    -------
    array of the shape of ``phi``
        Dimensionless; inf where contact never opens.

    Raises
    ------
    InputError
        If an angle is not finite or lies outside [−π/2, π/2].

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, eq. 5.3 (the square there stands under sin φ too).

    Examples
    --------
    >>> critical_delta([0.0, np.pi / 4, np.pi / 2]).round(8).tolist()
    [1.0, 1.15913851, inf]
    """
    p = integrals(phi)
    direction = slip_direction(phi)
    stiffening = -direction.sin_squared * p.b * p.c
    along = direction.cos_squared * p.a**2
    across = direction.sin_squared * p.b**2
    # (Y + stiffening)² = along (Y + across): Y² − 2 half Y + product = 0, the larger root
    half = 0.5 * along - stiffening
    product = stiffening**2 - along * across
    discriminant = half**2 - product
    opens = (discriminant >= 0.0) & ((half > 0.0) | (product < 0.0))
    root = np.sqrt(np.where(opens, discriminant, 1.0))
    larger = np.where(half > 0.0, half + root, -product / np.where(half > 0.0, 1.0, root - half))
    return np.where(opens, 1.0 / np.sqrt(np.where(opens, larger, 1.0)), np.inf)


def checked_height(delta: npt.ArrayLike) -> FloatArray:
    """``delta`` as an array, refused where the puck tips over.

    Raises InputError if a height is not finite or negative; ContactError if a height is 4 or more.

    >>> checked_height(4.0)
    Traceback (most recent call last):
    ...
    puck_tables.errors.ContactError: delta = 4: a puck with delta = 2 f h / r >= 4 tips over its \
leading edge as soon as it slides without spin; choose a lower or broader puck or less friction
    """
    height = checked_delta(delta)
    if not (height < TIPPING_DELTA).all():
        raise ContactError(
            f"delta = {height[height >= TIPPING_DELTA].flat[0]:g}: a puck with "
            "delta = 2 f h / r >= 4 tips over its leading edge as soon as it slides without spin; "
            "choose a lower or broader puck or less friction"
        )
    return height


def resultants(phi: npt.ArrayLike, delta: npt.ArrayLike) -> Resultants:
    """Friction resultants of full and partial contact, 0 ≤ δ < 4.

    Parameters
    ----------
    phi : array_like, radians, in [−π/2, π/2]
    delta : array_like
        Dimensionless height δ = 2fh/r, broadcast against ``phi``.

    Returns
    -------
    Resultants
        Dimensionless, of the broadcast shape: closed forms (1e-14) up to ``critical_delta(phi)``,
        beyond it the one-sided balance: 1e-13 for δ ≤ 3.9, 3e-12 at 3.9637, 5e-11 at 3.9999.

    Raises
    ------
    InputError
        If an argument is not finite or out of range.
    ContactError
        If δ ≥ 4, or δ > 3.9637 and φ within 0.00502 below π/4, where the balance is not unique.
    AccuracyError
        If δ > 3.9999 and the balance could not be solved so near to tipping.

    References
    ----------
    Full contact: Salnikova, Treschev, Gallyamov 2012, section 6.  One-sided pressure: the same
    balance of moments with σ = max(0, a + b x + c y).

    Examples
    --------
    >>> rho = resultants(0.5, 2.0)
    >>> [round(float(value), 7) for value in rho]
    [1.0813245, 0.6204802, 0.2196328]
    """
    angle, height = broadcast(phi=checked_phi(phi), delta=checked_height(delta))
    direction = slip_direction(angle)
    full = np.stack(moment_balance(closed_form.integrals(angle), direction, height))
    opened = height > critical_delta(angle)
    if opened.any():
        full[:, opened] = np.stack(balance(angle[opened], height[opened])[0])
    return Resultants(*full)


def loaded_share(phi: npt.ArrayLike, delta: npt.ArrayLike) -> FloatArray:
    """The share of the base that carries load: 1 in full contact, towards 0 as the puck tips.

    Parameters
    ----------
    phi : array_like, radians, in [−π/2, π/2]
    delta : array_like
        Dimensionless height, broadcast against ``phi``.

    Raises
    ------
    InputError, ContactError
        As :func:`resultants`.

    Examples
    --------
    >>> loaded_share([0.1, 0.5, 1.3], 2.0).round(6).tolist()
    [0.64808, 0.660885, 1.0]
    """
    angle, height = broadcast(phi=checked_phi(phi), delta=checked_height(delta))
    share = np.ones(angle.shape)
    opened = height > critical_delta(angle)
    if opened.any():
        share[opened] = segment(balance(angle[opened], height[opened])[1].offset).area / np.pi
    return share


def balance(phi: FloatArray, delta: FloatArray) -> tuple[Resultants, Chord]:
    """Solve the balance of moments of one-sided contact, by quadrature at every point.

    In full contact it is the linear law, by another way than closed forms.

    ``phi``: array (n,), radians, in (−π/2, π/2); ``delta``: array (n,), 0 < δ.  Returns Resultants,
    Chord: arrays (n,); the bearing γ is that for φ ≥ 0.  Raises ContactError where the balance is
    not unique; AccuracyError if it is not solved; not known to happen for δ < 4.

    >>> rho, chord = balance(np.array([0.9]), np.array([2.0]))
    >>> float(rho.spin[0].round(7)), float(chord.offset[0].round(6))
    (0.8430539, -0.635143)
    """
    size = np.abs(phi)
    folded = (delta > FOLD_DELTA) & (size > _FOLD_ANGLES[0]) & (size < _FOLD_ANGLES[1])
    if folded.any():
        raise ContactError(
            f"at phi = {phi[folded][0]:g}, delta = {delta[folded][0]:g} the balance of moments has "
            f"more than one solution: for every phi it has one up to delta = {FOLD_DELTA:g}"
        )
    return balanced(slip_direction(phi), delta)


def balanced(direction: SlipDirection, delta: FloatArray) -> tuple[Resultants, Chord]:
    """Resultants and chord of one-sided contact where the balance of moments is unique.

    ``direction``: SlipDirection; ``delta``: array (n,), 0 < δ.  Raises AccuracyError if it is not
    solved.

    >>> rho, _ = balanced(slip_direction(np.array([0.9])), np.array([2.0]))
    >>> float(rho.spin[0].round(7))
    0.8430539
    """
    values, chords = np.empty((3, delta.size)), np.empty((2, delta.size))
    for start in range(0, delta.size, _CHUNK):
        part = slice(start, start + _CHUNK)
        some = SlipDirection(direction.ratio[part], direction.fast_spin[part])
        chords[:, part] = solved_chord(some, delta[part])
        values[:, part] = _resultants(some, delta[part], Chord(*chords[:, part]))
    return Resultants(*values), Chord(*chords)


def height_slopes(phi: FloatArray, delta: FloatArray) -> tuple[Resultants, Resultants]:
    """The resultants of one-sided contact, and how they change with the height, ∂ρ/∂δ.

    The chord (d, γ) moves so that the balance stays solved; with ⟨f⟩ = ∫ξ f/∫ξ, ∂ξ/∂d = −1 and
    ∂ξ/∂γ the position along the chord, where ξ = 0 nothing enters or leaves.

    ``phi``: array (n,), radians, in [0, π/2); ``delta``: array (n,), above ``critical_delta(phi)``.
    Returns Resultants, Resultants: themselves and their derivatives at the same φ, arrays (n,).
    Raises ContactError, AccuracyError as :func:`balance`.

    >>> _, slopes = height_slopes(np.array([0.5]), np.array([2.0]))
    >>> [round(float(slope[0]), 6) for slope in slopes]
    [-0.02685, 0.331562, -0.211668]
    """
    values, chord = balance(phi, delta)
    out = np.empty((3, len(phi)))
    for start in range(0, len(phi), _CHUNK):
        part = slice(start, start + _CHUNK)
        direction = slip_direction(phi[part])
        own = Chord(chord.offset[part], chord.bearing[part])
        out[:, part] = _height_slopes(direction, delta[part], own)
    return values, Resultants(*out)


def _height_slopes(direction: SlipDirection, delta: FloatArray, chord: Chord) -> FloatArray:
    ratio, fast = direction.ratio, direction.fast_spin
    _, by_offset, by_bearing = chord_residual(ratio, fast, delta, *chord)
    loaded = segment(chord.offset)
    normal = np.stack([np.cos(chord.bearing), np.sin(chord.bearing)])
    by_height = -loaded.lever * normal / delta  # the balance is solved: (δ/4)⟨u/|u|⟩ = m n
    determinant = by_offset[0] * by_bearing[1] - by_offset[1] * by_bearing[0]
    shift = (by_bearing[0] * by_height[1] - by_bearing[1] * by_height[0]) / determinant
    turn = (by_offset[1] * by_height[0] - by_offset[0] * by_height[1]) / determinant
    rule = patch_rule(ratio, fast, *chord)
    sideways = rule.y * normal[0, :, None] - rule.x * normal[1, :, None]
    change = turn[:, None] * sideways - shift[:, None]
    change = change + (shift * loaded.area / loaded.load)[:, None] * rule.depth
    pressure = rule.weight * rule.depth / loaded.load[:, None]
    moved = rule.weight * change / loaded.load[:, None]
    before, after = ((one * rule.foot).sum(axis=-1) for one in (pressure, moved))
    return _summed(rule, direction, moved, 0.25 * (before + delta * after))


def _resultants(direction: SlipDirection, delta: FloatArray, chord: Chord) -> FloatArray:
    """ρ_∥, ρ_⊥, ρ_ω of a solved balance, (3, n), without cancellation for φ → 0."""
    rule = patch_rule(direction.ratio, direction.fast_spin, *chord)
    pressure = rule.weight * rule.depth / segment(chord.offset).load[:, None]
    return _summed(rule, direction, pressure, 0.25 * delta * (pressure * rule.foot).sum(axis=-1))


def _summed(
    rule: PatchRule, direction: SlipDirection, pressure: FloatArray, sideways: FloatArray
) -> FloatArray:
    """The resultants of a pressure, or their derivatives from those of it, (3, n).

    ``sideways``: what the balance says Σ σ y tan φ is.
    """
    fast = direction.fast_spin
    across = (pressure * rule.foot).sum(axis=-1)  # F_⊥ s: foot = s sin a
    sine, cosine = np.sqrt(direction.sin_squared), np.sqrt(direction.cos_squared)
    # The torque is Σ σ (x sin a − y cos a).  For a centre outside, Σ σ y is taken from the balance,
    # and with sin a = foot/s all of it is divided by tan φ before it is summed.
    about_centre = (pressure * rule.along).sum(axis=-1)
    curving = rule.x + direction.ratio[:, None] * rule.y * rule.foot / (1.0 + rule.cos_a)
    outside = (pressure * (rule.foot * curving)).sum(axis=-1) - sideways
    spin = np.where(fast, about_centre / np.where(fast, sine, 1.0), outside / cosine)
    return np.stack([
        (pressure * rule.cos_a).sum(axis=-1) / cosine, across / cosine**2, 2.0 * spin,
    ])  # fmt: skip
