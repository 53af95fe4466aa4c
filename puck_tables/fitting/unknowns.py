"""The unknowns of a fit, and the range in which each is looked for.

Those of the puck are shared by all tracks; then come the launch of each track and the walls that
are found.

Where a film does not tell a number, or another law moves its puck, a fit runs away along what all
looks alike: a puck that turns ever faster under ever more friction slows down as drag does.  So
ranges are what physics and the film leave: a launch is no farther from the track than its size, no
faster than the track by far, and its spin is of a body that somebody filmed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from itertools import product

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.fit_spec import FitSpec
from puck_tables.fitting.forward_model import WallLine
from puck_tables.fitting.observations import Observations
from puck_tables.fitting.parameters import LAUNCH, MOST, WALL

_DRAGGED = 100.0  # drag times the length of a film: nothing, or all there is, is left of a speed
_FASTER = 10.0  # times the fastest that a track goes from frame to frame
_RIM = 100.0  # times that speed: the rim, without angles
_TURNS = 20.0  # a frame, with angles
_PRIOR = 8.0  # standard deviations of a prior
_NOTICED = 0.75  # of the time between frames, twice the error of a readout that the tracks tell
# scales are plausible within their own size, but not less than this
_LEAST = {"friction": 1e-3, "decel": 1e-2, "gravity": 1e-2, "height": 1e-4, "radius": 1e-4}
_PLACES = ("launch_x", "launch_y")
_SPEEDS = ("launch_vx", "launch_vy")


def _of_films(name: str, films: Sequence[Observations], radius: float) -> tuple[float, float]:
    """The range of a number of a launch, or of a wall that the pucks of some tracks meet."""
    place = np.concatenate([film.place for film in films])
    size = max(float(np.ptp(place, axis=0).max()), radius)
    if name in _PLACES:
        along = place[:, _PLACES.index(name)]
        return float(along.min()) - size, float(along.max()) + size
    if name == "wall_distance":
        most = float(np.hypot(*place.T).max()) + size + 2.0 * radius
        return -most, most
    fastest = max(
        float((np.hypot(*np.diff(film.place, axis=0).T) / np.diff(film.time)).max())
        for film in films
    )  # fmt: skip
    fastest = max(fastest, 1e-3 * radius / max(float(film.time[-1]) for film in films))
    if name in _SPEEDS:
        return -_FASTER * fastest, _FASTER * fastest
    if name == "launch_spin":
        most = _RIM * fastest / radius
        for film in films:
            if film.angle is not None:
                most = max(most, 2.0 * math.pi * _TURNS / film.usual_step)
        return -most, most
    return -math.inf, math.inf  # an angle begins anew after each turn


NumbersOf = dict[str, float]
_MOTION = ("launch_vx", "launch_vy", "launch_spin")
_ACROSS = (("launch_y", "launch_vy"), ("launch_x", "launch_vx"))  # of lines that x, or y, tells
_WALL = -2  # the first wall in names, the next is one less


class Unknowns:
    """What is asked of some tracks, and the vector of unknowns that answers it."""

    spec: FitSpec
    films: tuple[Observations, ...]
    tall: bool
    rests: tuple[bool, ...]
    walls: tuple[WallLine | None, ...]

    @cached_property
    def launch_names(self) -> tuple[tuple[str, ...], ...]:
        """The unknowns of each launch."""
        result, rests = [], self.rests or (False,) * len(self.films)
        for film, rest, spinless in zip(self.films, rests, self.spinless, strict=True):
            known = {*self.spec.fixed, *(_MOTION if rest else ())}
            known |= {"launch_angle"} if film.angle is None else set()
            known |= {"launch_spin"} if spinless else set()
            known |= set() if film.straight is None else {*_ACROSS[film.straight.main]}
            result.append(tuple(name for name in LAUNCH if name not in known))
        return tuple(result)

    @cached_property
    def spinless(self) -> tuple[bool, ...]:
        """Which tracks are taken for slides without spin: those along a line, without angles.

        Unless something is said of their spin.
        """
        spec = self.spec
        said = any("launch_spin" in one for one in (spec.fixed, spec.priors, spec.bounds,
                                                    spec.start))  # fmt: skip
        return tuple(
            not said and film.straight is not None and film.angle is None for film in self.films
        )

    @cached_property
    def names(self) -> tuple[tuple[int, str], ...]:
        """(track, name) of every unknown; −1 for the puck, −2 for the first wall, and so on."""
        launches = [(n, name) for n, names in enumerate(self.launch_names) for name in names]
        walls = [_WALL - n for n, wall in enumerate(self.walls) if wall is None]
        return (*((-1, name) for name in self.spec.free), *launches, *product(walls, WALL))

    @cached_property
    def priors(self) -> tuple[tuple[int, float, float], ...]:
        """(unknown, value, standard deviation).

        That of a readout, unless it or bounds are given: a picture is read before the next one.
        """
        known = {**self.spec.priors}
        if self.read_within is not None:
            known["readout"] = 0.5 * self.read_within, 0.5 * self.read_within
        return tuple((k, *known[name]) for k, (_, name) in enumerate(self.names) if name in known)

    @property
    def read_within(self) -> float | None:
        """The usual time between two frames, s, None where readout has a prior or bounds."""
        if "readout" in (*self.spec.priors, *self.spec.bounds):
            return None
        return min(film.usual_step for film in self.films)

    @cached_property
    def limits(self) -> tuple[FloatArray, FloatArray]:
        """The least and the largest value of each unknown (m,).

        No δ is higher than motions of such a puck are known; bounds of the caller's are taken as
        they are, and his start and prior lie within.
        """
        spec, pairs = self.spec, []
        for track, name in self.names:
            low, high = spec.limits(name)
            if name == "delta":
                high = min(high, spec.highest(self.tall))
            elif name in ("friction", "decel"):
                high = min(high, spec.steepest(name))
            elif name == "drag":
                end = max(float(film.time[-1]) for film in self.films)
                most = min(_DRAGGED / end, MOST["drag"])
                low, high = max(low, -most), min(high, most)
            elif name not in spec.bounds and name in (*LAUNCH, *WALL):
                own = self.films if track < 0 else [self.films[track]]
                value, spread = spec.priors.get(name, (math.nan, 0.0))
                wanted = spec.start.get(name), value - _PRIOR * spread, value + _PRIOR * spread
                ends = [*_of_films(name, own, spec.puck.radius), *wanted]
                low, high = (float(of(np.array(ends, float))) for of in (np.nanmin, np.nanmax))
            pairs.append((low, high))
        low_high = np.array(pairs).reshape(-1, 2)
        return low_high[:, 0], low_high[:, 1]

    def plausible(self, x: FloatArray) -> FloatArray:
        """What is plausible for every unknown (m,): of scales their own size."""
        result, launches = self.numbers_at(x), self.launches(x)
        radius = self.spec.scales(result)[2]
        sizes = []
        for track, name in self.names:
            if name == "readout" and self.read_within is not None:
                sizes.append(_NOTICED * self.read_within)
            elif track == -1:
                own, least = self.spec.plausible(name), _LEAST.get(name)
                sizes.append(own if least is None else max(abs(result[name]), least))
            elif name in ("launch_angle", "wall_angle"):
                sizes.append(1.0)
            elif name in (*_PLACES, "wall_distance"):
                every = [film.place for film in ([self.films[track]] if track >= 0 else self.films)]
                sizes.append(float(np.ptp(np.concatenate(every), axis=0).max()) or radius)
            else:
                _, _, vx, vy, spin, _ = launches[track]
                slip = math.hypot(vx, vy, radius * spin) or 1.0
                sizes.append(slip / radius if name == "launch_spin" else slip)
        plausible: FloatArray = np.maximum(np.array(sizes), 1e-12)
        return plausible

    def numbers_at(self, x: FloatArray) -> NumbersOf:
        """The numbers of the puck that are found."""
        return dict(zip(self.spec.free, x[: len(self.spec.free)].tolist(), strict=True))

    def launches(self, x: FloatArray) -> FloatArray:
        """The launch (6,) of each track: x, y, vx, vy, spin, angle; (tracks, 6)."""
        out = np.empty((len(self.films), len(LAUNCH)))
        out[:] = [self.spec.fixed.get(name, 0.0) for name in LAUNCH]
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
        self, result: NumbersOf, launches: FloatArray, walls: tuple[WallLine, ...] = ()
    ) -> FloatArray:
        """The vector of unknowns from what they mean."""
        launch, wall = list(LAUNCH), list(WALL)
        return np.array([
            result[name] if track == -1 else launches[track, launch.index(name)] if track >= 0
            else walls[_WALL - track][wall.index(name)] for track, name in self.names
        ], float)  # fmt: skip

    def estimated_walls(self, x: FloatArray) -> tuple[WallLine, ...]:
        """All walls, given or found."""
        numbers = x[len(self.names) - len(WALL) * self.walls.count(None) :].reshape(-1, len(WALL))
        every = iter(numbers.tolist())
        return tuple(WallLine(*next(every)) if wall is None else wall for wall in self.walls)

    def within(self, x: FloatArray) -> FloatArray:
        """Unknowns with the height of the lowest of all pucks that move so, where many do."""
        delta, highest = self.spec.scales(self.numbers_at(x))[1], self.spec.highest(self.tall)
        if "height" not in self.spec.free or not delta > highest:
            return x
        lower = x.copy()
        lower[self.spec.free.index("height")] *= highest / delta
        return lower
