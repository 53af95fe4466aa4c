"""Many boards at once: each is the same as a world of its own, to the bit."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from boards import cushions, draw, draw_pucks, puck_at

import puck_tables as pt
from puck_tables._core import executor
from puck_tables.scene.run import Event
from puck_tables.world import bench
from puck_tables.world import engine_state as g


def table(**how: Any) -> pt.Scene:
    """A mallet, three pucks, walls, a pocket, an edge and two lines."""
    mallet = pt.Puck(0.05, path=[[0.0, -0.3, 0.0]], name="mallet")
    pucks = [puck_at(0.0, 0.0), puck_at(0.2, 0.1), puck_at(0.2, -0.1, name="last")]
    return pt.Scene(
        pucks=[mallet, *pucks], walls=cushions(), pockets=[pt.Pocket((0.5, 0.5), 0.04)],
        edges=[pt.Edge((0.0, -0.58), normal=(0.0, 1.0))], **how,
        lines=[pt.Line((0.1, -1.0), (0.1, 1.0), name="middle"), pt.Line(centre=(0, 0), radius=0.2)],
    )  # fmt: skip


def push() -> pt.Scene:
    """Pucks that stay together after impacts, so that groups of them push each other."""
    pucks = [puck_at(0.1 * n, 0.01 * n, restitution=0.0, tangential=0.0) for n in range(4)]
    return pt.Scene(pucks=pucks, walls=cushions(restitution=0.0))


def slope() -> pt.Scene:
    """Integrated, down to a cushion, over strips and patches."""
    floor = pt.Floor(
        slope=0.1, strips=pt.Strips((0.1,), (0.2, 0.1)), patches=[pt.Patch(0.4, (0, -0.2), 0.1)]
    )
    return pt.Scene(pucks=[puck_at(0.2 * n, 0.1 * n) for n in range(3)], floor=floor,
                    walls=cushions(), time=9.0)  # fmt: skip


def turning() -> pt.Scene:
    return pt.Scene(pucks=[puck_at(0.1 * n, 0.1) for n in range(3)], floor=pt.Floor(turning=0.5),
                    walls=cushions(), time=9.0)  # fmt: skip


def by_law() -> pt.Scene:
    """A floor whose friction law is known up to the fastest slip yet."""
    floor = pt.Floor(law=pt.StribeckLaw(0.3, 0.1, 0.2))
    pucks = [puck_at(0.1 * n, 0.1, (0.1, 0.0)) for n in range(2)]
    return pt.Scene(pucks=pucks, floor=floor, walls=cushions())


def by_law_on_rings() -> pt.Scene:
    """The same under bases over which friction is summed: what is known of the law lies there."""
    law = pt.CurlingLaw(0.02, 0.06, 0.1)
    pucks = [
        pt.Puck(0.03, base="annulus:0.02x0.015", friction=0.1, restitution=0.8, tangential=0.0,
                 rim=0.2, launch=pt.Launch((v, 0.0), position=(0.1 * n, 0.01 * n)))
        for n, v in enumerate((0.1, 0.0))
    ]  # fmt: skip
    return pt.Scene(pucks=pucks, floor=pt.Floor(law=law), walls=cushions(), tol=1e-4)


def rail() -> pt.Scene:
    held = pt.Puck(0.03, friction=0.2, constraint=pt.Constraint("rail", angle=0.0),
                    launch=pt.Launch((0.5, 0.0)))  # fmt: skip
    return pt.Scene(pucks=[held, puck_at(0.3, 0.01)], walls=cushions())


class Pair:
    """Boards, and worlds of their own to which the same is done one by one."""

    def __init__(self, scene: pt.Scene, n: int) -> None:
        self.scene, self.n = scene, n
        self.many, self.single = pt.Worlds(scene, n), [scene.world() for _ in range(n)]

    def both(self, many: Any, one: Any, boards: Any) -> bool:
        """Do it to both; whether it went well.  Where worlds fail all boards stay."""
        before = self.bits()
        done, told = [world.copy() for world in self.single], {}
        failed = {}
        for k, board in enumerate(boards):
            world = done[board]
            first, passed = int(world._engine.counts[g.N_EVENTS]), len(world._passings.rows)
            try:
                done[board] = one(world, k) or world
                fresh = done[board] is not world
                told[board] = done[board]._events(0 if fresh else first, 0 if fresh else passed)
            except pt.PuckError as error:
                failed[board] = str(error)
        if failed:
            with pytest.raises(pt.PuckError) as caught:
                many()
            assert caught.value.boards == tuple(sorted(failed))
            first = min(failed)
            assert str(caught.value).startswith(f"board {first}")
            assert str(caught.value).endswith(failed[first])
            assert self.bits() == before
            return False
        many()
        self.single = done
        self.agree()
        events = self.many.events
        ours = [
            Event(*row) for row in zip(*(events[n].tolist() for n in Event._fields), strict=True)
        ]
        theirs = [event for board in sorted(told) for event in told[board]]
        assert ours == theirs
        assert events["board"].tolist() == [b for b in sorted(told) for _ in told[b]]
        return True

    def bits(self) -> tuple[bytes, ...]:
        many = self.many
        return many.state().tobytes(), many.time.tobytes(), many.in_play.tobytes()

    def agree(self) -> None:
        states = np.array([world.state() for world in self.single])
        assert self.many.state().tobytes() == states.tobytes()
        assert self.many.time.tolist() == [world.time for world in self.single]
        assert self.many.in_play.tolist() == [world.in_play.tolist() for world in self.single]
        assert self.many.moving.tolist() == [world.moving.tolist() for world in self.single]

    def advance(self, span: float) -> bool:
        return self.both(
            lambda: self.many.advance(span), lambda w, k: w.advance(span) and None, range(self.n)
        )

    def strike(self, puck: int, boards: Any, velocity: Any, spin: Any) -> bool:
        if not self.many.in_play[boards, puck].all():
            with pytest.raises(pt.InputError, match="no longer in play: place"):
                self.many.strike(puck, velocity, spin, boards=boards)
            return False

        def one(world: pt.World, k: int) -> None:
            world.strike(puck, velocity if velocity is None else velocity[k],
                         None if spin is None else spin[k])  # fmt: skip

        return self.both(lambda: self.many.strike(puck, velocity, spin, boards=boards), one, boards)

    def drive(self, puck: int, boards: Any, velocity: Any, spin: Any) -> bool:
        if not self.many.in_play[boards, puck].all():
            with pytest.raises(pt.InputError, match="mallet is no longer in play"):
                self.many.drive(puck, velocity, spin, boards=boards)
            return False
        return self.both(
            lambda: self.many.drive(puck, velocity, spin, boards=boards),
            lambda w, k: w.drive(puck, velocity[k], spin[k]), boards,
        )  # fmt: skip

    def place(self, puck: int, boards: Any, parts: dict[str, Any]) -> bool:
        """With some parts of a state; one that is gone needs its position."""
        if "position" not in parts and not self.many.in_play[boards, puck].all():
            with pytest.raises(pt.InputError, match="no longer in play"):
                self.many.place(puck, **parts, boards=boards)
            return False

        def one(world: pt.World, k: int) -> None:
            world.place(puck, **{name: part[k] for name, part in parts.items()})

        return self.both(lambda: self.many.place(puck, **parts, boards=boards), one, boards)

    def remove(self, puck: int, boards: Any) -> bool:
        boards = boards[self.many.in_play[boards, puck]]
        return self.both(
            lambda: self.many.remove(puck, boards=boards), lambda w, k: w.remove(puck), boards
        )

    def copy(self, boards: Any) -> None:
        """Go on with copies; what was stays as it is."""
        before, old = self.bits(), self.many
        self.many, self.single = old.copy(boards), [self.single[k].copy() for k in boards]
        self.n = len(boards)
        self.agree()
        bits = old.state().tobytes(), old.time.tobytes(), old.in_play.tobytes()
        assert bits == before

    def set_state(self, boards: Any, states: Any, anew: bool) -> bool:
        def one(world: pt.World, k: int) -> pt.World:
            world = self.scene.world() if anew else world
            world.set_state(states[k])
            return world

        if anew:
            return self.both(lambda: self.many.reset(boards, states), one, boards)
        return self.both(
            lambda: self.many.set_state(states, boards=boards), lambda w, k: one(w, k) and None,
            boards,
        )  # fmt: skip

    def reset(self, boards: Any) -> None:
        self.many.reset(boards)
        for board in boards:
            self.single[board] = self.scene.world()
        self.agree()

    def meddle(self, rng: np.random.Generator) -> str:
        """A call drawn."""
        boards = np.flatnonzero(rng.random(self.n) < 0.6)
        count, pucks = len(boards), len(self.scene.pucks)
        velocity, spin = 1.5 * rng.normal(size=(count, 2)), 20.0 * rng.normal(size=count)
        led = [bool(one.path) for one in self.scene.pucks]
        free = int(rng.choice(np.flatnonzero(~np.array(led))))
        what = str(rng.choice(
            ["advance"] * 4 + ["strike", "turn", "same", "set_state", "anew", "reset", "drive",
                               "place", "remove", "copy"]
        ))  # fmt: skip
        if what == "advance":
            done = self.advance(float(rng.choice([1.0 / 60.0, 0.05, 0.3])))
        elif what == "strike":
            done = self.strike(free, boards, velocity, spin)
        elif what == "turn":
            done = self.strike(free, boards, None, 0.1 * spin)
        elif what == "same":  # as fast as before but for the last bits, every way
            angle = rng.uniform(0.0, 6.0, count)
            around = 1.7 * np.column_stack([np.cos(angle), np.sin(angle)])
            done = self.strike(free, boards, around, None)
        elif what == "drive" and any(led):
            done = self.drive(led.index(True), boards, velocity, spin)
        elif what == "place":
            given = {"position": 0.4 * rng.random((count, 2)), "angle": spin, "velocity": velocity,
                     "spin": spin}  # fmt: skip
            parts = {name: part for name, part in given.items() if rng.random() < 0.6}
            done = self.place(int(rng.integers(pucks)), boards, parts)
        elif what == "remove":
            done = self.remove(free, boards)
        elif what == "copy":
            self.copy(rng.permutation(self.n))
            done = True
        elif what == "reset":
            self.reset(boards)
            done = True
        else:
            states = np.array([w.state() for w in self.single])[boards]
            states[:, :, :2] += 0.02 * rng.normal(size=(count, pucks, 2))
            states[:, :, 3:5] += rng.normal(size=(count, pucks, 2))
            back = rng.random(count) < 0.5  # one that left play comes back
            states[back, free, :2] = 0.4 * rng.random((int(back.sum()), 2))
            done = self.set_state(boards, states, what == "anew")
        return what if done else f"{what} refused"


def chain(scene: pt.Scene, seed: int, calls: int = 40, n: int = 5) -> Pair:
    rng, pair = np.random.default_rng([seed, 39]), Pair(scene, n)
    done = [pair.meddle(rng) for _ in range(calls)]
    assert len(set(done)) > 4
    return pair


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("board", ["table", "drawn", "pieces"])
def test_boards_are_worlds_of_their_own_whatever_is_done(board: str, seed: int):
    scenes = {"table": table, "drawn": lambda: draw(seed, 5), "pieces": lambda: draw_pucks(seed, 4)}
    pair = chain(scenes[board](), seed)
    if board != "table":
        one = int(np.flatnonzero(pair.many.in_play.all(axis=0))[0])
        assert pair.strike(one, np.arange(5), strikes(5), None)
        assert pair.advance(math.inf)
        assert len({state.tobytes() for state in pair.many.state()}) > 1
        assert not pair.many.moving.any()


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("board", [table, push, slope, turning, by_law, by_law_on_rings, rail])
def test_so_are_boards_where_pucks_push_or_are_integrated(board: Any, seed: int):
    chain(board(), seed)


@pytest.mark.thorough
@pytest.mark.parametrize("name", [
    "carrom-break", "crokinole", "air-hockey-goals", "air-hockey-mallet", "bumper-pool", "sjoelen",
    "curling-take-out", "bowling-row", "turntable", "wet-patch", "skate-blade",
])  # fmt: skip
def test_boards_that_come_along(name: str):
    pair = Pair(pt.Scene.load(name), 3)
    for _ in range(30):
        pair.advance(1.0 / 60.0)
    if name in ("carrom-break", "crokinole", "curling-take-out"):
        assert pair.advance(math.inf)


def strikes(n: int) -> np.ndarray:
    angle = np.arange(n) * 0.1
    return np.column_stack([2.0 * np.cos(angle), np.sin(angle)])


def test_neither_how_many_nor_how_many_cores_changes_a_bit(monkeypatch: pytest.MonkeyPatch):
    found = []
    for n, cores in ((200, 1), (200, 2), (200, 3), (7, 2)):
        monkeypatch.setattr(executor, "usable_cores", lambda cores=cores: cores)
        worlds = pt.Worlds(table(), n)
        worlds.strike(1, strikes(n))
        for _ in range(20):
            worlds.drive(0, (0.1, 0.3))
            worlds.advance(1.0 / 60.0)
        worlds.advance(0.5)
        mine = worlds.events["board"] < 7
        events = {name: column[mine].tolist() for name, column in worlds.events.items()}
        found.append((worlds.state()[:7].tobytes(), events))
    assert all(one == found[0] for one in found)
    assert len(found[0][1]["time"]) > 3


def test_more_than_a_bench_holds_is_played_alone(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(bench, "ROWS", 0)
    alone, calls = pt.Worlds._play_alone, []
    monkeypatch.setattr(
        pt.Worlds, "_play_alone", lambda *given: calls.append(given[2]) or alone(*given)
    )
    pair = Pair(draw(3, 6), 3)
    assert pair.strike(0, np.arange(3), strikes(3), None)
    assert pair.advance(math.inf)
    assert (np.bincount(pair.many.events["board"]) > 4).all()
    assert calls[-3:] == [0, 1, 2]


def test_lines_passed_more_often_than_a_bench_notes(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(bench, "_PASSINGS", 1)
    pair = Pair(table(), 3)
    assert pair.strike(1, np.arange(3), strikes(3), None)
    assert pair.advance(1.0)
    assert (pair.many.events["what"] == "line").sum() > 3


def test_a_mallet_that_squeezes_changes_no_board_and_says_on_which():
    scene = pt.Scene(
        pucks=[pt.Puck(0.05, path=[[0, 0.4, 0]], name="mallet"), puck_at(0.57, 0.0)],
        walls=cushions(),
    )
    worlds = pt.Worlds(scene, 4)
    worlds.drive("mallet", [[0.1, 0.0], [-0.1, 0.0], [0.2, 0.0], [0.0, 0.0]])
    before = worlds.state()
    with pytest.raises(pt.PuckError, match=r"board 0, and 1 more: mallet, .* squeezes") as caught:
        worlds.advance(9.0)
    assert caught.value.boards == (0, 2)
    assert np.array_equal(worlds.state(), before) and worlds.time.tolist() == [0.0] * 4
    worlds.drive("mallet", (0.0, 0.0), boards=caught.value.boards)
    worlds.advance(1.0)
    assert worlds.state()[:, 0, 0] == pytest.approx([0.4, 0.3, 0.4, 0.4])


def test_an_overlap_says_on_which_board():
    worlds = pt.Worlds(table(), 3)
    states = worlds.state()
    states[1, 3, :2] = states[1, 2, :2] + [0.05, 0.0]
    with pytest.raises(pt.InputError, match=r"board 1: (puck 2|last) would overlap .* by 0.01 m"):
        worlds.set_state(states)
    with pytest.raises(pt.InputError, match=r"board 2: (puck 2|last) would overlap .* by 0.01 m"):
        worlds.reset([0, 2], states[:2])
    assert worlds.state().tolist() == [table().world().state().tolist()] * 3


BAD = [
    (lambda w: pt.Worlds(table(), 0), "n must be a whole number from 1 on, got 0"),
    (lambda w: pt.Worlds(table(), True), "n must be a whole number"),
    (lambda w: pt.Worlds(table(), 10**12), "GiB of memory, .* ask for fewer boards"),
    (lambda w: pt.Worlds(draw(1, 2).pucks, 2), "scene must be a Scene"),
    (lambda w: w.advance(-1.0), "duration must not be negative"),
    (lambda w: w.advance([1.0, 2.0]), "duration must be a number"),
    (lambda w: w.strike("nobody", (1, 0)), "no puck 'nobody'"),
    (lambda w: w.strike("mallet", (1, 0)), "mallet is driven along its path: drive leads it"),
    (lambda w: w.strike(1, (1, math.nan)), "velocity must be finite"),
    (lambda w: w.strike(1, [1.0, 2.0, 3.0]), r"velocity must have the shape \(2,\) or \(3, 2\)"),
    (lambda w: w.strike(1, None, [1.0, 2.0]), r"spin must have the shape \(\) or \(3,\)"),
    (lambda w: w.strike(1, (1, 0), boards=[3]), "boards must be numbers from 0 to 2, each once"),
    (lambda w: w.strike(1, (1, 0), boards=[1, 1]), "boards must be numbers"),
    (lambda w: w.strike(1, (1, 0), boards=[True, False]), "or a mask of 3"),
    (lambda w: w.strike(1, (1, 0), boards=[0.5]), "boards must be numbers"),
    (lambda w: w.strike(1, (1, 0), boards=[[1], [1, 2]]), "boards must be numbers"),
    (lambda w: w.place(1, (0.2, 0.1)), "board 0, and 2 more: (puck 1|puck 2) would overlap"),
    (lambda w: w.place(1, [1.0]), r"position must have the shape \(2,\) or \(3, 2\)"),
    (lambda w: w.place("nobody"), "no puck 'nobody'"),
    (lambda w: w.remove(1, boards=[3]), "boards must be numbers"),
    (lambda w: w.copy([]), "one board at least"),
    (lambda w: w.copy([3]), "boards must be numbers from 0 to 2, or a mask of 3"),
    (lambda w: w.drive(1, (1, 0)), "puck 1 is not led by hand"),
    (lambda w: w.drive(0, 1.0), "velocity must have the shape"),
    (lambda w: w.drive(0, None), "velocity must be"),
    (lambda w: w.drive(0, (1.0, 0.0), None), "spin must be"),
    (lambda w: w.set_state(np.zeros((2, 4, 6))), r"states must have the shape \(3, 4, 6\), or"),
    (lambda w: w.reset(7), "boards must be numbers"),
    (lambda w: w.strike(1, (1e200, 0)), "too fast for floating point"),
]  # fmt: skip


@pytest.mark.parametrize("n", range(len(BAD)))
def test_bad_input_is_one_sentence_and_changes_nothing(n: int):
    call, words = BAD[n]
    worlds = pt.Worlds(table(), 3)
    before = worlds.state()
    with pytest.raises(pt.InputError, match=words) as caught:
        call(worlds)
    assert "\n" not in str(caught.value)
    assert np.array_equal(worlds.state(), before) and worlds.time.tolist() == [0.0] * 3


def test_boards_are_numbers_or_a_mask_in_any_order():
    worlds = pt.Worlds(table(), 4)
    worlds.strike(1, [[1.0, 0.0], [2.0, 0.0]], boards=[3, 0])
    assert worlds.state()[:, 1, 3].tolist() == [2.0, 0.0, 0.0, 1.0]
    worlds.strike(1, (0.5, 0.0), boards=np.array([False, True, True, False]))
    assert worlds.state()[:, 1, 3].tolist() == [2.0, 0.5, 0.5, 1.0]
    assert worlds.events["board"].tolist() == [1, 2] and len(worlds) == 4
    worlds.reset([])
    worlds.strike(1, np.zeros((0, 2)), boards=[])
    assert worlds.state()[:, 1, 3].tolist() == [2.0, 0.5, 0.5, 1.0]
    assert repr(worlds) == "Worlds(4 boards of 4 pucks)"


def test_one_board_may_be_copied_again_and_again():
    pair = Pair(table(), 2)
    assert pair.strike(1, np.array([1]), strikes(1), None) and pair.advance(0.1)
    pair.copy([1, 0, 1, 1])
    assert pair.strike(2, np.arange(3), strikes(3), None) and pair.advance(1.0)
    assert len({state.tobytes() for state in pair.many.state()}) == 4


def test_what_cannot_end_is_refused_by_its_board():
    worlds = pt.Worlds(table(), 3)
    worlds.drive(0, (0.0, 0.0), 2.0, boards=[1])  # it turns for ever
    with pytest.raises(pt.InputError, match=r"board 1: a puck still moves after .* give a time"):
        worlds.advance(math.inf)
    assert worlds.time.tolist() == [0.0] * 3


def test_boards_that_push_are_played_together(monkeypatch: pytest.MonkeyPatch):
    """A row without rebounds, struck: groups push in the same call, with the bits of World."""
    monkeypatch.setattr(pt.Worlds, "_play_alone", None)
    row = [puck_at(0.0605 * k, 0.0, restitution=0.0) for k in range(3)]
    pair = Pair(pt.Scene(pucks=row, walls=cushions()), 3)
    assert pair.strike(0, np.arange(3), np.tile([1.2, 0.0], (3, 1)), None)
    assert pair.advance(math.inf)
    assert all(world.groups > 0 for world in pair.single)


def test_one_that_is_put_where_it_was_taken_out_is_back():
    """Its row is not new, but place says that it comes back; set_state leaves it out."""
    worlds = pt.Worlds(pt.Scene(pucks=[puck_at(0.0, 0.0), puck_at(0.2, 0.0)]), 2)
    start = worlds.state()
    worlds.remove(0)
    worlds.set_state(start)
    assert not worlds.in_play[:, 0].any()
    worlds.place(0, (0.0, 0.0), 0.0, (0.0, 0.0), 0.0, boards=[1])
    assert worlds.in_play[:, 0].tolist() == [False, True]


def test_who_goes_on_elsewhere_as_it_went_has_the_bits_of_a_world():
    """A rounding of its slip is no faster slip, from which steps would be others."""
    for v in np.random.default_rng(1).normal(size=(8, 2)):
        one = pt.Puck(0.1, friction=0.1, launch=pt.Launch(v, spin=30.0 * v[0]))
        scene = pt.Scene(pucks=[one], floor=pt.Floor(slope=0.9), walls=cushions(9.0), time=5.0)
        world, worlds = scene.world(), pt.Worlds(scene, 1)
        for board in (world, worlds):
            board.advance(0.05)
            board.place(0, (0.4, 0.4))
            board.advance(0.1)
        assert np.array_equal(world.state(), worlds.state()[0])
