"""Constraints with friction after Chetaev: general systems, and dry friction from asperities."""

from puck_tables.chetaev.asperity_forces import AsperityCurve, asperity_curve
from puck_tables.chetaev.motion import ConstrainedMotion, constrained_motion
from puck_tables.chetaev.patch_puck import patch_stop, patch_system
from puck_tables.chetaev.system import ConstrainedSystem
from puck_tables.chetaev.wavy_support import Asperity, AsperityMotion, asperity_motion

__all__ = [
    "Asperity", "AsperityCurve", "AsperityMotion", "ConstrainedMotion", "ConstrainedSystem",
    "asperity_curve", "asperity_motion", "constrained_motion", "patch_stop", "patch_system",
]  # fmt: skip
