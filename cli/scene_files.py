"""``puck scene``: the scenes that come along, and whether a scene file is right."""

from __future__ import annotations

import click
from puck_tables.cli.completion import scenes
from puck_tables.cli.printing import say

from puck_tables.report.lines_and_tables import listed


@click.group()
def scene() -> None:
    """Scene files: list, show and check them, and what may stand in them.

    A scene is one puck or several, a floor, launches and what acts on them, in SI units; 'puck
    simulate --scene' and 'puck sweep --scene' run it.
    """


@scene.command("list")
def list_scenes() -> None:
    """List the scenes that come along."""
    from puck_tables.scene.library import shipped_scenes

    click.echo(listed(shipped_scenes(), 24))


@scene.command()
@click.argument("name", shell_complete=scenes)
def show(name: str) -> None:
    """Print a scene that comes along, to start one of your own from.

    \b
    puck scene show incline > mine.toml
    """  # noqa: D301 - click reads the backspace
    from puck_tables.scene.library import shipped_text

    click.echo(shipped_text(name), nl=False)


@scene.command()
def fields() -> None:
    """List every entry that a scene may have: what is allowed, its default, what it is."""
    from puck_tables._core.fields import described
    from puck_tables.world.scene import Scene

    for path, allowed, text in described(Scene):
        click.echo(f"{path:<24} {allowed:<44} {text}".rstrip())


@scene.command()
@click.argument("name", metavar="FILE|NAME", shell_complete=scenes)
def check(name: str) -> None:
    """Check a scene: every error at once, or what it holds and how it would be run."""
    from puck_tables.world.plan import plan_of
    from puck_tables.world.prepare import prepared
    from puck_tables.world.scene import Scene
    from puck_tables.world.scene_ends import axes_of

    whole = Scene.load(name)
    prepared(whole)  # files and heights
    say(f"{name}: a scene" + (f", {whole.title}" if whole.title else ""))
    for path, values in axes_of(whole).items():
        click.echo(f"ranges        {path} from {values[0]:g} to {values[-1]:g}, {values.size}")
    say(plan_of(whole)[1])
