"""Every engine against every case, with one command: a table and a picture.

    pip install ".[plot]" && pip install -r docs/engines/requirements.txt
    python docs/engines/run_all.py FOLDER

Engines in an environment of their own: --python /path/to/its/python.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
import time
from collections import defaultdict
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

import puck_tables as pt
from puck_tables.errors import PuckError
from puck_tables.kernels.patience import compiled_at_once
from puck_tables.plot.style import COLORS, canvas, save_figure
from puck_tables.reference.cases import CASES

HERE = Path(__file__).resolve().parent
SHOWN = ("coin", "slide-spin-2", "tall-0.5", "box")
FEET = 61  # of with_mujoco_feet.py
PLASTIC = (0.7548776662466927, 0.5698402909980532)
MANY = 100_000  # launches at once
OURS = (1e-3, 1e-5, 1e-7, 1e-9)  # tol; the cases have 1e-11


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--python", default=sys.executable)
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    folder = given.folder.resolve()
    cases = {case.name: pt.reference_case(case.name, times=[0.0]).summary() for case in CASES}
    for case in cases.values():
        describe(case["scene"]["puck"])
    (folder / "cases.json").write_text(json.dumps(cases))
    subprocess.run([given.python, "-W", "ignore", "play.py", str(folder)], cwd=HERE, check=True)
    rows = measured(folder, cases)
    (folder / "measured.json").write_text(json.dumps(rows, indent=1))
    (folder / "table.md").write_text(table(rows))
    draw(rows, cases, folder / "engines.png")
    print((folder / "table.md").read_text())


def describe(puck: Any) -> None:
    """Say of a puck on a base what engines need of it, see task.py."""
    if isinstance(puck, list) or not puck.get("base"):
        return
    named = {name: puck[name] for name in ("friction", "mass", "gravity", "height", "gyration")
             if name in puck}  # fmt: skip
    body = pt.Puck(base=puck["base"], **named)
    base = body.shape
    middle = np.array(base.middle)
    parts = [(np.array(outline) - middle).tolist() for outline in base.outlines]
    parts += [[x - middle[0], y - middle[1], r] for x, y, r, _ in base.discs]
    area, _, second = base.about_centre
    torque = abs(body.wrench((0.0, 0.0), 1.0).torque)
    puck["solid"] = {
        "parts": parts, "points": spread(parts, base.reach, FEET), "reach": base.reach,
        "gyration": body.gyration, "arm": float(torque / (body.mass * body.decel)),
        "square": (np.diag(second) / area).tolist(), "area": float(area),
    }  # fmt: skip


def spread(parts: list[Any], reach: float, count: int) -> list[list[float]]:
    """So many places spread evenly over parts of a base: a sequence of low discrepancy."""
    found: list[list[float]] = []
    n = 0
    while len(found) < count:
        n += 1  # by powers of the plastic number
        x, y = (reach * (2.0 * ((0.5 + n * step) % 1.0) - 1.0) for step in PLASTIC)
        if any(is_in(part, x, y) for part in parts):
            found.append([x, y])
    return found


def is_in(part: Any, x: float, y: float) -> bool:
    """Whether a place lies in a disc or in a convex polygon."""
    if isinstance(part[0], float):
        return math.hypot(x - part[0], y - part[1]) <= part[2]
    ahead = part[1:] + part[:1]
    return all(
        (bx - ax) * (y - ay) >= (by - ay) * (x - ax)
        for (ax, ay), (bx, by) in zip(part, ahead, strict=True)
    )


def measured(folder: Path, cases: dict[str, Any]) -> list[dict[str, Any]]:
    """A row for each engine, case and step: errors in shares of Q²/J and Q/J, and the cost."""
    groups = defaultdict(list)
    for run in json.loads((folder / "played.json").read_text()):
        groups[run["engine"], run["case"]].append(run)
    rows = []
    for (engine, name), runs in groups.items():
        q, j = cases[name]["speed_scale"], cases[name]["rate_scale"]
        try:
            found = pt.compare(
                [folder / run["file"] for run in runs], name, steps=[run["step"] for run in runs],
                up="z" if runs[0]["in_space"] else None, puck="red" if name == "take-out" else None,
            )  # fmt: skip
        except PuckError as error:
            print(f"{engine}, {name}: {error}")
            continue
        cost = {run["step"]: run["seconds"] for run in runs}
        for row in found.rows():
            rows.append({
                "engine": engine, "case": name, "step": row["step"],
                "cost_ms": 1e3 * cost[row["step"]],
                "place": row["place_error_max"] / (q * q / j),
                "time": _number(row["rest_time_error"] / (q / j)),
                "falls": found.convergence().get("place on the way", ""),
            })  # fmt: skip
    return rows


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def table(rows: list[dict[str, Any]]) -> str:
    """Error of place and of the stop time, in per cent, and cost, at the finest step."""
    engines = list(dict.fromkeys(row["engine"] for row in rows))
    cells: dict[str, dict[str, str]] = defaultdict(dict)
    for row in rows:  # the last of a case has the smallest step
        late = "–" if row["time"] is None else f"{100 * row['time']:+.2f}"
        cells[row["case"]][row["engine"]] = (
            f"{100 * row['place']:.3f} / {late} / {row['cost_ms']:.3g}"
        )
    head = "| case | " + " | ".join(engines) + " |\n" + "| --- " * (len(engines) + 1) + "|\n"
    return head + "".join(
        f"| {case} | " + " | ".join(by.get(engine, "–") for engine in engines) + " |\n"
        for case, by in cells.items()
    )


@compiled_at_once()
def ours(case: dict[str, Any]) -> list[tuple[float, float]]:
    """Cost in ms and error of place of this program: of many at once, then of one by tol."""
    tables, launch = dict(case["scene"]["puck"]), case["scene"]["launch"]
    tables.pop("solid", None)
    puck, angle = pt.Puck(**tables), launch["orientation"]
    back = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    velocity = back @ launch["velocity"]  # in the axes of the puck
    exact = back @ [case["stop"]["x"], case["stop"]["y"]]
    length = case["speed_scale"] ** 2 / case["rate_scale"]
    many, spins = np.tile(velocity, (MANY, 1)), np.full(MANY, launch["spin"])
    puck.stop(many, spins)
    begin = time.process_time()
    found = puck.stop(many, spins)
    cost = (time.process_time() - begin) * 1e3 / MANY
    points = [(cost, float(np.hypot(*(found.stop_position[0] - exact))) / length)]
    for tol in OURS:
        puck.simulate(velocity, launch["spin"], frames=1, tol=tol)
        took = []
        for _ in range(15):
            begin = time.process_time()
            for _ in range(10):
                run = puck.simulate(velocity, launch["spin"], frames=1, tol=tol)
            took.append(0.1 * (time.process_time() - begin))
        off = float(np.hypot(*(np.array(run.stop_position) - exact))) / length
        points.append((1e3 * median(took), off))
    return points


def draw(rows: list[dict[str, Any]], cases: dict[str, Any], path: Path) -> None:
    """Error over cost, a line an engine, a point a step."""
    figure = canvas(11.0, 8.0)
    engines = list(dict.fromkeys(row["engine"] for row in rows))
    for panel, name in zip(figure.subplots(2, 2).ravel(), SHOWN, strict=True):
        for n, engine in enumerate(engines):
            mine = [row for row in rows if (row["engine"], row["case"]) == (engine, name)]
            panel.loglog(
                [row["cost_ms"] for row in mine], [max(row["place"], 1e-16) for row in mine], "o-",
                markersize=4, label=engine, color=(*COLORS, "#555555", "#c9a400")[n],
            )  # fmt: skip
        looked_up, *points = ours(cases[name])
        panel.loglog(
            [cost for cost, _ in points], [max(off, 1e-16) for _, off in points], "ks-",
            markersize=4, label="puck-tables, tol 1e-3 to 1e-9",
        )  # fmt: skip
        panel.loglog(
            looked_up[0], max(looked_up[1], 1e-16), "k^", label="puck-tables, of 1e5 at once, each"
        )
        panel.set_title(name)
        panel.set_xlabel("cost of the run / ms")
        panel.set_ylabel("largest error of the place / (Q²/J)")
        panel.grid(color="#e4e4e4", linewidth=0.6)
    figure.legend(*panel.get_legend_handles_labels(), loc="outside lower center", ncols=4,
                  frameon=False)  # fmt: skip
    save_figure(figure, path, overwrite=True)


if __name__ == "__main__":
    main()
