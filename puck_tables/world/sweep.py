"""Maps over a board: where all pucks end, for all combinations of the numbers that range."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.digest import files_named, refuse_changed
from puck_tables._core.executor import Progress
from puck_tables._core.memory import check_memory
from puck_tables.bulk.finish import check_part, finish
from puck_tables.bulk.work import Columns, Tally, Work
from puck_tables.errors import InputError, PuckError
from puck_tables.io.columns import derived
from puck_tables.io.dataset import Dataset, Variable, variable
from puck_tables.result import Result
from puck_tables.scene.entries import entry_at, is_batch, launch_paths, tables_of
from puck_tables.scene.library import files_of
from puck_tables.scene.outcome import column_of, plain_name, scene_texts
from puck_tables.scene.pieces import Piece
from puck_tables.scene.scene import Scene
from puck_tables.world.agreement import called, number_of, pieces_of, refuse_endless
from puck_tables.world.bulk import Ends, follow_all
from puck_tables.world.engine import PUSHING, REACHED
from puck_tables.world.outcome import STATE, WorldRun, ways_of
from puck_tables.world.prepare import game_of, order_of
from puck_tables.world.rim_laws import rule_of
from puck_tables.world.world import World

CHUNK = 2048
FEWEST, MOST = 1 << 6, 1 << 12  # runs kept together in a store
ENDS = (
    "at rest",
    "time is up",
    "events crowd together",
    "impacts without end",
    "refused",
    "unsolved",
    "faster than a table of restitution goes",
    "no step is short enough",
)
TIME_UP, REFUSED, UNSOLVED = 1, 4, 5
_LAUNCH = re.compile(r"(?:puck\[(\d+)\]\.)?launch\.(velocity\[[01]\]|spin)")
_PARTS = ("velocity[0]", "velocity[1]", "spin")


@dataclass(frozen=True, eq=False, repr=False)
class WorldMap(Result):
    """Ends of a board over its ranges.

    ``scene``: with its ranges; ``axes``: their values by path; ``names``: of the pucks;
    ``columns``: x, y, vx, vy (m, m/s), orientation, spin (rad, rad/s) and ``in_play`` of every puck
    at the end, arrays (axes…, pucks); ``end_time`` s and ``impacts`` (axes…), NaN without an end;
    ``end`` (axes…): index of :data:`ENDS`; ``told``: what :meth:`without_end` says.
    """

    scene: Scene
    names: tuple[str, ...]
    columns: Mapping[str, FloatArray] = field(repr=False)
    end: npt.NDArray[np.int8] = field(repr=False)
    told: tuple[str, ...] = field(default=(), repr=False)
    files: Mapping[str, str] = field(default_factory=dict, repr=False)

    picture: ClassVar[str] = "board_map"
    meanings: ClassVar[tuple[str, ...]] = ENDS

    @property
    def axes(self) -> dict[str, FloatArray]:
        """What ranges, by path; many launches by their number."""
        return axes_of(self.scene)

    def __repr__(self) -> str:
        ranged = " x ".join(f"{path} ({values.size})" for path, values in self.axes.items())
        return f"WorldMap({self.scene.title or 'scene'}, {len(self.names)} pucks, over {ranged})"

    def __getattr__(self, name: str) -> FloatArray:
        """A column by its name."""
        return column_of(self, name)

    def __getitem__(self, puck: int | str) -> dict[str, FloatArray]:
        """The columns of one puck, by its name or number, arrays (axes…).

        Raises
        ------
        InputError
            If there is no such puck.
        """
        number = number_of(puck, self.names)
        return {
            name: values[..., number] if values.ndim > self.end.ndim else values
            for name, values in self.columns.items()
        }

    @property
    def model(self) -> str:
        """What was done."""
        return f"{len(self.names)} pucks from impact to impact"

    def an_example(self) -> WorldRun:
        """The first run that has an end."""
        first = np.argwhere(self.end <= TIME_UP)[0]
        places = zip(self.axes, first.tolist(), strict=True)
        changed = [one for path, place in places for one in _numbers(self.scene, path, place)]
        run: Any = self.scene.at(dict(changed)).simulate()
        return run

    def explain(self) -> str:
        """How it was got."""
        return f"{self.end.size} runs\n{ways_of(self.scene)}\n{rule_of(self.scene)}"

    def dataset(self) -> Dataset:
        """The results over what ranges and the pucks; the scene and its files as texts."""
        columns = {**self.columns, **derived(self.columns)}
        return labelled(self.scene, self.names, self.files, columns, self.end)

    def without_end(self) -> list[str]:
        """A line for each way in which runs have no end: how many, the first, and what to do."""
        return list(self.told)


def labelled(
    scene: Scene, names: tuple[str, ...], files: Mapping[str, str], results: Columns,
    end: npt.NDArray[np.int8],
) -> Dataset:  # fmt: skip
    """Columns of the ends of a board with axes, names and units."""
    dims = tuple(plain_name(path) for path in scene.ranges)
    axes = {}
    columns = {"name": variable("name", list(names), ("puck",))}
    for path, values in axes_of(scene).items():
        if is_batch(path):
            text = "number of the launch"
            axes[plain_name(path)] = Variable(values, (plain_name(path),), "1", text)
            for one, row in zip(launch_paths(path), scene.ranges[path].T, strict=True):
                unit, text = scene.unit_of(one) or "1", f"{one} of the scene"
                columns[plain_name(one)] = Variable(row, (plain_name(path),), unit, text)
            continue
        doc = entry_at(scene, path).doc
        text = f"{path} of the scene" + (f", {doc}" if doc else "")
        unit = scene.unit_of(path) or "1"
        axes[plain_name(path)] = Variable(values, (plain_name(path),), unit, text)
    axes["puck"] = variable("puck", np.arange(len(names)), ("puck",))
    for name, values in results.items():
        over = (*dims, "puck") if values.ndim > end.ndim else dims
        columns[name] = variable(name, values, over)
    columns["end"] = variable("end", end, dims, ENDS)
    return Dataset(axes, columns, {"title": scene.title or "Scene"}, scene_texts(scene, files))


def sweep(
    scene: Scene, *, threads: int | None = None, chunk: int = CHUNK,
    progress: Progress | None = None, store: str | Path | None = None, cluster: str | None = None,
    overwrite: bool = False,
) -> WorldMap:  # fmt: skip
    """The map over a board, as :meth:`puck_tables.Scene.sweep` has it."""
    check_part(chunk)
    work = WorldWork(scene, chunk)
    if store is None:
        check_memory(work.shape, 8 * 3 * (len(work.names) * (len(STATE) + 1) + 2))
    found: WorldMap = finish(work, threads, progress, store, cluster, overwrite)
    return found


class WorldWork(Work):
    """The runs of a board over its ranges.

    Raises
    ------
    InputError
        If nothing ranges.
    """

    code = "end"
    meanings = ENDS

    def __init__(self, scene: Scene, part: int, read: dict[str, str] | None = None) -> None:
        self.scene, self.part = scene, part
        self.axes = axes_of(scene)
        if not self.axes:
            raise InputError(
                "no number of the scene is a range: write one as 'START:STOP:COUNT' or as a list "
                "(such as puck[0].launch.spin = '0:10:101')"
            )
        self.shape = tuple(values.size for values in self.axes.values())
        self.block = min(MOST, max(FEWEST, self.size // 64))
        pieces = pieces_of(scene)
        self.names = tuple(called(piece, number) for number, piece in enumerate(pieces))
        self.columns = dict.fromkeys((*STATE, "in_play"), (len(pieces),))
        self.columns |= dict.fromkeys(("end_time", "impacts"), ())
        within = {path: _launches(scene, path, pieces) for path in self.axes}
        self._inner = {path: one for found in within.values() for path, one in found}
        self._from = {one: path for path, found in within.items() for one, _ in found}
        self._outer = [path for path, found in within.items() if not found]
        self._whole, self.files = tables_of(scene), files_of(scene)
        self._read = files_named(self._whole) if read is None else read
        self._case = lru_cache(maxsize=8)(self._made)

    def __reduce__(self) -> Any:
        return WorldWork, (self.scene, self.part, self._read)

    @property
    def identity(self) -> Mapping[str, Any]:
        """The scene, its ranges, and what stands in the files that it names."""
        ranges = list(self.scene.ranges.items())
        return {"scene": self._whole, "axes": ranges, "files": self._read}

    def _made(self, places: tuple[int, ...]) -> _Case | InputError:
        try:
            at = dict.fromkeys(self.axes, 0) | dict(zip(self._outer, places, strict=True))
            numbers = [one for path, n in at.items() for one in _numbers(self.scene, path, n)]
            return _Case(self.scene.at(dict(numbers)))
        except InputError as error:
            return error

    def _split(self, start: int, stop: int) -> tuple[list[tuple[int, ...]], dict[str, FloatArray]]:
        """Places along what is more than a launch, and the launches, of some runs."""
        index = np.unravel_index(np.arange(start, stop), self.shape)
        places = dict(zip(self.axes, index, strict=True))
        outer = list(zip(*(places[path].tolist() for path in self._outer), strict=True))
        launches = {}
        for one, path in self._from.items():
            values = self.scene.ranges[path]
            if is_batch(path):
                values = values[:, launch_paths(path).index(one)]
            launches[one] = values[places[path]]
        return outer or [()] * (stop - start), launches

    def of(self, start: int, stop: int) -> Columns:
        """The ends of some runs.

        Raises
        ------
        InputError
            If a file that the scene names was changed meanwhile.
        """
        numbers, launches = self._split(start, stop)
        found = {name: np.full((stop - start, *one), np.nan) for name, one in self.columns.items()}
        end = np.full(stop - start, REFUSED, np.int8)
        begin = 0
        while begin < stop - start:  # runs that differ in nothing but launches, together
            last = begin + 1
            while last < stop - start and numbers[last] == numbers[begin]:
                last += 1
            one = self._case(numbers[begin])
            if isinstance(one, _Case):
                part = {path: values[begin:last] for path, values in launches.items()}
                columns, end[begin:last] = one.ends(part, self._inner, last - begin)
                for name, values in columns.items():
                    found[name][begin:last] = values
            begin = last
        refuse_changed(self._whole, self._read)
        return found | {self.code: end}

    def checked(self, tally: Tally) -> None:
        """Refuse a sweep every run of which is refused."""
        if set(tally.counts) == {REFUSED}:
            raise InputError(
                f"every run of this sweep is refused, the first: {self._refusal(tally)}"
            )

    def _refusal(self, tally: Tally) -> str:
        first = tally.first[REFUSED]
        return str(self._case(self._split(first, first + 1)[0][0]))

    def without_end(self, tally: Tally) -> list[str]:
        """A line for each way in which runs have no end: how many, the first, and what to do."""
        lines = []
        for code, count in tally.counts.items():
            if code > TIME_UP:
                place = np.unravel_index(tally.first[code], self.shape)
                at = zip(self.axes.items(), place, strict=True)
                run = ", ".join(f"{path} = {values[i]:.10g}" for (path, values), i in at)
                refused = code == REFUSED
                advice = self._refusal(tally) if refused else "run it alone, which says what to do"
                lines.append(
                    f"{count} of {self.size} runs: {ENDS[code]}; the first at {run}: {advice}"
                )
        return lines

    def explain(self, tally: Tally) -> str:
        """How it is got."""
        return f"{self.size} runs\n{ways_of(self.scene)}\n{rule_of(self.scene)}"

    def labelled(self, columns: Columns) -> Dataset:
        """The ends over what ranges; the scene and its files as texts."""
        results = {name: columns[name] for name in self.columns}
        return labelled(self.scene, self.names, self.files, results, columns[self.code])

    def result(self, columns: Columns) -> WorldMap:
        """The map."""
        end = columns[self.code]
        results = {name: columns[name] for name in self.columns}
        lines = tuple(self.without_end(Tally.of(end)))
        return WorldMap(self.scene, self.names, results, end, lines, self.files)


def axes_of(scene: Scene) -> dict[str, FloatArray]:
    """What ranges, by path; many launches by their number."""
    return {
        path: np.arange(float(len(values))) if is_batch(path) else values
        for path, values in scene.ranges.items()
    }


def _numbers(scene: Scene, path: str, place: int) -> list[tuple[str, float]]:
    """The numbers of the scene at a place along an axis, by path."""
    values = scene.ranges[path][place]
    if not is_batch(path):
        return [(path, float(values))]
    return list(zip(launch_paths(path), values.tolist(), strict=True))


def _launches(
    scene: Scene, path: str, pieces: tuple[Piece, ...]
) -> list[tuple[str, re.Match[str]]]:
    """The velocities and spins that an axis changes, if it changes nothing else.

    At the start: of later launches more depends on it than a velocity.
    """
    paths: tuple[str, ...] = (path,)
    values = scene.ranges[path]
    if is_batch(path):
        if (values[:, 3:] != values[0, 3:]).any():
            return []
        paths = launch_paths(path)[:3]
    found = [(one, match) for one in paths if (match := _LAUNCH.fullmatch(one)) is not None]
    for _, match in found:
        piece = pieces[int(match[1] or 0)]
        if piece.launch.time > 0.0 or piece.path or piece.constraint is not None:
            return []
    return found


class _Case:
    """A board of which only launches still vary."""

    def __init__(self, scene: Scene) -> None:
        self.scene, self.pieces = scene, pieces_of(scene)
        refuse_endless(scene)
        self.until = math.inf if scene.run.time is None else scene.run.time
        order = order_of(scene)
        self.game, room = game_of(scene, order)
        self.first, self.place = room.states.copy(), np.argsort(order)

    def ends(
        self, launches: Mapping[str, FloatArray], paths: Mapping[str, re.Match[str]], count: int
    ) -> tuple[Columns, npt.NDArray[np.int8]]:
        """Results (count, …) and how each run ended."""
        numbers = sorted({int(one[1] or 0) for one in paths.values()})
        starts = np.empty((count, len(numbers), 3))
        for m, number in enumerate(numbers):
            launch = self.pieces[number].launch
            starts[:, m] = *(launch.velocity or (0.0, 0.0)), launch.spin
        for path, values in launches.items():
            one = paths[path]
            starts[:, numbers.index(int(one[1] or 0)), _PARTS.index(one[2])] = values
        discs = self.place[numbers]
        ends = follow_all(self.game, self.first, discs, starts, self.until)
        for run in np.flatnonzero(ends.how == PUSHING):  # or of which much has to be kept
            self._run(
                {path: float(values[run]) for path, values in launches.items()}, int(run), ends
            )
        states = np.concatenate([ends.states, ends.in_play[:, :, None]], axis=2)[:, self.place]
        out: Columns = {name: states[:, :, n] for n, name in enumerate((*STATE, "in_play"))}
        out |= {"end_time": ends.time, "impacts": ends.impacts.astype(np.float64)}
        status = np.where(ends.how > 1, ends.how, 0).astype(np.int8)
        moving = (states[:, :, 3:6] != 0.0).any(axis=(1, 2))
        status[(status == 0) & moving] = TIME_UP
        for values in out.values():
            values[status > TIME_UP] = np.nan
        return out, status

    def _run(self, numbers: Mapping[str, float], run: int, ends: Ends) -> None:
        """A run in which pucks push each other, or in which very much happens."""
        world = World(self.scene.at(numbers))
        try:
            world.advance(self.until)
        except PuckError:
            ends.how[run] = UNSOLVED
            return
        order, last = np.argsort(self.place), world.state()
        last[~world.moving, 3:] = 0.0
        ends.states[run], ends.in_play[run] = last[order], world.in_play[order]
        ends.time[run] = min(world.last_motion, self.until)
        ends.impacts[run] = sum(event.what == "impact" for event in world.events_since(0.0))
        ends.how[run] = REACHED
