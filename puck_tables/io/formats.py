"""Which format a file name asks for; a result written whole or not at all.

A new format is one module with ``encode(dataset) -> bytes``, and one line here.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

from puck_tables._core.arrays import instance
from puck_tables._core.safe_write import write_bytes
from puck_tables.errors import InputError
from puck_tables.io.columns import Dataset

STORE = ".zarr"  # written block by block, by sweeps alone: puck_tables.bulk.store
FORMATS = {".h5": "hdf5", ".csv": "csv", ".json": "json", ".jsonl": "jsonl", ".parquet": "parquet"}


def ending_of(path: str | Path, allowed: Any) -> str:
    """The ending of a file name, which chooses its format.

    Raises
    ------
    InputError
        If it is none of those allowed, or no name.

    Examples
    --------
    >>> ending_of("run.csv", FORMATS)
    '.csv'
    """
    instance("path", path, str, Path)
    ending = Path(path).suffix.lower()
    if ending not in allowed:
        raise InputError(
            f"{path}: the ending of an output file chooses its format: one of {', '.join(allowed)}"
        )
    return ending


def encoder_for(path: str | Path) -> Callable[[Dataset], bytes]:
    """The function that encodes what is to be saved under a name.

    Raises
    ------
    InputError
        If its ending is not that of a format.
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> encoder_for("run.csv").__module__
    'puck_tables.io.csv'
    """
    module = import_module(f"puck_tables.io.{FORMATS[ending_of(path, FORMATS)]}")
    encode: Callable[[Dataset], bytes] = module.encode
    return encode


def save(dataset: Dataset, path: str | Path, overwrite: bool = False) -> None:
    """Write a result in the format that the ending of the name asks for.

    Raises
    ------
    InputError
        If its ending is not that of a format.
    MissingExtraError
        If the format needs a package that is not installed.
    OutputError
        If the file exists (without ``overwrite``) or cannot be written.

    Examples
    --------
    >>> save(Dataset({}, {}), "run.txt")
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: run.txt: the ending of an output file chooses its format: one \
of .h5, .csv, .json, .jsonl, .parquet
    """
    write_bytes(path, encoder_for(path)(dataset), overwrite)
