"""Look-ups in compiled code stay within their tables, whatever the floats they get."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest
from rarely import nightly, thorough

from puck_tables import SpeedLaw, Table
from puck_tables.contact.laws import law_of
from puck_tables.kernels.compile import kernel
from puck_tables.kernels.quadratic import (
    cell_at,
    fill_resultants,
    fill_section,
    room_for_section,
    section_at,
)
from puck_tables.kernels.speed_spline import fill_speed
from puck_tables.motion.body import body_of
from puck_tables.stopping.launch_arrays import launches_in
from puck_tables.stopping.launch_lookup import fill_launch_lookup
from puck_tables.stopping.lookup import stops_kernel
from puck_tables.stopping.similarity_lookup import LAUNCH_COLUMNS, LAUNCH_ROWS
from puck_tables.stopping.state_lookup import PUCK_ROWS, fill_states_at
from puck_tables.stopping.stop_section import fill_section_stops
from puck_tables.table.friction_section import friction_section
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.tradeoff.resultant_methods import fill_bicubic, graded_coefficients

WILD = np.array([
    np.nan, -np.nan, np.inf, -np.inf, 1e308, -1e308, 1e19, -1e19, 5e9, -5e9, -1.0, -5e-324, 0.0,
    0.5, 1.0, 1.0000001, 2.0, 1e3,
])  # fmt: skip


def test_every_float_has_a_cell():
    @kernel
    def cells(places: np.ndarray, count: int, out: np.ndarray) -> None:
        for n in range(places.size):
            out[n] = cell_at(places[n], count)

    out = np.empty(WILD.size, np.int64)
    cells(WILD, 7, out)
    good = np.clip(np.nan_to_num(WILD), 0, 6).astype(int)
    np.testing.assert_array_equal(out, good)


def look_up_everything() -> None:
    """All look-ups at all pairs of wild numbers, and in tables of wild numbers."""
    first, second = (axis.ravel().copy() for axis in np.meshgrid(WILD, WILD))
    n = first.size
    out, out4, out6 = np.empty((3, n)), np.empty((4, n)), np.empty((6, n))
    fast = np.arange(n) % 2 == 0
    table, stops = Table.shipped(), Table.shipped("stops")
    for law in (law_of("uniform"), law_of("annulus:0.5")):
        small = ResultantTable.tabulated(law, 8)
        sides, columns = np.array(small.axis.sides), small.columns
        for c in (columns, np.random.default_rng(1).choice(WILD, columns.shape)):
            fill_resultants(c, sides, first, second, out)
            for height in WILD:
                section_at(c, height, room_for_section(c))
    wild = np.random.default_rng(1).choice(WILD, (2, 11, 19, 3))
    for c in (graded_coefficients(table), wild):
        fill_bicubic(c, 1.0, first, second, out)
    speeds = Table.build(SpeedLaw([0.0, 0.5, 2.0], [0.3, 0.2, 0.25]), 1e-2)
    wild_table = speeds.compiled.copy()
    places = wild_table[1:]
    places[places.size // 2 :] = np.random.default_rng(6).choice(
        WILD, places.size - places.size // 2
    )
    for c in (speeds.compiled, wild_table):
        fill_speed(c, first, fast, second, out4)
    piece = friction_section(law_of("uniform"), 0.5, 1e-4).spline
    hostile = np.where(
        np.random.default_rng(3).random(piece.coefficients.shape) < 0.5, 1e308, piece.coefficients
    )
    for c in (piece.coefficients, hostile):
        fill_section(c, 3, first, fast, out)
    one = np.ones(n)
    for launches in (
        np.stack([first, second, 0.0 * one, 0.5 * one, one, one]),
        np.stack([first, 0.0 * one, second, 0.5 * one, one, one]),
        np.stack([one, one, one, first, second, one]),
        np.stack([one, one, one, 0.5 * one, first, second]),
    ):  # fmt: skip
        for powers in (4, 8):
            given = launches_in(launches).part(0, n)
            stops_kernel(powers)(*given, stops.thinned(powers, 1), *out, 1)
        for rows in (PUCK_ROWS, 3):
            fill_launch_lookup(
                *given, stops.thinned(), stops.launch_coefficients, stops.turn_coefficients,
                stops.constants, 1e-3, np.empty((rows, n)),
            )  # fmt: skip
        fill_section_stops(launches, body_stops(), 2.0, out6)
        pucks = np.ones((PUCK_ROWS, n))
        pucks[LAUNCH_COLUMNS:] = np.random.default_rng(4).choice(WILD, (LAUNCH_ROWS, n))
        fill_states_at(pucks, np.arange(n), np.abs(first), 0, n, stops.state_coefficients, out6)


def body_stops() -> np.ndarray:
    from puck_tables.stopping.stop_section import stop_section_for

    return stop_section_for(body_of(law_of("uniform"), 0.5, 0.9), 1e-4).spline.coefficients


@pytest.mark.parametrize(
    "environment", [thorough({}), nightly({"NUMBA_BOUNDSCHECK": "1", "NUMBA_DISABLE_JIT": "0"})]
)
def test_no_look_up_leaves_its_table(environment: dict[str, str]):
    """The second time with numba's test of every index, which raises."""
    code = "import test_index_guards as t; t.look_up_everything()"
    ended = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": os.path.dirname(__file__), **environment},
    )  # fmt: skip
    assert ended.returncode == 0, ended.stderr[-2000:]
