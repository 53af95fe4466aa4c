"""Whether what stands in a table file can be used: refused where it cannot, whatever its digests.

Whoever can write a file can make its digests right.  So the recipe must be known, what the file
says of itself complete, every value such as tables of its kind have, and some of them, those that
fit their neighbours least among them, are compared with the truth.
"""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from puck_tables.errors import TableError
from puck_tables.table.container import Contents, recipe_digest

FloatArray = npt.NDArray[np.float64]
AnyAccuracy = TypeVar("AnyAccuracy")


def check_usable(
    contents: Contents,
    source: str,
    recipe: dict[str, Any],
    nodes: dict[str, FloatArray],
    bounds: tuple[float, float],
    finest: float,
) -> None:
    """Refuse a file whose digest is right but whose numbers this program cannot use.

    Parameters
    ----------
    contents, source : what was read, from where
    recipe : that of a table with these axes
    nodes : where the splines will look, by axis
    bounds : between which all other values of such tables lie
    finest : no table on such a grid is more exact

    Raises
    ------
    TableError
    """
    attributes, arrays = contents
    known = {**recipe, "recipe_digest": recipe_digest(recipe)}
    if any(attributes.get(name) != value for name, value in known.items()):
        raise TableError(f"{source} was made by a recipe that this program does not know")
    low, high = bounds
    values = [array for name, array in arrays.items() if name not in nodes]
    if not (
        all(np.allclose(arrays[n], at, rtol=1e-14, atol=1e-14) for n, at in nodes.items())
        and all(np.all((array >= low) & (array <= high)) for array in values)
        and finest < attributes["tolerance"] < 1.0
    ):
        raise TableError(f"{source} has axes or values that this program cannot use")


def accuracy_of(attributes: dict[str, Any], kind: type[AnyAccuracy], functions: int) -> AnyAccuracy:
    """The measured accuracy in a file.

    Parameters
    ----------
    attributes : those of the file
    kind : the dataclass it is read as
    functions : how many numbers its lists must have

    Raises
    ------
    ValueError
        If it is not like that.

    Examples
    --------
    >>> from puck_tables.similarity.stop_table import StopAccuracy
    >>> lists = {name: [1.0] for name in ("largest", "rms", "at_phi", "at_delta")}
    >>> text = json.dumps({**lists, "order": 4, "points": 9})
    >>> accuracy_of({"achieved_accuracy": text}, StopAccuracy, 1).order
    4
    """
    stated = json.loads(attributes["achieved_accuracy"])
    entries = {f.name: f.type for f in dataclasses.fields(kind)}  # type: ignore[arg-type]
    if not isinstance(stated, dict) or stated.keys() != entries.keys():
        raise ValueError("its measured accuracy is not complete")
    for name, found in stated.items():
        numbers = found if isinstance(found, list) else [found]
        is_list = str(entries[name]).startswith("tuple")
        if is_list != isinstance(found, list) or (is_list and len(found) != functions):
            raise ValueError(f"its measured accuracy has another {name}")
        if not all(type(n) in (int, float) and not math.isnan(n) for n in numbers):
            raise ValueError(f"its measured accuracy has a {name} that is no number")
    return kind(**{k: tuple(v) if isinstance(v, list) else v for k, v in stated.items()})


def refuse_wrong(source: str, error: FloatArray, allowed: float, what: str) -> None:
    """Refuse a table of which a few values, compared with the truth, are wrong.

    Raises
    ------
    TableError
        If an error is larger than what is allowed, or no number.

    Examples
    --------
    >>> refuse_wrong("my.h5", np.array([1e-3]), 1e-9, "closed forms")
    Traceback (most recent call last):
    ...
    puck_tables.errors.TableError: my.h5 holds wrong numbers (off by 0.001 from closed forms): it \
was altered; build it again with 'puck build-tables'
    """
    if not np.all(error <= allowed):
        raise TableError(
            f"{source} holds wrong numbers (off by {np.max(error):.2g} from {what}): it was "
            "altered; build it again with 'puck build-tables'"
        )
