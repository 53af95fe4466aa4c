"""The page: its parts in one file, with the look-ups that ``puck export`` writes inside."""

from __future__ import annotations

from importlib.resources import files

from puck_tables.export.source import export_source

TOL = 1e-6
_SCRIPTS = ("model.js", "draw.js", "hands.js")


def explorer_page() -> str:
    """The explorer as one HTML file: it needs no server, no network and no other file.

    Returns
    -------
    str
        Its numbers come from :func:`puck_tables.export_source`, to 1e-6 of Q/J and Q²/J.

    Examples
    --------
    >>> page = explorer_page()
    >>> page[:15], len(page) < 1_000_000
    ('<!DOCTYPE html>', True)
    """
    folder = files("puck_tables.explore")
    page = (folder / "page.html").read_text(encoding="utf-8")
    scripts = "".join((folder / name).read_text(encoding="utf-8") for name in _SCRIPTS)
    look_ups = export_source("js", ("stop", "state", "resultants"), TOL).text
    return page.replace("/*look-ups*/", look_ups).replace("/*page*/", scripts)
