"""Films in text files: wide (a column a puck) and long (a row a puck), with any header."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError
from puck_tables.film.film import Body, Film, Flags
from puck_tables.film.headings import Heading, heading, headings, is_unit
from puck_tables.film.text import Look, look_at, number, read_columns, split
from puck_tables.film.units import factor

MOST_PUCKS = 10_000
_YES = {"true", "yes", "y", "t", "ja", "j", "oui", "si", "sí", "wahr", "ok"}
_NO = {"false", "no", "n", "f", "nein", "non", "falsch", ""}
_SHOWN, _HIDDEN = (
    {"visible", "seen", "shown", "detected"},
    {"hidden", "occluded", "lost", "missing"},
)
_TRACKPY = {"frame", "particle", "x", "y"}
_LIKELY = 0.6  # what DeepLabCut takes for a mark that is there ('pcutoff')


@dataclass
class _Layout:
    """Columns with the body that they are of, and what kind of file has such."""

    columns: list[tuple[str, Heading]]
    kind: str = "table"
    jointed: bool = False
    pixels: bool = False
    likely: float | None = _LIKELY


def film_of_table(path: str | Path, head: bytes, columns: str | None) -> Film:
    """The film in a text file.

    Parameters
    ----------
    path : the file
    head : how it begins
    columns : headings for its columns with commas, in place of those in the file

    Raises
    ------
    InputError
        If it is no table, has no header where none is given, or columns that do not fit.
    """
    look = look_at(path, head)
    layout = _layout(path, look, columns)
    for n, (body, one) in enumerate(layout.columns):
        cells = {row[n].lower() for row in look.rows if n < len(row)}
        if not one.role and cells & _HIDDEN and cells <= _SHOWN | _HIDDEN:
            layout.columns[n] = (body, Heading("seen"))  # whatever it is called
    wanted = [n for n, (_, one) in enumerate(layout.columns) if one.role]
    texts = [n for n in wanted if _holds_text(look, n, layout.columns[n][1])]
    values, words = read_columns(path, look, [n for n in wanted if n not in texts], texts)
    film = Film(layout.kind, [], jointed=layout.jointed, likely=layout.likely)
    if unused := [n for n in range(look.width) if n not in wanted and layout.kind == "table"]:
        film.notes.append(f"column {', '.join(_name(look, n) for n in unused[:8])} left out")
    film.unit, film.angle_unit, film.timed = _units(path, layout)
    if layout.pixels:
        film.unit = film.unit or "px"
        film.y_down = True if film.unit == "px" else None
    rows = _rows(path, layout, values, words)
    apart = list(dict.fromkeys(body for body, _ in layout.columns if body))
    for name, chosen in rows.items():
        for body in apart or [name]:
            mine = {
                n: one for n, (whose, one) in enumerate(layout.columns)
                if one.role and whose in ("", body)
            }  # fmt: skip
            film.bodies.append(_body(path, body, mine, values, words, chosen))
    return film


def _layout(path: str | Path, look: Look, columns: str | None) -> _Layout:
    """What the columns are."""
    header = [row[: look.width] + [""] * (look.width - len(row)) for row in look.header]
    if columns is not None:
        names = [name.strip() for name in columns.split(",")]
        if len(names) != look.width:
            raise InputError(
                f"{path} has {look.width} columns, and columns names {len(names)}: name each, "
                f"with - for those to leave out (its first row is {_shown(look.rows[0])})"
            )
        return _named(["" if name == "-" else name for name in names])
    if not header and (said := _commented(look)):
        header = [said]
    if not header:
        raise InputError(
            f"{path} has no header: say what its {look.width} columns are, such as "
            f"columns='{_example(look.width)}' (--columns); its first row is {_shown(look.rows[0])}"
        )
    if header[0][0].lower() == "scorer":
        return _deeplabcut(path, header)
    if len(header) > 1 and all(is_unit(cell) or cell in ("", "-") for cell in header[-1]):
        units = header.pop()
        header[-1] = [
            f"{name} [{unit.strip('[]() ')}]" if unit not in ("", "-") else name
            for name, unit in zip(header[-1], units, strict=True)
        ]
    names = header[-1]
    layout = _named(names, _owners(header)) if len(header) > 1 else _named(names)
    found = {name.lower() for name in names}
    if found >= _TRACKPY:
        layout.kind, layout.pixels = "trackpy table", True
    if "frame_idx" in found and {"track", "instance.score"} & found:
        layout.kind, layout.pixels, layout.jointed, layout.likely = "SLEAP table", True, True, None
    return layout


def _owners(header: list[list[str]]) -> list[str]:
    """The names of pucks over those of columns, each over its first; none if they fit none."""
    over = header[-2]
    owners = [next((cell for cell in over[n::-1] if cell), "") for n in range(len(over))]
    if sum(map(bool, over)) == 1 and over[0]:  # Tracker's export of one track: its name, alone
        owners = [over[0]] * len(over)
    whose = {"x": set[str](), "y": set[str]()}
    for owner, one in zip(owners, map(heading, header[-1]), strict=True):
        if one.role in whose:
            whose[one.role].add(owner)
    return owners if whose["x"] == whose["y"] else []


def _named(names: Sequence[str], owners: Sequence[str] = ()) -> _Layout:
    """The columns of a table with one row of names; ``owners`` are names of pucks over them."""
    read = headings(names) if not any(owners) else [heading(name) for name in names]
    if any(owners):
        read = [
            one._replace(puck=" ".join(filter(None, (owner, one.puck))))
            if one.role in ("x", "y", "angle", "seen", "hidden", "likelihood") else one
            for one, owner in zip(read, owners, strict=True)
        ]  # fmt: skip
    if any(name.lower() == "instance.score" for name in names):
        read = [Heading("") if one.puck == "instance" else one for one in read]
    return _Layout(list(zip(_blocks(read), read, strict=True)))


def _blocks(read: Sequence[Heading]) -> list[str]:
    """Bodies of columns where each puck has times of its own: blocks that begin, or end, with one.

    Examples
    --------
    >>> _blocks(headings(["t", "x", "y", "t", "x", "y"]))
    ['1', '1', '1', '2', '2', '2']
    """
    times = [n for n, one in enumerate(read) if one.role == "time"]
    if len(times) < 2:
        return [""] * len(read)
    first = next((n for n, one in enumerate(read) if one.role in ("x", "y")), 0)
    count = [sum(t <= n if times[0] <= first else t < n for t in times) for n in range(len(read))]
    block = [n if times[0] <= first else n + 1 for n in count]
    names = {
        n: {one.puck for at, one in zip(block, read, strict=True) if at == n and one.role == "x"}
        for n in block
    }
    return [names[n].copy().pop() if len(names[n]) == 1 and names[n] != {""} else str(n)
            for n in block]  # fmt: skip


def _deeplabcut(path: str | Path, header: list[list[str]]) -> _Layout:
    """The columns of DeepLabCut's tables: rows scorer, (individuals,) bodyparts, coords."""
    rows = {row[0].lower(): row for row in header}
    if not {"bodyparts", "coords"} <= set(rows):
        raise InputError(
            f"{path} begins as DeepLabCut's tables do but has no rows 'bodyparts' and 'coords': "
            "another version, which this program does not know"
        )
    owners = rows.get("individuals", [""] * len(header[0]))
    columns = [("", Heading("frame"))]
    for n in range(1, len(header[0])):
        role = rows["coords"][n].lower()
        known = role if role in ("x", "y", "likelihood") else ""
        columns.append((owners[n], Heading(known, rows["bodyparts"][n], "")))
    return _Layout(columns, "DeepLabCut table", jointed=True, pixels=True)


