// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/page/detail/columns.hpp>

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <zlib.h>

#include <pulsecast/base/random.hpp>

using namespace pulsecast;
using namespace pulsecast::page;

namespace {

struct Decoded {
  std::string text;
  std::map<std::string, std::vector<double>> columns;
};

/// What stands behind "KEY": in a piece of JSON, up to a comma or brace.
std::string field(const std::string& text, const std::string& key) {
  const auto at = text.find("\"" + key + "\":");
  if (at == std::string::npos) return "";
  const auto from = at + key.size() + 3;
  return text.substr(from, text.find_first_of(text[from] == '[' ? "]" : ",}", from) - from);
}

/// Reads columns as their description says, by other means than the page's.
Decoded decoded(const std::string& bytes, std::size_t count) {
  const auto byte = [&](std::size_t i) { return std::size_t{static_cast<unsigned char>(bytes[i])}; };
  const std::size_t size = byte(0) | byte(1) << 8 | byte(2) << 16;
  Decoded out{bytes.substr(4, size), {}};
  CHECK(field(out.text, "count") == std::to_string(count));
  std::vector<Bytef> planes(count * 100 + 100);
  z_stream stream{};
  REQUIRE(inflateInit2(&stream, -15) == Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + 4 + size));
  stream.avail_in = static_cast<uInt>(bytes.size() - 4 - size);
  stream.next_out = planes.data();
  stream.avail_out = static_cast<uInt>(planes.size());
  CHECK(inflate(&stream, Z_FINISH) == Z_STREAM_END);
  CHECK(stream.avail_in == 0);
  const std::size_t whole = stream.total_out;
  inflateEnd(&stream);
  std::size_t plane = 0;
  for (auto at = out.text.find("{\"name\""); at != std::string::npos; at = out.text.find("{\"name\"", at + 1)) {
    const std::string column = out.text.substr(at, out.text.find('}', at) + 1 - at), kind = field(column, "kind");
    const std::string name = field(column, "name").substr(1, field(column, "name").size() - 2);
    const std::size_t planes_of = std::stoul(field(column, "planes"));
    const bool differences = field(column, "differences") == "true";
    const bool scaled = kind == "\"linear\"" || kind == "\"logarithmic\"";
    const double offset = scaled ? std::stod(field(column, "offset")) : 0,
                 step = scaled ? std::stod(field(column, "step")) : 0;
    const std::string per_pulse = field(column, "per_pulse");
    const double each = per_pulse.empty() ? 0 : std::stod(per_pulse);
    std::vector<double> listed;
    if (kind == "\"listed\"") {
      std::istringstream list(field(column, "values").substr(1));
      for (std::string one; std::getline(list, one, ',');) listed.push_back(std::stod(one));
    }
    std::vector<double>& values = out.columns[name];
    std::int64_t before = 0;
    for (std::size_t i = 0; i < count; ++i) {
      std::uint64_t code = 0;
      for (std::size_t k = 0; k < planes_of; ++k) code |= std::uint64_t{planes[(plane + k) * count + i]} << 8 * k;
      auto now = static_cast<std::int64_t>(code);
      if (differences)
        now = before += code % 2 == 1 ? -static_cast<std::int64_t>(code / 2) - 1 : static_cast<std::int64_t>(code / 2);
      double value = std::numeric_limits<double>::quiet_NaN();
      if (now > 0 && kind == "\"linear\"") value = offset + static_cast<double>(now - 1) * step;
      if (now > 0 && kind == "\"logarithmic\"") value = offset * std::exp(static_cast<double>(now - 1) * step);
      if (now > 0 && kind == "\"listed\"") value = listed.at(static_cast<std::size_t>(now - 1));
      if (each != 0) value += each * out.columns["pulse"][i];
      values.push_back(value);
    }
    plane += planes_of;
  }
  CHECK(plane * count == whole);
  return out;
}

/// Point with its columns, as the test makes them up.
struct Known : PagePoint {
  float amplitude = 0, reflectance = 0, width = 0, incidence = 0, scan_angle = 0;
  ObjectId object = 0;
  std::uint16_t classification = 0, leg = 0;
  std::uint8_t number = 1, returns = 1;
  std::uint16_t channel = 0;
  ReflectionKind kind = ReflectionKind::surface;
  std::optional<std::uint32_t> colour{};
};

