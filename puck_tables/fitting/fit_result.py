"""What a fit found, as a result."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from puck_tables._core.arrays import FloatArray, instance
from puck_tables._core.doubts import unquestioned
from puck_tables._core.lazy import above
from puck_tables._core.safe_write import write_bytes
from puck_tables._version import __version__
from puck_tables.errors import InputError
from puck_tables.fitting.certainty import profile_point
from puck_tables.fitting.coupled_fit import Impact
from puck_tables.fitting.estimate import Estimate
from puck_tables.fitting.fit_spec import INTEGRATED
from puck_tables.fitting.forecast import HeldOut
from puck_tables.fitting.law_scores import LawScore, verdict
from puck_tables.fitting.numbers import KIND, EstimatedLaunch, Number, as_json, refuse_unplayable
from puck_tables.fitting.observations import Observations
from puck_tables.fitting.problem import Known
from puck_tables.fitting.remarks import Remarked
from puck_tables.fitting.slowing import law_over
from puck_tables.io.columns import Dataset, Variable, variable
from puck_tables.io.formats import FORMATS, ending_of
from puck_tables.puck import Puck
from puck_tables.result import Result

if TYPE_CHECKING:
    from puck_tables.trajectory import Trajectory


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Fit(Remarked, Result):
    """A puck and its launches, found from tracks.

    ``numbers``: :class:`Number` by name (``fit["friction"]``): found, following from what was
    found, or known; ``launches``: one for each slide.  ``chi2`` over ``degrees`` of freedom;
    ``noise`` (m, rad) and ``jitter`` (s, of time stamps), those of the residuals unless
    ``noise_known``; ``outliers``: share of the observations that are left out; ``left_out``:
    (track, frames at its start, at its end) that are no free motion; ``cut_off``: a sentence where
    these are many, with what they would change; ``runs``, ``drift``: probabilities of residuals so
    patterned by chance; ``blind``: a sentence for each thing that the tracks do not tell;
    ``astray``: why nobody would believe what was found, empty where somebody may; ``laws``:
    :class:`LawScore` of those compared, best first; ``held_out``: how well frames that were held
    out are predicted; ``impacts``: :class:`Impact` of those looked for; ``untied``: why they do not
    join the slides, empty where they do; ``not_met``: a sentence for each wall given on which there
    is none. ``forces``: what a table out of level, drag or air would do to it; ``uncut``: the
    tracks with frames that are no free motion; ``misfit``: what else tracks, floor or radius may
    be, if that fits better; ``constant_chi2``: χ² of one friction for all slip speeds, where one
    over them was found.
    """

    chi2: float
    degrees: int
    noise_known: Known
    runs: float
    left_out: tuple[tuple[str, int, int], ...]
    cut_off: str
    blind: tuple[str, ...]
    laws: tuple[LawScore, ...]
    held_out: HeldOut | None
    impacts: tuple[Impact, ...]
    constant_chi2: float
    uncut: tuple[Observations, ...]
    astray: str

    picture: ClassVar[str] = "fit"

    def __repr__(self) -> str:
        words = ", ".join(
            f"{name} not determined" if not number.determined
            else f"{name} {number.shown} at its bound" if number.at_bound
            else f"{name} {number.value:.6g} +- {number.error:.2g}"
            for name, number in self.numbers.items() if number.how == "found"
        )  # fmt: skip
        return f"Fit({words or 'launches alone'}; {len(self.launches)} tracks)"

    def __getitem__(self, name: str) -> Number:
        """A number of the puck by its name."""
        if name not in self.numbers:
            raise InputError(f"there is no '{name}': this fit has {', '.join(self.numbers)}")
        return self.numbers[name]

    @property
    def puck(self) -> Puck:
        """The puck that was found; of what is not determined, the value that fits best."""
        values = {name: number.value for name, number in self.numbers.items()}
        contact: dict[str, Any] = {"base": self.estimate.problem.spec.base}
        if contact["base"] is None:
            contact = {"radius": values["radius"], "pressure": self.given.body.law}
        if self.numbers.get("inner") and self.numbers["inner"].how == "found":
            contact["pressure"] = f"annulus:{values['inner']!r}"
        contact |= {name: values[name] for name in ("height", "friction", "gravity", "gyration")}
        with unquestioned():  # what nobody would believe of it the remarks say
            return Puck(**contact, mass=self.given.mass)

    @property
    def contact(self) -> tuple[str, str]:
        """How the puck touches the floor: what is said of it, and that."""
        if (base := self.estimate.problem.spec.base) is not None:
            return "base", f"{base.name}, whose reach is the radius r"
        return "pressure", self.puck.body.law.name

    @property
    def drag(self) -> float:
        """Drag of speed and spin besides dry friction, 1/s."""
        return self.numbers["drag"].value if "drag" in self.numbers else 0.0

    def launch(self, track: int | str = 0) -> EstimatedLaunch:
        """The launch of a track, by its number from 0 or its name.

        Raises
        ------
        InputError
        """
        names = [launch.name for launch in self.launches]
        if isinstance(track, str):
            if track not in names:
                raise InputError(f"there is no track '{track}': there are {', '.join(names)}")
            return self.launches[names.index(track)]
        instance("track", track, int, np.integer)
        if not -len(names) <= track < len(names):
            raise InputError(f"track must be from 0 to {len(names) - 1}, got {track}")
        return self.launches[track]

    def simulate(self, track: int | str = 0, **how: Any) -> Trajectory:
        """The motion of a track as it was found, until the puck stops.

        ``how``: as :meth:`Puck.simulate` takes it.  A puck on a base begins at the angle of its
        track.

        Raises
        ------
        InputError
            If there is no such track, or nobody would believe what was found, or the puck was found
            with drag: then only a scene has it.
        """
        launch = self.launch(track)
        numbers, spec = self.numbers, self.estimate.problem.spec
        drags = {name: numbers[name].value for name in ("drag", *INTEGRATED) if name in numbers}
        refuse_unplayable(drags, spec.speeds, self.astray)
        if spec.base is not None:
            how = {"orientation": launch.angle, **how}
        return self.puck.simulate(launch.velocity, launch.spin, **how)

    def report(self, path: str | Path, overwrite: bool = False) -> None:
        """Write one page for a class: pictures, numbers, residuals, what was assumed, and blanks.

        Parameters
        ----------
        path : .html; it loads nothing, and prints well
        overwrite : whether an existing file may be replaced

        Raises
        ------
        InputError
            If the ending is another.
        MissingExtraError
            If matplotlib is not installed.
        OutputError
            If the file exists or cannot be written.
        """
        above("save_page")(above("fit_page"), self, path, overwrite)

    @property
    def verdict(self) -> str:
        """Which of the laws compared the film supports, in a sentence; '' where none were."""
        return verdict(self.laws)

    def explain(self) -> str:
        """How it was found."""
        place, angle = (
            "given" if known else "that of the residuals" for known in self.noise_known[:2]
        )
        problem = self.estimate.problem
        lines = [
            f"Least squares by steps of Levenberg and Marquardt: {self.estimate.x.size} "
            f"unknowns from {self.estimate.residuals.size} residuals.",
            f"Noise of places {self.noise[0]:.3g} m, {place}.",
            *([f"Noise of angles {self.noise[1]:.3g} rad, {angle}."] if problem.angled else []),
            f"{100.0 * self.outliers:.3g} % of the observations, beyond 4 standard deviations, are "
            "left out: farther off where few frames tell the noise.",
        ]
        if math.isfinite(self.certainty.degrees):
            lines.append(
                f"Intervals are {self.certainty.reach:.3g} standard errors to either side: "
                f"Student's t of {self.certainty.degrees:.0f} degrees of freedom, which told the "
                "noise."
            )
        if self.certainty.widened:
            lines.append(
                "The model may not fit, or a number lies on the end of its range: standard errors "
                "are widened by what halves, quarters and eighths of the frames do to the numbers."
            )
        if "readout" in problem.spec.free and problem.read_within is not None:
            half = 500.0 * problem.read_within
            lines.append(
                f"A picture is taken to be read before the next one: a prior of {half:.3g} +- "
                f"{half:.3g} ms for readout, unless a prior or bounds are given."
            )
        profiled = [name for name, number in self.numbers.items() if number.profiled]
        if profiled:
            lines.append(f"Intervals by profile likelihood: {', '.join(profiled)}.")
        if self.estimate.problem.tall:
            lines.append("Part of the base may lift (delta > 1).")
        return "\n".join(lines)

    def summary(self) -> dict[str, Any]:
        """Everything but the frames, ready for JSON; None for what is not determined."""
        summary: dict[str, Any] = {
            "kind": KIND, "source": f"puck-tables {__version__}", "puck": self.puck.described(),
            "drag": self.drag,
            "numbers": self.numbers, "launches": self.launches,
            "correlation": self.correlation(), "chi2": self.chi2, "degrees": self.degrees,
            "noise": self.noise, "noise_given": self.noise_known[:2],
            "jitter": self.jitter, "jitter_given": self.noise_known.jitter,
            "outliers": self.outliers, "left_out": self.left_out, "cut_off": self.cut_off,
            "runs": self.runs, "drift": self.drift, "not_determined": self.blind,
            "astray": self.astray, "doubts": self.doubts, "remarks": self.remarks,
            "complaints": self.complaints, "laws": self.laws, "verdict": self.verdict,
            "held_out": None, "slip_speeds": self.estimate.problem.spec.speeds,
            "between": self.estimate.problem.spec.between,
            "constant_chi2": self.constant_chi2, "untied": self.untied, "impacts": self.impacts,
        }  # fmt: skip
        if self.held_out is not None:
            summary["held_out"] = {
                "tracks": self.held_out.tracks, "rms": self.held_out.rms,
                "rms_by_chance": self.held_out.chance, "inside": self.held_out.inside,
            }  # fmt: skip
        return {name: as_json(value) for name, value in summary.items()}

    def correlation(self) -> dict[str, dict[str, float]]:
        """Correlations of the numbers of the puck that were found."""
        names, matrix = self.estimate.problem.spec.free, self.certainty.correlation
        return {
            one: {other: float(matrix[i, k]) for k, other in enumerate(names)}
            for i, one in enumerate(names)
        }

    def profile(
        self, name: str, points: int = 9, reach: float = 3.0
    ) -> tuple[FloatArray, FloatArray]:
        """By how much χ² rises when one number of the puck is held at other values.

        Parameters
        ----------
        name : of a number that was found
        points : how many values
        reach : how far they go to either side, in standard errors, within the range of the number

        Returns
        -------
        values (n,), rises (n,)

        Raises
        ------
        InputError
        """
        free = self.estimate.problem.spec.free
        if name not in free:
            raise InputError(f"'{name}' was not found: there are {', '.join(free) or 'none'}")
        k, number = free.index(name), self.numbers[name]
        best, (low, high) = self.estimate, (float(ends[k]) for ends in self.estimate.problem.limits)
        error = next(filter(math.isfinite, (number.error, high - low, abs(number.value))))
        ends = max(low, number.value - reach * error), min(high, number.value + reach * error)
        values = np.linspace(*ends, points)
        costs = [profile_point(best, self.certainty, k, at, best.x)[0] for at in values.tolist()]
        return values, np.maximum(np.array(costs) - best.chi2, 0.0)

    def friction_over(
        self, speed: FloatArray | None = None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The friction coefficient over slip speed, with its standard error.

        As rows of a scene's law, with the first two, these numbers mean the same there, unless they
        were found with ``between="linear"``: a law of rows is cubic.

        Parameters
        ----------
        speed : (n,), m/s; those at which it was found where they are left out

        Returns
        -------
        speeds (n,) m/s, f (n,), standard errors (n,)

        Raises
        ------
        InputError
            If one friction for all slip speeds was found, or a speed is outside the law.
        """
        spec = self.estimate.problem.spec
        if not spec.speeds:
            raise InputError("one friction for all slip speeds was found: give slip_speeds to fit")
        at = np.array(spec.speeds) if speed is None else np.asarray(speed, float)
        return at, *law_over(self.estimate, self.certainty.covariance, at)

    def dataset(self) -> Dataset:
        """Frames with what was seen, the model and the residuals; the rest as attributes."""
        attributes = {
            "title": "A puck found from tracks", "chi2": self.chi2, "degrees": self.degrees,
            "noise": list(self.noise), "outliers": self.outliers, "runs": self.runs,
            "drift": self.drift, **self.puck.described(),
        }  # fmt: skip
        texts = {"summary": (json.dumps(self.summary()), "all that was found, as JSON")}
        columns = {**_frames(self.estimate), **_number_columns(self.numbers)}
        return Dataset({}, columns, attributes, texts)

    def save(self, path: str | Path, overwrite: bool = False) -> None:
        """Write .json (for ``puck simulate --fit``), or .h5, .csv, .jsonl, .parquet (the frames).

        Raises
        ------
        InputError, MissingExtraError, OutputError
            As of every result.
        """
        instance("path", path, str, Path)
        if Path(path).suffix.lower() == ".json":
            text = json.dumps(self.summary(), indent=1, allow_nan=False) + "\n"
            write_bytes(path, text.encode(), overwrite)
            return
        ending_of(path, FORMATS)
        super().save(path, overwrite)


