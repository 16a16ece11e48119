// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/las.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/full_waveform.hpp>

#include "support/detect.hpp"
#include "support/every_column.hpp"
#include "support/generators.hpp"
#include "support/las_reader.hpp"
#include "support/relative.hpp"
#include "support/temporary_folder.hpp"
#include "support/wdp_reader.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::Generator;
using support::las_real;
using support::las_whole;
using support::LasFile;
using support::LasPoint;
using support::read_las;
using support::TemporaryFolder;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Pulses and what came back, to be handed over in batches of any size.
struct Survey {
  std::vector<Shot> shots;
  std::vector<Echo> echoes;
  std::vector<float> samples{};
  static constexpr double interval = 0.25e-9;  ///< of the samples [s]

  [[nodiscard]] EchoBatch batch() const { return {shots, echoes, samples, interval}; }

  /// A pulse straight down from each point, which it meets at range 0.
  static Survey of_points(const std::vector<Vec3>& points) {
    Survey survey;
    for (const Vec3& point : points) survey.add({.origin = point, .direction = {0, 0, -1}}, {Echo{.range = 0}});
    return survey;
  }

  static Survey random(std::uint64_t seed, std::size_t pulses, double reach) {
    Generator random(seed);
    Survey survey;
    const Vec3 origin = random.point(reach);
    for (std::size_t i = 0; i < pulses; ++i) {
      std::vector<Echo> echoes(random.coin() ? 0 : random.whole(20));
      std::uint8_t number = 0;
      for (Echo& echo : echoes) {
        echo.range = random.log_uniform(1, 1e4);
        echo.amplitude = random.log_uniform(1e-13, 1);
        echo.reflectance = random.log_uniform(1e-3, 3);
        echo.width = random.log_uniform(1e-10, 1e-7);
        echo.object = static_cast<ObjectId>(random.whole(std::uint64_t{1} << 32));
        echo.classification = static_cast<std::uint16_t>(random.whole(400));
        echo.number = ++number;
        echo.kind = static_cast<ReflectionKind>(random.whole(reflection_kind_count));
      }
      survey.add({.index = random.whole(std::uint64_t{1} << 52) << 12 | i,
                  .tick = Tick::of(i, 2e6),
                  .origin = origin + random.point(100),
                  .direction = random.unit(),
                  .scan_angle = random.uniform(-pi, pi),
                  .leg = static_cast<std::uint16_t>(random.whole(65536)),
                  .channel = static_cast<std::uint16_t>(random.whole(400))},
                 echoes);
    }
    return survey;
  }

  /// The same with a waveform of random length to each second pulse or so, with or without echoes.
  static Survey random_with_waveforms(std::uint64_t seed, std::size_t pulses, double reach) {
    Survey survey = random(seed, pulses, reach);
    Generator random(seed + 500);
    for (Shot& shot : survey.shots) {
      if (random.coin()) continue;
      shot.first_sample = survey.samples.size();
      shot.samples = static_cast<std::uint32_t>(random.log_uniform(1, 500));
      const auto echoes = survey.batch().echoes_of(shot);
      shot.waveform_start = echoes.empty() ? 1e-6 : 2 * echoes[0].range / speed_of_light - random.uniform(0, 1e-8);
      const double peak = random.log_uniform(1e-11, 1e-3);
      for (std::uint32_t i = 0; i < shot.samples; ++i)
        survey.samples.push_back(static_cast<float>(peak * random.uniform()));
    }
    return survey;
  }

  void add(Shot shot, const std::vector<Echo>& with, const std::vector<float>& waveform = {}) {
    shot.first_echo = static_cast<std::uint32_t>(echoes.size());
    shot.echoes = static_cast<std::uint32_t>(with.size());
    shot.first_sample = samples.size();
    shot.samples = static_cast<std::uint32_t>(waveform.size());
    samples.insert(samples.end(), waveform.begin(), waveform.end());
    shots.push_back(shot);
    echoes.insert(echoes.end(), with.begin(), with.end());
  }

  /// The pulses from `first` on, at most `count`, as a batch of their own.
  [[nodiscard]] Survey part(std::size_t first, std::size_t count) const {
    Survey part;
    for (std::size_t i = first; i < std::min(first + count, shots.size()); ++i) {
      const auto of_shot = batch().echoes_of(shots[i]);
      const auto waveform = batch().waveform_of(shots[i]);
      part.add(shots[i], {of_shot.begin(), of_shot.end()}, {waveform.begin(), waveform.end()});
    }
    return part;
  }

  void write(const std::filesystem::path& path, const LasSettings& settings, std::size_t pulses_at_once) const {
    LasWriter writer(path, settings);
    for (std::size_t first = 0; first < shots.size(); first += pulses_at_once) {
      const Survey some = part(first, pulses_at_once);
      writer(some.batch());
    }
    writer.close();
  }

  [[nodiscard]] LasFile written(const LasSettings& settings = {}) const {
    const TemporaryFolder folder;
    write(folder / "points.las", settings, 1000);
    return read_las(folder / "points.las");
  }
};

/// The one point that is made of an echo of a pulse.
struct One {
  LasFile file;
  LasPoint point;
};
One one(const Shot& shot, const Echo& echo, const LasSettings& settings = {}) {
  Survey survey;
  survey.add(shot, {echo});
  LasFile file = survey.written(settings);
  REQUIRE(file.points.size() == 1);
  return {file, file.points[0]};
}

TEST_CASE("the header says who wrote the file and how, and nothing of the day unless told") {
  LasFile file = Survey::of_points({{1, 2, 3}}).written();
  CHECK(file.software == "pulsecast " PULSECAST_VERSION);
  CHECK(file.system == "simulation");
  CHECK(file.global_encoding == 17);
  CHECK((file.day == 0 && file.year == 0));
  CHECK(file.scale == std::array{1e-4, 1e-4, 1e-4});
  CHECK(file.wkt.empty());

  using namespace std::chrono_literals;
  file = Survey::of_points({{1, 2, 3}}).written({.gps_time = GpsTime::week, .created = 2026y / 1 / 1});
  CHECK(file.global_encoding == 16);
  CHECK((file.day == 1 && file.year == 2026));
  file = Survey::of_points({{1, 2, 3}}).written({.created = 2024y / 12 / 31});
  CHECK((file.day == 366 && file.year == 2024));
}

