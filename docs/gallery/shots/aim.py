"""
Every launch to a target
========================

Which launches of at most 1.9 m/s and 6 rad/s come to rest at (2, 0.1) m? A whole curve of them
for each sense of spin.
"""

import puck_tables as pt

found = pt.Puck.similar(delta=0.5).aim((2.0, 0.1), max_speed=1.9, max_spin=6.0)
print(found)
figure = found.plot()
