"""Maps over a scene: how and where it ends, for all combinations of the numbers that range."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError, PuckError
from puck_tables.io.columns import Dataset, Variable
from puck_tables.scene.entries import is_batch, launch_paths
from puck_tables.scene.library import files_of, plain_name
from puck_tables.scene.run import LAST_END
from puck_tables.world.scene_ends import SceneEnds, axes_of, number_along, numbers_of
from puck_tables.world.simulate import simulate

CHECKED = 8  # runs


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Map(SceneEnds):
    """Ends of a scene over its ranges.

    ``scene``: with its ranges; ``names``: of its pucks, none where it has one ``puck``;
    ``columns``: arrays of the shape of ``axes`` by name, of several pucks with the pucks last
    (``x``, ``in_play``, …), units as everywhere, NaN for a run without an end, each also an
    attribute; ``map["red"]``: those of one puck, ``map.of("red")`` the map of it.  ``end``: how
    each run ends, an index of ``meanings``; ``model``: what was taken for the first run that is
    valid; ``files``: what stands in the files that the scene names, by path.
    """

    @property
    def picture(self) -> str:  # type: ignore[override]
        """The module that draws it."""
        return "board_ends" if self.names else "scene_map"

    @property
    def axes(self) -> dict[str, FloatArray]:
        """What ranges, by path; many launches by their numbers from 0 on."""
        return axes_of(self.scene)

    @property
    def ranging(self) -> tuple[str, ...]:
        """The numbers of the scene that differ between its runs, by path."""
        return tuple(self.scene.ranges)

    def __repr__(self) -> str:
        ranged = " x ".join(f"{path} ({values.size})" for path, values in self.axes.items())
        return f"Map({self.title} over {ranged}, {self.model})"

    def numbers(self, run: int) -> dict[str, float]:
        """The numbers of the scene in a run, counted from 0 with the last range fastest, by path.

        >>> from puck_tables import Launch, Puck, Scene
        >>> ranges = {"puck.friction": [0.1, 0.2], "launch.spin": [0.0, 3.0]}
        >>> scene = Scene(Puck(0.04), launch=Launch((1.0, 0.0)), ranges=ranges)
        >>> scene.sweep().numbers(2)
        {'puck.friction': 0.2, 'launch.spin': 0.0}
        """
        ranged = numbers_of(self.scene.ranges, np.array([run]))
        return {path: float(values[0]) for path, values in ranged.items()}

    @cached_property
    def error_estimate(self) -> float:
        """The largest error of a few runs, each done again alone and estimated, of Q/a and Q²/a.

        Of several pucks it grows with every impact, see :class:`puck_tables.scene.run.Run`.

        Raises
        ------
        InputError
            If a file that the scene names has changed since the sweep.
        """
        if files_of(self.scene) != self.files:
            raise InputError("a file that the scene names has changed since: sweep it again")
        return largest_error(self)

    def along(self) -> tuple[tuple[str, ...], dict[str, Variable], dict[str, Variable]]:
        """Dimensions, axes, and the numbers of many launches."""
        dims = tuple(plain_name(path) for path in self.axes)
        axes, columns = {}, {}
        for path, values in self.axes.items():
            axis = plain_name(path)
            axes[axis] = number_along(self.scene, path, values, axis)
            if is_batch(path):
                for one, row in zip(launch_paths(path), self.scene.ranges[path].T, strict=True):
                    if one not in self.axes:
                        columns[plain_name(one)] = number_along(self.scene, one, row, axis)
        return dims, axes, columns

    def dataset(self) -> Dataset:
        """The results over what ranges; the scene and its files as texts."""
        result = super().dataset()
        more = {"model": self.model, "error_estimate": self.error_estimate}
        return replace(result, attributes={**result.attributes, **more})


def largest_error(ends: SceneEnds) -> float:
    """The largest error found in the ends of a scene, times in units of Q/a, places in Q²/a.

    Of :data:`CHECKED` runs that have an end, spread evenly: how far a run alone is from it, and the
    error estimate of that.  NaN where none has an end.

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