TEST_CASE("the values beyond the standard ones are named and described") {
  const LasFile file = Survey{}.written();
  std::string all;
  for (const auto& extra : file.extras)
    all += extra.name + ' ' + std::to_string(extra.type) + ' ' + extra.description + '\n';
  CHECK(all ==
        "Range 10 from the instrument [m]\n"
        "Amplitude 9 received power at peak [dB]\n"
        "Reflectance 9 re white Lambertian target [dB]\n"
        "EchoWidth 9 standard deviation in time [ns]\n"
        "PulseIndex 7 number of the pulse, from 0\n"
        "ObjectId 5 number of the object met\n");
  CHECK(Survey{}.written({.light_kinds = true}).extras.back().name == "LightKind");
}

/// Part of a scene, as far as attributes are asked for.
struct Tree {
  ObjectId object = 0;
  Attributes attributes{};
};

std::shared_ptr<const ObjectAttributes> attributes_of(const std::vector<Tree>& trees) {
  return std::make_shared<const ObjectAttributes>(std::span<const Tree>(trees));
}

TEST_CASE("colours make point format 7, with near infrared 8; an unknown colour is black, and all else is as without") {
  const Survey survey = Survey::random(7, 200, 1e3);
  const LasFile without = survey.written({.light_kinds = true});
  for (const bool near_infrared : {false, true}) {
    const LasFile file =
        survey.written({.light_kinds = true,
                        .colours = [](const EchoBatch&, const Shot&, const Echo& echo) -> std::optional<PointColour> {
                          if (echo.object % 2 == 0) return std::nullopt;
                          const auto low = static_cast<std::uint16_t>(echo.object);
                          return PointColour{low, 65535, echo.number, static_cast<std::uint16_t>(echo.object >> 16)};
                        },
                        .near_infrared = near_infrared});
    CHECK(file.format == (near_infrared ? 8 : 7));
    CHECK(file.global_encoding == 17);
    REQUIRE(file.points.size() == without.points.size());
    for (std::size_t i = 0; i < file.points.size(); ++i) {
      const LasPoint &p = file.points[i], &q = without.points[i];
      const auto object = static_cast<unsigned>(las_whole(file, p, "ObjectId"));
      const unsigned number = static_cast<unsigned>(survey.echoes[i].number);
      const std::array<unsigned, 4> known{object & 65535, 65535, number, near_infrared ? object >> 16 : 0};
      CHECK((p.colour == (object % 2 == 0 ? std::array<unsigned, 4>{} : known)));
      CHECK(p.bytes.substr(0, 30) == q.bytes.substr(0, 30));
      CHECK(p.bytes.substr(near_infrared ? 38 : 36) == q.bytes.substr(30));
    }
  }
}

TEST_CASE("attributes of objects follow the other extra values, by the object of the echo; NaN where unknown") {
  const std::string long_name(40, 'n'),
      umlaut = std::string(30, 'u') + "\u00e4";  // cut within a character of two bytes
  const auto known = attributes_of(
      {{3, attributes({{"age", 80}, {long_name, -1.5}})}, {5, attributes({{"age", 12}, {umlaut, 1e300}})}});
  for (const LasSettings& settings :
       {LasSettings{.attributes = known}, LasSettings{.waveforms = true, .light_kinds = true, .attributes = known},
        LasSettings{.format = LasFormat::las_1_0, .attributes = known}}) {
    Survey survey;
    for (const ObjectId object : {3U, 4U, 5U})
      survey.add({.direction = {0, 0, 1}}, {Echo{.range = 1, .object = object}});
    const LasFile file = survey.written(settings);
    REQUIRE(file.points.size() == 3);
    REQUIRE(file.extras.size() == (settings.light_kinds ? 10 : 9));
    const std::string n(31, 'n'), u(30, 'u');
    CHECK((file.extras.end() - 2)->name == n);
    CHECK(file.extras.back().name == u);
    CHECK(file.extras.back().description == "attribute of the object met");
    CHECK(las_real(file, file.points[0], "age") == 80);
    CHECK(las_real(file, file.points[0], n) == -1.5);
    CHECK(std::isnan(las_real(file, file.points[0], u)));
    for (const std::string& name : {std::string("age"), n, u}) CHECK(std::isnan(las_real(file, file.points[1], name)));
    CHECK(las_real(file, file.points[2], "age") == 12);
    CHECK(las_real(file, file.points[2], u) == 1e300);
  }
}

TEST_CASE("every column of the table is an extra value of its type, name and unit") {
  const support::EveryColumn all;
  const TemporaryFolder folder;
  LasWriter writer(folder / "points.las", {.columns = all.fields, .points = all.settings});
  writer(all.batch());
  writer.close();
  const LasFile file = read_las(folder / "points.las");
  REQUIRE(file.points.size() == 2);
  CHECK(file.extras.size() == 6 + point_columns.size());
  const PointBuffer expected = all.records();
  const std::size_t begin = file.extra("x").offset, size = expected.layout().size;
  CHECK(file.points[0].bytes.substr(begin) + file.points[1].bytes.substr(begin) == all.bytes(expected));
  for (const PointField& field : expected.layout().fields) {
    CAPTURE(field.name);
    constexpr std::array types{0, 2, 1, 4, 3, 6, 5, 9, 10, 8, 7};  // by NumberType
    const support::LasExtraField& extra = file.extra(field.name);
    CHECK(extra.offset == begin + field.offset);
    CHECK(extra.type == types[static_cast<std::size_t>(field.type)]);
    CHECK(extra.description.starts_with(field.column->description));
    if (!field.column->unit.empty()) CHECK(extra.description.ends_with("[" + std::string(field.column->unit) + "]"));
  }
  CHECK(file.points[0].bytes.size() == begin + size);
}

