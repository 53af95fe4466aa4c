"""What ``puck simulate`` says of a run of several pucks."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from puck_tables.scene.run import Run

MOST_PUCKS, MOST_IMPACTS, MOST_NAMES = 40, 6, 6  # of a report
_WIDEST = 24  # signs of a name in the table
_ROUNDING = 1e-14  # of energies


def report(run: Run) -> str:
    """What happened in two sentences; a table of pucks; impacts, energies, and how sure it is."""
    from puck_tables.scene.plan import EMPIRICAL, OVERHANG
    from puck_tables.world.outcome import ways_of

    lines = {
        "scene": _scene(run),
        "energy": _energy(run),
        "heat": _heat(run),
        "error": _error(run),
        "model": ", ".join(way for way in ways_of(run.scene).splitlines() if way != EMPIRICAL),
    }
    if run.scene.lateral.strength != 0.0:
        lines["lateral"] = EMPIRICAL
    if any(event.what == "overhang" for event in run.events):
        lines["overhang"] = OVERHANG
    parts = [
        plainly(run),
        "\n".join(_pucks(run)),
        *(["\n".join(_impacts(run))] if run.impacts else []),
        "\n".join(f"{name:<8} {text}" for name, text in lines.items()),
    ]
    return "\n\n".join(parts)


def plainly(run: Run) -> str:
    """How it ends and who leaves the board."""
    from puck_tables.world.agreement import pieces_of

    count, impacts = len(run.names), _counted(run.impacts, "impact")
    if run.end_time == 0.0 and all(event.what == "overhang" for event in run.events):
        return (
            f"{_counted(count, 'puck')}: nothing moves.\n"
            "Send one off: --set puck[0].launch.velocity=[1,0]"
        )
    left = sum(event.what in ("pocket", "edge") for event in run.events)
    if run.end == "at rest":
        rest = count - left
        what = f"{rest or 'none'} of {count} pucks" if left else _counted(count, "puck")
        verb = "comes" if rest == 1 else "come"
        first = f"{what} {verb} to rest after {run.end_time:.4g} s and {impacts}."
    else:
        free = [not piece.path for piece in pieces_of(run.scene)]
        moving = int((run.stop_times > run.end_time)[free].sum())
        verb = "moves" if moving == 1 else "move"
        first = (
            f"Time is up after {run.end_time:.4g} s and {impacts}: {moving} of "
            f"{_counted(count, 'puck')} still {verb}."
        )
    fates = []
    for what, one, several in (
        ("pocket", "falls into a pocket", "fall into pockets"),
        ("edge", "goes over an edge", "go over an edge"),
    ):
        names = [event.puck for event in run.events if event.what == what]
        if names:
            shown = ", ".join(names[:MOST_NAMES])
            more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
            fates.append(f"{len(names)} {one if len(names) == 1 else several} ({shown}{more})")
    return f"{first}\n{'; '.join(fates)}." if fates else f"{first}\nNone leaves play."


def _counted(count: int, noun: str) -> str:
    return f"{count or 'no'} {noun}{'' if count == 1 else 's'}"


def _pucks(run: Run) -> list[str]:
    """A line for each puck: where it ends, how far from its start, and when."""
    from puck_tables.world.agreement import pieces_of, start_of

    pieces = pieces_of(run.scene)
    wide = min(_WIDEST, max(len("puck"), *(len(name) for name in run.names)))
    rows = [f"{'puck':<{wide}} {'end x m':>12} {'end y m':>12} {'moved m':>10}  how it ends"]
    for number, (name, piece) in enumerate(zip(run.names, pieces, strict=True)):
        if number == MOST_PUCKS:
            rows.append(f"and {len(run.names) - MOST_PUCKS} more (-o FILE saves all)")
            break
        last = run.last_of(number)
        end = last["x"], last["y"]
        unseen = 1e-9 * piece.radius  # what rounding leaves
        x, y, moved = (
            0.0 if abs(way) < unseen else way for way in (*end, math.dist(end, start_of(piece)))
        )
        shown = name if len(name) <= wide else name[: wide - 3] + "..."
        rows.append(f"{shown:<{wide}} {x:>12.6g} {y:>12.6g} {moved:>10.4g}  {_fate(run, number)}")
    return rows


def _fate(run: Run, number: int) -> str:
    """What became of a puck."""
    name, stop = run.names[number], float(run.stop_times[number])
    for event in run.events:
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


def _impacts(run: Run) -> list[str]:
    """The first impacts, a line each."""
    impacts = [event for event in run.events if event.what == "impact"]
    rows = [
        f"impact at {event.time:.6g} s: {event.puck} and {event.partner}, {event.approach:.4g} m/s"
        for event in impacts[:MOST_IMPACTS]
    ]
    more = len(impacts) - MOST_IMPACTS
    return rows + ([f"and {_counted(more, 'impact')} more"] if more > 0 else [])


def _scene(run: Run) -> str:
    scene = run.scene
    parts = {
        "puck": len(run.names), "wall": len(scene.walls), "post": len(scene.posts),
        "arc": len(scene.arcs), "pocket": len(scene.pockets), "edge": len(scene.edges),
    }  # fmt: skip
    counted = ", ".join(_counted(count, noun) for noun, count in parts.items() if count)
    return f"{scene.title or 'without a title'}: {counted}"


def _energy(run: Run) -> str:
    """What was given, and what the pucks still have or took along when they left play."""
    last = run.last
    works = {
        "by driven bodies": last["work_driven"], "by slope and forces": last["work_given"],
        "by what moves under or leads the pucks": last["work_support"],
    }  # fmt: skip
    words = f"{last['energy_given']:.6g} J given by launches"
    words += "".join(f", {work:.6g} J {by}" for by, work in works.items() if work != 0.0)
    left = sum(run.last_of(name)["kinetic_energy"] for name in run.names) + last["energy_gone"]
    if abs(left) > 1e-9 * abs(last["energy_given"] + sum(works.values())):
        words += f"; {left:.6g} J left, or gone with who left play"
    return words


def _heat(run: Run) -> str:
    """What floor, drag, rims and impacts took; what is no more than rounding is told as 0."""
    last = run.last
    works = sum(abs(last[name]) for name in ("work_driven", "work_given", "work_support"))
    unseen = _ROUNDING * (last["energy_given"] + works)
    names = {"heat_dry": "floor", "heat_viscous": "drag", "heat_rims": "rims",
             "heat_impact": "impacts"}  # fmt: skip
    heats = {words: last[name] if abs(last[name]) > unseen else 0.0
             for name, words in names.items()}  # fmt: skip
    told = ", ".join(
        f"{heat:.6g} J {words}" for words, heat in heats.items()
        if heat or words in ("floor", "impacts")
    )  # fmt: skip
    rounding = run.energy_residual < _ROUNDING
    missed = f"under {_ROUNDING:g}" if rounding else f"{run.energy_residual:.1e}"
    return f"{told}; ledger misses {missed} of it"


def _error(run: Run) -> str:
    """What the end may be wrong by, and where nobody can know it."""
    from puck_tables.world.agreement import pieces_of

    if run.end_error > min(piece.radius for piece in pieces_of(run.scene)):
        return (
            "nobody can know the end: launches that differ by 1e-9 end up to "
            f"{run.end_error:.2g} m apart, for every impact multiplies what is not known"
        )
    return f"about {run.end_error:.1e} m at the end"
