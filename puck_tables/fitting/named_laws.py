"""Laws of friction over the slip speed u by a name and three numbers.

f(u) = f + (f₀ − f) φ(u/w) with f of fast slip, f₀ at rest and a speed w:

==========  =====================================  ==================
name        φ(x)                                   known as
==========  =====================================  ==================
stribeck    exp(−x)                                Stribeck's
hyperbola   1/(1 + x)                              a/(u + b) + c
two-valued  1 below x = 1, 0 above (a short slope)  static and kinetic
==========  =====================================  ==================
"""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.speed_law import SpeedLaw

_STEP = 0.05  # of w: so wide is the slope of the two values, that it can be fitted
_SHAPES = {
    "stribeck": np.array([0.0, 0.25, 0.5, 0.8, 1.2, 1.7, 2.4, 3.4, 5.0, 8.0]),
    "hyperbola": np.array([0.0, 0.2, 0.5, 1.0, 2.0, 4.0, 8.0, 20.0, 60.0]),
    "two-valued": np.array([0.0, 1.0 - _STEP, 1.0 + _STEP, 4.0]),
}
NAMES = tuple(_SHAPES)


def shape(name: str, x: FloatArray) -> FloatArray:
    """φ of a law at u/w (n,).

    Examples
    --------
    >>> shape("stribeck", np.array([0.0, 1.0])).round(4).tolist()
    [1.0, 0.3679]
    """
    if name == "stribeck":
        return np.exp(-x)
    if name == "hyperbola":
        return 1.0 / (1.0 + x)
    return np.clip(0.5 + (1.0 - x) / (2.0 * _STEP), 0.0, 1.0)


def law_named(name: str, fast: float, rest: float, speed: float) -> SpeedLaw:
    """The law with these numbers, between rows that are close where it bends.

    Examples
    --------
    >>> law = law_named("stribeck", 0.1, 0.2, 0.05)
    >>> round(float(law(0.0)), 4), round(float(law(0.05)), 3)
    (0.2, 0.137)
    """
    x = _SHAPES[name]
    values = fast + (rest - fast) * shape(name, x)
    return SpeedLaw((speed * x).tolist(), np.maximum(values, 1e-9).tolist(),
                    "linear" if name == "two-valued" else "cubic")  # fmt: skip
