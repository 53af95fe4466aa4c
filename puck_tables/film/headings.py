"""What the heading of a column says: a time, a place, an angle, whose, and in which unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

from puck_tables._core.quantities import function_in
from puck_tables._core.units import is_unit, parted, unit_meant, unit_named, unit_size, unit_word
from puck_tables.errors import InputError

_WORDS = {
    "time": "t time times zeit temps tiempo tempo tijd tid czas время 时间 時間 timestamp "
    "timestamps seconds secs elapsed stamp zeitpunkt instante instant",
    "frame": "frame frames framenumber frameno frameindex frameidx bild bildnummer image img slice "
    "cuadro fotograma fotogramas trame quadro quadros кадр кадры",
    "step": "dt deltat dtime Δt δt",
    "x": "x cx xc xpos posx xcoord coordx xcenter centerx xcentre centrex х",
    "y": "y cy yc ypos posy ycoord coordy ycenter centery ycentre centrey у",
    "z": "z zpos posz zcoord coordz",
    "angle": "angle theta θ phi φ orientation rotation winkel yaw ang rot drehwinkel ángulo angulo "
    "ângulo угол orientación orientação rotación rotação heading_angle",
    "seen": "visible seen detected found valid sichtbar",
    "hidden": "hidden occluded occlusion lost missing verdeckt",
    "likelihood": "likelihood confidence probability prob conf score",
    "nanos": "nsec nsecs nanosec nanosecs",
}  # fmt: skip
_ROLE = {word: role for role, words in _WORDS.items() for word in words.split()}
_FIRST = ("x", "y", "z", "angle", "likelihood", "seen", "hidden", "step", "nanos", "time", "frame")
_ID = {"id", "track", "particle", "puck", "object", "obj", "marker", "tag", "individual", "name",
       "body", "identity", "disk", "disc", "stone", "ball", "label", "target", "piece", "robot",
       "player", "entity", "animal", "person", "child"}  # fmt: skip
_NUMBERING = {"number", "nr", "no", "num", "index", "idx", "value", "n", "°", "frame"}
_FILLING = _NUMBERING - {"frame"} | {
    "pos", "position", "coord", "coordinate", "coords", "stamp", "elapsed", "ort", "koordinate",
    "in", "pose", "field", "translation", "transform", "header", "for", "posición", "posicion",
    "posição", "posicao", "положение", "координата", "coordenada", "coordonnée",
}  # fmt: skip
# of other quantities than places, times and angles
_OTHER = {"err", "error", "std", "sigma", "var", "cov", "width", "height", "size", "mass", "area",
          "min", "max", "bbox", "momentum", "force", "mean", "raw", "covariance", "magnetic",
          "magnetometer", "gravity", "residual", "pressure", "energy"}  # fmt: skip
# quantities of which a table without places may tell: by words, and by the first letter of vx, ωz
_RATES = {
    "a": "a acc accel acceleration accelerometer acelerómetro aceleración beschleunigung "
    "accélération aceleração ускорение gf",
    "w": "w omega ω gyro gyroscope gyr angular spin winkelgeschwindigkeit giroscopio",
    "v": "v vel velocity speed linear twist geschwindigkeit velocidad vitesse velocidade скорость",
}  # fmt: skip
_RATE_WORDS = {word: kind for kind, words in _RATES.items() for word in words.split()}
_QUATERNION = {"q", "quat", "quaternion", "orientation", "rotation", "rot"}
_FUSED = re.compile(r"([vwaqωr])([xyzw])|(?:g)()([xyz])")
# a place on a line, where nothing is called x or y
_ALONG = ("position", "pos", "displacement", "distance", "ort", "weg", "strecke", "posición",
          "posicion", "desplazamiento", "distancia", "déplacement", "posição", "posicao",
          "deslocamento", "distância", "положение", "координата", "путь", "перемещение",
          "расстояние")  # fmt: skip
_BARE = ("s", "d", "r")  # of a place on a line, alone in a heading
_KIND = {"x": "length", "y": "length", "z": "length", "time": "time", "step": "time",
         "angle": "angle", "qx": "angle", "qy": "angle", "qz": "angle"}  # fmt: skip
_TOKEN = re.compile(r"[^\W\d_]+|\d+|°")
_DIVIDED = re.compile(
    r"/\s*\d|[*×·⋅]\s*\d|\d\s*[*×·⋅]|/\s*(?:\w{1,2}|radius|diameter|length|width|size|max)\s*$"
)
_MANY = re.compile(r"[x×*·]?\s*\d+(?:\.\d+)?(?:e[-+]?\d+)?\s*(\D+)")  # a number before a unit
# a number that is no number of a puck: a power of ten by which places are multiplied
_TENS = re.compile(r"\s*(10+|\d*\.\d+|\d+e[-+]?\d+)\s+\w")
_KINOVEA = re.compile(r".+/[^/]+/[XY]")
_CAMEL = re.compile(r"(?<=[a-zà-ÿ])(?=[A-Z])")
_WITHIN = re.compile(r"(.+?)\s*[\[(]([^\[\]()]+)[\])]\s*(\S.*)")  # Position (m) Run #1


class Heading(NamedTuple):
    """What a column holds.

    ``role``: time, nanos (to be added to it), frame, step (time since the row before), x, y, z,
    angle, qx to qw (of a quaternion), seen, hidden, likelihood, id (of the puck); vx, vy, v (along
    a line), wx to wz and a (velocities, spins, accelerations); or '' for anything else; ``puck``:
    whose, as it is written, '' if it says none; ``unit``: '' if it says none.
    """

    role: str
    puck: str = ""
    unit: str = ""


def heading(text: str) -> Heading:
    """Read the heading of a column.

    Raises InputError if it has a unit in square brackets that is none, or a factor or a function.

    >>> heading("t [ms]"), heading("red_X_px"), heading("v_x")
    (Heading(role='time', puck='', unit='ms'), Heading(role='x', puck='red', unit='px'), \
Heading(role='vx', puck='', unit=''))
    """
    name, unit_text = parted(text.strip().strip("\"'").strip())
    if not unit_text and (within := _WITHIN.fullmatch(name)) and is_unit(within[2]):
        name, unit_text = f"{within[1]} {within[3]}", within[2].strip()
    if name.startswith("/") or _KINOVEA.fullmatch(name):  # a topic of ROS; red/0/X
        name = re.sub("/0(?=/.$)", "", name).replace("/", ".")
    if "{" in name:  # v_{x}, θ_{r}: Tracker's names of what it derives from places
        return Heading("")
    tokens = _CAMEL.sub(" ", name)
    result = [(m.group(), m.start(), m.end()) for m in _TOKEN.finditer(tokens)]
    lowered = [word.lower() for word, _, _ in result]
    roles = [_ROLE.get(word, "") for word in lowered]
    words = set(lowered)
    whose = words - {"field", "header"}
    if name == "TID" or (whose and whose <= _ID | _NUMBERING and whose & _ID):
        return Heading("" if whose == {"frame", "id"} else "id")  # of axes, in ROS
    if (rate := _rate(lowered, unit_text)) is not None:
        base, others = rate
        return Heading(base, _merged(tokens, [result[n] for n in others]), unit_text)
    role = next((one for one in _FIRST if one in roles), "")
    if not role:
        return Heading("")
    kept = [n for n, one in enumerate(lowered) if one not in _FILLING and roles[n] != role]
    if role in ("x", "y", "z") and (turned := [n for n in kept if lowered[n] in _QUATERNION]):
        role, kept = f"q{role}", [n for n in kept if n not in turned]
    unit = unit_word(unit_text, _KIND[role]) if role in _KIND else ""
    if unit_text and not unit and role in _KIND:
        if text.rstrip().endswith("]") or unit_meant(unit_text):
            unit_named(f"the unit of the column '{text.strip():.40}'", unit_text, _KIND[role])
        many = _MANY.fullmatch(unit_text)
        if many is not None and unit_word(many[1], _KIND[role]):
            raise _altered(text, role, unit_text)
        return heading(f"{name} {unit_text}")  # 'x (red)'
    if role == "time" and words & {"seconds", "secs"}:
        unit = unit or "s"
    if not unit and role in _KIND:
        for n in kept:
            last = n == len(result) - 1
            if last and unit_meant(result[n][0]):
                unit_named(f"the unit of '{text.strip():.40}'", result[n][0], _KIND[role])
            word = unit_word(result[n][0], _KIND[role])
            if word and (last or word == "px"):
                unit = word
                kept.remove(n)
                break
    if any(lowered[n] in _OTHER for n in kept):
        return Heading("")
    divided = _DIVIDED.search(name)
    if role in _KIND and (other := divided[0] if divided else function_in(name)):
        raise _altered(text, role, other)
    return Heading(role, _merged(tokens, [result[n] for n in kept]), unit)


def _rate(words: Sequence[str], unit: str) -> tuple[str, list[int]] | None:
    """The role of a quaternion, velocity, spin or acceleration, and which words say whose."""
    others = [n for n, word in enumerate(words) if word not in _FILLING]
    for n in others:
        fused = _FUSED.fullmatch(words[n])
        if fused is not None and fused[1] != "r":
            kind, axis = (fused[1].replace("ω", "w"), fused[2]) if fused[1] else ("w", fused[4])
            if axis == "w" and kind != "q":
                continue
            return ("a" if kind == "a" else kind + axis), [k for k in others if k != n]
    axis = next((word for word in reversed(words) if word in ("x", "y", "z", "w")), "")
    if axis == "w":
        quaternion = [n for n in others if words[n] in _QUATERNION]
        mine = [n for n in others if n not in quaternion and words[n] != "w"]
        return ("qw", mine) if quaternion else None
    kinds = {kind for kind, size in (("v", "velocity"), ("w", "spin"), ("a", "acceleration"))
             if unit and unit_size(unit, size) is not None and unit not in ("g",)}  # fmt: skip
    named = {_RATE_WORDS[words[n]]: n for n in reversed(others) if words[n] in _RATE_WORDS}
    if not kinds and (set(named) <= {"a"} and len(words) < 3 and "a" in words):
        named.pop("a", None)  # a_x may be the x of a puck called a
    kind = next((one for one in "awv" if one in (kinds or named)), "")
    if not kind or set(words) & _OTHER:
        return None
    mine = [n for n in others if _RATE_WORDS.get(words[n]) is None and words[n] != axis]
    if kind == "a":
        return "a", mine
    if not axis and kind == "w":
        return "wz", mine
    return (kind + axis if axis else kind), mine


def _altered(text: str, role: str, other: str) -> InputError:
    """Why a column is not read whose numbers are a multiple or a function of what it names."""
    return InputError(
        f"the column '{text.strip():.40}' is no plain {role}, for '{other}' stands in its heading: "
        f"write the numbers themselves under '{role}', with their unit"
    )


def _merged(text: str, words: Sequence[tuple[str, int, int]]) -> str:
    """Words as they stood, with what was between neighbours."""
    merged, end = "", 0
    for word, start, stop in words:
        between = text[end:start] if merged else ""
        merged += (between if not _TOKEN.search(between) else "_") + word
        end = stop
    return merged


def headings(names: Sequence[str]) -> list[Heading]:
    """The headings of a table; equal ones side by side are numbered, one puck each.

    >>> [one.puck for one in headings(["t", "x", "y", "x", "y"])]
    ['', '1', '1', '2', '2']
    """
    read = [heading(name) for name in names]
    numbers = {one.puck for one in read if one.puck.isdigit()}
    for name, one in zip(names, read, strict=True):
        tens = _TENS.match(name) if one.role in ("x", "y") else None
        if tens and (len(numbers) == 1 or not tens[1].isdigit()):
            raise _altered(name, one.role, tens[1])
    if any(re.match(r"v[_ ]?[xy]\b", name.strip().lower()) for name in names):
        read = [Heading("") if one.puck.lower() == "a" else one for one in read]  # a_x goes with it
    whole = {one.puck for one in read if one.role == "qw"}
    read = [
        one if one.role not in ("qx", "qy", "qz") or one.puck in whole
        else one._replace(role="angle" if one.role == "qz" else "") for one in read
    ]  # fmt: skip
    lowered = [set(_TOKEN.findall(name.lower())) for name in names]
    if {"mx", "cx"} <= set().union(*lowered):
        read = [_centre_or_mark(one, words) for one, words in zip(read, lowered, strict=True)]
    places = [one for one in read if one.role in ("x", "y")]
    if len({(one.role, one.puck) for one in places}) == len(places):
        return read
    counted: dict[tuple[str, str], int] = {}
    numbered = []
    for one in read:
        if one.role in ("", "time", "nanos", "frame", "step", "id"):
            numbered.append(one)
            continue
        key = (one.role, one.puck)
        counted[key] = counted.get(key, 0) + 1
        numbered.append(one._replace(puck=f"{one.puck} {counted[key]}".strip()))
    return numbered


def _centre_or_mark(one: Heading, words: set[str]) -> Heading:
    """The centre (cx, cy) and a mark (mx, my) of a puck apart."""
    units = filter(None, (unit_word(word, "length") for word in words))
    for mark, axis in (word for word in ("cx", "mx", "cy", "my") if word in words):
        return Heading(axis, mark, one.unit or next(units, ""))
    return one


def on_a_line(names: Sequence[str], read: Sequence[Heading]) -> list[Heading] | None:
    """The headings of a track along a line, of which x or y alone is told; None if it is none.

    What else there is has to be known, or to be of another quantity than places.

    >>> names = ["time", "position [cm]", "v"]
    >>> [one.role for one in on_a_line(names, headings(names))]
    ['time', 'x', 'v']
    >>> on_a_line(["t", "x", "h"], headings(["t", "x", "h"]))
    """
    words = [{word.lower() for word in _TOKEN.findall(name)} for name in names]
    result = list(read)
    roles = {one.role for one in read} & {"x", "y"}
    named = [n for n, one in enumerate(read) if not one.role and words[n] & {*_ALONG}]
    bare = [n for n, name in enumerate(names) if parted(name.strip())[0].lower() in _BARE]
    if not roles and named:
        words_of = "|".join(sorted(_ALONG, key=len, reverse=True))
        each = partial(re.compile(rf"\b({words_of})\b", re.IGNORECASE).sub, "x")
        result = headings([each(name) if n in named else name for n, name in enumerate(names)])
        roles = {"x"}
    elif not roles and len(bare) == 1:
        unit = parted(names[bare[0]].strip())[1]
        result[bare[0]] = Heading("x", "", unit_word(unit, "length"))
        roles = {"x"} if bool(unit) == bool(unit_word(unit, "length")) else set()
    other = [
        n for n, one in enumerate(result)
        if (not one.role and words[n] and not words[n] & _OTHER) or one.role == "z"
    ]  # fmt: skip
    return result if len(roles) == 1 and not other else None
