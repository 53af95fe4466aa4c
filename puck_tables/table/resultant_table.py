"""The table of friction resultants in full contact: built from its pressure law, judged by it.

Held are ρ_∥, ρ_⊥, ρ_ω at the nodes of φ and at four heights; splined are the friction ratios 1/ρ_∥,
ρ_⊥/ρ_∥, ρ_ω/ρ_∥, because in full contact they are polynomials of degree 2 in δ under every law:
five columns over φ are the whole table (:mod:`puck_tables.kernels.quadratic`), and its section at
one height is three.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, Self, cast

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast
from puck_tables._core.waiting import Progress
from puck_tables.contact import quadrature
from puck_tables.contact.closed_form import Resultants, checked_delta, moment_balance
from puck_tables.contact.integrals import checked_phi, slip_direction
from puck_tables.contact.laws import Law, law_of
from puck_tables.errors import InputError
from puck_tables.io.columns import Variable
from puck_tables.table.build import COARSEST, Goal, built
from puck_tables.table.check import Accuracy, CheckReport, Route, judged
from puck_tables.table.section_table import LawTable
from puck_tables.table.slip_spline import GRADING_POWER, LawAxis
from puck_tables.table.spline_fit import height_terms, sided_coefficients
from puck_tables.table.table import kinds

Tell = Callable[[int], None]

HEIGHTS = 4  # nodes of δ in a file
_INTERPRETATION = (
    "Friction on a puck of radius r, height h, mass m sliding with speed v and spin omega "
    "on a rough plane, Coulomb coefficient f, weight N = m g, whole base loaded by the "
    "named pressure law, tilted linearly by the moment balance. "
    "phi = atan2(r omega, v), delta = 2 f h / r. "
    "Force on the puck: -f N cos(phi) parallel along its velocity, -f N sin(phi) cos(phi) "
    "perpendicular across it (to the left), torque -(f N r / 2) sin(phi) spin about the "
    "vertical. Even in phi. Salnikova, Treschev, Gallyamov 2012, sections 3 and 6."
)
# where truth is closed forms, and where it is quadrature
_EXACT = Goal(2e-11, 1e-13, "an absolute error of the dimensionless resultants", 1.2, 1 << 16)
_BY_QUADRATURE = Goal(1e-9, 1e-11, _EXACT.units, 2.0, 2048, safety=1.25)
_PROBES, _FEW_PROBES = 60_000, 2400  # about as many points are measured
_CHUNK = 256  # angles between two reports of progress
_CEILING, _FLOOR = 3.0, 1e-13  # largest error × cells⁴, twice what was measured, and of the nodes
_NODE = 1e-10  # how well nodes under a law of quadrature are known


@dataclass(frozen=True, eq=False, repr=False)
class ResultantTable(LawTable):
    """Friction resultants under a pressure law, 0 ≤ δ ≤ 4⟨x²⟩, with the spline through them.

    ``values`` (nodes of φ, 4, 3): ρ_∥, ρ_⊥, ρ_ω at the nodes of ``axis`` and at δ = 0, ⅓, ⅔ and 1
    of ``delta_max``.
    """

    kind = "resultants"
    algorithm = "integrals of the law; friction ratios splined on its sides; 2"
    functions: ClassVar[Mapping[str, str]] = {
        "parallel": "friction resultant along the velocity, rho_parallel",
        "perpendicular": "friction resultant across the velocity, rho_perpendicular",
        "spin": "friction torque about the vertical, rho_omega",
    }
    second = "delta"
    quantities = tuple(functions)
    words: ClassVar[Mapping[str, str]] = {
        "title": "Friction resultants of a sliding, spinning puck",
        "interpretation": _INTERPRETATION,
        "method": "integrals of the pressure law over the base: uniform 2e-15, others 1e-13",
        "phi_map": (
            "sides in the order of phi, two for each edge of the load: phi_e = atan(1/edge), "
            f"tan(phi - phi_e) = extent xi^{GRADING_POWER}, xi = i/n from phi_e, xi = 1 at phi = 0,"
            " pi/2 or half way to the next line; cubic splines in xi with zero slope at xi = 0 and "
            "at phi = 0 and pi/2, else not-a-knot"
        ),
        "delta_map": "delta = delta_max j/3; polynomials of degree 2",
        "splined": "1/parallel, perpendicular/parallel, spin/parallel",
    }

    @property
    def lines_at(self) -> tuple[float, ...]:
        """Where the centre of rotation crosses an edge of the load."""
        return self.law.edges

    @cached_property
    def delta_max(self) -> float:
        """The largest δ: contact is full at every φ up to it."""
        return full_contact(self.law)

    @property
    def heights(self) -> FloatArray:
        """δ at the nodes."""
        return np.linspace(0.0, self.delta_max, HEIGHTS)

    @cached_property
    def columns(self) -> FloatArray:
        """What :mod:`puck_tables.kernels.quadratic` reads, fitted at first use; read-only."""
        terms = height_terms(self.values, self.heights)
        spline = np.ascontiguousarray(sided_coefficients(self.axis.by_side(terms), True) / 6.0)
        spline.flags.writeable = False
        return spline

    def section(self, delta: float) -> FloatArray:
        """The friction ratios at one height, as :mod:`puck_tables.kernels.quadratic` reads.

        Raises InputError if δ is outside the range of the table, or it is not of uniform pressure.
        """
        from puck_tables.kernels.quadratic import room_for_section, section_at

        height = float(self.checked_range(delta))
        out = room_for_section(self.columns)
        section_at(self.columns, height, out)
        return out

    def checked_range(self, delta: npt.ArrayLike, law: Law | None = None) -> FloatArray:
        """Dimensionless heights as an array, refused outside the range of the table.

        ``law``: the pressure law that friction is wanted under, uniform pressure where left out.
        Raises InputError if a height is not finite, negative or above the largest of the table, or
        the table is of another law.
        """
        law = law or law_of("uniform")
        if self.law != law:
            raise InputError(
                f"{self.source} is a table under the pressure law {self.law.name}, not "
                f"{law.name}{'' if self.law.name != law.name else ' as it is now'}: give a table "
                "of that law"
            )
        height = checked_delta(delta)
        if not np.all(height <= self.delta_max):
            raise InputError(
                f"delta = {height[height > self.delta_max].flat[0]!s} is outside this table "
                f"(pressure law {law.name}: 0 <= delta <= {self.delta_max:g}): beyond, part of the "
                "base lifts at some phi; where none does, use the closed forms (--exact)"
            )
        return height

    def resultants(self, phi: npt.ArrayLike, delta: npt.ArrayLike) -> Resultants:
        """Interpolated resultants ρ_∥, ρ_⊥, ρ_ω.

        Parameters
        ----------
        phi : array_like, radians, in [−π/2, π/2]
        delta : array_like, dimensionless, in [0, delta_max]
            Broadcast against ``phi``.

        Returns
        -------
        Resultants
            Dimensionless arrays of the broadcast shape; ``accuracy`` says how exact.

        Raises
        ------
        InputError
            If an argument is not finite or outside its range; nothing is extrapolated.

        Notes
        -----
        Cubic splines in φ times polynomials of degree 2 in δ.  The resultants: Salnikova, Treschev,
        Gallyamov 2012, section 6.

        Examples
        --------
        >>> from puck_tables import Table
        >>> float(Table.shipped().resultants(0.0, 0.5).perpendicular.round(12))
        0.125
        """
        from puck_tables.kernels.quadratic import fill_resultants

        height = self.checked_range(delta, self.law)
        angle, height = broadcast(phi=checked_phi(phi), delta=height)
        out = np.empty((3, angle.size))
        phi_, delta_ = (np.ascontiguousarray(axis).reshape(-1) for axis in (angle, height))
        fill_resultants(self.columns, np.array(self.axis.sides), phi_, delta_, out)
        return Resultants(*(row.reshape(angle.shape) for row in out))

    # the record of the kind

    @property
    def valid_range(self) -> str:
        """Where it holds, in words."""
        return f"|phi| <= pi/2, 0 <= delta <= {self.delta_max:g}; refused outside"

    @property
    def axes(self) -> dict[str, Variable]:
        """Slip angle and height."""
        return {
            "phi": Variable(self.axis.nodes(), ("phi",), "rad", "slip angle atan2(r omega, v)"),
            "delta": Variable(self.heights, ("delta",), "1", "dimensionless height 2 f h / r"),
        }

    @classmethod
    def is_of(cls, of: object) -> bool:
        """Pressure laws and their names."""
        return isinstance(of, Law) or (isinstance(of, str) and of not in kinds())

    @classmethod
    def built(cls, of: Any, accuracy: float | None = None, **how: Any) -> Self:
        """A table under a pressure law, see :meth:`puck_tables.Table.build`."""
        return cls._of_law(of if isinstance(of, Law) else law_of(of), accuracy, **how)

    @classmethod
    def _of_law(
        cls, law: Law, accuracy: float | None, cells: int | None = None,
        progress: Progress | None = None,
    ) -> Self:  # fmt: skip
        probes = _PROBES if law.can_lift else _FEW_PROBES
        done, work = 0, probes

        def tell(count: int) -> None:
            nonlocal done
            done += count
            if progress is not None:
                progress(min(done, work), work)

        def at(cells: int) -> ResultantTable:
            nonlocal done, work
            done, work = 0, LawAxis(law.edges, cells).size + probes
            return cls.tabulated(law, cells, tell)

        goal = _EXACT if law.can_lift else _BY_QUADRATURE
        result = built(at, lambda table: _measured(table, probes, tell), goal, accuracy, cells)
        return cast(Self, result)

    @classmethod
    def tabulated(cls, law: Law, cells: int, tell: Tell | None = None) -> Self:
        """The node values of a table, without a measured accuracy.

        >>> ResultantTable.tabulated(law_of("annulus:0.5"), 8).values.shape
        (33, 4, 3)
        """
        phi = LawAxis(law.edges, cells).nodes()
        heights = np.linspace(0.0, full_contact(law), HEIGHTS)
        return cls(_truth(law, phi[:, None], heights, tell), law=law)

    def validate(self, progress: Progress | None = None, points: int | None = None) -> CheckReport:
        """Judge the table by the law itself, under uniform pressure also by direct quadrature.

        At so many random ``points``, next to the singular lines, in every cell and at every node;
        other points at every call.

        >>> ResultantTable.shipped().validate(points=50).passed
        True
        """
        uniform, rng = self.law.can_lift, np.random.default_rng()
        count = (40_000 if uniform else 3000) if points is None else points
        truth = "closed forms" if uniform else "quadrature"
        allowed = min(self.tolerance, COARSEST)
        if uniform:  # what it promises, but no more than its grid can need
            allowed = min(self.tolerance, _CEILING / self.axis.cells**4 + _FLOOR)

        def off(phi: FloatArray, delta: FloatArray) -> FloatArray:
            return np.stack(self.resultants(phi, delta)) - _truth(self.law, phi, delta).T

        def off_at_nodes(phi: FloatArray, delta: FloatArray) -> FloatArray:
            missed = self.values - _truth(self.law, nodes[:, None], self.heights)
            return missed.reshape(-1, len(self.functions)).T

        names, nodes = self.functions, self.axis.nodes()
        inside = nodes[:-1] + rng.random(nodes.size - 1) * np.diff(nodes)
        every_phi, every_delta = np.broadcast_arrays(nodes[:, None], self.heights)
        routes = [
            Route(truth, names, *adversarial_points(self, count, seed=None), off, allowed),
            Route(f"{truth}, every cell", names, inside, self.delta_max * rng.random(inside.size),
                  off, allowed),
            Route("every node", names, every_phi.ravel(), every_delta.ravel(), off_at_nodes,
                  min(allowed, _NODE)),
        ]  # fmt: skip
        if uniform:

            def off_quadrature(phi: FloatArray, delta: FloatArray) -> FloatArray:
                direct = moment_balance(quadrature.integrals(phi), slip_direction(phi), delta)
                return np.stack(self.resultants(phi, delta)) - np.stack(direct)

            some = adversarial_points(self, min(count, 4000), seed=None)
            routes.append(Route("direct quadrature", names, *some, off_quadrature, allowed))
        return judged(self.source, self.tolerance, routes, progress)


def full_contact(law: Law) -> float:
    """The height up to which contact is full under a law, as tables have it: twelve digits."""
    return float(f"{law.delta_max:.12g}")


def _truth(law: Law, phi: FloatArray, delta: FloatArray, tell: Tell | None = None) -> FloatArray:
    """The resultants by the law, (…, 3); ``phi`` (n, …), ``delta`` alike or of one φ."""
    parts = []
    for start in range(0, len(phi), _CHUNK):
        some = slice(start, start + _CHUNK)
        at = delta if delta.shape[:1] != phi.shape[:1] else delta[some]
        parts.append(np.stack(law.resultants(phi[some], at), axis=-1))
        if tell is not None:
            tell(len(parts[-1]))
    return np.concatenate(parts)


def _measured(table: ResultantTable, probes: int, tell: Tell | None) -> Accuracy:
    """The errors of a table against its law."""
    phi, delta = adversarial_points(table, probes, seed=2012)
    truth = _truth(table.law, phi, delta, tell).T
    errors = np.abs(np.stack(table.resultants(phi, delta)) - truth)
    coarse = None
    if table.axis.cells % 2 == 0 and table.axis.cells >= 8:
        half = replace(table, values=table.values[::2])
        coarse = np.abs(np.stack(half.resultants(phi, delta)) - truth)
    return Accuracy.of(errors, phi, delta, coarse)


def adversarial_points(
    table: ResultantTable, count: int, seed: int | None
) -> tuple[FloatArray, FloatArray]:
    """Points where a table is worst, and random ones.

    ``table``: whose cells are probed; ``count``: about how many; ``seed``: of the random generator;
    None: other points at every call.  Returns ``phi, delta``: arrays (n,), random; both sides of
    the singular lines and of 0 and π/2 at all distances; nodes and middles of cells.
    """
    rng = np.random.default_rng(seed)
    part = count // 6
    lines = np.array([0.0, 0.5 * np.pi, *{side.line for side in table.axis.sides}])
    near = rng.choice(lines, part)
    near += rng.choice([-1.0, 1.0], part) * 10.0 ** -np.where(
        rng.random(part) < 0.1, rng.uniform(16.0, 300.0, part), rng.uniform(0.3, 16.0, part)
    )
    nodes = table.axis.nodes()
    middles = 0.5 * (nodes[1:] + nodes[:-1])
    phi = np.concatenate([
        lines, near[(near >= 0.0) & (near <= 0.5 * np.pi)],
        rng.choice(nodes, min(nodes.size, part), replace=False),
        rng.choice(middles, min(middles.size, 2 * part), replace=False),
        rng.uniform(0.0, 0.5 * np.pi, 2 * part),
    ])  # fmt: skip
    special = np.array([0.0, 5e-324, 1e-8, 0.1, 0.5, 0.9, 1.0 - 2.0**-53, 1.0])
    share = np.where(
        rng.random(phi.size) < 0.3, rng.choice(special, phi.size), rng.random(phi.size)
    )
    return rng.choice([-1.0, 1.0], phi.size) * phi, table.delta_max * share
