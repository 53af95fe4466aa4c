"""
Sliding and spinning stop together
==================================

Whatever the launch, v and ω vanish at the same moment. A puck that slides more than it spins
loses its slide faster, and the other way round, until the two are in balance.
"""

import matplotlib.pyplot as plt

import puck_tables as pt

puck = pt.Puck.similar(delta=0.0)
figure, axes = plt.subplots(layout="constrained")
for spin in (0.2, 0.5, 1.0, 2.0, 4.0):
    run = puck.simulate((1.0, 0.0), spin)
    axes.plot(run.speed, run.spin, label=f"r ω₀ = {spin:g} m/s")
axes.plot([0, 0.8], [0, 0.8 * pt.motion.limit_ratio(0.0)], "k--", label="limit")
axes.set(xlim=(0, 1.02), ylim=(0, 4.1), xlabel="v / m/s", ylabel="r ω / m/s",
         title="All motions end along one line")  # fmt: skip
axes.legend()
