"""Options of sweeps: spreads, lists of pressure laws, and where a sweep goes."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from puck_tables.cli.endings import last_words
from puck_tables.cli.options import Outputs
from puck_tables.cli.printing import note, say
from puck_tables.cli.values import named, numbers_in

from puck_tables.errors import InputError, OutputError

if TYPE_CHECKING:
    from puck_tables.bulk.spreads import Spread

SUMMED = 1_000_000  # samples (of each puck) of a store that are summed up unasked: some 200 MB
_RINGS = re.compile(r"annulus:([^:]*):([^:]*):([0-9]{1,10})")


def chosen_spreads(
    spreads: Iterable[str], names: Mapping[str, str] | None, unit_of: Callable[[str], str]
) -> dict[str, Spread]:
    """Spreads by what scatters.

    ``names``: the arguments by the names that are allowed; None: any, as they are; ``unit_of``:
    the unit of each.
    """
    from puck_tables.bulk.spreads import spread_named

    found: dict[str, Spread] = {}
    for name, text in named(spreads, "--spread", "NAME=SPREAD, like w0=normal:5:0.2").items():
        if names is not None and name not in names:
            raise InputError(f"--spread {name} does not scatter: give {', '.join(names)}")
        argument = name if names is None else names[name]
        found[argument] = spread_named(text, unit_of(argument))
    return found


def samples_checked(
    random: int | None, seed: int | None, spreads: tuple[str, ...], regions: tuple[str, ...],
    name_of_spin: str,
) -> list[tuple[float, ...]]:  # fmt: skip
    """The regions asked for; options of samples that stand alone are refused."""
    from puck_tables.bulk.summary import checked_regions

    if random is None:
        alone = {"--seed": seed is not None, "--spread": spreads, "--inside": regions}
        for name, is_given in alone.items():
            if is_given:
                raise InputError(f"{name} is for samples: give --random COUNT too")
        return []
    if not spreads:
        raise InputError(
            f"--random needs a --spread: say what scatters, like {name_of_spin}=normal:5:0.2"
        )
    numbers = [numbers_in(one, "--inside", ",", one, "m") for one in regions]  # 3 or 4 of each
    checked_regions(numbers)
    return numbers


def chosen_laws(pressure: tuple[str, ...]) -> list[str]:
    """Pressure laws, annulus:START:STOP:COUNT as so many of them."""
    import numpy as np

    from puck_tables.stopping.population import MOST_LAWS

    laws: list[str] = []
    for one in pressure or ("uniform",):
        rings = _RINGS.fullmatch(one)
        count = 1 if rings is None else int(rings[3])
        if len(laws) + count > MOST_LAWS:
            raise InputError(
                f"--pressure {one}: more than {MOST_LAWS} pressure laws, each is a kind of puck of "
                "its own that takes about a second to prepare: give fewer"
            )
        if rings is None:
            laws.append(one)
            continue
        try:
            inner = np.linspace(float(rings[1]), float(rings[2]), count).tolist()
        except ValueError:
            raise InputError(
                f"--pressure {one}: write annulus:INNER, or annulus:START:STOP:COUNT"
            ) from None
        laws += [f"annulus:{number!r}" for number in inner]
    if len(set(laws)) < len(laws):
        raise InputError("--pressure names the same law twice")
    return laws


@dataclass(frozen=True)
class Whole:
    """Where a sweep is done, and where it goes."""

    threads: int | None
    cluster: str | None
    out: Outputs
    regions: list[tuple[float, ...]]  # the chances of ending inside which are asked for

    @property
    def store(self) -> Path | None:
        """The Zarr store it goes to, if it does."""
        from puck_tables.io.formats import STORE

        path = self.out.output
        return path if path is not None and path.suffix.lower() == STORE else None

    @property
    def files(self) -> Outputs:
        """The outputs that are no store."""
        return self.out if self.store is None else replace(self.out, output=None)

    @property
    def how(self) -> dict[str, Any]:
        """Keyword arguments of a sweep of the library."""
        return {
            "threads": self.threads, "cluster": self.cluster, "overwrite": self.out.overwrite,
            "store": self.store,
        }  # fmt: skip

    def refuse_outputs(self, *inputs: Path | str | None) -> None:
        """Refuse, before any work, what could not be written."""
        from puck_tables.io.formats import FORMATS, STORE, ending_of

        if self.out.output is not None:
            ending_of(self.out.output, (*FORMATS, STORE))
        self.files.prepare(*inputs)
        if self.cluster is not None:
            if self.store is None:
                raise InputError("--cluster writes to a Zarr store: give -o NAME.zarr too")
            from puck_tables.bulk.cluster import checked_address

            checked_address(self.cluster)
        if self.store is not None:
            import puck_tables.bulk.store  # noqa: F401 - says what is not installed

            folder = self.store.absolute().parent
            if not folder.is_dir():
                raise OutputError(f"cannot write {self.store}: the folder {folder} does not exist")
            last_words.append(self._kept)

    def _kept(self) -> str:
        """What is said when the sweep is ended."""
        from puck_tables.bulk.store_folder import sibling_of

        if self.store is not None and self.store.exists():
            if sibling_of(Path(os.path.realpath(self.store))).exists():
                return (
                    f"Interrupted: {self.store} is as it was; what is done of the new one is kept "
                    "beside it: the same command goes on."
                )
            return f"Interrupted: {self.store} keeps what is done; the same command goes on."
        return last_words[0]()

    def refuse_memory(self, sizes: list[int], samples: int | None) -> None:
        """Refuse a map that would not fit in memory, as its format needs it."""
        from puck_tables._core.memory import check_memory
        from puck_tables.stopping.sweep_work import BYTES_PER_LAUNCH, BYTES_PER_ROW

        shape = tuple(n for n in sizes if n > 1) if samples is None else (samples,)
        if self.store is not None:
            if self.out.plot is not None or self.regions:
                advice = "--plot and --inside read a whole store, leave them out"
                check_memory(shape, BYTES_PER_LAUNCH, advice)
            return
        path, plot = self.out.output, self.out.plot
        as_text = plot is None if path is None else path.suffix.lower() != ".h5"
        check_memory(shape, BYTES_PER_ROW if as_text else BYTES_PER_LAUNCH)

    def deliver(self, result: Any) -> None:
        """Save, draw and sum up."""
        from puck_tables.bulk.finish import Stored
        from puck_tables.bulk.summary import Summary

        if self.store is not None:
            note(self.store)
            last_words[:] = last_words[:1]
        kept = isinstance(result, Stored)
        many = kept and result.work.size * max(1, len(getattr(result.work, "names", ()))) > SUMMED
        summed = kept and result.is_sample and (bool(self.regions) or not many)
        drawn = result.load() if summed or (kept and self.out.plot is not None) else result
        self.files.deliver(drawn, printed=not kept and not isinstance(result, Summary))
        say(str(result), err=True)
        if isinstance(drawn, Summary):
            click.echo(drawn.summary(self.regions))
        elif kept and result.is_sample:
            click.echo(
                f"More than {SUMMED:,} samples are summed up only with --plot or --inside, in "
                "memory (some 200 bytes each); or open the store with xarray.",
                err=True,
            )
        if self.out.explain:
            say(result.explain(), err=True)
