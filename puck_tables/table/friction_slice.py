"""Friction of one puck: its three friction ratios over the slip angle, straight from truth.

For a pressure law and a height δ the ratios 1/ρ_∥, ρ_⊥/ρ_∥, ρ_ω/ρ_∥ are functions of φ alone.  They
are singular on a few lines: where the instantaneous centre of rotation crosses an edge of the load,
tan φ = 1/edge, and where contact opens, δ_c(φ) = δ, across which partial and full contact part like
x^(5/2).  Between them they are analytic.  (That in partial contact the centre of rotation crosses
the edge of the loaded part is not felt: the pressure is zero there.)
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import KW_ONLY, dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables.contact import one_sided
from puck_tables.contact.laws import HOMOGENEOUS, Law, law_of
from puck_tables.contact.opening import critical_delta
from puck_tables.contact.resultants import checked_delta
from puck_tables.errors import AccuracyError, ContactError, InputError
from puck_tables.kernels.slice_spline import LINE
from puck_tables.table.build import COARSEST
from puck_tables.table.check import Check, CheckReport, compared
from puck_tables.table.fit import height_terms
from puck_tables.table.law_record import (
    law_in_file,
    profile_curve,
    profile_rows,
    profile_shapes,
    unsaveable_law,
)
from puck_tables.table.oddities import odd_nodes
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.table.slip_axis import GRADING_POWER, LawAxis, sides_of
from puck_tables.table.slip_spline import SlipSpline, slip_spline
from puck_tables.table.table import Accuracy, Axis, Progress, Table

FloatArray = npt.NDArray[np.float64]

DEFAULT_ACCURACY, FINEST_ACCURACY = 1e-9, 5e-13  # truth itself is good to 1e-13
_LARGEST, _ROUNDING = 1e3, 1e-12  # of a ratio
_NODES, _NODE_ERROR = 6, 1e-10  # how many are compared as a file is read, and how well known
_AT_THE_LIMIT = 1e-6
_SAME_LINE = 1e-12  # radians
_SHARP_DELTA = 3.6


@dataclass(frozen=True, eq=False, repr=False)
class FrictionSlice(Table):
    """The friction ratios of a puck over its slip angle.

    Parameters
    ----------
    values : array (nodes of φ, 3)
        1/ρ_∥, ρ_⊥/ρ_∥, ρ_ω/ρ_∥.
    law : Law
    delta : dimensionless height 2fh/r
    cotangents : cot φ of the singular lines, ascending
    """

    _: KW_ONLY
    law: Law
    delta: float
    cotangents: tuple[float, ...]

    kind = "friction slice"
    algorithm = "one-sided balance by quadrature, or integrals of the law; 1"
    functions: ClassVar[Mapping[str, str]] = {
        "inverse_parallel": "1/rho_parallel",
        "perpendicular_share": "rho_perpendicular/rho_parallel",
        "spin_share": "rho_omega/rho_parallel",
    }
    second = "delta"
    quantities = tuple(functions)
    words: ClassVar[Mapping[str, str]] = {
        "title": "Friction of one sliding, spinning puck",
        "interpretation": (
            "Ratios of the friction resultants rho of a puck under the named pressure law, at one "
            "height delta = 2 f h / r, over phi = atan2(r omega, v): force on the puck "
            "-f N cos(phi) rho_parallel along its velocity, -f N sin(phi) cos(phi) "
            "rho_perpendicular across it (to the left), torque -(f N r / 2) sin(phi) rho_omega. "
            "Even in phi. Where part of the base lifts the pressure is max(0, a + b x + c y). "
            "Salnikova, Treschev, Gallyamov 2012, section 6."
        ),
        "method": "balance of moments by quadrature, 1e-13",
        "phi_map": f"two sides for each line: tan(phi - line) = extent xi^{GRADING_POWER}",
    }
    entries: ClassVar[Mapping[str, type]] = {
        "n_phi": int, "profile_rows": int, "delta": float, "cotangents": str,
    }  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        lines = np.array(self.cotangents)
        if not (lines.size and lines[0] > 0.0 and np.all(np.diff(lines) > 0.0)):
            raise ValueError("its lines are none")
        if (len(self.values) - 1) % (2 * lines.size) or not np.isfinite(lines[-1]):
            raise ValueError("its nodes are not those of its lines")

    @cached_property
    def axis(self) -> LawAxis:
        """The slip angles of its nodes."""
        cells = (len(self.values) - 1) // (2 * len(self.cotangents))
        return LawAxis(self.cotangents, cells)

    @cached_property
    def spline(self) -> SlipSpline:
        """Through the nodes."""
        return SlipSpline(self.axis.sides, self.axis.by_side(self.values), True, self.accuracy)

    @cached_property
    def opening(self) -> float:
        """The slip angle up to which part of the base is lifted, radians; 0 where none ever is."""
        return opening_angle(self.delta) if self.law.can_lift else 0.0

    @property
    def error(self) -> float:
        """The largest error of a ratio, measured."""
        return float(self.spline.error.max())

    @property
    def lines(self) -> tuple[float, ...]:
        """The singular lines, radians, ascending."""
        return tuple(side.line for side in self.spline.sides[::2])

    @cached_property
    def cut(self) -> FloatArray:
        """What compiled code reads: the pure ratios, for no motion in particular."""
        return self.spline.with_inertia(0.5, np.ones(3))

    def for_motion(self, gyration: float, coarser: bool = False) -> FloatArray:
        """The same for the motion of a puck with radius of gyration k (in units of r).

        The third ratio is multiplied by r²/(2k²): only r ω' = −(r²/2k²) J sin φ ρ_ω feels how the
        mass is spread.

        Parameters
        ----------
        gyration : k/r > 0
        coarser : by every other node only, to see what the spline contributes to an error
        """
        spline = self.spline.coarser() if coarser else self.spline
        # exactly 1 and ½ for a homogeneous puck
        square = 0.5 if gyration == HOMOGENEOUS else gyration * gyration
        cut = spline.with_inertia(square, np.array([1.0, 1.0, 0.5 / square]))
        # a line that is the limit of the motion is never crossed: rounding would, again and again
        limit = np.abs(self.spline.values[:, 0, 2] * (0.5 / square) - 1.0) < _AT_THE_LIMIT
        cut[limit, LINE] = math.inf
        return cut

    def ratios(self, phi: FloatArray) -> FloatArray:
        """1/ρ_∥, ρ_⊥/ρ_∥, ρ_ω/ρ_∥ at slip angles (n,), (n, 3)."""
        return self.spline.at(phi)

    def at_ends(self) -> FloatArray:
        """The same at φ = 0 and π/2, (2, 3), as tabulated: without an error of the spline."""
        return np.stack([self.spline.values[0, -1], self.spline.values[-1, -1]])

    def validate(self, progress: Progress | None = None, points: int = 600) -> CheckReport:
        """Judge the slice by the law.

        Parameters
        ----------
        progress : callable (done, total), optional
        points : how many are compared at random, and as many next to the lines, in cells and at
            nodes
        """
        rng = np.random.default_rng()
        nodes = self.axis.nodes()
        near = rng.choice([*self.lines, 0.0, 0.5 * np.pi], points)
        near += rng.choice([-1.0, 1.0], points) * 10.0 ** -rng.uniform(0.3, 15.0, points)
        some = rng.permutation(nodes.size - 1)[:points]
        inside = nodes[some] + rng.random(some.size) * np.diff(nodes)[some]
        odd = self._odd_nodes(points // 2)
        allowed = min(self.tolerance, COARSEST)
        routes = (
            ("the law, random points", rng.uniform(0.0, 0.5 * np.pi, points), allowed),
            ("the law, next to the lines", np.clip(near, 0.0, 0.5 * np.pi), allowed),
            ("the law, in the cells", inside, allowed),
            ("the law, the oddest nodes", nodes[odd], max(allowed, _NODE_ERROR)),
        )
        checks: list[Check] = []
        for done, (name, phi, most) in enumerate(routes, 1):
            errors = (self.ratios(phi) - _ratios(self.law, phi, self.delta)).T
            checks += compared(name, self.quantities, errors, phi, 0.0 * phi + self.delta, most)
            if progress is not None:
                progress(done, len(routes))
        return CheckReport(self.source, self.tolerance, tuple(checks))

    def _odd_nodes(self, count: int) -> npt.NDArray[np.int64]:
        """Numbers of nodes that fit their neighbours least."""
        odd = odd_nodes(self.axis.by_side(self.values), (1,), count)
        return np.unique(self.axis.numbers[odd[:, 0], odd[:, 1]])

    # the record of the kind

    @classmethod
    def is_of(cls, of: object) -> bool:
        """A pressure law and a height."""
        return isinstance(of, tuple) and len(of) == 2 and isinstance(of[0], Law | str)

    @classmethod
    def built(cls, of: Any, accuracy: float | None = None, **how: Any) -> FrictionSlice:
        """The friction of one puck, see :meth:`puck_tables.Table.build`."""
        law = of[0] if isinstance(of[0], Law) else law_of(of[0])
        wanted = DEFAULT_ACCURACY if accuracy is None else accuracy
        if not FINEST_ACCURACY <= wanted <= COARSEST:
            raise AccuracyError(
                f"accuracy must be from {FINEST_ACCURACY:g} to {COARSEST:g} (an absolute error of "
                f"the friction ratios), got {wanted:g}"
            )
        return friction_slice(law, float(checked_delta(of[1])), wanted, **how)

    @property
    def pressure_law(self) -> str:
        """The name of the pressure law."""
        return self.law.name

    @property
    def grid(self) -> str:
        """How many nodes it has, in words."""
        return f"{len(self.values)} phi nodes"

    @property
    def valid_range(self) -> str:
        """Where it holds, in words."""
        return f"|phi| <= pi/2, delta = {self.delta:g} only"

    @property
    def axes(self) -> dict[str, Axis]:
        """Slip angle."""
        return {"phi": Axis(self.axis.nodes(), "rad", "slip angle atan2(r omega, v)")}

    @property
    def parameters(self) -> dict[str, int | float | str]:
        """Height, lines and nodes, and how many rows a tabulated law has."""
        return {
            "n_phi": len(self.values), "profile_rows": profile_rows(self.law),
            "delta": self.delta, "cotangents": json.dumps(self.cotangents),
        }  # fmt: skip

    @property
    def curve(self) -> dict[str, Axis]:
        """A tabulated law."""
        return profile_curve(self.law)

    @property
    def bounds(self) -> tuple[float, float, float]:
        """Of the values and of the accuracy."""
        return -_ROUNDING, _LARGEST, 0.1 * FINEST_ACCURACY

    @classmethod
    def shapes(cls, attributes: dict[str, Any]) -> dict[str, tuple[int, ...]]:
        """Shapes of the arrays of a file with these attributes.

        Examples
        --------
        >>> FrictionSlice.shapes({"n_phi": 33, "profile_rows": 0})["phi"]
        (33,)
        """
        nodes = (attributes["n_phi"],)
        return {"phi": nodes, **dict.fromkeys(cls.functions, nodes), **profile_shapes(attributes)}

    @classmethod
    def fields(cls, attributes: dict[str, Any], arrays: dict[str, FloatArray]) -> dict[str, Any]:
        """Law, height and lines of a file."""
        law, lines = law_in_file(attributes, arrays), json.loads(attributes["cotangents"])
        refuse_height(law, attributes["delta"])
        lines = tuple(float(line) for line in lines)
        return {"law": law, "delta": attributes["delta"], "cotangents": lines}

    @property
    def unsaveable(self) -> str | None:
        """A law that is a function."""
        return unsaveable_law(self.law)

    def spot_checks(self) -> Iterator[tuple[FloatArray, float, str]]:
        """Of nodes, those that fit their neighbours least among them."""
        nodes = np.random.default_rng().integers(0, len(self.values), _NODES)
        nodes = np.concatenate([self._odd_nodes(_NODES), nodes])
        truth = _ratios(self.law, self.axis.nodes()[nodes], self.delta)
        yield np.abs(self.values[nodes] - truth), _NODE_ERROR, f"the law {self.law.name}"


def slice_of(table: ResultantTable, delta: float, accuracy: float) -> FrictionSlice:
    """The section of a table of resultants at one height: the table is all that is asked.

    Parameters
    ----------
    table : of the puck's pressure law
    delta : dimensionless height 2fh/r
    accuracy : the largest error of a friction ratio

    Raises
    ------
    InputError
        If the height is outside the table, or the table of an odd number of cells.
    AccuracyError
        If the table is not so exact.

    Examples
    --------
    >>> table = ResultantTable.build("ring", 1e-8)
    >>> inverse, across, spin = slice_of(table, 1.0, 1e-6).ratios(np.array([0.0]))[0]
    >>> round(float(across / inverse), 6)  # ρ_⊥
    0.25
    """
    table.checked_range(delta, table.law.name)
    if table.axis.cells % 2:
        raise InputError(
            f"{table.source} has an odd number of cells ({table.axis.cells}), which motions cannot "
            "halve to see what it contributes to an error: build one with --accuracy"
        )
    a0, a2, b1, c0, c2 = height_terms(table.values, table.heights).T
    values = np.stack([a0 + a2 * delta**2, b1 * delta, c0 + c2 * delta**2], axis=-1)
    # an error of ρ_∥ stands in every ratio
    error = table.tolerance * float(values[:, 0].max() * (1.0 + values.max()))
    if error > accuracy:
        raise AccuracyError(
            f"{table.source} gives the friction ratios to {error:.1g}, not to {accuracy:.1g}: "
            "give a finer table, or a larger tol (--tol)", reachable=error,
        )  # fmt: skip
    everywhere = (error,) * 3, (error,) * 3, (error,) * 3, (0.0,) * 3, (delta,) * 3
    return FrictionSlice(
        values, law=table.law, delta=delta, cotangents=table.law.edges, tolerance=error,
        accuracy=Accuracy(*everywhere, promised=3, order=0.0, points=0), source=table.source,
    )  # fmt: skip


def _ratios(law: Law, phi: FloatArray, delta: float) -> FloatArray:
    """The friction ratios by the law, (n, 3)."""
    rho = law.friction(phi, delta)
    return np.stack([1.0 / rho.parallel, rho.perpendicular / rho.parallel,
                     rho.spin / rho.parallel], axis=-1)  # fmt: skip


def refuse_height(law: Law, delta: float) -> None:
    """Refuse a height at which the friction is not known at every slip angle.

    Raises
    ------
    InputError
        If it is not a height, or beyond full contact under another law than uniform pressure.
    ContactError
        If the puck tips, or its contact is not determined.

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> refuse_height(law_of("ring"), 2.0)
    """
    law.friction(0.0, delta)
    if law.can_lift and delta > one_sided.FOLD_DELTA:
        raise ContactError(
            f"delta = {delta:g}: beyond {one_sided.FOLD_DELTA:g} the balance of moments has more "
            "than one solution just below phi = pi/4, and the motion is not determined; choose a "
            "lower or broader puck or less friction"
        )


def opening_angle(delta: float) -> float:
    """The slip angle φ_c with δ_c(φ_c) = δ, up to which part of the base is lifted; 0 if δ ≤ 1.

    Examples
    --------
    >>> round(opening_angle(1.15913851), 6)  # π/4
    0.785398
    """
    if delta <= 1.0:
        return 0.0
    low, high = 0.0, 0.5 * math.pi
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return high
        if critical_delta(middle) < delta:
            low = middle
        else:
            high = middle


def _sharpest_bend(delta: float) -> float:
    """Where just below π/4 the ratios of a puck next to tipping bend most; 0 for lower ones.

    They are analytic there, but towards the fold of the balance (δ = 3.9638) on a scale that
    shrinks to nothing.  Nodes crowded there make the spline at δ = 3.9 240 times as good.
    """
    if delta < _SHARP_DELTA:
        return 0.0
    low, high = 0.25 * math.pi - 0.1, 0.25 * math.pi - 0.002
    while high - low > 1e-6:
        phi = np.linspace(low, high, 33)
        rho = one_sided.resultants(phi, delta)
        n = int(np.abs(np.diff(rho.perpendicular / rho.parallel, 2)).argmax())
        low, high = float(phi[max(n - 2, 0)]), float(phi[min(n + 3, 32)])
    return low


@lru_cache(maxsize=64)
def friction_slice(law: Law, delta: float, accuracy: float = DEFAULT_ACCURACY) -> FrictionSlice:
    """Tabulate the friction of one puck.

    Parameters
    ----------
    law : Law
    delta : dimensionless height 2fh/r
        Up to 3.9637 under uniform pressure, to ``law.delta_max`` under another.
    accuracy : the largest error of a friction ratio

    Returns
    -------
    FrictionSlice
        Kept: the same call again costs nothing.

    Raises
    ------
    InputError, ContactError
        If the height is out of range.
    AccuracyError
        If the accuracy is out of reach.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 6; beyond full contact the same balance of moments
    with σ = max(0, a + b x + c y).

    Examples
    --------
    >>> from puck_tables.contact.laws import law_of
    >>> found = friction_slice(law_of("uniform"), 2.0, 1e-7)
    >>> inverse, across, spin = found.ratios(np.array([0.5]))[0]
    >>> round(float(spin / inverse), 6)  # ρ_ω
    0.219633
    """
    refuse_height(law, delta)
    opening = opening_angle(delta) if law.can_lift else 0.0
    cotangents = list(law.edges[::-1])
    for line in (opening, _sharpest_bend(delta) if law.can_lift else 0.0):
        if line > 0.0 and all(abs(line - math.atan2(1.0, e)) > _SAME_LINE for e in law.edges):
            cotangents = sorted([*cotangents, 1.0 / math.tan(line)], reverse=True)
    spline = slip_spline(
        lambda phi: _ratios(law, phi, delta), sides_of(cotangents), accuracy, even=True
    )
    assert spline.accuracy is not None
    lines = tuple(cotangents[::-1])
    return FrictionSlice(
        LawAxis(lines, spline.cells).joined(spline.values), law=law, delta=delta,
        cotangents=lines, tolerance=accuracy,
        accuracy=replace(spline.accuracy, at_second=3 * (delta,)),
    )  # fmt: skip
