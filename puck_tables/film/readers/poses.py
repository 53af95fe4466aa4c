"""Films in HDF5: tables that DeepLabCut wrote with pandas, SLEAP's analysis files, and our own.

pandas keeps the names of columns as pickles.  They are never run: the few signs of which a list of
names consists are read one by one (:mod:`pickletools` only takes a pickle apart), and all others
are refused.

References
----------
DeepLabCut, "Output files": rows frames, columns (scorer, (individual,) bodypart, x|y|likelihood),
group ``df_with_missing``.  SLEAP, "Analysis HDF5": ``tracks`` (tracks, 2, nodes, frames) with
``track_names`` and ``node_names``; newer ones name other orders in the attribute ``dims``.
"""

from __future__ import annotations

import json
import pickletools
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.safe_read import HDF5
from puck_tables.errors import InputError
from puck_tables.film.column_roles import Layout, deeplabcut
from puck_tables.film.film import Film, Reader
from puck_tables.film.headings import Heading
from puck_tables.film.text_tables import csv_of, film_of_columns

_LARGEST = 1 << 27  # numbers in a file, a gigabyte
_DIMS = ("track", "xy", "node", "frame")
_DAMAGE = (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError)


def _film(path: str | Path, head: bytes) -> Film:
    """The film in an HDF5 file."""
    import h5py

    try:
        with h5py.File(path, "r") as file:
            if isinstance(file.get("tracks"), h5py.Dataset):
                return _sleap(path, file)
            for group in file.values():
                if isinstance(group, h5py.Group) and isinstance(group.get("table"), h5py.Dataset):
                    return _deeplabcut(path, group["table"])
            if "metadata" in file and "points" in file:
                raise InputError(
                    f"{path} is a project of SLEAP: export it as Analysis HDF5, or CSV"
                )
    except InputError:
        raise
    except _DAMAGE as error:
        raise InputError(f"{path} is damaged or no film: {error}") from None
    raise InputError(
        f"{path} is HDF5, but none of DeepLabCut (a pandas table) or SLEAP (Analysis HDF5): save "
        "the table as CSV"
    )


def _is_saved(path: str | Path, head: bytes) -> bool:
    """Whether it is one that this program saved."""
    import h5py

    if not head.startswith(HDF5):
        return False
    try:
        with h5py.File(path, "r") as file:
            return isinstance(file.get("time"), h5py.Dataset) and "source" in file.attrs
    except (OSError, RuntimeError, KeyError, ValueError):  # damaged
        return False


def _saved_as_csv(path: str | Path, head: bytes) -> bytes:
    """The columns of a file that this program saved, as a CSV file."""
    import h5py

    columns = {}
    try:
        with h5py.File(path, "r") as file:
            for name, one in file.items():
                if getattr(one, "ndim", 0) != 1 or "units" not in one.attrs:
                    continue
                if one.size > _LARGEST:
                    raise InputError(
                        f"{path}: its column {name} holds more than {_LARGEST} numbers"
                    )
                values, unit = one.asstr()[()] if one.dtype.kind == "O" else one[()], one.attrs
                columns[f"{name}[{unit['units']}]" if unit["units"] else name] = values.tolist()
        return csv_of([columns, *zip(*columns.values(), strict=True)])
    except InputError:
        raise
    except _DAMAGE as error:
        raise InputError(f"{path} is damaged or no film: {error}") from None


def _deeplabcut(path: str | Path, table: Any) -> Film:
    """The film in a table of pandas."""
    widths = (np.prod(table.dtype[name].shape, dtype=np.int64) for name in table.dtype.names)
    if table.size * int(sum(widths)) > _LARGEST:
        raise InputError(f"{path} holds more than {_LARGEST} numbers: cut it into shorter films")
    labels: list[Any] = []
    columns = [np.asarray(table["index"])]
    for name in table.dtype.names:
        kind = table.attrs.get(f"{name}_kind")
        if name == "index" or kind is None:
            continue
        values = np.asarray(table[name], dtype=np.float64).reshape(table.size, -1)
        named = _names_in(path, bytes(kind))
        columns += [*values.T]
        labels += named if len(named) == len(values.T) else [()]
    if not labels or not all(isinstance(one, tuple) and len(one) in (3, 4) for one in labels):
        raise InputError(f"{path} is a table of pandas, but none of DeepLabCut: save it as CSV")
    if not np.issubdtype(columns[0].dtype, np.integer):
        raise InputError(
            f"{path} names its frames instead of numbering them: it holds labels for training, "
            "not a film"
        )
    columns[0] = columns[0].astype(np.float64)
    layout = deeplabcut((one[1] if len(one) == 4 else "", *one[-2:]) for one in labels)
    return film_of_columns(path, layout, dict(enumerate(columns)), {})


