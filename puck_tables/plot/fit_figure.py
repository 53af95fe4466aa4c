"""Picture of a fit: the tracks and the motion found, what is left, and how sure the numbers are."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial.polynomial import polyval

from puck_tables._core.monotone import monotone_cubic
from puck_tables.fitting.fit_result import Fit
from puck_tables.fitting.fit_spec import NODES
from puck_tables.fitting.forward_model import states_of
from puck_tables.plot.style import BLUE, COLORS, GREY, LAUNCH, ORANGE, RED, canvas
from puck_tables.plot.titles import legend_below, titled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_POINTS = 9  # of a profile curve
_REACH = 3.0  # standard errors to either side of it
_FINE = 400  # points of a curve: smooth at any size of print
_UNSEEN = 1e-4  # of a number: what parts less is drawn from the number on
_NARROW = 5.0  # times as long as wide: a path that is shown in scales of its own


def draw(result: Fit) -> Figure:
    """Paths, residuals over time, pulls, and profile curves of the puck's numbers."""
    free = result.estimate.problem.spec.free
    names = [n for n in free if result.numbers[n].determined]
    figure = canvas(11.0, 7.0)
    grid = figure.add_gridspec(2, 6)
    draw_on(figure.add_subplot(grid[0, :3]), result)
    _draw_residuals(figure.add_subplot(grid[0, 3:]), result)
    _draw_pulls(figure.add_subplot(grid[1, :2]), result)
    if names:
        speeds = result.estimate.problem.spec.speeds
        # friction over slip speed has a panel of its own, for all of its numbers
        shown = [name for name in names if not (speeds and name in NODES)][:3]
        shown = (shown or names)[: 2 if speeds else 3]
        inner = grid[1, 2:].subgridspec(1, len(shown) + bool(speeds))
        if speeds:
            _draw_friction(figure.add_subplot(inner[0, len(shown)]), result)
        for n, name in enumerate(shown):
            _draw_profile(figure.add_subplot(inner[0, n]), result, name)
    lines = [f"{name} = {result.numbers[name].written.replace('+-', '±')}" for name in names]
    lines += [f"{name} is not determined" for name in free if name not in names]
    titled(
        figure,
        "; ".join(
            [*lines, f"chi² per degree of freedom {result.chi2 / max(result.degrees, 1):.3g}"]
        ),
    )
    return figure


def draw_on(paths: Axes, result: Fit) -> None:
    """The paths alone."""
    problem, x = result.estimate.problem, result.estimate.x
    moving, (slides, hits) = problem.moving(problem.numbers_at(x)), problem.slides(x)
    whole, labels = {film.name: film for film in result.uncut}, set[str]()

    def once(words: str) -> str | None:
        """A label, if nothing bears it yet."""
        new = words not in labels
        labels.add(words)
        return words if new else None

    for n, (film, track) in enumerate(zip(problem.films, slides, strict=True)):
        if (before := whole.get(film.name)) is not None:
            foreign = (before.frame < film.frame[0]) | (before.frame > film.frame[-1])
            if foreign.any():
                paths.plot(
                    *before.place[foreign].T, "+", color=GREY, markersize=5,
                    label=once("cut off"),
                )  # fmt: skip
        counts = result.estimate.kept[problem.each()[n][0]]
        colour = COLORS[n % len(COLORS)]
        paths.plot(
            *film.place[counts].T, "o", color=colour, markersize=4, fillstyle="none",
            markeredgewidth=0.6,
            label=film.name if 1 < len(problem.films) <= len(COLORS) else None,
        )  # fmt: skip
        if not counts.all():
            paths.plot(
                *film.place[~counts].T, "x", color=RED, markersize=5,
                label=once("left out"),
            )  # fmt: skip
        ends = [slide.since - track[0].since for slide in track] + [float(film.time[-1])]
        for slide, (start, stop) in zip(track, pairwise(ends), strict=True):
            fine = np.linspace(0.0, max(stop - start, 0.0), _FINE)
            paths.plot(*states_of(moving, slide.launch, fine)[:2], color=colour, linewidth=0.8)
        paths.plot(*track[0].launch[:2], **LAUNCH)
    for impact in hits:
        paths.plot(
            *impact.place, "o", color=GREY, markersize=7, fillstyle="none", label=once("impact")
        )
    films = "" if len(problem.films) <= len(COLORS) else f" of {len(problem.films)} films"
    title = f"seen (rings) and found (lines){films}"
    paths.set(xlabel="x / m", ylabel="y / m", title=title)
    wide, high = (np.ptp(ends) for ends in (paths.get_xlim(), paths.get_ylim()))
    if max(wide, high) < _NARROW * min(wide, high):  # else a narrow path would be a line
        paths.set_aspect("equal", adjustable="datalim")
    else:
        paths.set_title(f"{title}\nx and y of different scale")
    legend_below(paths)


