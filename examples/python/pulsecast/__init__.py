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
import re
import sys
from pathlib import Path

try:
    import numpy as _
except ImportError:
    if sys.argv[:1] == ["-m"] and getattr(sys, "orig_argv", sys.argv)[-len(sys.argv)].removeprefix("-m") == "pulsecast":  # the program needs none
        from .__main__ import main

        main()
    raise ImportError("pulsecast needs NumPy: expected the Debian package python3-numpy, or `pip install numpy`") from None

from ._core import *  # noqa: F403
from ._core import __version__
from . import _core
from ._degrees import add_degrees

__all__ = [name for name in vars(_core) if not name.startswith("_")] + ["__version__", "asset_folders", "catalogue", "platform", "scanner"]


def _shortly(settings):
    """Settings as text that makes them again: the members that differ from their defaults."""
    pairs = [(member.name, repr(getattr(settings, member.name)), repr(member.default_factory())) for member in dataclasses.fields(settings)]
    return f"{type(settings).__name__}({', '.join(f'{name}={value}' for name, value, default in pairs if value != default)})"


for _made in vars(_core).values():
    if dataclasses.is_dataclass(_made):
        add_degrees(_made)
        _made.__repr__ = _shortly


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
    """ScannerSettings of the `catalogue` by id, with or without that of the maker, or name: 'riegl_vz400', 'vz400', 'RIEGL VZ-400'. Case,
    blanks, hyphens and underscores do not count. Raises ValueError with the nearest id."""
    return _named(catalogue(assets)["scanners"], name, "scanner")


def platform(name, assets=()):
    """PlatformSettings of the `catalogue`, such as 'tripod' or 'sr22', found and refused as by `scanner`."""
    return _named(catalogue(assets)["platforms"], name, "platform")


def _named(known, name, kind):
    """The first of an id; else the only one whose id, with or without its maker, or name is that in `_plain` letters."""
    by_id = {one.id: one for one in reversed(known)}
    if name in by_id:
        return by_id[name]
    spellings = {}  # plain ones, with the ids that they may mean
    for one in by_id.values():
        for spelling in {_plain(text) for text in (one.id, one.id.partition("_")[2], one.name)} - {""}:
            spellings.setdefault(spelling, []).append(one.id)
    found = spellings.get(_plain(name), [])
    if len(found) == 1:
        return by_id[found[0]]
    alike = [spelling for spelling in spellings if spelling.startswith(_plain(name))] or difflib.get_close_matches(_plain(name), spellings, n=1)
    near = found or sorted({one for spelling in alike for one in spellings[spelling]})[:6]
    said = "did you mean " + " or ".join(map(repr, near)) + "?" if near else "catalogue() has all"
    raise ValueError(f"the catalogue has no {kind} {name!r}; {said}")


def _plain(text):
    """A name without case, blanks, hyphens and underscores."""
    return re.sub(r"[\s_-]", "", str(text)).casefold()
