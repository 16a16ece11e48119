# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Makes a folder of programs and shared objects independent of where it lies: `python3 carry_libraries.py FOLDER`.

Copies the shared libraries that its files need into FOLDER/lib/carried, under names of their own, so that they stand beside those of other
packages. Needs patchelf, readelf and ldd (Debian packages: patchelf, binutils, libc-bin).
"""

import hashlib
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

# Libraries of every system, by PEP 600; and libproj, which is of no use without its data bases.
of_the_system = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|util|resolv|gcc_s|stdc\+\+|z|expat|proj))\.so(\.|$)")


def output(*command) -> str:
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def is_elf(file: Path) -> bool:
    return file.is_file() and not file.is_symlink() and file.open("rb").read(4) == b"\x7fELF"


def elf_files(folder: Path) -> list[Path]:
    return sorted(file for file in folder.rglob("*") if is_elf(file))


def needed(file: Path) -> list[str]:
    return re.findall(r"\(NEEDED\).*\[(.*)\]", output("readelf", "--dynamic", "--wide", file))


def libraries_of(file: Path) -> dict[str, Path]:
    """Where the loader finds what a file needs, and what that needs."""
    lines = output("ldd", file)
    return {name: Path(path).resolve() for name, path in re.findall(r"^\s*(\S+) => (/\S+)", lines, re.MULTILINE)}


def carry(folder: Path):
    """Copies libraries, and sets the names and search folders of all files."""
    carried = folder / "lib" / "carried"
    own = {file.name for file in elf_files(folder)}
    names, originals, waiting = {}, {}, list(elf_files(folder))
    while waiting:  # what libraries need, too
        file = waiting.pop()
        found = libraries_of(originals.get(file, file))
        for name in needed(file):
            if name in own or name in names or of_the_system.match(name):
                continue
            if name not in found:
                sys.exit(f"error: {file} needs {name}, which the loader does not find")
            digest = hashlib.sha256(found[name].read_bytes()).hexdigest()[:8]
            names[name] = name.replace(".so", f"-{digest}.so", 1)
            carried.mkdir(parents=True, exist_ok=True)
            copy = carried / names[name]
            shutil.copy(found[name], copy)
            copy.chmod(0o755)
            originals[copy] = found[name]
            waiting.append(copy)
    folders = {name: carried for name in names.values()}
    for file in elf_files(folder):
        if "glibc-hwcaps" not in file.parts:  # the loader looks into these itself
            folders.setdefault(file.name, file.parent)
    for file in elf_files(folder):
        wanted = [(name, names.get(name, name)) for name in needed(file)]
        changes = [["--replace-needed", name, new] for name, new in wanted if name != new]
        kept = {(file.parent / path.removeprefix("$ORIGIN/")).resolve()  # of parts that are loaded on demand
                for path in output("patchelf", "--print-rpath", file).strip().split(":") if path.startswith("$ORIGIN/")}
        search = {file.parent} | {folders[new] for _, new in wanted if new in folders} | {place for place in kept if place.is_relative_to(folder)}
        paths = sorted("$ORIGIN" if place == file.parent else f"$ORIGIN/{os.path.relpath(place, file.parent)}" for place in search)
        if file.parent == carried:
            changes.append(["--set-soname", file.name])
        for change in [*changes, ["--set-rpath", ":".join(paths)]]:  # one at a time: patchelf 0.14 mixes their values up
            output("patchelf", *change, file)


def greatest_version(folder: Path, name: str) -> tuple[int, ...]:
    """Greatest version of the symbols of a library, such as GLIBC or GLIBCXX, that the files ask for."""
    versions = {version for file in elf_files(folder)
                for version in re.findall(rf"\b{name}_(\d+(?:\.\d+)+)", output("readelf", "--version-info", "--wide", file))}
    return max(tuple(int(part) for part in version.split(".")) for version in versions)


def static_library(name: str) -> str:
    """Path of a static library of the compiler; empty if there is none."""
    path = output(os.environ.get("CXX", "c++").split()[-1], f"-print-file-name=lib{name}.a").strip()
    return path if "/" in path else ""


def copy_licences(folder: Path, build: Path):
    """Copies the licences of carried libraries and of those compiled in, by the Debian packages that have them."""
    licences = folder / "licences"
    licences.mkdir(exist_ok=True)
    configuration = (build / "CPackConfig.cmake").read_text()
    listed = re.search(r'CPACK_DEBIAN_PACKAGE_SUGGESTS "(.*)"', configuration)[1].split(", ")
    packages = {"libglm-dev", "libcli11-dev", *listed} - {"libassimp-dev", "libcitygml-dev", "libopenmpi-dev", "openmpi-bin", "libproj-dev"}
    for name in (folder / "lib" / "carried").glob("*.so*"):
        original = re.sub(r"-[0-9a-f]{8}\.so", ".so", name.name)
        owners = output("dpkg", "--search", f"*/{original}")
        packages.add(re.match(r"([^:, ]+)", owners)[1])
    for package in sorted(packages):
        text = Path("/usr/share/doc") / package / "copyright"
        if not text.is_file():
            sys.exit(f"error: the licence of {package} is not in {text}, and a wheel must carry it")
        shutil.copy(text, licences / f"{package}.txt")


if __name__ == "__main__":
    carry(Path(sys.argv[1]).resolve())
    for library in ("GLIBC", "GLIBCXX"):
        print(library, ".".join(str(part) for part in greatest_version(Path(sys.argv[1]), library)))
