# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
from pathlib import Path

from ._core import *

def asset_folders() -> list[Path]: ...
