"""From the pixels of a tilted camera to metres on the floor: the homography of a plane.

Points of a plane and their pictures are related by ``w (x, y, 1) = H (u, v, 1)`` with one 3 x 3
matrix H up to a factor.  Four marks whose places on the floor are known, no three of them on a
line, fix it; more are fitted by least squares (the direct linear transformation, with both sides
moved and scaled first so that the equations are well conditioned).

References
----------
R. I. Hartley, In defense of the eight-point algorithm, IEEE PAMI 19 (1997) 580: the scaling.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from puck_tables._core.arrays import FloatArray, finite_array
from puck_tables._core.safe_read import content_of
from puck_tables._core.text import text_form_of
from puck_tables._core.text_rows import read_columns
from puck_tables._core.units import PIXEL, factor, unit_in
from puck_tables.errors import InputError

Marks = str | Path | Sequence[Sequence[float]]

_FEWEST = 4  # points: fewer leave a camera open
_LARGEST = 1 << 20  # bytes: a file of marks has some hundred
_FLAT = 1e-4  # triangles of marks, of the square of their extent, that are as good as a line


@dataclass(frozen=True, eq=False)
class Plane:
    """The homography of a floor.

    ``matrix``: ndarray (3, 3), H, from pixels to metres; ``residual``: float, m, root mean square
    of what the marks lie off; 0 with four of them; ``count``: of marks.
    """

    matrix: FloatArray
    residual: float
    count: int

    @property
    def mirrored(self) -> bool:
        """Whether y lies to the right of x in the picture, whose v points down."""
        return bool(np.linalg.det(self.matrix) > 0.0)

    def place(self, pixels: FloatArray) -> FloatArray:
        """Places (n, 2) in m of points (n, 2) in pixels.

        Raises InputError if a point lies at or beyond the horizon of the floor.

        >>> square = [(0, 0, 0, 0), (100, 0, 1, 0), (100, 100, 1, 1), (0, 100, 0, 1)]
        >>> plane_of(square).place(np.array([[50.0, 25.0]])).round(9).tolist()
        [[0.5, 0.25]]
        """
        x, y, depth = self._repeated(pixels)
        if (depth <= 0.0).any():
            u, v = pixels[np.flatnonzero(depth <= 0.0)[0]]
            raise InputError(
                f"the puck at pixel ({u:.6g}, {v:.6g}) would lie beyond the horizon of the floor "
                "that the marks span: check the marks"
            )
        return np.column_stack([x / depth, y / depth])

    def angle(self, pixels: FloatArray, angle: FloatArray) -> FloatArray:
        """Angles (n,) on the floor of directions (cos, sin) in the picture at points (n, 2)."""
        x, y, depth = self._repeated(pixels)
        cos, sin = np.cos(angle), np.sin(angle)
        dx, dy, dd = (row[0] * cos + row[1] * sin for row in self.matrix)
        turned: FloatArray = np.arctan2(dy * depth - y * dd, dx * depth - x * dd)
        return turned

    def _repeated(self, pixels: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        u, v = pixels[:, 0], pixels[:, 1]
        x, y, depth = (row[0] * u + row[1] * v + row[2] for row in self.matrix)
        return x, y, depth


def plane_of(rows: Sequence[Sequence[float]] | FloatArray) -> Plane:
    """The homography of four or more marks.

    ``rows``: array_like (n, 4), pixels u, v and the place x, y in m of each mark.  Raises
    InputError if they are fewer, not finite, or lie on a line in the picture or on the floor.

    >>> tilted = [(0, 0, 0, 0), (100, 0, 1, 0), (80, 60, 1, 1), (20, 60, 0, 1)]
    >>> plane_of(tilted).place(np.array([[50.0, 37.5]])).round(9).tolist()   # the diagonals meet
    [[0.5, 0.5]]
    """
    marks = finite_array("marks", rows, "1")
    if marks.ndim != 2 or marks.shape[1] != 4 or len(marks) < _FEWEST:
        raise InputError(
            "marks must be four rows or more of u, v (pixels) and x, y (metres), got "
            f"an array of {marks.shape}"
        )
    for points, where in ((marks[:, :2], "in the picture"), (marks[:, 2:], "on the floor")):
        _refuse_line(points, where)
    (pixels, shrink), (places, grow) = _scaled(marks[:, :2]), _scaled(marks[:, 2:])
    one, none = np.ones(len(marks)), np.zeros((len(marks), 3))
    near = np.column_stack([pixels, one])
    x, y = places[:, :1], places[:, 1:]
    equations = np.vstack([np.hstack([near, none, -x * near]), np.hstack([none, near, -y * near])])
    normal = np.linalg.svd(equations)[2][-1].reshape(3, 3)
    matrix = np.linalg.inv(grow) @ normal @ shrink
    depth = np.column_stack([marks[:, :2], one]) @ matrix[2]
    matrix = matrix * np.sign(depth[0])
    if (depth * np.sign(depth[0]) <= 0.0).any():
        raise InputError(
            "marks lie on both sides of the horizon of the floor that they span: check that each "
            "row has the pixel and the place of the same mark"
        )
    plane = Plane(matrix / np.abs(matrix).max(), 0.0, len(marks))
    apart = plane.place(marks[:, :2]) - marks[:, 2:]
    exact = len(marks) == _FEWEST
    residual = 0.0 if exact else float(np.sqrt((apart**2).sum(axis=1).mean()))
    return Plane(plane.matrix, residual, len(marks))


def plane_from(marks: Marks) -> Plane:
    """The homography that marks fix, given as rows or in a CSV file.

    ``marks``: str, Path or array_like (n, 4), a file of columns u, v (pixels) and x, y, whose
    header says the unit of the last two; or rows of the same in pixels and metres.  Raises
    InputError if the file cannot be read or does not say the unit, or as :func:`plane_of`.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "marks.csv")
    ...     rows = ["u,v,x [cm],y [cm]", "0,0,0,0", "100,0,50,0", "90,70,50,40", "10,70,0,40"]
    ...     _ = file.write_text(chr(10).join(rows))
    ...     plane_from(file).place(np.array([[50.0, 0.0]]))[0, 0].round(9).item()
    0.25
    """
    if not isinstance(marks, str | Path):
        return plane_of(marks)
    look = text_form_of(marks, content_of(marks, _LARGEST))
    form = f"{marks} must have the columns u, v, x, y: the pixels and the place of each mark"
    if look.width != 4:
        raise InputError(f"{form}; it has {look.width}")
    units = {unit_in(cell) for cell in look.header[-1][2:]} if look.header else {""}
    if len(units) > 1 or not units - {"", PIXEL}:
        raise InputError(f"{form}, with the unit of the places in the header, as in x [cm], y [cm]")
    values, _ = read_columns(marks, look, range(4), ())
    size = factor(units.pop(), "length")
    rows = np.column_stack([values[0], values[1], values[2] * size, values[3] * size])
    if not np.isfinite(rows).all():
        raise InputError(f"{form}, none of them left empty")
    return plane_of(rows)


def _refuse_line(points: FloatArray, where: str) -> None:
    """Refuse marks of which all but one, or all, lie on a line (or in a point)."""
    extent = float(np.ptp(points, axis=0).max())
    for left_out in range(len(points)):
        rest = np.delete(points, left_out, axis=0)
        middle = rest - rest.mean(axis=0)
        if np.linalg.svd(middle, compute_uv=False)[1] <= _FLAT * extent:
            raise InputError(
                f"the marks lie on a line {where}, or all but one do: of four marks no three may, "
                "spread them over the floor"
            )


def _scaled(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Points about their middle at a mean distance of the root of 2, and the matrix that did it."""
    middle = points.mean(axis=0)
    size = np.sqrt(2.0) / np.hypot(*(points - middle).T).mean()
    moved = np.diag([size, size, 1.0])
    moved[:2, 2] = -size * middle
    return (points - middle) * size, moved
