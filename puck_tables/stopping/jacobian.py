"""Results that carry derivatives, and what computes them: plain pucks by the stop table.

Of pucks by friction and height, from which δ = 2fh/r and J = fg follow, by the chain rule.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast, finite_array, positive, shown
from puck_tables._core.fields import Unsaid
from puck_tables.errors import InputError
from puck_tables.motion.body import STANDARD_GRAVITY, UnitPuck
from puck_tables.motion.unit_motion import frame_of
from puck_tables.stopping.launch_arrays import (
    DECEL,
    DELTA,
    RADIUS,
    Launches,
    in_chunks,
    launches_in,
    positive_array,
)
from puck_tables.stopping.spread import ResultSpread, spread_of
from puck_tables.stopping.state_values import for_each
from puck_tables.stopping.stop_table import StopTable

# what is left out, and is refused where it is given beside its counterpart
DEFAULT_DELTA, DEFAULT_DECEL = Unsaid(0.5), Unsaid(1.0)
DEFAULT_HEIGHT, DEFAULT_GRAVITY = Unsaid(0.0), Unsaid(STANDARD_GRAVITY)


class ByFriction(NamedTuple):
    """Friction and height of pucks, arrays that broadcast, and the gravity, m/s²."""

    friction: FloatArray
    height: FloatArray
    gravity: float

    def chained(self, launches: Launches, jacobian: FloatArray, each: Any = slice(None)) -> Any:
        """Rows of launches (6, n) with f and h in place of δ and J; the Jacobian's columns, too.

        ``jacobian`` (m, …, 6 or more) is changed where it is; ``each``: of which launch it is.

        ∂/∂f = (2h/r) ∂/∂δ + g ∂/∂J,  ∂/∂h = (2f/r) ∂/∂δ,  and of r, f and h held, −(δ/r) ∂/∂δ more.
        """
        rows = launches.matrix.copy()
        by_height = 2.0 / rows[RADIUS]
        shrinks = -rows[DELTA] / rows[RADIUS]
        for row, values in ((DELTA, self.friction), (DECEL, self.height)):
            rows[row] = np.broadcast_to(values, launches.shape).reshape(-1)
        friction, height = rows[DELTA, each, None], rows[DECEL, each, None]
        by_height, shrinks = by_height[each, None], shrinks[each, None]
        by_delta, by_decel = jacobian[..., DELTA].copy(), jacobian[..., DECEL].copy()
        jacobian[..., DELTA] = by_height * height * by_delta + self.gravity * by_decel
        jacobian[..., DECEL] = by_height * friction * by_delta
        jacobian[..., RADIUS] += shrinks * by_delta
        return rows


def refuse_both(delta: Any, decel: Any, friction: Any, height: Any, gravity: Any) -> bool:
    """Whether pucks are given by their friction; what clashes is refused.

    >>> refuse_both(0.5, 1.0, None, DEFAULT_HEIGHT, DEFAULT_GRAVITY)
    False
    """
    if friction is None:
        if type(height) is Unsaid and type(gravity) is Unsaid:
            return False
        raise InputError("height and gravity need a friction: give it, or delta and decel alone")
    if type(delta) is Unsaid and type(decel) is Unsaid:
        return True
    raise InputError(
        "friction, height, gravity stand in place of delta and decel: give the ones or the others"
    )


def delta_and_decel(
    delta: Any, decel: Any, radius: npt.ArrayLike, friction: Any, height: Any, gravity: Any
) -> tuple[Any, Any, ByFriction | None]:
    """δ and J of pucks, and what they follow from.

    Raises InputError if both are given, or a number lies outside its range.

    >>> numbers = DEFAULT_DELTA, DEFAULT_DECEL, 0.04, 0.25, 0.04, 10.0
    >>> [part.tolist() for part in delta_and_decel(*numbers)[:2]]
    [0.5, 2.5]
    """
    if not refuse_both(delta, decel, friction, height, gravity):
        return delta, decel, None
    f, h = finite_array("friction", friction, "1"), finite_array("height", height, "m")
    if not (f > 0.0).all():
        raise InputError(f"friction must be greater than 0, got {f.min():g}: no puck stops without")
    if (h < 0.0).any():
        raise InputError(f"height must not be negative, in m, got {h.min():g}")
    g, r = positive("gravity", gravity, "m/s^2"), positive_array("radius", radius, "m")
    f, h, r = broadcast(friction=f, height=h, radius=r)
    return 2.0 * f * h / r, f * g, ByFriction(f, h, g)


LAUNCH_NAMES = ("vx", "vy", "spin", "delta", "decel", "radius")
STOP_NAMES = ("stop_time", "stop_x", "stop_y", "path_length", "body_angle")
STATE_NAMES = ("x", "y", "orientation", "vx", "vy", "spin")
FRICTION_NAMES = ("vx", "vy", "spin", "friction", "height", "radius")
MOMENT_NAMES = (*LAUNCH_NAMES, "time")

Bodies = dict[float, UnitPuck]  # by height


class Differentiated:
    """A result with derivatives, where they were asked for.

    ``jacobian`` (…, rows, columns): derivatives of :attr:`JACOBIAN_ROWS` by
    :attr:`JACOBIAN_COLUMNS`, in these orders and SI units.
    """

    JACOBIAN_ROWS: ClassVar[tuple[str, ...]]
    JACOBIAN_COLUMNS: tuple[str, ...]
    _jacobian: FloatArray | None = None
    _arguments: FloatArray
    _anew: Callable[..., Any] | None = None  # the same of other launches
    _highest: float = 1.0  # δ of them

    @property
    def jacobian(self) -> FloatArray:
        """Derivatives (…, rows, columns).

        Raises
        ------
        InputError
            If they were not asked for.
        """
        if self._jacobian is None:
            raise InputError("derivatives were not asked for: call with jacobian=True")
        return self._jacobian

    def derivative(self, of: str, by: str) -> FloatArray:
        """One entry of the Jacobian by names, of the shape of the launches.

        Parameters
        ----------
        of : one of ``JACOBIAN_ROWS``
        by : one of ``JACOBIAN_COLUMNS``

        Raises
        ------
        InputError
            If a name is not known, or derivatives were not asked for.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> result = Puck.similar().stop((1.0, 0.0), 5.0, jacobian=True)
        >>> float(result.derivative("stop_x", "spin").round(6))
        0.420792
        """
        places = []
        for word, name, names in (
            ("of", of, self.JACOBIAN_ROWS), ("by", by, self.JACOBIAN_COLUMNS),
        ):  # fmt: skip
            if not isinstance(name, str) or name not in names:
                raise InputError(f"{word} must be one of {', '.join(names)}, got {shown(name)}")
            places.append(names.index(name))
        entry: FloatArray = self.jacobian[..., places[0], places[1]]
        return entry

    def spread(
        self,
        covariance: npt.ArrayLike,
        of: Sequence[str] | None = None,
        *,
        samples: int = 0,
        seed: int = 0,
    ) -> ResultSpread:
        """How the results scatter when the launches do: covariance in, covariance out.

        Parameters
        ----------
        covariance : array_like (k, k) or (…, k, k), SI units, symmetric, no negative variances
            Of the arguments named in ``of``, for all launches or for each.
        of : k names of ``JACOBIAN_COLUMNS``; the first three, the launch, if left out
        samples : int
            How many launches to draw of each, normally distributed, and to look up, beside the
            linear answer: 0, or from 2 on.
        seed : int
            The same seed draws the same samples.

        Returns
        -------
        Spread
            ``covariance`` A C Aᵀ with the Jacobian A, and ``deviation``; with samples also theirs,
            their ``ratio``, and ``is_linear``: whether the linear one is to be trusted.

        Raises
        ------
        InputError
            If derivatives were not asked for, the covariance is none, or a sample lies outside the
            range of its argument.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> result = Puck.similar().stop((1.0, 0.0), 5.0, jacobian=True)
        >>> out = result.spread([[1e-4, 0.0, 0.0], [0.0, 1e-4, 0.0], [0.0, 0.0, 1e-2]],
        ...                     samples=5000)
        >>> out.deviation.round(4).tolist()  # s, m, m, m, rad
        [0.0716, 0.0481, 0.0224, 0.0483, 0.3751]
        >>> bool(out.is_linear)
        True
        """
        return spread_of(
            self.JACOBIAN_ROWS, self.JACOBIAN_COLUMNS, self.jacobian, self._arguments, self._again,
            covariance, self.JACOBIAN_COLUMNS[:3] if of is None else of, samples, seed,
            self._highest,
        )  # fmt: skip

    def _again(self, arguments: FloatArray) -> FloatArray:
        """The rows of the Jacobian's results (rows, m) of arguments (columns, m)."""
        assert self._anew is not None
        result = self._anew(
            arguments[:2].T, arguments[2], *arguments[len(LAUNCH_NAMES) :],
            **dict(zip(self.JACOBIAN_COLUMNS[3:6], arguments[3:6], strict=True)),
        )  # fmt: skip
        return np.stack([getattr(result, name) for name in self.JACOBIAN_ROWS])


