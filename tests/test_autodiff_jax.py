"""Stops and states under jax: derivatives against its own differences, jit, vmap, refusals."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

jax = pytest.importorskip("jax")

import jax.numpy as jnp  # noqa: E402
from jax.test_util import check_grads  # noqa: E402

from puck_tables import states as plain_states  # noqa: E402
from puck_tables import stop as plain_stop  # noqa: E402
from puck_tables.autodiff.jax import states, stop  # noqa: E402
from puck_tables.errors import InputError  # noqa: E402


@pytest.fixture(autouse=True)
def double() -> Iterator[None]:
    with jax.enable_x64(True):
        yield


LAUNCH = [1.0, 0.3], 2.0, 0.4, 1.3, 0.8


def test_stops_pass_check_grads():
    def f(velocity, spin, delta, decel, radius):
        return stop(velocity, spin, delta=delta, decel=decel, radius=radius)

    arguments = tuple(jnp.asarray(one) for one in LAUNCH)
    check_grads(f, arguments, order=1, atol=1e-5, rtol=1e-5, eps=1e-4)
    check_grads(jax.jit(f), arguments, order=1, atol=1e-5, rtol=1e-5, eps=1e-4)


def test_states_pass_check_grads():
    def f(velocity, spin, time, delta):
        return states(velocity, spin, time, delta=delta)

    arguments = tuple(map(jnp.asarray, ([[1.0, 0.3], [-0.5, 2.0]], 2.0, [0.4, 0.9], 0.7)))
    check_grads(f, arguments, order=1, atol=1e-5, rtol=1e-5, eps=1e-4)


def test_other_pucks_pass_check_grads():
    """A tall one by all its numbers, one under another law by a launch."""

    def tall(velocity, spin, delta, decel, radius):
        return stop(velocity, spin, delta=delta, decel=decel, radius=radius)

    arguments = tuple(map(jnp.asarray, ([1.0, 0.3], 2.0, 2.1, 1.3, 0.8)))
    check_grads(tall, arguments, order=1, atol=1e-5, rtol=1e-5, eps=1e-4)

    def other(velocity, spin, time):
        return states(velocity, spin, time, pressure="hertz", gyration=0.6)

    arguments = tuple(map(jnp.asarray, ([1.0, 0.3], 2.0, 0.4)))
    check_grads(jax.jit(other), arguments, order=1, atol=1e-5, rtol=1e-5, eps=1e-4)


def test_values_and_jacobians_are_those_of_the_library():
    velocity, spin = np.random.default_rng(1).normal(size=(7, 2)), np.linspace(-3.0, 3.0, 7)
    found = plain_stop(velocity, spin, tol=2e-10, jacobian=True)
    assert np.array_equal(stop(velocity, spin)[:, 0], found.stop_time)
    by_map = jax.vmap(jax.jacobian(lambda v, w: stop(v, w), argnums=(0, 1)))(velocity, spin)
    assert np.allclose(by_map[0], found.jacobian[:, :, :2], atol=1e-13)
    assert np.allclose(by_map[1], found.jacobian[:, :, 2], atol=1e-13)
    found = plain_states(velocity, spin, 0.5, jacobian=True)
    by_jit = jax.jit(jax.vmap(jax.jacfwd(lambda v: states(v, 1.0, 0.5))))(velocity)
    assert by_jit.shape == (7, 6, 2)
    assert np.array_equal(states(velocity, spin, 0.5)[:, 0], found.x)


def test_refusals():
    with pytest.raises(InputError, match="single precision"):
        stop(jnp.asarray([1.0, 0.0], jnp.float32), 1.0)
    with jax.enable_x64(False), pytest.raises(InputError, match="jax_enable_x64"):
        stop((1.0, 0.0), 1.0)
    with pytest.raises(InputError, match=r"shape \(..., 2\)"):
        stop(1.0, 1.0)
    with pytest.raises(Exception, match="delta"):
        stop((1.0, 0.0), 1.0, delta=-1.0).block_until_ready()


def test_friction_and_height_pass_check_grads():
    def f(velocity, friction, height, radius):
        return stop(velocity, 2.0, friction=friction, height=height, radius=radius)

    arguments = tuple(map(jnp.asarray, ([1.0, 0.3], 0.2, 0.3, 0.8)))
    check_grads(jax.jit(f), arguments, order=1, atol=1e-5, rtol=1e-5, eps=1e-4)
    truth = plain_stop((1.0, 0.3), 2.0, friction=0.2, height=0.3, radius=0.8)
    assert float(f(*arguments)[0]) == pytest.approx(float(truth.stop_time), abs=1e-9)
    with pytest.raises(InputError, match="in place of delta and decel"):
        states((1.0, 0.0), 1.0, 0.1, friction=0.2, decel=1.0)
