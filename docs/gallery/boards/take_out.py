"""
Where a thousand take-outs end
==============================

A curling stone let go a little differently each time: where do the two stones come to rest?
"""

import matplotlib.pyplot as plt
import numpy as np

import puck_tables as pt

errors = np.random.default_rng(1).normal(size=(2, 1000)) * [[0.02], [0.002]]
velocities = np.array([3.1, 0.012]) + errors.T
ends = []
scene = pt.Scene.load("curling-take-out")
for vx, vy in velocities:
    world = scene.world()
    world.strike("red", velocity=(vx, vy), spin=-1.6)
    ends.append(world.at(60.0)[:2, :2])
ends = np.array(ends)
figure, axes = plt.subplots(layout="constrained")
axes.plot(*ends[:, 0].T, ".", color="firebrick", markersize=3, label="red, which was played")
axes.plot(*ends[:, 1].T, ".", color="darkgoldenrod", markersize=3, label="yellow, which was hit")
axes.set(aspect="equal", xlabel="x / m", ylabel="y / m", title="Ends of 1000 deliveries")
figure.legend(loc="outside lower center")