TEST_CASE("colours that the format has no room for, and names of attributes that cannot be told apart, are refused") {
  const TemporaryFolder folder;
  const auto refused = [&](const LasSettings& settings, const char* part) {
    CHECK_THROWS_WITH_AS(LasWriter(folder / "points.las", settings), doctest::Contains(part), SettingError);
  };
  const PointColours black = [](const EchoBatch&, const Shot&, const Echo&) { return PointColour{}; };
  refused({.format = LasFormat::las_1_4_legacy, .colours = black}, "LasSettings::colours");
  refused({.format = LasFormat::las_1_0, .colours = black}, "LasSettings::colours");
  refused({.waveforms = true, .colours = black}, "LasSettings::colours");
  refused({.near_infrared = true}, "LasSettings::near_infrared");
  refused({.attributes = attributes_of({{1, attributes({{"Range", 1}})}})}, "'Range'");
  refused({.light_kinds = true, .attributes = attributes_of({{1, attributes({{"LightKind", 1}})}})}, "'LightKind'");
  refused({.attributes = attributes_of({{1, std::make_shared<const std::vector<Attribute>>(1)}})}, "''");
  refused({.attributes =
               attributes_of({{1, attributes({{std::string(31, 'a') + "b", 1}, {std::string(31, 'a') + "c", 2}})}})},
          "aaac'");
  std::vector<Attribute> many;
  for (int i = 0; i < 336; ++i) many.push_back({std::to_string(i), 1});
  refused({.attributes = attributes_of({{1, attributes(many)}})}, "number of extra values");
  CHECK(folder.empty());
  many.pop_back();
  CHECK(Survey::of_points({{1, 2, 3}}).written({.attributes = attributes_of({{1, attributes(many)}})}).extras.size() ==
        341);
}

TEST_CASE("a coordinate reference system is written as given, even the longest that can be") {
  for (const std::string& wkt : {std::string("PROJCS[\"ETRS89 / UTM zone 32N\"]"), std::string(65534, 'x')}) {
    const LasFile file = Survey::of_points({{1, 2, 3}}).written({.wkt = wkt});
    CHECK((file.wkt == wkt));
    CHECK(file.points.size() == 1);
  }
}

TEST_CASE("a code of UTM is written as well-known text, with its zone's meridian") {
  struct Zone {
    std::uint16_t epsg;
    std::string name, datum, meridian, northing;
  };
  for (const Zone& zone : {Zone{32601, "WGS 84 / UTM zone 1N", "WGS_1984", "-177", "0"},
                           {32632, "WGS 84 / UTM zone 32N", "WGS_1984", "9", "0"},
                           {32660, "WGS 84 / UTM zone 60N", "WGS_1984", "177", "0"},
                           {32733, "WGS 84 / UTM zone 33S", "WGS_1984", "15", "10000000"},
                           {25832, "ETRS89 / UTM zone 32N", "European_Terrestrial_Reference_System_1989", "9", "0"},
                           {25838, "ETRS89 / UTM zone 38N", "European_Terrestrial_Reference_System_1989", "45", "0"},
                           {26910, "NAD83 / UTM zone 10N", "North_American_Datum_1983", "-123", "0"}}) {
    CAPTURE(zone.epsg);
    const LasFile file = Survey::of_points({{1, 2, 3}}).written({.epsg = zone.epsg});
    CHECK(file.global_encoding == 17);
    CHECK(file.wkt.starts_with("PROJCS[\"" + zone.name + "\",GEOGCS["));
    for (const std::string& part : {"DATUM[\"" + zone.datum + "\"", "[\"central_meridian\"," + zone.meridian + "]",
                                    "[\"false_northing\"," + zone.northing + "]"})
      CHECK(file.wkt.find(part) != file.wkt.npos);
    CHECK(file.wkt.ends_with("NORTH],AUTHORITY[\"EPSG\",\"" + std::to_string(zone.epsg) + "\"]]"));
    CHECK(std::count(file.wkt.begin(), file.wkt.end(), '[') == std::count(file.wkt.begin(), file.wkt.end(), ']'));
    CHECK(std::count(file.wkt.begin(), file.wkt.end(), '"') % 2 == 0);
  }
}

TEST_CASE("any other code is left out, as formats 6 to 9 have no keys, and the WKT bit is set; text comes first") {
  for (const std::uint16_t epsg :
       {std::uint16_t{2056}, std::uint16_t{25827}, std::uint16_t{25839}, std::uint16_t{32766}}) {
    const LasFile file = Survey::of_points({{1, 2, 3}}).written({.epsg = epsg});
    CHECK(file.keys.empty());
    CHECK(file.global_encoding == 17);
    CHECK(file.wkt.empty());
    CHECK(file.points.size() == 1);
  }
  const LasFile file = Survey::of_points({{1, 2, 3}}).written({.wkt = "LOCAL_CS[]", .epsg = 2056});
  CHECK((file.wkt == "LOCAL_CS[]" && file.keys.empty() && file.global_encoding == 17));
}

