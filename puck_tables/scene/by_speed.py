"""Friction of a scene whose coefficient depends on the slip speed: its law, and the table of it."""

from __future__ import annotations

import math
import threading
from functools import lru_cache
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray, rounded_up
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.law_moments import law_moments
from puck_tables.contact.round_load import RoundLoad, load_of
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import AccuracyError, SpeedError
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.scene.floor_parts import frictions_on, has_laws_by_place, law_of
from puck_tables.scene.ingredients import BySpeed
from puck_tables.scene.parts import Orthotropic
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.table.speed_build import finest_accuracy
from puck_tables.table.speed_table import SpeedTable
from puck_tables.table.table_store import table_for

Points = tuple[tuple[float, float], ...]

LAW_SHARE = 0.1  # of the error wanted: of the friction at any slip, in units of f N
UNDER_LAW_ERROR = 1e-10  # of sums of a law along the contour of a base, in the same units
NO_LAW = BySpeed(np.zeros(0), 0.0, 0.0, 1.0)
# of the last speed of a law: so far its last piece goes on, so that who sets off as fast is within
WITHIN = 1.0 + 4e-9
FARTHER = 4.0  # a law by name holds at all speeds: its table goes on as needed
_FLAT = 8.0  # times its own scale goes the first table of a launch from rest

_one_at_a_time = threading.Lock()  # the threads of a sweep need the same table


def law_range(scene: SceneSpec, fastest: float) -> tuple[SpeedLaw | FrictionLaw, float, float]:
    """A friction law, up to which slip it is tabulated, m/s, and the largest f there.

    ``fastest``: a slip of a rim for which it must hold, m/s.

    Raises InputError if the law cannot be read, or ends below that.
    """
    law, top = law_of(scene.floor.law), law_top(scene, fastest)
    return law, top, law.largest(top)


def law_top(scene: SceneSpec, fastest: float) -> float:
    """Up to which slip all friction laws of a scene are tabulated, m/s; inf: it has none.

    Raises InputError as :func:`law_range`.
    """
    tops = {name: _first_top(law, fastest) for name, law in laws_in(scene).items()}
    name, top = min(tops.items(), key=lambda one: one[1], default=("", math.inf))
    if fastest > WITHIN * top:
        raise SpeedError(
            f"the rim slips at {fastest:.6g} m/s at the launch, faster than the friction law "
            f"{name} goes ({top:g} m/s): nothing is known beyond; give it more"
        )
    return top


def laws_in(scene: SceneSpec) -> dict[str, SpeedLaw | FrictionLaw]:
    """All friction laws over the slip speed of a scene, by what they are called in a message.

    Raises InputError if one is no such law.

    >>> from puck_tables import Floor, Patch, Puck, Scene
    >>> list(laws_in(Scene(Puck(1.0), Floor(patches=[Patch([[0, 0.1], [9, 0.2]], radius=1)]))))
    ['floor.patch[0].friction']
    """
    floor = scene.floor
    laws = {} if not floor.law else {law_name(scene): law_of(floor.law)}
    if not has_laws_by_place(floor):
        return laws
    strips = 1 if floor.strips is None else len(floor.strips.friction)
    for part, one in enumerate(frictions_on(floor, 0.0)):
        name = f"strips.friction[{part}]" if part < strips else f"patch[{part - strips}].friction"
        name = "orthotropic" if part == 0 and floor.strips is None else name
        if isinstance(one, Orthotropic):
            law: Any = one.law
            laws |= {f"floor.{name}.law": law} if law else {}
        elif not isinstance(one, float) and name != "orthotropic":
            laws[f"floor.{name}"] = one
    return laws


def end_of_laws(scene: SceneSpec) -> tuple[float, str]:
    """The slip up to which the first of the laws that are points goes, m/s, and its name.

    Raises InputError as :func:`laws_in`.
    """
    ends = [
        (WITHIN * law.top_speed, name)
        for name, law in laws_in(scene).items()
        if isinstance(law, SpeedLaw)
    ]
    return min(ends, default=(math.inf, ""))


