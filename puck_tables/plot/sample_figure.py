"""Picture of samples: where they end, as a density, and how long it takes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.colours import on_white
from puck_tables.bulk.summary import Summary
from puck_tables.io.columns import COLUMNS
from puck_tables.plot.board_parts import draw_painted, painted_on
from puck_tables.plot.style import BLUE, GREY, ORANGE, canvas, colour_bar, no_rounding
from puck_tables.plot.titles import legend_below, noted, titled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FINE = 160  # cells along each side of the map
_WIDTHS = (1, 2, 3, 4, 6, 8, 11, 16)  # of these cells: deviations of what smooths samples
_NEAR, _SHARE = 800.0, 0.125  # samples that it takes together, at least; of all of them
_COVERED = 0.02  # of the largest density: where there is less, each sample is drawn
_TAIL, _ALONE = 5e-4, 1.5  # of the samples beyond each side of the map; samples, at least
HELD = 0.95  # of the samples inside the outer line
_HELD = (HELD, 0.5)
_FLAT = 2e-3  # a cloud thinner than this over its length is seen as a line
_FEW = 50  # samples have no density
_EDGE = 0.01  # of the side of a map, between it and a word
_ROUND = 97  # corners of a disc's outline
_LIGHT = 0.15  # of the ramp: less is not seen on white
_SHARES = (0.025, 0.5, 0.975)  # of the samples: the median, and what 95 % lie between


class Cloud(NamedTuple):
    """Where samples end, as a density over cells that lie along the cloud.

    ``corners``: x and y of the cells' corners, (2, n + 1, n + 1) m; ``density`` (n, n) 1/m²;
    ``at_samples``: the density at each sample, 1/m², 0 outside.
    """

    corners: FloatArray
    density: FloatArray
    at_samples: FloatArray

    @property
    def middles(self) -> FloatArray:
        """X and y of the middles of the cells, (2, n, n) m."""
        at = self.corners
        return np.asarray(
            0.25 * (at[:, 1:, 1:] + at[:, :-1, 1:] + at[:, 1:, :-1] + at[:, :-1, :-1])
        )


def draw(samples: Any) -> Figure:
    """The density of the ends, with the lines that hold 50 and 95 %; two histograms beside it."""
    figure = canvas(11.0, 5.6)
    grid = figure.add_gridspec(2, 3)
    draw_on(figure.add_subplot(grid[:, :2]), samples)
    for n, name in enumerate(samples.shown):
        _histogram(figure.add_subplot(grid[n, 2]), samples, name)
    lost = np.size(samples.counted(samples.place[0])) - samples.ended
    without = f" and {lost} without an end" if lost else ""
    whose = f" of {samples.whose}" if getattr(samples, "whose", "") else ""  # of several pucks
    titled(figure, f"{samples.ended} samples{whose}{without}: {samples.drawn_words}")
    return figure


def draw_on(panel: Axes, samples: Summary) -> None:
    """The density alone, and every sample where it is low."""
    x, y = (samples.counted(name) for name in samples.place)
    counts = np.isfinite(x) & np.isfinite(y)
    fallen = samples.ended - np.count_nonzero(counts)
    x, y = x[counts], y[counts]
    sides = [_sides(samples, name) for name in samples.place]
    (left, right), (low, high) = sides
    in_view = (x >= left) & (x <= right) & (y >= low) & (y <= high)
    x, y = x[in_view], y[in_view]
    cloud = cloud_of(x, y)
    bare = np.ones(x.size, np.bool_)
    if cloud is not None:
        bare = cloud.at_samples < _COVERED * float(cloud.density.max())
        _draw_density(panel, cloud)
    panel.plot(
        x[bare], y[bare], ".", color=on_white("#a8c4dc"), markersize=2.0,
        rasterized=True, zorder=1, label="single samples",
    )  # fmt: skip
    mean = samples.mean()
    panel.plot(*(mean[name] for name in samples.place), "+", color=ORANGE, label="mean", zorder=4)
    scene = getattr(samples, "scene", None)
    painted = [] if scene is None else painted_on(scene)
    draw_painted(panel, painted, 2.5)  # as the rings of a house, over the density
    panel.set(xlim=sides[0], ylim=sides[1])
    draw_regions(panel, samples)
    no_rounding(panel)
    panel.set(xlabel=COLUMNS[samples.place[0]].axis, ylabel=COLUMNS[samples.place[1]].axis)
    notes = ["x and y of different scale"]
    notes += [f"{fallen} of {samples.ended} samples left play"] if fallen else []
    if not in_view.all():
        notes.append(f"{np.count_nonzero(~in_view)} of {in_view.size} samples lie outside")
    noted(panel, "; ".join(notes))
    legend_below(panel, 5)


def draw_regions(panel: Axes, samples: Summary) -> None:
    """Outlines of the regions asked for, and of one puck the chance to end inside."""
    for number, region in enumerate(samples.regions):
        form = np.asarray(region, np.float64)
        if form.shape == (3,):
            turn = np.linspace(0.0, 2.0 * np.pi, _ROUND, endpoint=False)
            form = form[:2] + form[2] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        elif form.shape == (4,):
            form = form[[[0, 1], [2, 1], [2, 3], [0, 3]]]
        (x, y), label = form.T, "region" if number == 0 else None
        panel.fill(x, y, fill=False, color="black", linewidth=1.2, zorder=5, label=label)
        if not getattr(samples, "names", ()):
            low, high = panel.get_ylim()
            top, sides = high - _EDGE * (high - low), np.clip([x.min(), x.max()], *panel.get_xlim())
            panel.text(
                sides.mean(), min(y.max(), top), f"{100.0 * samples.chance(region).value:.3g} %",
                ha="center", va="bottom" if y.max() < top else "top", clip_on=True, zorder=5,
                bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 1.0},
            )  # fmt: skip


def _draw_density(panel: Axes, cloud: Cloud) -> None:
    """The density, and the lines inside which are 95 and 50 % of the samples."""
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap

    blues = ListedColormap(colormaps["Blues"](np.linspace(_LIGHT, 1.0, 256)))
    thick = np.ma.masked_less(cloud.density, _COVERED * float(cloud.density.max()))
    mesh = panel.pcolormesh(*cloud.corners, thick, cmap=blues, rasterized=True, zorder=2)
    colour_bar(panel, mesh, "density / m⁻²")
    levels = np.quantile(cloud.at_samples, [1.0 - held for held in _HELD])
    if not 0.0 < levels[0] < levels[1]:
        return
    colours = (GREY, ORANGE)
    panel.contour(
        *cloud.middles, cloud.density, levels=levels, colors=colours, linewidths=1.2, zorder=3
    )
    for held, colour in zip(_HELD, colours, strict=True):
        panel.plot([], [], color=colour, linewidth=1.2, label=f"holds {100 * held:.0f} %")


def cloud_of(x: FloatArray, y: FloatArray) -> Cloud | None:
    """The density of places (n,); None where they lie on a line or are too few.

    Cells lie along the axes of the cloud, in units of its deviations: a thin one has as many as a
    round one.  Samples are smoothed as far as it takes to have enough of them together.

    >>> x, y = np.random.default_rng(1).normal(size=(2, 10000))
    >>> thin = cloud_of(x + 1e-2 * y, x - 1e-2 * y)
    >>> inside = thin.at_samples > np.quantile(thin.at_samples, 0.5)
    >>> bool(abs(np.hypot(x, y)[inside].max() - 1.18) < 0.3)  # the ellipse that holds half of them
    True
    """
    if x.size < _FEW:
        return None
    places = np.stack([x, y])
    middle = places.mean(axis=1, keepdims=True)
    spread, axes = np.linalg.eigh(np.cov(places))
    if not spread[1] > 0.0 or not spread[0] > _FLAT**2 * spread[1]:
        return None
    frame = axes * np.sqrt(spread)  # columns: one deviation along each axis
    own = np.linalg.solve(frame, places - middle)
    tail = _tail(x.size)
    low, high = np.quantile(own, [tail, 1.0 - tail], axis=1)
    room = 0.15 * (high - low)
    edges = np.linspace(low - room, high + room, _FINE + 1).T
    counts = np.histogram2d(own[0], own[1], (edges[0], edges[1]))[0]
    enough = min(_NEAR, _SHARE * x.size)
    for width in _WIDTHS:
        smooth = _smoothed(counts, width)
        if 4.0 * np.pi * width**2 * float((counts * smooth).sum()) >= enough * x.size:
            break
    cell = np.prod(edges[:, 1] - edges[:, 0]) * np.sqrt(spread.prod())
    density = smooth / (x.size * cell)
    at = [np.searchsorted(row, one, "right") - 1 for row, one in zip(edges, own, strict=True)]
    inside = np.all([(one >= 0) & (one < _FINE) for one in at], axis=0)
    near = tuple(np.clip(at, 0, _FINE - 1))
    corners = np.tensordot(frame, np.stack(np.meshgrid(*edges, indexing="ij")), 1)
    return Cloud(corners + middle[:, :, None], density, np.where(inside, density[near], 0.0))


def _smoothed(counts: FloatArray, width: float) -> FloatArray:
    """Counts over cells, each spread by a normal distribution of this deviation, in cells."""
    cells = np.arange(_FINE) / width
    kernel = np.exp(-0.5 * (cells[:, None] - cells) ** 2) / (width * math.sqrt(2.0 * math.pi))
    return np.asarray(kernel @ counts @ kernel)


def _tail(count: int) -> float:
    """The share of the samples that may lie beyond each side; few are all shown."""
    return max(_TAIL, _ALONE / count) if count >= _FEW else 0.0


def _sides(samples: Summary, name: str) -> tuple[float, float]:
    """From where to where a map goes: all but a few samples far away."""
    tail = _tail(int(np.isfinite(samples.counted(name)).sum()))
    least, low, high, most = samples.quantiles((0.0, tail, 1.0 - tail, 1.0))[name].tolist()
    room = 0.1 * (high - low) or max(1e-3 * abs(low), 1e-9)
    near = 3.0 * room  # what is as near as this is shown too
    return (
        (least if least > low - near else low) - room,
        (most if most < high + near else high) + room,
    )


def _histogram(panel: Axes, samples: Any, name: str) -> None:
    values = samples.counted(name)
    values = values[np.isfinite(values)]
    low, high = float(values.min()), float(values.max())
    largest = max(abs(low), abs(high))
    # values may all be one
    room = 0.0 if high - low > 1e-6 * largest else max(0.05 * largest, 1e-9)
    panel.hist(values, bins=60, range=(low - room, high + room), color=BLUE, density=True)
    for share, value in zip(_SHARES, samples.quantiles(_SHARES)[name].tolist(), strict=True):
        panel.axvline(value, color=ORANGE, linewidth=1.0, linestyle="-" if share == 0.5 else "--")
    panel.set_xlabel(COLUMNS[name].axis)
    panel.set_yticks([])
