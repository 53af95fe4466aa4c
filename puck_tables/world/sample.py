"""Samples of a scene: how and where it ends when numbers of it scatter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.bulk.spreads import Spread
from puck_tables.bulk.summary import Chance, Summary, chance_of, head
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset, Variable
from puck_tables.scene.outcome import plain_name
from puck_tables.world.scene_ends import SceneEnds, number_along, spread_words

SAMPLE = "sample"
_PLACES = ("x", "y", "orientation")
_MOST_PUCKS, _WIDEST = 40, 24  # of a summary; signs of a name in it


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Sample(SceneEnds, Summary):
    """Ends of a scene over samples.

    ``scene``: whose numbers by the paths ``spreads`` were drawn from ``seed``; ``names``: of its
    pucks, none where it has one ``puck``; ``columns``: arrays (samples,) by name, of several pucks
    (samples, pucks), the numbers drawn among them, NaN without an end, each also an attribute;
    ``end``: how each ends, an index of ``meanings``.  Summaries are of one puck:
    ``sample.of("red").mean()``.  A puck that left play rests nowhere: it does not count in means of
    places, and in a chance it counts as outside; ``left_play`` is the chance of that.
    """

    spreads: Mapping[str, Spread]
    seed: int

    summed = ("end_time", "x", "y", "orientation")
    place = ("x", "y")
    shown = ("end_time", "orientation")

    @property
    def picture(self) -> str:  # type: ignore[override]
        """The module that draws it."""
        return "board_ends" if self.names else "sample"

    @property
    def ranging(self) -> tuple[str, ...]:
        """The numbers of the scene that differ between its runs, by path."""
        return tuple(self.spreads)

    def __repr__(self) -> str:
        return f"Sample({self.title}, {self.end.size} samples)"

    @property
    def drawn_words(self) -> str:
        """What scatters, in words."""
        return spread_words(self.scene, self.spreads)

    def numbers(self, run: int) -> dict[str, float]:
        """What was drawn for a sample, counted from 0, by path."""
        return {path: float(self.columns[plain_name(path)][run]) for path in self.spreads}

    def counted(self, name: str) -> FloatArray:
        """A column (samples,), NaN where it does not count.

        Raises
        ------
        InputError
            If it is of several pucks.
        """
        if self.names:
            raise InputError(
                "these samples are of several pucks, and a summary is of one: ask "
                f".of({self.names[0]!r}), by a name or a number"
            )
        values = super().counted(name)
        return np.where(self.in_play > 0.0, values, np.nan) if name in _PLACES else values

    @property
    def left_play(self) -> Chance:
        """The chance that the puck falls into a pocket or over an edge."""
        if self.names:
            self.counted("x")
        return chance_of(int(np.count_nonzero(self.in_play == 0.0)), max(self.ended, 1))

    def summary(self, regions: Sequence[npt.ArrayLike] = ()) -> str:
        """Means, deviations and quantiles in a table, for each puck, and chances; lines of text.

        Of pucks that left play how often they did; a region is told for each puck.
        """
        if not self.names:
            return "\n".join([super().summary(regions), *self._left()])
        shown = self.names[:_MOST_PUCKS]
        labels = [name if len(name) <= _WIDEST else f"{name[: _WIDEST - 3]}..." for name in shown]
        wide = max(map(len, labels)) + len(" orientation rad ")
        rows, chances = [head(wide), *self.of(0).rows(("end_time",), wide=wide)], []
        for name, label in zip(shown, labels, strict=True):
            one = self.of(name)
            rows += one.rows(_PLACES, f"{label} ", wide)
            chances += [f"{label} {line}" for line in (*one.chances(regions), *one._left())]
        if len(self.names) > len(shown):
            chances.append(f"and {len(self.names) - len(shown)} more pucks (-o FILE saves all)")
        return "\n".join(rows + chances)

    def _left(self) -> list[str]:
        share = self.left_play
        if share.value == 0.0:
            return []
        return [
            f"leaves play with a chance of {share.value:.6g} "
            f"(95 %: {share.low:.6g} to {share.high:.6g})"
        ]

    def along(self) -> tuple[tuple[str, ...], dict[str, Variable], dict[str, Variable]]:
        """The dimension, and what was drawn."""
        names = {path: plain_name(path) for path in self.spreads}
        drawn = {
            name: number_along(self.scene, path, self.columns[name], SAMPLE)
            for path, name in names.items()
        }
        return (SAMPLE,), {}, drawn

    def labelled(self) -> Dataset:
        """The columns with names and units, what was drawn among them."""
        drawn = {f"drawn_{plain_name(path)}": str(one) for path, one in self.spreads.items()}
        found = super().labelled()
        attributes = {**found.attributes, **drawn, "seed": self.seed}
        return replace(found, attributes=attributes)
