"""
The slip under a puck
=====================

Each point of the base slips about the instantaneous centre of rotation, v/ω to the left of the
motion for ω > 0. Friction acts against the slip, wherever it points, with the same size. That
couples the two motions: where the spin turns the slip sideways, less of the friction is left to
brake the slide.
"""

import matplotlib.pyplot as plt
import numpy as np

v, spin, r = 1.0, 2.0, 1.0
x, y = np.meshgrid(np.arange(-0.9, 1.0, 0.18), np.arange(-0.9, 1.0, 0.18))
x, y = x[np.hypot(x, y) < r], y[np.hypot(x, y) < r]
vx, vy = v - spin * y, spin * x
size = np.hypot(vx, vy)
figure, axes = plt.subplots(layout="constrained")
axes.add_patch(plt.Circle((0, 0), r, fill=False, linewidth=2))
axes.quiver(x, y, -vx / size, -vy / size, color="tab:red", width=0.004, label="friction")
axes.quiver(0, 0, v, 0, color="tab:blue", scale=4, width=0.012, label="velocity v")
axes.plot(0, v / spin, "ko", label="centre of rotation, v/ω away")
axes.set(aspect="equal", xlim=(-1.5, 1.5), ylim=(-1.2, 1.2), xlabel="x / r", ylabel="y / r",
         title=f"φ = atan2(rω, v) = {np.degrees(np.arctan2(r * spin, v)):.0f}°")  # fmt: skip
figure.legend(loc="outside lower center", ncols=3)
