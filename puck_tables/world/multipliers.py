"""The forces of contacts whose modes are known: as many linear equations as there are forces.

A contact that presses has gap″ = 0, a rim that sticks u′ = 0; on a rim that slides τ = ±μλ, which
for μ → ∞ leaves τ alone: λ → 0.  So a row of the constraints and a column of the forces differ
where rims slide.  In a rack there are more contacts than directions to move: then many forces do
the same, the matrix is singular, and of all solutions the smallest is taken, that of equally stiff
contacts.  For this the diagonal is raised by a little, and what this leaves is solved for again
until nothing is left.

By such equations errors of steps are taken out of places and velocities, too: gaps, approaches,
slips, by the least change in the measure of the masses.  So energy does not grow, no order has a
say, and a change as small as the error of a step spoils no order of a method.
"""

from __future__ import annotations

import math

from puck_tables._core.arrays import FloatArray
from puck_tables.kernels.compile import inlined, inner
from puck_tables.world.group import (
    ALONG,
    APART,
    APPROACH,
    ARM,
    CURVATURE,
    FAR_ARM,
    GAP,
    GRIP,
    NX,
    NY,
    STICKS,
    GroupBuffer,
    IntArray,
)

_RAISED = 1e-9  # of the diagonal
_ROUNDS = 4  # of solving for what is left, at most
RIGHT, SOLUTION, LEFT, STEP = range(4)  # vectors of the buffer


@inner
def close_gaps(buffer: GroupBuffer, modes: IntArray, y: FloatArray) -> None:
    """Places where what presses touches and what is led is; the kinematics are of y (m, 6)."""
    count = constrain(buffer, modes, False, False)
    number = 0
    for c in range(modes.shape[0]):
        if modes[c] != APART:
            buffer.vectors[RIGHT, number] = -buffer.kinematics[c, GAP]
            number += 1
    stray(buffer, number, 0)
    solve(buffer, count)
    add_forces(buffer, count, y, 0)


@inner
def stop_slips(buffer: GroupBuffer, modes: IntArray, y: FloatArray) -> float:
    """Velocities with which nothing that presses approaches, and no rim slips that sticks.

    The heat of it: a force that stops a slip works at half of it.
    """
    count = constrain(buffer, modes, True, False)
    number = 0
    for c in range(modes.shape[0]):
        if modes[c] == APART:
            continue
        buffer.vectors[RIGHT, number] = times_row(buffer, number, y, 3)
        number += 1
        if modes[c] == STICKS and buffer.kinematics[c, GRIP] > 0.0:
            buffer.vectors[RIGHT, number] = times_row(buffer, number, y, 3)
            number += 1
    stray(buffer, number, 1)
    solve(buffer, count)
    add_forces(buffer, count, y, 3)
    heat = 0.0
    for r in range(count):
        heat += 0.5 * buffer.vectors[RIGHT, r] * buffer.vectors[SOLUTION, r]
    return heat


@inlined
def _row_of(row: FloatArray, contact: FloatArray, along: bool) -> None:
    """What a unit force along the normal, or along the rims, is on both discs."""
    ex, ey = (-contact[NY], contact[NX]) if along else (contact[NX], contact[NY])
    row[0], row[1], row[3], row[4] = ex, ey, -ex, -ey
    row[2], row[5] = (contact[ARM], contact[FAR_ARM]) if along else (0.0, 0.0)


@inlined
def slide_shares(grip: float, mode: int) -> tuple[float, float]:
    """λ and τ of a unit of force on a rim that slides to a side, ±1."""
    return (0.0, float(mode)) if grip == math.inf else (1.0, mode * grip)


@inlined
def times_row(buffer: GroupBuffer, number: int, rates: FloatArray, first: int) -> float:
    """A row of the constraints times velocities or accelerations (m, …), from a column on."""
    total, row = 0.0, buffer.rows[number]
    for side in range(2):
        place = buffer.owners[number, side]
        if place >= 0:
            for i in range(3):
                total += row[3 * side + i] * rates[place, first + i]
    return total


