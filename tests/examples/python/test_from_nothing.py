# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Surveys from nothing, without a document: instruments by name, angles in degrees, and the example of the page."""

import copy
import math
import pickle
import re
from pathlib import Path

import numpy as np
import pytest

import pulsecast

PAGE = Path(__file__).parents[3] / "docs" / "python.md"


def test_instruments_of_the_catalogue_have_names():
    assert pulsecast.scanner("vz400") == pulsecast.scanner("riegl_vz400") and pulsecast.scanner("vz400").name == "RIEGL VZ-400"
    assert pulsecast.platform("tripod").kind == "stationary"
    known = pulsecast.catalogue()
    assert {one.id for one in known["scanners"]} > {"riegl_vz400", "vlp16", "gedi"} and len(known["platforms"]) > 10
    with pytest.raises(ValueError, match="^the catalogue has no scanner 'riegl_vz40'; did you mean 'riegl_vz400'\\?$"):
        pulsecast.scanner("riegl_vz40")
    with pytest.raises(ValueError, match="no platform 'xyz'; known names: .*, tripod, "):
        pulsecast.platform("xyz")


def test_documents_of_one_s_own_come_before_the_catalogue(tmp_path):
    (tmp_path / "data").mkdir()
    for name, rate in (("riegl_vz400", 7), ("own_one", 9), ("other_one", 9)):
        text = f'<document><scanner id="{name}" name="of one\'s own" optics="conic" pulseFreqs_Hz="{rate}"/></document>'
        (tmp_path / "data" / f"scanners_{name}.xml").write_text(text)
    assert pulsecast.scanner("vz400", assets=[tmp_path]).pulse_rates == [7] and pulsecast.scanner("vz400").pulse_rates != [7]
    assert pulsecast.scanner("own_one", assets=[str(tmp_path)]).pulse_rates == [9]
    with pytest.raises(ValueError, match="no scanner 'one'"):  # of two makers
        pulsecast.scanner("one", assets=[tmp_path])


def test_angles_are_also_in_degrees():
    leg = pulsecast.LegScannerSettings(scan_angle_deg=17.3, head_rate_deg=60, pulse_rate=5)
    assert leg.scan_angle == 17.3 * (math.pi / 180) and leg.scan_angle_deg == 17.3 and leg.head_rate_deg == 60 and leg.pulse_rate == 5
    assert leg == copy.deepcopy(leg) == pickle.loads(pickle.dumps(leg)) != pulsecast.LegScannerSettings(scan_angle_deg=17.4)
    leg.head_stop_deg = 90
    assert leg.head_stop == math.pi / 2 and leg.vertical_angle_min_deg is None
    leg.scan_angle_deg = None
    assert leg.scan_angle is None
    assert pulsecast.AxisTurn(axis="x", angle_deg=-90).angle == -math.pi / 2
    assert "[deg]" in pulsecast.AxisTurn.angle_deg.__doc__
    for deg in np.linspace(-720, 720, 1441) / 8:
        assert pulsecast.AxisTurn(angle_deg=deg).angle_deg == deg


def test_degrees_are_those_of_documents(tmp_path):
    folder = Path(__file__).parent.parent / "pulsecast"
    survey = pulsecast.read_survey(folder / "survey.xml", assets=[folder])
    for angle in (0.1, 17.3, 33.333, 45, 59.9):
        survey.legs[0].scanner.scan_angle_deg = angle
        assert f'scanAngle_deg="{angle}"' in pulsecast.xml_text(survey)
        pulsecast.write_survey(tmp_path / "survey.xml", survey)
        read = pulsecast.read_survey(tmp_path / "survey.xml").legs[0].scanner
        assert read.scan_angle == survey.legs[0].scanner.scan_angle and read.scan_angle_deg == angle


@pytest.mark.parametrize(("asked", "says"), [
    ({"scan_angle": 1, "scan_angle_deg": 1}, "LegScannerSettings: expected one of scan_angle and scan_angle_deg, not both"),
    ({"scan_angle_deg": "wide"}, "LegScannerSettings.scan_angle_deg: expected an angle in degrees, not 'wide'"),
    ({"head_stop_deg": True}, "LegScannerSettings.head_stop_deg: expected an angle in degrees, not True"),
    ({"pulse_rate_deg": 3}, "pulse_rate_deg"),
])
def test_degrees_that_cannot_be_are_refused(asked, says):
    with pytest.raises(TypeError, match=says):
        pulsecast.LegScannerSettings(**asked)


def test_what_is_no_angle_has_no_degrees():
    leg = pulsecast.LegScannerSettings()
    with pytest.raises(AttributeError):
        leg.pulse_rate_deg = 3
    assert not hasattr(pulsecast.NoiseSettings(), "mean_deg") and not hasattr(pulsecast.ErrorFormulas(), "head_deg")


def test_the_example_of_the_page_runs(capsys):
    text = PAGE.read_text(encoding="utf-8")
    section = text[text.index("## A survey from nothing"):text.index("## Module")]
    [block] = re.findall(r"```python\n(.*?)```", section, re.DOTALL)
    space = {}
    exec(block, space)
    assert set(space["points"]["object"]) == {0, 1, 2, 3} and "objects" in capsys.readouterr().out
    assert set(space["points"]["classification"]) == {2, 5}
