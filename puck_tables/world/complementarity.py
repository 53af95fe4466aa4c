"""Which contacts press, and which rims stick: λ ≥ 0, gap″ ≥ 0, λ gap″ = 0, |τ| ≤ μλ.

One problem for accelerations and for impacts, which have impulses for forces and velocities for
accelerations.  Modes are guessed, the forces solved for, and all modes that these contradict are
changed at once, so that the order of contacts has no say.  Where that goes round in circles, modes
come from Lemke's pivots, which find forces wherever there are some.

Of a contact λ ≥ 0 is complementary to gap″, and of rims that do not slip yet, with τ = τ₊ − τ₋ and
the slip u′ = A_t f,

    σ − u′ ≥ 0 ⟂ τ₊ ≥ 0,   σ + u′ ≥ 0 ⟂ τ₋ ≥ 0,   μλ − τ₊ − τ₋ ≥ 0 ⟂ σ ≥ 0

(Stewart and Trinkle 1996).  For μ → ∞ a large μ shows the modes: rims that all but nothing presses
may bear what keeps them from approaching.  The matrix is copositive, and Lemke's path ends at a
solution (Cottle, Pang and Stone 1992, 4.4), for impacts always; rows are told apart
lexicographically, since racks are full of ties.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.world.group import (
    APART,
    GRIP,
    LEVEL,
    SLIP,
    SMOOTH_SLIP,
    STICKS,
    GroupBuffer,
    IntArray,
    Scales,
)
from puck_tables.world.multipliers import (
    RIGHT,
    constrain,
    fill_matrix,
    leads,
    push_and_move,
    right_hand_side,
    slide_shares,
)

FORCE_N, FORCE_T, RATE_N, RATE_T, CAP = range(5)  # columns of a variable: see _write_variables
_LOST = 10.0  # of a slip, in units of the approach: the most that friction takes off it is as large
_STEEPEST = 1e4  # friction that shows the modes of friction without bound
_RAISED = 1e-8  # of the diagonal: of forces that do the same, those of equally stiff contacts
_PIVOT = 1e-10  # of the largest diagonal: smaller pivots are rounding
_TIE = 1e-10  # of the largest given: ratios closer than this are told apart by the next column
_PATIENCE = 50  # pivots for each variable: an end is reached in one or two
_OUT = 1e-8  # of the largest given: z₀ is out but for rounding
_NOTHING = 1e-11  # of the largest given: no force, no slip
_GUESSES = 25  # of modes from those before: beyond, they go round in circles
_LEFT_OVER = 1e-9  # of what is given: the equations have no solution


@inlined
def _write_variables(buffer: GroupBuffer, scales: Scales, modes: IntArray) -> int:
    """What a unit of each variable is of λ and τ, and which rates it minds; how many there are.

    ``first`` has the row of the normal of its contact.
    """
    size, row = 0, 0
    for c in range(modes.shape[0]):
        contact = buffer.kinematics[c]
        rough = contact[GRIP] > 0.0
        if buffer.matrix[row, row] > 0.0:  # else between two that cannot move
            v = buffer.variables[size]
            v[FORCE_N], v[FORCE_T], v[RATE_N], v[RATE_T], v[CAP] = 1.0, 0.0, 1.0, 0.0, -1.0
            buffer.first[size] = row
            size += 1
            slip = contact[SLIP]
            if rough and abs(slip) > 2.0 * SMOOTH_SLIP * scales.speed:
                v[FORCE_N], v[FORCE_T] = slide_shares(contact[GRIP], 1 if slip > 0.0 else -1)
            elif rough:
                for side in range(3):
                    v, sign = buffer.variables[size], 1.0 - 2.0 * side if side < 2 else 0.0
                    v[FORCE_N], v[FORCE_T], v[RATE_N], v[RATE_T] = 0.0, sign, 0.0, sign
                    v[CAP] = min(contact[GRIP], _STEEPEST) if side == 2 else -1.0
                    buffer.first[size] = row
                    size += 1
        row += 2 if rough else 1
    return size


@inlined
def _take_out_ties(buffer: GroupBuffer, first: int, count: int) -> None:
    """What leads discs is always taut: their rows from the first on leave the others."""
    a, b = buffer.matrix, buffer.vectors[RIGHT]
    for tie in range(first, count):
        for r in range(count):
            share = a[r, tie] / a[tie, tie]
            if r != tie and share != 0.0:
                for c in range(count):
                    a[r, c] -= share * a[tie, c]
                b[r] -= share * b[tie]


@inlined
def _write_tableau(buffer: GroupBuffer, size: int) -> None:
    """Write w − M z − z₀ = q in columns w, z, z₀, q, of numbers of order one."""
    a, b, table = buffer.matrix, buffer.vectors[RIGHT], buffer.tableau
    soft, most, slips = 0.0, 0.0, 0.0
    for i in range(size):
        r = buffer.first[i]
        soft = max(soft, a[r, r])
        if buffer.variables[i, RATE_N] != 0.0:
            most = max(most, abs(b[r]))
    for i in range(size):  # a slip counts as far as friction may change it
        if buffer.variables[i, CAP] >= 0.0:
            slip, cap = abs(b[buffer.first[i] + 1]), buffer.variables[i, CAP]
            slips = max(slips, min(slip, _LOST * cap * most) if cap < _STEEPEST else slip)
    most = max(most, slips)
    for i in range(size):
        v, r = buffer.variables[i], buffer.first[i]
        right = v[RATE_N] * b[r]
        if v[RATE_T] != 0.0:
            right += v[RATE_T] * b[r + 1]
        table[i, 2 * size], table[i, 2 * size + 1] = -1.0, -right / most if most > 0.0 else 0.0
        buffer.basis[i] = i
        for j in range(size):
            w, s = buffer.variables[j], buffer.first[j]
            total = 0.0
            for k in range(2):
                for n in range(2):
                    both = v[RATE_N + k] * w[FORCE_N + n]
                    if both != 0.0:
                        raised = 1.0 + _RAISED if r == s and k == n else 1.0
                        total += both * raised * a[r + k, s + n] / soft
            if r == s and v[CAP] >= 0.0:  # μλ − τ₊ − τ₋
                cap = v[CAP]
                if w[RATE_N] != 0.0:
                    total = min(cap, 1.0)
                elif w[RATE_T] != 0.0:
                    total = -1.0 if cap <= 1.0 else -1.0 / cap
            if r == s and w[CAP] >= 0.0 and v[RATE_T] != 0.0:
                total = 1.0  # σ
            table[i, j], table[i, size + j] = 1.0 if i == j else 0.0, -total


@inlined
def _leaves(buffer: GroupBuffer, size: int, column: int) -> int:
    """The row that gives way first as a column enters, in lexicographic order; −1: none."""
    table, best, last = buffer.tableau, -1, 2 * size + 1
    for r in range(size):
        pivot = table[r, column]
        if pivot <= _PIVOT:
            continue
        if best < 0:
            best = r
            continue
        for k in range(size + 1):
            n = last if k == 0 else k - 1
            apart = table[r, n] / pivot - table[best, n] / table[best, column]
            if k == 0 and abs(apart) <= _TIE and buffer.basis[best] == 2 * size:
                break
            if apart < -_TIE or (abs(apart) <= _TIE and buffer.basis[r] == 2 * size):
                best = r
                break
            if apart > _TIE:
                break
    return best


@inlined
def _pivot(buffer: GroupBuffer, size: int, row: int, column: int) -> None:
    """One variable for another."""
    table, width = buffer.tableau, 2 * size + 2
    pivot = table[row, column]
    for k in range(width):
        table[row, k] /= pivot
    for r in range(size):
        share = table[r, column]
        if r != row and share != 0.0:
            for k in range(width):
                table[r, k] -= share * table[row, k]
    buffer.basis[row] = column


@inlined
def _value(buffer: GroupBuffer, size: int, i: int) -> float:
    """A variable z; the last is z₀."""
    for r in range(size):
        if buffer.basis[r] == size + i:
            return buffer.tableau[r, 2 * size + 1]
    return 0.0


@inlined
def _follow_path(buffer: GroupBuffer, size: int) -> bool:
    """Pivots until z₀ is out of it; whether it is."""
    table, row, last = buffer.tableau, 0, 2 * size + 1
    for r in range(1, size):
        if table[r, last] <= table[row, last] + _TIE:
            row = r
    if table[row, last] >= 0.0:
        return True
    column = 2 * size
    for _ in range(_PATIENCE * size):
        out = buffer.basis[row]
        _pivot(buffer, size, row, column)
        if out == 2 * size:
            return True
        column = out + size if out < size else out - size
        row = _leaves(buffer, size, column)
        if row < 0:
            return _value(buffer, size, size) <= _OUT
    return False


@inner
def modes_of_lemke(buffer: GroupBuffer, modes: IntArray, scales: Scales) -> bool:
    """The modes of contacts where forces satisfy all conditions; whether there are any."""
    for c in range(modes.shape[0]):
        modes[c] = STICKS
    count = constrain(buffer, modes, True, False)
    fill_matrix(buffer, count)
    right_hand_side(buffer, modes)
    size = _write_variables(buffer, scales, modes)
    _take_out_ties(buffer, count - buffer.number[0], count)
    _write_tableau(buffer, size)
    if not _follow_path(buffer, size):
        return False
    i, row = 0, 0
    for c in range(modes.shape[0]):
        contact = buffer.kinematics[c]
        rough, slip = contact[GRIP] > 0.0, contact[SLIP]
        moves = i < size and buffer.first[i] == row
        row += 2 if rough else 1
        if not moves:
            continue
        pressed = _value(buffer, size, i) > _NOTHING
        i += 1
        if not rough or abs(slip) > 2.0 * SMOOTH_SLIP * scales.speed:
            modes[c] = 1 if slip >= 0.0 else -1
        else:
            rim = _value(buffer, size, i) - _value(buffer, size, i + 1)
            if _value(buffer, size, i + 2) > _NOTHING and abs(rim) > _NOTHING:
                modes[c] = 1 if rim > 0.0 else -1
            pressed = pressed or abs(rim) > _NOTHING
            i += 3
        if not pressed:
            modes[c] = APART
    return True


@inlined
def rim_mode(contact: FloatArray, speed: float) -> int:
    """How the rims slip, as seen; rims without friction slide."""
    slip = contact[SLIP]
    if abs(slip) <= 2.0 * SMOOTH_SLIP * speed and contact[GRIP] > 0.0:
        return STICKS
    return 1 if slip >= 0.0 else -1


@inlined
def most(contact: FloatArray, push: float) -> float:
    """The most that the rims bear where they are pressed."""
    return math.inf if contact[GRIP] == math.inf else contact[GRIP] * max(push, 0.0)


@inlined
def load_of(contact: FloatArray, mode: int, push: float, rim: float) -> float:
    """What presses a contact: λ, or on rims without bound that slide, τ against the slip."""
    return mode * rim if mode != STICKS and contact[GRIP] == math.inf else push


@inlined
def better_mode(buffer: GroupBuffer, c: int, mode: int, scales: Scales, may_slide: bool) -> int:
    """The mode that forces and accelerations ask for, when it was supposed to be ``mode``.

    ``may_slide``: also on rims without bound, which then nothing presses; guesses from the start go
    round in circles with it (13 of 300 racks were refused, 2 are).
    """
    gap, slip, soft, rolls = leads(buffer, c)
    slack = 0.5 * LEVEL * scales.rate
    if soft == 0.0:  # between two that cannot move nothing is known, if they do not part
        return APART if gap > slack else mode
    contact, push, rim = buffer.kinematics[c], buffer.pushes[c, 0], buffer.pushes[c, 1]
    if mode == APART:
        if gap >= -slack:
            return APART
        mode = rim_mode(contact, scales.speed)
        if mode == STICKS and abs(slip) * soft > most(contact, -gap) * rolls:  # as it would alone
            mode = 1 if slip > 0.0 else -1
        return mode
    if load_of(contact, mode, push, rim) * soft < -slack:
        if may_slide and mode == STICKS and contact[GRIP] == math.inf and rim != 0.0:
            return 1 if rim > 0.0 else -1
        return APART
    if contact[GRIP] == 0.0:
        return mode
    if mode == STICKS:
        if (abs(rim) - most(contact, push)) * rolls > slack:
            return 1 if rim > 0.0 else -1
        return STICKS
    begins = abs(contact[SLIP]) <= 2.0 * SMOOTH_SLIP * scales.speed
    return STICKS if begins and slip * mode < -slack else mode


@inner
def find_modes(buffer: GroupBuffer, modes: IntArray, members: int, scales: Scales) -> bool:
    """Modes that contradict nothing, from those given; pushes and accelerations.  Whether found."""
    count = modes.shape[0]
    for attempt in range(2):
        if attempt == 1 and not modes_of_lemke(buffer, modes, scales):
            return False
        for _ in range(_GUESSES):
            left = push_and_move(buffer, modes, members)
            changed = False
            for c in range(count):
                mode = better_mode(buffer, c, modes[c], scales, attempt == 1)
                buffer.order[c] = mode
                changed = changed or mode != modes[c]
            if not changed and left <= _LEFT_OVER:
                return True
            if not changed:
                break
            for c in range(count):
                modes[c] = buffer.order[c]
    return False
