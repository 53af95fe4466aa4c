"""
A map as labelled arrays
========================

Every result turns into an xarray Dataset, with units; from there on it is one line to what you
ask.
"""

import numpy as np

import puck_tables as pt

stops = pt.Puck.similar().sweep(
    spin=np.linspace(0, 10, 51), speed=np.linspace(0.2, 2, 31), delta=[0.0, 0.5, 1.0]
)
data = stops.to_xarray()
aside = data.stop_y.sel(launch_speed=1.0, method="nearest")
print(data.stop_y.attrs)
figure = aside.plot.line(x="launch_spin")[0].figure
