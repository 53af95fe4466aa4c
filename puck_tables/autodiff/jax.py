"""Stops and states that jax differentiates: under ``grad``, ``jvp``, ``jit`` and ``vmap``.

The numbers come from the host by ``pure_callback``, derivatives from the exact Jacobians; their own
derivatives are not known.  In double precision only: ``jax.config.update("jax_enable_x64", True)``.

>>> with jax.enable_x64(True):
...     slope = jax.grad(lambda w: stop((1.0, 0.0), w)[1])(5.0)
...     x = jax.vmap(lambda t: states((1.0, 0.0), 5.0, t)[0])(jnp.array([2.0, 9.0]))
>>> float(slope.round(6)), x.round(6).tolist()
(0.420792, [1.590682, 2.213952])
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from puck_tables.autodiff import host
from puck_tables.errors import InputError, MissingExtraError

try:
    import jax
    import jax.numpy as jnp
except ImportError:
    raise MissingExtraError("puck_tables.autodiff.jax needs jax: pip install jax") from None


@partial(jax.custom_jvp, nondiff_argnums=(1,))
def _stops(arguments: Any, kind: host.PuckKind) -> Any:
    rows = host.ROWS[arguments.shape[-1]]
    shape = jax.ShapeDtypeStruct((*arguments.shape[:-1], rows), np.float64)
    return jax.pure_callback(
        partial(host.values, kind=kind), shape, arguments, vmap_method="broadcast_all"
    )


@_stops.defjvp
def _stops_jvp(kind: host.PuckKind, primals: Any, tangents: Any) -> Any:
    (arguments,), (moved,) = primals, tangents
    rows, columns = host.ROWS[arguments.shape[-1]], arguments.shape[-1]
    shape = jax.ShapeDtypeStruct((*arguments.shape[:-1], rows, columns), np.float64)
    jacobian = jax.pure_callback(
        partial(host.slopes, kind=kind), shape, arguments, vmap_method="broadcast_all"
    )
    return _stops(arguments, kind), jnp.einsum("...rc,...c->...r", jacobian, moved)


def _array(number: Any) -> Any:
    array = jnp.asarray(number)
    if not jax.config.read("jax_enable_x64") or array.dtype == jnp.float32:
        raise InputError(
            "single precision is too coarse for the motion of a puck: call "
            "jax.config.update('jax_enable_x64', True) and give float64"
        )
    return array.astype(jnp.float64)


def _merged(velocity: Any, *others: Any) -> Any:
    """Arguments (…, columns) in double precision."""
    direction, *rest = map(_array, (velocity, *others))
    host.refuse_shape(direction.shape)
    return jnp.stack(jnp.broadcast_arrays(direction[..., 0], direction[..., 1], *rest), axis=-1)


stop, states = host.functions(_stops, _merged, _array)
