"""The measured front: what each way of answering costs and how far off it is; and the knob.

The file ``tables/front.csv`` holds what ``puck tradeoff`` measured once.  Errors are properties of
a way and hold everywhere; costs are those of the machine that measured, and only their order
matters here.  The knob takes the cheapest way whose measured error, times a margin for what the
measurement did not see, is within the tolerance.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from dataclasses import dataclass, fields
from functools import cache, lru_cache
from importlib.resources import files

from puck_tables.errors import AccuracyError, TableError

COARSEST, FINEST = 0.01, 1e-13
MARGIN = 1.5  # errors are measured at a thousand starts: others may be a little worse

LOOK_UP = "look-up"
RK4_TABLE, RK4_EXACT = "rk4, table", "rk4, closed forms"
ADAPTIVE_TABLE, ADAPTIVE_EXACT = "adaptive, table", "adaptive, closed forms"
INTEGRATED = (RK4_TABLE, RK4_EXACT, ADAPTIVE_TABLE, ADAPTIVE_EXACT)


@dataclass(frozen=True)
class Way:
    """One way of answering a question, measured.

    ``question``: resultants (three at a point), stop, trajectory, state.  ``method`` and
    ``setting`` name the way; ``outsider`` is 1 for what is not this program.  Errors are absolute
    and dimensionless: of the resultants, or in units of Q/J (time) and Q²/J (place); ``error`` is
    the worst, ``median_error`` the median over all starts.  ``ns`` is the median cost of one item
    on one thread in nanoseconds, ``ns_spread`` the distance between the quartiles, ``limit_ns`` the
    time that the machine's peak (``limit``: arithmetic or memory) would allow, 0 if not counted.
    """

    question: str
    method: str
    setting: str
    outsider: int
    error: float
    median_error: float
    time_error: float
    place_error: float
    ns: float
    ns_spread: float
    bytes: int
    build_s: float
    limit_ns: float
    limit: str

    def number(self, name: str) -> float:
        """A number of the setting, which reads like ``powers=6 thinning=2``.

        Examples
        --------
        >>> choose("stop", 1e-8).way.number("powers") >= 5
        True
        """
        return float(dict(part.split("=") for part in self.setting.split())[name])

    @property
    def name(self) -> str:
        """Method and setting."""
        return f"{self.method} ({self.setting})" if self.setting else self.method


@dataclass(frozen=True)
class Choice:
    """What the knob took, and why (``why``: lines of text)."""

    way: Way
    tol: float
    why: str


def ways_from_csv(text: str) -> tuple[Way, ...]:
    """Ways from what ``puck tradeoff -o front.csv`` saved.

    Raises
    ------
    TableError
        If the text is not such a file.

    Examples
    --------
    >>> ways_from_csv("question,method")
    ()
    """
    kinds = {"str": str, "int": int, "float": float}
    readers = {field.name: kinds[str(field.type)] for field in fields(Way)}
    try:
        rows = [
            {name.partition("[")[0]: value for name, value in row.items()}
            for row in csv.DictReader(io.StringIO(text))
        ]
        return tuple(Way(**{n: read(row[n]) for n, read in readers.items()}) for row in rows)
    except (KeyError, TypeError, ValueError):
        raise TableError("the file of measured ways is damaged: install the package anew") from None


@cache
def shipped_front() -> tuple[Way, ...]:
    """What came with the package.

    Examples
    --------
    >>> {way.question for way in shipped_front()} >= {"resultants", "stop", "trajectory", "state"}
    True
    """
    try:
        text = (files("puck_tables.tables") / "front.csv").read_text(encoding="utf-8")
    except OSError:
        raise TableError("tables/front.csv is missing: install the package anew") from None
    return ways_from_csv(text)


def pareto(ways: Iterable[Way]) -> list[Way]:
    """Those that no other beats in both error and cost, the cheapest first.

    Examples
    --------
    >>> front = pareto(way for way in shipped_front() if way.question == "stop")
    >>> all(a.error > b.error for a, b in zip(front[:-1], front[1:]))
    True
    """
    front: list[Way] = []
    for way in sorted(ways, key=lambda way: (way.ns, way.error)):
        if not front or way.error < front[-1].error:
            front.append(way)
    return front


@lru_cache(maxsize=256)
def choose(
    question: str,
    tol: float,
    methods: tuple[str, ...] = (LOOK_UP, *INTEGRATED),
    added_error: float = 0.0,
) -> Choice:
    """The cheapest way to a tolerance, by measured errors.

    Parameters
    ----------
    question : 'stop' or 'trajectory'
    tol : largest error wanted, in units of Q/J (times) and Q²/J (places), 1e-13 to 0.01
    methods : the methods that may be taken
    added_error : what the answer is off besides, such as by a table of one's own

    Returns
    -------
    Choice

    Raises
    ------
    AccuracyError
        If the tolerance is out of reach of these methods.

    Examples
    --------
    >>> choose("stop", 1e-6).way.method, choose("stop", 1e-12).way.method
    ('look-up', 'adaptive, closed forms')
    """
    known = [w for w in shipped_front() if w.question == question and w.method in methods]
    off = {way: MARGIN * way.error + added_error for way in known}
    best = max(FINEST, min(off.values()))
    if not best <= tol <= COARSEST:
        hint = "" if ADAPTIVE_EXACT in methods else "; integration with closed forms reaches 1e-13"
        raise AccuracyError(
            f"tol must be from {_up(best)} (the best of {' / '.join(dict.fromkeys(methods))}) to "
            f"{COARSEST:g}, in units of Q/J and Q^2/J, got {tol:g}: give a tol in that range{hint}"
        )
    ranked = sorted(known, key=lambda way: way.ns)
    taken = next(way for way in ranked if off[way] <= tol)
    cheaper = [way for way in ranked if way.ns < taken.ns]
    dearer = next((w for w in pareto(known) if w.ns > taken.ns and w.error < taken.error), None)
    lines = [
        f"asked         error <= {tol:.3g} of Q/J (times) and Q^2/J (places)",
        f"taken         {_told(taken)}",
        f"measured      {taken.error:.2g} at the worst of the starts, x {MARGIN:g} for those not "
        f"measured{f', + {added_error:.2g} of the table' if added_error else ''}",
    ]
    if cheaper:
        lines.append(f"cheaper, no   {_told(min(cheaper, key=lambda way: way.error))}")
    if dearer is not None:
        lines.append(f"closer, dear  {_told(dearer)}")
    return Choice(taken, tol, "\n".join(lines))


def _told(way: Way) -> str:
    return f"{way.name}: error {way.error:.2g}, {_duration(way.ns)} when measured"


def _duration(ns: float) -> str:
    return f"{ns:.3g} ns" if ns < 1e3 else f"{ns / 1e3:.3g} us"


def _up(value: float) -> str:
    """To two digits, upwards."""
    text = f"{value:.1e}"
    mantissa, exponent = text.split("e")
    if float(text) < value:
        text = f"{float(mantissa) + 0.1:.1f}e{exponent}"
    return f"{float(text):g}"
