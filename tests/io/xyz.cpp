// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/xyz.hpp>

#include <array>
#include <clocale>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::content;
using support::TemporaryFolder;

std::string written(const TemporaryFolder& folder, const std::vector<Shot>& shots, const std::vector<Echo>& echoes,
                    XyzSettings settings = {}) {
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
  const Echo first{
      .range = 10.00016, .amplitude = 2.5e-9, .reflectance = 0.5, .width = 1.25e-9, .object = 12, .classification = 5, .number = 1};
  const Echo second{.range = 50, .amplitude = 1e-10, .width = 0, .object = 3, .classification = 2, .number = 2};
  CHECK(written(folder, {shot}, {first, second}, {.start_time = 1000}) ==
        "100.0000 200.0000 39.9998 2.5000 1.2500 1 2 41 12 5 1007.250000000\n"
        "100.0000 200.0000 0.0000 0.1000 0.0000 2 2 41 3 2 1007.250000000\n");
}

TEST_CASE("pulses without echoes make no lines, and no points make an empty file") {
  const TemporaryFolder folder;
  CHECK(written(folder, {}, {}).empty());
  CHECK(written(folder, std::vector<Shot>(3), {}).empty());
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
  std::istringstream lines(written(folder, shots, echoes));
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
      for (std::size_t i = 0; i < 5; ++i) CHECK(std::fabs(reals[i] - expected[i]) <= 0.5e-4 + 1e-15 * std::fabs(expected[i]));
      CHECK(wholes == std::array<std::uint64_t, 5>{echo.number, shot.echoes, shot.index, echo.object, echo.classification});
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

}  // namespace
}  // namespace pulsecast::io
