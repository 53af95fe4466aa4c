"""What an aim on a board gives: launches, each run forward on the whole board."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS, Dataset, variable
from puck_tables.result import Result
from puck_tables.scene.entries import tables_of
from puck_tables.scene.library import files_of, scene_texts
from puck_tables.scene.run import Run, column_of, number_of
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.named_pucks import names_of, pucks_of, start_of, with_launch
from puck_tables.world.simulate import simulate
from puck_tables.world.targets import Odds, Target, odds_of

_LAUNCH = ("launch_spin", "launch_vx", "launch_vy", "launch_speed", "launch_heading")
_END = ("stop_time", "miss", "end_error", "impacts")


@dataclass(frozen=True, eq=False, repr=False)
class BoardAim(Result):
    """Launches of the ``striker`` after which the ``puck`` ends at ``target`` m or in a ``pocket``.

    Arrays (n,), the least sensitive first: ``launch_spin`` rad/s, ``launch_vx``, ``launch_vy``,
    ``launch_speed`` m/s, ``launch_heading`` rad; of a run of the whole board with each:
    ``stop_time`` s, ``miss`` m (of a pocket 0: it falls in), ``end_error`` m, as
    :class:`puck_tables.results.Run` has it, ``impacts`` that lead there, and ``sequences``
    in words.  Of a target: ``per_degree``, ``per_percent`` m, how far the end moves per degree of
    heading and per cent of speed.  Of a pocket: ``heading_width`` rad and ``speed_width`` m/s (or
    ``spin_width`` rad/s), the intervals through the launch from which the puck falls in.

    ``answer``: what was found, or why nothing can be; ``limit``: how far was looked.
    """

    scene: SceneSpec
    puck: str
    striker: str
    target: tuple[float, float]
    pocket: int | None
    columns: Mapping[str, FloatArray] = field(repr=False)
    sequences: tuple[str, ...]
    answer: str
    limit: str
    files: Mapping[str, str] = field(default_factory=dict, repr=False)

    picture: ClassVar[str] = "board_aim"

    def __repr__(self) -> str:
        return f"BoardAim({self.puck} {self.where}: {self.answer})"

    def __len__(self) -> int:
        return len(self.sequences)

    def __getattr__(self, name: str) -> FloatArray:
        """A column by its name."""
        return column_of(self, name)

    @property
    def where(self) -> str:
        """The target in words."""
        if self.pocket is not None:
            return f"in pocket {self.pocket}"
        return f"at ({self.target[0]:g}, {self.target[1]:g}) m"

    @property
    def start(self) -> tuple[float, float, float]:
        """Where the striker starts, m, and its radius, m."""
        puck = pucks_of(self.scene)[number_of(self.striker, names_of(self.scene))]
        return *start_of(puck), puck.radius

    def board(self, number: int = 0) -> SceneSpec:
        """The scene with a launch that was found.

        Raises
        ------
        InputError
            If there is no such launch.
        """
        if not -len(self) <= number < len(self):
            raise InputError(f"no launch {number}: {self.answer}")
        names = ("launch_vx", "launch_vy", "launch_spin")
        launch = np.array([self.columns[name][number] for name in names])
        return with_launch(self.scene, number_of(self.striker, names_of(self.scene)), launch)

    def run(self, number: int = 0) -> Run:
        """The run of the whole board with a launch that was found.

        Raises
        ------
        InputError
            If there is no such launch.
        """
        return simulate(self.board(number))

    def odds(
        self, number: int = 0, *, heading: float = 0.0, speed: float = 0.0, spin: float = 0.0,
        within: float | None = None, count: int = 2000, seed: int = 0,
    ) -> Odds:  # fmt: skip
        """How likely a launch does it where nobody hits it exactly, and the best aim beside it.

        Parameters
        ----------
        number : of the launch
        heading, speed, spin : standard deviations, rad, share of the speed, and rad/s
        within : m, of a target: how near the puck is to end
        count : scattered runs of the whole board; seed : of what they draw

        Returns
        -------
        Odds
            The best aim is climbed to from the launch by steps of the deviations, with 400 runs
            of the same draws for each; then both are run anew with the same ``count`` of others.

        Raises
        ------
        InputError
            If there is no such launch, nothing scatters, or ``within`` is not given for a target.

        Examples
        --------
        >>> from puck_tables import Edge, Puck, Scene
        >>> edge = Edge((0.82, 0.0), normal=(-1, 0))
        >>> table = Scene(pucks=[Puck(0.03, friction=0.1)], edges=[edge])
        >>> odds = table.aim((0.8, 0.0), spin=0.0).odds(speed=0.05, within=0.1)
        >>> round(odds.nominal.value, 2), round(odds.best.value, 2)         # short of the edge
        (0.5, 0.58)
        """
        self.board(number)  # which refuses a number of none
        names = names_of(self.scene)
        who = names.index(self.striker), names.index(self.puck)
        wanted = Target(*who, -1, self.target, -1 if self.pocket is None else self.pocket)
        columns = ("launch_heading", "launch_speed", "launch_spin")
        start = np.array([float(self.columns[name][number]) for name in columns])
        return odds_of(self.scene, wanted, start, heading, speed, spin, within, count, seed)

    def explain(self) -> str:
        """What was found, and how it was looked for."""
        return (
            f"{self.answer}\nlaunches {self.limit}: a sample over heading and speed (or spin), "
            "dense where the impacts change, then Newton's method on each; every launch is "
            "run on the whole board"
        )

    def summary(self) -> dict[str, Any]:
        """The launches with what went in, and the units of all, ready for JSON."""
        return {
            **self._attributes(),
            **{name: values.tolist() for name, values in self.columns.items()},
            "sequences": list(self.sequences),
            "scene": tables_of(self.scene),
            "units": {"target": "m", **{name: COLUMNS[name].unit for name in self.columns}},
        }

    def _attributes(self) -> dict[str, Any]:
        where = {"target": list(self.target)} if self.pocket is None else {"pocket": self.pocket}
        return {"puck": self.puck, "striker": self.striker, **where, "answer": self.answer}

    def dataset(self) -> Dataset:
        """One row a launch; what was aimed at as attributes, the scene as a text."""
        columns = {name: variable(name, row, ("launch",)) for name, row in self.columns.items()}
        columns["sequence"] = variable("sequence", list(self.sequences), ("launch",))
        attributes = {"title": "Launches on a board", **self._attributes()}
        return Dataset({}, columns, attributes, scene_texts(self.scene, self.files))


def aimed(
    scene: SceneSpec, wanted: Target, answer: str, starts: FloatArray | None = None,
    margins: FloatArray | None = None, *, of_spin: bool = False, count: int = 1, limit: str = "",
) -> BoardAim:  # fmt: skip
    """The result of launches vx, vy, spin (n, 3), the best of them run forward.

    ``margins`` (n, 2): how their ends change, or the widths of their intervals; ``answer``: what to
    say where there are none.
    """
    names = names_of(scene)
    starts = np.empty((0, 3)) if starts is None else starts
    margins = np.empty((0, 2)) if margins is None else margins
    pocketing = wanted.pocket >= 0
    speeds = np.hypot(starts[:, 0], starts[:, 1])
    if pocketing:
        shares = margins[:, 1] / (np.maximum(np.abs(starts[:, 2]), 1.0) if of_spin else speeds)
        order = np.argsort(-np.minimum(np.degrees(margins[:, 0]), 100.0 * shares), kind="stable")
    else:
        order = np.argsort(np.hypot(*margins.T), kind="stable")
    rows: list[list[float]] = []
    sequences: list[str] = []
    kept: list[int] = []
    for n in order.tolist():
        if len(kept) == count:
            break
        run = simulate(with_launch(scene, wanted.striker, starts[n]), [0.0])
        miss = _miss(run, wanted)
        if miss is None:
            continue
        sequence = _sequence(run, names[wanted.puck])
        rows.append([float(run.stop_times[wanted.puck]), miss, run.end_error, len(sequence)])
        sequences.append(", ".join(sequence))
        kept.append(n)
    starts, margins = starts[kept], margins[kept]
    values = [
        starts[:, 2], starts[:, 0], starts[:, 1], np.hypot(starts[:, 0], starts[:, 1]),
        np.arctan2(starts[:, 1], starts[:, 0]),
        *np.array(rows).reshape(-1, len(_END)).T, *margins.T,
    ]  # fmt: skip
    last = ("per_degree", "per_percent")
    if pocketing:
        last = ("heading_width", "spin_width" if of_spin else "speed_width")
    if kept:
        answer = f"{len(kept)} launch{'' if len(kept) == 1 else 'es'} {limit} found"
        if len(order) > len(kept):
            answer += f", the best of {len(order)}"
    columns = dict(zip((*_LAUNCH, *_END, *last), values, strict=True))
    return BoardAim(
        scene, names[wanted.puck], names[wanted.striker], wanted.place,
        wanted.pocket if pocketing else None, columns, tuple(sequences),
        answer.format(puck=names[wanted.puck]), limit, files_of(scene),
    )  # fmt: skip


def _miss(run: Run, wanted: Target) -> float | None:
    """How far from the target a run ends, m; None where the puck falls, or not where it is to."""
    name = run.names[wanted.puck]
    fallen = [
        e.partner for e in run.events if e.puck == name and e.what in ("pocket", "edge", "tip")
    ]
    if wanted.pocket >= 0:
        return 0.0 if fallen == [f"pocket {wanted.pocket}"] else None
    last = run.last_of(wanted.puck)
    place = last["x"], last["y"]
    return None if fallen else math.dist(place, wanted.place)


def _sequence(run: Run, puck: str) -> list[str]:
    """The impacts that led a puck where it ends, in words."""
    involved, impacts = {puck}, []
    for event in reversed(run.events):
        if event.what in ("impact", "contact") and {event.puck, event.partner} & involved:
            impacts.append(f"{event.puck} - {event.partner}")
            involved |= {event.puck, event.partner} & set(run.names)
    return impacts[::-1]
