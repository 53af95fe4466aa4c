"""Pressure laws by name: what a law tells the tables.

A law says how the five integrals follow from φ, and where on the radius it begins, ends or jumps:
at s = cot φ equal to such an edge the instantaneous centre of rotation crosses it, and the
resultants are singular there: like x² ln|x| where the pressure jumps, x ln|x| on the thin ring,
|x|^(3/2) under Galin's and |x|^(5/2) under Hertz's law, these two only for s > 1.

With ⟨x²⟩ = ∫ W ρ³ dρ in place of the 1/4 of uniform pressure the moment balance is that of a puck
of height δ/(4⟨x²⟩) under uniform pressure.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
from itertools import count
from pathlib import Path

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast, instance, real_array, shown
from puck_tables._core.own_folder import say
from puck_tables._core.quantities import PRESSURE, RADIUS
from puck_tables._core.read_columns import numbers_of
from puck_tables._core.safe_write import as_utf8
from puck_tables._core.units import unit_size
from puck_tables.contact import closed_form, one_sided, quadrature
from puck_tables.contact.closed_form import Resultants, checked_delta, moment_balance
from puck_tables.contact.integrals import PatchIntegrals, checked_phi, slip_direction
from puck_tables.contact.pressure import GALIN, HERTZ
from puck_tables.contact.superposition import (
    annulus_integrals,
    profile_integrals,
    ring_integrals,
    spread,
)
from puck_tables.errors import InputError

NAMES = "uniform, galin, hertz, ring, annulus:INNER (0 < INNER < 1), or a CSV file of rho, W"
_SLACK = 1e-9  # of δ/δ_max: names and files carry twelve digits
_LEAST_STEP = 1e-12  # between the radii of a profile
_LEAST_SPREAD = 2.5e-7  # root mean square, of the radius at which its load stands
_TIP = 1e-5  # the least radius that matters there
_MOST_KINKS, _STRAIGHT = 40, 1e-12  # the latter of the largest pressure
_SECANTS = 14  # steps; then it is halved, which always ends
_LARGEST = 1e-5  # a limit ratio above 1e5 is none: there the two rates agree to rounding
MAX_PROFILE_BYTES = 1 << 24  # bytes: more is no profile
_PROBES = np.linspace(0.0, 0.5 * np.pi, 33)  # rad, where two laws of one name are told apart
HOMOGENEOUS = 0.5**0.5  # radius of gyration over r of a homogeneous cylinder about its axis
THINNEST = 1.0 - 1e-6  # inner radius of the thinnest washer; beyond it take the ring


@dataclass(frozen=True, eq=False)
class Law:
    """An axisymmetric pressure law as the tables need it.

    Parameters
    ----------
    name : str
        As :func:`law_of` takes it.
    edges : tuple of float
        Radii at which the law begins, ends or jumps, ascending, the last 1.
    integrals : callable
        From slip angles to :class:`PatchIntegrals`.
    profile : pair of arrays (n,), optional
        Radii and pressures of a tabulated law, which its name does not say.
    rim : m, optional
        The radius of the rim that its file says.

    Examples
    --------
    >>> law_of("annulus:0.8").edges
    (0.8, 1.0)
    """

    name: str
    edges: tuple[float, ...]
    integrals: Callable[[npt.ArrayLike], PatchIntegrals]
    profile: tuple[FloatArray, FloatArray] | None = field(default=None, repr=False)
    rim: float | None = field(default=None, repr=False)

    def __eq__(self, other: object) -> bool:
        """Whether name and edges are the same, and the profile, or the integrals without one."""
        if not isinstance(other, Law):
            return NotImplemented
        if self.name != other.name or self.edges != other.edges:
            return False
        if self.profile is not None and other.profile is not None:
            return all(map(np.array_equal, self.profile, other.profile))
        if self.profile is not other.profile:
            return False
        return self.integrals is other.integrals or all(
            map(np.array_equal, self.integrals(_PROBES), other.integrals(_PROBES))
        )

    def __hash__(self) -> int:
        return hash((self.name, self.edges))

    @property
    def mean_square(self) -> float:
        """⟨x²⟩ = ∫ W ρ³ dρ, in r²: it is p_b at φ = 0."""
        return float(self.integrals(0.0).b)

    @property
    def delta_max(self) -> float:
        """The height up to which contact is full at every φ: 4⟨x²⟩."""
        return 4.0 * self.mean_square

    @property
    def can_lift(self) -> bool:
        """Whether partial contact is known: under uniform pressure."""
        return self.integrals is closed_form.integrals

    def resultants(self, phi: npt.ArrayLike, delta: npt.ArrayLike) -> Resultants:
        """Friction resultants of full contact under this law.

        Parameters
        ----------
        phi : array_like, radians, in [−π/2, π/2]
        delta : array_like
            Dimensionless height 2fh/r, at most ``delta_max``; broadcast against ``phi``.

        Raises
        ------
        InputError
            If an argument is not finite or outside its range.

        References
        ----------
        Salnikova, Treschev, Gallyamov 2012, sections 3, 5 and 6.

        Examples
        --------
        >>> float(law_of("ring").resultants(0.0, 1.0).perpendicular.round(12))
        0.25
        """
        angle, height = checked_phi(phi), checked_delta(delta)
        broadcast(phi=angle, delta=height)  # refuses shapes that do not fit
        scaled = height / self.delta_max
        if not np.all(scaled <= 1.0 + _SLACK):
            raise InputError(
                f"delta = {height[scaled > 1.0 + _SLACK].flat[0]:g} is outside full contact under "
                f"the pressure law {self.name}: 0 <= delta <= {self.delta_max:g}"
            )
        # not broadcast before: the integrals are the work, once for each angle
        return moment_balance(self.integrals(angle), slip_direction(angle), scaled)

    def friction(self, phi: npt.ArrayLike, delta: npt.ArrayLike) -> Resultants:
        """Friction resultants at every height for which they are known.

        Under uniform pressure that is also beyond full contact
        (:func:`puck_tables.contact.one_sided.resultants`).

        Parameters
        ----------
        phi : array_like, radians, in [−π/2, π/2]
        delta : array_like
            Dimensionless height 2fh/r: below 4 under uniform pressure, else at most ``delta_max``.

        Raises
        ------
        InputError, ContactError
            If an argument is not finite or outside its range, or the puck tips.

        Examples
        --------
        >>> float(law_of("uniform").friction(0.5, 2.0).spin.round(7))
        0.2196328
        """
        return (one_sided.resultants if self.can_lift else self.resultants)(phi, delta)


def law_of(text: str) -> Law:
    """The pressure law of a name, or of a CSV file with columns of the radius and the pressure.

    Radii are in units of r, or in the unit of length that their heading says; then the last is that
    of the rim.

    Parameters
    ----------
    text : str
        uniform, galin, hertz, ring, annulus:INNER, or the path of a CSV file.

    Raises
    ------
    InputError
        If the name is not known, the inner radius not between 0 and 1, or the file no profile.

    Examples
    --------
    >>> round(law_of("hertz").mean_square, 12)
    0.2
    """
    instance("the pressure law", text, str)
    kind, colon, rest = text.partition(":")
    if text in _NAMED:
        return Law(str(text), (1.0,), _NAMED[text])
    if kind == "annulus" and colon:
        try:
            inner = float(rest)
        except ValueError:
            inner = np.nan
        if not 0.0 < inner <= THINNEST:
            raise InputError(
                f"annulus:{rest}: the inner radius must be a number between 0 and 1 in units of "
                "the outer (0 is 'uniform', 1 is 'ring')"
            )
        return _washer(inner)
    if not text.lower().endswith(".csv"):
        raise InputError(f"no pressure law is called {shown(text)}: choose {NAMES}")
    radii, pressure, rim = _read(text)
    return replace(profile_law(radii, pressure, as_utf8(Path(text).name)), rim=rim)


@lru_cache(maxsize=64)
def _washer(inner: float) -> Law:
    """One law for one inner radius: what is kept by law is found again."""
    return Law(f"annulus:{inner}", (inner, 1.0), partial(annulus_integrals, inner=inner))


def profile_law(radii: npt.ArrayLike, pressure: npt.ArrayLike, name: str = "profile") -> Law:
    """A law from tabulated pressures, straight between the radii.

    Parameters
    ----------
    radii : array_like (n,), strictly ascending, from 0 or more to 1
        No pressure inside the first.
    pressure : array_like (n,), not negative, in any unit

    Raises
    ------
    InputError
        If they are not such a profile.

    Examples
    --------
    >>> law = profile_law([0.0, 1.0], [1.0, 0.0])  # a cone
    >>> round(law.mean_square, 12)
    0.15
    """
    rho, weight = real_array("radii", radii, "radii"), real_array("pressure", pressure, "any unit")
    if not (rho.ndim == 1 and rho.shape == weight.shape and rho.size >= 2):
        raise InputError(f"{name}: a profile needs two or more rows of rho, W")
    if not (rho[0] >= 0.0 and rho[-1] == 1.0 and np.all(np.diff(rho) > 0.0)):
        raise InputError(
            f"{name}: rho must ascend from 0 or more to 1, in units of the radius; of lengths in a "
            "file the heading must say the unit, as in r [mm]"
        )
    if not (np.all(weight >= 0.0) and np.all(np.isfinite(weight)) and weight.max() > 0.0):
        raise InputError(f"{name}: W must be finite, nowhere negative and not all zero")
    if np.diff(rho).min() < _LEAST_STEP:
        raise InputError(
            f"{name}: two radii are nearer than {_LEAST_STEP:g} to each other (units of the "
            "radius): a step of the pressure needs that much room"
        )
    shape = weight / weight.max()  # only the shape matters; the numbers may be of any size
    if spread(rho, shape) < _LEAST_SPREAD:
        raise InputError(
            f"{name}: the load lies on a ring or spot thinner than {1.0 - THINNEST:.0e} of the "
            "radius, and rounding would tell its friction: give a broader one, or take 'ring'"
        )
    integrals = partial(profile_integrals, radii=rho, pressure=shape)
    return Law(name, _edges(rho, shape), integrals, profile=(rho, shape))


def _edges(radii: FloatArray, pressure: FloatArray) -> tuple[float, ...]:
    """Where a profile begins, bends (the most, if it does so often) and ends.

    At a bend the resultants are like x³ ln|x|: splines across it lose their order.  At a tip in the
    middle, next to φ = π/2, the friction ratios are like x² ln|x|: radii that shrink towards it.
    """
    slope = np.concatenate([[0.0], np.diff(pressure) / np.diff(radii)])
    kink_size = np.abs(np.diff(slope))[1:] * np.minimum(np.diff(radii)[:-1], np.diff(radii)[1:])
    sharp = np.flatnonzero(kink_size > _STRAIGHT)
    sharp = sharp[np.argsort(-kink_size[sharp], kind="stable")[:_MOST_KINKS]]
    ends = np.append(radii[:1][radii[:1] > 0.0], 1.0)
    if radii[0] == 0.0 and abs(slope[1]) * radii[1] > _STRAIGHT:
        shrinking = radii[1] * 0.1 ** np.arange(1.0, 6.0)
        ends = np.append(ends, shrinking[shrinking > _TIP])
    return tuple(np.union1d(ends, radii[1:-1][sharp]).tolist())


def _read(path: str) -> tuple[FloatArray, FloatArray, float | None]:
    """Radii in units of the last, pressures, and the last radius in m, if its unit is said."""
    numbers = numbers_of(path, (RADIUS, PRESSURE), 2, MAX_PROFILE_BYTES)
    numbers.refuse_unless_ascending("the radii")
    radii, pressure = numbers.rows.T
    if (unit := numbers.units[0]) and unit_size(unit, "ratio") is None and radii[-1] > 0.0:
        say(f"{path}: its last radius, {radii[-1]:g} m, is taken as that of the rim")
        return radii / radii[-1], pressure, float(radii[-1])
    return radii, pressure, None


_NAMED: dict[str, Callable[[npt.ArrayLike], PatchIntegrals]] = {
    "uniform": closed_form.integrals,
    "galin": partial(quadrature.integrals, law=GALIN),
    "hertz": partial(quadrature.integrals, law=HERTZ),
    "ring": ring_integrals,
}


@lru_cache(maxsize=256)
def limit_ratio(law: Law, delta: float = 0.0, gyration: float = HOMOGENEOUS) -> float:
    """The ratio rω/v that every motion tends to.

    Parameters
    ----------
    law : Law
    delta : float
        Dimensionless height, in the range of :meth:`Law.friction`.
    gyration : float
        Radius of gyration k about the vertical axis in units of r; √½ for a homogeneous puck.

    Returns
    -------
    float
        tan φ₀ with ρ_∥ = (r²/2k²) ρ_ω, from r ω' = −(r²/2k²) J sin φ ρ_ω; inf where spin always
        outlasts the sliding (as under Hertz's law for k = √½, δ = 0), 0 where it never does.

    Raises
    ------
    InputError
        If the height or the radius of gyration is out of range.

    Examples
    --------
    >>> round(limit_ratio(law_of("uniform")), 9), round(limit_ratio(law_of("ring"), 0.0, 1.0), 9)
    (1.531389372, 1.0)
    """
    if not 0.0 < gyration < np.inf:
        raise InputError(f"the radius of gyration must be positive, in units of r, got {gyration}")
    low, high = _LARGEST, 0.5 * np.pi - _LARGEST
    above, below = (_sliding_decays_faster(law, phi, delta, gyration) for phi in (low, high))
    if not above > 0.0:
        return 0.0
    if below > 0.0:
        return np.inf
    side = 0
    for step in count():  # regula falsi (Illinois) as far as it goes, then halves
        middle = (above * high - below * low) / (above - below) if step < _SECANTS else low
        if not low < middle < high:
            middle = 0.5 * (low + high)
        if not low < middle < high:
            return float(np.tan(low))
        at_middle = _sliding_decays_faster(law, middle, delta, gyration)
        if at_middle > 0.0:
            low, above, below = middle, at_middle, 0.5 * below if side > 0 else below
            side = 1
        else:
            high, below, above = middle, at_middle, 0.5 * above if side < 0 else above
            side = -1
    raise AssertionError


def _sliding_decays_faster(law: Law, phi: float, delta: float, gyration: float) -> float:
    """By how much the share of itself that v loses is larger than that of rω."""
    rho = law.friction(phi, delta)
    return float(rho.parallel - rho.spin / (2.0 * gyration**2))
