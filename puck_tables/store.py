"""Tables built on demand, kept in the user's cache folder: built once on a machine, then read.

The name of a kept file ends in the digest of its recipe: all that determines the values, and the
sources that compute them, so that no table of another version of the program is taken for today's.
What is there is trusted only after its seal, its digest and its recipe proved right; what cannot be
kept is built and used all the same.
"""

from __future__ import annotations

import re
import stat
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from puck_tables.contact.laws import Law, law_of
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError, OutputError, TableError
from puck_tables.kernels.cache import source_digest
from puck_tables.own_folder import make_private, refuse_shared, say, user_cache
from puck_tables.real import real_array
from puck_tables.safe_write import PART_PATTERN
from puck_tables.table.container import Saved, recipe_digest
from puck_tables.table.law_file import ALGORITHM, load_law_table, profile_digest, save_law_table
from puck_tables.table.law_table import DEFAULT_ACCURACY, LawTable, build_law_table
from puck_tables.table.speed_build import build_speed_table
from puck_tables.table.speed_file import ALGORITHM as SPEED_ALGORITHM
from puck_tables.table.speed_file import load_speed_table, save_speed_table
from puck_tables.table.speed_table import SpeedTable
from puck_tables.waiting import watched

Progress = Callable[[int, int], None]
AnyKept = TypeVar("AnyKept", bound=Saved)

_NAME = re.compile(r"[\w.+-]+-[0-9a-f]{16}\.h5")


def table_for(
    pressure: str | Law, accuracy: float | None = None, progress: Progress | None = None
) -> LawTable:
    """The table of friction resultants under a pressure law: read if it is kept, else built.

    Parameters
    ----------
    pressure : str or Law
        As :func:`puck_tables.law_of` takes it, or a law of :func:`puck_tables.profile_law`, which
        is known by its values, not by its name.
    accuracy : float, optional
        Largest error, from 1e-11 to 0.01; default 1e-9.
    progress : callable (done, all), optional
        Told while the table is built.

    Returns
    -------
    LawTable

    Raises
    ------
    InputError
        If the law is not known, or is neither named nor a profile.
    AccuracyError
        If the accuracy is out of reach.

    Notes
    -----
    Kept under ``tables`` in the user's cache folder (``XDG_CACHE_HOME`` or ``~/.cache`` and its
    like); ``puck tables`` lists what is there.  A damaged file is named on stderr and built again.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, sections 3 and 6.

    Examples
    --------
    >>> table = table_for("annulus:0.8", accuracy=1e-6)
    >>> float(table.resultants(0.0, 1.0).perpendicular.round(5))
    0.25
    """
    if isinstance(pressure, Law) and pressure.profile is None:
        raise InputError(
            f"the law {pressure.name} is given by a function, which cannot be told from another: "
            "give its name, or build_law_table(law)"
        )
    law = pressure if isinstance(pressure, Law) else law_of(pressure)
    asked = DEFAULT_ACCURACY if accuracy is None else accuracy
    wanted = real_array("accuracy", asked, "an absolute error").item()
    recipe = {
        "pressure_law": law.name, "edges": law.edges, "accuracy": wanted, "algorithm": ALGORITHM,
        "sources": source_digest("contact", "kernels", "table"),
    }  # fmt: skip
    if (profile := law.profile) is not None:
        law = replace(law, name="profile")
        recipe |= {"pressure_law": law.name, "profile": profile_digest(*profile)}
    digest = recipe_digest(recipe)[:16]
    command = f"table_for({law.name!r}, {wanted:g}), recipe {digest}"
    return fetch(
        f"{file_stem(law)}-{wanted:g}-{digest}.h5",
        command,
        build=lambda: build_law_table(law, wanted, progress=progress),
        save=lambda table, path: save_law_table(table, path, overwrite=True, command=command),
        load=load_law_table,
    )


