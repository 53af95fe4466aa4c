"""One claim of the paper against one number of the program, and how far it is from failing."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Claim:
    """A claim, restated, with what was computed for it.

    ``where`` it stands in the paper, the ``statement`` in one line, what the paper says
    (``stated``), what the program finds (``computed``), and the ``margin``: with ``allowed`` given
    the deviation from what is stated, which may be that large; without, the room left to a strict
    inequality, which must be positive.  ``erratum`` says what is wrong where the paper is known to
    be; such a claim is expected to fail.

    >>> Claim("Cor. 1", "p_a > 0", "> 0", 1.0, 1.0).verdict
    'ok'
    """

    where: str
    statement: str
    stated: str
    computed: float
    margin: float
    allowed: float | None = None
    erratum: str = ""

    @property
    def holds(self) -> bool:
        """Whether the program finds what the paper says; never for a margin that is no number."""
        if self.allowed is None:
            return bool(self.margin > 0.0)
        return bool(self.margin <= self.allowed)

    @property
    def verdict(self) -> str:
        """'ok', 'erratum' (fails, and is known to) or 'DIFFERS' (is not as expected)."""
        if self.holds != bool(self.erratum):
            return "ok" if self.holds else "erratum"
        return "DIFFERS"


def equal(
    where: str, statement: str, stated: float, computed: float, allowed: float, text: str = "",
    erratum: str = "",
) -> Claim:  # fmt: skip
    """The claim that a quantity has a value; ``text`` is how the paper writes it.

    >>> equal("Prop. 4", "critical delta", 1.0, 1.0 + 2e-16, 1e-12).margin
    2.220446049250313e-16
    """
    return Claim(
        where, statement, text or f"{stated:.6g}", computed, abs(computed - stated), allowed,
        erratum,
    )  # fmt: skip


def more(where: str, statement: str, bound: float, computed: float) -> Claim:
    """The claim that a quantity, here at its smallest, is greater than a bound.

    >>> more("Cor. 1", "p_b > 0", 0.0, 0.25).margin
    0.25
    """
    return Claim(where, statement, f"> {bound:.6g}", computed, computed - bound)


def less(where: str, statement: str, bound: float, computed: float) -> Claim:
    """The claim that a quantity, here at its largest, is less than a bound.

    >>> less("section 7", "rate at pi/2", 0.0, -0.25).margin
    0.25
    """
    return Claim(where, statement, f"< {bound:.6g}", computed, bound - computed)


def farthest(values: Iterable[float], target: float) -> float:
    """The value farthest from a target: of several measurements the one to be judged.

    NaN, if there is one.

    >>> farthest([0.9, 1.2], 1.0)
    1.2
    """
    found = np.asarray(list(values))
    return float(found[np.argmax(np.abs(found - target))])


def at_least(where: str, statement: str, bound: float, computed: float, allowed: float) -> Claim:
    """The claim that a quantity, here at its smallest, is not below a bound that it touches.

    >>> at_least("Prop. 4", "pressure", 0.0, 1e-17, 1e-14).margin
    0.0
    """
    return Claim(where, statement, f">= {bound:.6g}", computed, max(bound - computed, 0.0), allowed)


def as_page(subjects: Mapping[str, Sequence[Claim]]) -> str:
    """The claims, by subject, as tables in Markdown."""
    lines: list[str] = []
    for subject, group in subjects.items():
        lines += [f"## {subject}", "", "| where | claim | paper | computed | margin | |"]
        lines += ["| --- | --- | --- | --- | --- | --- |"]
        for c in group:
            cells = (c.where, c.statement, c.stated, f"{c.computed:.6g}", _margin(c), c.verdict)
            lines.append("| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |")
        lines.append("")
    return "\n".join(lines)


def _margin(claim: Claim) -> str:
    if claim.allowed is None:
        return f"{claim.margin:.3g} to spare"
    return f"off {claim.margin:.0e} {'<=' if claim.holds else '>'} {claim.allowed:.0e}"
