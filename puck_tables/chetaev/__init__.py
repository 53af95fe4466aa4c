"""Constraints with friction after Chetaev: general systems, and dry friction from asperities."""

from typing import TYPE_CHECKING

from puck_tables._core.lazy import lazily

if TYPE_CHECKING:
    from puck_tables.chetaev.asperity_forces import AsperityCurve, asperity_curve
    from puck_tables.chetaev.motion import ConstrainedMotion, constrained_motion
    from puck_tables.chetaev.patch_puck import patch_stop, patch_system
    from puck_tables.chetaev.system import ConstrainedSystem
    from puck_tables.chetaev.wavy_support import Asperity, AsperityMotion, asperity_motion

_HOMES = {
    "asperity_forces": "AsperityCurve asperity_curve",
    "motion": "ConstrainedMotion constrained_motion",
    "patch_puck": "patch_stop patch_system",
    "system": "ConstrainedSystem",
    "wavy_support": "Asperity AsperityMotion asperity_motion",
}

__all__ = [
    "Asperity", "AsperityCurve", "AsperityMotion", "ConstrainedMotion", "ConstrainedSystem",
    "asperity_curve", "asperity_motion", "constrained_motion", "patch_stop", "patch_system",
]  # fmt: skip

__getattr__, __dir__ = lazily(__name__, _HOMES)
