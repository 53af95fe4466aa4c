"""The integrals that a table by slip speed is made and judged of, under any round load."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray
from puck_tables._core.executor import keep_on
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.integrals import SlipDirection
from puck_tables.contact.round_load import RoundLoad
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.contact.speed_quadrature import SpeedFunction, speed_integrals
from puck_tables.kernels.circle_quadrature import fill_load
from puck_tables.kernels.speed_quadrature_kernel import FEW_POWERS, FINE, fill_integrals

Law = SpeedLaw | FrictionLaw | SpeedFunction
Flags = npt.NDArray[np.bool_]

_SHORT = 0.3  # of its place
# points between two looks whether to go on: some 0.1 s
_AT_ONCE, _OF_CIRCLES = 20_000, 200


def truth_at(
    law: Law, load: RoundLoad, top: float, direction: SlipDirection, speed: FloatArray,
    rules: int = FINE, plain: bool = False,
) -> FloatArray:  # fmt: skip
    """p_a, p_b, p_d, p_e by quadrature, (…, 4).

    Parameters
    ----------
    law, load : of friction and of pressure
    top : what the slip goes up to, m/s
    direction, speed : of the slip, of one shape; m/s
    rules : FINE or COARSE
    plain : discs by :mod:`puck_tables.contact.speed_quadrature`, as for a law that is a function

    Examples
    --------
    >>> from puck_tables.contact.integrals import slip_direction
    >>> from puck_tables.contact.laws import law_of
    >>> viscous = SpeedLaw([0.0, 2.0], [0.0, 0.2])
    >>> ring = RoundLoad(law_of("ring"))
    >>> truth_at(viscous, ring, 2.0, slip_direction(np.array([0.7])), np.ones(1)).round(9).tolist()
    [[0.1, 0.05, 0.1, -0.05]]
    """
    if not len(load.discs):
        return _over_circles(law, load, top, direction, speed, rules)
    total = np.zeros((*np.shape(speed), 4))
    for radius, share in load.discs:
        if radius == 1.0:
            part = _of_disc(law, top, direction, speed, rules, plain)
            norm = np.ones(np.shape(speed))
        else:
            seen, norm = _of_rim(direction, radius)
            part = _of_disc(law, top, seen, speed * norm, rules, plain)
            part = part * np.array([1.0, radius**2, radius**2, radius**2])
        total += share * part / np.expand_dims(norm, -1)
    return total


def _of_rim(direction: SlipDirection, radius: float) -> tuple[SlipDirection, FloatArray]:
    """The slip of a disc of another radius: its direction, and its Q over that of the whole."""
    cosine, sine = np.sqrt(direction.cos_squared), radius * np.sqrt(direction.sin_squared)
    fast = sine > cosine
    ratio = np.where(fast, cosine, sine) / np.where(fast, sine, cosine)
    return SlipDirection(ratio, fast), np.hypot(cosine, sine)


def _of_disc(
    law: Law, top: float, direction: SlipDirection, speed: FloatArray, rules: int, plain: bool
) -> FloatArray:
    ratio, fast = direction.ratio, direction.fast_spin
    if plain or not isinstance(law, SpeedLaw | FrictionLaw):
        p = speed_integrals(np.where(fast, np.arctan2(1.0, ratio), np.arctan(ratio)), speed, law)
        return np.stack([p.a, p.b, p.d, p.e], axis=-1)
    ends, pieces = law.pieces(top)
    flat, inside, Q, out = _flat(ratio, fast, speed)
    for part in _parts(Q.size, max(1, _AT_ONCE // max(1, len(pieces) // 4))):
        fill_integrals(ends, pieces, flat[part], inside[part], Q[part], rules, out[part])
    return out.reshape(*np.shape(ratio), 4)


def _over_circles(
    law: Law, load: RoundLoad, top: float, direction: SlipDirection, speed: FloatArray, rules: int
) -> FloatArray:
    assert isinstance(law, SpeedLaw | FrictionLaw)  # a function has been refused
    ends, pieces = law.pieces(top)
    power, rows = load.circles
    kinks = _kinks(ends, pieces)
    flat, inside, Q, out = _flat(direction.ratio, direction.fast_spin, speed)
    for part in _parts(Q.size, max(1, _OF_CIRCLES // max(1, len(rows)))):
        fill_load(
            ends, pieces, kinks, power, rows, load.reach, flat[part], inside[part], Q[part], rules,
            out[part],
        )  # fmt: skip
    return out.reshape(*np.shape(direction.ratio), 4)


def _kinks(ends: FloatArray, pieces: FloatArray) -> FloatArray:
    """Speeds of the corners of a law of cubics; of a smooth one those between which it bends most.

    Smooth laws stand in pieces as long as a series allows: such a piece is much shorter than its
    distance from slip zero.
    """
    if pieces.shape[1] <= FEW_POWERS:
        return ends[1:-1]
    short = np.flatnonzero(np.diff(ends) < _SHORT * ends[1:])
    return np.setdiff1d(ends[np.union1d(short, short + 1)], ends[[0, -1]])


def _flat(
    ratio: FloatArray, fast: Flags, speed: FloatArray
) -> tuple[FloatArray, Flags, FloatArray, FloatArray]:
    flat = np.ravel(ratio).copy()
    inside = np.array(np.broadcast_to(fast, np.shape(ratio)), bool).ravel()
    return flat, inside, np.ravel(speed).copy(), np.empty((flat.size, 4))


def _parts(size: int, each: int) -> Iterator[slice]:
    """Slices of so many, with a look whether to go on before each."""
    for start in range(0, size, each):
        keep_on()
        yield slice(start, start + each)
