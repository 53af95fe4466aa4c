"""A comparison as one page for any browser: its words, its numbers and its picture."""

from __future__ import annotations

import math
from html import escape

from puck_tables._version import __version__
from puck_tables.io.columns import COLUMNS
from puck_tables.plot.comparison_figure import draw
from puck_tables.plot.html_page import svg_of
from puck_tables.reference.case_text import lines_of
from puck_tables.reference.comparison import Comparison
from puck_tables.reference.threshold import states_of

_STYLE = (
    "body{font:16px/1.5 system-ui,sans-serif;max-width:62em;margin:2em auto;padding:0 1em}"
    "table{border-collapse:collapse;font-size:14px}td,th{border:1px solid #ccc;padding:.2em .6em;"
    "text-align:right}td:first-child,th:first-child,.case td{text-align:left}"
    "svg{max-width:100%;height:auto}"
)


def page(result: Comparison) -> str:
    """The page as HTML."""
    case, answer = result.answer.case, result.answer
    svg = svg_of(draw(result))
    rows = result.rows()
    names = list(rows[0])
    head = "".join(f"<th>{escape(_titled(name))}</th>" for name in names)
    body = "".join(
        f"<tr><td>{escape(run.log.name)}</td>"
        + "".join(f"<td>{_written(row[name])}</td>" for name in names) + "</tr>"
        for run, row in zip(result.runs, rows, strict=True)
    )  # fmt: skip
    lines = "".join(
        f"<tr><td>{escape(name)}</td><td>{escape(told)}</td></tr>"
        for name, told in lines_of(answer).items()
    )
    last = states_of(answer([result.end_time]), result.puck)
    which = f"The puck {escape(result.whose)}" if result.whose else "It "
    exact = f"{which}ends after {result.end_time:.12g} s ({escape(answer.end)})"
    exact += f" at ({last['x'][0]:.12g}, {last['y'][0]:.12g}) m"
    exact += f", known to {answer.time_bound:.1e} s and {answer.place_bound:.1e} m."
    fallen = "".join(
        f"<li>{escape(words)}: {escape(what)}</li>" for words, what in result.convergence().items()
    )
    untold = "".join(f"<li>{escape(one)}</li>" for one in result.untold())
    truths = "".join(f"<li>{escape(one)}</li>" for one in result.truths())
    met = escape(", ".join(map(str, result.thresholds)))
    return (
        f"<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'>"
        f"<title>{escape(case.label)}</title><style>{_STYLE}</style></head><body>"
        f"<h1>{escape(case.title)}</h1><table class='case'>{lines}</table><p>{exact} "
        f"Rest counts from {met} on.</p>"
        f"<h2>Errors</h2><table><tr><th>file</th>{head}</tr>{body}</table>"
        + (f"<h2>Not told</h2><ul>{untold}</ul>" if untold else "")
        + (f"<h2>As the step falls</h2><ul>{fallen}</ul>" if fallen else "")
        + (f"<h2>Truth and not error</h2><ul>{truths}</ul>" if truths else "")
        + f"<h2>Picture</h2>{svg}<p>Made by puck-tables {__version__}.</p></body></html>\n"
    )


def _titled(name: str) -> str:
    column = COLUMNS[name]
    return column.long_name + (f" / {column.unit}" if column.unit not in ("", "1") else "")


def _written(value: float) -> str:
    return f"{value:.5g}" if math.isfinite(value) else "–"
