"""Maps of stops over launches and pucks, and samples of stops."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from puck_tables.bulk.summary import Summary
from puck_tables.io.columns import COLUMNS, Dataset, derived, following, variable
from puck_tables.result import Result
from puck_tables.stopping.population import Population, law_name
from puck_tables.stopping.solvers import OUTPUTS

if TYPE_CHECKING:
    from puck_tables.accuracy.method_errors import Selection


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
        found = {
            name.removeprefix("drawn_"): text
            for name, text in self._own.attributes.items() if name.startswith("drawn_")
        }  # fmt: skip
        said = (f"{name} {text} {COLUMNS[name].unit}" for name, text in found.items())
        return ", ".join(one.removesuffix(" 1") for one in said)
