"""How much of the base carries load along a motion."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from puck_tables.accuracy.methods import FrictionForm
from puck_tables.contact.one_sided import loaded_share
from puck_tables.kernels.quadratic import LINE
from puck_tables.motion.body import UnitPuck
from puck_tables.motion.state import T, U
from puck_tables.motion.unit_motion import GENERIC, MotionRun
from puck_tables.table.singular_lines import opening_angle


@dataclass(frozen=True)
class Contact:
    """How much of the base carries load along a motion.

    ``launch`` and ``least``: the share of the base, 1 in full contact.  ``opens``, ``closes``: when
    part of the base lifts and when all of it is down again, in units of Q₀/J; None: never.
    """

    launch: float = 1.0
    least: float = 1.0
    opens: float | None = None
    closes: float | None = None


def contact_of(body: UnitPuck, run: MotionRun) -> Contact:
    """What carries load along a motion: the share grows with φ, and φ is monotonic in time.

    >>> from puck_tables.motion.body import body_of
    >>> from puck_tables.motion.friction_source import source_of
    >>> from puck_tables.motion.unit_motion import solve
    >>> body = body_of("uniform", 2.0, 0.5**0.5)
    >>> run, _ = solve(source_of(body), 1.0, 0.0, 1e-6)
    >>> round(contact_of(body, run).least, 6)
    0.647743
    """
    if run.friction.source is not FrictionForm.SECTION or run.regime == "A":
        return Contact()
    opening = opening_angle(body.delta) if body.law.can_lift else 0.0
    if opening == 0.0:
        return Contact()
    start = math.atan(math.exp(min(run.y[0, U], 700.0)))
    end = math.atan(body.limit_ratio) if run.regime in GENERIC else start
    launch, last = loaded_share([start, end], body.delta).tolist()
    lifted, lifts = start < opening, end < opening
    if lifted == lifts:
        return Contact(launch, min(launch, last))
    lines = run.friction.coefficients[::2, LINE]  # a step ends exactly on the line
    line = lines[np.abs(lines - math.log(math.tan(opening))).argmin()]
    ends = np.flatnonzero(run.y[:, U] == line)
    time = float(run.y[ends[0], T]) if ends.size else 0.0
    return Contact(launch, min(launch, last), *((time, None) if lifts else (None, time)))
