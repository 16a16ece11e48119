// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/text_files.hpp>

#include <array>
#include <clocale>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "support/every_column.hpp"
#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::TemporaryFolder;

std::string points_of(const TemporaryFolder& folder, const std::vector<Shot>& shots, const std::vector<Echo>& echoes,
                      TextFileSettings settings = {}) {
  XyzWriter writer(folder / "points.xyz", settings);
  writer(EchoBatch{shots, echoes, {}, 0});
  writer.close();
  return content(folder / "points.xyz");
}

TEST_CASE("a point is a line of eleven columns") {
  const TemporaryFolder folder;
  Shot shot;
  shot.index = 41;
  shot.tick = {7, 0.25};
  shot.origin = {100, 200, 50};
  shot.direction = {0, 0, -1};
  shot.echoes = 2;
  const Echo first{.range = 10.00016,
                   .amplitude = 2.5e-9,
                   .reflectance = 0.5,
                   .width = 1.25e-9,
                   .object = 12,
                   .classification = 5,
                   .number = 1};
  const Echo second{.range = 50, .amplitude = 1e-10, .width = 0, .object = 3, .classification = 2, .number = 2};
  CHECK(points_of(folder, {shot}, {first, second}, {.start_time = 1000}) ==
        "100.0000 200.0000 39.9998 2.5000 1.2500 1 2 41 12 5 1007.250000000\n"
        "100.0000 200.0000 0.0000 0.1000 0.0000 2 2 41 3 2 1007.250000000\n");
}

TEST_CASE("colours and attributes are further columns of a point, in this order, and nan where they are unknown") {
  const TemporaryFolder folder;
  std::vector<Scene<TriangleMesh<>>::Part> trees(1);
  trees[0].object = 12;
  trees[0].attributes = pulsecast::attributes({{"age", 80.125}, {"species", 3}, {"share", 0.1}});
  const PointSettings points{
      .colours = [](const EchoBatch&, const Shot&, const Echo& echo) -> std::optional<PointColour> {
        if (echo.number == 2) return std::nullopt;
        return PointColour{65535, 257 * 128, 899, 0};  // 899 / 257 is 3.498
      },
      .attributes = ObjectAttributes{std::span(std::as_const(trees))}};
  const std::vector<Shot> shots{{.tick = {7, 0.25}, .direction = {0, 0, -1}, .echoes = 2}};
  const std::vector<Echo> echoes{{.range = 10, .object = 12}, {.range = 20, .object = 3, .number = 2}};
  const auto written = [&](const std::vector<PointField>& columns) {
    XyzWriter writer(folder / "points.xyz", {.start_time = 0}, {columns, points});
    writer(EchoBatch{shots, echoes, {}, 0});
    writer.close();
    return content(folder / "points.xyz");
  };
  const std::string first = "0.0000 0.0000 -10.0000 0.0000 0.0000 1 2 0 12 0 7.250000000";
  const std::string second = "0.0000 0.0000 -20.0000 0.0000 0.0000 2 2 0 3 0 7.250000000";
  CHECK(written({}) == first + '\n' + second + '\n');
  const std::vector<PointField> attributes = layouts::attributes(points.attributes.names());
  CHECK(written(layouts::colours()) == first + " 255 128 3\n" + second + " nan nan nan\n");
  CHECK(written(attributes) == first + " 80.125 3 0.1\n" + second + " nan nan nan\n");
  const std::vector<PointField> more = layouts::columns({column("pulse"), column("x"), column("reflectivity")});
  CHECK(written(more) == first + " 0 0 0\n" + second + " 0 0 0\n");
  CHECK(written({{"share", NumberType::float32, &attribute_column, 0.5}}) == first + " 0.05\n" + second + " nan\n");
}

TEST_CASE("every column of the table is a further column that reads back the same") {
  const support::EveryColumn all;
  const TemporaryFolder folder;
  XyzWriter writer(folder / "points.xyz", {}, {all.fields, all.settings});
  writer(all.batch());
  writer.close();
  const PointBuffer expected = all.records();
  std::istringstream lines(content(folder / "points.xyz"));
  for (std::size_t i = 0; i < 2; ++i) {
    std::string word;
    for (int standard = 0; standard < 11; ++standard) lines >> word;
    for (const PointField& field : expected.layout().fields) {
      CAPTURE(field.name);
      REQUIRE(static_cast<bool>(lines >> word));
      const double value = expected.number(i, field);
      if (word == "nan")
        CHECK((std::isnan(value) || (i == 1 && value == 0)));  // integers of a record have no NaN
      else
        CHECK((field.type == NumberType::float32 ? double{std::stof(word)} : std::stod(word)) == value);
    }
  }
}

