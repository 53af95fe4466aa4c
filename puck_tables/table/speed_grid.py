"""The axis of speeds of a table where the friction coefficient depends on the slip speed.

The variable is the fastest slip of the base, U = v + r|ω| = Q(cos φ + |sin φ|): a friction law
that is known up to U_max is used whole, and never beyond, at every slip angle.  The nodes are

    U_j = u₀ sinh(j/n · asinh(U_max/u₀)),   j = 0 … n,

uniform below the scale u₀ on which f varies first, logarithmic above, and 0 is a node: there f is
f(0) and the table is that of a constant coefficient.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from puck_tables.errors import InputError

FloatArray = npt.NDArray[np.float64]

MAX_CELLS = 8192
_LEAST_SCALE = 1e-9  # of the top speed


@dataclass(frozen=True)
class SpeedAxis:
    """Speeds U from 0 to ``top``.

    Parameters
    ----------
    cells : int
        At least 4.
    top : float
        U_max, m/s.
    scale : float
        u₀, m/s: the least speed at which f varies; from 1e-9 of ``top``.

    Raises
    ------
    InputError
        If a number is out of range.

    Examples
    --------
    >>> SpeedAxis(4, top=10.0, scale=0.1).nodes().round(4).tolist()
    [0.0, 0.1747, 0.7036, 2.6583, 10.0]
    """

    cells: int
    top: float
    scale: float

    def __post_init__(self) -> None:
        if not 4 <= self.cells <= MAX_CELLS:
            raise InputError(f"cells of speed must be from 4 to {MAX_CELLS}, got {self.cells}")
        if not 0.0 < self.top < math.inf:
            raise InputError(f"top_speed must be finite and greater than 0 m/s, got {self.top:g}")
        if not _LEAST_SCALE * self.top <= self.scale < math.inf:
            raise InputError(
                f"scale must be finite and at least {_LEAST_SCALE:g} of the top speed "
                f"{self.top:g} m/s, got {self.scale:g}"
            )

    @property
    def reach(self) -> float:
        """The length of the axis in asinh(U/u₀)."""
        return math.asinh(self.top / self.scale)

    def nodes(self) -> FloatArray:
        """U at the nodes, m/s, ascending from 0."""
        share = np.arange(self.cells + 1) / self.cells
        speeds = self.scale * np.sinh(share * self.reach)
        speeds[-1] = self.top
        return np.asarray(speeds)
