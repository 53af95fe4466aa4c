"""
Newton's row
============

Five pucks that touch pass an impact on, and the last one goes.
"""

import puck_tables as pt

run = pt.Scene.load("newtons-row").simulate()
print(run.impacts, "impacts")
figure = run.plot()
