"""What a scene says: a puck, a floor, a launch, and whatever acts on it; ranges of such numbers."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Self

import numpy as np

from puck_tables._core.arrays import FloatArray, instance
from puck_tables._core.fields import KeepsDefaults, Unsaid, of, specs
from puck_tables._core.reading import MAX_COUNT, Range, Reading, entries_in, read_values, written
from puck_tables.errors import InputError
from puck_tables.motion.body import STANDARD_GRAVITY
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.scene.entries import LAUNCH, columns_of, entry_at, is_batch, set_path, tables_of
from puck_tables.scene.floor_parts import frictions_on, largest_of
from puck_tables.scene.parts import Constraint, Drag, Edge, Floor, Force, Lateral, Launch, Wall
from puck_tables.scene.pucks_and_posts import Arc, Line, Pocket, Post, Rim, ScenePuck

MAX_RUNS = 1_000_000_000  # of one sweep


class Ranges(dict[str, Any]):
    """Ranges, and the parts of the scene that they are of."""

    def __init__(self, axes: Mapping[str, FloatArray], parts: Mapping[str, Any]) -> None:
        super().__init__(axes)
        self.parts = parts

    def __reduce__(self) -> Any:
        return Ranges, (dict(self), self.parts)

    def of_the_same(self, parts: Mapping[str, Any]) -> dict[str, FloatArray]:
        """Without those of parts that another scene has replaced."""
        kept = [name for name, part in parts.items() if part is self.parts.get(name)]
        return {path: one for path, one in self.items() if re.split(r"[.\[]", path)[0] in kept}


def refuse_twice(kind: type, tables: Mapping[str, Any], ranges: Any) -> None:
    """Refuse ranges that are none, or of numbers that are lists already."""
    if not isinstance(ranges, Mapping) or not all(isinstance(path, str) for path in ranges):
        raise InputError("ranges must be a mapping from paths such as 'launch.spin' to values")
    if ranges:
        reading = Reading([], {})
        read_values(kind, tables, "", reading)
        listed = {*(reading.ranges or {}), *reading.batches}
        many = [path for path in ranges if is_batch(path) and reading.batches]
        twice = [path for path in ranges if path in listed] + many
        if twice:
            raise InputError(f"{', '.join(twice)}: given as a list and in ranges: give one of them")


def batch_of(
    pairs: Mapping[str, FloatArray], ranges: dict[str, Range], errors: list[str]
) -> dict[str, FloatArray]:
    """What belongs to many launches, by path; it is no range of its own then."""
    if not pairs:
        return {}
    owners = sorted({owner_of(path) for path in pairs})
    if len(owners) > 1:
        errors.append(
            f"{', '.join(pairs)}: many launches at once are of one puck, the others have one each"
        )
        return {}
    count = len(next(iter(pairs.values())))
    if count > MAX_COUNT:
        errors.append(f"{count} launches: at most {MAX_COUNT} in one scene")
    numbers: dict[str, FloatArray] = {
        path: ranges.pop(path).numbers()
        for path in (f"{owners[0]}.spin", f"{owners[0]}.orientation")
        if path in ranges and ranges[path].listed
    }
    batch: dict[str, FloatArray] = {**pairs, **numbers}
    for path, values in batch.items():
        if len(values) != count:
            errors.append(
                f"{path}: {len(values)} values for {count} launches: give one for each, or a range "
                "'START:STOP:COUNT' for all of them"
            )
    return batch


def owner_of(path: str) -> str:
    """The axis of many launches that an entry of a launch belongs to.

    >>> owner_of("puck[1].launch.velocity")
    'puck[1].launch'
    """
    return path.rpartition(".")[0]


def launch_rows(launch: Launch, batch: Mapping[str, FloatArray], owner: str) -> FloatArray:
    """Rows of vx, vy, spin, x, y, orientation, array (n, 6), of the axis ``owner``."""
    rows = np.empty((len(next(iter(batch.values()))), len(LAUNCH)))
    rows[:, 0:2] = batch.get(f"{owner}.velocity", launch.velocity or (0.0, 0.0))
    rows[:, 2] = batch.get(f"{owner}.spin", launch.spin)
    rows[:, 3:5] = batch.get(f"{owner}.position", launch.position)
    rows[:, 5] = batch.get(f"{owner}.orientation", launch.orientation)
    return rows


@dataclass(frozen=True, eq=False, repr=False)
class SceneSpec(KeepsDefaults):
    """What a scene says, part by part, each checked; :class:`puck_tables.Scene` adds its verbs.

    What computes takes this class: it stands below all that can be asked of a scene.  Whether the
    parts go together is checked by :class:`puck_tables.Scene`.

    >>> SceneSpec(PuckSpec(0.04), launch=Launch(spin=[0.0, 5.0])).ranges["launch.spin"].tolist()
    [0.0, 5.0]
    """

    puck: PuckSpec = of("part", None, part=PuckSpec)
    floor: Floor = of("part", Floor(), part=Floor)
    launch: Launch = of("part", Launch(), part=Launch)
    drag: Drag = of("part", Drag(), part=Drag)
    lateral: Lateral = of("part", Lateral(), part=Lateral)
    force: Force = of("part", Force(), part=Force)
    pucks: tuple[ScenePuck, ...] = of("parts", (), part=ScenePuck, table="puck[]")
    walls: tuple[Wall, ...] = of("parts", (), part=Wall, table="wall")
    posts: tuple[Post, ...] = of("parts", (), part=Post, table="post")
    arcs: tuple[Arc, ...] = of("parts", (), part=Arc, table="arc")
    pockets: tuple[Pocket, ...] = of("parts", (), part=Pocket, table="pocket")
    lines: tuple[Line, ...] = of("parts", (), part=Line, table="line")
    edges: tuple[Edge, ...] = of("parts", (), part=Edge, table="edge")
    rims: tuple[Rim, ...] = of("parts", (), part=Rim, table="rim")
    constraint: Constraint | None = of("part", None, part=Constraint)
    title: str = of("text", "")
    gravity: float | None = of(
        "number",
        None,
        "m/s^2",
        acts="",
        low=0.0,
        above=True,
        doc="of all pucks; left out: that of the pucks",
    )
    time: float | None = of("number", None, "s", low=0.0, above=True, doc="until rest if left out")
    frames: float = of("number", 101.0, low=1.0, high=1e6, doc="states to save")
    tol: float = of(
        "number", 1e-9, low=1e-12, high=1e-2,
        doc="error wanted, of Q/a and Q^2/a: Q the slip, a the deceleration at the launch",
    )  # fmt: skip
    ranges: Mapping[str, FloatArray] = field(default_factory=dict)

    def __post_init__(self) -> None:
        tables, ranges, before = entries_in(self), self.ranges, None
        if isinstance(ranges, Ranges):  # of the scene of which this one is a changed copy
            before, ranges = ranges.parts["gravity"], ranges.of_the_same(self._parts())
        else:
            refuse_twice(type(self), tables, ranges)
        if ranges:  # as if they stood where their numbers are
            tables = tables_of(self)
            for path, values in ranges.items():
                for entry, column in columns_of(path, values):
                    set_path(tables, entry, column)
        self._fill(tables, "scene", before)

    @classmethod
    def from_tables(cls, tables: Mapping[str, Any], source: str = "scene") -> Self:
        """A scene from nested tables, as a TOML file gives them; walls stand under ``wall``.

        ``source``: its name, for messages.  InputError as for the class.

        >>> SceneSpec.from_tables({"puck": {"radius": 0.04, "height": "0:0.01:2"}}).ranges
        {'puck.height': array([0.  , 0.01])}
        """
        if not isinstance(tables, Mapping):
            raise InputError(f"{source}: a scene is a table of tables, got {type(tables).__name__}")
        scene = object.__new__(cls)
        scene._fill(tables, source)
        return scene

    def __repr__(self) -> str:
        """What it was given."""
        ranges = f", ranges={dict(self.ranges)!r})" if self.ranges else ")"
        return written(self).removesuffix(")") + ranges

    def __eq__(self, other: object) -> bool:
        """Whether both say the same, ranges included."""
        if type(other) is not type(self):
            return NotImplemented
        parts = (spec.name for spec in specs(type(self)).values())
        same = all(getattr(self, name) == getattr(other, name) for name in parts)
        theirs: Any = other.ranges
        return same and list(self.ranges) == list(theirs) and all(
            np.array_equal(values, theirs[path]) for path, values in self.ranges.items()
        )  # fmt: skip

    __hash__ = None  # type: ignore[assignment]  # ranges are arrays

    @property
    def frictions(self) -> tuple[float, ...]:
        """Coulomb's coefficients of strips, else that of the puck; then of patches.

        Of a stretch with a law over the slip speed that at rest.

        >>> SceneSpec(PuckSpec(1.0, friction=0.1)).frictions
        (0.1,)
        """
        plain = self.floor if self.floor.patches else replace(self.floor, law="")
        return tuple(largest_of(one, 0.0) for one in frictions_on(plain, self.puck.friction))

    @property
    def heights(self) -> list[float]:
        """δ = 2fh/r for each of them.

        >>> SceneSpec(PuckSpec(0.5, 1.0, 0.1)).heights
        [0.4]
        """
        puck = self.puck
        return [2.0 * friction * puck.height / puck.radius for friction in self.frictions]

    def single(self) -> Self:
        """Itself, if no number of it is a range, else InputError."""
        if self.ranges:
            raise InputError(
                f"{', '.join(self.ranges)}: a range makes many runs; give one number, or run a "
                "sweep"
            )
        return self

    def alone(self, puck: PuckSpec) -> Self:
        """A puck alone on its floor up to its edges, as long and as close, whether or not it fits.

        >>> board = SceneSpec(pucks=[ScenePuck(0.5, friction=0.1)])
        >>> board.alone(board.pucks[0]).frictions
        (0.1,)
        """
        scene = object.__new__(type(self))
        for spec in specs(type(self)).values():
            object.__setattr__(scene, spec.name, spec.default)
        object.__setattr__(scene, "puck", puck)
        for name in ("floor", "edges", "gravity", "time", "tol"):
            object.__setattr__(scene, name, getattr(self, name))
        object.__setattr__(scene, "ranges", {})
        return scene

    def at(self, numbers: Mapping[str, Any]) -> Self:
        """The scene without ranges, with other numbers, by path; InputError if they do not fit it.

        >>> SceneSpec(PuckSpec(0.04)).at({"launch.spin": 5.0}).launch.spin
        5.0
        """
        if not isinstance(numbers, Mapping):
            raise InputError("numbers must be a mapping from paths such as 'launch.spin'")
        tables = tables_of(self)
        for path, number in numbers.items():
            set_path(tables, path, number)
        return type(self).from_tables(tables)

    def unit_of(self, path: str) -> str:
        """The unit of what ranges along an axis, '' of a number without one.

        >>> SceneSpec(PuckSpec(0.04)).unit_of("launch.position[1]")
        'm'
        """
        instance("path", path, str)
        return "" if is_batch(path) else entry_at(self, path).kind.unit

    def _parts(self) -> dict[str, Any]:
        """Its parts by the tables that they stand in."""
        known = specs(type(self)).items()
        return {table: getattr(self, spec.name) for table, spec in known}

    def _disagreements(self) -> list[str]:
        """What is wrong between its parts: known to :class:`puck_tables.Scene`."""
        return []

    def _fill(self, tables: Mapping[str, Any], source: str, before: float | None = None) -> None:
        """Check all that is given, and take it; pucks may have got the gravity ``before``."""
        ranges: dict[str, Range] = {}
        reading = Reading([], ranges)
        puck = tables.get("puck")
        if isinstance(puck, ScenePuck) and (stray := puck.only_on_boards):
            raise _refusal(
                [
                    f"the puck has its own {', '.join(stray)}: give launch, force and constraint "
                    "of one puck beside it, Scene(puck, launch=...), or Scene(pucks=[puck])"
                ],
                source,
            )
        values = read_values(type(self), tables, "", reading)
        batch = batch_of(reading.batches, ranges, reading.errors)
        runs = math.prod([one.count for one in ranges.values()], start=max(len(batch), 1))
        if runs > MAX_RUNS:  # before their numbers are made
            reading.errors.append(
                f"{len(ranges)} ranges ({', '.join(list(ranges)[:3])} ...) make more than "
                f"{MAX_RUNS:g} runs: give fewer or shorter ones"
            )
        reading.errors.extend(_puck_or_pucks(values))
        if values is not None and not reading.errors:
            reading.errors.extend(_give_gravity(values, ranges, before))
        if values is None or reading.errors:
            raise _refusal(reading.errors, source)
        for spec in specs(type(self)).values():
            object.__setattr__(self, spec.name, values.get(spec.name, spec.default))
        axes = {path: one.numbers() for path, one in ranges.items()}
        if len(batch):
            owner = owner_of(next(iter(batch)))
            number = re.match(r"puck\[(\d+)\]", owner)
            launch = self.pucks[int(number[1])].launch if number else self.launch
            axes = {owner: launch_rows(launch, batch, owner), **axes}
        object.__setattr__(self, "ranges", Ranges(axes, self._parts()))
        if not axes and (faults := self._disagreements()):  # else they are up to each run
            raise _refusal(faults, source)


def _refusal(faults: list[str], source: str) -> InputError:
    head = f"{source}: {len(faults)} error{'s' if len(faults) != 1 else ''}"
    return InputError("\n  ".join([head, *faults]))


def _puck_or_pucks(values: Mapping[str, Any] | None) -> Iterator[str]:
    """What is wrong with one puck, or several."""
    if values is None:
        return
    if not values.get("puck") and not values.get("pucks"):
        yield "puck is missing: it must be a table, or a list of tables [[puck]]"
    if values.get("puck") and values.get("pucks"):
        yield "puck and pucks: give one puck with its launch, or a list of pucks"


def _give_gravity(
    values: dict[str, Any], ranges: Mapping[str, Range], before: float | None
) -> Iterator[str]:
    """Give all pucks the gravity of the scene, if it has one; what contradicts it is told."""
    gravity, several = values.get("gravity"), bool(values.get("pucks"))
    if gravity is not None or before is not None:
        _weigh(values, STANDARD_GRAVITY if gravity is None else gravity)
    pucks = values["pucks"] if several else (values["puck"],)
    for number, puck in enumerate(pucks):
        path = f"puck[{number}].gravity" if several else "puck.gravity"
        said = path if path in ranges else f"{path} = {puck.gravity:g}"
        if gravity is None:
            if several and (path in ranges or puck.gravity != pucks[0].gravity):
                yield (
                    f"{said}, where puck[0] has {pucks[0].gravity:g} m/s^2: pucks of one scene "
                    f"have one gravity, write it once above all, as gravity = {puck.gravity:g}, "
                    "and for no puck"
                )
                return
        elif not isinstance(puck.gravity, Unsaid) and (
            path in ranges or "gravity" in ranges or puck.gravity != gravity
        ):
            yield (
                f"{said}: the scene's gravity, {gravity:g} m/s^2, is that of all its pucks: leave "
                "one of them out"
            )


def _weigh(values: dict[str, Any], gravity: float) -> None:
    """Give a gravity to all pucks that were not given one."""

    def heavy(puck: PuckSpec) -> PuckSpec:
        if puck.gravity == gravity or not isinstance(puck.gravity, Unsaid):
            return puck
        return replace(puck, gravity=Unsaid(gravity))

    if values.get("puck"):
        values["puck"] = heavy(values["puck"])
    values["pucks"] = tuple(map(heavy, values.get("pucks") or ()))
