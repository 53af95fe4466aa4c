"""Games for agents: the checks of Gymnasium and PettingZoo, rules, and known answers."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from rarely import thorough

import puck_tables as pt

gymnasium = pytest.importorskip("gymnasium")
pytest.importorskip("pettingzoo")

from gymnasium.utils.env_checker import check_env  # noqa: E402
from pettingzoo.test import parallel_api_test, parallel_seed_test  # noqa: E402

from puck_tables.gym.air_hockey import guard  # noqa: E402
from puck_tables.gym.envs import GAMES, ManyTables, OneTable, varied  # noqa: E402
from puck_tables.gym.two_players import parallel_env  # noqa: E402

SLOW = ("Curling", "PushToPose")  # a stone by the law of ice, a finger that pushes
QUICK = [name for name in GAMES if name not in SLOW]


@pytest.mark.parametrize("name", [*QUICK, *map(thorough, SLOW)])
@pytest.mark.filterwarnings("error")
def test_each_game_passes_the_check_of_gymnasium(name: str):
    env = gymnasium.make(f"puck_tables/{name}-v0", render_mode="rgb_array")
    check_env(env.unwrapped)
    env.close()


def test_two_players_pass_the_checks_of_pettingzoo():
    parallel_api_test(parallel_env(), num_cycles=30)
    parallel_seed_test(lambda: parallel_env(noise=1e-3, delay=2), num_cycles=30)


@pytest.mark.parametrize("name", QUICK)
def test_one_board_is_the_first_of_many(name: str):
    """The same moves, whatever other boards do; where the other side draws, of one seed."""
    one, many = OneTable(name), ManyTables(name, 3)
    one.reset(seed=5)
    many.reset(seed=5)
    if name != "Carrom":  # their starts are drawn
        for tables in (one.many.tables, many.tables):
            states = many.tables.worlds.state()[0]
            tables.worlds.set_state(states, boards=[0])
    rng, rewards = np.random.default_rng(2), []
    for _ in range(3):
        actions = rng.uniform(-1.0, 1.0, (3, many.game.actions))
        alike = np.repeat(actions[:1], 3, axis=0) if name == "Shuffleboard" else actions
        seen, earned, *_ = one.step(alike[0])
        all_seen, all_earned, *_ = many.step(alike)
        rewards.append(all_earned)
        if name != "Shuffleboard":  # there the other side draws more for more boards
            assert np.array_equal(seen, all_seen[0]) and earned == all_earned[0]
    assert np.isfinite(rewards).all()


def test_a_board_that_is_over_begins_anew_at_the_next_step():
    envs = gymnasium.make_vec("puck_tables/Shuffleboard-v0", num_envs=2)
    envs.reset(seed=1)
    still = np.zeros((2, 4), np.float32)
    for move in range(4):
        seen, earned, ended, cut, _ = envs.step(still)
        assert ended.tolist() == [move == 3] * 2 and not cut.any()
        assert seen[0, -1] == pytest.approx(0.25 * (move + 1))
    seen, earned, ended, cut, _ = envs.step(still)
    assert earned.tolist() == [0.0, 0.0] and not (ended | cut).any()
    assert not seen.any()  # nothing is sent yet
    assert envs.step(still)[0][0, -1] == 0.25


def test_a_frame_is_counted_as_its_rules_say():
    """One's own beyond all others: 3 in the last 6 in, 2 before; by hand."""
    table = ManyTables("Shuffleboard", 1)
    table.reset(seed=1)
    worlds, away = table.tables.worlds, np.array([[6.25, 0.0], [6.05, 0.1], [5.9, -0.1]])
    worlds.place(0, away[0])
    worlds.place(1, away[1])
    worlds.place(4, away[2])
    table.tables.moves[:] = 4
    assert table.game.score(table.tables).tolist() == [5.0]
    worlds.place(4, (6.15, 0.2))  # now the other side is between
    assert table.game.score(table.tables).tolist() == [3.0]
    worlds.place(4, (6.26, 0.2))
    assert table.game.score(table.tables).tolist() == [-3.0]


def test_what_hangs_is_left_out_of_games():
    """The same frames on the shipped scene, which follows it: who falls, and all but 1 mm."""
    ends = []
    for edges in ((), pt.Scene.load("shuffleboard-two-stones").edges):
        tables, rng = ManyTables("Shuffleboard", 12), np.random.default_rng(5)
        if edges:
            tables.game.scene = replace(tables.game.scene, edges=edges)
            tables.tables = tables._laid_out()
        tables.reset(seed=3)
        for _ in range(4):
            tables.step(rng.uniform(-1.0, 1.0, (12, 4)))
        there = tables.tables.worlds.in_play
        ends.append((there, np.where(there[..., None], tables.tables.worlds.state()[..., :2], 0.0)))
    (there, places), (truly, exact) = ends
    assert (there == truly).all() and not there.all()
    assert 0.0 < np.abs(places - exact).max() < 1e-3


