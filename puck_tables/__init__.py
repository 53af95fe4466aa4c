"""Exact motion of a flat puck that slides and spins under dry friction, until it stops.

Importing the package stays light: numpy and numba are loaded when something is computed.  The names
here are what most need; :mod:`puck_tables.contact` holds more of the friction of a contact,
:mod:`puck_tables.motion` what can be said of motions without following them,
:mod:`puck_tables.chetaev` constraints with friction, and friction from asperities.

>>> import puck_tables as pt
>>> puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.1)  # ice hockey
>>> round(puck.simulate((2.0, 0.0), spin=30.0).stop_time, 6)
2.345288
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from puck_tables._core.lazy import lazily, lead_up, with_neighbours
from puck_tables._version import __version__

if TYPE_CHECKING:
    from puck_tables import chetaev, contact, motion
    from puck_tables.bulk.spreads import Normal, Uniform
    from puck_tables.contact.base import Base
    from puck_tables.contact.friction_laws import CurlingLaw, PowerLaw, StribeckLaw
    from puck_tables.contact.laws import Law, law_of, profile_law
    from puck_tables.contact.speed_law import SpeedLaw
    from puck_tables.errors import (
        AccuracyError,
        ClusterError,
        ContactError,
        InputError,
        MissingExtraError,
        OutputError,
        PuckError,
        TableError,
    )
    from puck_tables.export.source import Source, export_source
    from puck_tables.film.puck_track import Track
    from puck_tables.film.track_files import read_tracks
    from puck_tables.fitting.fit_result import Fit
    from puck_tables.fitting.fit_tracks import fit
    from puck_tables.fitting.forecast import Camera, Forecast, fisher
    from puck_tables.kernels.closed_form_kernel import resultants
    from puck_tables.puck import Puck
    from puck_tables.reference.answer import Answer, reference_case
    from puck_tables.reference.comparison import Comparison, compare
    from puck_tables.reference.floor_friction import FloorFriction, floor_friction
    from puck_tables.result import Result
    from puck_tables.scene.driven import path_along
    from puck_tables.scene.parts import (
        Constraint,
        Drag,
        Edge,
        Floor,
        Force,
        Lateral,
        Launch,
        Orthotropic,
        Patch,
        Strips,
        Wall,
    )
    from puck_tables.scene.pieces import Arc, Pocket, Post, Rim
    from puck_tables.scene.restitution import Plastic, RestitutionTable, Viscoelastic
    from puck_tables.scene.run import Run
    from puck_tables.stopping.aim_at_targets import Aim, Aims
    from puck_tables.stopping.array_functions import state_arrays, stop_arrays
    from puck_tables.stopping.states import States, states
    from puck_tables.stopping.stop_map import StopMap, StopSample
    from puck_tables.stopping.stops import Stops, stop
    from puck_tables.table.check import CheckReport
    from puck_tables.table.table import Table
    from puck_tables.table.table_cache import table_for
    from puck_tables.trajectory import Trajectory
    from puck_tables.warming import warm_up
    from puck_tables.world.aimed import BoardAim
    from puck_tables.world.map import Map
    from puck_tables.world.sample import Sample
    from puck_tables.world.scene import Piece, Scene
    from puck_tables.world.world import World
    from puck_tables.wrench.friction_hold import Hold
    from puck_tables.wrench.push import Push, push
    from puck_tables.wrench.surface import LimitSurface

with_neighbours(__name__, __file__)

_HOMES = {
    "AccuracyError": "errors",
    "Aim": "stopping.aim_at_targets",
    "Aims": "stopping.aim_at_targets",
    "Answer": "reference.answer",
    "Arc": "scene.pieces",
    "Base": "contact.base",
    "BoardAim": "world.aimed",
    "Camera": "fitting.forecast",
    "CheckReport": "table.check",
    "ClusterError": "errors",
    "Comparison": "reference.comparison",
    "Constraint": "scene.parts",
    "ContactError": "errors",
    "CurlingLaw": "contact.friction_laws",
    "Drag": "scene.parts",
    "Edge": "scene.parts",
    "Fit": "fitting.fit_result",
    "Floor": "scene.parts",
    "FloorFriction": "reference.floor_friction",
    "Force": "scene.parts",
    "Forecast": "fitting.forecast",
    "Hold": "wrench.friction_hold",
    "InputError": "errors",
    "Lateral": "scene.parts",
    "Launch": "scene.parts",
    "Law": "contact.laws",
    "LimitSurface": "wrench.surface",
    "Map": "world.map",
    "MissingExtraError": "errors",
    "Normal": "bulk.spreads",
    "Orthotropic": "scene.parts",
    "OutputError": "errors",
    "Patch": "scene.parts",
    "Piece": "world.scene",
    "Plastic": "scene.restitution",
    "Pocket": "scene.pieces",
    "Post": "scene.pieces",
    "PowerLaw": "contact.friction_laws",
    "Puck": "puck",
    "PuckError": "errors",
    "Push": "wrench.push",
    "RestitutionTable": "scene.restitution",
    "Result": "result",
    "Rim": "scene.pieces",
    "Sample": "world.sample",
    "Scene": "world.scene",
    "Run": "scene.run",
    "Source": "export.source",
    "SpeedLaw": "contact.speed_law",
    "States": "stopping.states",
    "StopMap": "stopping.stop_map",
    "StopSample": "stopping.stop_map",
    "Stops": "stopping.stops",
    "StribeckLaw": "contact.friction_laws",
    "Strips": "scene.parts",
    "Table": "table.table",
    "TableError": "errors",
    "Track": "film.puck_track",
    "Trajectory": "trajectory",
    "Uniform": "bulk.spreads",
    "Viscoelastic": "scene.restitution",
    "Wall": "scene.parts",
    "World": "world.world",
    "chetaev": "",
    "compare": "reference.comparison",
    "contact": "",
    "export_source": "export.source",
    "fisher": "fitting.forecast",
    "fit": "fitting.fit_tracks",
    "floor_friction": "reference.floor_friction",
    "law_of": "contact.laws",
    "motion": "",
    "path_along": "scene.driven",
    "profile_law": "contact.laws",
    "push": "wrench.push",
    "read_tracks": "film.track_files",
    "reference_case": "reference.answer",
    "resultants": "kernels.closed_form_kernel",
    "state_arrays": "stopping.array_functions",
    "states": "stopping.states",
    "stop": "stopping.stops",
    "stop_arrays": "stopping.array_functions",
    "table_for": "table.table_cache",
    "warm_up": "warming",
}

__all__ = [
    "AccuracyError",
    "Aim",
    "Aims",
    "Answer",
    "Arc",
    "Base",
    "BoardAim",
    "Camera",
    "CheckReport",
    "ClusterError",
    "Comparison",
    "Constraint",
    "ContactError",
    "CurlingLaw",
    "Drag",
    "Edge",
    "Fit",
    "Floor",
    "FloorFriction",
    "Force",
    "Forecast",
    "Hold",
    "InputError",
    "Lateral",
    "Launch",
    "Law",
    "LimitSurface",
    "Map",
    "MissingExtraError",
    "Normal",
    "Orthotropic",
    "OutputError",
    "Patch",
    "Piece",
    "Plastic",
    "Pocket",
    "Post",
    "PowerLaw",
    "Puck",
    "PuckError",
    "Push",
    "RestitutionTable",
    "Result",
    "Rim",
    "Run",
    "Sample",
    "Scene",
    "Source",
    "SpeedLaw",
    "States",
    "StopMap",
    "StopSample",
    "Stops",
    "StribeckLaw",
    "Strips",
    "Table",
    "TableError",
    "Track",
    "Trajectory",
    "Uniform",
    "Viscoelastic",
    "Wall",
    "World",
    "__version__",
    "chetaev",
    "compare",
    "contact",
    "export_source",
    "fisher",
    "fit",
    "floor_friction",
    "law_of",
    "motion",
    "path_along",
    "profile_law",
    "push",
    "read_tracks",
    "reference_case",
    "resultants",
    "state_arrays",
    "states",
    "stop",
    "stop_arrays",
    "table_for",
    "warm_up",
]

__getattr__, __dir__ = lazily(__name__, _HOMES)
lead_up({
    "draw": "puck_tables.plot.drawn",
    "save_movie": "puck_tables.plot.movie",
    "table of resultants": "puck_tables.table.resultant_table:ResultantTable",
    "table of stops": "puck_tables.stopping.stop_table:StopTable",
    "table of speed": "puck_tables.table.speed_table:SpeedTable",
    "table of friction section": "puck_tables.table.friction_section:FrictionSection",
    "table of stop section": "puck_tables.stopping.stop_section:StopSection",
})  # fmt: skip
