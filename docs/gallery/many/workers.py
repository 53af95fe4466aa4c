"""
A sweep on a cluster
====================

A map of 250 000 stops, done by two workers that start on this machine and kept in a store. For the
machines of a cluster give the address of its scheduler, ``cluster="tcp://HOST:8786"``, and a store
in a folder that all of them share; nothing else changes, and not a bit of the numbers.
"""

import tempfile

import numpy as np

import puck_tables as pt

if __name__ == "__main__":  # the workers read this script too, and shall start none of their own
    puck = pt.Puck(radius=0.0381, height=0.0254, friction=0.1)
    speed, spin = np.linspace(0, 2, 500), np.linspace(-60, 60, 500)
    with tempfile.TemporaryDirectory() as folder:
        kept = puck.sweep(spin, speed, store=f"{folder}/map.zarr", cluster="local:2")
        stops = kept.load()
    print(stops)
    figure = stops.plot()
