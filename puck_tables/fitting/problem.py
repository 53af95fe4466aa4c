"""The residuals of tracks under a puck and its launches, and their derivatives.

The unknowns are the free numbers of the puck, shared by all tracks, then the launch of each track.
Residuals are in units of the noise: x, y and angle of every frame, then the priors.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.fitting.launched import SPIN, VX, VY, Moving, path_of, path_with_slopes
from puck_tables.fitting.parameters import LAUNCH, Asked
from puck_tables.fitting.seen import Seen, wrapped

Found = dict[str, float]
X, Y, TURN = range(3)  # of a path
PLACE, ANGLE, PRIOR = range(3)  # kinds of residuals
_CURVE_STEP = 1e-4


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
    """

    asked: Asked
    films: tuple[Seen, ...]
    noise: tuple[float, float]
    tall: bool = False
    whole: tuple[FloatArray | None, ...] = ()

    @cached_property
    def launch_names(self) -> tuple[tuple[str, ...], ...]:
        """The unknowns of each launch."""
        return tuple(
            tuple(
                name for name in LAUNCH
                if name not in self.asked.fixed
                and (name != "launch_angle" or film.angle is not None)
            )
            for film in self.films
        )  # fmt: skip

    @cached_property
    def names(self) -> tuple[tuple[int, str], ...]:
        """(track, name) of every unknown; −1 for the puck."""
        launches = [(n, name) for n, names in enumerate(self.launch_names) for name in names]
        return (*((-1, name) for name in self.asked.free), *launches)

    @cached_property
    def kinds(self) -> npt.NDArray[np.int64]:
        """What kind each residual is of."""
        kinds = []
        for film in self.films:
            kinds += [PLACE] * (2 * film.time.size)
            kinds += [ANGLE] * int(self._angled(film).sum())
        return np.array(kinds + [PRIOR] * len(self.priors), np.int64)

    @cached_property
    def priors(self) -> tuple[tuple[int, float, float], ...]:
        """(unknown, value, standard deviation)."""
        found = []
        for k, (_, name) in enumerate(self.names):
            if name in self.asked.priors:
                found.append((k, *self.asked.priors[name]))
        return tuple(found)

    @cached_property
    def limits(self) -> tuple[FloatArray, FloatArray]:
        """The range of each unknown: δ no higher than its motions are known."""
        pairs = np.array([self.asked.limits(name) for _, name in self.names]).reshape(-1, 2)
        for k, (_, name) in enumerate(self.names):
            if name == "delta":
                pairs[k, 1] = min(pairs[k, 1], self.asked.highest(self.tall))
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
        return out

    def unknowns(self, found: Found, launches: FloatArray) -> FloatArray:
        """The vector of unknowns from what they mean."""
        order = list(LAUNCH)
        values = [
            found[name] if track < 0 else launches[track, order.index(name)]
            for track, name in self.names
        ]
        return np.array(values, float)

    def moving(self, found: Found) -> Moving:
        """What moves the puck."""
        return self.asked.moving(found, self.tall)

    def paths(self, x: FloatArray) -> list[FloatArray]:
        """Places and angles (3, n) of the model at the frames of each track."""
        moving = self.moving(self.found(x))
        return [
            _placed(launch, path_of(moving, launch[2:4], float(launch[4]), film.time))
            for launch, film in zip(self.launches(x), self.films, strict=True)
        ]

    def residuals(self, x: FloatArray) -> FloatArray:
        """All of them, in units of the noise."""
        rows = []
        for n, (film, path) in enumerate(zip(self.films, self.paths(x), strict=True)):
            rows += [(path[X] - film.place[:, 0]) / self.noise[0]]
            rows += [(path[Y] - film.place[:, 1]) / self.noise[0]]
            angled = self._angled(film)
            if film.angle is not None:
                whole = self.whole[n] if self.whole else None
                if whole is None:
                    off = wrapped(path[TURN, angled] - film.angle[angled])
                else:
                    off = path[TURN, angled] - whole[angled]
                rows += [off / self.noise[1]]
        rows += [np.array([(x[k] - value) / spread]) for k, value, spread in self.priors]
        return np.concatenate(rows)

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Their derivatives, (residuals, unknowns)."""
        found = self.found(x)
        moving = self.moving(found)
        out = np.zeros((self.kinds.size, x.size))
        scales = {name: np.array(self.asked.slopes(found, name)) for name in self.asked.free}
        spots = {key: k for k, key in enumerate(self.names)}
        row = 0
        for n, (film, launch) in enumerate(zip(self.films, self.launches(x), strict=True)):
            velocity, spin = launch[2:4], float(launch[4])
            _, slopes = path_with_slopes(moving, velocity, spin, film.time)
            angled = self._angled(film)
            rows = 2 * film.time.size + int(angled.sum())

            def stacked(path: FloatArray, angled: npt.NDArray[np.bool_] = angled) -> FloatArray:
                place = path[:TURN].ravel() / self.noise[0]
                return np.concatenate([place, path[TURN, angled] / self.noise[1]])

            block = out[row : row + rows]
            for name in self.asked.free:
                k = spots[-1, name]
                block[:, k] = stacked(np.einsum("k,kan->an", scales[name], slopes[3:]))
                if self.asked.changes_curve(name):
                    block[:, k] += stacked(self._by_difference(found, name, film, launch))
            one = np.zeros((3, film.time.size))
            shifts = {"launch_x": X, "launch_y": Y, "launch_angle": TURN}
            for name, which in shifts.items():
                if (n, name) in spots:
                    one[which] = 1.0
                    block[:, spots[n, name]] = stacked(one)
                    one[which] = 0.0
            for name, which in (("launch_vx", VX), ("launch_vy", VY), ("launch_spin", SPIN)):
                if (n, name) in spots:
                    block[:, spots[n, name]] = stacked(slopes[which])
            row += rows
        for n, (k, _, spread) in enumerate(self.priors):
            out[row + n, k] = 1.0 / spread
        return out

    def _by_difference(self, found: Found, name: str, film: Seen, launch: FloatArray) -> FloatArray:
        """The derivative of a path to what changes the curve itself."""
        low, high = self.asked.limits(name)
        ends = [min(max(found[name] + s * _CURVE_STEP, low), high) for s in (-1.0, 1.0)]
        path: list[FloatArray] = []
        for value in ends:
            moving = self.moving({**found, name: value})
            path.append(path_of(moving, launch[2:4], float(launch[4]), film.time))
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

    def with_noise(self, noise: tuple[float, float]) -> Problem:
        """The same with other noise."""
        return replace(self, noise=noise)


def _placed(launch: FloatArray, path: FloatArray) -> FloatArray:
    """Where the puck is, from how far it has come."""
    return path + launch[[0, 1, 5], None]


Residuals = Callable[[FloatArray], FloatArray]
