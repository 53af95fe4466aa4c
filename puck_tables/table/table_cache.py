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
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar, overload

import numpy as np

from puck_tables._core.own_folder import make_private, refuse_shared, say, user_cache
from puck_tables._core.partial_files import PART_PATTERN
from puck_tables._core.real import checked_progress, positive, real
from puck_tables._core.sources import source_digest
from puck_tables._core.waiting import watched
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.laws import Law, law_of
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError, OutputError, TableError
from puck_tables.table.file import recipe_digest
from puck_tables.table.friction_section import FrictionSection, friction_section
from puck_tables.table.law_table import is_named
from puck_tables.table.metadata import Progress
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.table.singular_lines import refuse_height
from puck_tables.table.speed_table import SpeedTable
from puck_tables.table.table import Table

AnyTable = TypeVar("AnyTable", bound=Table)

MOST_SECTIONS = 200  # of either kind are kept, some 100 kB each
_NAME = re.compile(r"[\w.+-]+-[0-9a-f]{16}\.h5")


@overload
def table_for(
    law: str | Law, accuracy: float | None = None, progress: Progress | None = None
) -> ResultantTable: ...


@overload
def table_for(
    law: SpeedLaw | FrictionLaw, accuracy: float | None = None, progress: Progress | None = None,
    top_speed: float | None = None,
) -> SpeedTable: ...  # fmt: skip


def table_for(
    law: str | Law | SpeedLaw | FrictionLaw, accuracy: float | None = None,
    progress: Progress | None = None, top_speed: float | None = None,
) -> ResultantTable | SpeedTable:  # fmt: skip
    """The table of a law: read if it is kept, else built.

    Parameters
    ----------
    law : str, Law, SpeedLaw or FrictionLaw
        A pressure law as :func:`puck_tables.law_of` takes it, or one of
        :func:`puck_tables.profile_law`, which is known by its values, not by its name; or a
        friction law over the slip speed.
    accuracy : float, optional
        Largest error, as :meth:`puck_tables.Table.build` takes it.
    progress : callable (done, all), optional
        Told while the table is built.
    top_speed : float, optional
        The fastest slip, m/s, of a friction law; a law by name needs it.

    Returns
    -------
    Table

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
    >>> table = table_for(SpeedLaw([0.0, 1.0], [0.2, 0.3]), 1e-6)
    >>> float(table.resultants(0.0, 0.5).parallel.round(6))
    0.25
    """
    checked_progress(progress)
    kind: type[ResultantTable] | type[SpeedTable]
    more: dict[str, Any] = {}
    if isinstance(law, SpeedLaw | FrictionLaw):
        kind, stem, said = SpeedTable, "slip-speed", "a friction law over the slip speed"
        more = {} if top_speed is None else {"top_speed": positive("top_speed", top_speed, "m/s")}
        if isinstance(law, SpeedLaw):
            points = [np.asarray(part).tolist() for part in (law.speeds, law.values)]
        else:
            points, stem = law.numbers, f"slip-speed-{law.kind}"
        of: dict[str, Any] = {"kind": law.kind, "points": points, **more}
    else:
        if isinstance(law, Law) and law.profile is None:
            raise InputError(
                f"the law {law.name} is given by a function, which cannot be told from another: "
                "give its name, or Table.build(law)"
            )
        law = law if isinstance(law, Law) else law_of(law)
        if law.profile is not None:
            law = replace(law, name="profile")
        kind, stem, said = ResultantTable, file_stem(law), law.name
        of = {"pressure_law": law.name, "edges": law.edges}
        if law.profile is not None:
            of["profile"] = [part.tolist() for part in law.profile]
    wanted = None
    if accuracy is not None:
        wanted = real("accuracy", accuracy, "an absolute error")
    digest = _digest(kind, {**of, "accuracy": wanted})
    asked = "default" if wanted is None else f"{wanted:g}"

    def build() -> ResultantTable | SpeedTable:
        if progress is not None or kind is ResultantTable:
            return kind.build(law, wanted, progress=progress, **more)
        with watched("tabulating the friction law, once") as show:
            return kind.build(law, wanted, progress=show, **more)

    return fetch(
        f"{stem}-{asked}-{digest}.h5", f"table_for({said}, {asked}), recipe {digest}", kind, build
    )


