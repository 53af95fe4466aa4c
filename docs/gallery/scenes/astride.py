"""
Astride a wet spot
==================

A puck slides over the edge of a wet spot: each part of its base feels the friction under it, so
that even without spin at first it is turned, and leaves the spot with a spin.
"""

import puck_tables as pt

puck = pt.Puck(radius=0.04, height=0.02, friction=0.3, mass=0.2)
floor = pt.Floor(patches=[pt.Patch(0.05, (0.3, 0.06), 0.1)])
run = pt.Scene(puck, floor, pt.Launch((1.6, 0.0)), title="Astride a wet spot").simulate()
for event in run.events:
    print(event)
figure = run.plot()