def _commented(look: Look) -> list[str]:
    """The header in the last comment over the numbers, if there is one."""
    for line in reversed(look.said):
        cells = split(re.sub(r"^[#%/\s]+", "", line), look.separator)
        if len(cells) == look.width and {"x", "y"} <= {one.role for one in map(heading, cells)}:
            return cells
    return []


def _name(look: Look, column: int) -> str:
    """A column in words: its name in the last row of them, or its number."""
    names = look.header[-1] if look.header else []
    return names[column] if column < len(names) and names[column] else str(column + 1)


def _example(width: int) -> str:
    names = ["t", "x", "y", "angle"][:width]
    return ",".join(names + ["-"] * (width - len(names)))


def _shown(row: Sequence[str]) -> str:
    return ", ".join(cell or "''" for cell in row[:8])[:80]


def _holds_text(look: Look, column: int, what: Heading) -> bool:
    """Whether a column of ids or flags holds texts."""
    if what.role not in ("id", "seen", "hidden"):
        return False
    cells = [row[column] for row in look.rows if column < len(row)]
    return any(number(cell, look.comma) is None for cell in cells) or not any(cells)


def _units(path: str | Path, layout: _Layout) -> tuple[str, str, bool]:
    """Units of places and angles, and whether that of times is named."""
    headed = [one for _, one in layout.columns]
    said = []
    for roles in (("x", "y"), ("angle",)):
        units = {one.unit for one in headed if one.role in roles}
        if len(units) > 1:
            raise InputError(
                f"{path}: its columns {' and '.join(roles)} are not all in one unit "
                f"({', '.join(unit or 'none said' for unit in sorted(units))}): name all with "
                "columns (--columns)"
            )
        said.append(units.pop() if units else "")
    timed = all(one.unit for one in headed if one.role in ("time", "step"))
    return said[0], said[1], timed


