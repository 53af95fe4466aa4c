"""
Why the last centimetre never looks like 0.653
==============================================

The papers' ratio ε = v/(rω) tends to 0.653 for a flat uniform puck, whatever the launch. But
slowly: where a camera or an engine stops to look, at a hundredth of the launch's slip speed, it
is still off. At a threshold of finite speed 0.67 is no error.
"""

import matplotlib.pyplot as plt
import numpy as np

import puck_tables as pt

puck = pt.Puck.similar(delta=0.0)
figure, axes = plt.subplots(layout="constrained")
for spin in (0.3, 0.8, 1.2, 3.0, 10.0):
    run = puck.simulate((1.0, 0.0), spin)
    states = run(run.stop_time * (1.0 - np.geomspace(1.0, 1e-6, 300)))
    axes.semilogx(states.slip_speed / states.slip_speed[0], states.speed / states.spin)
axes.axhline(1.0 / pt.motion.limit_ratio(0.0), color="black", linestyle="--")
axes.invert_xaxis()
axes.set(ylim=(0, 3.5), xlabel="Q over that of the launch", ylabel="ε = v/(rω)",
         title="The ratio, on its way to the stop")  # fmt: skip
