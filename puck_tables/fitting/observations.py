"""The frames of a track that are fitted, and how noisy they are without asking any model.

Places, or angles, may be rounded to a step.  Where a puck crosses a step in a frame or less,
rounding is about white, a step over √12; where it crosses one in several frames, what is off runs
through all of the step and is 0 in the mean.  But where a coordinate stays at one value and comes
back, or ends there, all these frames are off by one and the same amount: they count as two.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.film.film import Track

Mask = npt.NDArray[np.bool_]  # what counts, or is so
ROUNDED = 1.0 / math.sqrt(12.0)  # of a step: the spread of what is rounded to it
_COARSE = 2.0  # times the noise that frames show: a step below is hidden by noise
_OFF = 0.05  # of a step, as its multiples may be off in a file
_FEWEST = 6  # values that differ


def step_of(*columns: FloatArray) -> float:
    """The step of which all values of some columns (n,) are multiples, from any one on; else 0.

    >>> x = 0.3 * np.arange(40) ** 1.5
    >>> step_of(x), round(step_of(0.5 * np.round(2.0 * x), 0.0 * x), 9)
    (0.0, 0.5)
    """
    result = [np.unique(column[np.isfinite(column)]) for column in columns]
    gaps = np.concatenate([np.diff(values) for values in result])
    if gaps.size < _FEWEST:
        return 0.0
    # values that are one to rounding of the file are no step
    gaps = gaps[gaps > 1e-9 * max(float(np.ptp(values)) for values in result)]
    repeated = any(1 < one.size < column.size for one, column in zip(result, columns, strict=True))
    if not gaps.size or not (repeated or gaps.max() > 1.5 * gaps.min()):  # it goes on evenly
        return 0.0
    step = float(np.median(gaps[gaps < 1.5 * gaps.min()]))
    size = np.round(gaps / step)
    step = float((gaps * size).sum() / (size * size).sum())
    deviations = np.concatenate([
        np.diff(values) / step - np.round(np.diff(values) / step) for values in result
    ])  # fmt: skip
    return step if np.abs(deviations).max() < _OFF else 0.0


def counting(values: FloatArray, step: float) -> Mask:
    """Which of some values in the order of time (n,) count, where they are rounded to a step.

    >>> values = np.array([0.0, 1e-16, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0, 1.0])
    >>> counting(values, 1.0).astype(int)
    array([1, 0, 1, 1, 1, 1, 1, 0, 0, 1, 1])
    """
    edges = np.flatnonzero(np.abs(np.diff(values)) > 0.5 * step) + 1
    firsts, ends = np.append(0, edges), np.append(edges, values.size)
    counts = np.ones(values.size, bool)
    for k, (first, end) in enumerate(zip(firsts, ends, strict=True)):
        inner = 0 < k < firsts.size - 1
        if inner and (values[first - 1] < values[first]) == (values[first] < values[end]):
            continue  # it crosses the step
        counts[first + 1 : end - 1] = False
    return counts


FEWEST = 4  # frames of a track
GIVE_NOISE = (
    "give the noise of places in m and of angles in rad (--noise 0.0003,0.005, noise=(0.0003, "
    "0.005)), or more frames"
)
_ALIKE = 0.1  # of the usual time between frames
MEDIAN = 0.6744897501960817  # of |a normal deviate|
_THIRD = math.sqrt(20.0)  # the spread of a third difference of deviates
_LAST = 5  # frames whose median is where the puck rests: two strays do not move it
_FEW_WINDOWS, _ALIKE_TURNS, _FOLLOWED = 3, 0.5, 1.5  # of turns: mean of e^(iθ); rad

_FASTER = 10.0  # times the fastest that a track goes from frame to frame
_RIM = 100.0  # times that speed: the rim, without angles
_TURNS = 20.0  # a frame, with angles
PLACES = ("launch_x", "launch_y")


class Straight(NamedTuple):
    """The line through ``point`` (x, y) m along ``direction`` (cos, sin), all places of a track.

    What lies across it was not measured: it has no noise, and tells nothing.
    """

    point: tuple[float, float]
    direction: tuple[float, float]

    @property
    def main(self) -> int:
        """0 where x tells the place, 1 where y does."""
        return int(abs(self.direction[1]) > abs(self.direction[0]))

    @property
    def slope(self) -> float:
        """By how much the other coordinate changes with the main one."""
        return self.direction[1 - self.main] / self.direction[self.main]


@dataclass(frozen=True, eq=False)
class Observations:
    """Frames of one track where its puck is seen.

    ``time`` (n,) s from ``start``; ``place`` (n, 2) m; ``angle`` (n,) rad, NaN where there is none,
    or None where there never is; ``frame`` (n,): numbers in the track; ``row`` (n,): how far down
    the picture, 0 at its first line and 1 at its last, or None; ``straight``: the line along which
    alone places are told, or None; ``cuttable``: whether frames at its start, and at its end, may
    be none of the free motion; ``steps``: to which places (m) and angles (rad) are rounded, 0 where
    noise hides that; ``counts`` (n, 3): whether x, y and angle count where they are, or None.
    """

    name: str
    start: float
    time: FloatArray
    place: FloatArray
    angle: FloatArray | None
    frame: npt.NDArray[np.int64]
    row: FloatArray | None = None
    straight: Straight | None = None
    cuttable: tuple[bool, bool] = (True, True)
    steps: tuple[float, float] = (0.0, 0.0)
    counts: Mask | None = None

    def part(self, chosen: Mask) -> Observations:
        """Some of the frames; the first of them is the new start."""
        names = ("place", "frame", "angle", "row", "counts")
        every = ((name, getattr(self, name)) for name in names)
        some: Any = {name: None if one is None else one[chosen] for name, one in every}
        first = float(self.time[chosen][0])
        return replace(self, start=self.start + first, time=self.time[chosen] - first, **some)

    def thinned(self, count: int) -> Observations:
        """So many of the frames, spread over all of them, or all if they are fewer."""
        chosen = np.zeros(self.time.size, bool)
        chosen[np.linspace(0, self.time.size - 1, count).astype(int)] = True
        return self.part(chosen)

    @property
    def angles(self) -> FloatArray:
        """The angle (n,) of each frame, rad, NaN where there is none."""
        return np.full(self.time.size, np.nan) if self.angle is None else self.angle

    @property
    def size(self) -> float:
        """How far its places go along x or y, m."""
        return float(np.ptp(self.place, axis=0).max())

    @property
    def usual_step(self) -> float:
        """The usual time between two frames, s."""
        return float(np.median(np.diff(self.time)))


def observations_in(
    track: Track, since: float = -math.inf, until: float = math.inf, keep_all: bool = False
) -> Observations:
    """The frames of a track, those of free motion if its start and end are told, or all are.

    >>> track = Track(0.1 * np.arange(9), np.zeros((9, 2)), name="a")
    >>> observations_in(track, since=0.25).time.size
    6
    """
    chosen = track.seen & (track.time >= since) & (track.time <= until)
    count = int(chosen.sum())
    if count < FEWEST:
        within = ""
        if since > -math.inf or until < math.inf:
            first, last = track.time[track.seen][[0, -1]].tolist()
            within = f" in the time asked for, of {first:.9g} s to {last:.9g} s"
        raise InputError(
            f"{track.name} shows the puck in {count} frame{'' if count == 1 else 's'}{within}: a "
            f"fit needs {FEWEST} or more"
        )
    angle = None if track.angle is None else track.angle[chosen]
    angle = None if angle is None or not np.isfinite(angle).any() else angle
    time = track.time[chosen]
    return _on_grid(Observations(
        track.name, float(time[0]), time - time[0], track.place[chosen], angle,
        np.flatnonzero(chosen), straight=_straight(track.place[chosen]),
        cuttable=(since == -math.inf and not keep_all, until == math.inf and not keep_all),
    ))  # fmt: skip


def _on_grid(film: Observations) -> Observations:
    """A film with what is to be known of its rounding."""
    place, angle = (
        0.0 if step <= _COARSE * noise else step  # noise (NaN where it is not known) hides it
        for step, noise in zip((step_of(*film.place.T), step_of(film.angles)), noise_of([film]),
        strict=True)
    )  # fmt: skip
    steps = place, angle
    if not any(steps):
        return film
    counts = np.ones((film.time.size, 3), bool)
    for k, rows in enumerate((*film.place.T, film.angles)):
        if step := steps[k // 2]:
            known = np.isfinite(rows)
            counts[known, k] = counting(rows[known], step)
    return replace(film, steps=steps, counts=counts)


def _straight(place: FloatArray) -> Straight | None:
    """The line on which all places (n, 2) lie, or nearer to it than their noise along it.

    Noise of two coordinates would spread far more across.

    >>> x = np.arange(20.0) + 0.1 * np.random.default_rng(1).normal(size=20)
    >>> _straight(np.stack([0.3 * x, 0.4 * x], axis=1)).direction
    (0.6, 0.8)
    """
    size = np.ptp(place, axis=0)
    if not size.any():
        return None
    point = np.median(place, axis=0)
    if size.all():
        direction = np.linalg.svd(place - place.mean(axis=0), full_matrices=False)[2][0]
        direction *= np.copysign(1.0, direction[np.abs(direction).argmax()])
        deviations = place - point
        noise = _spread([np.diff(deviations @ direction, 3)])
        if not np.ptp(deviations @ [-direction[1], direction[0]]) <= noise:
            return None
    else:
        direction = (size > 0.0).astype(np.float64)
    x, y, cosine, sine = np.round([*point, *direction], 15).tolist()
    return Straight((x, y), (cosine, sine))


def noise_of(films: list[Observations]) -> tuple[float, float]:
    """The spread of places (m) and angles (rad) about smooth motions, by their third differences.

    No model of the puck is in it, so it can judge one.  Of what is rounded it is no less than that
    leaves, however slow the puck is.  NaN where too few frames follow each other.

    >>> noise = np.random.default_rng(1).normal(0.0, 1e-3, (900, 2))
    >>> track = Track(0.01 * np.arange(900), noise + np.arange(900)[:, None])
    >>> round(noise_of([observations_in(track)])[0], 4)
    0.001
    """
    places, angles = [], []
    for film in films:
        step = np.diff(film.time)
        even = np.abs(step / np.median(step) - 1.0) < _ALIKE
        runs = even[2:] & even[1:-1] & even[:-2]
        axes = np.eye(2) if film.straight is None else np.array([film.straight.direction]).T
        places.append(np.diff(film.place @ axes, 3, axis=0)[runs])
        if film.angle is not None:
            third = np.diff(film.angle, 3)[runs]
            angles.append(wrapped(third[np.isfinite(third)]))
    # one of the two may be rounded, and hardly have any
    along = [_spread([one[:, k] for one in places if k < one.shape[1]]) for k in range(2)]
    known = [one for one in along if math.isfinite(one)]
    place = math.sqrt(sum(one * one for one in known) / len(known)) if known else math.nan
    result = place, _spread(angles)
    least = (max(film.steps[kind] for film in films) * ROUNDED for kind in range(2))
    one, other = (
        float(np.fmax(noise, step)) if step else noise
        for noise, step in zip(result, least, strict=True)
    )
    return one, other


def _spread(thirds: list[FloatArray]) -> float:
    values = np.concatenate(thirds) if thirds else np.empty(0)
    if values.size < 2 * FEWEST:
        return math.nan
    return float(np.median(np.abs(values))) / (MEDIAN * _THIRD)


def wrapped(angle: FloatArray) -> FloatArray:
    """Angles to within half a turn of 0.

    >>> wrapped(np.array([7.0])).round(3).tolist()
    [0.717]
    """
    return np.asarray(angle - 2.0 * math.pi * np.round(angle / (2.0 * math.pi)))


def rests_from(film: Observations, spread: float) -> int:
    """The first frame from which on the puck does not move any more; n where it does to the end.

    >>> x = np.minimum(np.arange(20.0), 9.0)
    >>> rests_from(observations_in(Track(np.arange(20.0), np.stack([x, 0 * x], axis=1))), 1e-3)
    9
    """
    end = np.median(film.place[-_LAST:], axis=0)
    away = np.hypot(*(film.place - end).T) > 5.0 * spread
    # an outlier is no motion: two frames in a row are
    moved = away[1:] & away[:-1]
    last = int(np.flatnonzero(moved)[-1]) + 2 if moved.any() else 0
    return last if film.time.size - last >= _LAST else film.time.size


@dataclass(frozen=True, eq=False)
class Turning:
    """How fast a body turns, up to whole turns from frame to frame.

    ``step`` s: the usual time between frames; ``time`` (w,) s, ``rate`` (w,) rad/s of windows of
    frames; ``angle`` (n,) rad of the frames in one piece, NaN where it is not known; ``sure``:
    whether rates can be followed from window to window.
    """

    step: float
    time: FloatArray
    rate: FloatArray
    angle: FloatArray
    sure: bool

    def with_more(self, full_turns: int, time: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rates (w,) and angles (n,) if the body makes so many more turns from frame to frame."""
        more = 2.0 * math.pi * full_turns
        return self.rate + more / self.step, self.angle + more * np.round(time / self.step)


