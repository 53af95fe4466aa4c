"""
A curling stone, with its curl put in by hand
=============================================

Friction over the slip speed and a force across the motion with the numbers of a simulator of
curling (FCV1 of Digital Curling). Friction alone, by whatever law over the slip speed, bends the
path by far less: the lateral force is empirical, no dry friction over the contact explains it.
"""

import matplotlib.pyplot as plt

import puck_tables as pt

stone = pt.Puck(radius=0.0625, height=0.11, mass=19.96)
ice = pt.Floor(law=pt.CurlingLaw(a=0.00200985, b=0.06385782, c=0.00626286))
curl = pt.Lateral(strength=0.0082 * 19.96, speed_exponent=0.2)
figure, axes = plt.subplots(layout="constrained")
for lateral, name in ((curl, "with the lateral force"), (pt.Lateral(), "friction alone")):
    shot = pt.Scene(stone, ice, pt.Launch((2.4, 0.0), 1.57), lateral=lateral, tol=1e-6)
    run = shot.simulate()
    axes.plot(run.x, run.y, label=f"{name}: {run.last['y']:.2g} m aside")
axes.set(xlabel="along the sheet / m", ylabel="across / m", title="Spin counter-clockwise")
axes.legend()
