"""The loaded part of the base, a disc cut by a chord: that chord, and sums that friction needs.

Where the linear pressure law would pull, the floor lets go.  What is left is proportional to the
distance ξ = n·(x, y) − d from a chord of the unit disc, n = (cos γ, sin γ), where that is positive:
d ≤ −1 is full contact, d → 1 the tip of the puck.  The balance of moments is solved for the chord;
its two equations are those of :mod:`puck_tables.contact.one_sided`.  Two ways to sum over the
loaded part:

*Segment.*  Area and moments of ξ are integrals over x = cos t along n, entire functions of t that a
Gauss rule takes to rounding, also where the segment is small.

*Patch rule.*  Through the instantaneous centre of rotation (0, s), s = cot φ, goes a line for every
direction of slip (cos a, sin a); on it the slip does not turn, so that with the element R dl da
(R the signed distance from the centre) every sum of friction is a polynomial of degree ≤ 3 in the
position l along the line: two Gauss points between the ends of its loaded part are exact.  The
lines are integrated over a for s ≤ 1 and over χ, sin χ = s sin a, for s > 1.  A line changes what
it meets where it passes an end of the chord: between there and ±π/2 tanh-sinh rules, which do not
mind what happens at their ends (the corners, and for s → 1 the centre on the rim).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import closed_form
from puck_tables.contact.closed_form import moment_balance
from puck_tables.contact.integrals import PatchIntegrals, SlipDirection
from puck_tables.errors import AccuracyError

BoolArray = npt.NDArray[np.bool_]

_SEGMENT_NODES = 20  # to rounding: test_segment_and_patch_rule
SEGMENT_RULE = np.stack(np.polynomial.legendre.leggauss(_SEGMENT_NODES))  # on [−1, 1]
_GAUSS_2 = 3.0**-0.5  # node of Gauss's rule of two points, exact up to degree 3
_STEPS = 60  # of Newton's method: then another guess is tried
_CONVERGED = 1e-7  # a step of that size leaves an error of its square
_EASY_DELTA = 3.9  # dimensionless: up to it the guess leads to the solution
_FOLLOWED = 33  # heights from there to the wanted one: each is a good guess for the next
_MAX_TURN = 0.3  # radians a step


def _tanh_sinh(nodes: int, reach: float) -> tuple[FloatArray, FloatArray]:
    """Rule on [−1, 1] (Takahasi, Mori 1974); weights sum to 2."""
    u = np.linspace(-reach, reach, nodes)
    v = 0.5 * np.pi * np.sinh(u)
    weight = np.cosh(u) / np.cosh(v) ** 2
    return np.tanh(v), 2.0 * weight / weight.sum()


_LINE_NODES = 81  # 2e-13 in the resultants: test_against_strips
LINE_RULE = np.stack(_tanh_sinh(_LINE_NODES, 3.2))


class Segment(NamedTuple):
    """The loaded segment x > d of the unit disc: integrals of 1, x, ξ and the mean of x over ξ."""

    area: FloatArray
    moment: FloatArray
    load: FloatArray
    lever: FloatArray


def segment(offset: FloatArray) -> Segment:
    """Area and load of the part of the unit disc beyond chords at distances ``offset``.

    ``offset``: array (n,), d < 1; the whole disc for d ≤ −1.  Returns Segment, arrays (n,).

    >>> half = segment(np.array([0.0]))
    >>> float(half.load[0].round(12)), float(half.lever[0].round(12))  # 2/3, 3π/16
    (0.666666666667, 0.589048622548)
    """
    arc = np.arccos(np.maximum(offset, -1.0))[:, None]
    t = 0.5 * arc * (1.0 + SEGMENT_RULE[0])
    x = np.cos(t)
    element = arc * SEGMENT_RULE[1] * np.sin(t) ** 2
    # cos t − cos arc without cancellation, and what lies beyond the rim in full contact
    xi = 2.0 * np.sin(0.5 * (arc + t)) * np.sin(0.5 * (arc - t))
    xi += np.maximum(-1.0 - offset, 0.0)[:, None]
    load = (element * xi).sum(axis=-1)
    return Segment(
        element.sum(axis=-1), (element * x).sum(axis=-1), load, (element * xi * x).sum(-1) / load
    )


class PatchRule(NamedTuple):
    """Points and weights on the loaded parts of n discs, arrays (n, points).

    Position ``x``, ``y``; ``along``: l, which is also the lever arm of friction about the disc's
    centre; ``depth``: ξ; slip direction ``cos_a``, ``sin_a``; ``foot``: s sin a.  ``weight`` has
    the sign of R (the slip is −(cos a, sin a) where it is negative): it is for sums of friction.
    """

    x: FloatArray
    y: FloatArray
    along: FloatArray
    depth: FloatArray
    cos_a: FloatArray
    sin_a: FloatArray
    foot: FloatArray
    weight: FloatArray


def patch_rule(
    ratio: FloatArray, fast: BoolArray, offset: FloatArray, bearing: FloatArray
) -> PatchRule:
    """The rule for sums over the loaded part.

    ``ratio``, ``fast``: arrays (n,), min(v, r|ω|)/max(v, r|ω|), and whether r|ω| > v; ``offset``,
    ``bearing``: arrays (n,), d < 1 and γ of the chord.

    >>> one = np.ones(1)
    >>> rule = patch_rule(0.0 * one, one < 0.0, 0.0 * one, 0.0 * one)  # pure sliding, half a disc
    >>> float(rule.weight.sum().round(12))  # π/2
    1.570796326795
    """
    is_fast = fast[:, None]
    ratio = ratio[:, None]
    z, weight = _lines(ratio[:, 0], fast, offset, bearing)
    sine, cosine = np.sin(z), np.cos(z)
    # sin a = sin χ/s for a centre outside, sin χ = s sin a for one inside; no 1 − ratio² sin² z
    other = np.sqrt(cosine**2 + (1.0 - ratio) * (1.0 + ratio) * sine**2)
    sin_a, cos_a = np.where(is_fast, sine, ratio * sine), np.where(is_fast, cosine, other)
    foot, half_chord = np.where(is_fast, ratio * sine, sine), np.where(is_fast, other, cosine)

    n_x, n_y = np.cos(bearing)[:, None], np.sin(bearing)[:, None]
    level = foot * (n_x * cos_a + n_y * sin_a) - offset[:, None]
    slope = n_x * sin_a - n_y * cos_a
    low, high = level - half_chord * slope, level + half_chord * slope
    deepest, shallowest = np.maximum(low, high), np.minimum(low, high)
    all_loaded = shallowest >= 0.0
    span = np.where(all_loaded | (deepest <= 0.0), 1.0, deepest - shallowest)
    share = np.where(all_loaded, 1.0, np.maximum(deepest, 0.0) / span)
    half_length = half_chord * share
    middle = np.where(high > low, 1.0, -1.0) * half_chord * (1.0 - share)

    parts = []
    for side in (-_GAUSS_2, _GAUSS_2):
        along = middle + side * half_length
        # R dl da: with s over R to infinity when the puck only slides
        element = np.where(is_fast, ratio * cos_a + along, cosine * (1.0 + ratio * along / other))
        x, y = foot * cos_a + along * sin_a, foot * sin_a - along * cos_a
        depth = level + along * slope
        parts.append((x, y, along, depth, cos_a, sin_a, foot, element * half_length * weight))
    return PatchRule(*(np.concatenate(pair, axis=-1) for pair in zip(*parts, strict=True)))


def _lines(
    ratio: FloatArray, fast: BoolArray, offset: FloatArray, bearing: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Line parameters (a or χ) and weights: three intervals between the ends of the chord."""
    arc = np.arccos(np.clip(offset, -1.0, 1.0))
    ends = []
    for side in (-1.0, 1.0):
        x, y = np.cos(bearing + side * arc), np.sin(bearing + side * arc)
        ends.append(np.arctan2(x, np.where(fast, ratio - y, np.abs(ratio - y))))
    # lines, not rays: a modulo π
    first, second = (np.where(np.abs(e) > 0.5 * np.pi, e - np.copysign(np.pi, e), e) for e in ends)
    edge = np.full_like(first, 0.5 * np.pi)
    breaks = np.stack([-edge, np.minimum(first, second), np.maximum(first, second), edge], axis=-1)
    half = 0.5 * np.diff(breaks)[..., None]
    middle = 0.5 * (breaks[:, 1:] + breaks[:, :-1])[..., None]
    size = len(ratio), -1
    return (middle + half * LINE_RULE[0]).reshape(size), (half * LINE_RULE[1]).reshape(size)


