"""The accuracy-cost front: what each method costs and errs, measured; and the selection by it.

The file ``tables/front.csv`` holds what ``puck tradeoff`` measured once.  Errors are properties of
a method and hold everywhere; costs are those of the machine that measured, and only their order
matters here.  Selected is the cheapest method whose measured error, times a margin for what the
measurement did not see, is within the tolerance.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from dataclasses import dataclass, fields
from functools import cache, lru_cache
from importlib.resources import files

from puck_tables._core.arrays import rounded_up
from puck_tables.accuracy.methods import INTEGRATED, LOOK_UP, MEASURED, FrictionForm, Method, Scheme
from puck_tables.errors import AccuracyError, TableError

COARSEST, FINEST = 0.01, 1e-13  # of Q/(fg), Q²/(fg): looser nobody measured; finer is rounding
MARGIN = 1.5  # errors are measured at a thousand starts: others may be a little worse
UNITS = "of Q/(f g) (times) and Q^2/(f g) (places)"


@dataclass(frozen=True)
class MeasuredMethod:
    """One method of answering a question, measured.

    ``question``: resultants (three at a point), stop, trajectory, state.  ``method`` and
    ``setting`` name it; ``outsider`` is 1 for what is not this program.  Errors are absolute
    and dimensionless: of the resultants, or in units of Q/(fg) (time) and Q²/(fg) (place);
    ``error`` is the worst, ``median_error`` the median over all starts.  ``ns`` is the median cost
    of one item on one thread in nanoseconds, ``ns_spread`` the distance between the quartiles.
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

    @property
    def scheme(self) -> Scheme | None:
        """Which of the schemes that can be selected it measured, if any."""
        return MEASURED.get(self.method)

    @property
    def name(self) -> str:
        """Method and setting."""
        return named(self.method, self.setting)


@dataclass(frozen=True)
class Selection:
    """The method selected for a tolerance: its setting, its error, and why (``explanation``)."""

    scheme: Scheme
    setting: str
    error: float
    tol: float
    explanation: str

    @property
    def method(self) -> Method:
        """The method alone."""
        return self.scheme.method

    def number(self, name: str) -> float:
        """A number of the setting, which reads like ``powers=6 thinning=2``.

        >>> select("stop", 1e-8).number("powers") >= 5
        True
        """
        return float(dict(part.split("=") for part in self.setting.split())[name])


def named(method: str, setting: str) -> str:
    """Method and setting in words.

    >>> named("rk4, table", "steps=8")
    'rk4, table (steps=8)'
    """
    return f"{method} ({setting})" if setting else method


def errors_from_csv(text: str) -> tuple[MeasuredMethod, ...]:
    """The front from what ``puck tradeoff -o front.csv`` saved.

    Raises TableError if the text is not such a file.

    >>> errors_from_csv("question,method")
    ()
    """
    kinds = {"str": str, "int": int, "float": float}
    readers = {field.name: kinds[str(field.type)] for field in fields(MeasuredMethod)}
    try:
        rows = [
            {name.partition("[")[0]: value for name, value in row.items()}
            for row in csv.DictReader(io.StringIO(text))
        ]
        return tuple(
            MeasuredMethod(**{n: read(row[n]) for n, read in readers.items()}) for row in rows
        )
    except (KeyError, TypeError, ValueError):
        raise TableError("the measured front is damaged: install the package anew") from None


@cache
def shipped_errors() -> tuple[MeasuredMethod, ...]:
    """What came with the package.

    >>> {row.question for row in shipped_errors()} >= {"resultants", "stop", "trajectory", "state"}
    True
    """
    try:
        text = (files("puck_tables.tables") / "front.csv").read_text(encoding="utf-8")
    except OSError:
        raise TableError("tables/front.csv is missing: install the package anew") from None
    return errors_from_csv(text)


