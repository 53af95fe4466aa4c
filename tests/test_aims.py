"""Many targets at once: the launches of one question after the other, for any number of threads."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from commands import invoke
from reference import states

from puck_tables import Puck
from puck_tables.errors import InputError

PLAIN = Puck.similar(radius=0.3, decel=0.7)
TALL = Puck.similar(delta=3.9)
RNG = np.random.default_rng(8)
TARGETS = RNG.uniform(-3.0, 3.0, (40, 2))
WISHES = (
    {"spin": RNG.normal(size=40) * np.where(np.arange(40) % 7 == 0, 0.0, 5.0)},
    {"speed": RNG.uniform(0.5, 3.0, 40)}, {"stop_time": RNG.uniform(1.0, 4.0, 40)},
    {"max_speed": 2.0, "max_spin": 4.0}, {},
)  # fmt: skip


@pytest.mark.thorough
@pytest.mark.parametrize("puck", [PLAIN, TALL], ids=["plain", "tall"])
def test_all_branches_of_all_targets(puck: Puck):
    for wish in WISHES:
        many = puck.aim(TARGETS, **wish)
        for n in range(0, 40, 3):
            own = {name: np.broadcast_to(value, 40)[n].item() for name, value in wish.items()}
            one, mine = puck.aim(TARGETS[n], **own), many.target_index == n
            assert many.launches[n] == one.launch_spin.size == mine.sum(), (wish, n)
            for name in ("launch_spin", "launch_velocity", "stop_time"):
                np.testing.assert_allclose(
                    getattr(many, name)[mine], getattr(one, name), rtol=1e-7, atol=1e-9
                )
        assert many.miss.max(initial=0.0) <= 1e-9
        for name in ("speed", "stop_time"):  # what was wished is met to the last digits
            if name in wish:
                met = {"speed": many.launch_speed, "stop_time": many.stop_time}[name]
                np.testing.assert_allclose(met, wish[name][many.target_index], rtol=1e-12)


def test_launches_arrive_by_scipy():
    """All of the motion but its last second by an independent integrator."""
    puck = Puck.similar()
    found = puck.aim(TARGETS[:4], stop_time=[3.0, 4.0, 3.5, 5.0])
    assert found.launches.sum() >= 4
    for n in range(found.launch_spin.size):
        start = (tuple(found.launch_velocity[n]), found.launch_spin[n], 0.5)
        vx, vy, rim, x, y, _ = states(*start, np.array([0.0, found.stop_time[n] - 1.0]))[:, -1]
        rest = puck.simulate((vx, vy), rim, exact=True)
        there = np.array([x, y]) + rest.stop_position
        np.testing.assert_allclose(there, found.target[found.target_index[n]], atol=2e-9)


def test_the_same_bits_for_any_number_of_threads():
    places = np.random.default_rng(3).uniform(-2.0, 2.0, (9001, 2))
    one, three = (PLAIN.aim(places, spin=2.0, threads=threads) for threads in (1, 3))
    for name in ("target_index", "launch_velocity", "launch_spin", "stop_time"):
        np.testing.assert_array_equal(getattr(one, name), getattr(three, name))


def test_shapes_broadcast_and_one_target_is_told():
    grid = PLAIN.aim([[[1.0, 0.5]], [[0.0, 2.0]]], stop_time=[2.5, 1e-3, 4.0])
    assert grid.launches.shape == (2, 3)
    assert (grid.launches[:, 1] == 0).all()
    assert "the quickest takes" in grid[0, 1].answer
    assert grid[1, 2].launch_spin.size == grid.launches[1, 2] == 2
    assert "none to" in grid.answer
    several = PLAIN.aim((1.0, 0.5), spin=[-1.0, 0.0, 1.0])
    assert several.launch_spin.tolist() == pytest.approx([-1.0, 0.0, 1.0], rel=1e-13)
    assert PLAIN.aim(np.empty((0, 2)), spin=1.0).launch_spin.size == 0


def test_targets_under_the_puck():
    places = [(0.0, 0.0), (1.0, 0.0)]
    assert PLAIN.aim(places, spin=3.0).launch_velocity[0].tolist() == [0.0, 0.0]
    assert PLAIN.aim(places, stop_time=3.0).launches.tolist() == [2, 2]
    assert PLAIN.aim(places, speed=0.5).launches.tolist() == [0, 2]
    assert PLAIN.aim(places).launches.tolist() == [0, 15]
    assert PLAIN.aim(places, spin=3.0).miss.max() <= 1e-10


@pytest.mark.parametrize(
    ("target", "options", "words"),
    [
        (TARGETS, {"spin": [1.0, 2.0]}, "shape"),
        (np.ones((3, 3)), {}, "one place"),
        (TARGETS, {"speed": 0.0}, "greater than 0"),
        (TARGETS, {"threads": 0}, "threads"),
        ([(1.7e308, 1.7e308), (1.0, 0.0)], {"spin": 1.0}, "use larger units"),
        (TARGETS, {"spin": 1e300}, "out of the range of floating point"),
        (TARGETS, {"speed": 1e-200}, "out of the range of floating point"),
    ],
)
def test_bad_aims(target: object, options: dict, words: str):
    with pytest.raises(InputError, match=words):
        PLAIN.aim(target, **options)


def test_verbs(tmp_path: Path):
    found = PLAIN.aim(TARGETS, stop_time=3.0)
    found.save(tmp_path / "aims.h5")
    found.save(tmp_path / "aims.csv")
    rows = list(csv.DictReader((tmp_path / "aims.csv").read_text().splitlines()))
    assert len(rows) == found.launch_spin.size
    assert float(rows[-1]["launch_spin[rad/s]"]) == found.launch_spin[-1]
    assert len(found.plot().axes) == 3
    assert "integrated, end at most" in found.explain()
    with pytest.raises(InputError, match="nothing to draw"):
        PLAIN.aim(TARGETS, stop_time=1e-3).plot()


def run(*arguments: str):
    return invoke("aim", *arguments)


def test_a_file_of_targets(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    Path("holes.csv").write_text("x,y\n2,0.1\n1,-1\n")
    shown = run("--targets", "holes.csv", "--speed", "1.7", "-o", "shots.csv")
    assert shown.exit_code == 0, shown.stderr
    assert "2 launches to 2 targets, none to 1 of them" in shown.stdout
    rows = list(csv.DictReader(Path("shots.csv").read_text().splitlines()))
    assert [row["target_index[1]"] for row in rows] == ["0", "0"]
    for text, words in (
        ("x,y\n1,2,3\n", "2 names for 3 columns"),
        ("x,y\n1,a\n", "line 2, column 2: 'a' is no number"),
        ("x,y\n", "no rows"),
        ("x,y\n1,nan\n", "line 2: it has no y"),
        ("x [kg],y [m]\n1,2\n", "the unit of its column 'x [kg]'"),
    ):
        Path("bad.csv").write_text(text)
        refused = run("--targets", "bad.csv", "-o", "bad-out.csv")
        assert (refused.exit_code, Path("bad-out.csv").exists()) == (2, False)
        assert words in refused.stderr
    for arguments, words in (
        (["--targets", "none.csv"], "none.csv"),
        (["--targets", "holes.csv", "--target", "1,1"], "give one of them"),
        (["--targets", "holes.csv", "-o", "holes.csv", "--overwrite"], "holes.csv"),
        (["--targets", "holes.csv", "--scene", "carrom"], "--targets"),
    ):
        refused = run(*arguments)
        assert refused.exit_code in (1, 2)
        assert words in refused.stderr
    assert Path("holes.csv").read_text().startswith("x,y\n2,0.1")
