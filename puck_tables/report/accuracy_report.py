"""What is told of tables, of their checks, and of methods measured beside each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from puck_tables.accuracy.method_errors import pareto
from puck_tables.report.lines_and_tables import columns, listed

if TYPE_CHECKING:
    from puck_tables.table.check import CheckReport
    from puck_tables.table.table import Table
    from puck_tables.tradeoff.measurement import TradeOff

_FORMS = {"worst": ".1e", "median": ".1e", "cost ns": ".3g", "+-": ".0%", "bytes": "d"}


def report(table: Table) -> str:
    """A table in a dozen lines.  What was loaded has the right digest."""
    said, accuracy = table.metadata, table.accuracy
    assert accuracy is not None
    lines = {
        "table": table.source,
        "holds": f"{table.kind} ({', '.join(table.functions)}); {table.pressure_law} pressure",
        "grid": table.grid,
        "valid": table.valid_range,
        "tolerance": f"{table.tolerance:g}",
        "measured": f"at {accuracy.points} random and adversarial points ({table.errors}):",
    }
    heads = {"": "", "largest": ".1e", "rms": ".1e", "99.9 %": ".1e", "at phi": ".6g"}
    errors = zip(
        table.quantities, accuracy.largest, accuracy.rms, accuracy.p999, accuracy.at_phi,
        accuracy.at_second, strict=True,
    )  # fmt: skip
    order = f"{accuracy.order:.2f} in phi, against half the cells"
    rest = {
        "order": order if accuracy.order else "not measured",
        "made by": f"{said['command']}  (puck-tables {said['package_version']}, {said['created']})",
        "format": f"{said['format']} {said['format_version']}",
        "digest": f"sha256 {said['digest'][:16]}..., right",
    }
    return "\n".join(
        [listed(lines, 11), columns({**heads, table.second: ".6g"}, errors), listed(rest, 11)]
    )


def check_report(judged: CheckReport) -> str:
    """Every check of a table, and whether it was passed."""
    heads = {
        "check": "", "function": "", "points": "d", "largest": ".1e", "allowed": ".1e",
        "result": "", "at phi": ".6g", judged.second: ".6g",
    }  # fmt: skip
    rows = [
        (one.name, one.function, one.points, one.deviation, one.allowed,
         "pass" if one.passed else "FAIL", one.at_phi, one.at_second)
        for one in judged.checks
    ]  # fmt: skip
    return f"{judged.source}: tolerance {judged.tolerance:g}\n{columns(heads, rows)}"


def tradeoff_report(measured: TradeOff) -> str:
    """The front of every question, the outsiders, and the machine."""
    parts = []
    for question in dict.fromkeys(method.question for method in measured.methods):
        methods = [method for method in measured.methods if method.question == question]
        own = [method for method in methods if not method.outsider]
        rows: list[tuple[Any, ...]] = [
            (f"  {one.name}", one.error, one.median_error, one.ns,
             min(9.99, one.ns_spread / one.ns), one.bytes or None)
            for one in [*pareto(own), *(method for method in methods if method.outsider)]
        ]  # fmt: skip
        if len(own) < len(methods):
            rows.insert(len(pareto(own)), ("  outsiders", *[None] * len(_FORMS)))
        heads = {f"{question}: the front of {len(own)} methods": "", **_FORMS}
        parts.append(columns(heads, rows))
    machine = ", ".join(f"{name} {text}" for name, text in measured.machine.items())
    return "\n\n".join([*parts, f"{machine}; {measured.repeats} rounds, {measured.seconds:.0f} s"])
