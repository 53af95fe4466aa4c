"""
On brushed metal
================

Friction that is larger across the grain than along it, by the elliptic law: paths turn towards the
grain, with spin and without, and no look-up serves them, for the symmetry is gone.
"""

import matplotlib.pyplot as plt
import numpy as np

import puck_tables as pt

puck = pt.Puck(radius=0.04, height=0.02, mass=0.2)
metal = pt.Floor(orthotropic=pt.Orthotropic(friction=(0.15, 0.3)))  # along x, along y
figure, axes = plt.subplots(layout="constrained")
for heading in np.radians([15.0, 45.0, 75.0]):
    launch = 1.2 * np.array([np.cos(heading), np.sin(heading)])
    for spin, style in ((0.0, "--"), (60.0, "-")):
        run = pt.Scene(puck, metal, pt.Launch(launch, spin)).simulate()
        axes.plot(run.x, run.y, style, color=plt.cm.plasma(heading / 2.2))
axes.set(xlabel="along the grain / m", ylabel="across / m", aspect="equal")
axes.set_title("f = 0.15 along, 0.3 across; solid: with spin")
