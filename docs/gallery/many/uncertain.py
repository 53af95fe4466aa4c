"""
Errors of a launch, at its stop
===============================

A launch is never known exactly. Its covariance goes through the exact derivatives of the stop; a
thousand samples beside it tell whether the linear answer may be trusted.
"""

import matplotlib.pyplot as plt
import numpy as np

import puck_tables as pt

rng = np.random.default_rng(1)
errors = np.diag([0.02, 0.02, 0.2]) ** 2  # of vx, vy, spin
launches = rng.multivariate_normal([1.0, 0.0, 3.0], errors, 1000)
ends = pt.stop(launches[:, :2], launches[:, 2]).stop_position
linear = pt.stop((1.0, 0.0), 3.0, jacobian=True)
rows = [linear.derivative(f"stop_{c}", n) for c in "xy" for n in ("vx", "vy", "spin")]
slope = np.array(rows).reshape(2, 3)
value, vectors = np.linalg.eigh(slope @ errors @ slope.T)
turn = np.linspace(0, 2 * np.pi, 100)
circle = np.sqrt(value)[:, None] * [np.cos(turn), np.sin(turn)]
ring = linear.stop_position[:, None] + 2 * vectors @ circle
figure, axes = plt.subplots(layout="constrained")
axes.plot(*ends.T, ".", markersize=3)
axes.plot(*ring, "k", label="two standard deviations, by derivatives")
axes.set(aspect="equal", xlabel="x / m", ylabel="y / m", title="Stops of 1000 launches")
axes.legend()
