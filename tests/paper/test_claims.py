"""The paper's claims: they hold, and every one of them must be able to fail."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from pucks import simulate
from rarely import few

from paper import ends, friction, motions, patch, shapes
from paper.claim import Claim, as_page, equal, farthest, less, more
from paper.root import root
from paper.runs import ACCURACY
from puck_tables.contact import closed_form, quadrature
from puck_tables.contact.closed_form import Resultants, by_closed_form
from puck_tables.contact.integrals import PatchIntegrals
from puck_tables.trajectory import Trajectory


def differing(claims: list[Claim]) -> set[str]:
    return {claim.where for claim in claims if claim.verdict == "DIFFERS"}


@pytest.mark.thorough
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
    assert as_page({"Subject": [claim]}).rstrip().endswith(f"| {verdict} |")


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
        return change(simulate(v0, w0, exact=True, tol=ACCURACY, **given))

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


@pytest.mark.thorough
@pytest.mark.parametrize("name", few(4, CHANGES))
def test_wrong_motions_are_found_out(name: str):
    run, places = CHANGES[name]
    assert differing(motions.claims(run)) >= places


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("run", "places"),
    [
        (changed_motions(delta=0.98), {"result 4", "Cor. 12", "result 6"}),
        (changed_motions(decel=1.001), {"Cor. 11", "section 7"}),
        (changed_motions(lambda r: replace(r, heading=0.0 * r.heading)), {"Cor. 13", "result 7"}),
        (changed_motions(lambda r: replace(r, spin=-r.spin)), {"result 4"}),
        (changed_motions(lambda r: replace(r, speed=r.speed**1.1)), {"result 4", "Cor. 9"}),
        (changed_motions(lambda r: replace(r, spin=np.sin(r.launch_spin) * r.speed)), {"result 5"}),
        (changed_motions(lambda r: replace(r, slip_speed=r.slip_speed + 1e-6)), {"result 8"}),
        (changed_motions(lambda r: replace(r, heading=r.heading - 1e-9 * r.time)), {"result 7"}),
    ],
)
def test_wrong_ends_are_found_out(run: Callable[..., Trajectory], places: set[str]):
    assert differing(ends.claims(run)) >= places


@pytest.mark.thorough
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
def test_wrong_limits_are_found_out(monkeypatch, target, factor, group, places):
    from puck_tables.motion import limits

    true = getattr(limits, target.rsplit(".", 1)[1])
    monkeypatch.setattr(target, lambda delta: factor * true(delta))
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


def test_the_page_says_what_is_computed(subjects: dict[str, list[Claim]]):
    """Margins of rounding apart; ``PYTHONPATH=tests python -m paper`` writes it anew."""
    text = (ROOT / "docs/paper.md").read_text(encoding="utf-8")
    rows = [re.split(r" ?(?<!\\)\| ?", line) for line in text.splitlines() if line[:2] == "| "]
    now = [
        re.split(r" ?(?<!\\)\| ?", line)
        for line in as_page(subjects).splitlines()
        if line[:2] == "| "
    ]
    claims = [claim for group in subjects.values() for claim in group]
    assert [row[1:4] + row[6:] for row in rows] == [row[1:4] + row[6:] for row in now]
    computed = [float(row[4]) for row in rows if row[4] not in ("computed", "---")]
    assert computed == pytest.approx([claim.computed for claim in claims], rel=1e-3, abs=1e-9)
    assert f"{sum(claim.verdict == 'ok' for claim in claims)} claims hold" in text
    assert [claim.where for claim in claims if claim.erratum] == [
        "eq. 5.3", "section 8", "Cor. 11", "Cor. 12"
    ]  # fmt: skip
