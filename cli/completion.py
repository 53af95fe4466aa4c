"""What a shell offers at the Tab key where click alone cannot know it: scenes, cases, laws."""

from __future__ import annotations

import click
from click.shell_completion import CompletionItem

_LAWS = ("uniform", "galin", "hertz", "ring", "annulus:")


def scenes(context: click.Context, param: click.Parameter, begun: str) -> list[CompletionItem]:
    """Names of the scenes that come along, with their titles; and files, where those go."""
    from puck_tables.scene.library import shipped_scenes

    named = shipped_scenes().items()
    result = [CompletionItem(name, help=title) for name, title in named if name.startswith(begun)]
    return result if param.metavar is None else [*result, CompletionItem(begun, type="file")]


def cases(context: click.Context, param: click.Parameter, begun: str) -> list[CompletionItem]:
    """Names of benchmark cases, with their titles."""
    from puck_tables.reference.cases import CASES

    return [CompletionItem(c.name, help=c.title) for c in CASES if c.name.startswith(begun)]


def laws(context: click.Context, param: click.Parameter, begun: str) -> list[CompletionItem]:
    """Names of pressure laws, and files."""
    result = [CompletionItem(name) for name in _LAWS if name.startswith(begun)]
    return [*result, CompletionItem(begun, type="file")]
