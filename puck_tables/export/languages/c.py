"""C, from C99 on, and C++."""

from __future__ import annotations

import ast
from collections.abc import Sequence

from puck_tables.export.translate import Braces, Language, rows_of

_KINDS = {"float": "double", "int": "int", "bool": "int", "counter": "int", "None": "void"}
_ARRAYS = {"Numbers": "const double *", "Rows": "const int *", "Out": "double *"}
_COUNTS = ("_ROWS", "_CELLS", "_POWERS")  # tables of integers


class C(Braces, Language):
    """Names begin with ``puck_``; but for the user's functions all are static."""

    key, title, endings = "c", "C99", (".c", ".h")
    functions = {  # noqa: RUF012 - a table
        "abs": "fabs", "sqrt": "sqrt", "exp": "exp", "expm1": "expm1", "log": "log",
        "log1p": "log1p", "sin": "sin", "cos": "cos",
    }  # fmt: skip
    names = {"nan": "NAN", "True": "1", "False": "0"}  # noqa: RUF012

    def __init__(self) -> None:
        self._public: Sequence[str] = ()
        self._locals: set[str] = set()

    def head(self, public: Sequence[str]) -> str:
        """Includes."""
        self._public = public
        return (
            "#include <math.h>\n\n"
            "/* tables are of constant sizes: loops over them unroll where they are inlined */\n"
            "#if defined(__GNUC__)\n"
            "#define PUCK_INLINE static inline __attribute__((always_inline))\n"
            "#else\n#define PUCK_INLINE static inline\n#endif\n"
        )

    def constant(self, name: str, value: float | int) -> str:
        """A constant that compilers fold."""
        return f"#define {self.name(name)} {value!r}"

    def table(self, name: str, numbers: Sequence[float]) -> str:
        """Doubles; of what counts rows integers."""
        if not numbers:
            return ""
        kind = "int" if name.endswith(_COUNTS) else "double"
        return f"static const {kind} {self.name(name)}[] = {{\n{rows_of(numbers)}}};"

    def name(self, name: str) -> str:
        """With a prefix, but for variables of a function."""
        if name in self._locals:
            return name
        return f"PUCK_{name}" if name.isupper() else f"puck_{name}"

    def function(self, node: ast.FunctionDef) -> str:
        """One function; its variables keep their names."""
        self._locals = {one.arg for one in node.args.args} | {
            one.id for one in ast.walk(node)
            if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store)
        }  # fmt: skip
        return super().function(node)

    def signature(self, function: ast.FunctionDef) -> str:
        """Static, but for the user's."""
        self._locals.discard(function.name)
        assert function.returns is not None
        kind = _KINDS[ast.unparse(function.returns)]
        arguments = ", ".join(map(_argument, function.args.args)) or "void"
        own = "" if function.name in self._public else "PUCK_INLINE "
        return f"{own}{kind} {self.name(function.name)}({arguments})"

    def declaration(self, name: str, kind: str, value: str) -> str:
        """By its kind."""
        if kind in _ARRAYS:
            return f"{_ARRAYS[kind]}{name} = {value};"
        return f"{_KINDS[kind]} {name} = {value};"

    def array(self, function: str, name: str, size: str) -> tuple[str, str]:
        """On the stack."""
        return "", f"double {name}[{size}];"

    def whole(self, value: str) -> str:
        """A cast."""
        return f"(int)({value})"


def _argument(one: ast.arg) -> str:
    assert one.annotation is not None
    kind = ast.unparse(one.annotation)
    return _ARRAYS[kind] + one.arg if kind in _ARRAYS else f"{_KINDS[kind]} {one.arg}"


LANGUAGE = C()
