"""What a run of a scene of several pucks gives: states, events, and where the energy went."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.io.columns import COLUMNS, derived
from puck_tables.io.dataset import Dataset, Variable, variable
from puck_tables.result import TimedResult
from puck_tables.scene.entries import tables_of, units_of
from puck_tables.scene.outcome import column_of, refuse_changed, scene_texts
from puck_tables.scene.parts import Drag, Force
from puck_tables.scene.pieces import PieceSpec
from puck_tables.scene.plan import EMPIRICAL
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import (
    TABLE_ERROR,
    called,
    flight_error,
    frictions_under,
    has_closed_forms,
    is_integrated,
    number_of,
    pieces_of,
)
from puck_tables.world.rim_laws import rule_of
from puck_tables.world.world import Meeting

STATE = ("x", "y", "orientation", "vx", "vy", "spin")
MEETING = Meeting._fields
_NAMED = 6  # pucks of one way


@dataclass(frozen=True, eq=False, repr=False)
class WorldRun(TimedResult):
    """What happened to several pucks.

    ``end``: 'at rest' or 'time is up'; ``end_time`` s; ``names``: of the pucks, in their order;
    ``events``: see :class:`puck_tables.world.world.Meeting`; ``time`` (n,) s; ``columns``: arrays
    (n, pucks) by name, each also an attribute (``run.x``), a puck's by its name or number
    (``run["striker"]``); ``last``: the columns at the end, (pucks,).  One that has left play stays
    where it left, its ``in_play`` is 0.  ``stop_times`` (pucks,) s: when each came to rest or left
    play; later than ``end_time`` or inf where it still moves at the end.

    ``kinetic_energy`` J given by launches, ``heat_floor``, ``heat_rims``, ``heat_impact``: what
    friction of the floor or drag, rims that push each other, and impacts took, J; ``work_driven``,
    ``work_given``, ``work_support``: what driven bodies, slope and forces, and floors and
    constraints that move gave; ``energy_residual``: what this ledger misses, as a share of its
    largest entry.  ``end_error`` m: how far twins end
    whose launches are off by 1e-9, as much as the tables may be wrong by.  Each impact of round
    pucks multiplies errors: after many of them it may be as large as the board, and nobody can know
    the end, for the launch decides it by digits that it does not have.
    """

    scene: SceneSpec
    end: str
    end_time: float
    names: tuple[str, ...]
    events: list[Meeting]
    time: FloatArray
    columns: Mapping[str, FloatArray] = field(repr=False)
    last: Mapping[str, FloatArray] = field(repr=False)
    stop_times: FloatArray = field(repr=False)
    kinetic_energy: float
    heat_floor: float
    heat_rims: float
    heat_impact: float
    work_driven: float
    work_given: float
    work_support: float
    energy_residual: float
    end_error: float
    simulated: Callable[[SceneSpec, npt.ArrayLike], WorldRun] = field(repr=False)
    files: Mapping[str, str] = field(default_factory=dict, repr=False)

    picture: ClassVar[str] = "pucks"

    def __call__(self, times: npt.ArrayLike) -> WorldRun:
        """The same run with its states at other times, s, ascending.

        Raises
        ------
        InputError
            If they are no such times, or a file that the scene names has changed since the run.
        """
        refuse_changed(self.scene, self.files)
        return self.simulated(self.scene, times)

    def __repr__(self) -> str:
        title = f"{self.scene.title}: " if self.scene.title else ""
        count = len(self.events)
        return (
            f"WorldRun({title}{len(self.names)} pucks, {self.end} after {self.end_time:.6g} s, "
            f"{count} event{'s' if count != 1 else ''})"
        )

    def __getattr__(self, name: str) -> FloatArray:
        """A column by its name."""
        return column_of(self, name)

    def __getitem__(self, puck: int | str) -> dict[str, FloatArray]:
        """The columns of one puck, by its name or number, arrays (n,).

        Raises
        ------
        InputError
            If there is no such puck.
        """
        number = number_of(puck, self.names)
        whole = {**self.columns, **derived(self.columns)}
        return {"time": self.time, **{name: row[:, number] for name, row in whole.items()}}

    @property
    def impacts(self) -> int:
        """How many impacts there were."""
        return sum(event.what == "impact" for event in self.events)

    def explain(self) -> str:
        """How every puck was moved, and by which laws they meet."""
        return f"{ways_of(self.scene)}\n{rule_of(self.scene)}"

    def summary(self) -> dict[str, Any]:
        """The scalars with what went in, and the units of all, ready for JSON."""
        scalars = (
            "end", "end_time", "kinetic_energy", "heat_floor", "heat_rims", "heat_impact",
            "work_driven", "work_given", "work_support", "energy_residual", "end_error",
        )  # fmt: skip
        pucks = [
            {
                "name": name,
                **{key: float(row[i]) for key, row in self.last.items()},
                "stop_time": stop if math.isfinite(stop) else None,
            }
            for i, (name, stop) in enumerate(zip(self.names, self.stop_times.tolist(), strict=True))
        ]
        units = {name: COLUMNS[name].unit for name in (*self.last, "stop_time")}
        return {
            "title": self.scene.title,
            **{name: getattr(self, name) for name in scalars},
            "pucks": pucks,
            "events": [event._asdict() for event in self.events],
            "scene": tables_of(self.scene),
            "units": {
                **{name: COLUMNS[name].unit for name in scalars if name != "end"},
                **{f"pucks.{name}": unit for name, unit in units.items()},
                **{f"events.{name}": COLUMNS[f"event_{name}"].unit for name in MEETING},
                **{f"scene.{path}": unit for path, unit in units_of(self.scene).items()},
            },
        }

    def dataset(self) -> Dataset:
        """States over time and pucks, and events; scalars as attributes; the scene as a text."""
        dims = ("time", "puck")
        columns: dict[str, Variable] = {"name": variable("name", list(self.names), ("puck",))}
        for name, row in {**self.columns, **derived(self.columns)}.items():
            columns[name] = variable(name, row, dims)
        columns["stop_time"] = variable("stop_time", self.stop_times, ("puck",))
        axes = {
            "time": variable("time", self.time, ("time",)),
            "puck": variable("puck", np.arange(len(self.names)), ("puck",)),
        }
        if self.events:
            axes["event"] = variable("event", np.arange(len(self.events)), ("event",))
            for name in MEETING:
                values: Any = [getattr(event, name) for event in self.events]
                words = name in ("what", "puck", "partner")
                values = values if words else np.array(values)
                columns[f"event_{name}"] = variable(f"event_{name}", values, ("event",))
        left_out = ("pucks", "events", "scene", "units", "title")
        scalars = {n: v for n, v in self.summary().items() if n not in left_out}
        attributes = {"title": self.scene.title or "Scene", **scalars}
        return Dataset(axes, columns, attributes, scene_texts(self.scene, self.files))


def ways_of(scene: SceneSpec) -> str:
    """How the pucks of a scene are moved, a line for each way, and which they are.

    Examples
    --------
    >>> from puck_tables import Piece, Scene
    >>> ways_of(Scene(pucks=[Piece(0.1, friction=0.1)]))
    '1 puck looked up from impact to impact'
    """
    pieces = pieces_of(scene)
    ways: dict[str, list[str]] = {}
    for number, piece in enumerate(pieces):
        ways.setdefault(_way_of(scene, piece), []).append(called(piece, number))
    lines = []
    for way, names in ways.items():
        shown = ""
        if len(ways) > 1:
            more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
            shown = f" ({', '.join(names[:_NAMED])}{more})"
        lines.append(f"{len(names)} puck{'s' if len(names) != 1 else ''} {way}{shown}")
    if scene.lateral.strength != 0.0:
        lines.append(EMPIRICAL)
    return "\n".join(lines)


def _way_of(scene: SceneSpec, piece: PieceSpec) -> str:
    """How a puck is moved, and why it is not looked up."""
    if piece.path:
        return "driven along a path"
    floor, frictions = scene.floor, frictions_under(scene, piece)
    integrated = [is_integrated(scene, piece, friction) for friction in frictions]
    if any(integrated):
        acts = {
            piece.constraint.kind if piece.constraint else "": piece.constraint is not None,
            "slope": floor.slope > 0.0,
            "turntable": floor.turning != 0.0,
            "force": piece.force != Force(),
            "drag": scene.drag != Drag(),
            "lateral force (empirical)": scene.lateral.strength != 0.0,
            "friction law": bool(floor.law),
            "orthotropic friction": floor.orthotropic is not None,
            "no closed forms": not all(has_closed_forms(piece, one) for one in frictions),
            f"tol below the {TABLE_ERROR:g} of tables": flight_error(scene) < TABLE_ERROR,
        }
        what = ", ".join(name for name, there in acts.items() if there)
        where = "" if all(integrated) else " on some of the floor"
        return f"integrated from impact to impact{where}: {what}"
    if not any(frictions):
        return "in closed form, without dry friction"
    way = "looked up from impact to impact"
    if floor.strips is not None or floor.patches:
        way = "looked up from impact or border to the next, integrated where astride"
    return f"{way}, over the belt" if any(floor.velocity) else way
