# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""The survey program, by `python3 -m pulsecast`: `doctor` tells of this Python, too."""

import os
import platform
import sys
from importlib import metadata
from pathlib import Path


def program() -> str:
    """Path of the survey program: in the package, beside it in a build, or under the prefix that both are installed in."""
    here = Path(__file__).resolve()
    places = [here.parents[2] / "pulsecast"] + [parent / "bin" / "pulsecast" for parent in here.parents]
    for place in places:
        if place.is_file():
            return str(place)
    sys.exit("error: the survey program is not installed with this module: expected it of the same build, wheel or .deb (docs/packaging)")


def environment() -> dict[str, str]:
    """Variables of this process, and what `doctor` says of Python."""
    try:
        numpy = "NumPy " + metadata.version("numpy")
    except metadata.PackageNotFoundError:
        numpy = "missing: NumPy, without which pulsecast cannot be imported (Debian package: python3-numpy)"
    return os.environ | {"PULSECAST_PYTHON": f"{platform.python_version()}, {numpy}"}


def main() -> None:
    """Becomes the survey program, with the same arguments."""
    path = program()
    os.execve(path, [path, *sys.argv[1:]], environment())


if __name__ == "__main__":
    main()
