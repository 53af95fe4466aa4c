"""Friction of a tall puck over many slip angles, by compiled truth.

What :func:`puck_tables.contact.one_sided.resultants` computes with arrays, point by point with
:mod:`puck_tables.kernels.one_sided_kernel`: a section of a new puck needs thousands of them.
"""

from __future__ import annotations

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import run_chunks
from puck_tables.contact import closed_form, one_sided
from puck_tables.contact.integrals import slip_direction
from puck_tables.contact.loaded_chord import LINE_RULE, SEGMENT_RULE, guessed_chord
from puck_tables.contact.one_sided import critical_delta
from puck_tables.contact.resultants import Resultants, moment_balance

_CHUNK = 64  # neighbours that follow each other


def tall_resultants(phi: FloatArray, delta: float) -> Resultants:
    """Friction resultants under uniform pressure of one height above 1.

    Parameters
    ----------
    phi : array (n,), radians, in [0, π/2]; quickest where neighbours stand next to each other
    delta : dimensionless height, 1 < δ ≤ 3.9637

    Returns
    -------
    Resultants
        Arrays (n,), good to 1e-13 for δ ≤ 3.9.

    Examples
    --------
    >>> rho = tall_resultants(np.array([0.5, 1.5]), 2.0)
    >>> rho.spin.round(7).tolist()
    [0.2196328, 1.3316333]
    """
    if delta > one_sided.FOLD_DELTA:
        return one_sided.resultants(phi, delta)
    direction = slip_direction(phi)
    found = np.stack(moment_balance(closed_form.integrals(phi), direction, delta))
    opened = np.flatnonzero(delta > critical_delta(phi))

    def work(start: int, stop: int) -> None:
        from puck_tables.kernels.one_sided_kernel import FOUND, SPIN, fill_balances

        some = opened[start:stop]
        ratio, fast = direction.ratio[some], direction.fast_spin[some]
        guess = np.stack(guessed_chord(ratio, fast, np.full(some.size, delta)))
        out = np.empty((some.size, FOUND))
        lost = fill_balances(ratio, fast, delta, guess, LINE_RULE, SEGMENT_RULE, out)
        found[:, some] = out[:, : SPIN + 1].T
        if lost:
            left = some[np.isnan(out[:, 0])]
            found[:, left] = np.stack(one_sided.resultants(phi[left], delta))

    run_chunks(work, opened.size, _CHUNK)
    return Resultants(*found)
