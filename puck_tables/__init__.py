"""Exact motion of a flat puck that slides and spins under dry friction, until it stops.

Importing the package stays light: numpy and numba are loaded when something is computed.

>>> import puck_tables as pt
>>> puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.1)  # ice hockey
>>> round(puck.simulate((2.0, 0.0), spin=30.0).stop_time, 6)
2.345288
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from puck_tables._version import __version__

if TYPE_CHECKING:
    from puck_tables.chetaev.asperity import Asperity, AsperityMotion, asperity_motion
    from puck_tables.chetaev.asperity_curve import AsperityCurve, asperity_curve
    from puck_tables.chetaev.motion import ConstrainedMotion, constrained_motion
    from puck_tables.chetaev.patch_puck import patch_stop, patch_system
    from puck_tables.chetaev.system import ConstrainedSystem
    from puck_tables.contact.laws import Law, law_of, profile_law
    from puck_tables.contact.one_sided import loaded_share
    from puck_tables.contact.one_sided import resultants as one_sided_resultants
    from puck_tables.contact.opening import critical_delta
    from puck_tables.contact.resultants import Resultants, is_full_contact
    from puck_tables.contact.speed_law import SpeedLaw
    from puck_tables.contact.speed_quadrature import speed_resultants
    from puck_tables.errors import (
        AccuracyError,
        ContactError,
        InputError,
        MissingExtraError,
        OutputError,
        PuckError,
        TableError,
    )
    from puck_tables.kernels.closed_form import resultants
    from puck_tables.motion.limits import (
        approach_exponent,
        curvature_slope,
        elementary_stop_time,
        limit_angle,
        limit_ratio,
        regime,
    )
    from puck_tables.puck import Puck
    from puck_tables.result import Result
    from puck_tables.scene.outcome import SceneRun
    from puck_tables.scene.parts import (
        Constraint,
        Drag,
        Edge,
        Floor,
        Force,
        Launch,
        Run,
        Strips,
        Wall,
    )
    from puck_tables.scene.scene import Scene
    from puck_tables.scene.sweep import SceneMap
    from puck_tables.stopping.aim import Aim
    from puck_tables.stopping.states import States, states
    from puck_tables.stopping.stops import Stops, stop
    from puck_tables.stopping.sweep import StopMap
    from puck_tables.table.check import CheckReport
    from puck_tables.table.store import table_for
    from puck_tables.table.table import Table
    from puck_tables.trajectory import Trajectory

_HOMES = {
    "AccuracyError": "errors",
    "ContactError": "errors",
    "InputError": "errors",
    "MissingExtraError": "errors",
    "OutputError": "errors",
    "PuckError": "errors",
    "TableError": "errors",
    "Aim": "stopping.aim",
    "Asperity": "chetaev.asperity",
    "AsperityMotion": "chetaev.asperity",
    "asperity_motion": "chetaev.asperity",
    "AsperityCurve": "chetaev.asperity_curve",
    "asperity_curve": "chetaev.asperity_curve",
    "ConstrainedMotion": "chetaev.motion",
    "constrained_motion": "chetaev.motion",
    "patch_stop": "chetaev.patch_puck",
    "patch_system": "chetaev.patch_puck",
    "ConstrainedSystem": "chetaev.system",
    "Law": "contact.laws",
    "law_of": "contact.laws",
    "profile_law": "contact.laws",
    "loaded_share": "contact.one_sided",
    "one_sided_resultants": "contact.one_sided:resultants",
    "critical_delta": "contact.opening",
    "Resultants": "contact.resultants",
    "is_full_contact": "contact.resultants",
    "SpeedLaw": "contact.speed_law",
    "speed_resultants": "contact.speed_quadrature",
    "resultants": "kernels.closed_form",
    "approach_exponent": "motion.limits",
    "curvature_slope": "motion.limits",
    "elementary_stop_time": "motion.limits",
    "limit_angle": "motion.limits",
    "limit_ratio": "motion.limits",
    "regime": "motion.limits",
    "Puck": "puck",
    "Result": "result",
    "SceneRun": "scene.outcome",
    "Scene": "scene.scene",
    "Constraint": "scene.parts",
    "Drag": "scene.parts",
    "Edge": "scene.parts",
    "Floor": "scene.parts",
    "Force": "scene.parts",
    "Launch": "scene.parts",
    "Run": "scene.parts",
    "Strips": "scene.parts",
    "Wall": "scene.parts",
    "SceneMap": "scene.sweep",
    "States": "stopping.states",
    "states": "stopping.states",
    "StopMap": "stopping.sweep",
    "Stops": "stopping.stops",
    "stop": "stopping.stops",
    "table_for": "table.store",
    "CheckReport": "table.check",
    "Table": "table.table",
    "Trajectory": "trajectory",
}

__all__ = [
    "AccuracyError",
    "Aim",
    "Asperity",
    "AsperityCurve",
    "AsperityMotion",
    "CheckReport",
    "ConstrainedMotion",
    "ConstrainedSystem",
    "Constraint",
    "ContactError",
    "Drag",
    "Edge",
    "Floor",
    "Force",
    "InputError",
    "Launch",
    "Law",
    "MissingExtraError",
    "OutputError",
    "Puck",
    "PuckError",
    "Result",
    "Resultants",
    "Run",
    "Scene",
    "SceneMap",
    "SceneRun",
    "SpeedLaw",
    "States",
    "StopMap",
    "Stops",
    "Strips",
    "Table",
    "TableError",
    "Trajectory",
    "Wall",
    "__version__",
    "approach_exponent",
    "asperity_curve",
    "asperity_motion",
    "constrained_motion",
    "critical_delta",
    "curvature_slope",
    "elementary_stop_time",
    "is_full_contact",
    "law_of",
    "limit_angle",
    "limit_ratio",
    "loaded_share",
    "one_sided_resultants",
    "patch_stop",
    "patch_system",
    "profile_law",
    "regime",
    "resultants",
    "speed_resultants",
    "states",
    "stop",
    "table_for",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'puck_tables' has no attribute {name!r}")
    module, _, original = _HOMES[name].partition(":")
    value = getattr(import_module(f"puck_tables.{module}"), original or name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
