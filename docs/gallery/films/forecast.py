"""
What a film would tell
======================

Before the camera is bought: the errors of friction and of the tilt that a film could give at
best, over speed and spin.
"""

import puck_tables as pt

puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.15)
camera = pt.Camera(fps=120.0, place_noise=0.3e-3, angle_noise=5e-3)
forecast = pt.fisher(puck, pt.Launch((2.0, 0.0), spin=60.0), camera)
print(forecast)
figure = forecast.plot()