def _names_in(path: str | Path, pickled: bytes) -> list[Any]:
    """The list of texts, and of tuples of texts, in a pickle that holds nothing else."""
    stack: list[Any] = []
    memo: dict[int, Any] = {}
    mark = object()

    def since() -> list[Any]:
        at = len(stack) - 1 - stack[::-1].index(mark)
        items = stack[at + 1 :]
        del stack[at:]
        return items

    try:
        for sign, value, _ in pickletools.genops(pickled):
            match sign.name:
                case "MARK":
                    stack.append(mark)
                case "UNICODE" | "BINUNICODE" | "SHORT_BINUNICODE" | "STRING":
                    stack.append(value)
                case "LIST" | "TUPLE":
                    items = since()
                    stack.append(items if sign.name == "LIST" else tuple(items))
                case "EMPTY_LIST":
                    stack.append([])
                case "TUPLE1" | "TUPLE2" | "TUPLE3":
                    count = int(sign.name[-1])
                    items = [stack.pop() for _ in range(count)][::-1]
                    stack.append(tuple(items))
                case "APPEND":
                    item = stack.pop()
                    stack[-1].append(item)
                case "APPENDS":
                    items = since()
                    stack[-1].extend(items)
                case "PUT" | "BINPUT" | "LONG_BINPUT":
                    memo[value] = stack[-1]  # type: ignore[index]
                case "MEMOIZE":
                    memo[len(memo)] = stack[-1]
                case "GET" | "BINGET" | "LONG_BINGET":
                    stack.append(memo[value])  # type: ignore[index]
                case "PROTO" | "FRAME" | "STOP":
                    pass
                case _:
                    raise InputError(
                        f"{path} names its columns by more than texts, which is not read: save "
                        "the table as CSV"
                    )
        (names,) = stack
        if not isinstance(names, list):
            raise ValueError
    except (ValueError, IndexError, KeyError, AttributeError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{path} is damaged: its names of columns cannot be read") from None
    return names


def _sleap(path: str | Path, file: Any) -> Film:
    """The film in an analysis file of SLEAP."""
    tracks = file["tracks"]
    if tracks.ndim != 4 or tracks.size > _LARGEST:
        raise InputError(
            f"{path}: 'tracks' must be tracks x 2 x nodes x frames, at most {_LARGEST} numbers, "
            f"got {tracks.shape}"
        )
    order = _order(tracks)
    if order is None or tracks.shape[order.index("xy")] != 2:
        raise InputError(
            f"{path} is of a version of SLEAP that is not known: its 'tracks' are {tracks.shape}; "
            "export it as CSV"
        )
    values = np.asarray(tracks, dtype=np.float64).transpose([order.index(one) for one in _DIMS])
    nodes = _names(file, "node_names", values.shape[2], "node")
    names = _names(file, "track_names", values.shape[0], "track")
    if len(names) == 1:
        names = [""]
    count, _, marks, frames = values.shape
    scores: FloatArray | None = None
    if "point_scores" in file and file["point_scores"].shape == (count, marks, frames):
        scores = np.asarray(file["point_scores"], dtype=np.float64)
    columns = [("", Heading("frame"))]
    numbers = [np.arange(values.shape[3], dtype=np.float64)]
    for n, k in np.ndindex(len(names), len(nodes)):
        row = [*values[n, :, k], *([] if scores is None else [scores[n, k]])]
        columns += [
            (names[n], Heading(role, nodes[k]))
            for role, _ in zip(("x", "y", "likelihood"), row, strict=False)
        ]
        numbers += row
    layout = Layout(columns, "SLEAP analysis file", jointed=True, pixels=True, likely=None)
    return film_of_columns(path, layout, dict(enumerate(numbers)), {})


def _order(tracks: Any) -> list[str] | None:
    """What the axes of the tracks are: as written, or as SLEAP always had them."""
    said = tracks.attrs.get("dims")
    if said is None:
        return list(_DIMS)
    listed = json.loads(said) if isinstance(said, str | bytes) else list(said)
    words = [str(one.decode() if isinstance(one, bytes) else one).lower() for one in listed]
    order = [next((dim for dim in _DIMS if dim in word), "") for word in words]
    return order if sorted(order) == sorted(_DIMS) else None


def _names(file: Any, key: str, count: int, what: str) -> list[str]:
    """The names of tracks or nodes, or numbers where there are none."""
    result = [
        " ".join((one.decode(errors="replace") if isinstance(one, bytes) else str(one)).split())
        for one in (np.asarray(file[key]).ravel().tolist() if key in file else ())
    ]
    return result if len(result) == count and all(result) else [f"{what} {n}" for n in range(count)]


READERS = (
    Reader(_is_saved, as_text=_saved_as_csv),
    Reader(lambda _, head: head.startswith(HDF5), _film),
)
