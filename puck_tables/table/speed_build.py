"""Building a table of friction that depends on the slip speed: each patch as fine as it needs."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from puck_tables._core.executor import run_chunks
from puck_tables._core.real import rounded_up
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.contact.speed_quadrature import speed_integrals
from puck_tables.errors import AccuracyError
from puck_tables.kernels.speed_quadrature_kernel import COARSE, FINE
from puck_tables.table.accuracy import Accuracy
from puck_tables.table.build import COARSEST
from puck_tables.table.speed_grid import breaks_of, patches_of
from puck_tables.table.speed_patch import FilledPatch, Law
from puck_tables.table.speed_values import SpeedValues
from puck_tables.table.table import Progress

K = TypeVar("K", bound=SpeedValues)  # the kind that is made

DEFAULT_ACCURACY = 1e-6  # of f
FINEST_ACCURACY = 1e-13  # of f: finer is rounding
MAX_NODES = 2_000_000  # more is an accuracy out of reach
_NEXT = 0.03  # of the largest error: refined in the same round
_SAFETY = 2.0  # for points that were not measured
_COARSE_FROM = 5e-10  # from here on nodes of laws without corners are coarser; probes are not
_BETWEEN_WORDS = 0.1  # s


def tabulated(
    kind: type[K],
    law: Law,
    accuracy: float | None = None,
    top_speed: float | None = None,
    scale: float | None = None,
    progress: Progress | None = None,
) -> K:
    """Friction with a coefficient that depends on the slip speed, in full contact, tabulated.

    The grid is cut at the corners of the law, and every patch is as fine as it needs.

    Parameters
    ----------
    law, accuracy, top_speed, scale : as in :meth:`puck_tables.Table.build`
    progress : callable (done, total), optional
        Told how far the errors of all patches have come.

    Raises
    ------
    InputError
        If a number is out of range or the law gives no f.
    AccuracyError
        If the accuracy is out of range or would take more than 2 million nodes; it says which
        accuracy can be reached.

    Examples
    --------
    >>> from puck_tables.table.speed_table import SpeedTable
    >>> table = tabulated(SpeedTable, SpeedLaw([0.0, 0.5, 1.0, 3.0], [0.3, 0.22, 0.2, 0.25]), 1e-8)
    >>> table.accuracy.worst < 1e-8, table.top
    (True, 3.0)
    """
    accuracy = DEFAULT_ACCURACY if accuracy is None else accuracy
    if not FINEST_ACCURACY <= accuracy <= COARSEST:
        raise AccuracyError(
            f"the accuracy of a table of speeds must be from {FINEST_ACCURACY:g} to "
            f"{COARSEST:g} (of the largest f), got {accuracy:g}"
        )
    law = law.checked() if isinstance(law, FrictionLaw) else law
    breaks = breaks_of(law, top_speed, scale)
    largest = largest_f(law, float(breaks[-1]))
    goal = accuracy / _SAFETY
    patches = patches_of(breaks, law.grade if isinstance(law, SpeedLaw | FrictionLaw) else 1)
    rules = COARSE if isinstance(law, FrictionLaw) and accuracy >= _COARSE_FROM else FINE
    parts = [FilledPatch(patch, law, largest or 1.0, n, rules) for n, patch in enumerate(patches)]
    share, told = 0.0, 0.0

    def tell() -> None:
        nonlocal share, told
        if progress is not None and time.monotonic() >= told + _BETWEEN_WORDS:
            told = time.monotonic()
            share = max(share, sum(part.share(goal) for part in parts) / len(parts))
            progress(max(int(1000 * share), 1), 1000)

    _each(parts, FilledPatch.fill, tell)
    while pending := [part for part in parts if part.lacks(goal)]:
        chosen, room = [], MAX_NODES - sum(part.nodes for part in parts)
        worst = max(part.badness for part in pending)
        for part in sorted(pending, key=lambda part: -part.badness):
            if part.badness < _NEXT * worst:
                break  # not before the worst are mended: there may be no room for all
            room -= part.size_with(part.lacks(goal)) - part.nodes
            if room < 0:
                break
            chosen.append(part)
        if not chosen:
            raise _out_of_reach(parts, accuracy)
        _each(chosen, lambda part: part.refine(part.lacks(goal)), tell)
    if not all(part.good(goal) for part in parts):
        raise _out_of_reach(parts, accuracy)
    cells = np.array([part.cells for part in parts], np.int64)
    values = np.concatenate([part.values.reshape(-1, 4) for part in parts])
    return kind(
        values, breaks=breaks, cells=cells, tolerance=accuracy, accuracy=_measured(parts),
        law=law if isinstance(law, SpeedLaw | FrictionLaw) else None,
    )  # fmt: skip


def _each(
    parts: list[FilledPatch], work: Callable[[FilledPatch], None], tell: Callable[[], None]
) -> None:
    """Do it to every patch, on several threads."""
    run_chunks(
        lambda start, _: work(parts[start]), len(parts), 1, progress=lambda done, total: tell()
    )


def _out_of_reach(parts: list[FilledPatch], accuracy: float) -> AccuracyError:
    reached = _SAFETY * max(part.badness for part in parts)
    return AccuracyError(
        f"an accuracy of {accuracy:g} is out of reach for this friction law with its "
        f"corners: {rounded_up(reached):g} can be reached",
        reachable=rounded_up(reached),
    )


def largest_f(law: Law, top: float) -> float:
    """The largest f up to a speed: at a point of a law that does not overshoot, or sampled.

    Examples
    --------
    >>> largest_f(SpeedLaw([0.0, 1.0], [0.2, 0.3]), 0.5)
    0.25
    """
    if isinstance(law, SpeedLaw | FrictionLaw):
        return law.largest(top)
    speeds = top * np.linspace(0.0, 1.0, 1001) ** 3
    return float(np.abs(speed_integrals(0.0, speeds, law).a).max())


def _measured(parts: list[FilledPatch]) -> Accuracy:
    errors = np.concatenate([part.errors for part in parts]).T
    phi = np.concatenate([part.phi for part in parts])
    fastest = np.concatenate([part.speeds for part in parts]) * (np.cos(phi) + np.sin(phi))
    return Accuracy.of(errors, phi, fastest, None)
