"""The words of the code: the field's own, one for each thing, and no name twice."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator

import pytest
from test_layers import modules

# Rooms that keep to the words; one that is clean is put here, and none is taken out.
CLEAN = """
    _core accuracy autodiff bulk chetaev cli contact explore export film fitting io kernels
    motion plot puck reference result stopping table tradeoff trajectory verbs_of_many wrench
"""
# Words that nobody reads who did not write them, and what the field says.
WORDS = {
    "desk hall": "workspace, buffer",
    "game": "state",
    "piece": "puck, segment, row, arc, part",
    "ask asks asked asking given seen fitted launched natural":
        "limits, spec, inputs, observations, estimate, forward model, unit motion",
    "way ways stretch stretches": "slip direction, candidates; interval",
    "lean leans leaning settle settles settled calm gripped jam jammed dying":
        "in contact, bounces end, locked, wedged",
    "twin twins": "check run",
    "reel reels tide tides": "prescribed motion, force table",
    "doings concerned disappointed": "body state, contact state, stale",
    "sights beside quiet yielding": "contact kinematics, separation bound, break-away",
    "lightness turnability slowness": "inverse mass, inverse inertia",
    "pace paces books works course fate": "scale, ledger, impact sequence, outcome",
    "flight flights departures": "segment, start",
    "carried astride ground zones footing dry": "sticking; mixed; floor, floor map",
    "told curve curves orbit orbits flow flows cut cuts front":
        "explained, similarity solution, coefficients, section, method errors",
    "tied joined joining chain blow blows bend bends hit hits meeting meetings":
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
    "seen",  # of a track: its frames
}  # fmt: skip
# How many names of files stand in two rooms, and of classes twice: these may only fall.
FILES_TWICE, CLASSES_TWICE = 6, 3


def names_in(tree: ast.AST) -> Iterator[str]:
    """Names of classes, functions and arguments."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.name
        elif isinstance(node, ast.arg):
            yield node.arg


def refused_in(name: str) -> list[str]:
    """The words of a name that are refused; of ``TradeOff``: trade, off."""
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower().split("_")
    return [word for word in words if word in REFUSED and name not in OWN]


@pytest.mark.parametrize("room", CLEAN.split())
def test_names_are_of_the_field(room: str):
    files = {name: path for name, path in modules().items() if name.partition(".")[0] == room}
    assert files, "no such room"
    bad = {
        f"{file}: {name}": [f"say {REFUSED[word]} for {word}" for word in refused_in(name)]
        for file, path in files.items()
        for name in {file.rpartition(".")[2], *names_in(ast.parse(path.read_text("utf-8")))}
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
        "flow",
        "front",
        "cut",
    ]
    assert (
        refused_in("limit_surface") == refused_in("asperity_curve") == refused_in("upfront") == []
    )
