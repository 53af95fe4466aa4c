"""What many runs of a scene give, over its ranges or of samples: how and where each ends."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.bulk.spreads import Spread
from puck_tables.bulk.summary import Chance, Summary, chance_of, head
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset, Variable, derived, variable
from puck_tables.result import Result
from puck_tables.scene.entries import entry_at, is_batch, launch_paths
from puck_tables.scene.library import plain_name, scene_texts
from puck_tables.scene.run import ENDS, LAST_END, column_of, number_of
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.engine_state import Whole


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SceneEnds(Result):
    """How and where the runs of a scene end; a :class:`Map` or a :class:`Sample`, which tell more.

    ``explanation``: why the ``model`` was taken of the first run that is valid; ``endless``: what
    :meth:`without_end` says; ``whose``: the puck that it is of.
    """

    scene: SceneSpec
    names: tuple[str, ...]
    columns: Mapping[str, FloatArray] = field(repr=False)
    end: npt.NDArray[np.int8] = field(repr=False)
    model: str = ""
    explanation: str = ""
    endless: tuple[str, ...] = ()
    files: Mapping[str, str] = field(default_factory=dict)
    whose: str = ""

    meanings: ClassVar[tuple[str, ...]] = ENDS

    def __getattr__(self, name: str) -> FloatArray:
        """A column by its name."""
        return column_of(self, name)

    def __getitem__(self, puck: int | str) -> dict[str, FloatArray]:
        """The columns of one puck, by its name or number; InputError if there is none."""
        number = number_of(puck, self.names or (self.whose or "puck",))
        return {
            name: values[..., number] if values.ndim > self.end.ndim else values
            for name, values in self.columns.items()
        }

    def of(self, puck: int | str) -> Any:
        """The ends of one puck alone, by its name or number; InputError if there is none."""
        own = self[puck]
        whose = self.names[number_of(puck, self.names)] if self.names else self.whose
        return replace(self, names=(), columns=own, whose=whose)

    @property
    def title(self) -> str:
        """Of the scene, and which puck of it."""
        return (self.scene.title or "Scene") + (f", {self.whose}" if self.whose else "")

    @property
    def ended(self) -> int:
        """How many runs have an end."""
        return int(np.count_nonzero(self.end <= LAST_END))

    def numbers(self, run: int) -> dict[str, float]:
        """What is special to a run, counted from 0 with the last range fastest, by path."""
        raise NotImplementedError

    def along(self) -> tuple[tuple[str, ...], dict[str, Variable], dict[str, Variable]]:
        """Dimensions, axes, and columns that say what is special to the runs."""
        raise NotImplementedError

    def labelled(self) -> Dataset:
        """The columns with names, axes and units; the scene and its files as texts."""
        dims, axes, columns = self.along()
        if self.names:
            axes["puck"] = variable("puck", np.arange(len(self.names)), ("puck",))
            columns["name"] = variable("name", list(self.names), ("puck",))
        drawn = {name: values for name, values in self.columns.items() if name not in columns}
        columns |= self._over(drawn, dims)
        columns["end"] = variable("end", self.end, dims, ENDS)
        return Dataset(axes, columns, {"title": self.title}, scene_texts(self.scene, self.files))

    def dataset(self) -> Dataset:
        """The ends and what follows from them; the scene and its files as texts."""
        result = self.labelled()
        more = self._over(derived(self.columns), result.columns["end"].dims)
        return replace(result, columns={**result.columns, **more})

    def _over(
        self, columns: Mapping[str, FloatArray], dims: tuple[str, ...]
    ) -> dict[str, Variable]:
        """Columns over the runs, and perhaps the pucks."""
        return {
            name: variable(name, one, (*dims, "puck") if one.ndim > len(dims) else dims)
            for name, one in columns.items()
        }

    def explain(self) -> str:
        """The model that was taken, and why."""
        return self.explanation

    def without_end(self) -> list[str]:
        """A line for each way in which runs have no end: how many, the first, and what to do."""
        return list(self.endless)


def axes_of(scene: SceneSpec) -> dict[str, FloatArray]:
    """What ranges in a scene, by path; many launches by their numbers from 0 on.

    >>> from puck_tables import Launch, Puck, Scene
    >>> axes_of(Scene(Puck(1.0), launch=Launch([[1.0, 0.0], [2.0, 0.0]])))
    {'launch': array([0., 1.])}
    """
    return {
        path: np.arange(float(len(values))) if is_batch(path) else values
        for path, values in scene.ranges.items()
    }


def numbers_of(ranges: Mapping[str, FloatArray], runs: Whole) -> dict[str, FloatArray]:
    """The numbers that range, in runs (n,) counted from 0 with the last range fastest, by path."""
    places = np.unravel_index(runs, [len(values) for values in ranges.values()])
    result: dict[str, FloatArray] = {}
    for (path, values), place in zip(ranges.items(), places, strict=True):
        if is_batch(path):
            result |= zip(launch_paths(path), values[place].T, strict=True)
        else:
            result[path] = values[place]
    return result


def spread_words(scene: SceneSpec, spreads: Mapping[str, Spread]) -> str:
    """What scatters, and how, in the units of the scene."""
    return ", ".join(
        f"{path} {one} {scene.unit_of(path)}".rstrip() for path, one in spreads.items()
    )


def number_along(scene: SceneSpec, path: str, values: FloatArray, axis: str) -> Variable:
    """Numbers of the scene along an axis."""
    if is_batch(path):
        return Variable(values, (axis,), "1", "number of the launch")
    doc = entry_at(scene, path).doc
    text = f"{path} of the scene" + (f", {doc}" if doc else "")
    return Variable(values, (axis,), scene.unit_of(path) or "1", text)


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

    def summary(self) -> str:
        """Means, deviations and quantiles in a table, for each puck, and chances; lines of text.

        Of pucks that left play how often they did; a region is told for each puck.
        """
        if not self.names:
            return "\n".join([super().summary(), *self._left()])
        shown = self.names[:_MOST_PUCKS]
        labels = [name if len(name) <= _WIDEST else f"{name[: _WIDEST - 3]}..." for name in shown]
        wide = max(map(len, labels)) + len(" orientation rad ")
        rows, chances = [head(wide), *self.of(0).rows(("end_time",), wide=wide)], []
        for name, label in zip(shown, labels, strict=True):
            one = self.of(name)
            rows += one.rows(_PLACES, f"{label} ", wide)
            chances += [f"{label} {line}" for line in (*one.chances(self.regions), *one._left())]
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
        dataset = super().labelled()
        attributes = {**dataset.attributes, **drawn, "seed": self.seed}
        return replace(dataset, attributes=attributes)
