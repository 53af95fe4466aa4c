"""What a fit found, read back from its JSON file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from puck_tables._core.real import one_velocity, real
from puck_tables._core.safe_read import read_whole
from puck_tables.errors import InputError
from puck_tables.fitting.outcome import KIND
from puck_tables.puck import Puck

_LARGEST = 1 << 26  # bytes
_PUCK = ("radius", "height", "friction", "mass", "gravity", "pressure", "gyration")


def puck_and_launch(
    path: str | Path, track: str | None = None
) -> tuple[Puck, tuple[float, float], float, tuple[str, ...]]:
    """The puck, velocity (m/s) and spin (rad/s) of a track in a file of ``puck fit -o fit.json``.

    And sentences on what its tracks did not determine, and on what is hard to believe.

    Parameters
    ----------
    path : .json
    track : its name or number, where the file has several

    Raises
    ------
    InputError
        If the file is none of a fit, has no such track, its puck has drag or friction over slip
        speed, or nobody would believe what was found.
    """
    told = f"{path}: no file of puck fit (.json)"
    try:
        data: Any = json.loads(read_whole(path, _LARGEST))
    except (ValueError, RecursionError):
        raise InputError(told) from None
    kind = data.get("kind") if isinstance(data, dict) else None
    if isinstance(kind, str) and kind != KIND and kind.startswith(KIND[:-1]):
        raise InputError(f"{path} is of {kind:.40}, and this version reads {KIND}: fit again")
    if kind != KIND:
        raise InputError(told)
    try:
        launches = {str(one["track"]): one for one in data["launches"]}
        puck = Puck(**{name: data["puck"][name] for name in _PUCK})
        drag = real("drag", data["drag"], "1/s")
        chosen = launches[_chosen(list(launches), track, path)]
        velocity = one_velocity(chosen["velocity"])
        spin = real("spin", chosen["spin"], "rad/s")
        unknown = tuple(str(one) for one in (*data["not_determined"], *data["doubts"]))
        astray, speeds = str(data["astray"]), [*data["slip_speeds"]]
    except (KeyError, TypeError, AttributeError):
        raise InputError(told) from None
    if astray:
        raise InputError(f"{path}: {astray}: there is nothing to play")
    if speeds:
        raise InputError(
            f"{path}: this puck was found with friction over slip speed, which a free puck has "
            "not: make a scene of it, with that law"
        )
    if drag != 0.0:
        raise InputError(
            f"{path}: this puck was found with drag of {drag:.3g}/s, which a free puck has not: "
            "make a scene of it, with drag"
        )
    return puck, velocity, spin, unknown


def _chosen(names: list[str], track: str | None, path: str | Path) -> str:
    """The name of a track.

    Raises
    ------
    InputError
    """
    listed = ", ".join(names)
    if track is None:
        if len(names) != 1:
            raise InputError(f"{path} has {len(names)} tracks: say which (--track): {listed}")
        return names[0]
    if track in names:
        return track
    if track.isascii() and track.isdigit() and 1 <= int(track) <= len(names):
        return names[int(track) - 1]
    raise InputError(f"{path} has no track '{track}': there are {listed}")
