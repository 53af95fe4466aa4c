"""What is told of a motion: in two sentences, then its numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from puck_tables.motion.limits import REGIMES
from puck_tables.report.lines_and_tables import listed, puck_words

if TYPE_CHECKING:
    from puck_tables.trajectory import Trajectory

ENDS = {  # of slides on bases that are not round
    "rest": "it lies still",
    "together": "sliding and spinning end together",
    "slide last": "the spin dies out first, it slides last",
    "spin last": "the sliding dies out first, it spins last",
    "pivot": "it turns about one of its feet as it stops",
    "cycle": "sliding and spinning end together, at a ratio that changes to the very end",
}


def report(run: Trajectory) -> str:
    """The trajectory in a dozen lines."""
    lines = _of_round(run) if run.puck.shape is None else _on_base(run)
    return f"{plainly(run)}\n\n{listed(lines, 15)}"


def _of_round(run: Trajectory) -> dict[str, str]:
    """What is told of a round puck."""
    puck, (vx, vy), w0 = run.puck, run.launch_velocity, run.launch_spin
    q0 = math.hypot(vx, vy, puck.radius * w0)
    assert run.turn_angle is not None
    turn = f"{math.degrees(run.turn_angle):.5g} deg"
    if run.turn_rate:
        decade = math.degrees(run.turn_rate) * math.log(10.0)
        turn += f" by Q = Q0/1000, then {decade:.4g} deg more for each factor 10 of Q"
    return {
        "puck": puck_words(puck),
        "launch": f"v0 = ({vx:g}, {vy:g}) m/s, w0 = {w0:g} rad/s, "
        f"Q0 = hypot(v0, r w0) = {q0:.6g} m/s",
        "regime": f"{run.regime}: {REGIMES[run.regime]}",
        "contact": _contact(run),
        **_stop(run, q0, {"heading turned": turn}, {"limit": _limit(run)}),
    }


def _on_base(run: Trajectory) -> dict[str, str]:
    """What is told of a puck on another base."""
    puck, (vx, vy), w0 = run.puck, run.launch_velocity, run.launch_spin
    q0 = math.hypot(vx, vy, puck.inertia_radius * w0)
    angle = math.degrees(run.summary()["launch_orientation"])
    turned = f", turned by {angle:.4g} degrees" if round(angle, 6) else ""
    return {
        "puck": puck_words(puck),
        "launch": f"v0 = ({vx:g}, {vy:g}) m/s, w0 = {w0:g} rad/s, "
        f"Q0 = hypot(v0, k w0) = {q0:.6g} m/s{turned}",
        "end": "it slides without a spin" if _is_straight(run) else ENDS[run.regime],
        **_stop(run, q0, {}, {}),
    }


def _stop(
    run: Trajectory, q0: float, turns: dict[str, str], limit: dict[str, str]
) -> dict[str, str]:
    """What is told of any stop, with more about turns."""
    (x, y), puck = run.stop_position, run.puck
    return {
        "stop time": f"{run.stop_time:.9g} s",
        "stop position": f"({x:.9g}, {y:.9g}) m",
        "path length": f"{run.path_length:.9g} m",
        **turns,
        "body turned": f"{run.body_angle:.9g} rad ({run.body_angle / (2 * math.pi):.5g} turns)",
        **limit,
        "energy": f"{run.kinetic_energy:.6g} J (m = {puck.mass:g} kg), all lost to friction; "
        f"residual {run.energy_residual:.1e} of it",
        "method": run.method + (f", {run.steps} steps" if run.steps else ""),
        "error estimate": f"{run.error_estimate * q0 / puck.decel:.1e} s, "
        f"{run.error_estimate * q0 * q0 / puck.decel:.1e} m",
    }


def plainly(run: Trajectory) -> str:
    """What happens, in two sentences that need no other word than those of the command."""
    (vx, vy), (x, y) = run.launch_velocity, run.stop_position
    if run.stop_time == 0.0:
        return "The puck lies still.\nGive it a velocity (--v0) or a spin (--w0)."
    if vx == vy == 0.0:
        turns = abs(run.body_angle) / (2.0 * math.pi)
        return f"The puck spins on the spot and stops after {run.stop_time:.4g} s.\n" + (
            f"It turns {turns:.4g} times."
        )
    first = f"The puck stops after {run.stop_time:.4g} s, {math.hypot(x, y):.4g} m from its launch."
    aside = math.degrees(math.atan2(vx * y - vy * x, vx * x + vy * y))
    if _is_straight(run):
        return first + "\nWithout spin its path is straight."
    side = "left" if aside > 0.0 else "right"
    bent = (
        f"It bends to the {side}: it lies {abs(aside):.3g} degrees off the line it was sent along"
    )
    if abs(aside) < 1e-9:
        bent = "Its path is straight"
    end = ENDS.get(run.regime, ENDS["together"])
    return f"{first}\n{bent}; {end}."


def _is_straight(run: Trajectory) -> bool:
    """Whether it slides and never spins."""
    return run.stop_time > 0.0 and run.launch_spin == run.body_angle == 0.0


def _contact(run: Trajectory) -> str:
    """How much of the base carries load on the way."""
    if run.least_loaded_share == 1.0:
        return "full contact throughout"
    text = f"{100.0 * run.loaded_share:.4g} % of the base loaded at the launch"
    if run.least_loaded_share < run.loaded_share:
        text += f", falling to {100.0 * run.least_loaded_share:.4g} %"
    if run.contact_opens is not None:
        text += f"; lifts at {run.contact_opens:.6g} s"
    elif run.contact_closes is not None:
        text += f"; all of it from {run.contact_closes:.6g} s on"
    else:
        text += "; part of it lifted throughout"
    return text


def _limit(run: Trajectory) -> str:
    """What the ratio ε of sliding to spinning tends to."""
    angle = run.limit_angle
    assert angle is not None
    if run.regime not in ("B", "C", "D"):
        return "none: it does not slide and spin at once"
    if angle == 0.0:
        return "none: the spin dies out before the sliding, v/(r w) grows without bound"
    if angle == 0.5 * math.pi:
        return "none: the sliding dies out before the spin, v/(r w) tends to 0"
    return f"v/(r w) tends to {1.0 / math.tan(angle):.7g}"
