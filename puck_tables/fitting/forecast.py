"""What is foretold: of a film before it is made, and of frames that a fit has not seen.

The first are Cramér–Rao bounds of a puck, a launch, a camera.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray, instance, one_velocity, positive, real
from puck_tables.errors import InputError
from puck_tables.fitting.certainty import Z95, Certainty, certainty_of
from puck_tables.fitting.checked_spec import spec_of
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.observations import FEWEST, Mask, Observations, rests_from
from puck_tables.fitting.other_minima import mirrored, other_minima
from puck_tables.fitting.problem import ANGLE, PLACE, Problem
from puck_tables.fitting.remarks import minimum_sentence, mirror_sentence
from puck_tables.io.columns import Dataset, variable
from puck_tables.puck import Puck
from puck_tables.result import Result

MOST_FRAMES = 1_000_000  # of a film that is planned: more is a slip of the hand
_FASTEST = 1e6  # m/s
_RANGES = {
    "fps": ("1/s", 1e-6, 1e9), "place_noise": ("m", 1e-12, 1e3), "angle_noise": ("rad", 1e-12, 1e3),
    "duration": ("s", 1e-9, 1e9),
}  # fmt: skip


@dataclass(frozen=True)
class Camera:
    """A film: frames a second, noise, and how long it lasts.

    Parameters
    ----------
    fps : 1/s, 1e-6 to 1e9
    place_noise : m, 1e-12 to 1e3, of each of x and y in a frame
    angle_noise : rad, 1e-12 to 1e3, of the body in a frame; None without marks
    duration : s, 1e-9 to 1e9, from the launch; None: to the stop

    Raises
    ------
    InputError

    Examples
    --------
    >>> Camera(120.0, 0.3e-3, 5e-3).duration is None
    True
    """

    fps: float
    place_noise: float
    angle_noise: float | None = None
    duration: float | None = None

    def __post_init__(self) -> None:
        for name, (unit, low, high) in _RANGES.items():
            if getattr(self, name) is not None or name in ("fps", "place_noise"):
                number = positive(name, getattr(self, name), unit)
                if not low <= number <= high:
                    fault = f"from {low:g} to {high:g} {unit}, got {number:g}"
                    raise InputError(f"{name} must be {fault}")
                object.__setattr__(self, name, number)

    def film(self, stop_time: float) -> Observations:
        """Its frames of a motion that stops at a time; refused if they are too few or too many."""
        duration = stop_time if self.duration is None else self.duration
        count = math.floor(min(duration * self.fps, 2.0 * MOST_FRAMES) * (1.0 + 1e-12)) + 1
        if not FEWEST <= count <= MOST_FRAMES:
            words = f"{count}" if count <= MOST_FRAMES else f"{duration * self.fps:.4g}"
            raise InputError(
                f"{duration:.4g} s at {self.fps:g} frames a second are {words} frames: a forecast "
                f"takes {FEWEST} to {MOST_FRAMES}"
            )
        angle = None if self.angle_noise is None else np.zeros(count)
        return Observations(
            "film", 0.0, np.arange(count) / self.fps, np.zeros((count, 2)), angle, np.arange(count)
        )


@dataclass(frozen=True, eq=False, repr=False)
class Forecast(Result):
    """What a film would tell.

    ``names``, ``values``, ``errors``: of what would be found, the puck's numbers first, then those
    of the launch; an error is infinite where the film does not determine the number.  ``frames``:
    how many it has; ``rivals``: a sentence for each other motion that the film would look like,
    whose numbers it therefore does not determine.
    """

    puck: Puck
    velocity: tuple[float, float]
    spin: float
    camera: Camera
    free: tuple[str, ...]
    names: tuple[str, ...]
    values: FloatArray
    errors: FloatArray
    frames: int
    rivals: tuple[str, ...]
    correlation: FloatArray = field(repr=False)

    picture: ClassVar[str] = "forecast"

    def __repr__(self) -> str:
        words = ", ".join(f"{name} +- {self[name]:.2g}" for name in self.free)
        return f"Forecast({words}; {self.frames} frames)"

    def __getitem__(self, name: str) -> float:
        """The standard error of a number by its name."""
        if name not in self.names:
            raise InputError(f"there is no '{name}': this forecast has {', '.join(self.names)}")
        return float(self.errors[self.names.index(name)])

    def explain(self) -> str:
        """How it was got."""
        bounds = (
            f"Cramér–Rao bounds: the inverse of the Fisher matrix of {len(self.names)} unknowns "
            f"and {self.frames} frames, in the derivatives of the motion."
        )
        return "\n".join([bounds, *self.rivals])

    def over(self, speeds: FloatArray, spins: FloatArray, name: str) -> FloatArray:
        """The error of a number for launches of other speeds (m,) and spins (n,), (m, n).

        That of the motion itself: other motions which look alike are not searched for.
        """
        errors = np.empty((speeds.size, spins.size))
        for i, speed in enumerate(speeds.tolist()):
            for k, spin in enumerate(spins.tolist()):
                launch = (speed, 0.0), spin
                try:
                    _, forecast = _forecast_estimate(self.puck, *launch, self.camera, self.free)
                    errors[i, k] = forecast.errors[self.names.index(name)]
                except InputError:  # a film of too few frames
                    errors[i, k] = np.inf
        return errors

    def dataset(self) -> Dataset:
        """One row a number."""
        variables = {"name": list(self.names), "value": self.values, "error": self.errors}
        columns = {f"number_{key}": variable(f"number_{key}", one, ("number",))
                   for key, one in variables.items()}  # fmt: skip
        attributes = {
            "title": "What a film of a puck would tell", "frames": self.frames,
            "fps": self.camera.fps, "launch_velocity": list(self.velocity),
            "launch_spin": self.spin, **self.puck.described(),
        }  # fmt: skip
        return Dataset({}, columns, attributes)


def fisher(
    puck: Puck, launch: Any, camera: Camera, *, free: Iterable[str] = ("friction", "delta")
) -> Forecast:
    """What a film of a launch would tell of a puck, before the experiment.

    Parameters
    ----------
    puck : Puck
        On a base that is not round its x axis points along x at the launch.
    launch : :class:`puck_tables.Launch`, or anything with ``velocity`` (m/s) and ``spin`` (rad/s)
    camera : Camera
    free : names of what would be found of the puck, as :func:`fit` takes them

    Returns
    -------
    Forecast
        ``forecast["friction"]`` is the standard error of the best possible estimate, with the
        launch unknown.  Its picture shows it over speed and spin.

    Raises
    ------
    InputError

    Notes
    -----
    Σ = (Jᵀ J)⁻¹ with J the derivatives of places and angles in all frames over their noise; for
    Gaussian noise no unbiased estimate has a smaller covariance.

    References
    ----------
    C. R. Rao 1945; H. Cramér 1946.

    Examples
    --------
    >>> from puck_tables import Launch
    >>> puck = Puck(radius=0.0381, height=0.0254, friction=0.15)
    >>> film = fisher(puck, Launch((2.0, 0.0), spin=60.0), Camera(120.0, 0.3e-3, 5e-3))
    >>> round(film["friction"] / puck.friction, 6), round(film["delta"], 4)
    (6.9e-05, 0.0006)
    """
    instance("puck", puck, Puck)
    instance("camera", camera, Camera)
    velocity = one_velocity(getattr(launch, "velocity", None))  # type: ignore[arg-type]
    spin = real("spin", getattr(launch, "spin", None), "rad/s")  # type: ignore[arg-type]
    seen, known = _forecast_estimate(puck, velocity, spin, camera, free)
    problem, errors = seen.problem, known.errors
    alternatives = () if camera.angle_noise is not None else other_minima(seen, known)
    unsigned = mirrored(seen, known)
    names = tuple(name for _, name in problem.names)
    for minimum in alternatives:
        errors[[k for k, name in enumerate(names) if name in minimum.numbers]] = np.inf
    if unsigned:
        errors[names.index("launch_spin")] = np.inf
    said = [minimum_sentence(minimum, seen, False) for minimum in alternatives]
    said += [mirror_sentence("the film") for _ in unsigned]
    return Forecast(
        puck, velocity, spin, camera, problem.spec.free, names, seen.x, errors,
        problem.films[0].time.size, tuple(said), known.correlation,
    )  # fmt: skip


def _forecast_estimate(
    puck: Puck, velocity: tuple[float, float], spin: float, camera: Camera, free: Iterable[str]
) -> tuple[Estimate, Certainty]:
    """What would be found of a film of a launch without noise, and how well it is told."""
    spec = spec_of(puck, free, {}, {}, {}, {})
    if spec.base is not None and camera.angle_noise is None:
        raise InputError(
            "a film of a puck on a base tells something by its angles: give angle_noise"
        )
    slip = math.hypot(*velocity, puck.radius * spin)
    if not 0.0 < slip <= _FASTEST:
        raise InputError(
            f"a film is of a launch whose base slips at up to {_FASTEST:g} m/s, and at more than 0 "
            f"m/s, got {slip:g} m/s"
        )
    film = camera.film(float(puck.stop(velocity, spin).stop_time))
    noise = camera.place_noise, camera.angle_noise or 1.0
    problem = Problem(spec, (film,), noise, tall=spec.puck.delta > 1.0)
    numbers = {**spec.known(), "decel": puck.decel, "delta": spec.puck.delta}
    values = {name: numbers[name] for name in spec.free}
    x = problem.unknowns(values, np.array([[0.0, 0.0, *velocity, spin, 0.0]]))
    rows, slopes = problem.residuals_and_jacobian(x)
    certainty = certainty_of(slopes, problem.plausible(x))
    places = rows[: 2 * film.time.size].reshape(2, -1).T * camera.place_noise  # all were seen at 0
    problem = problem.with_films((replace(film, place=places),))
    kept = np.ones(rows.size, bool)
    return Estimate(problem, x, kept, problem.residuals(x), slopes), certainty


# of the frames, that may be held out: some that judge, and some to fit to
LEAST_SHARE, LARGEST_SHARE = 0.05, 0.9


@dataclass(frozen=True, eq=False)
class HeldOut:
    """Predictions of frames that the fit did not see.

    ``tracks``: whose later part it is; ``z_place`` (n,), ``z_angle`` (m,): what was seen less what
    was predicted, over the standard deviation of noise and prediction together; ``chance``: the
    range in which :attr:`rms` lies by chance, 95 of 100 times, if the model is right.
    """

    tracks: tuple[str, ...]
    z_place: FloatArray
    z_angle: FloatArray
    chance: tuple[float, float]

    @property
    def inside(self) -> float:
        """The share of observations within 95 % of their prediction."""
        every = np.abs(np.concatenate([self.z_place, self.z_angle]))
        return float(np.mean(every < Z95))

    @property
    def rms(self) -> float:
        """The root mean square of z; 1 where the model and its errors are right.

        An outlier counts as four.
        """
        every = np.clip(np.concatenate([self.z_place, self.z_angle]), -4.0, 4.0)
        return float(np.sqrt(np.mean(every**2)))


def split(
    films: tuple[Observations, ...], hold_out: float | tuple[str, ...], spread: float
) -> tuple[tuple[Observations, ...], tuple[Mask, ...]]:
    """The tracks with what is fitted of them alone, and which frames of each are predicted.

    That is the last share of the moving frames of each, or the later half of tracks that are named;
    ``spread`` m: noise of places.
    """
    if isinstance(hold_out, float) and not LEAST_SHARE <= hold_out <= LARGEST_SHARE:
        raise InputError(
            f"hold_out must be a share of the frames from {LEAST_SHARE:g} to {LARGEST_SHARE:g}, or "
            f"names of tracks, got {hold_out:g}"
        )
    names = [film.name for film in films]
    for name in () if isinstance(hold_out, float) else hold_out:
        if name not in names:
            raise InputError(f"hold_out names '{name}': the tracks are {', '.join(names)}")
    kept, later = [], []
    for film in films:
        share = hold_out if isinstance(hold_out, float) else 0.5 * (film.name in hold_out)
        moving = rests_from(film, spread)
        count = film.time.size if share == 0.0 else round((1.0 - share) * moving)
        if count < FEWEST + 2 and share > 0.0:
            raise InputError(
                f"{film.name} would keep {count} frames: hold out a smaller share, or other tracks"
            )
        after = np.arange(film.time.size) >= count
        kept.append(film.part(~after))
        later.append(after)
    return tuple(kept), tuple(later)


def predicted(
    part: Estimate, certainty: Certainty, films: tuple[Observations, ...], later: tuple[Mask, ...]
) -> HeldOut:
    """How far the frames held out are from their predictions."""
    whole = part.problem.with_films(films).with_noise(part.problem.noise, part.x)
    rows, slopes = whole.residuals_and_jacobian(part.x)
    by_fit = np.einsum("ik,kl,il->i", slopes, certainty.covariance, slopes)
    z, chosen = -rows / np.sqrt(1.0 + by_fit), np.zeros(rows.size, bool)
    for film, (x, y, turn), after in zip(films, whole.each(), later, strict=True):
        chosen[x] = after
        chosen[y] = after & (film.straight is None)
        chosen[turn] = after[np.isfinite(film.angles)]
    names = tuple(film.name for film, after in zip(films, later, strict=True) if after.any())
    noise_degrees = math.inf if certainty.degrees == math.inf else part.degrees
    return HeldOut(
        names, z[chosen & (whole.kinds == PLACE)], z[chosen & (whole.kinds == ANGLE)],
        _by_chance(slopes[chosen], by_fit[chosen], certainty.covariance, noise_degrees),
    )  # fmt: skip


def _by_chance(
    slopes: FloatArray, by_fit: FloatArray, covariance: FloatArray, noise_degrees: float
) -> tuple[float, float]:
    """Between which the rms of z lies with 95 %, over ``noise_degrees`` of its noise.

    The z of one motion err together: with R their correlations Σz² is as (n/ν) χ² of
    ν = n²/tr R² degrees (Satterthwaite), over the noise that was told as F.
    """
    from scipy.special import chdtri, fdtri

    weight = 1.0 / (1.0 + by_fit)
    shared = covariance @ (slopes.T * weight) @ slopes
    square = float(np.sum(weight**2 * (1.0 + 2.0 * by_fit)) + np.sum(shared * shared.T))
    degrees = by_fit.size**2 / square
    if noise_degrees == math.inf:
        ends = [chdtri(degrees, tail) / degrees for tail in (0.975, 0.025)]
    else:
        ends = [fdtri(degrees, noise_degrees, share) for share in (0.025, 0.975)]
    return math.sqrt(ends[0]), math.sqrt(ends[1])
