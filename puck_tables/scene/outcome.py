"""What a scene run gives: states, reactions, events and an energy ledger."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS, derived, following
from puck_tables.io.dataset import Dataset, variable
from puck_tables.result import TimedResult
from puck_tables.scene.entries import tables_of, units_of
from puck_tables.scene.library import files_of
from puck_tables.scene.plan import Plan
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.scene.scene_text import as_toml

ENDS = (
    "at rest", "carried by the floor", "carried round", "time is up", "over the edge",
    "step limit", "events crowd together", "not finite", "undecided", "impacts without end",
    "unsolved", "faster than a table of restitution goes", "no end found", "refused",
)  # fmt: skip
IMPACTS_WITHOUT_END, UNSOLVED, TOO_FAST = range(9, 12)  # of boards, beside the codes of the loop
NO_END, REFUSED = len(ENDS) - 2, len(ENDS) - 1  # of one of many runs, which go on
EVENTS = ("stick", "slip", "impact", "contact", "entry", "edge", "exit", "overhang")

# rows of the compiled loop, and what follows from them
LEDGER = (
    "time", "x", "y", "orientation", "vx", "vy", "spin", "work_given", "heat_dry", "heat_viscous",
    "work_support", "lambda_1", "lambda_2", "carried", "heat_impact", "kinetic_energy",
)  # fmt: skip
SLIPS = ("slip_speed", "slip_angle")  # in the laboratory
EVENT_UNITS = {"time": "s", "what": "1", "which": "1", "x": "m", "y": "m"}


class Event(NamedTuple):
    """What happened on the way: when (s), what, which, where (m).

    ``which``, from 0: of impact and contact the wall, of edge and overhang the edge, of entry and
    exit the border between strips and after all borders the patch, of stick and slip the strip
    under the centre.
    """

    time: float
    what: str
    which: int
    x: float
    y: float


@dataclass(frozen=True, eq=False, repr=False)
class SceneRun(TimedResult):
    """What happened.

    ``end``: 'at rest', 'carried by the floor' (at rest on a moving one), 'carried round' (at rest
    on one that turns, over the same borders again and again: a whole turn is followed), 'time is
    up' or 'over the edge'; ``end_time`` s; ``events``: what happened, one of stick (it comes to
    rest on the floor), slip (it leaves that rest), impact, contact (it stays at a wall), entry (its
    rim comes over a border or patch), exit (it has left it), overhang (its rim comes over an edge:
    from there to the edge it is carried as if nothing of it hung in the air), edge.
    ``plan``: the model that was taken, and why.  ``energy_residual``: what the ledger misses, as a
    share of its largest entry.  ``error_estimate``: of the end time in
    units of Q/J and of places in Q²/J, with ``speed_scale`` = Q in m/s and ``rate_scale`` = J in
    m/s² (the slip hypot(v, rω) at the launch, and the largest of friction, forces and what a
    turning floor asks over the mass; without slip Q² = J r), and of the times of rebounds from one
    wall.  It is above
    ``tol`` where the motion amplifies errors so much that tol cannot be kept.
    ``columns``: arrays (n,) over time by name, each also an attribute (``run.x``); ``heat_dry`` is
    that of the floor and of a rim that rubs on a cushion it leans on; ``heading``,
    ``slip_speed`` and ``slip_angle`` are of the motion in the laboratory, 0 at rest there.
    ``last``: the columns at the end, numbers.  ``files``: what stood in the files that the scene
    names, by the path of the entry.  Called with times it gives the same run with its states there.
    """

    scene: SceneSpec
    plan: Plan
    end: str
    end_time: float
    events: list[Event]
    energy_residual: float
    error_estimate: float
    speed_scale: float
    rate_scale: float
    steps: int
    last: Mapping[str, float]
    columns: Mapping[str, FloatArray] = field(repr=False)
    simulated: Callable[[SceneSpec, npt.ArrayLike], SceneRun] = field(repr=False)
    files: Mapping[str, str] = field(default_factory=dict, repr=False)

    picture: ClassVar[str] = "scene"

    def __call__(self, times: npt.ArrayLike) -> SceneRun:
        """The same run with its states at other times, s, ascending.

        Those after its end are left out, unless it rests there.

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
            f"SceneRun({title}{self.end} after {self.end_time:.6g} s at ({self.last['x']:.6g}, "
            f"{self.last['y']:.6g}) m, {count} event{'s' if count != 1 else ''})"
        )

    def __getattr__(self, name: str) -> FloatArray:
        """A column by its name."""
        if name in SLIPS:
            return self._derived()[name]
        return column_of(self, name)

    @property
    def impacts(self) -> int:
        """How many impacts on walls there were."""
        return sum(event.what == "impact" for event in self.events)

    def _derived(self) -> dict[str, FloatArray]:
        found, rim = derived(self.columns), self.scene.puck.radius * self.columns["spin"]
        slips = np.hypot(found["speed"], rim), np.arctan2(rim, found["speed"])
        return {**found, **dict(zip(SLIPS, slips, strict=True))}

    def explain(self) -> str:
        """The model that was taken, and why."""
        return self.plan.why

    def summary(self) -> dict[str, Any]:
        """The scalars with what went in, and the units of all, ready for JSON.

        Examples
        --------
        >>> from puck_tables import Launch, Puck, Scene
        >>> scene = Scene(Puck(0.04, friction=0.1), launch=Launch((1.0, 0.0)))
        >>> told = scene.simulate().summary()
        >>> told["end"], told["scene"]["launch"]["velocity"], told["units"]["scene.launch.velocity"]
        ('at rest', [1.0, 0.0], 'm/s')
        """
        last = {name: value for name, value in self.last.items() if name != "time"}
        return {
            "title": self.scene.title,
            "end": self.end,
            "end_time": self.end_time,
            **last,
            "events": [event._asdict() for event in self.events],
            "energy_residual": self.energy_residual,
            "error_estimate": self.error_estimate,
            "speed_scale": self.speed_scale,
            "rate_scale": self.rate_scale,
            "steps": self.steps,
            "model": self.plan.model,
            "scene": tables_of(self.scene),
            "units": {
                "end_time": "s",
                "speed_scale": "m/s",
                "rate_scale": "m/s^2",
                **{name: COLUMNS[name].unit for name in last},
                **{f"events.{name}": unit for name, unit in EVENT_UNITS.items()},
                **{f"scene.{path}": unit for path, unit in units_of(self.scene).items()},
            },
        }

    def dataset(self) -> Dataset:
        """States over time and events; scalars as attributes; the scene and its files as texts."""
        columns = {**self.columns, **self._derived()}
        over_time = {name: variable(name, row, ("time",)) for name, row in columns.items()}
        axes = {"time": over_time.pop("time")}
        if self.events:
            axes["event"] = variable("event", np.arange(len(self.events)), ("event",))
            for name in ("time", "what", "which"):
                values = [getattr(event, name) for event in self.events]
                row: Any = values if name == "what" else np.array(values)
                over_time[f"event_{name}"] = variable(f"event_{name}", row, ("event",))
        left_out = (*columns, "events", "scene", "units", "title")
        scalars = {n: v for n, v in self.summary().items() if n not in left_out}
        attributes = {"title": self.scene.title or "Scene", **scalars}
        return Dataset(axes, over_time, attributes, scene_texts(self.scene, self.files))


