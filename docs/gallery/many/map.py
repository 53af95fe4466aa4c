"""
A map of stops
==============

Where and when pucks stop, over speed and spin: 8181 launches, looked up in a fraction of a
millisecond.
"""

import numpy as np

import puck_tables as pt

puck = pt.Puck.similar(delta=0.5)
stops = puck.sweep(spin=np.linspace(-4, 4, 81), speed=np.linspace(0, 2, 101))
print(stops)
figure = stops.plot()
