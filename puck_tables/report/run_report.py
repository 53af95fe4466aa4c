"""What is told of a run of a scene."""

from __future__ import annotations

import math
from dataclasses import is_dataclass
from typing import TYPE_CHECKING, Any

from puck_tables._core.fields import Unsaid
from puck_tables.report.lines_and_tables import columns, listed

if TYPE_CHECKING:
    from puck_tables.scene.run import Event, Run
    from puck_tables.scene.scene_spec import SceneSpec

MOST_PARTS = 16  # of a scene in a report
MOST_PUCKS, MOST = 40, 6  # of a report; impacts, events, names
_LEAVES = {
    "pocket": ("falls into a pocket", "fall into pockets"),
    "edge": ("goes over an edge", "go over an edge"),
    "tip": ("tips over", "tip over"),
}
_EMPIRICAL = "empirical: no dry friction over the contact explains it"
_OVERHANG = (
    "a rim comes over an edge; until its centre does, a puck is carried as if none of it hung in "
    "the air, which it is not: its motion from there on is a guess"
)
_PRESSED_ON_REST = (
    "what comes over an edge carries nothing: a base is pressed on what is left of it, linearly, "
    "and stays level until its load is over the edge, where it tips"
)
_WIDEST = 48  # signs of a text in the table
_ROUNDING = 1e-14  # of energies


def report(run: Run) -> str:
    """What happened, what went in, energies, and how sure it is.

    Of several pucks first two sentences, a table of them and their impacts.
    """
    several = bool(run.scene.pucks)
    lines = _of_all(run) if several else _of_one(run)
    lines |= {"energy": _energy(run), "heat": _heat(run)}
    if run.scene.constraint is not None:
        last = run.last
        force = f"({last['lambda_1']:.6g}, {last['lambda_2']:.6g}) N at the end"
        lines["reaction"] = force + ("; at rest the floor shares it" if last["carried"] else "")
    steps = f", {run.steps} steps" if run.steps else ""
    lines |= {"error": _error(run), "model": run.model + steps}
    if any(event.what == "overhang" for event in run.events):
        lines["overhang"] = _overhang(run)
    if run.scene.lateral.strength != 0.0:
        there = [lines["lateral"]] if "lateral" in lines else []
        lines["lateral"] = "; ".join([*there, _EMPIRICAL])
    text = listed(lines, 10)
    if not several:
        return text
    met, passed = (
        _some([
            f"{event.what} at {event.time:.6g} s: {event.puck} and {event.partner}, "
            f"{abs(event.approach):.4g} m/s"
            for event in run.events if event.what == what
        ], "\n")
        for what in ("impact", "line")
    )  # fmt: skip
    return "\n\n".join(filter(None, [plainly(run), _pucks(run), met, passed, text]))


def _of_one(run: Run) -> dict[str, str]:
    """A scene of one puck, how and where it ends, and what happens on the way."""
    last = run.last
    return {
        "scene": run.scene.title or "without a title",
        **_inputs(run.scene),
        "friction": _friction(run.scene),
        "end": f"{run.end} after {run.end_time:.9g} s",
        "place": f"({last['x']:.9g}, {last['y']:.9g}) m, body at {last['orientation']:.6g} rad",
        "motion": f"v = ({last['vx']:.6g}, {last['vy']:.6g}) m/s, w = {last['spin']:.6g} rad/s",
        "events": _some([f"{_event(event)} at {event.time:.6g} s" for event in run.main_events])
        or "none",
    }


def _overhang(run: Run) -> str:
    """How those are carried that come over an edge."""
    from puck_tables.scene.map_of_floor import edges_under
    from puck_tables.world.named_pucks import pucks_of

    over = {event.puck for event in run.events if event.what == "overhang"}
    pucks = zip(run.names, pucks_of(run.scene), strict=True)
    hung = [len(edges_under(run.scene.alone(puck))) > 0 for name, puck in pucks if name in over]
    return "; ".join([_PRESSED_ON_REST] * any(hung) + [_OVERHANG] * (not all(hung)))


def _of_all(run: Run) -> dict[str, str]:
    """What is on a board."""
    scene = run.scene
    parts = {
        "puck": run.names, "wall": scene.walls, "post": scene.posts, "arc": scene.arcs,
        "pocket": scene.pockets, "edge": scene.edges, "line": scene.lines,
    }  # fmt: skip
    counted = ", ".join(_counted(len(those), noun) for noun, those in parts.items() if those)
    return {"scene": f"{scene.title or 'without a title'}: {counted}"}


