"""What the heading of a column says: a time, a place, an angle, whose, and in which unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from puck_tables._core.quantities import function_in
from puck_tables._core.units import parted, unit_meant, unit_named, unit_word
from puck_tables.errors import InputError

_WORDS = {
    "time": "t time times zeit temps tiempo tempo tijd tid czas время 时间 時間 timestamp "
    "timestamps seconds secs elapsed",
    "frame": "frame frames framenumber frameno frameindex frameidx bild bildnummer image img slice",
    "step": "dt deltat dtime Δt δt",
    "x": "x cx xc xpos posx xcoord coordx xcenter centerx xcentre centrex",
    "y": "y cy yc ypos posy ycoord coordy ycenter centery ycentre centrey",
    "angle": "angle theta θ phi φ orientation rotation winkel yaw ang rot",
    "seen": "visible seen detected found valid sichtbar",
    "hidden": "hidden occluded occlusion lost missing verdeckt",
    "likelihood": "likelihood confidence probability prob conf score",
}  # fmt: skip
_ROLE = {word: role for role, words in _WORDS.items() for word in words.split()}
_FIRST = ("x", "y", "angle", "likelihood", "seen", "hidden", "step", "time", "frame")
_ID = {"id", "track", "particle", "puck", "object", "obj", "marker", "tag", "individual", "name",
       "body", "identity"}  # fmt: skip
_FILLING = {"pos", "position", "coord", "coordinate", "coords", "value", "number", "nr", "no",
            "num", "index", "idx", "stamp", "elapsed", "ort", "koordinate", "in"}  # fmt: skip
# of other quantities than places, times and angles
_OTHER = {"v", "vel", "velocity", "speed", "acc", "acceleration", "err", "error", "std", "sigma",
          "var", "cov", "width", "height", "size", "mass", "area", "min", "max", "bbox", "momentum",
          "omega", "force", "mean", "raw"}  # fmt: skip
_RATES = {"vx", "vy", "ax", "ay", "a", "dx", "dy"}
# a place on a line, where nothing is called x or y
_ALONG = ("position", "pos", "displacement", "distance", "ort", "weg")
_KIND = {"x": "length", "y": "length", "time": "time", "step": "time", "angle": "angle"}
_TOKEN = re.compile(r"[^\W\d_]+|\d+|°")
_DIVIDED = re.compile(
    r"/\s*\d|[*×·⋅]\s*\d|\d\s*[*×·⋅]|/\s*(?:\w{1,2}|radius|diameter|length|width|size|max)\s*$"
)
_MANY = re.compile(r"[x×*·]?\s*\d+(?:\.\d+)?(?:e[-+]?\d+)?\s*(\D+)")  # a number before a unit
# a number that is no number of a puck: a power of ten by which places are multiplied
_TENS = re.compile(r"\s*(10+|\d*\.\d+|\d+e[-+]?\d+)\s+\w")
_CAMEL = re.compile(r"(?<=[a-zà-ÿ])(?=[A-Z])")


class Heading(NamedTuple):
    """What a column holds.

    ``role``: time, frame, step (time since the row before), x, y, angle, seen, hidden, likelihood,
    id (of the puck), or '' for anything else; ``puck``: whose, as it is written, '' if it says
    none; ``unit``: '' if it says none.
    """

    role: str
    puck: str = ""
    unit: str = ""


def heading(text: str) -> Heading:
    """Read the heading of a column.

    Raises
    ------
    InputError
        If it has a unit in square brackets that is none, or a factor or a function.

    Examples
    --------
    >>> heading("t [ms]"), heading("red_X_px"), heading("v_x")
    (Heading(role='time', puck='', unit='ms'), Heading(role='x', puck='red', unit='px'), \
Heading(role='', puck='', unit=''))
    """
    name, unit_text = parted(text.strip().strip("\"'").strip())
    if "{" in name:  # v_{x}, θ_{r}: Tracker's names of what it derives from places
        return Heading("")
    tokens = _CAMEL.sub(" ", name)
    result = [(m.group(), m.start(), m.end()) for m in _TOKEN.finditer(tokens)]
    lowered = [word.lower() for word, _, _ in result]
    roles = [_ROLE.get(word, "") for word in lowered]
    if lowered and all(word in _ID or word in _FILLING for word in lowered) and (
        set(lowered) & _ID
    ):  # fmt: skip
        return Heading("id")
    role = next((one for one in _FIRST if one in roles), "")
    if not role:
        return Heading("")
    at = roles.index(role)
    kept = [
        n for n, one in enumerate(lowered) if one not in _FILLING and roles[n] != role
    ]  # fmt: skip
    unit = unit_word(unit_text, _KIND[role]) if role in _KIND else ""
    if unit_text and not unit and role in _KIND:
        if text.rstrip().endswith("]"):
            unit_named(f"the unit of the column '{text.strip():.40}'", unit_text, _KIND[role])
        if unit_meant(unit_text):
            unit_named(f"the unit of the column '{text.strip():.40}'", unit_text, _KIND[role])
        many = _MANY.fullmatch(unit_text)
        if many is not None and unit_word(many[1], _KIND[role]):
            raise _altered(text, role, unit_text)
        return heading(f"{name} {unit_text}")  # 'x (red)'
    if role == "time" and lowered[at] in ("seconds", "secs"):
        unit = unit or "s"
    if not unit and role in _KIND:
        for n in kept:
            last = n == len(result) - 1
            if last and unit_meant(result[n][0]):
                unit_named(f"the unit of '{text.strip():.40}'", result[n][0], _KIND[role])
            if (found_unit := unit_word(result[n][0], _KIND[role])) and (
                last or found_unit == "px"
            ):
                unit = found_unit
                kept.remove(n)
                break
    if any(lowered[n] in _OTHER for n in kept):
        return Heading("")
    divided = _DIVIDED.search(name)
    if role in _KIND and (other := divided[0] if divided else function_in(name)):
        raise _altered(text, role, other)
    return Heading(role, _merged(tokens, [result[n] for n in kept]), unit)


def _altered(text: str, role: str, other: str) -> InputError:
    """Why a column is not read whose numbers are a multiple or a function of what it names."""
    return InputError(
        f"the column '{text.strip():.40}' is no plain {role}, for '{other}' stands in its heading: "
        f"write the numbers themselves under '{role}', with their unit"
    )


def _merged(text: str, words: Sequence[tuple[str, int, int]]) -> str:
    """Words as they stood, with what was between neighbours."""
    joined, end = "", 0
    for word, start, stop in words:
        between = text[end:start] if joined else ""
        joined += (between if not _TOKEN.search(between) else "_") + word
        end = stop
    return joined


def headings(names: Sequence[str]) -> list[Heading]:
    """The headings of a table; equal ones side by side are numbered, one puck each.

    Examples
    --------
    >>> [one.puck for one in headings(["t", "x", "y", "x", "y"])]
    ['', '1', '1', '2', '2']
    """
    read = [heading(name) for name in names]
    numbers = {one.puck for one in read if one.puck.isdigit()}
    for name, one in zip(names, read, strict=True):
        found = _TENS.match(name) if one.role in ("x", "y") else None
        if found and (len(numbers) == 1 or not found[1].isdigit()):
            raise _altered(name, one.role, found[1])
    if any(re.match(r"v[_ ]?[xy]\b", name.strip().lower()) for name in names):
        read = [Heading("") if one.puck.lower() == "a" else one for one in read]  # a_x goes with it
    places = [one for one in read if one.role in ("x", "y")]
    if len({(one.role, one.puck) for one in places}) == len(places):
        return read
    counted: dict[tuple[str, str], int] = {}
    numbered = []
    for one in read:
        if one.role in ("", "time", "frame", "step", "id"):
            numbered.append(one)
            continue
        key = (one.role, one.puck)
        counted[key] = counted.get(key, 0) + 1
        numbered.append(one._replace(puck=f"{one.puck} {counted[key]}".strip()))
    return numbered


def on_a_line(names: Sequence[str], read: Sequence[Heading]) -> list[Heading] | None:
    """The headings of a track along a line, of which x or y alone is told; None if it is none.

    What else there is has to be known, or to be of another quantity than places.

    Examples
    --------
    >>> names = ["time", "position [cm]", "v"]
    >>> [one.role for one in on_a_line(names, headings(names))]
    ['time', 'x', '']
    >>> on_a_line(["t", "x", "h"], headings(["t", "x", "h"]))
    """
    words = [{word.lower() for word in _TOKEN.findall(name)} for name in names]
    result = list(read)
    told = {one.role for one in read} & {"x", "y"}
    named = [n for n, one in enumerate(read) if not one.role and words[n] & {*_ALONG}]
    if not told and len(named) == 1:
        n = named[0]
        result[n] = heading(re.sub("|".join(_ALONG), "x", names[n], flags=re.IGNORECASE))
        told = {result[n].role} & {"x"}
    other = [
        n for n, one in enumerate(result)
        if not one.role and words[n] and not words[n] & (_OTHER | _RATES)
    ]  # fmt: skip
    return result if len(told) == 1 and not other else None