def law_table(
    scene: SceneSpec, law: SpeedLaw | FrictionLaw, top: float, load: RoundLoad
) -> SpeedTable:
    """The table of a friction law up to a slip, m/s, that the scene's tolerance asks for.

    Raises AccuracyError if the law has too many corners for so fine a tolerance; it says which can
    be reached.
    """
    try:
        with _one_at_a_time:
            return _kept_table(key_of(law), law_accuracy(scene.tol, load), top, load)
    except AccuracyError as error:
        if error.reachable is None:
            raise
        finest = rounded_up(error.reachable / LAW_SHARE)
        kinks, smoother = "its exponent", "a law that bends less at its start"
        if isinstance(law, SpeedLaw):
            kinks, smoother = "its corners", "a law with fewer points"
        if load.is_integrated:
            kinks, smoother = f"the pressure law {load.law.name}", "uniform pressure"
        raise AccuracyError(
            f"tol = {scene.tol:g} is out of reach of a table of {law_name(scene)}, with "
            f"{kinks}: give a tol (or --tol) of {finest:g} or more, or {smoother}"
        ) from None


def moments_of(
    law: SpeedLaw | FrictionLaw, top: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Its moments up to a slip, m/s, see :func:`puck_tables.contact.law_moments.law_moments`."""
    return _kept_moments(key_of(law), top)


def _first_top(law: SpeedLaw | FrictionLaw, fastest: float) -> float:
    """How far its table goes, m/s; by powers of two, so that launches that differ share one."""
    if isinstance(law, SpeedLaw):
        return law.top_speed
    room = fastest or _FLAT * max(law.scales, default=0.0) or 1.0
    return float(2.0 ** math.ceil(math.log2(room)))


def load_under(puck: PuckSpec) -> RoundLoad | None:
    """The round load of a puck; None: its base is another, friction is summed along its contour.

    Raises InputError if its pressure law is given by a function.

    >>> from puck_tables import Puck
    >>> load_under(Puck(base="annulus:0.1x0.05")).law.name, load_under(Puck(base="box:0.2x0.1"))
    ('annulus:0.5', None)
    """
    if puck.shape is not None:
        return load_of(puck.shape, puck.radius)
    return RoundLoad(puck.body.law)


def law_accuracy(tol: float, load: RoundLoad) -> float:
    """How wrong a table of a friction law under a load may be, in units of its largest f.

    ``tol``: the error wanted of the motion.

    >>> from puck_tables import Puck
    >>> law_accuracy(1e-6, load_under(Puck(0.1)))
    1e-07
    """
    return max(LAW_SHARE * tol, finest_accuracy(load))


def law_name(scene: SceneSpec) -> str:
    """The friction law of a scene in a message.

    >>> from puck_tables import Floor, Puck, Scene
    >>> law_name(Scene(Puck(1.0), Floor(law=[[0.0, 0.1], [1.0, 0.2]])))
    'floor.law'
    """
    law = scene.floor.law
    if isinstance(law, FrictionLaw):
        return f"floor.law, {law.kind}"
    return law if isinstance(law, str) else "floor.law"


def key_of(law: SpeedLaw | FrictionLaw) -> FrictionLaw | Points:
    """What a table is kept by."""
    if isinstance(law, FrictionLaw):
        return law
    return tuple(map(tuple, np.stack([law.speeds, law.values], axis=1).tolist()))


@lru_cache(maxsize=8)
def _kept_table(
    of: FrictionLaw | Points, accuracy: float, top: float, load: RoundLoad
) -> SpeedTable:  # fmt: skip
    """Kept by the law or its points: a sweep asks for it again and again."""
    law = _law(of)
    last = top if isinstance(law, FrictionLaw) else None
    return table_for(law, accuracy, top_speed=last, pressure=load.law, reach=load.reach)


@lru_cache(maxsize=32)
def _kept_moments(
    of: FrictionLaw | Points, top: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    law = _law(of)
    return law_moments(law, law.pieces(top)[0])


def _law(of: FrictionLaw | Points) -> SpeedLaw | FrictionLaw:
    if isinstance(of, FrictionLaw):
        return of
    speeds, values = zip(*of, strict=True)
    return SpeedLaw(speeds, values)