/// Points of a page that hold these.
PagePoints kept(const std::vector<Known>& all, bool colours = false) {
  PagePoints page(columns_of_page(colours, {}));
  page.points.assign(all.begin(), all.end());
  page.records.resize(all.size() * page.layout.size);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Known& p = all[i];
    const std::map<std::string, double> values{
        {"return_number", p.number},
        {"returns", p.returns},
        {"leg", p.leg},
        {"channel", p.channel},
        {"scan_angle", p.scan_angle},
        {"object", p.object},
        {"class", p.classification},
        {"reflectance", p.reflectance},
        {"amplitude", p.amplitude},
        {"incidence", p.incidence},
        {"kind", static_cast<int>(p.kind)},
        {"width", p.width},
        {"colour", p.colour ? *p.colour : std::numeric_limits<double>::quiet_NaN()}};
    for (const io::PointField& field : page.layout.fields)
      io::detail::visit_number_type(field.type, [&]<class Number>() {
        io::detail::store_number<Number>(values.at(field.name),
                                         page.records.data() + i * page.layout.size + field.offset);
      });
  }
  return page;
}

std::vector<Known> random_points(std::size_t n, std::uint64_t seed) {
  std::vector<Known> points;
  PulseIndex pulse = 1'000'000'000'000;
  for (std::size_t i = 0; i < n; ++i) {
    std::uint32_t k = 0;
    const auto draw = [&] { return uniform({.seed = seed, .pulse = i, .subray = k++}); };
    const auto real = [&](double most) { return static_cast<float>(most * draw()); };
    pulse += static_cast<PulseIndex>(5 * draw());
    points.push_back({{.position = {477000 + 900 * draw(), 5429000 + 500 * draw(), 100 * draw() - 20},
                       .time = static_cast<double>(pulse - 1'000'000'000'000) / 300e3 + 1234,
                       .pulse = pulse,
                       .to_instrument = {real(30), real(30), real(500)},
                       .key = static_cast<std::uint32_t>(4e9 * draw())},
                      std::pow(10.0f, -9 + real(6)),
                      real(1.2),
                      real(5e-9),
                      real(1.57),
                      real(1) - 0.5f,
                      static_cast<ObjectId>(4e9 * draw()),
                      static_cast<std::uint16_t>(65535 * draw()),
                      static_cast<std::uint16_t>(3 * draw()),
                      static_cast<std::uint8_t>(1 + 4 * draw()),
                      static_cast<std::uint8_t>(5 + 200 * draw()),
                      static_cast<std::uint8_t>(16 * draw()),
                      static_cast<ReflectionKind>(reflection_kind_count * draw())});
  }
  return points;
}

}  // namespace

TEST_CASE("every attribute is read back, right to half its step") {
  const auto points = random_points(3000, 1);
  const Decoded all = decoded(page_columns(kept(points), {.keys = true}), points.size());
  const double step = 0.01;  // of 900 m, 2^17 steps of 5 mm are too few
  CHECK(field(all.text, "step") == "0.01");
  std::size_t wrong = 0;
  const auto check = [&](const char* name, std::size_t i, double expected, double error) {
    const double found = all.columns.at(name)[i];
    if (std::abs(found - expected) <= error) return;
    if (++wrong < 5) FAIL_CHECK("point " << i << ", " << name << " is " << found << ", not " << expected);
  };
  constexpr double rounding = 1e-9;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Known& p = points[i];
    check("x", i, p.position.x, step / 2 + rounding);
    check("y", i, p.position.y, step / 2 + rounding);
    check("z", i, p.position.z, step / 2 + rounding);
    check("from_x", i, p.position.x + static_cast<double>(p.to_instrument[0]), step / 2 + rounding);
    check("from_z", i, p.position.z + static_cast<double>(p.to_instrument[2]), step / 2 + rounding);
    check("time", i, p.time, 0.5e-7 + 1e-9);
    check("pulse", i, static_cast<double>(p.pulse), 0);
    check("return_number", i, p.number, 0);
    check("returns", i, p.returns, 0);
    check("leg", i, p.leg, 0);
    check("channel", i, p.channel, 0);
    check("object", i, p.object, 0);
    check("class", i, p.classification, 0);
    check("kind", i, static_cast<double>(p.kind), 0);
    check("key", i, p.key, 0);
    check("reflectance", i, static_cast<double>(p.reflectance), 0.001 + rounding);
    check("amplitude", i, static_cast<double>(p.amplitude), 0.0101 * static_cast<double>(p.amplitude));
    check("incidence", i, static_cast<double>(p.incidence) * 180 / pi, 0.25 + rounding);
    check("scan_angle", i, static_cast<double>(p.scan_angle) * 180 / pi, 0.025 + rounding);
    check("width", i, static_cast<double>(p.width) * 1e9, 0.0005 + rounding);
  }
  CHECK(wrong == 0);
}