def refuse_rest(launches: FloatArray, shape: tuple[int, ...]) -> None:
    """Refuse launches (6, n) at rest: next to them the stop time is a cone."""
    still = (launches[:2] == 0.0).all(axis=0) & (launches[2] == 0.0)
    if still.any():
        where = np.unravel_index(int(still.argmax()), shape) if shape else ()
        which = "launch " + str(list(map(int, where))) if shape else "the launch"
        raise InputError(
            f"{which} is at rest, where the stop time has no derivative: leave it out, or leave "
            "out jacobian=True"
        )


def stop_jacobians(
    launches: Launches, plain: npt.NDArray[np.bool_], bodies: Bodies, table: StopTable,
    threads: int | None,
) -> FloatArray:  # fmt: skip
    """Derivatives (n, 5, 6) of the stops of launches: of ``plain`` ones by the stop table."""
    if plain.all():
        return _of_plain(table, launches, threads)
    from puck_tables.stopping.variational import stop_slopes_of

    rows = launches.matrix
    out = np.empty((launches.size, len(STOP_NAMES), len(LAUNCH_NAMES)))
    if plain.any():
        out[plain] = _of_plain(table, launches_in(rows[:, plain]), threads)
    for height, body in bodies.items():
        mine = ~plain & (rows[3] == height)
        out[mine] = stop_slopes_of(body, np.ascontiguousarray(rows[:, mine]), threads)
    return out


