"""Where and when bodies stop, to 1e-11, stones to 1e-9: launches of a box and of a curling stone.

    python tests/golden/make_body_starts.py

writes ``tables/body_starts.npz``, which the program ships: an array (6, n) for each body, vx, vy
(m/s), ω (rad/s), and the time (s) and place (m) of the stop.  Nothing of the program is used:
scipy's DOP853 over friction by ``tests/judges/base_judge.py``; where friction changes with the slip
speed f(|ω| R) is summed along every ray from the instantaneous centre by Gauss' rule.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "judges"))
from base_judge import Judge  # noqa: E402

COUNT, OF_STONES = 24, 12
G = 9.80665
X, Y = 0.1, 0.05
BOX = [[-X, -Y], [X, -Y], [X, Y], [-X, Y]]
K = float(np.hypot(X, Y) / np.sqrt(3.0))
_NODE, _WEIGHT = np.polynomial.legendre.leggauss(40)
_NODE, _WEIGHT = 0.5 * (_NODE + 1.0), 0.5 * _WEIGHT


class LawJudge(Judge):
    """A base whose friction changes with the slip speed; ``lever`` is the height, m."""

    def __init__(self, law: Callable[[np.ndarray], np.ndarray], *base: object) -> None:
        super().__init__(*base)
        self.law, self.unit = law, 1.0  # m/s, of the velocities that a slide is told in

    def friction_at(self, speed: np.ndarray) -> np.ndarray:
        return self.law(self.unit * speed)

    def along_rays(self, far: np.ndarray, w: float) -> list[np.ndarray]:
        # the law bends near the centre: nodes crowd there, R = far t²
        along = far[:, None] * _NODE**2
        pull = self.friction_at(w * along) * 2.0 * _NODE * _WEIGHT * far[:, None]
        return [(pull * along**n).sum(axis=1) for n in (1, 2, 3)]


def stribeck(u: np.ndarray) -> np.ndarray:
    return 0.2 + 0.15 * np.exp(-u / 0.1)


REST = 0.00200985 / 0.06385782 + 0.00626286


def curling(u: np.ndarray) -> np.ndarray:
    """Over that at rest."""
    return (0.00200985 / (u + 0.06385782) + 0.00626286) / REST


def main() -> None:
    rng = np.random.default_rng(38)
    band = [(0.0, 0.0, 0.0635, 1.0), (0.0, 0.0, 0.0555, -1.0)]
    bodies = {
        "box": (Judge([BOX], [], 0.25 * 0.02, K), 0.25 * G, 1e-13),
        "box, friction falls with speed": (LawJudge(stribeck, [BOX], [], 0.0, K), G, 1e-13),
        "curling stone": (LawJudge(curling, [], band, 0.057 * REST, 0.1025), REST * G, 1e-11),
    }
    found = {}
    for name, (judge, decel, rtol) in bodies.items():
        rows = []
        for _ in range(OF_STONES if name == "curling stone" else COUNT):
            speed, way = rng.uniform(0.5, 2.5), rng.uniform(0.0, 2.0 * np.pi)
            spin = rng.choice([-1.0, 1.0]) * speed / judge.k * np.exp(rng.uniform(-3.0, 1.5))
            velocity = (float(speed * np.cos(way)), float(speed * np.sin(way)))
            if isinstance(judge, LawJudge):
                judge.unit = float(np.hypot(speed, judge.k * spin))
            rows.append([*velocity, spin, *judge.slide(velocity, spin, decel, rtol)[:3]])
            print(name, np.round(rows[-1], 4), flush=True)
        found[name] = np.array(rows).T
    np.savez(HERE.parent.parent / "tables" / "body_starts.npz", **found)


if __name__ == "__main__":
    main()
