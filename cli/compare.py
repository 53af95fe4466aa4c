"""``puck compare``: runs of an engine against the exact answer to a case."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from puck_tables.cli.completion import cases
from puck_tables.cli.options import FILE, RESULTS, Outputs, number, outputs, packed
from puck_tables.cli.printing import note
from puck_tables.cli.values import Times


@click.command()
@click.argument("files", type=FILE, nargs=-1, required=True, metavar="THEIRS...")
@packed(
    "how", dict,
    click.option("--case", required=True, shell_complete=cases,
                 help="Which: see 'puck reference'."),
    click.option("--threshold", "thresholds", multiple=True, metavar="SPEED|SPIN",
                 help="Slower counts as at rest: 0.1rad/s or 1mm/s; as often as needed.  "
                 "[default: hypot(v, r w) below 1 % of that of the launch]"),
    number("--steps", "s", Times, metavar="DT1,DT2,...",
           help="Step of the engine in each file, s.  [default: the distance of its rows]"),
    click.option("--columns", metavar="NAMES",
                 help="Headings in place of the file's, - to leave out."),
    click.option("--unit", help="Of lengths (and velocities, a second) where a file says none: m."),
    click.option("--angle-unit",
                 help="Of angles (and spins, a second) where a file says none: rad."),
    click.option("--up", help="The axis that points up, y or z, where there are three."),
    click.option("--puck", help="Which puck, of a case of several: its name."),
    number("--launch-time", "s", default=0.0, show_default=True,
           help="When the launch is in the files, s."),
)  # fmt: skip
@click.option("--report", type=FILE, metavar="FILE.html", help="One page with all of it.")
@outputs(f"Save, a row a file: {RESULTS}.", explain=True, as_json=True)
def compare(
    files: tuple[Path, ...], how: dict[str, Any], report: Path | None, out: Outputs
) -> None:
    """Say what runs of an engine are off by in a case, and what only seems to be an error.

    THEIRS are tables with columns t, x, y and an angle or a quaternion (qw qx qy qz), velocities vx
    vy and the spin w, in any order, with units in the header; several files of falling step give
    the order of convergence.

    \b
    puck compare mine.csv --case coin
    puck compare a.csv b.csv c.csv --case coin --threshold 0.1rad/s --report coin.html
    puck compare log.csv --case tall-1 --unit m --angle-unit rad --up z
    """  # noqa: D301 - click reads the backspace
    out.prepare(*files, others=(report,))
    if report is not None:
        from puck_tables.plot.html_page import checked_page

        checked_page(report)
    from puck_tables.reference.comparison import compare as compared

    result = compared(files, **how)
    out.deliver(result)
    if report is not None:
        from puck_tables.plot.comparison_figure import page
        from puck_tables.plot.html_page import save_page

        save_page(page, result, report, out.overwrite)
        note(report)
    out.report(result)
