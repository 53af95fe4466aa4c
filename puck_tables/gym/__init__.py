"""Games on boards for agents that learn: environments of Gymnasium and PettingZoo.

They need the extra ``gym``.  Importing this module registers them, each under two ways::

    import gymnasium
    import puck_tables.gym
    env = gymnasium.make("puck_tables/Carrom-v0")
    envs = gymnasium.make_vec("puck_tables/Carrom-v0", num_envs=64)   # all in one compiled call

- ``puck_tables/AirHockeyAlone-v0``: a mallet against a simple player, 60 moves a second;
  ``puck_tables/AirHockey-v0``: both mallets
- ``puck_tables/Carrom-v0``, ``puck_tables/Crokinole-v0``: shots of one player
- ``puck_tables/Shuffleboard-v0``, ``puck_tables/Curling-v0``: a frame, and an end, against another
- ``puck_tables/PushToPose-v0``: a disc is pushed to a place and an angle

:func:`puck_tables.gym.two_players.parallel_env` is air hockey for two, of PettingZoo.
"""

from __future__ import annotations

from puck_tables.errors import MissingExtraError

try:
    from gymnasium import register
except ImportError:
    raise MissingExtraError('environments need Gymnasium: pip install "puck-tables[gym]"') from None

from puck_tables.gym.envs import GAMES, ManyTables, OneTable

for _name in GAMES:
    register(
        f"puck_tables/{_name}-v0",
        entry_point=OneTable,
        vector_entry_point=ManyTables,
        kwargs={"game": _name},
    )
