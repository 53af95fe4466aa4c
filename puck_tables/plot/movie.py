"""Movies of a motion: HTML, one file that any browser plays, or GIF and MP4 through matplotlib."""

from __future__ import annotations

import json
import math
import tempfile
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from subprocess import CalledProcessError
from typing import TYPE_CHECKING, Any

import numpy as np

from puck_tables._core.safe_write import check_target, write_bytes
from puck_tables.errors import MissingExtraError, OutputError
from puck_tables.io.formats import ending_of
from puck_tables.plot import board
from puck_tables.plot.animation import Animation, MovingDisc, between, film_of, path_of
from puck_tables.plot.base_outlines import path_of as path_through
from puck_tables.plot.base_outlines import placed
from puck_tables.plot.floor_axes import motion_said, shades_of
from puck_tables.plot.style import RED, canvas, may_replace, require_matplotlib
from puck_tables.plot.titles import titled
from puck_tables.result import TimedResult
from puck_tables.scene.parts import Floor

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOVIE_KINDS = (".html", ".gif", ".mp4")
DIGITS = 8  # of the numbers in HTML
_PICTURES = 25  # a second
# s, of a GIF or MP4: shorter or longer motions are shown slower, faster
_SHORTEST, _LONGEST = 3.0, 12.0
_HELD = 12  # pictures of the end
_DOTS = 100  # an inch
_FLASH = 0.2  # s for which an impact is seen


def checked_movie(path: str | Path) -> str:
    """The ending of a movie's name; refuse before any work is done if it cannot be made.

    Raises InputError if movies have no such ending; MissingExtraError if matplotlib or ffmpeg is
    needed and not installed.
    """
    kind = ending_of(path, MOVIE_KINDS)
    if kind != ".html":
        require_matplotlib()
    if kind == ".mp4":
        from matplotlib.animation import FFMpegWriter

        if not FFMpegWriter.isAvailable():
            raise MissingExtraError(
                "MP4 movies need the program ffmpeg, which is not found: install it, or name the "
                "movie .html or .gif"
            )
    return kind


def save_movie(result: TimedResult, path: str | Path, overwrite: bool = False) -> None:
    """Write a movie whole or not at all, as :meth:`puck_tables.result.TimedResult.movie` has it.

    Raises InputError if movies have no such ending; MissingExtraError if matplotlib or ffmpeg is
    needed and not installed; OutputError if a file is there that is no movie (without
    ``overwrite``) or cannot be written.
    """
    kind = checked_movie(path)
    check_target(path, may_replace(path, overwrite))
    film = film_of(result)
    content = page(film).encode() if kind == ".html" else _filmed(film, kind)
    write_bytes(path, content, may_replace(path, overwrite))


def page(film: Animation) -> str:
    """One HTML page with the film in it: it loads nothing and needs no server."""
    folder = files("puck_tables.plot")
    return with_film((folder / "movie.html").read_text(encoding="utf-8"), film)


def with_film(template: str, film: Animation) -> str:
    """A page that draws boards, with all that is shown of one written into it."""
    drawing = (files("puck_tables.plot") / "board_drawing.js").read_text(encoding="utf-8")
    shades = [
        {"corners": shade.corners, "centre": shade.centre, "radius": shade.radius,
         "colour": "#" + "".join(f"{round(255 * part):02x}" for part in shade.colour)}
        for shade in shades_of(film.floor, film.box, max(film.frictions, default=0.0))
    ]  # fmt: skip
    shown = {
        "title": _title(film), "end_time": film.end_time, "box": film.box,
        "bodies": [_body(body) for body in film.bodies],
        "lines": [line._asdict() for line in film.lines], "shades": shades,
        "moving": _motion(film.floor), "rounds": [one._asdict() for one in film.rounds],
        "painted": [line._asdict() for line in film.painted],
        "happenings": [one._asdict() for one in film.happenings],
    }  # fmt: skip
    text = json.dumps(shown, allow_nan=False, separators=(",", ":"))
    # what a name or a title says never ends the script
    text = text.replace("<", "\\u003c").replace(">", "\\u003e")
    return template.replace("/*drawing*/", drawing).replace("/*film*/null", text)


def _title(film: Animation) -> str:
    return f"{film.title or 'Scene'}: {film.end} after {film.end_time:.4g} s"


