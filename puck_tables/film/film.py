"""What a file holds before anything is done to it: marks on bodies, frame by frame."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from puck_tables._core.arrays import FloatArray

Flags = npt.NDArray[np.bool_]


@dataclass
class TrackedBody:
    """The rows of one body: a puck, or marks of which each is one.

    Parameters
    ----------
    name : str
        '' where the file has none.
    marks : dict of ndarray (n, 2)
        Places by the names of the marks, in the unit and along the axes of the file.
    frame, time : ndarray (n,), optional
        Frame numbers; times in s.
    angles : dict of ndarray (n,)
        Of the body that a mark is of, in the unit of the file; under '' of all.
    likelihoods, seen : dict of ndarray (n,)
        The same for how likely a place is, and whether it is one.
    """

    name: str
    marks: dict[str, FloatArray]
    frame: FloatArray | None = None
    time: FloatArray | None = None
    angles: dict[str, FloatArray] = field(default_factory=dict)
    likelihoods: dict[str, FloatArray] = field(default_factory=dict)
    seen: dict[str, Flags] = field(default_factory=dict)


@dataclass
class Film:
    """All bodies of a file, and what it says of them.

    Parameters
    ----------
    kind : str
        Of file, for messages.
    bodies : list of Body
    unit, angle_unit : str
        Of places and angles; '' where the file does not say.
    y_down : bool, optional
        Whether y grows downwards in it; None where it does not say.
    jointed : bool
        Whether the marks of a body are parts of it rather than pucks of their own.
    timed : bool
        Whether it names the unit of its times.
    likely : float, optional
        The likelihood below which the writer of such files takes a place for none.
    notes : list of str
        What was found, in sentences.
    """

    kind: str
    bodies: list[TrackedBody]
    unit: str = ""
    angle_unit: str = ""
    y_down: bool | None = None
    jointed: bool = False
    timed: bool = True
    likely: float | None = None
    notes: list[str] = field(default_factory=list)
