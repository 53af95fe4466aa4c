"""Which columns of a table are what, whose, and of what kind of file: from its header."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from puck_tables._core.text import TextForm
from puck_tables._core.text_rows import header_of
from puck_tables.errors import InputError
from puck_tables.film.film import ANGLES, NO_ACCELERATIONS, PLACES
from puck_tables.film.headings import Heading, heading, headings, on_a_line

_TRACKPY = {"frame", "particle", "x", "y"}
_SCORER = "scorer"  # begins DeepLabCut's tables
_CLOCKS = ("time", "nanos", "frame", "step")
# what stands in place of places and angles, and which roles it then has
_RATES = (
    (PLACES, {"vx": "x", "vy": "y", "v": "x", "wx": "", "wy": "", "wz": "", "a": ""}),
    (ANGLES, {"wz": "angle", "wx": "", "wy": "", "a": ""}),
)
_MOVES = {*_RATES[0][1], "vz"}
_ROS = re.compile(r"(pose[./]position|transform[./]translation)[./]x$")
_LIKELY = 0.6  # what DeepLabCut takes for a mark that is there ('pcutoff')


@dataclass
class Layout:
    """What the columns of a table are.

    ``columns``: each with the body that it is of ('' for all), ``kind``: of file, for messages,
    ``jointed``: whether marks are parts of a body, ``pixels``: whether such files are in pixels,
    ``likely``: the likelihood below which a place is none, ``along``: whether x or y alone is told,
    of tracks along a line, ``rates``: whether places are velocities, or angles spins.
    """

    columns: list[tuple[str, Heading]]
    kind: str = "table"
    jointed: bool = False
    pixels: bool = False
    likely: float | None = _LIKELY
    along: bool = False
    rates: str = ""


def layout_of(path: str | Path, form: TextForm, columns: str | None) -> Layout:
    """What the columns of a table are, by its header or by headings given in its place.

    >>> form = TextForm("utf-8", ",", False, [["t", "x1", "y1"]], [], [["0", "1", "2"]], 1, 3)
    >>> [one.role for _, one in layout_of("a.csv", form, None).columns]
    ['time', 'x', 'y']
    """
    header = headed(path, form, columns)
    if columns is not None:
        return _named(path, header[0])
    if header[0][0].lower() == _SCORER:
        return _deeplabcut(path, header)
    layout = _named(path, header[-1], _owners(header) if len(header) > 1 else ())
    result = {name.lower() for name in header[-1]}
    if any(_ROS.search(name) for name in result):  # in m and rad, by its REP 103
        layout.kind = "table of ROS messages"
        layout.columns = [
            (body, one._replace(unit="m") if one.role in ("x", "y", "z") and not one.unit else one)
            for body, one in layout.columns
        ]
    if result >= _TRACKPY:
        layout.kind, layout.pixels = "trackpy table", True
    if "frame_idx" in result and {"track", "instance.score"} & result:
        layout.kind, layout.pixels, layout.jointed, layout.likely = "SLEAP table", True, True, None
    return layout


def headed(path: str | Path, form: TextForm, columns: str | None) -> list[list[str]]:
    """The rows of names over the columns of a table; the last has their units in brackets.

    ``columns``: names with commas in place of those in the file; empty for '-'.

    Raises InputError if there are none, or not as many as columns.

    >>> form = TextForm("utf-8", ",", False, [["t", "x"], ["s", "cm"]], [], [["0", "1"]], 2, 2)
    >>> headed("a.csv", form, None)
    [['t [s]', 'x [cm]']]
    """
    if columns is not None:
        names = [name.strip() for name in columns.split(",")]
        if len(names) != form.width:
            raise InputError(
                f"{path} has {form.width} columns, and columns names {len(names)}: name each, "
                f"with - for those to leave out (its first row is {_shown(form.rows[0])})"
            )
        return [["" if name == "-" else name for name in names]]
    header = header_of(form, lambda cells: {"x", "y"} <= {one.role for one in map(heading, cells)})
    if not header:
        raise InputError(
            f"{path} has no header: say what its {form.width} columns are, such as "
            f"columns='{example(form.width)}' (--columns); its first row is {_shown(form.rows[0])}"
        )
    if header[0][0].lower() == _SCORER:
        return header
    if form.header and len(form.header[-1]) < form.width:
        raise InputError(
            f"{path} has {len(form.header[-1])} names for {form.width} columns, so none can be told"
            " from another: name all with columns (--columns), - for those to leave out"
        )
    return header


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


def _named(path: str | Path, names: Sequence[str], owners: Sequence[str] = ()) -> Layout:
    """The columns of a table with one row of names; ``owners`` are names of pucks over them."""
    read = headings(names) if not any(owners) else [heading(name) for name in names]
    if any(owners):
        read = [
            one._replace(puck=" ".join(filter(None, (owner, one.puck))))
            if one.role not in (*_CLOCKS, "id", "") else one
            for one, owner in zip(read, owners, strict=True)
        ]  # fmt: skip
    if any(name.lower() == "instance.score" for name in names):
        read = [Heading("") if one.puck == "instance" else one for one in read]
    read = _own_times(_one_clock(names, read))
    rates, line = "", on_a_line(names, read)
    roles = {one.role for one in line or read}
    if not roles & {"x", "y"}:
        for kind, into in _RATES:
            if roles & {role for role, other in into.items() if other}:
                rates = kind
                read = [one._replace(role=into.get(one.role, one.role)) for one in read]
                line = read if len({one.role for one in read} & {"x", "y"}) == 1 else None
                break
        else:
            if "a" in roles:
                raise InputError(f"{path} {NO_ACCELERATIONS}")
    read = [Heading("") if one.role in _MOVES else one for one in line or read]
    apart = {one.puck for one in read if one.role == "x"} == {"c", "m"}  # a centre and its mark
    return Layout(
        list(zip(_blocks(read), read, strict=True)), jointed=apart, along=line is not None,
        rates=rates,
    )  # fmt: skip


def _one_clock(names: Sequence[str], read: Sequence[Heading]) -> list[Heading]:
    """The headings with one of several times: of the measurement, or that counts from the start.

    >>> names = ["Time", "header.stamp", "x", "y"]
    >>> [one.role for one in _one_clock(names, headings(names))]
    ['', 'time', 'x', 'y']
    """
    times = [n for n, one in enumerate(read) if one.role == "time"]
    for word in ("stamp", "elapsed"):
        mine = [n for n in times if re.search(rf"(?<![^\W_]){word}(?![^\W_])", names[n].lower())]
        if len(mine) == 1 < len(times):
            others = {*times} - {*mine}
            return [Heading("") if n in others else one for n, one in enumerate(read)]
    return list(read)


def _own_times(read: Sequence[Heading]) -> list[Heading]:
    """The headings without times of something else, such as a stop, where the pucks have theirs.

    >>> [one.role for one in _own_times(headings(["t", "stop_time", "x", "y"]))]
    ['time', '', 'x', 'y']
    """
    pucks = {one.puck for one in read if one.role == "x"} | {""}
    known = {one.role for one in read if one.role in _CLOCKS and one.puck in pucks}
    return [Heading("") if one.role in known and one.puck not in pucks else one for one in read]


def _blocks(read: Sequence[Heading]) -> list[str]:
    """Bodies of columns where each puck has times of its own: blocks that begin, or end, with one.

    >>> _blocks(headings(["t", "x", "y", "t", "x", "y"]))
    ['1', '1', '1', '2', '2', '2']
    """
    times = [n for n, one in enumerate(read) if one.role == "time"]
    if len(times) < 2:
        return [""] * len(read)
    first = next((n for n, one in enumerate(read) if one.role in ("x", "y")), 0)
    count = [sum(t <= n if times[0] <= first else t < n for t in times) for n in range(len(read))]
    block = [n if times[0] <= first else n + 1 for n in count]
    owners: dict[int, set[str]] = {n: set() for n in block}
    for n, one in zip(block, read, strict=True):
        if one.role == "x":
            owners[n].add(one.puck)
    if not all(owners.get(n + 1) for n in range(len(times))):
        return [""] * len(read)  # two kinds of times of the same pucks
    return [min(owners[n]) if len(owners[n]) == 1 and owners[n] != {""} else str(n) for n in block]


def _deeplabcut(path: str | Path, header: list[list[str]]) -> Layout:
    """The columns of DeepLabCut's tables: rows scorer, (individuals,) bodyparts, coords."""
    rows = {row[0].lower(): row for row in header}
    if not {"bodyparts", "coords"} <= set(rows):
        raise InputError(
            f"{path} begins as DeepLabCut's tables do but has no rows 'bodyparts' and 'coords': "
            "another version, which this program does not know"
        )
    owners = rows.get("individuals", [""] * len(header[0]))
    return deeplabcut(zip(owners[1:], rows["bodyparts"][1:], rows["coords"][1:], strict=True))


