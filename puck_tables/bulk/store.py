"""Results of long work in a Zarr store, block by block; the one door to zarr.

A column is an array, a block of it a file with its CRC-32C, written under another name and renamed:
whole or not there.  The mark of a block is written last: it says by the checksums of its files that
this work made them.  All else, axes and labels, follows from the work: what is damaged of it is
written anew.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables._core.arrays import checked_threads
from puck_tables._core.executor import keep_on, run_chunks
from puck_tables._core.own_folder import say
from puck_tables._core.waiting import Progress
from puck_tables._version import __version__
from puck_tables.bulk.store_folder import DIGEST, shared, taken
from puck_tables.bulk.work import Columns, Tally, Work
from puck_tables.errors import InputError, MissingExtraError
from puck_tables.io.columns import Variable

try:
    import zarr
    from zarr.codecs import BytesCodec, Crc32cCodec
    from zarr.core.buffer import default_buffer_prototype
    from zarr.storage import MemoryStore
except ImportError:
    raise MissingExtraError("Zarr stores need zarr: pip install zarr") from None

NOT_DONE = -1  # the code of an item that is not computed yet
_AT_ONCE = {"write_empty_chunks": True}  # a block of NaN is a result, too
_CRC = 4  # bytes at the end of a file


class Store:
    """What is done of a work, in a Zarr store.

    ``path``: where it is, or is to be; a link is followed; ``work``: the work; ``begin``: whether
    it is made, or gone on with; else another process did so; ``overwrite``: whether it replaces a
    store of other work, when it is whole.  Raises InputError if it holds other work, or is no store
    of this program; OutputError if it cannot be made, or is not there.
    """

    def __init__(
        self, path: str | Path, work: Work, begin: bool = False, overwrite: bool = False
    ) -> None:
        self.path, self.work = Path(os.path.realpath(path)), work
        self.blocks = Blocks(work.shape, work.block)
        self.digest = work.digest
        self._files: dict[str, Any] = {}  # as zarr has them, on their way to or from the disk
        self._arrays = self._empty()
        start = {key: one.to_bytes() for key, one in self._files.items()}
        if begin:
            try:
                self.place = taken(self.path, self.digest, overwrite, start)
            except InputError as error:
                raise InputError(
                    f"{path}, a link: {error}" if os.path.islink(path) else str(error)
                ) from None
            self._mend(start)
        else:
            self.place = shared(self.path, self.digest)

    def _empty(self) -> dict[str, Any]:
        """Make the files of a store without results; the arrays of columns, the code last."""
        labels, blocks = self.work.labelled(self.work.virtual()), self.blocks
        kept = {name: value for name, value in labels.attributes.items() if value is not None}
        kept |= {name: text for name, (text, _) in labels.texts.items()}
        kept |= {"source": f"puck-tables {__version__}", DIGEST: self.digest}
        memory = MemoryStore(store_dict=self._files)
        group = zarr.create_group(memory, zarr_format=3, attributes=_plain(kept))
        for name, one in labels.axes.items():
            _put_whole(group, name, one)
        arrays = {}
        for name, one in labels.columns.items():
            if name not in self.work.columns and name != self.work.code:
                _put_whole(group, name, one)
                continue
            shape = np.shape(one.values)
            code = name == self.work.code
            arrays[name] = group.create_array(
                name, shape=shape, chunks=(*blocks.box, *shape[len(blocks.box) :]),
                dtype="i1" if code else "f8", fill_value=NOT_DONE if code else float("nan"),
                **_coded(one),
            )  # fmt: skip
        with warnings.catch_warnings():  # that others than xarray may not know it
            warnings.simplefilter("ignore")
            zarr.consolidate_metadata(memory)
        return {name: arrays[name] for name in (*self.work.columns, self.work.code)}

    def _mend(self, start: Mapping[str, bytes]) -> None:
        """Write anew what is missing or damaged of the axes and labels."""
        damaged = [key for key, one in start.items() if not _is_whole(self.place.content(key), one)]
        if damaged:
            self.place.refuse_lost()  # another work may be removing it
            for key in damaged:
                self.place.put(key, start[key])
            names = ", ".join(dict.fromkeys(key.split("/")[0] for key in damaged))
            say(f"{self.path}: missing or damaged, and written anew: {names}")

    def do(self, block: int) -> Tally:
        """Compute a block and keep it, unless it is there, whole; the tally of its codes.

        Raises OutputError if the disk does not take it, or the store belongs to another work by
        now; what was kept before stays.
        """
        self.place.refuse_lost()
        start, stop = self.blocks.run(block)
        result = self._kept(block)
        if result is None:
            result = self.work.columns_of(stop - start)
            for begin in range(start, stop, self.work.part):
                self.work.filled(result, begin, min(begin + self.work.part, stop), start)
                keep_on()
            self._keep(block, result)
        return Tally.of(result[self.work.code], start)

    def _kept(self, block: int) -> Columns | None:
        """The columns of a block, flat, if this work made all its files and they are whole."""
        keys = [self._key(name, block) for name in self._arrays]
        ends = [self.place.content(key, _CRC) for key in keys]
        if self.place.content(self._mark_key(block)) != self._mark(block, ends):
            return None
        box, (start, stop) = (*self.blocks.slices(block), ...), self.blocks.run(block)
        result: Columns = {}
        for key, (name, array) in zip(keys, self._arrays.items(), strict=True):
            content = self.place.content(key)
            if content is None:
                return None
            self._files[key] = default_buffer_prototype().buffer.from_bytes(content)
            try:
                values = np.asarray(array[box])
            except (OSError, ValueError, RuntimeError):  # a wrong checksum
                return None
            finally:
                del self._files[key]
            result[name] = values.reshape((stop - start, *self.work.columns.get(name, ())))
        return result

    def _keep(self, block: int, result: Columns) -> None:
        box = self.blocks.slices(block)
        shape = tuple(one.stop - one.start for one in box)
        ends: list[bytes | None] = []
        for name, array in self._arrays.items():
            array[(*box, ...)] = result[name].reshape((*shape, *result[name].shape[1:]))
            key = self._key(name, block)
            content = memoryview(self._files.pop(key).as_numpy_array())
            self.place.put(key, content)
            ends.append(bytes(content[-_CRC:]))
        self.place.put(self._mark_key(block), self._mark(block, ends))
        self.place.refuse_lost()

    def _key(self, name: str, block: int) -> str:
        """The file of a block of a column."""
        trailing = self._arrays[name].ndim - len(self.work.shape)
        place = (*self.blocks.place(block), *(0,) * trailing)
        return f"{name}/{self._arrays[name].metadata.encode_chunk_key(place)}"

    def _mark_key(self, block: int) -> str:
        return f"{self.work.code}/made/{block}"

    def _mark(self, block: int, ends: list[bytes | None]) -> bytes:
        """What says that this work made the files of a block, which end in these checksums."""
        what = repr((self.digest, block, ends))
        return hashlib.sha256(what.encode()).hexdigest().encode()

    def read(self) -> Columns:
        """The columns of the whole shape.

        Raises InputError if a block is missing or damaged.
        """
        result = self.work.columns_of(self.work.size)
        for block in range(self.blocks.count):
            one = self._kept(block)
            if one is None:
                raise InputError(
                    f"{self.path}: block {block} of {self.blocks.count} is missing or damaged: the "
                    "same work does it again"
                )
            start, stop = self.blocks.run(block)
            for name, values in one.items():
                result[name][start:stop] = values
        return {
            name: one.reshape((*self.work.shape, *one.shape[1:])) for name, one in result.items()
        }


def by_threads(store: Store, threads: int | None, progress: Progress | None) -> Tally:
    """Do all blocks of a store, on the threads of this process.

    Raises OutputError if the disk does not take them.
    """
    checked_threads(threads)
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


def _covers(result: Any, wanted: Any) -> bool:
    """Whether all that is wanted is there, perhaps with attributes of others."""
    if isinstance(result, dict) and isinstance(wanted, dict):
        return all(key in result and _covers(result[key], one) for key, one in wanted.items())
    return bool(result == wanted)


def _is_whole(result: bytes | None, wanted: bytes) -> bool:
    if result is None or result == wanted:
        return result is not None
    try:
        return _covers(json.loads(result), json.loads(wanted))
    except (ValueError, RecursionError):  # no labels, but an axis
        return False


def _put_whole(group: Any, name: str, one: Variable) -> None:
    """A coordinate, or what else does not belong to items, with its values; texts as codes."""
    values = np.asarray(one.values)
    if values.dtype.kind in "UO":
        texts = [str(text) for text in values.ravel()]
        flags = tuple(dict.fromkeys(texts))
        codes = np.array([flags.index(text) for text in texts], np.int16).reshape(values.shape)
        one, values = Variable(codes, one.dims, one.unit, one.long_name, flags), codes
    # what is missing is not read as zeros
    fill = {"f": float("nan"), "i": -1}.get(values.dtype.kind, 0)
    array = group.create_array(
        name, shape=values.shape, dtype=values.dtype, fill_value=fill, **_coded(one)
    )
    array[...] = values


def _coded(one: Variable) -> dict[str, Any]:
    """How an array is kept: as its bytes with a checksum, nothing packed; with its labels."""
    return {
        "serializer": BytesCodec(), "compressors": [Crc32cCodec()], "filters": [],
        "dimension_names": list(one.dims), "attributes": _plain(one.attributes), "config": _AT_ONCE,
    }  # fmt: skip


def _plain(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Attributes as JSON takes them."""
    return {
        name: value.tolist() if isinstance(value, np.generic | np.ndarray) else value
        for name, value in attributes.items()
    }


