"""
From a film to friction
=======================

A film of 200 frames with 0.3 mm of noise tells the friction of a puck to a part in a thousand.
"""

import numpy as np

import puck_tables as pt

t = np.arange(200) / 120.0
truth = pt.Puck(radius=0.0381, height=0.0254, friction=0.15).states((2.0, 0.3), 60.0, t)
noise = np.random.default_rng(1).normal(size=(200, 3)) * [3e-4, 3e-4, 5e-3]
place = np.stack([truth.x, truth.y], axis=1) + noise[:, :2]
film = pt.Track(t, place, truth.orientation + noise[:, 2], "film")
found = pt.fit(film, pt.Puck(radius=0.0381))
print(f"f = {found['friction'].value:.5f} +- {found['friction'].error:.5f}")
figure = found.plot()
