"""When pucks come to rest on the floor and leave that rest, told from the flights they had."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.scene.friction import SPIN, VX, VY, X, Y
from puck_tables.scene.ingredients import Surface, floor_velocity
from puck_tables.scene.parts import Floor
from puck_tables.world import game as g
from puck_tables.world.flight import GONE, LOOKED_UP, PATH, START, UNTIL
from puck_tables.world.lasting import at_rest_below, middle_of
from puck_tables.world.layout import DECEL, INTEGRATED, LIGHTNESS, RADIUS
from puck_tables.world.record import flights_of, states_at, states_on

Rest = tuple[float, str, int, float, float]  # when, stick or slip, which disc, where


def rests_of(game: g.Game) -> list[Rest]:
    """Every stick and slip until now; what an impact or a launch sets off is no slip."""
    found: list[Rest] = []
    for rest in _told(game):
        if rest[1] == "slip" and found and found[-1][:3] == (rest[0], "stick", rest[2]):
            found.pop()  # it stopped, and was not held
        else:
            found.append(rest)
    return found


def _told(game: g.Game) -> Iterator[Rest]:
    """Every stick and slip until now, also a rest that ends at once, disc by disc."""
    discs, states = flights_of(game)
    flights, kinds = game.history[: len(discs), 2:], game.history[: len(discs), 1]
    near, now = at_rest_below(game), float(game.clock[0])
    slips = slips_over(game, discs, states)
    for disc in range(len(game.discs)):
        row = game.discs[disc]
        if row[LIGHTNESS] == 0.0 or not (row[DECEL] > 0.0 or row[INTEGRATED] > 0.0):
            continue  # driven, or nothing can hold it
        rested = True  # what lies at the start has not come to rest
        mine = np.flatnonzero(discs == disc)
        for k, n in enumerate(mine.tolist()):
            start = float(flights[n, START])
            end = float(flights[mine[k + 1], START]) if k + 1 < len(mine) else now
            if kinds[n] == GONE:
                break
            first, last = slips[n] <= near
            moves = not (first and last)
            if kinds[n] == PATH and not moves and start < end:  # perhaps from rest to rest
                middle = states_on(game, mine[k : k + 1], np.array([min(middle_of(game, n), end)]))
                moves = bool(slips_over(game, discs[n : n + 1], middle)[0] > near)
            if first and not rested:
                yield start, "stick", disc, float(states[n, 0, X]), float(states[n, 0, Y])
            if first and moves and kinds[n] == PATH and start > 0.0:
                yield start, "slip", disc, float(states[n, 0, X]), float(states[n, 0, Y])
            rested = bool(last)
            if last and moves:
                stop = float(flights[n, UNTIL]) if kinds[n] == LOOKED_UP else end
                place = states_at(game, np.array([min(stop, end)]))[0, disc]
                yield min(stop, end), "stick", disc, float(place[X]), float(place[Y])


def slips_over(game: g.Game, discs: g.Whole, states: FloatArray) -> FloatArray:
    """How fast the rims of discs (n,) slip over the floor at states (n, …, 6), m/s."""
    surface: Surface = game.surface
    places: Any = states[..., X], states[..., Y]  # the same for arrays
    sx, sy, turning = floor_velocity(surface, *places)
    radii = game.discs[discs, RADIUS].reshape(-1, *[1] * (states.ndim - 2))
    across = np.hypot(states[..., VX] - sx, states[..., VY] - sy)
    slips: FloatArray = np.hypot(across, radii * (states[..., SPIN] - turning))
    return slips


def floor_under(floor: Floor, x: float, y: float) -> str:
    """What a puck with its centre at (x, y) rests on, in words.

    Examples
    --------
    >>> floor_under(Floor(), 0.0, 0.0)
    'floor'
    """
    if floor.strips is None:
        return "floor"
    along = math.cos(floor.strips.direction) * x + math.sin(floor.strips.direction) * y
    return f"strip {sum(along >= border for border in floor.strips.borders)}"
