"""Stops and states that torch differentiates once, backward and forward.

The numbers come from the host, in double precision; derivatives from the exact Jacobians.

>>> spin = torch.tensor(5.0, dtype=torch.float64, requires_grad=True)
>>> stop((1.0, 0.0), spin)[1].backward()
>>> round(spin.grad.item(), 6), round(states((1.0, 0.0), 5.0, 2.0)[0].item(), 6)
(0.420792, 1.590682)
"""

from __future__ import annotations

from typing import Any

from puck_tables.autodiff import host
from puck_tables.errors import InputError, MissingExtraError

try:
    import torch
    from torch.autograd.function import once_differentiable
except ImportError:
    raise MissingExtraError("puck_tables.autodiff.torch needs torch: pip install torch") from None


class _Stops(torch.autograd.Function):
    @staticmethod
    def forward(arguments: Any, kind: host.PuckKind) -> Any:
        values = host.values(arguments.numpy(force=True), kind)
        return torch.from_numpy(values).to(arguments.device)

    @staticmethod
    def setup_context(ctx: Any, inputs: Any, output: Any) -> None:
        ctx.save_for_backward(inputs[0])
        ctx.save_for_forward(inputs[0])
        ctx.kind = inputs[1]

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, cotangent: Any) -> Any:
        (arguments,) = ctx.saved_tensors
        slopes = _slopes(arguments, ctx.kind)
        return torch.einsum("...rc,...r->...c", slopes, cotangent), None

    @staticmethod
    def jvp(ctx: Any, moved: Any, _: Any) -> Any:
        (arguments,) = ctx.saved_tensors
        slopes = _slopes(arguments, ctx.kind)
        return torch.einsum("...rc,...c->...r", slopes, moved)


def _slopes(arguments: Any, kind: host.PuckKind) -> Any:
    slopes = host.slopes(arguments.numpy(force=True), kind)
    return torch.from_numpy(slopes).to(arguments.device)


def _array(number: Any) -> Any:
    is_real = isinstance(number, torch.Tensor) and number.is_floating_point()
    if is_real and number.dtype != torch.float64:
        raise InputError(
            f"{number.dtype} is too coarse for the motion of a puck: give torch.float64"
        )
    return torch.as_tensor(number, dtype=torch.float64)


def _merged(velocity: Any, *others: Any) -> Any:
    """Arguments (…, columns) in double precision."""
    direction, *rest = map(_array, (velocity, *others))
    host.refuse_shape(tuple(direction.shape))
    return torch.stack(torch.broadcast_tensors(direction[..., 0], direction[..., 1], *rest), dim=-1)


stop, states = host.functions(_Stops.apply, _merged, _array)
