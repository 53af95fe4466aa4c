"""Stops and states that jax differentiates: under ``grad``, ``jvp``, ``jit`` and ``vmap``.

The numbers come from the host by ``pure_callback``, derivatives from the exact Jacobians; their own
derivatives are not known.  In double precision only: ``jax.config.update("jax_enable_x64", True)``.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from puck_tables.autodiff import host
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.errors import InputError, MissingExtraError

try:
    import jax
    import jax.numpy as jnp
except ImportError:
    raise MissingExtraError(
        'puck_tables.autodiff.jax needs jax: pip install "puck-tables[jax]"'
    ) from None


@partial(jax.custom_jvp, nondiff_argnums=(1,))
def _found(arguments: Any, kind: host.PuckKind) -> Any:
    rows = host.ROWS[arguments.shape[-1]]
    shape = jax.ShapeDtypeStruct((*arguments.shape[:-1], rows), np.float64)
    return jax.pure_callback(
        partial(host.values, kind=kind), shape, arguments, vmap_method="broadcast_all"
    )


@_found.defjvp
def _found_jvp(kind: host.PuckKind, primals: Any, tangents: Any) -> Any:
    (arguments,), (moved,) = primals, tangents
    rows, columns = host.ROWS[arguments.shape[-1]], arguments.shape[-1]
    shape = jax.ShapeDtypeStruct((*arguments.shape[:-1], rows, columns), np.float64)
    jacobian = jax.pure_callback(
        partial(host.slopes, kind=kind), shape, arguments, vmap_method="broadcast_all"
    )
    return _found(arguments, kind), jnp.einsum("...rc,...c->...r", jacobian, moved)


def _joined(velocity: Any, *others: Any) -> Any:
    """Arguments (…, columns) in double precision."""
    arrays = [jnp.asarray(one) for one in (velocity, *others)]
    if not jax.config.read("jax_enable_x64") or any(array.dtype == jnp.float32 for array in arrays):
        raise InputError(
            "single precision is too coarse for the motion of a puck: call "
            "jax.config.update('jax_enable_x64', True) and give float64"
        )
    way, *rest = (array.astype(jnp.float64) for array in arrays)
    if way.ndim == 0 or way.shape[-1] != 2:
        raise InputError(f"velocity must have the shape (..., 2), got {way.shape}")
    return jnp.stack(jnp.broadcast_arrays(way[..., 0], way[..., 1], *rest), axis=-1)


def stop(
    velocity: Any, spin: Any = 0.0, *, delta: Any = 0.5, decel: Any = 1.0, radius: Any = 1.0,
    pressure: str | Law = "uniform", gyration: float = HOMOGENEOUS,
) -> Any:  # fmt: skip
    """Stops of pucks, as :func:`puck_tables.stop`.

    Parameters
    ----------
    velocity : (…, 2), m/s
    spin, delta, decel, radius : (…), rad/s, 1, m/s², m
    pressure, gyration : as :class:`puck_tables.Puck`; not differentiated

    Returns
    -------
    jax.Array (…, 5)
        Stop time, x, y, path length and body angle.

    Raises
    ------
    InputError
        If a number is in single precision, or the shape of ``velocity`` is wrong.  What
        :func:`puck_tables.stop` refuses comes through jax as its own error, with that sentence.

    Examples
    --------
    >>> with jax.enable_x64(True):
    ...     float(jax.grad(lambda w: stop((1.0, 0.0), w)[1])(5.0).round(6))
    0.420792
    """
    return _found(_joined(velocity, spin, delta, decel, radius), host.PuckKind(pressure, gyration))


def states(
    velocity: Any, spin: Any, time: Any, *, delta: Any = 0.5, decel: Any = 1.0, radius: Any = 1.0,
    pressure: str | Law = "uniform", gyration: float = HOMOGENEOUS,
) -> Any:  # fmt: skip
    """States of pucks, as :func:`puck_tables.states`.

    Parameters
    ----------
    velocity : (…, 2), m/s
    spin, time, delta, decel, radius : (…), rad/s, s, 1, m/s², m
    pressure, gyration : as :class:`puck_tables.Puck`; not differentiated

    Returns
    -------
    jax.Array (…, 6)
        x, y, orientation, vx, vy, spin.

    Raises
    ------
    InputError
        As :func:`stop`.

    Examples
    --------
    >>> with jax.enable_x64(True):
    ...     x = jax.vmap(lambda t: states((1.0, 0.0), 5.0, t)[0])(jnp.array([2.0, 9.0]))
    >>> x.round(6).tolist()
    [1.590682, 2.213952]
    """
    joined = _joined(velocity, spin, delta, decel, radius, time)
    return _found(joined, host.PuckKind(pressure, gyration))
