"""The picture of a measured trade-off: error against cost, log-log, with the front drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from puck_tables.accuracy.method_errors import MeasuredMethod, pareto
from puck_tables.plot.style import BLUE, COLORS, GREY, canvas
from puck_tables.plot.titles import titled
from puck_tables.tradeoff.measurement import TradeOff

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.transforms import Bbox

_TITLES = {
    "resultants": "three resultants at a scattered point",
    "stop": "stop of a launch (time and place)",
    "state": "state at a moment",
    "box": "stop of a box",
    "box, friction falls with speed": "stop of a box whose friction falls with the slip speed",
    "curling stone": "stop of a curling stone on its running band",
}
_LOWEST = 1e-16  # the least error drawn, rounding: a logarithm has no 0
_PAPER = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.4}
_PIXELS = 100.0 / 72.0  # of a point, as long as the figure is not saved
_MORE_COLORS = (*COLORS, "#7a5c00", "#00838a", "#a0527a", "#4f4f9a", "#6a8f00")


def draw(measured: TradeOff) -> Figure:
    """Error against cost for every method: one panel a question, one line a kind of method.

    Every point bears its setting, every method its name; the thick grey line is the front, hollow
    points are outsiders.
    """
    figure = canvas(13.0, 27.0)
    grid = figure.add_gridspec(len(_TITLES), 1, height_ratios=(1.0, 1.35, *[0.75] * 4))
    for row, question in enumerate(_TITLES):
        draw_on(figure.add_subplot(grid[row]), measured, question)
    titled(
        figure,
        f"error against cost: {measured.machine['processor']}, one thread, "
        f"medians of {measured.repeats} rounds",
    )
    return figure


def draw_on(axes: Axes, measured: TradeOff, question: str = "stop") -> None:
    """One question alone."""
    group = [one for one in measured.methods if one.question == question]
    _draw(axes, _TITLES[question], group)


def _draw(axes: Axes, title: str, group: list[MeasuredMethod]) -> None:
    best = pareto(one for one in group if not one.outsider)
    axes.plot(
        [_error(one) for one in best], [one.ns for one in best],
        color="#d5d5d5", linewidth=9.0, solid_capstyle="round", zorder=1, label="the front",
    )  # fmt: skip
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(300.0 * max(map(_error, group)), 0.01 * min(map(_error, group)))
    axes.set_ylim(0.3 * min(one.ns for one in group), 6.0 * max(one.ns for one in group))
    methods = list(dict.fromkeys(one.method for one in group))
    taken: list[Bbox] = []
    for number, method in enumerate(methods):
        own = [one for one in group if one.method == method]
        color = GREY if own[0].outsider else _MORE_COLORS[number % len(_MORE_COLORS)]
        error, cost = [_error(one) for one in own], [one.ns for one in own]
        axes.plot(
            error, cost, color=color, linewidth=1.0, marker="o", markersize=4.5, zorder=3,
            markerfacecolor="white" if own[0].outsider else color,
            linestyle="--" if own[0].outsider else "-",
        )  # fmt: skip
        for one in own:
            axes.annotate(
                _short(one.setting), (_error(one), one.ns), xytext=(0, -9 if number % 2 else 4),
                fontsize=5.5, textcoords="offset points", ha="center", color=color, zorder=4,
            )  # fmt: skip
        _name(axes, method, own, color, taken)
    axes.set(xlabel="worst error (left: rough, right: exact)", ylabel="ns for one")
    axes.set_title(title, fontsize=11, color=BLUE, loc="left")
    axes.grid(color="#eeeeee", linewidth=0.6)
    axes.legend(frameon=False, loc="upper left", fontsize=8)


def _name(
    axes: Axes, method: str, own: list[MeasuredMethod], color: str, taken: list[Bbox]
) -> None:
    """The name of a method near its line, where no other name stands; boxes in pixels."""
    from matplotlib.transforms import Bbox

    width, height = 5.4 * len(method), 11.0
    ends = sorted(own, key=_error)
    places = [(ends[-1], -width - 8.0, -3.0), (ends[0], 8.0, -3.0)]
    spots = places + [
        (one, dx, dy)
        for dy in (7.0, 19.0, -24.0, 31.0, -36.0, 43.0)
        for one in (ends[-1], ends[0], ends[len(ends) // 2])
        for dx in (0.0, -width)
    ]
    for one, dx, dy in spots:
        x, y = axes.transData.transform((_error(one), one.ns))
        left, low = x + _PIXELS * dx, y + _PIXELS * dy
        box = Bbox.from_bounds(left, low, _PIXELS * width, _PIXELS * height)
        inside = box.x0 >= axes.bbox.x0 and box.x1 <= axes.bbox.x1
        if inside and not box.count_overlaps(taken):
            break
    taken.append(box)
    axes.annotate(
        method, (_error(one), one.ns), xytext=(dx, dy), textcoords="offset points", bbox=_PAPER,
        fontsize=8, color=color, zorder=2, weight="bold",
    )  # fmt: skip


def _error(one: MeasuredMethod) -> float:
    return max(one.error, _LOWEST) if np.isfinite(one.error) else 1.0


def _short(setting: str) -> str:
    """The numbers of a setting."""
    return " ".join(part.split("=")[1] for part in setting.split())