def turning_of(film: Observations) -> Turning | None:
    """How fast the body of a track turns; None where no angles follow each other.

    Means over windows are taken on the circle, so that outliers hardly count.

    >>> t = 0.01 * np.arange(50)
    >>> film = observations_in(Track(t, np.zeros((50, 2)), (30.0 * t) % 6.28318530718))
    >>> turning = turning_of(film)
    >>> turning.rate.round(6).tolist()[:2], turning.angle[-1].round(6).item()
    ([30.0, 30.0], 14.7)
    """
    if film.angle is None:
        return None
    step = film.usual_step
    known = np.isfinite(film.angle[1:]) & np.isfinite(film.angle[:-1])
    follow = np.flatnonzero(known & (np.abs(np.diff(film.time) / step - 1.0) < _ALIKE))
    if follow.size < FEWEST - 1:
        return None
    windows = np.array_split(follow, follow.size // max(1, min(7, follow.size // 3)))
    forward = np.exp(1j * (film.angle[follow + 1] - film.angle[follow]))
    mean = np.array([part.mean() for part in np.array_split(forward, len(windows))])
    time = np.array([film.time[w].mean() + 0.5 * step for w in windows])
    phases = np.unwrap(np.angle(mean))
    rate = phases / step
    apart = np.abs(np.diff(phases)).max(initial=0.0)
    sure = len(windows) > _FEW_WINDOWS and np.abs(mean).min() > _ALIKE_TURNS and apart < _FOLLOWED
    speed = np.interp(film.time, time, rate)
    turned = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(film.time))])
    deviations = film.angle - turned
    middle = float(np.angle(np.nanmean(np.exp(1j * deviations))))
    angle = turned + middle + wrapped(deviations - middle)
    return Turning(step, time, rate, angle, bool(sure))


