"""Files as Tracker and SLEAP write them, made here: the shapes are those of real ones."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import h5py
import numpy as np

_CORE, _OWN = "org.opensourcephysics.media.core", "org.opensourcephysics.cabrillo.tracker"


def _values(values: Mapping[str, object]) -> str:
    kinds = {int: "int", float: "double", str: "string", bool: "boolean"}
    return "".join(
        f'<property name="{name}" type="{kinds[type(value)]}">{value}</property>\n'
        for name, value in values.items()
    )


def _object(kind: str, inside: str) -> str:
    return f'<object class="{kind}">\n{inside}</object>\n'


def _held(name: str, inside: str, kind: str = "object") -> str:
    return f'<property name="{name}" type="{kind}">\n{inside}</property>\n'


def _frames(kind: str, frames: Mapping[int, Mapping[str, object]]) -> str:
    items = "".join(
        _held(f"[{n}]", _object(f"{kind}$FrameData", _values(values)))
        for n, values in frames.items()
    )
    return _held("framedata", items, "array")


def trk(
    masses: Mapping[str, Mapping[int, tuple[float, float]]],
    axes: Mapping[int, tuple[float, float, float, float]],
    *, unit: str = "m", duration: float | None = 4.0, start: int = 0, step: int = 1,
) -> str:  # fmt: skip
    """A tab of Tracker: pixels of point masses by frame, axes (u0, v0, degrees, scale) by frame."""
    clip = _values({"startframe": start, "stepsize": step, "stepcount": 9, "starttime": 0.0})
    timing = _values({"rate": 1.0} | ({} if duration is None else {"delta_t": duration}))
    system = _frames(f"{_CORE}.ImageCoordSystem", {
        n: dict(zip(("xorigin", "yorigin", "angle", "xscale", "yscale"), (*a, a[3]), strict=True))
        for n, a in axes.items()
    })  # fmt: skip
    tracks = _held("item", _object(f"{_OWN}.CoordAxes", _values({"name": "axes"})))
    for name, marks in masses.items():
        frames = {n: {"x": u, "y": v} for n, (u, v) in marks.items()}
        inside = _values({"mass": 1.0, "name": name}) + _frames(f"{_OWN}.PointMass", frames)
        inside += '<property name="keyFrames" type="array" class="[I"/>\n'
        tracks += _held("item", _object(f"{_OWN}.PointMass", inside))
    inside = _values({"semantic_version": "5.0.7"})
    inside += _held("videoclip", _object(f"{_CORE}.VideoClip", clip))
    inside += _held("clipcontrol", _object(f"{_CORE}.StepperClipControl", timing))
    inside += _held("coords", _object(f"{_CORE}.ImageCoordSystem", system))
    inside += _values({"length_unit": unit}) if unit else ""
    inside += _held("tracks", tracks, "collection")
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + _object(f"{_OWN}.TrackerPanel", inside)


def sleap(
    path: Path, places: np.ndarray, nodes: Sequence[str], tracks: Sequence[str],
    dims: Sequence[str] | None = None,
) -> Path:  # fmt: skip
    """An analysis file: places (track, xy, node, frame), in another order with ``dims``."""
    usual = ("track", "xy", "node", "frame")
    with h5py.File(path, "w") as file:
        file["tracks"] = places.transpose([usual.index(one) for one in dims or usual])
        if dims is not None:
            file["tracks"].attrs["dims"] = json.dumps(list(dims))
        file["node_names"] = np.array([one.encode() for one in nodes])
        file["track_names"] = np.array([one.encode() for one in tracks])
    return path


def deeplabcut(path: Path, labels: Sequence[tuple[str, ...]], values: np.ndarray) -> Path:
    """A table as pandas writes it with PyTables: names of columns pickled, protocol 0."""
    import pickle

    kind = np.dtype([("index", "<i8"), ("values_block_0", "<f8", (len(labels),))])
    rows = np.zeros(len(values), kind)
    rows["index"], rows["values_block_0"] = np.arange(len(values)), values
    with h5py.File(path, "w") as file:
        table = file.create_dataset("df_with_missing/table", data=rows)
        table.attrs["values_block_0_kind"] = np.bytes_(pickle.dumps(list(labels), protocol=0))
    return path
