"""Compiles the laws: numba, without fast-math, so that plain Python gives the same bits."""

from collections.abc import Mapping
from typing import Any, Final

import numba
from llvmlite import binding as llvm
from llvmlite import ir
from numba.core import cgutils
from numba.extending import intrinsic, register_jitable
from numba.np.arrayobj import populate_array

from hli_bench.laws.cache import Code
from hli_bench.laws.compiled import LAWS
from hli_bench.laws.native import ENTRIES, Entry, parameters, target_machine
from hli_bench.laws.rows import TABLES, Rows

OPTIONS: Final[Mapping[str, Any]] = {
    "fastmath": False,
    "error_model": "numpy",
    "forceinline": True,
    "_nrt": False,
}
LIBRARY: Final = frozenset({"memset", "memcpy", "memmove", "floor", "ceil", "trunc", "sqrt", "fmod"})
"""What machine code may call: it is loaded without numba, and a call into the dark would end the process."""
_C_TYPES: Final[Mapping[Any, Any]] = {int: numba.int64, float: numba.float64}


@intrinsic(prefer_literal=True)
def table(typing: Any, frame: Any, at: Any, dtype: Any, dimensions: Any) -> Any:
    """Return the rows whose address and shape stand from word `at` of the frame on, C-contiguous."""
    kind = numba.types.Array(dtype.dtype, dimensions.literal_value, "C")

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        words = builder.bitcast(arguments[0], ir.IntType(64).as_pointer())
        address, *shape = [
            builder.load(cgutils.gep_inbounds(builder, words, at.literal_value + word))
            for word in range(1 + kind.ndim)
        ]
        array = context.make_array(kind)(context, builder)
        size = ir.IntType(64)(context.get_abi_sizeof(context.get_data_type(kind.dtype)))
        strides = [size]
        for count in reversed(shape[1:]):
            strides.insert(0, builder.mul(strides[0], count))
        data = builder.inttoptr(address, array.data.type)
        populate_array(array, data, shape, strides, size, meminfo=None)
        return array._getvalue()

    return kind(frame, at, dtype, dimensions), generate


@intrinsic(prefer_literal=True)
def number(typing: Any, frame: Any, at: Any, kind: Any) -> Any:
    """Return the number of a kind that stands in word `at` of the frame."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        words = builder.bitcast(arguments[0], context.get_value_type(kind.dtype).as_pointer())
        return builder.load(cgutils.gep_inbounds(builder, words, at.literal_value))

    return kind.dtype(frame, at, kind), generate


def compile_laws() -> Code:
    """Compile all entries into one object file. Raises RuntimeError when a law calls what is not there at run time."""
    for one in LAWS:
        register_jitable(**OPTIONS)(one)
    symbols: dict[str, str] = {}
    whole: Any = None
    for entry in ENTRIES:
        compiled: Any = numba.cfunc(_signature(entry), **OPTIONS)(_wrapper(entry))
        symbols[entry.__name__] = compiled.native_name
        module = llvm.parse_bitcode(compiled._library._final_module.as_bitcode())
        if whole is None:
            whole = module
        else:
            whole.link_in(module)
    outside = {function.name for function in whole.functions if function.is_declaration}
    outside = {name for name in outside if not name.startswith("llvm.")} - LIBRARY
    if outside:
        raise RuntimeError(f"laws may not raise or allocate, but call {', '.join(sorted(outside))}")
    return Code(symbols, target_machine(llvm).emit_object(whole))


def _signature(entry: Entry) -> Any:
    """Return the C signature of an entry: where its bound arguments stand, then those that change."""
    kinds = list(parameters(entry).values())
    changing = [_C_TYPES[kind] for kind in kinds[len(kinds) - ENTRIES[entry] :]]
    return numba.types.int64(numba.types.voidptr, *changing)


def _wrapper(entry: Entry) -> Entry:
    """Return a function that reads the bound arguments from a frame of 64-bit words and calls the law.

    Of rows the frame holds address and shape, of numbers the value.
    """
    kinds = list(parameters(entry).items())
    bound, changing = kinds[: len(kinds) - ENTRIES[entry]], kinds[len(kinds) - ENTRIES[entry] :]
    names: dict[str, Any] = {"law": entry, "table": table, "number": number}
    names |= {str(kind): kind for kind in _C_TYPES.values()}
    arguments: list[str] = []
    at = 0
    for name, kind in bound:
        if kind is Rows:
            names[name], dimensions = TABLES[name]
            arguments.append(f"table(frame, {at}, {name}, {dimensions})")
            at += 1 + dimensions
        else:
            arguments.append(f"number(frame, {at}, {_C_TYPES[kind]})")
            at += 1
    varying = [name for name, _ in changing]
    call = f"law({', '.join([*arguments, *varying])})"
    body = f"{call}; return 0" if entry.__annotations__["return"] is None else f"return {call}"
    exec(f"def entry({', '.join(['frame', *varying])}): {body}", names)
    made: Entry = names["entry"]
    return made
