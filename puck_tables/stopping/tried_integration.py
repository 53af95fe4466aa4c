"""A setting of the integrator for the stops of one kind of puck, tried out on a few."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.accuracy.method_errors import COARSEST
from puck_tables.accuracy.methods import Method
from puck_tables.kernels.quadratic import NO_COLUMNS
from puck_tables.motion.body import UnitPuck
from puck_tables.motion.friction_source import Sections
from puck_tables.motion.solve import FINEST_LOCAL, ErrorEstimate, Setting, close_enough, refined
from puck_tables.motion.unit_motion import unseen_tail
from puck_tables.stopping.solvers import Integration

_PROBES = 40  # launches over all φ, besides those next to lines


def integration_of(body: UnitPuck, tol: float, method: Method | None = None) -> Integration:
    """An integration good for every launch of a puck, tried at both sides of singular lines.

    Examples
    --------
    >>> from puck_tables.motion.body import body_of
    >>> integration_of(body_of("ring", 0.5, 1.0), 1e-6).error <= 1e-6
    True
    """
    source, probes = Sections(body), _probes(body)
    selection = source.selected("stop", tol, method)

    def attempt(setting: Setting) -> tuple[Integration, ErrorEstimate]:
        stepping = setting.stepping
        cut, coarse = (
            source.friction(setting.accuracy).coefficients,
            source.coarser(setting.accuracy).coefficients,
        )
        finer = stepping.finer(2.0, 0.01, FINEST_LOCAL)
        result, by_finer, by_coarse = (
            Integration(NO_COLUMNS, *how, selection.method, longest=body.longest)
            for how in ((cut, stepping), (cut, finer), (coarse, stepping))
        )
        answer = result.all(probes)[0][:3]
        steps, friction = (
            2.0 * float(np.abs(answer - other.all(probes)[0][:3]).max())
            for other in (by_finer, by_coarse)
        )
        return result, ErrorEstimate(steps + 2.0 * unseen_tail(stepping), friction / 8.0)

    finer = partial(refined, tol=tol, friction=source.next_accuracy)
    result, error, _ = close_enough(source.first(selection), attempt, finer, tol, "these pucks")
    return replace(result, error=error.total)


def _probes(body: UnitPuck) -> FloatArray:
    """Launches (6, n) with Q = J = r = 1: anywhere, and next to all lines and both ends."""
    lines = np.array([0.0, *body.friction(COARSEST).lines, 0.5 * np.pi])
    near = (lines[:, None] + np.outer([-1.0, 1.0], 10.0 ** -np.arange(1.0, 8.0)).ravel()).ravel()
    phi = np.concatenate([np.linspace(0.01, 1.56, _PROBES), near])
    phi = phi[(phi > 0.0) & (phi < 0.5 * np.pi)]
    one = np.ones(phi.size)
    return np.stack([np.cos(phi), 0.0 * one, np.sin(phi), body.delta * one, one, one])
