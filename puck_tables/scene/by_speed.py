"""Friction of a scene whose coefficient depends on the slip speed: its law, and the table of it."""

from __future__ import annotations

import math
import threading
from functools import lru_cache

import numpy as np

from puck_tables._core.real import rounded_up
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import AccuracyError, InputError
from puck_tables.scene.agreement import law_of_rows
from puck_tables.scene.ingredients import BySpeed
from puck_tables.scene.scene_spec import SceneSpec
from puck_tables.table.speed_build import FINEST_ACCURACY
from puck_tables.table.speed_table import SpeedTable
from puck_tables.table.table_cache import table_for

Points = tuple[tuple[float, float], ...]

LAW_SHARE = 0.1  # of the error wanted: of the friction at any slip, in units of f N
NO_LAW = BySpeed(np.zeros(0), 0.0, 0.0, 1.0)
FARTHER = 4.0  # a law by name holds at all speeds: its table goes on as needed
_FLAT = 8.0  # times its own scale goes the first table of a launch from rest

_one_at_a_time = threading.Lock()  # the threads of a sweep need the same table


def law_up_to(scene: SceneSpec, fastest: float, reach: float) -> tuple[SpeedTable, float]:
    """The table of a friction law that holds for such slips of the rim, m/s, and the largest f.

    Raises
    ------
    InputError
        If the law cannot be read, or ends below them.
    AccuracyError
        If it has too many corners for so fine a tolerance; it says which can be reached.
    """
    law = speed_law(scene)
    top = _first_top(law, fastest)
    if fastest > top:
        raise InputError(
            f"the rim slips at {fastest:.6g} m/s at the launch, faster than the friction law "
            f"{law_name(scene)} goes ({top:g} m/s): nothing is known beyond; give it more"
        )
    largest = law.largest(top)
    if isinstance(law, FrictionLaw):
        top *= reach
    share = largest / law.largest(top) if largest > 0.0 else 1.0  # the unit of errors of the table
    return _law_table(law, scene, top, share), largest


def _first_top(law: SpeedLaw | FrictionLaw, fastest: float) -> float:
    """How far its table goes, m/s; by powers of two, so that launches that differ share one."""
    if isinstance(law, SpeedLaw):
        return law.top_speed
    room = fastest or _FLAT * max(law.scales, default=0.0) or 1.0
    return float(2.0 ** math.ceil(math.log2(room)))


def law_error(scene: SceneSpec) -> float:
    """How wrong friction by slip speed may be, in units of the largest."""
    return max(LAW_SHARE * scene.tol, FINEST_ACCURACY)


def speed_law(scene: SceneSpec) -> SpeedLaw | FrictionLaw:
    """The friction law of a scene that has one, by name, or from its file or rows.

    Raises
    ------
    InputError
        If it is no such law.
    """
    law = scene.floor.law
    if isinstance(law, FrictionLaw):
        return law
    if isinstance(law, str):
        return SpeedLaw.from_csv(law)
    return law_of_rows(law)


def law_name(scene: SceneSpec) -> str:
    """The friction law of a scene in a message.

    Examples
    --------
    >>> from puck_tables import Floor, Puck, Scene
    >>> law_name(Scene(Puck(1.0), Floor(law=[[0.0, 0.1], [1.0, 0.2]])))
    'floor.law'
    """
    law = scene.floor.law
    if isinstance(law, FrictionLaw):
        return f"floor.law, {law.kind}"
    return law if isinstance(law, str) else "floor.law"


def _law_table(
    law: SpeedLaw | FrictionLaw, scene: SceneSpec, top: float, share: float
) -> SpeedTable:
    """The table of a friction law that the scene's tolerance asks for.

    Raises
    ------
    AccuracyError
        If the law has too many corners for so fine a tolerance; it says which can be reached.
    """
    of: FrictionLaw | Points
    if isinstance(law, FrictionLaw):
        of = law
    else:
        of = tuple(map(tuple, np.stack([law.speeds, law.values], axis=1).tolist()))
    try:
        with _one_at_a_time:
            return _kept_table(of, max(share * law_error(scene), FINEST_ACCURACY), top)
    except AccuracyError as error:
        if error.reachable is None:
            raise
        finest = rounded_up(error.reachable / LAW_SHARE)
        bends, smoother = "its exponent", "a law that bends less at its start"
        if isinstance(law, SpeedLaw):
            bends, smoother = "its corners", "a law with fewer points"
        raise AccuracyError(
            f"tol = {scene.tol:g} is out of reach of a table of {law_name(scene)}, with "
            f"{bends}: give a tol (or --tol) of {finest:g} or more, or {smoother}"
        ) from None


@lru_cache(maxsize=8)
def _kept_table(of: FrictionLaw | Points, accuracy: float, top: float) -> SpeedTable:
    """Kept by the law or its points: a sweep asks for it again and again."""
    if isinstance(of, FrictionLaw):
        return table_for(of, accuracy, top_speed=top)
    speeds, values = zip(*of, strict=True)
    return table_for(SpeedLaw(speeds, values), accuracy)
