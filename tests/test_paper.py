"""The paper, reproduced: claims that hold, claims that must be able to fail, figures, command."""

from __future__ import annotations

import csv
import math
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from conftest import ROOT
from puck_tables.cli.main import main
from reference import REFERENCE_RUNS

from puck_tables.contact import closed_form, quadrature
from puck_tables.contact.integrals import PatchIntegrals
from puck_tables.contact.resultants import Resultants
from puck_tables.paper import ends, figures, friction, motions, patch, shapes
from puck_tables.paper.claim import Claim, as_csv, as_text, equal, farthest, less, more
from puck_tables.paper.claims import all_claims
from puck_tables.paper.root import root
from puck_tables.table.check import by_closed_form
from puck_tables.trajectory import Trajectory, simulate


@pytest.fixture(scope="module")
def subjects() -> dict[str, list[Claim]]:
    return all_claims()


@pytest.fixture(scope="module")
def claims(subjects: dict[str, list[Claim]]) -> list[Claim]:
    return [claim for group in subjects.values() for claim in group]


def differing(claims: list[Claim]) -> set[str]:
    return {claim.where for claim in claims if claim.verdict == "DIFFERS"}


def test_every_claim_is_as_expected(claims: list[Claim]):
    assert differing(claims) == set()
    wrong = [claim.where for claim in claims if claim.verdict == "erratum"]
    assert wrong == ["eq. 5.3", "section 8", "Cor. 11", "Cor. 12"]


def test_all_that_the_paper_claims_is_there(claims: list[Claim]):
    places = [claim.where for claim in claims]
    assert places.count("table 4.6") == 15
    assert places.count("table 6.1") == 9
    promised = [f"result {n}" for n in range(9)] + [f"Prop. {n}" for n in range(4, 9)]
    assert set(places) >= {*promised, *(f"Cor. {n}" for n in range(1, 14))}
    statements = [(claim.where, claim.statement) for claim in claims]
    assert len(set(statements)) == len(statements)


def test_the_erratum_of_the_critical_height(claims: list[Claim]):
    at = {claim.statement: claim for claim in claims if claim.where == "eq. 5.3"}
    wrong = at["critical delta at phi = pi/4"]
    assert wrong.computed == pytest.approx(1.15913851, abs=1e-8)
    assert (wrong.stated, wrong.verdict) == ("1.1263...", "erratum")
    assert "1.1591" in wrong.erratum


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        (more("x", "x", 0.0, 0.1), "ok"),
        (more("x", "x", 0.0, 0.0), "DIFFERS"),
        (less("x", "x", 0.0, 0.1), "DIFFERS"),
        (equal("x", "x", 1.0, 1.1, 0.05), "DIFFERS"),
        (equal("x", "x", 1.0, 1.1, 0.05, erratum="misprint"), "erratum"),
        (equal("x", "x", 1.0, 1.0, 0.05, erratum="misprint"), "DIFFERS"),
        (equal("x", "x", 1.0, math.nan, 0.05), "DIFFERS"),
        (more("x", "x", 0.0, math.nan), "DIFFERS"),
        (equal("x", "x", 1.0, farthest([1.0, math.nan], 1.0), 0.05), "DIFFERS"),
        (equal("x", "x", 1.0, root(math.exp, 0.0, 1.0), 0.05), "DIFFERS"),
    ],
)
def test_verdicts(claim: Claim, verdict: str):
    assert claim.verdict == verdict
    assert verdict in as_text({"Subject": [claim]})
    assert as_csv({"Subject": [claim]}).splitlines()[1].endswith(f"{claim.holds},{verdict}")


# What must be found out when the integrals, the resultants or the motions were wrong.

Field = Callable[..., Any]


def changed_integrals(**change: Field) -> Callable[[Any], PatchIntegrals]:
    def integrals(phi: Any) -> PatchIntegrals:
        p = closed_form.integrals(phi)
        return p._replace(
            **{name: f(getattr(p, name), np.asarray(phi)) for name, f in change.items()}
        )

    return integrals


