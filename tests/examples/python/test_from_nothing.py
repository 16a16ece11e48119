# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Surveys from nothing, without a document: scenes of arrays, instruments by name, flights, trajectories and errors."""

import copy
import math
import os
import pickle
import re
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

import pulsecast

PAGE = Path(__file__).parents[3] / "docs" / "python.md"
SQUARE = np.array([[-200, -200, 0], [200, -200, 0], [200, 200, 0], [-200, 200, 0]], float), np.array([[0, 1, 2], [0, 2, 3]])
DOWN = [[0.0, 0.0, -1.0]]


def instrument():
    """A line scanner without noise."""
    channel = pulsecast.ChannelSettings(optic=pulsecast.OscillatingOptic(), scan_angle_max_deg=40, scan_rate_max=100)
    channel.waveform.rings = 1
    return pulsecast.ScannerSettings(id="line", pulse_rates=[1000], channels=[channel])


def flight(*places, speed=50.0, **platform):
    """A line scanner that looks down from a platform on straight lines."""
    mount = pulsecast.platform("satellite").mount
    scan = pulsecast.LegScannerSettings(scan_rate=10, scan_angle_deg=20)
    legs = [pulsecast.LegSettings(platform=pulsecast.LegPlatformSettings(position=at, speed=speed), scanner=scan) for at in places]
    return pulsecast.SurveySettings(name="line", scanner=instrument(), legs=legs,
                                    platform=pulsecast.PlatformSettings(**{"id": "straight", "kind": "linear_path", "mount": mount} | platform))


def points_of(survey, *meshes, **settings):
    floor = pulsecast.Mesh(*SQUARE, object=1_000_000, ground=True)
    return pulsecast.Simulation(survey, meshes=meshes or [floor], **settings).run(pulses=False).points


def positions(points):
    return np.column_stack([points[name] for name in "xyz"])


# ---------------------------------------------------------------------------------------------------------- placements

def tree(triangles):
    """A crown of steep triangles about the axis, 1 m wide and from 1 to 3 m high, with a level one at 2 m in its middle."""
    turn = np.linspace(0, 2 * np.pi, triangles, endpoint=False)
    crown = [[[0.2 * np.cos(a), 0.2 * np.sin(a), 1], [0.5 * np.cos(a), 0.5 * np.sin(a), 1], [0.5 * np.cos(a), 0.5 * np.sin(a), 3]] for a in turn]
    vertices = np.array([[[-0.1, -0.1, 2], [0.2, -0.1, 2], [-0.1, 0.2, 2]], *crown]).reshape(-1, 3)
    return vertices, np.arange(len(vertices)).reshape(-1, 3)


def test_ten_thousand_trees_are_one_in_memory_and_each_has_its_number_and_place():
    grid = np.indices((100, 100)).reshape(2, -1).T * 2.0
    places = np.column_stack([grid, 0.01 * np.arange(10_000)])
    vertices, triangles = tree(300)
    one = pulsecast.RaycastingScene([pulsecast.Mesh(vertices, triangles)])
    wood = pulsecast.RaycastingScene([pulsecast.Mesh(vertices, triangles, object=7, placements=places)])
    hits = wood.closest_hits(places + [0, 0, 50], np.repeat(DOWN, 10_000, axis=0))
    assert (hits["object"] == 7 + np.arange(10_000)).all()
    assert np.abs(hits["range"] - 48).max() < 1e-9
    copies = 10_000 * one.memory
    assert one.memory > 20_000 and wood.memory < copies / 20


