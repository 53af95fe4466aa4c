"""The neutral form of every result: named arrays over named axes, with units and attributes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.safe_write import as_utf8
from puck_tables.io.columns import COLUMNS


@dataclass(frozen=True)
class Variable:
    """Values over axes.

    ``values``: an array, or a list of texts; ``dims``: the names of its axes; ``unit``: '1' for a
    pure number, '' for a text; ``flags``: what the values 0, 1, … mean, of a code.
    """

    values: Any
    dims: tuple[str, ...]
    unit: str
    long_name: str
    flags: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "flags", tuple(map(as_utf8, self.flags)))
        if isinstance(self.values, list) and self.values and isinstance(self.values[0], str):
            object.__setattr__(self, "values", list(map(as_utf8, self.values)))

    @property
    def attributes(self) -> dict[str, Any]:
        """Its unit, what it is, and what codes mean, as the CF conventions have them."""
        said: dict[str, Any] = {"units": self.unit or "1", "long_name": self.long_name}
        if self.flags:
            said["flag_values"] = np.arange(len(self.flags), dtype=np.int8)
            said["flag_meanings"] = " ".join(flag.replace(" ", "_") for flag in self.flags)
        return said

    def readable(self) -> npt.NDArray[Any]:
        """The values, codes as words."""
        if self.flags:
            words: npt.NDArray[Any] = np.asarray(self.flags)[np.asarray(self.values)]
            return words
        return np.asarray(self.values)


def variable(
    name: str, values: Any, dims: tuple[str, ...], flags: tuple[str, ...] = ()
) -> Variable:
    """A variable with the unit and the words that its name has in the registry of columns.

    >>> variable("stop_time", [1.0], ("launch",)).unit
    's'
    """
    column = COLUMNS[name]
    return Variable(values, dims, column.unit, column.long_name, flags)


@dataclass(frozen=True)
class Dataset:
    """Axes, columns over them, scalars, and texts of any length; all by name.

    The dimensions of the table that a text format writes are those of the first column that has
    most; columns over some of them are repeated, columns with others (the events of a scene) are in
    HDF5 and xarray only.
    """

    axes: Mapping[str, Variable]
    columns: Mapping[str, Variable]
    attributes: Mapping[str, Any] = field(default_factory=dict)
    texts: Mapping[str, tuple[str, str]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        held = {name: as_utf8(one) if isinstance(one, str) else one
                for name, one in self.attributes.items()}  # fmt: skip
        object.__setattr__(self, "attributes", held)
        texts = {name: (as_utf8(text), words) for name, (text, words) in self.texts.items()}
        object.__setattr__(self, "texts", texts)

    def table(self) -> dict[str, Variable]:
        """The columns of a flat table: the axes, repeated as needed, then the rest; one row each.

        >>> launches = variable("launch_spin", np.array([1.0, 2.0]), ("launch_spin",))
        >>> times = variable("stop_time", np.array([3.0, 4.0]), ("launch_spin",))
        >>> Dataset({"launch_spin": launches}, {"stop_time": times}).table()["stop_time"].values
        array([3., 4.])
        """
        main = max(self.columns.values(), key=lambda one: len(one.dims))
        dims, shape = main.dims, np.shape(main.values)
        axes = {name: self.axes[name] for name in dims if name in self.axes}
        whole = {}
        for name, column in {**axes, **self.columns}.items():
            if set(column.dims) <= set(dims):
                sizes = [
                    size if dim in column.dims else 1 for dim, size in zip(dims, shape, strict=True)
                ]
                values = column.readable().reshape(sizes)
                whole[name] = (column, np.broadcast_to(values, shape).ravel())
        return {
            name: Variable(values, ("row",), one.unit, one.long_name)
            for name, (one, values) in whole.items()
        }

    def rows(self) -> tuple[dict[str, Variable], Iterator[tuple[Any, ...]]]:
        """The flat table and its rows as Python numbers and texts."""
        table = self.table()
        columns: Sequence[list[Any]] = [one.values.tolist() for one in table.values()]
        return table, zip(*columns, strict=True)
