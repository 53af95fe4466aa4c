"""
An ice-hockey puck
==================

Two metres a second and some five turns a second: it bends to the right, and sliding and spinning
end at the same moment.
"""

import puck_tables as pt

puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.1, mass=0.17)
run = puck.simulate((2.0, 0.0), spin=30.0)
print(run)
figure = run.plot()
