"""
Air hockey
==========

Cushions with restitution and rough rims: each rebound trades spin for speed along the cushion.
"""

import puck_tables as pt

run = pt.Scene.load("air-hockey").simulate()
print(run)
figure = run.plot()
