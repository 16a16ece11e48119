# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""The Python module, as its users meet it."""

import asyncio
import copy
import math
import os
import pickle
import resource
import signal
import subprocess
import threading
from multiprocessing import get_context
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


def test_points_state_their_covariance(survey):
    columns = ["variance_x", "covariance_xy", "systematic_variance_z", "uncertainty_flags", "range"]
    unknown = simulation(survey).run(columns=columns).columns
    assert np.isnan(unknown["variance_x"]).all() and (unknown["uncertainty_flags"] == 255).all()
    stated = simulation(survey, uncertainty=True).run(columns=columns).columns
    assert (stated["range"] == unknown["range"]).all() and (stated["variance_x"] >= 0).all()
    assert (stated["uncertainty_flags"] < 32).all()


def test_settings_are_plain_objects(survey):
    assert copy.deepcopy(survey) == survey == pickle.loads(pickle.dumps(survey))
    other = copy.deepcopy(survey)
    other.legs.append(copy.deepcopy(other.legs[0]))
    other.legs[-1].platform.position = (1, 2, 3)
    assert other != survey and survey.legs[0].platform.position == (0, 0, 0)
    with pytest.raises(AttributeError):
        survey.legs[0].platform.sped = 3
    assert "[m/s]; in documents: m/s, 0 to 1e5" in pulsecast.LegPlatformSettings.__doc__


@pytest.mark.parametrize(("spoil", "says"), [
    (lambda s: setattr(s.legs[1].platform, "speed", "fast"), r"SurveySettings\.legs\[1\]\.platform\.speed: expected a number, not 'fast'"),
    (lambda s: setattr(s.platform, "kind", "plane"), "SurveySettings.platform.kind: expected 'stationary' or .*'interpolated', not 'plane'"),
    (lambda s: setattr(s.scanner.channels[0], "returns_kept", "last"), "returns_kept: expected 'first' or 'strongest', not 'last'"),
    (lambda s: setattr(s.scanner.channels[0], "optic", 3), "optic: expected OscillatingOptic or .* not 3"),
    (lambda s: setattr(s.legs[0].platform, "position", (1, 2)), "position: expected a list of 3"),
    (lambda s: setattr(s.legs[0].platform, "speed", True), "speed: expected a number, not True"),
    (lambda s: setattr(s, "seed", -1), "seed: expected a whole number that is not negative"),
    (lambda s: s.legs.__setitem__(0, None), r"legs\[0\]: expected LegSettings, not None"),
    (lambda s: setattr(s, "name", "\udcff"), r"SurveySettings\.name: expected a text, not"),
])
def test_what_cannot_be_is_refused_by_name(survey, spoil, says):
    spoil(survey)
    with pytest.raises(TypeError, match=says):
        simulation(survey)


def test_what_is_not_a_number_is_refused_by_name(survey):
    survey.legs[1].scanner.scan_rate = math.nan
    with pytest.raises(pulsecast.SettingError, match=r"SurveySettings\.legs\[1\]\.scanner\.scan_rate is nan"):
        simulation(survey)


def test_what_does_not_go_together_is_refused_by_name(survey):
    survey.platform.attitude_noise = [pulsecast.NoiseSettings(clipped=True, clip_low=2), None, None]
    with pytest.raises(pulsecast.SettingError, match=r"SurveySettings\.platform\.attitude_noise\[0\]: clipMax is below clipMin"):
        pulsecast.xml_text(survey)


