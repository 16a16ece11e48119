# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Compares NPZ files as NumPy reads them, and PLY and PCD files as Open3D does if it is there, with the records that they were made of.

Usage: compare.py PROGRAM, which writes all of them.
"""

import pathlib
import subprocess
import sys
import tempfile
import zipfile

import numpy as np

RECORD = np.dtype(
    [("x", "<f8"), ("y", "<f8"), ("z", "<f8"), ("reflectance", "<f4"), ("time", "<f8"), ("channel", "<u2"), ("return_number", "u1"),
     ("returns", "u1"), ("classification", "<u2"), ("object", "<u4"), ("minus_1", "i1"), ("minus_2", "<i2"), ("minus_4", "<i4"),
     ("velocity", "<f8")])


def differences(arrays, records):
    """Names of the arrays that are not the fields of the records, by type, length or bytes."""
    wrong = set(arrays) ^ set(RECORD.names)
    for name in set(arrays) & set(RECORD.names):
        expected = np.ascontiguousarray(records[name])
        if arrays[name].dtype != expected.dtype or arrays[name].tobytes() != expected.tobytes():
            wrong.add(name)
    return wrong


def by_open3d(file, records):
    """Names of the fields that Open3D reads otherwise, as numbers of the same value."""
    cloud = open3d.t.io.read_point_cloud(str(file)).point
    found = {key: cloud[key].numpy() for key in cloud}
    positions = found.pop("positions")
    found.update(x=positions[:, 0], y=positions[:, 1], z=positions[:, 2])
    wrong = set()
    for name in RECORD.names:
        if file.suffix == ".ply" and RECORD[name].str in ("|i1", "<i2", "<u2", "<u4"):  # types that Open3D skips in PLY files
            continue
        if name not in found or not np.array_equal(found[name].ravel().astype("f8"), records[name].astype("f8"), equal_nan=True):
            wrong.add(name)
    return wrong


try:
    import open3d
except ImportError:
    open3d = None
    print("Open3D is not there: PLY and PCD files are not compared (Debian package: python3-open3d)")

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    subprocess.run([sys.argv[1], folder], check=True)
    files = sorted(folder.glob("*.npz"))
    assert len(files) == 3
    points = 0
    for file in files:
        assert zipfile.ZipFile(file).testzip() is None  # checksums
        with np.load(file, allow_pickle=False) as npz:
            arrays = {key: npz[key] for key in npz.files}
        records = np.fromfile(file.with_suffix(".bin"), dtype=RECORD)
        assert not differences(arrays, records), differences(arrays, records)
        points += len(records)
        for other in sorted(folder.glob(file.stem + ".*p[lc][yd]")) if open3d and len(records) > 0 else []:
            assert not by_open3d(other, records), (other.name, by_open3d(other, records))
    assert points > 20_000
    assert np.isnan(arrays["velocity"]).any()
    arrays["object"][-1] += 1  # which must be noticed
    assert differences(arrays, records) == {"object"}
print(f"{points} points are the same.")
