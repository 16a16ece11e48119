# SPDX-FileCopyrightText: 2026 the pulsecast contributors
# SPDX-License-Identifier: MIT
"""Points by column, and their Arrow stream, read by the text of its specification."""

import ctypes
import gc
import pickle
import resource
import sys
import threading

import numpy as np
import pytest

import painted
from painted import SettingError

# Source: Apache Arrow, The Arrow C Data Interface and The Arrow C Stream Interface, Structure definitions.


class ArrowSchema(ctypes.Structure):
    pass


class ArrowArray(ctypes.Structure):
    pass


class ArrowArrayStream(ctypes.Structure):
    pass


ArrowSchema._fields_ = [
    ("format", ctypes.c_char_p), ("name", ctypes.c_char_p), ("metadata", ctypes.c_char_p), ("flags", ctypes.c_int64), ("n_children", ctypes.c_int64),
    ("children", ctypes.POINTER(ctypes.POINTER(ArrowSchema))), ("dictionary", ctypes.POINTER(ArrowSchema)),
    ("release", ctypes.CFUNCTYPE(None, ctypes.POINTER(ArrowSchema))), ("private_data", ctypes.c_void_p)]
ArrowArray._fields_ = [
    ("length", ctypes.c_int64), ("null_count", ctypes.c_int64), ("offset", ctypes.c_int64), ("n_buffers", ctypes.c_int64), ("n_children", ctypes.c_int64),
    ("buffers", ctypes.POINTER(ctypes.c_void_p)), ("children", ctypes.POINTER(ctypes.POINTER(ArrowArray))), ("dictionary", ctypes.POINTER(ArrowArray)),
    ("release", ctypes.CFUNCTYPE(None, ctypes.POINTER(ArrowArray))), ("private_data", ctypes.c_void_p)]
ArrowArrayStream._fields_ = [
    ("get_schema", ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ArrowArrayStream), ctypes.POINTER(ArrowSchema))),
    ("get_next", ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ArrowArrayStream), ctypes.POINTER(ArrowArray))),
    ("get_last_error", ctypes.CFUNCTYPE(ctypes.c_char_p, ctypes.POINTER(ArrowArrayStream))),
    ("release", ctypes.CFUNCTYPE(None, ctypes.POINTER(ArrowArrayStream))), ("private_data", ctypes.c_void_p)]

pointer_of = ctypes.pythonapi.PyCapsule_GetPointer
pointer_of.restype, pointer_of.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
new_capsule = ctypes.pythonapi.PyCapsule_New
new_capsule.restype, new_capsule.argtypes = ctypes.py_object, [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]

# Source: The Arrow C Data Interface, Data type description, Format strings.
NUMPY_OF = {b"c": "i1", b"C": "u1", b"s": "i2", b"S": "u2", b"i": "i4", b"I": "u4", b"l": "i8", b"L": "u8", b"f": "f4", b"g": "f8"}

POINTS = {"x": b"g", "y": b"g", "z": b"g", "time": b"g", "range": b"g", "intensity": b"f", "reflectance": b"f", "echo_width": b"f", "cos_incidence": b"f",
          "pulse": b"l", "object": b"I", "classification": b"S", "leg": b"S", "return_number": b"C", "number_of_returns": b"C", "channel": b"S", "kind": b"C"}
COLOURS = dict.fromkeys(["red", "green", "blue", "near_infrared"], b"S")
ATTRIBUTES = {"age": b"g", "species": b"g"}


class Stream:
    """A consumer: moves the stream out of its capsule, as the specification of capsules has it."""

    def __init__(self, capsule):
        source = ArrowArrayStream.from_address(pointer_of(capsule, b"arrow_array_stream"))
        self.stream = moved(source)

    def schema(self):
        out = ArrowSchema()
        assert self.stream.get_schema(ctypes.byref(self.stream), ctypes.byref(out)) == 0
        return out

    def next(self):
        out = ArrowArray()
        assert self.stream.get_next(ctypes.byref(self.stream), ctypes.byref(out)) == 0
        return out

    def release(self):
        release(self.stream)


def moved(source):
    """Copy of a structure, which takes it over: the source counts as released."""
    copy = type(source).from_buffer_copy(source)
    source.release = type(source.release)()
    return copy


def release(structure):
    assert structure.release
    structure.release(ctypes.byref(structure))
    assert not structure.release


def numbers(array, form):
    """Numbers of a column of Arrow, in its own memory."""
    kind = np.dtype(NUMPY_OF[form])
    memory = (ctypes.c_char * (array.length * kind.itemsize)).from_address(array.buffers[1])
    return np.frombuffer(memory, kind)


