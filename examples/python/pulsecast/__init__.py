# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Virtual laser scanning: surveys in, NumPy arrays out.

    import pulsecast

    survey = pulsecast.read_survey("survey.xml")
    survey.legs[0].platform.position = (0, 0, 120)
    points = pulsecast.Simulation(survey).run().points

Settings are dataclasses; numbers are in SI units and radians, and each angle is in degrees, too, as `name_deg`.
"""

import dataclasses
import difflib
from pathlib import Path

try:
    import numpy as _
except ImportError:
    raise ImportError("pulsecast needs NumPy: expected the Debian package python3-numpy, or `pip install numpy`") from None

from ._core import *  # noqa: F403
from ._core import __version__
from . import _core
from ._degrees import add_degrees

__all__ = [name for name in vars(_core) if not name.startswith("_")] + ["__version__", "asset_folders", "catalogue", "platform", "scanner"]

for _made in vars(_core).values():
    if dataclasses.is_dataclass(_made):
        add_degrees(_made)


def asset_folders() -> list[Path]:
    """Folder of this package with the catalogue of scanners and platforms and the spectra of materials; empty if not installed."""
    here = Path(__file__).resolve()
    places = [here.parents[2] / "catalogue"] + [parent / "share" / "pulsecast" for parent in here.parents]
    return [place for place in places if (place / "data").is_dir()][:1]


def catalogue(assets=()):
    """Scanners and platforms of the catalogue, after those of `data/scanners*.xml` and `data/platforms*.xml` in the folders `assets`: a dict
    of lists of settings, as of `read_assets`."""
    folders = [Path(folder) for folder in assets]
    known = {"scanners": [], "platforms": [], "scenes": []}
    for folder in folders + asset_folders():
        for kind in ("scanners", "platforms"):
            for file in sorted((folder / "data").glob(kind + "*.xml")):
                known[kind] += _core.read_assets(file, folders)[kind]
    return known


def scanner(name, assets=()):
    """ScannerSettings of the `catalogue` by id, also without that of the maker: 'riegl_vz400' or 'vz400'. Raises ValueError with the
    nearest name."""
    return _named(catalogue(assets)["scanners"], name, "scanner")


def platform(name, assets=()):
    """PlatformSettings of the `catalogue` by id, such as 'tripod' or 'sr22'. Raises ValueError with the nearest name."""
    return _named(catalogue(assets)["platforms"], name, "platform")


def _named(known, name, kind):
    """The first of an id; else the only one whose id is that after a maker's."""
    by_id = {one.id: one for one in reversed(known)}
    short = [one for one in by_id if one.partition("_")[2] == name]
    if name in by_id or len(short) == 1:
        return by_id[name if name in by_id else short[0]]
    near = difflib.get_close_matches(str(name), by_id, n=1)
    said = f"did you mean {near[0]!r}?" if near else "known names: " + ", ".join(sorted(by_id))
    raise ValueError(f"the catalogue has no {kind} {name!r}; {said}")
