"""What ``puck fit`` prints: what was found, in words and numbers."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from puck_tables.fitting.fit_result import Fit
    from puck_tables.fitting.numbers import Number

_DIGITS = 9  # after the point: more are written with a power of ten


def report(result: Fit) -> str:
    """What was found, plainly first, then the numbers."""
    lines = [_plainly(result), ""]
    for name, number in result.numbers.items():
        if number.how != "known":
            lines.append(f"{name:<15} {_shown(number)}")
    known = [
        f"{name} {number.value:g}{_unit(number)}" for name, number in result.numbers.items()
        if number.how == "known"
    ]  # fmt: skip
    lines += [
        f"{'taken as known':<15} {', '.join(known)}",
        f"{'pressure':<15} {result.puck.body.law.name}",
    ]
    lines += [f"{'correlation':<15} {text}" for text in _correlations(result)]
    for launch in result.launches:
        v, w = launch.numbers, launch.numbers["launch_spin"]
        lines += [
            f"\nlaunch of {launch.name}, at {launch.time:g} s",
            f"{'  place':<15} ({launch.place[0]:.6g}, {launch.place[1]:.6g}) m "
            f"{_errors(v['launch_x'], v['launch_y'])}",
            f"{'  velocity':<15} ({launch.velocity[0]:.6g}, {launch.velocity[1]:.6g}) m/s "
            f"{_errors(v['launch_vx'], v['launch_vy'])}",
            f"{'  spin':<15} {_spin(result, w)}",
        ]
    for one in result.impacts:
        degrees = math.degrees(one.wall) % 360.0
        what = f"{one.partner}" if one.partner else "a wall"
        lines += [
            f"\nimpact of {one.track} at {one.time:.6g} s, ({one.place[0]:.5g}, "
            f"{one.place[1]:.5g}) m, on {what} at {degrees:.4g} degrees from x",
            f"{'  restitution':<15} {_shown(one.restitution)}",
            f"{'  rim':<15} {_shown(one.rim)} (tangential over normal impulse)",
        ]
        if one.mass_ratio is not None and one.mass_ratio.how != "known":
            lines.append(f"{'  mass ratio':<15} {_shown(one.mass_ratio)}")
    angled = any(film.angle is not None for film in result.estimate.problem.films)
    how = ["given" if known else "from the residuals" for known in result.noise_known[:2]]
    noise = f"places {1e3 * result.noise[0]:.3g} mm ({how[0]})"
    if angled:
        noise += f", angles {1e3 * result.noise[1]:.3g} mrad ({how[1]})"
    if result.jitter:
        how_stamps = "given" if result.noise_known.jitter else "from the residuals"
        noise += f", time stamps {1e3 * result.jitter:.3g} ms ({how_stamps})"
    lines += [
        "",
        f"{'noise':<15} {noise}",
        f"{'chi^2':<15} {result.chi2:.5g} for {result.degrees} degrees of freedom",
        f"{'left out':<15} {100.0 * result.outliers:.3g} % of the observations, as outliers",
        *_left_out(result),
        f"{'residuals':<15} probability of such a pattern by chance: runs {result.runs:.2g}, "
        f"drift {result.drift:.2g}",
    ]
    if speeds := result.estimate.problem.spec.speeds:
        fewer = result.constant_chi2 - result.chi2
        lines += [
            "", f"{'slip speeds':<15} {', '.join(f'{u:g}' for u in speeds)} m/s, of friction_0 and "
            f"so on; chi^2 is {fewer:.4g} less than with one friction for {len(speeds) - 1} more "
            "numbers",
        ]  # fmt: skip
    if result.laws:
        lines += ["", *_laws(result)]
    if result.held_out is not None:
        held = result.held_out
        lines += [
            "",
            f"{'held out':<15} {held.z_place.size + held.z_angle.size} observations of "
            f"{', '.join(held.tracks)}: {100.0 * held.inside:.3g} % within 95 % of their "
            f"prediction, z rms {held.rms:.3g} (if all is right 1, by chance {held.chance[0]:.3g} "
            f"to {held.chance[1]:.3g} in 95 of 100 films)",
        ]
    return "\n".join(lines)


def _left_out(result: Fit) -> list[str]:
    """Frames at either end that are no free motion."""
    return [
        f"{'cut off':<15} the first {first} and the last {last} frames of {name}: no free motion"
        for name, first, last in result.left_out
        if first or last
    ]


def _plainly(result: Fit) -> str:
    """What was found and what was not, in sentences."""
    sentences = [f"{result.cut_off}."] if result.cut_off else []
    friction, tilt = result.numbers["friction"], result.numbers["delta"]
    if friction.determined:
        sentences.append(
            f"The friction coefficient is {_rounded(friction)}: sliding without spin the puck "
            f"would lose {result['decel'].value:.4g} m/s each second."
        )
    elif result["decel"].determined:
        sentences.append(f"The puck would slide to rest at {_rounded(result['decel'])}.")
    if tilt.determined and tilt.how != "known":
        sentences.append(
            f"Its dimensionless height is {_rounded(tilt)}: so much friction tips its load forward."
        )
    sentences += [*result.blind, *result.remarks]
    if result.complaints:
        sentences += [text if text.endswith("?") else f"{text}." for text in result.complaints]
        angled = any(film.angle is not None for film in result.estimate.problem.films)
        said = "Or the radius, the unit of the angles or the way they turn is not as said."
        sentences.append(
            "So this may be no freely sliding puck, or not all of its motion: look at --plot, and "
            "give --since and --until if a hand or a wall touches it."
            + ("" if result.misfit else " Or speed changes its friction, or air slows it, too.")
            + (f" {said}" if angled and not result.misfit else "")
        )
    return "\n".join(sentences)


def _rounded(number: Number) -> str:
    """Value ± error, to two digits of the error, and the unit."""
    unit = _unit(number)
    if number.at_bound:
        return f"{number.shown}{unit} (at its bound)"
    if not (number.error > 0.0 and math.isfinite(number.error)):
        return f"{number.value:.6g}{unit}"
    digits = max(0, 1 - math.floor(math.log10(number.error)))
    if digits > _DIGITS and number.value != 0.0:
        power = max(0, digits + math.floor(math.log10(abs(number.value))))
        return f"{number.value:.{power}e} +- {number.error:.1e}{unit}"
    return f"{number.value:.{digits}f} +- {number.error:.{digits}f}{unit}"


def _errors(*numbers: Number) -> str:
    each = ("at its bound" if one.at_bound else f"{one.error:.2g}" for one in numbers)
    return f"+- {', '.join(each)}"


def _unit(number: Number) -> str:
    return "" if number.unit == "1" else f" {number.unit}"


def _shown(number: Number) -> str:
    """A number with its error and interval."""
    if number.how == "known":
        return f"{number.value:g}{_unit(number)} (known)"
    if not number.determined:
        return "not determined by these tracks"
    how = ", by profile likelihood" if number.profiled else ""
    follows = ", follows" if number.how == "follows" else ""
    interval = ""
    if math.isfinite(number.low) and math.isfinite(number.high):
        interval = f"   95 %: {number.low:.6g} to {number.high:.6g}"
    return f"{_rounded(number)}{interval}{how}{follows}"


def _spin(result: Fit, spin: Number) -> str:
    """A launch spin, as it is taken where whole turns from frame to frame are open."""
    films = result.estimate.problem.films
    half = min((math.pi / film.usual_step for film in films if film.angle is not None), default=0.0)
    if spin.determined or abs(spin.value) > half:
        return _shown(spin)
    return f"{spin.value:.5g} rad/s if it turns less than half a turn a frame; not determined"


def _correlations(result: Fit) -> list[str]:
    """Of each two numbers that were found."""
    table = result.correlation()
    names = list(table)
    return [
        f"{one} and {other}: {table[one][other]:.3f}"
        for n, one in enumerate(names) for other in names[n + 1 :]
        if math.isfinite(table[one][other])
    ]  # fmt: skip


def _laws(result: Fit) -> list[str]:
    """The laws compared, line by line."""
    best = result.laws[0]
    lines = [f"{'law':<18} {'chi^2':>10} {'more':>9} {'unknowns':>9} {'weight':>8}  found"]
    for law in result.laws:
        numbers = ", ".join(f"{name} {value:.4g}" for name, value in law.numbers.items())
        lines.append(
            f"{law.name:<18} {law.chi2:>10.5g} {law.chi2 - best.chi2:>9.4g} {law.unknowns:>9} "
            f"{law.weight:>8.2g}  {numbers}"
        )
    return lines
