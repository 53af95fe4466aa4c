"""The table of stops: where and when any puck stops, and how it gets there, over φ and δ."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.closed_form import checked_delta
from puck_tables.errors import InputError
from puck_tables.io.columns import Variable
from puck_tables.motion.state import STATE_ROWS
from puck_tables.stopping.launch_arrays import (
    CHUNK,
    TOO_LARGE,
    Launches,
    fits,
    in_chunks,
    launches_in,
    smallest_mark,
)
from puck_tables.stopping.lookup import (
    CONSTANT_HEIGHTS,
    HEIGHTS,
    STOP_POWERS,
    SlipAxis,
    by_power,
    height_polynomials,
    heights,
    section_rows,
    side_by_side,
    stops_kernel,
)
from puck_tables.stopping.similarity import InverseSolution, limits
from puck_tables.stopping.similarity_lookup import (
    LAUNCH_COLUMNS,
    REGULAR,
    STOPS_WIDTH,
    TURN_POWERS,
    TURN_STEP,
)
from puck_tables.stopping.slopes import Slopes, slopes_of
from puck_tables.stopping.state_lookup import PUCK_ROWS
from puck_tables.table.table import Table

UPPER_DELTA = 1.0  # above, part of the base may lift
OTHERS = ("path_length", "turn_angle", "body_angle")
STOPS = 5  # of the functions are of stops; the others of the curve of all motions
_INTERPRETATION = (
    "Where and when a uniform cylinder (radius r, height h) launched with speed v and spin omega "
    "on a rough plane stops, whole base loaded. Q = hypot(v, r omega), "
    "phi = atan2(r omega, v) >= 0, delta = 2 f h / r, J = f g. "
    "Stop time = (Q/J) time. Displacement along the launch velocity = "
    "(Q^2/J) cos(phi) along, to its left = (Q^2/J) delta sin(phi) cos(phi) across. Path length = "
    "(Q^2/J) cos(phi) length, body angle = (Q^2/(J r)) sin(phi) body. For omega < 0 the mirror "
    "image. Along a motion, with c = (r omega - v)/(r omega + v) and c0 its limit, ln Q = "
    "(ln|c - c0| + curve)/kappa - ln(1 + c)/A - ln(1 - c)/B and heading = h0 ln Q "
    "+ (h0/A) ln(1 + c) + ((h0 - h1)/B) ln(1 - c) + delta turn, up to constants; "
    "A = 1/2 + delta^2/8, B = (9 + 4 delta^2)/(36 + 4 delta^2), h1 = 9 delta/(36 + 4 delta^2), "
    "kappa = d ln|c - c0|/d ln Q and h0 = d heading/d ln Q at c0. "
    "Salnikova, Treschev, Gallyamov 2012, eq. 6.2-6.7 and section 7."
)


@dataclass(frozen=True, eq=False, repr=False)
class StopValues(Table):
    """Where and when any puck stops, and how it gets there, with the splines through them.

    :class:`puck_tables.stopping.stop_table.StopTable` adds how it is built and judged.
    """

    kind = "stops"
    algorithm = "Dormand-Prince with closed forms at 2e-14, curve by Gauss quadrature; 1"
    functions: ClassVar[Mapping[str, str]] = {
        "time": "stop time J t/Q",
        "along": "displacement along the launch velocity J x/(Q^2 cos(phi))",
        "across": "displacement to its left J y/(Q^2 delta sin(phi) cos(phi))",
        "length": "path length J l/(Q^2 cos(phi))",
        "body": "body angle J r theta/(Q^2 sin(phi))",
        "curve": "regular part of ln Q along a motion, times kappa",
        "turn": "regular part of the heading along a motion, over delta",
    }
    second = "delta"
    quantities = ("time", "x", "y", "path", "body", "curve", "turn")
    words: ClassVar[Mapping[str, str]] = {
        "title": "Stops of a sliding, spinning puck",
        "interpretation": _INTERPRETATION,
        "method": "stops integrated with closed forms to 1e-15, curve by quadrature to 1e-14",
        "phi_map": (
            "tan(phi) below pi/4, cot(phi) above = q^4/(2 - q^4), q = xi (2 - xi), xi = i/cells "
            "from either end; cubic splines with zero end slopes in xi on either side of pi/4"
        ),
        "delta_map": (
            "delta = sin(pi (2 j + 1)/36); polynomial in delta^2, degree 7 for stops, 8 for the "
            "curve"
        ),
    }

    def stops(
        self, launches: Launches, powers: int = STOP_POWERS, thinning: int = 1,
        threads: int | None = 1,
    ) -> tuple[FloatArray, FloatArray, int, int]:  # fmt: skip
        """Stop time (n,), place (n, 2), how many may be too large, and the mark of launches.

        Parameters
        ----------
        launches : Launches
        powers, thinning : see :meth:`thinned`
        threads : as for :func:`puck_tables.stop`

        Raises
        ------
        InputError
            If one of them is no launch.

        Examples
        --------
        >>> from puck_tables import Table
        >>> from puck_tables.stopping.launch_arrays import launches_of
        >>> launch = launches_of((1.0, 0.0), 5.0, 1.0, 1.0, 1.0)
        >>> time, place, _, _ = Table.shipped("stops").stops(launch)
        >>> time.round(6).tolist(), place.round(6).tolist()
        ([4.000189], [[2.257241, -0.308477]])
        """
        size = launches.size
        time, place = np.empty(size), np.empty((size, 2))
        fill, rows, both = stops_kernel(powers), self.thinned(powers, thinning), place.reshape(-1)
        if size <= CHUNK:
            doubtful, bad, mark = fill(*launches.part(0, size), rows, time, both, both[1:], 2)
            mark = int(mark) % (1 << 64)
        else:
            result = []

            def work(start: int, stop: int) -> None:
                x, y = both[2 * start : 2 * stop], both[2 * start + 1 : 2 * stop]
                part = launches.part(start, stop)
                result.append((start, *fill(*part, rows, time[start:stop], x, y, 2)))

            in_chunks(work, size, threads)
            _, doubtful, bad, _ = map(sum, zip(*result, strict=True))
            mark = smallest_mark((at, mark) for at, _, _, mark in result)
        if bad:
            launches.refuse_bad()
        return time, place, doubtful, mark

    def known(self, launches: FloatArray) -> FloatArray:
        """What the table knows of checked launches (6, n), see :func:`look_up_launch`; (14, n)."""
        return self.pucks(launches_in(launches))[LAUNCH_COLUMNS:]

    def pucks(self, launches: Launches, threads: int | None = None) -> FloatArray:
        """Launches, and what the table knows of them, (6 + 14, n).

        Raises
        ------
        InputError
            If one of them is no launch, or too large for floating point.
        """
        return self.filled(PUCK_ROWS, launches, threads)[0]

    def filled(self, rows: int, launches: Launches, threads: int | None) -> tuple[FloatArray, int]:
        """Rows of so many launches as :meth:`fill_pucks` has them, and how many may be too large.

        Raises
        ------
        InputError
            If one of them is no launch.
        """
        if launches.size <= CHUNK:
            return self.fill_pucks(rows, launches, 0, launches.size)
        out, doubtful = np.empty((rows, launches.size)), [0]

        def work(start: int, stop: int) -> None:
            out[:, start:stop], count = self.fill_pucks(rows, launches, start, stop)
            doubtful.append(count)

        in_chunks(work, launches.size, threads)
        return out, sum(doubtful)

    def fill_pucks(
        self, rows: int, launches: Launches, start: int, stop: int
    ) -> tuple[FloatArray, int]:
        """All that is known of some launches (20, n), or their stops (6, n), or the rest (3, n).

        The rest: path length, turn of heading and of the body.

        And how many may be too large for floating point.

        Raises
        ------
        InputError
            If one of them is no launch, or, where all is asked, too large for floating point.
        """
        from puck_tables.motion.path import TURN_SHARE
        from puck_tables.stopping.launch_lookup import fill_launch_lookup

        out = np.empty((rows, stop - start))
        doubtful, bad = fill_launch_lookup(
            *launches.part(start, stop), self.thinned(), self.launch_coefficients,
            self.turn_coefficients, self.constants, TURN_SHARE, out,
        )  # fmt: skip
        if bad:
            launches.refuse_bad()
        if doubtful and rows == PUCK_ROWS and not fits(out[:LAUNCH_COLUMNS]).all():
            raise InputError(TOO_LARGE)
        return out, doubtful

    def states_of_one(self, launch: Launches, moments: FloatArray) -> FloatArray | None:
        """States (6, n) of one launch at moments (n,), headings from its own; None: to be refused.

        What is known of it and its states in one call, which costs most where moments are few.
        """
        fill, arrays = self._of_one
        out = np.empty((STATE_ROWS, moments.size))
        return None if fill(*launch.part(0, 1), *arrays, moments, out) else out

    @cached_property
    def _of_one(self) -> tuple[Callable[..., int], tuple[FloatArray, ...]]:
        from puck_tables.stopping.launch_lookup import fill_states_of_one

        return fill_states_of_one, (
            self.thinned(), self.launch_coefficients, self.turn_coefficients, self.constants,
            self.state_coefficients,
        )  # fmt: skip

    def checked_range(self, delta: npt.ArrayLike) -> FloatArray:
        """``delta`` as an array, refused outside the range of the table."""
        height = checked_delta(delta)
        if not np.all(height <= UPPER_DELTA):
            raise InputError(
                f"delta = {height[height > UPPER_DELTA].flat[0]!s} is outside this table "
                f"(0 <= delta <= {UPPER_DELTA:g}): beyond, the whole base does not stay loaded in "
                "every motion"
            )
        return height

    # as compiled code reads it: coefficients of splines, made when asked for

    @cached_property
    def axis(self) -> SlipAxis:
        """The slip angles of its nodes."""
        return SlipAxis(len(self.values) // 2)

    @cached_property
    def constants(self) -> FloatArray:
        """c₀, κ, h₀/δ and ln T(π/4) as polynomials in 2δ² − 1, (4, 14)."""
        rows = []
        for delta in heights(CONSTANT_HEIGHTS):
            at = limits(float(delta))
            rows.append([math.tanh(0.5 * at.u), at.kappa, at.turn / delta])
        polynomials = np.zeros((4, CONSTANT_HEIGHTS))
        polynomials[:3] = height_polynomials(np.array(rows), CONSTANT_HEIGHTS).T
        quarter = np.log(self.values[self.axis.cells, :, 0])
        polynomials[3, :HEIGHTS] = height_polynomials(quarter)
        return polynomials

    @cached_property
    def height_constants(self) -> FloatArray:
        """The constants of a height, those of a power side by side, (14, 4)."""
        return np.ascontiguousarray(self.constants.T)

    @cached_property
    def slopes(self) -> Slopes:
        """What derivatives of stops and states need."""
        return slopes_of(self.axis, self.values)

    @cached_property
    def launch_coefficients(self) -> FloatArray:
        """Body angle, S/δ, κR, path length: as compiled look-ups of launches read them."""
        return side_by_side(by_power(self._sides([4, 6, 5, 3])))

    @cached_property
    def state_coefficients(self) -> FloatArray:
        """What :mod:`puck_tables.stopping.state_lookup` reads."""
        values = by_power(self.inverse.splined(with_time=True))
        padded = np.zeros((*values.shape[:3], STOPS_WIDTH))
        padded[..., : values.shape[3]] = values
        return side_by_side(padded)

    @cached_property
    def turn_coefficients(self) -> FloatArray:
        """The heading's regular part over the place by Q, (2, cells + 3, 12)."""
        parts = by_power(self.inverse.splined(with_time=False)[..., REGULAR:])
        padded = np.zeros((TURN_STEP * TURN_POWERS, *parts.shape[1:]))
        padded[: len(parts)] = parts
        return side_by_side(padded)

    @cached_property
    def inverse(self) -> InverseSolution:
        """From the time that is left, or Q, to the place on the curve, at the nodes."""
        return InverseSolution(self.constants, self._sides(list(range(len(self.functions)))))

    def _sides(self, functions: list[int], thinning: int = 1) -> FloatArray:
        """Some functions at the nodes (2, cells + 1, heights, functions), from k = 0 to k = 1."""
        n, values = self.axis.cells // thinning, self.values[::thinning, :, functions]
        return np.stack([values[: n + 1], values[: n - 1 : -1]])

    @cached_property
    def _thinned_tables(self) -> dict[tuple[int, int], FloatArray]:
        return {}

    def thinned(self, powers: int = STOP_POWERS, thinning: int = 1) -> FloatArray:
        """What :func:`puck_tables.stopping.lookup.stops_kernel` reads, as coarse as wanted.

        Parameters
        ----------
        powers : powers of 2δ² − 1 to keep for T; the others keep one fewer, enough for them
        thinning : keep every so many nodes of the slip axis; divides ``axis.cells``

        Returns
        -------
        array (2, cells/thinning + 3, powers × WIDTH)
        """
        if (powers, thinning) in self._thinned_tables:
            return self._thinned_tables[powers, thinning]
        kept = section_rows(self._sides([0, 1, 2, 4], thinning), powers)
        self._thinned_tables[powers, thinning] = kept
        return kept

    # the record of the kind

    @property
    def valid_range(self) -> str:
        """Where it holds, in words."""
        return f"|phi| <= pi/2, 0 <= delta <= {UPPER_DELTA:g}; refused outside"

    @property
    def axes(self) -> dict[str, Variable]:
        """Slip angle and height."""
        return {
            "phi": Variable(self.axis.phi(), ("phi",), "rad", "slip angle atan2(r omega, v)"),
            "delta": Variable(heights(), ("delta",), "1", "dimensionless height 2 f h / r"),
        }