@pytest.mark.parametrize(("spoil", "says"), [
    (lambda s: setattr(s.legs[1].scanner, "pulse_rate", -5), r"SurveySettings\.legs\[1\]\.scanner\.pulse_rate \(pulseFreq_hz\) is -5 Hz, but must be from 0 to"),
    (lambda s: setattr(s.legs[1].scanner, "scan_rate", -5), r"\.scan_rate \(scanFreq_hz\) is -5 Hz"),
    (lambda s: setattr(s.legs[1].scanner, "trajectory_interval", -1), r"\.trajectory_interval \(trajectoryTimeInterval_s\) is -1 s"),
    (lambda s: setattr(s.legs[2], "duration_max", -1), r"legs\[2\]\.duration_max \(maxDuration_s\) is -1 s"),
    (lambda s: setattr(s.scanner.channels[0], "scan_angle_max", -1), r"scanner\.channels\[0\]\.scan_angle_max \(scanAngleMax_deg\) is -57"),
    (lambda s: setattr(s.scanner.channels[0], "scan_rate_max", -1), r"scan_rate_max \(scanFreqMax_Hz\) is -1 Hz"),
    (lambda s: setattr(s.scanner.channels[0], "returns_max", -1), r"returns_max \(maxNOR\) is -1"),
    (lambda s: setattr(s.scanner.channels[0].waveform, "rings", 0), r"waveform\.rings \(beamSampleQuality\) is 0"),
    (lambda s: setattr(s.scanner.channels[0].waveform, "duration_max", -1e-9), r"duration_max \(maxFullwaveRange_ns\) is -1 ns"),
    (lambda s: setattr(s.platform, "position_noise", [None, pulsecast.NoiseSettings(lifespan=-1), None]), r"position_noise\[1\]\.lifespan \(fixedLifespan\) is -1"),
    (lambda s: setattr(s.scene, "dynamic_step", 0), r"SurveySettings\.scene\.dynamic_step \(dynStep\) is 0"),
    (lambda s: setattr(s.scene, "dynamic_interval", 0), r"dynamic_interval \(dynTimeStep\) is 0 s"),
    (lambda s: setattr(s.scene.parts[0], "dynamic_step", 0), r"scene\.parts\[0\]\.dynamic_step \(dynStep\) is 0"),
    (lambda s: setattr(s.scene.parts[0], "swaps", [pulsecast.SwapSettings(step=-1)]), r"parts\[0\]\.swaps\[0\]\.step \(swapStep\) is -1"),
    (lambda s: setattr(s.scene.parts[0], "motions", [pulsecast.MotionSequenceSettings(loop=-1)]), r"motions\[0\]\.loop \(loop\) is -1"),
    (lambda s: setattr(s.scene.parts[0], "source", pulsecast.XyzSource(estimate_normals=-1)), r"source\.estimate_normals \(estimateNormals\) is -1"),
    (lambda s: setattr(s.scene.parts[0], "source", pulsecast.GeoTiffSource(material=pulsecast.MaterialSource(random=-1))),
     r"source\.material\.random \(randomMaterials\) is -1"),
])
def test_less_than_the_default_of_zero_is_no_setting(survey, spoil, says):
    spoil(survey)
    with pytest.raises(ValueError, match=says):
        simulation(survey)


def test_what_a_simulation_cannot_be_asked_is_refused_by_name(survey):
    with pytest.raises(ValueError, match="repetition is -1"):
        simulation(survey, repetition=-1)
    with pytest.raises(ValueError, match=r"threads is 1e\+06, but must be from 0 to 1024"):
        simulation(survey, threads=1_000_000)
    with pytest.raises(ValueError, match=r"threads is 1e\+06, but must be from 0 to 1024"):
        simulation(survey).run(threads=1_000_000)
    with pytest.raises(ValueError, match="Rosette::bend is nan"):
        own_scanner.RosetteSurvey(bend=math.nan)


def test_numbers_and_truths_of_numpy_are_taken(survey):
    survey.legs[0].scanner.active, survey.legs[1].platform.position = np.bool_(False), np.array([5, 0, 0], "f4")
    survey.seed = np.uint8(5)
    run = simulation(survey)
    assert list(run.legs["active"]) == [False, True, True]
    assert (run.run().points["leg"] > 0).all()


def test_settings_with_arrays_are_compared(survey):
    arrays, lists = copy.deepcopy(survey), copy.deepcopy(survey)
    arrays.legs[1].platform.position = np.array(survey.legs[1].platform.position)
    lists.legs[1].platform.position = list(survey.legs[1].platform.position)
    assert survey == arrays == lists == copy.deepcopy(arrays)
    arrays.legs[1].platform.position[2] += 1
    assert survey != arrays != lists
    assert survey.legs[0] != survey and survey.legs[0] != "leg"


def test_settings_have_the_limits_and_notes_of_a_document(survey, tmp_path):
    survey.legs[0].scanner.pulse_rate, survey.legs[0].scanner.head_rate, survey.legs[0].scanner.head_stop = 123, 30, 360
    with pytest.warns(UserWarning) as notes:
        simulation(survey)
    for says in ("leg 0: pulseFreq_hz of 123 Hz is not one of", "leg 0: headRotatePerSec_deg exceeds the scanner's maximum",
                 "leg 0: headRotateStop_deg is 20626.480625, 57.29578 turns: given in degrees, not radians?"):
        assert any(says in str(note.message) for note in notes), says
    survey.legs[0].scanner.vertical_angle_min, survey.legs[0].scanner.vertical_angle_max = -40, 60
    for refused in (simulation, pulsecast.xml_text, lambda s: pulsecast.write_survey(tmp_path / "no.xml", s)):
        with pytest.raises(pulsecast.SettingError, match=r"vertical_angle_min \(verticalAngleMin_deg\) is -2291\.8.* from -360 to 360: given in degrees"):
            refused(survey)
    assert not (tmp_path / "no.xml").exists()


