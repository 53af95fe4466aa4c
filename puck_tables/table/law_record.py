"""Laws as plain numbers and texts: what files hold of them, and what kept tables are known by."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from puck_tables.contact.friction_laws import FrictionLaw, law_of_numbers
from puck_tables.contact.laws import Law, law_of, profile_law
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError, OutputError


def is_named(law: Law) -> bool:
    """Whether a law is the one that its name says, and no other that was given this name.

    >>> from dataclasses import replace
    >>> is_named(law_of("ring")), is_named(replace(law_of("hertz"), name="ring"))
    (True, False)
    """
    try:  # no file is read for a name
        return not law.name.lower().endswith(".csv") and law_of(law.name) == law
    except InputError:
        return False


def can_be_known(law: Law) -> bool:
    """Whether a law can be told from others: by its values or its name, not by a function."""
    return law.profile is not None or is_named(law)


def known(law: str | Law) -> Law:
    """A pressure law that can be told from others: a profile by its values, whatever its name.

    Raises InputError if it is given by a function, or not known.
    """
    one = law if isinstance(law, Law) else law_of(law)
    if not can_be_known(one):
        raise InputError(
            f"the law {one.name} is given by a function, which cannot be told from another: "
            "give its name, or Table.build(law)"
        )
    return one if one.profile is None else replace(one, name="profile")


def plain(value: Any) -> Any:
    """A number, an array or a law as JSON has it.

    Raises OutputError if it is a function, or a law made of one.

    >>> plain(law_of("ring")), plain(np.array([1.5]))
    ({'pressure': 'ring'}, {'array': [1.5]})
    """
    if isinstance(value, np.ndarray):
        return {"array": value.tolist()}
    if isinstance(value, SpeedLaw):
        points = [np.asarray(part).tolist() for part in (value.speeds, value.values)]
        return {"points": points, "between": value.kind}
    if isinstance(value, FrictionLaw):
        return {"friction": value.kind, "numbers": value.numbers}
    if isinstance(value, Law):
        if value.profile is not None:
            return {"pressure": value.name, "profile": [one.tolist() for one in value.profile]}
        if is_named(value):
            return {"pressure": value.name}
        raise OutputError(
            f"the pressure law {value.name} is a function, which a file cannot hold: give it as a "
            "profile (profile_law)"
        )
    if value is None or callable(value):
        raise OutputError(
            "the friction law of this table is a function, which a file cannot hold: give the law "
            "as a SpeedLaw of points"
        )
    return value


def from_plain(entry: Any) -> Any:
    """The way back; lists are tuples.

    >>> from_plain(plain(SpeedLaw([0.0, 1.0], [0.2, 0.3])))(0.5).round(3)
    np.float64(0.25)
    """
    if isinstance(entry, list):
        return tuple(entry)
    if not isinstance(entry, dict):
        return entry
    if "array" in entry:
        return np.array(entry["array"])
    if "points" in entry:
        speeds, values = entry["points"]
        return SpeedLaw(speeds, values, entry["between"])
    if "friction" in entry:
        return law_of_numbers(entry["friction"], entry["numbers"])
    if "profile" in entry:
        radii, pressure = entry["profile"]
        return profile_law(radii, pressure, entry["pressure"])
    if entry["pressure"].lower().endswith(".csv"):
        raise ValueError("it neither names nor holds its pressure law")
    return law_of(entry["pressure"])
