"""A point on a wavy one-sided support: Chetaev's model of what lies behind dry friction.

A point of mass m under a constant force (X, Y), Y < 0, moves on y ≥ −a cos(x/b).  In contact

    m x″ = −λ (a/b) sin(x/b) + X,     m y″ = λ + Y,     λ ≥ 0                               (5.2)

and with y held on the support, a/b = κ, θ = x/b,

    λ = [−Y + m (a/b²) x′² cos θ + X κ sin θ] / [1 + κ² sin² θ]                         (exact)
    λ ≈ −Y + m (a/b²) x′² cos θ  (leading terms),     λ ≈ −Y  (crude: Coulomb's law).

(The printed exact λ has −mY for −Y and m for 1 in the denominator: its units do not fit.)  Where λ
falls to 0 the point leaves the support and flies a parabola.  It lands *inelastically*: the
velocity along the normal is lost, that along the support is kept, and ½ m (normal velocity)² goes
from the energy.  Between landings the energy is constant.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast, finite_array, instance, positive, real
from puck_tables.chetaev.motion import checked_times
from puck_tables.errors import AccuracyError, InputError

_TOL = 1e-13  # of a step, relative: near to what doubles hold
_LARGEST_TURN = 0.05  # of θ in one step of sliding, so that no dip of λ is stepped over
# shares of a time at which it is seen whether a gap only grows; and of the first such time
_LOOKS, _HALVES = np.arange(1, 7) / 6, 0.5 ** np.arange(64.0)[:, None]
_GAP_STEPS = 1_000_000  # flights that hardly leave the crest take that many
_NOISE = 2.0**-53  # relative rounding of a double: a gap below it is none
MAX_ARCS = 100_000  # slides and flights: then it is refused by name


@dataclass(frozen=True)
class Asperity:
    """The support and the point on it.

    Parameters
    ----------
    amplitude, length : float, a > 0 and b > 0, m: the wavelength is 2πb
    load, mass, pull : float, −Y > 0, N; m > 0, kg; X, N
        All finite, else InputError.

    Examples
    --------
    >>> bumps = Asperity(amplitude=1e-6, length=4e-6, load=1.0, mass=0.1)
    >>> bumps.slope, round(bumps.lift_speed, 6)  # leaves the crest: x′² = −Y b²/(m a)
    (0.25, 0.012649)
    """

    amplitude: float
    length: float
    load: float
    mass: float
    pull: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (("amplitude", "m"), ("length", "m"), ("load", "N"), ("mass", "kg")):
            object.__setattr__(self, name, positive(name, getattr(self, name), unit))
        object.__setattr__(self, "pull", real("pull", self.pull, "N"))

    @property
    def slope(self) -> float:
        """κ = a/b: the steepest slope, and Coulomb's coefficient of the crude law."""
        return self.amplitude / self.length

    @property
    def lift_speed(self) -> float:
        """V₀ = b √(−Y/(m a)), m/s: a point that is not pulled leaves the crest above it."""
        return self.length * math.sqrt(self.load / (self.mass * self.amplitude))

    def height(self, x: npt.ArrayLike) -> FloatArray:
        """−a cos(x/b), m, at places x in m."""
        return np.asarray(-self.amplitude * np.cos(finite_array("x", x, "m") / self.length))

    def incline(self, x: npt.ArrayLike) -> FloatArray:
        """dy/dx of the support, κ sin(x/b), at places x in m."""
        return np.asarray(self.slope * np.sin(finite_array("x", x, "m") / self.length))

    def press(self, x: npt.ArrayLike, speed: npt.ArrayLike) -> FloatArray:
        """The numerator of λ, N: negative where the support falls away under a flying point."""
        place, rate = broadcast(
            x=finite_array("x", x, "m"), speed=finite_array("speed", speed, "m/s")
        )
        with np.errstate(over="ignore", invalid="ignore"):
            lifting = self.mass * self.amplitude / self.length**2 * rate**2
            press = self.load + lifting * np.cos(place / self.length) + self.pull * self.incline(x)
        if not np.isfinite(press).all():
            raise InputError("x and speed give a press too large for floating point")
        return np.asarray(press)

    def multipliers(self, x: npt.ArrayLike, speed: npt.ArrayLike) -> tuple[FloatArray, ...]:
        """λ exact, by its leading terms, and crude, in N, not cut at 0: below there is no contact.

        ``x`` in m, ``speed`` x′ in m/s: array_like, broadcast.

        >>> bumps = Asperity(amplitude=1.0, length=1.0, load=2.0, mass=1.0)
        >>> [float(lam.round(6)) for lam in bumps.multipliers(np.pi / 4, 1.0)]
        [1.804738, 2.707107, 2.0]
        """
        press, incline = self.press(x, speed), self.incline(x)
        exact = press / (1.0 + incline**2)
        return exact, press - self.pull * incline, np.full(press.shape, self.load)


