"""The compiled kernels of core; everything else is in pyproject.toml."""

import os
import platform
import runpy
import shutil
import sys
import sysconfig
from pathlib import Path

from pybind11.setup_helpers import Pybind11Extension, build_ext
from setuptools import setup

WINDOWS = sys.platform == "win32"
FLAGS = ["/O2"] if WINDOWS else ["-O3", "-ffp-contract=fast", "-fno-math-errno", "-fopenmp-simd"]
AVX2 = ["-mavx2", "-mfma", "-mtune=haswell"]
FOLDER = Path("core", "compiled")
DIGEST = runpy.run_path(str(FOLDER / "sources.py"))["digest"]()


def kernels(name: str, flags: list[str]) -> Pybind11Extension:
    """The module ``southwell.core.compiled.NAME``, compiled with ``flags``."""
    return Pybind11Extension(
        f"southwell.core.compiled.{name}",
        [str(FOLDER / "module.cpp")],
        define_macros=[("MODULE", name), ("SOURCES", f'"{DIGEST}"')],
        extra_compile_args=FLAGS + flags,
        depends=sorted(map(str, Path("core").rglob("*.hpp"))),
        cxx_std=17,
    )


class Build(build_ext):
    """Say what is missing before the compiler does."""

    def build_extensions(self) -> None:
        """Compile the modules."""
        compiler = os.environ.get("CXX") or (sysconfig.get_config_var("CXX") or "c++").split()[0]
        if not WINDOWS and not shutil.which(compiler):
            sys.exit(f"southwell: no C++ compiler ({compiler}): install one, on Debian and Ubuntu: apt install g++")
        if not Path(sysconfig.get_path("include"), "Python.h").is_file():
            sys.exit("southwell: no Python.h: install Python's headers, on Debian and Ubuntu: apt install python3-dev")
        super().build_extensions()


modules = [kernels("baseline", [])]
if platform.machine() == "x86_64" and not WINDOWS:  # MSVC has no way to ask the processor for AVX2
    modules.append(kernels("avx2", AVX2))

setup(ext_modules=modules, cmdclass={"build_ext": Build}, options={"build_ext": {"parallel": len(modules)}})
