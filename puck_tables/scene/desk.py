"""What is asked of a run, and the arrays that it works in."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import allocating
from puck_tables.scene.boundaries import DEGREE, Boundaries
from puck_tables.scene.equations import ROW, SIZE
from puck_tables.scene.explicit import STAGES
from puck_tables.scene.settle import Contacts, contacts_for
from puck_tables.scene.steps import WIDE


class Ask(NamedTuple):
    """What is asked of a run.

    ``until``: s; ``to_the_end``: go on to it also when carried; ``tolerance``: local error per step
    in units of ``scale`` (10,); ``speed``: the scale of speeds, m/s; ``step_limit``; ``twin``:
    0, or the share of the first step, and of those that end at an event, after which it is cut in
    two, so that no step is that of the run without, also where no error limits it; ``order``: which
    of two lines comes first that are met at once, see :mod:`puck_tables.scene.at_once`.
    """

    until: float
    to_the_end: bool
    tolerance: float
    scale: FloatArray
    speed: float
    step_limit: int
    twin: float
    order: int


class Desk(NamedTuple):
    """Arrays to work in.

    Rates of the stages of a step, and states and rates in a leap (n, 12), rates at its end (12,), a
    gap polynomial (6,), the state at the start and the end of a step and at a trial (12,), what is
    known of the walls, and of lines that were met at once (4,): how often it matters which is
    first, when at first, and which two; how the base lies to every patch of the floor (k,); the
    scales of the state (10,), which grow with it; and over which edges the base hangs.
    """

    work: FloatArray
    last: FloatArray
    gaps: FloatArray
    y: FloatArray
    new: FloatArray
    trial: FloatArray
    contacts: Contacts
    at_once: FloatArray
    lies: npt.NDArray[np.int64]
    scale: FloatArray
    hangs: npt.NDArray[np.bool_]


@allocating
def desk_for(bounds: Boundaries, patches: int) -> Desk:
    """A desk for a scene with these boundaries and so many patches on its floor."""
    return Desk(
        np.empty((STAGES, ROW)), np.empty(ROW), np.empty(DEGREE + 1), np.empty(WIDE),
        np.empty(WIDE), np.empty(WIDE), contacts_for(len(bounds.walls)), np.zeros(4),
        np.zeros(patches, np.int64), np.empty(SIZE), np.zeros(len(bounds.edges), np.bool_),
    )  # fmt: skip