def test_a_survey_of_placements_tells_them_apart():
    grid = np.indices((20, 20)).reshape(2, -1).T * 2.0 - 19.0
    places = np.column_stack([grid, np.zeros(400)])
    numbers = 5 * np.arange(400) + 3
    vertices, triangles = tree(40)
    wood = pulsecast.Mesh(vertices, triangles, object=numbers, placements=places, classification=5)
    survey = flight((0, -20, 60), (0, 20, 60), speed=4)
    points = points_of(survey, wood)
    nearest = np.rint((np.column_stack([points["x"], points["y"]]) + 19) / 2).astype(int)
    assert len(set(points["object"])) > 100
    assert (points["object"] == numbers[20 * nearest[:, 0] + nearest[:, 1]]).all()
    run = pulsecast.Simulation(survey, meshes=[wood])
    alone = pulsecast.Simulation(survey, meshes=[pulsecast.Mesh(vertices, triangles)])
    assert run.triangles == 400 * alone.triangles == 400 * len(triangles)
    assert run.memory < 400 * alone.memory / 5


def test_placements_turn_and_scale():
    turn = np.eye(4)
    turn[:3, :3] = 2 * np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])  # to the left, twice as large
    turn[:3, 3] = (10, 20, 30)
    scene = pulsecast.RaycastingScene([pulsecast.Mesh([[1, 0, 1], [3, 0, 1], [2, 1, 1]], [[0, 1, 2]], placements=[turn])])
    x, y = np.array([2, 0.5]) @ np.array([[0, 2], [-2, 0]])
    [hit] = scene.closest_hits([[10 + x, 20 + y, 100]], DOWN)
    assert abs(hit["range"] - (100 - 32)) < 1e-9
    assert np.isinf(scene.closest_hits([[12, 20.5, 100]], DOWN)["range"][0])


# ------------------------------------------------------------------------------------------------- classes, holes, laws

def test_classes_and_reflectances_are_by_triangle():
    mesh = pulsecast.Mesh(*SQUARE, classification=[2, 9], reflectance=[0.25, 0.75])
    hits = pulsecast.RaycastingScene([mesh]).closest_hits([[100, 50, 5], [50, 100, 5]], DOWN * 2)
    assert list(hits["classification"]) == [2, 9]
    points = points_of(flight((0, -20, 60), (0, 20, 60)), mesh)
    below = points["x"] > points["y"] + 0.1
    assert (points["classification"][below] == 2).all() and 100 < below.sum() < len(points) - 100
    for of, reflectance in ((below, 0.25), (points["x"] < points["y"] - 0.1, 0.75)):
        assert np.abs(points["reflectance"][of] / points["cos_incidence"][of] - reflectance).max() < 0.01


def test_a_picture_cuts_holes():
    corners = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
    leaf = np.array([[[80, 255], [80, 100]]], np.uint8)  # grey and opacity, from west to east
    rays = [[-100, 30, 5], [100, 30, 5]], DOWN * 2
    for cutoff, solid in ((0.5, [True, False]), (0.3, [True, True])):
        mesh = pulsecast.Mesh(*SQUARE, texture=corners, picture=leaf, cutoff=cutoff)
        assert list(np.isfinite(pulsecast.RaycastingScene([mesh]).closest_hits(*rays)["range"])) == solid
    points = points_of(flight((0, -20, 60), (0, 20, 60)), pulsecast.Mesh(*SQUARE, texture=corners, picture=leaf, cutoff=0.5))
    assert len(points) > 100 and points["x"].max() < 1e-6


def test_laws_of_scattered_light_have_names():
    for law, backscatter in (
            (pulsecast.Lambert(), lambda cosine: cosine), (pulsecast.DirectionIndependent(), np.ones_like),
            (pulsecast.Phong(share=0.5, exponent=4), lambda cosine: 0.5 * cosine + 0.5 * (2 * cosine**2 - 1)**4),
            (pulsecast.Tabulated(rows=[pulsecast.BackscatterAtIncidence(0, 1), pulsecast.BackscatterAtIncidence(incidence_deg=90)]),
             lambda cosine: 1 - np.arccos(np.minimum(cosine, 1)) / (np.pi / 2))):
        points = points_of(flight((0, -20, 60), (0, 20, 60)), pulsecast.Mesh(*SQUARE, reflectance=0.4, law=law))
        assert np.abs(points["reflectance"] - 0.4 * backscatter(points["cos_incidence"].astype(float))).max() < 0.005, law


