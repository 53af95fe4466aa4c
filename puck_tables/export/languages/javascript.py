"""JavaScript for browsers and Node."""

from __future__ import annotations

import ast
from collections.abc import Sequence

from puck_tables.export.translate import Braces, Language, rows_of


class JavaScript(Braces, Language):
    """One object of functions, ``puckTables``: for a script, a module and Node."""

    key, title, endings = "js", "JavaScript", (".js", ".mjs", ".cjs")
    functions = {  # noqa: RUF012 - a table
        name: f"Math.{name}"
        for name in ("abs", "sqrt", "exp", "expm1", "log", "log1p", "sin", "cos")
    }
    names = {"nan": "NaN", "True": "true", "False": "false"}  # noqa: RUF012

    def head(self, public: Sequence[str]) -> str:
        """All names are the file's own."""
        return '(function () {\n"use strict";\n'

    def constant(self, name: str, value: float | int) -> str:
        """A constant."""
        return f"const {name} = {value!r};"

    def table(self, name: str, numbers: Sequence[float]) -> str:
        """Doubles in one piece of memory."""
        return f"const {name} = new Float64Array([\n{rows_of(numbers)}]);"

    def foot(self, public: Sequence[str]) -> str:
        """The object, where a script, a module and Node look for it."""
        names = ", ".join(public)
        return (
            f"globalThis.puckTables = {{ {names} }};\n"
            f'if (typeof module === "object") module.exports = {{ {names} }};\n'
            "})();"
        )

    def signature(self, function: ast.FunctionDef) -> str:
        """A plain function."""
        arguments = ", ".join(one.arg for one in function.args.args)
        return f"function {function.name}({arguments})"

    def declaration(self, name: str, kind: str, value: str) -> str:
        """A local variable."""
        return f"let {name} = {value};"

    def array(self, function: str, name: str, size: str) -> tuple[str, str]:
        """Made once: a new one at every call would have to be swept up."""
        own = f"{function}_{name}"
        return f"const {own} = new Float64Array({size});", f"const {name} = {own};"

    def whole(self, value: str) -> str:
        """A whole number."""
        return f"Math.floor({value})"


LANGUAGE = JavaScript()
