"""What is exported of pucks on round bases: their stops, friction and orbits, at nodes.

Places are those of c = (r|ω| − v)/(r|ω| + v) between *marks*: pure sliding, the lines where the
centre of rotation crosses an edge of the load, pure spin.  A side reaches from mark to mark, the
first upwards, all others downwards: |c − origin| = extent · q², with nodes close at both ends: of
stops q = ξ² (2 − ξ)², as on the axis of the stop table (:mod:`puck_tables.stopping.lookup`), of
friction q = 1 − (1 − ξ)⁴, closest at the lines.  Heights are a
share of the largest under which the whole base stays loaded,
:data:`puck_tables.contact.laws.Law.delta_max`.

All motions of a puck that slides and spins lie on two orbits, one from pure sliding and one from
pure spin to the limit ratio.  With θ the logarithm of the time that is left,

    du/dθ = −T (ρ_∥ − (r²/2k²) ρ_ω),    dψ/dθ = T sin φ ρ_⊥,    u = ln(rω/v),

(Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7), T J/Q the time to the stop.  θ = 0 where an
orbit crosses its line.  Before and after, an orbit comes to its end like exp(−z), z = rate |θ|: so
seen, orbits of all heights and laws are much alike, and few powers of δ² tell them apart.  Places
on them are z = REACH x²/(1 − x), x = end ξ; from ξ = 1 on nothing changes any more.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from scipy.integrate import solve_ivp
from scipy.interpolate import make_interp_spline

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.closed_form import Resultants, moment_balance
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.laws import Law
from puck_tables.errors import AccuracyError
from puck_tables.puck import Puck
from puck_tables.stopping.lookup import heights
from puck_tables.stopping.stop_section import stops_at
from puck_tables.stopping.stop_table import StopTable

HEIGHTS = 14  # over δ, to which the splines of a file are fitted
_COARSE, _NODES, _FINE_NODES = 3e-7, 385, 1025  # of a side: finer errors take more cells
REACH = 16.0  # of z, the scale along an orbit
TURN_UNIT = 1.5  # of headings: they take less of the error than places on the orbits do
_FINEST, _SHARE = 2e-11, 0.02  # of stops; of the error asked for
_LAST, _STEP = 40.0, 1e-13  # the largest z that is followed, and the local error
_TAIL = 0.1  # of the error asked for: what may still change after the end of a table
_TRIED = 401  # places at which it is seen what still changes
_NEARBY = 0.02  # of ln(rω/v): how far beside the limit it is seen how fast it draws orbits
_INSIDE = 0.01  # a line so far from all limits is on the orbit


class LimitMotions(NamedTuple):
    """The two orbits of the pucks of a law.

    ``parts``: array (4, nodes, heights, 2), from pure sliding before and after θ = 0, from pure
    spin before and after it: before it (1 ± c) exp(z), after it c less its limit; and the regular
    part of the heading over the share of the largest δ, times the rate over its unit.
    ``of_heights``: array (heights, 9): the limit of c; c at θ = 0 of both orbits; the rates, and
    the turnings per θ over that share, in pure sliding, in pure spin and at the limit.
    ``rate_units``: of the three rates.  ``end``: x at ξ = 1.
    """

    parts: FloatArray
    of_heights: FloatArray
    rate_units: list[float]
    end: float


def marks_of(law: Law) -> FloatArray:
    """C at both ends and at the lines of a law, ascending.

    >>> from puck_tables.contact.laws import law_of
    >>> marks_of(law_of("annulus:0.8")).round(4).tolist()
    [-1.0, 0.0, 0.1111, 1.0]
    """
    edges = np.array([edge for edge in law.edges if edge > 0.0])
    return np.array([-1.0, *np.sort((1.0 - edges) / (1.0 + edges)), 1.0])


@dataclass(frozen=True, eq=False)
class LawValues:
    """What is exported of the pucks of one law and one radius of gyration, made when asked for.

    ``gyration``: radius of gyration about the vertical axis in units of r; ``tol``: the error that
    is asked for.

    >>> from puck_tables.contact.laws import law_of
    >>> values = LawValues(law_of("annulus:0.8"), 1.0, 1e-4)
    >>> round(values.tallest, 12), values.patch.shape
    (1.64, (3, 385, 14, 3))
    """

    law: Law
    gyration: float
    tol: float

    @property
    def tallest(self) -> float:
        """The largest δ."""
        return self.law.delta_max

    @property
    def xi(self) -> FloatArray:
        """The nodes of a side (nodes,)."""
        return np.linspace(0.0, 1.0, _NODES if self.tol > _COARSE else _FINE_NODES)

    @cached_property
    def marks(self) -> FloatArray:
        """C at the marks (m,)."""
        return marks_of(self.law)

    @cached_property
    def extents(self) -> FloatArray:
        """How far the sides reach from their origins (m − 1,), ascending; negative: downwards."""
        return np.diff(self.marks) * np.where(np.arange(self.marks.size - 1) > 0, -1.0, 1.0)

    @cached_property
    def origins(self) -> FloatArray:
        """The mark from which each side is measured (m − 1,), ascending."""
        return np.append(self.marks[:1], self.marks[2:])

    @cached_property
    def borders(self) -> FloatArray:
        """C between the sides (m − 2,), ascending."""
        return self.marks[1:-1]

    @cached_property
    def pucks(self) -> list[Puck]:
        """One of each height of the fit, ascending."""
        shares = heights(HEIGHTS) * self.tallest
        kind: dict[str, Any] = {"pressure": self.law, "gyration": self.gyration}
        return [Puck.similar(delta=float(delta), **kind) for delta in shares]

    @property
    def spin_time(self) -> float:
        """How long pure spin lasts, Q/J."""
        return self.pucks[0].body.spin_time

    @property
    def longest(self) -> float:
        """More than any motion lasts, Q/J."""
        return max(2.0, *(puck.body.longest for puck in self.pucks))

    def _angles(self, q: FloatArray) -> FloatArray:
        """Slip angles (sides, nodes) at q (nodes,)."""
        off = self.extents[:, None] * q**2
        c = self.origins[:, None] + off
        phi = np.arctan2(1.0 + c, 1.0 - c)
        # next to pure sliding and pure spin from the distance
        phi[0] = np.arctan2(off[0], 2.0 - off[0])
        phi[-1] = 0.5 * np.pi - np.arctan2(-off[-1], 2.0 + off[-1])
        return phi

    @cached_property
    def patch(self) -> FloatArray:
        """p_a, p_b, p_d (sides, nodes, heights, 3), the same at all heights."""
        phi = self._angles(1.0 - (1.0 - self.xi) ** 4)
        p = self.law.integrals(phi.ravel())
        patch = np.stack([p.a, p.b, p.d], axis=-1).reshape(*phi.shape, 1, 3)
        return np.broadcast_to(patch, (*phi.shape, HEIGHTS, 3))

    @cached_property
    def stops(self) -> FloatArray:
        """T, along, across/δ, path length and body angle (sides, nodes, heights, 5)."""
        if self.pucks[0].body.is_plain:
            return _of_plain(StopTable.shipped(), self.xi)
        accuracy = max(_FINEST, _SHARE * self.tol)
        result, phi = [], self._angles((self.xi * (2.0 - self.xi)) ** 2)
        for puck in self.pucks:
            friction = puck.body.friction(0.1 * accuracy)
            section = friction.for_motion(puck.gyration)
            stops = stops_at(puck.body, friction, section, phi.ravel(), accuracy)[:, :5]
            stops[:, 2] /= puck.delta
            result.append(stops.reshape(*phi.shape, 5))
        return np.stack(result, axis=2)

    @cached_property
    def limit_motions(self) -> LimitMotions:
        """The two orbits, from pure sliding and from pure spin."""
        return _limit_motions(self)


def _of_plain(table: StopTable, xi: FloatArray) -> FloatArray:
    """The stops of plain pucks from the table that comes along."""
    n = table.axis.cells
    sides = np.stack([table.values[: n + 1], table.values[: n - 1 : -1]], axis=1)[..., :5]
    at_nodes = make_interp_spline(np.linspace(0.0, 1.0, n + 1), sides, 5)
    known, wanted = (2.0 * heights(count) ** 2 - 1.0 for count in (sides.shape[2], HEIGHTS))
    by_height = np.moveaxis(at_nodes(xi), 2, 0)
    series = chebyshev.chebfit(known, by_height.reshape(known.size, -1), known.size - 1)
    values = np.asarray(chebyshev.chebval(wanted, series), np.float64).T
    return np.moveaxis(values.reshape(-1, *by_height.shape[1:]), (0, 1), (2, 1))


law_values = lru_cache(maxsize=8)(LawValues)  # one for all files of the same pucks and error


def _c(ratio: float) -> float:
    """(rω − v)/(rω + v) of a ratio rω/v."""
    return 1.0 if math.isinf(ratio) else (ratio - 1.0) / (ratio + 1.0)


def _limit_motions(values: LawValues) -> LimitMotions:
    """The orbits of a law, from its marks and times to the stop."""
    law, inertia = values.law, values.pucks[0].body.inertia
    marks = values.marks
    limits = np.array([_c(puck.limit_ratio) for puck in values.pucks])
    shares = heights(HEIGHTS)
    xi = values.xi
    splines = [make_interp_spline(xi, side, 5) for side in values.stops[..., 0]]

    def time_at(u: FloatArray) -> FloatArray:
        small = np.exp(-np.abs(u))
        share = 2.0 * small / (1.0 + small)  # 1 − |c|
        c = np.where(u < 0.0, share - 1.0, 1.0 - share)
        sides = np.searchsorted(values.borders, c)
        gap = (c - values.origins[sides]) / values.extents[sides]
        gap = np.where(sides == 0, share / values.extents[0], gap)
        gap = np.where(sides == len(values.extents) - 1, -share / values.extents[-1], gap)
        place = 1.0 - np.sqrt(1.0 - np.clip(gap, 0.0, 1.0) ** 0.25)
        at_all: FloatArray = np.stack([np.diagonal(spline(place)) for spline in splines])
        return at_all[sides, np.arange(HEIGHTS)]

    def friction(u: FloatArray) -> tuple[Resultants, FloatArray]:
        phi = np.where(u > 0.0, 0.5 * np.pi - np.arctan(np.exp(-u)), np.arctan(np.exp(u)))
        return moment_balance(law.integrals(phi), slip_direction(phi), shares), np.sin(phi)

    def slopes(y: FloatArray) -> FloatArray:
        u = np.clip(y[:HEIGHTS], -600.0, 600.0)
        rho, sine = friction(u)
        time = time_at(u)
        gap = rho.parallel - 0.5 / inertia * rho.spin
        return np.stack([-time * gap, time * sine * rho.perpendicular])

    slow_end, fast_end = slopes(np.full(HEIGHTS, -600.0)), slopes(np.full(HEIGHTS, 600.0))
    u_limit = _u(limits)
    drawn = (slopes(u_limit + _NEARBY)[0] - slopes(u_limit - _NEARBY)[0]) / (2.0 * _NEARBY)
    # only a scale: a straight line in δ² needs no further powers
    drawn = np.polyval(np.polyfit(shares**2, drawn, 1), shares**2)
    rates = [-slow_end[0], fast_end[0], drawn]
    turnings = [np.zeros(HEIGHTS), fast_end[1], slopes(u_limit)[1]]
    if not np.min(rates) > 0.0:
        raise AccuracyError("the motions of such pucks end in pure sliding, or in pure spin")
    units = [float(f"{TURN_UNIT * rate.min():.3g}") for rate in rates]
    starts = [_start(marks, limits, fast) for fast in (False, True)]

    def part_at(part: int) -> Callable[[FloatArray], FloatArray]:
        """A piece of the orbits at z (z, heights, 2)."""
        fast, ahead = divmod(part, 2)
        sign, end = (-1.0, 2) if ahead else (1.0, fast)
        rate, turning, unit = rates[end], turnings[end], units[end]
        begin = np.concatenate([_u(starts[fast]), np.zeros(HEIGHTS)])
        solution = solve_ivp(
            lambda _, y: (slopes(y) / rate).ravel(), (0.0, sign * _LAST), begin, method="DOP853",
            rtol=_STEP, atol=_STEP, dense_output=True,
        ).sol  # fmt: skip

        def result(z: FloatArray) -> FloatArray:
            u, heading = solution(sign * z).reshape(2, HEIGHTS, -1).swapaxes(1, 2)
            towards = -1.0 if fast else 1.0
            if ahead:
                c = np.tanh(0.5 * u) - limits
            else:
                c = 2.0 / (1.0 + np.exp(-towards * u)) * np.exp(z[:, None])
            regular = (heading - sign * z[:, None] / rate * turning) / shares * rate / unit
            return np.stack([c, regular], axis=-1)

        return result

    parts = [part_at(part) for part in range(4)]
    z = np.linspace(0.0, _LAST, _TRIED)
    far = np.stack([part(z) for part in parts])
    left = np.abs(far - far[:, -1:]).max(axis=(0, 2, 3))
    reach = z[np.argmax(left[:-1] <= _TAIL * values.tol)] / REACH
    end = float(f"{0.5 * (math.sqrt(reach * (reach + 4.0)) - reach):.4g}")
    x = end * xi
    limit_motions = np.stack([part(REACH * x**2 / (1.0 - x)) for part in parts])
    of_heights = np.stack([limits, *starts, *rates, *(one / shares for one in turnings)], axis=1)
    return LimitMotions(limit_motions, of_heights, units, end)


def _u(c: FloatArray) -> FloatArray:
    """Ln(rω/v) of c; 600 for infinite."""
    with np.errstate(divide="ignore"):
        u: FloatArray = np.clip(np.log1p(c) - np.log1p(-c), -600.0, 600.0)
    return u


def _start(marks: FloatArray, limits: FloatArray, fast: bool) -> FloatArray:
    """C at θ = 0 of an orbit at all heights: the line on it, else the middle."""
    inside = marks[1:-1][
        (marks[1:-1] > limits.max() + _INSIDE) if fast else (marks[1:-1] < limits.min() - _INSIDE)
    ]
    if inside.size:
        return np.full(limits.size, inside[-1] if fast else inside[0])
    return 0.5 * (limits + (1.0 if fast else -1.0))
