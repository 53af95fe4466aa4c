"""Stops of one kind of puck, looked up: everything about them over the slip angle alone.

For one pressure law, height and radius of gyration the stop of every launch follows from functions
of φ (:mod:`puck_tables.stopping.lookup`, where they depend on δ besides).  They inherit the lines
of the friction, and are singular at φ = 0 and π/2, where they carry broken powers, 1/(1 − σ(0)) and
σ(π/2)/(σ(π/2) − 1) with σ = (r²/2k²) ρ_ω/ρ_∥; at φ₀ they are analytic.  Each node is a stop of its
own, integrated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from puck_tables.errors import AccuracyError
from puck_tables.motion.body import Body
from puck_tables.motion.friction import LOOSEST_LOCAL
from puck_tables.motion.path import TURN_SHARE
from puck_tables.stopping.exact import integrated_stops
from puck_tables.table.friction_section import FINEST_ACCURACY, FrictionSection
from puck_tables.table.slip_axis import sides_of
from puck_tables.table.slip_spline import SlipSpline, slip_spline

FloatArray = npt.NDArray[np.float64]

FUNCTIONS = ("time", "along", "across", "length", "body", "turn")
FINEST_SECTION = 1e-10  # as fine as stops are looked up; beyond, they are integrated
_COUNTED = slice(0, 5)  # the turn, until Q has fallen to 1/1000, is what it is
_FINEST_CELLS = 1024
_SAMPLE = 48
_COARSER_BY = 8.0


@dataclass(frozen=True)
class StopSection:
    """Where and when any puck of one kind stops, as functions of its slip angle.

    Parameters
    ----------
    body : Body
    spline : of :data:`FUNCTIONS`: T; X/cos φ; Y/(sin φ cos φ); path length/cos φ; body angle/sin φ;
        turn/sin φ
    error : the largest error of T, X, Y, path length and body angle, in units of Q/J, Q²/J and
        Q²/(J r), measured
    """

    body: Body
    spline: SlipSpline = field(repr=False)
    error: float

    @property
    def cut(self) -> FloatArray:
        """What compiled code reads."""
        return self.spline.cut

    @property
    def turn_error(self) -> float:
        """The same of the turn, radians."""
        return float(self.spline.error[-1])


@lru_cache(maxsize=64)
def stop_section_for(body: Body, accuracy: float) -> StopSection:
    """Tabulate the stops of one kind of puck.

    Parameters
    ----------
    body : Body
    accuracy : the largest error, in units of Q/J (time), Q²/J (place, path), Q²/(J r) (body angle)

    Raises
    ------
    AccuracyError
        If it is out of reach.

    Notes
    -----
    The error is measured in the middles of all cells against integrated stops; what the friction
    slice behind them contributes, against one of half as many cells.

    Examples
    --------
    >>> from puck_tables.motion.body import body_of
    >>> found = stop_section_for(body_of("uniform", 2.0, 0.5**0.5), 1e-5)
    >>> float(found.spline.at(np.array([0.5]))[0, 0].round(4)), found.error <= 1e-5
    (1.1458, True)
    """
    of_friction = max(0.1 * accuracy, FINEST_ACCURACY)
    while True:
        friction = body.friction(of_friction)
        by_friction = _error_of_friction(body, friction, accuracy)
        if by_friction <= 0.3 * accuracy:
            break
        if of_friction <= FINEST_ACCURACY:
            raise AccuracyError(f"stops to {accuracy:.1g} are out of reach for this puck")
        of_friction = max(0.1 * of_friction, FINEST_ACCURACY)
    cotangents = [_cotangent(line) for line in friction.lines]
    spline = slip_spline(
        lambda phi: _stops(body, friction, friction.for_motion(body.gyration), phi, accuracy),
        sides_of(cotangents, ends_too=True),
        0.6 * accuracy,
        even=False,
        counted=_COUNTED,
        weights=_factors,
        finest=_FINEST_CELLS,
    )
    error = float(spline.error[_COUNTED].max()) + by_friction
    return StopSection(body, spline, error)


def _cotangent(phi: float) -> float:
    return 1.0 if phi == 0.25 * math.pi else 1.0 / math.tan(phi)


def _error_of_friction(body: Body, friction: FrictionSection, accuracy: float) -> float:
    """What the error of the friction does to stops anywhere."""
    phi = np.linspace(0.0, 0.5 * np.pi, _SAMPLE + 2)[1:-1]
    whole, half = (
        _stops(body, friction, friction.for_motion(body.gyration, coarser), phi, 0.1 * accuracy)
        for coarser in (False, True)
    )
    off = np.abs(whole - half) * _factors(phi)
    return 2.0 * float(off[:, _COUNTED].max()) / _COARSER_BY


def _factors(phi: FloatArray) -> FloatArray:
    """What the functions are multiplied with in a stop, (n, functions)."""
    cosine, sine = np.cos(phi), np.sin(phi)
    return np.stack([np.ones_like(sine), cosine, sine * cosine, cosine, sine, sine], axis=-1)


def _stops(
    body: Body, friction: FrictionSection, cut: FloatArray, phi: FloatArray, accuracy: float
) -> FloatArray:
    """The functions at slip angles, by integration; at 0 and π/2 in closed form."""
    at_zero, at_half = phi <= 0.0, phi >= 0.5 * np.pi
    inner = ~(at_zero | at_half)
    out = np.empty((phi.size, len(FUNCTIONS)))
    u = np.log(np.tan(phi[inner]))
    stops = integrated_stops(
        u, np.full(u.size, body.delta), cut, min(0.03 * accuracy, LOOSEST_LOCAL)
    )
    out[inner] = stops / _factors(phi[inner])
    out[at_zero], out[at_half] = _ends(body, friction)
    return out


def _ends(body: Body, friction: FrictionSection) -> tuple[FloatArray, FloatArray]:
    """The functions at φ → 0 and φ → π/2, elementary.

    Next to pure sliding v falls like t₀ − t and rω like its power σ(0); next to pure spin rω falls
    linearly and the complex velocity like its power (ρ_∥ + iρ_⊥)/s, s = (r²/2k²) ρ_ω.
    """
    (inverse, across, spin), (inverse_h, across_h, spin_h) = friction.at_ends()
    factor = 0.5 / body.inertia
    left, power = across / inverse, factor * spin
    log_share = math.log(TURN_SHARE)
    gap = power - 1.0
    # (1 − q^gap)/gap: the turn of a rim speed that falls like the power σ(0) of the speed
    swung = -math.expm1(gap * log_share) / gap if gap != 0.0 else -log_share
    slow = [1.0, 0.5, -0.5 * left / (power + 1.0), 0.5, 1.0 / (power + 1.0), -left * swung]
    rate = factor * spin_h / inverse_h
    along, left = 1.0 / inverse_h, across_h / inverse_h
    modulus = (rate + along) ** 2 + left**2
    fast = [
        1.0 / rate, (rate + along) / modulus, -left / modulus, 1.0 / (rate + along), 0.5 / rate,
        left / rate * log_share,
    ]  # fmt: skip
    return np.array(slow), np.array(fast)
