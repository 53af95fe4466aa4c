"""The classes of what calls give, for annotations: nobody makes them by hand.

Each knows what :class:`Result` has: ``summary``, ``dataset``, ``save``, ``plot``;
``print`` says of it what the command says.

>>> from puck_tables import Puck, results
>>> isinstance(Puck(0.04, friction=0.1).stop((1.0, 0.0)), results.Stops)
True
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from puck_tables._core.lazy import lazily

if TYPE_CHECKING:
    from puck_tables.export.board_source import BoardSource
    from puck_tables.export.source import Source
    from puck_tables.fitting.fit_result import Fit
    from puck_tables.fitting.forecast import Forecast
    from puck_tables.reference.answer import Answer
    from puck_tables.reference.comparison import Comparison
    from puck_tables.reference.floor_reaction import FloorFriction
    from puck_tables.result import Result
    from puck_tables.scene.run import Run
    from puck_tables.stopping.aim_at_targets import Aim
    from puck_tables.stopping.population import StopMap, StopSample
    from puck_tables.stopping.states import States
    from puck_tables.stopping.stops import Stops
    from puck_tables.table.check import CheckReport
    from puck_tables.trajectory import Trajectory
    from puck_tables.world.aimed import BoardAim
    from puck_tables.world.map import Map
    from puck_tables.world.scene_ends import Sample
    from puck_tables.world.targets import Odds
    from puck_tables.wrench.friction_hold import Hold
    from puck_tables.wrench.push import Push
    from puck_tables.wrench.surface import LimitSurface

__all__ = [
    "Aim", "Answer", "BoardAim", "BoardSource", "CheckReport", "Comparison", "Fit", "FloorFriction",
    "Forecast", "Hold", "LimitSurface", "Map", "Odds", "Push", "Result", "Run", "Sample", "Source",
    "States", "StopMap", "StopSample", "Stops", "Trajectory",
]  # fmt: skip

__getattr__, __dir__ = lazily(__name__)
