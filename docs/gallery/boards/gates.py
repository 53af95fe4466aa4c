"""
Through a gate
==============

Sjoelen, the Dutch shuffleboard: one closed wall goes around the board, its gate bar and partitions.
"""

import puck_tables as pt

run = pt.Scene.load("sjoelen").simulate()
print(run)
figure = run.plot()
