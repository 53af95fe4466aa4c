"""What limit surfaces of round pucks and of others have in common."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.io.columns import following
from puck_tables.result import Result

if TYPE_CHECKING:
    from puck_tables.motion.puck_spec import PuckSpec


@dataclass(frozen=True, eq=False, repr=False)
class FrictionSurface(Result):
    """Force and torque, N and N m, that friction takes up under a puck, over the twist."""

    puck: PuckSpec

    def __getattr__(self, name: str) -> FloatArray:
        """A column that follows from others: ``force``, N."""
        column: FloatArray = following(self, name)
        return column

    @property
    def unit_force(self) -> float:
        """F m g, N: what slides without spin."""
        return self.puck.mass * self.puck.decel

    def _said(self, kind: str) -> str:
        """How large it is, in a line."""
        return (
            f"{type(self).__name__}({self.torque.size} twists, {kind}, up to "
            f"{float(np.max(self.force)):.6g} N and {float(np.max(self.torque)):.6g} N m)"
        )
