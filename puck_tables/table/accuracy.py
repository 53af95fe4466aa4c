"""The errors of a table: measured when it is built, and kept in its file."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from puck_tables._core.arrays import FloatArray


@dataclass(frozen=True)
class Accuracy:
    """Errors of a table that were measured, not promised, in the units of its kind.

    One entry a function: largest, root mean square and 99.9 % error over random and adversarial
    points, and where the largest stands: φ in radians, and the place on the second axis.
    ``promised``: the tolerance of the table is that of so many of the functions.  ``order``:
    against half as many cells; 0 where it was not measured.
    """

    largest: tuple[float, ...]
    rms: tuple[float, ...]
    p999: tuple[float, ...]
    at_phi: tuple[float, ...]
    at_second: tuple[float, ...]
    promised: int
    order: float
    points: int

    @property
    def worst(self) -> float:
        """The largest error of what the tolerance is promised for."""
        return max(self.largest[: self.promised])

    @classmethod
    def of(
        cls, errors: FloatArray, phi: FloatArray, second: FloatArray, coarse: FloatArray | None
    ) -> Accuracy:
        """From errors (functions, points) at points; ``coarse``: those with half as many cells.

        >>> places = np.array([0.1, 0.2])
        >>> Accuracy.of(np.array([[1e-9, 1e-8]]), places, places, np.array([[1.0, 1.6e-7]])).at_phi
        (0.2,)
        """
        where = np.where(np.isnan(errors), np.inf, errors).argmax(axis=1)
        largest = errors[np.arange(len(errors)), where]
        order = 0.0 if coarse is None else float(np.log2(coarse.max() / errors.max()))
        return cls(
            tuple(largest.tolist()), tuple(np.sqrt((errors**2).mean(axis=1)).tolist()),
            tuple(np.quantile(errors, 0.999, axis=1).tolist()), tuple(phi[where].tolist()),
            tuple(second[where].tolist()), len(errors), order, phi.size,
        )  # fmt: skip

    def text(self) -> str:
        """The measured errors in JSON."""
        return json.dumps(asdict(self))

    @classmethod
    def read(cls, text: str) -> Accuracy:
        """From the JSON of a file."""
        stated: dict[str, Any] = json.loads(text)
        stated |= {name: tuple(v) for name, v in stated.items() if isinstance(v, list)}
        return cls(**stated)
