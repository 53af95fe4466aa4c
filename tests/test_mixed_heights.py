"""Ranges of heights in which some pucks are plain and others are not: each height its solver."""

from __future__ import annotations

import numpy as np
import pytest
from any_puck import stops_by_truth
from commands import invoke
from pucks import sweep

from puck_tables import Puck, Table, states, stop
from puck_tables.contact.laws import HOMOGENEOUS
from puck_tables.errors import InputError

COLUMNS = ("stop_time", "stop_x", "stop_y", "path_length", "turn_angle", "body_angle")


def columns(stops) -> np.ndarray:
    """All six outputs of ``stop``."""
    rest = (stops.path_length, stops.turn_angle, stops.body_angle)
    return np.stack([stops.stop_time, *np.moveaxis(stops.stop_position, -1, 0), *rest])


def test_plain_heights_keep_every_bit_in_a_mixed_range():
    delta = np.linspace(0.0, 1.1, 1000)
    rng = np.random.default_rng(5)
    delta[90 * np.arange(11)] = delta[-11:]  # not in order, and not all at one end
    velocity, spin = rng.normal(size=(1000, 2)), rng.normal(size=1000)
    rare = np.unique(delta[delta > 1.0])[::20]  # few, so that the test is quick
    keep = (delta <= 1.0) | np.isin(delta, rare)
    delta, velocity, spin = delta[keep], velocity[keep], spin[keep]
    mixed = columns(stop(velocity, spin, delta=delta))
    plain = delta <= 1.0
    assert 0 < np.count_nonzero(~plain) < 20
    np.testing.assert_array_equal(
        mixed[:, plain], columns(stop(velocity[plain], spin[plain], delta=delta[plain]))
    )
    for n in np.flatnonzero(~plain):
        alone = columns(stop(velocity[n], spin[n], delta=delta[n]))
        size = np.hypot(np.hypot(*velocity[n]), spin[n])
        assert np.abs(mixed[:3, n] - alone[:3]).max() <= 2e-8 * max(size, size**2)


def test_it_says_what_was_taken_for_how_many():
    found = stop((1.0, 0.0), 1.0, delta=[0.2, 1.5, 0.7, 1.0])
    assert found.method == "look-up and integrated"
    assert [one.scheme.name for one in found.selections] == ["look-up", "adaptive, section"]
    text = found.explain()
    assert "3 of 4 launches, of heights delta <= 1:" in text
    assert "1 of 4 launches, of heights above:" in text
    many = stop((1.0, 0.0), np.linspace(0.0, 4.0, 300)[:, None], delta=[0.5, 1.5], tol=1e-5)
    assert many.method == "look-up"
    assert [one.scheme.name for one in many.selections] == ["look-up", "look-up, section"]
    plain = stop((1.0, 0.0), 1.0, delta=[0.2, 0.7])
    assert "of heights" not in plain.explain()


@pytest.mark.thorough
def test_stops_of_a_mixed_range_by_truth():
    delta = np.array([0.6, 1.3, 0.9, 2.0])
    found = columns(stop((np.cos(0.7), 0.0), np.sin(0.7), delta=delta))
    for n, height in enumerate(delta):
        truth = stops_by_truth("uniform", height, HOMOGENEOUS, np.log(np.tan([0.7])))[:3, 0]
        assert np.abs(found[:3, n] - truth).max() <= 1e-8


def test_only_heights_that_need_preparation_are_counted():
    assert stop((1.0, 0.0), 1.0, delta=np.linspace(0.0, 1.0, 3000)).method == "look-up"
    with pytest.raises(InputError, match="501 different delta are too many"):
        stop((1.0, 0.0), 1.0, delta=[*np.linspace(0.0, 1.0, 600), *np.linspace(1.1, 3.0, 501)])
    with pytest.raises(InputError, match="501 different delta are too many"):
        states((1.0, 0.0), 1.0, 0.5, delta=np.linspace(1.1, 3.0, 501))


def test_a_mixed_map_is_the_stops_of_its_launches():
    spins, delta = np.linspace(-2.0, 2.0, 7), np.array([1.4, 0.3, 1.0, 0.3])
    made = sweep(spins, [0.5, 1.0], delta=delta, tol=1e-6)
    alone = sweep(spins, [0.5, 1.0], delta=delta[1:], tol=1e-6)
    for name in COLUMNS:
        np.testing.assert_array_equal(getattr(made, name)[1:], getattr(alone, name))
    cut = sweep(spins, [0.5, 1.0], delta=delta, tol=1e-6, chunk=3)
    for name in COLUMNS:
        np.testing.assert_array_equal(getattr(made, name), getattr(cut, name))
    said = invoke("sweep", "--w0", "1", "--delta", "0.9:1.1:3", "--explain", "--tol", "1e-5")
    assert said.exit_code == 0
    assert "2 of 3 launches, of heights delta <= 1:" in said.stderr


def test_states_of_mixed_heights():
    delta, times = np.array([0.4, 1.3, 0.8, 1.3]), np.linspace(0.0, 2.0, 5)
    velocity = np.array([[1.0, 0.2], [0.5, 0.0], [0.0, 0.0], [0.9, -0.4]])
    spin = np.array([1.0, -2.0, 0.5, 0.0])
    found = states(velocity[:, None, :], spin[:, None], times, delta=delta[:, None])
    assert found.explain().startswith("2 pucks looked up and 2 pucks integrated")
    for n in range(4):
        alone = states(velocity[n], spin[n], times, delta=delta[n])
        for name in ("x", "y", "heading", "orientation", "speed", "spin"):
            np.testing.assert_array_equal(getattr(found, name)[n], getattr(alone, name))
    run = Puck.similar(delta=1.3).simulate(velocity[1], spin[1], times=times)
    assert np.abs(run.x - found.x[1]).max() <= 2e-9


def test_a_table_that_is_given_keeps_its_range():
    for table in (Table.shipped(), Table.shipped("stops")):
        with pytest.raises(InputError, match="outside this table"):
            stop((1.0, 0.0), 1.0, delta=[0.5, 1.5], table=table)
    with pytest.raises(InputError, match="outside this table"):
        states((1.0, 0.0), 1.0, 0.5, delta=[0.5, 1.5], table=Table.shipped("stops"))
    with pytest.raises(InputError, match="homogeneous puck under uniform pressure"):
        stop((1.0, 0.0), 1.0, pressure="ring", table=Table.shipped("stops"))
