"""
A skate blade
=============

A blade lets the disc slide along itself only, and turns with it: the path is what the spin draws.
"""

import puck_tables as pt

run = pt.Scene.load("skate-blade").simulate()
print(run)
figure = run.plot()
