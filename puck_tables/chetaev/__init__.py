"""Constraints with friction after Chetaev: general systems, and dry friction from asperities."""

from typing import TYPE_CHECKING

from puck_tables._core.lazy import lazily

if TYPE_CHECKING:
    from puck_tables.chetaev.asperity_forces import AsperityCurve, asperity_curve
    from puck_tables.chetaev.asperity_shape import Asperity
    from puck_tables.chetaev.motion import ConstrainedMotion, constrained_motion
    from puck_tables.chetaev.patch_puck import patch_stop, patch_system
    from puck_tables.chetaev.system import ConstrainedSystem
    from puck_tables.chetaev.wavy_support import AsperityMotion, asperity_motion

_HOMES = {
    "Asperity": "asperity_shape",
    "AsperityCurve": "asperity_forces",
    "AsperityMotion": "wavy_support",
    "ConstrainedMotion": "motion",
    "ConstrainedSystem": "system",
    "asperity_curve": "asperity_forces",
    "asperity_motion": "wavy_support",
    "constrained_motion": "motion",
    "patch_stop": "patch_puck",
    "patch_system": "patch_puck",
}

__all__ = [
    "Asperity",
    "AsperityCurve",
    "AsperityMotion",
    "ConstrainedMotion",
    "ConstrainedSystem",
    "asperity_curve",
    "asperity_motion",
    "constrained_motion",
    "patch_stop",
    "patch_system",
]

__getattr__, __dir__ = lazily(__name__, _HOMES)