TEST_CASE("pulses without echoes make no lines, and no points make an empty file") {
  const TemporaryFolder folder;
  CHECK(points_of(folder, {}, {}).empty());
  CHECK(points_of(folder, std::vector<Shot>(3), {}).empty());
}

TEST_CASE("whatever is written reads back to the last decimal, in every locale") {
  const TemporaryFolder folder;
  std::setlocale(LC_ALL, "de_DE.UTF-8");  // where it is installed, numbers have commas
  support::Generator random(1);
  std::vector<Shot> shots;
  std::vector<Echo> echoes;
  for (std::uint64_t i = 0; i < 500; ++i) {
    Shot shot;
    shot.index = i * 1'000'000'007;
    shot.tick = Tick::of(i, 3e5);
    shot.origin = random.point(6e6);
    shot.direction = random.unit();
    shot.first_echo = static_cast<std::uint32_t>(echoes.size());
    shot.echoes = static_cast<std::uint32_t>(random.whole(5));
    for (std::uint8_t n = 1; n <= shot.echoes; ++n) {
      echoes.push_back({.range = random.log_uniform(1, 1e4),
                        .amplitude = random.log_uniform(1e-12, 1e-3),
                        .width = random.log_uniform(1e-10, 1e-7),
                        .object = static_cast<ObjectId>(random.whole(std::uint64_t{1} << 32)),
                        .classification = static_cast<std::uint16_t>(random.whole(65536)),
                        .number = n});
    }
    shots.push_back(shot);
  }
  std::istringstream lines(points_of(folder, shots, echoes));
  for (const Shot& shot : shots) {
    for (const Echo& echo : EchoBatch{shots, echoes, {}, 0}.echoes_of(shot)) {
      CAPTURE(shot.index);
      std::array<double, 5> reals{};
      std::array<std::uint64_t, 5> wholes{};
      double time = 0;
      for (double& value : reals) lines >> value;
      for (std::uint64_t& value : wholes) lines >> value;
      lines >> time;
      REQUIRE(lines.good());
      const Vec3 point = point_of(shot, echo);
      const std::array expected{point.x, point.y, point.z, echo.amplitude * 1e9, echo.width * 1e9};
      for (std::size_t i = 0; i < 5; ++i)
        CHECK(std::fabs(reals[i] - expected[i]) <= 0.5e-4 + 1e-15 * std::fabs(expected[i]));
      CHECK(wholes ==
            std::array<std::uint64_t, 5>{echo.number, shot.echoes, shot.index, echo.object, echo.classification});
      CHECK(std::fabs(time - shot.tick.seconds()) <= 0.6e-9);
    }
  }
  std::string rest;
  CHECK_FALSE(static_cast<bool>(lines >> rest));
  std::setlocale(LC_ALL, "C");
}

TEST_CASE("a point without a place is an error, and no file is left") {
  const TemporaryFolder folder;
  Shot shot;
  shot.direction = {0, 0, 1};
  shot.echoes = 1;
  for (const double range : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const std::vector<Echo> echoes{{.range = range}};
    const std::vector<Shot> shots{shot};
    XyzWriter writer(folder / "points.xyz");
    CHECK_THROWS_AS(writer(EchoBatch{shots, echoes, {}, 0}), FileError);
    CHECK_THROWS_AS(writer.close(), FileError);
  }
  CHECK(folder.empty());
}

TEST_CASE("a start time that is no number is refused before a file is made") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(XyzWriter(folder / "a.xyz", {.start_time = std::numeric_limits<double>::quiet_NaN()}), SettingError);
  CHECK(folder.empty());
}

std::string pulses_of(const std::vector<Shot>& shots, TextFileSettings settings = {}) {
  const TemporaryFolder folder;
  PulseTextWriter writer(folder / "pulses.txt", settings);
  writer(EchoBatch{shots, {}, {}, 0});
  writer.close();
  return content(folder / "pulses.txt");
}

TEST_CASE("a pulse is a line of ten columns, nine of which are HELIOS++'s") {
  Shot shot;
  shot.index = 41;
  shot.tick = {7, 0.25};
  shot.origin = {100, 200.00004, -50};
  shot.direction = {0.6, 0, -0.8};
  shot.channel = 3;
  shot.fate = Fate::returned;
  CHECK(pulses_of({shot}) ==
        "100.0000 200.0000 -50.0000 0.600000000 0.000000000 -0.800000000 7250000000.0000 41 3 0\n");
  CHECK(pulses_of({shot}, {.start_time = 4e8}) ==
        "100.0000 200.0000 -50.0000 0.600000000 0.000000000 -0.800000000 400000007250000000.0000 41 3 0\n");
}

