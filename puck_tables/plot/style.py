"""What all pictures share, and the door to matplotlib: figures, colours, marks, axes, saving."""

from __future__ import annotations

import contextlib
import io
import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables._core.safe_write import write_bytes
from puck_tables.errors import InputError, MissingExtraError
from puck_tables.io.formats import ending_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.gridspec import SubplotSpec

PICTURE_KINDS = (".png", ".svg", ".pdf")
# what stands at the beginning or the end of those that may be drawn again
_SIGNS = {
    ".png": b"\x89PNG", ".svg": b"<svg", ".pdf": b"/Creator (Matplotlib", ".gif": b"GIF8",
    ".mp4": b"ftyp", ".html": b'<meta name="generator" content="puck-tables movie">',
}  # fmt: skip
_LOOKED_AT = 4096  # bytes at each end

BLUE, ORANGE, GREEN, GREY, RED = "#0b5fa5", "#d9660c", "#2f8f3a", "#8a8a8a", "#b3202a"
COLORS = (BLUE, ORANGE, GREEN, "#8b2fa0", RED)
LAUNCH: dict[str, Any] = {
    "marker": "o",
    "color": GREEN,
    "markersize": 6,
    "linestyle": "",
    "zorder": 5,
}
STOP: dict[str, Any] = {
    "marker": "s",
    "color": ORANGE,
    "markersize": 6,
    "linestyle": "",
    "zorder": 5,
}
FEW = 7  # values of an axis that are curves rather than bands of a map
_STEADY = 1e-6  # of itself: a smaller change of a quantity is none


def require_matplotlib() -> None:
    """Refuse before any work is done if pictures cannot be drawn.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.
    InputError
        If its settings keep it from starting.
    """
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise MissingExtraError(
            "pictures need matplotlib: pip install 'puck-tables[plot]'"
        ) from None
    except ValueError as error:
        chosen = os.environ.get("MPLBACKEND")
        which = (
            f"MPLBACKEND = {chosen!r:.60}: unset it, pictures need no backend; " if chosen else ""
        )
        raise InputError(f"matplotlib does not start: {which}it says: {error!s:.200}") from None


