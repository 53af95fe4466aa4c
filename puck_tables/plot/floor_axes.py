"""The floor of a scene on axes: strips and patches of friction, and how it moves."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from puck_tables.plot.style import GREY
from puck_tables.scene.floor_parts import Friction, frictions_on, largest_of
from puck_tables.scene.floor_patches import corners_of
from puck_tables.scene.parts import Floor, Orthotropic

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ARROWS = (9, 5)  # of a moving floor, across and up
_MOVING = "#6f97b8"


class Box(NamedTuple):
    """What is in sight, m."""

    left: float
    right: float
    low: float
    high: float


class Shade(NamedTuple):
    """A part of the floor of one friction: a polygon, or without corners a circle, m; its colour.

    ``patch``: whether it lies on others; ``said``: what its friction is, in words.
    """

    friction: float
    corners: list[tuple[float, float]]
    centre: tuple[float, float]
    radius: float
    colour: tuple[float, float, float]
    patch: bool
    said: str


def draw_floor(axes: Axes, floor: Floor, box: Box, highest: float) -> None:
    """All of it that is seen in a box; ``highest``: the largest friction, the darkest patch."""
    from matplotlib.patches import Circle, Polygon

    labels: set[tuple[bool, str]] = set()
    for shade in shades_of(floor, box, highest):
        key = (shade.patch, shade.said)
        label: dict[str, Any] = {} if key in labels else {"label": shade.said}
        labels.add(key)
        style: dict[str, Any] = {
            "facecolor": shade.colour, "edgecolor": GREY, "linewidth": 0.8,
            "zorder": 1 if shade.patch else 0, **label,
        }  # fmt: skip
        axes.add_patch(
            Polygon(shade.corners, **style)
            if shade.corners
            else Circle(shade.centre, shade.radius, **style)
        )
    _draw_motion(axes, floor, box)


def shades_of(floor: Floor, box: Box, highest: float) -> list[Shade]:
    """Strips as far as a box shows them, and patches; the darker the more friction.

    >>> from puck_tables import Patch
    >>> wet = Floor(patches=[Patch(0.1, radius=1.0)])
    >>> [shade.radius for shade in shades_of(wet, Box(-1.0, 1.0, -1.0, 1.0), 0.2)]
    [1.0]
    """
    shades = _strips(floor, box)
    frictions = frictions_on(floor, 0.0)[-len(floor.patches) :] if floor.patches else []
    for patch, own in zip(floor.patches, frictions, strict=True):
        friction = largest_of(own, 0.0)
        share = friction / (highest or 1.0)
        colour = (0.86 - 0.5 * share, 0.93 - 0.4 * share, 0.98 - 0.25 * share)
        corners: Any = list(map(tuple, corners_of(patch).tolist()))
        said = _said(own)
        shades.append(Shade(friction, corners, patch.centre, patch.radius, colour, True, said))
    return shades


def _said(own: Friction) -> str:
    """The friction of a stretch in words."""
    if isinstance(own, Orthotropic):
        law: Any = own.law
        along, across = (one * (law.largest(0.0) if law else 1.0) for one in own.friction)
        return f"f = {along:g} along, {across:g} across{' at rest' if law else ''}"
    return f"f = {largest_of(own, 0.0):g}{'' if isinstance(own, float) else ' at rest'}"


def _strips(floor: Floor, box: Box) -> list[Shade]:
    """Strips of different friction."""
    strips = floor.strips
    if strips is None:
        return []
    across = (math.cos(strips.direction), math.sin(strips.direction))
    middle = ((box.left + box.right) / 2, (box.low + box.high) / 2)
    half = math.hypot(box.right - box.left, box.high - box.low)
    centre = across[0] * middle[0] + across[1] * middle[1]
    along = across[0] * middle[1] - across[1] * middle[0]
    ends = [centre - half, *strips.borders, centre + half]
    frictions = frictions_on(floor, 0.0)[: len(strips.friction)]
    at_rest = [largest_of(one, 0.0) for one in frictions]
    highest, result = max(at_rest) or 1.0, []
    for low, high, friction, one in zip(ends, ends[1:], at_rest, frictions, strict=False):
        low, high = max(low, centre - half), min(high, centre + half)
        if low >= high:
            continue
        corners = [
            (s * across[0] - t * across[1], s * across[1] + t * across[0])
            for s, t in ((low, along - half), (high, along - half), (high, along + half),
                         (low, along + half))
        ]  # fmt: skip
        shade = 0.97 - 0.22 * friction / highest
        grey = (shade, shade, shade)
        result.append(Shade(friction, corners, (0.0, 0.0), 0.0, grey, False, _said(one)))
    return result


def motion_said(floor: Floor) -> str:
    """How a floor moves, in words; nothing of one that rests.

    >>> motion_said(Floor(velocity=(0.3, 0.0)))
    'floor: belt (0.3, 0) m/s'
    """
    words = []
    if any(floor.velocity):
        words.append(f"belt ({floor.velocity[0]:g}, {floor.velocity[1]:g}) m/s")
    if floor.turning != 0.0:
        words.append(f"turntable {floor.turning:g} rad/s")
    return "floor: " + ", ".join(words) if words else ""


def _draw_motion(axes: Axes, floor: Floor, box: Box) -> None:
    """Arrows of a moving floor, and the centre of a turntable."""
    words = motion_said(floor)
    if not words:
        return
    across, up = _ARROWS
    x, y = np.meshgrid(
        np.linspace(box.left, box.right, 2 * across + 1)[1::2],
        np.linspace(box.low, box.high, 2 * up + 1)[1::2],
    )
    vx = floor.velocity[0] - floor.turning * (y - floor.centre[1])
    vy = floor.velocity[1] + floor.turning * (x - floor.centre[0])
    fastest = float(np.hypot(vx, vy).max())
    cell = (box.right - box.left) / across
    axes.quiver(
        x, y, vx, vy, color=_MOVING, angles="xy", scale_units="xy",
        scale=fastest / (0.7 * cell), width=0.003, zorder=1,
    )  # fmt: skip
    axes.plot([], [], color=_MOVING, marker=">", label=words)
    if floor.turning != 0.0:
        axes.plot(
            *floor.centre, "+", color="#4a7fa8", markersize=12, markeredgewidth=1.6, zorder=2,
            linestyle="", label="centre of the turntable",
        )  # fmt: skip
