"""What `puck warm-up` compiles, as code of the systems and processors that numba has wheels for.

    python .ci/code_elsewhere.py FOLDER

It is run by the Python of an environment with the package.  numba compiles for this machine, as
ever; what it would optimise next is optimised for each machine, by the same passes of LLVM, which
knows them all, and becomes the object file that numba would make there.  Of each platform a folder
holds the files of :mod:`puck_tables.kernels.kept_code`, and `target.json`.
"""

from __future__ import annotations

import json
import sys
from concurrent.futures import ThreadPoolExecutor
from copy import copy
from pathlib import Path
from typing import Any, NamedTuple

from llvmlite import binding
from numba import config
from numba.core.codegen import JITCodeLibrary, JITCPUCodegen

import puck_tables
from puck_tables.kernels.cache import brought_folder
from puck_tables.kernels.kept_code import KeptCode
from puck_tables.kernels.linking import Behind

V3 = ["avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"]


class Machine(NamedTuple):
    """Who runs it: Python's names; LLVM's name and oldest processor, and what its code uses."""

    place: list[str]
    triple: str
    processor: str
    needs: list[str]


# by the tag of a wheel; numba has none for Intel's Macs, nor for Windows on ARM before Python 3.12
_X86, _ARM = ("x86-64-v3", V3), ("generic", [])
MACHINES = {
    "manylinux_2_17_x86_64": Machine(["linux", "x86_64"], "x86_64-unknown-linux-gnu", *_X86),
    "manylinux_2_17_aarch64": Machine(["linux", "aarch64"], "aarch64-unknown-linux-gnu", *_ARM),
    "macosx_12_0_arm64": Machine(["darwin", "arm64"], "arm64-apple-darwin21.0.0", "apple-m1", []),
    "win_amd64": Machine(["win32", "amd64"], "x86_64-pc-windows-msvc", *_X86),
    "win_arm64": Machine(["win32", "arm64"], "aarch64-pc-windows-msvc", *_ARM),
}
if sys.version_info < (3, 12):
    del MACHINES["win_arm64"]


class Elsewhere(JITCPUCodegen):  # type: ignore[misc]
    """numba's code generator for another machine, as far as passes and object files need one."""

    _loopvect, _opt_level = False, 0

    def __init__(self, machine: Machine) -> None:
        target = binding.Target.from_triple(machine.triple)
        self._tm = target.create_target_machine(
            cpu=machine.processor, opt=config.OPT, codemodel="jitdefault", jit=True,
            reloc="static" if machine.triple.startswith("x86") else "default",
        )  # fmt: skip


def made_for(machine: Machine, library: Any, linked: bytes) -> bytes:
    """The object file of what a library is before it is optimised."""
    there, elsewhere = copy(library), Elsewhere(machine)
    module = binding.parse_bitcode(linked, binding.create_context())
    module.triple, module.data_layout = machine.triple, str(elsewhere._tm.target_data)
    for function in module.functions:
        if function.name == "hypot" and machine.place[0] == "win32":
            function.name = "_hypot"  # as libraries of Windows have it
    there._codegen, there._final_module = elsewhere, module
    _optimize(there)
    return bytes(elsewhere._tm.emit_object(module))


def copy_first(library: Any) -> None:
    """What other code links is a copy: making machine code changes what it is made of."""
    if not isinstance(library, Behind):
        library._finalized = True
        library._shared_module = library._get_module_for_linking().clone()
    _finalize(library)


_optimize, _finalize = Behind._optimize_final_module, JITCodeLibrary._finalize_final_module
_keep = KeptCode.keep


def main(into: Path) -> None:
    """Compile, and write a folder for each platform."""
    kept: list[tuple[Any, ...]] = []
    binding.initialize_all_targets()
    binding.initialize_all_asmprinters()
    with ThreadPoolExecutor() as pool:

        def optimize(library: Any) -> None:
            before = library, library._final_module.as_bitcode()
            library.elsewhere = {
                tag: pool.submit(made_for, machine, *before) for tag, machine in MACHINES.items()
            }
            _optimize(library)

        def keep(place: Any, folder: Path, sig: Any, target: Any, library: Any, parts: Any) -> None:
            kept.append((place, sig, library, parts))
            _keep(place, folder, sig, target, library, parts)

        JITCodeLibrary._finalize_final_module = copy_first
        Behind._optimize_final_module, KeptCode.keep = optimize, keep
        puck_tables.warm_up()
    for tag, machine in MACHINES.items():
        codegen = machine.triple, machine.processor, ""
        folder = into / tag / brought_folder().name
        folder.mkdir(parents=True)
        for place, sig, library, ((name, kind, (_, names)), *others) in kept:
            parts = (name, kind, (library.elsewhere[tag].result(), names)), *others
            _keep(place, folder, sig, codegen, library, parts)
        target = {"place": machine.place, "codegen": codegen, "needs": machine.needs}
        (folder / "target.json").write_text(json.dumps(target), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