def speed_table_for(law: SpeedLaw, accuracy: float) -> SpeedTable:
    """The table of friction by a law over the slip speed: read if it is kept, else built.

    Parameters
    ----------
    law : SpeedLaw
    accuracy : float
        As :func:`puck_tables.build_speed_table` takes it.

    Raises
    ------
    AccuracyError
        If the accuracy is out of reach.

    Examples
    --------
    >>> table = speed_table_for(SpeedLaw([0.0, 1.0], [0.2, 0.3]), 1e-6)
    >>> float(table.resultants(0.0, 0.5).parallel.round(6))
    0.25
    """
    points = [np.asarray(part).tolist() for part in (law.speeds, law.values)]
    recipe = {
        "kind": law.kind, "points": points, "accuracy": accuracy, "algorithm": SPEED_ALGORITHM,
        "sources": source_digest("contact", "kernels", "table"),
    }  # fmt: skip
    digest = recipe_digest(recipe)[:16]
    command = f"a scene with this friction law, to {accuracy:g}; recipe {digest}"

    def build() -> SpeedTable:
        with watched("tabulating the friction law, once") as progress:
            return build_speed_table(law, accuracy=accuracy, progress=progress)

    return fetch(
        f"slip-speed-{accuracy:g}-{digest}.h5",
        command,
        build=build,
        save=lambda table, path: save_speed_table(table, path, overwrite=True, command=command),
        load=load_speed_table,
    )


def file_stem(law: Law) -> str:
    """A file name for a law.

    Examples
    --------
    >>> file_stem(law_of("annulus:0.8"))
    'annulus-0.8'
    """
    return re.sub(r"[^\w.+-]", "-", law.name.removesuffix(".csv"))


def fetch(
    name: str,
    command: str,
    build: Callable[[], AnyKept],
    save: Callable[[AnyKept, Path], AnyKept],
    load: Callable[[Path], AnyKept],
) -> AnyKept:
    """A table from the user's cache, built and put there unless it is.

    Parameters
    ----------
    name : file name, ending in the digest of the recipe
    command : how it is made, with that digest: what the file must say of itself
    build, save, load : how its kind is made, and gets into and out of a file

    Returns
    -------
    The table, as read from a file if there is a place for one.
    """
    folder = tables_folder()
    if folder is None:
        say("there is no cache folder for built tables on this machine: this one is not kept")
        return build()
    path = folder / name
    try:
        make_private(folder.parent)
        make_private(folder)
        if _is_kept(path):
            try:
                kept = load(path)
                if kept.passport.get("command") == command:
                    return kept
                say(f"{path} is another table than its name says: it is built again")
            except TableError:
                say(f"{path} is damaged: it is built again")
    except OSError as error:
        say(f"the table is used but not kept for the next time: {error.strerror or error}")
        return build()
    table = build()
    try:
        return save(table, path)
    except OSError as error:
        reason = str(error) if isinstance(error, OutputError) else error.strerror or str(error)
        say(f"the table is used but not kept for the next time: {reason}")
        return table


def _is_kept(path: Path) -> bool:
    """Whether a file is there; a link, a pipe or an empty folder in its place is taken away."""
    try:
        mode = path.lstat().st_mode
    except FileNotFoundError:
        return False
    if stat.S_ISREG(mode):
        return True
    say(f"{path} is no file: it is removed, and the table built again")
    if stat.S_ISDIR(mode):
        path.rmdir()
    else:
        path.unlink()
    return False


def tables_folder() -> Path | None:
    """Where built tables are kept; None where the user has no cache folder.

    Examples
    --------
    >>> tables_folder().parts[-2:]
    ('puck-tables', 'tables')
    """
    base = user_cache()
    return None if base is None else base / "tables"


def kept_files() -> list[Path]:
    """The files of the cache that are tables by their names, in alphabetical order.

    Examples
    --------
    >>> all(path.suffix == ".h5" for path in kept_files())
    True
    """
    folder = tables_folder()
    if folder is None or not _is_ours(folder):
        return []
    return sorted(
        path
        for path in folder.iterdir()
        if _NAME.fullmatch(path.name) and path.is_file() and not path.is_symlink()
    )


def _is_ours(folder: Path) -> bool:
    """Whether there is such a folder, and it is safe to read and to remove files there."""
    try:
        refuse_shared(folder)
        return folder.is_dir()
    except OSError as error:
        say(f"{folder} is not used: {error.strerror or error}")
        return False


def leftovers() -> list[Path]:
    """What builders that were killed while writing have left in the cache more than a day ago."""
    folder = tables_folder()
    if folder is None or not _is_ours(folder):
        return []
    parts = folder.glob(PART_PATTERN)
    return sorted(path for path in parts if path.stat().st_mtime < time.time() - 86400)


def remove(path: Path) -> None:
    """Remove one of the :func:`kept_files` or :func:`leftovers`.

    Raises
    ------
    InputError
        If it is none.
    OutputError
        If the system does not let it go.
    """
    if path not in (*kept_files(), *leftovers()):
        raise InputError(f"no table {path.name} is kept: 'puck tables' lists those that are")
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        raise OutputError(f"cannot remove {path}: {error.strerror or error}") from None
