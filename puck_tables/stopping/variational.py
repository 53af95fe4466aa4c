"""Derivatives of stops and states of pucks that no stop table holds, by variational equations.

A launch is integrated in natural units together with its variations
(:mod:`puck_tables.motion.variation`); rotation, reflection and scale give the rest.  With Q = 1,
c = cos φ, s = sin φ, and a quantity F = Q^n f(u, δ), u = ln(rω/v),

    ∂F/∂v = n c f − f_u/c,    ∂F/∂(rω) = n s f + f_u/s .

Exact pure sliding and pure spin have the derivatives of launches 1e-25 beside them: the first
derivatives are continuous there.

Of many launches of one kind of puck the derivatives of stops in natural units are splined: a launch
costs a look-up and the way back to SI units, once a second or two were spent on the splines.  They
carry broken powers of φ at both ends, by one smaller than those of the stop, and may be too steep
there, or next to a line of the friction, for any spline: launches in such cells, few as these are,
are integrated.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import run_chunks
from puck_tables.errors import AccuracyError, InputError
from puck_tables.kernels.quadratic import LINE
from puck_tables.motion.body import UnitPuck
from puck_tables.motion.path import STOPPED, integrate
from puck_tables.motion.state import LENGTH, PSI, SIZE, THETA, T, U, X, Y
from puck_tables.motion.steppers import DORMAND_PRINCE
from puck_tables.motion.unit_motion import Frame, direction
from puck_tables.stopping.launch_derivatives import (
    STATES,
    at_same_time,
    by_launch,
    fill_placed_stops,
    rotated,
)
from puck_tables.table.friction_section import FrictionSlopes, friction_slopes_of, slopes_of_table
from puck_tables.table.singular_lines import lines_of
from puck_tables.table.slip_spline import refinements, sides_of

MANY = 3000  # launches of one height from which on splines cost less than integrating each
SPLINE_ERROR = 3e-8  # of Q, J, r: a third of what derivatives are promised to
# a side, doubled between: finer costs more than integrating
_COARSEST_CELLS, _FINEST_CELLS = 32, 512
_NEAR = 0.25  # of a side in ξ, 1/256 of it in φ: what may be too steep
_PLACED_AT_ONCE = 1 << 13  # launches that a thread takes at once
LOCAL = 1e-10  # of a step: derivatives are promised to 1e-7
_TINY = 1e-25  # for a cos φ or sin φ that is divided by
_STEP_LIMIT = 20_000  # more is a motion that does not end
_CHUNK = 16  # motions that a thread takes at once
_AT_LINE = 3e-6  # nearer to a line that is the limit the derivative is not known to 1e-7
_POWERS = np.array([1.0, 2.0, 2.0, 2.0, 2.0])  # of Q
_STOP = [T, X, Y, LENGTH, THETA]
_LEAST_SHARE = 1e-30  # of Q


class SlopeSection(NamedTuple):
    """Twenty functions of φ, and in which cells (sides, cells) they are good.

    Time, along, to the left, path, body angle, by the four columns of
    :func:`puck_tables.stopping.variational.unit_stops` each.
    """

    coefficients: FloatArray
    good: npt.NDArray[np.bool_]


@lru_cache(maxsize=16)
def slope_section(body: UnitPuck) -> SlopeSection:
    """Tabulate the derivatives of the stops of one kind of puck.

    The error is measured in the middles of all cells.
    """
    friction = variations_of(body)
    sides = sides_of(lines_of(body.law, body.delta)[::-1], ends_too=True)

    def at(phi: FloatArray) -> FloatArray:
        cosine = np.where(phi >= 0.5 * np.pi, 0.0, np.cos(phi))
        return unit_stops(friction, cosine, np.sin(phi)).reshape(phi.size, -1)

    for spline, xi, off in refinements(at, sides, False, _COARSEST_CELLS, _FINEST_CELLS):
        section = SlopeSection(spline.coefficients, off.max(axis=2) <= SPLINE_ERROR)
        if section.good[:, xi > _NEAR].all():
            break
    return section


def stop_slopes_of(body: UnitPuck, launches: FloatArray, threads: int | None = None) -> FloatArray:
    """Derivatives (n, 5, 6) of the stops of launches (6, n) of one kind of puck, none at rest.

    >>> from puck_tables.motion.body import body_of
    >>> launches = np.array([[1.0], [0.0], [0.0], [2.0], [1.0], [1.0]])
    >>> result = stop_slopes_of(body_of("uniform", 2.0, 0.5**0.5), launches)
    >>> result[0, 1].round(6).tolist()  # x of a slide: v²/2J
    [1.0, 0.0, 0.0, 0.0, -0.5, 0.0]
    """
    from puck_tables.stopping.stop_section import fill_section_slopes

    count, friction = launches.shape[1], variations_of(body)
    own, left = np.empty((count, 5, 4)), np.ones(count, np.bool_)
    speed, rim = np.hypot(launches[0], launches[1]), np.abs(launches[5] * launches[2])
    friction.refuse_limit(speed, rim)
    if count >= MANY and not friction.limits:
        section = slope_section(body)

        def work(start: int, stop: int) -> None:
            part = slice(start, stop)
            fill_section_slopes(speed[part], rim[part], *section, own[part], left[part])

        run_chunks(work, count, _PLACED_AT_ONCE, threads)
    if left.any():
        slip = np.hypot(speed, rim)[left]
        own[left] = unit_stops(friction, speed[left] / slip, rim[left] / slip)
    out = np.empty((count, 5, 6))

    def place(start: int, stop: int) -> None:
        some = np.ascontiguousarray(launches[:, start:stop])
        fill_placed_stops(some, own[start:stop], out[start:stop])

    run_chunks(place, count, _PLACED_AT_ONCE, threads)
    return out


class Variations(NamedTuple):
    """Friction of one kind of puck as motions and their variations read it.

    ``limits``: ln(rω/v) of lines of the friction that are the limit of its motions, as of a ring
    with k = r: next to them it has no derivative.
    """

    delta: float
    ratios: FloatArray
    slopes: FloatArray
    limits: tuple[float, ...]

    def refuse_limit(self, speed: FloatArray, rim: FloatArray) -> None:
        """Refuse launches of these v and r|ω|, arrays, at a line that is the limit."""
        for line in self.limits:
            if (np.abs(rim - np.exp(line) * speed) < _AT_LINE * np.hypot(speed, rim)).any():
                raise InputError(
                    f"a launch at r w/v = {np.exp(line):.6g}, the limit of this puck, where its "
                    "friction has no derivative, is not differentiated: move it by 1e-5, or leave "
                    "out jacobian=True"
                )


@lru_cache(maxsize=64)
def variations_of(body: UnitPuck) -> Variations:
    """The friction of a puck."""
    if body.table is not None:
        return variations_by(slopes_of_table(body.table, body.delta), body.gyration)
    try:
        return variations_by(friction_slopes_of(body.law, body.delta), body.gyration)
    except AccuracyError as error:
        raise AccuracyError(
            f"derivatives are out of reach of a puck of delta = {body.delta:g} under the pressure "
            f"law {body.law.name} (its friction is known to {error.reachable:.1g} only): leave out "
            "jacobian=True, or take differences"
        ) from None


def variations_by(source: FrictionSlopes, gyration: float) -> Variations:
    """The friction of a puck, with its slopes, from a section."""
    ratios, slopes = source.for_motion(gyration), source.for_slopes(gyration)
    limits = np.unique(slopes[np.isinf(ratios[:, LINE]), LINE])
    return Variations(source.delta, ratios, slopes, tuple(limits.tolist()))


def unit_stops(friction: Variations, cosine: FloatArray, sine: FloatArray) -> FloatArray:
    """Stops with Q = J = r = 1 and their derivatives.

    ``cosine``, ``sine``: arrays (n,), of the slip angle of the launch, ≥ 0, one or the other may be
    0.  Returns array (n, 5, 4): rows: time, along, to the left, path, body angle.  Columns: itself,
    for along and left over v; by v, rω, δ.

    >>> from puck_tables.motion.body import body_of
    >>> friction = variations_of(body_of("ring", 0.5, 1.0))
    >>> (unit_stops(friction, np.array([1.0]), np.array([0.0]))[0, 0].round(6) + 0.0).tolist()
    [1.0, 1.0, 0.0, 0.0]
    """
    from puck_tables.motion.variation import BLOCKS, KEPT, VARIED, fill_stop_variations

    c, s = np.maximum(cosine, _TINY), np.maximum(sine, _TINY)
    u = np.log(s / c)
    rows = np.empty((u.size, VARIED))

    def work(start: int, stop: int) -> None:
        part = slice(start, stop)
        fill_stop_variations(
            u[part], c[part], friction.delta, DORMAND_PRINCE, LOCAL, friction.ratios,
            friction.slopes, rows[part],
        )  # fmt: skip

    run_chunks(work, u.size, _CHUNK)
    stops = rows.reshape(u.size, BLOCKS, KEPT)[:, :, _STOP]
    value, by_u, by_height = stops.transpose(1, 0, 2)
    ratios: Any = c[:, None], s[:, None]
    by_slip: Any = _POWERS * value
    by_angle: Any = by_u / (c * s)[:, None]
    out = np.stack([value, *rotated(by_slip, by_angle, *ratios), by_height], axis=-1)
    out[:, 1:3, 0] /= ratios[0]
    return out


def unit_states(
    friction: Variations, frame: Frame, times: FloatArray, local: float = LOCAL
) -> FloatArray:
    """States of one launch with Q = J = r = 1 at times, and their derivatives.

    ``frame``: of the launch, which moves; ``times``: array (n,), s, ≥ 0; ``local``: the error of a
    step.  Returns array (n, 6, 6): of x, y, body angle, vx, vy, rω: themselves; by v, v across,
    rω, δ, time; body angle and rω as of counter-clockwise spin.
    """
    from puck_tables.motion.variation import VARIED, fill_state_variations, vary

    c, s = max(frame.speed / frame.slip, _TINY), max(frame.rim / frame.slip, _TINY)
    u, times = float(np.log(s / c)), times / frame.time
    z, y = np.empty(_STEP_LIMIT), np.empty((_STEP_LIMIT, SIZE))
    result, work, stop = np.empty(SIZE + 1), np.empty((8, VARIED)), np.empty(VARIED)
    status, count = integrate(
        u, DORMAND_PRINCE, 0.0, local, c, friction.ratios, friction.delta, _STEP_LIMIT, z, y,
        result,
    )  # fmt: skip
    if status != STOPPED:
        raise AccuracyError("a motion was too long to be differentiated: leave out jacobian=True")
    path, ends = np.empty((count, VARIED)), z[:count]
    vary(ends, u, DORMAND_PRINCE, friction.slopes, path, stop, work)
    which, z = _moments(times, ends, path, stop, friction)
    rows, rates = np.empty((times.size, VARIED)), np.empty((times.size, VARIED))
    fill_state_variations(z, which, ends, path, stop, DORMAND_PRINCE, friction.slopes, rows, rates)
    return _own_states(rows, rates, z, times, (c, s), frame)


def _own_states(
    rows: FloatArray, by_z: FloatArray, z: FloatArray, times: FloatArray,
    ratios: tuple[float, float], frame: Frame,
) -> FloatArray:  # fmt: skip
    """States (n, 6, 6) at ``times`` from a motion and its variations (n, 21) at z (n,), 1 at rest.

    ``by_z``: d/dz of the motion; ``ratios``: v/Q and r|ω|/Q at the launch.
    """
    from puck_tables.motion.variation import BLOCKS, KEPT

    def in_world(along: Any, left: Any) -> Any:
        return rotated(along, frame.side * left, frame.east, frame.north)

    def change(block: Any) -> Any:
        places = in_world(block[X], block[Y])
        return block[U], frame.side * block[PSI], block[T], *places, block[THETA]

    (c, s), (own, by_u, by_height) = ratios, rows.reshape(-1, BLOCKS, KEPT).transpose(1, 2, 0)
    cosine, sine = direction(own[U])
    east, north = in_world(np.cos(own[PSI]), np.sin(own[PSI]))
    q, quarter = (1.0 - z) ** 4, 0.25 * (1.0 - z)  # −dz/d ln Q
    speed, rim = q * cosine, q * sine
    at_times: Any = times
    value: Any = *in_world(own[X], own[Y]), own[THETA], speed * east, speed * north, rim
    fall = 1.0 / np.where(z < 1.0, by_z[:, T] * quarter, np.inf)
    swing = -frame.side * by_z[:, PSI] * quarter
    moving: Any = speed, rim, cosine, sine, east, north, fall, by_z[:, U] * quarter, swing
    own_states = by_launch(
        c, s, 1.0 / c, at_times, value,
        at_same_time(change(by_u / (c * s)), moving), at_same_time(change(by_height), moving),
        at_same_time((0.0, 0.0, -1.0, 0.0, 0.0, 0.0), moving),
    )  # fmt: skip
    columns = [np.broadcast_to(one, z.shape) for one in own_states]
    return np.stack(columns, axis=-1).reshape(-1, STATES, STATES)


def _moments(
    times: FloatArray, ends: FloatArray, path: FloatArray, stop: FloatArray, friction: Variations
) -> tuple[npt.NDArray[np.int64], FloatArray]:
    """The last step end before each time, and z there, 1 at rest."""
    from puck_tables.motion.path import states_at
    from puck_tables.motion.variation import KEPT

    which = np.searchsorted(path[:, T], times, side="right") - 1
    which = np.clip(which, 0, ends.size - 1)
    states = np.empty((ends.size, SIZE))
    states[:, :KEPT] = path[:, :KEPT]
    states[:, SIZE - 1] = 0.0
    rest = np.zeros(SIZE + 1)
    rest[:KEPT] = stop[:KEPT]
    q, y = np.empty(times.size), np.empty((times.size, SIZE))
    states_at(times, ends, states, rest, DORMAND_PRINCE, friction.ratios, friction.delta, q, y)
    return which, np.where(q > 0.0, 1.0 - np.maximum(q, _LEAST_SHARE) ** 0.25, 1.0)