@inlined
def constrain(buffer: GroupBuffer, modes: IntArray, sticks: bool, slides: bool) -> int:
    """Rows and columns of what contacts in these modes forbid, and then ties; their number.

    ``sticks``: also that rims that stick slip; ``slides``: with the forces of rims that slide.
    """
    count = 0
    for c in range(modes.shape[0]):
        if modes[c] == APART:
            continue
        contact = buffer.kinematics[c]
        for along in range(2):
            if along == 1 and not (sticks and modes[c] == STICKS and contact[GRIP] > 0.0):
                continue
            for side in range(2):
                buffer.owners[count, side] = buffer.pairs[c, side]
            _row_of(buffer.rows[count], contact, along == 1)
            _row_of(buffer.columns[count], contact, along == 1)
            if slides and along == 0 and modes[c] != STICKS:
                across, rim = slide_shares(contact[GRIP], modes[c])
                column = buffer.columns[count]
                ex, ey = (
                    across * contact[NX] - rim * contact[NY],
                    across * contact[NY] + rim * contact[NX],
                )
                column[0], column[1], column[3], column[4] = ex, ey, -ex, -ey
                column[2], column[5] = rim * contact[ARM], rim * contact[FAR_ARM]
            count += 1
    for tie in range(buffer.number[0]):
        buffer.owners[count, 0], buffer.owners[count, 1] = buffer.led_places[tie], -1
        for i in range(3):
            buffer.rows[count, i] = buffer.columns[count, i] = buffer.ties[tie, i]
            buffer.rows[count, 3 + i] = buffer.columns[count, 3 + i] = 0.0
        count += 1
    return count


@inlined
def stray(buffer: GroupBuffer, first: int, what: int) -> None:
    """By how much places (0) or velocities (1) of what is led are off, as what forces take out."""
    for tie in range(buffer.number[0]):
        buffer.vectors[RIGHT, first + tie] = buffer.strays[tie, what]


@inlined
def fill_matrix(buffer: GroupBuffer, count: int) -> None:
    """The matrix: how much a unit of one force changes what another one forbids."""
    for r in range(count):
        for c in range(count):
            total = 0.0
            for side in range(2):
                place = buffer.owners[r, side]
                if place < 0:
                    continue
                light, turns = buffer.inverse[place, 0], buffer.inverse[place, 1]
                for other in range(2):
                    if buffer.owners[c, other] == place:
                        i, j = 3 * side, 3 * other
                        total += light * (
                            buffer.rows[r, i] * buffer.columns[c, j]
                            + buffer.rows[r, i + 1] * buffer.columns[c, j + 1]
                        ) + turns * (buffer.rows[r, i + 2] * buffer.columns[c, j + 2])
            buffer.matrix[r, c] = total


@inlined
def _is_fixed(buffer: GroupBuffer, r: int) -> bool:
    """Whether a row is of two that cannot move."""
    for side in range(2):
        place = buffer.owners[r, side]
        if place >= 0 and buffer.inverse[place, 0] > 0.0:
            return False
    return True


@inlined
def _factor(buffer: GroupBuffer, count: int) -> None:
    """LU with row exchanges, of the matrix with its diagonal raised."""
    lu, order = buffer.factors, buffer.order
    for r in range(count):
        order[r] = r
        for c in range(count):
            lu[r, c] = buffer.matrix[r, c]
        lu[r, r] += _RAISED * abs(lu[r, r])
        if _is_fixed(buffer, r):
            lu[r, r] = 1.0  # no force
    for k in range(count):
        best = k
        for r in range(k + 1, count):
            if abs(lu[r, k]) > abs(lu[best, k]) * (1.0 + 1e-9):
                best = r
        if best != k:
            order[k], order[best] = order[best], order[k]
            for c in range(count):
                lu[k, c], lu[best, c] = lu[best, c], lu[k, c]
        if lu[k, k] == 0.0:
            lu[k, k] = 1.0  # what is left tells that there is no solution
        for r in range(k + 1, count):
            share = lu[r, k] / lu[k, k]
            lu[r, k] = share
            if share != 0.0:
                for c in range(k + 1, count):
                    lu[r, c] -= share * lu[k, c]


@inner
def solve(buffer: GroupBuffer, count: int) -> float:
    """Solve for the forces to ``vectors[RIGHT]``; what is left, over what was given."""
    fill_matrix(buffer, count)
    _factor(buffer, count)
    lu, v = buffer.factors, buffer.vectors
    largest, left = 0.0, 0.0
    for r in range(count):
        v[SOLUTION, r], v[LEFT, r] = 0.0, v[RIGHT, r]
        if _is_fixed(buffer, r):
            v[LEFT, r] = 0.0
        largest = max(largest, abs(v[LEFT, r]))
    for _ in range(_ROUNDS):
        for r in range(count):
            total = v[LEFT, buffer.order[r]]
            for c in range(r):
                total -= lu[r, c] * v[STEP, c]
            v[STEP, r] = total
        for back in range(count):
            r = count - 1 - back
            total = v[STEP, r]
            for c in range(r + 1, count):
                total -= lu[r, c] * v[STEP, c]
            v[STEP, r] = total / lu[r, r]
        left = 0.0
        for r in range(count):
            v[SOLUTION, r] += v[STEP, r]
        for r in range(count):
            total = v[RIGHT, r]
            for c in range(count):
                total -= buffer.matrix[r, c] * v[SOLUTION, c]
            if _is_fixed(buffer, r):
                total = 0.0
            v[LEFT, r] = total
            left = max(left, abs(total))
        if left <= 1e-16 * largest:
            break
    return left / largest if largest > 0.0 else 0.0


