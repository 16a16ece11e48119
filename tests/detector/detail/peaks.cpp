// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/detail/peaks.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

namespace {

/// A waveform of reflections alone.
struct NoContinuous {
  static bool needs_sum() { return false; }
  const ContinuousReturn* operator()(const Peak&, double, bool) const { return nullptr; }
};

/// Peaks at times, as high as said, with valleys a half before and after.
std::vector<Peak> kept(const WaveformSettings& s, const std::vector<Peak>& all) {
  std::vector<Peak> peaks;
  peaks.reserve(all.size());
  for (const Peak& p : all)
    merge_or_append({p.time, p.height, p.time - 0.5, p.time + 0.5}, s.separation, s.prominence, peaks);
  keep_echoes(s, peaks);
  return peaks;
}

std::vector<double> times(const std::vector<Peak>& peaks) {
  std::vector<double> t;
  for (const Peak& p : peaks) t.push_back(p.time);
  return t;
}

using Times = std::vector<double>;

}  // namespace

TEST_CASE("peaks closer than the separation are one, as high as the highest of them") {
  const WaveformSettings s{.separation = 2.5, .window = 0};
  const auto one = kept(s, {{10, 1}, {12, 3}, {14, 2}, {20, 1}});
  REQUIRE(times(one) == Times{12, 20});
  CHECK(one[0].height == 3);
  CHECK(one[0].begin == 9.5);
  CHECK(one[0].end == 14.5);
  CHECK(one[1].begin == 19.5);
  CHECK(times(kept({.separation = 2, .window = 0}, {{10, 1}, {12, 3}})) == Times{10, 12});
  CHECK(times(kept({.separation = 0, .window = 0}, {{10, 1}, {10.1, 3}})) == Times{10, 10.1});
}

TEST_CASE("within the window, only the highest is kept, and the first of equal ones") {
  CHECK(times(kept({.window = 2}, {{10, 1}, {12, 2}, {14.5, 1}})) == Times{12, 14.5});
  CHECK(times(kept({.window = 2}, {{10, 1}, {11, 1}})) == Times{10});
  CHECK(times(kept({.window = 2}, {{10, 1}, {12, 2}, {14, 3}})) == Times{14});  // who is outdone outdoes others
}

TEST_CASE("after an echo, the receiver is blind for its dead time, whatever comes") {
  CHECK(times(kept({.window = 0, .dead_time = 3}, {{10, 1}, {12, 5}, {13, 1}, {15.9, 1}, {16, 1}})) ==
        Times{10, 13, 16});
  // what the window has dropped blinds nobody
  CHECK(times(kept({.window = 1, .dead_time = 3}, {{10, 1}, {11, 2}, {13.5, 1}, {15, 1}})) == Times{11, 15});
}

TEST_CASE("of too many echoes, the first are kept, and those of the air only where there is room; or the strongest") {
  const auto kept_of = [](KeptReturns which, std::size_t most, const std::vector<Echo>& all) {
    std::vector<Echo> echoes;
    for (const Echo& echo : all)
      keep_return(echo, WaveformSettings{.returns_max = most, .returns_kept = which}, echoes);
    std::vector<double> ranges;
    for (const Echo& echo : echoes) ranges.push_back(echo.range);
    return ranges;
  };
  const auto air = ReflectionKind::air;
  const std::vector<Echo> solid{
      {.range = 10, .amplitude = 1}, {.range = 20, .amplitude = 5}, {.range = 30, .amplitude = 9}};
  CHECK(kept_of(KeptReturns::first, 2, solid) == Times{10, 20});
  CHECK(kept_of(KeptReturns::strongest, 2, solid) == Times{20, 30});
  const std::vector<Echo> rainy{{.range = 1, .amplitude = 9, .kind = air},
                                {.range = 2, .amplitude = 8, .kind = air},
                                {.range = 10, .amplitude = 1},
                                {.range = 11, .amplitude = 3, .kind = air},
                                {.range = 20, .amplitude = 2}};
  CHECK(kept_of(KeptReturns::first, 5, rainy) == Times{1, 2, 10, 11, 20});
  CHECK(kept_of(KeptReturns::first, 3, rainy) == Times{1, 10, 20});
  CHECK(kept_of(KeptReturns::first, 2, rainy) == Times{10, 20});
  CHECK(kept_of(KeptReturns::first, 1, rainy) == Times{10});
  CHECK(kept_of(KeptReturns::strongest, 2, rainy) == Times{1, 2});
}

TEST_CASE("peaks for which there is no room are lost") {
  std::vector<Peak> peaks;
  peaks.reserve(2);
  const std::size_t room = peaks.capacity();
  for (std::size_t k = 0; k < room + 3; ++k)
    CHECK_FALSE(merge_or_append({.time = static_cast<double>(k), .height = 1}, 0, 0, peaks));
  CHECK(peaks.size() == room);
  CHECK(peaks.capacity() == room);
}