TEST_CASE("pulses are written whatever became of them, and their fates have the numbers that are documented") {
  const std::vector<Fate> fates{Fate::returned, Fate::missed, Fate::out_of_range, Fate::below_threshold,
                                Fate::absorbed};
  std::vector<Shot> shots(fates.size());
  for (std::size_t i = 0; i < fates.size(); ++i) {
    shots[i].index = i;
    shots[i].fate = fates[i];
  }
  std::string expected, zeros = "0.0000 0.0000 0.0000 0.000000000 0.000000000 0.000000000 0.0000 ";
  for (const char* end : {"0 0 0\n", "1 0 2\n", "2 0 3\n", "3 0 4\n", "4 0 5\n"}) expected += zeros + end;
  CHECK(pulses_of(shots) == expected);
}

TEST_CASE("no pulses make an empty file; one without a place or a direction is an error") {
  CHECK(pulses_of({}).empty());
  const TemporaryFolder folder;
  std::vector<Shot> shots(2);
  for (Vec3 Shot::*member : {&Shot::origin, &Shot::direction}) {
    shots[1] = {};
    (shots[1].*member).z = std::numeric_limits<double>::quiet_NaN();
    PulseTextWriter writer(folder / "pulses.txt");
    CHECK_THROWS_WITH_AS(writer(EchoBatch{shots, {}, {}, 0}), doctest::Contains("line 2"), FileError);
  }
  CHECK_THROWS_AS(PulseTextWriter(folder / "a.txt", {.start_time = std::numeric_limits<double>::infinity()}),
                  SettingError);
  CHECK(folder.empty());
}

SubrayRecord hit(double range, double power, const Vec3& point) {
  SubrayRecord hit;
  hit.range = range;
  hit.power = power;
  hit.point = point;
  hit.cos_incidence = 0.5;
  hit.backscatter = 0.25;
  hit.object = 12;
  hit.classification = 5;
  return hit;
}

TEST_CASE("a hit is a line of eleven columns; subrays that met nothing have none, and keep their numbers") {
  const TemporaryFolder folder;
  std::vector<Shot> shots(2);
  shots[0].index = 40;
  shots[1].index = 41;
  const std::vector<SubrayRecord> subrays{hit(10, 2.5e-9, {1, 2, 3}), SubrayRecord{}, SubrayRecord{},
                                          hit(20.00016, 0, {-1, 0, 5e6})};
  SubrayTextWriter writer(folder / "subrays.txt");
  writer(EchoBatch{shots, {}, {}, 0, subrays});
  writer.close();
  CHECK(content(folder / "subrays.txt") ==
        "40 0 1.0000 2.0000 3.0000 10.0000 2.500000000 0.500000 0.250000 12 5\n"
        "41 1 -1.0000 0.0000 5000000.0000 20.0002 0.000000000 0.500000 0.250000 12 5\n");
}

TEST_CASE("without recorded subrays, and without pulses, the file is empty; a hit without a place is an error") {
  const TemporaryFolder folder;
  const std::vector<Shot> shots(2);
  SubrayTextWriter writer(folder / "subrays.txt");
  writer(EchoBatch{shots, {}, {}, 0, {}});
  writer(EchoBatch{});
  writer.close();
  CHECK(content(folder / "subrays.txt").empty());
  const std::vector<SubrayRecord> subrays(2, hit(1, 1, {0, std::numeric_limits<double>::quiet_NaN(), 0}));
  SubrayTextWriter bad(folder / "bad.txt");
  CHECK_THROWS_AS(bad(EchoBatch{shots, {}, {}, 0, subrays}), FileError);
  CHECK_FALSE(std::filesystem::exists(folder / "bad.txt.part"));
}

std::string waveforms_of(const EchoBatch& batch, TextFileSettings settings = {}) {
  const TemporaryFolder folder;
  WaveformTextWriter writer(folder / "waveforms.txt", settings);
  writer(batch);
  writer.close();
  return content(folder / "waveforms.txt");
}

TEST_CASE(
    "a waveform is a line of ten columns and its samples; times are one-way, in nanoseconds") {  // samples have a
                                                                                                 // float's 7 digits
  Shot shot;
  shot.index = 41;
  shot.tick = {7, 0.25};
  shot.origin = {100, 200, 50};
  shot.direction = {0, 0, -1};
  shot.waveform_start = 200e-9;
  shot.first_sample = 1;
  shot.samples = 3;
  const std::vector<Shot> shots{Shot{}, shot};
  const std::vector<float> samples{99, 0.5e-9F, 0, -0.25e-9F, 99};
  CHECK(waveforms_of({shots, {}, samples, 2e-9}, {.start_time = 1000}) ==
        "41 100.0000 200.0000 50.0000 0.000000000 0.000000000 -1.000000000 100.000000 102.000000 1007.250000000 "
        "0.499999986 0.000000000 -0.249999993\n");
}

