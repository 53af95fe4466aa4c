"""A result as one page for any browser: checked before any work, and written whole or not at all.

What stands on it is told by a function of its own; it loads nothing, and its pictures are SVG.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from puck_tables._core.safe_write import write_bytes
from puck_tables._version import __version__
from puck_tables.io.formats import ending_of
from puck_tables.plot.style import require_matplotlib

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def checked_page(path: str | Path) -> None:
    """Refuse, before any work, a page that could not be made."""
    ending_of(Path(path), (".html",))
    require_matplotlib()


def save_page(
    page: Callable[[Any], str], result: Any, path: str | Path, overwrite: bool = False
) -> None:
    """Write the page of a result, whole or not at all."""
    checked_page(path)
    write_bytes(path, page(result).encode(), overwrite)


def svg_of(figure: Figure) -> str:
    """A figure as it stands in a page, the same for the same figure."""
    picture = io.StringIO()
    figure.savefig(picture, format="svg", metadata={"Date": None})
    svg = picture.getvalue()
    return svg[svg.index("<svg") :]


def document(title: str, style: str, parts: Iterable[str]) -> str:
    """A whole page of these parts, HTML; its title is a text."""
    return (
        "<!DOCTYPE html>\n<html lang='en'><head><meta charset='utf-8'><meta name='viewport' "
        f"content='width=device-width'><title>{escape(title)}</title><style>{style}</style></head>"
        f"<body><main>{''.join(parts)}<p>Made by puck-tables {__version__}.</p></main></body>"
        "</html>\n"
    )


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Texts in rows, below their headings if there are any."""
    names = "".join(f"<th scope='col'>{escape(one)}</th>" for one in head)
    top = f"<thead><tr>{names}</tr></thead>" if names else ""
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table>{top}<tbody>{body}</tbody></table>"


def bullets(said: Iterable[str]) -> str:
    """Sentences as a list."""
    return f"<ul>{''.join(f'<li>{escape(one)}</li>' for one in said)}</ul>"
