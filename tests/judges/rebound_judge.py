"""Rebounds that settle: on slopes, under forces, on belts and turntables, smooth and rough walls.

The judge follows every rebound down to 1e-11 of the speed, in places measured from the wall; what
is left is one impact and a lean, with Coulomb's friction at the rim: what many small impacts give.

python tests/judges/rebound_judge.py --count 60 --seed 1 --tol 1e-9
"""

from __future__ import annotations

import math
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from report import arguments, table
from verdicts import judged, known

KINDS = ("slope", "force", "belt", "turntable")
STEEP = [0.0017, 0.02, 0.1]  # most of the speed is lost at once


def draw(seed: int, index: int) -> dict[str, Any]:
    """A puck that is driven against one wall; ``class``: of what kind."""
    rng = np.random.default_rng([seed, index, 7])
    kind, rough = KINDS[index % 4], bool(index // 4 % 2)
    restitution = float(rng.choice([*STEEP, 0.3, 0.5, 0.7, 0.8, 0.9, 0.97, 0.99, 0.999]))
    friction = float(rng.choice([0.0, 0.05, 0.1, 0.3]))
    if kind in ("belt", "turntable"):
        friction = max(friction, 0.05)
    radius = float(10.0 ** rng.uniform(-2.0, -1.0))
    mass = float(10.0 ** rng.uniform(-1.0, 0.5))
    weight = mass * 9.80665
    gap = float(10.0 ** rng.uniform(-2.0, -0.5))
    angle = rng.uniform(-math.pi, math.pi)  # of the way to the wall
    ahead = np.array([math.cos(angle), math.sin(angle)])
    left = np.array([-ahead[1], ahead[0]])
    scene: dict[str, Any] = {
        "class": f"{kind}, {'rough' if rough else 'smooth'}",
        "puck": {
            "radius": radius, "mass": mass, "gyration": float(rng.choice([0.5, 0.7071, 1.0])),
            "height": float(rng.choice([0.0, 0.0, 0.5])) * radius / max(2.0 * friction, 0.1),
            "friction": friction,
        },

        "launch": {},
    }  # fmt: skip
    extra = float(rng.choice([0.05, 0.3, 1.0]))  # acceleration, over friction
    lean = rng.choice([0.0, 0.2, -0.5, 1.0])
    pull = angle + lean
    strength = friction + extra
    if kind == "slope":
        scene["floor"] = {"slope": float(math.atan(strength)), "downhill": float(pull)}
        rate = 9.80665 * math.cos(math.atan(strength)) * extra
    elif kind == "force":
        force = strength * weight * np.array([math.cos(pull), math.sin(pull)])
        scene["force"] = {"constant": force.tolist()}
        if rng.random() < 0.4:
            scene["force"]["torque"] = float(0.1 * weight * radius * rng.normal())
        rate = 9.80665 * extra
    elif kind == "belt":
        belt = float(rng.choice([0.3, 2.0])) * (ahead + 0.3 * lean * left)
        scene["floor"] = {"velocity": belt.tolist()}
        rate = 9.80665 * friction
    else:
        turning = float(rng.choice([-1.0, 1.0]) * rng.uniform(1.0, 5.0))
        back = math.copysign(1.0, turning) * left * rng.uniform(0.2, 0.6)
        scene["floor"] = {"turning": turning, "centre": back.tolist()}
        rate = 9.80665 * friction
    speed = float(math.sqrt(2.0 * rate * gap) * rng.choice([0.0, 0.5, 2.0]))
    velocity = speed * (ahead + rng.choice([0.0, 0.3, -1.0]) * left)
    scene["launch"] = {
        "velocity": velocity.tolist(),
        "spin": float(rng.choice([0.0, 1.0, -5.0]) * max(speed, 0.3) / radius),
    }
    wall: dict[str, Any] = {
        "point": ((gap + radius) * ahead).tolist(), "normal": (-ahead).tolist(),
        "restitution": restitution,
    }  # fmt: skip
    if rough:
        wall["tangential"] = float(rng.choice([-0.93, -0.5, 0.0, 0.3, 0.5, 0.9, 1.0]))
        wall["friction"] = float(rng.choice([0.05, 0.2, 1.0]))
    elif rng.random() < 0.5:
        wall |= {"tangential": 0.0, "friction": 0.0}
    scene["wall"] = [wall]
    hit = math.hypot(speed, math.sqrt(2.0 * rate * gap))
    settle = 2.0 * hit / rate / (1.0 - restitution)
    scene |= {"time": float(1.3 * (hit / rate + min(settle, 60.0))), "frames": 1}
    return scene


def main() -> None:
    args = arguments(__doc__, [1e-6, 1e-9])
    rows: dict[tuple[str, float], list[float]] = {}
    faults, gave_up, clock = [], 0, time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        for index in range(args.count):
            scene = draw(args.seed, index)
            best = known(scene)
            if best is None or not best["stable"]:
                gave_up += 1
                continue
            for tol in args.tol:
                word, share, why = judged(scene, best, tol, Path(folder))
                row = rows.setdefault((scene["class"], tol), [0, 0, 0, 0.0])
                row[0] += 1
                row[1] += word in ("wrong", "end")
                row[2] += word == "refused"
                row[3] = max(row[3], share if math.isfinite(share) else 0.0)
                if word != "right":
                    faults.append((
                        f"{word}: {scene['class']}",
                        f"tol {tol:g}, index {index}, {share:.3g}× (amplification "
                        f"{best['amplification']:.3g}): {why}", scene,
                    ))  # fmt: skip
    table(
        ["class", "tol", "scenes", "wrong", "refused", "largest error / allowed"],
        [[*key, *row[:3], f"{row[3]:.3g}"] for key, row in sorted(rows.items())], faults, args.show,
    )  # fmt: skip
    print(f"\nthe judge gave up on {gave_up} of {args.count}; {time.perf_counter() - clock:.0f} s")


if __name__ == "__main__":
    main()