@lru_cache(maxsize=64)
def friction_for(law: Law, delta: float, accuracy: float) -> FrictionSection:
    """The friction of one puck: where that takes long, read if it is kept, else built.

    Parameters
    ----------
    law, delta, accuracy : as in :func:`puck_tables.table.friction_section.friction_section`

    Raises
    ------
    InputError, ContactError, AccuracyError
        As there.

    Examples
    --------
    >>> friction_for(law_of("ring"), 0.5, 1e-6).grid  # under other laws it takes no time
    '129 phi nodes'
    """
    if not (law.can_lift and delta > 1.0):
        return friction_section(law, delta, accuracy)
    refuse_height(law, delta)

    return kept_section(
        FrictionSection, law, f"tall-{delta:g}-{accuracy:g}",
        {"delta": delta, "accuracy": accuracy}, lambda law: friction_section(law, delta, accuracy),
    )  # fmt: skip


def kept_section(
    kind: type[AnyTable], law: Law, stem: str, recipe: dict[str, Any],
    build: Callable[[Law], AnyTable], rooms: tuple[str, ...] = (),
) -> AnyTable:  # fmt: skip
    """A section for one puck: read if it is kept, else built; the last :data:`MOST_SECTIONS` are.

    Parameters
    ----------
    kind : of table
    law : the pressure law; of one that is given by a function nothing is kept
    stem : of the file name; up to its first - it says what is kept
    recipe : what determines the values besides the law
    build : how it is made, of the law as the file has it
    rooms : whose sources determine the values, besides those of tables
    """
    if law.profile is not None:
        recipe = {**recipe, "profile": [part.tolist() for part in law.profile]}
        law = replace(law, name="profile")
    elif not is_named(law):
        return build(law)
    digest = _digest(kind, {**recipe, "pressure_law": law.name}, rooms)

    def build_and_make_room() -> AnyTable:
        _forget_oldest(stem.partition("-")[0])
        return build(law)

    command = f"{kind.kind} {stem} under pressure {law.name}; recipe {digest}"
    return fetch(f"{stem}-{digest}.h5", command, kind, build_and_make_room)


def _forget_oldest(what: str) -> None:
    """Make room for one more: a sweep over many heights shall not fill the disk."""
    files = [path for path in kept_files() if path.name.startswith(f"{what}-")]
    with suppress(OSError):  # another process may be at it
        oldest = sorted(files, key=lambda path: path.stat().st_mtime)
        for path in oldest[: 1 - MOST_SECTIONS or None]:
            path.unlink(missing_ok=True)


def _digest(kind: type[Table], recipe: dict[str, Any], rooms: tuple[str, ...] = ()) -> str:
    """Of all that determines a table, and of the sources that compute it."""
    sources = source_digest("contact", "kernels", "table", *rooms)
    return recipe_digest({**recipe, "algorithm": kind.algorithm, "sources": sources})[:16]


def file_stem(law: Law) -> str:
    """A file name for a law.

    Examples
    --------
    >>> file_stem(law_of("annulus:0.8"))
    'annulus-0.8'
    """
    return re.sub(r"[^\w.+-]", "-", law.name.removesuffix(".csv"))


def fetch(name: str, command: str, kind: type[AnyTable], build: Callable[[], AnyTable]) -> AnyTable:
    """A table from the user's cache, built and put there unless it is.

    Parameters
    ----------
    name : file name, ending in the digest of the recipe
    command : how it is made, with that digest: what the file must say of itself
    kind : of table
    build : how it is made

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
                kept = kind.load(path)
                if kept.metadata.get("command") == command:
                    return kept
                say(f"{path} is another table than its name says: it is built again")
            except TableError:
                say(f"{path} is damaged: it is built again")
    except OSError as error:
        say(f"the table is used but not kept for the next time: {error.strerror or error}")
        return build()
    table = build()
    try:
        return table.save(path, overwrite=True, command=command)
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
