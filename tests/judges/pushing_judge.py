"""Discs in sustained contact by other means: DOP853, friction by scipy, multipliers by numpy.

Flat discs (δ = 0) under uniform pressure on a level or tilted floor.  A constraint is a row of a
Jacobian J(q), its rate of change is taken by a complex step; accelerations and multipliers come
from one linear system.
"""

from __future__ import annotations

import math

import numpy as np
from reference import friction
from scipy.integrate import solve_ivp


class Judge:
    """One phase of a motion: who touches whom, and how the rims slip.

    ``discs``: rows radius, mass, inertia, f g, damping, spin damping, wake; ``contacts``: tuples of
    a disc, its partner (a disc, or ("wall", nx, ny, place), ("post", x, y, radius), ("arc", x, y,
    radius)), μ and the rim: −1 or 1 (it slides, the slip having that sign), 0 (it sticks), None
    (smooth); ``given``: of a disc whose motion is given, t → (q, q′, q″).
    """

    def __init__(self, discs, contacts, pull=(0.0, 0.0), given=None):
        self.discs, self.contacts = np.array(discs, float), contacts
        self.pull, self.given = np.array(pull), given or {}
        self.free = [i for i in range(len(discs)) if i not in self.given]

    def rows(self, q):
        """Rows: of gap′ and of the slip of the rims, for each contact."""
        out = []
        for i, other, _, _ in self.contacts:
            across, along = np.zeros_like(q), np.zeros_like(q)
            p, radius = q[3 * i : 3 * i + 2], self.discs[i, 0]
            if isinstance(other, tuple) and other[0] == "wall":
                n = -np.array(other[1:3])
            else:
                centre = (
                    np.array(other[1:3])
                    if isinstance(other, tuple)
                    else q[3 * other : 3 * other + 2]
                )
                d = centre - p
                n = d / np.sqrt(d[0] * d[0] + d[1] * d[1])
                if isinstance(other, tuple) and other[0] == "arc":
                    n = -n
            t = np.array([-n[1], n[0]])
            across[3 * i : 3 * i + 2], along[3 * i : 3 * i + 2], along[3 * i + 2] = -n, t, radius
            if not isinstance(other, tuple):
                across[3 * other : 3 * other + 2], along[3 * other : 3 * other + 2] = n, -t
                along[3 * other + 2] = self.discs[other, 0]
            out.append((across, along))
        return out

    def forces(self, v):
        """All but those of contacts."""
        out = np.zeros(len(v))
        for i in self.free:
            radius, mass, inertia, decel, damping, spin_damping, wake = self.discs[i]
            vx, vy, w = v[3 * i : 3 * i + 3]
            fx, fy, turn = friction(vx, vy, radius * w, 0.0)
            drag = damping + wake * math.hypot(vx, vy)
            out[3 * i] = mass * (decel * fx + self.pull[0] - drag * vx)
            out[3 * i + 1] = mass * (decel * fy + self.pull[1] - drag * vy)
            out[3 * i + 2] = 0.5 * mass * decel * radius * turn - inertia * spin_damping * w
        return out

    def solved(self, t, q, v):
        """Accelerations, (λ, τ) of the contacts, slips of their rims."""
        size = len(q)
        step = 1e-30
        rows, moved = self.rows(q), self.rows(q + 1j * step * v)
        mass = np.ones(size)
        for i in self.free:
            mass[3 * i : 3 * i + 3] = self.discs[i, [1, 1, 2]]
        constraints, columns = [], []
        for c, (_, _, grip, rim) in enumerate(self.contacts):
            across, along = rows[c]
            constraints.append((across, moved[c][0].imag / step))
            columns.append(across - (rim * grip * along if rim else 0.0))
            if rim == 0:
                constraints.append((along, moved[c][1].imag / step))
                columns.append(-along)
        k = len(columns)
        known = np.zeros(size)
        free = [3 * i + j for i in self.free for j in range(3)]
        for i, path in self.given.items():
            known[3 * i : 3 * i + 3] = path(t)[2]
        n = len(free)
        matrix, right = np.zeros((n + k, n + k)), np.zeros(n + k)
        matrix[:n, :n] = np.diag(mass[free])
        right[:n] = self.forces(v)[free]
        for c in range(k):
            matrix[:n, n + c] = -columns[c][free]
            matrix[n + c, :n] = constraints[c][0][free]
            right[n + c] = -constraints[c][0] @ known - constraints[c][1] @ v
        answer = np.linalg.lstsq(matrix, right, rcond=1e-13)[0]
        known[free] = answer[:n]
        pushes, number = [], n
        for _, _, grip, rim in self.contacts:
            push = answer[number]
            number += 1
            along = grip * rim * push if rim else 0.0
            if rim == 0:
                along = answer[number]
                number += 1
            pushes.append((push, along))
        return known, np.array(pushes), np.array([along.real @ v for _, along in rows])

    def _full(self, t, y):
        half = len(y) // 2
        q, v = y[:half].copy(), y[half:].copy()
        for i, path in self.given.items():
            q[3 * i : 3 * i + 3], v[3 * i : 3 * i + 3] = path(t)[:2]
        return q, v

    def run(self, states, t, t_end, until=None, tol=1e-12):
        """States (n, 6) at the end, the time, and whether ``until`` (t, q, v, judge) reached 0."""
        q, v = np.array(states)[:, :3].ravel(), np.array(states)[:, 3:].ravel()

        def rates(t, y):
            q, v = self._full(t, y)
            return np.concatenate([v, self.solved(t, q, v)[0]])

        events = None
        if until is not None:
            events = lambda t, y: until(self, t, *self._full(t, y))  # noqa: E731
            events.terminal = True
        scale = np.abs(v).max() or 1.0
        run = solve_ivp(
            rates, (t, t_end), np.concatenate([q, v]), "DOP853", rtol=tol, atol=tol * scale,
            events=events,
        )  # fmt: skip
        q, v = self._full(run.t[-1], run.y[:, -1])
        states = np.hstack([q.reshape(-1, 3), v.reshape(-1, 3)])
        return states, run.t[-1], run.status == 1
