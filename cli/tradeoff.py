"""``puck tradeoff``: accuracy against speed, measured on this machine."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click
from puck_tables.cli.options import FILE, deliver, output_options, prepare_outputs, progress

if TYPE_CHECKING:
    from puck_tables.accuracy.method_errors import MeasuredMethod
    from puck_tables.tradeoff.measurement import TradeOff


@click.command()
@click.option("--quick", is_flag=True, help="Fewer repeats and points: under a minute.")
@click.option(
    "-o", "--output", "outputs", type=FILE, metavar="FILE", multiple=True,
    help="Save everything: .h5, or .csv.  May be given twice.",
)  # fmt: skip
@output_options
def tradeoff(quick: bool, outputs: tuple[Path, ...], plot: Path | None, overwrite: bool) -> None:
    """Measure accuracy against speed of every method to answer.

    Resultants, stops, trajectories and states: by closed forms, tables, integrators, look-up, and
    by what others do; worst and median error, cost on one thread, memory.  Some minutes.

    \b
    puck tradeoff --quick
    puck tradeoff -o tradeoff.h5 -o tradeoff.csv --plot tradeoff.png
    """  # noqa: D301 - click reads the backspace
    prepare_outputs(*outputs, plot=plot, overwrite=overwrite)
    from puck_tables.tradeoff.measurement import measure

    with progress("measuring") as show:
        measured = measure(quick, show)
    for path in outputs:
        deliver(measured, path, None, overwrite)
    deliver(measured, None, plot, overwrite)
    click.echo(report(measured))


def report(measured: TradeOff) -> str:
    """The front of every question, the outsiders, and the machine."""
    from puck_tables.accuracy.method_errors import pareto

    lines = []
    for question in dict.fromkeys(method.question for method in measured.methods):
        methods = [method for method in measured.methods if method.question == question]
        own = [method for method in methods if not method.outsider]
        front = pareto(own)
        lines.append(
            f"{question + ': the front of ' + str(len(own)) + ' methods':<58}"
            f"{'worst':>8}{'median':>9}{'cost':>9} {'+-':>3}{'bytes':>9}"
        )
        lines += [_line(method) for method in front]
        outsiders = [method for method in methods if method.outsider]
        if outsiders:
            lines.append("  outsiders")
            lines += [_line(method) for method in outsiders]
        lines.append("")
    lines.append(
        ", ".join(f"{name} {text}" for name, text in measured.machine.items())
        + f"; {measured.repeats} rounds, {measured.seconds:.0f} s"
    )
    return "\n".join(lines)


def _line(method: MeasuredMethod) -> str:
    spread = f"{min(999.0, 100.0 * method.ns_spread / method.ns):.0f}%"
    return (
        f"  {method.name:<56}{method.error:>8.1e}{method.median_error:>9.1e}"
        f"{_duration(method.ns):>9}{spread:>5}{method.bytes or '-':>9}"
    )


def _duration(ns: float) -> str:
    for scale, unit in ((1e6, "ms"), (1e3, "us")):
        if ns >= scale:
            return f"{ns / scale:.3g} {unit}"
    return f"{ns:.3g} ns"
