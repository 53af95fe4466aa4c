"""What is told of maps and samples, in memory or in a store: a line, and what has no end."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from puck_tables.bulk.work import Tally
from puck_tables.io.columns import COLUMNS
from puck_tables.stopping.solvers import STATUS_MEANINGS
from puck_tables.world.scene_ends import spread_words

if TYPE_CHECKING:
    from puck_tables.bulk.finish import Stored
    from puck_tables.stopping.population import StopMap
    from puck_tables.world.map import Map
    from puck_tables.world.scene_ends import Sample


def stored_report(result: Stored) -> str:
    """Of a store what its work and its tally tell, without reading it."""
    work: Any = result.work
    if work.code == "status":
        return _stops(work.launches, work.shape, result.tally, work.method, work.source)
    return _ends(work, result.tally, "", work.without_end(result.tally))


def stops_report(result: StopMap) -> str:
    """What ranges, how many stop, and with which method."""
    tally = Tally.of(result.status)
    return _stops(result, result.status.shape, tally, result.method, result.table)


def map_report(result: Map) -> str:
    """What ranges, how runs end, and how exact they are."""
    error = f"{result.error_estimate:.1e} of Q/a (times), Q²/a (places)"
    model = f"; {result.model}; error <= {error} in the runs that were checked"
    return _ends(result, Tally.of(result.end), model, result.without_end())


def sample_report(result: Sample) -> str:
    """What scatters, and how runs end."""
    return _ends(result, Tally.of(result.end), "", result.without_end())


def _stops(
    launches: Any, shape: tuple[int, ...], tally: Tally, method: str, source: str
) -> str:  # fmt: skip
    ranged = " x ".join(f"{name} ({n})" for name, n in zip(launches.dims, shape, strict=True))
    units = {name: COLUMNS[name].unit for name in launches.fixed}
    fixed = ", ".join(
        f"{name} = {value:g}" + (f" {units[name]}" if units[name] != "1" else "")
        for name, value in launches.fixed.items()
    )
    counts = ", ".join(
        f"{tally.counts.get(code, 0)} {meaning.replace('_', ' ')}"
        for code, meaning in enumerate(STATUS_MEANINGS)
        if code == 0 or code in tally.counts
    )
    return f"{ranged or 'one launch'} at {fixed}: {counts}; {method}, {source}"


def _ends(ends: Any, tally: Tally, model: str, lines: Iterable[str]) -> str:
    """In one line, and one for each way in which runs have no end."""
    if spreads := getattr(ends, "spreads", None):  # of samples
        ranged = spread_words(ends.scene, spreads)
    else:
        ranged = " x ".join(f"{name} ({values.size})" for name, values in ends.axes.items())
    counts = ", ".join(f"{count} {ends.meanings[code]}" for code, count in tally.counts.items())
    return "\n".join([f"{ends.scene.title or 'scene'} over {ranged}: {counts}{model}", *lines])
