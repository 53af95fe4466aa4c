"""Exact motion of a flat puck that slides and spins under dry friction, until it stops.

Importing the package stays light: numpy and numba are loaded when something is computed.  The names
here are what most need; :mod:`puck_tables.results` holds the classes of what calls give,
:mod:`puck_tables.errors` what they raise, :mod:`puck_tables.contact` more of the friction of a
contact, :mod:`puck_tables.motion` what can be said of motions without following them,
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
    from puck_tables import chetaev, contact, errors, motion, results
    from puck_tables.bulk.spreads import Normal, Uniform
    from puck_tables.contact.base import Base
    from puck_tables.contact.friction_laws import CurlingLaw, PowerLaw, StribeckLaw
    from puck_tables.contact.laws import Law, law_of, profile_law
    from puck_tables.contact.speed_law import SpeedLaw
    from puck_tables.errors import InputError, PuckError
    from puck_tables.export.board_source import export_board
    from puck_tables.export.source import export_source
    from puck_tables.film.film import Track
    from puck_tables.film.track_files import read_tracks
    from puck_tables.fitting.fit_tracks import fit
    from puck_tables.fitting.forecast import Camera, fisher
    from puck_tables.kernels.closed_form_kernel import resultants
    from puck_tables.puck import Puck
    from puck_tables.reference.answer import reference_case
    from puck_tables.reference.comparison import compare
    from puck_tables.reference.floor_reaction import floor_friction
    from puck_tables.scene.parts import (
        Constraint,
        Drag,
        Edge,
        Floor,
        Force,
        Grip,
        Lateral,
        Launch,
        Orthotropic,
        Patch,
        Strips,
        Wall,
    )
    from puck_tables.scene.pucks_and_posts import Arc, Line, Pocket, Post, Rim
    from puck_tables.scene.restitution import Plastic, RestitutionTable, Viscoelastic
    from puck_tables.scene.rows_over_time import rows_over_time
    from puck_tables.stopping.array_functions import state_arrays, stop_arrays
    from puck_tables.stopping.states import states
    from puck_tables.stopping.stops import stop
    from puck_tables.table.table import Table
    from puck_tables.table.table_store import table_for
    from puck_tables.warming import warm_up
    from puck_tables.world.scene import Scene
    from puck_tables.world.world import World
    from puck_tables.world.worlds import Worlds
    from puck_tables.wrench.fence import Fence
    from puck_tables.wrench.push import push

with_neighbours(__name__, __file__)

__all__ = [
    "Arc", "Base", "Camera", "Constraint", "CurlingLaw", "Drag", "Edge", "Fence", "Floor", "Force",
    "Grip", "InputError", "Lateral", "Launch", "Law", "Line", "Normal", "Orthotropic", "Patch",
    "Plastic", "Pocket", "Post", "PowerLaw", "Puck", "PuckError", "RestitutionTable", "Rim",
    "Scene", "SpeedLaw", "StribeckLaw", "Strips", "Table", "Track", "Uniform", "Viscoelastic",
    "Wall", "World", "Worlds", "__version__", "chetaev", "compare", "contact", "errors",
    "export_board", "export_source", "fisher", "fit", "floor_friction", "law_of", "motion",
    "profile_law", "push", "read_tracks", "reference_case", "resultants", "results",
    "rows_over_time", "state_arrays", "states", "stop", "stop_arrays", "table_for", "warm_up",
]  # fmt: skip

__getattr__, __dir__ = lazily(__name__)
lead_up({
    "draw": "puck_tables.plot.drawn",
    "save_movie": "puck_tables.plot.movie",
    "save_page": "puck_tables.plot.html_page",
    "fit_page": "puck_tables.plot.fit_page:page",
    "report of Trajectory": "puck_tables.report.trajectory_report:report",
    "report of Run": "puck_tables.report.run_report:report",
    "report of Fit": "puck_tables.report.fit_report:report",
    "report of Aim": "puck_tables.report.aim_report:report",
    "report of BoardAim": "puck_tables.report.aim_report:board_report",
    "report of Answer": "puck_tables.report.reference_report:report",
    "report of FloorFriction": "puck_tables.report.reference_report:friction_report",
    "report of Comparison": "puck_tables.report.reference_report:comparison_report",
    "report of StopMap": "puck_tables.report.sweep_report:stops_report",
    "report of StopSample": "puck_tables.report.sweep_report:stops_report",
    "report of Map": "puck_tables.report.sweep_report:map_report",
    "report of Sample": "puck_tables.report.sweep_report:sample_report",
    "report of Stored": "puck_tables.report.sweep_report:stored_report",
    "report of Table": "puck_tables.report.accuracy_report:report",
    "report of CheckReport": "puck_tables.report.accuracy_report:check_report",
    "report of TradeOff": "puck_tables.report.accuracy_report:tradeoff_report",
    "table of resultants": "puck_tables.table.resultant_table:ResultantTable",
    "table of stops": "puck_tables.stopping.stop_table:StopTable",
    "table of speed": "puck_tables.table.speed_table:SpeedTable",
    "table of friction section": "puck_tables.table.friction_section:FrictionSection",
    "table of stop section": "puck_tables.stopping.stop_section:StopSection",
})  # fmt: skip
