"""What a language is to the export."""

from __future__ import annotations

import ast
from abc import ABC, abstractmethod
from collections.abc import Sequence


class Language(ABC):
    """How a file of programs is written in one language.

    ``key``: its name on the command line; ``title``: in words; ``endings``: of its files.
    """

    key: str
    title: str
    endings: tuple[str, ...]

    @abstractmethod
    def comment(self, lines: Sequence[str]) -> str:
        """Lines of text as a comment."""

    @abstractmethod
    def head(self, public: Sequence[str]) -> str:
        """What a file begins with, after its licence; ``public``: the functions of its user."""

    @abstractmethod
    def constant(self, name: str, value: float | int) -> str:
        """A named number."""

    @abstractmethod
    def table(self, name: str, numbers: Sequence[float]) -> str:
        """A named array of numbers."""

    @abstractmethod
    def function(self, node: ast.FunctionDef) -> str:
        """A function of the programs."""

    @abstractmethod
    def foot(self, public: Sequence[str]) -> str:
        """What a file ends with."""


def rows_of(numbers: Sequence[float], width: int = 96) -> str:
    """Numbers with commas, over lines.

    Examples
    --------
    >>> rows_of([1, -2.5, 3.0])
    '1,-2.5,3'
    """
    lines, line = [], ""
    for number in numbers:
        text = short(number)
        if len(line) + len(text) >= width:
            lines.append(line)
            line = ""
        line += text + ","
    return "\n".join([*lines, line.rstrip(",")])


def short(number: float) -> str:
    """A number with no more signs than it needs.

    Examples
    --------
    >>> short(2e-06), short(0.5), short(-3.0)
    ('2e-6', '.5', '-3')
    """
    text = repr(number)
    if text.endswith(".0"):
        return text[:-2]
    text = text.replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")
    return text.replace("0.", ".", 1) if text.lstrip("-").startswith("0.") else text
