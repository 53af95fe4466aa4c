"""Pucks by friction and height: δ = 2 f h / r and J = f g follow, derivatives by the chain rule."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, broadcast, finite_array, positive
from puck_tables._core.fields import Unsaid
from puck_tables.errors import InputError
from puck_tables.motion.body import STANDARD_GRAVITY
from puck_tables.stopping.launch_arrays import DECEL, DELTA, RADIUS, Launches, positive_array

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

        Notes
        -----
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

    Raises
    ------
    InputError
        If both are given, or a number lies outside its range.

    Examples
    --------
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