def deeplabcut(labels: Iterable[tuple[str, str, str]]) -> Layout:
    """The frames, and columns of an individual, a body part and what is told of it.

    >>> deeplabcut([("", "hub", "x"), ("", "hub", "y")]).columns[1]
    ('', Heading(role='x', puck='hub', unit=''))
    """
    columns = [("", Heading("frame"))]
    for owner, mark, what in labels:
        known = what.lower() in ("x", "y", "likelihood")
        columns.append((owner, Heading(what.lower() if known else "", mark)))
    return Layout(columns, "DeepLabCut table", jointed=True, pixels=True)


def name_of(form: TextForm, column: int) -> str:
    """A column in words: its name in the last row of them, or its number from 1.

    >>> name_of(TextForm("utf-8", ",", False, [["t", ""]], []), 1)
    '2'
    """
    names = form.header[-1] if form.header else []
    return names[column] if column < len(names) and names[column] else str(column + 1)


def example(width: int) -> str:
    """Headings as somebody may give them for a number of columns.

    >>> example(5)
    't,x,y,angle,-'
    """
    names = ["t", "x", "y", "angle"][:width]
    return ",".join(names + ["-"] * (width - len(names)))


def _shown(row: Sequence[str]) -> str:
    return ", ".join(cell or "''" for cell in row[:8])[:80]
