"""A pressure law in a table file: by its name, or as the curve of its profile."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables.contact.laws import Law, law_of, profile_law
from puck_tables.errors import InputError
from puck_tables.table.table import Axis

FloatArray = npt.NDArray[np.float64]

_RADIUS, _PRESSURE = "profile_radius", "profile_pressure"


def profile_rows(law: Law) -> int:
    """How many rows a tabulated law has; none that is known by its name.

    Examples
    --------
    >>> profile_rows(law_of("ring"))
    0
    """
    return 0 if law.profile is None else law.profile[0].size


def profile_curve(law: Law) -> dict[str, Axis]:
    """A tabulated law as argument and function, or nothing."""
    if law.profile is None:
        return {}
    radius, pressure = law.profile
    return {
        _RADIUS: Axis(radius, "1", "radius in units of that of the puck"),
        _PRESSURE: Axis(pressure, "1", "pressure, largest 1"),
    }


def profile_shapes(attributes: dict[str, Any]) -> dict[str, tuple[int, ...]]:
    """Shapes of the arrays of a profile in a file with these attributes.

    Examples
    --------
    >>> profile_shapes({"profile_rows": 3})["profile_radius"]
    (3,)
    """
    rows = attributes["profile_rows"]
    if rows < 0:
        raise ValueError("its profile has no number of rows")
    return {_RADIUS: (rows,), _PRESSURE: (rows,)} if rows else {}


def law_in_file(attributes: dict[str, Any], arrays: dict[str, FloatArray]) -> Law:
    """The law of a file: no other file is read for it.

    Raises
    ------
    ValueError
        If it names none and holds none, or both.
    """
    name = attributes["pressure_law"]
    named = not name.lower().endswith(".csv") and _known(name)
    if _RADIUS not in arrays:
        if not named:
            raise ValueError("it neither names nor holds its pressure law")
        return law_of(name)
    if named:
        raise ValueError(f"it holds a profile that is not the law it names, {name}")
    return profile_law(arrays[_RADIUS], arrays[_PRESSURE], name=name)


def unsaveable_law(law: Law) -> str | None:
    """Why no file can hold a law, in a sentence; None where one can."""
    if law.profile is not None or _known(law.name):
        return None
    return (
        f"the pressure law {law.name} is a function, which a file cannot hold: give it as a "
        "profile (profile_law)"
    )


def _known(name: str) -> bool:
    """Whether a law is known by its name."""
    try:
        return law_of(name).name == name
    except InputError:
        return False