@pytest.mark.parametrize(
    ("change", "places"),
    [
        ({"c": lambda p, phi: p * (1.0 + 1e-12)}, {"table 4.6"}),
        ({"a": lambda p, phi: p - 1.25 * np.sin(2.0 * phi) ** 8}, {"Cor. 1", "Cor. 2"}),
        ({"d": lambda p, phi: -p}, {"table 4.6", "Cor. 1", "Cor. 2"}),
        ({"b": lambda p, phi: p - 0.3 * np.cos(phi) ** 2}, {"Cor. 1", "Cor. 2"}),
        ({"b": lambda p, phi: p + 2e-4 * np.sin(2.0 * phi) ** 2}, {"Cor. 2"}),
        ({"c": lambda p, phi: p + 0.15 * np.sin(2.0 * phi) ** 2}, {"Cor. 3"}),
        ({"e": lambda p, phi: -p}, {"Cor. 3"}),
        ({"a": lambda p, phi: 1.01 * p}, {"Prop. 4", "eq. 5.3", "section 1"}),
        ({"a": lambda p, phi: 0.99 * p}, {"Prop. 4", "eq. 5.3", "section 1"}),
        ({"b": lambda p, phi: 1.01 * p}, {"eq. 5.3"}),
    ],
)
def test_wrong_integrals_are_found_out(change: dict[str, Field], places: set[str]):
    assert differing(patch.claims(changed_integrals(**change))) >= places


def changed_friction(**change: Field) -> friction.Friction:
    def resultants(phi: Any, delta: Any) -> Resultants:
        rho = by_closed_form(phi, delta)
        return rho._replace(
            **{name: f(getattr(rho, name), np.asarray(phi)) for name, f in change.items()}
        )

    return resultants


@pytest.mark.parametrize(
    ("change", "places"),
    [
        ({"parallel": lambda r, phi: r * (1.0 + 1e-12)}, {"table 6.1", "Cor. 8"}),
        ({"perpendicular": lambda r, phi: -r}, {"table 6.1", "Cor. 4"}),
        ({"spin": lambda r, phi: r - 0.6}, {"Cor. 4", "Fig. 9", "section 7"}),
        ({"spin": lambda r, phi: r - 0.7 * np.sin(phi) ** 2}, {"section 7", "Cor. 7", "Prop. 6"}),
        ({"spin": lambda r, phi: 1.6 - r}, {"section 7", "Cor. 7"}),
        ({"spin": lambda r, phi: r + 0.8 * np.sin(2 * phi) ** 40}, {"Prop. 6"}),
        ({"parallel": lambda r, phi: r - 2.5 * np.sin(2 * phi) ** 4}, {"Cor. 4", "Cor. 5"}),
        ({"spin": lambda r, phi: r + 1e-9 * phi}, {"section 8"}),
        ({"perpendicular": lambda r, phi: r + 1e-9 * phi}, {"section 8"}),
    ],
)
def test_wrong_resultants_are_found_out(change: dict[str, Field], places: set[str]):
    assert differing(friction.claims(changed_friction(**change))) >= places


def changed_motions(
    change: Callable[[Trajectory], Trajectory] = lambda run: run, **factor: float
) -> Callable[..., Trajectory]:
    def run(v0: Any, w0: float, **given: Any) -> Trajectory:
        given = {**given, **{name: f * given.get(name, 1.0) for name, f in factor.items()}}
        return change(simulate(v0, w0, **given))

    return run


def late_reversal(run: Trajectory) -> Trajectory:
    late = run.time > 0.9 * run.stop_time
    return replace(run, slip_angle=np.where(late, -1.0, 1.0) * run.slip_angle)