def refuse_changed(scene: SceneSpec, files: Mapping[str, str]) -> None:
    """Refuse to go on with a run of a scene whose files are no longer what they were.

    Raises
    ------
    InputError
    """
    if files_of(scene) != files:
        raise InputError("a file that the scene names has changed since the run: run it again")


def column_of(result: Any, name: str) -> FloatArray:
    """A column as an attribute of a result of a scene.

    Raises
    ------
    AttributeError
    """
    columns: Mapping[str, FloatArray] = result.__dict__.get("columns", {})
    column: FloatArray = columns[name] if name in columns else following(result, name)
    return column


def plain_name(path: str) -> str:
    """A path of a scene as a name: no brackets or dots, which other programs stumble over.

    Examples
    --------
    >>> plain_name("launch.velocity[0]")
    'launch_velocity_0'
    """
    return path.replace("[", "_").replace("]", "").replace(".", "_")


def scene_texts(scene: SceneSpec, files: Mapping[str, str]) -> dict[str, tuple[str, str]]:
    """A scene as a scene file, the files it names, and what they are."""
    named = {
        plain_name(path): (text, f"what stands in the file that {path} of the scene names")
        for path, text in files.items()
    }
    return {"scene": (as_toml(scene), "the scene as a scene file (TOML)"), **named}


def ledger(
    columns: Mapping[str, FloatArray], start: npt.ArrayLike
) -> tuple[FloatArray, FloatArray]:
    """What is missing in the energy ledger, and its largest entry, J, for every element.

    ``start``: the kinetic energy at the launch, J.

    Examples
    --------
    >>> names = ("work_given", "work_support", "heat_viscous", "heat_impact")
    >>> entries = {name: np.zeros(1) for name in names}
    >>> entries |= {"kinetic_energy": np.ones(1), "heat_dry": np.ones(1) + 1.0}
    >>> ledger(entries, 4.0)
    (array([1.]), array([4.]))
    """
    gains = [columns[name] for name in ("work_given", "work_support")]
    names = ("kinetic_energy", "heat_dry", "heat_viscous", "heat_impact")
    losses = [columns[name] for name in names]
    missing = np.abs(np.asarray(start) + sum(gains) - sum(losses))
    entries = np.broadcast_arrays(np.asarray(start), *gains, *losses)
    return missing, np.max(np.abs(entries), axis=0)


def ledger_residual(columns: Mapping[str, FloatArray], start: float) -> float:
    """The largest miss of a run as a share of the largest entry of its ledger.

    Examples
    --------
    >>> names = ("work_given", "work_support", "heat_viscous", "heat_impact", "heat_dry")
    >>> ledger_residual({"kinetic_energy": np.ones(2), **{n: np.zeros(2) for n in names}}, 1.0)
    0.0
    """
    missing, largest = ledger(columns, start)
    return float(missing.max()) / float(largest.max()) if largest.max() > 0.0 else 0.0
