// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/python/bind.hpp>

#include <cmath>
#include <csignal>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <pybind11/embed.h>

#include <pulsecast/pulsecast.hpp>

#include "python/interpreter.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
namespace py = pybind11;

namespace {

/// A wall of 8 m by 5 m, 10 m to the north.
const Scene<TriangleMesh<>>& wall() {
  static const MeshData mesh{.vertices = {{-4, 10, 0}, {4, 10, 0}, {4, 10, 5}, {-4, 10, 5}},
                             .triangles = {{0, 1, 2}, {0, 2, 3}}};
  static const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(mesh), .object = 42}});
  return scene;
}

/// Two lines up and down the wall and beyond it.
auto survey_of(PulseIndex pulses, double record) {
  const Scanner scanner{.pulse_rate = 10_kHz, .pulses = pulses};
  const Platform stand{Tripod{.position = {0, 0, 2}}, Mount{}, Deflector{PolygonMirror{.line_rate = 100_Hz}, scanner}};
  return Survey{
      stand, SunflowerFootprint{7}, wall(), Receiver{}, FullWaveform{WaveformSettings{.record_length = record}}, 3};
}
using WallSurvey = decltype(survey_of(1, 0));

/// A user's trajectory that is lost at once.
struct Lost {
  Pose<frame::Body, frame::World> at(Tick) const noexcept { return {no_rotation, {0, 0, std::nan("")}}; }
};
using LostSurvey = decltype(Survey{Platform{Lost{}, Mount{}, Deflector{FixedBeam{}, Scanner{}}}, SingleRay{}, wall(),
                                   Receiver{}, FirstHit{}});
LostSurvey lost_survey() {
  return Survey{Platform{Lost{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 10}}}, SingleRay{}, wall(),
                Receiver{}, FirstHit{}};
}

/// Row of a point, as a C++ program reads it.
struct PointRow {
  double x, y, z, time, range;
  float intensity, reflectance, echo_width, cos_incidence;
  std::int64_t pulse;
  std::uint32_t object;
  std::uint16_t classification, leg;
  std::uint8_t return_number, number_of_returns;
  std::uint16_t channel;
  std::uint8_t kind, spare[3];
};

/// Throws what a reader throws.
void fail_to_read() { throw FileError("scene.obj", "line 3", "expected a number"); }

/// Extras of the wall's points: its height, and red above 2 m.
io::PointSettings wall_extras(const WallSurvey&) {
  std::vector<Scene<TriangleMesh<>>::Part> parts(1);
  parts[0].object = 42;
  parts[0].attributes = attributes({{"height", 5}});
  const auto colour = [](const EchoBatch&, const Shot& shot, const Echo& echo) {
    return PointColour{.red = static_cast<std::uint16_t>(point_of(shot, echo).z > 2 ? 65535 : 0)};
  };
  return {.colours = colour, .attributes = ObjectAttributes{std::span(std::as_const(parts))}};
}

PYBIND11_EMBEDDED_MODULE(scans, m) {
  python::bind_survey<WallSurvey>(m, "WallSurvey", &wall_extras)
      .def(py::init(&survey_of), py::arg("pulses") = 200, py::arg("record") = 0.0);
  python::bind_survey<LostSurvey>(m, "LostSurvey").def(py::init(&lost_survey));
  m.def("fail_to_read", &fail_to_read);
  m.def("interrupt", [] { std::raise(SIGINT); });
}

/// Python that has the module at hand.
py::dict names() { return support::python_names("import scans, numpy"); }

/// What an expression of Python gives, in its own words.
std::string said(py::dict scope, const std::string& expression) { return py::str(py::eval(expression, scope)); }

}  // namespace