def test_a_survey_is_written_and_read_again(survey, tmp_path):
    survey.legs[0].scanner.pulse_rate = 1000
    pulsecast.write_survey(tmp_path / "again.xml", survey)
    assert pulsecast.read_survey(tmp_path / "again.xml", assets=[HERE]) == survey
    assert (tmp_path / "again.xml").read_text() == pulsecast.xml_text(survey)


def test_the_catalogue_is_at_hand():
    [folder] = pulsecast.asset_folders()
    scanners = pulsecast.read_assets(folder / "data" / "scanners_tls.xml")["scanners"]
    assert all(isinstance(scanner, pulsecast.ScannerSettings) for scanner in scanners) and len(scanners) > 3
    assert pulsecast.read_survey(HERE.parents[2] / "examples" / "yard" / "yard.xml").scanner.id == "riegl_vz400"


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


def test_meshes_and_parts_have_colours_and_attributes(survey):
    survey.scene.parts[0].attributes = [pulsecast.AttributeSettings(name="age", value=80), pulsecast.AttributeSettings(name="leaf", value=1)]
    wall = np.array([[-50, 3, -50], [50, 3, -50], [50, 3, 50], [-50, 3, 50]], float)
    corners = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
    red_and_blue = np.array([[[255, 0, 0], [0, 0, 255]]], np.uint8)  # from west to east
    mesh = pulsecast.Mesh(wall, SQUARE[1], object=9, reflectance=0.25, texture=corners, picture=red_and_blue, colour=(1, 1, 0.2),
                          attributes={"storeys": 4, "age": 12.5})
    batch = simulation(survey, meshes=[mesh]).run(colours=True)
    columns = batch.columns
    assert list(columns)[-7:] == ["red", "green", "blue", "near_infrared", "age", "leaf", "storeys"]
    of_mesh, west = columns["object"] == 9, columns["x"] < 0
    assert min(of_mesh.sum(), (~of_mesh).sum(), (of_mesh & west).sum(), (of_mesh & ~west).sum()) > 100
    assert (columns["age"] == np.where(of_mesh, 12.5, 80)).all()
    assert (columns["storeys"][of_mesh] == 4).all() and np.isnan(columns["storeys"][~of_mesh]).all()
    assert (columns["leaf"][~of_mesh] == 1).all() and np.isnan(columns["leaf"][of_mesh]).all()
    assert (columns["red"][of_mesh] == np.where(west[of_mesh], 65535, 0)).mean() > 0.99  # footprints on the seam
    assert (columns["blue"][of_mesh] == np.where(west[of_mesh], 0, 13107)).mean() > 0.99
    assert (columns["near_infrared"][of_mesh] == round(0.25 * 65535)).mean() > 0.99


@pytest.mark.parametrize(("asked", "error"), [
    ({"colour": (1, 2, 1)}, ValueError), ({"colour": (1, 1)}, TypeError), ({"picture": np.zeros(4, np.uint8)}, ValueError),
    ({"picture": np.zeros((2, 2, 5), np.uint8)}, ValueError), ({"picture": np.zeros((0, 2, 3), np.uint8)}, ValueError),
    ({"picture": np.zeros((2, 2, 3))}, TypeError), ({"attributes": {"": 1}}, ValueError), ({"attributes": {"age": "old"}}, TypeError),
    ({"attributes": {3: 3}}, TypeError),
])
def test_colours_and_attributes_that_cannot_be_are_refused(asked, error):
    with pytest.raises(error):
        pulsecast.Mesh(*SQUARE, **asked)


def test_hits_have_the_attributes_of_their_objects():
    low = pulsecast.Mesh(*SQUARE, object=3, attributes={"age": 80})
    scene = pulsecast.RaycastingScene([low, pulsecast.Mesh(np.array(SQUARE[0], float) + [200, 0, 0], SQUARE[1], object=4)])
    hits = scene.closest_hits([[0, 0, 5], [200, 0, 5], [500, 0, 5]], [[0, 0, -1]] * 3)
    told = scene.attributes_of(hits["object"])
    assert list(told) == ["age"] and told["age"][0] == 80 and np.isnan(told["age"][1:]).all()


def test_an_attribute_of_the_name_of_a_column_is_refused(survey):
    mesh = pulsecast.Mesh(*SQUARE, object=9, attributes={"intensity": 4})
    with pytest.raises(pulsecast.SettingError, match="^columns: 'intensity' is there twice: expected .* attributes without the name of a column$"):
        simulation(survey, meshes=[mesh]).run()
    with pytest.raises(pulsecast.SettingError, match="^columns: 'range' is there twice"):
        simulation(survey).run(columns=["range", "x", "range"])


