"""Frames that were not fitted, predicted: what says most about a model."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.fitting.certainty import Z95, Certainty
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.observations import FEWEST, Observations, rests_from
from puck_tables.fitting.problem import ANGLE, PLACE

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
) -> tuple[tuple[Observations, ...], tuple[npt.NDArray[np.bool_], ...]]:
    """The tracks with what is fitted of them alone, and which frames of each are predicted.

    Parameters
    ----------
    films : the tracks
    hold_out : the last share of the moving frames of each, or names of tracks of which the later
        half is
    spread : noise of places, m

    Raises
    ------
    InputError
    """
    if isinstance(hold_out, float):
        if not LEAST_SHARE <= hold_out <= LARGEST_SHARE:
            raise InputError(
                f"hold_out must be a share of the frames from {LEAST_SHARE:g} to {LARGEST_SHARE:g},"
                f" or names of tracks, got {hold_out:g}"
            )
        shares = [hold_out] * len(films)
    else:
        known = [film.name for film in films]
        for name in hold_out:
            if name not in known:
                raise InputError(f"hold_out names '{name}': the tracks are {', '.join(known)}")
        shares = [0.5 if film.name in hold_out else 0.0 for film in films]
    kept, later = [], []
    for film, share in zip(films, shares, strict=True):
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
    part: Estimate, certainty: Certainty, films: tuple[Observations, ...],
    later: tuple[npt.NDArray[np.bool_], ...],
) -> HeldOut:  # fmt: skip
    """How far the frames held out are from their predictions."""
    whole = part.problem.with_films(films).with_noise(part.problem.noise, part.x)
    rows, slopes = whole.residuals(part.x), whole.jacobian(part.x)
    by_fit = np.einsum("ik,kl,il->i", slopes, certainty.covariance, slopes)
    z, chosen = -rows / np.sqrt(1.0 + by_fit), np.zeros(rows.size, bool)
    for film, (x, y, turn), after in zip(films, whole.each(), later, strict=True):
        chosen[x] = after
        chosen[y] = after & (film.straight is None)
        if film.angle is not None:
            chosen[turn] = after[np.isfinite(film.angle)]
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
