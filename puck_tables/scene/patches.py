"""When the rim of a puck comes over a patch of the floor, and when it leaves it.

Within a step the distance between the rim and a patch changes no faster than the puck moves, so
that it is looked at often enough; where it changes its sign is found on real steps of the method.
Nor is it looked at before the puck has come as far as there was room at the last look.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.scene.equations import SIZE
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.scene.ground import (
    BORDERS,
    CORNER,
    CORNERS,
    MIDDLE_X,
    MIDDLE_Y,
    REACH,
    corner_of,
    patch_of,
    patches_on,
    strip_at,
)
from puck_tables.scene.ingredients import (
    Dry,
    Regions,
    Stretch,
    Surface,
    carried_along,
    dry_in,
    is_astride,
)
from puck_tables.scene.steps import step

OUTSIDE, ASTRIDE, INSIDE = range(3)  # how a base lies to a patch
_LOOKS = 256  # at a step, at most so many of one length; shorter grazes may pass unseen
_CLOSE = 1e-13  # of a step: how well a moment in it is known
_ASIDE, _SECANTS = 1e-4, 12  # of a step: how the slope is seen at first; then at most
_AT_END = 2e-5  # of a step: so close to its end the curve is the motion
_NEAR = 1e-8  # of a step: from so close a moment is known by the slope


@inner
def distance_to(ground: FloatArray, number: int, x: float, y: float) -> float:
    """How far a point is from the border of a patch; inside it that is negative."""
    dx, dy = x - patch_of(ground, number, MIDDLE_X), y - patch_of(ground, number, MIDDLE_Y)
    count, first = int(patch_of(ground, number, CORNERS)), int(patch_of(ground, number, CORNER))
    if count == 0:
        return math.sqrt(dx * dx + dy * dy) - patch_of(ground, number, REACH)
    nearest, within = math.inf, False
    for n in range(count):
        one = corner_of(ground, first + n)
        two = corner_of(ground, first + (n + 1 if n + 1 < count else 0))
        ax, ay, bx, by = x - one[0], y - one[1], two[0] - one[0], two[1] - one[1]
        share = min(max((ax * bx + ay * by) / (bx * bx + by * by), 0.0), 1.0)
        ox, oy = ax - share * bx, ay - share * by
        nearest = min(nearest, ox * ox + oy * oy)
        if (one[1] > y) != (two[1] > y) and ax < ay / by * bx:
            within = not within
    return -math.sqrt(nearest) if within else math.sqrt(nearest)


@inlined
def room_by(ground: FloatArray, number: int, how: int, radius: float, x: float, y: float) -> float:
    """How far the rim is from coming over a patch, or from leaving it."""
    away = distance_to(ground, number, x, y)
    if how == OUTSIDE:
        return away - radius
    if how == INSIDE:
        return -away - radius
    return radius - abs(away)


@inlined
def look_at_patches(
    ground: FloatArray, lies: npt.NDArray[np.int64], radius: float, x: float, y: float
) -> None:
    """How a base lies to every patch."""
    for k in range(lies.size):
        away = distance_to(ground, k, x, y)
        lies[k] = ASTRIDE
        if abs(away) >= radius:
            lies[k] = OUTSIDE if away > 0.0 else INSIDE


@inlined
def dry_under(regions: Regions, zone: int, lies: npt.NDArray[np.int64]) -> Dry:
    """The friction under a base in a zone of the strips that lies so to the patches."""
    zones, patches = len(regions.load) - len(lies) - 1, len(lies)
    row = zone
    for k in range(patches):
        if lies[k] == INSIDE:
            row = zones + k
    for k in range(patches):
        if lies[k] == ASTRIDE:
            row = zones + patches
    return dry_in(regions, row)


@inlined
def region_at(ground: FloatArray, x: float, y: float) -> int:
    """The strip, or after all strips the patch, in which a point lies."""
    if ground.size == 0:
        return 0
    for k in range(patches_on(ground)):
        if distance_to(ground, k, x, y) < 0.0:
            return int(ground[BORDERS]) + 1 + k
    return strip_at(ground, x, y)


@inlined
def after_patch(ground: FloatArray, number: int, how: int, x: float, y: float) -> int:
    """How a base lies to a patch whose border its rim has just met or left."""
    if how != ASTRIDE:
        return ASTRIDE
    return OUTSIDE if distance_to(ground, number, x, y) > 0.0 else INSIDE


@inlined
def _on_curve(
    dx: float, dy: float, h: float, surface: Surface, first: FloatArray, last: FloatArray, s: float
) -> tuple[float, float]:
    """How far a step has come at the share s of it, by the polynomials of degree 5 in between."""
    ax, ay = carried_along(surface, first[X], first[Y])
    bx, by = carried_along(surface, last[X], last[Y])
    r = 1.0 - s
    p, q = s * s * r * r, 0.5 * h * h
    from_rate, from_bend = s * r * r * r * (1.0 + 3.0 * s), p * r
    to_rate, to_bend = -s * s * s * r * (1.0 + 3.0 * r), p * s
    come = s * s * s * (1.0 + 3.0 * r * (1.0 + 2.0 * r))
    return (
        come * dx + h * (from_rate * first[X] + to_rate * last[X])
        + q * (from_bend * (first[VX] + ax) + to_bend * (last[VX] + bx)),
        come * dy + h * (from_rate * first[Y] + to_rate * last[Y])
        + q * (from_bend * (first[VY] + ay) + to_bend * (last[VY] + by)),
    )  # fmt: skip


@inlined
def comes_at_most(surface: Surface, h: float, first: FloatArray, last: FloatArray) -> float:
    """How far a base comes in a step over h at most, by dy/dt at its begin and at its end."""
    cx, cy = carried_along(surface, first[X], first[Y])
    ax, ay = first[VX] + cx, first[VY] + cy
    cx, cy = carried_along(surface, last[X], last[Y])
    bx, by = last[VX] + cx, last[VY] + cy
    one, two = first[X] * first[X] + first[Y] * first[Y], last[X] * last[X] + last[Y] * last[Y]
    bend = math.sqrt(max(ax * ax + ay * ay, bx * bx + by * by))
    return h * (math.sqrt(max(one, two)) + h * bend)


@inner
def first_patch(
    ground: FloatArray, lies: npt.NDArray[np.int64], stretch: Stretch, t: float, h: float,
    far: float, y: FloatArray, end: FloatArray, scale: FloatArray, work: FloatArray,
    last: FloatArray, new: FloatArray,
) -> tuple[int, float, float]:  # fmt: skip
    """The first patch whose border the rim meets or leaves on a step to ``end``; −1: none.  When.

    And how far the rim is from the next border when the step begins.  ``far``: as far as the step
    comes at most; ``last``: dy/dt at its end.  It is looked for on the polynomials between both
    ends, and then found on real steps.
    """
    which, moment, radius = -1, math.inf, stretch.model.body.radius
    surface, first, clear = stretch.model.surface, work[0], math.inf
    wx, wy = end[SIZE], end[SIZE + 1]
    for k in range(lies.size):
        how = lies[k]
        before = room_by(ground, k, how, radius, y[X], y[Y])
        clear = min(clear, before)
        if before > far or far == 0.0:
            continue
        # on from place to place, none further than the room there, to where there is none
        low, high, room, before = 0.0, 0.0, 0.0, max(before, 0.0)
        while high < 1.0 and high * h < moment:
            low, high = high, min(high + max(before / far, 1.0 / _LOOKS), 1.0)
            mx, my = _on_curve(wx, wy, h, surface, first, last, high)
            room = room_by(ground, k, how, radius, y[X] + mx, y[Y] + my)
            if room < 0.0:
                break
            before = room
        if room >= 0.0 or low * h >= moment:
            continue
        after = room
        for _ in range(60):
            if high - low <= _CLOSE or after == 0.0 or before == 0.0:
                break
            guess = (low * after - high * before) / (after - before)
            guess = min(max(guess, low + 0.5 * _CLOSE), high - 0.5 * _CLOSE)
            mx, my = _on_curve(wx, wy, h, surface, first, last, guess)
            room = room_by(ground, k, how, radius, y[X] + mx, y[Y] + my)
            if room < 0.0:
                high, after = guess, room
                before *= 0.5
            else:
                low, before = guess, room
                after *= 0.5
        if is_astride(stretch.dry) and high >= 1.0 - _AT_END:
            which, moment = k, high * h
            continue
        mx, my = _on_curve(wx, wy, h, surface, first, last, high - _ASIDE)
        after = room_by(ground, k, how, radius, y[X] + mx, y[Y] + my)
        mx, my = _on_curve(wx, wy, h, surface, first, last, high + _ASIDE)
        slope = 0.5 * (room_by(ground, k, how, radius, y[X] + mx, y[Y] + my) - after) / _ASIDE
        found = _on_steps(ground, k, how, stretch, t, high * h, h, slope / h, y, scale, work, new)
        if found < moment:
            which, moment = k, found
    return which, moment, clear


@inner
def _on_steps(
    ground: FloatArray, k: int, how: int, stretch: Stretch, t: float, near: float, h: float,
    slope: float, y: FloatArray, scale: FloatArray, work: FloatArray, new: FloatArray,
) -> float:  # fmt: skip
    """When on real steps there is no room by a patch, from close by and about how fast it goes."""
    radius, one, other, before = stretch.model.body.radius, near, near, 0.0
    for n in range(_SECANTS):
        step(stretch, t, one, y, scale, work, new)
        value = room_by(ground, k, how, radius, new[X], new[Y])
        if n > 0 and value != before:
            slope = (value - before) / (one - other)
        if slope == 0.0:
            break
        better = min(max(one - value / slope, 0.0), h)
        other, one, before = one, better, value
        if abs(one - other) <= _NEAR * h or t + one == t + other:  # what is left is rounding
            break
    return one
