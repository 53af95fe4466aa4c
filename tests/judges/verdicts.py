"""Engine against judge: errors in scales of the slip, over tol times measured amplification."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from report import engine
from scene_truth import BORDER, BOUNCE, EDGE, LEANS, REST, truth

NUDGE = 1e-7
NAMES = ("x", "y", "orientation", "vx", "vy", "spin")
GAVE_UP = ("too many steps", "too many events", "a rough corner")


def known(
    scene: dict[str, Any], frames: int = 6, nudges: int = 2, limit: int = 300_000
) -> dict[str, Any] | None:
    """Truth at some moments, its scales, and how it amplifies; None: the judge gives up."""
    times = scene["time"] * np.linspace(0.13, 1.0, frames)
    best = truth(scene, times, limit=limit)
    if best["end"] == "over the edge":
        times = best["time"] * np.linspace(0.13, 1.0, frames)[:-1]
        best = truth(scene, times, limit=limit)
    if best["end"] in GAVE_UP:
        return None
    other = truth(scene, times, tol=3e-13, limit=limit)
    r = scene["puck"]["radius"]
    speed, rate = best["speed"], best["rate"]
    length = speed * speed / rate
    scale = np.array([length, length, length / r, speed, speed, speed / r])
    if other["states"].shape != best["states"].shape:
        return None
    calm = calm_at(times, best["events"], 1e-4 * speed / rate)
    doubt = off(other, best, scale, calm)
    rng, grown, stable = np.random.default_rng(5), 1.0, True
    for _ in range(nudges):
        way = rng.choice([-1.0, 1.0], 9)
        for sign in (1.0, -1.0):
            change = truth(scene, times, change=NUDGE * sign * way, limit=limit)
            if change["states"].shape != best["states"].shape or change["end"] in GAVE_UP:
                stable = False
                continue
            grown = max(grown, off(change, best, scale, calm) / NUDGE)
            stable = stable and kinds(change["events"]) == kinds(best["events"])
    best.update(
        times=times, scale=scale, amplification=grown, doubt=doubt, stable=stable, calm=calm,
        unit=speed / rate,
    )  # fmt: skip
    return best


def kinds(events: np.ndarray) -> list[tuple[float, float]]:
    """Lines that were met, in order, without the many small rebounds."""
    found: list[tuple[float, float]] = []
    for event in events:
        if event[1] in (BOUNCE, BORDER, EDGE, LEANS):
            what = (float(BOUNCE) if event[1] == LEANS else float(event[1]), float(event[2]))
            if not found or what != found[-1] or what[0] != BOUNCE:
                found.append(what)
    return found


def calm_at(times: np.ndarray, events: np.ndarray, room: float) -> np.ndarray:
    """Moments at which no impact is near, so that velocities can be compared."""
    hits = events[np.isin(events[:, 1], (BOUNCE, LEANS)), 0]
    if not len(hits):
        return np.ones(len(times), bool)
    return np.min(np.abs(times[:, None] - hits), axis=1) > room


def off(one: dict[str, Any], two: dict[str, Any], scale: np.ndarray, calm: np.ndarray) -> float:
    """The largest difference of two runs in units of the scales."""
    if not len(one["states"]):
        return 0.0
    error = np.abs(one["states"][:, :6] - two["states"][:, :6]) / scale
    worst = float(error[:, :3].max())
    if calm.any():
        worst = max(worst, float(error[calm, 3:].max()))
    return worst


def judged(
    scene: dict[str, Any], best: dict[str, Any], tol: float, folder: Path
) -> tuple[str, float, str]:
    """A word, the error over tol · max(1, amplification), and why."""
    run, words = engine(scene, tol, folder, best["times"])
    if run is None:
        return "refused", np.inf, words
    states = np.stack([run.columns[name] for name in NAMES], axis=1)
    short = len(states) < len(best["times"])
    allowed = tol * best["amplification"] + 10.0 * best["doubt"]
    if (run.end == "over the edge") != (best["end"] == "over the edge") and not short:
        return "end", np.inf, f"{run.end} at {run.end_time:.9g}; truth: {best['end']}"
    if short and (run.end_time < best["times"][-1] - 10.0 * allowed * best["unit"]):
        return "end", np.inf, f"{run.end} at {run.end_time:.9g}; truth: {best['end']}"
    count = len(states)
    room = max(1e-4, 30.0 * allowed) * best["unit"]
    calm = calm_at(best["times"], best["events"], room)[:count]
    share = (
        off({"states": states}, {"states": best["states"][:count]}, best["scale"], calm) / allowed
    )
    why = f"error {share * allowed:.2g}, allowed {allowed:.2g}"
    rests = best["events"][best["events"][:, 1] == REST]
    found = [event.time for event in run.events if event.what == "stick"]
    if run.end == "at rest" and len(rests) and found:
        # how long rebounds would have lasted that died out, to a factor of two
        after = 2.0 * (allowed + run.error_estimate)
        late = abs(found[-1] - rests[-1, 0]) / best["unit"] / after
        if late > share:
            share, why = late, f"rests at {found[-1]:.12g}; truth {rests[-1, 0]:.12g}"
    return ("right" if share <= 1.0 else "wrong"), share, why
