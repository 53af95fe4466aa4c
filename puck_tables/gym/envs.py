"""Games as environments of Gymnasium: many tables at once, and one."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium.spaces import Box
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from puck_tables._core.arrays import FloatArray, finite_array, real, shown, whole
from puck_tables.contact.friction_laws import CurlingLaw
from puck_tables.errors import InputError
from puck_tables.gym.air_hockey import AirHockey, AirHockeyAlone
from puck_tables.gym.disc_games import Carrom, Crokinole, TableGame, Tables, Truth, Whole
from puck_tables.gym.push_to_pose import PushToPose
from puck_tables.gym.stone_games import Curling, Shuffleboard
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.world.worlds import Worlds

Obs = npt.NDArray[np.float32]
GAMES: dict[str, type[TableGame]] = {
    kind.__name__: kind
    for kind in (AirHockey, AirHockeyAlone, Carrom, Crokinole, Shuffleboard, Curling, PushToPose)
}
_MODES = ("rgb_array", "human")
RENDERED: dict[str, Any] = {"render_modes": list(_MODES), "render_fps": 60}


class ManyTables(VectorEnv[Obs, Any, Any]):
    """A game on many boards at once, all in one compiled call on all cores.

    A board whose game is over begins anew at the next step, whose action for it counts for nothing
    (``NEXT_STEP``).  ``truncations`` say where the moves of a game were used up before its end, or
    a motion could not be followed.

    Parameters
    ----------
    game : str
        Such as "Carrom", see :mod:`puck_tables.gym`.
    num_envs : int
    spread : 0 to 1, optional
        At :meth:`reset` the friction of all pucks, and each restitution, are multiplied by factors
        drawn from 1 − spread to 1 + spread (no restitution goes beyond 1), for all boards the same:
        ``vectorization_mode="sync"`` gives each board factors of its own, at each of its games.
    noise : m, optional
        The standard deviation of errors of the places that are seen.
    delay : moves, optional
        How old is what is seen.
    render_mode : "rgb_array" or "human", optional
        Pictures of the first board.

    Raises
    ------
    InputError
        If there is no such game, or a number is out of its range.

    Examples
    --------
    >>> tables = ManyTables("Shuffleboard", 3)
    >>> seen, _ = tables.reset(seed=1)
    >>> seen.shape, tables.single_action_space.shape
    ((3, 25), (4,))
    """

    metadata = RENDERED | {"autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self, game: str, num_envs: int = 1, spread: float = 0.0, noise: float = 0.0, delay: int = 0,
        render_mode: str | None = None,
    ) -> None:  # fmt: skip
        if game not in GAMES:
            raise InputError(f"no game {shown(game)}: there are {', '.join(GAMES)}")
        self.game, self.num_envs, self.render_mode = GAMES[game](), num_envs, render_mode
        self._spread, self._noise = real("spread", spread, ""), real("noise", noise, "m")
        if not (0.0 <= self._spread < 1.0 and self._noise >= 0.0):
            raise InputError(f"spread must be from 0 to below 1, and noise not negative, got "
                             f"{spread:g} and {noise:g} m")  # fmt: skip
        if render_mode not in (None, *_MODES):
            raise InputError(f"render_mode must be one of {_MODES}, got {shown(render_mode)}")
        self._delay, one = whole("delay", delay, 0), self.game
        low, high = one.low.astype(np.float32), one.high.astype(np.float32)
        self.single_observation_space = Box(low, high, dtype=np.float32)
        self.single_action_space = Box(-1.0, 1.0, (one.actions,), np.float32)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._scene = one.scene
        self.tables = self._laid_out()
        self._old: list[FloatArray] = []
        self._over = np.zeros(num_envs, bool)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Obs, dict[str, Any]]:
        """Begin anew on all boards; what is seen.

        ``options`` are for none here.
        """
        super().reset(seed=seed)
        if self._spread > 0.0:
            self.game.scene = varied(self._scene, self._spread, self.np_random)
            self.tables = self._laid_out()
        self._begin(np.arange(self.num_envs))
        return self._observed(), {}

    def step(self, actions: npt.ArrayLike) -> tuple[Obs, FloatArray, Truth, Truth, dict[str, Any]]:
        """Make a move on every board: what is seen, earned, where a game ended, or was cut off.

        ``actions``: (num_envs, numbers), from −1 to 1, else InputError.
        """
        if not self._old:
            raise InputError("reset the environment before its first step")
        chosen = self._checked(actions, self.num_envs)
        anew, playing = np.flatnonzero(self._over), np.flatnonzero(~self._over)
        earned, ended = np.zeros(self.num_envs), np.zeros(self.num_envs, bool)
        if playing.size:
            tables, rng = self.tables, self.np_random
            earned[playing], ended[playing] = self.game.move(tables, playing, chosen[playing], rng)
        failed = self.tables.failed.copy()
        earned[failed], ended[failed] = 0.0, False
        truncated = failed | ((self.tables.moves >= self.game.limit) & ~ended)
        if anew.size:
            truncated[anew] = False
            self._begin(anew)
        self._over = ended | truncated
        return self._observed(), earned, ended, truncated, {}

    def outcomes(self, actions: npt.ArrayLike, moves: int = 1, board: int = 0) -> FloatArray:
        """What each of several actions would earn now, array (n,): to look ahead.

        Nothing is changed; the chances of the other side are drawn anew, for all alike.
        ``actions``: (n, numbers), from −1 to 1, else InputError; ``moves``: for so many the same
        action is made, and all of them earn; ``board``: by its number.

        >>> tables = ManyTables("Carrom")
        >>> seen, _ = tables.reset(seed=1)
        >>> tables.outcomes([[0.0, 0.0, 0.5], [0.2, -0.1, 0.9]]).shape
        (2,)
        """
        if not self._old:
            raise InputError("reset the environment before its first step")
        chosen = self._checked(actions, None)
        tables = self.tables.copy(np.full(len(chosen), board))
        earned, playing = np.zeros(len(chosen)), np.arange(len(chosen))
        for _ in range(moves):
            rng = np.random.default_rng(int(tables.moves.sum()))
            won, over = self.game.move(tables, playing, chosen[playing], rng)
            won[tables.failed[playing]] = 0.0
            earned[playing] += won
            playing = playing[~over & ~tables.failed[playing]]
            if not playing.size:
                break
        return earned

    def render(self) -> Any:
        """The :meth:`picture` in a tuple, as vector environments have it."""
        drawn = self.picture()
        return None if drawn is None else (drawn,)

    def picture(self) -> npt.NDArray[np.uint8] | None:
        """Of the first board, array (height, width, 3), or a window, if a mode was asked for."""
        if self.render_mode is None:
            return None
        from puck_tables.plot.still import picture, shown_in_window

        worlds = self.tables.worlds
        drawn = picture(self.game.scene, worlds.state()[0], worlds.in_play[0])
        if self.render_mode == "human":
            shown_in_window(drawn)
            return None
        return drawn

    def _laid_out(self) -> Tables:
        count = self.num_envs
        nothing = np.zeros(count, np.int64), np.zeros(count, bool)
        return Tables(Worlds(self.game.scene, count), *nothing)

    def _begin(self, boards: Whole) -> None:
        self.game.begin(self.tables, boards, self.np_random)
        self._over[boards] = False
        now = self.game.seen(self.tables)
        if not self._old:
            self._old = [now.copy() for _ in range(self._delay + 1)]
        for row in self._old:
            row[boards] = now[boards]

    def _observed(self) -> Obs:
        """What is seen, late and with errors."""
        self._old = [*self._old[1:], self.game.seen(self.tables)]
        seen = self._old[0].copy()
        if self._noise > 0.0:
            count = seen[:, self.game.places].shape
            seen[:, self.game.places] += self._noise * self.np_random.normal(size=count)
        return seen.astype(np.float32)

    def _checked(self, actions: npt.ArrayLike, count: int | None) -> FloatArray:
        checked = finite_array("actions", actions, "1")
        shape = (len(checked) if count is None and checked.ndim else count, self.game.actions)
        if checked.shape != shape:
            raise InputError(f"actions must have the shape {shape}, got {checked.shape}")
        if checked.size and abs(worst := checked.flat[np.abs(checked).argmax()]) > 1.0:
            raise InputError(f"actions must lie from -1 to 1, got {worst:g}")
        return checked


class OneTable(gymnasium.Env[Obs, Any]):
    """A game on one board; parameters as of :class:`ManyTables`, and factors drawn at each game.

    >>> table = OneTable("Crokinole")
    >>> seen, _ = table.reset(seed=1)
    >>> table.step([0.0, 0.1, 0.2])[1] in (0.0, 5.0, 10.0, 15.0, 20.0)
    True
    """

    metadata = RENDERED

    def __init__(self, game: str, render_mode: str | None = None, **how: Any) -> None:
        self.many = ManyTables(game, 1, render_mode=render_mode, **how)
        self.render_mode = render_mode
        self.observation_space = self.many.single_observation_space
        self.action_space = self.many.single_action_space

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Obs, dict[str, Any]]:
        """Begin anew; what is seen."""
        super().reset(seed=seed)
        self.many.np_random = self.np_random
        seen, info = self.many.reset()
        self._rendered()
        return seen[0], info

    def step(self, action: npt.ArrayLike) -> tuple[Obs, float, bool, bool, dict[str, Any]]:
        """Make a move: what is seen, earned, whether the game ended, or was cut off."""
        parts = self.many.step(np.asarray(action)[None])
        self._rendered()
        seen, earned, ended, truncated, info = parts
        return seen[0], float(earned[0]), bool(ended[0]), bool(truncated[0]), info

    def outcomes(self, actions: npt.ArrayLike, moves: int = 1) -> FloatArray:
        """What each of several actions would earn now, as :meth:`ManyTables.outcomes`."""
        return self.many.outcomes(actions, moves)

    def render(self) -> Any:
        """A picture, if a mode was asked for: an array (height, width, 3), or a window."""
        return self.many.picture()

    def _rendered(self) -> None:
        if self.render_mode == "human":
            self.render()


def varied(scene: SceneSpec, spread: float, rng: np.random.Generator) -> SceneSpec:
    """The friction of all pucks, or of the law, times one factor; each restitution times its own.

    Factors are from 1 − spread to 1 + spread; no restitution goes beyond 1.

    >>> from puck_tables import Scene
    >>> other = varied(Scene.load("carrom-break"), 0.1, np.random.default_rng(1))
    >>> round(other.pucks[0].friction, 6), round(other.walls[0].restitution, 6)
    (0.150355, 0.650182)
    """
    factor = rng.uniform(1.0 - spread, 1.0 + spread)
    bounce = {}

    def of(part: Any) -> Any:
        e = part.restitution
        if not isinstance(e, float):
            return part
        if e not in bounce:
            bounce[e] = rng.uniform(1.0 - spread, min(1.0 + spread, 1.0 / e) if e else 1.0)
        return replace(part, restitution=e * bounce[e])

    pucks = [of(replace(puck, friction=factor * puck.friction)) for puck in scene.pucks]
    floor, law = scene.floor, scene.floor.law
    if isinstance(law, CurlingLaw):
        floor = replace(floor, law=replace(law, a=factor * law.a, c=factor * law.c))
    walls, posts, arcs = (tuple(map(of, ones)) for ones in (scene.walls, scene.posts, scene.arcs))
    return replace(scene, pucks=tuple(pucks), floor=floor, walls=walls, posts=posts, arcs=arcs)
