"""The unknowns of tracks, the slides from impact to impact that they mean, and their derivatives.

A state at an impact changes with the launch of its slide and with what moves the puck; the moment t
with the gap of the rims, dt = dgap/u_n; the state after it with all of these, the wall and the
numbers of the rims.  The law of impact is differenced, and the chain is their product.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property, partial
from itertools import product

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.fit_spec import LAUNCH, MARK, MOST, OWN_MOTION, WALL, FitSpec
from puck_tables.fitting.forward_model import (
    AS_LAUNCH,
    DELTA,
    LEAST_NUMBER,
    PLACE,
    STEP,
    TIME,
    ImpactSpec,
    ImpactState,
    Moving,
    Rims,
    Slide,
    WallLine,
    impact_at,
    marked,
    slopes_after,
    states_and_slopes,
    states_of,
    turned,
)
from puck_tables.fitting.observations import PLACES, Observations, range_in

_DRAGGED = 100.0  # drag times the length of a film: nothing, or all there is, is left of a speed
_PRIOR = 8.0  # standard deviations of a prior
_NOTICED = 0.75  # of the time between frames, twice the error of a readout that the tracks tell
# scales are plausible within their own size, but not less than this
_LEAST = {"friction": 1e-3, "decel": 1e-2, "gravity": 1e-2, "height": 1e-4, "radius": 1e-4}
_SHAPE_STEP = 1e-4  # of what has a curve of its own at each value

NumbersOf = dict[str, float]
_MOTION = ("launch_vx", "launch_vy", "launch_spin")
_ACROSS = (("launch_y", "launch_vy"), ("launch_x", "launch_vx"))  # of lines that x, or y, tells
_WALL = -2  # the first wall in names, the next is one less


class Slides:
    """What is asked of some tracks, the unknowns that answer it, and how the pucks then move.

    They do in slides, of which impacts begin all but the first.
    """

    spec: FitSpec
    films: tuple[Observations, ...]
    tall: bool
    rests: tuple[bool, ...]
    walls: tuple[WallLine | None, ...]
    impact_specs: tuple[ImpactSpec, ...]

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
        launches, rests = [], self.rests or (False,) * len(self.films)
        every = enumerate(zip(self.films, rests, self.spinless, strict=True))
        for n, (film, rest, spinless) in every:
            known = {*self.spec.fixed, *(_MOTION if rest else ())}
            known |= {"launch_angle"} if film.angle is None else set()
            known |= {"launch_spin"} if spinless else set()
            known |= set() if film.straight is None else {*_ACROSS[film.straight.main]}
            launches += [(n, name) for name in LAUNCH if name not in known]
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
                ends = [*range_in(name, own, spec.puck.radius), *wanted]
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
            elif track == -1 and name in _LEAST:
                sizes.append(max(abs(result[name]), _LEAST[name]))
            elif track == -1:
                own = self.spec.parameters[name].plausible
                sizes.append(self.spec.puck.radius if name in MARK else own)
            elif name in ("launch_angle", "wall_angle"):
                sizes.append(1.0)
            elif name in (*PLACES, "wall_distance"):
                every = [film.place for film in ([self.films[track]] if track >= 0 else self.films)]
                sizes.append(float(np.ptp(np.concatenate(every), axis=0).max()) or radius)
            else:
                _, _, vx, vy, spin, _ = launches[track]
                slip = math.hypot(vx, vy, radius * spin) or 1.0
                sizes.append(slip / radius if name == "launch_spin" else slip)
        return np.asarray(np.maximum(np.array(sizes), 1e-12))

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

    def moving(self, result: NumbersOf) -> Moving:
        """What moves the puck."""
        return self.spec.moving(result, self.tall)

    def fastest(self, x: FloatArray) -> float:
        """The greatest slip at a launch, at the rim, m/s."""
        radius = self.spec.scales(self.numbers_at(x))[2]
        _, _, vx, vy, spin, _ = self.launches(x).T
        return float((np.hypot(vx, vy) + radius * np.abs(spin)).max())

    def slides(self, x: FloatArray) -> tuple[list[list[Slide]], list[ImpactState]]:
        """The slides of each track, in their order, and the impacts between them.

        Times are those after the start of the first track.
        """
        result, slides, impacts = self.numbers_at(x), [], []
        numbers = self.spec.numbers(result)
        for film, launch in zip(self.films, self.launches(x), strict=True):
            late = 0.0 if film.row is None else numbers.get("readout", 0.0) * float(film.row[0])
            slides.append([Slide(film.start - self.films[0].start + late, launch)])
        for impact_spec in self.impact_specs:
            before = tuple(slides[n][-1] for n in impact_spec.films)
            _, gyration, rims, wall = self._met(impact_spec.wall, x)
            impact = impact_at(self.moving(result), gyration, rims, impact_spec, before, wall)
            for n, slide in zip(impact_spec.films, impact.after, strict=True):
                slides[n].append(slide)
            impacts.append(impact)
        return slides, impacts

    def _met(self, wall: int, x: FloatArray) -> tuple[float, float, Rims, WallLine | None]:
        """Radius m, radius of gyration over it, rims, and the wall of an impact, by its number."""
        result, pair = self.numbers_at(x), wall < 0
        numbers, line = self.spec.numbers(result), None if pair else self.estimated_walls(x)[wall]
        return numbers["radius"], numbers["gyration"], self.spec.rims(result, pair), line

    def times(self, n: int, result: NumbersOf) -> FloatArray:
        """The times of a track's frames after its first: lines of a picture are read in turn."""
        film = self.films[n]
        if film.row is None:
            return film.time
        readout = self.spec.numbers(result).get("readout", 0.0)
        return np.asarray(film.time + readout * (film.row - film.row[0]))

    def _parts(
        self, n: int, result: NumbersOf, slides: list[Slide]
    ) -> list[tuple[slice, FloatArray, Slide]]:
        """The frames of each slide of a track, their times after its launch, and the slide."""
        times = self.times(n, result)
        since = np.array([slide.since - slides[0].since for slide in slides])
        firsts = np.searchsorted(times, since[1:])
        ends = [0, *np.maximum.accumulate(firsts).tolist(), times.size]
        return [
            (slice(ends[m], ends[m + 1]), times[ends[m] : ends[m + 1]] - since[m], slide)
            for m, slide in enumerate(slides)
        ]

    def states(self, x: FloatArray) -> list[FloatArray]:
        """The states (6, n) of the model at the frames of each track."""
        result = self.numbers_at(x)
        moving, (slides, _) = self.moving(result), self.slides(x)
        every = (self._parts(n, result, track) for n, track in enumerate(slides))
        return [np.concatenate([states_of(moving, one.launch, times) for _, times, one in parts],
                               axis=1) for parts in every]  # fmt: skip

    def paths(self, x: FloatArray) -> list[FloatArray]:
        """Places and angles (3, n) of the model at the frames of each track."""
        numbers = self.spec.numbers(self.numbers_at(x))
        return [marked(states[PLACE], numbers) for states in self.states(x)]

    def paths_and_slopes(
        self, x: FloatArray
    ) -> Iterator[tuple[FloatArray, FloatArray, npt.NDArray[np.int64]]]:
        """Places and angles (3, n) of each track, derivatives (3, n, k), and to which unknowns."""
        result, slides, changes = self.numbers_at(x), self.slides(x)[0], self.slopes_of_slides(x)
        at, owners = _Along(self, result), np.array([track for track, _ in self.names])
        for n, film in enumerate(self.films):
            # slides may follow from launches of other tracks
            columns = np.flatnonzero(bool(self.impact_specs) | (owners == -1) | (owners == n))
            path = np.empty((3, film.time.size))
            slopes = np.empty((3, film.time.size, columns.size))
            parts = self._parts(n, result, slides[n])
            for (frames, times, slide), change in zip(parts, changes[n], strict=True):
                states, own, rates = at.states_and_slopes(slide, change[:, columns], times, PLACE)
                if film.row is not None and (-1, "readout") in self.spots:
                    own[:, :, self.spots[-1, "readout"]] += rates * film.row[frames]
                path[:, frames], slopes[:, frames] = states[PLACE], own
            arm = marked(path, self.spec.numbers(result)) - path  # which turns with the body
            slopes[0] -= arm[1][:, None] * slopes[2]
            slopes[1] += arm[0][:, None] * slopes[2]
            for k, name in enumerate(self.spec.free):
                if name in MARK:
                    slopes[..., k] += marked(path, {**dict.fromkeys(MARK, 0.0), name: 1.0}) - path
            yield path + arm, slopes, columns

    def slopes_of_slides(self, x: FloatArray) -> list[list[FloatArray]]:
        """The derivatives of each slide of each track (7, m): since when, then its launch."""
        slopes = [[self._first(n, x.size)] for n in range(len(self.films))]
        if not self.impact_specs:
            return slopes
        slides, impacts = self.slides(x)
        at = _Along(self, self.numbers_at(x))
        for impact_spec, impact in zip(self.impact_specs, impacts, strict=True):
            before = []
            for n in impact_spec.films:  # how a state changes with the unknowns, and with time
                slide = slides[n][len(slopes[n]) - 1]
                since = np.array([impact.time - slide.since])
                _, out, speed = at.states_and_slopes(slide, slopes[n][-1], since, slice(6))
                before.append((out[AS_LAUNCH, 0], speed[AS_LAUNCH, 0]))
            after = slopes_after(impact, before, x, partial(self._met, impact_spec.wall))
            for n, one in zip(impact_spec.films, after, strict=True):
                slopes[n].append(one)
        return slopes

    @cached_property
    def spots(self) -> dict[tuple[int, str], int]:
        """Where each unknown stands, by its track and name."""
        return {key: k for k, key in enumerate(self.names)}

    def _first(self, n: int, size: int) -> FloatArray:
        """Of the first slide of a track."""
        result, film = np.zeros((7, size)), self.films[n]
        for k, name in enumerate(LAUNCH):
            if (n, name) in self.spots:
                result[1 + k, self.spots[n, name]] = 1.0
        if film.straight is not None:
            for main in (1 + film.straight.main, 3 + film.straight.main):
                result[main + 1 - 2 * film.straight.main] = film.straight.slope * result[main]
        if film.row is not None and (-1, "readout") in self.spots:
            result[0, self.spots[-1, "readout"]] = film.row[0]
        return result


