"""Picture of runs of an engine beside the exact answer: what they show, and their errors.

And a comparison as one page for any browser: its words, its numbers and its picture.
"""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables.io.columns import COLUMNS
from puck_tables.plot.html_page import bullets, document, svg_of, table
from puck_tables.plot.style import COLORS, GREY, canvas, labelled, no_rounding, shaded
from puck_tables.plot.titles import legend_below, noted, titled
from puck_tables.reference.case_text import lines_of
from puck_tables.reference.comparison import Comparison
from puck_tables.reference.floor_reaction import ratios, slip_over

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_STYLE = (
    "body{font:16px/1.5 system-ui,sans-serif;max-width:62em;margin:2em auto;padding:0 1em}"
    "table{border-collapse:collapse;font-size:14px}td,th{border:1px solid #ccc;padding:.2em .6em;"
    "text-align:right}td:first-child,th:first-child,.case td{text-align:left}"
    "svg{max-width:100%;height:auto}"
)
_POINTS = 600  # points of a curve: smooth at any size of print
_LABELLED = 8  # curves: a legend of more hides the picture
_EXACT: dict[str, Any] = {"color": "black", "linewidth": 1.6}


def page(result: Comparison) -> str:
    """The page as HTML."""
    case, answer = result.answer.case, result.answer
    rows = result.rows()
    names = list(rows[0])
    last = answer([result.end_time]).states_of(result.puck)
    which = f"The puck {escape(result.whose)}" if result.whose else "It "
    exact = f"{which}ends after {result.end_time:.12g} s ({escape(answer.end)})"
    exact += f" at ({last['x'][0]:.12g}, {last['y'][0]:.12g}) m"
    exact += f", known to {answer.time_bound:.1e} s and {answer.place_bound:.1e} m."
    met = escape(", ".join(map(str, result.thresholds)))
    return document(case.label, _STYLE, [
        f"<h1>{escape(case.title)}</h1><div class='case'>{table((), lines_of(answer).items())}",
        f"</div><p>{exact} Rest counts from {met} on.</p><h2>Errors</h2>",
        table(["file", *map(_titled, names)], [
            (run.log.name, *(_written(row[name]) for name in names))
            for run, row in zip(result.runs, rows, strict=True)
        ]),
        *(f"<h2>{head.capitalize()}</h2>{bullets(texts)}"
          for head, texts in result.remarks().items()),
        f"<h2>Picture</h2>{svg_of(draw(result))}",
    ])  # fmt: skip


def _titled(name: str) -> str:
    column = COLUMNS[name]
    return column.long_name + (f" / {column.unit}" if column.unit not in ("", "1") else "")


def _written(value: float) -> str:
    return f"{value:.5g}" if math.isfinite(value) else "–"


def draw(result: Comparison) -> Figure:
    """Paths, speeds and ε of runs and of the exact motion, and errors over time."""
    figure = canvas(11.0, 9.6)
    panels = figure.subplots(3, 2)
    draw_on(panels[0, 0], result)
    _draw_speeds(panels[0, 1], result)
    _draw_ratio(panels[1, 0], result)
    _draw_errors(panels[1, 1], result, "place", "error of the place / m")
    _draw_errors(panels[2, 0], result, "speed", "error of the velocity / m/s")
    _draw_errors(panels[2, 1], result, "spin", "error of the spin / rad/s")
    titled(figure, f"{result.answer.case.label}: {result.answer.case.title}")
    return figure


def _colours(result: Comparison) -> list[tuple[float, float, float] | str]:
    """Light to dark with a falling step."""
    count = len(result.runs)
    return [COLORS[0]] if count == 1 else [shaded(n / (count - 1)) for n in range(count)]


def _exact(result: Comparison) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    times = np.linspace(0.0, result.end_time, _POINTS)
    return times, result.answer(times).states_of(result.puck)


def draw_on(axes: Axes, result: Comparison) -> None:
    """The paths."""
    _, exact = _exact(result)
    axes.plot(exact["x"], exact["y"], label="exact", **_EXACT)
    for run, colour in zip(result.runs, _colours(result), strict=True):
        name = run.log.name if len(result.runs) <= _LABELLED else None
        axes.plot(run.log.x, run.log.y, color=colour, linewidth=1.0, label=name)
    no_rounding(axes)
    labelled(axes, "x / m", "y / m")
    if len(result.runs) > _LABELLED:
        noted(axes, f"{len(result.runs)} runs, the first light and the last dark")
    legend_below(axes)


def _draw_speeds(axes: Axes, result: Comparison) -> None:
    times, exact = _exact(result)
    radius = result.answer.pucks[result.puck or 0].radius
    speed, rim, _ = slip_over(result.answer.floor, exact).sizes(radius)
    axes.plot(times, speed, label="v over the floor", **_EXACT)
    axes.plot(times, rim, linestyle="--", label="r|ω|", **_EXACT)
    for run, colour in zip(result.runs, _colours(result), strict=True):
        if run.seen_speed is not None and run.seen_rim is not None:
            axes.plot(run.time, run.seen_speed, color=colour, linewidth=1.0)
            axes.plot(run.time, run.seen_rim, color=colour, linewidth=1.0, linestyle="--")
    _over_time(axes, result, "m/s")
    axes.legend(frameon=False, fontsize=8)


def _draw_ratio(axes: Axes, result: Comparison) -> None:
    times, exact = _exact(result)
    radius = result.answer.pucks[result.puck or 0].radius
    epsilon, _ = ratios(slip_over(result.answer.floor, exact), radius)
    axes.plot(times, epsilon, label="exact", **_EXACT)
    for run, colour in zip(result.runs, _colours(result), strict=True):
        if run.seen_epsilon is not None:
            axes.plot(run.time, run.seen_epsilon, color=colour, linewidth=1.0)
    limit, rest = result.answer.limit_epsilon, result.exact_rest
    if limit is not None and np.isfinite(limit):
        axes.axhline(limit, color=GREY, linewidth=0.8, label="limit at the stop")
    if rest is not None:
        axes.axvline(rest.time, color=GREY, linewidth=0.8, linestyle=":", label="threshold met")
    finite = epsilon[np.isfinite(epsilon)]
    if finite.size:
        top = 5.0 * float(np.median(finite))
        axes.set_ylim(0.0, 1.3 * min(float(finite.max()), top) or 1.0)
        if finite.max() > 1.3 * top:
            noted(axes, f"it goes up to {finite.max():.3g}")
    _over_time(axes, result, "ε = v/(rω)")
    axes.legend(frameon=False, fontsize=8)


def _draw_errors(axes: Axes, result: Comparison, name: str, label: str) -> None:
    drawn = False
    for run, colour in zip(result.runs, _colours(result), strict=True):
        row = getattr(run, name)
        if row is not None and (np.abs(row) > 0.0).any():
            axes.plot(run.time, np.abs(row), color=colour, linewidth=1.0)
            drawn = True
    if drawn:
        axes.set_yscale("log", nonpositive="mask")  # an error of 0 is no line downwards
    else:
        axes.text(0.5, 0.5, "none, or not in the file", ha="center", transform=axes.transAxes,
                  color=GREY)  # fmt: skip
    _over_time(axes, result, label)


def _over_time(axes: Axes, result: Comparison, label: str) -> None:
    axes.set_xlim(0.0, 1.15 * result.end_time)
    labelled(axes, "time / s", label)
