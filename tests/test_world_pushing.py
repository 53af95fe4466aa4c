"""Discs that press on each other and on obstacles: judged by another integrator, and by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pushed_groups import (
    Ride,
    arc,
    cluster,
    disc,
    film_of,
    group_of,
    judged_discs,
    post,
    pull_of,
    wall,
    without_approach,
)
from pushing_judge import Judge

import puck_tables as pt
from puck_tables.motion.body import body_of
from puck_tables.world.group import (
    DRIVEN,
    HELD,
    PARTS,
    RESTS,
    RIM_GIVES,
    RIM_STOPS,
    RUNS_OFF,
    SETS_OFF,
    TIME_UP,
    YIELDS,
)
from puck_tables.world.layout import FRICTION
from puck_tables.world.paths import on_piece

ALONG, UP = math.cos(0.5), math.sin(0.5)

# name: group, states, contacts, the judge's contacts, how long
SMOOTH = {
    "a heavy one that spins pushes a light one": (
        group_of([disc(mass=0.4, decel=0.5), disc(mass=0.1, decel=2.0)]),
        [[0, 0, 0, 1, 0, 30], [0.1, 0, 0, 1, 0, 0]], [(0, 1)], [(0, 1, 0.0, None)], 0.3,
    ),
    "the same with rims that slide": (
        group_of([disc(mass=0.4, decel=0.5, grip=0.3), disc(mass=0.1, decel=2.0, grip=0.5)]),
        [[0, 0, 0, 1, 0, 30], [0.1, 0, 0, 1, 0, 0]], [(0, 1)], [(0, 1, 0.3, 1)], 0.3,
    ),
    "and with rims that stick": (
        group_of([disc(mass=0.4, decel=0.5, grip=1.0), disc(mass=0.1, decel=2.0, grip=1.0)]),
        [[0, 0, 0, 1, 0, 3], [0.1, 0, 0, 1, 0.1, -1]], [(0, 1)], [(0, 1, 1.0, 0)], 0.2,
    ),
    "a row of three": (
        group_of([
            disc(mass=0.4, decel=0.5, grip=0.2), disc(mass=0.1, grip=0.2),
            disc(mass=0.1, decel=2.0, grip=0.2),
        ]),
        [[0, 0, 0, 1, 0, 30], [0.1, 0, 0, 1, 0, 0], [0.2, 0, 0, 1, 0.2, -3]],
        [(0, 1), (1, 2)], [(0, 1, 0.2, 1), (1, 2, 0.2, -1)], 0.1,
    ),
    "one pushes another along a wall": (
        group_of(
            [disc(mass=0.4, decel=0.5, grip=0.2), disc(mass=0.1, decel=2.0, grip=0.2)],
            [wall(0, 1, 0, 0.3)], (0.0, -0.3),
        ),
        [[-0.1 * ALONG, 0.05 + 0.1 * UP, 0, 1, 0, 10], [0, 0.05, 0, 1, 0, 0]],
        [(0, 1), (1, -1)], [(0, 1, 0.2, 1), (1, ("wall", 0, 1, 0), 0.3, 1)], 0.1,
    ),
    "within an arc, with drag": (
        group_of(
            [disc(decel=0.5, grip=0.2, damping=0.1, spin_damping=0.2, wake=0.3)],
            [arc(0, 0, 0.4, 0, 7, 0.2)], (0.0, -1.0),
        ),
        [[0.35, 0, 0, 0, 1, 0]], [(0, -1)], [(0, ("arc", 0, 0, 0.4), 0.2, 1)], 0.2,
    ),
    "round a post, the rim sticking": (
        group_of([disc(decel=0.3, grip=2.0)], [post(0, 0, 0.1, 2.0)], (0.0, -1.0)),
        [[0, 0.15, 0, 0.2, 0, -4]], [(0, -1)], [(0, ("post", 0, 0, 0.1), 2.0, 0)], 0.1,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", SMOOTH)
def test_as_another_integrator(name: str):
    group, states, contacts, judged, until = SMOOTH[name]
    ride = Ride(group, states, contacts, until)
    assert ride.hows == [(TIME_UP, -1)]
    judge = Judge(judged_discs(group), judged, pull_of(group))
    truth, _, _ = judge.run(states, 0.0, until)
    assert np.abs(truth - ride.states).max() < 1e-10 * np.abs(truth).max()
    assert abs(ride.residual()) < 1e-12 * ride.energy(ride.starts[0])


def test_they_part_when_nothing_presses_any_more():
    group, states, contacts, judged, _ = SMOOTH["the same with rims that slide"]
    ride = Ride(group, states, contacts, 5.0, most=1)
    judge = Judge(judged_discs(group), judged)
    truth, t, parts = judge.run(
        states, 0.0, 5.0, until=lambda judge, t, q, v: judge.solved(t, q, v)[1][0, 0]
    )
    assert parts
    assert ride.hows == [(PARTS, 0)]
    assert abs(ride.t - t) < 1e-9
    assert np.abs(truth - ride.states).max() < 1e-9 * 30.0


def test_off_a_post_at_two_thirds_of_its_height_and_at_four_sevenths_if_it_rolls():
    start = [[1e-3, math.sqrt(0.15**2 - 1e-6), 0, 0, 0, 0]]
    top = start[0][1] / 0.15
    for grip, height in ((0.0, 2.0 / 3.0), (math.inf, 4.0 / 7.0)):
        group = group_of([disc(decel=0.0, grip=grip)], [post(0, 0, 0.1, grip)], (0.0, -1.0))
        ride = Ride(group, start, [(0, -1)], 9.0, most=1)
        assert ride.hows == [(PARTS, 0)]
        assert abs(ride.states[0, 1] / 0.15 - height * top) < 1e-11


def test_a_rolling_rim_gives_where_its_friction_ends():
    group = group_of([disc(decel=0.0, grip=0.3)], [post(0, 0, 0.1, 0.3)], (0.0, -1.0))
    ride = Ride(group, [[1e-3, math.sqrt(0.15**2 - 1e-6), 0, 0, 0, 0]], [(0, -1)], 9.0, most=2)
    assert [how for how, _ in ride.hows] == [RIM_GIVES, PARTS]
    x, y = ride.starts[1][0, :2] / 0.15
    top = math.sqrt(1.0 - (1e-3 / 0.15) ** 2)
    assert abs(x - 0.3 * (7.0 * y - 4.0 * top)) < 1e-10  # τ = m g sin/3, λ = m g (7 cos − 4)/3


def test_a_sliding_rim_stops_and_rolls():
    group = group_of([disc(decel=0.0, grip=0.2)], [wall(0, 1, 0, 0.2)], (0.0, -1.0))
    ride = Ride(group, [[0, 0.05, 0, 0.5, 0, 10]], [(0, -1)], 3.0)
    assert ride.hows == [(RIM_STOPS, 0), (TIME_UP, -1)]
    assert abs(ride.times[0] - 1.0 / (3.0 * 0.2)) < 1e-12  # u′ = −(1 + R²/k²) μ g
    assert abs(ride.states[0, 3] + 0.05 * ride.states[0, 5]) < 1e-15
    assert abs(ride.ledger[1] - 0.5 * (0.2 / 3.0) * 1.0**2) < 1e-12  # ½ m_t u²


def test_an_arc_ends():
    group = group_of([disc(decel=0.0)], [arc(0, 0, 0.4, -0.2, 1.2)])
    ride = Ride(group, [[0.35, 0, 0, 0, 0.7, 0]], [(0, -1)], 3.0, most=1)
    assert ride.hows == [(RUNS_OFF, 0)]
    assert abs(ride.t - 1.0 / 2.0) < 1e-12


@pytest.mark.parametrize("grip", [0.0, 0.3, math.inf])
def test_a_slope_holds_two_against_a_wall(grip: float):
    group = group_of([disc(decel=0.5, grip=grip)] * 2, [wall(0, 1, 0, grip)], (0.0, -1.0))
    ride = Ride(group, [[0, 0.15, 0, 0, 0, 0], [0, 0.05, 0, 0, 0, 0]], [(0, 1), (1, -1)], 1.0)
    assert (ride.doings_then[0] == HELD).all()
    assert np.abs(ride.pushes_then[0] - [[0.1, 0], [0.2, 0]]).max() < 1e-13


def test_without_the_wall_they_go_down_together():
    group = group_of([disc(decel=0.5, delta=0.3), disc(decel=0.7, delta=0.3)], pull=(0.0, -1.0))
    ride = Ride(group, [[0, 0.15, 0, 0, 0, 0], [0, 0.05, 0, 0, 0, 0]], [(0, 1)], 1.0)
    assert ride.hows == [(TIME_UP, -1)]
    assert np.abs(ride.states[:, 4] + 0.4).max() < 1e-12
    assert np.abs(ride.states[:, 1] - [-0.05, -0.15]).max() < 1e-12


def test_up_a_slope_and_down_again():
    group = group_of([disc(decel=0.5, delta=0.3)], pull=(0.0, -1.0))
    ride = Ride(group, [[0, 0, 0, 0, 1, 0]], [], 4.0)
    assert ride.hows == [(RESTS, 0), (TIME_UP, -1)]
    assert abs(ride.times[0] - 2.0 / 3.0) < 1e-11
    assert abs(ride.states[0, 1] - (1.0 / 3.0 - 0.25 * (10.0 / 3.0) ** 2)) < 1e-10


def test_a_mallet_sets_off_two_that_rest():
    path = lambda t: ([0.5 * t**3, 0, 0], [1.5 * t * t, 0, 0], [3.0 * t, 0, 0])  # noqa: E731
    group = group_of(
        [disc(mass=0), disc(decel=1.0), disc(decel=2.0)],
        films={0: film_of(path, np.linspace(0, 1, 11))},
    )
    states = np.zeros((3, 6))
    states[1:, :2] = [0.1, 0], [0.1 + 0.1 * math.cos(0.1), 0.1 * math.sin(0.1)]
    ride = Ride(group, states, [(0, 1), (1, 2)], 0.9, most=2)
    assert ride.hows == [(SETS_OFF, -1), (PARTS, 1)]
    assert ride.times[0] < 1e-9
    assert ride.doings_then[1].tolist() == [DRIVEN, YIELDS, YIELDS]
    # so slowly friction balances the pushes: 0.4 N along the line of centres, 0.2 N against the way
    across = 0.4 * math.sin(0.1) / 0.2
    push = 0.4 * math.cos(0.1) + 0.2 * math.sqrt(1.0 - across * across)
    assert np.abs(ride.pushes_then[1] - [[push, 0], [0.4, 0]]).max() < 1e-9
    given = {0: lambda t: [np.array(a) for a in path(t)]}
    judge = Judge(judged_discs(group), [(0, 1, 0.0, None), (1, 2, 0.0, None)], given=given)
    later = int(np.searchsorted(ride.pieces[0, :, 0], 0.2))  # from there the judge goes on
    t, start = float(ride.pieces[0, later, 0]), ride.pieces[:, later, 2:8]
    truth, end, parts = judge.run(
        start, t, 0.9, until=lambda judge, t, q, v: judge.solved(t, q, v)[1][1, 0]
    )
    assert parts
    assert t < 0.4
    assert abs(end - ride.times[1]) < 1e-9
    assert np.abs(truth - ride.states).max() < 1e-9


def random_start(seed: int, flat: bool = False):
    """A cluster on a wall that neither approaches nor is at rest, whatever its contacts do next."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 7))
    radii, places, contacts = cluster(rng, count)
    grip = [float(rng.choice([0.0, 0.1, 0.3])) for _ in range(count)]
    discs = [
        disc(
            radius=radii[i], mass=rng.uniform(0.1, 0.5), decel=rng.uniform(0.3, 2.0),
            delta=0.0 if flat else rng.uniform(0.0, 0.8), grip=grip[i],
            wake=rng.uniform(0.0, 0.2), damping=rng.uniform(0.0, 0.1),
        )
        for i in range(count)
    ]  # fmt: skip
    group = group_of(discs, [wall(0, 1, 0, 0.2)], rng.normal(size=2) * rng.choice([0.0, 0.3, 1.0]))
    states = np.zeros((count, 6))
    states[:, :2] = places
    states[:, 3:] = rng.normal(size=(count, 3)) * [1.0, 1.0, 10.0] + [0.5, 0.0, 0.0]
    return group, without_approach(group, states, contacts), contacts