def test_a_mesh_moves_along_its_poses():
    stands = pulsecast.SurveySettings(scanner=instrument(), legs=[pulsecast.LegSettings(duration_max=2.0)], platform=flight((0, 0, 0)).platform)
    stands.platform.kind = "stationary"
    stands.legs[0].platform.position = (0, 0, 60)
    stands.legs[0].scanner = pulsecast.LegScannerSettings(scan_rate=10, scan_angle_deg=20)
    lift = pulsecast.Mesh(*SQUARE, motion=[[0, 0, 0, 0], [1, 0, 0, 3]])
    points = points_of(stands, lift)
    assert np.abs(points["z"] - 3 * np.minimum(points["time"], 1)).max() < 1e-4
    tilted = pulsecast.Mesh(*SQUARE, motion=[[0, 0, 0, 0, 0, 0, 0], [2, 0, 0, 0, 0, math.radians(20), 0]])  # pitch: north goes up
    points = points_of(stands, tilted)
    assert np.abs(points["z"] - points["y"] * np.tan(np.radians(10) * points["time"])).max() < 1e-3
    with pytest.raises(pulsecast.SettingError, match="motion|move"):
        pulsecast.RaycastingScene([lift])


# ------------------------------------------------------------------------------------------------- catalogue and degrees

def test_instruments_of_the_catalogue_have_names():
    assert pulsecast.scanner("vz400") == pulsecast.scanner("riegl_vz400") and pulsecast.scanner("vz400").name == "RIEGL VZ-400"
    assert pulsecast.platform("tripod").kind == "stationary"
    known = pulsecast.catalogue()
    assert {one.id for one in known["scanners"]} > {"riegl_vz400", "vlp16", "gedi"} and len(known["platforms"]) > 10
    for name in ("VZ-400", "VZ400", "vz_400", "RIEGL VZ-400", "Riegl_VZ400"):
        assert pulsecast.scanner(name).id == "riegl_vz400", name
    assert pulsecast.scanner("VUX-1UAV") == pulsecast.scanner("vux-1uav") and pulsecast.platform("Tripod").id == "tripod"
    for name, near in (("vz40O", "riegl_vz400"), ("vux-1", "vux-1uav")):
        with pytest.raises(ValueError, match=f"^the catalogue has no scanner '{name}'; did you mean .*{near}'.*\\?$"):
            pulsecast.scanner(name)
    with pytest.raises(ValueError, match="^the catalogue has no scanner 'riegl_vz40'; did you mean 'riegl_vz400' or 'riegl_vz400i'\\?$"):
        pulsecast.scanner("riegl_vz40")
    with pytest.raises(ValueError, match=r"no platform 'xyz'; catalogue\(\) has all$"):
        pulsecast.platform("xyz")


def test_documents_of_one_s_own_come_before_the_catalogue(tmp_path):
    (tmp_path / "data").mkdir()
    for name, rate in (("riegl_vz400", 7), ("own_one", 9), ("other_one", 9)):
        text = f'<document><scanner id="{name}" name="of one\'s own" optics="conic" pulseFreqs_Hz="{rate}"/></document>'
        (tmp_path / "data" / f"scanners_{name}.xml").write_text(text)
    assert pulsecast.scanner("vz400", assets=[tmp_path]).pulse_rates == [7] and pulsecast.scanner("vz400").pulse_rates != [7]
    assert pulsecast.scanner("own_one", assets=[str(tmp_path)]).pulse_rates == [9]
    for name in ("one", "ONE"):
        with pytest.raises(ValueError, match=rf"no scanner '{name}'; did you mean '(own|other)_one' or '(own|other)_one'\?"):  # of two makers
            pulsecast.scanner(name, assets=[tmp_path])


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


