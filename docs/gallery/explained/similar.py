"""
One curve for all motions
=========================

The equations keep their form when speeds and times are scaled and the plane is turned or
mirrored. So stop time and place of a puck are three functions of φ, in units of Q/(fg) and Q²/(fg):
these are looked up, and nothing is integrated.
"""

import matplotlib.pyplot as plt
import numpy as np

import puck_tables as pt

phi = np.linspace(0.0, np.pi / 2, 301)
figure, axes = plt.subplots(layout="constrained")
for delta, style in ((0.0, "-"), (1.0, "--")):
    stops = pt.stop(np.stack([np.cos(phi), 0 * phi], axis=1), np.sin(phi), delta=delta)
    degrees, place = np.degrees(phi), stops.stop_position
    axes.plot(degrees, stops.stop_time, f"C0{style}", label=f"time T, δ = {delta:g}")
    axes.plot(degrees, place[:, 0], f"C1{style}", label="ahead X")
    axes.plot(degrees, place[:, 1], f"C2{style}", label="aside Y")
axes.set(xlabel="φ of the launch / °", title="Stops of Q = 1, fg = 1", xticks=[0, 45, 90])
axes.legend()
