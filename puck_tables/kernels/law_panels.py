"""Where the panels of a contour end over which a friction law by the slip speed is summed.

A law bends at its corners, and a steep one is short pieces: a rule that goes across misses that by
parts in ten thousand.  From the point of a side, or of a circle, that is nearest to the
instantaneous centre, the slip speed only grows, both ways.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.law_moments import DEGREE, MOMENTS
from puck_tables.kernels.compile import inlined
from puck_tables.kernels.elementary import log_of

# of Gauss's rule a panel, and across the base where C is far away; on it and on ARC rests that sums
# are good to 1e-10: test_a_law_is_integrated_as_exactly_as_a_constant
NODES = 8
PANEL = 2.0  # of y
ARC = 0.9  # of an angle, over how far it is from the singularity next to C
LEAST_GAP = 1e-9  # of an angle: closer, C lies on the circle
_AHEAD = 4  # pieces of a smooth law: a panel across them is good to 1e-11
_BEYOND = 1.0 + 1e-9  # times a slip speed: a corner there is passed
_STEP = 1e-12  # the shortest panel of a circle


@inlined
def begin_of(law: FloatArray, u: float) -> int:
    """Where in a law the begin of the piece stands in which a slip speed lies; the last goes on."""
    low, high = 1, 1 + int(law[0])
    while high - low > 1:
        middle = (low + high) // 2
        if u >= law[middle]:
            low = middle
        else:
            high = middle
    return low


@inlined
def next_end(law: FloatArray, u: float) -> float:
    """Up to which slip speed a rule may go from one: the next corner, or some pieces on; or inf."""
    count, after = int(law[0]), begin_of(law, u) + _AHEAD
    cut = law[after] if after <= count else math.inf
    corners = 2 + count + count * MOMENTS * (DEGREE + 1)
    for k in range(int(law[corners])):
        corner = law[corners + 1 + k]
        if u * _BEYOND < corner < cut:
            cut = corner
    return cut


@inlined
def side_panel(
    law: FloatArray, spin: float, away: float, piece: int, y: float, last: float
) -> tuple[float, int]:
    """Where the panel ends that begins at y ≥ 0, s = away sinh y, in a piece of the law.

    Also, in which piece the next one begins: no panel of a side goes across two.
    """
    end, after = last, piece
    if piece < int(law[0]):
        reach = law[piece + 1] / spin
        root = math.sqrt(max((reach - away) * (reach + away), 0.0))
        there = log_of((reach + root) / away)
        if there < last:
            end, after = max(there, y), piece + 1
    panels = 1 + int((end - y) / PANEL)
    return (end, after) if panels == 1 else (y + (end - y) / panels, piece)


@inlined
def circle_end(
    law: FloatArray, spin: float, off: float, size: float, turn: float, last: float
) -> float:
    """Where the panel ends that begins at a turn from 0 to π; ``off``: how far its middle is.

    ``last``: where the arc ends, or turns back.
    """
    gap, left = abs(off - size), last - turn
    near = min(max(gap / size, LEAST_GAP), 1.0)
    length = ARC * math.sqrt(near * near + turn * turn)
    if length >= 0.7 * left:
        length = left if length >= left else 0.5 * left
    end = turn + length if length < left else last
    product, h = 4.0 * off * size, math.sin(0.5 * turn)
    reach = next_end(law, spin * math.sqrt(gap * gap + product * h * h)) / spin
    if reach < math.inf:
        square = (reach - gap) * (reach + gap)
        if square < product:
            there = 2.0 * math.asin(math.sqrt(max(square, 0.0) / product))
            end = min(end, max(there, turn + _STEP))
    return end


@inlined
def arc_from_nearest(start: float, turn: float, nearest: float) -> tuple[float, float]:
    """From where to where an arc goes, counter-clockwise, counted from an angle of its circle."""
    whole = 2.0 * math.pi
    if abs(turn) == whole:  # it begins nowhere
        return 0.0, whole
    low = (start if turn > 0.0 else start + turn) - nearest
    low -= whole * math.floor(low / whole)
    return low, low + abs(turn)


@inlined
def panels_far_off(turn: float) -> int:
    """How many panels an arc takes where C is far away."""
    return 1 + int(abs(turn) / ARC)
