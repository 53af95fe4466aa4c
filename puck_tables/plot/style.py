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
import numpy.typing as npt

from puck_tables._core.safe_write import write_bytes
from puck_tables.errors import InputError, MissingExtraError
from puck_tables.io.formats import ending_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Colormap
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
_MARK: dict[str, Any] = {"markersize": 6, "linestyle": "", "zorder": 5}
LAUNCH: dict[str, Any] = {"marker": "o", "color": GREEN, **_MARK}
STOP: dict[str, Any] = {"marker": "s", "color": ORANGE, **_MARK}
FEW = 7  # values of an axis that are curves rather than bands of a map
NO_VALUE = "#d0d0d0"  # of a map, where there is none: white and the colours of values are taken
_STEADY = 1e-6  # of itself: a smaller change of a quantity is none
_STRAIGHT = 1e-6  # of its length: a path that bends by less is drawn as a line


def ramp() -> Colormap:
    """Colours of marks from low to high, each of which is seen on white.

    >>> from matplotlib.colors import to_hex
    >>> to_hex(ramp()(0.0)), to_hex(ramp()(1.0))
    ('#0d0887', '#e16462')
    """
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap

    return ListedColormap(colormaps["plasma"](np.linspace(0.0, 0.6, 256)))


def require_matplotlib() -> None:
    """Refuse before any work is done if pictures cannot be drawn.

    Raises MissingExtraError if matplotlib is not installed; InputError if its settings keep it from
    starting.
    """
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise MissingExtraError("pictures need matplotlib: pip install matplotlib") from None
    except ValueError as error:
        chosen = os.environ.get("MPLBACKEND")
        which = (
            f"MPLBACKEND = {chosen!r:.60}: unset it, pictures need no backend; " if chosen else ""
        )
        raise InputError(f"matplotlib does not start: {which}it says: {error!s:.200}") from None


def canvas(width: float, height: float) -> Figure:
    """An empty figure; sizes in inches.

    Raises MissingExtraError if matplotlib is not installed.
    """
    require_matplotlib()
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


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


def no_rounding(axes: Axes) -> None:
    """Not to stretch a straight path across it until its rounding is seen."""
    sides: dict[str, Any] = {"xlim": axes.get_xlim(), "ylim": axes.get_ylim()}
    longest = max(high - low for low, high in sides.values())
    for side, (low, high) in sides.items():
        if high - low < _STRAIGHT * longest:
            middle, half = 0.5 * (low + high), 0.05 * longest
            axes.set(**{side: (middle - half, middle + half)})


def labelled(axes: Axes, x: str, y: str) -> None:
    """What stands at both axes, and a light grid."""
    axes.set(xlabel=x, ylabel=y)
    axes.grid(color="#e4e4e4", linewidth=0.6)


def colour_bar(axes: Axes, marks: ScalarMappable, label: str) -> None:
    """What the colours of marks say, beside their panel."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    figure.colorbar(marks, ax=axes, label=label)


def checked_kind(path: str | Path) -> str:
    """The ending of a picture's name."""
    return ending_of(path, PICTURE_KINDS)


def may_replace(path: str | Path, overwrite: bool = False) -> bool:
    """Whether what lies at a path may go for a picture or a movie: one of the same kind may.

    It can be drawn again.  A PDF or a page must have been drawn by puck-tables or matplotlib; an
    empty file holds nothing.

    >>> may_replace("/nowhere/run.png"), may_replace(__file__, overwrite=True)
    (False, True)
    """
    sign = _SIGNS.get(Path(path).suffix.lower())
    if overwrite or sign is None:
        return overwrite
    try:
        if not Path(path).is_file():
            return False
    except OSError:  # a name that is too long
        return False
    with contextlib.suppress(OSError), open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(0)
        result = file.read(_LOOKED_AT)
        file.seek(max(file.tell(), size - _LOOKED_AT))
        return sign in result + file.read() or not size
    return False


def save_figure(figure: Figure, path: str | Path, overwrite: bool = False) -> None:
    """Write a figure whole or not at all, in the place of a picture, see :func:`may_replace`.

    Raises InputError if the ending of the name is none of pictures; OutputError if a file is there
    that is no picture (without ``overwrite``) or cannot be written.
    """
    kind = checked_kind(path)
    buffer = io.BytesIO()
    for axes in figure.axes:
        _plain_axes(axes)
    with warnings.catch_warnings():  # a title may have signs that the font lacks
        warnings.filterwarnings("ignore", "Glyph .* missing from")
        figure.savefig(buffer, format=kind[1:], dpi=130)
    write_bytes(path, buffer.getvalue(), may_replace(path, overwrite))


