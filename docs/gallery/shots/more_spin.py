"""
Spin carries
============

The same speed with more and more spin: a spinning puck feels less friction along its way, so it
goes farther. The stops lie almost on a straight line.
"""

import matplotlib.pyplot as plt
import numpy as np

import puck_tables as pt

puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.1)
figure, axes = plt.subplots(layout="constrained")
for spin in np.linspace(0.0, 150.0, 7):
    run = puck.simulate((1.0, 0.0), spin)
    axes.plot(run.x, run.y, label=f"{spin:.0f} rad/s")
    axes.plot(run.x[-1], run.y[-1], "ko", markersize=4)
axes.set(xlabel="x / m", ylabel="y / m", title="Paths of 1 m/s, up to their stops")
axes.legend(title="spin")
