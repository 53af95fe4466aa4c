"""The command ``puck``, in this process."""

from __future__ import annotations

from typing import Any

from click.testing import CliRunner, Result
from puck_tables.cli.main import main


def invoke(*words: object, **how: Any) -> Result:
    """Its exit status and what it says; ``how``: input, or an environment."""
    return CliRunner().invoke(main, [str(word) for word in words], **how)
