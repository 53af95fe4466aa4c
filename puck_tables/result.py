"""What every result can do: be saved, drawn, explained, compared, handed to xarray and pandas."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from puck_tables._core.lazy import above, report_of
from puck_tables.io.columns import Dataset
from puck_tables.io.formats import save

if TYPE_CHECKING:
    import pandas
    import xarray
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


class Result:
    """The base of all results.

    A kind of result gives its :meth:`dataset`, its :meth:`explain`, and ``picture``: the module of
    :mod:`puck_tables.plot` that draws it (``draw(result)``, a figure, and ``draw_on(axes,
    result)``, its main panel).
    """

    picture: ClassVar[str]
    __hash__ = None  # type: ignore[assignment]  # arrays can change

    def dataset(self) -> Dataset:
        """Axes, columns with units, and scalars: what files and other programs get."""
        raise NotImplementedError

    def explain(self) -> str:
        """How the result was got, and why in that way: lines of text."""
        raise NotImplementedError

    def save(self, path: str | Path, overwrite: bool = False) -> None:
        """Write the result as HDF5, CSV, JSON or Parquet, by the ending of the name.

        Parameters
        ----------
        path : .h5 or .json (everything, labelled), .csv, .jsonl or .parquet (one row a state)
        overwrite : whether an existing file may be replaced

        Raises
        ------
        InputError
            If the ending is not known.
        MissingExtraError
            If the format needs a package that is not installed.
        OutputError
            If the file exists or cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> from puck_tables import Puck
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     Puck.similar().simulate((1.0, 0.0), frames=2).save(folder + "/run.csv")
        ...     print(Path(folder, "run.csv").read_text()[:17])
        time[s],x[m],y[m]
        """
        save(self.dataset(), path, overwrite)

    def plot(
        self, path: str | Path | None = None, ax: Axes | None = None, overwrite: bool = False
    ) -> Figure:
        """Draw the result.

        Parameters
        ----------
        path : .png, .svg or .pdf, optional
            A picture that is there is replaced: it can be drawn again.
        ax : matplotlib axes, optional
            To draw the main panel on, instead of a whole new figure.
        overwrite : whether a file that is no picture may be replaced, too

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        InputError
            If the ending is not known, or there is nothing to draw.
        MissingExtraError
            If matplotlib is not installed.
        OutputError
            If a file that is no picture has that name, or it cannot be written.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> len(Puck.similar().simulate((1.0, 0.0), 5.0).plot().axes)
        3
        """
        figure: Figure = above("draw")(self, path, ax, overwrite)
        return figure

    def to_xarray(self) -> xarray.Dataset:
        """The result as an xarray.Dataset with units; needs xarray.

        >>> from puck_tables import Puck
        >>> dict(Puck.similar().sweep([0.0, 1.0], 1.0).to_xarray().sizes)
        {'launch_spin': 2}
        """
        from puck_tables.io.formats import to_xarray

        return to_xarray(self.dataset())

    def to_pandas(self) -> pandas.DataFrame:
        """The result as a pandas.DataFrame, one row a state, a launch or a run; needs pandas.

        >>> from puck_tables import Puck
        >>> Puck.similar().simulate((1.0, 0.0), frames=2).to_pandas().x.tolist()
        [0.0, 0.5]
        """
        from puck_tables.io.formats import to_pandas

        return to_pandas(self.dataset())

    def __str__(self) -> str:
        """What the command ``puck`` prints of it: what a reader wants to know first, in words.

        >>> from puck_tables import Puck
        >>> print(str(Puck.similar().simulate((1.0, 0.0))).splitlines()[0])
        The puck stops after 1 s, 0.5 m from its launch.
        """
        return report_of(self)

    def _repr_html_(self) -> str:
        """A small table for notebooks: what the repr says, and the scalars."""
        rows = "".join(
            f"<tr><th>{escape(str(name))}</th><td>{escape(_short(value))}</td></tr>"
            for name, value in self.dataset().attributes.items()
        )
        return f"<p>{escape(repr(self))}</p><table>{rows}</table>"

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        mine, theirs = self.dataset(), other.dataset()
        if dict(mine.texts) != dict(theirs.texts):
            return False
        pairs = [
            ({n: v.values for n, v in one.items()}, {n: v.values for n, v in two.items()})
            for one, two in ((mine.axes, theirs.axes), (mine.columns, theirs.columns))
        ] + [(dict(mine.attributes), dict(theirs.attributes))]
        return all(
            one.keys() == two.keys() and all(_equal(one[name], two[name]) for name in one)
            for one, two in pairs
        )


class TimedResult(Result):
    """A result that is a motion over time: it can be a movie, too."""

    def movie(self, path: str | Path, overwrite: bool = False) -> None:
        """Show the motion, with impacts and spins.

        Parameters
        ----------
        path : .html, .gif or .mp4
            HTML is one file for any browser, with a time slider; it needs nothing else.  GIF needs
            matplotlib, MP4 the program ffmpeg besides.  A movie that is there is replaced.
        overwrite : whether a file that is no movie may be replaced, too

        Raises
        ------
        InputError
            If the ending is not known.
        MissingExtraError
            If matplotlib or ffmpeg is needed and not installed.
        OutputError
            If a file that is no movie has that name, or it cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> from puck_tables import Puck
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     Puck.similar().simulate((1.0, 0.0), 5.0).movie(folder + "/run.html")
        ...     print(Path(folder, "run.html").read_text()[:15])
        <!DOCTYPE html>
        """
        above("save_movie")(self, path, overwrite)


def _equal(one: Any, two: Any) -> bool:
    a, b = np.asarray(one), np.asarray(two)
    numbers = a.dtype.kind == "f" and b.dtype.kind == "f"
    return np.array_equal(a, b, equal_nan=numbers)


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.9g}"
    if isinstance(value, list | tuple):
        return ", ".join(map(_short, value))
    return str(value)
