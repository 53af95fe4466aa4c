"""Picture of a run: of one puck its plane, speeds and energies; of several all their ways."""

from __future__ import annotations

from typing import TYPE_CHECKING

from puck_tables.plot import pucks_figure, scene_figure
from puck_tables.scene.run import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(run: Run) -> Figure:
    """The whole motion, whatever states the run has: it is run again."""
    return pucks_figure.draw(run) if run.scene.pucks else scene_figure.draw(run)


def draw_on(axes: Axes, run: Run) -> None:
    """The plane or the board alone."""
    (pucks_figure if run.scene.pucks else scene_figure).draw_on(axes, run)
