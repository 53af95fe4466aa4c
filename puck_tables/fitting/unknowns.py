"""What the numbers of a fit are: of the puck, of each launch, of the walls that are found.

Those of the puck are shared by all tracks; then come the launch of each track and the walls.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.asked import Asked
from puck_tables.fitting.joined import Wall
from puck_tables.fitting.limits import limits_of
from puck_tables.fitting.parameters import LAUNCH, WALL
from puck_tables.fitting.seen import Seen

Found = dict[str, float]
_MOTION = ("launch_vx", "launch_vy", "launch_spin")
_ACROSS = (("launch_y", "launch_vy"), ("launch_x", "launch_vx"))  # of lines that x, or y, tells
_WALL = -2  # the first wall in names, the next is one less


class Unknowns:
    """What is asked of some tracks, and the vector of unknowns that answers it."""

    asked: Asked
    films: tuple[Seen, ...]
    tall: bool
    rests: tuple[bool, ...]
    walls: tuple[Wall | None, ...]

    @cached_property
    def launch_names(self) -> tuple[tuple[str, ...], ...]:
        """The unknowns of each launch."""
        return tuple(
            tuple(
                name for name in LAUNCH
                if name not in self.asked.fixed
                and (name != "launch_angle" or film.angle is not None)
                and not (rests and name in _MOTION)
                and not (spinless and name == "launch_spin")
                and (film.straight is None or name not in _ACROSS[film.straight.main])
            )
            for film, rests, spinless in zip(
                self.films, self.rests or [False] * len(self.films), self.spinless, strict=True
            )
        )  # fmt: skip

    @cached_property
    def spinless(self) -> tuple[bool, ...]:
        """Which tracks are taken for slides without spin: those along a line, without angles.

        Unless something is said of their spin.
        """
        asked = self.asked
        said = any("launch_spin" in one for one in (asked.fixed, asked.priors, asked.bounds,
                                                    asked.start))  # fmt: skip
        return tuple(
            not said and film.straight is not None and film.angle is None for film in self.films
        )

    @cached_property
    def names(self) -> tuple[tuple[int, str], ...]:
        """(track, name) of every unknown; −1 for the puck, −2 for the first wall, and so on."""
        launches = [(n, name) for n, names in enumerate(self.launch_names) for name in names]
        walls = [
            (_WALL - n, name) for n, wall in enumerate(self.walls) if wall is None for name in WALL
        ]
        return (*((-1, name) for name in self.asked.free), *launches, *walls)

    @cached_property
    def priors(self) -> tuple[tuple[int, float, float], ...]:
        """(unknown, value, standard deviation).

        That of a readout, unless it or bounds are given: a picture is read before the next one.
        """
        found = []
        for k, (_, name) in enumerate(self.names):
            if name in self.asked.priors:
                found.append((k, *self.asked.priors[name]))
            elif name == "readout" and self.read_within is not None:
                found.append((k, 0.5 * self.read_within, 0.5 * self.read_within))
        return tuple(found)

    @property
    def read_within(self) -> float | None:
        """The usual time between two frames, s, None where readout has a prior or bounds."""
        if "readout" in (*self.asked.priors, *self.asked.bounds):
            return None
        return min(film.usual_step for film in self.films)

    @cached_property
    def limits(self) -> tuple[FloatArray, FloatArray]:
        """The range in which each unknown is looked for."""
        return limits_of(self.asked, self.films, self.names, self.tall)

    def found(self, x: FloatArray) -> Found:
        """The numbers of the puck that are found."""
        return dict(zip(self.asked.free, x[: len(self.asked.free)].tolist(), strict=True))

    def launches(self, x: FloatArray) -> FloatArray:
        """The launch (6,) of each track: x, y, vx, vy, spin, angle; (tracks, 6)."""
        out = np.empty((len(self.films), len(LAUNCH)))
        out[:] = [self.asked.fixed.get(name, 0.0) for name in LAUNCH]
        order = list(LAUNCH)
        for k, (track, name) in enumerate(self.names):
            if track >= 0:
                out[track, order.index(name)] = x[k]
        for row, film in zip(out, self.films, strict=True):
            if film.straight is not None:
                main, point = film.straight.main, film.straight.point
                other = 1 - main
                row[other] = point[other] + film.straight.slope * (row[main] - point[main])
                row[2 + other] = film.straight.slope * row[2 + main]
        return out

    def unknowns(
        self, found: Found, launches: FloatArray, walls: tuple[Wall, ...] = ()
    ) -> FloatArray:
        """The vector of unknowns from what they mean."""
        order = list(LAUNCH)
        values = []
        for track, name in self.names:
            if track == -1:
                values.append(found[name])
            elif track < -1:
                values.append(walls[_WALL - track][list(WALL).index(name)])
            else:
                values.append(launches[track, order.index(name)])
        return np.array(values, float)

    def found_walls(self, x: FloatArray) -> tuple[Wall, ...]:
        """All walls, given or found."""
        found: list[Wall] = []
        at = len(self.names) - len(WALL) * self.walls.count(None)
        for wall in self.walls:
            if wall is None:
                wall, at = Wall(*x[at : at + len(WALL)].tolist()), at + len(WALL)
            found.append(wall)
        return tuple(found)

    def within(self, x: FloatArray) -> FloatArray:
        """The same, with the height of the tallest puck that moves so: all higher ones do, too."""
        delta, highest = self.asked.scales(self.found(x))[1], self.asked.highest(self.tall)
        if "height" not in self.asked.free or not delta > highest:
            return x
        lower = x.copy()
        lower[self.asked.free.index("height")] *= highest / delta
        return lower