TEST_CASE("coordinates, scale, offset and bounds are in units of the reference system, ranges in metres") {
  const double us_foot = 1200.0 / 3937;
  const SpatialReference in{.epsg = 2263, .unit = us_foot, .vertical_unit = 0.3048, .wkt = "LOCAL_CS[]"};
  const Vec3 place{1'000'000.5 * us_foot, 200'000.25 * us_foot, 100.125 * 0.3048};
  const Survey survey = Survey::of_points({place});
  const LasFile file = survey.written({.scale = 1e-3, .reference = in}), metres = survey.written({});
  CHECK((file.scale == std::array<double, 3>{1e-3, 1e-3, 1e-3}));
  CHECK(file.offset[0] == 1'000'000);
  const std::array<double, 3> expected{1'000'000.5, 200'000.25, 100.125};
  for (std::size_t axis = 0; axis < 3; ++axis) CHECK(std::fabs(file.points[0].place[axis] - expected[axis]) < 1e-9);
  CHECK(file.wkt == "LOCAL_CS[]");
  CHECK(file.points[0].bytes.size() == metres.points[0].bytes.size());  // the rest is the same
  CHECK(std::equal(file.points[0].bytes.begin() + 12, file.points[0].bytes.end(), metres.points[0].bytes.begin() + 12));
  CHECK(survey.written({.reference = {.wkt = "LOCAL_CS[]"}}).points[0].stored == metres.points[0].stored);
}

TEST_CASE("GeoTIFF keys of legacy formats have the units, and the vertical system") {
  const auto keys = [](const SpatialReference& in) {
    const LasFile file = Survey::of_points({{1, 2, 3}}).written({.format = LasFormat::las_1_0, .reference = in});
    return file.keys;
  };
  using Keys = std::map<unsigned, unsigned>;
  CHECK(keys({.epsg = 2056}) == Keys{{1024, 1}, {3072, 2056}, {3076, 9001}});
  CHECK(keys({.epsg = 25832, .vertical_epsg = 7837, .wkt = "COMPD_CS[]"}) ==
        Keys{{1024, 1}, {3072, 25832}, {3076, 9001}, {4096, 7837}, {4099, 9001}});
  CHECK(keys({.epsg = 2263, .unit = 0.304800609601219}) ==
        Keys{{1024, 1}, {3072, 2263}, {3076, 9003}, {4099, 9001}});  // heights in metres
  CHECK(keys({.epsg = 2222, .vertical_epsg = 8228, .unit = 0.3048, .vertical_unit = 0.3048}) ==
        Keys{{1024, 1}, {3072, 2222}, {3076, 9002}, {4096, 8228}, {4099, 9002}});
  CHECK(keys({.epsg = 2136, .unit = 0.304799710181509}) ==
        Keys{{1024, 1}, {3072, 2136}, {4099, 9001}});  // the Gold Coast foot
}

TEST_CASE("coordinates are rounded to the nearest step on both sides of zero") {
  const LasFile file =
      Survey::of_points({{0.00014, 0.00016, 0.00024}, {-0.00014, -0.00016, -0.00024}, {0.00004, -0.00004, 0}})
          .written({.offset = Vec3{0, 0, 0}});
  CHECK(file.points[0].stored == std::array<std::int32_t, 3>{1, 2, 2});
  CHECK(file.points[1].stored == std::array<std::int32_t, 3>{-1, -2, -2});
  CHECK(file.points[2].stored == std::array<std::int32_t, 3>{0, 0, 0});
}

TEST_CASE("UTM coordinates keep a tenth of a millimetre, about a round offset") {
  const Vec3 utm{478412.12344, 5429876.98761, 113.4567};
  const LasFile file = Survey::of_points({utm, utm + Vec3{90000, -90000, 900}}).written();
  CHECK(file.offset == std::array{478400.0, 5429900.0, 100.0});
  CHECK(std::fabs(file.points[0].place[0] - 478412.1234) < 1e-8);
  CHECK(std::fabs(file.points[0].place[1] - 5429876.9876) < 1e-8);
  CHECK(std::fabs(file.points[0].place[2] - 113.4567) < 1e-8);
  CHECK(file.min[1] == support::relative(5339876.9876, 1e-14));
  CHECK(file.max[0] == support::relative(568412.1234, 1e-14));
}

TEST_CASE("coordinates use all of 32 bits, and one that needs more is an error that leaves no file") {
  const LasSettings settings{.offset = Vec3{0, 0, 0}};
  const LasFile file = Survey::of_points({{214748.36468, -214748.36482, 0}}).written(settings);
  CHECK(file.points[0].stored[0] == std::numeric_limits<std::int32_t>::max());
  CHECK(file.points[0].stored[1] == std::numeric_limits<std::int32_t>::min());

  const std::vector<Vec3> misfits{{214748.3648, 0, 0}, {0, -214748.36488, 0}, {0, 0, 1e300},
                                  {nan, 0, 0},         {0, infinite, 0},      {0, 0, -infinite}};
  for (const Vec3& misfit : misfits) {
    CAPTURE(misfit.x);
    const TemporaryFolder folder;
    for (const LasSettings& either : {settings, LasSettings{.offset = {}}}) {
      const Survey survey = Survey::of_points({{1, 2, 3}, {4, 5, 6}, misfit});
      LasWriter writer(folder / "points.las", either);
      CHECK_THROWS_WITH_AS(writer(EchoBatch{survey.shots, survey.echoes, {}, 0}),
                           doctest::Contains("does not fit 32 bits"), FileError);
      CHECK_THROWS_AS(writer(EchoBatch{survey.shots, survey.echoes, {}, 0}), FileError);
      CHECK_THROWS_AS(writer.close(), FileError);
    }
    CHECK(folder.empty());
  }
  const TemporaryFolder folder;
  const Survey survey = Survey::of_points({{1, 2, 3}, {1, -3e5, 3}});
  LasWriter writer(folder / "points.las", settings);
  CHECK_THROWS_WITH(
      writer(EchoBatch{survey.shots, survey.echoes, {}, 0}),
      ((folder / "points.las").string() + ", point 2: y is -300000 m, which does not fit 32 bits; expected 0 m +- "
                                          "214748.3647 m (offset, and 2^31 steps of 0.0001 m; a greater scale, by "
                                          "LasSettings::scale or --lasScale, reaches farther)")
          .c_str());
}

TEST_CASE("a first point without a place is an error, too") {
  const TemporaryFolder folder;
  const Survey survey = Survey::of_points({{nan, 2, 3}});
  LasWriter writer(folder / "points.las");
  CHECK_THROWS_WITH_AS(writer(EchoBatch{survey.shots, survey.echoes, {}, 0}),
                       doctest::Contains("expected 0 m +- 214748"), FileError);
  CHECK(folder.empty());
}

TEST_CASE("no points make a good file, with and without pulses") {
  for (const std::size_t pulses : {std::size_t{0}, std::size_t{5}}) {
    const LasFile file = Survey{std::vector<Shot>(pulses), {}}.written({.wkt = "x"});
    CHECK(file.points.empty());
    CHECK(file.min == std::array{0.0, 0.0, 0.0});
    CHECK(file.max == std::array{0.0, 0.0, 0.0});
    CHECK(file.wkt == "x");
  }
}

TEST_CASE("from the fifteenth on, returns are written as the fifteenth of fifteen") {
  Survey survey;
  std::vector<Echo> echoes(20);
  for (std::uint8_t n = 1; n <= 20; ++n) {
    echoes[n - 1U].number = n;
    echoes[n - 1U].range = n;
  }
  survey.add({.direction = {0, 0, 1}}, echoes);
  const LasFile file = survey.written();
  REQUIRE(file.points.size() == 20);
  for (std::size_t i = 0; i < 20; ++i) {
    CHECK(file.points[i].return_number == std::min<std::size_t>(i + 1, 15));
    CHECK(file.points[i].returns == 15);
    CHECK(las_real(file, file.points[i], "Range") == static_cast<double>(i + 1));
  }
  CHECK(file.by_return == std::array<std::uint64_t, 15>{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 6});
}

TEST_CASE("what is more than a field can hold is cut, and nothing at all has a level of -200 dB") {
  const Shot shot{.direction = {0, 0, -1}, .leg = 65535};
  auto [file, p] = one(shot, {.range = 1, .amplitude = 0, .reflectance = 0, .classification = 256});
  CHECK(p.intensity == 0);
  CHECK(p.classification == 255);
  CHECK(p.source == 65535);
  CHECK(las_real(file, p, "Amplitude") == -200);
  CHECK(las_real(file, p, "Reflectance") == -200);

  CHECK(one(shot, {.range = 1, .reflectance = 1}).point.intensity == 65535);
  CHECK(one(shot, {.range = 1, .reflectance = 7}).point.intensity == 65535);
  CHECK(one(shot, {.range = 1, .reflectance = nan}).point.intensity == 0);
  CHECK(one(shot, {.range = 1, .reflectance = 7}, {.intensity_full_scale = 14}).point.intensity == 32768);
  CHECK(one({.direction = {0, 0, -1}, .scan_angle = pi}, {.range = 1}).point.scan_angle_deg == doctest::Approx(180));
  CHECK(one({.direction = {0, 0, -1}, .scan_angle = -4}, {.range = 1}).point.scan_angle_deg == doctest::Approx(-180));
}

TEST_CASE("whatever is written reads back, field by field, and its header is exact") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    Generator random(seed + 1000);
    const Survey survey = Survey::random(seed, 100, random.log_uniform(1, 1e7));
    const bool kinds = seed % 2 == 1;
    LasSettings settings{
        .light_kinds = kinds, .scale = random.log_uniform(1e-5, 1e-2), .start_time = random.uniform(0, 6e5)};
    const LasFile file = survey.written(settings);  // checks numbers and bounds against the points
    REQUIRE(file.points.size() == survey.echoes.size());
    std::size_t i = 0;
    for (const Shot& shot : survey.shots) {
      for (const Echo& echo : EchoBatch{survey.shots, survey.echoes, {}, 0}.echoes_of(shot)) {
        CAPTURE(i);
        const LasPoint& p = file.points[i++];
        const Vec3 place = point_of(shot, echo);
        for (int axis = 0; axis < 3; ++axis) {
          CHECK(std::fabs(p.place[static_cast<std::size_t>(axis)] - place[axis]) <=
                0.5 * settings.scale + 1e-15 * std::fabs(place[axis]) + 1e-9);
        }
        CHECK(std::fabs(p.intensity - std::min(echo.reflectance, 1.0) * 65535) <= 0.5 + 1e-9);
        CHECK((p.flags == 0 && p.scan_direction == 0 && p.edge == 0));
        CHECK(p.return_number == std::min<unsigned>(echo.number, 15));
        CHECK(p.returns == std::min<unsigned>(shot.echoes, 15));
        CHECK(p.channel == shot.channel % 4);
        CHECK(p.user_data == std::min<unsigned>(shot.channel, 255));
        CHECK(p.classification == std::min<unsigned>(echo.classification, 255));
        CHECK(std::fabs(p.scan_angle_deg - degrees(shot.scan_angle)) <= 0.003 + 1e-9);
        CHECK(p.source == std::min(shot.leg + 1, 65535));
        CHECK(p.gps_time == settings.start_time + shot.tick.seconds());
        CHECK(las_real(file, p, "Range") == echo.range);
        CHECK(las_real(file, p, "Amplitude") == doctest::Approx(10 * std::log10(echo.amplitude / 1e-9)).epsilon(1e-5));
        CHECK(std::pow(10, las_real(file, p, "Reflectance") / 10) == doctest::Approx(echo.reflectance).epsilon(1e-5));
        CHECK(las_real(file, p, "EchoWidth") == doctest::Approx(echo.width * 1e9).epsilon(1e-6));
        CHECK(las_whole(file, p, "PulseIndex") == shot.index);
        CHECK(las_whole(file, p, "ObjectId") == echo.object);
        if (kinds) CHECK(las_whole(file, p, "LightKind") == static_cast<std::uint64_t>(echo.kind));
      }
    }
  }
}

