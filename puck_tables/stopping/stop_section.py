"""Stops of one kind of puck, looked up: everything about them over the slip angle alone.

For one pressure law, height and radius of gyration the stop of every launch follows from functions
of φ (:mod:`puck_tables.stopping.lookup`, where they depend on δ besides).  They inherit the lines
of the friction, and are singular at φ = 0 and π/2, where they carry broken powers, 1/(1 − σ(0)) and
σ(π/2)/(σ(π/2) − 1) with σ = (r²/2k²) ρ_ω/ρ_∥; at φ₀ they are analytic.  Each node is a stop of its
own, integrated.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, real
from puck_tables._core.waiting import Progress
from puck_tables.accuracy.method_errors import COARSEST
from puck_tables.contact.laws import Law
from puck_tables.errors import AccuracyError
from puck_tables.kernels.compile import inlined, look_up, patience, weighted_rows
from puck_tables.kernels.quadratic import HEADER, basis, section_place
from puck_tables.motion.body import UnitPuck, body_of
from puck_tables.motion.friction_source import LOOSEST_LOCAL
from puck_tables.motion.path import TURN_SHARE
from puck_tables.motion.solve import ErrorEstimate, close_enough
from puck_tables.stopping.exact import integrated_stops
from puck_tables.stopping.launch_derivatives import OWN
from puck_tables.stopping.lookup import LARGEST, SMALLEST
from puck_tables.table.check import CheckReport
from puck_tables.table.friction_section import FINEST_ACCURACY, FrictionSection
from puck_tables.table.law_record import can_be_known, known
from puck_tables.table.section_table import SectionTable
from puck_tables.table.slip_spline import GRADING_POWER, LawAxis, sides_of, slip_spline
from puck_tables.table.table_store import fetch

FINEST_SECTION = 1e-10  # as fine as stops are looked up; beyond, they are integrated
DEFAULT_ACCURACY = 1e-8  # of Q²/J: the default tol of stops
_COUNTED = slice(0, 5)  # the turn, until Q has fallen to 1/1000, is what it is
_TURN = 0.01  # its errors count a hundredth
_FINEST_CELLS = 1024  # a side
_SAMPLE = 48  # launches at which it is held against an integration
_COARSER_BY = 8.0  # half as many cells are 16 times as bad; half of that is believed
_SHARE_OF_FRICTION, _SHARE_OF_SPLINE = 0.3, 0.6  # of the accuracy


@dataclass(frozen=True, eq=False, repr=False)
class StopSection(SectionTable):
    """Where and when any puck of one kind stops, as functions of its slip angle.

    Parameters
    ----------
    values : array (nodes of φ, 6)
        T; X/cos φ; Y/(sin φ cos φ); path length/cos φ; body angle/sin φ; turn/sin φ.
    law, delta, cotangents
        As :class:`puck_tables.table.section_table.SectionTable`.
    gyration : radius of gyration about the vertical axis in units of r
    friction_error : what the error of the friction contributes, measured
    """

    _: KW_ONLY
    gyration: float
    friction_error: float = 0.0

    kind = "stop section"
    algorithm = "Dormand-Prince with a friction section; 1"
    functions: ClassVar[Mapping[str, str]] = {
        "time": "stop time J t/Q",
        "along": "displacement along the launch velocity J x/(Q^2 cos(phi))",
        "across": "displacement to its left J y/(Q^2 sin(phi) cos(phi))",
        "length": "path length J l/(Q^2 cos(phi))",
        "body": "body angle J r theta/(Q^2 sin(phi))",
        "turn": "turn until Q has fallen to 1/1000, over sin(phi)",
    }
    quantities = ("time", "x", "y", "path", "body", "turn")
    words: ClassVar[Mapping[str, str]] = {
        "title": "Stops of one sliding, spinning puck",
        "interpretation": (
            "Where and when a puck under the named pressure law, of height delta = 2 f h / r and "
            "radius of gyration k = gyration r, launched with Q = hypot(v, r omega) and "
            "phi = atan2(r omega, v) >= 0 stops: the functions say how, J = f g. For omega < 0 the "
            "mirror image. Salnikova, Treschev, Gallyamov 2012, section 7."
        ),
        "method": "stops integrated, friction as fine as needed",
        "phi_map": (
            "two sides for each line, of phi = 0 and pi/2 one: "
            f"tan(phi - line) = extent xi^{GRADING_POWER}"
        ),
    }
    ends_too = True

    @property
    def coefficients(self) -> FloatArray:
        """What compiled code reads."""
        return self.spline.coefficients

    @cached_property
    def body(self) -> UnitPuck:
        """The puck."""
        return body_of(self.law, self.delta, self.gyration)

    @cached_property
    def error(self) -> float:
        """The largest error of time, place, path and body angle, measured."""
        return float(self.spline.error[_COUNTED].max()) + self.friction_error

    def validate(self, progress: Progress | None = None, points: int = 300) -> CheckReport:
        """Judge the section by integration with friction ten times as fine.

        Parameters
        ----------
        progress : callable (done, total), optional
        points : how many are compared at random, and as many next to the lines, in cells and at
            nodes
        """
        allowed = min(self.tolerance, COARSEST)
        body = self.body
        friction = body.friction(max(0.01 * allowed, FINEST_ACCURACY))
        section, counts = friction.for_motion(body.gyration), np.array([1.0] * 5 + [_TURN])

        def apart(phi: FloatArray) -> FloatArray:
            truth = stops_at(body, friction, section, phi, 0.1 * allowed)
            missed: FloatArray = (self.spline.at(phi) - truth) * _factors(phi) * counts
            return missed

        return self.judged(apart, "integration", points, allowed, allowed, progress)

    # the record of the kind

    @classmethod
    def is_of(cls, of: object) -> bool:
        """A pressure law, a height and a radius of gyration."""
        return isinstance(of, tuple) and len(of) == 3 and isinstance(of[0], Law | str)

    @classmethod
    def built(cls, of: Any, accuracy: float | None = None, **how: Any) -> StopSection:
        """The stops of one kind of puck, see :meth:`puck_tables.Table.build`."""
        wanted = DEFAULT_ACCURACY if accuracy is None else real("accuracy", accuracy, "Q^2/J")
        if not FINEST_SECTION <= wanted <= COARSEST:
            raise AccuracyError(
                f"accuracy must be from {FINEST_SECTION:g} to {COARSEST:g} (an absolute error in "
                f"units of Q/J and Q^2/J), got {wanted:g}"
            )
        return stop_section(body_of(*of), wanted, **how)


@lru_cache(maxsize=64)
def stop_section_for(body: UnitPuck, accuracy: float) -> StopSection:
    """The stops of one kind of puck: read if they are kept, else tabulated.

    ``body``: Body; ``accuracy``: the largest error, in units of Q/J (time), Q²/J (place, path),
    Q²/(J r) (body angle).

    >>> result = stop_section_for(body_of("uniform", 2.0, 0.5**0.5), 1e-5)
    >>> float(result.spline.at(np.array([0.5]))[0, 0].round(4)), result.error <= 1e-5
    (1.1458, True)
    """
    if body.table is not None or not can_be_known(body.law):  # one's own
        return stop_section(body, accuracy)
    body = replace(body, law=known(body.law))
    return fetch(
        f"stops-{body.delta:g}-{body.gyration:g}-{accuracy:g}",
        {"law": body.law, "delta": body.delta, "gyration": body.gyration, "accuracy": accuracy},
        lambda: stop_section(body, accuracy),
    )


def stop_section(body: UnitPuck, accuracy: float, progress: Progress | None = None) -> StopSection:
    """Tabulate the stops of one kind of puck.

    Parameters
    ----------
    body, accuracy
        As :func:`stop_section_for`.
    progress : callable (done, total), optional

    Notes
    -----
    The error is measured in the middles of all cells against integrated stops; what the friction
    section behind them contributes, against one of half as many cells.
    """

    def attempt(of_friction: float) -> tuple[FrictionSection, ErrorEstimate]:
        friction = body.friction(of_friction)
        error = _error_of_friction(body, friction, accuracy)
        return friction, ErrorEstimate(0.0, error / _SHARE_OF_FRICTION)

    def finer(of_friction: float, error: ErrorEstimate) -> float | None:
        if of_friction <= FINEST_ACCURACY:
            return None
        return max(0.1 * of_friction, FINEST_ACCURACY)

    first = max(0.1 * accuracy, FINEST_ACCURACY)
    friction, error, _ = close_enough(first, attempt, finer, accuracy, "look-up of such pucks")
    lines = tuple(  # in the order of φ
        1.0 if line == 0.25 * math.pi else 1.0 / math.tan(line) for line in friction.lines
    )
    done = 0

    def functions(phi: FloatArray) -> FloatArray:
        nonlocal done
        done += phi.size
        if progress is not None:
            progress(done, max(done, _FINEST_CELLS))
        return stops_at(body, friction, friction.for_motion(body.gyration), phi, accuracy)

    spline = slip_spline(
        functions, sides_of(lines, ends_too=True), _SHARE_OF_SPLINE * accuracy, even=False,
        counted=_COUNTED, weights=_factors, finest=_FINEST_CELLS,
    )  # fmt: skip
    assert spline.accuracy is not None
    measured = replace(spline.accuracy, promised=5, at_second=6 * (body.delta,))
    axis = LawAxis(lines[::-1], spline.cells, ends_too=True)
    return StopSection(
        axis.concatenated(spline.values), law=body.law, delta=body.delta, cotangents=lines[::-1],
        gyration=body.gyration, friction_error=_SHARE_OF_FRICTION * error.total,
        tolerance=accuracy, accuracy=measured,
    )  # fmt: skip


def _error_of_friction(body: UnitPuck, friction: FrictionSection, accuracy: float) -> float:
    """What the error of the friction does to stops anywhere."""
    phi = np.linspace(0.0, 0.5 * np.pi, _SAMPLE + 2)[1:-1]
    whole, half = (
        stops_at(body, friction, friction.for_motion(body.gyration, coarser), phi, 0.1 * accuracy)
        for coarser in (False, True)
    )
    apart = np.abs(whole - half) * _factors(phi)
    return 2.0 * float(apart[:, _COUNTED].max()) / _COARSER_BY


def _factors(phi: FloatArray) -> FloatArray:
    """What the functions are multiplied with in a stop, (n, functions)."""
    cosine, sine = np.cos(phi), np.sin(phi)
    return np.stack([np.ones_like(sine), cosine, sine * cosine, cosine, sine, sine], axis=-1)


def stops_at(
    body: UnitPuck, friction: FrictionSection, section: FloatArray, phi: FloatArray, accuracy: float
) -> FloatArray:
    """The functions at slip angles, by integration; at 0 and π/2 in closed form."""
    at_zero, at_half = phi <= 0.0, phi >= 0.5 * np.pi
    inner = ~(at_zero | at_half)
    out = np.empty((phi.size, len(StopSection.functions)))
    u = np.log(np.tan(phi[inner]))
    stops = integrated_stops(
        u, np.full(u.size, body.delta), section, min(0.03 * accuracy, LOOSEST_LOCAL)
    )
    out[inner] = stops / _factors(phi[inner])
    out[at_zero], out[at_half] = end_values(friction.at_ends(), body.inertia)
    return out


def end_values(ratios: FloatArray, inertia: float) -> FloatArray:
    """The functions at φ → 0 and φ → π/2 (2, 6), elementary, from the friction ratios there (2, 3).

    Next to pure sliding v falls like t₀ − t and rω like its power σ(0); next to pure spin rω falls
    linearly and the complex velocity like its power (ρ_∥ + iρ_⊥)/s, s = (r²/2k²) ρ_ω.

    >>> end_values(np.array([[1.0, 0.0, 0.5], [1.0, 0.0, 4.0 / 3.0]]), 0.5)[1, :3].round(6).tolist()
    [0.75, 0.428571, -0.0]
    """
    (inverse, across, spin), (inverse_h, across_h, spin_h) = ratios
    factor = 0.5 / inertia
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
    return np.array([slow, fast])


_FUNCTIONS = 6  # outputs of a stop
_LOWEST = 1e-290  # below, a ratio of speeds loses digits: both are raised by a power of two


@inlined
def place_of(speed: float, edge: float, section: FloatArray, width: int) -> tuple[int, int, float]:
    """Side, first number and place in the cell of speeds v and r|ω|."""
    larger = max(speed, edge)
    raised = 2.0**200 if larger < _LOWEST else 1.0
    ratio = (raised * min(speed, edge)) / (raised * larger) if larger > 0.0 else 0.0
    side, i, place = section_place(ratio, edge > speed, section, width)
    return side, i, place


@look_up
def fill_section_stops(
    launches: FloatArray, section: FloatArray, longest: float, out: FloatArray
) -> int:
    """Stops of launches (6, n): vx, vy, ω, δ, J, r, into ``out`` (6, n), see solvers.OUTPUTS.

    ``section`` holds the functions of :mod:`puck_tables.stopping.stop_section`; all launches are of
    its puck.  No direction is computed and nothing divided by zero.  Returns of how many
    ``longest`` times Q²/J or Q²/(J r) is too large.
    """
    patience(launches.shape[1])
    flat, too_large = section.reshape(-1), 0
    for n in range(launches.shape[1]):
        patience(1)
        vx, vy = launches[0, n], launches[1, n]
        decel, radius = launches[4, n], launches[5, n]
        rim = radius * launches[2, n]
        speed2, edge = vx * vx + vy * vy, abs(rim)
        slip2 = speed2 + rim * rim
        if (speed2 > SMALLEST) & (slip2 < LARGEST):
            speed, slip = math.sqrt(speed2), math.sqrt(slip2)
        else:
            speed = math.hypot(vx, vy)
            slip = math.hypot(speed, edge)
        side, i, place = place_of(speed, edge, section, _FUNCTIONS)
        time, along, across, length, body, turn = weighted_rows(
            flat, side * section.shape[1] + i, basis(place), _FUNCTIONS
        )
        scale = slip / decel
        straight, left = scale * along, (rim / decel) * across
        out[0, n] = scale * time
        out[1, n] = straight * vx - left * vy
        out[2, n] = straight * vy + left * vx
        out[3, n] = scale * speed * length
        out[4, n] = rim / slip * turn if slip > 0.0 and speed > 0.0 else 0.0
        out[5, n] = scale * (rim / radius) * body
        size = longest * scale * slip
        too_large += 0 if abs(size / radius + size) < math.inf else 1
    return too_large


@look_up
def fill_section_slopes(
    speed: FloatArray, rim: FloatArray, section: FloatArray, good: npt.NDArray[np.bool_],
    out: FloatArray, left: npt.NDArray[np.bool_],
) -> None:  # fmt: skip
    """Natural derivatives (n, 5, 4) of stops at v and r|ω| (n,), not both 0, by splines.

    ``section`` holds the functions of :mod:`puck_tables.stopping.variational`, ``good`` says in
    which cells they are good; ``left`` (n,): which launches are in others, and left out.
    """
    patience(speed.size)
    flat, numbers = section.reshape(-1), out.reshape(-1)
    for n in range(speed.size):
        patience(1)
        side, i, place = place_of(speed[n], rim[n], section, OWN)
        # a node is good whatever lies between
        left[n] = place > 0.0 and not good[side, (i - HEADER) // OWN]
        if not left[n]:
            own = weighted_rows(flat, side * section.shape[1] + i, basis(place), OWN)
            for k in range(OWN):
                numbers[OWN * n + k] = own[k]