def written(survey, scanner):
    """The survey with what a document has besides, and settings of its first leg."""
    survey.scene = pulsecast.SceneSettings(id="scene", parts=[pulsecast.PartSettings(id="0", source=pulsecast.ObjSource(files=["floor.obj"]))])
    survey.legs[0].scanner = scanner
    return survey


# -------------------------------------------------------------------------------------------------------------- flights

def test_a_block_flight_covers_its_area_with_its_overlap():
    block = pulsecast.BlockFlight(area=((0, 0, 0), (200, 300, 0)), altitude=90, swath=60, overlap=0.25, speed=30, run_in=5)
    legs = pulsecast.plan_block_flight(block, pulsecast.LegScannerSettings(scan_rate=20))
    lines, turns = legs[::2], legs[1::2]
    starts, ends = (np.array([leg.platform.position for leg in some]) for some in (lines, turns))
    assert len(lines) == len(turns) == 1 + math.ceil((200 - 60) / (60 * 0.75))
    assert all(leg.scanner.active and leg.platform.speed == 30 and leg.scanner.scan_rate == 20 for leg in lines)
    assert not any(leg.scanner.active for leg in turns)
    assert np.abs(np.diff(starts[:, 0]) - 45).max() < 1e-9 and (starts[:, 2] == 90).all()
    assert starts[0, 0] - 30 <= 0 and starts[-1, 0] + 30 >= 200 and abs(starts[:, 0].mean() - 100) < 1e-9
    assert (starts[::2, 1] == -5).all() and (starts[1::2, 1] == 305).all() and (ends[::2, 1] == 305).all()
    survey = flight((0, 0, 0))
    survey.legs = pulsecast.plan_block_flight(
        pulsecast.BlockFlight(area=((-40, -30, 0), (40, 30, 0)), altitude=60, swath=2 * 60 * math.tan(math.radians(20)), speed=30),
        survey.legs[0].scanner)
    points = points_of(survey)
    counts, _, _ = np.histogram2d(points["x"], points["y"], bins=[np.arange(-40, 41, 10), np.arange(-30, 31, 10)])
    assert counts.min() > 20
    with pytest.raises(pulsecast.SettingError, match="BlockFlight::overlap is 1,"):
        pulsecast.plan_block_flight(pulsecast.BlockFlight(area=((0, 0, 0), (9, 9, 0)), overlap=1))
    with pytest.raises(TypeError, match="expected BlockFlight, not 3"):
        pulsecast.plan_block_flight(3)


def test_a_run_without_points_says_why_at_the_line_of_its_caller(tmp_path):
    below = flight((0, 0, -80), (0, 50, -80), (0, 100, -80))
    run = pulsecast.Simulation(below, meshes=[pulsecast.Mesh(*SQUARE)])
    middle = int(run.legs[1]["first"])
    why = r"no points: leg {} begins at \(0.0, {}.0, -80.0\) m, and the scene extends from \(-200.0, -200.0, 0.0\) to \(200.0, 200.0, 0.0\) m"
    for number, asked in ((0, {}), (0, {"callback": print}), (0, {"output": tmp_path / "no.xyz"}), (0, {"end": middle}), (1, {"first": middle})):
        with pytest.warns(UserWarning, match=why.format(number, 50 * number)) as told:
            run.run(**asked)
        assert len(told) == 1 and told[0].filename == __file__
    with pytest.warns(UserWarning, match="no points: the scene is empty"):
        pulsecast.Simulation(below).run()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for asked in ({"first": 1}, {"end": middle - 1}, {"stride": 2}):  # of a part, which may be empty on purpose
            run.run(**asked)
        with pytest.raises(UserWarning, match="no points"):
            run.run()


# --------------------------------------------------------------------------------------------------------- trajectories

def driven(poses, *windows, **trajectory):
    survey = flight(*[(0, 0, 0)] * max(1, len(windows)), kind="interpolated")
    for leg, (start, end) in zip(survey.legs, windows or [(None, None)]):
        leg.platform.trajectory = pulsecast.TrajectorySettings(file="drive", start=start, end=end, **trajectory)
    return pulsecast.Simulation(survey, meshes=[pulsecast.Mesh(*SQUARE)], trajectories={"drive": poses})