def _draw_residuals(panel: Axes, result: Fit) -> None:
    """What was seen less the model, over the time since the launch."""
    estimate = result.estimate
    shown = np.clip(-estimate.residuals, -6.0, 6.0)
    for film, parts in zip(estimate.problem.films, estimate.problem.each(), strict=True):
        times = [film.time, film.time]
        if film.angle is not None:
            times.append(film.time[np.isfinite(film.angle)])
        weighed = bool(estimate.problem.weights)
        labels = ("along", "across", "angle") if weighed else ("x", "y", "angle")
        for time, part, colour, label in zip(times, parts, COLORS, labels, strict=False):
            first = film is estimate.problem.films[0]
            panel.plot(
                time, shown[part], ".", color=colour, markersize=3,
                label=label if first else None,
            )  # fmt: skip
    panel.axhline(0.0, color=GREY, linewidth=0.8)
    panel.set(
        xlabel="time since the launch / s",
        ylabel="residual / noise (to 6)",
        ylim=(-6.5, 6.5),
        title=f"what is left; chance of such a pattern {min(result.runs, result.drift):.2g}",
    )
    legend_below(panel)


def _draw_pulls(panel: Axes, result: Fit) -> None:
    """How often residuals have each size, beside the normal distribution."""
    in_view = result.estimate.problem.kinds < 2
    pulls = np.clip(-result.estimate.residuals[in_view], -6.0, 6.0)
    edges = np.linspace(-6.0, 6.0, 37)
    panel.hist(pulls, edges.tolist(), density=True, color=BLUE, alpha=0.6)
    z = np.linspace(-6.0, 6.0, 200)
    panel.plot(z, np.exp(-0.5 * z * z) / math.sqrt(2.0 * math.pi), color=ORANGE)
    panel.set(xlabel="residual / noise", ylabel="density", title=f"{pulls.size} residuals")


def _draw_friction(panel: Axes, result: Fit) -> None:
    """The friction coefficient over slip speed, with its 95 % band."""
    nodes, values, errors = result.friction_over()
    fine, value, error = result.friction_over(np.linspace(0.0, float(nodes[-1]), 200))
    wide = result.certainty.quantile * error
    panel.fill_between(fine, value - wide, value + wide, color=BLUE, alpha=0.25, linewidth=0.0)
    panel.plot(fine, value, color=BLUE)
    panel.errorbar(nodes, values, result.certainty.quantile * errors, fmt="o", color=BLUE)
    panel.set(xlabel="slip speed / m/s", title="friction, 95 %")


def _draw_profile(panel: Axes, result: Fit, name: str) -> None:
    """By how much χ² rises when one number is held elsewhere."""
    k = result.estimate.problem.spec.free.index(name)
    values, rises = result.profile(name, _POINTS, _REACH)
    number, known_to = result.numbers[name], ""
    if values[-1] - values[0] < _UNSEEN * abs(number.value):  # axes would not part them
        known_to = number.written.partition(" ")[0]
    shift = float(known_to or 0.0)
    values = values - shift
    fine = np.linspace(values[0], values[-1], 100)
    panel.plot(values, rises, "o", color=BLUE, markersize=3)
    ascend = (np.diff(values) > 0.0).all()
    powers = monotone_cubic(values, rises) if ascend else rises[:1, None]
    part = np.clip(np.searchsorted(values, fine, "right") - 1, 0, len(powers) - 1)
    panel.plot(fine, polyval(fine - values[part], powers[part].T, tensor=False), color=BLUE)
    error = float(result.certainty.errors[k])
    if math.isfinite(error):
        panel.plot(fine, ((fine + shift - number.value) / error) ** 2, ":", color=GREY)
    panel.axhline(result.certainty.quantile**2, color=ORANGE, linewidth=0.8)
    for end in (number.low, number.high):
        panel.axvline(end - shift, color=ORANGE, linewidth=0.8)
    unit = "" if number.unit == "1" else f" / {number.unit}"
    from_there = f"{name} - {known_to}" if known_to else name
    words = f"({from_there}){unit}" if known_to and unit else f"{from_there}{unit}"
    panel.set(xlabel=words, title="rise of chi²")
    panel.tick_params(axis="x", labelrotation=30)
    panel.ticklabel_format(axis="x", useOffset=False)
