"""A fit as one page for a class: pictures, numbers, residuals, what was assumed, and blanks.

It loads nothing, needs no server, and is made to be printed.
"""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from puck_tables.fitting.fit_result import Fit
from puck_tables.fitting.numbers import Number
from puck_tables.plot.fit_figure import draw
from puck_tables.plot.html_page import bullets, document, svg_of, table
from puck_tables.plot.style import BLUE, COLORS, canvas

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_ROWS = 16  # of measured points: as many as a class copies
_STYLE = (
    "body{font:16px/1.5 system-ui,sans-serif;max-width:52em;margin:2em auto;padding:0 1em;"
    "color:#111;background:#fff}table{border-collapse:collapse;font-size:14px;margin:.5em 0}"
    "td,th{border:1px solid #767676;padding:.2em .6em;text-align:right;height:1.5em}"
    "td:first-child,th:first-child{text-align:left}svg{max-width:100%;height:auto}"
    ".blank{display:inline-block;min-width:9em;border-bottom:1px solid #111}"
    ".wide{display:block;height:1.9em;border-bottom:1px solid #767676}"
    ".found{font-size:1.15em;font-weight:600}figure{margin:1em 0}"
    "@media print{body{margin:0;font-size:11pt}h2{break-after:avoid}"
    "table,figure,li{break-inside:avoid}}"
)


def page(result: Fit) -> str:
    """The page as HTML."""
    names = ", ".join(film.name for film in result.estimate.problem.films)
    title = f"Friction of a puck: {names}"
    return document(title, _STYLE, [
        f"<h1>{escape(title)}</h1>",
        f"<p>Name {_blank()} Class {_blank()} Date {_blank()}</p>",
        f"<p class='found'>{escape(_first(result))}</p>",
        _pictures(result), _numbers(result), _left(result), _assumed(result), _laws(result),
        _class(result),
    ])  # fmt: skip


def _first(result: Fit) -> str:
    """What was found of friction, in a sentence."""
    if result.astray:
        return f"{result.astray}."
    friction = result.numbers["friction"]
    if not friction.determined:
        return "These tracks do not tell the friction."
    return (
        f"Friction coefficient f = {_written(friction)}: sliding without spin the puck loses "
        f"{result.numbers['decel'].value:.4g} m/s each second."
    )


def _pictures(result: Fit) -> str:
    return (
        "<h2>Pictures</h2>"
        + _figure(_speeds(result), "Speed over time",
                  "Speed over time, from each frame to the next (circles), and of the motion found "
                  "(line). Where nothing but friction acts on a slide the line is straight.")
        + _figure(draw(result), "Paths, residuals and likelihoods",
                  "Places and the path found; what is left of places and angles, frame by frame; "
                  "how often so much is left; how much worse other values would fit.")
    )  # fmt: skip


def _figure(figure: Figure, label: str, words: str) -> str:
    svg = svg_of(figure).replace("<svg", f"<svg role='img' aria-label='{label}'", 1)
    return f"<figure>{svg}<figcaption>{escape(words)}</figcaption></figure>"


def _speeds(result: Fit) -> Figure:
    """Speeds of each track over time: seen, and of the motion found."""
    problem, x = result.estimate.problem, result.estimate.x
    figure = canvas(8.0, 3.2)
    axes = figure.add_subplot()
    for n, (film, path) in enumerate(zip(problem.films, problem.paths(x), strict=True)):
        colour = COLORS[n % len(COLORS)]
        since, step = film.start + film.time, np.diff(film.time)
        middle = 0.5 * (since[1:] + since[:-1])
        seen, computed = (np.hypot(*np.diff(places)) / step for places in (film.place.T, path[:2]))
        axes.plot(middle, seen, "o", color=colour, markersize=3, fillstyle="none",
                  markeredgewidth=0.6)  # fmt: skip
        axes.plot(middle, computed, color=colour if n else BLUE, linewidth=1.5)
    axes.set(xlabel="time / s", ylabel="speed / (m/s)", ylim=(0.0, None))
    return figure


def _numbers(result: Fit) -> str:
    rows = [
        (_words(name, result), _written(number), number.interval or "–",
         {"found": "from the film", "follows": "follows", "known": "known"}[number.how])
        for name, number in result.numbers.items()
    ]  # fmt: skip
    launches = [
        (one.name, f"{math.hypot(*one.velocity):.4g}", _written(one.numbers["launch_spin"]))
        for one in result.launches
    ]
    return (
        "<h2>Numbers</h2>"
        + table(("number", "value", "95 of 100 times within", "where from"), rows)
        + table(("launch of", "speed / (m/s)", "spin"), launches)
    )