class SlideOrFlight(NamedTuple):
    """One stretch of a motion: its kind, when and how it begins, in SI units."""

    kind: str  # "slide" or "fly"
    time: float
    x: float
    y: float
    vx: float
    vy: float
    loss: float  # energy lost by the landing at its start

    def flown(self, asperity: Asperity, t: Any) -> tuple[Any, ...]:
        """X, y, vx, vy so long after its beginning, s, on the parabola of a flight."""
        ax, ay = asperity.pull / asperity.mass, -asperity.load / asperity.mass
        x, y = self.x + (self.vx + 0.5 * ax * t) * t, self.y + (self.vy + 0.5 * ay * t) * t
        return x, y, self.vx + ax * t, self.vy + ay * t


@dataclass(frozen=True)
class AsperityMotion:
    """States at given times, and the arcs between lift-offs and landings.

    Attributes
    ----------
    time, x, y, vx, vy, multiplier : arrays (k,), SI units
        The last is λ, N; 0 in flight.
    arcs : tuple of SlideOrFlight
    lost, energy_residual : float, J
        Energy lost by all landings; largest change of ½m(x′² + y′²) − Xx − Yy that none explains.
    """

    time: FloatArray
    x: FloatArray = field(repr=False)
    y: FloatArray = field(repr=False)
    vx: FloatArray = field(repr=False)
    vy: FloatArray = field(repr=False)
    multiplier: FloatArray = field(repr=False)
    arcs: tuple[SlideOrFlight, ...] = field(repr=False)
    lost: float
    energy_residual: float


def asperity_motion(
    asperity: Asperity, x: float, speed: float, times: npt.ArrayLike
) -> AsperityMotion:
    """Let a point go on the support: it slides, flies and lands (Chetaev 1960, section 5).

    Times of lift-off and landing are exact to about 1e-12 of the time b/x′.

    Parameters
    ----------
    asperity : Asperity
    x, speed : float, m and m/s
        The place and x′, along the support, at the first of ``times``; finite, else InputError.
    times : array_like (k,), s
        At least two, ascending, else InputError; AccuracyError if 100 000 arcs do not reach the
        last.

    Examples
    --------
    >>> bumps = Asperity(amplitude=1.0, length=1.0, load=1.0, mass=1.0)  # V₀ = 1 m/s
    >>> run = asperity_motion(bumps, np.pi, 1.2, [0.0, 1.0, 10.0])
    >>> [arc.kind for arc in run.arcs[:2]], float((run.x[1] - run.x[0]).round(12))  # off the crest
    (['fly', 'slide'], 1.2)
    """
    instance("asperity", asperity, Asperity)
    when = checked_times(times)
    place, rate = real("x", x, "m"), real("speed", speed, "m/s")
    if not math.isfinite(asperity.mass * rate * rate):
        raise InputError(f"speed = {rate:g} m/s gives an energy too large for floating point")
    arc: SlideOrFlight | None = on_support(asperity, float(when[0]), place, rate)
    arcs, pieces = list[SlideOrFlight](), []
    while arc is not None:
        if len(arcs) == MAX_ARCS:
            raise AccuracyError(
                f"after {MAX_ARCS} slides and flights only t = {arc.time:g} s was reached: "
                "ask for an earlier time"
            )
        arcs.append(arc)
        follow = _slide if arc.kind == "slide" else _fly
        arc, states = follow(asperity, arc, when[when >= arc.time], float(when[-1]))
        pieces.append(states)
    t, px, py, vx, vy, lam = np.concatenate(pieces, axis=1)
    begun, lost = np.array([one.time for one in arcs]), np.cumsum([one.loss for one in arcs])
    energy = 0.5 * asperity.mass * (vx**2 + vy**2) - asperity.pull * px + asperity.load * py
    energy += lost[np.searchsorted(begun, t, side="right") - 1]
    changed = float(np.abs(energy - energy[0]).max())
    return AsperityMotion(t, px, py, vx, vy, lam, tuple(arcs), float(lost[-1]), changed)


def on_support(
    asperity: Asperity, time: float, x: float, vx: float, loss: float = 0.0, leaves: bool = False
) -> SlideOrFlight:
    """The arc that begins at a place of the support with a velocity along it."""
    kind = "fly" if leaves or asperity.press(x, vx) <= 0.0 else "slide"
    y, vy = float(asperity.height(x)), float(asperity.incline(x)) * vx
    return SlideOrFlight(kind, time, x, y, vx, vy, loss)


def _fly(
    asperity: Asperity, arc: SlideOrFlight, wanted: FloatArray, end: float
) -> tuple[SlideOrFlight | None, FloatArray]:
    """Until the landing, and the states at the times wanted before it."""
    lasts = landing(asperity, arc, end - arc.time)
    down = arc.time + lasts
    t = wanted[wanted < down] - arc.time
    states = np.stack([t + arc.time, *arc.flown(asperity, t), 0.0 * t])
    if down > end:
        return None, states
    x, _, vx, vy = arc.flown(asperity, lasts)
    incline = float(asperity.incline(x))
    # along the support, in the direction (1, incline): kept
    lost = 0.5 * asperity.mass * (vy - incline * vx) ** 2 / (1.0 + incline**2)
    along = (vx + incline * vy) / (1.0 + incline**2)
    return on_support(asperity, down, x, along, lost), states


