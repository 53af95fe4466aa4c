"""``puck simulate``: one trajectory."""

from __future__ import annotations

import math
from contextlib import nullcontext
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource
from puck_tables.cli.options import (
    FILE,
    Outputs,
    PuckChoice,
    number,
    outputs,
    packed,
    puck_options,
    table_option,
)
from puck_tables.cli.printing import listed, say
from puck_tables.cli.run_report import report as report_of_scene
from puck_tables.cli.scene_run import SceneChoice, scene_options, scene_tables
from puck_tables.cli.values import Times, Vector

from puck_tables.accuracy.methods import INTEGRATORS
from puck_tables.errors import InputError
from puck_tables.kernels.patience import one_question

if TYPE_CHECKING:
    from puck_tables.puck import Puck
    from puck_tables.result import TimedResult
    from puck_tables.trajectory import Trajectory

ENDS = {  # of slides on bases that are not round
    "rest": "it lies still",
    "together": "sliding and spinning end together",
    "slide last": "the spin dies out first, it slides last",
    "spin last": "the sliding dies out first, it spins last",
}


@click.command()
@click.option("--fit", "fit_path", type=FILE, metavar="FILE",
              help="The puck and the launch that 'puck fit -o FILE.json' found.")  # fmt: skip
@click.option("--track", help="Which track of --fit, by its name or number from 1.")
@number("--v0", "m/s", Vector, help="Launch velocity in m/s, like 1,0.")
@number("--w0", "rad/s", default=0.0, show_default=True, help="Launch spin in rad/s.")
@packed("choice", PuckChoice, *puck_options(base=True, mass=True))
@click.option("--frames", type=int, help="Number of states to save.  [default: 101]")
@number("--times", "s", Times, help="Times of the states to save, in s.")
@number("--tol", default=1e-9, show_default=True, help="Largest error, in units of Q/(f g) (times) "
        "and Q^2/(f g) (places), Q = hypot(v0, r w0): the cheapest method whose measured error is "
        "below it is taken.")  # fmt: skip
@click.option("--method", type=click.Choice([method.value for method in INTEGRATORS]),
              help="Dormand-Prince 5(4), or Runge-Kutta 4.  [default: the cheaper]")  # fmt: skip
@click.option("--exact", is_flag=True, help="Closed forms instead of the table.")
@table_option
@outputs(movie=True, explain=True, as_json=True)
@scene_options
@click.pass_context
def simulate(
    ctx: click.Context, fit_path: Path | None, track: str | None,
    v0: tuple[float, float] | None, w0: float, choice: PuckChoice, frames: int | None,
    times: tuple[float, ...] | None, tol: float, method: str | None, exact: bool,
    table_path: Path | None, out: Outputs, chosen: SceneChoice,
) -> None:  # fmt: skip
    """Slide one puck until it stops, or run a scene of one or of several.

    \b
    puck simulate --v0 1,0 --w0 5
    puck simulate --v0 2,0 --w0 30 --radius 0.0381 --height 0.0254 --friction 0.1
    puck simulate --v0 1,0 --w0 5 --frames 200 -o run.csv --plot run.png
    puck simulate --scene air-hockey --set launch.spin=100 --plot air-hockey.png
    puck simulate --scene carrom-break --movie carrom.html
    puck simulate --v0 1,0 --w0 5 --delta 2
    puck simulate --v0 1,0 --w0 5 --pressure annulus:0.8 --gyration 0.9
    puck simulate --v0 1,0 --w0 10 --base box:20cmx10cm --friction 0.3 --plot box.png
    puck simulate --fit fit.json --track 1
    """  # noqa: D301 - click reads the backspace
    unknown: tuple[str, ...] = ()
    run: TimedResult
    report_only = out.output is None and out.plot is None and times is None
    if chosen:
        from puck_tables.world.scene import Scene

        tables = scene_tables(ctx, chosen)
        out.prepare(*chosen.reads(tables))
        board = isinstance(tables.get("puck"), list)  # quicker by what was compiled before
        with nullcontext() if board else one_question():
            run = Scene.from_tables(tables, chosen.name).simulate((0.0,) if report_only else times)
        in_words = report_of_scene
    else:
        if track is not None and fit_path is None:
            raise InputError("--track chooses a track of --fit: give that, too")
        if exact and table_path is not None:
            raise InputError("--exact and --table clash: closed forms need no table")
        out.prepare(table_path, choice.pressure, choice.base, fit_path)
        if fit_path is not None:
            puck, launch, unknown = _from_fit(ctx, fit_path, track)
        elif v0 is not None:
            puck, launch = choice.puck(), {"velocity": v0, "spin": w0}
        else:
            raise click.MissingParameter(param_hint="'--v0'", param_type="option")
        from puck_tables.table.resultant_table import ResultantTable

        with one_question():
            run = puck.simulate(
                **launch, frames=1 if report_only and frames is None else frames, times=times,
                tol=tol, method=method, exact=exact,
                table=None if table_path is None else ResultantTable.load(table_path),
            )  # fmt: skip
        in_words = partial(report, note="" if fit_path else choice.note)
    for sentence in unknown:
        say(f"{fit_path}: {sentence}", err=True)
    out.deliver(run)
    out.report(run, in_words)


