"""A comparison as one page for any browser: its words, its numbers and its picture."""

from __future__ import annotations

import math
from html import escape

from puck_tables.io.columns import COLUMNS
from puck_tables.plot.comparison_figure import draw
from puck_tables.plot.html_page import bullets, document, svg_of, table
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
    rows = result.rows()
    names = list(rows[0])
    last = states_of(answer([result.end_time]), result.puck)
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
