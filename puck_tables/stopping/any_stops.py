"""Stops of launches of every puck: any pressure law, any radius of gyration, part lifted.

For each height among the launches there is a stop slice, looked up, where they are many; where they
are few they are integrated.  Both are made before the first launch is answered and depend on the
kind of puck alone, so that the numbers do not depend on how the work is cut.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.executor import Progress, in_slices, run_chunks
from puck_tables._core.real import rounded_up
from puck_tables.accuracy.front import ADAPTIVE_EXACT, LOOK_UP, RK4_EXACT, Choice, choose
from puck_tables.contact.laws import Law, law_of
from puck_tables.contact.resultants import checked_delta
from puck_tables.errors import AccuracyError, InputError
from puck_tables.motion.body import Body, body_of
from puck_tables.motion.sliced import LOOSEST_LOCAL, checked_tol, friction_of, unseen_tail
from puck_tables.stopping.solvers import METHODS, OUTPUTS, fits
from puck_tables.stopping.stop_slice import FINEST_SLICE, StopSlice, stop_slice
from puck_tables.table.friction_slice import FINEST_ACCURACY
from puck_tables.table.resultant_table import ResultantTable

FloatArray = npt.NDArray[np.float64]
Status = npt.NDArray[np.int8]

MANY = 300  # launches of one kind from which on a stop slice costs less than integrating them
MOST_HEIGHTS = 500
HEIGHT_COST = 2000  # launches that take as long as the preparation of a height
_OVERFLOW = 2
_PROBES = 40
_FINEST_LOCAL, _MOST_STEPS = 1e-15, 4096


@dataclass(frozen=True)
class _Integrated:
    """One kind of puck, its stops to be integrated with a setting that was tried on it."""

    cut: FloatArray
    steps: float
    local: float
    error: float


class AnyStops:
    """Stops of the pucks of one law and radius of gyration, of any heights; a face of solvers.

    Parameters
    ----------
    pressure, gyration, tol, method, table
        As :func:`puck_tables.stop` takes them.
    """

    def __init__(
        self, pressure: str | Law, gyration: float, tol: float, method: str | None,
        table: ResultantTable | None = None,
    ) -> None:  # fmt: skip
        if method not in (None, *METHODS):
            raise InputError(f"method must be one of {', '.join(METHODS)}, got {method!r}")
        self.tol = checked_tol(tol)
        if method == LOOK_UP and self.tol < FINEST_SLICE:
            raise AccuracyError(
                f"tol must be from {FINEST_SLICE:g} on for look-up of such pucks, got {tol:g}: "
                "give a tol in that range, or another method"
            )
        self._law = pressure if isinstance(pressure, Law) else law_of(pressure)
        self._gyration = body_of(self._law, 0.0, gyration).gyration
        self._wanted, self._table = method, table
        self._ready: dict[float, StopSlice | _Integrated] = {}

    @property
    def source(self) -> str:
        """What the stops come from, in words."""
        of = "" if self._table is None else f" of {self._table.source}"
        return f"slices{of} of pressure {self._law.name}, k/r = {self._gyration:g}"

    @property
    def work(self) -> dict[str, Any]:
        """What determines the bits besides the launches."""
        phi = np.linspace(0.0, 0.5 * np.pi, 99)
        return {
            "by": self._wanted, "law": self._law.name, "edges": self._law.edges,
            "friction": np.stack(self._law.friction(phi, 0.0)), "profile": self._law.profile,
            "gyration": self._gyration, "tol": self.tol,
            "table": None if self._table is None else self._table.values,
        }  # fmt: skip

    @property
    def method(self) -> str:
        """'look-up', 'integrated' or both."""
        kinds = {isinstance(one, StopSlice) for one in self._ready.values()}
        names = [name for looked, name in ((True, LOOK_UP), (False, "integrated"))
                 if looked in kinds]  # fmt: skip
        return " and ".join(names)

    def checked_range(self, delta: npt.ArrayLike) -> FloatArray:
        """``delta`` as an array, refused where the friction is not known.

        Raises
        ------
        InputError, ContactError
        """
        height = checked_delta(delta)
        if height.size:
            body_of(self._law, float(height.max()), self._gyration, self._table)
        return height

    def prepare(
        self, delta: FloatArray, each: npt.ArrayLike, threads: int | None = None,
        progress: Progress | None = None,
    ) -> None:  # fmt: skip
        """Make what the launches need: ``each`` of every height ``delta`` (n,), all different."""
        if delta.size > MOST_HEIGHTS:
            raise InputError(
                f"{delta.size} different delta are too many for such pucks, each takes about a "
                f"second to prepare: give at most {MOST_HEIGHTS}"
            )
        counts = np.broadcast_to(each, delta.shape)

        def work(start: int, stop: int) -> None:
            for n in range(start, stop):
                self._ready[float(delta[n])] = self._made(float(delta[n]), int(counts[n]))

        run_chunks(work, delta.size, 1, threads, progress)

    def _made(self, delta: float, launches: int) -> StopSlice | _Integrated:
        body = body_of(self._law, delta, self._gyration, self._table)
        if self._wanted == LOOK_UP:
            return stop_slice(body, self.tol)
        if self._wanted is None and launches >= MANY and self.tol >= FINEST_SLICE:
            try:
                return stop_slice(body, self.tol)
            except AccuracyError:
                pass  # functions too steep for a spline; the integrator knows nothing of that
        return _settled(body, self.tol, self._wanted)

    @property
    def choice(self) -> Choice:
        """What the tolerance led to."""
        question = "stop"
        base = choose(question, 0.01, (RK4_EXACT if self._wanted == "rk4" else ADAPTIVE_EXACT,)).way
        error = max((one.error for one in self._ready.values()), default=0.0)
        looked = sum(isinstance(one, StopSlice) for one in self._ready.values())
        method = f"{LOOK_UP}, slice" if looked else base.method.replace("closed forms", "slice")
        lines = [
            f"asked         error <= {self.tol:.3g} of Q/J (times) and Q^2/J (places)",
            f"taken         {self.method}, {self.source}",
            f"heights       {looked} by stop slice ({MANY} launches or more), "
            f"{len(self._ready) - looked} integrated",
            f"measured      {error:.2g} at the worst, against integration of higher accuracy",
        ]
        return Choice(replace(base, method=method, setting="", error=error), self.tol,
                      "\n".join(lines))  # fmt: skip

    def first(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """The same as :meth:`all`: no part of it comes cheaper."""
        return self.all(launches)

    def all(self, launches: FloatArray) -> tuple[FloatArray, Status]:
        """All of the outputs of a stop (6, n) and status (n,) of launches (6, n)."""
        out = np.empty((len(OUTPUTS), launches.shape[1]))
        status = np.zeros(launches.shape[1], np.int8)
        for delta in np.unique(launches[3]):
            mine = launches[3] == delta
            out[:, mine], status[mine] = _answered(self._ready[float(delta)], launches[:, mine])
        lost = ~fits(launches, body_of(self._law, 0.0, self._gyration).longest)
        status[lost] = _OVERFLOW
        out[:, status != 0] = np.nan
        return out, status


def _answered(ready: StopSlice | _Integrated, launches: FloatArray) -> tuple[FloatArray, Status]:
    from puck_tables.motion.bulk import fill_stops
    from puck_tables.motion.steppers import DORMAND_PRINCE
    from puck_tables.stopping.slice_lookup import fill_slice_stops

    out = np.empty((len(OUTPUTS), launches.shape[1]))
    status = np.zeros(launches.shape[1], np.int8)
    if isinstance(ready, StopSlice):
        fill_slice_stops(launches, ready.spline.cut, out)
    else:

        def work(start: int, stop: int) -> None:
            some, part = np.ascontiguousarray(launches[:, start:stop]), out[:, start:stop].copy()
            fill_stops(
                some, DORMAND_PRINCE, ready.steps, ready.local, ready.cut, part,
                status[start:stop],
            )  # fmt: skip
            out[:, start:stop] = part

        in_slices(work, launches.shape[1])
    return out, status


def _settled(body: Body, tol: float, method: str | None) -> _Integrated:
    """A setting of the integrator good for every launch of a puck, tried at both sides of lines.

    Raises
    ------
    AccuracyError
        If none is.
    """
    stepper = RK4_EXACT if method == "rk4" else ADAPTIVE_EXACT
    known = choose("stop", tol, (stepper,)).way
    steps = known.number("steps") if method == "rk4" else 0.0
    local = 1.0 if method == "rk4" else min(known.number("local"), LOOSEST_LOCAL)
    accuracy = max(0.5 * tol, FINEST_ACCURACY)
    probes = _probes(body)
    while True:
        cut, coarse = (friction_of(body, accuracy, half).cut for half in (False, True))
        answers = [
            _answered(_Integrated(*setting, 0.0), probes)[0][:3]
            for setting in (
                (cut, steps, local), (cut, 2.0 * steps, max(0.01 * local, _FINEST_LOCAL)),
                (coarse, steps, local),
            )
        ]  # fmt: skip
        by_steps = 2.0 * (float(np.abs(answers[0] - answers[1]).max()) + unseen_tail(steps, local))
        by_slice = 2.0 * float(np.abs(answers[0] - answers[2]).max()) / 8.0
        if by_steps + by_slice <= tol:
            return _Integrated(cut, steps, local, by_steps + by_slice)
        if by_slice > by_steps and accuracy > FINEST_ACCURACY:
            accuracy = max(0.1 * accuracy, FINEST_ACCURACY)
        elif by_slice > by_steps or steps >= _MOST_STEPS or local <= _FINEST_LOCAL:
            raise AccuracyError(
                f"tol = {tol:g} is out of reach for these pucks: give tol (--tol) of "
                f"{rounded_up(2.0 * (by_steps + by_slice)):g} or more"
            )
        else:
            steps, local = 2.0 * steps, max(0.1 * local, _FINEST_LOCAL)


def _probes(body: Body) -> FloatArray:
    """Launches (6, n) with Q = J = r = 1: anywhere, and next to all lines and both ends."""
    lines = np.array([0.0, *body.friction(0.01).lines, 0.5 * np.pi])
    near = (lines[:, None] + np.outer([-1.0, 1.0], 10.0 ** -np.arange(1.0, 8.0)).ravel()).ravel()
    phi = np.concatenate([np.linspace(0.01, 1.56, _PROBES), near])
    phi = phi[(phi > 0.0) & (phi < 0.5 * np.pi)]
    one = np.ones(phi.size)
    return np.stack([np.cos(phi), 0.0 * one, np.sin(phi), body.delta * one, one, one])
