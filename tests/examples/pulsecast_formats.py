# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Compares the points and waveforms that the survey program writes in each format, as NumPy reads them, and runs the snippets of docs/results.md.
Usage: pulsecast_formats.py PROGRAM SURVEY DOCS FOLDER, where FOLDER is emptied."""

import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys

import numpy as np

program, survey, docs, root = (pathlib.Path(word).resolve() for word in sys.argv[1:])
shutil.rmtree(root, ignore_errors=True)
root.mkdir(parents=True)
os.environ["XDG_CACHE_HOME"] = str(root / "cache")
TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4", "float": "<f4", "double": "<f8"}


def run(form, *options, into=None):
    """Folder of a run."""
    output = root / (into or form)
    subprocess.run([program, survey, "--format", form, "--output", output, "--gpsStartTime", "1577836800", "--quiet", *options], check=True)
    return next(output.glob("*/*"))


def ply(path):
    head, body = path.read_bytes().split(b"end_header\n", 1)
    fields = re.findall(rb"property (\w+) (\w+)", head)
    assert not {kind for kind, _ in fields} & {b"ushort", b"uint"}, "Open3D does not take these types"
    return np.frombuffer(body, [(name.decode(), TYPES[kind.decode()]) for kind, name in fields])


def pcd(path):
    head, body = path.read_bytes().split(b"DATA binary\n", 1)
    rows = {line.split()[0]: line.split()[1:] for line in head.decode().splitlines() if not line.startswith("#")}
    kinds = [letter.lower() + size for letter, size in zip(rows["TYPE"], rows["SIZE"])]
    return np.frombuffer(body, list(zip(rows["FIELDS"], kinds)))


def kitti(folder):
    """Points in the frame of the first scan, x to the right and y forward; labels; number of scans."""
    points, labels = [], []
    poses = np.loadtxt(folder / "poses.txt", ndmin=2).reshape(-1, 3, 4)
    for number, pose in enumerate(poses):
        scan = np.fromfile(folder / f"velodyne/{number:06}.bin", "<f4").reshape(-1, 4).astype(float)
        p = scan[:, :3] @ pose[:, :3].T + pose[:, 3]
        points.append(np.stack([-p[:, 1], p[:, 0], p[:, 2]], axis=1))
        labels.append(np.fromfile(folder / f"labels/{number:06}.label", "<u4"))
    return np.concatenate(points), np.concatenate(labels), len(poses)


def mcap(path):
    """Points of the messages, as arrays of fields."""
    data, at, all_points = path.read_bytes(), 8, []

    def message(cdr):
        body, place = cdr[4:], 8  # after the stamp

        def number(kind, size):
            nonlocal place
            place = (place + size - 1) // size * size + size
            return struct.unpack_from("<" + kind, body, place - size)[0]

        def text():
            nonlocal place
            length = number("I", 4)
            place += length
            return body[place - length : place - 1].decode()

        frame, height, width, fields = text(), number("I", 4), number("I", 4), []
        for _ in range(number("I", 4)):
            name, offset, kind, count = text(), number("I", 4), number("B", 1), number("I", 4)
            fields.append((name, offset, ["", "i1", "u1", "<i2", "<u2", "<i4", "<u4", "<f4", "<f8"][kind]))
            assert count == 1
        number("B", 1)
        step, _, length = number("I", 4), number("I", 4), number("I", 4)
        names, offsets, formats = zip(*fields)
        kind = np.dtype({"names": names, "offsets": offsets, "formats": formats, "itemsize": step})
        assert frame == "scanner" and height == 1 and length == width * step
        return np.frombuffer(body, kind, width, place)

    while at < len(data) - 8:
        opcode, length = struct.unpack_from("<BQ", data, at)
        if opcode == 6:  # a chunk: records after times, size, checksum, compression, size
            at += 9 + 40
            continue
        if opcode == 5:
            all_points.append(message(data[at + 9 + 22 : at + 9 + length]))
        at += 9 + length
    return np.concatenate(all_points)


def ptx(path):
    """Points of all scans in the world, with their intensities, and the numbers of lines."""
    lines, at, points, sizes = path.read_text().splitlines(), 0, [], []
    while at < len(lines):
        count = int(lines[at]) * int(lines[at + 1])
        matrix = np.array([line.split() for line in lines[at + 6 : at + 10]], float)
        scan = np.array([line.split() for line in lines[at + 10 : at + 10 + count]], float)
        assert len(scan) == count
        hit = scan[np.any(scan[:, :3] != 0, axis=1)]
        assert (scan[np.all(scan[:, :3] == 0, axis=1)][:, 3] == 0.5).all()
        points.append(np.column_stack([hit[:, :3] @ matrix[:3, :3] + matrix[3, :3], hit[:, 3]]))
        sizes.append(count)
        at += 10 + count
    return np.concatenate(points), sizes


def places(points):
    return np.stack([points[axis] for axis in "xyz"], axis=1).astype(float)


text = run("xyz", "--writeWaveform", "--waveformBins", "200", "--columns", "leg,range")
arrays = run("npz", "--writeWaveform")
folders = {name: run(name) for name in ("ply", "pcd", "mcap", "ptx")}
folders["kitti"] = run("kitti", "--kittiClasses", "own")
for prefix in ("leg000", "strip00a"):
    rows = np.loadtxt(text / f"{prefix}_points.xyz")
    points = np.load(arrays / f"{prefix}_points.npz")
    assert len(rows) > 500
    assert np.allclose(places(points), rows[:, :3], atol=6e-5, rtol=0)
    assert np.allclose(points["intensity"] * 1e9, rows[:, 3], atol=6e-5, rtol=1e-6)
    for name, column in (("return_number", 5), ("number_of_returns", 6), ("pulse", 7), ("object", 8), ("classification", 9), ("leg", 11)):
        assert (points[name] == rows[:, column]).all(), name
    assert np.allclose(points["clock"], rows[:, 10], atol=1e-9, rtol=0)
    assert (points["range"] == rows[:, 12]).all()
    for name, found in (("ply", ply(folders["ply"] / f"{prefix}_points.ply")), ("pcd", pcd(folders["pcd"] / f"{prefix}_points.pcd"))):
        assert set(found.dtype.names) == set(points.files), name
        for field in points.files:
            same = found[field] == points[field] if name == "ply" or field not in "xyz" else np.isclose(found[field], points[field], atol=1e-5)
            assert (same | (np.isnan(found[field]) & np.isnan(points[field]))).all(), (name, field)
    turns, labels, scans = kitti(folders["kitti"] / f"{prefix}_points.kitti")
    assert scans == (10 if prefix == "leg000" else 20)
    shift = places(points)[0] - turns[0]
    assert abs(shift[2] - 1.5) < 1e-4 and np.allclose(turns + shift, places(points), atol=1e-4)
    assert (labels == points["object"] << 16 | points["classification"]).all()
    messages = mcap(folders["mcap"] / f"{prefix}_points.mcap")
    assert np.allclose(messages["range"], points["range"]) and (messages["pulse"] == points["pulse"]).all()
    assert np.allclose(np.linalg.norm(places(messages), axis=1), points["range"], atol=1e-3)
    first = points["return_number"] == 1
    grid, sizes = ptx(folders["ptx"] / f"{prefix}_points.ptx")
    assert len(sizes) == (1 if prefix == "leg000" else 2) and sizes[0] > first.sum() / len(sizes)
    assert len(grid) == first.sum() and np.allclose(grid[:, :3], places(points)[first], atol=3e-6)
    assert np.allclose(grid[:, 3], np.clip(points["reflectance"], 0, 1)[first], atol=1e-6)
    waves, table = np.load(arrays / f"{prefix}_fullwave.npz"), np.loadtxt(text / f"{prefix}_fullwave.txt")

    def beams(what):
        return np.stack([waves[f"{what}_{axis}"] for axis in "xyz"], axis=1)

    assert table.shape == (len(waves["pulse"]), 210) and (table[:, 0] == waves["pulse"]).all()
    for k in range(len(table)):
        samples = waves["samples"][waves["first"][k] :][: waves["count"][k]]
        assert np.allclose(table[k, 10 : 10 + len(samples)], samples * 1e9, atol=1e-9) and not table[k, 10 + len(samples) :].any()
    assert np.allclose(table[:, 7], waves["start"] * 5e8, atol=1e-6) and np.allclose(table[:, 1:4], beams("origin"), atol=6e-5)
    assert np.allclose(table[:, 4:7], beams("direction"), atol=1e-9) and np.allclose(table[:, 9], waves["time"], atol=1e-9)

# The snippets of the page, each in the folder of the run that its first line names.
snippets = re.findall(r"```python\n# (--format [^\n]*)\n(.*?)```", docs.read_text(), re.S)
assert len(snippets) == 3
waves = np.load(arrays / "leg000_fullwave.npz")
for options, snippet in snippets:
    os.chdir(run(*options.removeprefix("--format ").split(), into="snippet" + options.replace(" ", "_")))
    values = {}
    exec(snippet, values)
    peak = waves["samples"][waves["first"][0] :][: waves["count"][0]].max()
    assert abs(values["samples"].max() / peak - 1) < 2e-4, options
print("All formats have the same points and waveforms.")
