"""Stops and states under torch: its gradcheck, values of the library, refusals."""

from __future__ import annotations

import re

import numpy as np
import pytest

torch = pytest.importorskip("torch")

from conftest import ROOT  # noqa: E402

from puck_tables import states as plain_states  # noqa: E402
from puck_tables import stop as plain_stop  # noqa: E402
from puck_tables.autodiff.torch import states, stop  # noqa: E402
from puck_tables.errors import InputError  # noqa: E402

# torch warns of its own forward mode
pytestmark = pytest.mark.filterwarnings("ignore:.torch.jit.script. is deprecated")


def leaf(values: object) -> object:
    return torch.tensor(values, dtype=torch.float64, requires_grad=True)


def test_stops_pass_gradcheck():
    def f(velocity, spin, delta, decel, radius):
        return stop(velocity, spin, delta=delta, decel=decel, radius=radius)

    arguments = tuple(map(leaf, ([[1.0, 0.3], [-0.5, 2.0]], [2.0, -1.0], 0.4, 1.3, 0.8)))
    assert torch.autograd.gradcheck(f, arguments, eps=1e-4, atol=1e-5, check_forward_ad=True)


def test_states_pass_gradcheck():
    def f(velocity, spin, time):
        return states(velocity, spin, time, delta=0.7)

    arguments = tuple(map(leaf, ([[1.0, 0.3], [-0.5, 2.0]], 2.0, [0.4, 0.9])))
    assert torch.autograd.gradcheck(f, arguments, eps=1e-4, atol=1e-5, check_forward_ad=True)


@pytest.mark.thorough
def test_other_pucks_pass_gradcheck():
    """A tall one by all its numbers, one under another law by a launch."""

    def tall(velocity, spin, delta, decel, radius):
        return stop(velocity, spin, delta=delta, decel=decel, radius=radius)

    arguments = tuple(map(leaf, ([1.0, 0.3], 2.0, 2.1, 1.3, 0.8)))
    assert torch.autograd.gradcheck(tall, arguments, eps=1e-4, atol=1e-5, check_forward_ad=True)

    def other(velocity, spin, time):
        return states(velocity, spin, time, pressure="hertz", gyration=0.6)

    arguments = tuple(map(leaf, ([1.0, 0.3], 2.0, 0.4)))
    assert torch.autograd.gradcheck(other, arguments, eps=1e-4, atol=1e-5, check_forward_ad=True)


def test_values_are_those_of_the_library():
    velocity, spin = np.random.default_rng(1).normal(size=(7, 2)), np.linspace(-3.0, 3.0, 7)
    found = plain_stop(velocity, spin, tol=2e-10)
    assert np.array_equal(stop(velocity, spin)[:, 0].numpy(), found.stop_time)
    assert np.array_equal(states(velocity, spin, 0.5)[:, 1], plain_states(velocity, spin, 0.5).y)


def test_values_are_known_where_derivatives_are_not():
    still = stop((0.0, 0.0), leaf(0.0))
    assert not still.any()
    with pytest.raises(InputError, match="at rest"):
        still.sum().backward()


def test_pure_spin_has_gradients():
    velocity = leaf([0.0, 0.0])
    stop(velocity, 3.0)[1].backward()
    found = plain_stop((0.0, 0.0), 3.0, jacobian=True)
    assert np.allclose(velocity.grad, found.jacobian[1, :2], atol=1e-14)


def test_refusals():
    with pytest.raises(InputError, match="float32 is too coarse"):
        stop(torch.ones(2), 1.0)
    with pytest.raises(InputError, match=r"shape \(..., 2\)"):
        stop(1.0, 1.0)
    with pytest.raises(InputError, match="delta"):
        stop((1.0, 0.0), 1.0, delta=leaf(-1.0))


def test_the_program_of_the_page_prints_what_it_says(capsys: pytest.CaptureFixture[str]):
    text = (ROOT / "docs" / "derivatives.md").read_text(encoding="utf-8")
    program = re.search(r"```python\n(import torch.*?)```", text, re.DOTALL)[1]
    exec(program, {})
    assert capsys.readouterr().out.strip() == program.rpartition("# ")[2].strip()


def test_friction_and_height_pass_gradcheck():
    def f(velocity, friction, height, radius):
        return stop(velocity, 2.0, friction=friction, height=height, radius=radius)

    arguments = tuple(map(leaf, ([1.0, 0.3], 0.2, 0.3, 0.8)))
    assert torch.autograd.gradcheck(f, arguments, eps=1e-4, atol=1e-5, check_forward_ad=True)
    truth = plain_stop((1.0, 0.3), 2.0, friction=0.2, height=0.3, radius=0.8)
    assert f(*arguments)[0].item() == pytest.approx(float(truth.stop_time), abs=1e-9)
    with pytest.raises(InputError, match="in place of delta and decel"):
        states((1.0, 0.0), 1.0, 0.1, friction=0.2, decel=1.0)
