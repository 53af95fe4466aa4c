"""The page: its parts in one file, with the look-ups that ``puck export`` writes inside."""

from __future__ import annotations

import json
from importlib.resources import files
from typing import NamedTuple

import numpy as np

from puck_tables.export.languages import LANGUAGES
from puck_tables.export.program import base_step, launch_motion, resultant_formulas
from puck_tables.export.source import export_source, functions_of, with_callees

TOL = 1e-6  # of Q/J, Q²/J: finer than a screen shows
_SCRIPTS = ("base.js", "model.js", "draw.js", "hands.js")


class ShownLaw(NamedTuple):
    """A pressure law of the page; the mass of its puck is spread as its pressure is, k² = 2⟨x²⟩.

    ``file``: its look-ups in ``tables``, by ``puck export --language js --pressure LAW --gyration K
    --tol 1e-6``, for making them takes ten seconds; those of plain pucks are made in one.
    """

    name: str
    title: str
    gyration: float
    tallest: float
    file: str


LAWS = (
    ShownLaw("uniform", "uniform, flat", 0.5**0.5, 1.0, ""),
    ShownLaw("hertz", "Hertz, domed", 0.632456, 0.8, "hertz.js"),
    ShownLaw("annulus:0.8", "annulus 0.8, washer", 0.905539, 1.64, "annulus.js"),
    ShownLaw("ring", "ring, hoop", 1.0, 2.0, "ring.js"),
)


def explorer_page() -> str:
    """The explorer as one HTML file: it needs no server, no network and no other file.

    Its numbers come from :func:`puck_tables.export_source`, to 1e-6 of Q/J and Q²/J;
    bases that are drawn on it are integrated, to 5e-6.

    >>> page = explorer_page()
    >>> page[:15], len(page) < 300_000
    ('<!DOCTYPE html>', True)
    """
    folder = files("puck_tables.explore")
    page = (folder / "page.html").read_text(encoding="utf-8")
    scripts = "".join((folder / name).read_text(encoding="utf-8") for name in _SCRIPTS)
    return page.replace("/*laws*/", _laws() + _friction_of_bases()).replace("/*page*/", scripts)


def _laws() -> str:
    """A script that fills ``puckLaws``: what is to be known of each law, and its look-ups."""
    lines = ["const puckLaws = {};"]
    for law in LAWS:
        described = {"title": law.title, "gyration": law.gyration, "tallest": law.tallest}
        name = json.dumps(law.name)
        lines += [
            _look_ups(law),
            f"puckLaws[{name}] = {{ ...{json.dumps(described)}, tables: globalThis.puckTables }};",
        ]
    return "\n".join(lines)


def _look_ups(law: ShownLaw) -> str:
    if not law.file:
        return export_source("js", ("stop", "state", "resultants"), TOL).text
    return (files("puck_tables.tables") / law.file).read_text(encoding="utf-8")


def _friction_of_bases() -> str:
    """``puckBase(sides, count, area, farthest)``: ``wrench`` of exported files, of any polygon."""
    language = LANGUAGES["js"]
    modules = (launch_motion, resultant_formulas, base_step)
    functions = {node.name: node for module in modules for node in functions_of(module)}
    of_base = ("BASE_SIDES", "BASE_COUNT", "BASE_AREA", "BASE_FARTHEST")
    nodes, weights = np.polynomial.legendre.leggauss(base_step.BASE_RULE)
    numbers = {
        name: value for module in modules for name, value in vars(module).items()
        if name.isupper() and isinstance(value, int | float) and name not in of_base
    }  # fmt: skip
    lines = [
        *(language.constant(name, value) for name, value in numbers.items()),
        language.table("BASE_DISCS", [0.0]),
        language.table("BASE_NODES", nodes.tolist()),
        language.table("BASE_WEIGHTS", weights.tolist()),
        *(language.function(node) for node in with_callees(functions, ["wrench"]).values()),
    ]
    return "\n".join(
        [f"\nfunction puckBase({', '.join(of_base)}) {{", *lines, "return wrench;", "}"]
    )