TEST_CASE("the bytes of a file do not depend on how the pulses are cut into batches, nor on the day") {
  const TemporaryFolder folder;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    CAPTURE(seed);
    const Survey survey = Survey::random(seed, 4000, 1e6);
    survey.write(folder / "whole.las", {}, survey.shots.size());
    const std::string whole = content(folder / "whole.las");
    CHECK(whole.size() > (std::size_t{1} << 20));  // more than is handed over at once
    for (const std::size_t pulses_at_once : {std::size_t{1}, std::size_t{7}, std::size_t{1000}}) {
      survey.write(folder / "cut.las", {}, pulses_at_once);
      CHECK((content(folder / "cut.las") == whole));
    }
  }
}

// ----------------------------------------------------------------------------------------- formats

TEST_CASE("points of legacy formats hold what they can, and headers say which they are") {
  const Shot sideways{.direction = {0, 0, -1}, .scan_angle = pi, .channel = 77};
  for (const LasFormat format : {LasFormat::las_1_4_legacy, LasFormat::las_1_0}) {
    const auto [file, p] = one(sideways, {.range = 1, .classification = 300}, {.format = format});
    CHECK(file.minor == (format == LasFormat::las_1_0 ? 0 : 4));
    CHECK(file.format == 1);
    CHECK(file.global_encoding == (format == LasFormat::las_1_0 ? 0 : 1));
    CHECK(p.classification == 31);
    CHECK(p.scan_angle_deg == 90);
    CHECK((p.flags == 0 && p.scan_direction == 0 && p.edge == 0 && p.user_data == 77));
    CHECK(one({.direction = {0, 0, -1}, .scan_angle = radians(-12.6)}, {.range = 1}, {.format = format})
              .point.scan_angle_deg == -13);
    Survey survey;
    std::vector<Echo> echoes(7);
    for (std::uint8_t n = 1; n <= 7; ++n) echoes[n - 1U].number = n;
    survey.add({.direction = {0, 0, 1}}, echoes);
    echoes.resize(5);
    survey.add({.direction = {0, 0, 1}}, echoes);
    const LasFile many = survey.written({.format = format});
    CHECK((many.points[6].return_number == 5 && many.points[6].returns == 5));
    CHECK(many.by_return == std::array<std::uint64_t, 15>{2, 2, 2, 2, 4});
    const TemporaryFolder folder;
    LasWriter writer(folder / "many.las", {.format = format});
    writer(survey.batch());
    CHECK(writer.pulses_cut() == 1);
    for (std::size_t n = 0; n < 3; ++n) survey.echoes[n].classification = static_cast<std::uint16_t>(30 + n);
    LasWriter classes(folder / "classes.las", {.format = format});
    classes(survey.batch());
    CHECK(classes.classes_cut() == 1);
  }
}

