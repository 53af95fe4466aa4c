"""
The break of carrom
===================

Nineteen men and a striker: 51 impacts, each found as a root between two curves.
"""

import puck_tables as pt

run = pt.Scene.load("carrom-break").simulate()
print(run)
figure = run.plot()
