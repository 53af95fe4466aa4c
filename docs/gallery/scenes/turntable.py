"""
A turntable throws it off
=========================

The table turns at 5 rad/s; friction can carry the puck only near the centre, so it spirals out.
"""

import puck_tables as pt

run = pt.Scene.load("turntable").simulate()
print(run)
figure = run.plot()
