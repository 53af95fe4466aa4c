"""Groups of discs for the tests of sustained contacts, and the whole of a motion through events."""

from __future__ import annotations

import numpy as np

from puck_tables.contact.laws import law_of
from puck_tables.scene.ingredients import Regions
from puck_tables.scene.regions import NO_LAW
from puck_tables.world.group import (
    LEDGER,
    APART,
    HELD,
    Group,
    Scales,
    desk_for,
)
from puck_tables.world.layout import DISC_COLUMNS, OBSTACLE_COLUMNS, POST, WALL, ARC
from puck_tables.world.paths import PIECE_COLUMNS
from puck_tables.world.pressing import press
from puck_tables.world.pushing import follow


def disc(radius=0.05, mass=0.2, decel=1.0, delta=0.0, grip=0.0, gyration=0.5**0.5, damping=0.0,
         spin_damping=0.0, wake=0.0, tangential=0.0):  # fmt: skip
    """A row of discs; no mass: driven."""
    light = 1.0 / mass if mass else 0.0
    return [
        radius, light, light / (gyration * radius) ** 2, decel, delta, damping, spin_damping, wake,
        0.0, tangential, grip,
    ]  # fmt: skip


def wall(nx, ny, place, grip=0.0):
    return [WALL, nx, ny, place, 0.0, 0.0, grip, 0.0, 0.0]


def post(x, y, radius, grip=0.0):
    return [POST, x, y, radius, 0.0, 0.0, grip, 0.0, 0.0]


def arc(x, y, radius, first, span, grip=0.0):
    return [ARC, x, y, radius, 0.0, 0.0, grip, first, span]


def group_of(discs, obstacles=(), pull=(0.0, 0.0), films=None, cuts=None):
    """``films``: of discs that are driven, number: rows (k, 21)."""
    discs = np.array(discs).reshape(-1, DISC_COLUMNS)
    mass = np.where(discs[:, 1] > 0.0, 1.0 / np.where(discs[:, 1] > 0.0, discs[:, 1], 1.0), 0.0)
    rows, reels = [np.zeros((0, PIECE_COLUMNS))], np.zeros((len(discs), 2), np.int64)
    for number, film in (films or {}).items():
        first = sum(map(len, rows))
        rows.append(np.asarray(film))
        reels[number] = first, first + len(film)
    if cuts is None:
        cuts = np.zeros((len(discs), 0))
    return Group(
        discs, np.array(obstacles, float).reshape(-1, OBSTACLE_COLUMNS),
        Regions(mass * discs[:, 3], discs[:, 4].copy(), cuts, NO_LAW), np.vstack(rows), reels, float(pull[0]), float(pull[1]),
    )  # fmt: skip


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
            rate = max(group.discs[:, 3].max(), np.hypot(group.gx, group.gy))
            scales = Scales(speed if speed > 0.0 else np.sqrt(rate * r.max()), rate, tol)
        desk = desk_for(len(self.members), len(contacts))
        self.ledger, self.t = np.zeros(LEDGER), 0.0
        self.hows, self.times, self.rows, self.starts = [], [], [], [self.states.copy()]
        self.modes_then, self.doings_then, self.pushes_then = [], [], []
        while self.t < t_end and len(self.hows) < most:
            modes = np.zeros(len(contacts), np.int64)
            doings = np.zeros(len(self.members), np.int64)
            status = press(
                group, self.members, contacts, self.states, self.t, scales, modes, doings,
                self.ledger, desk,
            )  # fmt: skip
            assert status == 0
            kept = modes != APART
            self.pushes_then.append(desk.pushes[: len(contacts)].copy())
            self.desk = desk
            contacts, modes = contacts[kept], modes[kept]
            self.modes_then.append(modes.copy())
            self.doings_then.append(doings.copy())
            if (doings == HELD).all():
                break
            pieces = np.zeros((len(self.members), rooms, PIECE_COLUMNS))
            how, which, self.t, count = follow(
                group, self.members, contacts, self.states, self.t, t_end, scales, modes, doings,
                pieces, self.ledger, desk,
            )  # fmt: skip
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
        floor, rim, drag, pull, drive = self.ledger
        return (
            self.energy(self.starts[0]) + pull + drive - floor - rim - drag
            - self.energy(self.states)
        )  # fmt: skip