def test_a_platform_follows_arrays():
    times = np.array([10, 10.5, 12, 13.0])
    poses = np.column_stack([times, [0, 1, 5, 5], [0, 0, 3, 9], [60, 61, 62, 60], np.zeros(4), [0, 0.1, 0.2, 0.2], [0, 0.5, 1.0, 1.5]])
    path = driven(poses).trajectory(0.25)
    assert len(path) == 13 and path["time"][-1] == 3
    for column, name in enumerate(("x", "y", "z"), 1):
        assert np.abs(path[name] - np.interp(path["time"] + 10, times, poses[:, column])).max() < 1e-9, name
    at_poses = np.isin(path["time"] + 10, times)
    assert np.abs(path["pitch"][at_poses] - poses[:, 5]).max() < 1e-9 and np.abs(path["yaw"][at_poses] - poses[:, 6]).max() < 1e-9
    again = driven(path).trajectory(0.25)
    for name in ("time", "x", "y", "z", "roll", "pitch", "yaw"):
        assert np.abs(again[name] - path[name]).max() < 1e-9, name


def test_legs_follow_their_parts_of_a_trajectory():
    poses = np.column_stack([np.arange(5.0), 10.0 * np.arange(5), np.zeros(5), np.full(5, 60.0)])
    path = driven(poses, (0.5, 1.5), (2, None)).trajectory(0.5)
    assert list(path["leg"]) == [0, 0, 0, 1, 1, 1, 1, 1]
    assert np.abs(path["x"] - [5, 10, 15, 20, 25, 30, 35, 40]).max() < 1e-9
    assert np.abs(path["yaw"] - np.pi / 2).max() < 1e-9  # heads east, along its path
    with pytest.raises(pulsecast.SettingError, match="^leg 0: tStart to tEnd is from 5 s to 6 s, but must be within the poses, from 0 s to 4 s$"):
        driven(poses, (5, 6))
    with pytest.warns(UserWarning, match="^drive: the window ends after the last pose, at 4 s$"):
        driven(poses, (1, 40))
    with pytest.warns(UserWarning, match="^drive: the window begins before the first pose, at 0 s$"):
        driven(poses, (-1, 2))


def test_attitudes_may_be_quaternions():
    half = 0.35
    east = driven([[0, 0, 0, 60, 0, 0, -math.sin(half), math.cos(half)], [1, 0, 9, 60, 0, 0, -math.sin(half), math.cos(half)]])
    assert np.abs(east.trajectory(0.5)["yaw"] - 2 * half).max() < 1e-9


def test_angles_in_degrees_are_asked_about():
    level = np.column_stack([np.arange(5.0), np.zeros(5), 10 * np.arange(5.0), np.full(5, 60.0), np.zeros((5, 3))])
    for column, angles, says in ((6, 90.0, "yaw of row 0 is 90 rad"), (6, [-3, 3, -3, 3, 183], "yaw of row 4 is 183 rad"),
                                 (5, 3.0, "pitch of row 0 is 3 rad"), (4, [0, 1, 2, 3, 8.5], "roll of row 4 is 8.5 rad")):
        poses = level.copy()
        poses[:, column] = angles
        with pytest.warns(UserWarning, match=re.escape(f"trajectories['drive']: {says}: given in degrees, not radians?")):
            driven(poses)
        if column != 5:
            continue
        pulsecast.Mesh(*SQUARE, motion=poses)  # may turn over
    with pytest.warns(UserWarning, match="Mesh::motion: yaw of row 1 is 90 rad: given in degrees"):
        pulsecast.Mesh(*SQUARE, motion=[[0] * 7, [1, 0, 0, 0, 0, 0, 90]])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for column, angles in ((6, np.linspace(0, 20, 5)), (6, [3, -3, 3, 6.2, 0]), (5, [6.28, 0, -1.5, 0, 1.5]), (4, [3, -3, 3, 3.3, 6.28])):
            poses = level.copy()
            poses[:, column] = angles
            driven(poses)  # turns on and on; within a turn either way


