"""The mathematics of code for other machines, beside 60 digits."""

from __future__ import annotations

import math

import mpmath
import numpy as np
import pytest

from puck_tables.kernels.mathematics import FUNCTIONS

SMALL = 10.0 ** np.linspace(-12.0, 0.0, 60)
WIDE = 10.0 ** np.linspace(-300.0, 300.0, 150)
BOTH = np.concatenate([SMALL, -SMALL])
# arguments of each, and by how many units in the last place of the result (of 1) it may be off
CASES = {
    "sin": (np.linspace(-1e5, 1e5, 301), 2.0), "cos": (np.linspace(-1e5, 1e5, 301), 2.0),
    "exp": (np.linspace(-740.0, 709.7, 301), 3.0),
    "log": ([*WIDE, *(1.0 + BOTH[:-1]), 5e-324], 2.0), "log1p": ([*WIDE, *(0.999 * BOTH)], 4.0),
    "expm1": ([*BOTH, *np.linspace(-45.0, 709.0, 200)], 4.0), "cbrt": ([*WIDE, *-WIDE], 2.0),
    "atan": ([*WIDE, *BOTH], 4.0), "asin": (BOTH, 4.0), "acos": (BOTH, 4.0),
    "sinh": ([*BOTH, *np.linspace(-710.0, 710.0, 200)], 5.0),
    "cosh": (np.linspace(-710.0, 710.0, 200), 5.0),
    "tanh": ([*BOTH, *np.linspace(-30.0, 30.0, 99)], 5.0),
    "asinh": ([*WIDE, *-WIDE, *BOTH], 4.0), "atanh": (0.999 * BOTH, 5.0),
}  # fmt: skip


def units(name: str, arguments: tuple[float, ...]) -> float:
    """By how many units in its last place a result is off."""
    with mpmath.workdps(60):
        exact = map(mpmath.mpf, arguments)
        if name == "cbrt":
            truth = mpmath.sign(arguments[0]) * mpmath.cbrt(abs(arguments[0]))
        else:
            truth = getattr(mpmath, {"pow": "power"}.get(name, name))(*exact)
        mine = FUNCTIONS[name](*map(float, arguments))
        size = 1.0 if name in ("sin", "cos") else float(truth)
        return float(abs(mpmath.mpf(mine) - truth)) / math.ulp(size)


@pytest.mark.parametrize("name", CASES)
def test_of_one_number(name: str) -> None:
    arguments, most = CASES[name]
    assert max(units(name, (float(x),)) for x in arguments) < most


def test_of_two_numbers() -> None:
    rng = np.random.default_rng(5)
    for name, most in (("hypot", 2.0), ("atan2", 4.0)):
        pairs = rng.normal(size=(400, 2)) * 10.0 ** rng.uniform(-150.0, 150.0, (400, 1))
        pairs[:, 1] *= 10.0 ** rng.uniform(-10.0, 0.0, 400)
        assert max(units(name, tuple(pair)) for pair in pairs.tolist()) < most
    for x, y in zip(rng.uniform(0.01, 100.0, 400), rng.uniform(-9.0, 9.0, 400), strict=True):
        assert units("pow", (x, y)) < 3.0 + 2.0 * abs(y * math.log(x))
    odd = FUNCTIONS["pow"]
    assert [odd(-2.0, 3.0), odd(-2.0, 2.0), odd(0.0, 0.5), odd(0.0, -1.0), odd(5.0, 0.0)] == (
        pytest.approx([-8.0, 4.0, 0.0, math.inf, 1.0], rel=1e-15)
    )
    assert math.isnan(odd(-2.0, 0.5))


def test_what_has_no_value_is_nan_and_what_is_too_large_infinite() -> None:
    for name, x in (("log", -1.0), ("asin", 1.1), ("acos", -1.1), ("atanh", 2.0), ("sin", 1e16)):
        assert math.isnan(FUNCTIONS[name](x))
    for name in CASES:
        assert math.isnan(FUNCTIONS[name](math.nan))
    assert [FUNCTIONS[name](x) for name, x in (("exp", 710.0), ("log", 0.0), ("expm1", -99.0))] == [
        math.inf, -math.inf, -1.0,
    ]  # fmt: skip
    assert FUNCTIONS["atan2"](-0.0, -1.0) == -math.pi
