"""All that can be asked of a scene.

What answers stands above the scene, and is loaded when it is asked.
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy.typing as npt

from puck_tables._core.executor import Progress

if TYPE_CHECKING:
    from puck_tables.bulk.spreads import Spread
    from puck_tables.scene.outcome import SceneRun
    from puck_tables.sweeps.map import Map
    from puck_tables.sweeps.sample import Sample
    from puck_tables.world.aimed import BoardAim
    from puck_tables.world.world import World


class SceneVerbs:
    """Questions to a :class:`puck_tables.Scene`, which has these verbs."""

    def simulate(self, times: npt.ArrayLike | None = None) -> SceneRun:
        """Run it, from the launch to the end.

        Parameters
        ----------
        times : array_like, s, ≥ 0, ascending, optional
            When to save states; else ``frames`` of them from the launch to the end.

        Returns
        -------
        SceneRun
            States beyond the end of the run are left out, except at rest.

        Raises
        ------
        InputError
            If a number of it is a range, or it has not ended after a thousand times its time scale
            and gives no ``time``.
        PuckError
            If the motion leaves floating point, or too many events crowd together.

        Notes
        -----
        Dry friction by the resultants of Salnikova, Treschev, Gallyamov 2012 at velocities relative
        to the floor; constraints and energies after Chetaev 1960, eq. 2.3, 2.4 and 4.1.

        Examples
        --------
        >>> from puck_tables import Scene
        >>> run = Scene.load("incline").simulate()
        >>> run.end, round(run.end_time, 6)
        ('at rest', 2.253703)
        """
        run: SceneRun = _answers(self, "simulate").simulate(self, times)
        return run

    def sweep(
        self,
        *,
        threads: int | None = None,
        chunk: int = 256,
        progress: Progress | None = None,
        store: str | Path | None = None,
        cluster: str | None = None,
        overwrite: bool = False,
    ) -> Map:
        """Run it for all combinations of the numbers in it that are ranges.

        Parameters
        ----------
        threads, chunk : int
            How the work is cut; the numbers do not depend on it, to the last bit.
        progress : callable (done, total), optional
        store, cluster, overwrite
            As for :meth:`puck_tables.Puck.sweep`: a Zarr store, and machines that write to it.

        Returns
        -------
        Map
            A run that has no end, or that is refused, is named in :meth:`Map.without_end`.  Of a
            list of ``pucks`` its columns have a last dimension over them.

        Raises
        ------
        InputError
            If no run of it has an end, nothing ranges, or the map would not fit in memory.

        Examples
        --------
        >>> from puck_tables import Launch, Puck, Scene
        >>> puck, velocities = Puck(0.04, friction=0.1), [[1.0, 0.0], [0.0, 2.0]]
        >>> Scene(puck, launch=Launch(velocities, spin=[0.0, 9.0])).sweep().y.round(6).tolist()
        [0.0, 2.056068]
        """
        ends: Map = import_module("puck_tables.sweeps.runs").sweep(
            self, threads=threads, chunk=chunk, progress=progress, store=store, cluster=cluster,
            overwrite=overwrite,
        )  # fmt: skip
        return ends

    def sample(
        self,
        count: int,
        seed: int,
        spreads: Mapping[str, Spread],
        *,
        threads: int | None = None,
        chunk: int = 256,
        progress: Progress | None = None,
        store: str | Path | None = None,
        cluster: str | None = None,
        overwrite: bool = False,
    ) -> Sample:
        """Run it with numbers that scatter.

        Parameters
        ----------
        count, seed : how many are drawn, 2 to 1e9, and from which seed
        spreads : :class:`puck_tables.Normal` or ``Uniform`` by path, such as 'launch.spin'
        threads, chunk, progress, store, cluster, overwrite
            As for :meth:`sweep`.

        Returns
        -------
        Sample
            With the summaries of :meth:`puck_tables.Puck.sample`; of a list of ``pucks`` those of
            each, ``sample.of("red").mean()``, and how often it leaves play.

        Raises
        ------
        InputError
            If nothing scatters, or what does is no number of the scene.

        Examples
        --------
        >>> from puck_tables import Normal, Puck, Scene
        >>> scene = Scene(Puck(0.04, friction=0.1))
        >>> found = scene.sample(1000, 7, {"launch.velocity[0]": Normal(1.0, 0.01)})
        >>> round(found.mean()["x"], 3)
        0.51
        >>> from puck_tables import Launch, Piece
        >>> cue = Piece(0.03, friction=0.1, name="cue", launch=Launch((1.0, 0.0)))
        >>> red = Piece(0.03, friction=0.1, name="red", launch=Launch(position=(0.3, 0.0)))
        >>> spreads = {"puck[0].launch.velocity[1]": Normal(0.0, 0.01)}
        >>> found = Scene(pucks=[cue, red]).sample(100, 7, spreads)
        >>> round(found.of("red").mean()["x"], 3)
        0.569
        """
        found: Sample = import_module("puck_tables.sweeps.runs").sample(
            self, count, seed, spreads, threads=threads, chunk=chunk, progress=progress,
            store=store, cluster=cluster, overwrite=overwrite,
        )  # fmt: skip
        return found

    def world(self) -> World:
        """The same board to play on: advance it, strike pucks, look ahead.

        Raises
        ------
        InputError
            If a number of it is a range.

        Examples
        --------
        >>> from puck_tables import Piece, Scene
        >>> Scene(pucks=[Piece(0.03, friction=0.1)]).world()
        World(1 pucks, 0 moving, at 0 s)
        """
        world: World = import_module("puck_tables.world.world").World(self)
        return world

    def aim(
        self,
        target: npt.ArrayLike | None = None,
        *,
        puck: int | str | None = None,
        striker: int | str | None = None,
        pocket: int | str | None = None,
        hits: int | str | None = None,
        spin: npt.ArrayLike | None = None,
        speed: float | None = None,
        max_speed: float | None = None,
        max_spin: float | None = None,
        max_impacts: int = 3,
        count: int = 16,
        progress: Progress | None = None,
    ) -> BoardAim:
        """Launches of one puck after which another, or it itself, rests at a place or is pocketed.

        Parameters
        ----------
        target : (x, y), m, on the board; or ``pocket``, its number
        puck : which is to end there, by name or number
            Left out: the one besides the striker, or the only one.
        striker : which is sent off; left out: the one that the scene sends off
        hits : a puck that must be hit on the way, optional
        spin : of the launch, rad/s, one or several; left out: that of the scene
        speed : of the launch, m/s, instead: heading and spin are looked for
        max_speed, max_spin : bounds on speed (m/s) and on |spin| (rad/s)
            Left out: three times the speed that slides the whole way; rim speeds of twice that.
        max_impacts : with at most so many impacts that lead the puck there
        count : how many launches are given, the least sensitive first
        progress : callable (done, total), optional

        Returns
        -------
        BoardAim
            With no launch, and the reason in ``answer``, where none was found: this is a search,
            and no proof that there is none.  Each launch is run on the whole board, which gives
            its ``miss``.

        Raises
        ------
        InputError
            If it is not clear what is sent, or where to; the puck cannot rest there; a number is
            out of its range.

        Notes
        -----
        Runs with the same impacts are a smooth map from heading and speed to the end of the puck;
        Newton's method solves each for the target, from a sample that is dense where they change.

        Examples
        --------
        >>> from puck_tables import Launch, Piece, Scene
        >>> cue = Piece(0.03, friction=0.1, name="cue")
        >>> red = Piece(0.03, friction=0.1, name="red", launch=Launch(position=(0.3, 0.0)))
        >>> found = Scene(pucks=[cue, red]).aim((0.8, 0.1), striker="cue")
        >>> found.courses, found.launch_speed.round(6).tolist()
        (('cue - red',), [1.23967])
        """
        found: BoardAim = import_module("puck_tables.world.aim").aim(
            self, target, puck=puck, striker=striker, pocket=pocket, hits=hits, spin=spin,
            speed=speed, max_speed=max_speed, max_spin=max_spin, max_impacts=max_impacts,
            count=count, progress=progress,
        )  # fmt: skip
        return found


def _answers(scene: Any, question: str) -> Any:
    """The module that answers: of boards another one than of one puck."""
    return import_module(f"puck_tables.{'world' if scene.is_board else 'scene'}.{question}")