CHANGES: dict[str, tuple[Callable[..., Trajectory], set[str]]] = {
    "another friction": (changed_motions(delta=0.98), {"eq. 6.2", "Prop. 7"}),
    "another deceleration": (changed_motions(decel=0.9), {"eq. 6.2", "result 0"}),
    "spin reversed late": (changed_motions(late_reversal), {"result 1"}),
    "mirrored": (
        changed_motions(lambda r: replace(r, heading=-r.heading, y=-r.y)),
        {"eq. 6.2", "result 2", "Cor. 10", "Prop. 7"},
    ),
    "drift": (changed_motions(lambda r: replace(r, y=r.y + 1e-9 * r.x)), {"result 6"}),
    "speed left over": (
        changed_motions(lambda r: replace(r, speed=r.speed + 1e-6)), {"result 3", "Prop. 7"},
    ),
    "spin left over": (changed_motions(lambda r: replace(r, spin=r.spin + 1e-6)), {"Cor. 6"}),
    "slides after the spin": (
        changed_motions(lambda r: replace(r, spin=r.spin * (1.0 - r.time / r.stop_time))),
        {"eq. 6.2", "result 5", "result 4"},
    ),
    "spins after the slide": (
        changed_motions(lambda r: replace(r, speed=r.speed * (1.0 - r.time / r.stop_time))),
        {"eq. 6.2", "result 5", "result 4"},
    ),
    "never B or C": (changed_motions(lambda r: replace(r, regime="D")), {"result 3"}),
    "one direction favoured": (
        changed_motions(lambda r: replace(r, speed=r.speed * (1 + 1e-6 * np.cos(r.heading)))),
        {"result 2"},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CHANGES)
def test_wrong_motions_are_found_out(name: str):
    run, places = CHANGES[name]
    assert differing(motions.claims(run)) >= places


@pytest.mark.parametrize(
    ("run", "places"),
    [
        (changed_motions(delta=0.98), {"result 4", "Cor. 12", "result 6"}),
        (changed_motions(decel=1.001), {"Cor. 11", "section 7"}),
        (changed_motions(lambda r: replace(r, heading=0.0 * r.heading)), {"Cor. 13", "result 7"}),
        (changed_motions(lambda r: replace(r, spin=-r.spin)), {"result 4"}),
        (changed_motions(lambda r: replace(r, speed=r.speed**1.1)), {"result 4", "Cor. 9"}),
        (changed_motions(lambda r: replace(r, spin=np.sin(r.w0) * r.speed)), {"result 5"}),
        (changed_motions(lambda r: replace(r, slip_speed=r.slip_speed + 1e-6)), {"result 8"}),
        (changed_motions(lambda r: replace(r, heading=r.heading - 1e-9 * r.time)), {"result 7"}),
    ],
)
def test_wrong_ends_are_found_out(run: Callable[..., Trajectory], places: set[str]):
    assert differing(ends.claims(run)) >= places


@pytest.mark.parametrize(
    ("run", "places"),
    [
        (changed_motions(lambda r: replace(r, x=r.x + 1e-7 * r.x**2)), {"Prop. 8"}),
        (changed_motions(lambda r: replace(r, path_length=r.path_length + 1e-6)), {"result 7"}),
        (
            changed_motions(lambda r: replace(r, stop_position=(r.stop_position[0] ** 3, 0.0))),
            {"Fig. 4"},
        ),
        (changed_motions(lambda r: replace(r, y=r.y + 1e-9)), {"result 7"}),
    ],
)
def test_wrong_paths_are_found_out(run: Callable[..., Trajectory], places: set[str]):
    assert differing(shapes.claims(run)) >= places


def test_times_that_do_not_grow_linearly_are_found_out():
    run = changed_motions(lambda r: replace(r, stop_time=r.stop_time**3))
    assert [c.holds for c in shapes.nearly_straight_lines(run)] == [False, True]


@pytest.mark.parametrize(
    ("target", "factor", "group", "places"),
    [
        ("paper.friction.limit_angle", 0.7, friction.claims, {"Cor. 8", "Prop. 6", "result 4"}),
        ("paper.friction.limit_angle", 1.5, friction.claims, {"Cor. 8", "Prop. 6", "result 4"}),
        ("paper.friction.curvature_slope", 1.1, friction.claims, {"result 8"}),
        ("paper.friction.curvature_slope", 0.9, friction.claims, {"result 8"}),
        ("paper.friction.approach_exponent", -1.0, friction.claims, {"Cor. 9"}),
        ("paper.ends.curvature_slope", 1.001, ends.claims, {"Cor. 12"}),
        ("paper.ends.approach_exponent", 1.01, ends.claims, {"Cor. 9", "Cor. 11", "Cor. 12"}),
    ],
)
def test_wrong_limits_are_found_out(
    monkeypatch: pytest.MonkeyPatch,
    target: str,
    factor: float,
    group: Callable[[], list[Claim]],
    places: set[str],
):
    from puck_tables.motion import limits

    true = getattr(limits, target.rsplit(".", 1)[1])
    monkeypatch.setattr(f"puck_tables.{target}", lambda delta: factor * true(delta))
    assert differing(group()) >= places


def test_a_wrong_quadrature_is_found_out(monkeypatch: pytest.MonkeyPatch):
    true = quadrature.integrals
    assert differing(patch.pressure_laws()) == set()
    for factor in (0.7, 1.3):
        monkeypatch.setattr(
            quadrature, "integrals",
            lambda *given, factor=factor: (p := true(*given))._replace(d=factor * p.d),
        )  # fmt: skip
        assert differing(patch.claims()) >= {"eq. 4.5", "section 3"}


def test_a_field_without_the_symmetry_is_found_out(monkeypatch: pytest.MonkeyPatch):
    uneven = changed_friction(parallel=lambda r, phi: r * (1.0 + 1e-9 * phi))
    monkeypatch.setattr(motions, "by_closed_form", uneven)
    assert differing(motions.symmetry(simulate)) == {"Prop. 5"}


def test_the_readme_counts_right(claims: list[Claim]):
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert f"{len(claims)} of its claims" in text
    assert f"{sum(claim.verdict == 'ok' for claim in claims)} claims hold" in text


# Figures


def test_stops_of_figure_4_and_paths_of_figure_3():
    for delta in (0.0, 1.0):
        curves = figures.stops_against_spin(delta).panels[0].curves
        for spin in (1.0, 5.0):
            at = np.flatnonzero(curves[0].x == spin)[0]
            found = [float(curve.y[at]) for curve in curves]
            assert found == pytest.approx(REFERENCE_RUNS[delta, spin], abs=1e-10)
    spin_rich = figures.paths().panels[0].curves[-1]  # v = 5, ω = 25
    assert spin_rich.x[-1] == pytest.approx(25 * 2.257241156461, abs=1e-7)
    assert spin_rich.y[-1] == pytest.approx(-25 * 0.308477350409, abs=1e-7)
    labels = [curve.label[-3:] for curve in figures.paths().panels[0].curves]
    assert set(labels) == {"(B)", "(C)"}


def test_limit_angle_of_figure_2():
    curve = figures.limit_angles().panels[0].curves[0]
    at = {0.0: 0.992313778946643533, 0.5: 0.987079101411475736, 1.0: 0.975464553235532779}
    for delta, angle in at.items():
        assert curve.y[np.flatnonzero(curve.x == delta)[0]] == pytest.approx(angle, abs=1e-14)
    assert np.all(np.diff(curve.y) < 0.0)


@pytest.mark.parametrize(
    ("figure", "duration"), [(figures.steel_puck, 0.52), (figures.rubber_puck, 0.38)]
)
def test_ratios_of_figures_5_and_6(figure: Callable[[], Any], duration: float):
    *curves, limit = figure().panels[0].curves
    for curve in curves:
        assert curve.x[0] == 0.0
        assert duration * 0.9999 < curve.x[-1] < duration
        assert abs(curve.y[-1] / limit.y[0] - 1.0) < 0.01
        assert np.all(np.diff(np.abs(curve.y - limit.y[0])) < 0.0)
    # the launch that the label names stops when it should
    speed, spin = (float(part.split(" = ")[1].split()[0]) for part in curves[1].label.split(","))
    radius, height, f = (0.03, 0.019, 0.2) if duration == 0.52 else (0.037, 0.025, 0.6)
    run = simulate(
        (speed, 0.0), spin, radius=radius, delta=2 * f * height / radius, decel=f * 9.80665
    )
    assert run.stop_time == pytest.approx(duration, rel=0.03)


def test_surfaces_of_figures_7_to_10():
    at = lambda curve, phi: float(np.interp(phi, curve.x, curve.y))  # noqa: E731
    p = figures.patch_integrals().panels[0].curves
    ends_of = {"a": (1, 1), "b": (1 / 4, 1 / 3), "c": (0, -1 / 3), "d": (1 / 4, 2 / 3),
               "e": (-1 / 4, 0)}  # fmt: skip
    for curve, (first, last) in zip(p, ends_of.values(), strict=True):
        assert (at(curve, 0.0), at(curve, np.pi / 2)) == pytest.approx((first, last), abs=1e-14)
    reserve = figures.pressure_reserves().panels[0].curves
    along, spin = (panel.curves for panel in figures.friction_along_and_spin().panels)
    across = figures.friction_across().panels[0].curves
    for i, delta in enumerate(figures.FAMILY):
        assert at(reserve[i], 0.0) == pytest.approx(1.0 - delta**2, abs=1e-14)
        assert at(reserve[i], np.pi / 2) == pytest.approx((1.0 + delta**2 / 9) ** 2, abs=1e-14)
        assert at(along[i], np.pi / 2) == pytest.approx(9 / (9 + delta**2), abs=1e-14)
        assert at(spin[i], 0.0) == pytest.approx((4 - delta**2) / 8, abs=1e-14)
        assert at(across[i], 0.0) == pytest.approx(delta / 4, abs=1e-14)


def test_phase_portrait_of_figure_11():
    rate, grows, falls, attracts, repels = figures.phase_portrait().panels[0].curves
    for arrows, sign in ((grows, 1.0), (falls, -1.0)):
        assert np.all(sign * np.interp(arrows.x, rate.x, rate.y) > 0.0)
    for points, slope in ((attracts, -1.0), (repels, 1.0)):
        inside = np.clip(points.x, -1.57, 1.57)  # one-sided at ±π/2
        for x in inside:
            ahead, behind = np.interp([x + 0.01, x - 0.01], rate.x, rate.y)
            assert slope * (ahead - behind) > 0.0
    np.testing.assert_allclose(np.interp(attracts.x, rate.x, rate.y), 0.0, atol=1e-3)


# The command


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def puck(*arguments: str) -> Result:
    return CliRunner().invoke(main, arguments)


FILES = ["claims.csv", *(f"figure_{n:02}.png" for n in range(2, 12))]


def test_the_command_writes_prints_and_says_what_it_wrote(claims: list[Claim]):
    result = puck("paper", "--out", "deep/er")
    assert result.exit_code == 0, result.output
    assert sorted(path.name for path in Path("deep/er").iterdir()) == FILES
    for name in FILES:
        assert f"wrote deep/er/{name}" in result.stderr
    for name in FILES[1:]:
        picture = Path("deep/er", name).read_bytes()
        assert picture[:8] == b"\x89PNG\r\n\x1a\n"
        assert len(picture) > 15_000
    with open("deep/er/claims.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["statement"] for row in rows] == [claim.statement for claim in claims]
    assert {row["verdict"] for row in rows} == {"ok", "erratum"}
    np.testing.assert_allclose(
        [float(row["computed"]) for row in rows], [claim.computed for claim in claims]
    )
    assert f"{len(claims)} claims: {len(claims) - 4} ok, 4 errata of the paper, 0 differ" in (
        result.stdout
    )
    assert all(claim.statement in result.stdout for claim in claims)
    assert "wrote" not in result.stdout
    assert result.output.isascii()
    assert puck("paper", "--help").output.isascii()


def no_work() -> None:
    raise AssertionError("work was done before the outputs were checked")


@pytest.fixture
def idle(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("puck_tables.paper.claims.all_claims", lambda show: no_work())


@pytest.mark.usefixtures("idle")
@pytest.mark.parametrize("name", FILES)
def test_existing_files_are_kept(name: str):
    Path("out").mkdir()
    Path("out", name).write_text("mine")
    result = puck("paper", "--out", "out")
    assert result.exit_code == 1
    assert f"out/{name} exists already; use --overwrite" in result.stderr
    assert result.stdout == ""
    assert [path.name for path in Path("out").iterdir()] == [name]
    assert Path("out", name).read_text() == "mine"


@pytest.mark.usefixtures("idle")
def test_refusals(monkeypatch: pytest.MonkeyPatch):
    assert puck("paper").exit_code == 2
    Path("file").write_text("mine")
    for place in ("file", "file/below", "/proc/out"):
        result = puck("paper", "--out", place, "--overwrite")
        assert result.exit_code == 1
        assert f"Error: cannot make the folder {place}: " in result.stderr
        assert result.stdout == ""
    assert Path("file").read_text() == "mine"
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    result = puck("paper", "--out", "new")
    assert result.exit_code == 1
    assert "pip install 'puck-tables[plot]'" in result.stderr
    assert not Path("new").exists()


def test_a_claim_that_differs_ends_with_3(monkeypatch: pytest.MonkeyPatch):
    wrong = equal("Prop. 4", "critical delta", 1.0, 1.1, 1e-12)
    monkeypatch.setattr("puck_tables.paper.claims.all_claims", lambda show: {"Patch": [wrong]})
    monkeypatch.setattr("puck_tables.paper.figures.FIGURES", {2: figures.limit_angles})
    Path("out").mkdir()
    Path("out/claims.csv").write_text("old")
    result = puck("paper", "--out", "out", "--overwrite")
    assert result.exit_code == 3
    assert "DIFFERS" in result.stdout
    assert "Error: a claim differs" in result.stderr
    assert "critical delta" in Path("out/claims.csv").read_text()
    assert Path("out/figure_02.png").exists()
