"""Results of long work in a Zarr store, block by block; the one door to zarr.

A column is an array, a block of it a file with its CRC-32C, written under another name and renamed:
whole or not there.  The code of a block is written last.  The attributes of the store say by a
digest which work it is, so that the same work goes on and any other is refused.
"""

from __future__ import annotations

import secrets
import shutil
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.executor import Progress, keep_on, run_chunks
from puck_tables._core.safe_write import PART_PATTERN
from puck_tables._version import __version__
from puck_tables.bulk.blocks import Blocks
from puck_tables.bulk.work import Columns, Tally, Work, refuse_no_threads
from puck_tables.errors import InputError, MissingExtraError, OutputError
from puck_tables.io.dataset import Variable

try:
    import zarr
    from zarr.codecs import BytesCodec, Crc32cCodec
except ImportError:
    raise MissingExtraError('Zarr stores need zarr: pip install "puck-tables[cluster]"') from None

DIGEST = "puck_tables_work"
NOT_DONE = -1  # the code of an item that is not computed yet
_NO_STORE = (OSError, ValueError, KeyError, TypeError, AttributeError)  # what zarr says of others
_AT_ONCE = {"write_empty_chunks": True}  # a block of NaN is a result, too


class Store:
    """What is done of a work, in a Zarr store: made, or gone on with if it holds the same work.

    Parameters
    ----------
    path : where it is, or is to be
    work : the work
    overwrite : whether a store of other work may be replaced

    Raises
    ------
    InputError
        If it holds other work, or is no store of this program.
    OutputError
        If it cannot be made.
    """

    def __init__(self, path: str | Path, work: Work, overwrite: bool = False) -> None:
        self.path, self.work = Path(path).absolute(), work
        self.blocks = Blocks(work.shape, work.block)
        self.digest = work.digest
        if not (self.path.exists() and self._goes_on(overwrite)):
            self._make()
        self._open()

    def _open(self) -> None:
        names = [*self.work.columns, self.work.code]
        self._arrays: dict[str, Any] = {}
        try:
            self._arrays = {
                name: zarr.open_array(self.path / name, mode="r+", config=_AT_ONCE)
                for name in names
            }
        except _NO_STORE:
            self._arrays.clear()
        box = self.blocks.box
        if not self._arrays or any(
            array.shape[: len(box)] != self.work.shape or array.chunks[: len(box)] != box
            for array in self._arrays.values()
        ):
            raise InputError(f"{self.path} is damaged: give another name, or remove it")

    def _goes_on(self, overwrite: bool) -> bool:
        """Whether the same work is there; what may be replaced is put away."""
        try:
            attributes = zarr.open_group(self.path, mode="r").attrs.asdict()
        except _NO_STORE:
            attributes = {}
        found = attributes.get(DIGEST)
        if found == self.digest:
            return True
        if found is None:
            raise InputError(
                f"{self.path} exists and is no Zarr store of this program: give another name"
            )
        if not overwrite:
            raise InputError(
                f"{self.path} holds other work: give the arguments, files and program that it was "
                "begun with, another name, or --overwrite (overwrite=True) to replace it"
            )
        old = self._part()
        self.path.rename(old)
        shutil.rmtree(old)
        return False

    def _part(self) -> Path:
        return self.path.with_name(PART_PATTERN.replace("*", secrets.token_hex(8)))

    def _make(self) -> None:
        """The store without results, under another name, then its own: never a part of it."""
        part = self._part()
        try:
            part.mkdir()  # zarr would make those above it, too
            self._fill(part)
            if self.path.exists():
                raise FileExistsError(17, "it has just been made by another process", str(part))
            part.rename(self.path)
        except OSError as error:
            raise OutputError(f"cannot write {self.path}: {error.strerror or error}") from None
        finally:
            shutil.rmtree(part, ignore_errors=True)

    def _fill(self, part: Path) -> None:
        labels, blocks = self.work.labelled(self.work.virtual()), self.blocks
        kept = {name: value for name, value in labels.attributes.items() if value is not None}
        kept |= {name: text for name, (text, _) in labels.texts.items()}
        kept |= {"source": f"puck-tables {__version__}", DIGEST: self.digest}
        group = zarr.create_group(part, zarr_format=3, attributes=_plain(kept))
        for name, one in labels.axes.items():
            _put_whole(group, name, one)
        for name, one in labels.columns.items():
            if name not in self.work.columns and name != self.work.code:
                _put_whole(group, name, one)
                continue
            shape = np.shape(one.values)
            code = name == self.work.code
            group.create_array(
                name, shape=shape, chunks=(*blocks.box, *shape[len(blocks.box) :]),
                dtype="i1" if code else "f8", fill_value=NOT_DONE if code else float("nan"),
                **_coded(one),
            )  # fmt: skip
        with warnings.catch_warnings():  # that others than xarray may not know it
            warnings.simplefilter("ignore")
            zarr.consolidate_metadata(part)

    def do(self, block: int) -> Tally:
        """Compute a block and keep it, unless it is there, whole; the tally of its codes.

        Raises
        ------
        OutputError
            If the disk does not take it; what was kept before stays.
        """
        start, stop = self.blocks.run(block)
        codes = self._done(block)
        if codes is None:
            found = self.work.columns_of(stop - start)
            for begin in range(start, stop, self.work.part):
                self.work.filled(found, begin, min(begin + self.work.part, stop), start)
                keep_on()
            self._keep(block, found)
            codes = found[self.work.code]
        return Tally.of(codes, start)

    def _done(self, block: int) -> npt.NDArray[np.int8] | None:
        """The codes of a block whose files are all there and whole; nothing is left of others."""
        files = [self._file(name, block) for name in self._arrays]
        if all(file.is_file() for file in files):
            try:
                columns = self.read(block)
                if (columns[self.work.code] != NOT_DONE).all():
                    return columns[self.work.code]
            except (OSError, ValueError, RuntimeError):
                pass
        for file in files:  # zarr would read what it is to write over
            file.unlink(missing_ok=True)
        return None

    def _file(self, name: str, block: int) -> Path:
        trailing = self._arrays[name].ndim - len(self.work.shape)
        key = self._arrays[name].metadata.encode_chunk_key(
            (*self.blocks.place(block), *(0,) * trailing)
        )
        return self.path / name / str(key)

    def _keep(self, block: int, found: Columns) -> None:
        box = self.blocks.slices(block)
        shape = tuple(one.stop - one.start for one in box)
        try:
            for name, array in self._arrays.items():  # the code is the last of them
                array[(*box, ...)] = found[name].reshape((*shape, *found[name].shape[1:]))
        except OSError as error:
            raise OutputError(f"cannot write {self.path}: {error.strerror or error}") from None

    def read(self, block: int | None = None) -> Columns:
        """The columns of a block, flat, or of the whole shape.

        Raises
        ------
        ValueError
            If a checksum is wrong.
        """
        if block is None:
            return {name: np.asarray(array[...]) for name, array in self._arrays.items()}
        box = (*self.blocks.slices(block), ...)
        start, stop = self.blocks.run(block)
        shapes = {name: (stop - start, *self.work.columns.get(name, ())) for name in self._arrays}
        return {
            name: np.asarray(array[box]).reshape(shapes[name])
            for name, array in self._arrays.items()
        }


