"""Tables that the program builds for itself, kept in the user's cache folder.

A file is named by the digest of what determines its values, the sources that compute them too, and
trusted only after its seal and its recipe proved right.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable
from contextlib import nullcontext, suppress
from pathlib import Path
from typing import Any, TypeVar, cast, overload

from puck_tables._core.arrays import checked_progress, positive, real
from puck_tables._core.own_folder import make_private, say, user_cache
from puck_tables._core.sources import source_digest
from puck_tables._core.waiting import Progress, watched
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.laws import Law
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import OutputError, TableError
from puck_tables.table.law_record import known, plain
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.table.speed_table import SpeedTable
from puck_tables.table.table import Table

AnyTable = TypeVar("AnyTable", bound=Table)
MOST_ALIKE = 200  # files, some 100 kB each: a sweep over many heights shall not fill the disk
ENDING = "-" + 16 * "[0-9a-f]" + ".h5"  # of the names of kept files


def fetch(stem: str, recipe: dict[str, Any], build: Callable[[], AnyTable]) -> AnyTable:
    """A table from the store, built and put there unless it is.

    ``stem``: how its file's name begins; of those alike up to the first - the last 200 are kept.
    ``recipe``: the numbers, arrays and laws that determine the values, by name.
    """
    said = {name: plain(value) for name, value in recipe.items() if value is not None}
    sources = source_digest("contact", "kernels", "motion", "stopping", "table")
    whole = json.dumps([stem, said, sources], sort_keys=True, default=str)
    digest = hashlib.sha256(whole.encode()).hexdigest()[:16]
    command, folder = f"kept by the program: {stem}, recipe {digest}", tables_folder()
    try:
        if folder is None:
            raise OSError("there is no cache folder on this machine")
        make_private(folder)
        path = folder / f"{stem}-{digest}.h5"
        if os.path.lexists(path):
            with suppress(TableError):
                kept = Table.load(path)
                if kept.metadata["command"] == command:
                    return cast(AnyTable, kept)
            say(f"{path} is damaged, or another table than its name says: it is built again")
            path.rmdir() if path.is_dir() and not path.is_symlink() else path.unlink(True)
        alike = folder.glob(f"{stem.split('-')[0]}-*{ENDING}")
        for one in sorted(alike, key=lambda one: one.stat().st_mtime)[: 1 - MOST_ALIKE or None]:
            one.unlink(missing_ok=True)
    except OSError as error:
        return _not_kept(build(), error)
    table = build()
    try:
        return table.save(path, overwrite=True, command=command)
    except (OSError, OutputError) as error:
        return _not_kept(table, error)


def _not_kept(table: AnyTable, error: Exception) -> AnyTable:
    reason = getattr(error, "strerror", None) or error
    say(f"the table is used but not kept for the next time: {reason}")
    return table


def tables_folder() -> Path | None:
    """Where built tables are kept; None where the user has no cache folder."""
    return (base := user_cache()) and base / "tables"


@overload
def table_for(
    law: str | Law, accuracy: float | None = None, progress: Progress | None = None
) -> ResultantTable: ...


@overload
def table_for(
    law: SpeedLaw | FrictionLaw, accuracy: float | None = None, progress: Progress | None = None,
    top_speed: float | None = None, pressure: str | Law = "uniform", reach: float = 1.0,
) -> SpeedTable: ...  # fmt: skip


def table_for(
    law: str | Law | SpeedLaw | FrictionLaw, accuracy: float | None = None,
    progress: Progress | None = None, top_speed: float | None = None,
    pressure: str | Law = "uniform", reach: float = 1.0,
) -> ResultantTable | SpeedTable:  # fmt: skip
    """The table of a law: read if it is kept (``puck tables`` lists what is), else built.

    Parameters
    ----------
    law : str, Law, SpeedLaw or FrictionLaw
        A pressure law as :func:`puck_tables.law_of` takes it, or one of
        :func:`puck_tables.profile_law`; or a friction law over the slip speed.
    accuracy, progress : optional
        Largest error, and a callable (done, all), as :meth:`puck_tables.Table.build` takes them.
    top_speed, pressure, reach : optional
        Of a friction law: the fastest slip, m/s, which a law by name needs; the pressure law under
        it, and the part of the radius on which that stands.

    Returns
    -------
    Table

    Raises
    ------
    InputError
        If the law is not known, or is neither named nor a profile.
    AccuracyError
        If the accuracy is out of reach.

    References
    ----------
    Salnikova, Treschev, Gallyamov 2012, sections 3 and 6.

    Examples
    --------
    >>> float(table_for("annulus:0.8", accuracy=1e-6).resultants(0.0, 1.0).perpendicular.round(5))
    0.25
    >>> float(table_for(SpeedLaw([0, 1], [0.2, 0.3]), 1e-6).resultants(0.0, 0.5).parallel.round(6))
    0.25
    """
    checked_progress(progress)
    wanted = None if accuracy is None else real("accuracy", accuracy, "an absolute error")
    kind: type[ResultantTable | SpeedTable] = ResultantTable
    how: dict[str, Any] = {}
    if isinstance(law, SpeedLaw | FrictionLaw):
        kind, name = SpeedTable, f"slip-speed-{law.kind}"
        top = None if top_speed is None else positive("top_speed", top_speed, "m/s")
        how = {"top_speed": top, "pressure": known(pressure), "reach": reach}
    else:
        law = known(law)
        name = law.name.replace(":", "-")

    def build() -> ResultantTable | SpeedTable:
        with watched("tabulating the friction law, once") if how else nullcontext() as show:
            return kind.build(law, wanted, progress=progress or show, **how)

    stem = f"{name}-{'default' if wanted is None else f'{wanted:g}'}"
    return fetch(stem, {"law": law, "accuracy": wanted, **how}, build)