def test_men_in_pockets_and_discs_in_the_hole_are_counted():
    carrom = ManyTables("Carrom", 1)
    carrom.reset()
    worlds = carrom.tables.worlds
    worlds.place("white 1", (-0.25, 0.3), velocity=(-0.6, 0.2875))  # by hand into a pocket
    worlds.place("black 1", (0.25, 0.3), velocity=(0.6, 0.2875))
    worlds.place("queen", (0.25, -0.2), velocity=(0.6, -0.9125))
    worlds.advance(np.inf)
    assert worlds.in_play[0].sum() == 17
    assert carrom.game.score(carrom.tables).tolist() == [3.0]
    crokinole = ManyTables("Crokinole", 1)
    crokinole.reset(seed=3)
    board = crokinole.tables
    assert crokinole.game.score(board).tolist() == [-30.0]  # 15, 10 and 5 of the other side
    for k in range(8, 11):
        board.worlds.remove(k)
    board.worlds.place(0, (0.0, -0.06), velocity=(0.0, 0.5))
    board.worlds.place(1, (0.0, -0.16))
    board.worlds.advance(np.inf)
    board.moves[:] = 2
    assert crokinole.game.score(board).tolist() == [30.0]  # 20 in the hole, and 10


def test_a_goal_ends_the_game_and_is_of_who_shot_it():
    for side, earned in ((1.0, 1.0), (-1.0, -1.0)):
        table = OneTable("AirHockey")
        table.reset(seed=1)
        worlds = table.many.tables.worlds
        worlds.place("left", (0.3, 0.9))
        worlds.place("right", (1.9, 0.9))
        worlds.place("puck", (1.1 + 0.9 * side, 0.55), velocity=(3.0 * side, 0.0))
        found = [table.step(np.zeros(4)) for _ in range(8)]
        assert sum(one[1] for one in found) == earned
        assert [one[2] for one in found].index(True) < 7


def test_both_players_see_the_same_from_their_ends():
    table = parallel_env()
    table.reset(seed=4)
    turned = {"left": [0.3, 0.5], "right": [0.3, 0.5]}
    table._many.tables.worlds.place("puck", (1.1, 0.55), velocity=(0.0, 0.0), spin=0.0)
    for _ in range(20):
        seen, *_ = table.step(turned)
        assert np.allclose(seen["left"], seen["right"], atol=1e-6)


def test_a_look_ahead_changes_nothing_and_tells_what_comes():
    table = OneTable("Crokinole")
    table.reset(seed=2)
    before = table.many.tables.worlds.state()
    tries = np.random.default_rng(1).uniform(-1.0, 1.0, (64, 3))
    told = table.outcomes(tries)
    assert np.array_equal(table.many.tables.worlds.state(), before)
    assert told.max() > told.min()
    best = int(told.argmax())
    assert table.step(tries[best])[1] == told[best]


def test_a_player_who_looks_ahead_beats_chance():
    rng, earned = np.random.default_rng(3), {1: 0.0, 128: 0.0}
    for tries in earned:
        table, over = OneTable("Carrom"), False
        table.reset(seed=3)
        while not over:
            actions = rng.uniform(-1.0, 1.0, (tries, 3))
            _, won, ended, cut, _ = table.step(actions[table.outcomes(actions).argmax()])
            earned[tries] += won
            over = ended or cut
    assert earned[128] > earned[1] + 3.0


def test_what_is_seen_is_late_and_noisy_as_asked():
    plain, late = OneTable("AirHockey"), OneTable("AirHockey", delay=3)
    plain.reset(seed=1)
    late.reset(seed=1)
    moves = np.random.default_rng(1).uniform(-1.0, 1.0, (10, 4))
    seen = [(plain.step(one)[0], late.step(one)[0]) for one in moves]
    for k in range(3, 10):
        assert np.array_equal(seen[k][1], seen[k - 3][0])
    many, noisy = ManyTables("AirHockey", 2000), ManyTables("AirHockey", 2000, noise=2e-3)
    off = (noisy.reset(seed=1)[0] - many.reset(seed=1)[0]).astype(float)
    assert off[:, :6].std() == pytest.approx(2e-3, rel=0.03)
    assert off[:, 13:19].std() == pytest.approx(2e-3, rel=0.03)
    assert not off[:, 6:13].any() and not off[:, 19:].any()