TEST_CASE("what has no value is told as such") {
  auto points = random_points(4, 2);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  points[1].amplitude = 0;
  points[2].amplitude = nan;
  points[1].width = nan;
  points[2].reflectance = std::numeric_limits<float>::infinity();
  const Decoded all = decoded(page_columns(kept(points)), 4);
  CHECK(std::isnan(all.columns.at("amplitude")[1]));
  CHECK(std::isnan(all.columns.at("amplitude")[2]));
  CHECK(std::isnan(all.columns.at("width")[1]));
  CHECK(std::isnan(all.columns.at("reflectance")[2]));
  CHECK(std::isfinite(all.columns.at("amplitude")[3]));
  CHECK(std::isfinite(all.columns.at("width")[3]));
}

TEST_CASE("widths, kinds of light and keys are left out unless they are wanted") {
  auto points = random_points(10, 3);
  for (Known& p : points) {
    p.width = 0;
    p.kind = ReflectionKind::surface;
  }
  const Decoded all = decoded(page_columns(kept(points)), 10);
  CHECK_FALSE(all.columns.contains("width"));
  CHECK_FALSE(all.columns.contains("kind"));
  CHECK_FALSE(all.columns.contains("key"));
}

TEST_CASE("colours are told to the bit, those that are unknown as such, and none are told of a cloud without") {
  auto points = random_points(3000, 8);
  CHECK_FALSE(decoded(page_columns(kept(points)), points.size()).columns.contains("colour"));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto draw = [&](std::uint32_t k) {
      return static_cast<std::uint8_t>(256 * uniform({.seed = 9, .pulse = i, .subray = k}));
    };
    if (i % 5 != 0) points[i].colour = std::uint32_t{draw(0)} << 16 | std::uint32_t{draw(1)} << 8 | draw(2);
  }
  points[1].colour = 0xFFFFFF;
  points[2].colour = 0;
  const std::vector<double> found = decoded(page_columns(kept(points, true)), points.size()).columns.at("colour");
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    wrong += points[i].colour ? found[i] != *points[i].colour : !std::isnan(found[i]);
  CHECK(wrong == 0);
  CHECK((found[1] == 0xFFFFFF && found[2] == 0));
}

TEST_CASE("no points, one point, and points far away can be told") {
  CHECK(decoded(page_columns(PagePoints()), 0).columns.at("x").empty());
  auto points = random_points(1, 4);
  CHECK(decoded(page_columns(kept(points)), 1).columns.at("pulse")[0] ==
        1e12 + static_cast<double>(points[0].pulse - 1'000'000'000'000));
  points = random_points(3, 5);
  points[0].position = {1e300, 1e300, -1e300};
  CHECK(decoded(page_columns(kept(points)), 3).columns.at("leg")[1] == points[1].leg);
}

TEST_CASE("the step of coordinates suits the extent") {
  CHECK(page_step(0) == 1e-4);
  CHECK(page_step(13) == 1e-4);
  CHECK(page_step(100) == 1e-3);
  CHECK(page_step(131.072) == 1e-3);
  CHECK(page_step(131.08) == 2e-3);
  CHECK(page_step(1000) == doctest::Approx(1e-2));
  CHECK(page_step(1e7) == doctest::Approx(1e2));
  CHECK_THROWS_AS(static_cast<void>(page_columns(PagePoints(), {.position_step = -1})), SettingError);
  CHECK_THROWS_AS(static_cast<void>(page_columns(PagePoints(), {.effort = 0})), SettingError);
}

TEST_CASE("a scan line takes few bytes") {
  std::vector<Known> points;
  for (std::size_t i = 0; i < 100'000; ++i) {
    const double t = static_cast<double>(i) / 300e3;
    const auto noise = [i](std::uint32_t k) { return uniform({.seed = 6, .pulse = i, .subray = k}); };
    Known point{{.position = {20 * std::sin(300 * t), 60 * t, 0.02 * noise(0)},
                 .time = t,
                 .pulse = i,
                 .to_instrument = {0, 0, 400}}};
    point.amplitude = 1e-6f + 1e-7f * static_cast<float>(noise(1));
    point.reflectance = 0.3f + 0.1f * static_cast<float>(noise(2));
    point.incidence = 0.1f * static_cast<float>(noise(3));
    points.push_back(point);
  }
  const double bytes = static_cast<double>(page_columns(kept(points)).size()) / 100'000;
  MESSAGE(bytes, " bytes a point");
  CHECK(bytes < 9);  // 12 as base64
}

TEST_CASE("base64 is that of its standard") {  // source: RFC 4648, section 10
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foob") == "Zm9vYg==");
  CHECK(base64("fooba") == "Zm9vYmE=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64("\xfb\xff") == "+/8=");
}
