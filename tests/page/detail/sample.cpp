// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/page/detail/sample.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

using namespace pulsecast;
using namespace pulsecast::page;

namespace {

/// Gives shots 0 to n - 1 to a sink, so many a batch, of 0, 1 or 2 echoes in turn.
void give(PageSample& sample, PulseIndex n, PulseIndex a_batch) {
  for (PulseIndex begin = 0; begin < n; begin += a_batch) {
    std::vector<Shot> shots;
    std::vector<Echo> echoes;
    for (PulseIndex i = begin; i < std::min(n, begin + a_batch); ++i) {
      const auto number = static_cast<std::uint32_t>(i % 3);
      shots.push_back({.index = i,
                       .tick = Tick::of(i, 1000),
                       .origin = {1, 2, 3},
                       .direction = {0, 0.6, -0.8},
                       .first_echo = static_cast<std::uint32_t>(echoes.size()),
                       .echoes = number});
      for (std::uint32_t k = 1; k <= number; ++k)
        echoes.push_back({.range = 10.0 * k, .number = static_cast<std::uint8_t>(k)});
    }
    EchoBatch batch;
    batch.shots = shots;
    batch.echoes = echoes;
    sample(batch);
  }
}

/// Value of a point in a column of the page, in its unit.
double at(const PagePoints& all, std::size_t point, const std::string& name) {
  for (std::size_t k = 0; k < all.columns.size(); ++k)
    if (all.columns[k].field.name == name) return all.value(point, k);
  FAIL("there is no column " << name);
  return 0;
}

std::vector<std::pair<PulseIndex, int>> names(PageSample& sample) {
  std::vector<std::pair<PulseIndex, int>> all;
  const PagePoints& kept = sample.points();
  for (std::size_t i = 0; i < kept.points.size(); ++i)
    all.emplace_back(kept.points[i].pulse, at(kept, i, "return_number"));
  return all;
}

}  // namespace

TEST_CASE("what fits is kept, in pulse order, with all that its shot and echo were") {
  PageSample sample(1000);
  const Shot shot{.index = 7,
                  .tick = {5, 0.25},
                  .origin = {1, 2, 3},
                  .direction = {0, 0.6, -0.8},
                  .scan_angle = 0.5,
                  .leg = 3,
                  .channel = 2,
                  .echoes = 2};
  const Echo echoes[] = {{.range = 10,
                          .amplitude = 1e-6,
                          .reflectance = 0.5,
                          .width = 2e-9,
                          .cos_incidence = 0.5,
                          .object = 9,
                          .classification = 5},
                         {.range = 20, .number = 2, .kind = ReflectionKind::water}};
  EchoBatch batch;
  batch.shots = {&shot, 1};
  batch.echoes = echoes;
  sample(batch);
  const PagePoints& all = sample.points();
  REQUIRE(all.points.size() == 2);
  const PagePoint& p = all.points[0];
  CHECK(length(p.position - Vec3{1, 8, -5}) < 1e-12);
  CHECK(p.to_instrument[1] == -6.0f);
  CHECK(p.to_instrument[2] == 8.0f);
  CHECK(p.time == 5.25);
  CHECK(p.pulse == 7);
  CHECK(at(all, 0, "amplitude") == static_cast<double>(1e-6f));
  CHECK(at(all, 0, "reflectance") == 0.5);
  CHECK(at(all, 0, "width") == static_cast<double>(2e-9f) * 1e9);
  CHECK(at(all, 0, "incidence") == doctest::Approx(60));
  CHECK(at(all, 0, "scan_angle") == doctest::Approx(90 / pi));
  CHECK(
      (at(all, 0, "object") == 9 && at(all, 0, "class") == 5 && at(all, 0, "leg") == 3 && at(all, 0, "channel") == 2));
  CHECK((at(all, 0, "return_number") == 1 && at(all, 0, "returns") == 2 && at(all, 0, "kind") == 0));
  CHECK((at(all, 1, "return_number") == 2 && at(all, 1, "kind") == 2));
  CHECK(sample.seen() == 2);
}

