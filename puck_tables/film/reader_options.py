"""What is said of a file beside it: frames a second, units, marks and names."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from puck_tables._core.arrays import instance, positive, real
from puck_tables._core.units import PIXEL, pixel_size, unit_named
from puck_tables.errors import InputError
from puck_tables.film.film import UPS
from puck_tables.film.plane import Marks, Plane, plane_from


@dataclass(frozen=True)
class ReaderOptions:
    """What a reader says of a file; see :func:`puck_tables.film.track_files.read_tracks`."""

    fps: float | None = None
    unit: str | None = None
    scale: str | float | None = None
    angle_unit: str | None = None
    y_down: bool | None = None
    marks: Marks | None = None
    centre: str | Sequence[str] | None = None
    toward: str | None = None
    likelihood: float | None = None
    pucks: str | Sequence[str] | None = None
    up: str | None = None
    size: float | None = field(init=False, default=None)  # of a pixel in m
    plane: Plane | None = field(init=False, default=None)

    def __post_init__(self) -> None:
        def put(name: str, value: object) -> None:
            object.__setattr__(self, name, value)

        if self.fps is not None:
            put("fps", positive("fps", self.fps, "frames a second"))
        if self.unit is not None:
            put("unit", unit_named("unit", self.unit, "length"))
        if self.angle_unit is not None:
            put("angle_unit", unit_named("angle_unit", self.angle_unit, "angle"))
        if self.scale is not None:
            put("size", pixel_size(self.scale))
        if self.likelihood is not None:
            likelihood = real("likelihood", self.likelihood, "0 to 1")
            if not 0.0 <= likelihood <= 1.0:
                raise InputError(f"likelihood must be 0 to 1, got {likelihood:g}")
        if self.scale is not None and self.marks is not None:
            raise InputError("scale and marks both give the size of a pixel: give one of them")
        if (self.size is not None or self.marks is not None) and self.unit not in (None, PIXEL):
            which = "scale" if self.marks is None else "marks"
            raise InputError(f"{which} is for places in pixels: leave unit = '{self.unit}' out")
        if self.marks is not None:
            if self.y_down is not None:
                raise InputError(
                    "with marks the axes are those in which their places on the floor are given: "
                    "leave y_down out"
                )
            put("plane", plane_from(self.marks))
        if self.up is not None and self.up not in UPS:
            raise InputError(f"up must be the axis that points up, x, y or z, got {self.up!r:.40}")
        instance("y_down", self.y_down, bool, type(None))
        instance("toward", self.toward, str, type(None))
        for name in ("centre", "pucks"):
            option = getattr(self, name)
            names = option.split(",") if isinstance(option, str) else option
            if names is not None:
                instance(name, names, list, tuple)
                put(name, [str(one).strip() for one in names])
                if not names or not all(getattr(self, name)):
                    raise InputError(f"{name} must be names with commas, got {option!r:.40}")
        if self.toward is not None and self.centre is None:
            raise InputError(
                f"toward = '{self.toward}' needs centre, too: the mark, or the marks, in whose "
                "middle the centre of the puck lies"
            )
