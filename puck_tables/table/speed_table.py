"""A table of friction with a coefficient that depends on the slip speed: building and look-up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.contact.integrals import checked_phi, slip_direction
from puck_tables.contact.resultants import Resultants
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.contact.speed_quadrature import (
    SpeedFunction,
    checked_height_ratio,
    checked_speed,
    fastest,
    speed_resultants,
)
from puck_tables.errors import AccuracyError, InputError
from puck_tables.real import broadcast
from puck_tables.table.fit import half_clamped_coefficients, not_a_knot_coefficients
from puck_tables.table.grid import PhiAxis
from puck_tables.table.speed_grid import SpeedAxis

FloatArray = npt.NDArray[np.float64]
Law = SpeedLaw | SpeedFunction
Progress = Callable[[int, int], None]

DEFAULT_ACCURACY = 1e-6
FINEST_ACCURACY, COARSEST_ACCURACY = 1e-10, 0.01
_MAX_NODES = 4_000_000
_FIRST_CELLS = 16
_GROWTH = 1.5
_SAFETY = 1.2  # for points that were not measured


@dataclass(frozen=True)
class SpeedAccuracy:
    """Errors of a table against quadrature, measured, in units of the largest f of the law.

    One entry for each of F_∥/N, F_⊥/N and 2M/(N r): largest, root mean square and 99.9 % error
    over random and adversarial points, and where the largest stands (φ, and v + r|ω| in m/s);
    ``half_phi`` and ``half_speed`` are the largest errors with every other node left out of one
    axis.
    """

    largest: tuple[float, ...]
    rms: tuple[float, ...]
    p999: tuple[float, ...]
    at_phi: tuple[float, ...]
    at_speed: tuple[float, ...]
    half_phi: float
    half_speed: float
    points: int

    @property
    def worst(self) -> float:
        """The largest of the three largest errors."""
        return max(self.largest)


@dataclass(frozen=True)
class SpeedTable:
    """Friction at slip angles φ and fastest slips U = v + r|ω|, for one law f(|u|) and one 2h/r.

    Parameters
    ----------
    phi_axis : PhiAxis
    speed_axis : SpeedAxis
    height_ratio : float
        2h/r.
    values : array (n_phi, n_speed, 3)
        F_∥/(N cos φ), F_⊥/(N sin φ cos φ), 2M/(N r sin φ) at the nodes.
    largest_f : float
        Largest f at the speeds of the axis, the unit of the errors.
    law : SpeedLaw, optional
        The friction law; none if it was given as a function.
    tolerance, accuracy, passport, source
        As in :class:`puck_tables.table.table.Table`; errors in units of ``largest_f``.
    """

    phi_axis: PhiAxis
    speed_axis: SpeedAxis
    height_ratio: float
    values: FloatArray = field(repr=False)
    largest_f: float
    law: SpeedLaw | None = None
    tolerance: float = 0.0
    accuracy: SpeedAccuracy | None = None
    passport: dict[str, Any] = field(default_factory=dict, repr=False)
    source: str = "memory"

    @cached_property
    def coefficients(self) -> FloatArray:
        """As :mod:`puck_tables.kernels.speed_spline` reads them."""
        middle = self.phi_axis.cells_per_side
        sides = np.stack([self.values[middle::-1], self.values[middle:]], axis=1)
        # flat at π/4, where dφ/dη = 0; at 0 and π/2 not even in φ, as U is not
        along_eta = half_clamped_coefficients(sides)
        along_speed = not_a_knot_coefficients(np.moveaxis(along_eta, 2, 0))
        return np.ascontiguousarray(along_speed.transpose(2, 0, 1, 3)) / 36.0

    def resultants(self, phi: npt.ArrayLike, speed: npt.ArrayLike) -> Resultants:
        """Interpolated friction.

        Parameters
        ----------
        phi : array_like, radians, in [−π/2, π/2]
        speed : array_like, m/s
            Q = hypot(v, rω), broadcast against ``phi``; v + r|ω| within the table.

        Returns
        -------
        Resultants
            F_∥/(N cos φ), F_⊥/(N sin φ cos φ) and 2M/(N r sin φ), f included.

        Raises
        ------
        InputError
            If an argument is out of range; nothing is extrapolated.

        Examples
        --------
        >>> table = build_speed_table(lambda u: 0.2 + 0.1 * u, top_speed=2.0, accuracy=1e-4)
        >>> float(table.resultants(0.0, 1.0).parallel.round(4))  # a puck that only slides: f(v)
        0.3
        """
        from puck_tables.kernels.speed_spline import DONE, fill_speed

        angle, Q = broadcast(phi=checked_phi(phi), speed=checked_speed(speed))
        direction = slip_direction(angle)
        out = np.empty((3, angle.size))
        status = fill_speed(
            self.coefficients, self.speed_axis.scale, self.speed_axis.reach,
            np.ravel(direction.ratio), np.ravel(direction.fast_spin), np.ravel(Q).copy(), out,
        )  # fmt: skip
        if status != DONE:
            raise InputError(
                f"the fastest slip v + r|omega| = {float(fastest(direction, Q).max()):g} m/s is "
                f"outside this table (0 to {self.speed_axis.top:g} m/s)"
            )
        return Resultants(*(row.reshape(angle.shape) for row in out))


def build_speed_table(
    law: Law,
    height_ratio: float = 0.0,
    *,
    top_speed: float | None = None,
    scale: float | None = None,
    accuracy: float = DEFAULT_ACCURACY,
    most_nodes: int | None = None,
    progress: Progress | None = None,
) -> SpeedTable:
    """Tabulate friction with a coefficient that depends on the slip speed, in full contact.

    Parameters
    ----------
    law : SpeedLaw, or callable from speeds in m/s to f
    height_ratio : float
        2h/r ≥ 0, such that the whole base stays loaded.
    top_speed : float, optional
        The fastest slip v + r|ω| of the table, m/s; needed for a callable, otherwise that of the
        law.
    scale : float, optional
        The speed below which f is nearly linear, m/s: nodes are spaced evenly below and
        logarithmically above.  Default: the first speed of a ``SpeedLaw``, or ``top_speed``.
    accuracy : float
        Largest error wanted of F/N and 2M/(N r), in units of the largest f; 1e-10 to 0.01.
    most_nodes : int, optional
        Stop there with the accuracy that is reached, ``accuracy.worst`` of the result, where a law
        with jumps would take ever more.
    progress : callable (done, total), optional
        Called with rows of slip angles of the grid that is being filled.

    Returns
    -------
    SpeedTable
        With the errors that were measured.

    Raises
    ------
    InputError
        If a number is out of range or the law gives no f.
    ContactError
        If part of the base would lift at one of the nodes.
    AccuracyError
        If the accuracy is out of range or would take more than 4 million nodes.

    Notes
    -----
    For a smooth f the error falls with order 4 in both axes.  A cubic ``SpeedLaw`` has kinks of f′
    at its points, a linear one jumps: next to φ = 0, where the whole base slips at one speed, the
    torque over sin φ has them too, and the order is about 2 and 1.

    Examples
    --------
    >>> law = SpeedLaw([0.0, 0.5, 1.0, 3.0], [0.3, 0.22, 0.2, 0.25])
    >>> table = build_speed_table(law, 1.0, accuracy=1e-4)
    >>> table.accuracy.worst < 1e-4, table.speed_axis.top
    (True, 3.0)
    """
    g = checked_height_ratio(height_ratio)
    if not FINEST_ACCURACY <= accuracy <= COARSEST_ACCURACY:
        raise AccuracyError(
            f"the accuracy of a table of speeds must be from {FINEST_ACCURACY:g} to "
            f"{COARSEST_ACCURACY:g} (of the largest f), got {accuracy:g}"
        )
    top, least = _range(law, top_speed, scale)
    cells = [_FIRST_CELLS, _FIRST_CELLS]
    while True:
        size = (2 * cells[0] + 1) * (cells[1] + 1)
        if size > _MAX_NODES:
            raise AccuracyError(
                f"an accuracy of {accuracy:g} would take more than {_MAX_NODES} nodes; ask for "
                "less, or give the friction law with fewer kinks"
            )
        axes = PhiAxis(2 * cells[0] + 1), SpeedAxis(cells[1], top, least)
        table = tabulate(law, *axes, g, progress)
        measured = measure(table, law)
        if _SAFETY * measured.worst <= accuracy:
            return replace(table, tolerance=accuracy, accuracy=measured)
        if most_nodes is not None and 2 * size > most_nodes:
            return replace(table, tolerance=_SAFETY * measured.worst, accuracy=measured)
        larger = 0 if measured.half_phi > measured.half_speed else 1
        for axis, half in enumerate((measured.half_phi, measured.half_speed)):
            if axis == larger or half > 0.3 * max(measured.half_phi, measured.half_speed):
                cells[axis] = 2 * round(0.5 * _GROWTH * cells[axis])


def _range(law: Law, top_speed: float | None, scale: float | None) -> tuple[float, float]:
    if isinstance(law, SpeedLaw):
        top = law.top_speed if top_speed is None else float(top_speed)
        if top > law.top_speed:
            raise InputError(
                f"top_speed = {top:g} m/s is outside this friction law (0 to {law.top_speed:g} m/s)"
            )
        least = float(np.asarray(law.speeds)[1])
    else:
        if top_speed is None:
            raise InputError("a friction law given as a function needs top_speed= in m/s")
        top = least = float(top_speed)
    return top, min(least if scale is None else float(scale), top)


def tabulate(
    law: Law,
    phi_axis: PhiAxis,
    speed_axis: SpeedAxis,
    height_ratio: float,
    progress: Progress | None = None,
) -> SpeedTable:
    """The node values of a table, without a measured accuracy.

    Examples
    --------
    >>> axes = PhiAxis(9), SpeedAxis(4, 1.0, 1.0)
    >>> tabulate(lambda u: 0.1 + 0.0 * u, *axes, 0.0).values.shape
    (9, 5, 3)
    """
    direction = phi_axis.slip_direction()
    speeds = speed_axis.nodes()
    phi = phi_axis.nodes()
    values = np.empty((phi.size, speeds.size, 3))
    for row, angle in enumerate(phi):
        Q = speeds * np.sqrt(1.0 + direction.ratio[row] ** 2) / (1.0 + direction.ratio[row])
        values[row] = np.stack(speed_resultants(angle, Q, law, height_ratio), axis=-1)
        if progress is not None:
            progress(row + 1, phi.size)
    f = speed_resultants(0.0, speeds, law).parallel
    points = law if isinstance(law, SpeedLaw) else None
    return SpeedTable(phi_axis, speed_axis, height_ratio, values, float(np.abs(f).max()), points)


def measure(table: SpeedTable, law: Law, seed: int = 1960) -> SpeedAccuracy:
    """The errors of a table against quadrature, at random and adversarial points.

    Adversarial: both sides of φ = π/4 and next to 0 and π/2 at all distances, speeds near 0, slips
    that straddle a knot of the law, and the middles of cells, those next to the ends of the axes
    above all.

    Examples
    --------
    >>> def constant(u):
    ...     return 0.1 + 0.0 * u
    >>> rough = tabulate(constant, PhiAxis(17), SpeedAxis(4, 1.0, 1.0), 0.0)
    >>> 1e-5 < measure(rough, constant).worst < 1e-2
    True
    """
    rng = np.random.default_rng(seed)
    distance = 10.0 ** -rng.uniform(0.3, 15.0, 300) * rng.choice([-1, 1], 300)
    near = rng.choice([0.0, 0.25 * np.pi, 0.5 * np.pi], 300) + distance
    nodes, speeds = table.phi_axis.nodes(), table.speed_axis.nodes()
    middles = 0.5 * (nodes[1:] + nodes[:-1])
    phi = np.abs(np.concatenate([
        rng.uniform(0.0, 0.5 * np.pi, 900), near, rng.choice(middles, 600),
        rng.choice(middles[[0, 1, 2, -3, -2, -1]], 600),
    ]))  # fmt: skip
    phi = np.where(phi > 0.5 * np.pi, np.pi - phi, phi)
    share = rng.random(phi.size)
    centres = 0.5 * (speeds[1:] + speeds[:-1])
    marks = np.concatenate([
        centres, np.tile(centres[[0, 1, -2, -1]], 10),
        10.0 ** -rng.uniform(0.0, 9.0, 50) * speeds[-1],
        np.asarray(law.speeds) if isinstance(law, SpeedLaw) else speeds[:1],
    ])  # fmt: skip
    marks = marks[marks <= speeds[-1]]
    U = np.where(share < 0.5, speeds[-1] * 2.0 * share, rng.choice(marks, phi.size))
    ratio = slip_direction(phi).ratio
    Q = U * np.sqrt(1.0 + ratio**2) / (1.0 + ratio)
    if isinstance(law, SpeedLaw):
        about = _about_knots(law, speeds[-1], rng)
        phi, Q, U = (np.concatenate(pair) for pair in zip((phi, Q, U), about, strict=True))
    truth = np.stack(speed_resultants(phi, Q, law, table.height_ratio))
    weight = np.stack([np.cos(phi), np.sin(phi) * np.cos(phi), np.sin(phi)]) / (
        table.largest_f or 1.0
    )

    def error(one: SpeedTable) -> FloatArray:
        found = np.stack(one.resultants(phi, Q))
        return np.asarray(weight * np.abs(found - truth))

    errors = error(table)
    where = errors.argmax(axis=1)
    n_phi, n_speed = table.phi_axis.size, table.speed_axis.cells
    half_phi = half_speed = np.inf
    if table.phi_axis.cells_per_side % 2 == 0 and n_phi >= 17:
        axis = PhiAxis(n_phi // 2 + 1)
        half_phi = float(error(replace(table, phi_axis=axis, values=table.values[::2])).max())
    if n_speed % 2 == 0 and n_speed >= 8:
        shorter = replace(table.speed_axis, cells=n_speed // 2)
        halved = replace(table, speed_axis=shorter, values=table.values[:, ::2])
        half_speed = float(error(halved).max())
    return SpeedAccuracy(
        tuple(errors.max(axis=1).tolist()), tuple(np.sqrt((errors**2).mean(axis=1)).tolist()),
        tuple(np.quantile(errors, 0.999, axis=1).tolist()), tuple(phi[where].tolist()),
        tuple(U[where].tolist()), half_phi, half_speed, int(errors.size),
    )  # fmt: skip


def _about_knots(
    law: SpeedLaw, top: float, rng: np.random.Generator
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """φ, Q and U where part of the base slips slower and part faster than a knot of the law."""
    knots = np.asarray(law.speeds)[1:]
    phi = 0.5 * np.pi * 10.0 ** -rng.uniform(0.0, 4.0, 1500)
    alpha, beta = np.cos(phi), np.sin(phi)
    Q = rng.choice(knots, phi.size) / (alpha - beta * rng.uniform(-1.0, 1.0, phi.size))
    U = Q * (alpha + beta)
    kept = (Q > 0.0) & (top >= U)
    return phi[kept], Q[kept], U[kept]
