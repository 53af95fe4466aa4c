"""An explicit step of order 8, on a graded time (:mod:`puck_tables.scene.grading`).

The pair 8(5,3) of Dormand and Prince as Hairer, Nørsett and Wanner have it (Solving Ordinary
Differential Equations I, II.5 and II.10: dop853.f; the numbers as in SciPy).  Its error is
h e₅²/√(e₅² + e₃²/100), of order 8, with e₅ and e₃ those of embedded methods of order 5 and 3.
"""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined
from puck_tables.scene.blade_axes import by_floor, has_axes, rates_by_blade
from puck_tables.scene.equations import SIZE, rates_here
from puck_tables.scene.friction import VX, VY, X, Y
from puck_tables.scene.grading import powers_of
from puck_tables.scene.ingredients import Stretch

STAGES = 13  # the last one stands at the end of the step

_ROWS: tuple[dict[int, float], ...] = (
    {},
    {0: 0.05260015195876773},
    {0: 0.0197250569845379, 1: 0.0591751709536137},
    {0: 0.02958758547680685, 2: 0.08876275643042054},
    {0: 0.2413651341592667, 2: -0.8845494793282861, 3: 0.924834003261792},
    {0: 0.037037037037037035, 3: 0.17082860872947386, 4: 0.12546768756682242},
    {0: 0.037109375, 3: 0.17025221101954405, 4: 0.06021653898045596, 5: -0.017578125},
    {0: 0.03709200011850479, 3: 0.17038392571223998, 4: 0.10726203044637328, 5:
     -0.015319437748624402, 6: 0.008273789163814023},
    {0: 0.6241109587160757, 3: -3.3608926294469414, 4: -0.868219346841726, 5:
     27.59209969944671, 6: 20.154067550477894, 7: -43.48988418106996},
    {0: 0.47766253643826434, 3: -2.4881146199716677, 4: -0.590290826836843, 5:
     21.230051448181193, 6: 15.279233632882423, 7: -33.28821096898486, 8:
     -0.020331201708508627},
    {0: -0.9371424300859873, 3: 5.186372428844064, 4: 1.0914373489967295, 5:
     -8.149787010746927, 6: -18.52006565999696, 7: 22.739487099350505, 8: 2.4936055526796523,
     9: -3.0467644718982196},
    {0: 2.273310147516538, 3: -10.53449546673725, 4: -2.0008720582248625, 5:
     -17.9589318631188, 6: 27.94888452941996, 7: -2.8589982771350235, 8: -8.87285693353063, 9:
     12.360567175794303, 10: 0.6433927460157636},
    {0: 0.054293734116568765, 5: 4.450312892752409, 6: 1.8915178993145003, 7:
     -5.801203960010585, 8: 0.3111643669578199, 9: -0.1521609496625161, 10:
     0.20136540080403034, 11: 0.04471061572777259},
)  # fmt: skip
_E5 = {
    0: 0.01312004499419488, 5: -1.2251564463762044, 6: -0.4957589496572502, 7:
    1.6643771824549864, 8: -0.35032884874997366, 9: 0.3341791187130175, 10:
    0.08192320648511571, 11: -0.022355307863886294,
}  # fmt: skip
_E3 = {
    0: -0.18980075407240762, 5: 4.450312892752409, 6: 1.8915178993145003, 7:
    -5.801203960010585, 8: -0.4226823213237919, 9: -0.1521609496625161, 10:
    0.20136540080403034, 11: 0.02265179219836082,
}  # fmt: skip


def _row(numbers: dict[int, float]) -> list[float]:
    return [numbers.get(j, 0.0) for j in range(STAGES)]


_A = np.array([_row(numbers) for numbers in _ROWS])
_C = np.array([math.fsum(numbers.values()) for numbers in _ROWS])
# of each stage, the first one besides that at the start that it is made of; and of the end
_SECOND = np.array([[*numbers, stage, stage][1] for stage, numbers in enumerate(_ROWS)])
_LATE = int(_SECOND[-1])
_B, _ERROR_5, _ERROR_3 = _A[-1], np.array(_row(_E5)), np.array(_row(_E3))


@inlined
def _five(
    y: FloatArray, i: int, h: float, slope: float, stage: int, work: FloatArray, new: FloatArray
) -> None:  # fmt: skip
    """Five numbers, from i on, of the state at a stage into ``new``.

    By name, so that they stay in registers: a compiler does not see that ``new`` and ``work`` are
    apart, and in loops over both to write and read again takes as long as to add.
    """
    w = h * slope * _A[stage, 0]
    a, b, c = y[i] + w * work[0, i], y[i + 1] + w * work[0, i + 1], y[i + 2] + w * work[0, i + 2]
    d, e = y[i + 3] + w * work[0, i + 3], y[i + 4] + w * work[0, i + 4]
    for j in range(_SECOND[stage], stage):
        w = h * _A[stage, j]
        a, b, c = a + w * work[j, i], b + w * work[j, i + 1], c + w * work[j, i + 2]
        d, e = d + w * work[j, i + 3], e + w * work[j, i + 4]
    new[i], new[i + 1], new[i + 2], new[i + 3], new[i + 4] = a, b, c, d, e


@inlined
def explicit_step(
    stretch: Stretch, t: float, h: float, y: FloatArray, scale: FloatArray, work: FloatArray,
    new: FloatArray,
) -> float:  # fmt: skip
    """A step from (t, y) over h into ``new`` (12,), the state and dx, dy; its error in ``scale``.

    On entry work[0] is dy/dt at t, on return work[STAGES − 1] that at the end; those between are by
    the variable of the step.  Velocities of a blade are by its own axes, on entry and on return.
    """
    graded, own = stretch.grade[1] != 0.0, has_axes(stretch)
    slope, two, three, four = powers_of(stretch.grade)
    for stage in range(1, STAGES):
        s = _C[stage]
        moment = t + h * (s * (slope + s * (two + s * (three + s * four))))
        _five(y, 0, h, slope, stage, work, new)
        _five(y, 5, h, slope, stage, work, new)
        along, across = new[VX], new[VY]
        if own:
            by_floor(stretch, new)
        rates_here(stretch, moment, new, work, stage)
        if own:
            new[VX], new[VY] = along, across
            rates_by_blade(stretch, new, work, stage)
        if graded and stage < STAGES - 1:
            here = slope + s * (2.0 * two + s * (3.0 * three + s * (4.0 * four)))
            for i in range(SIZE):
                work[stage, i] *= here
    new[SIZE], new[SIZE + 1] = h * slope * _B[0] * work[0, X], h * slope * _B[0] * work[0, Y]
    for j in range(_LATE, STAGES - 1):
        new[SIZE] += h * _B[j] * work[j, X]
        new[SIZE + 1] += h * _B[j] * work[j, Y]
    largest = 0.0
    for i in range(SIZE):
        rate = slope * work[0, i]
        fifth, third = _ERROR_5[0] * rate, _ERROR_3[0] * rate
        for k in range(_LATE, STAGES - 1):
            rate = work[k, i]
            fifth += _ERROR_5[k] * rate
            third += _ERROR_3[k] * rate
        measured = h / scale[i]
        fifth, third = measured * fifth, measured * third
        square = fifth * fifth
        below = square + 0.01 * third * third
        error = 0.0 if below == 0.0 else square * square / below  # squared
        if not error <= largest:
            largest = error
    return math.sqrt(largest)