def pareto(rows: Iterable[MeasuredMethod]) -> list[MeasuredMethod]:
    """The methods that no other beats in both error and cost, the cheapest first.

    >>> front = pareto(row for row in shipped_errors() if row.question == "stop")
    >>> all(a.error > b.error for a, b in zip(front[:-1], front[1:]))
    True
    """
    best: list[MeasuredMethod] = []
    for row in sorted(rows, key=lambda row: (row.ns, row.error)):
        if not best or row.error < best[-1].error:
            best.append(row)
    return best


@lru_cache(maxsize=256)
def select(
    question: str,
    tol: float,
    schemes: tuple[Scheme, ...] = (LOOK_UP, *INTEGRATED),
    own_table: tuple[str, float] | None = None,
) -> Selection:
    """The cheapest method to a tolerance, by measured errors.

    ``question``: 'stop' or 'trajectory'; ``tol``: largest error wanted, in units of Q/(fg) (times)
    and Q²/(fg) (places), 1e-13 to 0.01; ``schemes``: what may be selected; ``own_table``: the name
    of a table that stands where closed forms were measured, and what it adds to the error.  Raises
    AccuracyError if the tolerance is out of reach of these schemes.

    >>> select("stop", 1e-6).scheme.name, select("stop", 1e-12).scheme.name
    ('look-up', 'adaptive, closed forms')
    """
    added = 0.0 if own_table is None else own_table[1]
    rows = [row for row in shipped_errors() if row.question == question and row.scheme in schemes]
    off = {row: MARGIN * row.error + added for row in rows}
    best = max(FINEST, min(off.values()))
    if not best <= tol <= COARSEST:
        names = " / ".join(_said_scheme(scheme, own_table) for scheme in schemes)
        exact = Scheme(Method.ADAPTIVE, FrictionForm.CLOSED_FORMS)
        hint = "" if exact in schemes else "; integration with closed forms reaches 1e-13"
        raise AccuracyError(
            f"tol must be from {rounded_up(best, 2):g} (the best of {names}) to {COARSEST:g}, in "
            f"units of Q/(f g) and Q^2/(f g), got {tol:g}: give a tol in that range{hint}"
        )
    ranked = sorted(rows, key=lambda row: row.ns)
    taken = next(row for row in ranked if off[row] <= tol)
    cheaper = min(
        (row for row in ranked if row.ns < taken.ns), key=lambda row: row.error, default=None
    )
    closer = next((r for r in pareto(rows) if r.ns > taken.ns and r.error < taken.error), None)
    lines = [
        f"Asked: an error of at most {tol:.3g} {UNITS}.",
        f"Taken: {_said(taken, own_table)}, {_duration(taken.ns)} when measured.",
        f"It errs by {taken.error:.2g} at the worst of the starts; times {MARGIN:g} for those not "
        f"measured{f', plus {added:.2g} of the table' if added else ''}, that is within the "
        "tolerance.",
    ]
    if cheaper is not None:
        lines.append(
            f"A cheaper method, {_said(cheaper, own_table)}, errs by {cheaper.error:.2g} (times "
            f"{MARGIN:g}), more than the tolerance asks."
        )
    if closer is not None:
        lines.append(
            f"A closer method, {_said(closer, own_table)}, errs by {closer.error:.2g} and costs "
            f"more: {_duration(closer.ns)}."
        )
    scheme = MEASURED[taken.method]
    return Selection(scheme, taken.setting, taken.error, tol, "\n".join(lines))


def _said_scheme(scheme: Scheme, own_table: tuple[str, float] | None) -> str:
    if own_table is None or scheme.source is None:
        return scheme.name
    return f"{scheme.method}, the table {own_table[0]}"


def _said(row: MeasuredMethod, own_table: tuple[str, float] | None) -> str:
    return named(_said_scheme(MEASURED[row.method], own_table), row.setting)


def _duration(ns: float) -> str:
    return f"{ns:.3g} ns" if ns < 1e3 else f"{ns / 1e3:.3g} us"
