"""The lines painted on the floor of a scene, on axes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from puck_tables.plot.style import GREY
from puck_tables.scene.scene_spec import SceneSpec

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ROUND = 97  # points of a round one


class Painted(NamedTuple):
    """A painted line: its colour, and the points that it goes through, m."""

    colour: str
    x: tuple[float, ...]
    y: tuple[float, ...]


def painted_on(scene: SceneSpec) -> list[Painted]:
    """All of them.

    Examples
    --------
    >>> from puck_tables import Line, Puck, Scene
    >>> painted_on(Scene(Puck(0.1), lines=[Line((0.0, 0.0), (0.0, 2.0))]))[0].y
    (0.0, 2.0)
    """
    found, turn = [], np.linspace(0.0, 2.0 * math.pi, _ROUND)
    for line in scene.lines:
        colour = line.colour or GREY
        if line.start is None or line.end is None:
            x = line.centre[0] + line.radius * np.cos(turn)
            y = line.centre[1] + line.radius * np.sin(turn)
            found.append(Painted(colour, tuple(x.tolist()), tuple(y.tolist())))
        else:
            x0, x1 = zip(line.start, line.end, strict=True)
            found.append(Painted(colour, x0, x1))
    return found


def draw_painted(axes: Axes, lines: list[Painted]) -> None:
    """All of them, labelled once."""
    for number, line in enumerate(lines):
        label = "line" if number == 0 else None
        axes.plot(line.x, line.y, color=line.colour, linewidth=1.1, zorder=0.9, label=label)
