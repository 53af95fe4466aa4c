"""Films followed with Tracker (Open Source Physics): its .trk files (XML) and .trz archives.

A file holds the marks of point masses in pixels of the picture, u to the right and v down, by the
number of the frame; the duration of a frame; and the axes and the scale that the user chose.  As
Tracker does, with the origin (u0, v0), the angle a of the axes and s pixels to a unit of length,

    p = (u - u0)/s,  q = (v0 - v)/s,  x = p cos a + q sin a,  y = q cos a - p sin a,

and the time of frame n is that of the first one plus (n - first) durations.  Axes that move from
frame to frame hold until the next that is written.  Where the user chose no scale (it is then 1)
places stay pixels.

References
----------
D. Brown, Tracker 5.0 to 6.3; files of these were read.  Entities are refused, and doctypes not
followed.
"""

from __future__ import annotations

import lzma
import math
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables._core.safe_read import ZIP, read_whole
from puck_tables._core.text import encoding_of
from puck_tables._core.units import unit_word
from puck_tables.errors import InputError
from puck_tables.film.film import Film, Reader, TrackedBody, first_text

_LARGEST = 1 << 26  # bytes of a .trk, or of all in an archive
_LARGEST_ARCHIVE = 1 << 32  # bytes: more is no archive of Tracker, or one made to fill the memory
_MOST_MEMBERS = 10_000  # files in it: the same
_MOST_FRAMES = 10_000_000  # of a film: a day at 100 Hz
_PANEL, _MASS = "TrackerPanel", "PointMass"


def _film_of_zip(path: str | Path, head: bytes) -> Film:
    """The film of a .trz archive: all its .trk files."""
    if Path(path).stat().st_size > _LARGEST_ARCHIVE:
        raise InputError(f"{path} is too large: unpack it, and read its .trk file")
    films, left = {}, _LARGEST
    name: PurePosixPath | None = None
    damage = (zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, ValueError, OSError)
    try:
        with zipfile.ZipFile(path) as archive:
            members = archive.infolist()
            if len(members) > _MOST_MEMBERS:
                raise InputError(f"{path} has too many members: it is no .trz archive of Tracker")
            names = [PurePosixPath(member.filename) for member in members]
            if any(name.parts[:1] == ("word",) for name in names):
                raise InputError(f"{path} is a document: save its table as CSV")
            for member, name in zip(members, names, strict=True):
                if name.suffix.lower() != ".trk" or name.parts[0] == "__MACOSX":
                    continue
                with archive.open(member) as file:  # what a member says of its size may be wrong
                    content = file.read(left + 1)
                if len(content) > left:
                    raise InputError(f"{path}: {name} is too large to be a file of Tracker")
                left -= len(content)
                films[name.stem] = _film(f"{path}: {name}", content)
    except InputError:
        raise
    except RuntimeError as error:  # encrypted, or packed by an uncommon method
        raise InputError(
            f"{path}: {name} cannot be read ({error}): unpack it, and read its .trk file"
        ) from None
    except damage as error:
        where = f"{name} in it cannot be unpacked" if name else (
            "its list of contents is missing or broken, as of a file that was not copied to its end"
        )  # fmt: skip
        raise InputError(
            f"{path} is a damaged archive: {where} ({error}). Copy it once more, or open it in "
            "Tracker and save it again"
        ) from None
    if not films:
        raise InputError(
            f"{path} is an archive without a .trk file of Tracker: unpack it, and read its tables"
        )
    first = next(iter(films.values()))
    if len(films) == 1:
        return first
    if len({film.unit for film in films.values()}) > 1:
        raise InputError(f"{path}: its .trk files have different units of length: unpack it")
    for stem, film in films.items():
        for body in film.bodies:
            body.name = stem
    first.bodies = [body for film in films.values() for body in film.bodies]
    return first


def _film(path: str, content: bytes) -> Film:
    """The film in the XML of a .trk file."""
    text = content.decode(encoding_of(path, content), errors="replace")
    if "<!ENTITY" in text:
        raise InputError(f"{path} defines entities, which no file of Tracker does: it is not read")
    try:
        root = ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError, RecursionError) as error:
        raise InputError(
            f"{path} is damaged XML ({error}): open it in Tracker and save it again"
        ) from None
    if root.tag != "object" or not _kind(root):
        raise InputError(
            f"{path} is XML, but no file of Tracker: save the table of its points as CSV"
        )
    if _kind(root) != _PANEL:
        raise InputError(
            f"{path} holds a {_kind(root)} of Tracker, not a tab with tracks: read the .trk files "
            "of its tabs"
        )
    result = {}
    for mass in (one.find("object") for one in _held(root, "tracks")):
        if mass is not None and _kind(mass) == _MASS:
            result[_texts(mass).get("name", "").strip()] = {  # its pixels by frame
                frame: (_number(path, texts, "x"), _number(path, texts, "y"))
                for frame, texts in _indexed(path, _held(mass, "framedata"))
            }
    result = {name: marks for name, marks in result.items() if marks}
    if not result:
        raise InputError(f"{path} holds no point mass that was marked in a frame")
    texts = _texts(root)
    start, step, duration, begin = _clock(path, root)
    marked = {frame for marks in result.values() for frame in marks}
    frames = sorted(marked | {*range(min(marked), max(marked) + 1, step)})
    film = Film(
        "file of Tracker", [], unit_word(texts.get("length_unit", ""), "length"), y_down=False
    )
    pictures = {
        name: np.array([marks.get(n, (math.nan, math.nan)) for n in frames])
        for name, marks in result.items()
    }
    axes = _axes(path, root)
    plain = all(scale == 1.0 for *_, scale in axes.values())
    if plain:
        film.unit, film.y_down = "px", True
        film.notes.append("no scale was chosen in Tracker: its axes are not used")
    numbers = np.array(frames, dtype=np.float64)
    body = TrackedBody("", pictures if plain else {
        name: _world(numbers, points, axes) for name, points in pictures.items()
    }, frame=numbers)  # fmt: skip
    if duration is not None:
        body.time = 1e-3 * (begin + (numbers - start) * duration)
        film.notes.append(f"frames {duration:.6g} ms apart")
    film.bodies.append(body)
    return film


