# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
from pathlib import Path

from ._core import *
from ._core import __version__ as __version__

def asset_folders() -> list[Path]: ...