def run(pulses=5000, **asked):
    return painted.Sweep(pulses).run(**({"columns": True} | asked))


def test_columns_are_those_of_the_rows_bit_for_bit():
    rows, batch = run(columns=False), run()
    assert list(batch.columns) == [*POINTS, *ATTRIBUTES]
    assert len(rows.points) > 4000
    for name in POINTS:
        column = batch.columns[name]
        assert column.dtype == rows.points.dtype[name] and column.flags.c_contiguous
        assert column.tobytes() == rows.points[name].tobytes(), name
        assert np.shares_memory(rows.columns[name], rows.points), name
    assert batch.pulses.tobytes() == rows.pulses.tobytes()
    assert repr(batch) == repr(rows) == f"<Batch of {len(rows.points)} points, 5000 pulses, 0 samples>"


def test_columns_of_given_names_are_kept_alone_also_those_that_need_surfaces():
    rows = run(columns=False, colours=True)
    batch = run(columns=["normal_z", "species", "range", "red", "part", "velocity_x", "clock"])
    assert list(batch.columns) == ["normal_z", "species", "range", "red", "part", "velocity_x", "clock"]
    columns = batch.columns
    assert np.abs(columns["normal_z"] - 1).max() < 1e-6 and (columns["velocity_x"] == 0).all()
    assert (columns["part"] == np.where(rows.columns["object"] == 1, 0, 1)).all()
    for name in ("species", "range", "red"):
        assert columns[name].tobytes() == rows.columns[name].tobytes(), name
    assert (columns["clock"] == rows.points["time"]).all()
    stream = Stream(batch.__arrow_c_stream__())
    schema = stream.schema()
    assert [schema.children[k].contents.format for k in range(schema.n_children)] == [b"f", b"g", b"g", b"S", b"I", b"f", b"g"]
    release(schema)
    stream.release()
    with pytest.raises(SettingError, match="column 'nrmal_z' is not known; did you mean 'normal_z'"):
        run(columns=["nrmal_z"])


def test_points_by_column_are_no_rows():
    with pytest.raises(AttributeError, match="columns"):
        run().points


def test_attributes_are_those_of_the_points_objects():
    for asked in (False, True):
        columns = run(columns=asked).columns
        south = columns["object"] == 1
        assert south.any() and not south.all()
        assert (columns["age"][south] == 80.5).all() and np.isnan(columns["age"][~south]).all()
        assert (columns["species"] == np.where(south, 3, 7)).all()
        assert columns["age"].dtype == np.float64


def test_colours_are_those_of_the_points_surfaces():
    for asked in (False, True):
        columns = run(columns=asked, colours=True).columns
        assert list(columns) == [*POINTS, *COLOURS, *ATTRIBUTES]
        south = columns["object"] == 1
        assert south.any() and not south.all()
        for name, of_south, of_north in (("red", 65535, 0), ("green", 0, 13107), ("blue", 0, 65535), ("near_infrared", 13107, 26214)):
            assert columns[name].dtype == np.uint16
            assert (columns[name] == np.where(south, of_south, of_north)).all(), name


def test_what_cannot_be_kept_is_refused():
    import own_scanner
    with pytest.raises(ValueError, match="colours"):
        own_scanner.RosetteSurvey(10).run(colours=True)
    with pytest.raises(SettingError) as refused:
        painted.MisnamedSweep(10).run()
    assert "'range'" in refused.value.field


def test_the_schema_names_the_columns_and_their_formats():
    stream = Stream(run(colours=True).__arrow_c_stream__())
    for _ in range(2):  # as often as asked
        schema = stream.schema()
        assert schema.format == b"+s" and schema.flags == 0 and not schema.metadata and not schema.dictionary
        expected = POINTS | COLOURS | ATTRIBUTES
        assert schema.n_children == len(expected)
        for k, (name, form) in enumerate(expected.items()):
            child = schema.children[k].contents
            assert (child.name.decode(), child.format) == (name, form)
            assert child.flags == child.n_children == 0 and not child.metadata and not child.dictionary and child.release
        release(schema)
    stream.release()


def test_columns_are_in_the_memory_of_the_arrays():
    batch = run(colours=True)
    stream = Stream(batch.__arrow_c_stream__())
    array, end = stream.next(), stream.next()
    assert not end.release  # which is the end
    points = len(batch.columns["x"])
    assert (array.length, array.null_count, array.offset, array.n_buffers) == (points, 0, 0, 1) and points > 4000
    assert array.buffers[0] is None
    for k, (name, form) in enumerate((POINTS | COLOURS | ATTRIBUTES).items()):
        column, child = batch.columns[name], array.children[k].contents
        assert (child.length, child.null_count, child.offset, child.n_buffers, child.n_children) == (points, 0, 0, 2, 0)
        assert child.buffers[0] is None
        assert child.buffers[1] == column.ctypes.data, name
        assert numbers(child, form).tobytes() == column.tobytes()
    release(array)
    stream.release()


