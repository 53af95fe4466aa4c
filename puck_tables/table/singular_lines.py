"""Where the friction of one puck is singular over its slip angle, and where it is not known.

The lines are those where the instantaneous centre of rotation crosses an edge of the load,
tan φ = 1/edge, and where contact opens, δ_c(φ) = δ, across which partial and full contact part like
x^(5/2).  Between them the friction ratios are analytic.  (That in partial contact the centre of
rotation crosses the edge of the loaded part is not felt: the pressure is zero there.)

Friction of a tall puck, which a section needs at thousands of slip angles, is what
:func:`puck_tables.contact.one_sided.resultants` computes with arrays, point by point by compiled
truth (:mod:`puck_tables.kernels.one_sided_kernel`).
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import run_chunks
from puck_tables.contact import closed_form, one_sided
from puck_tables.contact.closed_form import Resultants, moment_balance
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.laws import Law
from puck_tables.contact.loaded_chord import LINE_RULE, SEGMENT_RULE, guessed_chord
from puck_tables.contact.one_sided import critical_delta
from puck_tables.errors import ContactError

_CHUNK = 64  # neighbours that follow each other
_SAME_LINE = 1e-12  # radians
_SHARP_DELTA = 3.6  # from there on the bend below φ = π/4 is a line of its own


def tall_resultants(phi: FloatArray, delta: float) -> Resultants:
    """Friction resultants under uniform pressure of one height above 1.

    ``phi``: array (n,), radians, in [0, π/2]; quickest where neighbours stand next to each other;
    ``delta``: dimensionless height, 1 < δ ≤ 3.9637.  Returns Resultants: arrays (n,), good to 1e-13
    for δ ≤ 3.9.

    >>> rho = tall_resultants(np.array([0.5, 1.5]), 2.0)
    >>> rho.spin.round(7).tolist()
    [0.2196328, 1.3316333]
    """
    if delta > one_sided.FOLD_DELTA:
        return one_sided.resultants(phi, delta)
    direction = slip_direction(phi)
    resultants = np.stack(moment_balance(closed_form.integrals(phi), direction, delta))
    opened = np.flatnonzero(delta > critical_delta(phi))

    def work(start: int, stop: int) -> None:
        from puck_tables.kernels.one_sided_kernel import BALANCE, SPIN, fill_balances

        some = opened[start:stop]
        ratio, fast = direction.ratio[some], direction.fast_spin[some]
        guess = np.stack(guessed_chord(ratio, fast, np.full(some.size, delta)))
        out = np.empty((some.size, BALANCE))
        lost = fill_balances(ratio, fast, delta, guess, LINE_RULE, SEGMENT_RULE, out)
        resultants[:, some] = out[:, : SPIN + 1].T
        if lost:
            left = some[np.isnan(out[:, 0])]
            resultants[:, left] = np.stack(one_sided.resultants(phi[left], delta))

    run_chunks(work, opened.size, _CHUNK)
    return Resultants(*resultants)


def lines_of(law: Law, delta: float) -> tuple[float, ...]:
    """The cotangents of the lines of a puck between which splines lie, ascending.

    Besides the singular ones that where a puck next to tipping bends most.

    >>> from puck_tables.contact.laws import law_of
    >>> lines_of(law_of("annulus:0.8"), 0.5)
    (0.8, 1.0)
    >>> [round(line, 6) for line in lines_of(law_of("uniform"), 2.0)]
    [0.566906, 1.0]
    """
    refuse_height(law, delta)
    if not law.can_lift:
        return law.edges
    opening, corner = opening_angle(delta), _sharpest_corner(delta)
    if any(abs(opening - math.atan2(1.0, e)) <= _SAME_LINE for e in law.edges):
        opening = 0.0
    between = [1.0 / math.tan(line) for line in (opening, corner) if line > 0.0]
    return tuple(sorted([*law.edges, *between]))


@lru_cache(maxsize=1024)
def refuse_height(law: Law, delta: float) -> None:
    """Refuse a height at which the friction is not known at every slip angle."""
    law.friction(0.0, delta)
    if law.can_lift and delta > one_sided.FOLD_DELTA:
        raise ContactError(
            f"delta = {delta:g}: beyond {one_sided.FOLD_DELTA:g} the balance of moments has more "
            "than one solution just below phi = pi/4, and the motion is not determined; choose a "
            "lower or broader puck or less friction"
        )


@lru_cache(maxsize=1024)
def opening_angle(delta: float) -> float:
    """The slip angle φ_c with δ_c(φ_c) = δ, up to which part of the base is lifted; 0 if δ ≤ 1.

    >>> round(opening_angle(1.15913851), 6)  # π/4
    0.785398
    """
    if delta <= 1.0:
        return 0.0
    low, high = 0.0, 0.5 * math.pi
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return high
        if critical_delta(middle) < delta:
            low = middle
        else:
            high = middle


def _sharpest_corner(delta: float) -> float:
    """Where just below π/4 the ratios of a puck next to tipping bend most; 0 for lower ones.

    They are analytic there, but towards the fold of the balance (δ = 3.9638) on a scale that
    shrinks to nothing.  Nodes crowded there make the spline at δ = 3.9 240 times as good.
    """
    if delta < _SHARP_DELTA:
        return 0.0
    low, high = 0.25 * math.pi - 0.1, 0.25 * math.pi - 0.002
    while high - low > 1e-6:
        phi = np.linspace(low, high, 33)
        rho = tall_resultants(phi, delta)
        n = int(np.abs(np.diff(rho.perpendicular / rho.parallel, 2)).argmax())
        low, high = float(phi[max(n - 2, 0)]), float(phi[min(n + 3, 32)])
    return low
