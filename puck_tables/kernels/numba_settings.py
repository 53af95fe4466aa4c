"""What the user set for numba in the environment, looked at before it is read there.

On some of it numba ends in the middle of its import, on other it ends the process, and what it does
not understand it leaves out.
"""

from __future__ import annotations

import os
import re
import warnings

from puck_tables.errors import InputError

# what ends it: how it must look, and in words
_FATAL = {
    "NUMBA_NUM_THREADS": (r"\s*\+?0*[1-9]\d*\s*", "a whole number from 1 on"),
    "NUMBA_CPU_FEATURES": (r"([+-][\w.-]+(,[+-][\w.-]+)*)?", "features like +avx2,-fma"),
}
_NOT_UNDERSTOOD = re.compile(r"Environment variable '(\w+)'")
_unusable: set[str] = set()


def read_settings() -> None:
    """Import numba, if it can use the environment variables that are set for it.

    Raises
    ------
    InputError
    """
    for name, (form, words) in _FATAL.items():
        value = os.environ.get(name)
        if value is not None and not re.fullmatch(form, value):
            raise InputError(f"{name}={value}: set it to {words}, or not at all")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        import numba  # noqa: F401 - it reads them as it is imported
    result = (_NOT_UNDERSTOOD.match(str(one.message)) for one in said)
    _unusable.update(match[1] for match in result if match)
    for name in sorted(_unusable):
        raise InputError(f"{name}={os.environ.get(name)}: numba cannot use it; leave it out")
