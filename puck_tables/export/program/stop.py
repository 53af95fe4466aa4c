"""Where and when a launch stops."""

from __future__ import annotations

from puck_tables.export.program.intrinsics import (
    SPIN_TIME,
    STEEP,
    STOP,
    STOP_DEGREE,
    STOP_POWERS,
    STOP_QUANTUM,
    STOP_ROWS,
    Out,
    room,
)
from puck_tables.export.program.places import (
    AROUND,
    EAST,
    MEASURED,
    NORTH,
    RIM,
    SHARE,
    SIDE,
    SLIP,
    SPEED,
    look_up,
    measured,
    place_of,
    refused,
)

# of the functions of a stop
TIME, ALONG, ACROSS, LENGTH, BODY = 0, 1, 2, 3, 4
STOP_FUNCTIONS = 5  # T, X, Y, path, body angle


def table_at(side: int, share: float, delta: float, f: Out) -> None:
    """T, along, across, path length and body angle by look-up; side 1 where r|w| > v."""
    look_up(
        STOP, STOP_ROWS[side] * STOP_POWERS * STOP_FUNCTIONS,
        STOP_ROWS[side + 1] - STOP_ROWS[side] - STOP_DEGREE, STOP_DEGREE, STOP_POWERS,
        STOP_FUNCTIONS, STOP_QUANTUM, place_of(share), STEEP * delta * delta - 1.0, f,
    )  # fmt: skip


def stop_functions(side: int, share: float, delta: float, f: Out) -> None:
    """The functions of a stop: by look-up, in pure sliding and in pure spin exactly."""
    table_at(side, share, delta, f)
    if share == 0.0 and side == 0:
        f[TIME] = 1.0
        f[ALONG] = 0.5
        f[LENGTH] = 0.5
    elif share == 0.0:
        f[TIME] = SPIN_TIME
        f[BODY] = 0.5 * SPIN_TIME


def stopped(m: Out, f: Out, delta: float, decel: float, radius: float, out: Out) -> None:
    """Stop time, place, path length and body angle of a measured launch."""
    duration: float = m[SLIP] / decel
    size: float = duration * m[SLIP]
    across: float = delta * m[AROUND] * m[RIM] * f[ACROSS]
    out[0] = duration * f[TIME]
    out[1] = size * (f[ALONG] * m[EAST] - across * m[NORTH])
    out[2] = size * (f[ALONG] * m[NORTH] + across * m[EAST])
    out[3] = size * m[SPEED] * f[LENGTH]
    out[4] = size / radius * m[AROUND] * m[RIM] * f[BODY]


def stop(
    vx: float, vy: float, spin: float, delta: float, decel: float, radius: float, out: Out
) -> int:
    """Stop time s, place x m, y m, path length m and body angle rad of a launch, into out[5].

    vx, vy m/s; spin rad/s, counter-clockwise positive; delta = 2 f h / r from 0 to TALLEST;
    decel = f g m/s^2; radius m.  Errors: the tolerance times Q/J, Q^2/J, Q^2/J and Q^2/(J r), where
    Q = hypot(v, r w) and J is decel.  Returns 0; 1 where a number is not finite or out of range, 2
    where the motion is too large for floating point: nothing but NaN is in out then.
    """
    m = room(MEASURED)
    f = room(5)
    code: int = measured(vx, vy, spin, delta, decel, radius, m)
    if code != 0:
        return refused(out, 5, code)
    stop_functions(int(m[SIDE]), m[SHARE], delta, f)
    stopped(m, f, delta, decel, radius, out)
    return 0
