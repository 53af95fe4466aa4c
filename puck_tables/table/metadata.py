"""What a table says of itself: its values, what they are, and what its file holds."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, NamedTuple, Self

from puck_tables._core.arrays import FloatArray
from puck_tables._core.lazy import above
from puck_tables.table.accuracy import Accuracy

Progress = Callable[[int, int], None]

# the classes of the kinds, which stand above
KINDS = {
    "resultants": "ResultantTable",
    "stops": "StopTable",
    "speed": "SpeedTable",
    "friction section": "FrictionSection",
    "stop section": "StopSection",
}


class Axis(NamedTuple):
    """An axis in a file: its values and what they are."""

    values: FloatArray
    units: str
    long_name: str


@dataclass(frozen=True, eq=False, repr=False)
class Record(ABC):
    """The values of a table and what is said of them; :class:`puck_tables.Table` adds its verbs."""

    values: FloatArray
    tolerance: float = field(default=0.0, kw_only=True)
    accuracy: Accuracy | None = field(default=None, kw_only=True)
    metadata: dict[str, Any] = field(default_factory=dict, kw_only=True)
    source: str = field(default="memory", kw_only=True)

    # the record of a kind, as its files have it
    kind: ClassVar[str]
    algorithm: ClassVar[str]
    functions: ClassVar[Mapping[str, str]]  # names, and what they are
    second: ClassVar[str]  # the second axis, in words for a report
    errors: ClassVar[str] = "absolute errors"  # what they are, in such words
    quantities: ClassVar[tuple[str, ...]]  # what has them
    words: ClassVar[Mapping[str, str]]  # title, interpretation, method, maps of the axes
    entries: ClassVar[Mapping[str, type]]  # what determines the values besides

    def __post_init__(self) -> None:
        values = self.values.view()
        values.flags.writeable = False
        object.__setattr__(self, "values", values)

    def __repr__(self) -> str:
        return (
            f"<Table of {self.kind}: {self.pressure_law} pressure, {self.grid}, "
            f"to {self.tolerance:g}, {self.source}>"
        )

    # what a kind says

    @classmethod
    @abstractmethod
    def is_of(cls, of: object) -> bool:
        """Whether tables of this kind are built of such a thing."""

    @classmethod
    @abstractmethod
    def built(cls, of: Any, accuracy: float | None, **how: Any) -> Self:
        """Such a table, see :meth:`build`."""

    @property
    def pressure_law(self) -> str:
        """The name of the pressure law."""
        return "uniform"

    @property
    @abstractmethod
    def grid(self) -> str:
        """How many nodes it has, in words."""

    @property
    @abstractmethod
    def valid_range(self) -> str:
        """Where it holds, in words; beyond it look-ups are refused."""

    @property
    @abstractmethod
    def axes(self) -> dict[str, Axis]:
        """The axes of the functions, in their order."""

    @property
    def parameters(self) -> dict[str, int | float | str]:
        """What determines the values besides the record: the values of ``entries``."""
        return {}

    @property
    def curve(self) -> dict[str, Axis]:
        """An argument and a function of it besides, or nothing."""
        return {}

    @property
    @abstractmethod
    def bounds(self) -> tuple[float, float, float]:
        """Between which two numbers all values lie, and what no such table is better than."""

    @classmethod
    @abstractmethod
    def shapes(cls, attributes: dict[str, Any]) -> dict[str, tuple[int, ...]]:
        """Shapes of the arrays of a file with these attributes: axes, functions, curve."""

    @classmethod
    @abstractmethod
    def fields(cls, attributes: dict[str, Any], arrays: dict[str, FloatArray]) -> dict[str, Any]:
        """What the constructor needs besides the values, from a file.

        Raises
        ------
        ValueError
            If there is no such table.
        """

    @property
    def unsaveable(self) -> str | None:
        """Why no file can hold the table, in a sentence; None where one can."""
        return None


def kind_named(name: str) -> type[Record]:
    """The class of a kind.

    Examples
    --------
    >>> kind_named("stops").__name__
    'StopTable'
    """
    kind: type[Record] = above(KINDS[name])
    return kind