def _inputs(scene: SceneSpec) -> dict[str, str]:
    """What a scene says, a line for each of its parts, without what is left at its default."""
    from puck_tables.scene.entries import entries

    parts: dict[str, list[str]] = {}
    for entry in entries(scene):
        part, dot, name = entry.path.partition(".")
        if part.startswith("line["):
            continue  # which of them it passes stands under events
        if is_dataclass(entry.value) or not (dot or part not in ("title", "gravity")):
            continue  # its entries follow; above all, and of each puck
        if entry.default is None and isinstance(entry.value, Unsaid):
            continue  # what follows from the base
        if entry.value != entry.default and entry.value is not None:
            based = name == "gyration" and scene.puck.shape is not None
            unit = "m" if based else entry.kind.unit
            words = f"{name} {_written(entry.value)} {unit}".strip()
            parts.setdefault(part, []).append(words)
    lines = {part: ", ".join(words) for part, words in list(parts.items())[:MOST_PARTS]}
    more = len(parts) - MOST_PARTS
    return lines | ({"further": f"{more} parts more"} if more > 0 else {})


def _written(value: Any) -> str:
    if isinstance(value, tuple):
        return f"({', '.join(map(_written, value))})"
    return f"{value:.9g}" if isinstance(value, float) else str(getattr(value, "kind", value))


def _friction(scene: SceneSpec) -> str:
    """Heights and decelerations, one for each strip of floor."""
    normal = scene.puck.gravity * math.cos(scene.floor.slope)
    from puck_tables.scene.by_speed import laws_in
    from puck_tables.scene.floor_parts import directions_in, frictions_on, largest_of
    from puck_tables.scene.parts import Orthotropic

    directions = directions_in(scene.floor)
    by_direction = f"by direction, {', '.join(directions)}" if directions else ""
    if laws := laws_in(scene):
        return "; ".join(filter(None, [f"by slip speed, {', '.join(laws)}", by_direction]))
    decels = ", ".join(
        " along and ".join(f"{f * normal:.6g}" for f in one.friction) + " across"
        if isinstance(one, Orthotropic) else f"{largest_of(one, 0.0) * normal:.6g}"
        for one in frictions_on(scene.floor, scene.puck.friction)
    )  # fmt: skip
    pull = "f g cos(slope)" if scene.floor.slope else "f g"
    decels = f"{pull} = {decels} m/s^2"
    if directions:
        return f"{by_direction}, {decels}"
    if scene.puck.shape is not None:
        return decels
    words = f"delta = {', '.join(f'{delta:.4g}' for delta in scene.heights)}, {decels}"
    return words + ("; part of the base may lift" if max(scene.heights) > 1.0 else "")


def _event(event: Event) -> str:
    """What happened, and at which wall, edge, border, patch or strip."""
    return event.what if event.partner == "floor" else f"{event.what} ({event.partner})"


def _some(texts: list[str], sign: str = ", ") -> str:
    """The first of many, and how many more there are."""
    more = len(texts) - MOST
    return sign.join(texts[:MOST]) + (f"{sign.strip(',')}and {more} more" if more > 0 else "")


def plainly(run: Run) -> str:
    """How it ends and who leaves the board."""
    from puck_tables.world.named_pucks import pucks_of

    free = [not puck.path for puck in pucks_of(run.scene)]  # none is driven
    counted = _counted(sum(free), "puck")
    if run.end_time == 0.0 and all(event.what == "overhang" for event in run.events):
        return f"{counted}: nothing moves.\nSend one off: --set puck[0].launch.velocity=[1,0]"
    after = f"{run.end_time:.4g} s and {_counted(run.impacts, 'impact')}"
    left = {what: [event.puck for event in run.events if event.what == what] for what in _LEAVES}
    rest = sum(free) - sum(map(len, left.values()))
    if run.end in ("at rest", "over the edge", "in a pocket", "tipped over"):
        who = counted if rest == sum(free) else f"{rest} of {counted}"
        first = f"{who} {'comes' if rest == 1 else 'come'} to rest after {after}."
        first = first if rest else f"No puck is left after {after}."
    elif run.end == "time is up":
        moving = int((run.stop_times > run.end_time)[free].sum())
        who = counted if moving == sum(free) else f"{moving} of {counted}"
        verb = "moves" if moving == 1 else "move"
        first = f"Time is up after {after}: {who} still {verb}."
    else:
        who, them = ("the puck rests", "it") if rest == 1 else (f"{rest} pucks rest", "them")
        how = "round" if run.end == "carried round" else "along"
        first = f"After {after} {who} on the floor, which carries {them} {how}."
    outcomes = [
        f"{len(names)} {_LEAVES[what][len(names) > 1]} ({_some(names)})"
        for what, names in left.items() if names
    ]  # fmt: skip
    return f"{first}\n{'; '.join(outcomes) or 'None leaves play'}."


