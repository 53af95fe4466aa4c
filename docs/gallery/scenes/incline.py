"""
A slope that holds until it spins
=================================

A slope of a tenth holds this puck (f = 0.15) at rest. A spin takes friction from the slide, so a
spinning puck glides down until its spin is gone, and then stays.
"""

import numpy as np

import puck_tables as pt

puck = pt.Puck(radius=0.04, height=0.02, friction=0.15, mass=0.2)
slope = pt.Floor(slope=0.1, downhill=-np.pi / 2)
run = pt.Scene(puck, slope, pt.Launch((0.8, 0.5), spin=60.0)).simulate()
print(run)
figure = run.plot()
