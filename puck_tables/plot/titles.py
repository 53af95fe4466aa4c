"""Words of a picture: titles, notes and legends, as users wrote them, none wider than its place."""

from __future__ import annotations

import warnings
from bisect import bisect_left
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Any

from puck_tables._core.wording import counted

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Text

_LINES, _MOST = 6, 2000  # lines and characters of a title; what is longer ends in dots
_NAME = 40  # characters of a legend's entry
_ROOM = 0.96  # of a width


def titled(figure: Figure, text: str) -> None:
    """Write the title of a figure as it stands: what users write is no mathematics.

    >>> from puck_tables.plot.style import canvas
    >>> figure = canvas(4.0, 3.0)
    >>> titled(figure, "more words than there is room for in one line of such a small picture")
    >>> figure.get_suptitle().count(chr(10)) > 0
    True
    """
    _shrunk(figure.suptitle(text, parse_math=False), _ROOM * figure.bbox.width)


def noted(axes: Axes, text: str) -> None:
    """Write above a panel what is not seen in it."""
    words = axes.set_title(text, fontsize=9, loc="left", parse_math=False)
    _shrunk(words, width_of(axes))


def out_of_sight(there: Sequence[Sequence[Any]], in_view: Sequence[Sequence[Any]]) -> str:
    """How many of each kind, the first entry, are there and not seen, in words.

    >>> out_of_sight([("wall",), ("edge",), ("edge",)], [("edge",)])
    'out of sight: 1 wall, 1 edge'
    """
    unseen = Counter(one[0] for one in there) - Counter(one[0] for one in in_view)
    words = ", ".join(counted(count, kind) for kind, count in unseen.items())
    return f"out of sight: {words}" if words else ""


def width_of(axes: Axes) -> float:
    """How wide a panel is, pixels; as far as that is known before all is laid out."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    return float(axes.get_position().width * figure.bbox.width)


def legend_below(
    where: Axes | Figure, columns: int = 3, down: float = 0.16,
    shown: tuple[list[Any], list[str]] | None = None,
) -> None:  # fmt: skip
    """A legend under a panel or a figure, where nothing is drawn, of as many columns as fit.

    ``down``: how far below its panel, in heights of it; ``shown``: handles and labels, if not those
    of the panels.
    """
    from matplotlib.axes import Axes

    handles, labels = shown or _entries(where)
    if not labels:
        return
    entries: dict[str, Any] = {"handles": handles, "labels": [shortened(label) for label in labels]}
    place: dict[str, Any] = {"loc": "outside lower center"}
    room = _ROOM * where.bbox.width
    if isinstance(where, Axes):
        place = {"loc": "upper center", "bbox_to_anchor": (0.5, -down)}
        room = width_of(where) / _ROOM  # panels grow when all is laid out
    for count in range(min(columns, len(labels)), 0, -1):
        legend = where.legend(ncols=count, frameon=False, fontsize=9, **place, **entries)
        for text in legend.get_texts():
            text.set_parse_math(False)  # what users write is no mathematics
        if count == 1 or legend.get_window_extent().width <= room:
            return
        legend.remove()


def _entries(where: Axes | Figure) -> tuple[list[Any], list[str]]:
    """What is labelled in a panel, or in all panels of a figure, each label once."""
    panels: list[Any] = [where] if hasattr(where, "get_legend_handles_labels") else where.axes
    result: dict[str, Any] = {}
    for panel in panels:
        for handle, label in zip(*panel.get_legend_handles_labels(), strict=True):
            result.setdefault(label, handle)
    return list(result.values()), list(result)


def shortened(name: str) -> str:
    """A name that is not too long for a legend.

    >>> shortened("a" * 50)
    'aaaaaaaaaaaaaaaaaaa…aaaaaaaaaaaaaaaaaaaa'
    """
    if len(name) <= _NAME:
        return name
    return name[: _NAME // 2 - 1] + "…" + name[-_NAME // 2 :]


def _shrunk(text: Text, room: float) -> None:
    """Break a text into lines that are not wider than ``room``, pixels."""

    def fits(words: str) -> bool:
        text.set_text(words)
        return bool(text.get_window_extent().width <= room)

    with warnings.catch_warnings():  # a title may have signs that the font lacks
        warnings.filterwarnings("ignore", "Glyph .* missing from")
        lines = list(islice(_lines(text.get_text()[:_MOST], fits), _LINES + 1))
    if len(lines) > _LINES:
        lines = [*lines[: _LINES - 1], lines[_LINES - 1][:-2] + "…"]
    text.set_text("\n".join(lines))


def _lines(text: str, fits: Callable[[str], bool]) -> Iterator[str]:
    """The lines of a text that fit; a word that does not is broken."""
    for part in text.split("\n"):
        line = ""
        for word in part.split(" "):
            longer = f"{line} {word}" if line else word
            if fits(longer):
                line = longer
                continue
            if line:
                yield line
            while len(word) > 1 and not fits(word):
                parts = [word[:n] for n in range(2, len(word))]
                count = 1 + bisect_left(parts, True, key=lambda part: not fits(part))
                yield word[:count]
                word = word[count:]
            line = word
        yield line
