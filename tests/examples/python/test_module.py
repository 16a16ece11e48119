# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""The Python module, as its users meet it."""

import copy
import os
import pickle
import resource
import signal
import subprocess
import threading
from pathlib import Path

import numpy as np
import pytest

import own_scanner
import pulsecast

HERE = Path(__file__).parent.parent / "pulsecast"
SQUARE = ([[-50, -50, 0], [50, -50, 0], [50, 50, 0], [-50, 50, 0]], [[0, 1, 2], [0, 2, 3]])


@pytest.fixture
def survey():
    return pulsecast.read_survey(HERE / "survey.xml", assets=[HERE])


def simulation(survey, **settings):
    return pulsecast.Simulation(survey, assets=[HERE], **settings)


def test_the_cloud_is_that_of_the_program(survey, tmp_path):
    subprocess.run([os.environ["PULSECAST_PROGRAM"], HERE / "survey.xml", "--assets", HERE, "--output", tmp_path, "--format", "xyz", "--seed", "3",
                    "--quiet"], check=True)
    rows = np.vstack([np.loadtxt(file) for file in sorted(tmp_path.glob("**/*_points.xyz"))])
    points = simulation(survey, seed=3).run().points
    assert len(points) == len(rows) > 1000
    for column, name in enumerate("xyz"):
        assert np.abs(points[name] - rows[:, column]).max() < 1e-4
    assert (points["object"] == 7).all()


def test_the_cloud_is_that_of_cpp_bit_for_bit(tmp_path):
    survey = pulsecast.read_survey(HERE / "long.xml", assets=[HERE])
    subprocess.run([os.environ["PULSECAST_ROWS"], HERE / "long.xml", "3", "1", tmp_path / "rows", HERE], check=True, stdout=subprocess.DEVNULL)
    rows = np.fromfile(tmp_path / "rows", np.dtype([*{
        "x": "f8", "y": "f8", "z": "f8", "time": "f8", "range": "f8", "intensity": "f4", "cos_incidence": "f4", "pulse": "i8", "object": "u4",
        "return_number": "u4"}.items()]))
    points = simulation(survey, seed=3).run(threads=2).points
    assert len(points) == len(rows) > 10_000
    for name in rows.dtype.names:
        assert points[name].astype(rows.dtype[name]).tobytes() == rows[name].tobytes(), name
    assert points["range"].tobytes() != simulation(survey, seed=4).run().points["range"].tobytes()


def test_points_may_come_alone(survey):
    run = simulation(survey, waveforms=True)
    both, points = run.run(), run.run(pulses=False)
    assert points.points.tobytes() == both.points.tobytes() and points.fates == both.fates
    assert len(both.pulses) > 1000 and len(points.pulses) == len(points.waveforms) == 0
    batches = []
    run.run(callback=batches.append, every_pulses=500, pulses=False)
    assert len(batches) > 1 and (np.concatenate([batch.points for batch in batches]) == both.points).all()


def test_threads_do_not_change_a_bit(survey):
    one, two = (simulation(survey, waveforms=True, echo_width=True).run(threads=n) for n in (1, 2))
    assert one.points.tobytes() == two.points.tobytes()
    assert one.pulses.tobytes() == two.pulses.tobytes()
    assert one.waveforms.tobytes() == two.waveforms.tobytes() and len(one.waveforms) > 0
    assert (one.points["echo_width"] > 0).mean() > 0.9


def test_settings_are_plain_objects(survey):
    assert copy.deepcopy(survey) == survey == pickle.loads(pickle.dumps(survey))
    other = copy.deepcopy(survey)
    other.legs.append(copy.deepcopy(other.legs[0]))
    other.legs[-1].platform.position = (1, 2, 3)
    assert other != survey and survey.legs[0].platform.position == (0, 0, 0)
    with pytest.raises(AttributeError):
        survey.legs[0].platform.sped = 3
    assert "[m/s]" in pulsecast.LegPlatformSettings.__doc__


@pytest.mark.parametrize(("spoil", "says"), [
    (lambda s: setattr(s.legs[1].platform, "speed", "fast"), r"SurveySettings\.legs\[1\]\.platform\.speed: expected a number, not 'fast'"),
    (lambda s: setattr(s.platform, "kind", "plane"), "SurveySettings.platform.kind: expected 'stationary' or .*'interpolated', not 'plane'"),
    (lambda s: setattr(s.scanner.channels[0], "optic", 3), "optic: expected OscillatingOptic or .* not 3"),
    (lambda s: setattr(s.legs[0].platform, "position", (1, 2)), "position: expected a list of 3"),
    (lambda s: setattr(s, "seed", -1), "seed: expected a whole number that is not negative"),
    (lambda s: s.legs.__setitem__(0, None), r"legs\[0\]: expected LegSettings, not None"),
])
def test_what_cannot_be_is_refused_by_name(survey, spoil, says):
    spoil(survey)
    with pytest.raises(TypeError, match=says):
        simulation(survey)


