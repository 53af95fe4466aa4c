"""
Friction that you measured
==========================

A coefficient that falls with the slip speed, from a few measured points: the table of its
resultants is built once, in seconds, and kept.
"""

import matplotlib.pyplot as plt

import puck_tables as pt

points = [[0.0, 0.30], [0.3, 0.22], [1.0, 0.18], [4.0, 0.17]]  # slip speed in m/s, f
puck = pt.Puck(radius=0.04, mass=0.2)
measured = pt.Scene(puck, pt.Floor(law=points), pt.Launch((1.5, 0.0), spin=40.0)).simulate()
constant = pt.Puck(radius=0.04, mass=0.2, friction=0.2).simulate((1.5, 0.0), spin=40.0)
figure, axes = plt.subplots(layout="constrained")
for run, name in ((measured, "f(u) as measured"), (constant, "f = 0.2")):
    axes.plot(run.time, run.speed, label=f"v, {name}")
    axes.plot(run.time, 0.04 * run.spin, "--", label=f"r ω, {name}")
axes.set(xlabel="time / s", ylabel="m/s", title="The same launch on two floors")
axes.legend()