class Chord(NamedTuple):
    """The chord that bounds the loaded part: distance d from the centre and bearing γ of the load.

    d ≤ −1 in full contact, where the pressure is (N/πr²)(1 − n·(x, y)/d).
    """

    offset: FloatArray
    bearing: FloatArray


def guessed_chord(ratio: FloatArray, fast: npt.NDArray[np.bool_], delta: FloatArray) -> Chord:
    """The tilt of the linear law, as far as the load can move: |⟨(x, y)⟩| = m(d) ≤ δ/4.

    ``ratio``, ``fast``: arrays (n,), min(v, r|ω|)/max(v, r|ω|), and whether r|ω| > v; ``delta``:
    array (n,), dimensionless height.

    >>> one = np.ones(1)
    >>> float(guessed_chord(0.5 * one, one < 0.0, 2.0 * one).offset[0].round(3))
    -0.294
    """
    direction = SlipDirection(ratio, fast)
    a, b, d = closed_form.shape_integrals(direction.ratio, direction.fast_spin.astype(np.float64))
    p = PatchIntegrals(a, b, b - d, d, d - 2.0 * b)
    rho = moment_balance(p, direction, delta)
    sideways = np.sqrt(direction.sin_squared) * rho.perpendicular
    force = np.sqrt(direction.cos_squared) * np.hypot(rho.parallel, sideways)
    offset = -1.0 / (delta * force)
    lever = np.clip(0.25 * delta * force, 0.25, np.minimum(0.245 * delta, 0.98))
    opened = 1.0 - 7.985 * (1.0 - np.sqrt(1.0 - 0.584 * (1.0 - lever)))  # m(d), fitted
    bearing = np.arctan2(sideways, rho.parallel)
    return Chord(np.where(offset > -1.0, opened, offset), bearing)


