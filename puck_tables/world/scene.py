"""The scene, and what can be asked of it.

What answers stands below, and is loaded when it is asked: importing the scene stays light.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Self

import numpy.typing as npt

from puck_tables._core.fields import of
from puck_tables._core.waiting import Progress
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.puck import Puck
from puck_tables.scene.library import find_scene
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.agreement import disagreements

if TYPE_CHECKING:
    from puck_tables.bulk.spreads import Spread
    from puck_tables.scene.run import Run
    from puck_tables.world.aimed import BoardAim
    from puck_tables.world.map import Map
    from puck_tables.world.scene_ends import Sample
    from puck_tables.world.world import World


@dataclass(frozen=True, eq=False, repr=False)
class Scene(SceneSpec):
    """A puck on a floor, its launch, and whatever acts on it: checked when it is made.

    Parts may also be tables.  Numbers may be numpy scalars; where a number stands a list, an array
    or a text 'START:STOP:COUNT' is a range, a dimension of :meth:`sweep`.  Such a number stands at
    its first value (its last, where no puck can have the first), its values in ``ranges``.  Many
    launches at once are velocities (n, 2), see :class:`puck_tables.Launch`: their range is
    ``launch``, rows of vx, vy, spin, x, y, orientation.

    Parameters
    ----------
    puck : Puck
    floor, launch, drag, lateral, force, title : optional
        As :mod:`puck_tables.scene.parts` has them.
    walls, edges : sequences of Wall, of Edge, optional
    pucks, posts, arcs, pockets, lines, rims : sequences, optional
        As :mod:`puck_tables.scene.pucks_and_posts` has them.
    constraint : Constraint, optional
    time : s, > 0, optional
        How long; left out, until rest.
    frames, tol : optional
        How many states to save; the error wanted, of Q/a and Q²/a as :class:`Run` has them.
    gravity : m/s², > 0, optional
        Of all its pucks.  Left out, it is what the pucks have: one, where there are several.
    ranges : mapping, optional
        Values of numbers that take several, by path, such as ``{"puck.height": [0.0, 0.01]}``.  A
        changed copy (:func:`dataclasses.replace`) keeps those of the parts that it keeps.

    Raises
    ------
    InputError
        If anything is wrong: every error with its path, its value and what is allowed.

    Examples
    --------
    >>> from puck_tables import Floor, Launch
    >>> puck = Puck(radius=0.04, friction=0.1)
    >>> scene = Scene(puck, Floor(slope=0.05), Launch((1.0, 0.0), spin=20.0))
    >>> round(scene.simulate().end_time, 6)
    2.329592
    >>> Scene(puck, launch=Launch(spin=[0.0, 5.0])).ranges["launch.spin"].tolist()
    [0.0, 5.0]
    """

    puck: Puck = of("part", None, part=PuckSpec, made=Puck)
    pucks: tuple[Puck, ...] = of("parts", (), part=Puck, table="puck[]")

    def _disagreements(self) -> list[str]:
        """What is wrong between its parts."""
        return disagreements(self)

    @classmethod
    def load(cls, name: str | Path) -> Self:
        """A scene from a TOML file, or one that is shipped, by its name.

        Raises
        ------
        InputError
            If there is neither, or anything in it is wrong.

        Examples
        --------
        >>> Scene.load("incline").title
        'Puck on an incline'
        """
        return cls.from_tables(find_scene(str(name)), str(name))

    def simulate(self, times: npt.ArrayLike | None = None) -> Run:
        """Run it, from the launch to the end.

        Parameters
        ----------
        times : array_like, s, ≥ 0, ascending, optional
            When to save states; else ``frames`` of them from the launch to the end.

        Returns
        -------
        Run
            States beyond the end of the run are left out, except at rest.

        Raises
        ------
        InputError
            If a number of it is a range, or it has not ended after a hundred times its time scale
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
        from puck_tables.world.simulate import simulate

        return simulate(self, times)

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
        from puck_tables.bulk.finish import Doing
        from puck_tables.world.runs import sweep

        return sweep(self, Doing(threads, chunk, progress, store, cluster, overwrite))

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
        >>> from puck_tables import Launch, Puck
        >>> cue = Puck(0.03, friction=0.1, name="cue", launch=Launch((1.0, 0.0)))
        >>> red = Puck(0.03, friction=0.1, name="red", launch=Launch(position=(0.3, 0.0)))
        >>> spreads = {"puck[0].launch.velocity[1]": Normal(0.0, 0.01)}
        >>> found = Scene(pucks=[cue, red]).sample(100, 7, spreads)
        >>> round(found.of("red").mean()["x"], 3)
        0.569
        """
        from puck_tables.bulk.finish import Doing
        from puck_tables.world.runs import sample

        how = Doing(threads, chunk, progress, store, cluster, overwrite)
        return sample(self, count, seed, spreads, how)

    def world(self) -> World:
        """The scene as a board to play on: advance it, strike pucks, look ahead.

        Raises
        ------
        InputError
            If a number of it is a range.

        Examples
        --------
        >>> from puck_tables import Puck, Scene
        >>> Scene(pucks=[Puck(0.03, friction=0.1)]).world()
        World(1 pucks, 0 moving, at 0 s)
        """
        from puck_tables.world.world import World

        return World(self)

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
        >>> from puck_tables import Launch, Puck, Scene
        >>> cue = Puck(0.03, friction=0.1, name="cue")
        >>> red = Puck(0.03, friction=0.1, name="red", launch=Launch(position=(0.3, 0.0)))
        >>> found = Scene(pucks=[cue, red]).aim((0.8, 0.1), striker="cue")
        >>> found.sequences, found.launch_speed.round(6).tolist()
        (('cue - red',), [1.23967])
        """
        from puck_tables.world.aim import aim

        return aim(
            self, target, puck=puck, striker=striker, pocket=pocket, hits=hits, spin=spin,
            speed=speed, max_speed=max_speed, max_spin=max_spin, max_impacts=max_impacts,
            count=count, progress=progress,
        )  # fmt: skip
