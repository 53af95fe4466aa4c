"""Units that people write, of every quantity that is read, and the size of a pixel."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from decimal import Decimal
from typing import Any

from puck_tables._core.wording import meant
from puck_tables.errors import InputError

PIXEL = "px"

_LENGTHS = {
    "m": "m meter meters metre metres metro metros mètre mètres м", "dm": "dm", "cm": "cm "
    "centimeter centimeters centimetre centimetres centímetros см",
    "mm": "mm millimeter millimeters millimetre millimetres milímetros мм",
    "um": "um µm μm micron microns micrometer micrometre", "km": "km", "in": "in inch inches zoll",
    "ft": "ft foot feet", "yd": "yd yard yards", PIXEL: "px pixel pixels pix píxel píxeles пиксель",
}  # fmt: skip
_METRES = {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 1e-3, "um": 1e-6, "km": 1e3, "in": 0.0254,
           "ft": 0.3048, "yd": 0.9144}  # fmt: skip
_TIMES = {
    "s": "s sec secs second seconds sek sekunde sekunden segundo segundos seconde secondes с сек",
    "ms": "ms msec millisecond milliseconds millis milisegundos мс",
    "us": "us µs μs usec microsecond microseconds", "ns": "ns nanosecond nanoseconds",
    "min": "min minute minutes", "h": "h hr hour hours",
}  # fmt: skip
_SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0}
_ANGLES = {
    "rad": "rad radian radians radianes radianos рад", "deg": "deg degree degrees ° grad_deg "
    "grados graus degré degrés град", "turn": "turn turns rev "
    "revs revolution revolutions", "mrad": "mrad milliradian milliradians",
}  # fmt: skip
_RADIANS = {"rad": 1.0, "deg": math.pi / 180.0, "turn": 2.0 * math.pi, "mrad": 1e-3}
_MEGA = {"Mm": "a megametre: write mm", "Ms": "a megasecond: write ms"}
_GRADS = {"grad", "grads", "gon", "gons", "grade", "grades", "gradian", "gradians"}
_SYMBOL = 3  # letters: of more, capitals say nothing
_KINDS = {"length": (_LENGTHS, {**_METRES, PIXEL: math.nan}), "time": (_TIMES, _SECONDS),
          "angle": (_ANGLES, _RADIANS)}  # fmt: skip
_FORCES = {"N": 1.0, "mN": 1e-3, "uN": 1e-6, "µN": 1e-6, "μN": 1e-6, "cN": 1e-2, "kN": 1e3,
           "MN": 1e6, "newton": 1.0, "newtons": 1.0, "kgf": 9.80665, "gf": 9.80665e-3,
           "lbf": 4.4482216152605}  # fmt: skip
_RATIOS = dict.fromkeys(("1", "-", "–", "—", "dimensionless", "unitless", "ratio", "none"), 1.0)
_RATIOS |= dict.fromkeys(("%", "percent", "per cent", "prozent"), 0.01)
_RATIOS |= dict.fromkeys(("‰", "permille", "per mille", "promille"), 1e-3) | {"ppm": 1e-6}
# m/s: international nautical miles an hour, miles an hour
_SPEEDS = dict.fromkeys(("knot", "knots", "kt", "kts", "kn"), 1852.0 / 3600.0) | {"mph": 0.44704}
_WHOLE = {
    "mps": "m/s", "rpm": "turn/min", "rps": "turn/s", "mmps": "mm/s", "mms": "mm/s", "cmps": "cm/s",
    "cms": "cm/s", "kmh": "km/h", "kmph": "km/h", "kph": "km/h",
}  # fmt: skip
_ACCELERATIONS = dict.fromkeys(("g", "g0", "gn"), 9.80665)
_MASSES = {"kg": 1.0, "g": 1e-3, "mg": 1e-6, "t": 1e3, "lb": 0.45359237, "oz": 0.028349523125}
KIND_OF = {"m": "length", "m/s": "velocity", "rad": "angle", "rad/s": "spin", "s": "time",
           "m/s^2": "acceleration",
           "N": "force", "N m": "torque", "kg": "mass"}  # fmt: skip
SHOWN = {"m": "25mm", "m/s": "2km/h", "rad": "45deg", "rad/s": "30rpm", "s": "40ms", "kg": "20g",
         "m/s^2": "1.62 m/s^2", "N": "5mN", "N m": "5 mN m"}  # fmt: skip
EXAMPLES = {"velocity": "m/s", "spin": "rad/s", "length": "m", "time": "s", "angle": "rad",
            "force": "N", "torque": "N m", "acceleration": "m/s^2"}  # fmt: skip
_NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_BAR = re.compile(rf"\s*({_NUMBER})\s*(?:px|pixels?)\s*=\s*(.+)")


def unit_word(text: str, kind: str) -> str:
    """The usual name of a unit, '' if there is none.

    ``text``: as somebody wrote it; ``kind``: length, time or angle.

    >>> unit_word("Seconds", "time"), unit_word("pixels", "length"), unit_word("m", "time")
    ('s', 'px', '')
    >>> unit_word("MM", "length"), unit_word("Km", "length"), unit_word("Mm", "length")
    ('mm', 'km', '')
    """
    wanted = text.strip()
    if _mixed_up(wanted):
        return ""
    wanted = wanted.lower()
    return next((unit for unit, names in _KINDS[kind][0].items() if wanted in names.split()), "")


def _mixed_up(symbol: str) -> bool:
    """Whether capitals and small letters of a symbol say another unit, or none.

    Headings may be in capitals throughout, and words and symbols may begin with one.

    >>> [_mixed_up(text) for text in ("MM", "Km", "Milliseconds", "Mm", "mM", "uS")]
    [False, False, False, True, True, True]
    """
    if len(symbol) > _SYMBOL or symbol.isupper():
        return False
    return symbol in _MEGA or symbol[1:] != symbol[1:].lower()


def unit_meant(text: str) -> str:
    """Why a unit, perhaps behind a number or over a time, is not read as what it looks like.

    >>> unit_meant("40Mm/s"), unit_meant("Grad"), unit_meant("40 mm")
    ("'Mm' is a megametre: write mm", "'Grad' may be degrees or gradians: write deg (a gradian is \
0.9 deg)", '')
    """
    for word in re.findall(r"[^\W\d_]+", text):
        if word in _MEGA:
            return f"'{word}' is {_MEGA[word]}"
        if word.lower() in _GRADS:
            return f"'{word}' may be degrees or gradians: write deg (a gradian is 0.9 deg)"
        if _mixed_up(word) and word.lower() in (*_METRES, *_SECONDS):
            return f"'{word}' is no unit: write {word.lower()}"
    return ""


def factor(unit: str, kind: str) -> float:
    """A unit in SI: metres, seconds or radians; a pixel has no size.

    >>> factor("cm", "length"), factor("ms", "time")
    (0.01, 0.001)
    """
    return _KINDS[kind][1][unit]


def unit_named(name: str, text: str, kind: str) -> str:
    """The usual name of a unit that is asked for.

    >>> unit_named("unit", "cms", "length")
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: unit = 'cms' is not known (did you mean 'cm'?). Known: m, dm, \
cm, mm, um, km, in, ft, yd, px
    """
    word = unit_word(text, kind) if isinstance(text, str) else ""
    if not word:
        names = [one for line in _KINDS[kind][0].values() for one in line.split()]
        why = unit_meant(str(text)[:40])
        hint = f": {why}" if why else meant(str(text).lower(), names, 0.7)
        raise InputError(
            f"{name} = {text!r:.40} is not known{hint}. Known: {', '.join(_KINDS[kind][0])}"
        )
    return word


def quantity(text: str, unit: str) -> float | None:
    """A number with a unit behind it, such as '25.4mm', in an SI unit; None for anything else.

    ``text``: as somebody wrote it; ``unit``: the SI unit in which it is wanted, of :data:`KIND_OF`.

    >>> quantity("25.4mm", "m"), quantity("2 km/h", "m/s"), quantity("180deg", "rad")
    (0.0254, 0.5555555555555556, 3.141592653589793)
    >>> quantity("25.4", "m"), quantity("25.4 kg", "m")
    (None, None)
    """
    match = re.fullmatch(rf"\s*({_NUMBER})\s*([^\s\d].*?)\s*", text)
    size = unit_size(match[2], KIND_OF[unit]) if match and unit in KIND_OF else None
    if match is None or size is None:
        return None
    if unit_word(match[2], "angle") == "deg":
        number = math.radians(float(match[1]))
    else:
        number = float(Decimal(match[1]) * Decimal(repr(size)))  # 25.4mm is 0.0254 to the last bit
    return number


def measured_kinds(text: str) -> dict[str, float]:
    """A number with a unit in each SI unit that it can be of: '5g' may be a mass or not.

    >>> measured_kinds("40mm"), measured_kinds("40"), list(measured_kinds("5g"))
    ({'m': 0.04}, {}, ['m/s^2', 'kg'])
    """
    values = {unit: quantity(text, unit) for unit in KIND_OF}
    return {unit: number for unit, number in values.items() if number is not None}


def measured(text: str, unit: str) -> float:
    """A number in an SI unit, or with another unit behind it.

    Raises ValueError if it is none.

    >>> measured("1e-3", "m"), measured("2mm", "m")
    (0.001, 0.002)
    """
    value = quantity(text, unit)
    if value is None and ("_" in text or not text.isascii()):  # which float() takes
        raise ValueError(text)
    return float(text) if value is None else value


def without_unit(numbers: Iterable[Any], unit: str) -> str:
    """Which of numbers beside each other has no unit though another has one; '' if all agree.

    '80,50cm/s' may be two numbers in cm/s or the first in m/s: nobody can tell.  0 is 0 in any.

    >>> without_unit(["80", "50cm/s"], "m/s"), without_unit(["0", "50cm/s"], "m/s")
    ('80', '')
    """
    written = [str(one).strip() for one in numbers]
    named = [quantity(one, unit) is not None for one in written]
    if not any(named):
        return ""
    bare = (one for one, has in zip(written, named, strict=True) if not has)
    return next((one for one in bare if re.fullmatch(_NUMBER, one) and float(one)), "")


UNIT_EACH = "give each of these numbers its unit: '{}' has none beside one that has"


def pixel_size(scale: str | float) -> float:
    """The size of a pixel in metres.

    ``scale``: like '0.5mm' or '0.5 mm/px', or a scale bar, '240px = 30cm'; a number is in metres.

    >>> pixel_size("0.5 mm/px"), pixel_size(0.002)
    (0.0005, 0.002)
    >>> pixel_size("240px = 30cm")
    0.00125
    """
    if isinstance(scale, str) and (bar := _BAR.fullmatch(scale)) and float(bar[1]) > 0.0:
        return pixel_size(bar[2]) / float(bar[1])
    what = "scale must be the size of a pixel, a number and a unit such as 0.5mm"
    if isinstance(scale, str):
        match = re.fullmatch(rf"\s*({_NUMBER})\s*([^\s/0-9]*)\s*(?:/\s*(?:px|pixel)\s*)?", scale)
        if match is None or not match[2]:
            raise InputError(f"{what}, got '{scale:.40}'")
        unit = unit_named("the unit of scale", match[2], "length")
        if unit == PIXEL:
            raise InputError(f"{what}, got '{scale:.40}': a length, not pixels")
        size = float(match[1]) * _METRES[unit]
    else:
        try:
            size = float(scale)
        except (TypeError, ValueError, OverflowError):
            raise InputError(f"{what}, or metres as a number, got {scale!r:.40}") from None
    if not (math.isfinite(size) and size > 0.0):
        raise InputError(f"{what}, greater than 0, got {scale!r:.40}")
    return size


def unit_in(heading: str) -> str:
    """The unit of length that a heading names at its end, '' if none.

    >>> unit_in("x [cm]"), unit_in("X_mm"), unit_in("x")
    ('cm', 'mm', '')
    """
    words = re.findall(r"[^\W_]+|°", heading)
    return unit_word(words[-1], "length") if len(words) > 1 else ""


def parted(text: str) -> tuple[str, str]:
    """A name and what stands as its unit, in brackets or after a stroke or comma.

    >>> parted("x [mm]"), parted("t / s"), parted("x")
    (('x', 'mm'), ('t', 's'), ('x', ''))
    """
    match = re.fullmatch(r"(.+?)\s*[\[(<]\s*([^\[\]()<>]*?)\s*[\])>]", text)
    if match is not None:
        return match[1], match[2]
    for form in (r"(.+?)\s*[/,]\s*([^\s/,]+)", r"(.+?)\s+(?:in|en|em)\s+(\S+)"):
        match = re.fullmatch(form, text)
        if match is not None and is_unit(match[2]):
            return match[1], match[2]
    return text, ""


def bracketed(text: str) -> tuple[str, str]:
    """A heading and what stands in brackets at its end.

    >>> bracketed("Sliding speed (mm/s)"), bracketed("v / [m s^-1]"), bracketed("mu")
    (('Sliding speed', 'mm/s'), ('v', 'm s^-1'), ('mu', ''))
    """
    bare = text.strip().strip("\"'").strip()
    match = re.fullmatch(r"(.*?)[\s/_,]*[\[(<{]\s*([^\[\]()<>{}]*?)\s*[\])>}]", bare)
    return (match[1], match[2]) if match is not None and match[1] else (bare, "")


def unit_behind(text: str, kind: str) -> str:
    """The unit of a kind that stands at the end of a heading without brackets, '' if none.

    >>> unit_behind("speed_mm_s", "velocity"), unit_behind("r/R", "radius")
    ('mm/s', '')
    """
    for match in re.finditer(r"\s+in\s+|[\s/_,]+", text):
        behind = text[match.end() :]
        for unit in (behind, behind.replace("_", "/")):
            if match.start() and unit_size(unit, kind) is not None:
                return unit
    return ""


def is_unit(text: str) -> bool:
    """Whether a cell is a unit, in brackets or not: of a row of units under the names.

    >>> is_unit("(cm)"), is_unit("mm/s"), is_unit("x")
    (True, True, False)
    """
    bare = text.strip().strip("[]()<>").strip()
    return bool(unit_word(bare, "length")) or any(unit_size(bare, kind) for kind in EXAMPLES)


def unit_size(unit: str, kind: str) -> float | None:
    """A unit of a kind in SI units, None if it is none.

    ``unit``: as somebody wrote it; ``kind``: length, time, angle, velocity, spin, acceleration,
    force, torque, mass; ratio: a pure number; radius: a length or a pure number; any: whatever it
    is, of size 1.

    >>> unit_size("cm/s", "velocity"), unit_size("m", "velocity"), unit_size("deg/s", "spin")
    (0.01, None, 0.017453292519943295)
    >>> unit_size("mN", "force"), unit_size("N mm", "torque"), unit_size("%", "ratio")
    (0.001, 0.001, 0.01)
    """
    text = unit.strip()
    if text[:2] not in _MEGA:
        text = _WHOLE.get(text.lower(), text)
    if kind == "any":
        return 1.0
    if kind == "ratio":
        return _RATIOS.get(text.lower())
    if kind == "radius":
        size = _RATIOS.get(text.lower())
        return unit_size(text, "length") if size is None else size
    if kind == "force":
        return _FORCES.get(text, _FORCES.get(text.lower()) if text.islower() else None)
    if kind == "mass":
        return _MASSES.get(text)
    if kind == "torque":
        parts = re.fullmatch(r"(\w*?N|\w*?gf|lbf|newtons?)[\s*·.⋅-]*([a-zµμ]+)", text)
        size = None if parts is None else unit_size(parts[1], "force")
        arm = None if parts is None else unit_size(parts[2], "length")
        return None if size is None or arm is None else size * arm
    if kind == "acceleration":
        return _acceleration(text)
    if kind == "velocity" and text in _SPEEDS:
        return _SPEEDS[text]
    if kind in ("velocity", "spin"):
        match = re.fullmatch(r"(.+?)\s*(?:/|\s+per\s+)\s*(.+)", text)
        match = match or re.fullmatch(r"(\S+?)(?:\s+|\*|·|\.)?(s)\^?(?:-1|⁻¹|−1)", text)
        if match is None:
            return None
        above = unit_size(match[1], "length" if kind == "velocity" else "angle")
        below = unit_size(match[2], "time")
        return None if above is None or below is None else above / below
    name = unit_word(text, kind)
    return None if not name or name == PIXEL else factor(name, kind)


def _acceleration(text: str) -> float | None:
    """A unit of acceleration in m/s², None if it is none.

    >>> _acceleration("cm/s^2"), _acceleration("ft s⁻²"), _acceleration("m/s")
    (0.01, 0.3048, None)
    """
    if text in _ACCELERATIONS:
        return _ACCELERATIONS[text]
    if above_below := re.fullmatch(r"(.+)(?:/|\s+per\s+)(.+)", text):  # km/h/s
        speed = unit_size(above_below[1], "velocity")
        seconds = unit_size(above_below[2], "time")
        if speed is not None and seconds is not None:
            return speed / seconds
    match = re.fullmatch(
        r"(.+?)\s*(?:/|\s+per\s+)\s*\(?(.+?)\s*(?:(?:\^|\*\*)?2|²|squared)\)?", text
    )
    match = match or re.fullmatch(
        r"(\S+?)(?:\s+|\*|·|\.|⋅)?(s)(?:\^|\*\*)?\(?(?:[-−]2|⁻²)\)?", text
    )
    above = unit_size(match[1], "length") if match else None
    below = unit_size(match[2], "time") if match else None
    return None if above is None or below is None else above / below**2
