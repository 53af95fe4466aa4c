"""The methods by which motions and stops are computed, and where their friction comes from.

What a user types as ``method`` is a :class:`Method`.  A new integrator is a line here, its tableau
in :mod:`puck_tables.motion.steppers`, and its rows of the measured front, which ``puck tradeoff``
writes.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from typing import NamedTuple

from puck_tables.errors import InputError


class Method(StrEnum):
    """How: by look-up, or by which integrator."""

    LOOK_UP = "look-up"
    RK4 = "rk4"
    ADAPTIVE = "adaptive"

    @property
    def words(self) -> str:
        """Its name in a report."""
        return _WORDS[self][0]

    @property
    def setting(self) -> str:
        """What determines the error of an integrator."""
        return _WORDS[self][1]


_WORDS = {
    Method.LOOK_UP: ("look-up", "powers"),
    Method.RK4: ("Runge-Kutta 4", "steps"),
    Method.ADAPTIVE: ("Dormand-Prince 5(4), adaptive", "local"),
}
METHODS = tuple(Method)
INTEGRATORS = tuple(method for method in Method if method is not Method.LOOK_UP)


class FrictionForm(StrEnum):
    """Where the friction of an integration comes from."""

    TABLE = "table"
    CLOSED_FORMS = "closed forms"
    SECTION = "section"


class Scheme(NamedTuple):
    """A method, and for an integrator where its friction comes from.

    >>> Scheme(Method.RK4, FrictionForm.TABLE).name, Scheme(Method.LOOK_UP).name
    ('rk4, table', 'look-up')
    """

    method: Method
    source: FrictionForm | None = None

    @property
    def name(self) -> str:
        """Its name in the table of measured errors."""
        return self.method.value if self.source is None else f"{self.method}, {self.source}"


LOOK_UP = Scheme(Method.LOOK_UP)
INTEGRATED = tuple(
    Scheme(method, source)
    for method in INTEGRATORS
    for source in (FrictionForm.TABLE, FrictionForm.CLOSED_FORMS)
)
MEASURED = {scheme.name: scheme for scheme in (LOOK_UP, *INTEGRATED)}


def method_named(name: str | None, among: Iterable[Method] = METHODS) -> Method | None:
    """The method that a user asks for; None where any will do.

    Raises InputError if there is none of that name.

    >>> method_named("rk4")
    <Method.RK4: 'rk4'>
    """
    if name is None:
        return None
    known = {method.value: method for method in among}
    if not isinstance(name, str) or name not in known:
        raise InputError(f"method must be one of {', '.join(known)}, got {name!s:.60}")
    return known[name]


def schemes_of(
    methods: Iterable[Method],
    sources: Iterable[FrictionForm] = (FrictionForm.TABLE, FrictionForm.CLOSED_FORMS),
) -> tuple[Scheme, ...]:
    """The measured schemes of these methods, the integrators with friction from these sources.

    >>> [scheme.name for scheme in schemes_of([Method.RK4], [FrictionForm.TABLE])]
    ['rk4, table']
    """
    wanted, allowed = set(methods), {None, *sources}
    return tuple(s for s in MEASURED.values() if s.method in wanted and s.source in allowed)
