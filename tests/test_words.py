"""The words of the code: the field's own, one for each thing, no name twice; reasons of numbers."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator

import pytest
from test_layers import modules, parsed

# Rooms that keep to the words; one that is clean is put here, and none is taken out.
CLEAN = """
    _core accuracy autodiff bulk chetaev cli contact explore export film fitting io kernels
    gym motion plot puck reference report result results scene stopping table tradeoff trajectory
    verbs_of_many warming world wrench
"""
# Words that nobody reads who did not write them, and what the field says.
WORDS = {
    "desk hall": "workspace, buffer",
    "game": "state",
    "ask asks asked asking given seen fitted launched natural":
        "limits, spec, inputs, observations, estimate, forward model, unit motion",
    "way ways stretch stretches": "slip direction, candidates; interval",
    "lean leans leaning settle settles settled calm gripped jam jammed dying":
        "in contact, bounces end, locked, wedged",
    "twin twins": "check run",
    "reel reels tide tides": "prescribed motion, force table",
    "doings concerned disappointed": "body state, contact state, stale",
    "sights beside quiet yielding": "contact kinematics, separation bound, break-away",
    "lightness turnability slowness slownesses": "inverse mass, inverse inertia",
    "pace paces books works course courses fate": "scale, ledger, impact sequence, outcome",
    "flight flights departures": "segment, start",
    "carried astride ground zones footing dry": "sticking; mixed; floor, floor map",
    "told curve curves orbit orbits flow flows cut cuts front":
        "explained, similarity solution, coefficients, section, method errors",
    "tied joined joining chain chains blow blows bend bends hit hits meeting meetings":
        "coupled fit, impact, kink",
    "abreast blindness misread rival rivals": "multi-start; not identifiable, misfit, other minima",
    "found": "what it is",
}  # fmt: skip
REFUSED = {word: instead for words, instead in WORDS.items() for word in words.split()}
# Whole names that stay: the field's own, and what users type or read.
OWN = {
    "AsperityCurve", "asperity_curve",  # a characteristic curve
    "SlideOrFlight",  # a point over an asperity flies
    "_dry_friction",
    "hits",  # --hits of ``puck aim``
    "DryFriction", "ShotGame", "StoneGame", "TableGame", "game", "table_game",  # of agents
    "seen", "seen_speed", "seen_rim", "seen_epsilon",  # of a track: its frames; of a log
    "given", "cut_off", "rivals",  # of a fit and a forecast
    "CARRIED_AWAY", "CARRIED_ROUND", "carried",  # how a run ends
    "CURVES", "flights", "flights_per_period",  # of points over asperities
    "DRY",  # friction
}  # fmt: skip
# How many names of files stand in two rooms, and of classes twice: these may only fall.  Files of
# cli bear the names of their commands: aim, simulate.
FILES_TWICE, CLASSES_TWICE = 2, 0


def names_in(tree: ast.AST) -> Iterator[str]:
    """All names that are made: of classes, functions, arguments, variables and attributes."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.name
        elif isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            yield node.id
        elif isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield node.attr


def refused_in(name: str) -> list[str]:
    """The words of a name that are refused; of ``TradeOff``: trade, off."""
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower().split("_")
    return [word for word in words if word in REFUSED and name not in OWN]


def is_number(value: ast.AST | None) -> bool:
    """Whether a value is a number, an expression, or some of these in a row."""
    if isinstance(value, ast.Tuple):
        return all(is_number(one) for one in value.elts)
    number = isinstance(value, ast.Constant) and isinstance(value.value, int | float)
    return number or isinstance(value, ast.UnaryOp | ast.BinOp)


def bare_constants(source: str) -> Iterator[str]:
    """Constants without a comment in their lines, above, or above their unbroken group."""
    lines, said, after = source.splitlines(), False, 0
    for node in parsed(source).body:
        if not isinstance(node, ast.Assign | ast.AnnAssign):
            after = 0
            continue
        said = lines[node.lineno - 2].startswith("#") or (said and node.lineno == after)
        after = node.end_lineno + 1
        target = node.targets[0] if isinstance(node, ast.Assign) else node.target
        constant = is_number(node.value) and ast.unparse(target).isupper()
        if constant and not said and "#" not in "".join(lines[node.lineno - 1 : after - 1]):
            yield lines[node.lineno - 1]


def dependent_docstrings(source: str) -> Iterator[str]:
    """Docstrings that cannot be read alone."""
    for node in ast.walk(parsed(source)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            text = ast.get_docstring(node) or ""
            if text.startswith(("The same", "Those", "Another", "As ")):
                yield text.partition("\n")[0]


@pytest.mark.parametrize("fault", [bare_constants, dependent_docstrings])
def test_every_constant_has_its_reason_and_every_docstring_stands_alone(fault):
    bad = {name: [*fault(path.read_text("utf-8"))] for name, path in modules().items()}
    assert not {name: faults for name, faults in bad.items() if faults}


def test_a_bare_constant_and_a_dependent_docstring_are_noticed():
    source = "# rows\nA = 1\nB = A + 1\n\nC = -2.0\nD, E = 1, 2.0\nF = 3  # m\nG = 'text'\n"
    assert [*bare_constants(source)] == ["C = -2.0", "D, E = 1, 2.0"]
    assert [*dependent_docstrings('def f(): "The same."\n\ndef g(): "Places."\n')] == ["The same."]


@pytest.mark.parametrize("room", CLEAN.split())
def test_names_are_of_the_field(room: str):
    files = {name: path for name, path in modules().items() if name.partition(".")[0] == room}
    assert files, "no such room"
    bad = {
        f"{file}: {name}": [f"say {REFUSED[word]} for {word}" for word in refused_in(name)]
        for file, path in files.items()
        for name in {file.rpartition(".")[2], *names_in(parsed(path.read_text("utf-8")))}
        if refused_in(name)
    }
    assert not bad


def test_no_two_files_and_no_two_classes_have_one_name():
    files = Counter(name.rpartition(".")[2] for name in modules())
    public = re.compile(r"^class ([A-Z]\w*)", re.MULTILINE)
    classes = Counter(
        name for path in modules().values() for name in public.findall(path.read_text("utf-8"))
    )
    twice = sorted(name for name, n in files.items() if n > 1 and not name.startswith("__"))
    assert len(twice) == FILES_TWICE, f"lower FILES_TWICE if fewer: {twice}"
    twice = sorted(name for name, n in classes.items() if n > 1)
    assert len(twice) == CLASSES_TWICE, f"lower CLASSES_TWICE if fewer: {twice}"


def test_a_word_is_noticed_in_every_kind_of_name():
    tree = ast.parse("class FlowSection:\n    async def at_front(self, *, the_cut=1): ...\n")
    assert [word for name in names_in(tree) for word in refused_in(name)] == [
        "flow", "front", "cut",
    ]  # fmt: skip
    assert (
        refused_in("limit_surface") == refused_in("asperity_curve") == refused_in("upfront") == []
    )
