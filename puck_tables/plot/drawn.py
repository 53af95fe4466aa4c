"""A result drawn by the module of its kind, and saved."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from puck_tables.plot.style import checked_kind, require_matplotlib, save_figure
from puck_tables.result import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw(result: Result, path: str | Path | None, ax: Axes | None, overwrite: bool) -> Figure:
    """Draw a result, as :meth:`puck_tables.results.Result.plot` has it."""
    require_matplotlib()
    if path is not None:
        checked_kind(path)
    module: Any = import_module(f"puck_tables.plot.{result.picture}_figure")
    figure: Figure
    if ax is None:
        figure = module.draw(result)
    else:
        module.draw_on(ax, result)
        figure = ax.get_figure(root=True)  # type: ignore[assignment]
    if path is not None:
        save_figure(figure, path, overwrite)
    return figure