def _held(of: Element | None, *names: str) -> list[Element]:
    """The properties of what an object holds under a name, and that under the next, and so on."""
    for name in names:
        held = [] if of is None else of.findall("property")
        of = next((one for one in held if one.get("name") == name), None)
        if of is not None and (inner := of.find("object")) is not None:
            of = inner
    return [] if of is None else of.findall("property")


def _kind(of: Element) -> str:
    """The class of an object without its package."""
    return of.get("class", "").rpartition(".")[2]


def _texts(of: Element | None, *names: str) -> dict[str, str]:
    """The plain values of an object, or of what it holds, by name."""
    return {one.get("name", ""): one.text or "" for one in _held(of, *names) if not len(one)}


def _number(path: str, texts: dict[str, str], name: str) -> float:
    """A finite number of an object."""
    try:
        value = float(texts[name])
    except (KeyError, ValueError):
        value = math.nan
    if not math.isfinite(value):
        raise InputError(
            f"{path}: '{name}' is missing or no number: it is damaged, or of a version of Tracker "
            "that is not known; export its table as text instead"
        )
    return value


def _indexed(path: str, array: list[Element]) -> Iterator[tuple[int, dict[str, str]]]:
    """The objects of an array with their numbers: those that are not written are missing."""
    for one in array:
        item, name = one.find("object"), one.get("name", "")
        if item is None:
            continue
        digits = name.strip("[]")
        if not digits.isascii() or not digits.isdigit() or int(digits) > _MOST_FRAMES:
            raise InputError(f"{path}: '{name:.20}' is no number of a frame: it is damaged")
        yield int(digits), _texts(item)


def _clock(path: str, root: Element) -> tuple[int, int, float | None, float]:
    """First frame, frames of a step, ms of a frame and of the first; None where it is not said."""
    texts, timing = _texts(root, "videoclip"), _texts(root, "clipcontrol")
    if "delta_t" not in timing:
        timing = _texts(root, "videoclip", "video")
    duration = _number(path, timing, "delta_t") if "delta_t" in timing else None
    if duration is not None and duration <= 0.0:
        raise InputError(f"{path}: frames that last {duration:g} ms: give fps (--fps)")
    start = int(_number(path, texts, "startframe")) if "startframe" in texts else 0
    step = int(_number(path, texts, "stepsize")) if "stepsize" in texts else 1
    begin = _number(path, texts, "starttime") if "starttime" in texts else 0.0
    return start, max(step, 1), duration, begin


def _axes(path: str, root: Element) -> dict[int, tuple[float, float, float, float]]:
    """Origin, angle and scale by the frame from which they hold."""
    axes = {}
    for frame, texts in _indexed(path, _held(root, "coords", "framedata")):
        names = ("xorigin", "yorigin", "angle", "xscale", "yscale")
        u, v, angle, scale, other = (_number(path, texts, name) for name in names)
        if scale <= 0.0 or not math.isclose(scale, other, rel_tol=1e-9):
            raise InputError(
                f"{path}: scales of {scale:g} and {other:g} pixels along x and y: they must be "
                "equal and greater than 0; for a tilted camera leave the scale at 1 and use marks"
            )
        axes[frame] = (u, v, math.radians(angle), scale)
    if not axes:
        raise InputError(
            f"{path} has no axes and scale: it is of a version of Tracker that is not known; "
            "export its table as text instead"
        )
    return axes


def _world(
    frames: FloatArray, pixels: FloatArray, axes: dict[int, tuple[float, float, float, float]]
) -> FloatArray:
    """Places (n, 2) along the axes of each frame."""
    since = sorted(axes)
    which = np.maximum(np.searchsorted(since, frames, side="right") - 1, 0)
    u, v, angle, scale = np.array([axes[frame] for frame in since])[which].T
    p, q = (pixels[:, 0] - u) / scale, (v - pixels[:, 1]) / scale
    cos, sin = np.cos(angle), np.sin(angle)
    return np.column_stack([p * cos + q * sin, q * cos - p * sin])


READERS = (
    Reader(  # an archive whose first bytes are damaged says that it is one
        lambda path, head: (
            head.startswith(ZIP)
            or (Path(path).suffix.lower() == ".trz" and not first_text(path, head))
        ),
        _film_of_zip,
    ),
    Reader(
        lambda path, head: first_text(path, head).startswith("<"),
        lambda path, _: _film(str(path), read_whole(path, _LARGEST)),
    ),
)
