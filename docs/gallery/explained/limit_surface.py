"""
What a pushed puck takes
========================

Force and torque at which a puck slips, the limit surface of planar pushing: its section through
the torque axis, beside the ellipsoid and the quartic that planners put in its place.
"""

import puck_tables as pt

puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.1, mass=0.17)
surface = puck.limit_surface()
print(surface.explain())
hold = puck.holds((0.1, 0.05), torque=0.002)
print(f"(0.1, 0.05) N and 2 mN m may grow {float(hold.margin):.2f} times before the puck slips")
figure = surface.plot()