def solved_chord(direction: SlipDirection, delta: FloatArray) -> Chord:
    """The chord by Newton's method from a guess; where that fails, followed up from a lower δ."""
    chord, unsolved = _newton(direction, delta, guessed_chord(*direction, delta))
    if unsolved.any():
        part = SlipDirection(direction.ratio[unsolved], direction.fast_spin[unsolved])
        start = np.minimum(_EASY_DELTA, delta[unsolved])
        followed = guessed_chord(*part, start)
        for share in np.linspace(0.0, 1.0, _FOLLOWED):
            height = start + share * (delta[unsolved] - start)
            followed, lost = _newton(part, height, followed)
        if lost.any():
            raise AccuracyError(
                f"the balance of moments was not solved at delta = {height[lost][0]:.17g}, "
                f"min(v, r omega)/max(v, r omega) = {part.ratio[lost][0]:g}: up to delta = 3.9999 "
                "it is, nearer to tipping at 4 the load is too close to a point"
            )
        chord.offset[unsolved], chord.bearing[unsolved] = followed
    return chord


def _newton(
    direction: SlipDirection, delta: FloatArray, start: Chord
) -> tuple[Chord, npt.NDArray[np.bool_]]:
    """Newton's method for the points that still move; and which of them never settled."""
    offset, bearing = start.offset.copy(), start.bearing.copy()
    moving = np.ones(len(delta), dtype=np.bool_)
    for _ in range(_STEPS):
        residual, by_offset, by_bearing = chord_residual(
            direction.ratio[moving], direction.fast_spin[moving], delta[moving],
            offset[moving], bearing[moving],
        )  # fmt: skip
        determinant = by_offset[0] * by_bearing[1] - by_offset[1] * by_bearing[0]
        step = (by_bearing[0] * residual[1] - by_bearing[1] * residual[0]) / determinant
        turn = (by_offset[1] * residual[0] - by_offset[0] * residual[1]) / determinant
        room = 1.0 - offset[moving]
        offset[moving] = 1.0 - np.clip(room - step, 0.5 * room, 2.2 * room)
        bearing[moving] += np.clip(turn, -_MAX_TURN, _MAX_TURN)
        moving[moving] = ~((np.abs(step) <= _CONVERGED * room) & (np.abs(turn) <= _CONVERGED))
        if not moving.any():
            break
    return Chord(offset, bearing), moving


def chord_residual(
    ratio: FloatArray, fast: npt.NDArray[np.bool_], delta: FloatArray, offset: FloatArray,
    bearing: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:  # fmt: skip
    """M(d) n − (δ/4) ⟨u/|u|⟩ and its derivatives by d and γ, each (2, n)."""
    rule = patch_rule(ratio, fast, offset, bearing)
    loaded = segment(offset)
    normal = np.stack([np.cos(bearing), np.sin(bearing)])
    tangent = np.stack([-normal[1], normal[0]])
    slip = np.stack([rule.cos_a, rule.sin_a])
    sideways = rule.x * tangent[0, :, None] + rule.y * tangent[1, :, None]
    scale = 0.25 * delta / loaded.load
    friction = scale * (rule.weight * rule.depth * slip).sum(axis=-1)
    lever_slope = (loaded.lever * loaded.area - loaded.moment) / loaded.load
    friction_slope = friction * loaded.area / loaded.load - scale * (rule.weight * slip).sum(-1)
    return (
        loaded.lever * normal - friction,
        lever_slope * normal - friction_slope,
        loaded.lever * tangent - scale * (rule.weight * sideways * slip).sum(axis=-1),
    )
