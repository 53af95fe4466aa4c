"""From the few words of Python in which the programs are written to languages with braces.

A statement is a declaration (``x: float = …``, ``w = room(3)``), an assignment, a sum (``+=``), an
``if``, a ``while``, a ``for`` over a ``range`` or a ``return``; an expression is arithmetic over
numbers, elements of arrays, calls of functions, comparisons, and one of two.  A language says how
it declares (:class:`Braces`); one without braces has a class of its own beside its file.
"""

from __future__ import annotations

import ast
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import NoReturn


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

    def foot(self, public: Sequence[str]) -> str:
        """What a file ends with: nothing, if the language needs nothing."""
        return ""


_OPERATORS: Mapping[type[ast.AST], tuple[str, int]] = {
    ast.Or: ("||", 1), ast.And: ("&&", 2), ast.Eq: ("==", 4), ast.NotEq: ("!=", 4),
    ast.Lt: ("<", 5), ast.LtE: ("<=", 5), ast.Gt: (">", 5), ast.GtE: (">=", 5), ast.Add: ("+", 6),
    ast.Sub: ("-", 6), ast.Mult: ("*", 7), ast.Div: ("/", 7),
}  # fmt: skip
_UNARY, _ATOM = 8, 9  # how tightly operators bind, the tightest last
_LINE = 96  # characters


class Braces(ABC):
    """A language whose statements and operators look like those of C."""

    functions: Mapping[str, str]  # its names of mathematical functions
    names: Mapping[str, str] = {"nan": "NAN", "True": "true", "False": "false"}

    def comment(self, lines: Sequence[str]) -> str:
        """In the style of C."""
        return "/* " + "\n".join(lines) + " */"

    @abstractmethod
    def signature(self, function: ast.FunctionDef) -> str:
        """The head of a function, up to its brace."""

    @abstractmethod
    def declaration(self, name: str, kind: str, value: str) -> str:
        """The beginning of a variable; ``kind``: float, int, bool, Numbers or counter."""

    @abstractmethod
    def array(self, function: str, name: str, size: str) -> tuple[str, str]:
        """An array to work in: lines before the function, and the declaration inside."""

    @abstractmethod
    def whole(self, value: str) -> str:
        """The whole part of a number that is not negative."""

    def name(self, name: str) -> str:
        """How a function or a table is called there."""
        return name

    # functions

    def function(self, node: ast.FunctionDef) -> str:
        """One function, its docstring as a comment before it.

        >>> from puck_tables.export.languages import LANGUAGES
        >>> tree = ast.parse("def f(x: float) -> float: return -x if x < 0.0 else x")
        >>> print(LANGUAGES["js"].function(tree.body[0]).expandtabs(2))
        function f(x) {
          return x < 0.0 ? -x : x;
        }
        """
        text = ast.get_docstring(node)
        self._before: list[str] = []
        self._here = node.name
        body = node.body[1:] if text is not None else node.body
        lines = [self.signature(node) + " {", *self._block(body, 1), "}"]
        heading = [] if text is None else [self.comment(text.splitlines())]
        return "\n".join([*heading, *self._before, *lines])

    def _block(self, statements: list[ast.stmt], depth: int) -> list[str]:
        return [line for one in statements for line in self._statement(one, depth)]

    def _statement(self, node: ast.stmt, depth: int) -> list[str]:
        pad = "\t" * depth
        match node:
            case ast.AnnAssign(target=ast.Name(id=name), annotation=kind, value=value) if value:
                return _folded(pad, self.declaration(name, ast.unparse(kind), self.of(value)))
            case ast.Assign(
                targets=[ast.Name(id=name)], value=ast.Call(func=ast.Name(id="room"), args=[size])
            ):
                before, inside = self.array(self._here, name, self.of(size))
                self._before += [before] if before else []
                return [pad + inside] if inside else []
            case ast.Assign(targets=[target], value=value):
                return _folded(pad, f"{self.of(target)} = {self.of(value)};")
            case ast.AugAssign(target=target, op=operator, value=value):
                sign = _OPERATORS[type(operator)][0]
                return _folded(pad, f"{self.of(target)} {sign}= {self.of(value)};")
            case ast.Return(value=value):
                return _folded(pad, f"return {self.of(value)};" if value else "return;")
            case ast.Expr(value=value):
                return _folded(pad, f"{self.of(value)};")
            case ast.While(test=test, body=body):
                return _closed(pad, f"while ({self.of(test)})", self._block(body, depth + 1))
            case ast.For(
                target=ast.Name(id=name), iter=ast.Call(func=ast.Name(id="range"), args=args),
                body=body,
            ):  # fmt: skip
                return _closed(pad, self._range(name, args), self._block(body, depth + 1))
            case ast.If(test=test, body=body, orelse=other):
                head, inner = f"if ({self.of(test)})", self._block(body, depth + 1)
                if not other:
                    return _closed(pad, head, inner)
                lines = [f"{pad}{head} {{", *inner, pad + "}"]
                if len(other) == 1 and isinstance(other[0], ast.If):
                    nested = self._statement(other[0], depth)
                    return [*lines[:-1], f"{pad}}} else {nested[0].strip()}", *nested[1:]]
                otherwise = self._block(other, depth + 1)
                return [*lines[:-1], f"{pad}}} else {{", *otherwise, pad + "}"]
        _refuse(node)

    def _range(self, name: str, args: list[ast.expr]) -> str:
        counted = "unused" if name == "_" else name
        values = list(map(self.of, args))
        start, stop, step = [*([] if len(args) > 1 else ["0"]), *values, "1"][:3]
        first = self.declaration(counted, "counter", start)
        if step == "-1":
            return f"for ({first} {counted} > {stop}; {counted}--)"
        return f"for ({first} {counted} < {stop}; {counted}++)"

    # expressions

    def of(self, node: ast.expr) -> str:
        """An expression."""
        return self._bound(node)[0]

    def _bound(self, node: ast.expr) -> tuple[str, int]:
        """An expression, and how firmly its parts hold together."""
        match node:
            case ast.Constant(value=bool(value)):
                return self.names[str(value)], _ATOM
            case ast.Constant(value=value):
                return repr(value), _ATOM
            case ast.Name(id=name):
                return self.names.get(name, self.name(name)), _ATOM
            case ast.Subscript(value=array, slice=place):
                return f"{self.of(array)}[{self.of(place)}]", _ATOM
            case ast.UnaryOp(op=ast.USub(), operand=inner):
                return "-" + self._inside(inner, _UNARY), _UNARY
            case ast.UnaryOp(op=ast.Not(), operand=inner):
                return "!" + self._inside(inner, _UNARY), _UNARY
            case ast.BinOp(left=left, op=operator, right=right):
                sign, firm = _OPERATORS[type(operator)]
                return f"{self._inside(left, firm)} {sign} {self._inside(right, firm + 1)}", firm
            case ast.Compare(left=left, ops=[operator], comparators=[right]):
                sign, firm = _OPERATORS[type(operator)]
                return f"{self._inside(left, 6)} {sign} {self._inside(right, 6)}", firm
            case ast.BoolOp(op=operator, values=values):
                sign, firm = _OPERATORS[type(operator)]
                return f" {sign} ".join(self._inside(one, 4) for one in values), firm
            case ast.IfExp(test=test, body=body, orelse=other):
                return f"{self._inside(test, 1)} ? {self._inside(body, 1)} : {self.of(other)}", 0
            case ast.Call(func=ast.Name(id="int"), args=[inner]):
                return self.whole(self.of(inner)), _ATOM
            case ast.Call(func=ast.Name(id=name), args=args):
                called = self.functions.get(name, self.name(name))
                return f"{called}({', '.join(map(self.of, args))})", _ATOM
        _refuse(node)

    def _inside(self, node: ast.expr, least: int) -> str:
        text, firm = self._bound(node)
        return text if firm >= least else f"({text})"


