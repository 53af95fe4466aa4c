"""Films in text files: wide (a column a puck) and long (a row a puck), with any header."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.text import TextForm, number, text_form_of
from puck_tables._core.text_rows import read_columns
from puck_tables._core.units import factor, unit_size
from puck_tables.errors import InputError
from puck_tables.film.column_roles import Layout, example, name_of
from puck_tables.film.film import ANGLES, Film, Flags, TrackedBody
from puck_tables.film.headings import Heading

MOST_PUCKS = 10_000  # in one file: more is a column of another meaning
_TURN = ("qx", "qy", "qz", "qw")
_YES = {"true", "yes", "y", "t", "ja", "j", "oui", "si", "sí", "wahr", "ok", "1"}
_NO = {"false", "no", "n", "f", "nein", "non", "falsch", "", "0"}
_SHOWN = {"visible", "seen", "shown", "detected"}
_HIDDEN = {"hidden", "occluded", "lost", "missing"}
_DATE = re.compile(
    r"([0-9]{4}-[0-9]{2}-[0-9]{2})[T ]([0-9]{2}:[0-9]{2}:[0-9]{2})(?:[.,]([0-9]{1,9}))?"
    r"(Z|[+-][0-9]{2}:?[0-9]{2})?"
)
_CLOCK = re.compile(r"(?:([0-9]{1,3}):)?([0-9]{1,2}):([0-9]{1,2})(?:[.,]([0-9]{1,9}))?")
_NANO = 1e-9  # s


def film_in_text(
    path: str | Path, form: TextForm, layout: Layout, content: bytes | None = None
) -> Film:
    r"""The film in a table of text whose columns are known; ``content``: its bytes, if read.

    >>> form = text_form_of("a.tsv", b"7\t9\n8\t9\n")
    >>> layout = Layout([("", Heading("x", "", "mm")), ("", Heading("y", "", "mm"))], "file")
    >>> film_in_text("a.tsv", form, layout, b"7\t9\n8\t9\n").bodies[0].marks[""].tolist()
    [[7.0, 9.0], [8.0, 9.0]]
    """
    for n, (body, one) in enumerate(layout.columns):
        cells = {row[n].lower() for row in form.rows if n < len(row)}
        if not one.role and cells & _HIDDEN and cells <= _SHOWN | _HIDDEN:
            layout.columns[n] = (body, Heading("seen"))  # whatever it is called
    wanted = [n for n, (_, one) in enumerate(layout.columns) if one.role]
    if not {one.role for _, one in layout.columns} & {"x", "y"} and not layout.rates:
        names = ", ".join(name_of(form, n) for n in range(min(form.width, 8)))
        raise InputError(
            f"{path} has no columns x and y that are known by their names (they are {names:.90}): "
            f"say what they are, such as columns='{example(form.width)}' (--columns), of a puck on "
            "a line with x alone"
        )
    texts = []
    for n in wanted:  # ids and flags that are texts, and times of a clock
        shown, role = [row[n] for row in form.rows if n < len(row)], layout.columns[n][1].role
        is_text = any(number(cell, form.comma) is None for cell in shown) or not any(shown)
        if role == "time":
            is_text = any(map(is_clock, shown))
        if is_text and role in ("time", "id", "seen", "hidden"):
            texts.append(n)
    values, words = read_columns(path, form, [n for n in wanted if n not in texts], texts, content)
    for n in texts:
        body, one = layout.columns[n]
        if one.role == "time":
            codes, named = words.pop(n)
            values[n] = seconds(f"{path}, column {n + 1}", named)[codes]
            layout.columns[n] = (body, one._replace(unit="s"))
    notes = []
    unused = [n for n in range(form.width) if n not in wanted]
    if unused and layout.kind.startswith("table"):
        names = ", ".join(name_of(form, n) for n in unused[:8])
        notes.append(f"column{'' if len(unused) == 1 else 's'} {names} left out")
    return film_of_columns(path, layout, values, words, notes)


def film_of_columns(
    path: str | Path, layout: Layout, values: Mapping[int, FloatArray], words: Mapping[int, Any],
    notes: Sequence[str] = (),
) -> Film:  # fmt: skip
    """The film in columns, whatever file they are from.

    ``values``: numbers (n,) by the number of a column; ``words``: of columns of texts, for each row
    the number of its text, and the texts; ``notes``: what was found, in sentences.

    >>> layout = Layout([("", Heading("time")), ("", Heading("x")), ("", Heading("y"))])
    >>> film_of_columns("a", layout, dict(enumerate(np.eye(3))), {}).bodies[0].marks[""].tolist()
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]
    """
    film = Film(layout.kind, [], jointed=layout.jointed, likely=layout.likely, rates=layout.rates)
    film.notes += notes
    values = dict(values)
    for n, (body, one) in enumerate(layout.columns) if layout.rates else ():
        rate = {"x": "velocity", "y": "velocity", "angle": "spin"}.get(one.role, "")
        if rate and one.unit and (size := unit_size(one.unit, rate)) is not None:
            values[n] = values[n] * size
            unit = "rad" if one.role == "angle" else "m"
            layout.columns[n] = (body, one._replace(unit=unit))
    if any(one.role == "step" for _, one in layout.columns):
        film.notes.append("times summed from steps, each since the row before")
    if layout.along:
        film.notes.append("places along one line, the other coordinate is 0")
    film.unit, film.angle_unit, film.timed = _units(path, layout, values)
    if layout.rates == ANGLES:
        film.unit = "m"  # of places that are all 0
    if layout.pixels:
        film.unit = film.unit or "px"
        film.y_down = True if film.unit == "px" else None
    rows = _rows(path, layout, values, words)
    apart = list(dict.fromkeys(body for body, _ in layout.columns if body))
    for name, chosen in rows.items():
        for body in apart or [name]:
            every = enumerate(layout.columns)
            mine = {n: one for n, (whose, one) in every if one.role and whose in ("", body)}
            of_body = _body(path, body, mine, values, words, chosen, layout.along, layout.rates)
            if of_body.marks:
                film.bodies.append(of_body)
    return film


def csv_of(rows: Iterable[Iterable[Any]]) -> bytes:
    r"""Rows of cells as a CSV file (UTF-8), which is then read as any other; None is left empty.

    >>> csv_of([["t", "x"], [0.5, None]])
    b't,x\n0.5,\n'
    """
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue().encode()


def film_below(
    path: str | Path, head: bytes, lines: int, columns: Sequence[tuple[str, Heading]], kind: str,
    up: str, rate: float = 0.0, content: bytes | None = None,
) -> Film:  # fmt: skip
    r"""The film in a table that stands below lines of another form, which said what it holds.

    ``head``: how the file begins; ``lines``: how many stand above the first row of numbers;
    ``columns``: each with the body that it is of; ``up``: the axis of places in space that points
    up; ``rate``: frames a second, where the lines say it and no column holds times; ``content``:
    all of the table, where other things stand below it.

    >>> import tempfile
    >>> columns = [("", Heading("x", "", "mm")), ("", Heading("y", "", "mm"))]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file, content = Path(folder, "a.tsv"), b"FREQUENCY\t50\n7\t9\n8\t9\n"
    ...     _ = file.write_bytes(content)
    ...     film_below(file, content, 1, columns, "file", "z", 50.0).bodies[0].time.tolist()
    [0.0, 0.02]
    """
    form = text_form_of(path, b"\n".join(head.split(b"\n")[lines:]))
    columns = [*columns] + [("", Heading(""))] * max(0, form.width - len(columns))
    if len(columns) > form.width:
        raise InputError(
            f"{path} names {len(columns)} columns and has {form.width}: it is damaged, or of a "
            "version that is not known; export it once more"
        )
    form = replace(form, skip=form.skip + lines)
    film = film_in_text(path, form, Layout(columns, kind, jointed=True, likely=None), content)
    film.up = up
    for body in film.bodies:
        if body.time is None and rate > 0.0:
            first = next(iter(body.marks.values())).shape[0]
            body.time = (np.arange(first) if body.frame is None else body.frame) / rate
    if rate > 0.0:
        film.notes.append(f"{rate:.9g} frames a second, as it says")
    return film


def _units(
    path: str | Path, layout: Layout, values: dict[int, FloatArray]
) -> tuple[str, str, bool]:  # fmt: skip
    """Units of places and angles, and whether that of times is named.

    ``values``: of columns in different units they are brought to m or rad.
    """
    said, headed = [], [one for _, one in layout.columns]
    for kind, si, roles in (("length", "m", ("x", "y", "z")), ("angle", "rad", ("angle",))):
        own = {n: one for n, one in enumerate(headed) if one.role in roles}
        units = {one.unit for one in own.values()}
        if len(units) > 1:
            sizes = {unit: unit_size(unit, kind) or math.nan for unit in units}
            if any(map(math.isnan, sizes.values())):
                names = " and ".join(sorted({one.role for one in own.values()}))
                written = ", ".join(unit or "none said" for unit in sorted(units))
                raise InputError(
                    f"{path}: its columns {names} are not all in one unit ({written}): name all "
                    "with columns (--columns)"
                )
            values.update({n: sizes[one.unit] * values[n] for n, one in own.items()})
            units = {si}
        said.append(units.pop() if units else "")
    timed = all(one.unit for one in headed if one.role in ("time", "step"))
    return said[0], said[1], timed


def _rows(
    path: str | Path, layout: Layout, values: Mapping[int, FloatArray], words: Mapping[int, Any]
) -> dict[str, Any]:
    """Which rows are of which puck, by its name: all of them where no column says whose they are.

    Rows of a puck are put in the order of their frames or times: a long table has none.
    """
    lines = []
    for whose in (n for n, (_, one) in enumerate(layout.columns) if one.role == "id"):
        if whose in words:
            codes, names = words[whose]
        else:
            numbers, codes = np.unique(values[whose], return_inverse=True, equal_nan=True)
            names = [f"{one:.15g}" for one in numbers]
        if not len(names) == codes.size > 1:  # else it numbers the rows
            lines.append((len(names), whose in words, codes, names))
    if not lines:
        return {"": slice(None)}
    *_, codes, names = max(lines, key=lambda one: one[:2])  # who tells most apart, best by name
    if len(names) > MOST_PUCKS:
        raise InputError(
            f"{path} has {len(names)} pucks, at most {MOST_PUCKS} are read: leave out what is none"
        )
    roles = [one.role for _, one in layout.columns]
    by = next((roles.index(role) for role in ("frame", "time") if role in roles), None)
    order = np.argsort(codes, kind="stable") if by is None else np.lexsort((values[by], codes))
    rows = np.split(order, np.cumsum(np.bincount(codes, minlength=len(names)))[:-1])
    return {name: mine for name, mine in zip(names, rows, strict=True) if name != "nan"}


def _body(
    path: str | Path, name: str, columns: dict[int, Heading], values: Mapping[int, FloatArray],
    words: Mapping[int, Any], rows: Any, along: bool, rates: str,
) -> TrackedBody:  # fmt: skip
    """One body from its columns and rows; ``along``: places along x or y alone, the other is 0."""
    of_body: dict[tuple[str, str], FloatArray] = {}
    units: dict[str, str] = {}
    seen: dict[str, Flags] = {}
    for n, one in columns.items():
        if one.role in ("seen", "hidden"):
            flags = _flags(path, n, one.role, values, words)[rows]
            seen[one.puck] = seen[one.puck] & flags if one.puck in seen else flags
        elif one.role != "id":
            if (one.role, one.puck) in of_body:
                raise InputError(
                    f"{path} has two columns '{one.role}' of one puck: name its columns apart, or "
                    "with columns (--columns)"
                )
            of_body[one.role, one.puck] = values[n][rows]
            units[one.role] = one.unit

    def of(role: str) -> dict[str, FloatArray]:
        return {mark: value for (one, mark), value in of_body.items() if one == role}

    marks = {}
    for role, mark in of_body:
        if role not in ("x", "y"):
            continue
        where = of_body[role, mark]
        other = of_body.get(("y" if role == "x" else "x", mark), 0.0 * where if along else None)
        if other is None:
            raise InputError(
                f"{path} has a column {role} {f'of {mark} ' if mark else ''}without its "
                f"{'y' if role == 'x' else 'x'}: name its columns with columns (--columns), of a "
                f"puck that goes along {role} alone with - for what else there is"
            )
        level = [where, other] if role == "x" else [other, where]
        height = [of_body["z", mark]] if ("z", mark) in of_body else []
        marks[mark] = np.column_stack(level + height)
    if rates == ANGLES:
        marks = {mark: np.zeros((where.size, 2)) for mark, where in of("angle").items()}
    turns = {
        mark: np.stack([of_body[role, mark] for role in _TURN], axis=1) for mark in marks
        if all((role, mark) in of_body for role in _TURN)
    }  # fmt: skip
    body = TrackedBody(
        name, marks, angles=of("angle"), likelihoods=of("likelihood"), seen=seen, turns=turns
    )
    clocks: list[FloatArray | None] = []
    for role in ("frame", "time", "step", "nanos"):
        whose = [*of(role).values()]
        if len(whose) > 1:
            raise InputError(
                f"{path} has two columns of {role}: read the pucks one by one, with - in columns "
                "(--columns) for those of others"
            )
        clocks.append(whose[0] if whose else None)
    body.frame, body.time, steps, nanos = clocks
    if body.time is not None:
        body.time = body.time * factor(units["time"] or "s", "time")
        if nanos is not None:  # from the first second on: doubles hold no more of a stamp
            start = body.time[np.isfinite(body.time)].min(initial=np.inf)
            body.time = body.time - start + 1e-9 * nanos
    elif steps is not None:
        unit = factor(units["step"] or "s", "time")
        body.time = unit * np.concatenate([[0.0], np.cumsum(steps[1:])])
    return body


def _flags(
    path: str | Path, column: int, role: str, values: Mapping[int, FloatArray],
    words: Mapping[int, Any],
) -> Flags:  # fmt: skip
    """Whether the puck is seen, row by row, from a column of flags."""
    if column in words:
        codes, texts = words[column]
        shown = []
        for text in texts:
            if (low := text.lower()) not in _SHOWN | _HIDDEN | _YES | _NO:
                raise InputError(
                    f"{path}, column {column + 1}: '{text:.30}' does not say whether the puck is "
                    "seen: write 1 or 0, true or false"
                )
            yes = (low in _YES) == (role == "seen")
            shown.append(low in _SHOWN or (low not in _HIDDEN and yes))
        return np.asarray(np.array(shown, bool)[codes])
    flags = values[column]
    if not np.isin(flags[~np.isnan(flags)], (0.0, 1.0)).all():
        raise InputError(
            f"{path}, column {column + 1}: flags of what is seen must be 0 or 1; leave the column "
            "out with - in columns (--columns)"
        )
    return np.asarray((flags == 1.0) == (role == "seen"))


def is_clock(text: str) -> bool:
    """Whether a text is a time with or without a date: 2025-12-11T10:30:45.12, 30:45.12.

    >>> is_clock("2025-12-11 10:30:45,5"), is_clock("1:02.5"), is_clock("12.5")
    (True, True, False)
    """
    return bool(_DATE.fullmatch(text) or _CLOCK.fullmatch(text))


def seconds(where: str, texts: Sequence[str]) -> FloatArray:
    """Times (n,) in s, from the first one on; NaN for empty texts; ``where``: for messages.

    >>> seconds("a.csv", ["23:59:59.75", "", "24:00:00.5"]).tolist()
    [0.0, nan, 0.75]
    """
    nanos = [_nanos(where, text) if text else None for text in texts]
    first = next((one for one in nanos if one is not None), 0)
    return np.array([np.nan if one is None else (one - first) * _NANO for one in nanos])


def _nanos(where: str, text: str) -> int:
    """A time in whole nanoseconds: doubles hold no fraction of a second since 1970 to 1e-8."""
    if (result := _DATE.fullmatch(text)) is not None:
        date, clock, part, zone = result.groups()
        try:
            whole = int(np.datetime64(f"{date}T{clock}", "s").astype(np.int64))
        except ValueError:
            raise InputError(f"{where}: '{text:.40}' is no date") from None
        if zone not in (None, "Z"):
            sign, digits = (-1 if zone[0] == "-" else 1), zone[1:].replace(":", "")
            whole -= sign * (3600 * int(digits[:2]) + 60 * int(digits[2:]))
    elif (result := _CLOCK.fullmatch(text)) is not None:
        hours, minutes, secs, part = result.groups()
        whole = 3600 * int(hours or 0) + 60 * int(minutes) + int(secs)
    else:
        raise InputError(f"{where}: '{text:.40}' is no time as in the rows before")
    return whole * 10**9 + int((part or "0").ljust(9, "0"))
