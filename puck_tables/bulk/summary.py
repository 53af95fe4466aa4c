"""What samples tell: mean, covariance, quantiles, where they end, and the chance of a region."""

from __future__ import annotations

import math
from collections.abc import Sequence
from copy import copy
from typing import Any, NamedTuple, Self

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray, finite_array, listed, shown, whole
from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS

_SIGMAS = 1.959963984540054  # of a 95 % interval
_MOST_BINS = 4096  # along one axis of a picture: finer than any screen
_SHARES = (0.025, 0.5, 0.975)  # of the quantiles of a table: the median, and 95 % of all
_WIDE = 18  # signs of its first column
Bins = npt.NDArray[np.bool_]


class Chance(NamedTuple):
    """A share of samples, and the 95 % interval of the chance that it estimates (Wilson's)."""

    value: float
    low: float
    high: float


class Summary:
    """Summaries of a result over samples.

    A kind of result gives ``summed``, the names of its columns over samples that have a mean, and
    ``place``, those of the two that are where it ends.  Samples that have no end (NaN) do not
    count; ``ended`` says how many do.
    """

    summed: tuple[str, ...]
    place: tuple[str, str]
    regions: tuple[npt.ArrayLike, ...] = ()

    def within(self, *regions: npt.ArrayLike) -> Self:
        """Samples whose summary and picture tell how many of them end inside regions.

        Parameters
        ----------
        regions : each (x, y, r), a disc; (x1, y1, x2, y2), a rectangle; or corners (n, 2); m

        Raises
        ------
        InputError
            If a region is none of these, or empty.

        Examples
        --------
        >>> from puck_tables import Normal, Puck
        >>> found = Puck.similar().sample(10_000, 7, spin=Normal(5.0, 0.2), speed=1.0)
        >>> found.within((2.2, -0.16, 0.1)).summary().splitlines()[-1][:55]
        'ends inside (2.2, -0.16, 0.1) m with a chance of 0.7563'
        """
        checked_regions(regions)
        result = copy(self)
        object.__setattr__(result, "regions", regions)
        return result

    def counted(self, name: str) -> FloatArray:
        """A column (samples,), NaN where it does not count."""
        return np.asarray(getattr(self, name), np.float64).ravel()

    def _rows(self, names: Sequence[str] | None = None) -> FloatArray:
        known = ", ".join(self.summed)
        names = self.summed if names is None else listed("names", names, "columns")
        if not len(names):
            raise InputError(f"names must be some of the columns {known}")
        for name in names:
            if not isinstance(name, str) or name not in self.summed:
                raise InputError(f"{shown(name)} is no column of samples: there are {known}")
        rows = np.stack([self.counted(name) for name in names])
        kept = rows[:, np.isfinite(rows).all(axis=0)]
        if kept.shape[1] < 2:
            raise InputError("fewer than two samples have an end: there is nothing to sum up")
        return kept

    @property
    def ended(self) -> int:
        """How many samples have an end."""
        return int(self._rows(self.place).shape[1])

    def mean(self) -> dict[str, float]:
        """Means by column, SI units."""
        return {name: float(self._rows((name,))[0].mean()) for name in self.summed}

    def covariance(self, names: Sequence[str] | None = None) -> FloatArray:
        """Covariance (n, n) of these columns, of all without ``names``; SI units."""
        return np.atleast_2d(np.cov(self._rows(names)))

    def quantiles(
        self, shares: npt.ArrayLike = (0.025, 0.25, 0.5, 0.75, 0.975)
    ) -> dict[str, FloatArray]:
        """Values below which shares of the samples, 0 to 1, lie, by column; else InputError."""
        wanted = finite_array("shares", shares, "1")
        if wanted.ndim > 1 or not wanted.size or not ((wanted >= 0.0) & (wanted <= 1.0)).all():
            raise InputError("shares of quantiles must be numbers from 0 to 1")
        return {
            name: np.asarray(np.quantile(self._rows((name,))[0], wanted)) for name in self.summed
        }

    def density(
        self, bins: int = 100, extent: npt.ArrayLike | None = None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Where it ends: edges (bins + 1,) along x and y, and the density (bins, bins), 1/m².

        Parameters
        ----------
        bins : along each side, 1 to 4096
        extent : (x1, x2, y1, y2), m; without it, that of all samples

        Raises
        ------
        InputError
        """
        bins = whole("bins", bins, 1, _MOST_BINS)
        x, y = self._rows(self.place)
        if extent is None:
            sides = [_sides(x), _sides(y)]
        else:
            ends = finite_array("extent", extent, "m")
            sides = [(ends[0], ends[1]), (ends[2], ends[3])] if ends.shape == (4,) else []
            if ends.shape != (4,) or not (ends[1] > ends[0] and ends[3] > ends[2]):
                raise InputError("extent must be (x1, x2, y1, y2) with x1 < x2 and y1 < y2, in m")
        counts, across, along = np.histogram2d(x, y, bins, sides)
        area = (across[1] - across[0]) * (along[1] - along[0])
        return across, along, counts / (x.size * area)

    def chance(self, region: npt.ArrayLike) -> Chance:
        """The chance to end inside a region.

        Parameters
        ----------
        region : (x, y, r), a disc; (x1, y1, x2, y2), a rectangle; or corners (n, 2) of a polygon; m

        Raises
        ------
        InputError
            If the region is none of these, or empty.
        """
        inside = inside_of(region, *(self.counted(name) for name in self.place))
        if self.ended < 2:
            self._rows(self.place)
        return chance_of(int(np.count_nonzero(inside)), self.ended)

    def summary(self) -> str:
        """Means, deviations and quantiles in a table, and the chances of regions; lines of text."""
        return "\n".join([head(), *self.rows(self.summed), *self.chances(self.regions)])

    def rows(self, names: Sequence[str], label: str = "", wide: int = _WIDE) -> list[str]:
        """Means, deviations and quantiles of columns, as a table; none of less than two samples."""
        result = []
        for name in names:
            own = self.counted(name)
            own = own[np.isfinite(own)]
            if own.size > 1:
                numbers = (own.mean(), own.std(ddof=1), *np.quantile(own, _SHARES))
                words = "".join(f"{number:>13.6g}" for number in numbers)
                result.append(f"{f'{label}{name} {COLUMNS[name].unit}':<{wide}}{words}")
        return result

    def chances(self, regions: Sequence[npt.ArrayLike]) -> list[str]:
        """How its places hang together, and the chances of regions, in words."""
        lines, places = [], np.stack([self.counted(name) for name in self.place])
        places = places[:, np.isfinite(places).all(axis=0)]
        if places.shape[1] > 1 and (places.std(axis=1) > 0.0).all():
            correlation = float(np.corrcoef(*places)[0, 1])
            lines.append(f"correlation of {self.place[0]} and {self.place[1]}: {correlation:.4g}")
        for region in regions:
            one = self.chance(region)
            numbers = finite_array("region", region, "m").ravel()
            words = ", ".join(f"{number:g}" for number in numbers)
            lines.append(
                f"ends inside ({words}) m with a chance of {one.value:.6g} "
                f"(95 %: {one.low:.6g} to {one.high:.6g})"
            )
        return lines


def head(wide: int = _WIDE) -> str:
    """The head of the table of a summary.

    >>> head(2).split()
    ['mean', 'deviation', '2.5', '%', '50', '%', '97.5', '%']
    """
    return f"{'':<{wide}}{'mean':>13}{'deviation':>13}{'2.5 %':>13}{'50 %':>13}{'97.5 %':>13}"


def chance_of(in_region: int, samples: int) -> Chance:
    """The chance that so many hits speak for.

    >>> [round(one, 4) for one in chance_of(50, 100)]
    [0.5, 0.4038, 0.5962]
    """
    share, z = in_region / samples, _SIGMAS
    scale = 1.0 / (1.0 + z * z / samples)
    middle = scale * (share + z * z / (2 * samples))
    half = scale * z * math.sqrt(share * (1.0 - share) / samples + (z / (2 * samples)) ** 2)
    low = 0.0 if in_region == 0 else max(0.0, middle - half)  # but for rounding
    return Chance(share, low, 1.0 if in_region == samples else min(1.0, middle + half))


def inside_of(region: npt.ArrayLike, x: FloatArray, y: FloatArray) -> Bins:
    """Whether places (n,) lie inside a region, see :meth:`Summary.chance`.

    Raises InputError.

    >>> inside_of((0.0, 0.0, 1.0), np.array([0.5, 2.0]), np.zeros(2)).tolist()
    [True, False]
    """
    form = finite_array("region", region, "m")
    inside: Bins
    if form.shape == (3,) and form[2] > 0.0:
        inside = np.hypot(x - form[0], y - form[1]) <= form[2]
    elif form.shape == (4,) and form[2] > form[0] and form[3] > form[1]:
        inside = (x >= form[0]) & (x <= form[2]) & (y >= form[1]) & (y <= form[3])
    elif form.ndim == 2 and form.shape[1] == 2 and len(form) >= 3:
        inside = np.zeros(x.shape, np.bool_)
        for (x1, y1), (x2, y2) in zip(form, np.roll(form, -1, axis=0), strict=True):
            if y1 != y2:  # a ray along x: every edge that it crosses changes sides
                crosses = (y1 > y) != (y2 > y)
                inside ^= crosses & (x < x1 + (y - y1) * ((x2 - x1) / (y2 - y1)))
    else:
        raise InputError(
            "a region must be (x, y, r) with r > 0, a rectangle (x1, y1, x2, y2) with x1 < x2 and "
            "y1 < y2, or at least three corners (x, y) of a polygon, in m"
        )
    return inside


def _sides(values: FloatArray) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    if high > low:
        return low, high
    room = max(1e-3 * abs(low), 1e-9)  # all in one place
    return low - room, high + room


def checked_regions(entries: Any) -> None:
    """Refuse regions that are none, before any work.

    >>> checked_regions([(0.0, 0.0, 1.0)])
    """
    for region in entries:
        inside_of(region, np.zeros(1), np.zeros(1))
