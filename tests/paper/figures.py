"""The figures of the paper, computed: the data of each as curves, ready to be drawn.

Figures 8 to 10 are surfaces over (φ, δ) there and families of curves here, which can be read off;
all is even and π-periodic in φ, so a quarter turn shows it.  Figures 5 and 6 are measurements
there, of pucks whose friction and launches are not given: here the same pucks in theory, with a
friction coefficient that is assumed, stopping after the time that was filmed.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from paper.friction import slip_angle_rate
from paper.panels import Panel, Picture, PlotLine
from paper.patch import HEIGHTS, PHI, pressure_reserve
from paper.runs import simulate
from paper.shapes import SPIN, ends_against_spin
from puck_tables._core.arrays import FloatArray
from puck_tables.contact.closed_form import by_closed_form, integrals
from puck_tables.motion.limits import limit_angle
from puck_tables.puck import Puck

FAMILY = (0.0, 0.25, 0.5, 0.75, 1.0)
QUARTER_TICKS = {
    0.0: "0", math.pi / 8: "π/8", math.pi / 4: "π/4", 3 * math.pi / 8: "3π/8", math.pi / 2: "π/2",
}  # fmt: skip
PHI_LABEL = "slip angle φ = arctan(rω/v)"

# Launches of Fig. 3: speed and spin.  Its one readable label is v = 10, ω = 1; the others fill the
# range of its axes, with types B and C both there.
LAUNCHES = ((10.0, 1.0), (10.0, 4.0), (10.0, 10.0), (5.0, 12.0), (5.0, 25.0))


def limit_angles() -> Picture:
    """Fig. 2: the limit angle φ₀ against δ.

    >>> limit_angles().panels[0].lines[0].y[[0, -1]].round(6).tolist()
    [0.992314, 0.975465]
    """
    curve = PlotLine(HEIGHTS, limit_angle(HEIGHTS))
    return Picture(
        "Slip angle at the stop of every puck that slides and spins (Fig. 2)",
        [Panel("height δ = 2fh/r", "limit angle φ₀ / rad", [curve])],
    )


def paths(delta: float = 1.0) -> Picture:
    """Fig. 3: paths of the centre, launched along x.

    >>> x = paths().panels[0].lines[-1].x  # v = 5, ω = 25: 25 times the path of v = 1, ω = 5
    >>> float((x[-1] / 25.0).round(6))
    2.257241
    """
    lines = []
    for speed, spin in LAUNCHES:
        run = Puck.similar(delta=delta).simulate((speed, 0.0), spin, exact=True, frames=400)
        lines.append(PlotLine(run.x, run.y, f"v = {speed:g}, ω = {spin:g} ({run.regime})"))
    return Picture(
        f"Paths of the centre: counter-clockwise spin bends them right (Fig. 3; δ = {delta:g})",
        [
            Panel(
                "x / r",
                "y / r  (stretched)",
                lines,
                "v in units of √(rJ), ω of √(J/r); type B: launched spin-rich, C: spin-poor",
            )
        ],
    )


def stops_against_spin(delta: float = 1.0) -> Picture:
    """Fig. 4: where and when a puck with v = (1, 0) stops, against its spin.

    >>> [round(float(curve.y[20]), 6) for curve in stops_against_spin().panels[0].lines]
    [4.000189, 2.257241, -0.308477]
    """
    labels = ("time $t_0$ / √(r/J)", "place $x_0$ / r", "place $y_0$ / r")
    lines = [
        PlotLine(SPIN, values, label)
        for label, values in zip(labels, ends_against_spin(simulate, delta), strict=True)
    ]
    return Picture(
        f"Stop of a puck launched with v = (1, 0)√(rJ) (Fig. 4; δ = {delta:g})",
        [Panel("launch spin ω(0) / √(J/r)", "at the stop (dimensionless)", lines)],
    )


def ratio_against_time(
    radius: float, height: float, friction: float, duration: float, frames: int = 400
) -> tuple[float, list[PlotLine]]:
    """ε = rω/v against time (s) of a real puck, for launches that all stop after ``duration``.

    Returns its δ and the curves, the last one the limit ratio.

    >>> delta, lines = ratio_against_time(0.03, 0.019, 0.2, 0.52)
    >>> round(delta, 6), round(float(lines[-1].y[0]), 6)
    (0.253333, 1.526615)
    """
    puck = Puck(radius, height, friction)
    lines = []
    for ratio in (6.0, 3.0, 0.75, 0.25):
        trial = puck.simulate((1.0, 0.0), ratio / radius, exact=True, frames=1)
        speed = duration / trial.stop_time  # times are proportional to speeds
        spin = ratio * speed / radius
        times = duration * (1.0 - np.linspace(1.0, 0.0, frames, endpoint=False) ** 2)
        run = puck.simulate((speed, 0.0), spin, exact=True, times=times)
        label = f"v = {speed:.2g} m/s, ω = {spin:.2g} rad/s"
        lines.append(PlotLine(run.time, radius * run.spin / run.speed, label))
    ends = np.array([0.0, duration])
    limit = puck.limit_ratio
    lines.append(PlotLine(ends, np.full(2, limit), f"limit {limit:.3f}", dashed=True))
    return puck.delta, lines


def steel_puck() -> Picture:
    """Fig. 5: ε(t) of the steel puck, 60 mm by 19 mm; (b) only up to 0.44 s.

    >>> len(steel_puck().panels)
    2
    """
    delta, lines = ratio_against_time(0.030, 0.019, 0.2, 0.52)
    early = [
        PlotLine(c.x[c.x <= 0.44], c.y[c.x <= 0.44], c.label) for c in lines[:-1]
    ] + [PlotLine(np.array([0.0, 0.44]), lines[-1].y, lines[-1].label, dashed=True)]  # fmt: skip
    label = "rω/v (ε of this paper)"
    return Picture(
        f"Steel puck, 60 mm × 19 mm, in theory (Fig. 5; f = 0.2 assumed: δ = {delta:.3f})",
        [
            Panel("time / s", label, lines, "(a) to the stop after 0.52 s"),
            Panel("time / s", label, early, "(b) up to 0.44 s"),
        ],
        height=3.6,
    )


def rubber_puck() -> Picture:
    """Fig. 6: ε(t) of the rubber puck, 74 mm by 25 mm.

    >>> float(rubber_puck().panels[0].lines[-1].x[-1])
    0.38
    """
    delta, lines = ratio_against_time(0.037, 0.025, 0.6, 0.38)
    return Picture(
        f"Rubber puck, 74 mm × 25 mm, in theory (Fig. 6; f = 0.6 assumed: δ = {delta:.3f})",
        [Panel("time / s", "rω/v (ε of this paper)", lines, "to the stop after 0.38 s")],
    )


def patch_integrals() -> Picture:
    """Fig. 7: the five integrals.

    >>> [float(curve.y[0].round(12)) for curve in patch_integrals().panels[0].lines]
    [1.0, 0.25, 0.0, 0.25, -0.25]
    """
    p = integrals(PHI)._asdict()
    lines = [PlotLine(PHI, values, f"$p_{name}$") for name, values in p.items()]
    return Picture(
        "The five integrals of the contact patch, uniform pressure (Fig. 7)",
        [Panel(PHI_LABEL, "dimensionless", lines, x_ticks=QUARTER_TICKS)],
    )


def family(function: Callable[[float], FloatArray]) -> list[PlotLine]:
    """A function of φ at five heights, light to dark.

    >>> [curve.label for curve in family(lambda delta: 0.0 * PHI)][:2]
    ['δ = 0', 'δ = 0.25']
    """
    return [PlotLine(PHI, function(delta), f"δ = {delta:g}", shade=delta) for delta in FAMILY]


def pressure_reserves() -> Picture:
    """Fig. 8: what keeps the pressure positive.

    >>> [float(curve.y[0]) for curve in pressure_reserves().panels[0].lines]
    [1.0, 0.9375, 0.75, 0.4375, 0.0]
    """
    label = r"$p_Δ^2 - δ^2\,\cos^2φ\;p_a^2\,(1 + δ^2\,\sin^2φ\;p_b^2)$"
    lines = family(lambda delta: pressure_reserve(integrals, PHI, delta))
    return Picture(
        "Pressure is positive on the whole base where this function is (Fig. 8)",
        [Panel(PHI_LABEL, label, lines, x_ticks=QUARTER_TICKS)],
    )


def friction_along_and_spin() -> Picture:
    """Fig. 9: the resultants ρ_∥ and ρ_ω.

    >>> [float(panel.lines[-1].y[0]) for panel in friction_along_and_spin().panels]
    [1.0, 0.375]
    """
    along = family(lambda delta: by_closed_form(PHI, delta).parallel)
    spin = family(lambda delta: by_closed_form(PHI, delta).spin)
    return Picture(
        "Friction along the velocity and against the spin (Fig. 9)",
        [
            Panel(PHI_LABEL, r"$ρ_\parallel$ (dimensionless)", along, x_ticks=QUARTER_TICKS),
            Panel(PHI_LABEL, r"$ρ_ω$ (dimensionless)", spin, x_ticks=QUARTER_TICKS),
        ],
        height=3.4,
    )


def friction_across() -> Picture:
    """Fig. 10: the resultant ρ_⊥.

    >>> float(friction_across().panels[0].lines[-1].y[0])
    0.25
    """
    across = family(lambda delta: by_closed_form(PHI, delta).perpendicular)
    return Picture(
        "Friction across the velocity: it bends the path (Fig. 10)",
        [Panel(PHI_LABEL, r"$ρ_\perp$ (dimensionless)", across, x_ticks=QUARTER_TICKS)],
    )


def phase_portrait(delta: float = 1.0) -> Picture:
    """Fig. 11: how the slip angle moves, and where it rests.

    >>> phase_portrait().panels[0].lines[3].x.round(6).tolist()  # the attractors
    [-0.975465, 0.975465]
    """
    phi = np.linspace(-0.5 * math.pi, 0.5 * math.pi, 601)
    limit, end = float(limit_angle(delta)), 0.5 * math.pi
    attractors, repellers = np.array([-limit, limit]), np.array([-end, 0.0, end])
    right = np.array([-0.5 * (limit + end), 0.5 * limit])
    lines = [
        PlotLine(phi, slip_angle_rate(by_closed_form, phi, delta), "rate dφ/dτ"),
        PlotLine(right, 0.0 * right, "φ grows", marker=">"),
        PlotLine(-right, 0.0 * right, "φ falls", marker="<"),
        PlotLine(attractors, 0.0 * attractors, "attracts: ±φ₀", marker="o"),
        PlotLine(repellers, 0.0 * repellers, "repels: 0, ±π/2", marker="o", hollow=True),
    ]
    ticks = {-end: "-π/2", -limit: "-φ₀", 0.0: "0", limit: "φ₀", end: "π/2"}
    return Picture(
        f"Every generic motion goes to ±φ₀ (Fig. 11; δ = {delta:g}, Q dτ = J dt)",
        [Panel(PHI_LABEL, "dφ/dτ (dimensionless)", lines, x_ticks=ticks)],
    )


FIGURES: dict[int, Callable[[], Picture]] = {
    2: limit_angles, 3: paths, 4: stops_against_spin, 5: steel_puck, 6: rubber_puck,
    7: patch_integrals, 8: pressure_reserves, 9: friction_along_and_spin, 10: friction_across,
    11: phase_portrait,
}  # fmt: skip