def test_angles_of_settings_in_degrees_are_asked_about():
    def told(**platform):
        survey = flight(*LINE, **platform)
        with warnings.catch_warnings(record=True) as notes:
            warnings.simplefilter("always")
            pulsecast.Simulation(survey, meshes=[pulsecast.Mesh(*SQUARE)])
        return [str(note.message) for note in notes]

    down = pulsecast.platform("satellite").mount
    turned = copy.deepcopy(down)
    turned.rotation.turns.append(pulsecast.AxisTurn(axis="x", angle=90))
    assert told(mount=turned) == ["rot 2: angle_deg is 5156.620156, 14.323945 turns: given in degrees, not radians?"]
    assert told(mount_error=pulsecast.MountErrorSettings(pitch=2)) == ["pitch_deg is 114.591559, 0.31831 turns: given in degrees, not radians?"]
    assert len(told(pose_errors=pulsecast.PoseErrorSettings(angular_jitter=1, attitude_drift=(1, 0, 2), boresight_deviation=(0, 3, 0)))) == 4
    for noise in (pulsecast.NoiseSettings(deviation=2), pulsecast.NoiseSettings(distribution="uniform", low=-2, high=0)):
        [note] = told(attitude_noise=[None, noise, None])
        assert note.startswith("attitudeYNoise is 114.59"), note
    turned.rotation.turns[-1].angle_deg = 36000
    assert told(mount=turned, mount_error=pulsecast.MountErrorSettings(pitch=0.4), attitude_noise=[None, pulsecast.NoiseSettings(deviation=0.1), None],
                position_noise=[None, pulsecast.NoiseSettings(deviation=2), None]) == []


@pytest.mark.parametrize(("poses", "says"), [
    (np.zeros((3, 5)), r"trajectories\['drive'\] \(columns\) is 5, but must be 4, 7 or 8"),
    (np.zeros(4), r"trajectories\['drive'\] \(columns\) is 0"),
    ([[1, 0, 0, 0], [0, 0, 0, 0]], "time is 0 s, but must be at least that of the previous waypoint"),
    ([[0, 0, 0, 0, 0, 0, 0, 2]], "rotation"), ([[0, math.nan, 0, 0]], "position"),
])
def test_a_trajectory_that_cannot_be_is_refused(poses, says):
    with pytest.raises(pulsecast.SettingError, match=says):
        driven(poses)


# --------------------------------------------------------------------------------------------------------------- errors

LINE = ((0, -20, 100), (0, 20, 100), (0, -20, 100))


def test_a_boresight_error_moves_points_by_its_closed_form():
    right = flight(*LINE[:2])
    wrong = flight(*LINE[:2], mount_error=pulsecast.MountErrorSettings(pitch=1e-3))
    moved = positions(points_of(wrong)) - positions(points_of(right))
    assert len(moved) > 500
    assert np.abs(moved - [0, 100 * math.sin(1e-3), 100 * (1 - math.cos(1e-3))]).max() < 1e-6
    lever = flight(*LINE[:2], mount_error=pulsecast.MountErrorSettings(position=(0.1, 0.2, -0.3)))
    assert np.abs(positions(points_of(lever)) - positions(points_of(right)) - [0.1, 0.2, -0.3]).max() < 1e-6