def landing(asperity: Asperity, arc: SlideOrFlight, longest: float) -> float:
    """How long a flight that begins on the support lasts; infinite beyond ``longest``, s.

    The gap below the point is convex while the numerator of λ is negative, and its second
    derivative never falls below −B: from a gap g closing at the rate g′ it cannot close before the
    positive root of g + g′h − ½Bh² = 0.  Steps of that length never pass a landing, and end in it
    like Newton's.
    """
    ax, ay = asperity.pull / asperity.mass, -asperity.load / asperity.mass
    # steps begin where the gap has only grown
    first = asperity.length / max(abs(arc.vx), math.sqrt(abs(ax) * asperity.length), 1e-300)
    tries = min(first, math.sqrt(asperity.mass * asperity.length / asperity.load)) * _HALVES
    x, _, vx, _ = arc.flown(asperity, tries * _LOOKS)
    grows = (asperity.press(x, vx) < 0.0).all(axis=1)
    t = float(tries[grows.argmax(), 0]) if grows.any() else 0.0
    for _ in range(_GAP_STEPS):
        if t > longest:
            return math.inf
        x, _, vx, vy = arc.flown(asperity, t)
        # how far the bound on the speed is to hold
        ahead = max(abs(vx / ax), math.sqrt(asperity.length / abs(ax))) if ax != 0.0 else math.inf
        # y − y₀ and the support's own rise: exact for short flights
        middle, half = 0.5 * (x + arc.x) / asperity.length, 0.5 * (x - arc.x) / asperity.length
        rise = 2.0 * asperity.amplitude * math.sin(middle) * math.sin(half)
        gap = (arc.vy + 0.5 * ay * t) * t - rise
        if gap <= _NOISE * (abs(arc.vy * t) + abs(ay * t * t) + abs(rise)):
            return t  # landed, to rounding: also flights too low to be seen
        closing = vy - asperity.slope * math.sin(x / asperity.length) * vx
        fastest = abs(vx) + (abs(ax) * ahead if ax != 0.0 else 0.0)
        pull = -ay + asperity.amplitude / asperity.length**2 * fastest**2 + abs(ax) * asperity.slope
        root = math.sqrt(max(closing * closing + 2.0 * pull * gap, 0.0))
        step = 2.0 * gap / (root - closing) if closing < 0.0 else (closing + root) / pull
        step = min(step, ahead)
        if step <= 4e-16 * t:
            return t
        t += step
    raise AccuracyError(
        f"the landing of the flight that begins at x = {arc.x:g} m was not found: it grazes a crest"
    )


def _slide(
    asperity: Asperity, arc: SlideOrFlight, wanted: FloatArray, end: float
) -> tuple[SlideOrFlight | None, FloatArray]:
    """Until λ falls to 0, and the states at the times wanted before that."""
    from scipy.integrate import solve_ivp

    def slope(t: float, state: FloatArray) -> list[float]:
        incline = float(asperity.incline(state[0]))
        lam = float(asperity.press(*state)) / (1.0 + incline**2)
        return [state[1], (asperity.pull - lam * incline) / asperity.mass]

    def press(t: float, state: FloatArray) -> float:
        return float(asperity.press(*state))

    press.terminal, press.direction = True, -1  # type: ignore[attr-defined]
    # over a wave the load and the pull give no more energy
    gained = asperity.load * asperity.amplitude + math.pi * abs(asperity.pull) * asperity.length
    fastest = math.sqrt(arc.vx**2 + arc.vy**2 + 4.0 * gained / asperity.mass)
    solved = solve_ivp(
        slope, (arc.time, end), [arc.x, arc.vx], "DOP853", wanted, events=press, rtol=_TOL,
        atol=_TOL * np.array([asperity.length, fastest]),
        max_step=_LARGEST_TURN * asperity.length / fastest,
    )  # fmt: skip
    if solved.status < 0:
        raise AccuracyError(
            f"the slide that begins at x = {arc.x:g} m, t = {arc.time:g} s cannot be followed: its "
            "steps got too short; ask for an earlier time"
        )
    t, (x, vx) = np.array(solved.t, np.float64), np.reshape(solved.y, (2, -1))  # lists of none
    vy = asperity.incline(x) * vx
    states = np.stack([t, x, asperity.height(x), vx, vy, asperity.multipliers(x, vx)[0]])
    if solved.status != 1:
        return None, states
    leave, off = float(solved.t_events[0][0]), solved.y_events[0][0].tolist()
    return on_support(asperity, leave, off[0], off[1], leaves=True), states[:, t < leave]
