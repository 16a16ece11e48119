# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""The module is whole: it reaches every setting of a survey in C++, each name has a docstring, and the page lists all."""

import dataclasses
from pathlib import Path

import pytest

import members
import pulsecast

PAGE = Path(__file__).parents[3] / "docs" / "tables" / "python.md"


@pytest.mark.parametrize("name", [name for name, _ in members.settings_of_cpp()])
def test_each_setting_of_a_survey_is_reached_or_says_why_not(name):
    [(way, reason)] = [(way, reason) for one, _, way, reason in members.ways() if one == name]
    assert (way is None) != (reason is None), f"{name}: expected a way in REACHED that is there, or a reason in WITHOUT"


def test_the_table_names_nothing_that_is_not_there():
    known = {name for name, _ in members.settings_of_cpp()}
    assert len(known) > 60
    assert not {*members.REACHED, *members.WITHOUT} - known
    assert not [place for places in members.REACHED.values() for place in places if not members.has(place)]
    assert not members.has("Mesh(colours)") and not members.has("Mesh.colours") and not members.has("Meshes")


@pytest.mark.parametrize("name", members.names())
def test_each_name_has_a_docstring(name):
    found = getattr(pulsecast, name)
    if not isinstance(found, type) and not callable(found):
        return
    assert members.text_of(found), name
    if dataclasses.is_dataclass(found):
        assert not [field.name for field in dataclasses.fields(found) if f"\n{field.name}: {field.type}\n" not in found.__doc__]
    elif isinstance(found, type) and not issubclass(found, BaseException):
        assert not [member for member, text in members.members_of(found) if not text]


def test_the_page_has_all_members():
    assert PAGE.read_text(encoding="utf-8").splitlines() == "\n".join(members.page()).splitlines(), \
        "docs/tables/python.md: expected what tests/examples/python/members.py prints"
