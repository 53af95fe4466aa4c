"""The table of friction by slip speed: its look-up, built from its friction law, judged by it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast
from puck_tables._core.waiting import Progress
from puck_tables.contact.closed_form import Resultants, moment_balance, pressure_tilt
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.integrals import PatchIntegrals, checked_phi, slip_direction
from puck_tables.contact.laws import Law, law_of
from puck_tables.contact.round_load import RoundLoad
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.contact.speed_quadrature import (
    checked_height_ratio,
    checked_speed,
    fastest,
    refuse_lifting,
)
from puck_tables.errors import InputError
from puck_tables.io.columns import Variable
from puck_tables.kernels.speed_spline import DONE, fill_speed, packed
from puck_tables.table.build import COARSEST
from puck_tables.table.check import CheckReport, Route, judged
from puck_tables.table.speed_build import largest_f, tabulated
from puck_tables.table.speed_grid import RayPatch, SlipPatch, is_pile, patches_of, rays_under
from puck_tables.table.speed_patch import quintic_coefficients, truth_at
from puck_tables.table.table import Table

IntArray = npt.NDArray[np.int64]

_ROUNDED = 1e-14  # of a slip
_INTERPRETATION = (
    "Friction on a puck of radius r, height h, mass m sliding with speed v and spin omega on a "
    "rough plane whose coefficient f depends on the local slip speed u by the law in made_of; "
    "weight N = m g, the pressure in made_of over its reach of r, tilted linearly by the moment "
    "balance. phi = atan2(r omega, v), Q = hypot(v, r omega), slip directions (e_x, e_y) in units "
    "of r, means over the pressure: cos(phi) p_a = mean of f e_x, sin(phi) p_b = mean of f e_y x, "
    "sin(phi) p_d = mean of f (x e_y - y e_x), cos(phi) p_e = mean of f (x e_y - y e_x) y, p_c = "
    "p_b - p_d. With g = h/(2 r <x^2>), 2h/r under uniform pressure, D = 1 - g^2 sin^2(phi) p_b "
    "p_c: force -N cos(phi) p_a/D along the velocity, -N sin(phi) cos(phi) g p_a p_b/D across it "
    "(to the left), torque -N r sin(phi) (p_d + g^2 cos^2(phi) p_a p_b p_e/D). Even in phi. "
    "Salnikova, Treschev, Gallyamov 2012, section 5, with f inside the integrals."
)
_MAP = (
    "U = v + r|omega|, W = |v - r|omega||; patches between the breaks b_k of U and W, for r|omega| "
    "< v and then for >, slab of U after slab. U <= b_1: U = b_1 xi^g, W = U zeta^4, g = 6/"
    "exponent rounded up for a Stribeck exponent that is no whole number, else 1. b_k <= U <= "
    "b_k+1: U = b_k + (b_k+1 - b_k) xi^p; W = b_1/2 zeta^4, then W = b_l - (b_l - left end)(1 - "
    "zeta)^p up to b_k, p = 2 (3 where r|omega| < v and l = k); last U, W = b_k + (b_k+1 - b_k)(xi,"
    " zeta). Nodes uniform in xi and zeta, zeta fastest; quintic not-a-knot splines in both. "
    "breaks, and cells of every patch along xi and zeta, stand in made_of. Under a pressure that "
    "begins, ends or bends at other radii a r than r: slabs U = b_k + (b_k+1 - b_k) xi (first xi^g)"
    " between rays (v - r|omega|)/U = -1, the (a - 1)/(a + 1) ascending, 1, with shares zeta^4 : "
    "(1 - zeta)^4 of the way from one to the next; but where the law is one of points and the "
    "pressure uniform or an annulus, the nodes are those of a disc of radius r, and with the share "
    "s of each disc a r in the load and n = hypot(cos(phi), a sin(phi)), p_a is the sum of s p_a/n "
    "and the others of s a^2 p/n at v, a omega"
)


@dataclass(frozen=True, eq=False, repr=False)
class SpeedTable(Table):
    """The friction integrals at all slips of one law f(|u|), for pucks of every height.

    ``values`` (nodes, 4): p_a, p_b, p_d, p_e at the nodes of all patches, one after the other, ζ
    running fastest; ``breaks`` (k + 1,): speeds from 0 to the top between which the patches lie,
    m/s; ``cells`` (patches, 2): along ξ and ζ of every patch, see
    :mod:`puck_tables.kernels.speed_spline`; ``law``: none if it was given as a function; ``reach``:
    the part of the radius on which the load stands.

    Errors are those of cos φ p_a, sin φ p_b, sin φ p_d and cos φ p_e in units of the
    largest f of the law up to the top.
    """

    _: KW_ONLY
    breaks: FloatArray
    cells: IntArray
    law: SpeedLaw | FrictionLaw | None = None
    pressure: Law = field(default_factory=lambda: law_of("uniform"))
    reach: float = 1.0

    kind = "speed"
    algorithm = (
        "one integral over circles about the centre of rotation; quintic splines in patches; 3"
    )
    functions: ClassVar[Mapping[str, str]] = {
        "p_a": "mean of f e_x, over cos(phi)",
        "p_b": "mean of f e_y x, over sin(phi)",
        "p_d": "mean of f (x e_y - y e_x), over sin(phi)",
        "p_e": "mean of f (x e_y - y e_x) y, over cos(phi)",
    }
    second = "v + r|omega|"
    errors = "errors over the largest f"
    quantities = ("cos p_a", "sin p_b", "sin p_d", "cos p_e")
    words: ClassVar[Mapping[str, str]] = {
        "title": "Friction of a sliding, spinning puck whose coefficient depends on the slip speed",
        "interpretation": _INTERPRETATION,
        "method": "quadrature over circles about the centre of rotation, 1e-14",
        "map": _MAP,
    }

    @property
    def top(self) -> float:
        """The fastest slip v + r|ω| of the table, m/s."""
        return float(self.breaks[-1])

    @property
    def pressure_law(self) -> str:
        """The name of the pressure law, and where it ends within the radius."""
        where = "" if self.reach == 1.0 else f" on {self.reach:.6g} of the radius"
        return self.pressure.name + where

    @cached_property
    def round_load(self) -> RoundLoad:
        """Its pressure."""
        return RoundLoad(self.pressure, self.reach)

    @cached_property
    def patches(self) -> tuple[SlipPatch | RayPatch, ...]:
        """Its patches, in the order of ``cells``."""
        return patches_of(self.breaks, self._grade, rays_under(self.law, self.round_load))

    @property
    def _grade(self) -> int:
        """See :class:`puck_tables.table.speed_grid.SlipPatch`."""
        return 1 if self.law is None else self.law.grade

    @cached_property
    def compiled(self) -> FloatArray:
        """All in one array, as :func:`puck_tables.kernels.speed_spline.packed` lays it out."""
        splines = [quintic_coefficients(values) for values in self.by_patch()]
        rays, discs = rays_under(self.law, self.round_load), np.empty((0, 2))
        if is_pile(self.law, self.round_load):
            discs = self.round_load.discs
        return packed(self.breaks, rays, discs, self.cells, splines, self._grade)

    def by_patch(self) -> list[FloatArray]:
        """Node values of every patch, (ξ nodes, ζ nodes, 4)."""
        sizes = (self.cells + 1).prod(axis=1)
        parts = np.split(self.values, np.cumsum(sizes)[:-1])
        shapes = (self.cells + 1).tolist()
        return [part.reshape(u, w, 4) for part, (u, w) in zip(parts, shapes, strict=True)]

    def integrals(self, phi: npt.ArrayLike, speed: npt.ArrayLike) -> PatchIntegrals:
        """The interpolated integrals, see :func:`puck_tables.contact.speed_quadrature`.

        At slip angles in [−π/2, π/2] and speeds Q = hypot(v, rω), m/s, with v + r|ω| within the
        table; InputError else, nothing is extrapolated.
        """
        angle, Q = broadcast(phi=checked_phi(phi), speed=checked_speed(speed))
        direction = slip_direction(angle)
        out = np.empty((4, angle.size))
        status = fill_speed(
            self.compiled, np.ravel(direction.ratio), np.ravel(direction.fast_spin),
            np.ravel(Q).copy(), out,
        )  # fmt: skip
        if status != DONE:
            raise InputError(
                f"the fastest slip v + r|omega| = {float(fastest(direction, Q).max()):g} m/s is "
                f"outside this table (0 to {self.top:g} m/s)"
            )
        a, b, d, e = (row.reshape(angle.shape) for row in out)
        return PatchIntegrals(a, b, b - d, d, e)

    def resultants(
        self, phi: npt.ArrayLike, speed: npt.ArrayLike, height_ratio: float = 0.0
    ) -> Resultants:
        """Interpolated friction.

        Parameters
        ----------
        phi : array_like, radians, in [−π/2, π/2]
        speed : array_like, m/s
            Q = hypot(v, rω), broadcast against ``phi``; v + r|ω| within the table.
        height_ratio : float
            2h/r ≥ 0; times a constant f it is δ.

        Returns
        -------
        Resultants
            F_∥/(N cos φ), F_⊥/(N sin φ cos φ) and 2M/(N r sin φ), f included.

        Raises
        ------
        InputError
            If an argument is out of range; nothing is extrapolated.
        ContactError
            If part of the base would have to be pulled down.

        Examples
        --------
        >>> from puck_tables import Table
        >>> table = Table.build(lambda u: 0.2 + 0.1 * u, accuracy=1e-4, top_speed=2.0)
        >>> float(table.resultants(0.0, 1.0).parallel.round(4))  # a puck that only slides: f(v)
        0.3
        """
        g = checked_height_ratio(height_ratio)
        p = self.integrals(phi, speed)
        direction = slip_direction(np.broadcast_to(checked_phi(phi), p.a.shape))
        rho = moment_balance(p, direction, self.lever(g))
        refuse_lifting(self.reach * pressure_tilt(rho, direction, self.lever(g)), g)
        return rho

    def lever(self, height_ratio: float) -> float:
        """What 2h/r is in the moment balance: times 1/(4⟨x²⟩), as under uniform pressure.

        >>> from puck_tables import SpeedLaw, Table
        >>> law = SpeedLaw([0.0, 1.0], [0.2, 0.3])
        >>> round(Table.build(law, 1e-3, pressure="ring").lever(1.0), 12)  # ⟨x²⟩ = 1/2
        0.5
        """
        return height_ratio / (4.0 * self.round_load.mean_square)

    def refuse_height(self, height_ratio: float) -> None:
        """Raise ContactError for a puck part of whose base would lift anywhere in the table."""
        if height_ratio == 0.0:
            return
        cells, lever = self.cells.tolist(), self.lever(height_ratio)
        tilts = []
        for patch, values, (u, w) in zip(self.patches, self.by_patch(), cells, strict=True):
            xi, zeta = np.arange(u + 1)[:, None] / u, np.arange(w + 1) / w
            direction, Q = patch.place(xi, zeta)
            a, b, d, e = np.moveaxis(values, -1, 0)
            p = PatchIntegrals(a, b, b - d, d, e)
            if is_pile(self.law, self.round_load):
                phi = np.arctan2(np.sqrt(direction.sin_squared), np.sqrt(direction.cos_squared))
                p = self.integrals(phi, Q * (1.0 - _ROUNDED))
            rho = moment_balance(p, direction, lever)
            tilts.append(self.reach * pressure_tilt(rho, direction, lever).max())
        refuse_lifting(np.array(tilts), height_ratio)

    def validate(
        self, progress: Progress | None = None, points: int = 2000, law: Any = None
    ) -> CheckReport:
        """Judge the table by quadrature.

        So many ``points`` are compared at random, as many next to φ = 0, π/4, π/2, as many where a
        rim slips at one of the breaks, and as many or more in all patches alike.  ``law``: where
        the table was made of a function and does not hold it; InputError if it is not given then.

        >>> def f(u):
        ...     return 0.2 + 0.1 * u
        >>> table = SpeedTable.build(f, top_speed=1.0, accuracy=1e-4)
        >>> table.validate(points=300, law=f).passed
        True
        """
        law = self.law if law is None else law
        if law is None:
            raise InputError("the friction law of this table is a function: give it as law=")
        rng = np.random.default_rng()

        def scattered(smallest: float) -> FloatArray:
            """Either side of 0, at all distances."""
            sizes = 10.0 ** -rng.uniform(smallest, 15.0, points)
            return np.asarray(rng.choice([-1.0, 1.0], points) * sizes)

        near = rng.choice([0.0, 0.25 * np.pi, 0.5 * np.pi], points) + scattered(0.5)
        U = self.top * rng.random((2, points)) ** rng.choice([1.0, 4.0], points)
        at_break = self.breaks[rng.integers(0, len(self.breaks), points)] * (1.0 + scattered(1.0))
        other = self.top * rng.random(points)
        fastest, slowest = np.maximum(at_break, other), np.minimum(at_break, other)
        side = rng.choice([-1.0, 1.0], points)
        equal = 0.25 * np.pi + side * np.arctan(slowest / fastest)
        unit = largest_f(law, self.top) or 1.0  # what the table says of it is not asked

        def off(phi: FloatArray, speeds: FloatArray) -> FloatArray:
            cosine, sine = np.cos(phi), np.sin(phi)
            Q = speeds / (cosine + sine) * (1.0 - 1e-15)
            got = self.integrals(phi, Q)
            truth = truth_at(law, self.round_load, self.top, slip_direction(phi), Q, plain=True)
            missed = np.stack([got.a, got.b, got.d, got.e]) - np.moveaxis(truth, -1, 0)
            return np.stack([cosine, sine, sine, cosine]) / unit * missed

        allowed = min(self.tolerance, COARSEST)
        return judged(self.source, self.tolerance, [
            Route(f"quadrature, {where}", self.quantities, phi, speeds, off, allowed)
            for where, phi, speeds in (
                ("random points", rng.uniform(0.0, 0.5 * np.pi, points), U[0]),
                ("next to 0, pi/4, pi/2", np.clip(near, 0.0, 0.5 * np.pi), U[1]),
                ("a rim at a break", np.clip(equal, 0.0, 0.5 * np.pi),
                 np.minimum(fastest, self.top)),
                ("in every patch", *self._in_every_patch(-(-points // len(self.patches)), rng)),
            )
        ], progress, self.second)  # fmt: skip

    def _in_every_patch(
        self, count: int, rng: np.random.Generator
    ) -> tuple[FloatArray, FloatArray]:
        """φ and v + r|ω| at so many random places of each patch."""
        values = []
        for patch in self.patches:
            direction, Q = patch.place(*rng.random((2, count)))
            cosine, sine = np.sqrt(direction.cos_squared), np.sqrt(direction.sin_squared)
            values.append((np.arctan2(sine, cosine), Q * (cosine + sine)))
        phi, fastest = np.concatenate(values, axis=1)
        return phi, fastest

    # the record of the kind

    @property
    def grid(self) -> str:
        """How many nodes it has, in words."""
        return f"{len(self.values)} nodes in {len(self.cells)} patches"

    @property
    def valid_range(self) -> str:
        """Where it holds, in words."""
        return f"|phi| <= pi/2, 0 <= v + r|omega| <= {self.top:g} m/s; refused outside"

    @property
    def axes(self) -> dict[str, Variable]:
        """The numbers of the nodes."""
        return {
            "node": Variable(np.arange(float(len(self.values))), ("node",), "1", "node of a patch")
        }

    @classmethod
    def is_of(cls, of: object) -> bool:
        """Friction laws over the slip speed: points or functions."""
        return isinstance(of, SpeedLaw) or callable(of)

    @classmethod
    def built(cls, of: Any, accuracy: float | None = None, **how: Any) -> Self:
        """A table of a friction law, see :meth:`puck_tables.Table.build`."""
        return cls(**tabulated(of, accuracy, **how))
