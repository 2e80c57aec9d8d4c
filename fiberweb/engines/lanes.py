"""Four numbers in one register, for loops that the compiler cannot vectorise by itself because each
round depends on the one before it.

`load(like, array, index)` gives the number at an index, or the four from there on if `like` is
`four()`; `store` writes them back; between them stand +, - and *, and `inverse`. So one
function serves both, and is inlined twice.
"""

from __future__ import annotations

import operator

from llvmlite import ir
from numba import types
from numba.core.typing.templates import ConcreteTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, register_model

COUNT = 4  # of an AVX2 register; elsewhere the compiler takes several smaller ones
_VECTOR = ir.VectorType(ir.DoubleType(), COUNT)
_CONTRACT = ("contract",)  # as everywhere in kernels, see `fiberweb.engines.jit`


class _Four(types.Type):
    def __init__(self):
        super().__init__("four_numbers")


FOUR = _Four()


@register_model(_Four)
class _Model(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, _VECTOR)


def _pairwise(symbol, method: str) -> None:
    @infer_global(symbol)
    class _(ConcreteTemplate):
        cases = [signature(FOUR, FOUR, FOUR)]  # noqa: RUF012

    @lower_builtin(symbol, FOUR, FOUR)
    def _(context, builder, sig, args):
        return getattr(builder, method)(*args, flags=_CONTRACT)


for _symbol, _method in ((operator.add, "fadd"), (operator.sub, "fsub"), (operator.mul, "fmul")):
    _pairwise(_symbol, _method)


def _constant(number: float):
    return ir.Constant(_VECTOR, [number] * COUNT)


def _address(context, builder, kind, array, index):
    array = context.make_array(kind)(context, builder, array)
    return builder.gep(array.data, [index])


@intrinsic
def four(typing):
    """Four zeros."""
    return FOUR(), lambda context, builder, sig, args: _constant(0.0)


@intrinsic
def load(typing, like, array, index):
    """The number of a contiguous array at an unsigned index, or four from there on."""

    def build(context, builder, sig, args):
        address = _address(context, builder, sig.args[1], *args[1:])
        if sig.args[0] is FOUR:
            address = builder.bitcast(address, _VECTOR.as_pointer())
        return builder.load(address, align=8)

    return like(like, array, index), build


@intrinsic
def store(typing, value, array, index):
    """Write back what `load` gave."""

    def build(context, builder, sig, args):
        address = _address(context, builder, sig.args[1], *args[1:])
        if sig.args[0] is FOUR:
            address = builder.bitcast(address, _VECTOR.as_pointer())
        builder.store(args[0], address, align=8)
        return context.get_dummy_value()

    return types.void(value, array, index), build


@intrinsic
def inverse(typing, value):
    """1 / value."""

    def build(context, builder, sig, args):
        one = _constant(1.0) if sig.args[0] is FOUR else ir.Constant(ir.DoubleType(), 1.0)
        return builder.fdiv(one, args[0])

    return value(value), build