TEST_CASE("points have the colours of their echoes, rounded to a byte, and keep them when others are dropped") {
  std::size_t asked = 0;
  const PointColours colours = [&](const EchoBatch&, const Shot& shot, const Echo& echo) -> std::optional<PointColour> {
    ++asked;
    if (echo.number == 2) return std::nullopt;
    return PointColour{.red = static_cast<std::uint16_t>(257 * (shot.index % 256)), .green = 65535, .blue = 899};
  };
  PageSample few(500, {.colours = colours});
  give(few, 9000, 100);
  CHECK(few.points().points.size() == 500);
  CHECK(asked < few.seen());  // only of those that were kept for a moment
  const PagePoints& all = few.points();
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const double colour = at(all, i, "colour");
    const double expected = static_cast<double>(all.points[i].pulse % 256 << 16 | 255 << 8 | 3);  // 899 / 257 is 3.498
    CHECK((at(all, i, "return_number") == 2 ? std::isnan(colour) : colour == expected));
  }
  PageSample without(500);
  give(without, 9000, 100);
  CHECK(names(few) == names(without));
}

TEST_CASE("further columns are kept with their points, but for those that a page has anyway") {
  const std::vector<std::string> asked{"clock", "range", "leg", "azimuth", "pulse", "number_of_returns"};
  PageSample sample(500, {.start_time = 1000}, io::layouts::columns(asked));
  give(sample, 9000, 100);
  const PagePoints& all = sample.points();
  std::vector<std::string> further;
  for (const PageColumn& each : all.columns)
    if (each.further) further.push_back(each.field.name);
  CHECK(further == std::vector<std::string>{"clock", "azimuth", "number_of_returns"});
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    CHECK(at(all, i, "clock") == doctest::Approx(1000 + all.points[i].time));
    CHECK(at(all, i, "azimuth") == std::atan2(all.points[i].position.y, all.points[i].position.x));
  }
}

TEST_CASE("of too many, those of the least keys are kept, however they came") {
  constexpr PulseIndex n = 20'000;
  std::vector<std::pair<std::uint32_t, std::pair<PulseIndex, int>>> all;
  for (PulseIndex i = 0; i < n; ++i)
    for (int k = 1; k <= static_cast<int>(i % 3); ++k)
      all.push_back({page_key(i, static_cast<std::uint8_t>(k)), {i, k}});
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const std::size_t most : {2u, 777u, 15'999u, 19'998u, 30'000u}) {
    std::vector<std::pair<PulseIndex, int>> expected;
    for (std::size_t i = 0; i < std::min(most, all.size()); ++i) expected.push_back(all[i].second);
    std::sort(expected.begin(), expected.end());
    for (const PulseIndex a_batch : {PulseIndex{13}, PulseIndex{2048}, n}) {
      CAPTURE(most);
      CAPTURE(a_batch);
      PageSample sample(most);
      give(sample, n, a_batch);
      CHECK(names(sample) == expected);
      CHECK(sample.seen() == all.size());
    }
  }
}

TEST_CASE("asking in between changes nothing") {
  PageSample once(500), often(500);
  give(once, 9000, 9000);
  for (int k = 0; k < 3; ++k) static_cast<void>(often.points());
  give(often, 9000, 100);
  static_cast<void>(often.points());
  CHECK(names(once) == names(often));
}

TEST_CASE("keys of neighbours differ in every bit") {
  std::set<std::uint32_t> keys;
  int ones[32] = {};
  for (PulseIndex i = 0; i < 4096; ++i) {
    const std::uint32_t key = page_key(i, 1);
    keys.insert(key);
    for (int k = 0; k < 32; ++k) ones[k] += static_cast<int>(key >> k & 1);
  }
  CHECK(keys.size() == 4096);
  for (const int n : ones) CHECK(std::abs(n - 2048) < 5 * 32);
}

TEST_CASE("points that are not finite are passed over, and sizes that cannot be are refused") {
  PageSample sample(10);
  const double infinity = std::numeric_limits<double>::infinity();
  const Shot shots[] = {{.origin = {infinity, 0, 0}, .direction = axis::forward, .echoes = 1},
                        {.index = 1, .direction = axis::forward, .first_echo = 1, .echoes = 1}};
  const Echo echoes[] = {{.range = 1}, {.range = infinity}};
  EchoBatch batch;
  batch.shots = shots;
  batch.echoes = echoes;
  sample(batch);
  CHECK(sample.points().points.empty());
  CHECK_THROWS_AS(PageSample(1), SettingError);
  CHECK_THROWS_AS(PageSample(std::size_t{1} << 30), SettingError);
}
