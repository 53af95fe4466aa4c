"""Every engine that is installed plays every case that it can: python play.py FOLDER.

FOLDER holds cases.json, as run_all.py writes it; the logs go there, and played.json.
"""

from __future__ import annotations

import importlib
import json
import sys
from pathlib import Path

ENGINES = ("mujoco", "mujoco_feet", "drake", "pybullet", "pymunk", "box2d")
LONGER = 1.3  # than the exact motion, to see it come to rest


def main(folder: Path) -> None:
    cases = json.loads((folder / "cases.json").read_text())
    played = []
    for engine in ENGINES:
        try:
            adapter = importlib.import_module(f"with_{engine}")
        except ImportError as error:
            print(f"{engine} is left out: {error} (pip install -r requirements.txt)")
            continue
        for name, case in cases.items():
            if not adapter.can(case["scene"]):
                continue
            until = case["end_time"] * (1.0 if case["end"] == "time is up" else LONGER)
            for dt in adapter.STEPS:
                path = folder / f"{engine}-{name}-{dt:g}.csv"
                found = adapter.run(case["scene"], dt, until)
                found.write(path)
                played.append({
                    "engine": engine, "case": name, "step": dt, "file": path.name,
                    "seconds": found.seconds, "in_space": "qw" in found.header,
                    "settings": adapter.SETTINGS,
                })  # fmt: skip
            print(engine, name, f"{played[-1]['seconds'] * 1e3:.1f} ms", flush=True)
    (folder / "played.json").write_text(json.dumps(played))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
