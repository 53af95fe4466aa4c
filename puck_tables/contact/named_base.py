"""The base that a text names: by its lengths, or by a file of corners or a drawing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from puck_tables._core.arrays import instance, number_in, shown
from puck_tables._core.doubts import OF_A_PUCK, question
from puck_tables._core.drawn_outlines import SUFFIXES, outlines_of
from puck_tables._core.safe_read import is_number
from puck_tables._core.safe_write import as_utf8
from puck_tables.contact.base import Base
from puck_tables.errors import InputError

NAMES = (
    "box:LENGTHxWIDTH, disc:RADIUS, annulus:RADIUSxINNER, polygon:X,Y;X,Y;X,Y, feet:RADIUS;X,Y;X,Y "
    "or ;X,Y,LOAD (m, or with units), a CSV of x, y or a drawing (SVG)"
)


def base_of(text: str) -> Base:
    """The base of a text: of a name with lengths, or of a file of corners, or a drawing.

    ``text``: box:LENGTHxWIDTH, disc:RADIUS, annulus:RADIUSxINNER, polygon:X,Y;X,Y;X,Y by its
    corners, feet:RADIUS;X,Y;X,Y by their places (X,Y,LOAD with loads of their own), in m or with
    units (box:20cmx10cm), or the path of a CSV file with columns x and y or of a drawing (SVG, of
    an outline and its holes); ``@X,Y`` after it is the centre of mass.  Raises InputError if it is
    not known, or a number is out of range; ContactError if part of it would lift.

    >>> round(base_of("box:20cmx10cm@1cm,0").middle[0], 6)
    0.01
    >>> round(base_of("polygon:0,0;20cm,0;0,10cm").area, 6)
    0.01
    """
    instance("base", text, str)
    shape, at, place = text.rpartition("@") if "@" in text else (text, "", "")
    centre = None
    if at:
        centre = _place(f"base {shown(text)}: the centre of mass is @X,Y, got @{place}", place)
    if shape.lower().endswith(SUFFIXES):
        corners, *holes = outlines_of(shape)
        base = Base.polygon(corners, holes=holes, centre=centre, name=as_utf8(text))
        question("base", base.reach, "m", OF_A_PUCK)
        return base
    kind, _, sizes = shape.partition(":")
    if kind in ("polygon", "feet"):
        return _by_places(kind, sizes, text, centre)
    makers: dict[str, tuple[Callable[..., Base], int]]
    makers = {"box": (Base.box, 2), "disc": (Base.disc, 1), "annulus": (Base.annulus, 2)}
    if kind not in makers:
        raise InputError(f"no base is called {shown(text)}: choose {NAMES}")
    make, count = makers[kind]
    parts = sizes.split("x")
    lengths = [_length(f"base {shape}", part) for part in parts] if len(parts) == count else []
    if not lengths:
        raise InputError(
            f"base {shown(text)}: {kind} takes {count} lengths, an x between; choose {NAMES}"
        )
    base = make(*lengths, centre=centre)
    return replace(base, name=text) if at else base


def _by_places(
    kind: str, sizes: str, text: str, centre: tuple[float, float] | None
) -> Base:  # fmt: skip
    """A polygon, or feet, of a text of places."""
    first, *rest = sizes.split(";")
    each = "its corners are X,Y;X,Y;X,Y"
    if kind == "feet":
        each = "feet are RADIUS;X,Y;X,Y, or each X,Y,LOAD"
    wrong = f"base {shown(text)}: {each}, in m or with units"
    if kind == "polygon":
        places = [_place(wrong, part) for part in (first, *rest)]
        return Base.polygon(places, centre=centre, name=text)
    if not rest:
        raise InputError(wrong)
    radius = _length(f"base {kind}", first)
    parts = [part.split(",") for part in rest]
    loads = None
    if all(len(one) == 3 for one in parts):
        values = [one.pop() for one in parts]
        loads = [
            float(one) if is_number(one) else number_in("a load of a foot", one, "N")
            for one in values
        ]
    places = [_place(wrong, ",".join(one)) for one in parts]
    base = Base.feet(places, radius, centre=centre, loads=loads)
    return replace(base, name=text)


def _place(wrong: str, text: str) -> tuple[float, float]:
    """A place of a text X,Y, m, or what is wrong with it."""
    numbers = [_length("a place of the base", part) for part in text.split(",")]
    if len(numbers) != 2:
        raise InputError(wrong)
    return numbers[0], numbers[1]


def _length(name: str, text: str) -> float:
    """A length, m, with or without a unit; one without that is no size of a puck is questioned."""
    if not is_number(text):
        return number_in(name, text, "m")
    question("base", float(text), "m", OF_A_PUCK)
    return float(text)