@pytest.mark.parametrize("seed", range(12))
def test_the_ledger_closes(seed: int):
    ride = Ride(*random_start(seed), 2.0, most=200)
    assert len(ride.hows) < 200
    scale = max(ride.energy(ride.starts[0]), np.abs(ride.ledger).max())
    assert abs(ride.residual()) < 1e-10 * scale
    assert ride.ledger[:3].min() >= 0.0


@pytest.mark.parametrize("seed", range(6))
def test_neither_members_nor_contacts_have_an_order(seed: int):
    group, states, contacts = random_start(seed)
    first = Ride(group, states, contacts, 0.2)
    rng = np.random.default_rng(seed)
    order = rng.permutation(len(states))
    place = np.argsort(order)
    swapped = [
        (place[i], place[j] if j >= 0 else j)[:: 1 if j < 0 else int(rng.choice([-1, 1]))]
        for i, j in contacts
    ]
    again = Ride(
        group._replace(discs=group.discs[order]),  # which know the regions of their friction
        states[order], [swapped[i] for i in rng.permutation(len(swapped))], 0.2,
        members=rng.permutation(len(states)),
    )  # fmt: skip
    assert [how for how, _ in first.hows] == [how for how, _ in again.hows]
    assert np.abs(again.states[place] - first.states).max() < 1e-10 * np.abs(first.states).max()