def _of_plain(table: StopTable, launches: Launches, threads: int | None) -> FloatArray:
    from puck_tables.stopping.stop_jacobian import fill_stop_jacobians, is_streamed

    slopes = table.slopes.stops
    out = np.empty((launches.size, len(STOP_NAMES), len(LAUNCH_NAMES)))

    def work(start: int, stop: int) -> None:
        fill_stop_jacobians(*launches.part(start, stop), slopes, is_streamed(out), out[start:stop])

    in_chunks(work, launches.size, threads)
    return out


def integrated_jacobians(
    bodies: Bodies, launches: FloatArray, pucks: npt.NDArray[np.int64],
    which: npt.NDArray[np.int64], moments: FloatArray, out: FloatArray, threads: int | None,
) -> None:  # fmt: skip
    """Derivatives of states of other ``pucks`` into their places in ``out`` (n, 6, 7).

    ``which`` (n,): of ``launches`` (6, m), at ``moments`` (n,).
    """
    from puck_tables.stopping.launch_derivatives import fill_placed_states
    from puck_tables.stopping.variational import unit_states, variations_of

    frictions = {height: variations_of(body) for height, body in bodies.items()}

    def work(puck: int, mine: npt.NDArray[np.int64]) -> None:
        launch, times = launches[:, puck], moments[mine]
        vx, vy, spin, height, decel, radius = launch.tolist()
        frame = frame_of((vx, vy), spin, decel, radius)
        part = np.zeros((mine.size, len(STATE_NAMES), len(MOMENT_NAMES)))
        if frame.slip > 0.0:
            friction = frictions[height]
            friction.refuse_limit(np.array(frame.speed), np.array(frame.rim))
            own = unit_states(friction, frame, times)
            fill_placed_states(launch, times, own, part)
        out[mine] = part

    for_each(pucks, which, work, threads)