def is_map(axes: Mapping[str, Any]) -> bool:
    """Whether values over these axes are drawn as a map, not as curves."""
    return len(axes) == 2 and min(values.size for values in axes.values()) > FEW


def across_of(axes: Mapping[str, Any]) -> str:
    """The axis that lies across: the last one of a map, of curves the longest.

    >>> across_of({"friction": np.ones(9), "spin": np.ones(3)})
    'friction'
    """
    names = list(axes)[::-1]
    return names[0] if is_map(axes) else max(names, key=lambda name: axes[name].size)


def draw_over(
    panel: Axes, axes: Mapping[str, Any], labels: Mapping[str, str], values: Any, text: str
) -> None:
    """Draw values over one axis as a curve, over two as a map, or as curves if one has few values.

    ``labels``: what to write at an axis, by its name; ``text``: what the values are.  How many
    there are not is said.
    """
    panel.grid(color="#dddddd", linewidth=0.6)
    missing = int(np.count_nonzero(~np.isfinite(values)))
    if missing:
        text += f"\nnone at {missing} of {values.size}"
    names = list(axes)
    if is_map(axes):
        _draw_map(panel, axes, labels, values, text)
        return
    across = across_of(axes)
    rows = values if len(names) == 2 and across == names[1] else np.transpose(values)
    family = [name for name in names if name != across]
    alone = missing > 0 or axes[across].size < 30  # a value between two that are not has no line
    marker = "." if alone else ""
    if not family:
        panel.plot(axes[across], values, color=BLUE, marker=marker)
    for n, row in enumerate(rows if family else ()):
        share = n / max(len(rows) - 1, 1)
        panel.plot(
            axes[across], row, color=shaded(share), marker=marker,
            label=_at(labels[family[0]], float(axes[family[0]][n])),
        )  # fmt: skip
    panel.set_ylabel(text)
    if _place(panel).is_last_row():
        panel.set_xlabel(labels[across])


def edges_of(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Where the bands of a map end whose middles are these ascending values; one has a band, too.

    >>> edges_of(np.array([1.0, 2.0, 4.0])).tolist(), edges_of(np.array([3.0])).tolist()
    ([0.5, 1.5, 3.0, 5.0], [2.5, 3.5])
    """
    middles = 0.5 * (values[1:] + values[:-1])
    first, last = (0.5 * (values[n + 1] - values[n]) if values.size > 1 else 0.5 for n in (0, -2))
    return np.concatenate([[values[0] - first], middles, [values[-1] + last]])


def in_order(axes: Mapping[str, Any], *values: Any) -> tuple[dict[str, Any], list[Any]]:
    """Axes with their values ascending, and arrays over them: curves go on, bands lie side by side.

    >>> in_order({"x": np.array([3.0, 1.0])}, np.array([9.0, 1.0]))
    ({'x': array([1., 3.])}, [array([1., 9.])])
    """
    orders = [np.argsort(row, kind="stable") for row in axes.values()]
    ordered = {name: row[order] for (name, row), order in zip(axes.items(), orders, strict=True)}
    return ordered, [one[np.ix_(*orders)] for one in values]


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

    >>> shaded(0.0)
    (0.39, 0.59, 0.81)
    """
    light, dark = np.array([0.39, 0.59, 0.81]), np.array([0.02, 0.17, 0.38])
    red, green, blue = (light + share * (dark - light)).tolist()
    return red, green, blue


def _draw_map(
    panel: Axes, axes: Mapping[str, Any], labels: Mapping[str, str], values: Any, text: str
) -> None:
    (down, rows), (across, columns) = axes.items()
    finite = values[np.isfinite(values)]
    limits: dict[str, Any] = {}
    if finite.size and finite.min() < 0.0 < finite.max():
        largest = float(np.abs(finite).max())
        limits = {"vmin": -largest, "vmax": largest, "cmap": "RdBu_r"}
    panel.grid(visible=False)
    panel.set_facecolor(NO_VALUE)
    mesh = panel.pcolormesh(edges_of(columns), edges_of(rows), values, rasterized=True, **limits)
    colour_bar(panel, mesh, "")
    panel.set_title(text, fontsize=10)
    if _place(panel).is_last_row():
        panel.set_xlabel(labels[across])
    if _place(panel).is_first_col():
        panel.set_ylabel(labels[down])
