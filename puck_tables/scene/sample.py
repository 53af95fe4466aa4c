"""Ends of a scene when numbers of it scatter."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import Progress
from puck_tables._core.memory import check_memory
from puck_tables._core.real import instance
from puck_tables.bulk.finish import check_part, finish
from puck_tables.bulk.spreads import Spread, checked_samples
from puck_tables.bulk.summary import Summary
from puck_tables.bulk.work import Columns, Tally
from puck_tables.errors import InputError
from puck_tables.io.columns import derived
from puck_tables.io.dataset import Dataset, Variable, variable
from puck_tables.result import Result
from puck_tables.scene.case import RESULTS
from puck_tables.scene.entries import entry_at
from puck_tables.scene.outcome import ENDS, column_of, plain_name, scene_texts
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.sweep import BYTES, CHUNK, SceneWork

SAMPLE = "sample"


@dataclass(frozen=True, eq=False, repr=False)
class SceneSample(Result, Summary):
    """Ends of a scene over samples.

    ``columns``: arrays (samples,) by name, the numbers drawn among them, NaN without an end;
    ``end``: index of :data:`puck_tables.scene.outcome.ENDS`; ``spreads``: what scatters, by path.
    """

    scene: SceneSpec
    spreads: Mapping[str, Spread]
    seed: int
    columns: Mapping[str, FloatArray] = field(repr=False)
    end: npt.NDArray[np.int8] = field(repr=False)
    explanation: str = field(repr=False)
    told: tuple[str, ...] = field(default=(), repr=False)
    files: Mapping[str, str] = field(default_factory=dict, repr=False)

    picture: ClassVar[str] = "sample"
    meanings: ClassVar[tuple[str, ...]] = ENDS
    summed = ("end_time", "x", "y", "orientation")
    place = ("x", "y")
    shown = ("end_time", "orientation")

    def __repr__(self) -> str:
        return f"SceneSample({self.scene.title or 'scene'}, {self.end.size} samples)"

    def __getattr__(self, name: str) -> FloatArray:
        """A column by its name."""
        return column_of(self, name)

    @property
    def drawn_words(self) -> str:
        """What scatters, in words."""
        return ", ".join(f"{path} {one}" for path, one in self.spreads.items())

    def without_end(self) -> list[str]:
        """A line for each way in which runs have no end: how many, the first, and what to do."""
        return list(self.told)

    def explain(self) -> str:
        """The model that was taken, and why."""
        return self.explanation

    def dataset(self) -> Dataset:
        """The ends over the samples, with what was drawn."""
        results = {name: self.columns[name] for name in RESULTS}
        found = _labelled(self, self.columns, self.end)
        more = {name: variable(name, one, (SAMPLE,)) for name, one in derived(results).items()}
        return Dataset({}, {**found.columns, **more}, found.attributes, found.texts)


def _labelled(one: Any, columns: Mapping[str, Any], end: npt.NDArray[np.int8]) -> Dataset:
    """Columns of samples with names and units; the scene and its files as texts."""
    found = {}
    for path in one.spreads:
        doc = entry_at(one.scene, path).doc
        text = f"{path} of the scene" + (f", {doc}" if doc else "")
        name = plain_name(path)
        unit = one.scene.unit_of(path) or "1"
        found[name] = Variable(columns[name], (SAMPLE,), unit, text)
    found |= {name: variable(name, columns[name], (SAMPLE,)) for name in RESULTS}
    found["end"] = variable("end", end, (SAMPLE,), ENDS)
    drawn = {f"drawn_{plain_name(path)}": str(spread) for path, spread in one.spreads.items()}
    attributes = {"title": one.scene.title or "Scene", **drawn, "seed": one.seed}
    return Dataset({}, found, attributes, scene_texts(one.scene, one.files))


def sample(
    scene: SceneSpec, count: int, seed: int, spreads: Mapping[str, Spread], *,
    threads: int | None = None, chunk: int = CHUNK, progress: Progress | None = None,
    store: str | Path | None = None, cluster: str | None = None, overwrite: bool = False,
) -> SceneSample:  # fmt: skip
    """Samples of a scene, as :meth:`puck_tables.Scene.sample` has it."""
    if scene.is_board:
        raise InputError(
            "samples of boards are not drawn: let a number of the board range instead, such as "
            "puck[0].launch.spin = '0:5:11', and sweep it"
        )
    check_part(chunk)
    checked_samples(count, seed)
    instance("spreads", spreads, Mapping)
    work = SceneDraws(scene, chunk, None, count, seed, dict(spreads))
    if store is None:
        check_memory(work.shape, BYTES)
    found: SceneSample = finish(work, threads, progress, store, cluster, overwrite)
    return found


class SceneDraws(SceneWork):
    """The runs of a scene of which some numbers are drawn.

    Raises
    ------
    InputError
        If nothing scatters, or what does is no number of the scene.
    """

    is_sample = True

    def __init__(
        self, scene: SceneSpec, part: int, read: dict[str, str] | None, count: int, seed: int,
        spreads: Mapping[str, Spread],
    ) -> None:  # fmt: skip
        if scene.ranges:
            raise InputError(
                f"samples have no ranges: give {', '.join(scene.ranges)} one number or a spread"
            )
        if not spreads or not all(isinstance(one, Spread) for one in spreads.values()):
            raise InputError(
                "samples need a spread: say what scatters, such as launch.spin=normal:5:0.2"
            )
        self.spreads, self.seed = spreads, seed
        middle = {path: one.of(np.array([0.5])).item() for path, one in spreads.items()}
        try:
            scene.at(middle)  # what is no number of the scene is refused here
        except InputError as error:
            raise InputError(f"samples: in the middle of what is drawn, {error}") from None
        super().__init__(scene, part, read, {path: np.zeros(0) for path in spreads}, (count,))
        self.columns = {plain_name(path): () for path in spreads} | dict.fromkeys(RESULTS, ())

    def __reduce__(self) -> Any:
        return SceneDraws, (
            self.scene, self.part, self._read, self.size, self.seed, self.spreads
        )  # fmt: skip

    @property
    def identity(self) -> Mapping[str, Any]:
        """The scene, and what is drawn."""
        drawn = {path: str(one) for path, one in self.spreads.items()}
        return {**super().identity, "drawn": drawn, "seed": self.seed, "count": self.size}

    def _values(self, start: int, stop: int) -> dict[str, FloatArray]:
        return {path: one.drawn(path, self.seed, start, stop) for path, one in self.spreads.items()}

    def of(self, start: int, stop: int) -> Columns:
        """The ends of some samples, and what was drawn."""
        drawn: Columns = {
            plain_name(path): values for path, values in self._values(start, stop).items()
        }
        return drawn | super().of(start, stop)

    def labelled(self, columns: Columns) -> Dataset:
        """The ends over the samples, with what was drawn."""
        return _labelled(self, columns, columns[self.code])

    def result(self, columns: Columns) -> SceneSample:  # type: ignore[override]
        """The samples."""
        end, tally = columns[self.code], Tally.of(columns[self.code])
        numbers = {name: columns[name] for name in self.columns}
        return SceneSample(
            self.scene, self.spreads, self.seed, numbers, end, self.explain(tally),
            tuple(self.without_end(tally)), self.files,
        )  # fmt: skip
