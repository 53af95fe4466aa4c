"""Picture of samples: where they end, as a density, and how long it takes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.bulk.summary import Summary
from puck_tables.io.columns import COLUMNS
from puck_tables.plot.style import BLUE, GREY, ORANGE, canvas, titled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FEWEST, _MOST, _PER_BIN = 12, 120, 40.0
_TAIL = 5e-4  # of the samples beyond each side of the map
_HELD = (0.95, 0.5)  # of the samples inside the lines
_WIDE = 2.0  # cells: lines about anything narrower are but noise
_SHARES = (0.025, 0.5, 0.975)


def draw(samples: Any) -> Figure:
    """The density of the ends, with the lines that hold 50 and 95 %; two histograms beside it."""
    figure = canvas(11.0, 5.6)
    grid = figure.add_gridspec(2, 3)
    draw_on(figure.add_subplot(grid[:, :2]), samples)
    for n, name in enumerate(samples.shown):
        _histogram(figure.add_subplot(grid[n, 2]), samples, name)
    titled(figure, f"{samples.ended} samples: {samples.drawn_words}")
    return figure


def draw_on(panel: Axes, samples: Summary) -> None:
    """The density alone."""
    across, along, density = samples.density(_bins(samples.ended), _extent(samples))
    shown = np.ma.masked_equal(density.T, 0.0)
    mesh = panel.pcolormesh(across, along, shown, cmap="Blues", rasterized=True)
    figure = panel.get_figure(root=True)
    assert figure is not None
    figure.colorbar(mesh, ax=panel, label="density / m⁻²")
    middles = [0.5 * (edges[1:] + edges[:-1]) for edges in (across, along)]
    area = (across[1] - across[0]) * (along[1] - along[0])
    levels = levels_holding(density, area)
    if len(levels) == len(_HELD) and _width(density >= levels[1]) > _WIDE:
        lines = panel.contour(
            *middles, density.T, levels=levels, colors=[GREY, ORANGE], linewidths=1.2
        )
        words = {level: f"{100 * held:.0f} %" for level, held in zip(levels, _HELD, strict=True)}
        panel.clabel(lines, fmt=words, fontsize=8)
    mean = samples.mean()
    panel.plot(*(mean[name] for name in samples.place), "+", color=ORANGE, label="mean")
    panel.legend(frameon=False, fontsize=9, loc="upper right")
    panel.set_xlabel(COLUMNS[samples.place[0]].axis)
    panel.set_ylabel(COLUMNS[samples.place[1]].axis)


def levels_holding(density: FloatArray, area: float) -> list[float]:
    """Densities above which 95 and 50 % of the samples lie, ascending; none if they are one.

    Examples
    --------
    >>> levels_holding(np.array([[0.1, 0.3], [0.6, 0.0]]), 1.0)
    [0.1, 0.6]
    """
    falling = np.sort(density.ravel())[::-1]
    held = np.cumsum(falling) * area
    places = np.minimum(np.searchsorted(held, _HELD), falling.size - 1)
    levels: list[float] = falling[places].tolist()
    return levels if 0.0 < levels[0] < levels[1] else []


def _width(inside: npt.NDArray[np.bool_]) -> float:
    """How many cells wide an area is in the mean, however it lies."""
    return float(inside.sum() / max(inside.any(axis=0).sum(), inside.any(axis=1).sum()))


def _bins(count: int) -> int:
    return int(np.clip(np.sqrt(count / _PER_BIN), _FEWEST, _MOST))


def _extent(samples: Summary) -> list[float]:
    shares = samples.quantiles((0.0, _TAIL, 1.0 - _TAIL, 1.0))
    extent = []
    for name in samples.place:
        least, low, high, most = shares[name].tolist()
        room = 0.1 * (high - low) or max(1e-3 * abs(low), 1e-9)
        extent += [max(least, low - room), min(most, high + room)]
        if not extent[-1] > extent[-2]:
            extent[-2:] = [low - room, high + room]
    return extent


def _histogram(panel: Axes, samples: Any, name: str) -> None:
    values = np.asarray(getattr(samples, name)).ravel()
    panel.hist(values[np.isfinite(values)], bins=60, color=BLUE, density=True)
    for share, value in zip(_SHARES, samples.quantiles(_SHARES)[name].tolist(), strict=True):
        panel.axvline(value, color=ORANGE, linewidth=1.0, linestyle="-" if share == 0.5 else "--")
    panel.set_xlabel(COLUMNS[name].axis)
    panel.set_yticks([])
