"""The residuals of tracks under a puck and its launches, and their derivatives.

The unknowns are the free numbers of the puck, shared by all tracks, then the launch of each track,
then the walls that are found.  Impacts begin further slides, whose launches follow.  Residuals are
in units of the noise: x, y and angle of every frame, then the priors.  Where time stamps jitter
they are those along the motion, across it, and of the angle at what the place says of the time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.asked import Asked
from puck_tables.fitting.chain import slopes_of_slides
from puck_tables.fitting.joined import Hit, Meeting, Slide, Wall, met
from puck_tables.fitting.launched import (
    SPIN,
    TIME,
    VX,
    VY,
    Moving,
    path_of,
    path_with_slopes,
    rates_of,
)
from puck_tables.fitting.parameters import LAUNCH, WALL
from puck_tables.fitting.seen import Seen, Straight, wrapped
from puck_tables.fitting.timing import weights_of

Found = dict[str, float]
X, Y, TURN = range(3)  # of a path
PLACE, ANGLE, PRIOR, UNSEEN = range(4)  # kinds of residuals; across a line there are none
_CURVE_STEP = 1e-4
_DRAGGED = 100.0  # drag times the length of a film
_MOTION = ("launch_vx", "launch_vy", "launch_spin")
LAUNCH_NAMES = tuple(LAUNCH)
_ACROSS = (("launch_y", "launch_vy"), ("launch_x", "launch_vx"))  # of lines that x, or y, tells
_WALL = -2  # the first wall in names, the next is one less


@dataclass(frozen=True, eq=False)
class Problem:
    """What least squares are asked.

    Parameters
    ----------
    asked : what is to be found of the puck
    films : the tracks
    noise : standard deviations of places (m) and angles (rad)
    tall : whether part of the base may lift
    whole : angles of each track in one piece (None: only up to whole turns)
    rests : whether the puck of each track rests until it is hit
    walls : that are met, None for those to be found
    meetings : impacts, in the order of time (s after the start of the first track)
    jitter : standard deviation of time stamps, s
    weights : what makes residuals of each track's frames independent (n, 3, 3); empty: the noise
    """

    asked: Asked
    films: tuple[Seen, ...]
    noise: tuple[float, float]
    tall: bool = False
    whole: tuple[FloatArray | None, ...] = ()
    rests: tuple[bool, ...] = ()
    walls: tuple[Wall | None, ...] = ()
    meetings: tuple[Meeting, ...] = ()
    jitter: float = 0.0
    weights: tuple[FloatArray, ...] = ()

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
    def kinds(self) -> npt.NDArray[np.int64]:
        """What kind each residual is of."""
        kinds = []
        for film in self.films:
            kinds += [PLACE] * film.time.size
            kinds += [PLACE if film.straight is None else UNSEEN] * film.time.size
            kinds += [ANGLE] * int(self._angled(film).sum())
        return np.array(kinds + [PRIOR] * len(self.priors), np.int64)

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
        """The range of each unknown: no δ higher than motions of such a puck are known."""
        pairs = np.array([self.asked.limits(name) for _, name in self.names]).reshape(-1, 2)
        for k, (_, name) in enumerate(self.names):
            if name == "delta":
                pairs[k, 1] = min(pairs[k, 1], self.asked.highest(self.tall))
            elif name in ("friction", "decel"):
                pairs[k, 1] = min(pairs[k, 1], self.asked.steepest(name))
            elif name == "drag":  # more leaves nothing, or all there is, of a speed
                most = _DRAGGED / max(float(film.time[-1]) for film in self.films)
                pairs[k] = max(pairs[k, 0], -most), min(pairs[k, 1], most)
        return pairs[:, 0], pairs[:, 1]

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

    def moving(self, found: Found) -> Moving:
        """What moves the puck."""
        return self.asked.moving(found, self.tall)

    def slides(self, x: FloatArray) -> tuple[list[list[Slide]], list[Hit]]:
        """The slides of each track, in their order, and the impacts between them.

        Times are those after the start of the first track.
        """
        found = self.found(x)
        slides = [
            [Slide(self._begin(n, found), launch)] for n, launch in enumerate(self.launches(x))
        ]
        hits = []
        if self.meetings:
            moving, walls = self.moving(found), self.found_walls(x)
            gyration = {**self.asked.known(), **found}["gyration"]
        for meeting in self.meetings:
            wall = None if meeting.wall < 0 else walls[meeting.wall]
            before = tuple(slides[n][-1] for n in meeting.films)
            hit = met(moving, gyration, self.asked.rims(found, wall is None), meeting, before, wall)
            for n, slide in zip(meeting.films, hit.after, strict=True):
                slides[n].append(slide)
            hits.append(hit)
        return slides, hits

    def _begin(self, n: int, found: Found) -> float:
        """When a track begins, s after the start of the first."""
        film = self.films[n]
        late = 0.0 if film.row is None else self.asked.readout(found) * float(film.row[0])
        return film.start - self.films[0].start + late

    def _times(self, n: int, found: Found) -> FloatArray:
        """The times of a track's frames after its first: lines of a picture are read in turn."""
        film = self.films[n]
        if film.row is None:
            return film.time
        late: FloatArray = self.asked.readout(found) * (film.row - film.row[0])
        return film.time + late

    def _parts(
        self, n: int, found: Found, slides: list[Slide]
    ) -> list[tuple[slice, FloatArray, Slide]]:
        """The frames of each slide of a track, their times after its launch, and the slide."""
        times = self._times(n, found)
        if len(slides) == 1:
            return [(slice(0, times.size), times, slides[0])]
        since = np.array([slide.since - slides[0].since for slide in slides])
        firsts = np.searchsorted(times, since[1:])
        ends = [0, *np.maximum.accumulate(firsts).tolist(), times.size]
        return [
            (slice(ends[m], ends[m + 1]), times[ends[m] : ends[m + 1]] - since[m], slide)
            for m, slide in enumerate(slides)
        ]

    def paths(self, x: FloatArray) -> list[FloatArray]:
        """Places and angles (3, n) of the model at the frames of each track."""
        return self._along(x, path_of, True)

    def rates(self, x: FloatArray) -> list[FloatArray]:
        """Velocity and spin (3, n) of the model at the frames of each track."""
        return self._along(x, rates_of, False)

    def _along(self, x: FloatArray, of: Along, placed: bool) -> list[FloatArray]:
        found = self.found(x)
        moving, (slides, _) = self.moving(found), self.slides(x)
        tracks = []
        for n, track in enumerate(slides):
            parts = [
                of(moving, slide.launch[2:4], float(slide.launch[4]), times)
                + (slide.launch[[0, 1, 5], None] if placed else 0.0)
                for _, times, slide in self._parts(n, found, track)
            ]
            tracks.append(parts[0] if len(parts) == 1 else np.concatenate(parts, axis=1))
        return tracks

    def off(self, x: FloatArray) -> list[FloatArray]:
        """Model less what was seen (3, n) of each track, m and rad; NaN where no angle was."""
        return self._off(self.paths(x))

    def _off(self, paths: list[FloatArray]) -> list[FloatArray]:
        rows = []
        for n, (film, path) in enumerate(zip(self.films, paths, strict=True)):
            turn = np.full(film.time.size, np.nan)
            if film.angle is not None:
                whole = self.whole[n] if self.whole else None
                turn = path[TURN] - (film.angle if whole is None else whole)
                if whole is None:
                    turn = wrapped(turn)
            rows.append(np.stack([path[X] - film.place[:, 0], path[Y] - film.place[:, 1], turn]))
        return rows

    def residuals(self, x: FloatArray) -> FloatArray:
        """All of them, in units of the noise."""
        return self._residuals(x, self.paths(x))

    def _residuals(self, x: FloatArray, paths: list[FloatArray]) -> FloatArray:
        rows = [self._weighed(n, off) for n, off in enumerate(self._off(paths))]
        rows += [np.array([(x[k] - value) / spread]) for k, value, spread in self.priors]
        return np.concatenate(rows)

    def _weighed(self, n: int, off: FloatArray) -> FloatArray:
        """What is off (3, n, …) in units of the noise, one frame's x after the other's, …"""
        angled = self._angled(self.films[n])
        if self.weights:
            known = np.where(angled.reshape(-1, *[1] * (off.ndim - 2)), off[TURN], 0.0)
            rows = np.einsum("nab,bn...->an...", self.weights[n], np.stack([*off[:TURN], known]))
        else:
            rows = off / np.array([self.noise[0], self.noise[0], self.noise[1]]).reshape(
                -1, *[1] * (off.ndim - 1)
            )
        straight = self.films[n].straight
        if straight is not None:
            if not self.weights:  # which lie along the motion
                rows[X] = straight.way[0] * rows[X] + straight.way[1] * rows[Y]
            rows[Y] = 0.0
        return np.concatenate([rows[X], rows[Y], rows[TURN, angled]])

    def usual(self, rows: FloatArray) -> float:
        """The median size of residuals of what is seen."""
        return float(np.median(np.abs(rows[self.kinds != UNSEEN])))

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Their derivatives, (residuals, unknowns)."""
        return self.residuals_and_jacobian(x)[1]

    def residuals_and_jacobian(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Both, from the same motions."""
        found = self.found(x)
        moving, (slides, _) = self.moving(found), self.slides(x)
        follow = slopes_of_slides(self, x) if self.meetings else []
        out = np.zeros((self.kinds.size, x.size))
        scales = {name: np.array(self.asked.slopes(found, name)) for name in self.asked.free}
        spots = {key: k for k, key in enumerate(self.names)}
        row, paths = 0, []
        for n, film in enumerate(self.films):
            path = np.empty((3, film.time.size))
            paths.append(path)
            whole = np.zeros((3, film.time.size, x.size))
            for m, (frames, times, slide) in enumerate(self._parts(n, found, slides[n])):
                velocity, spin = slide.launch[2:4], float(slide.launch[4])
                path[:, frames], slopes = path_with_slopes(moving, velocity, spin, times)
                path[:, frames] += slide.launch[[0, 1, 5], None]
                block = whole[:, frames]
                for name in self.asked.free:
                    k = spots[-1, name]
                    if self.asked.changes_curve(name):
                        block[:, :, k] = self._by_difference(found, name, times, slide)
                    else:
                        block[:, :, k] = np.einsum("k,kan->an", scales[name], slopes[3:TIME])
                    if name == "readout" and film.row is not None:
                        block[:, :, k] += slopes[TIME] * (film.row[frames] - film.row[0])
                if m == 0:
                    for name, axis in _SHIFTS.items():
                        if (n, name) in spots:
                            block[axis, :, spots[n, name]] = 1.0
                    for name, which in _PUSHES.items():
                        if (n, name) in spots:
                            block[:, :, spots[n, name]] = slopes[which]
                    if film.straight is not None:
                        self._along_line(n, block, slopes, film.straight)
                    continue
                since, place_x, place_y, *pushes, angle = follow[n][m]
                begin = np.zeros(x.size)
                if film.row is not None and (-1, "readout") in spots:
                    begin[spots[-1, "readout"]] = film.row[0]
                block -= slopes[TIME][:, :, None] * (since - begin)
                block += np.stack([place_x, place_y, angle])[:, None, :]
                for which, push in zip((VX, VY, SPIN), pushes, strict=True):
                    block += slopes[which][:, :, None] * push
            rows = self._weighed(n, whole)
            out[row : row + len(rows)] = rows
            row += len(rows)
        for n, (k, _, spread) in enumerate(self.priors):
            out[row + n, k] = 1.0 / spread
        return self._residuals(x, paths), out

    def _along_line(
        self, n: int, block: FloatArray, slopes: FloatArray, straight: Straight
    ) -> None:
        """What the other coordinate does with the main one, added to the derivatives (3, n, m)."""
        place, push = (LAUNCH_NAMES[straight.main + by] for by in (0, 2))
        spots = {name: k for k, (track, name) in enumerate(self.names) if track == n}
        if place in spots:
            block[1 - straight.main, :, spots[place]] = straight.slope
        if push in spots:
            block[:, :, spots[push]] += straight.slope * slopes[(VY, VX)[straight.main]]

    def _by_difference(
        self, found: Found, name: str, times: FloatArray, slide: Slide
    ) -> FloatArray:
        """The derivative of a path to what changes the curve itself."""
        low, high = self.asked.limits(name)
        ends = [min(max(found[name] + s * _CURVE_STEP, low), high) for s in (-1.0, 1.0)]
        path: list[FloatArray] = []
        for value in ends:
            moving = self.moving({**found, name: value})
            path.append(path_of(moving, slide.launch[2:4], float(slide.launch[4]), times))
        slope: FloatArray = (path[1] - path[0]) / (ends[1] - ends[0])
        return slope

    @staticmethod
    def _angled(film: Seen) -> npt.NDArray[np.bool_]:
        if film.angle is None:
            return np.zeros(film.time.size, bool)
        known: npt.NDArray[np.bool_] = np.isfinite(film.angle)
        return known

    def each(self) -> list[tuple[slice, slice, slice]]:
        """Where the residuals of each track stand: along x, along y, angles."""
        found, row = [], 0
        for film in self.films:
            n, angles = film.time.size, int(self._angled(film).sum())
            ends = row + n, row + 2 * n, row + 2 * n + angles
            found.append((slice(row, ends[0]), slice(ends[0], ends[1]), slice(ends[1], ends[2])))
            row = ends[2]
        return found

    def with_noise(
        self, noise: tuple[float, float], x: FloatArray,
        kept: npt.NDArray[np.bool_] | None = None, jitter: float | None = None,
    ) -> Problem:  # fmt: skip
        """The same with other noise; where time stamps jitter it depends on the motion ``x``.

        ``kept``: residuals that count: an angle is seen beside its place, if that counts.
        """
        moved = replace(self, noise=noise, jitter=self.jitter if jitter is None else jitter)
        if moved.jitter == 0.0:
            return moved
        weights = []
        for rates, (place, _, _) in zip(self.rates(x), self.each(), strict=True):
            placed = np.ones(rates.shape[1], bool) if kept is None else kept[place]
            weights.append(weights_of(noise, moved.jitter, rates, placed))
        return replace(moved, weights=tuple(weights))

    def with_films(self, films: tuple[Seen, ...]) -> Problem:
        """The same of other frames, before anything is known of their motion."""
        return replace(self, films=films, whole=(), weights=())


Along = Callable[[Moving, FloatArray, float, FloatArray], FloatArray]
_SHIFTS = {"launch_x": X, "launch_y": Y, "launch_angle": TURN}
_PUSHES = {"launch_vx": VX, "launch_vy": VY, "launch_spin": SPIN}
