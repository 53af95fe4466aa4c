"""A small table of every kind, for the tests that hold for all of them."""

from __future__ import annotations

from functools import cache

import numpy as np

from puck_tables import SpeedLaw, Table, profile_law

LAW = SpeedLaw([0.0, 0.5, 2.0], [0.3, 0.2, 0.25])
KINDS = ("resultants", "washer", "profile", "stops", "speed", "section", "stop section")


@cache
def small(kind: str) -> Table:
    """A coarse table; by name: its kind, or resultants under a law."""
    if kind == "speed":
        return Table.build(LAW, 1e-3)
    if kind == "profile":
        law = profile_law([0.0, 0.5, 1.0], [1.0, 2.0, 0.5], name="stone.csv")
        return Table.build(law, cells=12)
    if kind == "section":
        return Table.build(("uniform", 2.0), 1e-5)
    if kind == "stop section":
        return Table.build(("hertz", 0.5, 0.8), 1e-5)
    if kind == "washer":
        return Table.build("annulus:0.8", cells=12)
    return Table.build("stops", cells=16) if kind == "stops" else Table.build(accuracy=1e-6)


def answers(table: Table) -> np.ndarray:
    """What a table says at fixed places of its range."""
    rng = np.random.default_rng(5)
    phi = np.concatenate([rng.uniform(0.0, 1.5707, 3000), [0.0, 0.25 * np.pi]])
    share = rng.random(phi.size)
    if table.kind == "stops":
        rim, one = np.tan(phi), np.ones(phi.size)
        launches = np.stack([np.cos(phi), 0.0 * one, np.sin(phi), share, one, one])
        from puck_tables.stopping.launch_arrays import launches_in

        time, place, _, _ = table.stops(launches_in(launches))
        known = table.known(launches)[3:6] + 0.0 * rim
        return np.concatenate([time[None], place.T, known])
    if table.kind == "stop section":
        c, s = np.cos(phi), np.sin(phi)
        return table.spline.at(phi).T * np.stack([np.ones_like(c), c, s * c, c, s, s])
    if table.kind == "friction section":
        return table.ratios(phi).T
    if table.kind == "speed":
        return np.stack(table.resultants(phi, table.top * share / np.sqrt(2.0), 0.5))
    return np.stack(table.resultants(phi, table.delta_max * share))
