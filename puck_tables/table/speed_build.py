"""Building a table of friction that depends on the slip speed: each patch as fine as it needs."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from puck_tables._core.arrays import rounded_up
from puck_tables._core.executor import run_chunks
from puck_tables._core.waiting import Progress
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.laws import Law as PressureLaw
from puck_tables.contact.laws import law_of
from puck_tables.contact.round_load import RoundLoad, load_of_law
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.contact.speed_quadrature import speed_integrals
from puck_tables.errors import AccuracyError
from puck_tables.kernels.speed_quadrature_kernel import COARSE, FINE
from puck_tables.table.build import checked_accuracy
from puck_tables.table.check import Accuracy
from puck_tables.table.speed_grid import breaks_of, is_pile, patches_of, rays_under
from puck_tables.table.speed_patch import FilledPatch, Law

DEFAULT_ACCURACY = 1e-6  # of f
FINEST_ACCURACY = 1e-13  # of f: finer is rounding
_FINEST_OF_OTHERS = 1e-9  # of f, under an annulus or a ring
_FINEST_OF_CIRCLES = 1e-8  # of f, under piles of circles: a node takes half a millisecond
MAX_NODES = 2_000_000  # more is an accuracy out of reach
MAX_OF_CIRCLES = 300_000  # the same under those
_NEXT = 0.03  # of the largest error: refined in the same round
_SAFETY = 2.0  # for points that were not measured
_CLOSE = 2.0  # as much again where corners put an accuracy out of reach
_COARSE_FROM = 5e-10  # from here on nodes of laws without corners are coarser; probes are not
_BETWEEN_WORDS = 0.1  # s


def tabulated(
    law: Law, accuracy: float | None = None, top_speed: float | None = None,
    scale: float | None = None, progress: Progress | None = None,
    pressure: str | PressureLaw = "uniform", reach: float = 1.0,
) -> dict[str, Any]:  # fmt: skip
    """The fields of a table of friction that depends on the slip speed, in full contact.

    The grid is cut at the corners of the law, and every patch is as fine as it needs.

    ``law``, ``accuracy``, ``top_speed``, ``scale``, ``pressure``, ``reach``: as in
    :meth:`puck_tables.Table.build`; ``progress``: callable (done, total), optional, told how far
    the errors of all patches have come.  Raises InputError if a number is out of range or the law
    gives no f; AccuracyError if the accuracy is out of range or would take more than 2 million
    nodes (300,000 under Hertz's or Galin's law or a profile); it says which accuracy can be
    reached.

    >>> made = tabulated(SpeedLaw([0.0, 0.5, 1.0, 3.0], [0.3, 0.22, 0.2, 0.25]), 1e-8)
    >>> made["accuracy"].worst < 1e-8, float(made["breaks"][-1])
    (True, 3.0)
    """
    load = load_of_law(pressure, reach, law)
    accuracy = checked_accuracy(
        accuracy, DEFAULT_ACCURACY, finest_accuracy(load), "of the largest f"
    )
    law = law.checked() if isinstance(law, FrictionLaw) else law
    breaks = breaks_of(law, top_speed, scale)
    largest = largest_f(law, float(breaks[-1]))
    piled, most = is_pile(law, load), MAX_OF_CIRCLES if load.is_integrated else MAX_NODES
    growth = load.growth if piled else 1.0
    goal = accuracy / _SAFETY / growth
    grade = law.grade if isinstance(law, SpeedLaw | FrictionLaw) else 1
    patches = patches_of(breaks, grade, rays_under(law, load))
    own = RoundLoad(law_of("uniform")) if piled else load
    rules = COARSE if isinstance(law, FrictionLaw) and accuracy >= _COARSE_FROM else FINE
    parts = [
        FilledPatch(patch, law, own, largest or 1.0, n, rules) for n, patch in enumerate(patches)
    ]
    share, last = 0.0, 0.0

    def tell(*_: int) -> None:
        nonlocal share, last
        if progress is not None and time.monotonic() >= last + _BETWEEN_WORDS:
            last = time.monotonic()
            share = max(share, sum(part.share(goal) for part in parts) / len(parts))
            progress(max(int(1000 * share), 1), 1000)

    _each(parts, FilledPatch.fill, tell)
    while pending := [part for part in parts if part.lacks(goal)]:
        chosen, room = [], most - sum(part.nodes for part in parts)
        worst = max(part.badness for part in pending)
        for part in sorted(pending, key=lambda part: -part.badness):
            if part.badness < _NEXT * worst:
                break  # not before the worst are mended: there may be no room for all
            room -= part.size_with(part.lacks(goal)) - part.nodes
            if room < 0:
                break
            chosen.append(part)
        if not chosen:
            break
        _each(chosen, lambda part: part.refine(part.lacks(goal)), tell)
    if not all(part.good(goal) for part in parts):
        reached = rounded_up(_CLOSE * _SAFETY * growth * max(part.badness for part in parts))
        raise AccuracyError(
            f"an accuracy of {accuracy:g} is out of reach for this friction law with its "
            f"corners: {reached:g} can be reached",
            reachable=reached,
        )
    cells = np.array([part.cells for part in parts], np.int64)
    return {
        "values": np.concatenate([part.values.reshape(-1, 4) for part in parts]),
        "breaks": breaks, "cells": cells, "tolerance": accuracy,
        "accuracy": _measured(parts, growth),
        "law": law if isinstance(law, SpeedLaw | FrictionLaw) else None,
        "pressure": load.law, "reach": load.reach,
    }  # fmt: skip


def finest_accuracy(load: RoundLoad) -> float:
    """How good a table under a load can be, of the largest f.

    >>> from puck_tables.contact.laws import law_of
    >>> finest_accuracy(RoundLoad(law_of("uniform"))), finest_accuracy(RoundLoad(law_of("hertz")))
    (1e-13, 1e-08)
    """
    if load.is_integrated:
        return _FINEST_OF_CIRCLES
    return FINEST_ACCURACY if len(load.discs) == 1 else _FINEST_OF_OTHERS


def _each(parts: list[FilledPatch], work: Callable[[FilledPatch], None], tell: Progress) -> None:
    """Do it to every patch, on several threads."""
    run_chunks(lambda start, _: work(parts[start]), len(parts), 1, progress=tell)


def largest_f(law: Law, top: float) -> float:
    """The largest f up to a speed: at a point of a law that does not overshoot, or sampled.

    >>> largest_f(SpeedLaw([0.0, 1.0], [0.2, 0.3]), 0.5)
    0.25
    """
    if isinstance(law, SpeedLaw | FrictionLaw):
        return law.largest(top)
    speeds = top * np.linspace(0.0, 1.0, 1001) ** 3
    return float(np.abs(speed_integrals(0.0, speeds, law).a).max())


def _measured(parts: list[FilledPatch], growth: float) -> Accuracy:
    errors = growth * np.concatenate([part.errors for part in parts]).T
    phi = np.concatenate([part.phi for part in parts])
    fastest = np.concatenate([part.speeds for part in parts]) * (np.cos(phi) + np.sin(phi))
    return Accuracy.of(errors, phi, fastest, None)