def test_friction_and_restitutions_are_drawn_within_the_spread():
    scene = pt.Scene.load("carrom-break")
    drawn = [varied(scene, 0.3, np.random.default_rng(k)) for k in range(300)]
    friction = np.array([one.pucks[0].friction for one in drawn]) / scene.pucks[0].friction
    rims = np.array([one.pucks[0].restitution for one in drawn])
    assert 0.7 < friction.min() < 0.72 and 1.28 < friction.max() < 1.3
    assert 0.63 < rims.min() < 0.65 and 0.98 < rims.max() <= 1.0
    assert all(len({p.friction for p in one.pucks}) == 1 for one in drawn)
    ice = varied(pt.Scene.load("curling-draw"), 0.3, np.random.default_rng(1)).floor.law
    assert ice.a / 0.00200985 == pytest.approx(ice.c / 0.00626286) != 1.0
    table = OneTable("Carrom", spread=0.3)
    found = {}
    for seed in (1, 2, 1):
        table.reset(seed=seed)
        found.setdefault(seed, []).append(table.many.game.scene.pucks[0].friction)
    assert found[1][0] == found[1][1] != found[2][0]


def test_a_motion_that_cannot_be_followed_is_cut_off(monkeypatch: pytest.MonkeyPatch):
    table = ManyTables("Carrom", 3)
    table.reset()
    whole, failing = pt.Worlds.advance, [True]

    def advance(worlds: pt.Worlds, span: float) -> None:
        if failing:
            failing.clear()
            error = pt.PuckError("board 1: events crowd")
            error.boards = (1,)
            raise error
        whole(worlds, span)

    monkeypatch.setattr(pt.Worlds, "advance", advance)
    _, earned, ended, cut, _ = table.step(np.full((3, 3), 0.5))
    assert cut.tolist() == [False, True, False] and earned[1] == 0.0 and not ended.any()
    assert table.step(np.full((3, 3), 0.5))[3].tolist() == [False] * 3
    assert table.tables.moves.tolist() == [2, 0, 2]


def test_a_striker_whose_place_is_taken_goes_beside():
    table = OneTable("Carrom")
    table.reset()
    worlds = table.many.tables.worlds
    worlds.place("striker", (0.2, -0.2508))
    worlds.place("queen", (0.0, -0.2508))
    table.many.tables.advance = lambda span: None  # type: ignore[method-assign]
    table.step([0.0, 0.0, -1.0])
    assert abs(worlds.state()[0, -1, 0]) == pytest.approx(0.04)  # radii 0.0159 and 0.02065


def test_a_simple_player_guards_its_goal():
    seen = np.zeros((2, 13))
    seen[:, :6] = [[0.4, 0.2, 1.9, 0.5, 1.8, 0.9], [0.25, 0.55, 1.9, 0.5, 0.5, 0.8]]
    away, near = guard(seen)
    assert away[0] < 0.0 < away[1]  # home, and level with the puck
    assert near[0] > 0.0 and near[1] > 0.0  # for the puck, which lies in its half
    assert np.hypot(*near) == pytest.approx(1.5 / 4.0)


BAD: list[tuple[Any, str]] = [
    (lambda: OneTable("Chess"), "no game 'Chess': there are AirHockey"),
    (lambda: OneTable("Carrom", spread=1.0), "spread must be from 0 to below 1"),
    (lambda: OneTable("Carrom", noise=-1.0), "noise not negative"),
    (lambda: OneTable("Carrom", delay=0.5), "delay must be a whole number from 0 on"),
    (lambda: OneTable("Carrom", render_mode="ascii"), "render_mode must be one of"),
    (lambda: ManyTables("Carrom", 0), "n must be a whole number from 1 on"),
    (lambda: OneTable("Carrom").step([0.0, 0.0, 0.0]), "reset the environment before"),
    (lambda: OneTable("Carrom").outcomes([[0.0, 0.0, 0.0]]), "reset the environment before"),
]


@pytest.mark.parametrize("n", range(len(BAD)))
def test_bad_input_is_one_sentence(n: int):
    with pytest.raises(pt.InputError, match=BAD[n][1]) as caught:
        BAD[n][0]()
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("action", "words"), [
    ([0.0, 0.0], r"have the shape \(1, 3\), got \(1, 2\)"),
    ([-2.0, 0.0, 0.0], "lie from -1 to 1, got -2"),
    ([np.nan, 0.0, 0.0], "be finite numbers, got nan"),
    (1.0, "have the shape"), ("left", "be real numbers"),
])  # fmt: skip
def test_bad_actions_change_nothing(action: Any, words: str):
    table = OneTable("Carrom")
    table.reset()
    before = table.many.tables.worlds.state()
    with pytest.raises(pt.InputError, match=f"actions must {words}"):
        table.step(action)
    assert np.array_equal(table.many.tables.worlds.state(), before)
    assert table.many.tables.moves.tolist() == [0]


@pytest.mark.parametrize("name", QUICK)
def test_a_picture_shows_what_is_in_play(name: str):
    table = OneTable(name, render_mode="rgb_array")
    table.reset(seed=1)
    drawn = table.render()
    assert drawn.dtype == np.uint8 and drawn.ndim == 3 and drawn.shape[2] == 3
    assert len(np.unique(drawn.reshape(-1, 3), axis=0)) > 4
