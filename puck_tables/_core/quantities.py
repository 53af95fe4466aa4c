"""What the heading of a column of numbers says: which it is, and its unit."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

from puck_tables._core.units import EXAMPLES, bracketed, is_unit, unit_behind, unit_size
from puck_tables.errors import InputError

_TOKEN = re.compile(r"[^\W\d_]+")
_ERRORS = {"std", "sd", "se", "sem", "sigma", "err", "error", "errors", "var", "uncertainty",
           "unsicherheit", "fehler"}  # fmt: skip
_FRAMES = {"frame", "frames", "framenumber", "frameno", "bild", "image", "slice"}
_DIAMETERS = {"diameter", "diametre", "diam", "dia", "durchmesser"}
_FREQUENCIES = {"hz", "khz", "mhz", "1/s", "s^-1", "s-1", "fps"}
# numbers by which a heading says that its own are to be multiplied
_FACTOR = re.compile(
    r"[*×·⋅]\s*\d|\d\s*[*×·⋅]|(?<=[\s(\[_])x\s*\d{2,}|\d{2,}\s*x\b|\b10\s*(?:\^|\*\*|[⁰¹²³⁴-⁹⁻])"
    r"|\b1\s*e\s*[-+]?\d|/\s*10+\b|\bper\s+10+\b|[(\[]\s*(?:10+|\d*\.\d+)\s*[)\]]|^\s*10+\s|\bin\s+10+\b"
    r"|\bthousandths?\b|\bhundredths?\b|\bx\s*\d*\.?\d+e[-+]?\d|[(\[]\s*e\s*[-+]?\d", re.IGNORECASE,
)  # fmt: skip
# what makes of a quantity another one, of which a heading tells
_FUNCTION = re.compile(
    r"\^|\*\*|[²³]|\b(?:log|ln|lg|log10|sqrt|exp)\b|\b1\s*[-−/]|\b(?:ratio|normali[sz]ed|cumulative|fraction|scaled)\b|(?<=_)ratio\b",
    re.IGNORECASE,
)  # fmt: skip
_QUOTIENT = re.compile(r"\w+\s*/\s*\w+")


def function_in(name: str) -> str:
    """What in a heading without its unit makes of its quantity another one; '' if nothing.

    >>> function_in("log v"), function_in("1-e"), function_in("slip speed")
    ('log', '1-', '')
    """
    match = _FUNCTION.search(name)
    return match[0].strip() if match else ""


class InputColumn(NamedTuple):
    """A column that may be wanted.

    ``name``: in messages; ``words``: by which a heading is known, the first as an example;
    ``kind``: of its unit, see :func:`puck_tables._core.units.unit_size`.
    """

    name: str
    words: str
    kind: str

    @property
    def written(self) -> str:
        """A heading as somebody may write it."""
        word, unit = self.words.split()[0], EXAMPLES.get(self.kind)
        return f"{word} [{unit}]" if unit else word


TIME = InputColumn("time", "t time times zeit temps tiempo tempo tijd sec secs seconds", "time")
X = InputColumn("x", "x xpos posx xcoord", "length")
Y = InputColumn("y", "y ypos posy ycoord", "length")
ANGLE = InputColumn("angle", "angle theta θ phi φ orientation rotation winkel", "angle")
SPEED = InputColumn(
    "speed", "v u speed speeds velocity velocities geschwindigkeit vitesse velocidad", "velocity"
)
FRICTION = InputColumn(
    "friction coefficient", "f mu µ μ cof coef coeff coefficient friction reibwert reibzahl "
    "reibungszahl reibungskoeffizient", "ratio",
)  # fmt: skip
RESTITUTION = InputColumn("restitution", "e cor restitution", "ratio")
RADIUS = InputColumn("radius", f"r radius radii rho ρ x radial {' '.join(_DIAMETERS)}", "radius")
PRESSURE = InputColumn("pressure", "p pressure w load stress druck pression", "any")
SPEED_X = InputColumn("velocity along x", "vx Vx velocityx xvelocity speedx xspeed", "velocity")
SPEED_Y = InputColumn("velocity along y", "vy Vy velocityy yvelocity speedy yspeed", "velocity")
SPIN = InputColumn("spin", "spin omega ω w turning drehzahl rotationspeed", "spin")
FACTOR = InputColumn("factor", "factor factors share multiplier faktor facteur", "ratio")
FORCE_X = InputColumn("force along x", "Fx fx forcex xforce", "force")
FORCE_Y = InputColumn("force along y", "Fy fy forcey yforce", "force")
TORQUE = InputColumn("torque", "torque moment m mz tz tau drehmoment", "torque")
ALL = (
    TIME, X, Y, ANGLE, SPEED, FRICTION, RESTITUTION, RADIUS, PRESSURE, FACTOR, FORCE_X, FORCE_Y,
    TORQUE,
)  # fmt: skip


def known_as(text: str, columns: Sequence[InputColumn]) -> InputColumn | None:
    """Which of several columns a heading names."""
    tokens = _tokens(text)
    if _ERRORS & set(tokens):
        return None
    for token in ["".join(tokens), *reversed(tokens)]:  # the last says what it is: 'slip speed'
        for column in columns:
            if token in column.words.lower().split():
                return column
    return None


def measures(text: str) -> bool:
    """Whether a heading is a unit, or is of frames: what it measures is then known."""
    bare = text.strip("[]() ")
    return is_unit(bare) or bare.lower() in _FREQUENCIES or is_frame(text)


def is_frame(text: str) -> bool:
    """Whether a heading is of numbers of frames.

    >>> is_frame("Frame no"), is_frame("t [s]")
    (True, False)
    """
    return bool(_FRAMES & set(_tokens(text)))


def _tokens(text: str) -> list[str]:
    """The words of the name in a heading."""
    return [token.lower() for token in _TOKEN.findall(bracketed(text)[0])]


def with_names(headings: Sequence[str], columns: Sequence[InputColumn]) -> list[str]:
    """Headings of which those that are a unit alone, 'mm/s', have the name of what it measures."""
    named = {known_as(text, columns) for text in headings}
    whole = []
    for text in headings:
        bare = text.strip("[]() ")
        fits = [
            one for one in columns
            if one not in named and one.kind != "any" and unit_size(bare, one.kind) is not None
        ]  # fmt: skip
        if bare and len(fits) == 1 and known_as(text, columns) is None:
            named.add(fits[0])
            text = f"{fits[0].words.split()[0]} [{bare}]"
        whole.append(text)
    return whole


def unit_of(path: str, text: str, column: InputColumn) -> tuple[str, float]:
    """The unit in a heading as it is written, and its size.

    Raises InputError if it is none of the column's kind: what stands in brackets, or behind the
    name and is one of another kind; or if there is a factor beside it.
    """
    if column.kind != "any" and (factor := _FACTOR.search(text)):
        raise InputError(
            f"{path}: its column '{text:.40}' has a factor, '{factor[0].strip()}': write the "
            f"numbers themselves under '{column.written}'"
        )
    name, unit = bracketed(text)
    behind = "" if unit else unit_behind(name, column.kind)
    if function_in(behind):  # 'friction ratio': of friction to what?
        behind = ""
    bare = name.removesuffix(behind)
    made = function_in(bare)
    if not made and column.kind not in ("any", "radius") and not is_unit(bare):  # r/R is a radius
        quotient = _QUOTIENT.search(bare)
        made = quotient[0] if quotient else ""
    if made:
        raise InputError(
            f"{path}: its column '{text:.40}' is not the {column.name} itself, for '{made}' "
            f"stands in it: write that under '{column.written}'"
        )
    if column.kind == "ratio" and (sign := re.search("[%‰]", text)):
        unit = sign[0]  # also 'mu%', 'COF (in %)'
    words = bool(unit) and column.kind in ("ratio", "radius") and not text.rstrip().endswith("]")
    if words and not is_unit(unit) and unit_size(unit, column.kind) is None:
        unit = ""  # 'COF (dynamic)'
    unit = unit or unit_behind(name, column.kind)
    other = column.kind in EXAMPLES and any(unit_behind(name, kind) for kind in EXAMPLES)
    across = column.kind == "radius" and bool(_DIAMETERS & set(_tokens(text)))
    if across and unit_size(unit, "length") is None:
        raise InputError(
            f"{path}: its column '{text:.40}' needs a unit of length, such as [mm], or give radii"
        )
    if not (unit or other):
        return "", 1.0
    size = unit_size(unit, column.kind) if unit else None
    if size is None:
        example = EXAMPLES.get(column.kind)
        what = f"write one such as {example}" if example else "it is a pure number"
        raise InputError(
            f"{path}: the unit of its column '{text:.40}' ({column.name}) is not known: {what}"
        )
    return unit, 0.5 * size if across else size
