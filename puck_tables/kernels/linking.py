"""How functions that call each other are compiled: together, once, at a door.

numba optimises every function as soon as it is compiled, together with all that it calls, and makes
machine code of that, also of what only other functions call: what lies ten calls deep is worked on
ten times.  Here a function without a door to Python stays as it was written down, and is optimised
with each door behind which it is called.  A door that another one calls is not part of that: its
machine code is there once, and is called by its address.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from llvmlite import binding
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, Flags
from numba.core.targetconfig import ConfigStack

Library: Any = JITCodeLibrary
AnyCompiler: Any = Compiler
Options: Any = Flags
_compiled_now: Any = ConfigStack


class Called(NamedTuple):
    """A door that compiled code calls: where it stands, for which types, under which symbol."""

    module: str
    name: str
    kinds: tuple[Any, ...]
    symbol: str


CALLED_LATE: dict[str, Called] = {}  # by symbol: those that are compiled when they are called


def put_at(symbol: str, code: Any) -> None:
    """Put a function that is compiled at a symbol under which others call it."""
    address = code.library.get_pointer_to_function(code.fndesc.llvm_func_name)
    binding.add_symbol(symbol, address)


class _NoAddress:
    """The code generator for a function that has no address, and so no environment at one."""

    def __init__(self, codegen: Any) -> None:
        self._codegen = codegen

    def __getattr__(self, name: str) -> Any:
        return getattr(self._codegen, name)

    def set_env(self, *_: Any) -> None:
        """Nothing to do: it belongs to Python objects, and there are none."""


class Pasted(Library):  # type: ignore[misc]
    """The code of a function that only compiled functions call."""

    @property
    def codegen(self) -> Any:
        """The code generator."""
        return _NoAddress(self._codegen)

    def finalize(self) -> None:
        """Nothing is optimised; whoever links it may have it from another library too."""
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == binding.Linkage.external:
                function.linkage = "linkonce_odr"
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """None: it has no address."""
        self._ensure_finalized()
        return 0

    def _get_module_for_linking(self) -> Any:
        self._ensure_finalized()
        return self._final_module


class Behind(Library):  # type: ignore[misc]
    """The code of a function with a door, and of all behind it but for other doors.

    ``calls``: those.
    """

    calls: tuple[Called, ...] = ()

    def finalize(self) -> None:
        """Optimise all of it together, callers first: what nobody calls yet is not taken over."""
        behind: dict[Any, None] = {}
        seen: set[Any] = set()

        def add(libraries: list[Any]) -> None:
            for library in libraries:
                if library not in seen:
                    seen.add(library)
                    add(library._linking_libraries if isinstance(library, Pasted) else [])
                    behind[library] = None

        add(list(self._linking_libraries))  # type: ignore[has-type]
        called = list(reversed(behind))
        self.calls = tuple(one.door for one in called if hasattr(one, "door"))
        self._linking_libraries = [one for one in called if not hasattr(one, "door")]
        super().finalize()
        names = [one.name for one in self._final_module.global_variables]
        self.calls += tuple(CALLED_LATE[name] for name in names if name in CALLED_LATE)


class QuickOptions(Options):  # type: ignore[misc]
    """The options of a compilation; numba compares them at each operator that it looks up."""

    __slots__ = ()

    def __hash__(self) -> int:
        return hash(QuickOptions)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, QuickOptions):
            return NotImplemented
        mine, theirs = self._values, other._values
        return mine == theirs or all(
            getattr(self, name) == getattr(other, name) for name in mine.keys() | theirs.keys()
        )


def is_for_another() -> bool:
    """Whether what is compiled now is a function of somebody else's."""
    options = _compiled_now.top_or_none()
    return options is not None and not isinstance(options, QuickOptions)


class LinkedAtDoors(AnyCompiler):  # type: ignore[misc]
    """numba's compiler, with these libraries."""

    library, has_doors = Pasted, True

    def compile_extra(self, function: Any) -> Any:
        """Compile a function for one signature."""
        self.state.flags = QuickOptions(self.state.flags)
        kind = self.library if self.state.flags.no_cpython_wrapper else Behind
        codegen = self.state.targetctx.codegen()
        self.state.library = kind(codegen, function.__qualname__)
        self.state.library.enable_object_caching()
        return super().compile_extra(function)
