# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Virtual laser scanning: surveys in, NumPy arrays out.

    import pulsecast

    survey = pulsecast.read_survey("survey.xml", assets=pulsecast.asset_folders())
    survey.legs[0].platform.position = (0, 0, 120)
    points = pulsecast.Simulation(survey).run().points

Settings are dataclasses; numbers are in SI units and radians.
"""

from pathlib import Path

try:
    import numpy as _
except ImportError:
    raise ImportError("pulsecast needs NumPy: expected the Debian package python3-numpy, or `pip install numpy`") from None

from ._core import *  # noqa: F403
from ._core import __version__
from . import _core

__all__ = [name for name in vars(_core) if not name.startswith("_")] + ["__version__", "asset_folders"]


def asset_folders() -> list[Path]:
    """Folder of this package with the catalogue of scanners and platforms and the spectra of materials; empty if not installed."""
    here = Path(__file__).resolve()
    places = [here.parents[2] / "catalogue"] + [parent / "share" / "pulsecast" for parent in here.parents]
    return [place for place in places if (place / "data").is_dir()][:1]