def test_errors_of_calibration_are_drawn_once_and_drifts_are_slow():
    truth = positions(points_of(flight(*LINE)))

    def errors(seed=0, **settings):
        return positions(points_of(flight(*LINE, pose_errors=pulsecast.PoseErrorSettings(**settings)), seed=seed)) - truth

    height = errors(lever_arm_deviation=(0, 0, 0.5))
    assert np.ptp(height[:, 2]) < 1e-6 and np.abs(height[:, :2]).max() < 1e-6 and abs(height[0, 2]) > 1e-3
    assert abs(errors(seed=5, lever_arm_deviation=(0, 0, 0.5))[0, 2] - height[0, 2]) > 1e-3
    drift = errors(position_drift=(0, 0, 0.5), drift_time=5)[:, 2]
    half = len(drift) // 2  # two legs of 0.8 s, which draw their own
    assert 0 < np.abs(np.diff(drift[:half])).max() < 0.05 < np.ptp(drift)
    assert abs(drift[half - 1] - drift[half]) > 0.05
    late = errors(latency_deviation=0.01)
    there, back = late[100:700], late[half + 100:half + 700]  # beside the ends, where the platform rests
    assert np.ptp(there[:, 1]) < 1e-6 and abs(there[0, 1]) > 1e-3 and np.abs(back[:, 1] + there[0, 1]).max() < 1e-6
    assert np.abs(late[:, [0, 2]]).max() < 1e-6


def test_errors_are_in_documents_and_can_be_left_out(tmp_path):
    errors = pulsecast.PoseErrorSettings(position_drift=(0.1, 0.2, 0.3), attitude_drift_deg=(0, 0, 0.01), drift_time=30, angular_jitter_deg=0.002,
                                         lever_arm_deviation=(0.01, 0, 0), boresight_deviation_deg=(0.01, 0.02, 0.03), latency_deviation=1e-4)
    survey = flight(*LINE[:2], pose_errors=errors)
    assert (positions(points_of(survey, platform_noise=False)) == positions(points_of(flight(*LINE[:2])))).all()
    pulsecast.write_survey(tmp_path / "survey.xml", written(survey, survey.legs[0].scanner))
    text = (tmp_path / "survey.xml").read_text()
    assert 'attitudeDriftZ_deg="0.01"' in text and 'latency_s="0.0001"' in text
    (tmp_path / "floor.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "survey.xml").write_text(re.sub(r"/[^\"]*/floor.obj", "floor.obj", text))
    assert pulsecast.read_survey(tmp_path / "survey.xml", assets=[tmp_path]).platform.pose_errors == errors
    survey.platform.pose_errors.drift_time = 0
    with pytest.raises(pulsecast.SettingError, match=r"pose_errors\.drift_time \(driftTime_s\) is 0 s"):
        pulsecast.xml_text(survey)


# -------------------------------------------------------------------------------------------------------- what cannot be

@pytest.mark.parametrize(("asked", "says"), [
    ({"classification": [1, 2, 3]}, "Mesh::classification .number. is 3, but must be 1, or one a triangle, 2"),
    ({"classification": 70_000}, "Mesh::classification is 70000"), ({"reflectance": [0.1, 2]}, "Mesh::reflectance is 2"),
    ({"object": [1, 2]}, "Mesh::object .number. is 2, but must be 1, or one a placement, 1"), ({"object": -1}, "Mesh::object is -1"),
    ({"cutoff": 0.5}, "Mesh::picture .channels. is 0, but must be 2 or 4"),
    ({"placements": np.zeros((2, 2))}, "Mesh::placements .dimensions."), ({"placements": np.zeros((0, 3))}, "at least 1"),
    ({"placements": np.zeros((1, 4, 4))}, "placement 0 .*a rotation, one scale for all axes and a translation"),
    ({"placements": [np.diag([1.0, 1.0, -1.0, 1.0])]}, "placement 0"), ({"motion": np.zeros((2, 3))}, "Mesh::motion .columns. is 3"),
    ({"law": pulsecast.Phong(share=2)}, "Phong::share is 2"),
])
def test_a_mesh_that_cannot_be_is_refused(asked, says):
    with pytest.raises(pulsecast.SettingError, match=says):
        pulsecast.Mesh(*SQUARE, **asked)


