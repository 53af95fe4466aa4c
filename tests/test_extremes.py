"""Arguments pushed to their ends, each with a stated bound; the rows stand in extremes.py."""

from __future__ import annotations

import math

import numpy as np
import pytest
from extremes import ROWS, Row
from pucks import simulate

import puck_tables as pt
from puck_tables.errors import AccuracyError, ContactError, InputError


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.name)
def test_within_the_bound(row: Row):
    assert row.measure() <= row.bound


def test_a_row_that_is_wrong_is_found_out(monkeypatch: pytest.MonkeyPatch):
    """The judges judge: a resultant that is off by 2e-14, a stop by 1e-9, a NaN."""
    rows = {row.name: row for row in ROWS}
    true_resultants, true_stop = pt.resultants, pt.stop
    special = rows["resultants_next_to_the_special_angles"]
    for spoil in (2e-14, math.nan):

        def spoilt(phi, delta, by=spoil):
            rho = true_resultants(phi, delta)
            return rho._replace(spin=rho.spin + np.where(np.abs(phi) < 1e-299, by, 0.0))

        monkeypatch.setattr(pt, "resultants", spoilt)
        assert special.measure() > special.bound

    class Late:
        def __init__(self, *given, **named):
            found = true_stop(*given, **named)
            self.stop_time, self.stop_position = found.stop_time + 1e-9, found.stop_position

    monkeypatch.setattr(pt, "stop", Late)
    edges = rows["launches_on_the_edges_of_cells"]
    assert edges.measure() > edges.bound


def test_resultants_at_and_below_the_smallest_double():
    """Denormal φ cannot be told from 0: (4 − δ²)/8."""
    for delta in (0.0, 1.0):
        ends = pt.resultants([5e-324, -5e-324, 1e-310], delta)
        assert ends.spin.tolist() == pytest.approx([(4 - delta**2) / 8] * 3, abs=1e-15)


def test_beyond_the_ends_there_is_a_sentence():
    critical = float(pt.contact.critical_delta(0.3))
    with pytest.raises(ContactError, match="part of the base is lifted"):
        pt.resultants(0.3, critical * (1.0 + 1e-9))
    for delta in (4.0, math.nextafter(4.0, 5.0), 1e70):
        with pytest.raises(ContactError, match="tips over"):
            pt.contact.one_sided_resultants(0.3, delta)
    with pytest.raises(AccuracyError, match=r"up to delta = 3\.9999 it is"):
        pt.contact.one_sided_resultants(0.3, math.nextafter(4.0, 0.0))
    for motion in (
        {"velocity": (1e160, 0.0), "spin": 0.0},
        {"velocity": (1.0, 0.0), "spin": 1e308, "radius": 1e9},
    ):
        with pytest.raises(InputError, match="too large for floating point"):
            simulate(**motion)
        with pytest.raises(InputError, match="too large for floating point"):
            pt.states(**motion, time=1.0)
        stops = pt.stop(**motion)
        assert (stops.status == 2).all()
        assert np.isnan(stops.stop_time).all()
    with pytest.raises(InputError, match="too large for floating point"):
        simulate((1e100, 0.0), 0.0, mass=1e150)


def test_places_too_small_for_floating_point_are_zero():
    """Q²/J under 5e-324 rounds to 0; times and speeds keep their digits."""
    for speed in (1e-170, 1e-290):
        found, run = pt.stop((speed, 0.0), speed), simulate((speed, 0.0), speed)
        base = pt.stop((1.0, 0.0), 1.0)
        assert float(found.stop_time) / speed == pytest.approx(float(base.stop_time), rel=1e-14)
        assert run.stop_time / speed == pytest.approx(float(base.stop_time), abs=1e-8)
        assert found.stop_position.tolist() == [0.0, 0.0]
        assert run.stop_position == (0.0, 0.0)
        assert np.isfinite([run.energy_residual, run.turn_angle, run.body_angle]).all()


def test_no_jump_where_one_cell_meets_the_next():
    table = pt.Table.shipped("stops")
    from puck_tables.stopping.stop_check import looked_up

    ratio = table.axis.ratio()[1::9]
    u = np.concatenate([np.log(ratio), -np.log(ratio)])
    delta = np.linspace(0.0, 1.0, u.size)
    below, above = (looked_up(table, np.nextafter(u, s * np.inf), delta) for s in (-1, 1))
    assert np.abs(above - below).max() <= 2e-15