TEST_CASE("points and pulses in Python are those of the same survey in C++, to the last bit") {
  py::dict scope = names();
  py::exec("result = scans.WallSurvey(200, 4e-9).run(threads=2)", scope);
  std::vector<Shot> shots;
  Cloud cloud;
  std::vector<float> samples;
  run(survey_of(200, 4e-9), {.threads = 1}, cloud, [&](const EchoBatch& batch) {
    shots.assign(batch.shots.begin(), batch.shots.end());
    samples.assign(batch.samples.begin(), batch.samples.end());
  });
  REQUIRE(cloud.size() > 20);
  const auto points = scope["result"].attr("points").cast<py::array>();
  REQUIRE(points.itemsize() == sizeof(PointRow));
  REQUIRE(points.size() == static_cast<py::ssize_t>(cloud.size()));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    CAPTURE(i);
    const PointRow& row = static_cast<const PointRow*>(points.data())[i];
    const Echo& echo = cloud.echoes[i];
    CHECK(Vec3{row.x, row.y, row.z} == cloud.points[i]);
    CHECK(row.time == cloud.ticks[i].seconds());
    CHECK(row.range == echo.range);
    CHECK(row.intensity == static_cast<float>(echo.amplitude));
    CHECK(row.reflectance == static_cast<float>(echo.reflectance));
    CHECK(row.cos_incidence == static_cast<float>(echo.cos_incidence));
    CHECK(row.pulse == static_cast<std::int64_t>(cloud.pulses[i]));
    CHECK(row.object == 42);
    CHECK(row.return_number == echo.number);
    CHECK(row.number_of_returns == 1);
    CHECK((row.spare[0] == 0 && row.spare[1] == 0 && row.spare[2] == 0));
  }
  const auto pulses = scope["result"].attr("pulses").cast<py::array_t<python::PulseRow>>();
  REQUIRE(pulses.size() == static_cast<py::ssize_t>(shots.size()));
  std::int64_t sample = 0, point = 0;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    CAPTURE(i);
    const python::PulseRow& row = pulses.at(static_cast<py::ssize_t>(i));
    CHECK(row.pulse == static_cast<std::int64_t>(shots[i].index));
    CHECK(Vec3{row.direction_x, row.direction_y, row.direction_z} == shots[i].direction);
    CHECK(row.fate == static_cast<std::uint8_t>(shots[i].fate));
    CHECK(row.waveform_start == shots[i].waveform_start);
    CHECK(row.first_sample == sample);
    CHECK(row.first_point == point);
    sample += row.samples;
    point += row.points;
  }
  const auto waveforms = scope["result"].attr("waveforms").cast<py::array_t<float>>();
  CHECK(std::vector<float>(waveforms.data(), waveforms.data() + waveforms.size()) == samples);
  CHECK(said(scope, "result.fates['returned'] == len(result.points) and result.slots == 200 and result.complete") ==
        "True");
  py::exec("row = int(numpy.flatnonzero(result.pulses['samples'])[1])\nfirst = result.pulses['first_sample'][row]",
           scope);
  CHECK(said(scope, "first > 0 and numpy.array_equal(result.waveform_of(row), result.waveforms[first:first + 16])") ==
        "True");
  CHECK(said(scope, "[scans.FATES[f] for f in sorted(set(result.pulses['fate']))]") == "['returned', 'missed']");
}

TEST_CASE("an array holds the rows that were collected, not a copy, and outlives the run") {
  py::dict scope = names();
  py::exec("points = scans.WallSurvey(200).run().points", scope);
  CHECK(said(scope, "points.flags.owndata") == "False");
  CHECK(said(scope, "points.base is not None and points['object'].min() == 42") == "True");
  CHECK(said(scope, "len(scans.WallSurvey(200).run(first=10, end=10).points)") == "0");
}

TEST_CASE("a callback gets every pulse once, in order, and the result keeps none") {
  py::dict scope = names();
  py::exec(
      "numbers = []\nsizes = []\n"
      "def take(batch):\n"
      "  numbers.extend(batch.pulses['pulse'])\n"
      "  sizes.append(len(batch.pulses))\n"
      "survey = scans.WallSurvey(20000)\n"
      "result = survey.run(threads=2, callback=take, every_pulses=3000)\n",
      scope);
  CHECK(said(scope, "numbers == list(range(20000)) and len(sizes) > 3 and min(sizes[:-1]) >= 3000") == "True");
  CHECK(said(scope, "len(result.points) == 0 and result.slots == 20000") == "True");
}

TEST_CASE("progress ends with all done") {
  py::dict scope = names();
  py::exec("told = []\nscans.WallSurvey(20000).run(progress=lambda *p: told.append(p))", scope);
  CHECK(said(scope, "told[-1][:2]") == "(20000, 20000)");
}

