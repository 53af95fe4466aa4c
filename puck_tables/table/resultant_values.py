"""The table of friction resultants in full contact, under any pressure law.

Held are ρ_∥, ρ_⊥, ρ_ω at the nodes of φ and at four heights; splined are the friction ratios 1/ρ_∥,
ρ_⊥/ρ_∥, ρ_ω/ρ_∥, because in full contact they are polynomials of degree 2 in δ under every law:
five columns over φ are the whole table (:mod:`puck_tables.kernels.quadratic`), and its section at
one height is three.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.real import broadcast
from puck_tables.contact.integrals import checked_phi
from puck_tables.contact.laws import Law, law_of
from puck_tables.contact.resultants import Resultants, checked_delta
from puck_tables.errors import InputError
from puck_tables.io.dataset import Variable
from puck_tables.table.section_table import LawTable
from puck_tables.table.slip_axis import GRADING_POWER
from puck_tables.table.spline_fit import height_terms, sided_coefficients

HEIGHTS = 4  # nodes of δ in a file
_UNIFORM = "uniform"
_INTERPRETATION = (
    "Friction on a puck of radius r, height h, mass m sliding with speed v and spin omega "
    "on a rough plane, Coulomb coefficient f, weight N = m g, whole base loaded by the "
    "named pressure law, tilted linearly by the moment balance. "
    "phi = atan2(r omega, v), delta = 2 f h / r. "
    "Force on the puck: -f N cos(phi) parallel along its velocity, -f N sin(phi) cos(phi) "
    "perpendicular across it (to the left), torque -(f N r / 2) sin(phi) spin about the "
    "vertical. Even in phi. Salnikova, Treschev, Gallyamov 2012, sections 3 and 6."
)


@dataclass(frozen=True, eq=False, repr=False)
class ResultantValues(LawTable):
    """Friction resultants under a pressure law with the spline through them.

    :class:`puck_tables.table.resultant_table.ResultantTable` adds how it is built and judged.
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
        fitted = np.ascontiguousarray(sided_coefficients(self.axis.by_side(terms), True) / 6.0)
        fitted.flags.writeable = False
        return fitted

    def section(self, delta: float) -> FloatArray:
        """The friction ratios at one height, as :mod:`puck_tables.kernels.section_spline` reads.

        Raises
        ------
        InputError
            If δ is outside the range of the table, or it is not of uniform pressure.
        """
        from puck_tables.kernels.quadratic import room_for_section, section_at

        height = float(self.checked_range(delta))
        out = room_for_section(self.columns)
        section_at(self.columns, height, out)
        return out

    def checked_range(self, delta: npt.ArrayLike, law: str = _UNIFORM) -> FloatArray:
        """``delta`` as an array, refused outside the range of the table.

        Parameters
        ----------
        delta : dimensionless heights
        law : the pressure law that friction is wanted under

        Raises
        ------
        InputError
            If a height is not finite, negative or above the largest of the table, or the table is
            of another law.
        """
        if self.law.name != law:
            self.refuse_other(law_of(law))
        height = checked_delta(delta)
        if not np.all(height <= self.delta_max):
            raise InputError(
                f"delta = {height[height > self.delta_max].flat[0]!s} is outside this table "
                f"(pressure law {law}: 0 <= delta <= {self.delta_max:g}): beyond, the whole base "
                "does not stay loaded at every phi; where it does, use the closed forms (--exact)"
            )
        return height

    def refuse_other(self, law: Law) -> None:
        """Refuse to be the table of another pressure law.

        Raises
        ------
        InputError
        """
        if self.law != law:
            raise InputError(
                f"{self.source} is a table under the pressure law {self.law.name}, not "
                f"{law.name}{'' if self.law.name != law.name else ' as it is now'}: give a table "
                "of that law"
            )

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

        height = self.checked_range(delta, self.law.name)
        angle, height = broadcast(phi=checked_phi(phi), delta=height)
        out = np.empty((3, angle.size))
        phi_, delta_ = (np.ascontiguousarray(axis).reshape(-1) for axis in (angle, height))
        fill_resultants(self.columns, np.array(self.axis.sides), phi_, delta_, out)
        return Resultants(*(row.reshape(angle.shape) for row in out))

    # the record of the kind

    @property
    def grid(self) -> str:
        """How many nodes it has, in words."""
        return f"{len(self.values)} phi x {HEIGHTS} delta nodes"

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


def full_contact(law: Law) -> float:
    """The height up to which contact is full under a law, as tables have it: twelve digits."""
    return float(f"{law.delta_max:.12g}")
