"""What is where: the state of a free motion in natural units, and the state of a puck.

In natural units (:mod:`puck_tables.motion.equations_of_motion`) u = ln(r|ω|/v), heading ψ, time,
place, body angle θ, path length, work of friction.  Of a puck
(:mod:`puck_tables.motion.unit_motion`) place, heading, body angle, speed and spin.
"""

from __future__ import annotations

SIZE = 8  # numbers of a state
U, PSI, T, X, Y, THETA, LENGTH, WORK = range(SIZE)

STATE_ROWS = 6  # numbers of a state of a puck
PUCK_X, PUCK_Y, HEADING, ORIENTATION, SPEED, SPIN = range(STATE_ROWS)