def test_a_mirrored_start_stays_mirrored():
    half = math.radians(31.0)
    group = group_of(
        [disc(mass=0.5, decel=0.4, grip=0.3), disc(grip=0.3, delta=0.4), disc(grip=0.3, delta=0.4)]
    )
    x, y, u = 0.1 * math.cos(half), 0.1 * math.sin(half), 0.8
    states = np.array([
        [0, 0, 0, 1, 0, 0], [x, y, 0, 1, 0, 3.0], [x, -y, 0, 1, 0, -3.0],
    ])  # fmt: skip
    states[1, 3:5] = u * x / 0.1 + (1 - u) * 1.0, 0.0
    states[2, 3:5] = states[1, 3:5]
    states = without_approach(group, states, [(0, 1), (0, 2)])
    ride = Ride(group, states, [(0, 1), (0, 2)], 5.0)
    assert len(ride.hows) > 1
    mirror = np.array([1, -1, -1, 1, -1, -1])
    for then in ride.starts:
        assert np.abs(then[2] * mirror - then[1]).max() < 1e-11
        assert np.abs(then[0, [1, 2, 4, 5]]).max() < 1e-11


def test_a_rack_with_more_contacts_than_directions():
    """Seven in a hexagon, pushed: forces are not unique, motions are, and symmetric."""
    angles = np.arange(6) * math.pi / 3.0
    places = np.vstack([[0, 0], 0.1 * np.column_stack([np.cos(angles), np.sin(angles)])])
    states = np.zeros((7, 6))
    states[:, :2], states[:, 3] = places, 1.0
    discs = [disc(decel=1.0)] * 7
    discs[4] = disc(decel=0.1, mass=1.0)  # the one behind pushes all
    group = group_of(discs)
    contacts = [
        (i, j) for i in range(7) for j in range(i) if np.hypot(*(places[i] - places[j])) < 0.101
    ]
    assert len(contacts) == 12
    ride = Ride(group, states, contacts, 0.05)
    kept = ride.modes_then[0]
    assert ride.hows[0][0] == TIME_UP, (ride.hows, kept)
    judged = [(int(i), int(j), 0.0, None) for i, j in ride.contacts]
    truth, _, _ = Judge(judged_discs(group), judged).run(states, 0.0, 0.05)
    assert np.abs(truth - ride.states).max() < 1e-11
    assert (
        np.abs(ride.states[[1, 2, 3]] - ride.states[[1, 6, 5]] * [1, -1, -1, 1, -1, -1]).max()
        < 1e-13
    )


