"""
How the load is spread
======================

A ring, a washer, a uniform base and a rounded one (Hertz) under the same launch: the nearer to the
centre the load lies, the less it brakes the spin. The puck turns longer and bends more.
"""

import matplotlib.pyplot as plt

import puck_tables as pt

figure, axes = plt.subplots(layout="constrained")
for law in ("ring", "annulus:0.8", "uniform", "hertz"):
    puck = pt.Puck.similar(delta=0.5, pressure=law)
    run = puck.simulate((1.0, 0.0), spin=3.0)
    axes.plot(run.x, run.y, label=f"{law}: {run.stop_time:.3f} s")
    axes.plot(run.x[-1], run.y[-1], "ko", markersize=4)
axes.set(xlabel="x / m", ylabel="y / m", title="1 m/s, r ω = 3 m/s, δ = 0.5")
axes.legend()