TEST_CASE("reference systems are written as each format knows them") {
  const Survey survey = Survey::of_points({{1, 2, 3}});
  LasFile file = survey.written({.format = LasFormat::las_1_4_legacy, .epsg = 32632});
  CHECK((file.epsg == 32632 && file.wkt.empty() && file.global_encoding == 1));
  file = survey.written({.format = LasFormat::las_1_4_legacy, .wkt = "LOCAL_CS[]", .epsg = 32632});
  CHECK((file.epsg == 0 && file.wkt == "LOCAL_CS[]" && file.global_encoding == 17));
  file = survey.written({.format = LasFormat::las_1_0, .wkt = "LOCAL_CS[]", .epsg = 32632});
  CHECK((file.epsg == 32632 && file.wkt.empty()));
}

TEST_CASE("every format reads back, and tells the same places and times") {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    CAPTURE(seed);
    const Survey survey = Survey::random(seed, 100, 1e5);
    const LasFile expected = survey.written();
    for (const LasFormat format : {LasFormat::las_1_4_legacy, LasFormat::las_1_0}) {
      const LasFile file = survey.written({.format = format});
      REQUIRE(file.points.size() == expected.points.size());
      CHECK((file.min == expected.min && file.max == expected.max));
      for (std::size_t i = 0; i < file.points.size(); ++i) {
        const LasPoint &p = file.points[i], &q = expected.points[i];
        CHECK((p.stored == q.stored && p.gps_time == q.gps_time && p.intensity == q.intensity && p.source == q.source));
        CHECK(p.classification == std::min(q.classification, 31U));
        CHECK(std::fabs(p.scan_angle_deg - std::clamp(q.scan_angle_deg, -90.0, 90.0)) <= 0.51);
        CHECK((p.return_number == std::min(q.return_number, 5U) && p.returns == std::min(q.returns, 5U)));
        for (const char* name : {"PulseIndex", "ObjectId"})
          CHECK(las_whole(file, p, name) == las_whole(expected, q, name));
        for (const char* name : {"Range", "Amplitude", "Reflectance", "EchoWidth"})
          CHECK(las_real(file, p, name) == las_real(expected, q, name));
      }
    }
  }
}

// ------------------------------------------------------------------------------------- intensities

TEST_CASE("an intensity of amplitude has the full scale that it is given") {
  const Shot shot{.direction = {0, 0, -1}};
  const LasSettings settings{.intensity = LasIntensity::amplitude, .intensity_full_scale = 1e-6};
  CHECK(one(shot, {.range = 1, .amplitude = 1e-7, .reflectance = 1}, settings).point.intensity == 6554);
  CHECK(one(shot, {.range = 1, .amplitude = 1e-6}, settings).point.intensity == 65535);
  CHECK(one(shot, {.range = 1, .amplitude = 1e-3}, settings).point.intensity == 65535);
  CHECK(one(shot, {.range = 1, .amplitude = 0}, settings).point.intensity == 0);
}

TEST_CASE("an intensity normalized by range is that of the same surface at the range that it is given") {
  const Shot shot{.direction = {0, 0, -1}};
  const LasSettings settings{
      .intensity = LasIntensity::range_normalized, .intensity_full_scale = 1e-6, .intensity_range = 10};
  CHECK(one(shot, {.range = 10, .amplitude = 1e-7}, settings).point.intensity == 6554);
  CHECK(one(shot, {.range = 20, .amplitude = 0.25e-7}, settings).point.intensity == 6554);
  CHECK(one(shot, {.range = 5, .amplitude = 4e-7}, settings).point.intensity == 6554);
  CHECK_THROWS_AS((LasSettings{.intensity = LasIntensity::range_normalized}.validate()), SettingError);
  CHECK_THROWS_AS((LasSettings{.intensity_range = 0}.validate()), SettingError);
}