@pytest.mark.parametrize("spin", [5.0, 30.0, 80.0])
def test_one_alone_as_a_single_puck(spin: float):
    puck = pt.Puck(
        radius=0.04, height=0.02, friction=0.15, mass=0.2, pressure="annulus:0.8", gyration=0.9
    )
    cut = body_of("annulus:0.8", puck.delta, 0.9).friction(1e-11).coefficients
    group = group_of(
        [disc(radius=0.04, decel=0.15 * puck.gravity, delta=puck.delta, gyration=0.9)],
        cuts=cut[None],
    )
    ride = Ride(group, [[0, 0, 0, 0.8, 0.5, spin]], [], 50.0)
    run = puck.simulate((0.8, 0.5), spin=spin, tol=1e-10)
    assert ride.hows == [(RESTS, 0)]
    assert abs(ride.t - run.stop_time) < 1e-9 * run.stop_time
    assert np.abs(ride.states[0, :2] - run.stop_position).max() < 1e-9
    times = np.linspace(0.0, 0.999 * run.stop_time, 50)
    states, out = run(times), np.empty(9)
    for k, t in enumerate(times):
        row = max(int(np.searchsorted(ride.pieces[0, :, 0], t, side="right")) - 1, 0)
        on_piece(ride.pieces[0, row], t, out)
        assert np.hypot(out[0] - states.x[k], out[1] - states.y[k]) < 1e-9
        assert abs(out[5] - states.spin[k]) < 1e-8 * spin


