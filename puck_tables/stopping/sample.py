"""Stops of launches that scatter."""

from __future__ import annotations

from typing import ClassVar

from puck_tables.bulk.summary import Summary
from puck_tables.stopping.solvers import OUTPUTS
from puck_tables.stopping.sweep import StopMap


class StopSample(StopMap, Summary):
    """Stops of samples: a :class:`StopMap` over ``sample``, and its summaries.

    Besides the stops, the numbers that were drawn are columns: ``launch_spin``, ….
    """

    picture: ClassVar[str] = "sample"
    summed = OUTPUTS
    place = ("stop_x", "stop_y")
    shown = ("stop_time", "path_length")

    @property
    def drawn_words(self) -> str:
        """What scatters, in words."""
        found = self._own.attributes.items()
        return ", ".join(
            f"{name.removeprefix('drawn_')} {text}"
            for name, text in found if name.startswith("drawn_")
        )  # fmt: skip
