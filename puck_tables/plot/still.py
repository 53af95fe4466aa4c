"""A board as it is at one moment, as an array of colours, or in a window."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.plot.animation import at_start
from puck_tables.plot.board import draw_board, draw_body, show, size_of
from puck_tables.plot.style import canvas
from puck_tables.scene.scene_spec import SceneSpec

_SHARE = 0.5  # of the size of a figure: pictures are 500 dots wide or so


def picture(
    scene: SceneSpec, states: FloatArray, in_play: npt.NDArray[np.bool_]
) -> npt.NDArray[np.uint8]:
    """The board with its pucks in states (pucks, 6), array (height, width, 3).

    What is shown is what the scene covers at its start, whatever the states: all pictures of a
    scene have one size.

    Raises MissingExtraError if matplotlib is not installed.

    >>> from puck_tables import Scene
    >>> world = Scene.load("crokinole").world()
    >>> picture(world.scene, world.state(), world.in_play).shape[2]
    3
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    film = at_start(scene)
    wide, high = size_of(film.box)
    figure = canvas(_SHARE * wide, _SHARE * high)
    figure.set_layout_engine("none")
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    draw_board(axes, film)
    for body, state, there in zip(film.bodies, states, in_play, strict=True):
        if there:
            draw_body(axes, body, *state[:3].tolist())
    show(axes, film.box)
    axes.axis("off")
    drawn: Any = FigureCanvasAgg(figure)
    drawn.draw()
    return np.asarray(drawn.buffer_rgba())[:, :, :3].copy()


def shown_in_window(drawn: npt.NDArray[np.uint8]) -> None:
    """Show a picture in a window that stays, and takes the next one."""
    from matplotlib import pyplot

    figure: Any = pyplot.figure("puck-tables", clear=True)
    figure.figimage(drawn, resize=True)
    pyplot.pause(1e-3)
