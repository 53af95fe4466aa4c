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
    from puck_tables.aiming import Aim
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
    from puck_tables.scene.scene import Scene, scene_from
    from puck_tables.scene.simulate import simulate_scene
    from puck_tables.scene.sweep import SceneMap, sweep_scene
    from puck_tables.similarity.build import build_stop_table
    from puck_tables.similarity.check import validate_stops
    from puck_tables.similarity.file import load_stop_table, save_stop_table
    from puck_tables.similarity.stop_table import StopTable
    from puck_tables.states import States, states
    from puck_tables.stop_map import StopMap
    from puck_tables.stops import Stops, stop
    from puck_tables.store import table_for
    from puck_tables.table.build import build_table
    from puck_tables.table.check import CheckReport, validate
    from puck_tables.table.file import load_table, save_table
    from puck_tables.table.law_check import validate_law
    from puck_tables.table.law_file import load_law_table, save_law_table
    from puck_tables.table.law_table import LawTable, build_law_table
    from puck_tables.table.partial_build import build_partial_table
    from puck_tables.table.partial_check import validate_partial
    from puck_tables.table.partial_file import load_partial_table, save_partial_table
    from puck_tables.table.partial_table import PartialTable
    from puck_tables.table.speed_build import build_speed_table
    from puck_tables.table.speed_check import validate_speed
    from puck_tables.table.speed_file import load_speed_table, save_speed_table
    from puck_tables.table.speed_table import SpeedTable
    from puck_tables.table.table import Table
    from puck_tables.trajectory import Trajectory

_HOMES = {
    "Aim": "aiming",
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
    "scene_from": "scene.scene",
    "simulate_scene": "scene.simulate",
    "SceneMap": "scene.sweep",
    "sweep_scene": "scene.sweep",
    "build_stop_table": "similarity.build",
    "validate_stops": "similarity.check",
    "load_stop_table": "similarity.file",
    "save_stop_table": "similarity.file",
    "StopTable": "similarity.stop_table",
    "States": "states",
    "states": "states",
    "StopMap": "stop_map",
    "Stops": "stops",
    "stop": "stops",
    "table_for": "store",
    "build_table": "table.build",
    "CheckReport": "table.check",
    "validate": "table.check",
    "load_table": "table.file",
    "save_table": "table.file",
    "validate_law": "table.law_check",
    "load_law_table": "table.law_file",
    "save_law_table": "table.law_file",
    "LawTable": "table.law_table",
    "build_law_table": "table.law_table",
    "build_partial_table": "table.partial_build",
    "validate_partial": "table.partial_check",
    "load_partial_table": "table.partial_file",
    "save_partial_table": "table.partial_file",
    "PartialTable": "table.partial_table",
    "build_speed_table": "table.speed_build",
    "validate_speed": "table.speed_check",
    "load_speed_table": "table.speed_file",
    "save_speed_table": "table.speed_file",
    "SpeedTable": "table.speed_table",
    "Table": "table.table",
    "Trajectory": "trajectory",
}

__all__ = [
    "Aim",
    "Asperity",
    "AsperityCurve",
    "AsperityMotion",
    "CheckReport",
    "ConstrainedMotion",
    "ConstrainedSystem",
    "Law",
    "LawTable",
    "PartialTable",
    "Puck",
    "Result",
    "Resultants",
    "Scene",
    "SceneMap",
    "SceneRun",
    "SpeedLaw",
    "SpeedTable",
    "States",
    "StopMap",
    "StopTable",
    "Stops",
    "Table",
    "Trajectory",
    "__version__",
    "approach_exponent",
    "asperity_curve",
    "asperity_motion",
    "build_law_table",
    "build_partial_table",
    "build_speed_table",
    "build_stop_table",
    "build_table",
    "constrained_motion",
    "critical_delta",
    "curvature_slope",
    "elementary_stop_time",
    "is_full_contact",
    "law_of",
    "limit_angle",
    "limit_ratio",
    "load_law_table",
    "load_partial_table",
    "load_speed_table",
    "load_stop_table",
    "load_table",
    "loaded_share",
    "one_sided_resultants",
    "patch_stop",
    "patch_system",
    "profile_law",
    "regime",
    "resultants",
    "save_law_table",
    "save_partial_table",
    "save_speed_table",
    "save_stop_table",
    "save_table",
    "scene_from",
    "simulate_scene",
    "speed_resultants",
    "states",
    "stop",
    "sweep_scene",
    "table_for",
    "validate",
    "validate_law",
    "validate_partial",
    "validate_speed",
    "validate_stops",
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
