"""What tables under a pressure law have in common: the law, and the slip angles of their nodes."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import ClassVar

from puck_tables.contact.laws import Law
from puck_tables.table.slip_axis import LawAxis
from puck_tables.table.table import Table


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

    @property
    @abstractmethod
    def lines_at(self) -> tuple[float, ...]:
        """Cot φ of the singular lines, ascending."""

    @cached_property
    def axis(self) -> LawAxis:
        """The slip angles of its nodes."""
        sides = 2 * (len(self.lines_at) + self.ends_too)
        return LawAxis(self.lines_at, (len(self.values) - 1) // sides, self.ends_too)

    @property
    def pressure_law(self) -> str:
        """The name of the pressure law."""
        return self.law.name
