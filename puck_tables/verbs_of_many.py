"""What can be asked of very many launches of a puck: maps over ranges, and samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy.typing as npt

from puck_tables._core.waiting import Progress
from puck_tables.errors import InputError
from puck_tables.wrench.verbs_of_friction import VerbsOfFriction

if TYPE_CHECKING:
    import xarray

    from puck_tables.contact.laws import Law
    from puck_tables.stopping.population import StopMap, StopSample
    from puck_tables.table.table import Table


@dataclass(frozen=True, repr=False)
class VerbsOfMany(VerbsOfFriction):
    """A puck, and the questions about many launches of it; :class:`puck_tables.Puck` has all."""

    def sweep(
        self,
        spin: npt.ArrayLike | None = None,
        speed: npt.ArrayLike | None = None,
        *,
        velocity: npt.ArrayLike | None = None,
        heading: npt.ArrayLike | None = None,
        radius: npt.ArrayLike | None = None,
        height: npt.ArrayLike | None = None,
        friction: npt.ArrayLike | None = None,
        gravity: npt.ArrayLike | None = None,
        delta: npt.ArrayLike | None = None,
        decel: npt.ArrayLike | None = None,
        gyration: npt.ArrayLike | None = None,
        pressure: str | Law | Sequence[str | Law] | None = None,
        launches: xarray.Dataset | None = None,
        tol: float = 1e-8,
        method: str | None = None,
        table: Table | None = None,
        threads: int | None = None,
        chunk: int = 8192,
        progress: Progress | None = None,
        store: str | Path | None = None,
        cluster: str | None = None,
        overwrite: bool = False,
    ) -> StopMap:
        """Stops of all combinations of numbers of the launch and of the puck.

        Parameters
        ----------
        spin, speed, heading : number or array (n,), rad/s, m/s ≥ 0, rad from x
            Without ``spin``, ``speed`` and ``velocity``: a map of 41 speeds by 41 spins.  On a base
            that is not round headings are from the x axis of the body at the launch.
        velocity : (vx, vy), m/s, instead of ``speed`` and ``heading``
        radius, height, friction, gravity, gyration : number or array (n,), optional
            Instead of that of the puck, whose other numbers stay; units as :class:`Puck` has them.
        delta, decel : number or array (n,), optional
            δ = 2fh/r in place of the height, fg (m/s²) in place of the gravity.  On a base that
            is not round there is no δ and no radius, and the gyration is that of the puck.
        pressure : pressure law, or a list of at most 100, optional
        launches : xarray.Dataset, optional
            Its coordinates and variables ``launch_speed``, ``launch_spin``, ``launch_vx``,
            ``radius``, … over its dimensions, instead of arrays.
        tol : float
            Largest error in units of Q/(fg) (time) and Q²/(fg) (place).
        method, table : optional
            As for :func:`puck_tables.stop`.
        threads, chunk : int
            How the work is cut; the numbers do not depend on it, to the last bit.
        progress : callable (done, total), optional
        store : path of a Zarr store, .zarr, optional
            Where results go as they are made, block by block, for maps larger than memory and work
            that is to go on after any end: called again with the same arguments, it does.
        cluster : 'local:N' or 'tcp://HOST:PORT', optional
            N processes of this machine, or a Dask cluster that runs, do it; with ``store``.
        overwrite : whether a store of other work may be replaced

        Returns
        -------
        StopMap
            One dimension for each argument that is an array.  With ``store`` a ``Stored``, whose
            ``.load()`` is the map, ``.to_xarray()`` a lazy dataset.

        Raises
        ------
        InputError
            If an argument is not finite or outside its range, two give the same, more than 500
            different pucks need preparation, the map would not fit in memory, or ``store`` holds
            other work.
        AccuracyError
            If the tolerance is out of reach.
        MissingExtraError, ClusterError, OutputError
            If zarr or dask is not installed, no scheduler answers, or the disk is full.

        Examples
        --------
        >>> from puck_tables import Puck
        >>> stops = Puck.similar(delta=0.0).sweep([0.0, 1.0, 2.0], velocity=(1.0, 0.0))
        >>> stops.stop_x.round(4).tolist()
        [0.5, 0.6374, 0.9835]
        >>> Puck(0.04, friction=0.1).sweep(0.0, 1.0, friction=[0.1, 0.2]).stop_x.round(4).tolist()
        [0.5099, 0.2549]
        """
        from puck_tables.bulk.finish import Doing
        from puck_tables.stopping.stop_sweep import sweep

        axes = {
            "spin": spin, "speed": speed, "velocity": velocity, "heading": heading,
            "radius": radius, "height": height, "friction": friction, "gravity": gravity,
            "delta": delta, "decel": decel, "gyration": gyration, "pressure": pressure,
        }  # fmt: skip
        by, how = (tol, method, table), Doing(threads, chunk, progress, store, cluster, overwrite)
        return cast("StopMap", sweep(self, axes, launches, by, how))

    def sample(
        self,
        count: int,
        seed: int = 0,
        *,
        tol: float = 1e-8,
        method: str | None = None,
        table: Table | None = None,
        threads: int | None = None,
        chunk: int = 8192,
        progress: Progress | None = None,
        store: str | Path | None = None,
        cluster: str | None = None,
        overwrite: bool = False,
        **numbers: Any,
    ) -> StopSample:
        """Stops of launches that scatter.

        Parameters
        ----------
        count, seed : how many are drawn, 2 to 1e9, and from which seed, 0 to 2⁶⁴ − 1
            The same seed gives the same bits, whatever the chunks, threads or machines.
        numbers : spreads such as ``spin=Normal(5.0, 0.2)``, ``speed=Uniform(0.9, 1.1)``, or one
            number, of ``spin``, ``speed``, ``heading``, ``vx``, ``vy``, ``velocity`` (fixed),
            ``radius``, ``height``, ``friction``, ``gravity``, ``delta``, ``decel``, ``gyration``;
            ``pressure`` is a law.  They scatter independently of each other.
        tol, method, table, threads, chunk, progress, store, cluster, overwrite
            As for :meth:`sweep`.

        Returns
        -------
        StopSample
            A :class:`StopMap` over the samples with ``mean()``, ``covariance()``, ``quantiles()``,
            ``density()`` and ``chance(region)``.

        Raises
        ------
        InputError
            If nothing scatters, or a number that is drawn lies outside its range; and as
            :meth:`sweep`.

        Examples
        --------
        >>> from puck_tables import Normal, Puck
        >>> found = Puck.similar().sample(10_000, 7, spin=Normal(5.0, 0.2), speed=1.0)
        >>> round(found.mean()["stop_time"], 3), found.chance((2.2, -0.16, 0.1)).value > 0.5
        (3.961, True)
        """
        from puck_tables.bulk.finish import Doing
        from puck_tables.stopping.population import COLUMN
        from puck_tables.stopping.stop_sweep import sample

        known = {*COLUMN, "velocity"}
        unknown = [name for name in numbers if name not in known]
        if unknown:
            raise InputError(f"{unknown[0]} is no number of a launch: give {', '.join(known)}")
        by, how = (tol, method, table), Doing(threads, chunk, progress, store, cluster, overwrite)
        return cast("StopSample", sample(self, count, seed, numbers, by, how))
