"""What tables under a pressure law have in common: the law, by its name or as a profile."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.laws import Law, law_of, profile_law
from puck_tables.errors import InputError
from puck_tables.table.metadata import Axis
from puck_tables.table.oddities import odd_nodes
from puck_tables.table.slip_axis import LawAxis
from puck_tables.table.table import Table

_RADIUS, _PRESSURE = "profile_radius", "profile_pressure"


@dataclass(frozen=True, eq=False, repr=False)
class LawTable(Table):
    """A table over the slip angle under a pressure law.

    Parameters
    ----------
    values : array (nodes of φ, …)
        At the nodes of ``axis``.
    law : Law
    """

    _: KW_ONLY
    law: Law

    ends_too: ClassVar[bool] = False  # whether φ = 0 and π/2 are singular lines besides
    entries: ClassVar[Mapping[str, type]] = {"n_phi": int, "profile_rows": int}

    def __post_init__(self) -> None:
        super().__post_init__()
        lines = np.array(self.lines_at)
        if not (lines.size and lines[0] > 0.0 and np.all(np.diff(lines) > 0.0)):
            raise ValueError("its lines are none")
        if (len(self.values) - 1) % self._sides or not np.isfinite(lines[-1]):
            raise ValueError("its nodes are not those of its lines")

    @property
    @abstractmethod
    def lines_at(self) -> tuple[float, ...]:
        """Cot φ of the singular lines, ascending."""

    @cached_property
    def axis(self) -> LawAxis:
        """The slip angles of its nodes."""
        return LawAxis(self.lines_at, (len(self.values) - 1) // self._sides, self.ends_too)

    @property
    def _sides(self) -> int:
        return 2 * (len(self.lines_at) + self.ends_too)

    @property
    def pressure_law(self) -> str:
        """The name of the pressure law."""
        return self.law.name

    @property
    def parameters(self) -> dict[str, int | float | str]:
        """How many nodes, and how many rows a tabulated law has."""
        rows = 0 if self.law.profile is None else self.law.profile[0].size
        return {"n_phi": len(self.values), "profile_rows": rows}

    @property
    def curve(self) -> dict[str, Axis]:
        """A tabulated law."""
        if self.law.profile is None:
            return {}
        radius, pressure = self.law.profile
        return {
            _RADIUS: Axis(radius, "1", "radius in units of that of the puck"),
            _PRESSURE: Axis(pressure, "1", "pressure, largest 1"),
        }

    @property
    def unsaveable(self) -> str | None:
        """A law that is a function."""
        if self.law.profile is not None or _known(self.law.name):
            return None
        return (
            f"the pressure law {self.law.name} is a function, which a file cannot hold: give it as "
            "a profile (profile_law)"
        )

    @classmethod
    def shapes(cls, attributes: dict[str, Any]) -> dict[str, tuple[int, ...]]:
        """Shapes of the arrays of a file with these attributes, over the slip angle alone."""
        nodes, rows = (attributes["n_phi"],), attributes["profile_rows"]
        if rows < 0:
            raise ValueError("its profile has no number of rows")
        profile = {_RADIUS: (rows,), _PRESSURE: (rows,)} if rows else {}
        return {"phi": nodes, **dict.fromkeys(cls.functions, nodes), **profile}

    @classmethod
    def fields(cls, attributes: dict[str, Any], arrays: dict[str, FloatArray]) -> dict[str, Any]:
        """The law of a file: no other file is read for it."""
        name = attributes["pressure_law"]
        named = not name.lower().endswith(".csv") and _known(name)
        if _RADIUS not in arrays:
            if not named:
                raise ValueError("it neither names nor holds its pressure law")
            return {"law": law_of(name)}
        if named:
            raise ValueError(f"it holds a profile that is not the law it names, {name}")
        return {"law": profile_law(arrays[_RADIUS], arrays[_PRESSURE], name=name)}

    def odd_nodes(self, count: int) -> npt.NDArray[np.int64]:
        """Numbers of about so many nodes that fit their neighbours least."""
        functions = self.values.reshape(len(self.values), -1)
        odd = odd_nodes(self.axis.by_side(functions), (1,), count)
        return np.unique(self.axis.numbers[odd[:, 0], odd[:, 1]])


def is_named(law: Law) -> bool:
    """Whether a law is the one that its name says, and no other that was given this name.

    Examples
    --------
    >>> from dataclasses import replace
    >>> is_named(law_of("ring")), is_named(replace(law_of("hertz"), name="ring"))
    (True, False)
    """
    return _known(law.name) and law_of(law.name) == law


def _known(name: str) -> bool:
    try:
        return law_of(name).name == name
    except InputError:
        return False