def robust_parabola(time: FloatArray, place: FloatArray, start: int, stop: int) -> FloatArray:
    """Coefficients (3, 2) of a parabola through frames, outliers weighing little."""
    t, p = time[start:stop], place[start:stop]
    powers = np.stack([np.ones(t.size), t, t * t], axis=1)[:, : min(3, max(1, t.size - 1))]
    weights = np.ones(t.size)
    result = np.zeros((3, 2))
    for _ in range(6):
        root = np.sqrt(weights)[:, None]
        coefficients = np.linalg.lstsq(powers * root, p * root, rcond=None)[0]
        deviations = np.hypot(*(p - powers @ coefficients).T)
        spread = max(float(np.median(deviations)), 1e-9 * float(np.abs(p).max()), 1e-150)
        weights = 1.0 / (1.0 + (deviations / (2.0 * spread)) ** 2) ** 2
    result[: len(coefficients)] = coefficients
    return result


def range_in(name: str, films: Sequence[Observations], radius: float) -> tuple[float, float]:
    """The range of a number of a launch, or of a wall that the pucks of some tracks meet."""
    place = np.concatenate([film.place for film in films])
    size = max(float(np.ptp(place, axis=0).max()), radius)
    if name in PLACES:
        along = place[:, PLACES.index(name)]
        return float(along.min()) - size, float(along.max()) + size
    if name == "wall_distance":
        most = float(np.hypot(*place.T).max()) + size + 2.0 * radius
        return -most, most
    fastest = max(
        float((np.hypot(*np.diff(film.place, axis=0).T) / np.diff(film.time)).max())
        for film in films
    )  # fmt: skip
    fastest = max(fastest, 1e-3 * radius / max(float(film.time[-1]) for film in films))
    if name in ("launch_vx", "launch_vy"):
        return -_FASTER * fastest, _FASTER * fastest
    if name == "launch_spin":
        turns = [
            2.0 * math.pi * _TURNS / film.usual_step for film in films if film.angle is not None
        ]
        most = max([_RIM * fastest / radius, *turns])
        return -most, most
    return -math.inf, math.inf  # an angle begins anew after each turn
