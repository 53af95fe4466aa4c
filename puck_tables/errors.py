"""Every exception of the package; each message is one sentence that says what to do."""

from __future__ import annotations


class PuckError(Exception):
    """Base class: whatever the package refuses to do, it refuses with one of these.

    ``boards``: of what :class:`puck_tables.Worlds` does, the numbers of boards on which it fails.
    """

    boards: tuple[int, ...] = ()


class InputError(PuckError, ValueError):
    """An argument is not a number, has the wrong shape or lies outside its range."""


class ContactError(InputError):
    """The state lies outside the law of contact asked for: lifted, tipping, or not determined."""


class SpeedError(InputError):
    """A slip is faster than a law of friction given by points goes."""


class AccuracyError(InputError):
    """The accuracy asked for is out of reach of the chosen method.

    ``reachable``: the one that is not, where that is known.
    """

    def __init__(self, message: str, reachable: float | None = None) -> None:
        super().__init__(message)
        self.reachable = reachable


class TableError(PuckError):
    """A file cannot be used as a table: missing, altered, of another kind or format."""


class OutputError(PuckError, OSError):
    """A result could not be written; nothing was left half-written."""


class MissingExtraError(PuckError, ImportError):
    """An optional package is needed for this and is not installed."""


class ClusterError(PuckError, ConnectionError):
    """The machines that were to do the work cannot be reached; what they have done stays."""
