"""Stops and states that torch differentiates once, backward and forward.

The numbers come from the host, in double precision; derivatives from the exact Jacobians.
"""

from __future__ import annotations

from typing import Any

from puck_tables.autodiff import host
from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.errors import InputError, MissingExtraError

try:
    import torch
    from torch.autograd.function import once_differentiable
except ImportError:
    raise MissingExtraError(
        'puck_tables.autodiff.torch needs torch: pip install "puck-tables[torch]"'
    ) from None


class _Found(torch.autograd.Function):
    @staticmethod
    def forward(arguments: Any, kind: host.PuckKind) -> Any:
        found = host.values(arguments.numpy(force=True), kind)
        return torch.from_numpy(found).to(arguments.device)

    @staticmethod
    def setup_context(ctx: Any, inputs: Any, output: Any) -> None:
        ctx.save_for_backward(inputs[0])
        ctx.save_for_forward(inputs[0])
        ctx.kind = inputs[1]

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, given: Any) -> Any:
        (arguments,) = ctx.saved_tensors
        slopes = _slopes(arguments, ctx.kind)
        return torch.einsum("...rc,...r->...c", slopes, given), None

    @staticmethod
    def jvp(ctx: Any, moved: Any, _: Any) -> Any:
        (arguments,) = ctx.saved_tensors
        slopes = _slopes(arguments, ctx.kind)
        return torch.einsum("...rc,...c->...r", slopes, moved)


def _slopes(arguments: Any, kind: host.PuckKind) -> Any:
    found = host.slopes(arguments.numpy(force=True), kind)
    return torch.from_numpy(found).to(arguments.device)


def _joined(velocity: Any, *others: Any) -> Any:
    """Arguments (…, columns) in double precision."""
    for one in (velocity, *others):
        if isinstance(one, torch.Tensor) and one.is_floating_point() and one.dtype != torch.float64:
            raise InputError(
                f"{one.dtype} is too coarse for the motion of a puck: give torch.float64"
            )
    way, *rest = (torch.as_tensor(one, dtype=torch.float64) for one in (velocity, *others))
    if way.ndim == 0 or way.shape[-1] != 2:
        raise InputError(f"velocity must have the shape (..., 2), got {tuple(way.shape)}")
    return torch.stack(torch.broadcast_tensors(way[..., 0], way[..., 1], *rest), dim=-1)


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
    torch.Tensor (…, 5)
        Stop time, x, y, path length and body angle, float64.

    Raises
    ------
    InputError
        If a tensor is not float64, or as :func:`puck_tables.stop`.

    Examples
    --------
    >>> spin = torch.tensor(5.0, dtype=torch.float64, requires_grad=True)
    >>> stop((1.0, 0.0), spin)[1].backward()
    >>> round(spin.grad.item(), 6)
    0.420792
    """
    kind = host.PuckKind(pressure, gyration)
    return _Found.apply(_joined(velocity, spin, delta, decel, radius), kind)


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
    torch.Tensor (…, 6)
        x, y, orientation, vx, vy, spin, float64.

    Raises
    ------
    InputError
        As :func:`stop`.

    Examples
    --------
    >>> round(states((1.0, 0.0), 5.0, 2.0)[0].item(), 6)
    1.590682
    """
    joined = _joined(velocity, spin, delta, decel, radius, time)
    return _Found.apply(joined, host.PuckKind(pressure, gyration))