def _body(body: MovingDisc) -> dict[str, Any]:
    return {
        **body._asdict(),
        "gone": body.gone if math.isfinite(body.gone) else None,
        "mark": body.mark,
        "mark_length": body.mark_length,
        "outline": [np.round(part, DIGITS).tolist() for part in body.outline],
        "line": body.line,
        "knots": [[float(f"{x:.{DIGITS}g}") for x in row] for row in body.knots.tolist()],
    }


def _motion(floor: Floor) -> dict[str, Any] | None:
    """Of a floor that moves: velocity m/s, turning rad/s about a centre m, and words."""
    words = motion_said(floor)
    names = ("velocity", "turning", "centre")
    return {name: getattr(floor, name) for name in names} | {"words": words} if words else None


def _filmed(film: Animation, kind: str) -> bytes:
    """The bytes of a GIF or an MP4."""
    from matplotlib.animation import FFMpegWriter, PillowWriter

    shown = min(max(film.end_time, _SHORTEST), _LONGEST) if film.end_time > 0.0 else 0.0
    times = np.linspace(0.0, film.end_time, round(shown * _PICTURES) + 1)
    figure, show = _stage(film, shown / film.end_time if film.end_time > 0.0 else 1.0)
    writer = (PillowWriter if kind == ".gif" else FFMpegWriter)(fps=_PICTURES)
    try:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"movie{kind}"
            with writer.saving(figure, str(path), _DOTS):
                for time in [*times.tolist(), *[film.end_time] * _HELD]:
                    show(time)
                    writer.grab_frame()
            return path.read_bytes()
    except (OSError, CalledProcessError) as error:  # no room for it, or ffmpeg fails
        raise OutputError(f"the movie could not be made: {error}") from None


def _stage(film: Animation, slowed: float) -> tuple[Figure, Callable[[float], None]]:
    """A picture of a film, and what shows it at any time."""
    from matplotlib.patches import PathPatch

    wide, high = board.size_of(film.box)
    share = min(1.0, 6.0 / max(wide, high))
    figure = canvas(_even(share * wide + 0.9), _even(share * high + 1.0))
    axes = figure.add_subplot()
    board.draw_board(axes, film)
    board.show(axes, film.box)
    titled(figure, _title(film))
    clock = axes.set_title(" ", fontsize=9, loc="left")
    figure.draw_without_rendering()
    figure.set_layout_engine("none")  # all is where it stays
    moving = []
    for body in film.bodies:
        looks: dict[str, Any] = {"facecolor": body.colour, "edgecolor": "black"}
        if body.driven:
            looks = {"facecolor": "white", "edgecolor": body.line}
        (trail,) = axes.plot([], [], color=body.line, linewidth=0.8)
        disc = board.disc(body, 0.0, 0.0, linewidth=0.7, zorder=3, **looks)
        axes.add_patch(disc)
        (mark,) = axes.plot([], [], color=body.mark, linewidth=1.0, zorder=3)
        moving.append((body, disc, trail, mark))
    (flashes,) = axes.plot(
        [], [], linestyle="", marker="o", markersize=9, fillstyle="none", color=RED, zorder=4
    )

    def show(time: float) -> None:
        for body, disc, trail, mark in moving:
            until = min(time, body.gone)
            x, y, angle = between(body.knots, np.array([until]))[0].tolist()
            trail.set_data(*path_of(body, until).T)
            if isinstance(disc, PathPatch):
                disc.set_path(path_through(placed(body.outline, x, y, angle)))
            else:
                disc.set_center((x, y))
            long = body.mark_length
            rim = x + long * math.cos(angle), y + long * math.sin(angle)
            mark.set_data([x, rim[0]], [y, rim[1]])
            for part in (disc, mark):
                part.set_alpha(0.25 if time >= body.gone else 1.0)
        recent = [e for e in film.happenings if 0.0 <= time - e.time <= _FLASH / slowed]
        flashes.set_data([one.x for one in recent], [one.y for one in recent])
        clock.set_text(f"{time:.3f} s" + (f", {1.0 / slowed:.3g}x" if slowed != 1.0 else ""))

    return figure, show


def _even(inches: float) -> float:
    """A size that is an even number of dots: video formats need it."""
    return 2.0 * round(0.5 * inches * _DOTS) / _DOTS
