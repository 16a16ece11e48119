# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Files that Python writes: those of the survey program, byte for byte, and as others read them."""

import copy
import importlib.util
import json
import os
import re
import signal
import struct
import subprocess
import threading
from pathlib import Path

import numpy as np
import pytest

import pulsecast

HERE = Path(__file__).parent.parent / "pulsecast"
DOCS = Path(__file__).parents[3] / "docs"
PROGRAM = os.environ["PULSECAST_PROGRAM"]
START = {"gps_start_time": "2020-01-01 00:00:00"}
NODE = Path(os.environ.get("PULSECAST_NODE_MODULES") or "/none")
FORMATS = re.search(r"Format of the points: ([^;]*);", " ".join(
    subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout.split()))[1].replace(" or ", ", ").split(", ")
FLOOR = ([[-50, -50, 0.5], [50, -50, 0.5], [50, 50, 0.5], [-50, 50, 0.5]], [[0, 1, 2], [0, 2, 3]])


def simulation(**settings):
    survey = pulsecast.read_survey(HERE / "survey.xml", assets=[HERE])
    return pulsecast.Simulation(survey, **({"assets": [HERE], "seed": 3} | settings))


def of_program(folder, *options):
    """Folder with the files of a run of the program."""
    done = subprocess.run([PROGRAM, HERE / "survey.xml", "--assets", HERE, "--output", folder / "output", "--seed", "3", "--gpsStartTime",
                           START["gps_start_time"], "--noSceneWriting", *options], capture_output=True, text=True, check=True)
    [results] = (folder / "output").glob("*/*")
    return results, done.stderr


def contents(path):
    """Bytes of a file, or of the files of a folder by their names."""
    if path.is_dir():
        return {str(file.relative_to(path)): file.read_bytes() for file in sorted(path.rglob("*")) if file.is_file()}
    return path.read_bytes()


def legs_of(run, first, last):
    return {"first": int(run.legs[first]["first"]), "end": int(run.legs[last]["end"])}


@pytest.mark.parametrize("form", FORMATS)
def test_a_leg_and_a_strip_have_the_bytes_of_the_program(form, tmp_path):
    results, _ = of_program(tmp_path, "--format", form)
    run = simulation()
    for name, legs in (("leg000", (0, 0)), ("strip00a", (1, 2))):
        out = tmp_path / f"{name}.{form}"
        batch = run.run(**legs_of(run, *legs), output=out, **START)
        assert contents(out) == contents(results / f"{name}_points.{form}") and len(contents(out)) > 0
        assert len(batch.points) == len(batch.pulses) == 0 and batch.fates["returned"] > 500
    assert not list(tmp_path.glob("*.part"))


@pytest.mark.parametrize(("form", "words", "options"), [
    ("las", ["--lasScale", "0.01", "--epsg", "25832+7837"], {"las_scale": 0.01, "epsg": "25832+7837"}),
    ("las", ["--las10"], {"las10": True}),
    ("laz", ["--columns", "leg,azimuth", "--colours", "--nearInfrared"], {"columns": ["leg", "azimuth"], "colours": True, "near_infrared": True}),
    ("ply", ["--columns", "normal_z", "--colours"], {"columns": ["normal_z"], "colours": True}),
    ("npz", ["--missesAt", "30"], {"misses_at": 30}),
    ("xyz", ["--columns", "range"], {"columns": ["range"]}),
    ("mcap", ["--scanRate", "4"], {"scan_rate": 4}),
    ("kitti", ["--scanRate", "4", "--kittiClasses", "own"], {"scan_rate": 4, "kitti_classes": "own"}),
])
def test_options_of_the_program_are_keywords(form, words, options, tmp_path):
    results, _ = of_program(tmp_path, "--format", form, *words)
    run = simulation()
    run.run(**legs_of(run, 0, 0), output=tmp_path / "points", format=form, **START, **options)
    assert contents(tmp_path / "points") == contents(results / f"leg000_points.{form}")


