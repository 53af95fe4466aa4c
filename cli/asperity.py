"""``puck asperity``: dry friction from a wavy support, force against speed."""

from __future__ import annotations

import math
from pathlib import Path

import click
from puck_tables.cli.options import FILE, Outputs, PuckCommand, number, outputs
from puck_tables.cli.printing import note, progress
from puck_tables.cli.values import RangeParam

from puck_tables.errors import InputError

# speeds, and times the lift speed up to which: enough for a smooth curve beyond it
DEFAULT_COUNT, DEFAULT_TOP = 501, 2.5
MAX_SPEEDS = 1_000_000  # each a row of the answer


@click.command(cls=PuckCommand)
@number("--amplitude", "m", default=1e-6, show_default=True, help="a in m.")
@number("--wavelength", "m", default=2e-5, show_default=True, help="2 pi b in m.")
@number("--load", "N", default=1.0, show_default=True, help="-Y in N.")
@number("--mass", "kg", help="m in kg.  [default: the load is its weight]")
@number("--speeds", "m/s", RangeParam, help="In m/s.  [default: 0 to 2.5 V0 in 501 steps]")
@click.option("--law", type=FILE, metavar="FILE", help="Save greatest force over load against "
              "speed: a CSV that floor.law of a scene takes.")  # fmt: skip
@outputs("Save the curve: .h5 or .csv.  Without -o and --plot, CSV goes to stdout.")
def asperity(
    amplitude: float, wavelength: float, load: float, mass: float | None,
    speeds: float | tuple[float, float, int] | None, law: Path | None, out: Outputs,
) -> None:  # fmt: skip
    """Draw friction against speed for a point on a wavy one-sided support.

    The point is pressed on y >= -a cos(x/b) and driven along it at a held speed; above V0 it leaves
    the crests, flies and lands without a rebound.  Columns: Coulomb's force, the greatest force in
    contact (held speed, and a point not driven), the mean force with all landings, the phase of the
    landing (nan without one), flights in a period.  Chetaev 1960, section 5.

    \b
    puck asperity --plot asperity.png
    puck asperity --amplitude 2e-6 --wavelength 4e-5 --load 5 --speeds 0:0.03:301 -o curve.csv
    puck asperity --wavelength 0.001 --amplitude 1e-5 --speeds 0:0.2:41 --law rough.csv
    """  # noqa: D301 - click reads the backspace
    out.prepare(others=(law,))
    if out.plot is not None and isinstance(speeds, float):
        raise InputError("--plot needs a range: give --speeds START:STOP:COUNT")
    import numpy as np

    from puck_tables.chetaev.asperity_forces import asperity_curve
    from puck_tables.chetaev.wavy_support import Asperity
    from puck_tables.motion.body import STANDARD_GRAVITY

    heavy = load / STANDARD_GRAVITY if mass is None else mass
    support = Asperity(amplitude, wavelength / (2.0 * math.pi), load, heavy)
    if speeds is None:
        speeds = 0.0, DEFAULT_TOP * support.lift_speed, DEFAULT_COUNT
    count = speeds[2] if isinstance(speeds, tuple) else np.size(speeds)
    if count > MAX_SPEEDS:
        raise InputError(f"--speeds asks for {count} speeds: at most {MAX_SPEEDS}")
    held = np.linspace(*speeds) if isinstance(speeds, tuple) else np.atleast_1d(speeds)
    with progress("speeds") as show:
        result = asperity_curve(support, held, show)
    out.deliver(result, printed=law is None)
    if law is not None:
        result.law().to_csv(law, out.overwrite)
        note(law)
    click.echo(result, err=True)
