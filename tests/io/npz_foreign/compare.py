# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Compares NPZ files as NumPy reads them with the records that they were made of. Usage: compare.py PROGRAM, which writes both."""

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
    assert points > 20_000
    assert np.isnan(arrays["velocity"]).any()
    arrays["object"][-1] += 1  # which must be noticed
    assert differences(arrays, records) == {"object"}
print(f"{points} points are the same.")
