"""Groups of discs for the tests of sustained contacts, and the whole of a motion through events."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from puck_tables.kernels.compile import kernel
from puck_tables.kernels.quadratic import NO_SECTION
from puck_tables.scene.by_speed import NO_LAW
from puck_tables.scene.floor_map import NO_FLOOR_MAP
from puck_tables.scene.forces import QUADRATIC, SLIDING, SPINNING
from puck_tables.scene.ingredients import Regions, Surface
from puck_tables.world import pressing, pushing
from puck_tables.world.engine_state import Engine
from puck_tables.world.group import APART, HELD, Scales, buffer_for
from puck_tables.world.layout import (
    ARC,
    DISC_COLUMNS,
    DRAG,
    FRICTION,
    OBSTACLE_COLUMNS,
    POST,
    PULL_X,
    PULL_Y,
    REGION,
    TANGENTIAL,
    WALL,
)
from puck_tables.world.paths import PIECE_COLUMNS
from puck_tables.world.step_ledger import DONE, LEDGER, WORK_COLUMNS

press, follow = kernel(pressing.press), kernel(pushing.follow)


def disc(radius=0.05, mass=0.2, decel=1.0, delta=0.0, grip=0.0, gyration=0.5**0.5, damping=0.0,
         spin_damping=0.0, wake=0.0, tangential=0.0):  # fmt: skip
    """A row of discs; no mass: driven."""
    light = 1.0 / mass if mass else 0.0
    row = [0.0] * DISC_COLUMNS
    row[:5] = radius, light, light / (gyration * radius) ** 2, decel, delta
    row[TANGENTIAL], row[FRICTION] = tangential, grip
    row[DRAG + SLIDING], row[DRAG + SPINNING], row[DRAG + QUADRATIC] = damping, spin_damping, wake
    return row


def wall(nx, ny, place, grip=0.0):
    return [WALL, nx, ny, place, 0.0, 0.0, grip, 0.0, 0.0, 0.0]


def post(x, y, radius, grip=0.0):
    return [POST, x, y, radius, 0.0, 0.0, grip, 0.0, 0.0, 0.0]


def arc(x, y, radius, first, span, grip=0.0):
    return [ARC, x, y, radius, 0.0, 0.0, grip, first, span]


def padded(obstacles):
    """Rows of what stands, with what a wall without ends and a round one leave out."""
    rows = np.zeros((len(obstacles), OBSTACLE_COLUMNS))
    for row, given in zip(rows, obstacles, strict=True):
        row[: len(given)] = given
    return rows


def group_of(discs, obstacles=(), pull=(0.0, 0.0), films=None, cuts=None):
    """``films``: of discs that are driven, number: rows (k, 21)."""
    discs = np.array(discs).reshape(-1, DISC_COLUMNS)
    discs[:, [PULL_X, PULL_Y]] = np.where(discs[:, 1:2] > 0.0, pull, 0.0)
    discs[:, REGION] = np.arange(len(discs))
    mass = np.where(discs[:, 1] > 0.0, 1.0 / np.where(discs[:, 1] > 0.0, discs[:, 1], 1.0), 0.0)
    rows, reels = [np.zeros((0, PIECE_COLUMNS))], np.zeros((len(discs), 2), np.int64)
    for number, film in (films or {}).items():
        first = sum(map(len, rows))
        rows.append(np.asarray(film))
        reels[number] = first, first + len(film)
    if cuts is None:
        cuts = np.zeros((len(discs), *NO_SECTION.shape))
    regions = Regions(
        mass * discs[:, 3], discs[:, 4].copy(), cuts, NO_LAW, np.zeros(len(discs), np.bool_),
        NO_FLOOR_MAP, np.zeros((len(discs), 2), np.int64),
    )  # fmt: skip
    read = {
        "discs": discs, "obstacles": padded(obstacles), "regions": regions,
        "surface": Surface(*[0.0] * 9, 1.0), "rims": np.zeros(1), "pieces": np.vstack(rows),
        "drives": reels, "forcing": np.zeros((0, 4)),
        "spans": np.zeros((len(discs), 2), np.int64),
    }  # fmt: skip
    return Engine(**dict.fromkeys(Engine._fields, np.zeros(0)) | read)


def pull_of(group):
    """The acceleration down the slope, of all that can move."""
    return group.discs[group.discs[:, 1] > 0.0][0, [PULL_X, PULL_Y]]


class Ride:
    """A motion through all its events: ``times``, ``hows``, pieces of each member, the ledger."""

    def __init__(self, group, states, contacts, t_end, tol=1e-12, members=None, scales=None,
                 rooms=4000, most=60):  # fmt: skip
        self.group, self.states = group, np.array(states, float)
        self.members = np.arange(len(group.discs)) if members is None else np.array(members)
        contacts = np.array(contacts, np.int64).reshape(-1, 2)
        if scales is None:
            r = group.discs[:, 0]
            speed = np.sqrt(
                self.states[:, 3] ** 2 + self.states[:, 4] ** 2 + (r * self.states[:, 5]) ** 2
            ).max()
            pulls = np.hypot(group.discs[:, PULL_X], group.discs[:, PULL_Y])
            rate = max(group.discs[:, 3].max(), pulls.max())
            rate = rate if rate > 0.0 else speed**2 / r.min()
            scales = Scales(speed if speed > 0.0 else np.sqrt(rate * r.max()), rate, tol)
        buffer = buffer_for(len(self.members), len(contacts))
        self.ledger, self.t = np.zeros(LEDGER), 0.0
        self.hows, self.times, self.rows, self.starts = [], [], [], [self.states.copy()]
        self.modes_then, self.doings_then, self.pushes_then = [], [], []
        while self.t < t_end and len(self.hows) < most:
            modes = np.zeros(len(contacts), np.int64)
            motions = np.zeros(len(self.members), np.int64)
            status = press(
                group, self.members, contacts, self.states, self.t, scales, modes, motions,
                self.ledger, buffer,
            )  # fmt: skip
            assert status == 0
            kept = modes != APART
            self.pushes_then.append(buffer.pushes[: len(contacts)].copy())
            self.buffer = buffer
            contacts, modes = contacts[kept], modes[kept]
            self.modes_then.append(modes.copy())
            self.doings_then.append(motions.copy())
            if (motions == HELD).all():
                break
            pieces = np.zeros((len(self.members), rooms, PIECE_COLUMNS))
            work_rows = np.zeros((rooms, WORK_COLUMNS))
            how, which, self.t, count = follow(
                group, self.members, contacts, self.states, self.t, t_end, scales, modes, motions,
                pieces, work_rows, buffer,
            )  # fmt: skip
            self.ledger += work_rows[:count, DONE : DONE + LEDGER].sum(axis=0)
            self.hows.append((how, which))
            self.times.append(self.t)
            self.rows.append(pieces[:, :count].copy())
            self.starts.append(self.states.copy())
        self.contacts = contacts
        self.pieces = np.concatenate(self.rows, axis=1) if self.rows else None

    def energy(self, states):
        d, total = self.group.discs, 0.0
        for i in self.members:
            if d[i, 1] > 0.0:
                total += 0.5 * (states[i, 3] ** 2 + states[i, 4] ** 2) / d[i, 1]
                total += 0.5 * states[i, 5] ** 2 / d[i, 2]
        return total

    def residual(self):
        """What the ledger misses."""
        floor, rim, drag, pull, drive, support = self.ledger[:6]
        return (
            self.energy(self.starts[0]) + pull + drive + support - floor - rim - drag
            - self.energy(self.states)
        )  # fmt: skip


def film_of(path, times):
    """A film of a motion t → (q, q′, q″)."""
    rows = []
    for a, b in pairwise(times):
        first, last = path(a), path(b)
        rows.append(np.concatenate([[a, b - a], *first, *last]))
    return np.array(rows)


def judged_discs(group):
    """Discs as the judge reads them."""
    rows = []
    for d in group.discs:
        mass, inertia = (1.0 / d[1], 1.0 / d[2]) if d[1] > 0.0 else (1.0, 1.0)
        rows.append(
            [d[0], mass, inertia, d[3], *d[[DRAG + n for n in (SLIDING, SPINNING, QUADRATIC)]]]
        )
    return rows


def cluster(rng, count):
    """Radii, places and contacts of discs of which each touches others, the first a wall y = 0."""
    radii = rng.uniform(0.03, 0.06, count) if rng.random() < 0.5 else np.full(count, 0.05)
    places, contacts = [np.array([0.0, radii[0]])], [(0, -1)]
    while len(places) < count:
        k, a, b = len(places), int(rng.integers(len(places))), int(rng.integers(len(places)))
        angle = rng.uniform(0.0, 2.0 * np.pi)
        trials = [places[a] + (radii[a] + radii[k]) * np.array([np.cos(angle), np.sin(angle)])]
        d = places[b] - places[a]
        size, one, two = np.hypot(*d), radii[a] + radii[k], radii[b] + radii[k]
        if 0.0 < size < one + two and rng.random() < 0.6:  # between two
            along = (one * one - two * two + size * size) / (2.0 * size)
            if abs(along) < one:
                side = np.array([-d[1], d[0]]) / size * np.sqrt(one * one - along * along)
                trials.insert(0, places[a] + d / size * along + side)
        for p in trials:
            gaps = [np.hypot(*(p - q)) - r - radii[k] for q, r in zip(places, radii, strict=False)]
            if min(gaps) > -1e-13 and p[1] > radii[k]:
                contacts += [(i, k) for i, gap in enumerate(gaps) if gap < 1e-12]
                places.append(p)
                break
    return radii, np.array(places), contacts


def without_approach(group, states, contacts):
    """The same states with the least change of velocities that takes what approaches away."""
    states, rows = np.array(states, float), []
    weights = np.column_stack([group.discs[:, 1], group.discs[:, 1], group.discs[:, 2]]).ravel()
    for i, j in contacts:
        row = np.zeros((len(states), 3))
        n = -group.obstacles[-1 - j, 1:3] if j < 0 else states[j, :2] - states[i, :2]
        n = n / np.hypot(*n)
        row[i, :2] = n
        if j >= 0:
            row[j, :2] = -n
        rows.append(row.ravel())
    rows, v = np.array(rows), states[:, 3:].ravel()
    forces = np.linalg.lstsq((rows * weights) @ rows.T, rows @ v, rcond=1e-12)[0]
    states[:, 3:] = (v - weights * (rows.T @ forces)).reshape(-1, 3)
    return states
