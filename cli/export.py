"""``puck export``: the look-ups as a source file of another language."""

from __future__ import annotations

import re

import click
from puck_tables.cli.options import Outputs, PuckChoice, body_options, number, outputs, packed
from puck_tables.cli.printing import note
from puck_tables.cli.scene_run import SceneChoice, scene_options, scene_tables

from puck_tables.errors import InputError


@click.command()
@click.option("--language", required=True, metavar="NAME",
              help="c, js or python; of a scene c or js.")  # fmt: skip
@click.option("--target", metavar="MACHINE", help="Of a scene in C: x86_64- or aarch64- before "
              "linux, macos or windows.  [default: this machine]")  # fmt: skip
@click.option("--what", default="stop,state,resultants", show_default=True, metavar="PARTS",
              help="Where and when launches stop, states at any time, friction resultants;"
                   " of a --base wrench, of friction, and a step of its motion."
              )  # fmt: skip
@number("--tol", default=1e-6, show_default=True,
        help="Largest error, in units of Q/(f g), Q^2/(f g), Q: 1e-9 to 0.01.")  # fmt: skip
@packed("choice", PuckChoice, *body_options(True))
@scene_options
@outputs("The file.", plot=False, required=True)
@click.pass_context
def export(
    ctx: click.Context, language: str, target: str | None, what: str, tol: float,
    choice: PuckChoice, chosen: SceneChoice, out: Outputs,
) -> None:  # fmt: skip
    """Write one self-contained source file that computes motions without this program.

    The tables are in it, as small as the error allows, the licence, and self_test, which returns
    how many numbers of the test vectors in the file are missed: 0.  For one pressure law and one
    radius of gyration, and all heights under which the whole base stays loaded: delta up to 1 under
    uniform pressure, 0.8 under Hertz's, 4/3 under Galin's, 2 on a ring, 1 + a^2 on annulus:a.

    \b
    puck export --language c -o puck.c
    puck export --language c --pressure annulus:0.8 --gyration 0.905539 -o washer.c
    puck export --language js --what stop,state --tol 1e-4 -o puck.js
    puck export --language c --base box:0.2x0.1 --what wrench -o box.c

    With --scene it plays a board, as World does in Python (strike, place, drive, advance, state,
    copy): engine and scene in WebAssembly for browsers and Node, beside it types for TypeScript, or
    a header in C, beside it a static library of machine code, for C++, Rust and C# as well.  The
    same calls give the same bits in all of them.

    \b
    puck export --language js --scene carrom-break -o carrom.js
    puck export --language c --scene carrom-break -o carrom.h
    puck export --language c --target aarch64-linux --scene carrom-break -o carrom.h
    """  # noqa: D301 - click reads the backspace
    if chosen:
        return _export_board(ctx, language, target, chosen, out)
    if target is not None:
        raise InputError("--target is for a board: give --scene FILE|NAME, too")
    from puck_tables.export.source import checked_ending, checked_request, export_source

    parts = checked_request(language, what, tol)
    assert out.output is not None
    checked_ending(out.output, language)
    out.prepare(choice.pressure, saved=False)
    source = export_source(language, parts, tol, choice.puck())
    click.echo(repr(source), err=True)
    out.deliver(source)


def _export_board(
    ctx: click.Context, language: str, target: str | None, chosen: SceneChoice, out: Outputs
) -> None:
    """Write what plays the board of a scene."""
    from puck_tables.export.board_source import companion_path, export_board
    from puck_tables.world.scene import Scene

    if language not in ("c", "js"):
        raise InputError(f"--language {language}: boards are exported to c and js")
    tables = scene_tables(ctx, chosen, ("language", "target"))
    assert out.output is not None
    name = re.sub(r"\W", "_", out.output.stem, flags=re.ASCII)
    beside = companion_path(out.output, language, name)
    out.prepare(*chosen.reads(tables), others=(beside,), saved=False)
    scene = Scene.from_tables(tables, chosen.name)
    source = export_board(scene, language, target=target, name=name)
    click.echo(repr(source), err=True)
    out.deliver(source)
    note(beside)
