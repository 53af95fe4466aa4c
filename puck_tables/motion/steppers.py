"""One explicit Runge–Kutta step, for any Butcher tableau, and the integrators that there are."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.accuracy.method_errors import Selection
from puck_tables.accuracy.methods import Method
from puck_tables.kernels.compile import inlined, inner
from puck_tables.motion.equations_of_motion import derivatives
from puck_tables.motion.state import SIZE


class Tableau(NamedTuple):
    """Butcher tableau of s stages: their weights (s, s), nodes, the weights of the end.

    ``e``: error weights (2, s).  The error of a step over h is h e²/√(e² + e′²/100), with e and e′
    by one row each: h e where the second is zero; without an estimate both are.  ``order``: of the
    error of a motion with fixed steps; of a pair, of the local error that it estimates.
    ``reused``: whether the last stage is the first of the next step.  ``unrolled``: whether
    :mod:`puck_tables.motion.bulk_stops` takes the same steps.
    """

    a: FloatArray
    c: FloatArray
    b: FloatArray
    e: FloatArray
    order: int
    reused: bool
    unrolled: bool


def tableau_of(
    rows: list[list[float]], weights: list[float], errors: list[list[float]], order: int,
    unrolled: bool = False,
) -> Tableau:  # fmt: skip
    """A tableau from its rows, each as long as its last number that is not zero.

    >>> tableau_of([[], [1 / 2]], [0.0, 1.0], [], 2).c.tolist()
    [0.0, 0.5]
    """

    def filled(numbers: list[list[float]], height: int) -> FloatArray:
        out = np.zeros((height, len(rows)))
        for n, row in enumerate(numbers):
            out[n, : len(row)] = row
        return out

    a, b = filled(rows, len(rows)), filled([weights], 1)[0]
    c = np.array([math.fsum(row) for row in rows])
    return Tableau(a, c, b, filled(errors, 2), order, bool(np.array_equal(a[-1], b)), unrolled)


# Kutta 1901
RK4 = tableau_of([[], [1 / 2], [0, 1 / 2], [0, 0, 1]], [1 / 6, 1 / 3, 1 / 3, 1 / 6], [], 4, True)

# Dormand and Prince 1980, RK5(4)7M; the last stage is the next step's first
_LAST = [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84]
DORMAND_PRINCE = tableau_of(
    [
        [],
        [1 / 5],
        [3 / 40, 9 / 40],
        [44 / 45, -56 / 15, 32 / 9],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
        _LAST,
    ],
    _LAST,
    [[71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40]],
    5,
)

# their pair 8(5,3) as Hairer, Nørsett and Wanner have it (Solving Ordinary Differential Equations
# I, II.5 and II.10: dop853.f; the numbers as in SciPy)
_LAST_8 = [
    0.054293734116568765, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003, -5.801203960010585,
    0.3111643669578199, -0.1521609496625161, 0.20136540080403034, 0.04471061572777259,
]  # fmt: skip
DORMAND_PRINCE_8 = tableau_of(
    [
        [],
        [0.05260015195876773],
        [0.0197250569845379, 0.0591751709536137],
        [0.02958758547680685, 0, 0.08876275643042054],
        [0.2413651341592667, 0, -0.8845494793282861, 0.924834003261792],
        [0.037037037037037035, 0, 0, 0.17082860872947386, 0.12546768756682242],
        [0.037109375, 0, 0, 0.17025221101954405, 0.06021653898045596, -0.017578125],
        [0.03709200011850479, 0, 0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
         0.008273789163814023],
        [0.6241109587160757, 0, 0, -3.3608926294469414, -0.868219346841726, 27.59209969944671,
         20.154067550477894, -43.48988418106996],
        [0.47766253643826434, 0, 0, -2.4881146199716677, -0.590290826836843, 21.230051448181193,
         15.279233632882423, -33.28821096898486, -0.020331201708508627],
        [-0.9371424300859873, 0, 0, 5.186372428844064, 1.0914373489967295, -8.149787010746927,
         -18.52006565999696, 22.739487099350505, 2.4936055526796523, -3.0467644718982196],
        [2.273310147516538, 0, 0, -10.53449546673725, -2.0008720582248625, -17.9589318631188,
         27.94888452941996, -2.8589982771350235, -8.87285693353063, 12.360567175794303,
         0.6433927460157636],
        _LAST_8,
    ],
    _LAST_8,
    [
        [0.01312004499419488, 0, 0, 0, 0, -1.2251564463762044, -0.4957589496572502,
         1.6643771824549864, -0.35032884874997366, 0.3341791187130175, 0.08192320648511571,
         -0.022355307863886294],
        [-0.18980075407240762, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003,
         -5.801203960010585, -0.4226823213237919, -0.1521609496625161, 0.20136540080403034,
         0.02265179219836082],
    ],
    8,
)  # fmt: skip


TABLEAUS = {Method.RK4: RK4, Method.ADAPTIVE: DORMAND_PRINCE}


class Stepping(NamedTuple):
    """An integrator with its setting: so many fixed steps, or 0 and the local error of a step."""

    tableau: Tableau
    steps: float
    local: float

    @property
    def fixed(self) -> bool:
        """Whether the steps are fixed."""
        return self.steps > 0.0

    def finer(self, steps: float, local: float, finest: float) -> Stepping:
        """With so many times the steps, or the local error times ``local``, at least ``finest``."""
        more = float(math.ceil(steps * self.steps))
        return Stepping(self.tableau, more, max(local * self.local, finest))


def stepping_of(selection: Selection, loosest: float = 1.0) -> Stepping:
    """The integrator that was selected; its local error at most ``loosest``.

    >>> from puck_tables.accuracy.method_errors import select
    >>> from puck_tables.accuracy.methods import INTEGRATED
    >>> stepping_of(select("stop", 1e-4, INTEGRATED)).steps
    10.0
    """
    tableau, value = TABLEAUS[selection.method], selection.number(selection.method.setting)
    if tableau.e.any():
        return Stepping(tableau, 0.0, min(value, loosest))
    return Stepping(tableau, value, 1.0)


# of the work space: as many stages as any method has, the slopes at an event, and a state
ROWS = len(DORMAND_PRINCE_8.c) + 2
AT_EVENT = ROWS - 2


@inlined
def times_as_long(error: float, tolerance: float, power: float, least: float) -> float:
    """By how much a step may be longer, at most 5, or must be shorter, for its error to be right.

    ``power``: of the error over the length; ``least``: the shortest it may become at once.
    """
    if not error < math.inf:
        return least
    if error == 0.0:
        return 5.0
    return min(max(0.9 * (tolerance / error) ** power, least), 5.0)


@inlined
def estimated(tableau: Tableau, work: FloatArray, i: int) -> float:
    """The error of one number of the state in a step just done, over its length."""
    error, other = 0.0, 0.0
    for stage in range(tableau.b.size):
        error += tableau.e[0, stage] * work[stage, i]
        other += tableau.e[1, stage] * work[stage, i]
    return error if other == 0.0 else error * (abs(error) / math.hypot(error, 0.1 * other))


@inner
def step(
    tableau: Tableau, z: float, y: FloatArray, h: float, section: FloatArray, delta: float,
    work: FloatArray, out: FloatArray,
) -> float:  # fmt: skip
    """A step from (z, y) over h into ``out``; returns the largest local error estimate.

    On entry work[0] is dy/dz at z; on return the other rows are the stages.
    """
    stages = tableau.b.size
    state = work[ROWS - 1]
    for stage in range(1, stages):
        for i in range(SIZE):
            state[i] = y[i]
        for j in range(stage):
            if tableau.a[stage, j] != 0.0:
                weight = h * tableau.a[stage, j]
                for i in range(SIZE):
                    state[i] += weight * work[j, i]
        derivatives(z + tableau.c[stage] * h, state, section, delta, work[stage])
    largest = 0.0
    for i in range(SIZE):
        increment = 0.0
        for j in range(stages):
            increment += tableau.b[j] * work[j, i]
        out[i] = y[i] + h * increment
        error = abs(h * estimated(tableau, work, i))
        if not error <= largest:  # a NaN is never small
            largest = error
    return largest