def test_points_by_column_are_those_of_the_rows(survey):
    rows, columns = simulation(survey).run().points, simulation(survey).run(columns=True).columns
    assert list(columns) == list(rows.dtype.names)
    for name in rows.dtype.names:
        assert columns[name].tobytes() == rows[name].tobytes(), name


def test_a_mesh_that_passes_light_on_shows_ghosts(survey):
    survey.scene.parts = []
    for leg in survey.legs:
        leg.platform.on_ground = False
    down = np.array(SQUARE[0], float)
    mirror = pulsecast.Mesh(down, SQUARE[1], object=1, reflectance=0, smooth=pulsecast.SmoothInterface.mirror(0.9))
    ceiling = pulsecast.Mesh(down + [0, 0, 4], SQUARE[1], object=2)
    points = simulation(survey, meshes=[mirror, ceiling], light_paths=True).run().points
    ghosts = points[points["z"] < -1]
    assert len(ghosts) > 100 and set(ghosts["object"]) == {2} and set(ghosts["kind"]) == {3}
    assert np.abs(ghosts["z"] + 4).max() < 1e-3
    lake = pulsecast.Mesh(down, SQUARE[1], reflectance=0, smooth=pulsecast.SmoothInterface.water(
        pulsecast.Medium.of_water("1C", 532e-9)))
    bottom = pulsecast.Mesh(down - [0, 0, 1], SQUARE[1], object=3)
    wet = simulation(survey, meshes=[lake, bottom], light_paths=True).run().points
    assert 3 in set(wet["object"]) and wet["z"].min() < -1.05


def test_light_that_cannot_be_is_refused():
    for wrong in ({"index": 0.9}, {"absorption": -1}, {"scattering": 1, "backscatter": 2}):
        with pytest.raises(pulsecast.SettingError):
            pulsecast.Medium(**wrong)
    with pytest.raises(pulsecast.SettingError):
        pulsecast.Medium.of_water("1C", 1550e-9)
    with pytest.raises(ValueError, match="2C"):
        pulsecast.Medium.of_water("2C", 532e-9)
    for wrong in (pulsecast.SmoothInterface.mirror(1.5), pulsecast.SmoothInterface.pane(-1)):
        with pytest.raises(pulsecast.SettingError):
            pulsecast.Mesh(*SQUARE, reflectance=0, smooth=wrong)
    with pytest.raises(pulsecast.SettingError):
        pulsecast.Mesh(*SQUARE, reflectance=0.5, smooth=pulsecast.SmoothInterface.mirror(0.6))


@pytest.mark.parametrize(("vertices", "triangles", "field"), [
    ([[0, 0]], [[0, 0, 0]], "vertices"), (SQUARE[0], [[0, 1]], "triangles"), (SQUARE[0], [[0, 1, 4]], "triangles"),
    (SQUARE[0], [[0, 1, -1]], "triangles"), (np.zeros(9), [[0, 1, 2]], "vertices (dimensions)"),
    ([[0, 0, np.nan]], [[0, 0, 0]], "vertices"), (SQUARE[0], np.zeros((0, 3), int), "triangles"),
])
def test_a_mesh_that_cannot_be_is_refused(vertices, triangles, field):
    with pytest.raises(pulsecast.SettingError) as error:
        pulsecast.Mesh(vertices, triangles)
    assert field in error.value.field


@pytest.mark.parametrize(("ask", "says"), [
    (lambda: pulsecast.Mesh(*SQUARE, classification=70000), "Mesh::classification is 70000, but must be from 0 to 65535"),
    (lambda: pulsecast.Mesh(*SQUARE, object=-1), "Mesh::object is -1, but must be from 0 to 4294967295"),
    (lambda: own_scanner.RosetteSurvey(10).run(end=2**64), "run end is 18446744073709551616, but must be a whole number from 0 to 1844"),
    (lambda: own_scanner.RosetteSurvey(10).run(every_pulses=-10**400), "run every_pulses is "),
    (lambda: pulsecast.RaycastingScene([pulsecast.Mesh(*SQUARE)]).occluded(np.zeros((1, 6)), seed=-3), "^seed is -3"),
    (lambda: pulsecast.RaycastingScene([pulsecast.Mesh(*SQUARE)], threads=2**40), "^RaycastingScene threads is 1099511627776"),
    (lambda: pulsecast.Simulation(pulsecast.SurveySettings(), seed=-1), "^Simulation seed is -1"),
    (lambda: pulsecast.Simulation(pulsecast.SurveySettings(), threads=-1), "^Simulation threads is -1"),
])
def test_whole_numbers_out_of_range_are_refused_in_a_sentence(ask, says):
    with pytest.raises(pulsecast.SettingError, match=says) as refused:
        ask()
    assert "\n" not in str(refused.value)


