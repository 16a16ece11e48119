# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""The Arrow stream of points as DuckDB reads it, by its library for Node.js, without its Python module."""

import ctypes
import os
from pathlib import Path

import numpy as np
import pytest

import painted

LIBRARY = Path(os.environ["PULSECAST_NODE_MODULES"]) / "@duckdb" / "node-bindings-linux-x64" / "libduckdb.so"
TYPES = {"f8": "DOUBLE", "f4": "FLOAT", "i8": "BIGINT", "u4": "UINTEGER", "u2": "USMALLINT", "u1": "UTINYINT"}


class Result(ctypes.Structure):
    # Source: DuckDB, C API, duckdb_result
    _fields_ = [("counts", ctypes.c_uint64 * 3), ("pointers", ctypes.c_void_p * 3)]


class Database:
    def __init__(self):
        self.library = ctypes.CDLL(str(LIBRARY))
        self.library.duckdb_result_error.restype = ctypes.c_char_p
        self.library.duckdb_value_varchar.restype = ctypes.c_char_p
        self.library.duckdb_value_double.restype = ctypes.c_double
        self.library.duckdb_value_int64.restype = ctypes.c_int64
        database, self.connection = ctypes.c_void_p(), ctypes.c_void_p()
        assert self.library.duckdb_open(None, ctypes.byref(database)) == 0
        assert self.library.duckdb_connect(database, ctypes.byref(self.connection)) == 0

    def query(self, text):
        result = Result()
        failed = self.library.duckdb_query(self.connection, text.encode(), ctypes.byref(result))
        assert not failed, self.library.duckdb_result_error(ctypes.byref(result))
        return result

    def value(self, kind, text):
        """The only value of a query."""
        return getattr(self.library, f"duckdb_value_{kind}")(ctypes.byref(self.query(text)), ctypes.c_uint64(0), ctypes.c_uint64(0))

    def take(self, batch):
        """Table `points` of a batch."""
        pointer_of = ctypes.pythonapi.PyCapsule_GetPointer
        pointer_of.restype, pointer_of.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
        capsule = batch.__arrow_c_stream__()
        stream = ctypes.c_void_p(pointer_of(capsule, b"arrow_array_stream"))
        assert self.library.duckdb_arrow_scan(self.connection, b"stream", stream) == 0
        self.query("CREATE TABLE points AS SELECT * FROM stream")
        self.query("DROP VIEW stream")


@pytest.fixture
def database():
    return Database()


def test_every_number_arrives(database):
    batch = painted.Sweep(300_000).run(columns=True, colours=True, pulses=False)
    database.take(batch)
    assert database.value("int64", "SELECT count(*) FROM points") == len(batch.columns["x"]) > 200_000
    for name, column in batch.columns.items():
        kind = TYPES[column.dtype.str[1:]]
        assert database.value("varchar", f"SELECT DISTINCT typeof({name}) FROM points").decode() == kind, name
        assert database.value("int64", f"SELECT count({name}) FROM points") == len(column)  # none is null
        if column.dtype.kind == "f":
            there = column[~np.isnan(column)]
            assert database.value("int64", f"SELECT count(*) FROM points WHERE NOT isnan({name})") == len(there)
            for end in ("min", "max"):
                value = database.value("double", f"SELECT {end}({name})::DOUBLE FROM points WHERE NOT isnan({name})")
                assert value == getattr(there, end)(), (name, end)
        else:
            assert database.value("int64", f"SELECT sum({name}::BIGINT)::BIGINT FROM points") == column.astype(np.int64).sum(), name


def test_rows_stay_together(database):
    batch = painted.Sweep(20_000).run(columns=True, colours=True)
    database.take(batch)
    of_north = "FROM points WHERE object = 2"
    assert database.value("int64", f"SELECT count(*) {of_north}") == (batch.columns["object"] == 2).sum() > 5000
    assert database.value("double", f"SELECT min(y) {of_north}") >= 0
    assert database.value("int64", f"SELECT count(*) {of_north} AND species = 7 AND blue = 65535 AND isnan(age)") == \
        database.value("int64", f"SELECT count(*) {of_north}")


def test_a_table_without_points_is_empty(database):
    database.take(painted.Sweep(10).run(first=5, end=5, columns=True))
    assert database.value("int64", "SELECT count(*) FROM points") == 0
