"""
A washer on a conveyor
======================

Dropped spinning on a belt, a washer is taken along. Friction follows its slip over the belt, not
its speed in the room.
"""

import puck_tables as pt

run = pt.Scene.load("washer-on-conveyor").simulate()
print(run)
figure = run.plot()