def _from_fit(
    ctx: click.Context, path: Path, track: str | None
) -> tuple[Puck, dict[str, Any], tuple[str, ...]]:
    """The puck and the launch of a fit, which no option contradicts, and what it left open."""
    for name in ("v0", "w0", *(one.name for one in fields(PuckChoice))):
        if ctx.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            raise InputError(
                f"--fit and --{name} clash: the file of the fit has the puck and its launch"
            )
    from puck_tables.fitting.fit_files import puck_and_launch

    return puck_and_launch(path, track)


def report(run: Trajectory, note: str) -> str:
    """The trajectory in a dozen lines."""
    lines = _on_base(run, note) if run.puck.shape is not None else _of_round(run, note)
    return f"{plainly(run)}\n\n{listed(lines, 15)}"


def _of_round(run: Trajectory, note: str) -> dict[str, str]:
    """What is told of a round puck."""
    from puck_tables.motion.limits import REGIMES

    puck, (vx, vy), w0 = run.puck, run.launch_velocity, run.launch_spin
    q0 = math.hypot(vx, vy, puck.radius * w0)
    assert run.turn_angle is not None
    turn = f"{math.degrees(run.turn_angle):.5g} deg"
    if run.turn_rate:
        decade = math.degrees(run.turn_rate) * math.log(10.0)
        turn += f" by Q = Q0/1000, then {decade:.4g} deg more for each factor 10 of Q"
    kind = f", {puck.body.kind}" if puck.body.kind else ""
    return {
        "puck": f"r = {puck.radius:g} m, delta = {puck.delta:.6g}, "
        f"f g = {puck.decel:.6g} m/s^2{kind}{note}",
        "launch": f"v0 = ({vx:g}, {vy:g}) m/s, w0 = {w0:g} rad/s, "
        f"Q0 = hypot(v0, r w0) = {q0:.6g} m/s",
        "regime": f"{run.regime}: {REGIMES[run.regime]}",
        "contact": _contact(run),
        **_stop(run, q0, {"heading turned": turn}, {"limit": _limit(run)}),
    }


def _on_base(run: Trajectory, note: str) -> dict[str, str]:
    """What is told of a puck on another base."""
    puck, (vx, vy), w0 = run.puck, run.launch_velocity, run.launch_spin
    assert puck.shape is not None
    k = puck.inertia_radius
    q0 = math.hypot(vx, vy, k * w0)
    high = f"h = {puck.height:g} m, " if puck.height > 0.0 else ""
    angle = math.degrees(run.summary()["launch_orientation"])
    turned = f", turned by {angle:.4g} degrees" if round(angle, 6) else ""
    return {
        "puck": f"base {puck.shape.name}, k = {k:.6g} m, {high}f = {puck.friction:g}, "
        f"f g = {puck.decel:.6g} m/s^2{note}",
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
