// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/point_records.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scene/motion.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/sensor/spinning_sensor.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/allocations.hpp"
#include "support/generators.hpp"

namespace pulsecast::io {
namespace {

using namespace literals;

/// Batch of one pulse to the east with echoes at 10 m and 20 m.
struct TwoEchoes {
  std::array<Shot, 1> shots{{{.index = 7,
                              .tick = {3, 0.25},
                              .origin = {1, 2, 3},
                              .direction = axis::right,
                              .leg = 2,
                              .channel = 1,
                              .echoes = 2}}};
  std::array<Echo, 2> echoes{
      {{.range = 10,
        .amplitude = 2e-9,
        .reflectance = 0.5,
        .width = 1e-9,
        .cos_incidence = 0.7,
        .object = 9,
        .classification = 6},
       {.range = 20, .amplitude = 1e-9, .reflectance = 8, .number = 2, .kind = ReflectionKind::glass, .velocity = -3}}};

  [[nodiscard]] EchoBatch batch() const { return {.shots = shots, .echoes = echoes, .samples = {}}; }
};

/// Layout of one field a column, of one type.
PointLayout every_column(NumberType type) {
  std::vector<PointField> fields;
  for (const PointColumn& each : point_columns) fields.push_back({std::string(each.name), type, &each});
  return PointLayout::packed(fields);
}

double number(const PointBuffer& points, std::size_t point, const PointColumn* of) {
  for (const PointField& field : points.layout().fields)
    if (field.column == of) return points.number(point, field);
  FAIL("the layout has no such column");
  return 0;
}

TEST_CASE("integers are rounded and limited to the range of their type, and NaN is 0") {
  TwoEchoes two;
  two.echoes[0] = {
      .range = 3.6, .reflectance = 1e9, .object = 70'000, .velocity = std::numeric_limits<double>::quiet_NaN()};
  two.shots[0].origin = {-400, 0, 0};
  for (const NumberType type : {NumberType::int8, NumberType::uint8, NumberType::int16, NumberType::uint16,
                                NumberType::int32, NumberType::uint32}) {
    CAPTURE(static_cast<int>(type));
    PointBuffer points(every_column(type));
    points(two.batch());
    const bool has_sign = type == NumberType::int8 || type == NumberType::int16 || type == NumberType::int32;
    const double bits = 8 * size_of(type) - (has_sign ? 1 : 0);
    const double most = std::exp2(bits) - 1, least = has_sign ? -most - 1 : 0;
    CHECK(number(points, 0, column("range")) == 4);
    CHECK(number(points, 0, column("x")) == std::max(least, -396.0));
    CHECK(number(points, 0, column("object")) == std::min(most, 70'000.0));
    CHECK(number(points, 0, column("part")) == most);
    CHECK(number(points, 0, column("radial_velocity")) == 0);
    CHECK(number(points, 0, column("reflectivity")) == std::min(most, 255.0));
  }
}

TEST_CASE("records have their numbers at the offsets of the layout, scaled, and padding is zero") {
  PointBuffer points(layouts::ouster());
  const TwoEchoes two;
  points(two.batch());
  REQUIRE(points.records().size() == 2 * 48);
  const std::byte* const second = points.records().data() + 48;
  float x = 0;
  std::uint32_t t = 0, range = 0;
  std::memcpy(&x, second, sizeof x);
  std::memcpy(&t, second + 20, sizeof t);
  std::memcpy(&range, second + 32, sizeof range);
  CHECK((x == 21 && t == 3'250'000'000 && range == 20'000));
  for (std::size_t k = 36; k < 48; ++k) CHECK(second[k] == std::byte{});
}

TEST_CASE("many points are stored together as one by one, also of a column of the user's and of attributes") {
  const PointColumn own{"own", "", NumberType::float64, [](const PointView& p) noexcept { return 3 * p.echo.range; },
                        ""};
  PointLayout layout = every_column(NumberType::float32).with({{"own", NumberType::float64, &own, 2}});
  const auto sensor = [](Tick t) { return Pose<frame::Instrument, frame::World>{no_rotation, {t.seconds(), 0, 0}}; };
  for (const bool surfaces : {false, true}) {
    PointSettings settings{.sensor = sensor};
    if (surfaces) settings.surfaces = [](const EchoBatch&, const Shot&, const Echo&) { return std::nullopt; };
    const PointEncoder encoder(layout, settings);
    for (const std::size_t count : {0U, 1U, 31U, 32U, 33U, 200U}) {
      CAPTURE(count);
      std::vector<Shot> shots;
      std::vector<Echo> echoes;
      for (std::uint32_t n = 0; echoes.size() < count; ++n) {
        shots.push_back({.index = n, .tick = {n, 0.5}, .direction = axis::right, .channel = 3});
        shots.back().first_echo = static_cast<std::uint32_t>(echoes.size());
        shots.back().echoes = std::min(n % 4, static_cast<std::uint32_t>(count - echoes.size()));
        for (std::uint32_t k = 0; k < shots.back().echoes; ++k) echoes.push_back({.range = 7.0 * n + k});
      }
      const EchoBatch batch{.shots = shots, .echoes = echoes, .samples = {}};
      std::vector<std::byte> together, each(count * layout.size);
      encoder.encode(batch, together);
      std::byte* record = each.data();
      for (const Shot& shot : shots)
        for (const Echo& echo : batch.echoes_of(shot)) {
          encoder.store(batch, shot, echo, record);
          record += layout.size;
        }
      CHECK(together == each);
    }
  }
}

TEST_CASE("points of a moving sensor are distorted in its frame, unless the distortion is removed") {
  // two pulses ahead, 0.5 s apart, to a wall at y = 50, from a sensor that drives to it at 10 m/s
  const MeshData wall{.vertices = {{-9, 50, -9}, {9, 50, -9}, {9, 50, 9}, {-9, 50, 9}},
                      .triangles = {{0, 1, 2}, {0, 2, 3}}};
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(wall)}});
  const StraightLine path{.from = {5, 0, 1}, .to = {5, 100, 1}, .speed = 10};
  const Platform platform{path, Mount{.lever_arm = {0, 1, 0}},
                          Deflector{FixedBeam{}, Scanner{.pulse_rate = 2, .pulses = 2}}};
  const Survey survey{platform, SingleRay{}, scene, Receiver{}, FirstHit{}};
  PointSettings settings{.sensor = [&](Tick t) { return platform.instrument_at(t); },
                         .axes = PointAxes::forward_left_up};
  const auto forward = [&](std::size_t point) {
    PointBuffer points(every_column(NumberType::float64), settings);
    points.begin_scan({});
    run(survey, {}, points);
    CHECK(std::fabs(number(points, point, column("y"))) < 1e-9);
    CHECK(std::fabs(number(points, point, column("z"))) < 1e-9);
    return number(points, point, column("x"));
  };
  CHECK(forward(0) == doctest::Approx(49));
  CHECK(forward(1) == doctest::Approx(44));
  settings.distortion = MotionDistortion::removed;
  CHECK(forward(0) == doctest::Approx(49));
  CHECK(forward(1) == doctest::Approx(49));
}

TEST_CASE("part, material, normal and velocity of a moving board are in the sensor's axes") {
  const MeshData board{.vertices = {{-9, 20, -9}, {9, 20, -9}, {9, 20, 9}, {-9, 20, 9}},
                       .triangles = {{0, 1, 2}, {0, 2, 3}},
                       .materials = {1, 1}};
  const auto drive = std::make_shared<const PartMotion>(SteadyMotion{.velocity = {2, 0, 0}});
  const auto mesh = std::make_shared<const TriangleMesh<>>(board);
  const MaterialTable paints = material_table({{.name = "red"}, {.name = "green"}});
  const MovingScene<TriangleMesh<>> scene(
      {{.geometry = mesh, .materials = paints, .placement = {.translation = {0, 50, 0}}},
       {.geometry = mesh, .materials = paints, .object = 4, .motion = drive}},
      {.to = 1});
  const Platform platform{Tripod{.heading = -90_deg}, Mount{.boresight = rotation_about(axis::up, -90_deg)},
                          Deflector{FixedBeam{}, Scanner{.pulses = 1}}};
  const Survey survey{platform, SingleRay{}, scene, Receiver{}, FirstHit{}};
  PointBuffer points(every_column(NumberType::float64), {.sensor = [&](Tick t) { return platform.instrument_at(t); },
                                                         .axes = PointAxes::forward_left_up,
                                                         .surfaces = surfaces_of(scene)});
  run(survey, {}, points);
  REQUIRE(points.size() == 1);
  const auto at = [&](const PointColumn* of) { return number(points, 0, of); };
  const Pose<frame::World, frame::Instrument> frame = platform.instrument_at({}).inverse();
  const Vec3 towards = to_forward_left_up(frame.direction({0, -1, 0})),
             along = to_forward_left_up(frame.direction({2, 0, 0}));
  CHECK((at(column("part")) == 1 && at(column("material")) == 1 && at(column("object")) == 4));
  CHECK(length(Vec3{at(column("normal_x")), at(column("normal_y")), at(column("normal_z"))} - towards) < 1e-12);
  CHECK(length(Vec3{at(column("velocity_x")), at(column("velocity_y")), at(column("velocity_z"))} - along) < 1e-12);
}

/// Colours by return number: of the first echo, none of the others.
std::optional<PointColour> of_first(const EchoBatch&, const Shot&, const Echo& echo) {
  if (echo.number != 1) return std::nullopt;
  return PointColour{.red = 65535, .green = 257 * 128, .blue = 257 * 3 + 128, .near_infrared = 13107};
}

TEST_CASE(
    "colours of points are shares of white, numbers of 8 and 16 bits, or packed in one, and unknown ones are NaN or "
    "0") {
  const TwoEchoes two;
  PointBuffer shares(every_column(NumberType::float64), {.colours = of_first});
  shares(two.batch());
  const auto share = [&](const PointColumn* of) { return number(shares, 0, of); };
  CHECK((share(column("red")) == 65535 && share(column("green")) == 257 * 128 && share(column("blue")) == 899 &&
         share(column("near_infrared")) == 13107));
  for (const PointColumn* of : {column("red"), column("green"), column("blue"), column("near_infrared"), column("rgb")})
    CHECK(std::isnan(number(shares, 1, of)));

  const auto check = [&](const std::vector<PointField>& fields, const std::vector<double>& expected) {
    PointBuffer points(PointLayout::packed(fields), {.colours = of_first});
    points(two.batch());
    REQUIRE(fields.size() == expected.size());
    for (std::size_t k = 0; k < fields.size(); ++k) {
      CAPTURE(fields[k].name);
      CHECK(points.number(0, points.layout().fields[k]) == expected[k]);
      CHECK(points.number(1, points.layout().fields[k]) == 0);
    }
  };
  check(layouts::colours(), {255, 128, 3});  // 899 / 257 is 3.498
  check(layouts::deep_colours(), {65535, 32896, 899, 13107});
  check({{"rgba", NumberType::uint32, column("rgb")}}, {0xFF8003});
  PointBuffer packed(PointLayout::packed(layouts::packed_colour()), {.colours = of_first});
  packed(two.batch());
  std::uint32_t bits = 0;
  std::memcpy(&bits, packed.records().data(), sizeof bits);
  CHECK(bits == 0xFF8003);
}

TEST_CASE("every colour of 8 and of 16 bits is written exactly") {
  TwoEchoes two;
  std::uint16_t level = 0;
  const PointSettings settings{
      .colours = [&](const EchoBatch&, const Shot&, const Echo&) { return PointColour{.red = level}; }};
  PointBuffer deep(PointLayout::packed(layouts::deep_colours()), settings),
      bytes(PointLayout::packed(layouts::colours()), settings);
  std::size_t wrong = 0;
  for (std::uint32_t n = 0; n < 65536; ++n) {
    level = static_cast<std::uint16_t>(n);
    deep.begin_scan({});
    deep(two.batch());
    wrong += deep.number(0, deep.layout().fields[0]) != n;
    bytes.begin_scan({});
    bytes(two.batch());
    wrong += bytes.number(0, bytes.layout().fields[0]) != std::round(n / 257.0);
  }
  CHECK(wrong == 0);
}

TEST_CASE("colours are asked for only if the layout has them") {
  int asked = 0;
  const PointSettings settings{.colours = [&](const EchoBatch&, const Shot&, const Echo&) {
    ++asked;
    return std::optional(PointColour{});
  }};
  const TwoEchoes two;
  PointBuffer without(layouts::velodyne().with(layouts::labels()), settings);
  without(two.batch());
  CHECK(asked == 0);
  PointBuffer with(layouts::velodyne().with(layouts::packed_colour()), settings);
  with(two.batch());
  CHECK(asked == 2);
}

TEST_CASE(
    "attributes of a point's object are in the fields of their names, in any type, and NaN or 0 where it has none") {
  std::vector<Scene<TriangleMesh<>>::Part> trees(1);
  trees[0].object = 9;
  trees[0].attributes = pulsecast::attributes({{"age", 80.25}, {"species", 3}});
  const ObjectAttributes attributes{std::span(std::as_const(trees))};
  const TwoEchoes two;
  PointBuffer points(PointLayout::packed({{"species", NumberType::uint8, &attribute_column},
                                          {"object", NumberType::uint32, column("object")},
                                          {"age", NumberType::float64, &attribute_column, 12}}),
                     {.attributes = attributes});
  points(two.batch());
  const auto at = [&](std::size_t point, std::size_t field) {
    return points.number(point, points.layout().fields[field]);
  };
  CHECK((at(0, 0) == 3 && at(0, 1) == 9 && at(0, 2) == 963));
  CHECK((at(1, 0) == 0 && at(1, 1) == 0 && std::isnan(at(1, 2))));

  PointBuffer all(layouts::map().with(layouts::attributes(attributes.names())), {.attributes = attributes});
  all(two.batch());
  CHECK((all.number(0, all.layout().fields[10]) == 80.25 && all.number(0, all.layout().fields[11]) == 3));
}

TEST_CASE("a field of an attribute that no object has is refused") {
  const std::vector<std::string> names{"height"};
  CHECK_THROWS_WITH_AS(PointBuffer(layouts::map().with(layouts::attributes(names))), doctest::Contains("'height'"),
                       SettingError);
}

TEST_CASE("a buffer that has grown keeps its memory for further scans") {
  const TwoEchoes two;
  PointBuffer points(layouts::velodyne().with(layouts::labels()));
  points(two.batch());
  const std::byte* const memory = points.records().data();
  for (int scan = 0; scan < 100; ++scan) {
    points.begin_scan({scan, 0});
    points(two.batch());
  }
  CHECK(points.records().data() == memory);
  CHECK(points.size() == 2);
}

TEST_CASE("settings out of range are refused") {
  CHECK_THROWS_AS(PointBuffer{PointLayout{}}, SettingError);
  CHECK_THROWS_WITH_AS(PointBuffer(layouts::map(), {.start_time = std::numeric_limits<double>::infinity()}),
                       doctest::Contains("PointSettings::start_time"), SettingError);
}

TEST_CASE("the covariance of a point turns with its axes, and is NaN where it is unknown") {
  const PointUncertainty stated{.random = {.xx = 1, .yy = 2, .zz = 3}, .systematic = {.xx = 4, .xy = 5}, .flags = 2};
  const Shot shot{.direction = axis::forward, .echoes = 1};
  const Echo echo{.range = 10};
  const EchoBatch batch{.shots = {&shot, 1}, .echoes = {&echo, 1}, .samples = {}};
  const auto record_of = [&](const PointSettings& settings) {
    const PointLayout layout =
        PointLayout::packed(layouts::uncertainty()).with(layouts::columns({column("systematic_variance_y")}));
    PointBuffer buffer(layout, settings);
    buffer(batch);
    std::vector<double> numbers;
    for (const PointField& field : layout.fields) numbers.push_back(buffer.number(0, field));
    return numbers;
  };
  PointSettings settings;
  CHECK(record_of(settings).back() != record_of(settings).back());
  CHECK(record_of(settings)[6] == 255);
  settings.uncertainty = [&](const Shot&, const Echo&) { return stated; };
  CHECK(record_of(settings) == std::vector<double>{5, 2, 3, 5, 0, 0, 2, 0});
  settings.axes = PointAxes::forward_left_up;  // x is the former y, y the former -x
  CHECK(record_of(settings) == std::vector<double>{2, 5, 3, -5, 0, 0, 2, 4});
  settings.sensor = [](Tick) {
    return Pose<frame::Instrument, frame::World>{rotation_about(axis::up, 90 * pi / 180), {}};
  };
  const std::vector<double> turned = record_of(settings);
  CHECK(turned[0] == doctest::Approx(5));
  CHECK(turned[3] == doctest::Approx(5));
}

/// Adds a shot with an echo at a range.
void add_shot(PointBuffer& points, const Shot& shot, double range) {
  const std::array<Echo, 2> echoes{{{.range = range, .reflectance = 0.5}, {.range = range + 1, .number = 2}}};
  points({.shots = {&shot, 1}, .echoes = std::span(echoes).first(shot.echoes), .samples = {}});
}

TEST_CASE("a grid has rings by columns, the first echo of a pulse, and NaN or 0 without one") {
  const PointLayout layout = PointLayout::packed({{"range", NumberType::float32, column("range")},
                                                  {"ring", NumberType::uint16, column("ring")},
                                                  {"time", NumberType::float64, column("time")}});
  PointBuffer points(layout, {.rings = {1, 0}}, {.rows = 2, .columns = 3, .column_rate = 10});
  const auto range = [&](std::size_t i) { return points.number(i, layout.fields[0]); };
  CHECK((points.size() == 6 && std::isnan(range(0)) && points.number(5, layout.fields[1]) == 0));
  for (const double start : {0.0, 7.0}) {
    CAPTURE(start);
    points.begin_scan(Tick::of_seconds(start));
    const auto tick = [&](double time) { return Tick::of_seconds(start) + Tick::of_seconds(time); };
    add_shot(points, {.tick = tick(0.0), .direction = axis::forward, .channel = 0, .echoes = 1}, 10);
    add_shot(points, {.tick = tick(0.25), .direction = axis::forward, .channel = 1, .echoes = 2}, 20);
    add_shot(points, {.tick = tick(0.15), .direction = axis::forward, .channel = 1, .echoes = 0}, 30);
    CHECK(points.size() == 6);
    for (const std::size_t miss : {0U, 1U, 4U, 5U}) {
      CHECK((std::isnan(range(miss)) && std::isnan(points.number(miss, layout.fields[2]))));
      CHECK(points.number(miss, layout.fields[1]) == 0);
    }
    CHECK((range(3) == 10 && points.number(3, layout.fields[1]) == 1));
    CHECK((range(2) == 20 && points.number(2, layout.fields[2]) == 0.25));
  }
  CHECK(points.echoes_left_out() == 2);
  add_shot(points, {.tick = {7, 0.3}, .direction = axis::forward, .channel = 0, .echoes = 1}, 10);   // no column
  add_shot(points, {.tick = {6, 0.95}, .direction = axis::forward, .channel = 0, .echoes = 1}, 10);  // nor before
  add_shot(points, {.tick = {7, 0.1}, .direction = axis::forward, .channel = 2, .echoes = 1}, 10);   // no row
  CHECK(points.echoes_left_out() == 5);
  add_shot(points, {.tick = {7, 0.01}, .direction = axis::forward, .channel = 0, .echoes = 2}, 90);  // a taken place
  CHECK(points.echoes_left_out() == 7);
  CHECK((range(3) == 10 && std::isnan(range(0)) && std::isnan(range(5))));
}

TEST_CASE("each firing of any rate, delay and scan has a place of its own") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double rate = any.log_uniform(10, 1e5), delay = any.coin() ? 0 : any.uniform(0, 0.9 / rate);
    const std::uint64_t first = any.whole(1'000'000'000);
    const auto columns = static_cast<std::uint32_t>(1 + any.whole(2000));
    PointBuffer points(layouts::xyzi(), {}, {.rows = 2, .columns = columns, .column_rate = rate});
    points.begin_scan(Tick::of(first, rate));
    for (std::uint64_t i = 0; i < columns; ++i)
      for (std::uint16_t ring = 0; ring < 2; ++ring)
        add_shot(points,
                 {.tick = Tick::of(first + i, rate) + Tick::of_seconds(ring * delay),
                  .direction = axis::forward,
                  .channel = ring,
                  .echoes = 1},
                 static_cast<double>(1 + i + ring * columns));
    for (std::size_t i = 0; i < points.size(); ++i)
      REQUIRE(points.number(i, points.layout().fields[1]) == static_cast<double>(i + 1));
    CHECK(points.echoes_left_out() == 0);
  }
}

TEST_CASE("without a rate, pulses fill a grid row by row, at one time or at any") {
  PointBuffer points(layouts::xyzi(), {}, {.rows = 3, .columns = 4});
  points.begin_scan({1, 0});
  for (PulseIndex i = 0; i < 12; ++i)
    add_shot(points, {.index = 120 + i, .tick = {1, 0}, .direction = axis::forward, .echoes = 1},
             1.0 + static_cast<double>(i));
  for (std::size_t i = 0; i < 12; ++i) CHECK(points.number(i, points.layout().fields[1]) == static_cast<double>(1 + i));
}

TEST_CASE("a grid allocates nothing after it is made, and grids out of range are refused") {
  PointBuffer points(layouts::ouster(), {}, {.rows = 64, .columns = 100, .column_rate = 1000});
  const std::size_t before = support::allocations;
  for (int scan = 0; scan < 3; ++scan) {
    points.begin_scan({scan, 0});
    for (PulseIndex i = 0; i < 100; ++i)
      add_shot(points, {.tick = Tick{scan, 0} + Tick::of(i, 1000), .direction = axis::forward, .echoes = 1}, 5);
  }
  CHECK(support::allocations == before);
  CHECK_THROWS_WITH_AS(PointBuffer(layouts::xyzi(), {}, {.rows = 1}), doctest::Contains("PointGrid::columns"),
                       SettingError);
  CHECK_THROWS_AS(PointBuffer(layouts::xyzi(), {}, {.rows = 100'000, .columns = 100'000}), SettingError);
  CHECK_THROWS_AS(PointBuffer(layouts::xyzi(), {}, {.rows = 1, .columns = 1, .column_rate = -1}), SettingError);
  CHECK_THROWS_AS(PointBuffer(layouts::xyzi(), {}, {.rows = 1, .columns = 1, .column_rate = std::nan("")}),
                  SettingError);
}

}  // namespace
}  // namespace pulsecast::io
