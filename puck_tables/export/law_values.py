"""What is exported of pucks under a pressure law: their stops, friction and orbits, at nodes.

Places are those of c = (r|ω| − v)/(r|ω| + v) between *marks*: pure sliding, the lines where the
centre of rotation crosses an edge of the load, pure spin.  Each mark has a side of its own up to
the middle between it and the next, ξ⁴ = |c − mark|/extent.  Heights are a share of the largest
under which the whole base stays loaded, :data:`puck_tables.contact.laws.Law.delta_max`.

All motions of a puck that slides and spins lie on two orbits, one from pure sliding and one from
pure spin to the limit ratio.  With θ the logarithm of the time that is left,

    du/dθ = −T (ρ_∥ − (r²/2k²) ρ_ω),    dψ/dθ = T sin φ ρ_⊥,    u = ln(rω/v),

(Salnikova, Treschev, Gallyamov 2012, eq. 6.2–6.7), T J/Q the time to the stop.  θ = 0 where an
orbit crosses its line; before and after, |θ| = REACH ξ²/(1 − ξ), ξ from 0 to 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import make_interp_spline

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.laws import Law
from puck_tables.contact.resultants import Resultants, moment_balance
from puck_tables.puck import Puck
from puck_tables.stopping.axes import heights
from puck_tables.stopping.stop_section import stops_at

NODES, HEIGHTS = 385, 14
REACH = 8.0
_FINEST, _SHARE = 2e-11, 0.02  # of stops; of the error asked for
_LAST, _STEP = 120.0, 1e-13  # the largest |θ| that is followed, and the local error
_INSIDE = 0.01  # a line so far from all limits is on the orbit


def marks_of(law: Law) -> FloatArray:
    """C at both ends and at the lines of a law, ascending.

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> marks_of(law_of("annulus:0.8")).round(4).tolist()
    [-1.0, 0.0, 0.1111, 1.0]
    """
    edges = np.array([edge for edge in law.edges if edge > 0.0])
    return np.array([-1.0, *np.sort((1.0 - edges) / (1.0 + edges)), 1.0])


@dataclass(frozen=True, eq=False)
class LawValues:
    """What is exported of the pucks of one law and one radius of gyration, made when asked for.

    Parameters
    ----------
    law : Law
    gyration : radius of gyration about the vertical axis in units of r
    tol : the error that is asked for

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> values = LawValues(law_of("annulus:0.8"), 1.0, 1e-4)
    >>> round(values.tallest, 12), values.patch.shape
    (1.64, (6, 385, 14, 3))
    """

    law: Law
    gyration: float
    tol: float

    @property
    def tallest(self) -> float:
        """The largest δ."""
        return self.law.delta_max

    @cached_property
    def marks(self) -> FloatArray:
        """C at the marks (m,)."""
        return marks_of(self.law)

    @cached_property
    def extents(self) -> FloatArray:
        """How far the sides reach from their marks (2 m − 2,), ascending."""
        return np.repeat(0.5 * np.diff(self.marks), 2)

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

    @cached_property
    def phi(self) -> FloatArray:
        """Slip angles of the nodes (sides, nodes)."""
        sides = np.arange(self.extents.size)
        owner, way = (sides + 1) // 2, np.where(sides % 2, -1.0, 1.0)
        off = (way * self.extents)[:, None] * np.linspace(0.0, 1.0, NODES) ** 4
        c = self.marks[owner][:, None] + off
        phi = np.arctan2(1.0 + c, 1.0 - c)
        # next to pure sliding and pure spin from the distance
        phi[0] = np.arctan2(off[0], 2.0 - off[0])
        phi[-1] = 0.5 * np.pi - np.arctan2(-off[-1], 2.0 + off[-1])
        return phi

    @cached_property
    def patch(self) -> FloatArray:
        """p_a, p_b, p_d (sides, nodes, heights, 3), the same at all heights."""
        p = self.law.integrals(self.phi.ravel())
        patch = np.stack([p.a, p.b, p.d], axis=-1).reshape(*self.phi.shape, 1, 3)
        return np.broadcast_to(patch, (*self.phi.shape, HEIGHTS, 3))

    @cached_property
    def stops(self) -> FloatArray:
        """T, along, across/δ, path length and body angle (sides, nodes, heights, 5)."""
        accuracy = max(_FINEST, _SHARE * self.tol)
        found = []
        for puck in self.pucks:
            friction = puck.body.friction(0.1 * accuracy)
            cut = friction.for_motion(puck.gyration)
            stops = stops_at(puck.body, friction, cut, self.phi.ravel(), accuracy)[:, :5]
            stops[:, 2] /= puck.delta
            found.append(stops.reshape(*self.phi.shape, 5))
        return np.stack(found, axis=2)

    @cached_property
    def orbits(self) -> tuple[FloatArray, FloatArray]:
        """The orbits (4, nodes, heights, 2), and what depends on the height alone (heights, 7).

        From pure sliding and from pure spin; before θ = 0 (1 ± c) exp(rate θ), after it c, and the
        regular part of the heading over δ.  The limit of c, the turning over δ per θ there and in
        pure spin, and for both orbits the rates and c at θ = 0.
        """
        limits = np.array([_c(puck.limit_ratio) for puck in self.pucks])
        inertia, times = self.pucks[0].body.inertia, self.stops[..., 0]
        return _orbits(self.law, inertia, self.marks, self.extents, times, limits)


@lru_cache(maxsize=8)
def law_values(law: Law, gyration: float, tol: float) -> LawValues:
    """One for all files of the same pucks and error."""
    return LawValues(law, gyration, tol)


def _c(ratio: float) -> float:
    """(rω − v)/(rω + v) of a ratio rω/v."""
    return 1.0 if math.isinf(ratio) else (ratio - 1.0) / (ratio + 1.0)


def _orbits(
    law: Law, inertia: float, marks: FloatArray, extents: FloatArray, times: FloatArray,
    limits: FloatArray,
) -> tuple[FloatArray, FloatArray]:  # fmt: skip
    """The four pieces of the orbits (4, nodes, heights, 2), and the constants (heights, 7)."""
    shares = heights(HEIGHTS)
    xi = np.linspace(0.0, 1.0, NODES)
    splines = [
        [make_interp_spline(xi, times[side, :, j], 5) for j in range(HEIGHTS)]
        for side in range(len(times))
    ]
    borders = np.append(0.5 * (marks[1:] + marks[:-1]), marks[1:-1])
    borders.sort()

    def time_at(u: FloatArray) -> FloatArray:
        small = np.exp(-np.abs(u))
        share = 2.0 * small / (1.0 + small)  # 1 − |c|
        c = np.where(u < 0.0, share - 1.0, 1.0 - share)
        sides = np.searchsorted(borders, c)
        owner = (sides + 1) // 2
        gap = np.where(sides == 0, share, np.abs(c - marks[owner]))
        gap = np.where(sides == len(extents) - 1, share, gap)
        place = np.sqrt(np.sqrt(np.minimum(gap / extents[sides], 1.0)))
        return np.array([float(splines[s][j](place[j])) for j, s in enumerate(sides)])

    def friction(u: FloatArray) -> tuple[Resultants, FloatArray]:
        phi = np.where(u > 0.0, 0.5 * np.pi - np.arctan(np.exp(-u)), np.arctan(np.exp(u)))
        return moment_balance(law.integrals(phi), slip_direction(phi), shares), np.sin(phi)

    def slopes(_: float, y: FloatArray) -> FloatArray:
        u = np.clip(y[:HEIGHTS], -600.0, 600.0)
        rho, sine = friction(u)
        time = time_at(u)
        gap = rho.parallel - 0.5 / inertia * rho.spin
        return np.concatenate([-time * gap, time * sine * rho.perpendicular])

    after = xi[1:-1] ** 2 / (1.0 - xi[1:-1]) * REACH
    followed = after < _LAST
    orbits = np.empty((4, NODES, HEIGHTS, 2))
    starts = [_start(marks, limits, fast) for fast in (False, True)]
    at_limit, slow_end, fast_end = (
        slopes(0.0, np.concatenate([u, np.zeros(HEIGHTS)])).reshape(2, HEIGHTS)
        for u in (_u(limits), np.full(HEIGHTS, -600.0), np.full(HEIGHTS, 600.0))
    )
    rates = (-slow_end[0], fast_end[0])
    for piece in range(4):
        fast, ahead = divmod(piece, 2)
        sign = -1.0 if ahead else 1.0
        turning = at_limit[1] if ahead else (fast_end[1] if fast else 0.0)
        begin = np.concatenate([_u(starts[fast]), np.zeros(HEIGHTS)])
        way = solve_ivp(
            slopes, (0.0, sign * _LAST), begin, method="DOP853", rtol=_STEP, atol=_STEP,
            t_eval=sign * after[followed],
        ).y  # fmt: skip
        u, heading = way[:HEIGHTS].T, way[HEIGHTS:].T
        regular = heading - sign * after[followed][:, None] * turning
        count = followed.sum() + 1
        if ahead:
            orbits[piece, 0, :, 0], orbits[piece, count:, :, 0] = starts[fast], limits
            orbits[piece, 1:count, :, 0] = np.tanh(0.5 * u)
        else:
            towards = -1.0 if fast else 1.0
            share = 2.0 / (1.0 + np.exp(-towards * u))
            scaled = share * np.exp(rates[fast] * after[followed][:, None])
            orbits[piece, 0, :, 0] = 1.0 + towards * starts[fast]
            orbits[piece, 1:count, :, 0], orbits[piece, count:, :, 0] = scaled, scaled[-1]
        orbits[piece, 0, :, 1] = 0.0
        orbits[piece, 1:count, :, 1], orbits[piece, count:, :, 1] = regular, regular[-1]
    delta = shares * law.delta_max
    orbits[..., 1] /= delta
    turnings = (at_limit[1] / delta, fast_end[1] / delta)
    return orbits, np.stack([limits, *turnings, *rates, *starts], axis=1)


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
        return np.full(limits.size, inside[0] if fast else inside[-1])
    return 0.5 * (limits + (1.0 if fast else -1.0))