def by_threads(store: Store, threads: int | None, progress: Progress | None) -> Tally:
    """Do all blocks of a store, on the threads of this process.

    Raises
    ------
    OutputError
        If the disk does not take them.
    """
    refuse_no_threads(threads)
    blocks, done = store.blocks, 0
    tallies: dict[int, Tally] = {}

    def some(start: int, stop: int) -> None:
        for block in range(start, stop):
            tallies[block] = store.do(block)

    def tell(_: int, __: int) -> None:
        nonlocal done
        done = sum(sum(tally.counts.values()) for tally in list(tallies.values()))
        if progress is not None:
            progress(done, store.work.size)

    run_chunks(some, blocks.count, 1, threads, tell)
    return sum(tallies.values(), Tally({}, {}))


def _put_whole(group: Any, name: str, one: Variable) -> None:
    """A coordinate, or what else does not belong to items, with its values; texts as codes."""
    values = np.asarray(one.values)
    if values.dtype.kind in "UO":
        texts = [str(text) for text in values.ravel()]
        flags = tuple(dict.fromkeys(texts))
        codes = np.array([flags.index(text) for text in texts], np.int16).reshape(values.shape)
        one, values = Variable(codes, one.dims, one.unit, one.long_name, flags), codes
    array = group.create_array(name, shape=values.shape, dtype=values.dtype, **_coded(one))
    array[...] = values


def _coded(one: Variable) -> dict[str, Any]:
    """How an array is kept: as its bytes with a checksum, nothing packed; with its labels."""
    attributes: dict[str, Any] = {"units": one.unit or "1", "long_name": one.long_name}
    if one.flags:
        attributes["flag_values"] = list(range(len(one.flags)))
        attributes["flag_meanings"] = " ".join(flag.replace(" ", "_") for flag in one.flags)
    return {
        "serializer": BytesCodec(), "compressors": [Crc32cCodec()], "filters": [],
        "dimension_names": list(one.dims), "attributes": attributes, "config": _AT_ONCE,
    }  # fmt: skip


def _plain(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Attributes as JSON takes them."""
    return {
        name: value.item() if isinstance(value, np.generic) else value
        for name, value in attributes.items()
    }