def canvas(width: float, height: float) -> Figure:
    """An empty figure; sizes in inches.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> canvas(4.0, 3.0).axes
    []
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def titled(figure: Figure, text: str) -> None:
    """Write the title of a figure as it stands: what users write is no mathematics."""
    figure.suptitle(text, parse_math=False)


def legend_below(axes: Axes, columns: int = 3) -> None:
    """A legend under its panel, where nothing is drawn."""
    if axes.get_legend_handles_labels()[1]:
        axes.legend(
            loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=columns, frameon=False,
            fontsize=9,
        )  # fmt: skip


def _plain_axes(axes: Axes) -> None:
    """Numbers at an axis as they are, not beside one that is to be added; no zoom into rounding."""
    from matplotlib.ticker import ScalarFormatter

    for axis in (axes.xaxis, axes.yaxis):
        formatter = axis.get_major_formatter()
        if not isinstance(formatter, ScalarFormatter):
            continue
        formatter.set_useOffset(False)
        low, high = sorted(axis.get_view_interval())
        middle = 0.5 * abs(low + high)
        if high - low < _STEADY * middle:
            wide = 0.05 * middle
            (axes.set_xlim if axis is axes.xaxis else axes.set_ylim)(low - wide, high + wide)


def checked_kind(path: str | Path) -> str:
    """The ending of a picture's name.

    Raises
    ------
    InputError
        If pictures have no such ending.

    Examples
    --------
    >>> checked_kind("run.png")
    '.png'
    """
    return ending_of(path, PICTURE_KINDS)


def may_replace(path: str | Path, overwrite: bool = False) -> bool:
    """Whether what lies at a path may go for a picture or a movie: one of the same kind may.

    It can be drawn again.  A PDF or a page must have been drawn by puck-tables or matplotlib; an
    empty file holds nothing.

    Examples
    --------
    >>> may_replace("/nowhere/run.png"), may_replace(__file__, overwrite=True)
    (False, True)
    """
    sign = _SIGNS.get(Path(path).suffix.lower())
    if overwrite or sign is None or not Path(path).is_file():
        return overwrite
    with contextlib.suppress(OSError), open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(0)
        found = file.read(_LOOKED_AT)
        file.seek(max(file.tell(), size - _LOOKED_AT))
        return sign in found + file.read() or not size
    return False


def save_figure(figure: Figure, path: str | Path, overwrite: bool = False) -> None:
    """Write a figure whole or not at all, in the place of a picture, see :func:`may_replace`.

    Raises
    ------
    InputError
        If the ending of the name is none of pictures.
    OutputError
        If a file is there that is no picture (without ``overwrite``) or cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_figure(canvas(4.0, 3.0), folder + "/empty.png")
    """
    kind = checked_kind(path)
    buffer = io.BytesIO()
    for axes in figure.axes:
        _plain_axes(axes)
    with warnings.catch_warnings():  # a title may have signs that the font lacks
        warnings.filterwarnings("ignore", "Glyph .* missing from")
        figure.savefig(buffer, format=kind[1:], dpi=130)
    write_bytes(path, buffer.getvalue(), may_replace(path, overwrite))


def draw_over(
    figure: Figure, panel: Axes, axes: Mapping[str, Any], labels: Mapping[str, str], values: Any,
    text: str,
) -> None:  # fmt: skip
    """Draw values over one axis as a curve, over two as a map, or as curves if one has few values.

    ``labels``: what to write at an axis, by its name; ``text``: what the values are.
    """
    panel.grid(color="#dddddd", linewidth=0.6)
    if not np.isfinite(values).any():
        panel.text(0.5, 0.5, "no values", ha="center", transform=panel.transAxes, color=GREY)
    names = list(axes)
    if len(names) == 2 and min(axes[name].size for name in names) > FEW:
        _draw_map(figure, panel, axes, labels, values, text)
        return
    across = max(reversed(names), key=lambda name: axes[name].size)
    rows = values if len(names) == 2 and across == names[1] else np.transpose(values)
    family = [name for name in names if name != across]
    marker = "." if axes[across].size < 30 else ""
    if not family:
        panel.plot(axes[across], values, color=BLUE, marker=marker)
    for n, row in enumerate(rows if family else ()):
        share = n / (len(rows) - 1)
        panel.plot(
            axes[across], row, color=shaded(share), marker=marker,
            label=_at(labels[family[0]], float(axes[family[0]][n])),
        )  # fmt: skip
    panel.set_ylabel(text)
    if _place(panel).is_last_row():
        panel.set_xlabel(labels[across])


def _place(panel: Axes) -> SubplotSpec:
    """Where a panel stands among the others."""
    spec = panel.get_subplotspec()
    assert spec is not None
    return spec


def _at(label: str, value: float) -> str:
    """One value of an axis in words, from its label 'what / unit'."""
    what, _, unit = label.partition(" / ")
    return f"{what}: {value:.4g} {unit}".rstrip()


def shaded(share: float) -> tuple[float, float, float]:
    """The colour of a curve in its family, light at 0 to dark at 1.

    Examples
    --------
    >>> shaded(0.0)
    (0.62, 0.8, 0.94)
    """
    light, dark = np.array([0.62, 0.80, 0.94]), np.array([0.02, 0.17, 0.38])
    red, green, blue = (light + share * (dark - light)).tolist()
    return red, green, blue


def _draw_map(
    figure: Figure, panel: Axes, axes: Mapping[str, Any], labels: Mapping[str, str], values: Any,
    text: str,
) -> None:  # fmt: skip
    (down, rows), (across, columns) = axes.items()
    finite = values[np.isfinite(values)]
    limits: dict[str, Any] = {}
    if finite.size and finite.min() < 0.0 < finite.max():
        largest = float(np.abs(finite).max())
        limits = {"vmin": -largest, "vmax": largest, "cmap": "RdBu_r"}
    panel.grid(visible=False)
    mesh = panel.pcolormesh(columns, rows, values, shading="nearest", rasterized=True, **limits)
    figure.colorbar(mesh, ax=panel)
    panel.set_title(text, fontsize=10)
    if _place(panel).is_last_row():
        panel.set_xlabel(labels[across])
    if _place(panel).is_first_col():
        panel.set_ylabel(labels[down])