TEST_CASE("rows of as many samples as asked for end with zeros or are cut, and their last time is of the last sample") {
  std::vector<Shot> shots(2);
  for (Shot& shot : shots) shot.direction = {0, 0, -1};
  shots[0].samples = 1;
  shots[1] = shots[0];
  shots[1].first_sample = 1;
  shots[1].samples = 3;
  const std::vector<float> samples{1e-9F, 2e-9F, 3e-9F, 4e-9F};
  const std::string head = "0 0.0000 0.0000 0.0000 0.000000000 0.000000000 -1.000000000 0.000000 1.000000 0.000000000 ";
  const TemporaryFolder folder;
  WaveformTextWriter writer(folder / "a.txt", {.waveform_samples = 2});
  writer(EchoBatch{shots, {}, samples, 2e-9});
  writer.close();
  CHECK(content(folder / "a.txt") ==
        head + "0.999999972 0.000000000\n" + head + "1.999999943 3.000000026\n");  // to a float's digits
  CHECK((writer.waveforms_cut() == 1 && writer.samples_max() == 3));
}

TEST_CASE("each sample is found at the range that its column says, and keeps its power") {
  support::Generator random(1);
  constexpr double interval = 0.25e-9;
  std::vector<Shot> shots;
  std::vector<float> samples;
  for (PulseIndex i = 0; i < 100; ++i) {
    Shot shot;
    shot.index = i;
    shot.origin = random.point(1e6);
    shot.direction = random.unit();
    shot.waveform_start = random.uniform(1e-9, 1e-4);
    shot.first_sample = samples.size();
    shot.samples = static_cast<std::uint32_t>(2 + random.whole(200));
    for (std::uint32_t k = 0; k < shot.samples; ++k)
      samples.push_back(static_cast<float>(random.log_uniform(1e-12, 1e-3)));
    shots.push_back(shot);
  }
  const EchoBatch batch{shots, {}, samples, interval};
  std::istringstream lines(waveforms_of(batch));
  for (const Shot& shot : shots) {
    CAPTURE(shot.index);
    std::string line;
    REQUIRE(std::getline(lines, line));
    std::istringstream columns(line);
    std::vector<double> values(10 + shot.samples);
    for (double& value : values) columns >> value;
    REQUIRE(columns);
    CHECK(columns.eof());
    CHECK(values[0] == static_cast<double>(shot.index));
    for (int axis = 0; axis < 3; ++axis) {
      CHECK(std::fabs(values[1 + static_cast<std::size_t>(axis)] - shot.origin[axis]) <= 0.51e-4);
      CHECK(std::fabs(values[4 + static_cast<std::size_t>(axis)] - shot.direction[axis]) <= 0.51e-9);
    }
    for (std::uint32_t k = 0; k < shot.samples; ++k) {
      const double at = values[7] + (values[8] - values[7]) * k / (shot.samples - 1);
      CHECK(std::fabs(at - (shot.waveform_start + k * interval) / 2 * 1e9) <= 1e-6);  // 0.3 um
      CHECK(std::fabs(values[10 + k] - double{batch.waveform_of(shot)[k]} * 1e9) <= 0.5e-9 + 1e-15 * values[10 + k]);
    }
  }
}

TEST_CASE("pulses without a waveform make no lines, those without echoes do; places must be finite") {
  const std::vector<float> samples{1e-9F};
  std::vector<Shot> shots(3);
  CHECK(waveforms_of({shots, {}, samples, 1e-9}).empty());
  shots[1].samples = 1;
  CHECK(waveforms_of({shots, {}, samples, 1e-9}) ==
        "0 0.0000 0.0000 0.0000 0.000000000 0.000000000 0.000000000 0.000000 0.000000 0.000000000 0.999999972\n");
  const TemporaryFolder folder;
  shots[1].origin.x = std::numeric_limits<double>::infinity();
  WaveformTextWriter writer(folder / "a.txt");
  CHECK_THROWS_AS(writer(EchoBatch{shots, {}, samples, 1e-9}), FileError);
  CHECK_THROWS_AS(WaveformTextWriter(folder / "b.txt", {.start_time = std::numeric_limits<double>::quiet_NaN()}),
                  SettingError);
  CHECK(folder.empty());
}

}  // namespace
}  // namespace pulsecast::io
