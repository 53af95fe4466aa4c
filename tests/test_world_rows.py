"""Rows of launches: velocities, spins and places that go together, of one of several pucks."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest

import puck_tables as pt
from puck_tables.scene.library import as_toml

VELOCITIES = [[1.0, 0.0], [1.2, 0.1], [0.8, -0.05]]
SPINS = [0.0, 5.0, -9.0]
RED = pt.Puck(0.03, friction=0.2, name="red", launch=pt.Launch(position=(0.3, 0.01)))


def cue(velocity: object, spin: object = 0.0, **more: object) -> pt.Puck:
    return pt.Puck(0.03, friction=0.2, name="cue", launch=pt.Launch(velocity, spin, **more))


def test_rows_go_one_by_one_to_the_bit():
    ends = pt.Scene(pucks=[cue(VELOCITIES, SPINS), RED]).sweep()
    assert ends.x.shape == (3, 2)
    for n, (velocity, spin) in enumerate(zip(VELOCITIES, SPINS, strict=True)):
        run = pt.Scene(pucks=[cue(velocity, spin), RED]).simulate()
        assert run.last["x"].tolist() == ends.x[n].tolist()
    assert len(set(ends["red"]["x"].tolist())) == 3
    data = ends.to_xarray()
    assert data.puck_0_launch_spin.values.tolist() == SPINS
    assert data.x.dims == ("puck_0_launch", "puck")


def test_rows_of_places_and_ranges_of_others_are_a_product():
    places = [[0.0, 0.0], [0.0, 0.01], [0.02, 0.0]]
    scene = pt.Scene(
        pucks=[cue(VELOCITIES, position=places), RED], ranges={"puck[1].friction": [0.1, 0.3]}
    )
    ends = scene.sweep()
    one = pt.Scene(pucks=[
        cue(VELOCITIES[1], position=places[1]),
        pt.Puck(0.03, friction=0.3, name="red", launch=pt.Launch(position=(0.3, 0.01))),
    ]).simulate()  # fmt: skip
    assert ends.x.shape == (3, 2, 2)
    assert ends.x[1, 1].tolist() == one.last["x"].tolist()
    assert pt.Scene.from_tables(tomllib.loads(as_toml(scene))) == scene


def test_thousands_of_rows_are_an_array():
    rows = np.random.default_rng(0).normal(size=(3000, 2))
    ends = pt.Scene(pucks=[cue(rows, np.linspace(-9.0, 9.0, 3000)), RED]).sweep()
    assert np.isfinite(ends.x).all()
    assert (ends["red"]["x"] != 0.3).sum() > 10


def test_rows_of_two_pucks_are_refused_by_name():
    other = pt.Puck(0.03, friction=0.1, launch=pt.Launch(VELOCITIES, position=(0.9, 0.9)))
    with pytest.raises(pt.InputError, match=r"puck\[0\]\.launch\.velocity, puck\[1\].*of one puck"):
        pt.Scene(pucks=[cue(VELOCITIES), other])


def test_rows_of_different_lengths_are_refused():
    with pytest.raises(pt.InputError, match="2 values for 3 launches"):
        pt.Scene(pucks=[cue(VELOCITIES, [0.0, 1.0]), RED])