def _left(result: Fit) -> str:
    angled, by_chance = result.estimate.problem.angled, min(result.runs, result.drift)
    said = [
        f"A place is off by {1e3 * result.noise[0]:.3g} mm (standard deviation)"
        + (f", an angle by {math.degrees(result.noise[1]):.2g} degrees." if angled else "."),
        f"χ² is {result.chi2:.4g} for {result.degrees} degrees of freedom; "
        f"{100.0 * result.outliers:.2g} % of what was seen is left out as strays.",
        f"So much pattern in what is left comes by chance with a probability of {by_chance:.2g}.",
        *result.complaints,
    ]  # fmt: skip
    return f"<h2>What is left</h2>{bullets(said)}"


def _assumed(result: Fit) -> str:
    known = [
        f"{_words(name, result)}: {_written(number)}" for name, number in result.numbers.items()
        if number.how == "known"
    ]  # fmt: skip
    said = [
        "The table is level, hard and alike everywhere, and only friction (and what was found "
        "beside it) slows the puck.",
        "Friction does not depend on how hard a point is pressed; its coefficient is the same for "
        "all speeds unless a law was found.",
        f"How it touches the floor: {': '.join(result.contact)}.",
        *(f"Known, not found: {one}." for one in known),
        *result.remarks,
    ]
    lost = f"<h2>What the film does not tell</h2>{bullets(result.blind)}" if result.blind else ""
    return f"<h2>What was assumed</h2>{bullets(said)}{lost}"


def _laws(result: Fit) -> str:
    if not result.laws:
        return ""
    rows = [
        (one.name, f"{one.unknowns}", f"{one.chi2:.5g}", f"{one.weight:.2g}") for one in result.laws
    ]
    return f"<h2>Which floor</h2><p>{escape(result.verdict)}</p>" + table(
        ("model", "numbers found", "χ²", "weight"), rows
    )


def _class(result: Fit) -> str:
    """Points to copy and blanks to fill."""
    film = result.estimate.problem.films[0]
    chosen = np.unique(np.linspace(0, film.time.size - 1, _ROWS).round().astype(int))
    angled = film.angle is not None
    rows = []
    for n in chosen:
        row = [f"{film.start + film.time[n]:.4f}", *(f"{one:.4f}" for one in film.place[n])]
        row += [f"{film.angle[n]:.3f}"] if film.angle is not None else []
        rows.append((*row, "", ""))
    turned = ["angle / rad"] if angled else []
    head = ("t / s", "x / m", "y / m", *turned, "way / m", "speed / (m/s)")
    gravity = result.numbers["gravity"].value
    tasks = [
        f"Read the speed at the start from the first picture: v = {_blank()} m/s, and when the "
        f"puck stops, or would: t = {_blank()} s.",
        f"Of a slide without spin f = v/(g t), g = {gravity:g} m/s²: f = {_blank()}. "
        "(One that spins slides longer, so that this f is too small.)",
        f"Fill in the last two columns of the table for the first five rows, and say how much "
        f"speed is lost each second: {_blank()} m/s².",
        f"By how many of its errors is your f off from that of the fit? {_blank()} What would "
        f"make yours larger, or smaller? <span class='wide'></span>",
        f"Weigh and measure your puck: mass {_blank()} kg, radius {_blank()} mm, height "
        f"{_blank()} mm. Which of these should not matter for f? {_blank()}",
        "Look at what is left: is it noise, or is there a pattern? What may have made it? "
        "<span class='wide'></span><span class='wide'></span>",
        "Which of the assumptions would you test first, and how? <span class='wide'></span>"
        "<span class='wide'></span>",
    ]
    items = "".join(f"<li>{one}</li>" for one in tasks)
    return (
        f"<h2>For you to do</h2><p>Points of {escape(film.name)}:</p>{table(head, rows)}"
        f"<ol>{items}</ol>"
    )


def _words(name: str, result: Fit) -> str:
    known = result.estimate.problem.spec.parameters
    return f"{name.replace('_', ' ')} ({known[name].words})" if name in known else name


def _written(number: Number) -> str:
    """Value ± error and unit."""
    return number.written.replace("+-", "±") if number.determined else "not told"


def _blank() -> str:
    return "<span class='blank'>&nbsp;</span>"