TEST_CASE(
    "without one, the strongest echo of the file has the greatest intensity, and all others theirs in proportion") {
  const LasSettings settings{.intensity = LasIntensity::amplitude};
  Survey survey;
  for (const double amplitude : {1e-8, 4e-8, 2e-8, 0.0})
    survey.add({.direction = {0, 0, -1}}, {Echo{.range = 1, .amplitude = amplitude}});
  LasFile file = survey.written(settings);
  CHECK(file.points[0].intensity == 16384);
  CHECK(file.points[1].intensity == 65535);
  CHECK(file.points[2].intensity == 32768);
  CHECK(file.points[3].intensity == 0);
  CHECK(Survey{}.written(settings).points.empty());
  CHECK(one({.direction = {0, 0, -1}}, {.range = 1, .amplitude = 0}, settings).point.intensity == 65535);  // of its own

  for (const LasFormat format : {LasFormat::las_1_4, LasFormat::las_1_4_legacy, LasFormat::las_1_0}) {
    survey = Survey::random(3, 4000, 100);  // more than is scaled at once
    file = survey.written({.format = format, .intensity = LasIntensity::amplitude});
    double most = 0;
    for (const Echo& echo : survey.echoes) most = std::max(most, echo.amplitude);
    REQUIRE(file.points.size() * 60 > (std::size_t{1} << 20));
    for (std::size_t i = 0; i < file.points.size(); ++i)
      REQUIRE(std::fabs(file.points[i].intensity - survey.echoes[i].amplitude / most * 65535) <= 0.7);
    const LasFile other = survey.written({.format = format});
    REQUIRE(other.points.size() == file.points.size());
    for (std::size_t i = 0; i < file.points.size(); ++i) {  // and nothing else is different
      std::string bytes = file.points[i].bytes;
      REQUIRE(bytes.replace(12, 2, other.points[i].bytes.substr(12, 2)) == other.points[i].bytes);
    }
  }
}

// --------------------------------------------------------------------------------------- waveforms

TEST_CASE("two returns of a pulse share one packet, in which their places are found") {
  const double c = speed_of_light;
  for (const LasFormat format : {LasFormat::las_1_4, LasFormat::las_1_4_legacy}) {
    Survey survey;
    const std::vector<float> waveform{0, 0x1p-30F, 0x1p-31F, 0};
    survey.add({.origin = {0, 0, 100}, .direction = {0, 0, -1}, .waveform_start = 600e-9},
               {Echo{.range = 90, .number = 1}, Echo{.range = 90.1, .number = 2}}, waveform);
    survey.add({.origin = {1, 0, 100}, .direction = {0, 0, -1}}, {Echo{.range = 90}});
    const TemporaryFolder folder;
    survey.write(folder / "points.las", {.format = format, .waveforms = true}, 1);
    const LasFile file = read_las(folder / "points.las");
    const support::WdpFile packets = support::read_wdp(folder / "points.wdp");
    CHECK(file.minor == 4);
    CHECK(file.format == (format == LasFormat::las_1_4 ? 9 : 4));
    CHECK((file.global_encoding & 4U) != 0);
    CHECK(packets.bytes.size() == 60 + 2 * 16);
    REQUIRE(file.points.size() == 3);
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      const support::LasWavePacket& wave = file.points[i].wave;
      CHECK((wave.offset == 60 && wave.size == 32));
      CHECK(wave.location_ps == support::relative((2 * (i == 0 ? 90 : 90.1) / c - 600e-9) * 1e12, 1e-6));
      CHECK((wave.direction[0] == 0 && wave.direction[1] == 0));
      CHECK(wave.direction[2] == support::relative(c / 2 * 1e-12, 1e-7));  // back up, to the instrument
      const std::vector<double> samples = waveform_of(file, packets, file.points[i]);
      REQUIRE(samples.size() == 16);
      CHECK((samples[0] == 0 && samples[1] == 0x1p-30 && samples[2] == 0x1p-31 && samples[3] == 0 && samples[15] == 0));
    }
    const support::LasWavePacket& none = file.points[2].wave;
    CHECK((none.descriptor == 0 && none.offset == 0 && none.size == 0 && none.location_ps == 0 &&
           none.direction[2] == 0));
  }
}

TEST_CASE("every waveform reads back, and position plus location times direction is where its first sample is from") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    CAPTURE(seed);
    const Survey survey = Survey::random_with_waveforms(seed, 200, 1e6);
    const TemporaryFolder folder;
    survey.write(folder / "points.las",
                 {.format = seed % 2 == 0 ? LasFormat::las_1_4 : LasFormat::las_1_4_legacy, .waveforms = true}, 7);
    const LasFile file = read_las(folder / "points.las");
    const support::WdpFile packets = support::read_wdp(folder / "points.wdp");
    REQUIRE(file.points.size() == survey.echoes.size());
    std::set<unsigned> in_points, described;
    for (const LasPoint& p : file.points)
      if (p.wave.descriptor != 0) in_points.insert(p.wave.descriptor);
    for (const support::LasWaveDescriptor& d : file.descriptors) described.insert(d.index);
    CHECK((in_points == described && file.descriptors.size() == in_points.size()));
    for (const support::LasWaveDescriptor& d : file.descriptors) CHECK((d.bits == 16 && d.spacing_ps == 250));
    std::size_t i = 0;
    std::uint64_t used = 60;
    for (const Shot& shot : survey.shots) {
      const auto waveform = survey.batch().waveform_of(shot);
      const auto echoes = survey.batch().echoes_of(shot);
      for (const Echo& echo : echoes) {
        CAPTURE(i);
        const LasPoint& p = file.points[i++];
        REQUIRE((p.wave.descriptor == 0) == waveform.empty());
        if (waveform.empty()) continue;
        CHECK(p.wave.offset == used);
        const Vec3 place{p.place[0], p.place[1], p.place[2]},
            back{p.wave.direction[0], p.wave.direction[1], p.wave.direction[2]};
        const Vec3 anchor = shot.origin + shot.direction * (speed_of_light / 2 * shot.waveform_start);
        if (echo.range - echoes[0].range <
            300) {  // as long as waveforms are: a location has the seven digits of a float
          CHECK(length(place + back * p.wave.location_ps - anchor) < 1e-3);
          CHECK(length(anchor - back * p.wave.location_ps - point_of(shot, echo)) < 1e-3);
        }
        const std::vector<double> samples = waveform_of(file, packets, p);
        REQUIRE(samples.size() >= waveform.size());
        const double peak = *std::max_element(waveform.begin(), waveform.end());
        for (std::size_t k = 0; k < samples.size(); ++k)
          REQUIRE(std::fabs(samples[k] - (k < waveform.size() ? double{waveform[k]} : 0)) <= peak / 7680 + 0x1p-53);
      }
      if (!echoes.empty() && !waveform.empty()) used += file.points[i - 1].wave.size;
    }
    CHECK(used == packets.bytes.size());  // each once, none without points
  }
}

