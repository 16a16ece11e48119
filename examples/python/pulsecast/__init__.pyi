# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
import os
from collections.abc import Sequence
from pathlib import Path

from ._core import *
from ._core import __version__ as __version__
from ._core import _Assets

def asset_folders() -> list[Path]: ...
def catalogue(assets: Sequence[str | os.PathLike[str]] = ...) -> _Assets: ...
def scanner(name: str, assets: Sequence[str | os.PathLike[str]] = ...) -> ScannerSettings: ...
def platform(name: str, assets: Sequence[str | os.PathLike[str]] = ...) -> PlatformSettings: ...