def test_the_corners_of_triangles_are_whole_numbers():
    with pytest.raises(TypeError, match="whole numbers, not float64"):
        pulsecast.Mesh(SQUARE[0], [[0, 1.7, 2]])
    with pytest.raises(TypeError, match="Mesh triangles: expected"):
        pulsecast.Mesh(SQUARE[0], [[0, 1, 2], [3]])
    for kind in ("u1", "i4", ">i8"):
        assert pulsecast.Mesh(np.asfortranarray(SQUARE[0], dtype="f4"), np.array(SQUARE[1] * 2, kind)[::2]).size == 2


def test_a_mesh_is_asked_by_rays():
    floor = pulsecast.Mesh(*SQUARE, object=9, classification=2, texture=[[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]])
    roof = pulsecast.Mesh(np.array(SQUARE[0]) / 10 + [0, 0, 3], SQUARE[1])
    scene = pulsecast.RaycastingScene([floor, roof])
    assert repr(scene) == "<RaycastingScene of 2 meshes>" and scene.memory > 0
    origins, directions = [[2, 1, 10], [20, -10, 10], [0, 0, 10], [0, 0, 10]], [[0, 0, -2], [0, 0, -1], [0, 0, 1], [0, 0, np.nan]]
    hits = scene.closest_hits(origins, directions)
    assert list(hits["range"]) == [7, 10, np.inf, np.inf]
    assert list(hits["part"]) == [1, 0, -1, -1] and list(hits["primitive"]) == [0, 0, -1, -1] and list(hits["ray"]) == [0, 1, 2, 3]
    assert list(hits["object"]) == [0, 9, 0, 0] and list(hits["classification"]) == [0, 2, 0, 0] and list(hits["front"]) == [1, 1, 0, 0]
    assert (hits["normal"] == [[0, 0, 1], [0, 0, 1], [0, 0, 0], [0, 0, 0]]).all() and (hits["velocity"] == 0).all()
    assert np.allclose(hits["texture"][1], [0.7, 0.4]) and np.isnan(hits["texture"][[0, 2, 3]]).all()
    assert np.allclose(hits["weights"][1] @ np.array(SQUARE[0])[SQUARE[1][0]], [20, -10, 0]) and np.isnan(hits["weights"][2:]).all()
    assert scene.closest_hits(np.hstack([origins, directions])).tobytes() == hits.tobytes()
    assert list(scene.occluded(origins, directions)) == [True, True, False, False]
    assert list(scene.occluded(origins, directions, far=8)) == [True, False, False, False]
    every = scene.all_hits(origins, directions)
    assert list(every["ray"]) == [0, 0, 1] and list(every["range"]) == [7, 10, 10] and list(every["part"]) == [1, 0, 0]
    assert list(scene.all_hits(origins, directions, near=7)["range"]) == [10, 10]


def test_rays_are_answered_alike_by_any_number_of_threads():
    random = np.random.default_rng(1)
    scene = pulsecast.RaycastingScene([pulsecast.Mesh(random.normal(size=(300, 3)), np.arange(300).reshape(100, 3))])
    rays = random.normal(size=(50_000, 6))
    one, two = (scene.closest_hits(rays, threads=n) for n in (1, 2))
    assert one.tobytes() == two.tobytes() and 1000 < np.isfinite(one["range"]).sum() < 50_000
    assert (scene.occluded(rays, threads=2) == np.isfinite(one["range"])).all()
    every = scene.all_hits(rays, threads=2)
    assert every.tobytes() == scene.all_hits(rays, threads=1).tobytes() and len(every) > np.isfinite(one["range"]).sum()
    _, first = np.unique(every["ray"], return_index=True)
    assert (every["range"][first] == one["range"][np.isfinite(one["range"])]).all()
    assert len(scene.closest_hits(np.empty((0, 6)))) == len(scene.all_hits(np.empty((0, 6)))) == 0


