"""Slides of pucks on bases of any shape: from launches in SI units to stops and states.

``tol`` bounds the error of a stop: of its time in units of Q₀/J, of its place in Q₀²/J, and of how
far the farthest point of the base has turned with it, in Q₀²/J.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import AccuracyError, InputError, PuckError
from puck_tables.kernels.base_friction import LEVER, REACH
from puck_tables.kernels.compile import allocating, patience
from puck_tables.kernels.patience import A_MOTION
from puck_tables.motion.base_motion import (
    LENGTH,
    MOST_STEPS,
    RIM,
    ROWS,
    SIZE,
    STATE_SIZE,
    STOPPED,
    TURN,
    VX,
    VY,
    T,
    X,
    Y,
    noise_of,
    slide,
)
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.motion.solve import ErrorEstimate, close_enough

WHY_INTEGRATED = (
    "On a base that is not round friction depends on how the body stands to its velocity, too, so "
    "the stops of all launches are no one curve to look up; friction itself is summed along the "
    "sides of the base, in closed form."
)
FINEST, COARSEST = 1e-12, 1e-2  # tol: finer is rounding; looser nobody measured
LONGEST = 25.0  # Q₀/J: the longest slide, of a radius of gyration of 10 times the reach
OVERFLOW = 2  # index of solvers.STATUS_MEANINGS

# The local error over tol, of flywheels (k beyond the reach) less by as much as they take longer.
# Measured on 1,100 random slides, k from 0.1 to 10 times the reach and Q₀²/(J k) up to 3,000: an
# error is at most 26 times the local one, in the median 0.01 times; of 170 flywheels 0.43 of tol.
_LOCAL = 1.0 / 30.0
_FINER = 0.01  # of the local error: a slide that tells the error of another
_ROUNDING = 10.0  # of a slide as long as Q₀/J, over that of friction

# rows of what comes out of a slide: time, place, path length, 0, angle of the body, as in
# solvers.OUTPUTS; steps, energy residual, how fast the direction of (v, kΩ) changes per factor e of
# Q, and that direction at the stop, atan2(k|Ω|, v)
OUT_ROWS = 10
STOP_TIME, STOP_X, STOP_Y, PATH, _, BODY_ANGLE, STEPS, RESIDUAL, CHANGE, ENDING = range(OUT_ROWS)


@allocating
def fill_slides(
    base: FloatArray, launches: FloatArray, local: float, ends: npt.NDArray[np.int64],
    moments: FloatArray, out: FloatArray, states: FloatArray, status: npt.NDArray[np.int8],
) -> None:  # fmt: skip
    """Slides of launches (6, n): vx, vy, ω, f z (m), J, k.

    ``base``: as :func:`puck_tables.kernels.base_friction.packed` has it; ``moments`` (m,): times in
    Q₀/J, those of launch i from ``ends[i]`` to ``ends[i + 1]``, in order; into ``out``
    (OUT_ROWS, n) (of the stop, but of a launch with moments), ``states`` (m, 6) as
    :mod:`puck_tables.motion.state` has those of a puck, and ``status`` (n,).
    One launch never influences another, so any cutting into chunks gives the same bits.
    """
    patience(A_MOTION * launches.shape[1])
    own, y, work = base.copy(), np.empty(SIZE), np.empty((ROWS, SIZE))
    for n in range(launches.shape[1]):
        patience(1)
        begin, end = ends[n], ends[n + 1]
        vx, vy, spin = launches[0, n], launches[1, n], launches[2, n]
        decel, gyration = launches[4, n], launches[5, n]
        q0 = math.hypot(math.hypot(vx, vy), gyration * spin)
        time = q0 / decel
        length = time * q0
        turning = length / gyration
        fits = math.isfinite(LONGEST * (length + turning))
        status[n] = STOPPED if fits else OVERFLOW
        if q0 == 0.0 or not fits:
            out[:, n] = 0.0 if fits else math.nan
            states[begin:end] = 0.0 if fits else math.nan
            continue
        own[LEVER] = launches[3, n]
        for i in range(SIZE):
            y[i] = 0.0
        y[VX], y[VY], y[RIM] = vx / q0, vy / q0, gyration * spin / q0
        finer = local * min(1.0, base[REACH] / gyration)  # of slides that take as much longer
        status[n], steps, residual, change = slide(
            own, gyration, turning, finer, y, work, moments[begin:end], states[begin:end]
        )
        if status[n] != STOPPED:
            out[:, n] = math.nan
            states[begin:end] = math.nan
            continue
        out[STOP_TIME, n], out[PATH, n] = y[T] * time, y[LENGTH] * length
        out[STOP_X, n], out[STOP_Y, n] = y[X] * length, y[Y] * length
        out[_, n], out[BODY_ANGLE, n] = 0.0, y[TURN] * turning
        out[STEPS, n], out[RESIDUAL, n], out[CHANGE, n] = steps, residual, change
        out[ENDING, n] = math.atan2(abs(y[RIM]), math.hypot(y[VX], y[VY]))
        for m in range(begin, end):
            states[m, 0] *= length
            states[m, 1] *= length
            states[m, 3] *= turning
            states[m, 4] *= q0
            states[m, 5] *= q0 / gyration


def local_error(tol: float) -> float:
    """The error of a step that keeps a slide to a tolerance.

    Raises AccuracyError if the tolerance is out of reach.

    >>> local_error(3e-7)
    1e-08
    """
    if not FINEST <= tol <= COARSEST:
        raise AccuracyError(
            f"tol must be from {FINEST:g} to {COARSEST:g} for a puck on a base, got {tol:g}: give "
            "a tol in that range"
        )
    return tol * _LOCAL


def launch_rows(puck: PuckSpec, velocity: FloatArray, spin: FloatArray) -> FloatArray:
    """Launches (6, n), as :func:`fill_slides` takes them, of velocities (n, 2) and spins (n,)."""
    puck_numbers = np.array([[puck.lever], [puck.decel], [puck.inertia_radius]])
    rows = np.empty((6, len(velocity)))
    rows[:2], rows[2], rows[3:] = velocity.T, spin, puck_numbers
    return rows


@dataclass(frozen=True)
class BaseSlide:
    """One slide of a puck on a base, SI units.

    ``launch`` (6, 1) and ``out`` (OUT_ROWS,): see above, as the body has them at the launch;
    ``error``: of the stop, in units of Q₀/J and Q₀²/J; ``local``: the error of a step;
    ``orientation`` rad: of the body at the launch.
    """

    puck: PuckSpec
    launch: FloatArray = field(repr=False)
    local: float
    out: FloatArray = field(repr=False)
    error: float
    orientation: float = 0.0

    @property
    def slip(self) -> float:
        """Q₀ = hypot(v, kω) of the launch, m/s."""
        vx, vy, spin, _, _, gyration = self.launch[:, 0].tolist()
        return math.hypot(vx, vy, gyration * spin)

    @property
    def stop_time(self) -> float:
        """Seconds."""
        return float(self.out[STOP_TIME])

    @property
    def stop_position(self) -> tuple[float, float]:
        """Metres from the launch."""
        x, y = _turned(self.out[STOP_X], self.out[STOP_Y], self.orientation)
        return float(x), float(y)

    @property
    def path_length(self) -> float:
        """Metres."""
        return float(self.out[PATH])

    @property
    def body_angle(self) -> float:
        """How far the body turns, rad."""
        return float(self.out[BODY_ANGLE])

    @property
    def steps(self) -> int:
        """How many there are."""
        return int(self.out[STEPS])

    @property
    def energy_residual(self) -> float:
        """The largest difference between energy lost and work of friction, over the energy."""
        return float(self.out[RESIDUAL])

    @property
    def explanation(self) -> str:
        """How it was got, why in that way, and how it ends."""
        change, angle = self.out[CHANGE], float(self.out[ENDING])
        ending = f"At the stop v : k|w| = {math.cos(angle):.4f} : {math.sin(angle):.4f}"
        turns = f", still turning by {change:.2g} rad per factor e of Q" if change > _TURNS else ""
        if self.slip == 0.0:
            ending, turns = "Nothing moves", ""
        return (
            f"integrated in dt/Q, Q = hypot(v, k w), order 8, {self.steps} steps that err by "
            f"{self.local:.2g} at most; against finer steps the stop errs by {self.error:.2g} of "
            f"Q/(f g) (time) and Q^2/(f g) (place).\n{WHY_INTEGRATED}\n{ending}{turns}."
        )

    @property
    def end(self) -> str:
        """How it ends, told by the direction of (v, kΩ) at the stop, and where that leads."""
        if self.slip == 0.0:
            return "rest"
        angle = float(self.out[ENDING])
        if angle < _ALONE:
            return "slide last"
        if angle > 0.5 * math.pi - _ALONE:
            return "spin last"
        if self._turns_about_a_foot():
            return "pivot"
        return "cycle" if self.puck.lever > 0.0 and self._turns_on() else "together"

    def _late(self) -> tuple[float, float, float]:
        """Velocity, in the axes of the body, and kΩ as long before the stop as both are known."""
        early = 1.0 - max(_KNOWN * self.local, 1e-7)
        _, _, heading, angle, speed, spin = self.states(np.array([early * self.stop_time]))[:, 0]
        vx, vy = _turned(speed, 0.0, heading - angle)
        return float(vx), float(vy), float(spin) * self.puck.inertia_radius

    def _turns_about_a_foot(self) -> bool:
        """Whether the instantaneous centre lies in a foot at the stop."""
        shape = self.puck.shape
        assert shape is not None
        feet = [disc for disc in shape.discs if disc[3] > 0.0]
        if not feet or len(feet) + len(shape.outlines) == 1:
            return False
        (x, y), (vx, vy, rim) = shape.middle, self._late()
        per = self.puck.inertia_radius / rim
        centre = x - per * vy, y + per * vx
        return any(math.dist(centre, foot[:2]) < foot[2] for foot in feet)

    def _turns_on(self) -> bool:
        """Whether the direction of (v, kΩ) would never settle, however long Q fell on."""
        puck, none, nothing = self.puck, np.empty(0), np.empty((0, STATE_SIZE))
        slide, changes = self, []
        for _ in range(_MORE_SLIDES):
            vx, vy, rim = slide._late()
            slower = _SLOW / math.hypot(vx, vy, rim)
            spin = np.array([slower * rim / puck.inertia_radius])
            launch = launch_rows(puck, slower * np.array([[vx, vy]]), spin)
            out = _followed(puck, launch, FINEST, none, nothing)
            slide = BaseSlide(puck, launch, FINEST, out, FINEST)
            changes.append(out[CHANGE])
        return bool(changes[-1] > _TURNS and changes[-1] > 0.1 * changes[0])

    def states(self, times: FloatArray) -> FloatArray:
        """States (6, n) at times (n,) s ≥ 0: as :mod:`puck_tables.motion.state` has them."""
        order = np.argsort(times, kind="stable")
        rows = np.empty((times.size, STATE_SIZE))
        moments = times[order] / (self.slip / self.puck.decel or 1.0)
        _followed(self.puck, self.launch, self.local, moments, rows)
        states = np.empty_like(rows)
        states[order] = rows
        x, y, heading, angle, speed, spin = states.T
        heading = np.where(speed > 0.0, heading + self.orientation, heading)
        x, y = _turned(x, y, self.orientation)
        return np.stack([x, y, heading, angle + self.orientation, speed, spin])


_KNOWN = 1e4  # times the error of a step: with so much left of Q its direction is known
# slides after the stop, each over a factor of 1e7 of Q or more, on which the body does not turn
_MORE_SLIDES, _SLOW = 12, 1e-8
_TURNS = 1e-3  # rad: a direction that turns by less is that of the end
_ALONE = 0.01  # rad: nearer to pure sliding or spinning at the stop, the other has died out first


def _turned(x: Any, y: Any, angle: float) -> tuple[Any, Any]:
    cosine, sine = math.cos(angle), math.sin(angle)
    return x * cosine - y * sine, x * sine + y * cosine


def slide_of(
    puck: PuckSpec, velocity: tuple[float, float], spin: float, tol: float,
    orientation: float = 0.0,
) -> BaseSlide:  # fmt: skip
    """The slide after a launch, its error measured against a finer one.

    ``orientation`` rad: of the body at the launch.

    Raises AccuracyError if the tolerance is out of reach; InputError if the motion is too large for
    floating point; PuckError if the slide does not end in a million steps.

    >>> puck = PuckSpec(base="box:0.2x0.1", friction=0.3)
    >>> slide_of(puck, (1.0, 0.0), 10.0, 1e-9).out[STOP_TIME].round(9).item()
    0.448246266
    """
    launch = launch_rows(puck, np.array([_turned(*velocity, -orientation)]), np.array([spin]))
    none, nothing = np.empty(0), np.empty((0, STATE_SIZE))
    slip = math.hypot(*velocity, puck.inertia_radius * spin)
    time = slip / puck.decel or 1.0
    length = time * (slip or 1.0)
    assert puck.shape is not None
    noise = _ROUNDING * noise_of(puck.packed_base)
    scale = np.array([time, length, length, length, 1.0, length / puck.shape.reach])

    def attempt(local: float) -> tuple[BaseSlide, ErrorEstimate]:
        out = _followed(puck, launch, local, none, nothing)
        finer = _followed(puck, launch, max(_FINER * local, 1e-15), none, nothing)
        off = float(np.abs((out - finer)[: scale.size] / scale).max())
        error = ErrorEstimate(off, 0.0, noise * max(1.0, float(out[STOP_TIME]) / time))
        return BaseSlide(puck, launch, local, out, error.total, orientation), error

    def finer(local: float, error: ErrorEstimate) -> float | None:
        return 0.1 * local if local > 1e-14 else None

    return close_enough(local_error(tol), attempt, finer, tol, "this slide")[0]


def _followed(
    puck: PuckSpec, launch: FloatArray, local: float, moments: FloatArray, states: FloatArray
) -> FloatArray:
    """What comes out of one slide (OUT_ROWS,); its states at moments."""
    assert puck.shape is not None
    out, status = np.empty((OUT_ROWS, 1)), np.empty(1, np.int8)
    ends = np.array([0, moments.size])
    fill_slides(puck.packed_base, launch, local, ends, moments, out, states, status)
    if status[0] == OVERFLOW:
        raise InputError(
            "velocity, spin, base and friction give a motion too large for floating point: use "
            "larger units"
        )
    if status[0] != STOPPED:
        raise PuckError(
            f"the slide cannot be followed in {MOST_STEPS} steps: ask for less accuracy, or give "
            "less spin"
        )
    return out[:, 0]