def _rows(
    path: str | Path, layout: _Layout, values: dict[int, FloatArray], words: dict[int, Any]
) -> dict[str, Any]:
    """Which rows are of which puck, by its name: all of them where no column says whose they are.

    Rows of a puck are put in the order of their frames or times: a long table has none.
    """
    whose = next((n for n, (_, one) in enumerate(layout.columns) if one.role == "id"), None)
    if whose is None:
        return {"": slice(None)}
    if whose in words:
        codes, names = words[whose]
    else:
        numbers, codes = np.unique(values[whose], return_inverse=True, equal_nan=True)
        names = [f"{one:.15g}" for one in numbers]
    size = codes.size
    if len(names) == size > 1:  # a number of the row
        return {"": slice(None)}
    if len(names) > MOST_PUCKS:
        raise InputError(
            f"{path} has {len(names)} pucks, at most {MOST_PUCKS} are read: leave out what is none"
        )
    by = next(
        (n for role in ("frame", "time") for n, (_, one) in enumerate(layout.columns)
         if one.role == role), None,
    )  # fmt: skip
    order = np.argsort(codes, kind="stable") if by is None else np.lexsort((values[by], codes))
    ends = np.cumsum(np.bincount(codes, minlength=len(names)))
    starts = np.concatenate([[0], ends[:-1]])
    return {
        name: order[start:end] for name, start, end in zip(names, starts, ends, strict=True)
        if name != "nan"
    }  # fmt: skip


def _body(
    path: str | Path, name: str, columns: dict[int, Heading], values: dict[int, FloatArray],
    words: dict[int, Any], rows: Any,
) -> Body:  # fmt: skip
    """One body from its columns and rows."""
    found: dict[tuple[str, str], FloatArray] = {}
    units: dict[str, str] = {}
    seen: dict[str, Flags] = {}
    for n, one in columns.items():
        if one.role in ("seen", "hidden"):
            flags = _flags(path, n, one.role, values, words)[rows]
            seen[one.puck] = seen[one.puck] & flags if one.puck in seen else flags
        elif one.role != "id":
            if (one.role, one.puck) in found:
                raise InputError(
                    f"{path} has two columns '{one.role}' of one puck: name its columns apart, or "
                    "with columns (--columns)"
                )
            found[one.role, one.puck] = values[n][rows]
            units[one.role] = one.unit
    marks = {}
    for role, mark in found:
        if role not in ("x", "y"):
            continue
        other = found.get(("y" if role == "x" else "x", mark))
        if other is None:
            raise InputError(
                f"{path} has a column {role} {f'of {mark} ' if mark else ''}without its "
                f"{'y' if role == 'x' else 'x'}: name its columns with columns (--columns)"
            )
        marks[mark] = np.column_stack([found["x", mark], found["y", mark]])
    if not marks:
        raise InputError(
            f"{path} has no columns x and y that are known by their names: say what its columns "
            "are, such as columns='t,x,y,-' (--columns)"
        )
    body = Body(name, marks, seen=seen)
    clocks = {}
    for (role, _), value in found.items():
        if role in clocks:
            raise InputError(
                f"{path} has two columns of {role}: read the pucks one by one, with - in columns "
                "(--columns) for those of others"
            )
        if role in ("frame", "time", "step"):
            clocks[role] = value
    body.frame, body.time = clocks.get("frame"), clocks.get("time")
    if body.time is not None:
        body.time = body.time * factor(units["time"] or "s", "time")
    elif "step" in clocks:
        steps = clocks["step"] * factor(units["step"] or "s", "time")
        body.time = np.concatenate([[0.0], np.cumsum(steps[1:])])
    body.angles = {mark: value for (role, mark), value in found.items() if role == "angle"}
    body.likelihoods = {
        mark: value for (role, mark), value in found.items() if role == "likelihood"
    }
    return body


def _flags(
    path: str | Path, column: int, role: str, values: dict[int, FloatArray], words: dict[int, Any]
) -> Flags:
    """Whether the puck is seen, row by row, from a column of flags."""
    if column in words:
        codes, texts = words[column]
        shown = []
        for text in texts:
            low = text.lower()
            if low not in _SHOWN | _HIDDEN | _YES | _NO | {"0", "1"}:
                raise InputError(
                    f"{path}, column {column + 1}: '{text:.30}' does not say whether the puck is "
                    "seen: write 1 or 0, true or false"
                )
            yes = low in _YES | {"1"}
            shown.append(low in _SHOWN or (low not in _HIDDEN and yes == (role == "seen")))
        by_row: Flags = np.array(shown, bool)[codes]
        return by_row
    flags = values[column]
    if not np.isin(flags[~np.isnan(flags)], (0.0, 1.0)).all():
        raise InputError(
            f"{path}, column {column + 1}: flags of what is seen must be 0 or 1; leave the column "
            "out with - in columns (--columns)"
        )
    result: Flags = flags == (1.0 if role == "seen" else 0.0)
    return result