def _counted(count: int, noun: str) -> str:
    return f"{count or 'no'} {noun}{'' if count == 1 else 's'}"


def _pucks(run: Run) -> str:
    """A line for each puck: where it ends, how far from its start, and when."""
    from puck_tables.world.named_pucks import pucks_of, start_of

    rows = []
    for number, (name, puck) in enumerate(zip(run.names, pucks_of(run.scene), strict=True)):
        if number == MOST_PUCKS:
            break
        last = run.last_of(number)
        end = last["x"], last["y"]
        unseen = 1e-9 * puck.radius  # what rounding leaves
        lengths = (*end, math.dist(end, start_of(puck)))
        shown = (0.0 if abs(length) < unseen else length for length in lengths)
        rows.append((name, *shown, _ending(run, number)))
    heads = {"puck": "", "end x m": ".6g", "end y m": ".6g", "moved m": ".4g", "how it ends": ""}
    more = f"\nand {len(run.names) - MOST_PUCKS} more (-o FILE saves all)"
    return columns(heads, rows, _WIDEST) + (more if len(run.names) > MOST_PUCKS else "")


def _ending(run: Run, number: int) -> str:
    """What became of a puck."""
    name, stop = run.names[number], float(run.stop_times[number])
    for event in run.events:
        if event.puck == name and event.what == "tip":
            return f"tips over at {event.time:.6g} s"
        if event.puck == name and event.what in ("pocket", "edge"):
            where = "in" if event.what == "pocket" else "over"
            return f"{where} {event.partner} at {event.time:.6g} s"
    if run.scene.pucks and run.scene.pucks[number].path:
        return "driven"
    if stop > run.end_time:
        last = run.last_of(number)
        speed = math.hypot(last["vx"], last["vy"])
        return f"moves, {speed:.4g} m/s"
    return f"stops at {stop:.6g} s" if stop > 0.0 else "never moved"


def _energy(run: Run) -> str:
    """What was given, and what the pucks still have or took along when they left play."""
    last = run.last
    rows = {
        "by driven bodies": last["work_driven"], "by slope and forces": last["work_given"],
        "by what moves under or leads the pucks": last["work_support"],
    }  # fmt: skip
    words = f"{last['energy_given']:.6g} J given by launches"
    words += "".join(f", {work:.6g} J {by}" for by, work in rows.items() if work != 0.0)
    left = sum(run.last_of(name)["kinetic_energy"] for name in run.names) + last["energy_gone"]
    if abs(left) > 1e-9 * abs(last["energy_given"] + sum(rows.values())):
        words += f"; {left:.6g} J left, or gone with who left play"
    return words


def _heat(run: Run) -> str:
    """What floor, drag, rims and impacts took; what is no more than rounding is told as 0."""
    last = run.last
    work = sum(abs(last[name]) for name in ("work_driven", "work_given", "work_support"))
    unseen = _ROUNDING * (last["energy_given"] + work)
    names = {"floor": "heat_dry", "drag": "heat_viscous", "rims": "heat_rims",
             "impacts": "heat_impact"}  # fmt: skip
    heats = {who: last[name] if abs(last[name]) > unseen else 0.0 for who, name in names.items()}
    note = ", ".join(
        f"{heat:.6g} J {who}" for who, heat in heats.items() if heat or who in ("floor", "impacts")
    )
    rounding = run.energy_residual < _ROUNDING
    missed = f"under {_ROUNDING:g}" if rounding else f"{run.energy_residual:.1e}"
    return f"{note}; ledger misses {missed} of it"


def _error(run: Run) -> str:
    """What times and places may be wrong by; where tol could not be kept, or nobody can know."""
    from puck_tables.world.named_pucks import pucks_of

    tol, several = run.scene.tol, bool(run.scene.pucks)
    time = run.speed_scale / run.rate_scale if run.rate_scale > 0.0 else 0.0
    wanted = f"tol = {tol:g}"
    if time > 0.0:
        wanted += f" ({tol * time:.1e} s, {tol * time * run.speed_scale:.1e} m)"
    if run.end_error > min(puck.radius for puck in pucks_of(run.scene)):
        return (
            "nobody can know the end: launches that differ by 1e-9 end up to "
            f"{run.end_error:.2g} m apart, for every impact multiplies what is not known"
        )
    words = f"about {run.error_estimate * time:.1e} s, {run.end_error:.1e} m; {wanted}"
    if run.error_estimate > tol:
        known = "a finer table of its law helps" if run.scene.floor.law else "finer steps help"
        why = "impacts multiply what is not known of launches" if several else f"{known} no more"
        words += f" is out of reach, {why}"
    return words
