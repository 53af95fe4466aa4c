"""Air hockey for two agents, as PettingZoo has it."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.spaces import Box
from pettingzoo import ParallelEnv

from puck_tables.gym.envs import RENDERED, ManyTables, Obs

PLAYERS = ("left", "right")


class TwoPlayers(ParallelEnv[str, Obs, Any]):
    """Air hockey: an action of each is vx, vy of its mallet, from −1 to 1, of 4 m/s.

    Each sees the table from its end, as :class:`puck_tables.gym.air_hockey.AirHockey` tells; a goal
    earns one 1, the other −1, and ends the game.  Parameters as of
    :class:`puck_tables.gym.envs.ManyTables`.

    >>> table = TwoPlayers()
    >>> seen, _ = table.reset(seed=1)
    >>> _, earned, ended, *_ = table.step({"left": [0.5, 0.0], "right": [0.0, 0.0]})
    >>> earned, ended
    ({'left': 0.0, 'right': 0.0}, {'left': False, 'right': False})
    """

    metadata = RENDERED | {"name": "air_hockey_v0"}

    def __init__(self, render_mode: str | None = None, **how: Any) -> None:
        self.render_mode = render_mode
        self._many = ManyTables("AirHockey", 1, render_mode=render_mode, **how)
        self.possible_agents = list(PLAYERS)
        self.agents: list[str] = []
        low, high = (np.split(side.astype(np.float32), 2)[0] for side in
                     (self._many.game.low, self._many.game.high))  # fmt: skip
        self._space: Box[Any] = Box(low, high, dtype=np.float32)
        self._actions: Box[Any] = Box(-1.0, 1.0, (2,), np.float32)

    def observation_space(self, agent: str) -> Box[Any]:
        """Of an agent: 13 numbers."""
        return self._space

    def action_space(self, agent: str) -> Box[Any]:
        """Of an agent: 2 numbers."""
        return self._actions

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Obs], dict[str, dict[str, Any]]]:
        """Serve; what each sees."""
        self.agents = list(PLAYERS)
        seen, _ = self._many.reset(seed=seed)
        return self._split(seen), {one: {} for one in PLAYERS}

    def step(self, actions: dict[str, Any]) -> tuple[dict[str, Any], ...]:
        """A frame: what each sees and earns, whether the game ended, or was cut off."""
        both = np.concatenate([actions[one] for one in PLAYERS])
        seen, earned, ended, truncated, _ = self._many.step(both[None])
        if ended[0] or truncated[0]:
            self.agents = []
        won = float(earned[0])
        return (
            self._split(seen), dict(zip(PLAYERS, (won, 0.0 - won), strict=True)),
            dict.fromkeys(PLAYERS, bool(ended[0])), dict.fromkeys(PLAYERS, bool(truncated[0])),
            {one: {} for one in PLAYERS},
        )  # fmt: skip

    def render(self) -> Any:
        """A picture, if a mode was asked for."""
        return self._many.picture()

    def _split(self, seen: Obs) -> dict[str, Obs]:
        return dict(zip(PLAYERS, np.split(seen[0], 2), strict=True))


parallel_env = TwoPlayers