_FRAMES = (
    "track", "frame", "time", "seen_x", "seen_y", "seen_angle", "fit_x", "fit_y", "fit_angle",
    "counts_place", "counts_angle",
)  # fmt: skip


def _frames(result: Estimate) -> dict[str, Variable]:
    """Columns of all frames: what was seen, the model, and whether it counts."""
    problem, kept = result.problem, result.kept
    rows: dict[str, list[Any]] = {name: [] for name in _FRAMES}
    parts = zip(problem.films, problem.paths(result.x), problem.each(), strict=True)
    for n, (film, path, (x, _, turn)) in enumerate(parts):
        counts = np.zeros(film.time.size, np.int8)
        counts[np.isfinite(film.angles)] = kept[turn]
        values = (
            np.full(film.time.size, n), film.frame, film.start + film.time, film.place[:, 0],
            film.place[:, 1], film.angles, *path, kept[x].astype(np.int8), counts,
        )  # fmt: skip
        for name, value in zip(rows, values, strict=True):
            rows[name].append(value)
    return {
        name: variable(name, np.concatenate(values), ("observation",))
        for name, values in rows.items()
    }


def _number_columns(numbers: Mapping[str, Number]) -> dict[str, Variable]:
    """Columns of the numbers of the puck."""
    known = {name: number for name, number in numbers.items() if math.isfinite(number.value)}
    columns = {"number_name": variable("number_name", list(known), ("number",))}
    for what in ("value", "error", "low", "high"):
        of_all = np.array([getattr(number, what) for number in known.values()])
        columns[f"number_{what}"] = variable(f"number_{what}", of_all, ("number",))
    return columns
