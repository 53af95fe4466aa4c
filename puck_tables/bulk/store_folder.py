"""Where a store is, and which work it belongs to.

A store is a folder that is held open: what is written goes into that folder, whatever has its name
meanwhile, so that two works never mix.  A store that replaces another is made beside it, as
``.NAME.new``, and takes its place when it is whole; there is one such, of the work that said so
last, and all other works on that name stop.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from weakref import finalize

from puck_tables._core.partial_files import (
    alone_in,
    hold,
    identity,
    if_dead,
    new_part,
    remove,
    remove_dead,
)
from puck_tables._core.safe_write import written_part
from puck_tables.errors import InputError, OutputError

DIGEST = "puck_tables_work"  # the attribute of a store that says which work it is
ROOT = "zarr.json"
Content = Mapping[str, bytes]


class Place:
    """A folder, held open, that holds what is done of a work, or is to.

    ``path``: the name of the store, without links, which another may have by now; ``folder``: where
    it is now; ``digest``: which work it is.
    """

    def __init__(self, path: Path, folder: Path) -> None:
        self.path, self._folder = path, folder
        self._at: int | None = None
        if os.open in os.supports_dir_fd:
            self._at = os.open(folder, os.O_RDONLY)
            finalize(self, os.close, self._at)
        self._is = identity(folder if self._at is None else self._at)
        self.digest = _digest_in(self.content(ROOT))

    def hold(self) -> None:
        """Hold it for this process: it is no leftover."""
        if self._at is not None:
            hold(self._at)

    @property
    def folder(self) -> Path:
        """What it is called now."""
        sibling = sibling_of(self.path)
        return sibling if identity(sibling) == self._is else self.path

    def content(self, key: str, last: int = 0) -> bytes | None:
        """The bytes of a file, or so many last ones; None if it cannot be read."""
        name = key if self._at is not None else self._folder / key
        try:
            descriptor = os.open(name, os.O_RDONLY, dir_fd=self._at)
            with open(descriptor, "rb") as file:
                if last:
                    file.seek(-last, os.SEEK_END)
                return file.read()
        except (OSError, ValueError):
            return None

    def put(self, key: str, content: bytes | memoryview) -> None:
        """Write a file, whole or not at all.

        Raises OutputError if the disk does not take it, or the store belongs to another work by
        now.
        """
        try:
            self._write(key, content)
        except OSError as error:
            self.refuse_lost()
            raise _unwritten(self.path, error) from None

    def _write(self, key: str, content: bytes | memoryview) -> None:
        with written_part(self._folder, content, at=self._at) as part:
            if self._at is None:
                to = self._folder / key
                to.parent.mkdir(parents=True, exist_ok=True)
                part.replace(to)
                return
            try:
                os.rename(part.name, key, src_dir_fd=self._at, dst_dir_fd=self._at)
            except FileNotFoundError:
                self._make_above(key)
                os.rename(part.name, key, src_dir_fd=self._at, dst_dir_fd=self._at)

    def _make_above(self, key: str) -> None:
        for above in reversed(Path(key).parents[:-1]):
            with contextlib.suppress(FileExistsError):
                os.mkdir(above, dir_fd=self._at)

    def refuse_lost(self) -> None:
        """Refuse to go on for a work that the store does not belong to any more.

        Raises OutputError.
        """
        if not self.is_mine:
            with _renaming(self.path):  # it may be renamed at this moment
                self._refuse_lost()

    def _refuse_lost(self) -> None:
        if not self.is_mine:
            raise OutputError(
                f"{self.path} was removed, or taken over by another work that said --overwrite "
                "(overwrite=True): this one stops"
            )

    @property
    def is_mine(self) -> bool:
        """Whether the store belongs to this work."""
        mark = identity(sibling_of(self.path))
        return (identity(self.path) if mark is None else mark) == self._is

    def complete(self) -> None:
        """Let it take the place of the store that it replaces, if it does.

        Raises OutputError if it belongs to another work by now, or what is there is no store any
        more.
        """
        with _renaming(self.path) as aside:
            self._refuse_lost()
            if identity(self.path) != self._is:
                if os.path.lexists(self.path):
                    if Place(self.path, self.path).digest is None:
                        raise OutputError(f"{self.path} is no store any more: it is not replaced")
                    aside(self.path)
                sibling_of(self.path).rename(self.path)
        remove_dead(self.path)

    def withdraw(self) -> None:
        """Remove what was to replace another store, which stays."""
        with contextlib.suppress(OutputError), _renaming(self.path) as aside:
            if self.is_mine and identity(self.path) != self._is:
                aside(sibling_of(self.path))


def sibling_of(path: Path) -> Path:
    """Where a store that is to replace another is made.

    >>> sibling_of(Path("maps/m.zarr")).name
    '.m.zarr.new'
    """
    return path.with_name(f".{path.name}.new")


def taken(path: Path, digest: str, overwrite: bool, start: Content) -> Place:
    """The place of a work: gone on with, or new, with what it starts with.

    ``path``: the name of the store, without links; ``digest``: of the work; ``overwrite``: whether
    a store of other work may be replaced, and another work stopped; ``start``: the files of a store
    in which nothing is done, by name.  Raises InputError if another work has it, or something else
    is there; OutputError if it cannot be made.
    """
    sibling = sibling_of(path)
    remove_dead(path.parent)
    with _renaming(path) as aside:
        if not os.path.lexists(path) and os.path.lexists(sibling):
            sibling.rename(path)  # it was replacing another when it was killed
        result = _at(path, path)
        if result is not None and result.digest != digest and not overwrite:
            raise InputError(
                f"{path} holds other work: give the arguments, files and program that it was "
                "begun with, another name, or --overwrite (overwrite=True) to replace it"
            )
        new = _at(path, sibling)
        goes_on = result is None or result.digest == digest
        if new is not None and (goes_on or new.digest != digest):
            if overwrite:
                aside(sibling)
            elif not if_dead(sibling, aside):
                raise InputError(
                    f"{path} is being replaced by another work: wait until that ends, or say "
                    "--overwrite (overwrite=True) to stop it"
                )
            new = None
        place = (result if goes_on else new) or _made(
            path, path if result is None else sibling, start
        )
        place.hold()
    remove_dead(place.folder)
    return place


def shared(path: Path, digest: str) -> Place:
    """The place of a work that another process has taken.

    Raises OutputError if it is not there.
    """
    for folder in (sibling_of(path), path):
        place = Place(path, folder) if folder.is_dir() else None
        if place is not None and place.digest == digest:
            return place
    raise OutputError(f"{path} does not hold this work any more")


def _at(path: Path, folder: Path) -> Place | None:
    """The store there, if anything is.

    Raises InputError if it is no store of this program.
    """
    if not os.path.lexists(folder):
        return None
    is_folder = folder.is_dir() and not folder.is_symlink()
    place = Place(path, folder) if is_folder else None
    if place is None or place.digest is None:
        raise InputError(
            f"{folder} exists and is no Zarr store of this program: give another name, or remove it"
        )
    return place


def _made(path: Path, folder: Path, start: Content) -> Place:
    """A store in which nothing is done: whole, or not there."""
    part = new_part(path.parent)
    try:
        part.mkdir()
        place = Place(path, part)
        place.hold()
        for key, content in start.items():
            place._write(key, content)
        part.rename(folder)
        return Place(path, folder)
    finally:
        remove(part)


@contextlib.contextmanager
def _renaming(path: Path) -> Iterator[Callable[[Path], None]]:
    """Nobody else renames this store meanwhile; gives how to put a folder aside, for good."""
    gone: list[Path] = []

    def aside(folder: Path) -> None:
        part = new_part(folder.parent)
        folder.rename(part)
        gone.append(part)

    try:
        with alone_in(path.parent):
            yield aside
    except OSError as error:
        if isinstance(error, OutputError):
            raise
        raise _unwritten(path, error) from None
    finally:
        for part in gone:
            remove(part)


def _unwritten(path: Path, error: OSError) -> OutputError:
    return OutputError(f"cannot write {path}: {error.strerror or error}")


def _digest_in(root: bytes | None) -> str | None:
    """What a store says that it is."""
    try:
        result = json.loads(root or b"")["attributes"][DIGEST]
    except (ValueError, KeyError, TypeError):
        return None
    return result if isinstance(result, str) else None
