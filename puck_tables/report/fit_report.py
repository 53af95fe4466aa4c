"""What is told of a fit: what was found, in words and numbers."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING

from puck_tables.report.lines_and_tables import columns, listed

if TYPE_CHECKING:
    from puck_tables.fitting.fit_result import Fit
    from puck_tables.fitting.numbers import Number

_WIDTH = 15  # of names


def report(result: Fit) -> str:
    """What was found, plainly first, then the numbers."""
    numbers = result.numbers
    known = [
        f"{n} {one.value:g}{one.unit_behind}" for n, one in numbers.items() if one.how == "known"
    ]
    lines = [
        _plainly(result), "",
        _lines({name: _shown(one) for name, one in numbers.items() if one.how != "known"}),
        _lines({"taken as known": ", ".join(known), **dict([result.contact])}),
        *_correlations(result),
    ]  # fmt: skip
    for launch in result.launches:
        v, (x, y), (vx, vy) = launch.numbers, launch.place, launch.velocity
        errors = _errors(v["launch_vx"], v["launch_vy"])
        lines += [f"\nlaunch of {launch.name}, at {launch.time:g} s", _lines({
            "  place": f"({x:.6g}, {y:.6g}) m {_errors(v['launch_x'], v['launch_y'])}",
            "  velocity": f"({vx:.6g}, {vy:.6g}) m/s {errors}",
            "  spin": _spin(result, v["launch_spin"]),
        })]  # fmt: skip
    for one in result.impacts:
        ratio = one.mass_ratio
        lines += [
            f"\nimpact of {one.track} at {one.time:.6g} s, ({one.place[0]:.5g}, "
            f"{one.place[1]:.5g}) m, on {one.partner or 'a wall'} at "
            f"{math.degrees(one.wall) % 360.0:.4g} degrees from x",
            _lines({
                "  restitution": _shown(one.restitution),
                "  rim": f"{_shown(one.rim)} (tangential over normal impulse)",
                **({} if ratio is None or ratio.how == "known" else
                   {"  mass ratio": _shown(ratio)}),
            }),
        ]  # fmt: skip
    chance = f"runs {result.runs:.2g}, drift {result.drift:.2g}"
    lines += ["", _lines({
        "noise": _noise(result),
        "chi^2": f"{result.chi2:.5g} for {result.degrees} degrees of freedom",
        "left out": f"{100.0 * result.outliers:.3g} % of the observations, as outliers",
    })]  # fmt: skip
    lines += [  # frames at either end that are no free motion
        _lines({"cut off": f"the first {first} and the last {last} frames of {name}: no free "
                "motion"}) for name, first, last in result.left_out if first or last
    ]  # fmt: skip
    lines.append(_lines({"residuals": f"probability of such a pattern by chance: {chance}"}))
    if speeds := result.estimate.problem.spec.speeds:
        fewer = result.constant_chi2 - result.chi2
        lines += ["", _lines({"slip speeds": (
            f"{', '.join(f'{u:g}' for u in speeds)} m/s, of friction_0 and so on; chi^2 is "
            f"{fewer:.4g} less than with one friction for {len(speeds) - 1} more numbers"
        )})]  # fmt: skip
    if result.laws:
        lines += ["", _laws(result), result.verdict]
    if (held := result.held_out) is not None:
        lines += ["", _lines({"held out": (
            f"{held.z_place.size + held.z_angle.size} observations of {', '.join(held.tracks)}: "
            f"{100.0 * held.inside:.3g} % within 95 % of their prediction, z rms {held.rms:.3g} "
            f"(if all is right 1, by chance {held.chance[0]:.3g} to {held.chance[1]:.3g} in 95 of "
            "100 films)"
        )})]  # fmt: skip
    return "\n".join(lines)


def _lines(entries: dict[str, str]) -> str:
    return listed(entries, _WIDTH)


def _noise(result: Fit) -> str:
    """Of places, angles and time stamps, and where it is known from."""
    angled = result.estimate.problem.angled
    parts = zip(
        (f"places {1e3 * result.noise[0]:.3g} mm", f"angles {1e3 * result.noise[1]:.3g} mrad",
         f"time stamps {1e3 * result.jitter:.3g} ms"),
        result.noise_known, (True, angled, bool(result.jitter)), strict=True,
    )  # fmt: skip
    return ", ".join(
        f"{words} ({'given' if known else 'from the residuals'})"
        for words, known, shown in parts if shown
    )  # fmt: skip


def _plainly(result: Fit) -> str:
    """What was found and what was not, in sentences."""
    sentences = [f"{result.cut_off}."] if result.cut_off else []
    friction, tilt = result.numbers["friction"], result.numbers["delta"]
    if friction.determined:
        sentences.append(
            f"The friction coefficient is {friction.written}: sliding without spin the puck "
            f"would lose {result['decel'].value:.4g} m/s each second."
        )
    elif result["decel"].determined:
        sentences.append(f"The puck would slide to rest at {result['decel'].written}.")
    if tilt.determined and tilt.how != "known":
        sentences.append(
            "Its dimensionless height delta, by which friction tips its load forward, is "
            f"{tilt.written}."
        )
    sentences += [*result.blind, *result.remarks]
    if result.complaints:
        sentences += [text if text.endswith("?") else f"{text}." for text in result.complaints]
        based = result.estimate.problem.spec.base is not None
        said = (
            "Or the base, its x axis from which angles count, their unit or the way they turn is "
            "not as said."
            if based else
            "Or the radius, the unit of the angles or the way they turn is not as said."
        )  # fmt: skip
        sentences.append(
            "So this may be no freely sliding puck, or not all of its motion: look at --plot, and "
            "give --since and --until if a hand or a wall touches it."
            + ("" if result.misfit else " Or speed changes its friction, or air slows it, too.")
            + (f" {said}" if result.estimate.problem.angled and not result.misfit else "")
        )
    return "\n".join(sentences)


def _errors(*numbers: Number) -> str:
    """Of places and velocities; unknown together, where no motion fits."""
    if any(one.error == math.inf for one in numbers):
        return "(not determined)"
    each = ("at its bound" if one.at_bound else f"{one.error:.2g}" for one in numbers)
    return f"+- {', '.join(each)}"


def _shown(number: Number) -> str:
    """A number with its error and interval."""
    if number.how == "known":
        return f"{number.value:g}{number.unit_behind} (known)"
    if not number.determined:
        return "not determined by these tracks"
    how = ", by profile likelihood" if number.profiled else ""
    follows = ", follows" if number.how == "follows" else ""
    interval = f"   95 %: {number.interval}" if number.interval else ""
    return f"{number.written}{interval}{how}{follows}"


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
    return [
        _lines({"correlation": f"{one} and {other}: {table[one][other]:.3f}"})
        for one, other in combinations(table, 2) if math.isfinite(table[one][other])
    ]  # fmt: skip


def _laws(result: Fit) -> str:
    """The laws compared, line by line."""
    heads = {"law": "", "chi^2": ".5g", "more": ".4g", "unknowns": "d", "weight": ".2g",
             "found": ""}  # fmt: skip
    return columns(heads, (
        (law.name, law.chi2, law.chi2 - result.laws[0].chi2, law.unknowns, law.weight,
         ", ".join(f"{name} {value:.4g}" for name, value in law.numbers.items()))
        for law in result.laws
    ), most=200)  # fmt: skip