class _Along:
    """States along slides, and their derivatives, for numbers of the puck."""

    def __init__(self, problem: Slides, result: NumbersOf) -> None:
        spec = problem.spec
        self._moving, self._nearby = problem.moving(result), list[Moving]()
        self._parts: list[tuple[int, float]] = []  # of the difference of each, by an unknown
        self._scales = np.zeros((7, len(spec.free)))  # which are the first unknowns
        for k, name in enumerate(spec.free):
            if not spec.changes_motion(name):
                self._scales[DELTA:TIME, k] = spec.slopes(result, name)
                continue
            value, (low, high) = result[name], spec.limits(name)
            step = STEP * max(abs(value), LEAST_NUMBER) * (1.0 if value < high else -1.0)
            ends = [value + step]
            if name in OWN_MOTION:  # known less well
                ends = [min(value + _SHAPE_STEP, high), max(value - _SHAPE_STEP, low)]
                step = ends[0] - ends[1]
            for end, part in zip(ends, (1.0 / step, -1.0 / step), strict=False):
                self._nearby.append(problem.moving({**result, name: end}))
                self._parts.append((k, part))

    def states_and_slopes(
        self, slide: Slide, change: FloatArray, times: FloatArray, rows: slice
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """States (6, n) at times (n,) after a launch, derivatives (k, n, m) of k rows, by time.

        ``change`` (7, m): of the slide.
        """
        states, every, differ = states_and_slopes(self._moving, slide.launch, times, self._nearby)
        slopes = every[:, rows].swapaxes(0, 1)
        by = np.zeros(change.shape)
        by[:DELTA], by[TIME] = change[3:6], -change[0]
        by[:, : self._scales.shape[1]] += self._scales
        out: FloatArray = (slopes.reshape(-1, 7) @ by).reshape(*slopes.shape[:2], -1)
        out[PLACE] += change[[1, 2, 6], None]
        if self._moving.motions.angle is not None:
            out += turned(slide.launch, states, every)[rows, :, None] * change[6]
        for (k, part), difference in zip(self._parts, differ, strict=True):
            out[:, :, k] += part * difference[rows]
        return states, out, slopes[:, :, TIME]