def test_errors_fall_with_the_tolerance():
    group, states, contacts, _, until = SMOOTH["the same with rims that slide"]
    best = Ride(group, states, contacts, until, tol=1e-14).states
    errors, steps = [], []
    for tol in (1e-6, 1e-8, 1e-10, 1e-12):
        ride = Ride(group, states, contacts, until, tol=tol)
        errors.append(np.abs((ride.states - best)[:, 3:5]).max())
        steps.append(ride.pieces.shape[1])
    assert all(
        error < 30.0 * tol for error, tol in zip(errors, (1e-6, 1e-8, 1e-10, 1e-12), strict=True)
    )
    assert errors[0] > 300.0 * errors[2]
    assert 4.0 < steps[3] / steps[0] < 25.0  # 10^(6/5)


def test_nothing_overlaps_on_the_way():
    for name in ("a row of three", "one pushes another along a wall"):
        group, states, contacts, _, until = SMOOTH[name]
        ride, out = Ride(group, states, contacts, until), np.empty((len(states), 9))
        for t in np.linspace(0.0, until, 200)[1:-1]:
            row = int(np.searchsorted(ride.pieces[0, :, 0], t, side="right")) - 1
            for place in range(len(states)):
                on_piece(ride.pieces[place, row], t, out[place])
            for i, j in contacts:
                gap = np.hypot(*(out[j, :2] - out[i, :2])) - 0.1 if j >= 0 else out[i, 1] - 0.05
                assert abs(gap) < 1e-12 * 0.05


def test_a_full_buffer_changes_nothing():
    group, states, contacts, _, until = SMOOTH["a row of three"]
    whole = Ride(group, states, contacts, until)
    parts = Ride(group, states, contacts, until, rooms=7)
    assert len(parts.hows) > 2
    assert np.abs(whole.states - parts.states).max() < 1e-11


def judge_first_stretch(seed: int) -> bool:
    """One stretch of a random group against the judge; whether there was any."""
    group, states, contacts = random_start(seed, flat=True)
    ride = Ride(group, states, contacts, 0.1, most=1)
    if not ride.hows or (ride.doings_then[0] == HELD).any():
        return False
    judged = []
    for (i, j), mode in zip(ride.contacts, ride.modes_then[0], strict=True):
        grip = min(group.discs[i, FRICTION], group.discs[j, FRICTION]) if j >= 0 else 0.2
        judged.append(
            (int(i), int(j) if j >= 0 else ("wall", 0, 1, 0), grip, int(mode) if grip else None)
        )
    judge = Judge(judged_discs(group), judged, pull_of(group))
    truth, _, _ = judge.run(ride.starts[0], 0.0, ride.t)
    assert np.abs(truth - ride.states).max() < 1e-9 * np.abs(truth).max(), seed
    start = ride.starts[0]
    _, pushes, _ = judge.solved(0.0, start[:, :3].ravel(), start[:, 3:].ravel())
    assert all(push > -1e-9 for push, _ in pushes), seed
    return len(pushes) > 0


def test_random_groups_as_another_integrator():
    assert sum(judge_first_stretch(seed) for seed in range(12)) >= 5


@pytest.mark.nightly
def test_many_random_groups():
    assert sum(judge_first_stretch(seed) for seed in range(100, 300)) >= 95
    for seed in range(100, 500):
        ride = Ride(*random_start(seed), 2.0, most=300)
        assert len(ride.hows) < 300, seed
        scale = max(ride.energy(ride.starts[0]), np.abs(ride.ledger).max())
        assert abs(ride.residual()) < 1e-10 * scale, seed
