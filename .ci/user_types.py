"""What a user's type checker sees of the installed package; run by .ci/run, never executed."""

from typing import assert_type

import numpy as np

import puck_tables as pt

puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.1)
run = puck.simulate((2.0, 0.0), spin=30.0)
assert_type(run, pt.results.Trajectory)
assert_type(run.stop_time, float)
assert_type(puck.stop([[1.0, 0.0]], np.ones(1)), pt.results.Stops)
assert_type(pt.Table.shipped(), pt.Table)
assert_type(puck.regime((2.0, 0.0), 30.0), str)
assert_type(puck.states((2.0, 0.0), 30.0, 0.1), pt.results.States)
assert isinstance(puck.limit_surface(), pt.results.LimitSurface)
assert_type(puck.holds((0.1, 0.0)), pt.results.Hold)
assert_type(puck.sweep([0.0, 1.0], 1.0), pt.results.StopMap)
assert_type(puck.sample(10, 1, spin=pt.Normal(5.0, 0.1)), pt.results.StopSample)
assert_type(pt.Puck.similar(delta=0.5), pt.Puck)
scene = pt.Scene.load("incline")
assert_type(scene, pt.Scene)
assert_type(scene.puck, pt.Puck)
assert_type(scene.pucks, tuple[pt.Puck, ...])
assert_type(scene.at({"launch.spin": 1.0}).single(), pt.Scene)
assert_type(scene.simulate(), pt.results.Run)
assert_type(scene.sweep(), pt.results.Map)
assert_type(scene.world(), pt.World)
assert_type(pt.Puck(0.1).stop((1.0, 0.0)), pt.results.Stops)
assert_type(puck.aim((1.0, 0.0)), pt.results.Aim)
