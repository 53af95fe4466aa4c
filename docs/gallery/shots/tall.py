"""
A tall puck lifts
=================

Friction pulls at the base while the weight acts at the centre, so the pressure is larger in
front. Of a tall puck, δ = 2fh/r above 1, the rear lifts off the floor while it slides fast: the
dashed line tells how much of the base is loaded.
"""

import matplotlib.pyplot as plt
import numpy as np

import puck_tables as pt

run = pt.Puck.similar(delta=3.0).simulate((1.0, 0.0), spin=1.0)
phi = np.clip(run.slip_angle, 1e-6, np.pi / 2 - 1e-6)
figure, axes = plt.subplots(layout="constrained")
axes.plot(run.time, run.speed, label="speed v / m/s")
axes.plot(run.time, run.spin, label="r ω / m/s")
share = pt.contact.loaded_share(phi, 3.0)
axes.plot(run.time[:-1], share[:-1], "k--", label="loaded share of the base")
axes.set(xlabel="time / s", title="A puck of δ = 3")
axes.legend()