@pytest.mark.parametrize(("asked", "says"), [
    ({"classification": 1.5}, "Mesh classification: expected whole numbers"), ({"reflectance": "grey"}, "Mesh reflectance: expected numbers"),
    ({"law": "phong"}, "law: expected Lambert or DirectionIndependent or Phong or .*, not 'phong'"),
])
def test_what_is_of_another_type_is_refused(asked, says):
    with pytest.raises(TypeError, match=says):
        pulsecast.Mesh(*SQUARE, **asked)


def test_meshes_are_one_or_several():
    floor, survey = pulsecast.Mesh(*SQUARE), flight(*LINE)
    for meshes in (floor, [floor], (floor,), (mesh for mesh in [floor])):
        assert pulsecast.Simulation(survey, meshes=meshes).triangles == 2
    assert pulsecast.Simulation(survey, meshes=None).triangles == 0
    assert pulsecast.RaycastingScene(floor).with_meshes(floor).memory > 0
    for wrong in (["tree.obj"], "tree.obj", 3, [[floor]]):
        with pytest.raises(TypeError, match="^meshes: expected a Mesh or several, not .*; files are parts of the survey's scene$"):
            pulsecast.Simulation(survey, meshes=wrong)
    with pytest.raises(TypeError, match="^Mesh vertices: expected numbers, not "):
        pulsecast.Mesh([[0, 0, 0], [1, 0]], [[0, 1, 2]])
    with pytest.raises(TypeError, match="^Simulation seed: expected a whole number, not 'x'$"):
        pulsecast.Simulation(survey, seed="x")


def test_settings_are_told_by_what_they_are_not_by_default():
    survey = flight(*LINE)
    assert repr(pulsecast.SurveySettings()) == "SurveySettings()"
    assert repr(pulsecast.LegPlatformSettings(speed=3.5)) == "LegPlatformSettings(speed=3.5)"
    assert eval(repr(survey), vars(pulsecast)) == survey and "SurveySettings(name='line', scanner=ScannerSettings(id='line'" in repr(survey)
    with pytest.raises(TypeError) as refused:
        pulsecast.write_survey(pulsecast.SurveySettings(name="line"), "swapped.xml")
    assert len(str(refused.value)) < 300


def test_what_is_no_obj_file_is_told(tmp_path):
    (tmp_path / "a.gltf").write_text('{"asset": {"version": "2.0"}}')
    survey = flight(*LINE)
    survey.scene.parts = [pulsecast.PartSettings(source=pulsecast.ObjSource(files=[str(tmp_path / "a.gltf")]))]
    with pytest.raises(pulsecast.FileError, match=r"a\.gltf: holds no vertex: expected an OBJ file"):
        pulsecast.Simulation(survey)


@pytest.mark.parametrize("asked", ["--version", "doctor"])
def test_the_program_starts_without_numpy(asked, tmp_path):
    (tmp_path / "numpy.py").write_text("raise ImportError")
    without = {**os.environ, "PYTHONPATH": f"{tmp_path}:{os.environ['PYTHONPATH']}"}
    run = subprocess.run([sys.executable, "-m", "pulsecast", asked], env=without, capture_output=True, text=True)
    assert run.returncode == 0 and pulsecast.__version__ in run.stdout and not run.stderr
    run = subprocess.run([sys.executable, "-c", "import pulsecast"], env=without, capture_output=True, text=True)
    assert run.returncode == 1 and "ImportError: pulsecast needs NumPy" in run.stderr


# ----------------------------------------------------------------------------------------------------------------- page

def test_the_examples_of_the_page_run():
    text = PAGE.read_text()
    section = text[text.index("## A survey from nothing"):text.index("## Module")]
    blocks = re.findall(r"```python\n(.*?)```", section, re.DOTALL)
    assert len(blocks) == 5
    space: dict[str, object] = {}
    for block in blocks:
        exec(block, space)  # each goes on from those before
        if block is blocks[0]:
            assert set(space["points"]["object"]) == {0, 1, 2, 3}  # as it says
    assert len(space["points"]) > 1000
