"""Constants on which a promised error rests: twice as coarse, and the test that judges it fails.

Each is made coarser in a copy of the package, where kernels run as they are written.  Where a
factor of two changes nothing that is promised, the step to the one that does is larger.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest
from conftest import ROOT

# file, constant, as it is made coarser, the test that fails then
RESTS_ON = [
    ("contact/closed_form", "AGM_STEPS = 8", "4", "test_contact.py::test_uncompiled_closed_form"),
    ("contact/loaded_chord", "_LINE_NODES = 81", "41", "test_partial.py::test_against_strips"),
    ("contact/loaded_chord", "_SEGMENT_NODES = 20", "10",
     "test_partial.py::test_segment_and_patch_rule"),
    ("contact/quadrature", "_GAUSS_NODES = 14", "7", "test_contact.py::test_quadrature"),
    ("contact/quadrature", "_PANELS = 32", "4", "test_contact.py::test_quadrature"),
    ("contact/speed_quadrature", "_GAUSS_NODES = 12", "6",
     "test_speed_friction.py::test_a_constant_coefficient_gives_the_closed_forms"),
    ("contact/superposition", "_COUNT = 41", "21",
     "test_laws.py::test_a_profile_is_its_rings_by_elliptic_integrals"),
    ("fitting/forward_model", "_MOMENTS, _DRAGGED = 129, 1e-8", "65, 1e-8",
     "test_fit_drag.py::test_a_slide_with_drag_is_elementary"),
    ("fitting/speed_motion", "_STEP, _LARGEST, _STEPS = 0.08, 0.32, 440", "0.16, 0.64, 440",
     "test_fit_drag.py::test_motions_are_those_of_an_independent_integrator"),
    ("fitting/unit_motions", "HEIGHT_STEP = 0.05", "0.1",
     "test_fit.py::test_motions_between_the_heights_of_tall_pucks_are_those_of_the_puck"),
    ("kernels/base_boundary", "_NODES = 16", "4",
     "test_base_directions.py::test_friction_is_that_of_points_over_the_base"),
    ("kernels/closed_form_kernel", "_FEW_STEPS = 4", "2",
     "test_contact.py::test_compiled_resultants"),
    ("kernels/elliptic_sums", "_COUNT = 14", "7",
     "test_orthotropic.py::test_resultants_are_those_of_a_grid_over_the_base"),
    ("kernels/law_far_sums", "_RAY = 5", "2",
     "test_base_scenes.py::test_where_it_turns_far_away_a_disc_or_half_of_it_is_what_points_sum"),
    ("kernels/law_panels", "_AROUND = 20", "10",
     "test_base_scenes.py::test_where_it_turns_far_away_a_disc_or_half_of_it_is_what_points_sum"),
    ("kernels/law_panels", "_FAR_ARC = 1.3", "2.6",
     "test_base_scenes.py::test_where_it_turns_far_away_a_disc_or_half_of_it_is_what_points_sum"),
    ("kernels/law_panels", "NODES = 8", "4",
     "test_base_scenes.py::test_a_law_is_integrated_as_exactly_as_a_constant"),
    ("kernels/law_panels", "ARC = 0.9", "1.8",
     "test_base_scenes.py::test_a_law_is_integrated_as_exactly_as_a_constant"),
    ("kernels/law_panels", "_GROWTH = 1.0", "3.0",
     "test_speed_and_direction.py::test_sums_are_those_of_points_on_rays"),
    ("kernels/polygon_sums", "_ARC_NODES = 16", "8",
     "test_astride_friction.py::test_strips_against_scans"),
    ("kernels/polygon_sums", "FAR = 6.0", "1.5",
     "test_base_motion.py::test_friction_is_that_of_the_judge"),
    ("kernels/polygon_sums", "NODES = 8", "4",
     "test_base_motion.py::test_friction_is_that_of_the_judge"),
    ("kernels/round_paths", "_COUNTS, _REACHES = np.array([10, 16,", "np.array([5, 8,",
     "test_astride_pressure.py::test_resultants_against_circles"),
    ("kernels/speed_quadrature_kernel", "_RULES = (14, 8, 5, 12, 7, 5)", "(7, 4, 3, 6, 4, 3)",
     "test_speed_friction.py::test_the_compiled_integrals_are_those_of_numpy"),
    ("stopping/lookup", "CONSTANT_HEIGHTS = 14", "9",
     "test_similarity.py::test_polynomials_of_the_height_are_as_exact_as_they_say"),
    ("stopping/lookup", "HEIGHTS = 9", "5",
     "test_similarity.py::test_polynomials_of_the_height_are_as_exact_as_they_say"),
    ("stopping/similarity", "_DEGREE = 23", "11",
     "test_similarity.py::test_regular_slopes_pass_the_limit_smoothly"),
    ("stopping/similarity", "_NEAR_LIMIT = 0.15", "0.3",
     "test_similarity.py::test_regular_slopes_pass_the_limit_smoothly"),
    ("stopping/similarity", "_COUNT = 10", "5",
     "test_similarity.py::test_parts_are_the_integrals_of_their_slopes"),
    ("table/slip_spline", "GRADING_POWER = 4", "2",
     "test_resultant_table.py::test_order_4_through_every_singular_line"),
]  # fmt: skip


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The package and its tests, to be changed."""
    folder = tmp_path_factory.mktemp("copy")
    for name in ("puck_tables", "cli", "tables", "tests"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", folder)
    return folder


def run(folder: Path, tests: Sequence[str]) -> subprocess.CompletedProcess[str]:
    """Tests of a copy, kernels as they are written."""
    env = dict(
        os.environ, NUMBA_DISABLE_JIT="1", PYTHONPATH=str(folder), PYTHONDONTWRITEBYTECODE="1",
        XDG_CACHE_HOME=str(folder / "cache"),
    )  # fmt: skip
    command = [
        sys.executable, "-m", "pytest", "-q", "-x", "-n0", "-p", "no:cacheprovider", "-m",
        "not nightly", "-W", "ignore::RuntimeWarning", *(f"tests/{test}" for test in tests),
    ]  # fmt: skip
    return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True)


@pytest.mark.nightly
def test_they_pass_as_the_constants_are(copy: Path):
    ended = run(copy, sorted({test for *_, test in RESTS_ON}))
    assert ended.returncode == 0, ended.stdout


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("name", "constant", "coarser", "test"),
    RESTS_ON,
    ids=[f"{name}-{constant.partition(' ')[0]}" for name, constant, *_ in RESTS_ON],
)
def test_a_coarser_constant_fails_its_test(copy, name, constant, coarser, test):
    path = copy / "puck_tables" / f"{name}.py"
    source, left = path.read_text("utf-8"), constant.partition(" = ")[0]
    assert source.count(f"\n{constant}") == 1, "the constant is another one now"
    assert test.partition("::")[2] in source, "no comment names the test"
    try:
        path.write_text(source.replace(f"\n{constant}", f"\n{left} = {coarser}"), "utf-8")
        ended = run(copy, [test])
    finally:
        path.write_text(source, "utf-8")
    assert ended.returncode == 1 and "AssertionError" in ended.stdout, ended.stdout
