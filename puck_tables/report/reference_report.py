"""What is told of benchmark cases, and of runs of engines beside them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from puck_tables.io.columns import COLUMNS
from puck_tables.reference.case_text import lines_of
from puck_tables.report.lines_and_tables import columns, listed

if TYPE_CHECKING:
    from puck_tables.reference.answer import Answer
    from puck_tables.reference.comparison import Comparison
    from puck_tables.reference.floor_reaction import FloorFriction

_ROWS = 20  # of friction that are shown
_SHORT = {
    "step": "step", "rest_time": "rests after", "rest_time_error": "its error",
    "stop_place_error": "stop off by", "place_error_max": "place off by",
    "speed_error_max": "v off by", "spin_error_max": "w off by", "epsilon_seen": "v/(r w)",
    "epsilon_error": "its error",
}  # fmt: skip


def report(answer: Answer) -> str:
    """A case and its answer."""
    lines = lines_of(answer)
    lines["frames"] = (
        f"{answer.time.size} from {answer.time.min():g} to {answer.time.max():.6g} s: -o FILE "
        "saves them, --json prints them"
    )
    return listed(lines, 12)


def friction_report(result: FloorFriction) -> str:
    """A few rows of force and torque over ε."""
    heads = {
        "v/(r w)": ".6g", "F along/fN": ".10f", "F across/fN": ".10f",
        "M/(fNr)": ".10f",
    }  # fmt: skip
    step = max(1, result.epsilon.size // _ROWS)
    rows = zip(
        *(values[::step] for values in (
            result.epsilon, result.share_along, result.share_across,
            result.share_torque,
        )), strict=True,
    )  # fmt: skip
    what = f"on the floor, fN = {result.load:.6g} N, r = {result.puck.radius:g} m"
    lines = [f"{result.case.label}: {what}", columns(heads, rows)]
    if step > 1:
        lines.append(
            f"one row in {step} of {result.epsilon.size}: -o FILE saves all, --json prints them"
        )
    return "\n".join(lines)


def comparison_report(result: Comparison) -> str:
    """The numbers of every run in a table, and what they say."""
    answer = result.answer
    first = [
        f"case {answer.case.label}: {answer.case.title}",
        f"exact: {result.whose}{answer.end} after {result.end_time:.9g} s, known to "
        f"{answer.time_bound:.1e} s and {answer.place_bound:.1e} m",
        f"rest counts from {', '.join(map(str, result.thresholds))} on; errors: theirs less exact",
    ]
    units = {name: COLUMNS[name].unit for name in _SHORT}
    heads = {"file": ""} | {
        word if units[name] == "1" else f"{word} {units[name]}": ".6g"
        for name, word in _SHORT.items()
    }
    rows = [
        (run.log.name, *(row[name] for name in _SHORT))
        for run, row in zip(result.runs, result.rows(), strict=True)
    ]
    parts = ["\n  ".join([f"{head}:", *texts]) for head, texts in result.remarks().items()]
    return "\n\n".join(["\n".join(first), columns(heads, rows), *parts])
