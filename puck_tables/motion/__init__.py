"""The hot loop: equations of motion, steppers, events; everything compiled."""

from typing import TYPE_CHECKING

from puck_tables._core.lazy import lazily

if TYPE_CHECKING:
    from puck_tables.motion.limits import (
        approach_exponent,
        curvature_slope,
        limit_angle,
        limit_ratio,
        regime,
    )

__all__ = [
    "approach_exponent", "curvature_slope", "limit_angle", "limit_ratio", "regime",
]  # fmt: skip

__getattr__, __dir__ = lazily(__name__)
