"""Tables by the law or the puck that they are of: built once on a machine, then read."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import replace
from functools import lru_cache
from typing import Any, overload

from puck_tables._core.real import checked_progress, positive, real
from puck_tables._core.waiting import watched
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.laws import Law, law_of
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError
from puck_tables.table.friction_section import FrictionSection, friction_section
from puck_tables.table.law_record import is_named, plain
from puck_tables.table.resultant_table import ResultantTable
from puck_tables.table.singular_lines import refuse_height
from puck_tables.table.speed_table import SpeedTable
from puck_tables.table.table import Progress
from puck_tables.table.table_store import AnyTable, fetch

MOST_SECTIONS = 200  # of either kind are kept, some 100 kB each


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
    pressure, reach : optional
        The pressure law under a friction law, and the part of the radius on which it stands.

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
    wanted = None if accuracy is None else real("accuracy", accuracy, "an absolute error")
    kind: type[ResultantTable | SpeedTable] = ResultantTable
    how: dict[str, Any] = {}
    if isinstance(law, SpeedLaw | FrictionLaw):
        kind, name = SpeedTable, f"slip-speed-{law.kind}"
        how = {"pressure": _known(pressure), "reach": reach}
        if top_speed is not None:
            how["top_speed"] = positive("top_speed", top_speed, "m/s")
    else:
        law = _known(law)
        name = law.name

    def build() -> ResultantTable | SpeedTable:
        with watched("tabulating the friction law, once") if how else nullcontext() as show:
            return kind.build(law, wanted, progress=progress or show, **how)

    recipe = {one: plain(value) for one, value in {"law": law, **how}.items()}
    stem = f"{name}-{'default' if wanted is None else f'{wanted:g}'}"
    return fetch(stem, {"accuracy": wanted, **recipe}, kind, build)


def _known(law: str | Law) -> Law:
    """A pressure law that can be told from others: a profile by its values, whatever its name.

    Raises
    ------
    InputError
        If it is given by a function, or not known.
    """
    one = law if isinstance(law, Law) else law_of(law)
    if one.profile is not None:
        return replace(one, name="profile")
    if not is_named(one):
        raise InputError(
            f"the law {one.name} is given by a function, which cannot be told from another: "
            "give its name, or Table.build(law)"
        )
    return one


@lru_cache(maxsize=64)
def friction_for(law: Law, delta: float, accuracy: float) -> FrictionSection:
    """The friction of one puck: where that takes long, read if it is kept, else built.

    Parameters
    ----------
    law, delta, accuracy : as in :func:`puck_tables.table.friction_section.friction_section`

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
    if law.profile is None and not is_named(law):
        return build(law)
    known = _known(law)
    return fetch(
        stem, {**recipe, "law": plain(known)}, kind, lambda: build(known), rooms, MOST_SECTIONS
    )
