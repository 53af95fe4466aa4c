"""What a film would tell, before it is made: Cramér–Rao bounds of a puck, a launch, a camera."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray, instance, one_velocity, positive, real
from puck_tables.errors import InputError
from puck_tables.fitting.certainty import Certainty, certainty_of
from puck_tables.fitting.checked_spec import spec_of
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.identifiability import minimum_sentence, mirror_sentence
from puck_tables.fitting.observations import FEWEST, Observations
from puck_tables.fitting.other_minima import mirrored, other_minima
from puck_tables.fitting.problem import Problem
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
        """Its frames of a motion that stops at a time.

        Raises
        ------
        InputError
            If they are too few or too many.
        """
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
    said = [minimum_sentence(minimum, False) for minimum in alternatives]
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
