"""``puck warm-up``: what is compiled at the first use, compiled now."""

from __future__ import annotations

import click


@click.command()
def warm_up() -> None:
    """Compile what games and services call, once for this machine.

    It takes some minutes, or a second where it was done before; stderr says how far it is.  Without
    it nothing is missing: what takes long is compiled when it is first asked.

    \b
    puck warm-up
    """  # noqa: D301 - click reads the backspace
    from puck_tables.warming import warm_up

    warm_up()