def _refuse(node: ast.AST) -> NoReturn:
    raise NotImplementedError(f"programs have no such words: {ast.unparse(node)}")


def _closed(pad: str, head: str, body: list[str]) -> list[str]:
    """A head and what belongs to it: a short statement beside it, else in braces."""
    if len(body) == 1 and len(pad) + len(head) + len(body[0].lstrip()) < _LINE:
        return [f"{pad}{head} {body[0].lstrip()}"]
    return [f"{pad}{head} {{", *body, pad + "}"]


def _folded(pad: str, line: str) -> list[str]:
    """A statement over as many lines as it needs."""
    lines: list[str] = []
    indent = pad
    while len(indent) + len(line) > _LINE and " " in line[: _LINE - len(indent)]:
        end = line.rindex(" ", 0, _LINE - len(indent))
        lines.append(indent + line[:end])
        line, indent = line[end + 1 :], pad + "\t\t"
    return [*lines, indent + line]


def rows_of(numbers: Sequence[float], width: int = 96) -> str:
    """Numbers with commas, over lines.

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

    >>> short(2e-06), short(0.5), short(-3.0)
    ('2e-6', '.5', '-3')
    """
    text = repr(number)
    if text.endswith(".0"):
        return text[:-2]
    text = text.replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")
    return text.replace("0.", ".", 1) if text.lstrip("-").startswith("0.") else text