TEST_CASE("errors come as Python's own, with their fields") {
  py::dict scope = names();
  py::exec("try:\n  scans.WallSurvey(200, -1)\nexcept scans.SettingError as e:\n  error = e", scope);
  CHECK(said(scope, "isinstance(error, ValueError) and (error.field, error.value, error.unit, error.allowed != '')") ==
        "('WaveformSettings::record_length', -1.0, 's', True)");
  py::exec("try:\n  scans.fail_to_read()\nexcept scans.FileError as e:\n  error = e", scope);
  CHECK(said(scope, "isinstance(error, OSError) and (error.path, error.place, error.problem)") ==
        "('scene.obj', 'line 3', 'expected a number')");
}

TEST_CASE("what a callback raises ends the run") {
  py::dict scope = names();
  py::exec(
      "def take(batch): raise KeyError('enough')\n"
      "try:\n  scans.WallSurvey(20000).run(threads=2, callback=take, every_pulses=1)\nexcept KeyError as e:\n  error = "
      "e",
      scope);
  CHECK(said(scope, "error") == "'enough'");
}

TEST_CASE("Ctrl-C stops a run, what came is whole, and Python's own handler is back") {
  py::dict scope = names();
  py::exec("import signal\nsignal.signal(signal.SIGINT, signal.default_int_handler)",
           scope);  // the test framework took it
  py::exec(
      "def stop(*progress): scans.interrupt()\n"
      "try:\n  scans.WallSurvey(100_000_000).run(progress=stop)\nexcept scans.Interrupted as e:\n  result = e.result\n",
      scope);
  CHECK(said(scope, "0 < result.slots < 100_000_000 and not result.complete") == "True");
  CHECK(
      said(scope, "len(result.pulses) == result.slots and list(result.pulses['pulse']) == list(range(result.slots))") ==
      "True");
  CHECK(said(scope, "issubclass(scans.Interrupted, KeyboardInterrupt)") == "True");
  CHECK_THROWS_WITH(py::exec("scans.interrupt()\nfor i in range(1000000): pass", scope),
                    doctest::Contains("KeyboardInterrupt"));
}

TEST_CASE("a pose of a user's own trajectory that is not finite is a RuntimeError that names the pulse") {
  py::dict scope = names();
  py::exec(R"(
try:
    scans.LostSurvey().run(threads=2)
    said = "nothing"
except RuntimeError as error:
    said = str(error)
)",
           scope);
  CHECK(said(scope, "said") ==
        "pulse 0 at 0 s has a pose that is not finite: check the trajectory, optic or pose errors");
}

TEST_CASE("the energy of a batch is the ledger of its run") {
  py::dict scope = names();
  py::exec("energy = scans.WallSurvey(200, 0).run(threads=1).energy", scope);
  const EnergyLedger e = run(survey_of(200, 0), {.threads = 1}).energy;
  const auto term = [&](const char* name) { return scope["energy"][name].cast<double>(); };
  CHECK(said(scope, "list(energy)") ==
        "['sent', 'missed', 'out_of_range', 'absorbed', 'scattered', 'cut', 'received']");
  CHECK(EnergyLedger{term("sent"), term("missed"), term("out_of_range"), term("absorbed"), term("scattered"),
                     term("cut"), term("received")} == e);
  CHECK(e.missed > 0);
  CHECK(e.scattered > 0);
  CHECK(e.received > 0);
}

TEST_CASE("points by column are those of the rows, with their extras") {
  py::dict scope = names();
  py::exec(
      "survey = scans.WallSurvey(200)\n"
      "rows = survey.run(colours=True)\n"
      "columns = survey.run(columns=True, colours=True).columns\n"
      "extras = ['red', 'green', 'blue', 'near_infrared', 'height']",
      scope);
  CHECK(said(scope, "list(columns) == list(rows.columns) == [*rows.points.dtype.names, *extras]") == "True");
  CHECK(said(scope, "all(columns[name].tobytes() == rows.columns[name].tobytes() for name in columns)") == "True");
  CHECK(said(scope, "len(rows.points) > 20 and set(columns['height']) == {5.0}") == "True");
  CHECK(said(scope, "(columns['red'] == numpy.where(columns['z'] > 2, 65535, 0)).all() and len(set(columns['red']))") ==
        "2");
}