def test_page_map_and_picture_have_the_bytes_of_the_program(tmp_path):
    results, _ = of_program(tmp_path, "--page", "--pagePoints", "1000", "--geojson", "--epsg", "25832", "--format", "laz", "--columns", "range")
    subprocess.run([PROGRAM, "preview", HERE / "survey.xml", "--assets", HERE, "--output", tmp_path, "--seed", "3", "--quiet"], check=True)
    run = simulation()
    run.run(output=[tmp_path / "page.html", tmp_path / "all.laz", tmp_path / "picture.png"], page_points=1000, columns=["range"], **START)
    assert contents(tmp_path / "page.html") == contents(results / "page.html")
    assert contents(tmp_path / "picture.png") == contents(tmp_path / "test_preview.png")
    run.run(**legs_of(run, 0, 0), output=tmp_path / "map.geojson", epsg=25832)
    assert contents(tmp_path / "map.geojson") == contents(results / "leg000_map.geojson")


def test_a_batch_is_written_from_memory(tmp_path):
    run = simulation()
    for batch, colours in ((run.run(), True), (run.run(columns=True), False)):
        for form in ("ply", "npz", "html", "geojson", "png", "mcap", "laz"):
            written, streamed = tmp_path / f"written.{form}", tmp_path / f"streamed.{form}"
            of = {"columns": ["azimuth", "scan_angle"], "colours": colours} if form != "png" else {}
            batch.write(written, **of, **START)
            run.run(output=streamed, **of, **START)
            if form not in ("laz", "mcap"):  # of intensities and times with more bits than the arrays have
                assert contents(written) == contents(streamed), form
            else:
                assert abs(len(contents(written)) - len(contents(streamed))) < 100
    classes = batch.columns["classification"]
    classes[:10] = 17
    batch.write(tmp_path / "changed.npz")
    assert (np.load(tmp_path / "changed.npz")["classification"][:10] == 17).all()


def test_a_callback_gets_batches_beside_the_files_and_these_can_be_written(tmp_path):
    run, batches = simulation(), []
    run.run(callback=batches.append, every_pulses=500, output=tmp_path / "all.npz", **START)
    points = np.load(tmp_path / "all.npz")
    assert len(batches) > 1 and (np.concatenate([batch.points["x"] for batch in batches]) == points["x"]).all()
    batches[1].write(tmp_path / "second.npz", **START)
    assert (np.load(tmp_path / "second.npz")["time"] == batches[1].points["time"]).all()


def test_an_interrupted_run_leaves_files_that_are_complete_up_to_there(tmp_path):
    survey = pulsecast.read_survey(HERE / "long.xml", assets=[HERE])
    run = pulsecast.Simulation(survey, assets=[HERE], seed=3)
    with pytest.raises(pulsecast.Interrupted) as stopped:
        run.run(output=[tmp_path / "part.npz", tmp_path / "part.html"], progress=lambda *_: signal.raise_signal(signal.SIGINT), **START)
    result = stopped.value.result
    points = np.load(tmp_path / "part.npz")
    assert len(np.unique(points["pulse"])) == result.fates["returned"] and (tmp_path / "part.html").stat().st_size > 10_000
    assert not list(tmp_path.glob("*.part*"))


def test_scans_without_points_are_there_whatever_else_is_written(tmp_path):
    run, options = simulation(), {"scan_rate": 1000} | START
    run.run(output=tmp_path / "alone.kitti", **options)
    run.run(output=[tmp_path / "beside.kitti", tmp_path / "map.geojson"], **options)
    run.run().write(tmp_path / "written.kitti", **options)
    scans = contents(tmp_path / "alone.kitti")
    assert any(name.endswith(".bin") and not data for name, data in scans.items())
    assert scans == contents(tmp_path / "beside.kitti") and scans.keys() == contents(tmp_path / "written.kitti").keys()


@pytest.mark.parametrize("every_pulses", [100, 0])  # 0: a batch at the end alone
def test_a_run_that_fails_leaves_no_file_and_keeps_the_former_one(every_pulses, tmp_path):
    out = tmp_path / "points.laz"
    out.write_text("former")

    def fail(_):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        simulation().run(output=[out, tmp_path / "page.html"], callback=fail, every_pulses=every_pulses)
    assert os.listdir(tmp_path) == ["points.laz"] and out.read_text() == "former"
    simulation().run(output=out)
    assert out.read_bytes()[:4] == b"LASF"


