"""The numbers of many launches and their pucks: fixed, over ranges, given one by one, or drawn.

A puck has a radius, a height, a friction and a gravity; δ = 2fh/r may stand in place of the height,
J = fg in place of the gravity.  A velocity has a speed and a heading, or two components.
A map, or a sample, has the stops of all of them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray, finite_array
from puck_tables._core.doubts import OF_A_PUCK, question
from puck_tables.bulk.spreads import Spread
from puck_tables.bulk.summary import Summary
from puck_tables.contact.laws import Law
from puck_tables.errors import InputError
from puck_tables.io.columns import COLUMNS, Dataset, Variable, derived, following, variable
from puck_tables.result import Result
from puck_tables.stopping.solvers import OUTPUTS

if TYPE_CHECKING:
    from puck_tables.accuracy.method_errors import Selection

COLUMN = {  # of the arguments, in the order of dimensions
    "pressure": "pressure", "gyration": "gyration", "gravity": "gravity", "decel": "decel",
    "friction": "friction", "height": "height", "radius": "radius", "delta": "delta",
    "heading": "launch_heading", "vx": "launch_vx", "vy": "launch_vy", "speed": "launch_speed",
    "spin": "launch_spin",
}  # fmt: skip
SAMPLE = "sample"
CLASHES = (
    ("delta", "height"), ("decel", "gravity"), ("vx", "speed"), ("vx", "heading"), ("vy", "speed"),
    ("vy", "heading"),
)  # fmt: skip
OF_PUCK = ("pressure", "gyration", "gravity", "decel", "friction", "height", "radius", "delta")
_ABOVE_ZERO = ("gyration", "gravity", "decel", "friction", "radius")
_NOT_BELOW_ZERO = ("height", "delta", "speed")
MOST_LAWS = 100  # each needs tables of its own


@dataclass(frozen=True, eq=False)
class Population:
    """Numbers of launches by the names of arguments.

    ``dims``, ``shape``: what they range over; ``values``: arrays, each over the dimensions that
    ``over`` names; ``spreads``: what is drawn, with ``seed``, over the last dimension; ``laws``:
    the pressure laws that ``values['pressure']`` counts.
    """

    dims: tuple[str, ...]
    shape: tuple[int, ...]
    values: Mapping[str, FloatArray] = field(repr=False)
    over: Mapping[str, tuple[str, ...]]
    laws: tuple[str | Law, ...]
    spreads: Mapping[str, Spread] = field(default_factory=dict)
    seed: int = 0

    @property
    def size(self) -> int:
        """How many launches."""
        return math.prod(self.shape)

    def at(self, start: int, stop: int) -> dict[str, Any]:
        """Numbers of some launches, arrays (stop − start,) or one number for all."""
        index: dict[str, Any] = {}
        if self.dims:
            places = np.unravel_index(np.arange(start, stop), self.shape)
            index = dict(zip(self.dims, places, strict=True))
        result: dict[str, Any] = {}
        for name, array in self.values.items():
            over = self.over[name]
            result[name] = array[tuple(index[dim] for dim in over)] if over else array[()]
        for name, spread in self.spreads.items():
            result[name] = spread.drawn(name, self.seed, start, stop)
            refuse_outside(name, result[name], f"samples of {name}")
        return result

    def of_pucks(self) -> Population:
        """What of them determines the puck, over as few dimensions as it needs."""
        drawn = {name: one for name, one in self.spreads.items() if name in OF_PUCK}
        used = {dim for name in OF_PUCK for dim in self.over.get(name, ())}
        if drawn:
            used.add(SAMPLE)
        dims = tuple(dim for dim in self.dims if dim in used)
        shape = tuple(n for dim, n in zip(self.dims, self.shape, strict=True) if dim in used)
        values = {name: array for name, array in self.values.items() if name in OF_PUCK}
        return Population(dims, shape, values, self.over, self.laws, drawn, self.seed)

    @property
    def axes(self) -> dict[str, FloatArray]:
        """The ranges, by the columns of results; of pressure laws their numbers from 0 on."""
        return {
            dim: self.values[name]
            for dim in self.dims
            for name in (_ARGUMENT.get(dim, ""),)
            if self.over.get(name) == (dim,)
        }

    @property
    def fixed(self) -> dict[str, float]:
        """What is one number for all, by the columns of results."""
        alone = ("pressure", "gyration")  # in words elsewhere
        first = [name for name in ("decel", "radius") if name in self.values]
        return {
            COLUMN[name]: float(self.values[name])
            for name in dict.fromkeys([*first, *COLUMN])
            if name not in alone and name in self.values and not self.over[name]
        }

    def variables(self) -> tuple[dict[str, Variable], dict[str, Variable]]:
        """The ranges, and what is given one by one, with their labels."""
        axes, columns = {}, {}
        for name, array in self.values.items():
            over, column = self.over[name], COLUMN[name]
            flags = tuple(map(law_name, self.laws)) if name == "pressure" else ()
            one = variable(column, array.astype(np.int16) if flags else array, over, flags)
            if over == (column,):
                axes[column] = one
            elif over:
                columns[column] = one
        return {dim: axes[dim] for dim in self.dims if dim in axes}, columns

    @property
    def identity(self) -> dict[str, Any]:
        """What determines the numbers, but for the laws."""
        return {
            "shape": self.shape, "values": self.values, "over": self.over, "seed": self.seed,
            "spreads": {name: str(one) for name, one in self.spreads.items()},
        }  # fmt: skip


_ARGUMENT = {column: name for name, column in COLUMN.items()}


def ranged(chosen: Mapping[str, Any], laws: Any) -> Population:
    """Launches for all combinations of numbers and lists of them.

    ``chosen``: by the names of arguments: numbers, or lists (n,); ``laws``: a pressure law, or a
    list of them.

    >>> ranged({"spin": [0.0, 1.0], "speed": 1.0}, "uniform").axes
    {'launch_spin': array([0., 1.])}
    """
    values, over, result = _values(chosen, laws)
    for name, array in values.items():
        if array.ndim > 1 or array.size == 0:
            raise InputError(f"{name} must be a number or a list of numbers")
    for name in COLUMN:
        if name in values:
            over[name] = (COLUMN[name],) if values[name].ndim else ()
    dims = tuple(COLUMN[name] for name in COLUMN if over.get(name))
    shape = tuple(values[_ARGUMENT[dim]].size for dim in dims)
    return Population(dims, shape, values, over, result)


def drawn(chosen: Mapping[str, Any], laws: Any, count: int, seed: int) -> Population:
    """Launches of which some numbers are drawn."""
    spreads = {name: one for name, one in chosen.items() if isinstance(one, Spread)}
    if not spreads:
        raise InputError(
            "samples need a spread: give one number or more as a spread, such as a spin of "
            "normal:5:0.2"
        )
    for name, one in spreads.items():
        one.checked_for(name, COLUMNS[COLUMN[name]].unit)
    others = {name: one for name, one in chosen.items() if name not in spreads}
    values, over, result = _values(others, laws)
    for name, array in values.items():
        if array.ndim:
            raise InputError(f"{name} must be one number or a spread: samples have no ranges")
        over[name] = ()
    refuse_clashes([*values, *spreads])
    return Population((SAMPLE,), (count,), values, over, result, spreads, seed)


def labelled(launches: Any, chosen: Mapping[str, Any], laws: Any) -> Population:
    """Launches of an xarray.Dataset: its coordinates and variables, over its dimensions.

    ``launches``: xarray.Dataset with variables named as in results: launch_speed, launch_spin, …;
    ``chosen``: further numbers.
    """
    arrays = {str(name): one for name, one in launches.variables.items()}
    sizes = {str(dim): int(n) for dim, n in launches.sizes.items()}
    unknown = [name for name in arrays if name not in _ARGUMENT and name not in sizes]
    unknown += [name for name in arrays if name == "pressure"]
    known = ", ".join(column for column in _ARGUMENT if column != "pressure")
    if unknown:
        raise InputError(f"{unknown[0]} is no number of a launch: there are {known}")
    numbers = {
        _ARGUMENT[name]: np.asarray(one.values) for name, one in arrays.items() if name in _ARGUMENT
    }
    twice = [name for name in numbers if name in chosen]
    if twice:
        raise InputError(f"{twice[0]} stands in the dataset and is given, too: give one of them")
    for name, one in arrays.items():
        expected, unit = COLUMNS[name].unit if name in COLUMNS else "", one.attrs.get("units")
        if name in _ARGUMENT and unit not in (None, expected):
            raise InputError(f"{name} of the dataset is in {unit}: it must be in {expected}")
    if not numbers or 0 in sizes.values():
        raise InputError(f"the dataset has no launches: give it variables of {known}")
    values, over, result = _values({**chosen, **numbers}, laws)
    for name, array in values.items():
        if name in numbers:
            over[name] = tuple(map(str, arrays[COLUMN[name]].dims))
        elif array.ndim:
            raise InputError(f"{name} must be one number beside a dataset: put lists into it")
        else:
            over[name] = ()
    return Population(tuple(sizes), tuple(sizes.values()), values, over, result)


def _values(
    chosen: Mapping[str, Any], laws: Any
) -> tuple[dict[str, FloatArray], dict[str, tuple[str, ...]], tuple[str | Law, ...]]:
    refuse_clashes(chosen)
    values: dict[str, FloatArray] = {}
    result: tuple[Any, ...] = (laws,)
    if isinstance(laws, list | tuple | np.ndarray):
        result = tuple(laws)
        if not 1 <= len(result) <= MOST_LAWS:
            raise InputError(
                f"a list of {len(result)} pressure laws: give 1 to {MOST_LAWS}, each is a kind of "
                "puck of its own that takes about a second to prepare"
            )
        values["pressure"] = np.arange(float(len(result)))
    for name, value in chosen.items():
        if isinstance(value, Spread):
            raise InputError(f"{name} is a spread: give it to sample, not to sweep")
        unit = COLUMNS[COLUMN[name]].unit
        values[name] = finite_array(name, value, unit)
        refuse_outside(name, values[name], name)
        if (numbers := values[name]).size:
            usual = OF_A_PUCK if name in ("radius", "height") else 0.0
            question(name, max(numbers.min().item(), numbers.max().item(), key=abs), unit, usual)
    return values, {"pressure": ()}, result


def refuse_clashes(names: Any) -> None:
    """Refuse two numbers that give the same."""
    for one, other in CLASHES:
        if one in names and other in names:
            raise InputError(f"{one} and {other} clash: give one of them")


def refuse_outside(name: str, values: FloatArray, words: str) -> None:
    """Refuse numbers outside their range."""
    if not values.size:
        return
    low, unit = float(values.min()), COLUMNS[COLUMN[name]].unit
    unit = "" if unit == "1" else f" {unit}"
    if name in _ABOVE_ZERO and not low > 0.0:
        raise InputError(f"{words} must be greater than 0{unit}, got {low:g}")
    if name in _NOT_BELOW_ZERO and not low >= 0.0:
        raise InputError(f"{words} must not be negative, got {low:g}{unit}")


def velocities(one: Mapping[str, Any], count: int) -> FloatArray:
    """Components (2, count) of the velocities of launches by their numbers, m/s.

    >>> velocities({"speed": 2.0}, 1).tolist()
    [[2.0], [0.0]]
    """
    rows = np.empty((2, count))
    if "speed" not in one:
        rows[0], rows[1] = one.get("vx", 0.0), one.get("vy", 0.0)
        return rows
    rows[0], rows[1] = one["speed"], 0.0
    if "heading" in one:
        rows[1] = rows[0] * np.sin(one["heading"])
        rows[0] *= np.cos(one["heading"])
    return rows


def law_name(law: str | Law) -> str:
    """A pressure law in a word."""
    return law.name if isinstance(law, Law) else law


class StopMap(Result):
    """Stops over a grid of launches.

    ``axes`` maps the ranged quantities, in the order of the arrays' dimensions ``dims``, to their
    values, by the names of columns: ``launch_speed`` (m/s), ``launch_spin`` (rad/s),
    ``launch_heading`` (rad), ``radius``, ``height`` (m), ``friction``, ``gravity``, ``decel``
    (m/s²), ``delta``, ``gyration`` (1), ``pressure`` (numbers of ``laws``).  ``fixed`` holds what
    is one number for all.

    Arrays: ``stop_time`` s, ``stop_x``, ``stop_y`` m from the launch, ``path_length`` m,
    ``turn_angle`` rad (until Q has fallen to 1/1000; integrated, to a hundred times the tolerance),
    ``body_angle`` rad, ``status`` (0: stopped), and what was given one by one.  ``method`` says how
    ('look-up', 'integrated', or both where pucks differ), ``table`` with which table,
    ``selections`` what was selected for the tolerance, ``outputs`` the names of the arrays of
    stops: on a base that is not round there is no ``turn_angle``.
    """

    picture: ClassVar[str] = "stop_map"

    def __init__(
        self, launches: Population, tol: float, method: str, table: str,
        selections: tuple[Selection, ...], explanation: str, own: Dataset,
    ) -> None:  # fmt: skip
        self.dims, self.axes, self.fixed = launches.dims, launches.axes, launches.fixed
        self.laws = tuple(map(law_name, launches.laws))
        self.tol, self.method, self.table, self.selections = tol, method, table, selections
        self._explanation, self._own = explanation, own
        self.outputs = tuple(name for name in OUTPUTS if name in own.columns)

    def __getattr__(self, name: str) -> Any:
        """A column: of the stops, what was given one by one, or what follows from others."""
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._own.columns:
            return self._own.columns[name].values
        return following(self, name)

    def __repr__(self) -> str:
        ranged = " x ".join(f"{name} ({n})" for name, n in zip(self.dims, self.status.shape,
                                                               strict=True))  # fmt: skip
        return f"{type(self).__name__}({ranged or 'one launch'}, by {self.method})"

    def explain(self) -> str:
        """Which method was taken, and why."""
        return self._explanation

    def dataset(self) -> Dataset:
        """The stops over what was ranged; the rest as attributes."""
        own = self._own
        values = {name: one.values for name, one in own.columns.items() if name in OUTPUTS}
        more = {name: variable(name, one, self.dims) for name, one in derived(values).items()}
        return Dataset(own.axes, {**own.columns, **more}, own.attributes)


class StopSample(StopMap, Summary):
    """Stops of samples: a :class:`StopMap` over ``sample``, and its summaries.

    Besides the stops, the numbers that were drawn are columns: ``launch_spin``, ….
    """

    picture: ClassVar[str] = "sample"
    place = ("stop_x", "stop_y")
    shown = ("stop_time", "path_length")

    def __init__(self, *parts: Any) -> None:
        super().__init__(*parts)
        self.summed = self.outputs

    @property
    def drawn_words(self) -> str:
        """What scatters, in words."""
        words = {
            name.removeprefix("drawn_"): text
            for name, text in self._own.attributes.items() if name.startswith("drawn_")
        }  # fmt: skip
        said = (f"{name} {text} {COLUMNS[name].unit}" for name, text in words.items())
        return ", ".join(one.removesuffix(" 1") for one in said)