TEST_CASE("what a detector kept peaks in its packet where the locations of its returns say") {
  const FullWaveform detector{
      WaveformSettings{.sample_interval = Survey::interval, .timing = EchoTiming::peak, .record_length = 100e-9}};
  auto workspace = detector.workspace(2);
  std::vector<Reflection> reflections{{.range = 812.3456, .power = 1e-7}, {.range = 815.4321, .power = 3e-8}};
  const Detection detection = support::detect(detector, Laser{}, reflections, workspace);
  REQUIRE(detection.echoes.size() == 2);
  Survey survey;
  survey.add({.origin = {478412, 5429876, 1000},
              .direction = normalize(Vec3{0.3, -0.2, -1}),
              .waveform_start = detection.waveform_start},
             {detection.echoes.begin(), detection.echoes.end()},
             {detection.waveform.begin(), detection.waveform.end()});
  const TemporaryFolder folder;
  survey.write(folder / "points.las", {.waveforms = true}, 1);
  const LasFile file = read_las(folder / "points.las");
  const support::WdpFile packets = support::read_wdp(folder / "points.wdp");
  REQUIRE(file.points.size() == 2);
  for (const LasPoint& p : file.points) {
    const std::vector<double> samples = waveform_of(file, packets, p);
    const auto near = static_cast<std::size_t>(std::lround(p.wave.location_ps / 250));
    REQUIRE((near >= 3 && near + 3 < samples.size()));
    const auto peak = std::max_element(samples.begin() + static_cast<std::ptrdiff_t>(near) - 3,
                                       samples.begin() + static_cast<std::ptrdiff_t>(near) + 4);
    CHECK(std::fabs(p.wave.location_ps / 250 - static_cast<double>(peak - samples.begin())) <= 0.6);
    CHECK(*peak == support::relative(std::pow(10, las_real(file, p, "Amplitude") / 10) * 1e-9, 0.03));
  }
}

TEST_CASE("waveforms change nothing else in a point, and need not be there") {
  const Survey survey = Survey::random_with_waveforms(1, 200, 1e3);
  const LasFile with = survey.written({.waveforms = true}), without = survey.written();
  REQUIRE(with.points.size() == without.points.size());
  for (std::size_t i = 0; i < with.points.size(); ++i) {
    std::string bytes = with.points[i].bytes;
    CHECK(bytes.erase(30, 29) == without.points[i].bytes);
  }
  const TemporaryFolder folder;
  Survey::random(1, 10, 10).write(folder / "none.las", {.waveforms = true}, 10);
  CHECK(read_las(folder / "none.las").format == 9);
  CHECK(support::read_wdp(folder / "none.wdp").bytes.size() == 60);
  survey.write(folder / "plain.las", {}, 10);
  CHECK_FALSE(std::filesystem::exists(folder / "plain.wdp"));
}

TEST_CASE(
    "the bytes of packets do not depend on batches; without close, or with a point without a place, there are none") {
  const TemporaryFolder folder;
  const Survey survey = Survey::random_with_waveforms(2, 1000, 1e3);
  for (const std::size_t at_once : {std::size_t{1}, std::size_t{33}, std::size_t{1000}})
    survey.write(folder / std::to_string(at_once).append(".las"), {.waveforms = true}, at_once);
  for (const char* end : {".las", ".wdp"}) {
    const std::string whole = content(folder / std::string("1000").append(end));
    for (const char* name : {"1", "33"}) CHECK((content(folder / std::string(name).append(end)) == whole));
  }
  const TemporaryFolder other;
  Survey bad = survey;
  bad.echoes.back().range = nan;
  bad.shots.back() = bad.shots[0];
  bad.shots.back().first_echo = static_cast<std::uint32_t>(bad.echoes.size() - 1);
  bad.shots.back().echoes = 1;
  {
    LasWriter open(other / "open.las", {.waveforms = true});
    open(survey.batch());
    LasWriter writer(other / "bad.las", {.waveforms = true});
    CHECK_THROWS_AS(writer(bad.batch()), FileError);
    CHECK_THROWS_AS(writer.close(), FileError);
  }
  CHECK_THROWS_WITH_AS(LasWriter(other / "points.wdp", {.waveforms = true}),
                       doctest::Contains("is the name of its waveform file"), FileError);
  CHECK(other.empty());
}

TEST_CASE("settings that cannot be are refused before a file is made") {
  const TemporaryFolder folder;
  using namespace std::chrono_literals;
  const std::vector<LasSettings> bad{{.scale = 0},
                                     {.scale = -1e-4},
                                     {.scale = nan},
                                     {.offset = Vec3{0, nan, 0}},
                                     {.offset = Vec3{0, 0, infinite}},
                                     {.wkt = std::string(65535, 'x')},
                                     {.epsg = 1023},
                                     {.epsg = 32767},
                                     {.reference = {.epsg = 1023}},
                                     {.reference = {.vertical_epsg = 32767}},
                                     {.reference = {.unit = 0}},
                                     {.reference = {.vertical_unit = nan}},
                                     {.reference = {.wkt = std::string(65535, 'x')}},
                                     {.start_time = infinite},
                                     {.intensity_full_scale = 0},
                                     {.amplitude_reference = nan},
                                     {.created = 2026y / 2 / 30}};
  for (const LasSettings& settings : bad) CHECK_THROWS_AS(LasWriter(folder / "points.las", settings), SettingError);
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