TEST_CASE("a run keeps the columns of given names alone, whichever the table or the objects have") {
  py::dict scope = names();
  py::exec(
      "survey = scans.WallSurvey(200)\n"
      "rows = survey.run().points\n"
      "batch = survey.run(columns=['height', 'range', 'red', 'azimuth', 'pulse', 'kind'])\n"
      "columns = batch.columns",
      scope);
  CHECK(said(scope, "list(columns)") == "['height', 'range', 'red', 'azimuth', 'pulse', 'kind']");
  CHECK(said(scope, "all((columns[name] == rows[name]).all() for name in ['range', 'pulse', 'kind'])") == "True");
  CHECK(said(scope, "set(columns['height']) == {5.0} and set(columns['red']) == {0, 65535}") == "True");
  CHECK(said(scope, "numpy.allclose(columns['azimuth'], numpy.arctan2(rows['y'], rows['x']))") == "True");
  CHECK(said(scope, "str(batch).startswith(f'<Batch of {len(rows)} points,') and len(rows) > 20") == "True");
  const auto refusal = [&](const char* asked) {
    scope["asked"] = py::eval(asked, scope);
    py::exec("try:\n  survey.run(columns=asked)\n  error = ''\nexcept ValueError as e:\n  error = str(e)", scope);
    return scope["error"].cast<std::string>();
  };
  CHECK(refusal("['rnage']") == "column 'rnage' is not known; did you mean 'range'?");
  CHECK(refusal("['normal_x']") == "run columns: the points of this survey have no surfaces");
  CHECK(refusal("['x', 'x']").find("columns 'x' (number) is 2") == 0);
}

TEST_CASE("every column of the table is an array of its type, and a column of the Arrow stream") {
  py::dict scope = names();
  py::list all;
  for (const io::PointColumn& each : io::point_columns)
    if (each.needs != io::PointNeed::surface) all.append(std::string(each.name));
  scope["names"] = all;
  py::exec("batch = scans.WallSurvey(200).run(columns=names)\nstream = batch.__arrow_c_stream__()", scope);
  CHECK(said(scope, "list(batch.columns) == names and all(len(c) > 20 for c in batch.columns.values())") == "True");
  for (const io::PointColumn& each : io::point_columns)
    if (each.needs != io::PointNeed::surface) {
      CAPTURE(each.name);
      const auto column = scope["batch"].attr("columns")[py::str(std::string(each.name))].cast<py::array>();
      CHECK(column.dtype().is(python::dtype_of(each.type)));
      CHECK(said(scope, "'" + std::string(each.name) + "' in scans.WallSurvey.run.__doc__") == "True");
    }
}

TEST_CASE("a consumer of the Arrow stream may take it apart and keep a column after all else is gone") {
  py::dict scope = names();
  py::exec("batch = scans.WallSurvey(200).run(columns=True)\nexpected = batch.columns['range'].tobytes()", scope);
  const py::object capsule = py::eval("batch.__arrow_c_stream__()", scope);
  auto* const source = static_cast<ArrowArrayStream*>(PyCapsule_GetPointer(capsule.ptr(), "arrow_array_stream"));
  ArrowArrayStream stream = *source;
  source->release = nullptr;
  ArrowSchema schema{};
  REQUIRE(stream.get_schema(&stream, &schema) == 0);
  CHECK_FALSE(static_cast<bool>(stream.get_last_error(&stream)));
  REQUIRE(schema.n_children == 18);  // 17 and the height
  CHECK(std::string(schema.children[4]->name) == "range");
  CHECK(std::string(schema.children[4]->format) == "g");
  ArrowSchema name = *schema.children[17];
  schema.children[17]->release = nullptr;
  schema.release(&schema);
  CHECK_FALSE(static_cast<bool>(schema.release));
  CHECK(std::string(name.name) == "height");
  name.release(&name);

  ArrowArray table{}, end{};
  REQUIRE(stream.get_next(&stream, &table) == 0);
  REQUIRE(stream.get_next(&stream, &end) == 0);
  CHECK_FALSE(static_cast<bool>(end.release));
  const auto* const memory = static_cast<const char*>(table.children[4]->buffers[1]);
  const void* const of_array = scope["batch"].attr("columns")["range"].cast<py::array_t<double>>().data();
  CHECK(static_cast<const void*>(memory) == of_array);
  ArrowArray range = *table.children[4];
  table.children[4]->release = nullptr;
  table.release(&table);
  stream.release(&stream);
  py::exec("del batch", scope);
  const auto expected = scope["expected"].cast<std::string>();
  CHECK(std::string(memory, static_cast<std::size_t>(range.length) * sizeof(double)) == expected);
  range.release(&range);
  CHECK_FALSE(static_cast<bool>(range.release));
}
