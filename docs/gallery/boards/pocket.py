"""
Into the hole of crokinole
==========================

All launches of the shot that end in the hole, also off posts and other discs; the one that
forgives most is drawn.
"""

import puck_tables as pt

shots = pt.Scene.load("crokinole").aim(puck="shot", pocket=0, max_speed=2.0)
print(len(shots.sequences), "found;", shots.sequences[0])
figure = shots.plot()
