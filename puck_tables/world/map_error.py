"""How far the runs of a map may be off: some of them beside runs that have an error estimate."""

from __future__ import annotations

import math

import numpy as np

from puck_tables.errors import PuckError
from puck_tables.scene.outcome import LAST_END
from puck_tables.world.scene_ends import SceneEnds
from puck_tables.world.simulate import simulate

CHECKED = 8  # runs


def largest_error(ends: SceneEnds) -> float:
    """The largest error found in the ends of a scene, times in units of Q/a, places in Q²/a.

    Of :data:`CHECKED` runs that have an end, spread evenly: how far a run alone is from it, and the
    error estimate of that.  NaN where none has an end.

    Examples
    --------
    >>> from puck_tables import Launch, Puck, Scene
    >>> scene = Scene(Puck(0.04, friction=0.2), launch=Launch((1.0, 0.0), spin=[0.0, 5.0]))
    >>> largest_error(scene.sweep()) <= scene.tol
    True
    """
    valid = np.flatnonzero(ends.end.ravel() <= LAST_END)
    worst = math.nan
    places = np.linspace(0, max(len(valid) - 1, 0), min(CHECKED, len(valid))).astype(int)
    for number in valid[places].tolist():
        one = ends.scene.at(ends.numbers(number))
        try:
            run = simulate(one, [])
        except PuckError:  # its own end is in doubt
            return math.inf
        place = np.unravel_index(number, ends.end.shape)
        alone = run.last_of(ends.whose) if ends.whose else run.last
        x, y = (ends.columns[name][place] - alone[name] for name in ("x", "y"))
        far = float(np.max(np.hypot(x, y)))  # of the puck that is off most
        late = abs(run.end_time - float(ends.columns["end_time"][place]))
        unit = run.speed_scale / max(run.rate_scale, 1e-300)
        error = max(_share(late, unit), _share(far, run.speed_scale * unit))
        worst = max(error + run.error_estimate, worst if worst == worst else 0.0)
    return worst


def _share(error: float, scale: float) -> float:
    """An error in units of a scale; where nothing moves both are 0."""
    return error / scale if scale > 0.0 else (math.inf if error > 0.0 else 0.0)