def test_a_sensor_at_many_poses_measures_ranges():
    scene = pulsecast.RaycastingScene([pulsecast.Mesh(*SQUARE)])
    poses = np.tile(np.eye(4), (3, 1, 1))
    poses[:, 2, 3] = [1, 2, 3]  # height
    poses[2, :3, :3] = [[1, 0, 0], [0, 0, -1], [0, 1, 0]]  # forward is up, up is backward
    ranges = scene.run_batch(poses, np.zeros((2, 3)), [[0, 0, -1], [0, -3, -4]])
    assert ranges.dtype == np.float32 and ranges.shape == (3, 2)
    assert np.allclose(ranges, [[1, 1.25], [2, 2.5], [np.inf, 5]])
    rays = np.random.default_rng(2).normal(size=(5000, 6))
    one, two = (scene.run_batch(poses, rays, threads=n) for n in (1, 2))
    assert one.tobytes() == two.tobytes()
    moved = [np.hstack([rays[:, :3] @ p[:3, :3].T + p[:3, 3], rays[:, 3:] @ p[:3, :3].T]) for p in poses]
    assert np.allclose(one, [scene.closest_hits(r)["range"] for r in moved], rtol=1e-6)
    assert scene.run_batch(poses, np.empty((0, 6))).shape == (3, 0) and scene.run_batch(np.empty((0, 4, 4)), rays).shape == (0, 5000)
    for wrong, field in ((np.eye(4), "poses"), (2 * poses, "poses: pose 0"), (poses * np.diag([1, -1, 1, 1]), "poses: pose 0"),
                         (np.full((1, 4, 4), math.nan), "poses: pose 0")):
        with pytest.raises(pulsecast.SettingError) as error:
            scene.run_batch(wrong, rays)
        assert field in error.value.field


def test_sensors_in_scenes_of_their_own_measure_what_each_does_in_its_scene():
    ground = pulsecast.RaycastingScene([pulsecast.Mesh(*SQUARE)])
    lid = pulsecast.Mesh(np.array(SQUARE[0]) + [0, 0, 10], SQUARE[1])
    covered = ground.with_meshes([lid])
    assert repr(covered) == "<RaycastingScene of 2 meshes>" and repr(ground) == "<RaycastingScene of 1 meshes>"
    poses = np.tile(np.eye(4), (3, 1, 1))
    poses[:, 2, 3] = [1, 2, 3]
    up_and_down = (np.zeros((2, 3)), [[0, 0, 1], [0, 0, -1]])
    of = [0, 1, 0]
    ranges = pulsecast.RaycastingScene.run_batch_in([ground, covered], of, poses, *up_and_down)
    assert ranges.tolist() == [[np.inf, 1], [8, 2], [np.inf, 3]]
    rays = np.random.default_rng(4).normal(size=(3000, 6))
    together = ground.run_batch_in((ground, covered), np.array(of, np.uint8), poses, rays, threads=2)
    assert all((together[p] == (ground, covered)[of[p]].run_batch(poses[p:p + 1], rays)[0]).all() for p in range(3))
    assert ground.run_batch_in([], [], np.empty((0, 4, 4)), rays).shape == (0, 3000)
    for wrong in ([0, 1], [0, 1, 2], [0, -1, 1]):
        with pytest.raises(pulsecast.SettingError) as error:
            ground.run_batch_in([ground, covered], wrong, poses, rays)
        assert "run_batch_in scene_of" in error.value.field
    with pytest.raises(TypeError, match="expected whole numbers"):
        ground.run_batch_in([ground, covered], [0, 0.5, 1], poses, rays)
    with pytest.raises((TypeError, RuntimeError)):
        ground.run_batch_in([ground, lid], of, poses, rays)


def test_a_batch_fills_a_given_array():
    scene = pulsecast.RaycastingScene([pulsecast.Mesh(*SQUARE)])
    poses = np.tile(np.eye(4), (3, 1, 1))
    poses[:, 2, 3] = [1, 2, 3]
    down = (np.zeros((2, 3)), [[0, 0, -1], [0, -3, -4]])
    everything = np.zeros((2, 3, 2), np.float32)
    assert scene.run_batch(poses, *down, out=everything[1]).base is everything
    assert np.allclose(everything, [np.zeros((3, 2)), [[1, 1.25], [2, 2.5], [3, 3.75]]])
    assert scene.run_batch_in([scene], [0] * 3, poses, *down, out=everything[0]).tobytes() == everything[1].tobytes()
    fixed = np.zeros((3, 2), np.float32)
    fixed.flags.writeable = False
    for out, given in ((np.zeros((3, 2)), "not a float64 array of shape (3, 2)"), (np.zeros((2, 3), np.float32), "not a float32 array of shape (2, 3)"),
                       (np.zeros(6, np.float32), "of shape (6,)"), (np.zeros((2, 3), np.float32).T, "not a strided float32 array of shape (3, 2)"),
                       (fixed, "not a read-only float32 array"), (np.zeros((3, 2), ">f4"), "not a >f4 array"), (np.zeros((3, 2), np.int32), "int32")):
        with pytest.raises(ValueError) as error:
            scene.run_batch(poses, *down, out=out)
        assert "run_batch out: expected a writeable C-contiguous array of float32 of shape (3, 2)" in str(error.value) and given in str(error.value)
        assert not out.any()
    with pytest.raises(TypeError, match="not <class 'list'>"):
        scene.run_batch(poses, *down, out=[[0.0] * 2] * 3)


