"""
A curling stone, with its curl put in by hand
=============================================

Friction over the slip speed and a force across the motion with the numbers of a simulator of
curling (FCV1 of Digital Curling). Friction alone, by whatever law over the slip speed, bends the
path by far less: the lateral force is empirical, no dry friction over the contact explains it.
"""

from dataclasses import replace

import matplotlib.pyplot as plt

import puck_tables as pt

draw = pt.Scene.load("curling-draw")
figure, axes = plt.subplots(layout="constrained")
straight = pt.Launch((2.4, 0.0), spin=1.57)
for lateral, name in ((draw.lateral, "with the lateral force"), (pt.Lateral(), "friction alone")):
    run = replace(draw, launch=straight, lateral=lateral, lines=()).simulate()
    axes.plot(run.x, run.y, label=f"{name}: {run.last['y']:.2g} m aside")
axes.set(xlabel="along the sheet / m", ylabel="across / m", title="Spin counter-clockwise")
axes.legend()