def test_memory_lives_until_its_last_owner_lets_go():
    batch = run()
    expected = {name: column.copy() for name, column in batch.columns.items()}
    x = batch.columns["x"]
    own = sys.getrefcount(x)
    stream = Stream(batch.__arrow_c_stream__())
    array = stream.next()
    assert sys.getrefcount(x) > own
    child = moved(array.children[0].contents)  # a consumer may keep a column alone
    del batch
    stream.release()
    gc.collect()
    for k, (name, form) in enumerate((POINTS | ATTRIBUTES).items()):
        if k > 0:
            assert numbers(array.children[k].contents, form).tobytes() == expected[name].tobytes(), name
    release(array)
    assert numbers(child, b"g").tobytes() == expected["x"].tobytes()
    without_batch = sys.getrefcount(x)
    release(child)
    assert sys.getrefcount(x) == without_batch - 1 == 2  # of `x`, and of the call


def test_capsules_that_nobody_takes_free_their_stream():
    batch = run()
    x = batch.columns["x"]
    before = sys.getrefcount(x)
    capsule = batch.__arrow_c_stream__()
    assert sys.getrefcount(x) == before + 1
    del capsule
    assert sys.getrefcount(x) == before


def test_structures_are_released_by_any_thread():
    batch = run()
    x = batch.columns["x"]
    before = sys.getrefcount(x)
    held = []

    def consume():
        stream = Stream(batch.__arrow_c_stream__())
        held.append((stream.schema(), stream.next()))
        stream.release()

    threads = [threading.Thread(target=consume) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sys.getrefcount(x) == before + 8
    threads = [threading.Thread(target=lambda pair=pair: [release(part) for part in pair]) for pair in held]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sys.getrefcount(x) == before


def test_streams_leave_no_memory_behind():
    batch = run(100)

    def consume(times):
        for _ in range(times):
            stream = Stream(batch.__arrow_c_stream__())
            release(stream.schema())
            release(stream.next())
            stream.release()
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    assert -consume(500) + consume(5000) < 2048  # KiB


def test_a_run_without_points_has_columns_of_length_zero():
    batch = run(first=10, end=10, colours=True)
    stream = Stream(batch.__arrow_c_stream__())
    schema, array = stream.schema(), stream.next()
    assert schema.n_children == array.n_children == len(POINTS | COLOURS | ATTRIBUTES)
    assert array.length == 0 and all(array.children[k].contents.length == 0 for k in range(array.n_children))
    release(schema)
    release(array)
    stream.release()


def test_batches_of_a_callback_are_streams_each():
    whole, parts = run(20_000), []
    left = run(20_000, callback=parts.append, every_pulses=3000)
    assert len(parts) > 3 and len(left.columns["x"]) == 0
    together = []
    for part in parts:
        stream = Stream(part.__arrow_c_stream__())
        array = stream.next()
        together.append(numbers(array.children[0].contents, b"g").copy())
        assert part.pulses["first_point"][0] == 0 and part.pulses["points"].sum() == array.length
        release(array)
        stream.release()
    assert np.concatenate(together).tobytes() == whole.columns["x"].tobytes()


def test_batches_that_were_sent_are_streams_too():
    batch = run(colours=True)
    sent = pickle.loads(pickle.dumps(batch))
    assert list(sent.columns) == list(batch.columns)
    stream = Stream(sent.__arrow_c_stream__())
    array = stream.next()
    for k, (name, form) in enumerate((POINTS | COLOURS | ATTRIBUTES).items()):
        assert numbers(array.children[k].contents, form).tobytes() == batch.columns[name].tobytes(), name
    release(array)
    stream.release()


def test_rows_are_no_stream():
    with pytest.raises(ValueError, match="columns=True"):
        run(columns=False).__arrow_c_stream__()


def test_the_schema_that_a_consumer_asks_for_is_a_capsule():
    batch, name, schema = run(), b"arrow_schema", ArrowSchema()
    asked = new_capsule(ctypes.addressof(schema), name, None)
    for capsule in (batch.__arrow_c_stream__(asked), batch.__arrow_c_stream__(requested_schema=None)):
        Stream(capsule).release()
    other = new_capsule(ctypes.addressof(schema), b"arrow_array", None)
    for wrong in (3, "schema", other):
        with pytest.raises(TypeError, match="arrow_schema"):
            batch.__arrow_c_stream__(wrong)
