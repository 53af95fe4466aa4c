"""A reader of plain HDF5: numbers and texts on the root, contiguous arrays below it, no more.

The HDF5 library follows whatever a file's metadata say; some that are wrong make it go round for
ever, where not even Ctrl-C is heard.  Table files hold few shapes of HDF5, those that h5py writes
by default (version 0 of the format, old-style group and object headers), and only these are read
here.  Nothing is followed twice and nothing is taken that does not lie in the file, so every file
ends in an answer or an error at once.

References
----------
The HDF Group, HDF5 File Format Specification, version 3.0: sections II.A (superblock), III.A, B, D,
E (B-tree, symbol table, heaps), IV.A (object headers and their messages).
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray

Value = int | float | str

_SIGNATURE = b"\x89HDF\r\n\x1a\n"
_FLOAT = bytes.fromhex("11203f000800000000004000340b0034ff030000")  # little-endian double
_INTEGER = bytes.fromhex("100800000800000000004000")  # little-endian, signed, 64 bits
_TEXT = bytes.fromhex("1901010010000000100000000100000000000800")  # UTF-8, any length
# messages of an object header
_SPACE, _TYPE, _EXTERNAL, _LAYOUT, _FILTERS, _ATTRIBUTE, _MORE, _GROUP = (
    0x01, 0x03, 0x07, 0x08, 0x0B, 0x0C, 0x10, 0x11,
)  # fmt: skip
_SHARED = 2
# far more than a table has
_MOST, _MOST_NODES, _MOST_NAMES = 512, 64, 1 << 16
_CONTIGUOUS = 1
_HARD = (0, 1)  # kinds of links that lead to an object in this file


class PlainFile:
    """An HDF5 file in memory.

    Parameters
    ----------
    content : bytes

    Attributes
    ----------
    attributes : dict
        Those of the root by name; integers, floats and texts.

    Raises
    ------
    ValueError
        If it is no plain HDF5 file; also when an array is asked for.

    Examples
    --------
    >>> import io, h5py
    >>> buffer = io.BytesIO()
    >>> with h5py.File(buffer, "w") as file:
    ...     file.attrs["kind"] = "stops"
    ...     file["time"] = [1.0, 0.75]
    >>> found = PlainFile(buffer.getvalue())
    >>> found.attributes, found.array("time", (2,)).tolist()
    ({'kind': 'stops'}, [1.0, 0.75])
    """

    def __init__(self, content: bytes) -> None:
        self._content = content
        head = self._unpack("<8s6B", 0)
        if head[0] != _SIGNATURE or any(head[1:5]) or self._unpack("<BB", 13) != (8, 8):
            raise ValueError("not the version of HDF5 that this program writes")
        (base,) = self._unpack("<Q", 24)
        if base != 0:
            raise ValueError("a file within a file")
        messages = list(self._messages(self._unpack("<Q", 64)[0]))
        self.attributes = dict(
            self._attribute(at) for kind, at, _ in messages if kind == _ATTRIBUTE
        )
        groups = [at for kind, at, _ in messages if kind == _GROUP]
        if len(groups) != 1:
            raise ValueError("no root group")
        tree, heap = self._unpack("<QQ", groups[0])
        self._objects = self._names(tree, heap)

    def array(self, name: str, shape: tuple[int, ...]) -> FloatArray:
        """An array of doubles of this shape, which stands plainly in the file; read-only.

        Raises
        ------
        ValueError
            If it does not; its text ends a sentence that begins with the name of the file.
        """
        if name not in self._objects:
            raise ValueError(f"{name} is missing or a link")
        messages = list(self._messages(self._objects[name]))
        found = {kind: at for kind, at, _ in messages}
        if len([1 for kind, _, _ in messages if kind in (_SPACE, _TYPE, _LAYOUT)]) != 3:
            raise ValueError("its arrays do not fit its axes")
        if not self._content.startswith(_FLOAT, found[_TYPE]) or self._shape(found[_SPACE]) != list(
            shape
        ):
            raise ValueError("its arrays do not fit its axes")
        version, layout = self._unpack("<BB", found[_LAYOUT])
        if version != 3 or layout != _CONTIGUOUS or _FILTERS in found or _EXTERNAL in found:
            raise ValueError(f"{name} does not stand plainly in it")
        at, size = self._unpack("<QQ", found[_LAYOUT] + 2)
        count = int(np.prod(shape, dtype=np.float64))
        if size != 8 * count or at + size > len(self._content):
            raise ValueError("it is shorter than its arrays")
        return np.frombuffer(self._content, "<f8", count, at).astype(np.float64).reshape(shape)

    def _unpack(self, form: str, at: int) -> tuple[Any, ...]:
        try:
            return struct.unpack_from(form, self._content, at)
        except struct.error:
            raise ValueError("a place outside of the file") from None

    def _bytes(self, at: int, size: int) -> bytes:
        if at + size > len(self._content):
            raise ValueError("a place outside of the file")
        return self._content[at : at + size]

    def _messages(self, header: int) -> Iterator[tuple[int, int, int]]:
        """Kind, place and size of the messages of an object header with all its parts."""
        version, count, size = (self._unpack(f, header + i)[0] for f, i in
                                (("<B", 0), ("<H", 2), ("<I", 8)))  # fmt: skip
        if version != 1 or count > _MOST:
            raise ValueError("an object header of another version")
        parts = [(header + 16, size)]
        seen: set[int] = set()
        while parts:
            at, size = parts.pop(0)
            if at in seen:
                raise ValueError("an object header that leads to itself")
            seen.add(at)
            end = at + size
            while at + 8 <= end and count > 0:
                kind, length, flags = self._unpack("<HHB", at)
                at += 8
                if at + length > end:
                    raise ValueError("a message longer than its header")
                if flags & _SHARED and kind in (_SPACE, _TYPE, _LAYOUT, _ATTRIBUTE):
                    raise ValueError("a message that stands elsewhere")
                if kind == _MORE:
                    place, room = self._unpack("<QQ", at)
                    parts.append((place, room))
                else:
                    yield kind, at, length
                at += length
                count -= 1

    def _shape(self, at: int) -> list[int]:
        """The shape in a dataspace message."""
        version, rank, flags = self._unpack("<BBB", at)
        if version != 1 or flags > 1:
            raise ValueError("a dataspace of another version")
        return list(self._unpack(f"<{rank}Q", at + 8))

    def _attribute(self, at: int) -> tuple[str, Value]:
        """Name and value in an attribute message."""
        version, flags, name, kind, space = self._unpack("<BBHHH", at)
        if version not in (1, 3) or (version == 3 and flags != 0):
            raise ValueError("an attribute of another version")
        at += 8 if version == 1 else 9
        sizes = [-(-size // 8) * 8 for size in (name, kind, space)]  # version 1 pads them
        places = [at]
        for padded, size in zip(sizes, (name, kind, space), strict=True):
            places.append(places[-1] + (padded if version == 1 else size))
        text = self._bytes(at, name).rstrip(b"\0").decode()
        if self._shape(places[2]):
            raise ValueError(f"attribute {text} is an array")
        stored = self._bytes(places[1], kind).rstrip(b"\0")
        if stored == _FLOAT.rstrip(b"\0"):
            return text, float(struct.unpack("<d", self._bytes(places[3], 8))[0])
        if stored == _INTEGER.rstrip(b"\0"):
            return text, int(struct.unpack("<q", self._bytes(places[3], 8))[0])
        if stored == _TEXT.rstrip(b"\0"):
            return text, self._text(*self._unpack("<IQI", places[3]))
        raise ValueError(f"attribute {text} is neither a number nor a text")

    def _text(self, length: int, heap: int, wanted: int) -> str:
        """A text in a global heap."""
        if length == 0:
            return ""
        mark, version, size = (self._unpack(f, heap + i)[0] for f, i in
                               (("<4s", 0), ("<B", 4), ("<Q", 8)))  # fmt: skip
        if mark != b"GCOL" or version != 1:
            raise ValueError("no heap of texts")
        at, end = heap + 16, min(heap + size, len(self._content))
        for _ in range(_MOST):
            if at + 16 > end:
                break
            index, _, _, room = self._unpack("<HHIQ", at)
            if index == wanted:
                if length > room:
                    raise ValueError("a text longer than its place")
                return self._bytes(at + 16, length).decode()
            if index == 0:
                break
            at += 16 + -(-room // 8) * 8
        raise ValueError("a text that is not there")

    def _names(self, tree: int, heap: int) -> dict[str, int]:
        """Places of the objects of a group by name; links of other kinds are left out."""
        mark, version, size, _, data = self._unpack("<4sB3xQQQ", heap)
        if mark != b"HEAP" or version != 0 or size > _MOST_NAMES:
            raise ValueError("no names")
        objects: dict[str, int] = {}
        seen: set[int] = set()
        waiting = [tree]
        while waiting:
            node = waiting.pop()
            if node in seen or len(seen) > _MOST_NODES:
                raise ValueError("a group that leads to itself")
            seen.add(node)
            mark, used = self._unpack("<4s2xH", node)
            if mark not in (b"TREE", b"SNOD") or used > _MOST_NODES:
                raise ValueError("a group without its nodes")
            if mark == b"TREE":
                waiting += [self._unpack("<Q", node + 32 + 16 * i)[0] for i in range(used)]
                continue
            for entry in range(node + 8, node + 8 + 40 * used, 40):
                name, place, link = self._unpack("<QQI", entry)
                end = self._content.find(b"\0", data + name, data + size)
                if name >= size or end < 0:
                    raise ValueError("a name that is not there")
                if link in _HARD:
                    objects[self._bytes(data + name, end - data - name).decode()] = place
        return objects
