"""Python without any package."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence

from puck_tables.export.translate import Language, rows_of


class Python(Language):
    """The programs as they are."""

    key, title, endings = "python", "Python 3.8", (".py",)

    def comment(self, lines: Sequence[str]) -> str:
        """A docstring."""
        return '"""' + "\n".join(lines) + '\n"""'

    def head(self, public: Sequence[str]) -> str:
        """Imports, and the words of the programs."""
        return (
            "from __future__ import annotations\n\n"
            "from collections.abc import MutableSequence, Sequence\n"
            "from math import cos, exp, expm1, log, log1p, nan, pi, sin, sqrt\n\n"
            f"__all__ = {list(public)}\n\n"
            "Numbers = Rows = Sequence\nOut = MutableSequence\n\n\n"
            "def room(size):\n\treturn [0.0] * size\n\n"
        )

    def constant(self, name: str, value: float | int) -> str:
        """A constant."""
        return f"{name} = {value!r}"

    def table(self, name: str, numbers: Sequence[float]) -> str:
        """A tuple."""
        return f"{name} = (\n{rows_of(numbers)},\n)" if numbers else f"{name} = ()"

    def function(self, node: ast.FunctionDef) -> str:
        """The source of a function without the kinds of its variables."""
        plain = ast.fix_missing_locations(_Plain().visit(node))
        return "\n" + re.sub(r"^( {4})+", _tabs, ast.unparse(plain), flags=re.MULTILINE) + "\n"


def _tabs(spaces: re.Match[str]) -> str:
    return "\t" * (len(spaces[0]) // 4)


class _Plain(ast.NodeTransformer):
    """Variables without annotations; those of arguments stay."""

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.stmt:
        """An assignment."""
        assert node.value is not None
        return ast.Assign([node.target], node.value)


LANGUAGE = Python()
