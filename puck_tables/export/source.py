"""One self-contained source file: tables, programs, licence, and vectors that test them."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from puck_tables._core.arrays import instance, listed, real, shown
from puck_tables._core.safe_write import write_bytes
from puck_tables._version import __version__
from puck_tables.errors import AccuracyError, InputError
from puck_tables.export.check_vectors import INPUTS, cases_of
from puck_tables.export.exported_tables import base_tables, round_tables
from puck_tables.export.languages import LANGUAGES
from puck_tables.export.licence import LICENCE
from puck_tables.export.program import (
    base_step,
    launch_motion,
    look_ups,
    resultant_formulas,
    self_check,
)
from puck_tables.puck import Puck

FINEST, COARSEST = 1e-9, 1e-2  # of Q/(fg), Q²/(fg): as fine as the stop table; looser is no answer
PARTS = {  # what can be asked for, and the functions of it that its user calls
    "stop": ("stop",), "state": ("stop", "state", "turn"), "resultants": ("resultants",),
    "wrench": ("wrench", "step"),
}  # fmt: skip
_MISSES = '''
def {name}_misses() -> int:
    """How many numbers of the test vectors {name}() misses."""
    c: Numbers = {upper}_CASES
    out = room({answers})
    missed: int = 0
    for n in range({upper}_COUNT):
        k: int = n * {width}
        missed += {name}({arguments}, out)
        for j in range({answers}):
            missed += misses(out[j], c[k + {given} + j], {unit})
    return missed
'''
_UNITS = {
    "stop": "stop_unit(c, k, j)", "state": "state_unit(c, k, j)", "step": "step_unit(j)",
}  # fmt: skip
_SELF_TEST = '''
def self_test() -> int:
    """How many numbers of the test vectors are missed: 0."""
    return {total}
'''


@dataclass(frozen=True)
class Source:
    """A source file.

    Parameters
    ----------
    text : its content
    language : one of :func:`languages`
    what : what it computes
    tol : the largest error of it, in units of Q/(fg) (times), Q²/(fg) (places), Q (speeds), rad
    kind : pressure and gyration in words, empty for homogeneous pucks under uniform pressure
    tallest : δ up to which it holds
    """

    text: str
    language: str
    what: tuple[str, ...]
    tol: float
    kind: str = ""
    tallest: float = 1.0

    def __repr__(self) -> str:
        size = len(self.text.encode())
        of = f", {self.kind}" + _heights(self.tallest) if self.kind else ""
        return f"Source({self.language}, {', '.join(self.what)} to {self.tol:g}{of}, {size} bytes)"

    def save(self, path: str | Path, overwrite: bool = False) -> None:
        """Write the file.

        Parameters
        ----------
        path : ending as the language has it
        overwrite : whether an existing file may be replaced

        Raises
        ------
        InputError
            If the ending is another language's.
        OutputError
            If the file exists or cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     export_source("c", "resultants").save(folder + "/puck.c")
        ...     Path(folder, "puck.c").read_text()[:14]
        '/* puck-tables'
        """
        instance("path", path, str, Path)
        checked_ending(path, self.language)
        write_bytes(path, self.text.encode(), overwrite)


def export_source(
    language: str,
    what: str | Iterable[str] = ("stop", "state", "resultants"),
    tol: float = 1e-6,
    puck: Puck | None = None,
) -> Source:
    """A source file that computes stops, states or resultants without this package.

    Parameters
    ----------
    language : 'c', 'js' or 'python'
    what : 'stop' (where and when a launch stops), 'state' (states at any time, the turn of the
        heading, and stop), 'resultants' (of friction), or some of them; of a puck on a base
        'wrench' (of friction; and a step of its motion)
    tol : float
        Largest error, in units of Q/(fg) (times), Q²/(fg) (places), Q²/(fg r) (body angle), Q
        (velocity), Q/r (spin) and 1 (turn of the heading), Q = hypot(v, rω) of the launch; 1e-9 to
        0.01. Of resultants 1; in closed form, 1e-14, under uniform pressure.
    puck : Puck, optional
        Whose pressure law and radius of gyration the file is for; the height and all else are
        arguments of its functions.  Default: homogeneous, under uniform pressure.

    Returns
    -------
    Source
        For all heights under which the whole base stays loaded in every motion, 0 ≤ δ ≤
        ``tallest``: 1 under uniform pressure, 0.8 under Hertz's, 4/3 under Galin's, 2 on a ring,
        1 + a² on an annulus.

    Raises
    ------
    InputError
        If a language or a part is not known.
    AccuracyError
        If the tolerance is out of reach: of states, where the limit ratio lies next to 0, to
        infinity or to where the centre of rotation crosses an edge of the load; of stops, on a ring
        below 1e-8, under Galin's law on a homogeneous puck below 2e-8, and where the radius of
        gyration is next to 0.1 r or beyond 4 r.

    Notes
    -----
    A function fills an array and returns a code: 0, or 1 where an argument is not finite or out of
    range, or 2 where the motion is too large for floating point; the array holds nothing but NaN
    then.  ``self_test`` returns how many numbers of the vectors in the file are missed: 0.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, section 2 (symmetry) and eq. 6.2–6.7.

    Examples
    --------
    >>> import runpy, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     export_source("python", "stop", 1e-4).save(folder + "/puck.py")
    ...     puck = runpy.run_path(folder + "/puck.py")
    >>> out = [0.0] * 5
    >>> puck["stop"](1.0, 0.0, 5.0, 1.0, 1.0, 1.0, out), round(out[0], 2), puck["self_test"]()
    (0, 4.0, 0)
    """
    parts = checked_request(language, what, tol)
    instance("puck", puck, Puck, type(None))
    kind = Puck(radius=1.0) if puck is None else puck
    if kind.shape is not None or "wrench" in parts:
        if parts != ("wrench",):
            raise InputError(
                "of a puck on a base 'wrench' is exported, with a step of its motion, and nothing "
                "else; of one without a base all but that: choose what fits, or give no base"
            )
        tables, constants = base_tables(kind)
        text = _text(language, parts, float(tol), kind, tables, constants)
        return Source(text, language, parts, float(tol), _words(kind), 0.0)
    tables, constants = round_tables(kind, parts, float(tol))
    tallest, words = float(constants["TALLEST"]), _words(kind)
    text = _text(language, parts, float(tol), kind, tables, constants)
    return Source(text, language, parts, float(tol), words, tallest)


def checked_request(language: str, what: str | Iterable[str], tol: float) -> tuple[str, ...]:
    """What is asked for, in the order of :data:`PARTS`.

    >>> checked_request("c", "state,stop", 1e-6)
    ('stop', 'state')
    """
    instance("language", language, str)
    if language not in LANGUAGES:
        raise InputError(f"no language is called {shown(language)}: choose {', '.join(LANGUAGES)}")
    error = real("tol", tol, "units of Q/(f g), Q^2/(f g)")
    if not FINEST <= error <= COARSEST:
        raise AccuracyError(
            f"tol must be from {FINEST:g} to {COARSEST:g} for exported files, got {error:g}: give "
            "a tol in that range"
        )
    wanted = what.split(",") if isinstance(what, str) else listed("what", what, "names")
    names = [one.strip() if isinstance(one, str) else one for one in wanted]
    for name in names:
        if not isinstance(name, str) or name not in PARTS:
            raise InputError(
                f"nothing to export is called {shown(name)}: choose {', '.join(PARTS)}"
            )
    if not names:
        raise InputError(f"there is nothing to export: choose {', '.join(PARTS)}")
    return tuple(part for part in PARTS if part in names)


def checked_ending(path: str | Path, language: str) -> None:
    """Refuse a file name whose ending is not that of the language.

    >>> checked_ending("puck.js", "c")
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: puck.js: a file of C99 ends in .c or .h
    """
    of = LANGUAGES[language]
    if Path(path).suffix.lower() not in of.endings:
        raise InputError(f"{path}: a file of {of.title} ends in {' or '.join(of.endings)}")


def _text(
    key: str, parts: tuple[str, ...], tol: float, kind: Puck, tables: Mapping[str, Sequence[float]],
    constants: Mapping[str, float],
) -> str:  # fmt: skip
    """The whole file."""
    language, based = LANGUAGES[key], kind.shape is not None
    modules = [
        look_ups,
        launch_motion,
        resultant_formulas,
        *([base_step] if based else []),
        self_check,
    ]
    public = list(dict.fromkeys(name for part in parts for name in PARTS[part]))
    functions = {node.name: node for module in modules for node in functions_of(module)}
    looked_up = functions.pop("looked_up_integrals")
    if "PATCH" in tables:
        looked_up.name = "shape_integrals"
        functions[looked_up.name] = looked_up
    cases = cases_of(public, tol, kind)
    functions |= _self_test({name: width for name, (width, _) in cases.items()})
    functions = with_callees(functions, [*public, "self_test"])
    numbers: dict[str, Any] = {  # what stands for a number of the file is replaced
        name: value for module in modules for name, value in vars(module).items()
        if name.isupper() and isinstance(value, int | float)
    }  # fmt: skip
    numbers["TOLERANCE"] = tol
    arrays: dict[str, Sequence[float]] = {}
    for name, (width, values) in cases.items():
        arrays[f"{name.upper()}_CASES"] = values
        numbers[f"{name.upper()}_COUNT"] = len(values) // width
    arrays |= tables
    numbers |= constants
    whole = _Whole({n: v for n, v in numbers.items() if isinstance(v, int)})
    functions = {name: whole.visit(node) for name, node in functions.items()}
    used = {
        one.id for node in functions.values() for one in ast.walk(node) if isinstance(one, ast.Name)
    }  # fmt: skip
    title = _title(language.title, parts, tol, public, kind, constants.get("TALLEST", 0.0))
    pieces = [
        language.comment([*title, "", *LICENCE.splitlines()]),
        language.head([*public, "self_test"]),
        *(language.constant(n, v) for n, v in numbers.items() if n in used),
        *(language.table(n, v) for n, v in arrays.items() if n in used and v),
        *(language.function(node) for node in functions.values()),
        language.foot([*public, "self_test"]),
    ]
    return "\n".join(piece for piece in pieces if piece) + "\n"


class _Whole(ast.NodeTransformer):
    """Whole numbers, such as places in arrays and sizes of tables, in the stead of their names."""

    def __init__(self, numbers: Mapping[str, int]) -> None:
        self._numbers = numbers

    def visit_Name(self, node: ast.Name) -> ast.expr:
        """A number for a name, if it is one of them."""
        return ast.Constant(self._numbers[node.id]) if node.id in self._numbers else node


def with_callees(
    functions: Mapping[str, ast.FunctionDef], public: Sequence[str]
) -> dict[str, ast.FunctionDef]:
    """Public functions and those that they call, each after what it calls."""
    result: dict[str, ast.FunctionDef] = {}

    def add(name: str) -> None:
        node = functions[name]
        for one in ast.walk(node):
            if isinstance(one, ast.Name) and one.id in functions and one.id != name:
                add(one.id)
        result.setdefault(name, node)

    for name in public:
        add(name)
    return result


def _title(
    language: str, parts: tuple[str, ...], tol: float, public: Sequence[str], kind: Puck,
    tallest: float,
) -> list[str]:  # fmt: skip
    of = _words(kind) or "uniform pressure, homogeneous"
    return [
        f"puck-tables {__version__}: {', '.join(parts)} of flat pucks that slide and spin under "
        "dry friction.",
        f"{language}; error {tol:g} (see each function);",
        f"{of}{_heights(tallest, '0 <= ')}.",
        f"Functions: {', '.join(public)}; self_test returns how many numbers of its vectors are",
        "missed: 0.  Needs IEEE arithmetic (no -ffast-math).  Made by a program: do not edit.",
    ]


def _heights(tallest: float, least: str = "") -> str:
    """Up to which δ a file holds, in words; of a base nothing: its height is its own."""
    return f", {least}delta <= {tallest:.12g}" if tallest > 0.0 else ""


def _words(kind: Puck) -> str:
    """What it is, in letters that no language takes for the end of a comment."""
    base = kind.shape
    if base is None:
        words = kind.body.kind
    else:
        lever = kind.friction * kind.height
        height = f"f h = {lever:.9g} m" if lever > 0.0 else "flat"
        words = f"base {base.name}, k = {kind.gyration:.9g} m, {height}"
    return re.sub(r"[^\w .,:=/+-]|\*/", "_", words, flags=re.ASCII)


def functions_of(module: ModuleType) -> list[ast.FunctionDef]:
    """The functions of a program, as they are written."""
    tree = ast.parse(inspect.getsource(module))
    return [node for node in tree.body if isinstance(node, ast.FunctionDef)]


def _self_test(widths: Mapping[str, int]) -> dict[str, ast.FunctionDef]:
    """The tests of each function by vectors of so many numbers, and that of the whole file."""
    text = ""
    for name, width in widths.items():
        inputs = INPUTS[name]
        arguments = ", ".join(["c[k]", *(f"c[k + {n}]" for n in range(1, inputs))])
        text += _MISSES.format(
            name=name, upper=name.upper(), width=width, given=inputs, answers=width - inputs,
            arguments=f"0.0, 0.0, 0.0, {arguments}, 1.0, 0.5" if name == "step" else arguments,
            unit=_UNITS.get(name, "1.0"),
        )  # fmt: skip
    text += _SELF_TEST.format(total=" + ".join(f"{name}_misses()" for name in widths))
    tests = [node for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)]
    return {node.name: node for node in tests}
