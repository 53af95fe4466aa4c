"""A board to play on: one page, with the engine of an exported board behind it."""

from __future__ import annotations

from importlib.resources import files

from puck_tables.export.board_source import export_board
from puck_tables.plot.animation import film_of
from puck_tables.plot.floor_axes import Box
from puck_tables.plot.movie import with_film
from puck_tables.world.scene import Scene


def board_page(scene: Scene) -> str:
    """A board as one HTML file to play on, which needs no server, no network and no other file.

    A puck is dragged, and its way and that of all others is seen before it is let go; a mallet is
    led.  The page has what :func:`puck_tables.export_board` writes inside, and the same limits.

    ``scene``: Scene, which ends by itself, or has a time: what is in sight is chosen by its run.
    Raises InputError as :func:`puck_tables.export_board`.
    """
    page = (files("puck_tables.plot") / "played_board.html").read_text(encoding="utf-8")
    film = film_of(scene.simulate())
    bodies = [body._replace(knots=body.knots[:1]) for body in film.bodies]
    box = film.box if film.lines or film.rounds else _wider(film.box)
    page = with_film(page, film._replace(bodies=bodies, box=box))
    return page.replace("/*board*/", export_board(scene).text)


def _wider(box: Box) -> Box:
    """Twice as wide and as high: nothing keeps pucks on an open floor where one run was."""
    left, right, low, high = box
    x, y = 0.5 * (right - left), 0.5 * (high - low)
    return Box(left - x, right + x, low - y, high + y)
