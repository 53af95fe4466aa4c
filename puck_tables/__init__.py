"""Exact motion of a flat puck that slides and spins under dry friction, until it stops.

Importing the package stays light: numpy and numba are loaded when something is computed.

>>> import puck_tables
>>> round(puck_tables.simulate((1.0, 0.0), 5.0, delta=1.0).stop_time, 8)
4.0001888
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from puck_tables._version import __version__

if TYPE_CHECKING:
    from puck_tables.aiming import Aim, aim
    from puck_tables.asperity_picture import plot_asperity
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
    from puck_tables.plots import plot_aim, plot_map, plot_trajectory
    from puck_tables.puck import similarity_parameters
    from puck_tables.result_file import save_aim, save_asperity, save_map, save_trajectory
    from puck_tables.scene.outcome import SceneRun
    from puck_tables.scene.scene import Scene, scene_from
    from puck_tables.scene.simulate import simulate_scene
    from puck_tables.scene.sweep import SceneMap, sweep_scene
    from puck_tables.scene_file import save_scene_map, save_scene_run
    from puck_tables.scene_map_picture import plot_scene_map
    from puck_tables.scene_picture import plot_scene
    from puck_tables.states import States, flow
    from puck_tables.stop_map import StopMap, sweep
    from puck_tables.stops import Stops, stop
    from puck_tables.store import table_for
    from puck_tables.table.check import CheckReport
    from puck_tables.table.table import Table
    from puck_tables.trajectory import Trajectory, simulate

_HOMES = {
    "Aim": "aiming",
    "aim": "aiming",
    "plot_asperity": "asperity_picture",
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
    "SpeedLaw": "contact.speed_law",
    "speed_resultants": "contact.speed_quadrature",
    "Resultants": "contact.resultants",
    "is_full_contact": "contact.resultants",
    "resultants": "kernels.closed_form",
    "approach_exponent": "motion.limits",
    "curvature_slope": "motion.limits",
    "elementary_stop_time": "motion.limits",
    "limit_angle": "motion.limits",
    "limit_ratio": "motion.limits",
    "regime": "motion.limits",
    "plot_aim": "plots",
    "plot_map": "plots",
    "plot_trajectory": "plots",
    "similarity_parameters": "puck",
    "save_aim": "result_file",
    "save_asperity": "result_file",
    "save_map": "result_file",
    "save_trajectory": "result_file",
    "SceneRun": "scene.outcome",
    "Scene": "scene.scene",
    "scene_from": "scene.scene",
    "simulate_scene": "scene.simulate",
    "SceneMap": "scene.sweep",
    "sweep_scene": "scene.sweep",
    "save_scene_map": "scene_file",
    "save_scene_run": "scene_file",
    "plot_scene": "scene_picture",
    "plot_scene_map": "scene_map_picture",
    "Trajectory": "trajectory",
    "simulate": "trajectory",
    "Stops": "stops",
    "stop": "stops",
    "table_for": "store",
    "States": "states",
    "flow": "states",
    "StopMap": "stop_map",
    "sweep": "stop_map",
    "CheckReport": "table.check",
    "Table": "table.table",
    "Law": "contact.laws",
    "law_of": "contact.laws",
    "profile_law": "contact.laws",
    "loaded_share": "contact.one_sided",
    "one_sided_resultants": "contact.one_sided:resultants",
    "critical_delta": "contact.opening",
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
    "Resultants",
    "Scene",
    "SceneMap",
    "SceneRun",
    "SpeedLaw",
    "States",
    "StopMap",
    "Stops",
    "Table",
    "Trajectory",
    "__version__",
    "aim",
    "approach_exponent",
    "asperity_curve",
    "asperity_motion",
    "constrained_motion",
    "critical_delta",
    "curvature_slope",
    "elementary_stop_time",
    "flow",
    "is_full_contact",
    "law_of",
    "limit_angle",
    "limit_ratio",
    "loaded_share",
    "one_sided_resultants",
    "patch_stop",
    "patch_system",
    "plot_aim",
    "plot_asperity",
    "plot_map",
    "plot_scene",
    "plot_scene_map",
    "plot_trajectory",
    "profile_law",
    "regime",
    "resultants",
    "save_aim",
    "save_asperity",
    "save_map",
    "save_scene_map",
    "save_scene_run",
    "save_trajectory",
    "scene_from",
    "similarity_parameters",
    "simulate",
    "simulate_scene",
    "speed_resultants",
    "stop",
    "sweep",
    "sweep_scene",
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