@pytest.mark.parametrize(("asked", "field"), [
    ({"rays": np.zeros((2, 5))}, "rays rays"), ({"rays": np.zeros(6)}, "rays rays"),
    ({"rays": np.zeros((2, 3)), "directions": np.zeros((3, 3))}, "rays directions"),
    ({"rays": np.zeros((2, 6)), "directions": np.zeros((2, 3))}, "rays rays"),
    ({"rays": np.zeros((2, 6)), "near": -1}, "rays near"), ({"rays": np.zeros((2, 6)), "far": math.nan}, "rays far"),
    ({"rays": np.zeros((2, 6)), "time": [1, 2, 3]}, "rays time"), ({"rays": np.zeros((2, 6)), "threads": 1025}, "threads"),
])
def test_rays_that_cannot_be_are_refused(asked, field):
    scene = pulsecast.RaycastingScene([pulsecast.Mesh(*SQUARE)])
    for query in (scene.closest_hits, scene.all_hits, scene.occluded):
        with pytest.raises(pulsecast.SettingError) as error:
            query(**asked)
        assert field in error.value.field
    with pytest.raises(pulsecast.SettingError):
        pulsecast.Mesh(*SQUARE, texture=np.zeros((2, 3)))
    with pytest.raises(pulsecast.SettingError):
        pulsecast.Mesh(*SQUARE, texture=np.zeros((1, 3, 2)))


def test_results_are_copied_and_sent(survey):
    run = simulation(survey, waveforms=True)
    batch = run.run()
    for other in (copy.copy(batch), copy.deepcopy(batch), pickle.loads(pickle.dumps(batch))):
        for name in ("points", "pulses", "waveforms", "sample_interval", "slots", "rays", "seconds", "complete", "fates", "energy"):
            assert np.array_equal(getattr(other, name), getattr(batch, name)), name
        assert np.array_equal(other.waveform_of(60), batch.waveform_of(60))
    with get_context("fork").Pool(2) as pool:
        sent = pool.map(run_of, [(survey, seed) for seed in (1, 2)])
        with pytest.raises(pulsecast.FileError):
            pool.map(read_none, [1])
    assert (sent[0].points == simulation(survey, seed=1).run().points).all() and sent[1].slots == len(run)


def read_none(_):
    pulsecast.read_survey("none.xml")


def run_of(survey_and_seed):
    survey, seed = survey_and_seed
    return simulation(survey, seed=seed).run()


def test_objects_say_what_they_are(survey):
    run = simulation(survey)
    batch = run.run()
    assert repr(run) == "<Simulation of 3 legs, 6000 pulse slots, 2 triangles>"
    assert repr(batch) == f"<Batch of {len(batch.points)} points, 6000 pulses, 0 samples>"
    assert repr(pulsecast.Mesh(*SQUARE, object=7)) == "<Mesh of 2 triangles, object 7>"
    assert pulsecast.__version__.count(".") == 2


@pytest.mark.parametrize(("asked", "error"), [
    ({"callback": 3}, TypeError), ({"progress": "loud"}, TypeError), ({"callback": print, "every_seconds": -1}, ValueError),
    ({"callback": print, "every_seconds": math.nan}, ValueError), ({"stride": 0}, ValueError), ({"threads": -1}, ValueError),
    ({"threads": 1025}, ValueError), ({"threads": 0.5}, TypeError), ({"first": True, "end": "2"}, TypeError),
])
def test_what_a_run_cannot_be_asked_is_refused_before_it_begins(survey, asked, error):
    begun = []
    with pytest.raises(error):
        simulation(survey).run(**({"progress": lambda *_: begun.append(1)} | asked))
    assert not begun


def test_rows_of_waveforms_end(survey):
    batch = simulation(survey, waveforms=True).run()
    for row in (-1, 6000):
        with pytest.raises(IndexError, match=f"row {row} of 6000"):
            batch.waveform_of(row)


def test_trajectories_and_legs(survey):
    run = simulation(survey)
    poses, legs = run.trajectory(0.25), run.legs
    assert list(legs["number"]) == [0, 1, 2] and legs["end"][-1] == len(run)
    pulses = run.run().pulses
    for leg, number in zip(legs, [0, 1, 2], strict=True):  # the last two share a strip
        of_leg = (pulses["pulse"] >= leg["first"]) & (pulses["pulse"] < leg["end"])
        assert of_leg.sum() == 2000 and (pulses["leg"][of_leg] == number).all()
    assert (np.diff(poses["time"]) >= 0).all()
    assert [tuple(poses[poses["leg"] == k][0])[1:3] for k in range(3)] == [(0, 0), (5, 0), (5, 5)]
    for interval in (0, 1e-300, float("nan")):
        with pytest.raises(pulsecast.SettingError):
            run.trajectory(interval)


