"""Numbers that are allowed, but of a size that another unit would explain: said, once a name."""

from __future__ import annotations

import contextlib
import math
import threading
from collections.abc import Container, Iterator

from puck_tables._core.own_folder import say
from puck_tables._core.units import SHOWN

OF_A_PUCK = 10.0  # m, of its radius or height
MOST_FRICTION = 5.0  # no dry surface has more
_USUAL = {"m": 100.0, "m/s": 300.0, "rad": 2.0 * math.pi, "kg": 100.0}
_WORDS = {"m": "lengths are in metres", "m/s": "speeds are in m/s", "kg": "masses are in kg",
          "rad": "angles are in radians; if degrees are meant"}  # fmt: skip
_WIDE = 1.0  # rad, of a standard deviation: those of headings are below


_here = threading.local()


@contextlib.contextmanager
def unquestioned(numbers: Container[float] | None = None) -> Iterator[None]:
    """Take numbers as they are in this thread, all or these: they follow, or had a unit."""
    before = getattr(_here, "taken", ())
    _here.taken = numbers
    try:
        yield
    finally:
        _here.taken = before


def question(name: str, number: float, unit: str, usual: float = 0.0) -> None:
    """Say on stderr that a number, which had no unit behind it, is of a doubtful size.

    ``name``: of what it is; of a path such as puck.radius or wall[0].start[1] the last name;
    ``number``, ``unit``: in this SI unit; ``usual``: up to which it is usual, where that differs
    from others of the unit.
    """
    limit = usual or _USUAL.get(unit, math.inf)
    taken = getattr(_here, "taken", ())
    if not limit < abs(number) < math.inf or taken is None or number in taken:
        return
    what = name.rpartition(".")[2].partition("[")[0]
    if what == "orientation" and 2.0 * number % 1.0:  # of a puck that has turned often
        return
    if not unit:
        say(f"a {what} over {limit:g}, more than dry surfaces have: percent are hundredths")
        return
    said = f"a {what} beyond {limit:.4g} {unit}: {_WORDS[unit]}"
    say(f"{said}{' write' if unit == 'rad' else '; write'} another unit behind it: '{SHOWN[unit]}'")


def question_spread(name: str, deviation: float, width: float, unit: str) -> None:
    """Say so of an angle that scatters too widely: by a deviation, or over a width."""
    wide = deviation > _WIDE or width > _USUAL["rad"] * (1.0 + 1e-9)
    if unit == "rad" and wide:
        say(
            f"the {name.rpartition('.')[2]} scatters by {deviation or width:.4g} rad: "
            f"{_WORDS['rad']} write '{SHOWN['rad']}'"
        )
