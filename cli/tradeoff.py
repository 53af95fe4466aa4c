"""``puck tradeoff``: accuracy against speed, measured on this machine."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.options import FILE, Outputs, outputs
from puck_tables.cli.printing import columns, progress

if TYPE_CHECKING:
    from puck_tables.tradeoff.measurement import TradeOff

_FORMS = {"worst": ".1e", "median": ".1e", "cost ns": ".3g", "+-": ".0%", "bytes": "d"}


@click.command()
@click.option("--quick", is_flag=True, help="Fewer repeats and points: under a minute.")
@click.option("-o", "--output", "files", type=FILE, metavar="FILE", multiple=True,
              help="Save everything: .h5, or .csv.  May be given twice.")  # fmt: skip
@outputs(None)
def tradeoff(quick: bool, files: tuple[Path, ...], out: Outputs) -> None:
    """Measure accuracy against speed of every method to answer.

    Resultants, stops, trajectories and states: by closed forms, tables, integrators, look-up, and
    by what others do; worst and median error, cost on one thread, memory.  Some minutes.

    \b
    puck tradeoff --quick
    puck tradeoff -o tradeoff.h5 -o tradeoff.csv --plot tradeoff.png
    """  # noqa: D301 - click reads the backspace
    for path in files:
        Outputs(path, overwrite=out.overwrite).prepare()
    out.prepare(others=files)
    from puck_tables.tradeoff.measurement import measure

    with progress("measuring") as show:
        measured = measure(quick, show)
    for path in files:
        Outputs(path, overwrite=out.overwrite).deliver(measured)
    out.deliver(measured)
    click.echo(report(measured))


def report(measured: TradeOff) -> str:
    """The front of every question, the outsiders, and the machine."""
    from puck_tables.accuracy.method_errors import pareto

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
