"""The laws as machine code: compiled together once, kept in a file, and bound to the rows of a bench.

Loading the file takes llvmlite only. numba, which takes longer to import than a short run lasts, is imported
when there is something to compile.
"""

import ctypes
import functools
import os
import struct
from collections.abc import Callable, Mapping
from typing import Any, Final

import numpy as np

from hli_bench.base.loading import installed
from hli_bench.laws import cache
from hli_bench.laws.channels import advance_channels
from hli_bench.laws.machine import advance_machine
from hli_bench.laws.rows import TABLES, Rows
from hli_bench.laws.segments import put_segment
from hli_bench.laws.stride import exchange_in, exchange_out, stride

Entry = Callable[..., Any]

ENTRIES: Final[Mapping[Entry, int]] = {
    stride: 5,
    advance_machine: 1,
    exchange_in: 0,
    exchange_out: 0,
    advance_channels: 2,
    put_segment: 3,
}
"""Laws that Python calls, and how many of their last parameters change from call to call; the others are bound."""
COMPILING: Final = "compiling the laws of motion, once until they, numba or the processor change: some 10 s"
"""What to tell people who wait."""
PLAIN: Final = os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0")
"""Laws stay the Python functions that they are."""
_C_TYPES: Final[Mapping[Any, Any]] = {int: ctypes.c_int64, float: ctypes.c_double}
_FUNCTIONS: Final[dict[str, Entry]] = {}
"""Entries into the machine code by name, once it is loaded."""
_ENGINES: Final[list[Any]] = []
"""What holds the machine code, as long as the process."""


@functools.cache
def parameters(entry: Entry) -> Mapping[str, Any]:
    """Return the parameters of a law with their annotations, in order."""
    names = entry.__code__.co_varnames[: entry.__code__.co_argcount]
    return {name: entry.__annotations__[name] for name in names}


def prepare(
    on_compile: Callable[[], None] = lambda: None,
    apart: Callable[[Callable[[], cache.Code]], cache.Code] = lambda work: work(),
) -> None:
    """Load the machine code; when none is kept compile the laws, and call `on_compile` before.

    `apart` does the compiling, in which numba and LLVM call Python back.
    """
    if PLAIN or _FUNCTIONS:
        return
    from llvmlite import binding as llvm

    name = cache.file_name(*_made_by(llvm))
    code = cache.read(name)
    if code is None:
        on_compile()
        code = apart(_compile)
        cache.keep(name, code)
    _load(llvm, code)


def _compile() -> cache.Code:
    from hli_bench.laws.compiler import compile_laws

    return compile_laws()


def bind(entry: Entry, *leading: Rows | float) -> Entry:
    """Return a law with its first arguments fixed, to be called with the ones that change.

    Machine code works on the rows in place, where they lie now. Raises TypeError for rows of another kind.
    """
    if PLAIN:
        return functools.partial(entry, *leading)
    kinds = parameters(entry)
    expected = len(kinds) - ENTRIES[entry]
    if len(leading) != expected:
        raise TypeError(f"{entry.__name__}: {len(leading)} arguments to bind, expected {expected}")
    words: list[int] = []
    for (name, kind), argument in zip(kinds.items(), leading, strict=False):
        if kind is Rows:
            words += _place(entry, name, argument)
        else:
            words += struct.unpack("q", struct.pack("d" if kind is float else "q", argument))
    prepare()
    frame = np.array(words, np.int64)
    address: Any = ctypes.c_void_p(frame.ctypes.data)
    address.keeps = frame, leading
    return functools.partial(_FUNCTIONS[entry.__name__], address)


def _place(entry: Entry, name: str, rows: Any) -> tuple[int, ...]:
    """Return address and shape of rows, which must be what the law takes under that name."""
    dtype, dimensions = TABLES[name]
    flags = rows.flags
    if rows.dtype != dtype or rows.ndim != dimensions or not (flags.c_contiguous and flags.writeable):
        raise TypeError(
            f"{entry.__name__}: {name} is {rows.dtype}, {rows.ndim} dimensions; expected {dtype}, "
            f"{dimensions}, contiguous and writeable"
        )
    # a third of the time of rows.ctypes.data
    address = ctypes.addressof(ctypes.c_char.from_buffer(rows)) if rows.size else 0
    return address, *rows.shape


def _made_by(llvm: Any) -> list[str]:
    """Return what decides which machine code the laws become: compiler, processor."""
    version = installed("numba").with_name("_version.py").read_text(encoding="utf-8")
    return [version, str(llvm.llvm_version_info), llvm.get_process_triple(), *processor(llvm)]


def processor(llvm: Any) -> tuple[str, str]:
    """Return name and features of the processor to compile for: this one, or NUMBA_CPU_NAME."""
    chosen = os.environ.get("NUMBA_CPU_NAME")
    if chosen:
        return chosen, os.environ.get("NUMBA_CPU_FEATURES", "")
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()


def target_machine(llvm: Any) -> Any:
    """Return what makes and loads code for the processor."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    cpu, features = processor(llvm)
    target = llvm.Target.from_triple(llvm.get_process_triple())
    return target.create_target_machine(
        cpu=cpu,
        features=features,
        opt=3,
        reloc="static" if target.name.startswith("x86") else "default",
        codemodel="jitdefault",
        jit=True,
    )


def _load(llvm: Any, code: cache.Code) -> None:
    """Load an object file and take its entries. Raises LookupError when it lacks one.

    They let go of Python's lock while they run: a stride may take many ms, and the threads of Zenoh and CAN go on.
    """
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), target_machine(llvm))
    _ENGINES.append(engine)
    engine.add_object_file(llvm.ObjectFileRef.from_data(code.data))
    engine.finalize_object()
    functions: dict[str, Entry] = {}
    for entry, changing in ENTRIES.items():
        kinds = list(parameters(entry).values())
        kinds = kinds[len(kinds) - changing :]
        prototype = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, *(_C_TYPES[kind] for kind in kinds))
        functions[entry.__name__] = prototype(_address(engine, code.symbols[entry.__name__]))
    _FUNCTIONS.update(functions)


def _address(engine: Any, symbol: str) -> int:
    """Return where a function lies: to call address 0, which the engine gives for none, would end the process."""
    address: int = engine.get_function_address(symbol)
    if not address:
        raise LookupError(f"no {symbol} in the machine code of the laws")
    return address
