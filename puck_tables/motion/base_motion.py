"""The free motion of a puck on a base of any shape under a constant coefficient of friction.

In natural units, Q₀ = J = 1 with Q = hypot(v, kΩ), k the radius of gyration, in which J is the
force of friction over the mass: times in Q₀/J, places in Q₀²/J.  With F and M the force and the
torque of friction over f N, s = kΩ, in dτ = dt/Q:

    dv/dτ = q F,  ds/dτ = q M/k,  dx/dτ = q v,  dt/dτ = q,  dθ/dτ = q s Q₀²/(J k).

F and M depend on the direction of (v, s) and on the angle θ of the body alone, so q falls like
e^(−τ) and the steps stay as long as they are up to the stop.  How fast it falls then changes by
little: the last of q is slid at one direction of (v, s), in closed form.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.base_friction import AREA, REACH, SIDES, base_friction
from puck_tables.kernels.compile import inlined, inner, patience
from puck_tables.motion.steppers import DORMAND_PRINCE_8, times_as_long

# of a motion: velocity, kΩ, angle of the body over Q₀²/(J k), time, place, length of the path, and
# work of friction; the first four have a say in friction
SIZE = 9
VX, VY, RIM, TURN, T, X, Y, LENGTH, WORK = range(SIZE)
STATE_SIZE = 6  # of a state: place, heading of the velocity, angle of the body, speed, kΩ
STOPPED, STEP_LIMIT = 0, 1  # how it ends, as in stopping.solvers.STATUS_MEANINGS

STAGES = len(DORMAND_PRINCE_8.c) - 1  # those of a step; the last row is the first of the next one
ROWS = STAGES + 2  # of the work space: the stages, a state on the way, and the end of a step
_A, _B = DORMAND_PRINCE_8.a, DORMAND_PRINCE_8.b
_ERROR_5, _ERROR_3 = DORMAND_PRINCE_8.e
# of each stage, the first one besides that at the start that it is made of; and of the end
_SECOND = np.array([[*np.flatnonzero(row), n, n][1] for n, row in enumerate(_A)])
_LATE = int(_SECOND[-1])
_PART, _END = STAGES, STAGES + 1

_FIRST_STEP, _SHORTEST_STEP, _LONGEST_STEP = 0.05, 1e-12, 2.5  # of τ, in which q falls like e^(−τ)
_ROUNDING = 1e-14  # of friction over f N, and so much more of a long, thin base
MOST_STEPS = 1_000_000  # more is a body that turns for hours
_NEWTON = 12  # steps to the state at a moment: two or three do


@inlined
def noise_of(base: FloatArray) -> float:
    """By how much friction over f N may be off, by rounding."""
    thin = base[REACH] * base[REACH] / base[AREA] if base[SIDES] > 0.0 else 1.0
    return _ROUNDING * max(1.0, thin)


@inlined
def _rates(
    base: FloatArray, gyration: float, turning: float, work: FloatArray, stage: int,
    vx: float, vy: float, rim: float, turn: float,
) -> None:  # fmt: skip
    """Rates in τ of a state into a row of ``work``."""
    fx, fy, torque = base_friction(base, turning * turn, vx, vy, rim / gyration)
    torque /= gyration
    speed = math.sqrt(vx * vx + vy * vy)
    q = math.sqrt(speed * speed + rim * rim)
    work[stage, VX], work[stage, VY], work[stage, RIM] = q * fx, q * fy, q * torque
    work[stage, TURN], work[stage, T] = q * rim, q
    work[stage, X], work[stage, Y], work[stage, LENGTH] = q * vx, q * vy, q * speed
    work[stage, WORK] = -q * (fx * vx + fy * vy + torque * rim)


@inner
def _step(
    base: FloatArray, gyration: float, turning: float, y: FloatArray, h: float, work: FloatArray,
    end: int,
) -> None:  # fmt: skip
    """A step from ``y`` over h into a row of ``work``, whose first holds the rates at its start."""
    for stage in range(1, STAGES):
        weight = h * _A[stage, 0]
        vx, vy = y[VX] + weight * work[0, VX], y[VY] + weight * work[0, VY]
        rim, turn = y[RIM] + weight * work[0, RIM], y[TURN] + weight * work[0, TURN]
        for k in range(_SECOND[stage], stage):
            weight = h * _A[stage, k]
            vx, vy = vx + weight * work[k, VX], vy + weight * work[k, VY]
            rim, turn = rim + weight * work[k, RIM], turn + weight * work[k, TURN]
        _rates(base, gyration, turning, work, stage, vx, vy, rim, turn)
    for i in range(SIZE):
        rate = _B[0] * work[0, i]
        for k in range(_LATE, STAGES):
            rate += _B[k] * work[k, i]
        work[end, i] = y[i] + h * rate


@inlined
def _missed(work: FloatArray, h: float, arm: float) -> float:
    """The error of a step just done; ``arm``: the reach of the base over k.

    An angle errs by how far it moves the farthest point.
    """
    largest = 0.0
    for i in range(WORK):
        fifth, third = _ERROR_5[0] * work[0, i], _ERROR_3[0] * work[0, i]
        for k in range(_LATE, STAGES):
            fifth += _ERROR_5[k] * work[k, i]
            third += _ERROR_3[k] * work[k, i]
        weight = h if i != TURN else h * arm
        fifth, third = weight * fifth, weight * third
        square = fifth * fifth
        below = square + 0.01 * third * third
        error = 0.0 if below == 0.0 else square * square / below
        if not error <= largest:  # a NaN is never small
            largest = error
    return math.sqrt(largest)


@inlined
def _tail(y: FloatArray, work: FloatArray, turning: float) -> tuple[float, float]:
    """How fast ln q falls in τ, and the direction of (v, s) as the body has it changes."""
    q = work[0, T]
    ex, ey, es = y[VX] / q, y[VY] / q, y[RIM] / q
    fx, fy, fs = work[0, VX] / q, work[0, VY] / q, work[0, RIM] / q
    falls = -(ex * fx + ey * fy + es * fs)
    across = math.sqrt(
        (fx + falls * ex) ** 2 + (fy + falls * ey) ** 2 + (fs + falls * es) ** 2
    )  # fmt: skip
    across += turning * abs(y[RIM]) * math.sqrt(ex * ex + ey * ey)
    return falls, across


@inlined
def _write(y: FloatArray, share: float, left: float, states: FloatArray, n: int) -> None:
    """A state with a ``share`` of its velocities left, ``left``: of time at its place."""
    speed = math.sqrt(y[VX] * y[VX] + y[VY] * y[VY])
    gone = 0.5 * left * (1.0 - share * share)
    states[n, 0], states[n, 1] = y[X] + gone * y[VX], y[Y] + gone * y[VY]
    states[n, 2] = math.atan2(y[VY], y[VX]) if speed > 0.0 else 0.0
    states[n, 3] = y[TURN] + gone * y[RIM]
    states[n, 4], states[n, 5] = share * speed, share * y[RIM]


@inner
def _fill_between(
    base: FloatArray, gyration: float, turning: float, y: FloatArray, h: float, work: FloatArray,
    times: FloatArray, begin: int, states: FloatArray,
) -> int:  # fmt: skip
    """States at the moments in a step, from ``begin`` on; returns the first one after it.

    There is no interpolation error: a moment is found by Newton's method on steps from the start.
    """
    n, span = begin, work[_END, T] - y[T]
    while n < times.size and times[n] < work[_END, T]:
        part = h * min(1.0, max(0.0, (times[n] - y[T]) / span))
        for _ in range(_NEWTON):
            _step(base, gyration, turning, y, part, work, _PART)
            off = times[n] - work[_PART, T]
            if abs(off) <= 4e-16 * max(1.0, times[n]):
                break
            vx, vy, rim = work[_PART, VX], work[_PART, VY], work[_PART, RIM]
            part = min(h, max(0.0, part + off / math.sqrt(vx * vx + vy * vy + rim * rim)))
        _write(work[_PART], 1.0, 0.0, states, n)
        n += 1
    return n


@inner
def slide(
    base: FloatArray, gyration: float, turning: float, local: float, y: FloatArray,
    work: FloatArray, times: FloatArray, states: FloatArray,
) -> tuple[int, int, float, float]:  # fmt: skip
    """From a launch to the stop; where moments are asked for, not beyond the step over the last.

    ``base``: as :func:`puck_tables.kernels.base_friction.packed` has it, lengths as ``gyration``,
    k; ``turning``: Q₀²/(J k); ``local``: the error of a step; ``y`` (9,): the launch, of q = 1;
    then the stop, with velocities just before it, or the end of the last step; ``work`` (ROWS, 9);
    ``times``, ``states``: moments (n,), in order, and room for states there, (n, 6).

    Returns status, number of steps, the largest difference between energy lost and work over the
    energy, and how fast the direction of (v, s) still changes, per factor e of q.
    """
    arm, steps, n, residual = base[REACH] / gyration, 0, 0, 0.0
    h, noise = _FIRST_STEP, noise_of(base)
    _rates(base, gyration, turning, work, 0, y[VX], y[VY], y[RIM], y[TURN])
    while True:
        patience(1)
        falls, across = _tail(y, work, turning)
        left, change = work[0, T] / falls, min(1.0, across / falls)
        if left * change <= local:
            break
        _step(base, gyration, turning, y, h, work, _END)
        error = _missed(work, h, arm)
        rounding = noise * h * max(1.0, arm, turning * work[0, T])
        error = 0.0 if error <= rounding else error / min(1.0, h * falls)
        if error <= local:
            n = _fill_between(base, gyration, turning, y, h, work, times, n, states)
            for i in range(SIZE):
                y[i] = work[_END, i]
            steps += 1
            _rates(base, gyration, turning, work, 0, y[VX], y[VY], y[RIM], y[TURN])
            lost = 0.5 * (1.0 - work[0, T] * work[0, T])
            residual = max(residual, 2.0 * abs(lost - y[WORK]))
            if 0 < times.size == n:
                return STOPPED, steps, residual, 1.0
        elif not h > _SHORTEST_STEP:
            return STEP_LIMIT, steps, residual, 1.0
        h = min(_LONGEST_STEP, h * times_as_long(error, local, 0.125, 0.2))
        if steps == MOST_STEPS:
            return STEP_LIMIT, steps, residual, 1.0
    stop = y[T] + left
    while n < times.size:
        share = min(1.0, max(0.0, (stop - times[n]) / left))
        _write(y, share, left, states, n)
        n += 1
    y[T] = stop
    y[X], y[Y], y[TURN] = (
        y[X] + 0.5 * left * y[VX], y[Y] + 0.5 * left * y[VY], y[TURN] + 0.5 * left * y[RIM],
    )  # fmt: skip
    y[LENGTH] += 0.5 * left * math.sqrt(y[VX] * y[VX] + y[VY] * y[VY])
    return STOPPED, steps, residual, change