def test_a_survey_is_written_and_read_again(survey, tmp_path):
    survey.legs[0].scanner.pulse_rate = 1000
    pulsecast.write_survey(tmp_path / "again.xml", survey)
    assert pulsecast.read_survey(tmp_path / "again.xml", assets=[HERE]) == survey
    assert (tmp_path / "again.xml").read_text() == pulsecast.xml_text(survey)


def test_the_catalogue_is_at_hand():
    [folder] = pulsecast.asset_folders()
    scanners = pulsecast.read_assets(folder / "data" / "scanners_tls.xml")["scanners"]
    assert all(isinstance(scanner, pulsecast.ScannerSettings) for scanner in scanners) and len(scanners) > 3


def test_errors_have_their_fields(survey, tmp_path):
    with pytest.raises(pulsecast.FileError) as error:
        pulsecast.read_survey(tmp_path / "none.xml")
    assert isinstance(error.value, OSError) and error.value.path.endswith("none.xml")
    survey.scanner.channels[0].receiver_diameter = -1
    with pytest.raises(pulsecast.SettingError) as error:
        simulation(survey)
    assert isinstance(error.value, ValueError) and error.value.value == -1 and error.value.unit == "m"


def test_meshes_stand_beside_the_survey_s_own_parts(survey):
    survey.scene.parts = []
    for leg in survey.legs:
        leg.platform.on_ground = False
    assert len(simulation(survey).run().points) == 0
    floor = pulsecast.Mesh(np.array(SQUARE[0], float), np.array(SQUARE[1]), object=9, reflectance=0.25, classification=2, ground=True)
    run = simulation(survey, meshes=[floor])
    points = run.run().points
    assert run.triangles == floor.size == 2 and len(points) > 1000
    assert set(points["object"]) == {9} and set(points["classification"]) == {2}
    steep = points[points["cos_incidence"] > 0.5]
    assert np.abs(steep["z"]).max() < 1e-6
    assert np.abs(steep["reflectance"] / steep["cos_incidence"] - 0.25).max() < 0.01


@pytest.mark.parametrize(("vertices", "triangles", "field"), [
    ([[0, 0]], [[0, 0, 0]], "vertices"), (SQUARE[0], [[0, 1]], "triangles"), (SQUARE[0], [[0, 1, 4]], "triangles"),
    (SQUARE[0], [[0, 1, -1]], "triangles"), ([[0, 0, np.nan]], [[0, 0, 0]], "vertices"), (SQUARE[0], np.zeros((0, 3), int), "triangles"),
])
def test_a_mesh_that_cannot_be_is_refused(vertices, triangles, field):
    with pytest.raises(pulsecast.SettingError) as error:
        pulsecast.Mesh(vertices, triangles)
    assert field in error.value.field


def test_trajectories_and_legs(survey):
    run = simulation(survey)
    poses, legs = run.trajectory(0.25), run.legs
    assert list(legs["number"]) == [0, 1, 2] and legs["end"][-1] == len(run)
    assert (np.diff(poses["time"]) >= 0).all()
    assert [tuple(poses[poses["leg"] == k][0])[1:3] for k in range(3)] == [(0, 0), (5, 0), (5, 5)]
    with pytest.raises(pulsecast.SettingError):
        run.trajectory(0)


def test_memory_is_given_back(survey):
    def peak():
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    for _ in range(2):
        simulation(survey).run()
    before = peak()
    for _ in range(50):
        simulation(survey).run()
    assert peak() - before < 2048  # KiB


def test_a_scanner_of_one_s_own():
    survey = own_scanner.RosetteSurvey(20_000)
    points = survey.run().points
    assert len(points) == len(survey) == 20_000
    assert np.abs(points["z"] + 10).max() < 1e-6
    assert np.hypot(points["x"], points["y"]).max() < 10 * np.tan(0.4) * 1.01
    with pytest.raises(pulsecast.SettingError):  # of the other module: they are the same
        own_scanner.RosetteSurvey(10, bend=float("nan")).run(stride=0)


def test_ctrl_c_stops_and_leaves_what_is_whole():
    survey = own_scanner.RosetteSurvey(2_000_000_000)
    threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(pulsecast.Interrupted) as stopped:
        survey.run()
    pulses = stopped.value.result.pulses
    assert 0 < len(pulses) == stopped.value.result.slots
    assert (pulses["pulse"] == np.arange(len(pulses))).all()
