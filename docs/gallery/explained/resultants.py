"""
Three numbers are the friction
==============================

Summed over the base, friction along the motion, across it and about the axis are three functions
of the slip angle φ = atan2(rω, v) and of the height δ = 2fh/r. At φ = π/4 the centre of rotation
crosses the rim.
"""

import matplotlib.pyplot as plt
import numpy as np

import puck_tables as pt

phi = np.linspace(0.0, np.pi / 2, 401)
figure, all_axes = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
for delta in (0.0, 0.5, 1.0):
    rho = pt.resultants(phi, delta)
    for axes, values in zip(all_axes, (rho.parallel, rho.perpendicular, rho.spin), strict=True):
        axes.plot(np.degrees(phi), values, label=f"δ = {delta:g}")
for axes, name in zip(all_axes, ("ρ∥: along", "ρ⊥: across", "ρω: torque"), strict=True):
    axes.set(xlabel="φ / °", title=name, xticks=[0, 45, 90])
all_axes[0].legend()
