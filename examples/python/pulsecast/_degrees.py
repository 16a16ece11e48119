# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Angles of settings in degrees: `name_deg` for each member in radians, as attribute and as argument by name."""

import collections.abc
import functools
import inspect
import math
import re
from typing import Any

DEGREE = math.pi / 180


def radians(angle_deg: Any, name: str) -> Any:
    """Radians of an angle, or of several, as documents convert them; None stays."""
    if angle_deg is None:
        return None
    try:
        if isinstance(angle_deg, collections.abc.Iterable):
            return tuple(float(one) * DEGREE for one in angle_deg)
        if isinstance(angle_deg, bool):
            raise TypeError
        return float(angle_deg) * DEGREE
    except (TypeError, ValueError):
        raise TypeError(f"{name}: expected an angle in degrees, not {angle_deg!r}") from None


def degrees(angle: Any) -> Any:
    """The number of degrees, of 15 digits where these are the angle again; of several a tuple; None stays."""
    if angle is None:
        return None
    if isinstance(angle, collections.abc.Iterable):
        return tuple(degrees(one) for one in angle)
    about = angle / DEGREE
    short = float(f"{about:.15g}")
    return short if short * DEGREE == angle else about


ANGLE = re.compile(r"^(\w+): (?:float|float \| None|tuple\[float, float, float\])\n    (.*\[rad(?:/s)?\])(?:;.*)?$", re.MULTILINE)


def add_degrees(made: type) -> None:
    """Adds `name_deg` for each member of a class of settings that is in radians, or radians a second, by its docstring."""
    angles = dict(ANGLE.findall(made.__doc__ or ""))
    if not angles:
        return
    init: Any = made.__init__  # type: ignore[misc]
    known = {name + "_deg": name for name in angles}

    @functools.wraps(init)
    def with_degrees(self: Any, *args: Any, **members: Any) -> None:
        for name_deg in known.keys() & members.keys():
            angle_deg = members.pop(name_deg)
            if angle_deg is None:
                continue
            if known[name_deg] in members:
                raise TypeError(f"{made.__name__}: expected one of {known[name_deg]} and {name_deg}, not both")
            members[known[name_deg]] = radians(angle_deg, f"{made.__name__}.{name_deg}")
        init(self, *args, **members)

    signature = inspect.signature(init)
    more = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None) for name in known]
    with_degrees.__signature__ = signature.replace(parameters=[*signature.parameters.values(), *more])  # type: ignore[attr-defined]
    made.__init__ = with_degrees  # type: ignore[misc]
    for name_deg, name in known.items():
        setattr(made, name_deg, _property(made, name_deg, name, angles[name]))


def _property(made: type, name_deg: str, name: str, doc: str) -> property:
    def read(self: Any) -> Any:
        return degrees(getattr(self, name))

    def write(self: Any, angle_deg: Any) -> None:
        setattr(self, name, radians(angle_deg, f"{made.__name__}.{name_deg}"))

    return property(read, write, doc=f"`{name}` in degrees: {doc.replace('[rad', '[deg')}")