@inlined
def add_forces(buffer: GroupBuffer, count: int, target: FloatArray, first: int) -> None:
    """Change velocities, accelerations or places (m, …), from a column on, by the solution."""
    for r in range(count):
        force = buffer.vectors[SOLUTION, r]
        for side in range(2):
            place = buffer.owners[r, side]
            if place >= 0:
                column = buffer.columns[r]
                target[place, first] -= force * buffer.inverse[place, 0] * column[3 * side]
                target[place, first + 1] -= force * buffer.inverse[place, 0] * column[3 * side + 1]
                target[place, first + 2] -= force * buffer.inverse[place, 1] * column[3 * side + 2]


@inlined
def right_hand_side(buffer: GroupBuffer, modes: IntArray) -> None:
    """What the forces have to bring to nothing: gap″ and u′ without them."""
    number = 0
    for c in range(modes.shape[0]):
        if modes[c] == APART:
            continue
        contact = buffer.kinematics[c]
        accel = contact[CURVATURE] * contact[ALONG]
        buffer.vectors[RIGHT, number] = (
            times_row(buffer, number, buffer.own, 0) - accel * contact[ALONG]
        )
        number += 1
        if modes[c] == STICKS and contact[GRIP] > 0.0:
            buffer.vectors[RIGHT, number] = (
                times_row(buffer, number, buffer.own, 0) + accel * contact[APPROACH]
            )
            number += 1
    for tie in range(buffer.number[0]):
        right = times_row(buffer, number, buffer.own, 0) - buffer.strays[tie, 2]
        buffer.vectors[RIGHT, number] = right
        number += 1


@inner
def push_and_move(buffer: GroupBuffer, modes: IntArray, members: int) -> float:
    """Forces of the contacts in ``pushes``, accelerations in ``rates``; what was left over."""
    count, left = constrain(buffer, modes, True, True), 0.0
    if count > 0:
        right_hand_side(buffer, modes)
        left = solve(buffer, count)
    number = 0
    for c in range(modes.shape[0]):
        buffer.pushes[c, 0] = buffer.pushes[c, 1] = 0.0
        if modes[c] == APART:
            continue
        force, grip = buffer.vectors[SOLUTION, number], buffer.kinematics[c, GRIP]
        number += 1
        buffer.pushes[c, 0] = force
        if modes[c] != STICKS:
            across, rim = slide_shares(grip, modes[c])
            buffer.pushes[c, 0], buffer.pushes[c, 1] = across * force, rim * force
        elif grip > 0.0:
            buffer.pushes[c, 1] = buffer.vectors[SOLUTION, number]
            number += 1
    for tie in range(buffer.number[0]):
        buffer.tautness[tie] = buffer.vectors[SOLUTION, number + tie]
    for place in range(members):
        for i in range(3):
            buffer.rates[place, i] = buffer.own[place, i]
    add_forces(buffer, count, buffer.rates, 0)
    return left


@inlined
def leads(buffer: GroupBuffer, c: int) -> tuple[float, float, float, float]:
    """Of a contact: gap″, u′, and how much a unit of λ and of τ changes them."""
    contact = buffer.kinematics[c]
    across, along, soft, rolls = 0.0, 0.0, 0.0, 0.0
    for side in range(2):
        place = buffer.pairs[c, side]
        if place < 0:
            continue
        sign, arm = 1.0 - 2.0 * side, contact[ARM + side]
        ax, ay, aw = buffer.rates[place, 0], buffer.rates[place, 1], buffer.rates[place, 2]
        across += sign * (ax * contact[NX] + ay * contact[NY])
        along += sign * (ay * contact[NX] - ax * contact[NY]) + arm * aw
        soft += buffer.inverse[place, 0]
        rolls += buffer.inverse[place, 0] + arm * arm * buffer.inverse[place, 1]
    accel = contact[CURVATURE] * contact[ALONG]
    return accel * contact[ALONG] - across, along + accel * contact[APPROACH], soft, rolls


@inlined
def finite(buffer: GroupBuffer, members: int) -> bool:
    """Whether all accelerations are numbers."""
    total = 0.0
    for place in range(members):
        for i in range(3):
            total += abs(buffer.rates[place, i])
    return math.isfinite(total)
