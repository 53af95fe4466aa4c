"""Claims about the paths of the centre: similar ones, different ones, and where they end."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from paper.claim import Claim, equal, farthest, more
from paper.runs import Simulate, curvature_radius, launch, simulate
from puck_tables._core.arrays import FloatArray
from puck_tables.contact.closed_form import by_closed_form
from puck_tables.motion.limits import curvature_slope, limit_ratio
from puck_tables.trajectory import Trajectory

Complex = npt.NDArray[np.complex128]

DELTA = 1.0
SPIN = np.linspace(0.0, 10.0, 41)


def claims(run: Simulate = simulate) -> list[Claim]:
    """All claims of this file, for the program's motions or others put to the test."""
    return [*similar_paths(run), *five_shapes(run), *nearly_straight_lines(run)]


def to_stop(run: Trajectory) -> Complex:
    """The way from each state to the stop, x + iy."""
    return np.asarray(complex(*run.stop_position) - (run.x + 1j * run.y))


def similar_paths(run: Simulate) -> list[Claim]:
    """Proposition 8: paths of one type are similar; those of type D congruent.

    A motion, halfway to its stop, and another one launched there in its own way (with the same
    rω/v, but smaller, mirrored and turned; type D: with the same Q) must go on along one path up to
    scale, rotation and reflection, which the first point fixes.
    """
    found = []
    shares = np.linspace(1.0, 0.0, 51)
    limit = float(limit_ratio(DELTA))
    for name, ratio in (("B", 8.0), ("C", 0.1), ("D", limit)):
        one = launch(run, -ratio, DELTA, speed=2.0, heading=0.7, shares=0.5 * shares)
        q = float(one.slip_speed[0]) if name == "D" else 1.0
        other = launch(run, -float(np.tan(one.slip_angle[0])), DELTA, speed=q, shares=shares)
        way, image = to_stop(other), to_stop(one).conj()  # mirrored: the spins are opposite
        scale = way[0] / image[0]
        off = float(np.abs(scale * image - way).max() / abs(way[0]))
        if name == "D":
            off = max(off, abs(abs(scale) - 1.0))
        kind = "congruent" if name == "D" else "similar"
        found.append(
            equal(
                "Prop. 8", f"paths of type {name} are {kind} (largest misfit/size)", 0.0, off, 1e-10
            )
        )
    return found


def bend(run: Simulate, ratio: float) -> float:
    """s/R of a motion at its launch: path to the stop over radius of curvature.

    A number that no similarity changes; along a path of type D it stays δ/Λ.
    """
    motion = launch(run, ratio, DELTA, shares=[1.0])
    across = by_closed_form(motion.slip_angle, DELTA).perpendicular
    return motion.path_length / float(curvature_radius(across, motion)[0])


def five_shapes(run: Simulate) -> list[Claim]:
    """Result 7: a point, a ray, a self-similar curve, and two others that are not."""
    limit = float(limit_ratio(DELTA))
    point = launch(run, math.inf, DELTA)
    ray = launch(run, 0.0, DELTA, heading=0.3)
    off_ray = np.abs(((ray.x + 1j * ray.y) * np.exp(-0.3j)).imag).max()
    spiral = launch(run, limit, DELTA, shares=np.logspace(0.0, -6.0, 13))
    # s from each state is a piece of the same curve: Q² s(1), tested by its own length
    along = [
        launch(run, limit, DELTA, speed=float(q), shares=[1.0]).path_length
        for q in spiral.slip_speed
    ]
    across = by_closed_form(spiral.slip_angle, DELTA).perpendicular
    constant = np.asarray(along) / curvature_radius(across, spiral)
    expected = DELTA / float(curvature_slope(DELTA))
    spins = [bend(run, ratio) for ratio in np.geomspace(1.001 * limit, 1e6, 40).tolist()]
    slides = [bend(run, ratio) for ratio in np.geomspace(1e-6, 0.999 * limit, 40).tolist()]
    return [
        equal("result 7", "type B0 is a point (path length)", 0.0, point.path_length, 1e-15),
        equal("result 7", "type C0 is a ray (largest distance from it)", 0.0, float(off_ray),
              1e-15),
        equal("result 7", "type D is self-similar: s/R = delta/Lambda throughout", expected,
              farthest(constant, expected), 1e-10, "constant"),
        more("result 7", "type B is another curve: s/R varies by", 0.0, max(spins) - min(spins)),
        more("result 7", "type C a third: its s/R falls below that of B by", 0.0,
             min(spins) - min(slides)),
    ]  # fmt: skip


def ends_against_spin(run: Simulate, delta: float) -> FloatArray:
    """Stop time, x and y of launches with v = (1, 0) and the spins of Fig. 4, shape (3, n)."""
    stops = [run((1.0, 0.0), float(w0), delta=delta, frames=1) for w0 in SPIN]
    return np.array([(r.stop_time, *r.stop_position) for r in stops]).T


def nearly_straight_lines(run: Simulate) -> list[Claim]:
    """Fig. 4: stop time and place grow nearly linearly with the spin.

    Measured by the largest distance from the straight line that fits best, over the range.
    """
    time, x, _ = ends_against_spin(run, DELTA)

    def off(values: FloatArray) -> float:
        line = np.polynomial.Polynomial.fit(SPIN, values, 1)
        return float(np.abs(values - line(SPIN)).max() / np.ptp(values))

    return [
        equal("Fig. 4", f"{name} nearly linear in w(0) from 0 to 10 (off/range)", 0.0, off(values),
              0.1, "linear")
        for name, values in (("t0", time), ("x0", x))
    ]  # fmt: skip
