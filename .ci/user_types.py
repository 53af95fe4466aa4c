"""What a user's type checker sees of the installed package; run by .ci/run, never executed."""

from typing import assert_type

import numpy as np

import puck_tables as pt

puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.1)
run = puck.simulate((2.0, 0.0), spin=30.0)
assert_type(run, pt.Trajectory)
assert_type(run.stop_time, float)
assert_type(puck.stop([[1.0, 0.0]], np.ones(1)), pt.Stops)
assert_type(pt.Table.shipped(), pt.Table)
assert_type(pt.Scene.load("incline"), pt.Scene)
assert_type(puck.aim((1.0, 0.0)), pt.Aim)
