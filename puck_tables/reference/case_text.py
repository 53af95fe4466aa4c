"""A case and its answer in words, line by line, as the command and the page show them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.reference.answer import Answer
from puck_tables.scene.entries import units_of
from puck_tables.scene.parts import Launch

_RIM = ("restitution", "tangential", "rim")  # what counts where pucks meet


def lines_of(answer: Answer) -> dict[str, str]:
    """What goes in, with all its digits, and what comes out, by what it is.

    >>> from puck_tables.reference.answer import reference_case
    >>> lines_of(reference_case("incline-below"))["floor"]
    'slope = 0.09966865249116204 rad, downhill = -1.5707963267948966 rad'
    """
    case = answer.case
    lines = {"case": f"{case.label}: {case.title}", "tests": case.tests}
    units = units_of(answer.run.scene)
    for n, (puck, name) in enumerate(zip(answer.pucks, answer.names or ("puck",), strict=True)):
        lines[name] = _puck(puck)
        if answer.names:
            entry = case.tables["puck"][n]
            rim = {one: entry[one] for one in _RIM if one in entry}
            lines[name] += "".join(f", {text}" for text in _entries(rim, units, "puck."))
        lines["launch" if n == 0 else f"launch {n + 1}"] = _launch(puck.launch)
    for what in ("floor", "force", "wall"):
        parts = case.tables.get(what, {})
        for n, part in enumerate(parts if isinstance(parts, list) else [parts] if parts else []):
            text = ", ".join(_entries(part, units, f"{what}."))
            lines[what if n == 0 else f"{what} {n + 1}"] = text
    lines["end"] = f"{answer.end} after {answer.end_time:.12g} s"
    last = answer.last()
    if not answer.names:
        lines["place"] = f"({last['x']:.12g}, {last['y']:.12g}) m"
    for n, name in enumerate(answer.names):
        lines[f"stop {name}"] = (
            f"({last['x'][n]:.12g}, {last['y'][n]:.12g}) m after {answer.end_time_of(n):.12g} s"
        )
    if answer.limit_epsilon is not None:
        lines["limit"] = f"v/(r w) tends to {answer.limit_epsilon:.9g}"
    lines["error"] = (
        f"<= {answer.time_bound:.1e} s, {answer.place_bound:.1e} m, {answer.speed_bound:.1e} m/s"
    )
    return lines


def _puck(puck: PuckSpec) -> str:
    """Its numbers; of pressure and gyration those that are not the usual ones."""
    size = f"r = {_digits(puck.radius)} m" if puck.shape is None else f"base {puck.base}"
    text = (
        f"{size}, height {_digits(puck.height)} m (centre of mass at "
        f"{_digits(0.5 * puck.height)} m), f = {_digits(puck.friction)}, "
        f"g = {_digits(puck.gravity)} m/s^2, m = {_digits(puck.mass)} kg"
    )
    if puck.shape is not None:
        return f"{text}, gyration {_digits(puck.gyration)} m"
    text += f", delta = {puck.delta:.6g}"
    usual = PuckSpec(puck.radius)
    if puck.pressure != usual.pressure:
        text += f", pressure {puck.body.law.name}"
    if puck.gyration != usual.gyration:
        text += f", gyration {_digits(puck.gyration)} r"
    return text


def _launch(launch: Launch) -> str:
    vx, vy = launch.velocity or (0.0, 0.0)
    text = f"v = {_pair(vx, vy)} m/s, w = {_digits(launch.spin)} rad/s"
    turned = f", turned by {_digits(launch.orientation)} rad" if launch.orientation else ""
    return f"{text} at {_pair(*launch.position)} m{turned}"


def _entries(part: Mapping[str, Any], units: Mapping[str, str], path: str) -> Iterator[str]:
    """The entries of a table of a scene, as --set would take them, in SI units."""
    for name, value in part.items():
        if isinstance(value, dict):
            yield from (f"{name}.{text}" for text in _entries(value, units, f"{path}{name}."))
        else:
            unit = units.get(path + name, "1")
            yield f"{name} = {_digits(value)}" + (f" {unit}" if unit != "1" else "")


def _pair(x: float, y: float) -> str:
    return f"({_digits(x)}, {_digits(y)})"


def _digits(value: float | list[Any]) -> str:
    """A number with all its digits, whole ones without a point; or rows of them."""
    if isinstance(value, list):
        return f"[{', '.join(map(_digits, value))}]"
    return repr(float(value)).removesuffix(".0")
