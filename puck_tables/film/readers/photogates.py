"""Tables of two photogates: how long each was blocked, and the time between them, a row a slide.

The edges of a flag of width w that passes two gates a way L apart are four places along a line at
four times: 0, w, L and L + w at 0, Δ₁, T and T + Δ₂.  The columns ``flag`` and ``distance`` say w
and L with their units; PASCO and Vernier name the others.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from puck_tables._core.text import text_form_of
from puck_tables._core.text_rows import header_of, read_columns
from puck_tables._core.units import factor, parted, unit_word
from puck_tables.errors import InputError
from puck_tables.film.film import Film, Reader, TrackedBody, first_text

_BETWEEN = re.compile(r"time.*between.*gates?|between.*gates?", re.IGNORECASE)
_GATE = re.compile(r"(?:time.*(?:in|at)\s+)?(?:photo)?gate\s*#?\s*([12])\b.*", re.IGNORECASE)
_SIZES = {"flag": re.compile(r"(?:flag|width).*", re.IGNORECASE),
          "distance": re.compile(r"distance.*|spacing.*", re.IGNORECASE)}  # fmt: skip


def _film(path: str | Path, head: bytes) -> Film:
    """The slides in a table of two photogates, along a line."""
    form = text_form_of(path, head)
    names = header_of(form, bool)[-1]
    numbers = _columns(names)
    missing = [name for name in ("gate 2", "between", "flag", "distance") if name not in numbers]
    if missing:
        raise InputError(
            f"{path} is of photogates and has no column of {' and '.join(missing)}: it needs the "
            "times in gate 1, in gate 2 and between the gates, and columns 'flag [cm]', the width "
            "of what passes them, and 'distance [cm]', the way between them"
        )
    columns, _ = read_columns(path, form, list(numbers.values()), [])
    values = {}
    for name, n in numbers.items():
        kind = "length" if name in _SIZES else "time"
        unit = unit_word(parted(names[n])[1], kind)
        if not unit and kind == "length":
            raise InputError(
                f"{path} does not say the unit of its column '{names[n]}': {name} [cm]"
            )
        values[name] = columns[n] * factor(unit or "s", kind)
    film = Film(
        "table of photogates", [], "m", notes=["places along one line, the edges of a flag"]
    )
    rows = [values[name] for name in ("gate 1", "gate 2", "between", "flag", "distance")]
    for n, (one, two, between, width, gap) in enumerate(np.stack(rows, axis=1).tolist(), start=1):
        if np.isfinite([one, two, between]).all():
            place = np.array([0.0, width, gap, gap + width])
            marks = {"": np.stack([place, 0.0 * place], axis=1)}
            time = np.array([0.0, one, between, between + two])
            film.bodies.append(TrackedBody(f"slide {n}", marks, time=time))
    return film


def _columns(names: list[str]) -> dict[str, int]:
    """Where gates, the time between them and the sizes stand."""
    columns: dict[str, int] = {}
    for n, name in enumerate(names):
        bare = parted(name.strip())[0].strip()
        gate = _GATE.fullmatch(bare)
        if _BETWEEN.fullmatch(bare):
            columns.setdefault("between", n)
        elif gate is not None:
            columns.setdefault(f"gate {gate[1]}", n)
        for size, form in _SIZES.items():
            if form.fullmatch(bare):
                columns.setdefault(size, n)
    return columns


def _opens(path: str | Path, head: bytes) -> bool:
    if first_text(path, head) or b"ate" not in head[:2000]:
        return False
    try:
        header = header_of(text_form_of(path, head), bool)
    except InputError:
        return False
    return bool(header) and "gate 1" in _columns(header[-1])


READERS = (Reader(_opens, _film),)
