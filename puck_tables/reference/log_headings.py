"""What the heading of a column of an engine's log says: places, velocities, spins, quaternions."""

from __future__ import annotations

import re
from typing import NamedTuple

from puck_tables._core.units import EXAMPLES, parted, unit_size
from puck_tables.errors import InputError
from puck_tables.film.headings import heading

_NAMES = {
    "vx": "vx xvel velx velocityx xvelocity linvelx linearvelocityx vellinx xdot dx dxdt xd",
    "vy": "vy yvel vely velocityy yvelocity linvely linearvelocityy velliny ydot dy dydt yd",
    "vz": "vz zvel velz velocityz zvelocity linvelz linearvelocityz vellinz zdot dz dzdt zd",
    "wx": "wx omegax angvelx angularvelocityx velangx gyrox",
    "wy": "wy omegay angvely angularvelocityy velangy gyroy",
    "wz": "wz omegaz angvelz angularvelocityz velangz gyroz",
    "spin": "w omega spin angvel angularvelocity yawrate thetadot dtheta dthetadt angularspeed",
    "qw": "qw quatw quaternionw orientationw rotw rotationw",
    "qx": "qx quatx quaternionx orientationx rotx rotationx",
    "qy": "qy quaty quaterniony orientationy roty rotationy",
    "qz": "qz quatz quaternionz orientationz rotz rotationz",
    "z": "z posz zpos positionz zposition pz zcoord coordz",
    "x": "px positionx xposition",
    "y": "py positiony yposition",
}  # fmt: skip
_ROLE = {name: role for role, names in _NAMES.items() for name in names.split()}
_KIND = dict.fromkeys(("vx", "vy", "vz"), "velocity")
_KIND |= dict.fromkeys(("wx", "wy", "wz", "spin"), "spin")
_KIND |= dict.fromkeys(("x", "y", "z"), "length")
_KIND |= {"time": "time", "angle": "angle"}
_FROM_FILM = ("time", "x", "y", "angle")


class LogHeading(NamedTuple):
    """What a column holds, and its unit.

    ``role``: time, x, y, z, angle, vx to vz, wx to wz, spin, qw to qz, or '' for any other;
    ``unit``: what it is in SI units, None if it says none.
    """

    role: str
    unit: float | None = None

    @property
    def kind(self) -> str:
        """Of its unit: length, time, angle, velocity, spin, or '' of a pure number."""
        return _KIND.get(self.role, "")


def log_heading(text: str, puck: str | None = None) -> LogHeading:
    """Read the heading of a column.

    ``puck``: name of the puck whose columns are wanted; those without a name are of all.  Raises
    InputError if it has a unit in square brackets that is none of its kind.

    >>> log_heading("v_x [mm/s]"), log_heading("omega (deg/s)").role, log_heading("quat.w")
    (LogHeading(role='vx', unit=0.001), 'spin', LogHeading(role='qw', unit=None))
    >>> log_heading("red_vx", "red").role, log_heading("red_vx", "yellow").role
    ('vx', '')
    """
    name, unit_text = parted(text.strip().strip("\"'").strip())
    if (match := re.fullmatch(r"(.+?)\s*[\[(]\s*(.*?)\s*[\])]", text.strip())) is not None:
        name, unit_text = match[1], match[2]  # a unit that no film has
    plain = "".join(re.findall(r"[a-z0-9]+", name.lower().replace("ω", "omega")))
    mine = re.sub(r"[^a-z0-9]", "", (puck or "").lower())
    for own in (plain.removeprefix(mine), plain.removesuffix(mine)):
        if own in _ROLE:
            role = _ROLE[own]
            return LogHeading(role, _unit(text, unit_text, _KIND.get(role, "")))
    seen = heading(name if unit_text else text)
    if seen.role not in _FROM_FILM or seen.puck.lower() not in ("", (puck or "").lower()):
        return LogHeading("")
    if seen.unit and not unit_text:
        return LogHeading(seen.role, _unit(text, seen.unit, _KIND[seen.role]))
    return LogHeading(seen.role, _unit(text, unit_text, _KIND[seen.role]))


def _unit(text: str, unit: str, kind: str) -> float | None:
    """A unit in SI; None where there is none."""
    if not unit or not kind:
        return None
    size = unit_size(unit, kind)
    if size is None:
        raise InputError(
            f"the unit of the column '{text.strip():.40}' is not known: write one such as "
            f"{EXAMPLES[kind]}"
        )
    return size
