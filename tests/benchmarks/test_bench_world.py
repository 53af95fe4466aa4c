"""Many pucks: a break, one meeting, growth, a game in real time, and a map of strikes."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
import pytest
from boards import cushions, draw, hexagon, judged
from pucks_judge import Floor, play

import puck_tables as pt
from benchmarks.step_engines import Played, play_box2d, play_pymunk
from puck_tables.kernels.compile import kernel
from puck_tables.world.contact_search import next_contact

BREAK = pytest.mark.benchmark(group="carrom break, 20 discs until rest, one thread")
MEETING = pytest.mark.benchmark(group="next contact of one pair, one thread")
GROWTH = pytest.mark.benchmark(group="one striker among many at rest, one thread")
HOCKEY = pytest.mark.benchmark(group="air hockey, 1/60 s a call")
HANDS = pytest.mark.benchmark(group="a hand in a world of 20 pucks, one call")
CURLING = pytest.mark.benchmark(group="curling take-out, 100 000 strikes, all cores")

BOARD, MAN, STRIKER = 0.7366, 0.0159, 0.02065  # m


def carrom(gap: float) -> pt.Scene:
    """19 men and a striker on a 29-inch board; ``gap`` between the men, m."""
    rim = {"friction": 0.1, "restitution": 0.9, "tangential": 0.0, "rim": 0.2}
    men = [
        pt.Puck(MAN, mass=0.0053, launch=pt.Launch(position=place), **rim)
        for place in hexagon(2, 2.0 * MAN + gap)
    ]
    strike = pt.Launch((0.05, 4.0), position=(-0.004, -0.3))
    striker = pt.Puck(STRIKER, mass=0.015, launch=strike, name="striker", **rim)
    walls = cushions(0.5 * BOARD, 0.9, tangential=0.0, friction=0.2)
    return pt.Scene(pucks=[*men, striker], walls=walls)


LOOSE = 1e-3  # m, between the men where the first impacts are compared


def compare(other: Played, extra: dict[str, Any]) -> float:
    """How far a stepping engine is from us: first three impacts, s; ends of the discs, m."""
    scene = carrom(LOOSE)
    world = scene.world()
    events = [event for event in world.advance(math.inf) if event.what == "impact"][:3]
    assert np.abs(other.places).max() < 0.5 * BOARD  # none has left it
    number = {name: n for n, name in enumerate(world.names)}
    ours = [(e.time, {number[e.puck], number.get(e.partner, -1)}) for e in events]
    found = [(time, {i, j}) for time, i, j in other.impacts[:3]]
    late = [abs(a[0] - b[0]) for a, b in zip(ours, found, strict=True)]
    extra["same_partners"] = [a[1] == b[1] for a, b in zip(ours, found, strict=True)]
    extra["impacts_off_s"] = late
    off = np.hypot(*(other.places - world.state()[:, :2]).T)
    extra["ends_off_m"] = [float(np.median(off)), float(off.max())]
    extra["rest_off_s"] = abs(other.time - world.last_motion)
    return float(max(late))


def until_rest(world: pt.World) -> int:
    twin = world.copy()
    return sum(event.what == "impact" for event in twin.advance(math.inf))


@BREAK
@pytest.mark.parametrize("gap", [0.0, LOOSE])
def test_carrom_break(measure: Any, gap: float) -> None:
    world, error = carrom(gap).world(), None
    measure.benchmark.extra_info["impacts"] = until_rest(world)
    if gap > 0.0:
        first = [e.time for e in world.copy().advance(math.inf) if e.what == "impact"][:3]
        truth = play(Floor(), *judged(carrom(gap)), first[-1] + 1e-3, most=3).impacts
        error = max(abs(a - b[0]) for a, b in zip(first, truth, strict=True))
    name = "men touch" if gap == 0.0 else f"men {1e3 * gap:g} mm apart"
    measure(name, lambda: until_rest(world), unit="game", error=error)


@BREAK
@pytest.mark.parametrize("engine", ["pymunk", "Box2D"])
def test_rival_break(measure: Any, engine: str) -> None:
    pytest.importorskip(engine, reason=f"{engine} is not installed")
    follow = {"pymunk": play_pymunk, "Box2D": play_box2d}[engine]
    scene = carrom(LOOSE)
    error = compare(follow(scene, True), measure.benchmark.extra_info)
    measure(f"rival: {engine}, 1 ms steps", lambda: follow(scene), unit="game", error=error)


@MEETING
@pytest.mark.parametrize("which", ["meets", "does not"])
def test_next_contact(measure: Any, which: str) -> None:
    """Pairs of a board on which all move."""
    world = draw(77, 40, side=0.6).world()
    engine, room, pairs = world._engine, world._room, []
    for i in range(40):
        for j in range(40):
            if i != j and max(engine.segments[i, 0], engine.segments[j, 0]) != 0.0:
                found = next_contact(engine, i, j, 0.0, math.inf, room.work, room.one, room.two)
                if math.isfinite(found) is (which == "meets"):
                    pairs.append((i, j))
    several = np.array(pairs)

    @kernel
    def look(engine: Any, pairs: Any, room: Any) -> Any:
        total = 0.0
        for row in range(pairs.shape[0]):
            total += next_contact(
                engine, pairs[row, 0], pairs[row, 1], 0.0, np.inf, room.work, room.one, room.two
            )
        return total

    measure(
        f"{len(several)} pairs, one {which}", lambda: look(engine, several, room),
        items=len(several), unit="pair",
    )  # fmt: skip


def crowd(count: int) -> pt.Scene:
    """Pucks at rest at the same density whatever their number, and a heavy striker."""
    rng, pitch = np.random.default_rng(count), 0.09
    places = np.array(hexagon(13, pitch)[: count - 1])
    places += rng.uniform(-0.01, 0.01, places.shape)
    rim = {"friction": 0.05, "restitution": 0.95}
    rest = [pt.Puck(0.03, mass=0.1, launch=pt.Launch(position=p), **rim) for p in places.tolist()]
    launch = pt.Launch((10.0, 0.3), position=(float(places[:, 0].min()) - 0.1, 0.0))
    return pt.Scene(pucks=[*rest, pt.Puck(0.03, mass=1.0, launch=launch, **rim)])


@GROWTH
@pytest.mark.parametrize("count", [2, 5, 10, 20, 50, 100, 200, 500])
def test_growth(measure: Any, count: int) -> None:
    world = crowd(count).world()
    impacts = max(until_rest(world), 1)
    measure(f"{count} pucks, {impacts} impacts", lambda: until_rest(world), items=impacts,
            unit="impact")  # fmt: skip


def hockey() -> pt.Scene:
    """A table with a puck and two mallets that go to and fro before the goals for a minute."""
    times = np.arange(0.0, 120.0, 1.0 / 60.0)

    def way(x: float, phase: float) -> list[list[float]]:
        return [
            [t, x + 0.08 * math.sin(3.1 * t + phase), 0.25 * math.sin(2.3 * t + phase)]
            for t in times.tolist()
        ]

    puck = pt.Puck(0.04, friction=0.0, mass=0.03, restitution=0.9, tangential=-0.5,
                    launch=pt.Launch((3.0, 1.3), 10.0))  # fmt: skip
    mallets = [pt.Puck(0.05, path=way(x, x), restitution=0.9) for x in (-0.75, 0.75)]
    walls = [
        pt.Wall((-1.0 * nx, -0.5 * ny), normal=(nx, ny), restitution=0.9)
        for nx, ny in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
    ]
    return pt.Scene(pucks=[puck, *mallets], walls=walls, drag=pt.Drag(sliding=0.002),
                    time=60.0)  # fmt: skip


@HOCKEY
def test_air_hockey(measure: Any) -> None:
    start = hockey().world()

    def engine(call: Any) -> np.ndarray:
        world, spent = start.copy(), np.empty(3600)
        for frame in range(spent.size):
            before = time.perf_counter()
            call(world)
            spent[frame] = time.perf_counter() - before
        return spent

    calls = {
        "advance": lambda world: world.advance(1.0 / 60.0),
        "advance and state": lambda world: (world.advance(1.0 / 60.0), world.state()),
    }
    for name, call in calls.items():
        spent = np.sort([engine(call) for _ in range(3)], axis=None)
        measure.benchmark.extra_info[name] = {
            "median_s": float(np.median(spent)), "of_1000_s": float(np.quantile(spent, 0.999)),
            "worst_s": float(spent[-1]),
        }  # fmt: skip
    measure("a minute of play, advance and state", lambda: engine(calls["advance and state"]),
            items=3600, unit="frame")  # fmt: skip


def led() -> pt.World:
    """The same table with one mallet, which a hand leads."""
    scene = hockey()
    mallet = pt.Puck(0.05, path=[[0.0, -0.75, 0.0]], restitution=0.9)
    return pt.Scene(
        pucks=[scene.pucks[0], mallet], walls=scene.walls, drag=scene.drag, time=60.0
    ).world()


@HOCKEY
def test_air_hockey_led_by_hand(measure: Any) -> None:
    """Every frame: where to, and advance; now and then the puck is struck."""
    start = led()

    def engine() -> np.ndarray:
        world, spent = start.copy(), np.empty((2, 3600))
        for frame in range(spent.shape[1]):
            if frame % 300 == 0:
                world.strike(0, (2.0, 1.3), 10.0)
            t = frame / 60.0
            x, y = -0.75 + 0.08 * math.sin(3.1 * t), 0.25 * math.sin(2.3 * t)
            times = [time.perf_counter()]
            world.drive(1, towards=(x, y), speed=1.0)
            times.append(time.perf_counter())
            world.advance(1.0 / 60.0)
            times.append(time.perf_counter())
            spent[:, frame] = np.diff(times)
        return spent

    spent = np.concatenate([engine() for _ in range(3)], axis=1)
    for name, row in zip(("drive", "advance"), np.sort(spent, axis=1), strict=True):
        measure.benchmark.extra_info[name] = {
            "median_s": float(np.median(row)), "of_1000_s": float(np.quantile(row, 0.999)),
            "worst_s": float(row[-1]),
        }  # fmt: skip
    measure("a minute of play, drive and advance", engine, items=3600, unit="frame")


@HANDS
@pytest.mark.parametrize("verb", ["strike", "place", "set_state", "remove and place"])
def test_hands(measure: Any, verb: str) -> None:
    world = draw(3, 20, side=0.6).world()
    world.advance(20.0)
    states, home = world.state(), world.state()[0, :2]
    moved = states.copy()
    moved[0, :2] += 1e-4
    turn = [0]

    def both() -> None:
        world.remove(0)
        world.place(0, home, velocity=(0.0, 0.0), spin=0.0)

    def other() -> None:
        turn[0] = 1 - turn[0]
        world.set_state(moved if turn[0] else states)

    calls = {
        "strike": lambda: world.strike(0, (0.0, 0.0), 0.0),
        "place": lambda: world.place(0, home, velocity=(0.0, 0.0), spin=0.0),
        "set_state": other, "remove and place": both,
    }  # fmt: skip
    measure(verb, calls[verb], unit="call")


def take_out() -> pt.Scene:
    """A stone sent at one of two in the house: 250 headings, 400 spins."""
    stone = {"radius": 0.145, "height": 0.114, "mass": 19.1, "friction": 0.015, "restitution": 0.85,
             "tangential": 0.0, "rim": 0.1}  # fmt: skip
    launch = {"velocity": [3.2, "-0.03:0.03:250"], "spin": "-2:2:400"}
    return pt.Scene.from_tables({"puck": [
        {"name": "sent", "launch": launch, **stone},
        {"name": "out", "launch": {"position": [28.0, 0.0]}, **stone},
        {"name": "guard", "launch": {"position": [26.5, 0.5]}, **stone},
    ]})  # fmt: skip


@CURLING
def test_take_out(measure: Any) -> None:
    scene = take_out()
    found = scene.sweep()
    measure.benchmark.extra_info["impacts"] = float(found.impacts.sum())
    measure("where do three stones end?", lambda: scene.sweep(), items=100_000, unit="strike")