def test_errors_of_a_run_are_told_apart_by_cause_and_class(survey):
    survey.scanner.channels[0].accuracy = 0.1
    errors = simulation(survey).errors(clusters=200, seed=1, threads=1)
    assert list(errors) == ["sampling", "estimator", "instrument", "together"]
    assert list(errors["together"]["classes"]) == [2]
    value, low, high = errors["instrument"]["all"]["range_68"]
    assert low < value < high and 0.08 < value < 0.12
    assert errors["together"]["all"]["lost"][2] > 0  # a limit, not certainty
    with pytest.raises(pulsecast.SettingError):
        simulation(survey).errors(clusters=1)


def test_settings_that_reach_an_accuracy_are_chosen(survey):
    run = simulation(survey)
    chosen, known = run.choose(range=0.01, echoes=0.02, clusters=200, seed=1, threads=1)
    assert known["reached"] and known["subrays"] >= 2000 and known["slots"] > 0
    assert known["errors"]["range_95"][2] <= 0.01 and known["errors"]["lost"][2] <= 0.02
    assert len(chosen) == len(run) and known["rings"] >= 1 and 0 < known["bin_size"] <= 1e-9
    errors = chosen.errors(clusters=200, seed=9, threads=1)["sampling"]["all"]
    assert errors["range_95"][0] <= 0.01 and errors["lost"][0] <= 0.02
    nearest, known = run.choose(range=1e-12, clusters=50, threads=1)
    assert not known["reached"] and len(nearest) == len(run)
    for limits in ({"range": 0}, {"intensity": -1}, {"echoes": float("nan")}, {"clusters": 1}):
        with pytest.raises(pulsecast.SettingError):
            run.choose(**limits)


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
    assert np.abs(points["z"] + 10).max() < 1e-4  # between two bins of the waveform
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


def test_ctrl_c_ends_queries_of_many_rays_and_samples_of_errors():
    scene = pulsecast.RaycastingScene([pulsecast.Mesh(*SQUARE)])
    poses, rays = np.tile(np.eye(4), (40_000, 1, 1)), np.tile([0, 0, 1, 0, 0, -1.0], (1000, 1))
    ranges = np.full((40_000, 1000), -1, np.float32)
    threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        scene.run_batch(poses, rays, out=ranges)
    assert (ranges == -1).any()
    survey = pulsecast.Simulation(pulsecast.read_survey(HERE / "long.xml", assets=[HERE]), assets=[HERE], seed=3)
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        survey.errors(clusters=1_000_000)  # minutes to the end


def test_ctrl_c_under_asyncio_stops_at_the_second():
    async def scan():
        return own_scanner.RosetteSurvey(2_000_000_000).run(pulses=False)

    for delay in (0.2, 0.6):
        threading.Timer(delay, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        asyncio.run(scan())


def test_a_signal_handler_that_raises_ends_a_run():
    def leave(*_):
        raise SystemExit(5)

    before = signal.signal(signal.SIGTERM, leave)
    try:
        threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGTERM)).start()
        with pytest.raises(SystemExit, match="5"):
            own_scanner.RosetteSurvey(2_000_000_000).run(pulses=False)
    finally:
        signal.signal(signal.SIGTERM, before)


def interrupt(*_):
    signal.raise_signal(signal.SIGINT)


def test_ctrl_c_is_told_even_if_it_comes_too_late_to_stop():
    with pytest.raises(pulsecast.Interrupted) as stopped:
        own_scanner.RosetteSurvey(100).run(progress=interrupt)
    assert stopped.value.result.complete and len(stopped.value.result.points) == 100


@pytest.mark.parametrize("taken", [False, True])
def test_a_handler_of_the_program_s_own_stays(taken):
    heard = []
    before = signal.signal(signal.SIGINT, (lambda *_: heard.append(1)) if taken else signal.SIG_IGN)
    try:
        batch = own_scanner.RosetteSurvey(200_000).run(callback=interrupt, every_pulses=1)
    finally:
        signal.signal(signal.SIGINT, before)
    assert batch.complete and bool(heard) == taken


def test_ctrl_c_on_the_main_thread_stops_no_later_run_of_another():
    survey, counts = own_scanner.RosetteSurvey(100_000), []
    with pytest.raises(pulsecast.Interrupted):
        survey.run(callback=interrupt, every_pulses=1)
    other = threading.Thread(target=lambda: counts.append(len(survey.run().points)))
    other.start()
    other.join()
    assert counts == [100_000]
