"""Picture of a run: of one puck its plane, speeds and energies; of a board all ways on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from puck_tables.plot import pucks, scene
from puck_tables.scene.run import Run

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(run: Run) -> Figure:
    """The whole motion, whatever states the run has: it is run again."""
    return pucks.draw(run) if run.scene.is_board else scene.draw(run)


def draw_on(axes: Axes, run: Run) -> None:
    """The plane or the board alone."""
    (pucks if run.scene.is_board else scene).draw_on(axes, run)