TEST_CASE("windows are kept to by all that stay, whatever there is") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Peak> all(any.whole(100));
    double t = 0;
    for (Peak& p : all) p = {t += any.uniform(), any.uniform()};
    const WaveformSettings s{
        .separation = any.uniform(0, 1), .window = any.uniform(0, 3), .dead_time = any.uniform(0, 3)};
    const auto stay = kept(s, all);
    for (std::size_t i = 1; i < stay.size(); ++i) {
      CHECK(stay[i].time - stay[i - 1].time >= s.dead_time);
      CHECK(stay[i].time - stay[i - 1].time > s.window);
      CHECK(stay[i].time - stay[i - 1].time >= s.separation);
    }
  }
}

TEST_CASE("the higher of two peaks stays, with its mark, if the lower rises too little above the valley") {
  std::vector<Peak> peaks;
  peaks.reserve(4);
  CHECK(!merge_or_append({.time = 1, .height = 5, .begin = 0, .end = 2, .before = 0, .after = 4, .mark = 0.9}, 0, 2,
                         peaks));
  CHECK(merge_or_append({.time = 3, .height = 7, .begin = 2, .end = 4, .before = 4, .after = 1, .mark = 2.9}, 0, 2,
                        peaks));
  CHECK(!merge_or_append({.time = 6, .height = 4, .begin = 4, .end = 8, .before = 1, .after = 0, .mark = 5.9}, 0, 2,
                         peaks));
  REQUIRE(peaks.size() == 2);
  CHECK(peaks[0].mark == 2.9);
  CHECK(peaks[0].begin == 0);
  CHECK(peaks[0].end == 4);
  CHECK(peaks[0].after == 1);
  CHECK(peaks[1].mark == 5.9);
}

TEST_CASE("an echo is made of the reflections between its valleys, and has the labels of the strongest at its peak") {
  const PulseShape shape(3.5e-9);  // tau is 1 ns
  const double metre = 2 / speed_of_light;
  const std::vector<Reflection> reflections{
      {10, 9, 1, 1, {}, 0.1}, {20, 1, 2, 2, {}, 0.2}, {20.1, 3, 3, 3, {}, 0.3}, {21, 2, 4, 4, {}, 0.4}};
  const Peak peak{.time = 20.15 * metre,
                  .height = 3.5,
                  .begin = 19 * metre,
                  .end = 20.9 * metre,
                  .mark = 20.15 * metre,
                  .width = 7};
  const Echo e = echo_of(peak, reflections, shape, EchoTiming::true_range, NoContinuous{});
  CHECK(e.range == support::relative(20.075, 1e-12));
  CHECK(e.amplitude == 3.5);
  CHECK(e.width == 7);
  CHECK(e.object == 3);
  CHECK(e.classification == 3);
  CHECK(e.cos_incidence == 0.3);
  CHECK(echo_of(peak, reflections, shape, EchoTiming::peak, NoContinuous{}).range == support::relative(20.15, 1e-12));
  // a peak of noise alone is nobody's
  const Echo nobody = echo_of({.time = 15 * metre, .begin = 14.9 * metre, .end = 15.1 * metre, .mark = 15 * metre},
                              std::span(reflections).subspan(1), shape, EchoTiming::true_range, NoContinuous{});
  CHECK(nobody.range == support::relative(15, 1e-12));
  CHECK(nobody.object == 0);
}

TEST_CASE("an echo has the labels of the greatest share at its peak, the first of equal ones, of any number") {
  const PulseShape shape(3.5e-9);
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Reflection> reflections(1 + any.whole(40));
    const bool alike = any.coin();
    for (std::size_t i = 0; i < reflections.size(); ++i)
      reflections[i] = {any.coin() ? 20 : any.uniform(19, 21), alike ? 1 : any.log_uniform(0.1, 10), 0};
    std::sort(reflections.begin(), reflections.end(),
              [](const Reflection& a, const Reflection& b) { return a.range < b.range; });
    for (std::size_t i = 0; i < reflections.size(); ++i) reflections[i].object = static_cast<ObjectId>(i + 1);
    const double time = 2 * any.uniform(18, 26) / speed_of_light;
    ObjectId expected = 0;
    double most = 0;
    for (const Reflection& r : reflections) {
      const double share = r.power * shape(time - arrival(r));
      if (!(share > most * (1 + 1e-14))) continue;
      most = share;
      expected = r.object;
    }
    CHECK(echo_of({.time = time, .mark = time}, reflections, shape, EchoTiming::peak, NoContinuous{}).object ==
          expected);
  }
}
