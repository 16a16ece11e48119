# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Builds the wheel by CMake: `pip wheel --no-build-isolation --no-deps .`; docs/packaging/README.md describes it.

PULSECAST_BUILD: folder of a finished build to pack, in place of an own one in build/wheel. PULSECAST_LEVELS: x86-64 levels of the
own one, by default 1;3;4; empty for one build with the compiler's flags.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

root = Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(root / "docs" / "packaging"))
import carry_libraries  # noqa: E402

version = re.search(r'PULSECAST_VERSION "(.*)"', (root / "include/pulsecast/version.hpp").read_text())[1]


def run(*command):
    subprocess.run([str(word) for word in command], check=True)


def own_build() -> Path:
    """Folder of the build, finished."""
    folder = root / "build" / "wheel"
    levels = os.environ.get("PULSECAST_LEVELS", "1;3;4" if os.uname().machine == "x86_64" else "")
    generator = ["-G", "Ninja"] if shutil.which("ninja") and "CMAKE_GENERATOR" not in os.environ else []
    # libarchive's static library: the shared one needs libxml2 and ICU, 30 MB, for archives that are not written
    archive = carry_libraries.static_library("archive")
    static = [f"-DLibArchive_LIBRARY={archive}", "-DCMAKE_CXX_STANDARD_LIBRARIES=-Wl,--as-needed -lnettle -lz",
              *(f"-DCMAKE_{kind}_LINKER_FLAGS=-Wl,--gc-sections" for kind in ("SHARED", "MODULE"))] if archive else []
    without = ["-DCMAKE_DISABLE_FIND_PACKAGE_PROJ=ON"]  # which needs curl, SQLite and data bases
    run("cmake", "-S", root, "-B", folder, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF", f"-DPULSECAST_LEVELS={levels}",
        f"-DPython_EXECUTABLE={sys.executable}", *without, *static)
    jobs = os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", str(os.cpu_count()))
    run("cmake", "--build", folder, "--parallel", jobs, "--target", "wheel")
    return folder


class BuildPackage(build_py):
    """The package, from the files that CMake installs."""

    def run(self):
        build = Path(os.environ["PULSECAST_BUILD"]) if "PULSECAST_BUILD" in os.environ else own_build()
        prefix, package = root / "build" / "wheel_prefix", Path(self.build_lib).resolve() / "pulsecast"
        for folder in (prefix, package):
            shutil.rmtree(folder, ignore_errors=True)
        run("cmake", "--install", build, "--component", "wheel", "--strip", "--prefix", prefix)
        modules = list(prefix.rglob("pulsecast/__init__.py"))
        if len(modules) != 1:
            sys.exit("error: the build has no Python module: expected the Debian packages pybind11-dev, python3-dev and python3-numpy")
        shutil.move(modules[0].parent, package)
        for folder in ("bin", "lib/pulsecast", "share/pulsecast"):
            shutil.copytree(prefix / folder, package / folder, dirs_exist_ok=True)
        carry_libraries.carry(package)
        carry_libraries.copy_licences(package, build)
        self.distribution.data_files = [
            (str(file.parent.relative_to(prefix)), [str(file.relative_to(root))])
            for folder in ("share/man", "share/bash-completion", "share/zsh") for file in (prefix / folder).rglob("*") if file.is_file()]


class PlatformWheel(bdist_wheel):
    """A wheel for one version of Python, and the least glibc that its files need."""

    def get_tag(self):
        python, abi, platform = super().get_tag()
        if platform.startswith("linux_"):
            package = Path(self.get_finalized_command("build").build_platlib).resolve() / "pulsecast"
            major, minor = carry_libraries.greatest_version(package, "GLIBC")[:2]
            platform = platform.replace("linux", f"manylinux_{major}_{minor}", 1)
        return python, abi, platform


class BinaryDistribution(Distribution):
    def has_ext_modules(self):
        return True


(root / "build").mkdir(exist_ok=True)
setup(version=version, distclass=BinaryDistribution, package_dir={"": "examples/python"}, scripts=["docs/packaging/wheel/pulsecast"],
      long_description=(root / "README.md").read_text(), long_description_content_type="text/markdown",
      cmdclass={"build_py": BuildPackage, "bdist_wheel": PlatformWheel}, options={"egg_info": {"egg_base": "build"}})