def test_others_run_while_files_are_written(tmp_path):
    run, counted = simulation(), []
    run.run(output=tmp_path / "a.copc.laz", progress=lambda *_: counted.append(threading.get_ident()))
    assert counted and threading.get_ident() not in counted


@pytest.mark.parametrize(("output", "options", "error", "says"), [
    ("a.foo", {}, ValueError, r"output '.*a\.foo': expected a name that ends in \.xyz, .*\.copc\.laz, .*\.html, \.geojson or \.png, or format="),
    ("a.foo", {"format": "e57"}, ValueError, "format 'e57': expected xyz, .* or ptx"),
    ("a.laz", {"las_scal": 1}, ValueError, r"las_scal is no option of files; did you mean 'las_scale'\?"),
    ("a.laz", {"lasScale": 1}, ValueError, r"^lasScale is no option of files; did you mean 'las_scale'\?$"),
    ("a.laz", {"columns": ["azimuth", "range", "azimuth"]}, ValueError, "'azimuth'.* is there twice"),
    ("a.laz", {"seed": 1}, ValueError, r"seed is no option of files"),
    ("a.laz", {"las_scale": 0}, ValueError, r"las_scale: '0': expected a length from 1e-9 to 1000 m"),
    ("a.kitti", {"columns": ["range"]}, ValueError, r"columns and format kitti: it has no further columns: expected format xyz, "),
    ("a.xyz", {"colours": True}, ValueError, "colours and format xyz: it has no colours"),
    ("a.laz", {"scan_rate": 4}, ValueError, "scan_rate and format laz: it is not in scans: expected format kitti or mcap"),
    ("a.laz", {"columns": ["rang"]}, ValueError, "column 'rang' is not known; did you mean 'range'"),
    ("a.laz", {"columns": ["variance_x"]}, ValueError, r"uncertainty: expected Simulation\(\.\.\., uncertainty=True\)"),
    ("no/folder/a.laz", {}, pulsecast.FileError, r"a\.laz: cannot be created: .*expected an existing, writable folder"),
    (["a.laz", "a.laz"], {}, pulsecast.FileError, r"a\.laz: is already being written"),
    ("", {}, pulsecast.FileError, None), (3, {}, TypeError, "output: expected the name of a file, or a list of names, not 3"),
    (["a.laz", None], {}, TypeError, "output: expected the name of a file"),
    (None, {"las_scale": 0.1}, TypeError, "run: las_scale is an option of files: expected output="),
])
def test_files_that_cannot_be_are_refused_before_the_run(output, options, error, says, tmp_path):
    begun = []
    names = [tmp_path / name if name else name for name in output] if isinstance(output, list) else (
        tmp_path / output if isinstance(output, str) and output else tmp_path if output == "" else output)
    if output == "":
        options = {"format": "laz"}
    with pytest.raises(error, match=says):
        simulation().run(output=names, progress=lambda *_: begun.append(1), **options)
    assert not begun and not os.listdir(tmp_path)


def test_a_folder_with_scans_is_kept(tmp_path):
    (tmp_path / "velodyne").mkdir()
    (tmp_path / "velodyne" / "mine").write_text("mine")
    with pytest.raises(pulsecast.FileError, match="holds files already"):
        simulation().run(output=tmp_path, format="kitti")
    assert (tmp_path / "velodyne" / "mine").read_text() == "mine"


@pytest.mark.parametrize(("batch", "options", "says"), [
    (lambda run: run.run(pulses=False), {}, r"the batch has no pulses.*run\(pulses=True\)"),
    (lambda run: run.run(columns=["x"]), {}, "the batch has no column 'range'"),
    (lambda run: copy.copy(run.run()), {}, "copied or sent has no survey"),
    (lambda run: run.run(), {"columns": ["radial_velocity"]}, "a batch does not hold the column radial_velocity"),
    (lambda run: run.run(), {"uncertainty": True}, "a batch does not hold the uncertainty"),
])
def test_a_batch_that_cannot_be_written_is_refused(batch, options, says, tmp_path):
    with pytest.raises(ValueError, match=says):
        batch(simulation()).write(tmp_path / "a.laz", **options)
    assert not os.listdir(tmp_path)