@dataclass(frozen=True)
class Blocks:
    """Blocks of at most ``size`` items (at least one) over a shape.

    Each is a box, as a store of arrays wants it, and a run of items in C order, as the work is
    done: the last axes are whole, one is cut evenly, those before it one by one.

    >>> blocks = Blocks((3, 10), 6)
    >>> blocks.box, blocks.count, blocks.run(1), blocks.place(1)
    ((1, 5), 6, (5, 10), (0, 1))
    """

    shape: tuple[int, ...]
    size: int

    @property
    def box(self) -> tuple[int, ...]:
        """How many items along each axis."""
        blocked, inner = self._blocked
        if blocked < 0:
            return self.shape
        length = self.shape[blocked]
        parts = -(-length // max(1, self.size // inner))
        return *(1 for _ in self.shape[:blocked]), -(-length // parts), *self.shape[blocked + 1 :]

    @property
    def _blocked(self) -> tuple[int, int]:
        """The axis that is cut, −1 for none, and how many items the axes behind it have."""
        inner = 1
        for axis in reversed(range(len(self.shape))):
            if inner * self.shape[axis] > self.size:
                return axis, inner
            inner *= self.shape[axis]
        return -1, inner

    @property
    def grid(self) -> tuple[int, ...]:
        """How many blocks along each axis."""
        return tuple(-(-n // one) for n, one in zip(self.shape, self.box, strict=True))

    @property
    def count(self) -> int:
        """How many blocks."""
        return math.prod(self.grid)

    def place(self, block: int) -> tuple[int, ...]:
        """Which block it is along each axis."""
        result = []
        for n in reversed(self.grid):
            block, rest = divmod(block, n)
            result.append(rest)
        return tuple(reversed(result))

    def slices(self, block: int) -> tuple[slice, ...]:
        """Its box."""
        return tuple(
            slice(place * one, min((place + 1) * one, n))
            for place, one, n in zip(self.place(block), self.box, self.shape, strict=True)
        )

    def run(self, block: int) -> tuple[int, int]:
        """Its first item, and the first behind it."""
        start, items = 0, 1
        for one, n in zip(self.slices(block), self.shape, strict=True):
            start = start * n + one.start
            items *= one.stop - one.start
        return start, start + items
