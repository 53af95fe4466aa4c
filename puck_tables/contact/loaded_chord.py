"""The chord that bounds the loaded part of the base: the balance of moments solved for it.

The two equations are those of :mod:`puck_tables.contact.one_sided`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact import closed_form
from puck_tables.contact.integrals import PatchIntegrals, SlipDirection
from puck_tables.contact.loaded_patch import patch_rule, segment
from puck_tables.contact.resultants import moment_balance
from puck_tables.errors import AccuracyError

_STEPS = 60  # of Newton's method: then another guess is tried
_SETTLED = 1e-7  # a step of that size leaves an error of its square
_EASY_DELTA = 3.9  # dimensionless: up to it the guess leads to the solution
_FOLLOWED = 33  # heights from there to the wanted one: each is a good guess for the next
_MAX_TURN = 0.3  # radians a step


class Chord(NamedTuple):
    """The chord that bounds the loaded part: distance d from the centre and bearing γ of the load.

    d ≤ −1 in full contact, where the pressure is (N/πr²)(1 − n·(x, y)/d).
    """

    offset: FloatArray
    bearing: FloatArray


def guessed_chord(ratio: FloatArray, fast: npt.NDArray[np.bool_], delta: FloatArray) -> Chord:
    """The tilt of the linear law, as far as the load can move: |⟨(x, y)⟩| = m(d) ≤ δ/4.

    Parameters
    ----------
    ratio, fast : arrays (n,), min(v, r|ω|)/max(v, r|ω|), and whether r|ω| > v
    delta : array (n,), dimensionless height

    Examples
    --------
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
        moving[moving] = ~((np.abs(step) <= _SETTLED * room) & (np.abs(turn) <= _SETTLED))
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