def test_points_that_were_moved_are_refused(tmp_path):
    batch = simulation().run()
    batch.points["z"][5] += 1
    with pytest.raises(ValueError, match="point 5 has been moved"):
        batch.write(tmp_path / "a.laz")
    assert not os.listdir(tmp_path)


def test_what_a_file_does_not_hold_is_a_warning(tmp_path):
    _, said = of_program(tmp_path, "--format", "kitti")
    mesh = pulsecast.Mesh(*FLOOR, classification=300)
    run = simulation(meshes=[mesh])
    with pytest.warns(UserWarning, match=r"points have a class above 255, .*: columns classification keeps theirs"):
        run.run(output=tmp_path / "a.las")
    with pytest.warns(UserWarning, match=r"points have label 0, as no label is known of their classes \(300\): kitti_classes gives labels"):
        run.run(output=tmp_path / "scans", format="kitti")
    assert "label 0" not in said


@pytest.mark.skipif(not importlib.util.find_spec("osgeo"), reason="python3-gdal")
def test_gdal_reads_the_map(tmp_path):
    from osgeo import ogr

    run = simulation()
    run.run(output=tmp_path / "map.geojson", epsg=25832)
    source = ogr.Open(str(tmp_path / "map.geojson"))
    layer = source.GetLayer()
    kinds = [feature.GetField("kind") for feature in layer]
    assert kinds.count("footprint") >= 3 and kinds.count("trajectory") == 3
    assert layer.GetSpatialRef().GetAuthorityCode(None) == "25832"


@pytest.mark.skipif(not (NODE / "copc").is_dir(), reason="npm install copc")
def test_copc_reads_all_points(tmp_path):
    run = simulation()
    points = run.run().points
    run.run(output=tmp_path / "all.copc.laz")
    script = """
const { Copc } = require('copc');
(async () => {
  const file = process.argv[1], copc = await Copc.create(file);
  const { nodes } = await Copc.loadHierarchyPage(file, copc.info.rootHierarchyPage);
  let count = 0, sum = 0;
  for (const node of Object.values(nodes)) {
    const view = await Copc.loadPointDataView(file, copc, node), x = view.getter('X');
    for (let i = 0; i < view.pointCount; ++i) sum += x(i);
    count += view.pointCount;
  }
  console.log(JSON.stringify([count, sum]));
})();"""
    said = subprocess.run(["node", "-e", script, tmp_path / "all.copc.laz"], env=os.environ | {"NODE_PATH": str(NODE)}, capture_output=True, text=True,
                          check=True).stdout
    count, total = json.loads(said)
    assert count == len(points) and abs(total - points["x"].sum()) < 1e-4 * count


def test_the_twelve_lines_of_the_page_run(tmp_path):
    code = re.search(r"```python\n(# A tree.*?)```", (DOCS / "python.md").read_text(), re.S)[1]
    assert len([line for line in code.splitlines() if line.strip() and not line.startswith("#")]) <= 12
    faces = "".join(f"v {x} {y} {z}\n" for z in (0, 6) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))) + "".join(
        f"f {1 + i} {1 + (i + 1) % 4} {5 + (i + 1) % 4} {5 + i}\n" for i in range(4))
    (tmp_path / "tree.obj").write_text(faces)
    here = Path.cwd()
    os.chdir(tmp_path)
    try:
        exec(compile(code, "docs/python.md", "exec"), {})
    finally:
        os.chdir(here)
    head = (tmp_path / "tree.laz").read_bytes()[:255]
    assert head[:4] == b"LASF" and struct.unpack_from("<Q", head, 247)[0] > 10_000
    assert (tmp_path / "tree.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
