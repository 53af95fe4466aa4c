"""Tables with right digests and wrong content: refused or failed by validate, never believed."""

from __future__ import annotations

import io
import json
from pathlib import Path

import h5py
import numpy as np
import pytest
from click.testing import CliRunner
from forged_tables import Edit, forged, honest, outcome, random_edit
from kinds_of_table import KINDS, answers, small
from puck_tables.cli.main import main

from puck_tables import Table, table_for
from puck_tables._core.own_folder import say
from puck_tables.errors import TableError
from puck_tables.table import store
from puck_tables.table.file import sealed
from puck_tables.table.slip_axis import LawAxis


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("honest")


def unchanged(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
    """The edit that is none."""


def believed(folder: Path, tmp_path: Path, count: int, seed: int) -> dict[str, list[str]]:
    """What became of so many forgeries of each kind, by outcome."""
    rng = np.random.default_rng(seed)
    became: dict[str, list[str]] = {}
    for kind in KINDS:
        content = honest(kind, folder)
        path = tmp_path / "honest.h5"
        path.write_bytes(forged(content, unchanged))
        truth = Table.load(path)
        assert outcome(path.read_bytes(), truth, tmp_path) == "right"
        for _ in range(count):
            name, edit = random_edit(kind, rng)
            became.setdefault(outcome(forged(content, edit), truth, tmp_path), []).append(name)
    return became


@pytest.mark.thorough
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_no_forged_table_is_believed(folder: Path, tmp_path: Path):
    became = believed(folder, tmp_path, 3, seed=5)
    assert became.get("WRONG", []) == []
    assert len(became["refused"]) > 10


@pytest.mark.nightly
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_no_forged_table_of_a_thousand_is_believed(folder: Path, tmp_path: Path):
    assert believed(folder, tmp_path, 170, seed=6).get("WRONG", []) == []


def in_one_node(name: str, place: tuple[int, ...], change: float) -> Edit:
    def edit(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        arrays[name][place] += change

    return edit


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("kind", "name", "place", "change"),
    [
        ("resultants", "spin", (7, 2), 1e-5), ("stops", "turn", (20, 8), 1e-2),
        ("washer", "parallel", (29, 1), 1e-3), ("profile", "spin", (101, 2), 1e-3),
        ("speed", "p_d", (617,), 0.02), ("section", "spin_share", (40,), 1e-3),
        ("stop section", "along", (40,), 1e-2),
    ],
)  # fmt: skip
def test_one_altered_node_does_not_pass(
    kind: str, name: str, place: tuple[int, ...], change: float, folder: Path, tmp_path: Path
):
    """Whatever the points that validate happens to choose."""
    path = tmp_path / "forged.h5"
    path.write_bytes(forged(honest(kind, folder), in_one_node(name, place, change)))
    try:
        table = Table.load(path)
    except TableError as error:
        assert "altered" in str(error)
        return
    for _ in range(1 if kind == "stops" else 3):
        assert not table.validate().passed


def test_what_a_file_says_is_no_yardstick(folder: Path, tmp_path: Path):
    """Errors measured, the largest f and the tolerance come from the file that is judged."""

    def boast(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        attributes["tolerance"] = 0.9
        arrays["spin"][1:3] *= 1.0 + 1e-3

    path = tmp_path / "boast.h5"
    for kind in ("resultants", "washer", "profile"):
        path.write_bytes(forged(honest(kind, folder), boast))
        with pytest.raises(TableError, match="holds wrong numbers"):
            Table.load(path)

    def unit(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        attributes["largest_f"] = 1e9

    path.write_bytes(forged(honest("speed", folder), unit))
    with pytest.raises(TableError, match=r"off by 1e.09 from the largest f of its law"):
        Table.load(path)


def test_a_section_with_other_lines_or_too_few_cells_is_refused(folder: Path, tmp_path: Path):
    """Its nodes alone are right: between them the spline would not be."""
    path = tmp_path / "forged.h5"
    table = small("section")

    def on(axis: LawAxis, tolerance: float) -> Edit:
        def edit(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
            nodes = axis.nodes()
            rho = table.law.friction(nodes, table.delta)
            ratios = 1.0 / rho.parallel, rho.perpendicular / rho.parallel, rho.spin / rho.parallel
            arrays.update(zip(("phi", *table.functions), (nodes, *ratios), strict=True))
            attributes["n_phi"], attributes["tolerance"] = nodes.size, tolerance
            attributes["cotangents"] = json.dumps(axis.edges)

        return edit

    for axis, tolerance, words in (
        (LawAxis(table.cotangents, 32), 1e-5, ""),
        (LawAxis((1.0,), 64), 1e-5, "its lines are not those of its puck"),
        (LawAxis(table.cotangents, 4), 1e-6, "cannot use"),
    ):
        path.write_bytes(forged(honest("section", folder), on(axis, tolerance)))
        if words:
            with pytest.raises(TableError, match=words):
                Table.load(path)
        else:
            Table.load(path)


def test_a_profile_may_not_call_itself_by_the_name_of_a_law(folder: Path, tmp_path: Path):
    def uniform(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        attributes["pressure_law"] = "uniform"

    path = tmp_path / "forged.h5"
    path.write_bytes(forged(honest("profile", folder), uniform))
    with pytest.raises(TableError, match="not the law it names, uniform"):
        Table.load(path)


@pytest.mark.thorough
@pytest.mark.parametrize("kind", KINDS)
def test_every_entry_that_is_missing_or_of_another_type_is_a_sentence(
    kind: str, folder: Path, tmp_path: Path
):
    content = honest(kind, folder)
    with h5py.File(io.BytesIO(content), "r") as file:
        names = list(file.attrs)
    path = tmp_path / "forged.h5"
    for name in names:
        for value in (None, 7, "seven"):

            def edit(attributes: dict[str, object], arrays: object, new: object = value) -> None:
                if new is None:
                    del attributes[name]  # noqa: B023 - called at once
                else:
                    attributes[name] = new  # noqa: B023

            path.write_bytes(forged(content, edit))
            try:
                answers(Table.load(path))
            except TableError as error:
                assert str(error).startswith(str(path))

    def nameless(attributes: dict[str, object], arrays: object) -> None:
        del attributes["valid_range"]

    path.write_bytes(forged(content, nameless))
    for command in ("info", "validate"):
        ended = CliRunner().invoke(main, [command, str(path)])
        assert (ended.exit_code, ended.stdout) == (1, "")
        assert len(ended.stderr.splitlines()) == 1


def test_metadata_bytes_under_a_right_seal_end_at_once(folder: Path):
    """Each in an answer or a sentence; by the HDF5 library some of them never ended."""
    whole = honest("washer", folder).rpartition(b"\npuck-tables")[0]
    rng = np.random.default_rng(8)
    refused = 0
    for _ in range(600):
        content = bytearray(whole)
        content[int(rng.integers(6000))] = int(rng.choice([0, 255, rng.integers(256)]))
        try:
            Table.read(sealed(bytes(content)), "it")
        except TableError:
            refused += 1
    assert 60 < refused < 600


def test_a_kept_table_that_was_altered_is_built_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    say.cache_clear()
    right = table_for("ring", accuracy=1e-4)
    (path,) = store.kept_files()

    def altered(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        arrays["spin"][15, 2] *= 1.01

    path.write_bytes(forged(path.read_bytes(), altered))
    assert CliRunner().invoke(main, ["tables"]).stdout.count("damaged") == 1
    again = table_for("ring", accuracy=1e-4)
    assert f"{path} is damaged: it is built again" in capsys.readouterr().err
    np.testing.assert_array_equal(again.values, right.values)
    np.testing.assert_array_equal(table_for("ring", accuracy=1e-4).values, right.values)
    path.unlink()

    def nameless(attributes: dict[str, object], arrays: dict[str, np.ndarray]) -> None:
        del attributes["valid_range"]

    table_for("ring", accuracy=1e-4)
    path.write_bytes(forged(path.read_bytes(), nameless))
    listed = CliRunner().invoke(main, ["tables"])
    assert listed.exit_code == 0
    assert "damaged" in listed.stdout
