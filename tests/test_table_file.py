"""Table files: what they carry, and every way to be refused."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray

from puck_tables import Table, build_table, load_table, save_table
from puck_tables.errors import OutputError, TableError
from puck_tables.table.container import sealed


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("tables") / "rough.h5"
    save_table(build_table(accuracy=1e-6), path, command="puck build-tables --accuracy 1e-6")
    return path


def test_round_trip_is_exact(file: Path, rough_table: Table):
    loaded = load_table(file)
    np.testing.assert_array_equal(loaded.values, rough_table.values)
    assert loaded.accuracy == rough_table.accuracy
    assert loaded.tolerance == 1e-6


def test_file_says_what_it_holds(file: Path):
    passport = load_table(file).passport
    assert passport["format"] == "puck-tables"
    for name in (
        "format_version", "kind", "pressure_law", "interpretation", "phi_map", "delta_map",
        "valid_range", "method", "package_version", "library_versions", "created", "command",
        "content_digest", "recipe_digest", "achieved_accuracy", "tolerance",
    ):  # fmt: skip
        assert passport[name], name


def test_opens_in_xarray_with_named_axes(file: Path):
    with xarray.open_dataset(file, engine="h5netcdf") as data:
        assert dict(data.sizes) == {"phi": 69, "delta": 4}
        assert data.spin.dims == ("phi", "delta")
        assert data.phi.attrs["units"] == "rad"
        middle = data.parallel.sel(phi=np.pi / 4, delta=1.0, method="nearest")
        assert float(middle) == pytest.approx(1.1852400155)


def test_default_table_ships_small_and_good(table: Table):
    from importlib.resources import files

    content = files("puck_tables.tables").joinpath("resultants.h5").read_bytes()
    assert len(content) <= 1_000_000
    assert table.accuracy.worst <= 5e-9
    assert table.delta_axis.upper == 1.0


def edited(file: Path, to: Path, edit: Callable[[h5py.File], object]) -> Path:
    """A copy changed by h5py, which drops the seal."""
    shutil.copy(file, to)
    with h5py.File(to, "r+") as opened:
        edit(opened)
    return to


def altered(file: Path, to: Path, **attributes: object) -> Path:
    """A copy with other attributes and a right seal."""
    path = edited(file, to, lambda opened: opened.attrs.update(attributes))
    path.write_bytes(sealed(path.read_bytes()))
    return path


def test_newer_format_other_kind_and_stranger_are_refused_by_name(file: Path, tmp_path: Path):
    newer = altered(file, tmp_path / "newer.h5", format_version="3.0")
    with pytest.raises(TableError, match=r"format 3\.0, newer than 2\.0.*update puck-tables"):
        load_table(newer)
    with pytest.raises(TableError, match="holds 'stops'"):
        load_table(altered(file, tmp_path / "kind.h5", kind="stops"))
    with h5py.File(tmp_path / "other.h5", "w") as other:
        other["x"] = 1.0
    with pytest.raises(TableError, match="not a table of this program"):
        load_table(tmp_path / "other.h5")


def test_what_has_no_seal_is_refused_before_hdf5_sees_it(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    def parsed(*given: object) -> None:
        raise AssertionError("HDF5 was given a file without a seal")

    bare = tmp_path / "bare.h5"
    bare.write_bytes(file.read_bytes().rpartition(b"\npuck-tables")[0])
    cut = tmp_path / "cut.h5"
    cut.write_bytes(file.read_bytes()[:-1])
    monkeypatch.setattr(h5py, "File", parsed)
    for path in (bare, cut):
        with pytest.raises(TableError, match="digest"):
            load_table(path)


def test_a_sealed_file_is_still_checked(rough_table: Table, tmp_path: Path):
    """Whoever writes a right digest over wrong numbers is refused for the numbers."""
    bad = replace(rough_table, tolerance=float("inf"))
    with pytest.raises(TableError, match="tolerance is missing or no finite number"):
        save_table(bad, tmp_path / "bad.h5")
    with pytest.raises(TableError, match="cannot use"):
        save_table(replace(rough_table, values=-rough_table.values), tmp_path / "bad.h5")
    assert list(tmp_path.iterdir()) == []


def test_altered_values_text_and_axes_are_refused(file: Path, tmp_path: Path):
    with pytest.raises(TableError, match="digest"):
        load_table(altered(file, tmp_path / "text.h5", pressure_law="hertz"))
    with pytest.raises(TableError, match="digest"):
        load_table(altered(file, tmp_path / "tolerance.h5", tolerance=1e-12))
    for name in ("parallel", "phi"):
        path = tmp_path / f"{name}.h5"
        edited(file, path, lambda f, name=name: f[name].write_direct(f[name][...] * (1 + 1e-15)))
        path.write_bytes(sealed(path.read_bytes()))
        with pytest.raises(TableError, match="content does not match its digest"):
            load_table(path)


def test_every_flipped_byte_is_refused(file: Path, tmp_path: Path):
    """Before HDF5 reads a byte: there are flips that make it hang."""
    whole = file.read_bytes()
    rng = np.random.default_rng(2012)
    flipped = tmp_path / "flipped.h5"
    positions = {*rng.choice(len(whole), 300, replace=False), *range(len(whole) - 90, len(whole))}
    for position in positions:
        content = bytearray(whole)
        content[position] ^= 1 << int(rng.integers(8))
        flipped.write_bytes(content)
        with pytest.raises(TableError):
            load_table(flipped)


@pytest.mark.parametrize("share", [0.0, 0.01, 0.3, 0.9, 0.999])
def test_truncated_is_refused(file: Path, tmp_path: Path, share: float):
    content = file.read_bytes()
    cut = tmp_path / "cut.h5"
    cut.write_bytes(content[: int(share * len(content))])
    with pytest.raises(TableError):
        load_table(cut)


def test_missing_not_hdf5_and_folder_are_refused(tmp_path: Path):
    with pytest.raises(TableError, match="there is no table file"):
        load_table(tmp_path / "none.h5")
    (tmp_path / "text.h5").write_text("puck")
    with pytest.raises(TableError, match="not an HDF5 file"):
        load_table(tmp_path / "text.h5")
    with pytest.raises(TableError, match="not a regular file"):
        load_table(tmp_path)
    with pytest.raises(TableError, match="not a regular file"):
        load_table("/dev/zero")


def test_nothing_is_overwritten_and_nothing_non_finite_is_saved(file: Path, rough_table: Table):
    before = file.read_bytes()
    with pytest.raises(OutputError, match="exists already"):
        save_table(rough_table, file)
    spoilt = rough_table.values.copy()
    spoilt[0, 0, 0] = np.nan
    with pytest.raises(OutputError, match="non-finite"):
        save_table(replace(rough_table, values=spoilt), file, overwrite=True)
    assert file.read_bytes() == before
    assert [path.name for path in file.parent.iterdir()] == [file.name]


def test_full_disk_leaves_nothing(
    tmp_path: Path, rough_table: Table, monkeypatch: pytest.MonkeyPatch
):
    def full(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(OutputError, match="No space left on device"):
        save_table(rough_table, tmp_path / "full.h5")
    assert list(tmp_path.iterdir()) == []
