"""``puck explore``: the explorer, in a browser."""

from __future__ import annotations

import webbrowser

import click
from puck_tables.cli.options import Outputs, outputs
from puck_tables.cli.printing import note
from puck_tables.cli.scene_run import SceneChoice, scene_options, scene_tables

from puck_tables.errors import InputError, OutputError


@click.command()
@scene_options
@outputs("Only write the page there.", plot=False, file="FILE.html")
@click.pass_context
def explore(ctx: click.Context, chosen: SceneChoice, out: Outputs) -> None:
    """Open a page in which a launch is dragged, and its motion seen at once.

    One file, without a server or a network: path, stop, speeds and their ratio over time, pressure
    under the base, stop times around; click where the puck shall stop.  Of pucks under uniform
    pressure, Hertz's, that of a washer and of a hoop, whole base loaded, within 1e-6 of Q/(f g) and
    Q^2/(f g); or of a flat base that you draw, within 5e-6.

    \b
    puck explore
    puck explore -o explorer.html

    With --scene it is a board to play on: drag a puck, and see its way and that of all others
    before you let it go; lead a mallet.

    \b
    puck explore --scene carrom-break
    """  # noqa: D301 - click reads the backspace
    from puck_tables._core.own_folder import make_private, user_cache
    from puck_tables._core.safe_write import write_bytes

    if out.output is not None:
        if out.output.suffix.lower() not in (".html", ".htm"):
            raise InputError(f"{out.output}: the explorer is a page: call it FILE.html")
        out.prepare(saved=False)
        write_bytes(out.output, _page(ctx, chosen).encode(), out.overwrite)
        note(out.output)
        return
    folder = user_cache()
    if folder is None:
        raise InputError(
            "there is no cache folder to put the page in: say where, with -o FILE.html"
        )
    try:
        make_private(folder)
    except OSError as error:
        raise OutputError(f"{folder}: {error.strerror or error}: give -o FILE.html") from None
    page = folder / ("board.html" if chosen else "explorer.html")
    write_bytes(page, _page(ctx, chosen).encode(), overwrite=True)
    note(page)
    if not webbrowser.open(page.as_uri()):
        click.echo("No browser could be opened: open that file in one.", err=True)


def _page(ctx: click.Context, chosen: SceneChoice) -> str:
    """The explorer, or the board of a scene."""
    from puck_tables.explore.page import explorer_page

    if not chosen:
        return explorer_page()
    from puck_tables.plot.played_board import board_page
    from puck_tables.world.scene import Scene

    return board_page(Scene.from_tables(scene_tables(ctx, chosen), chosen.name))
