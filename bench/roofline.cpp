// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Time of a pulse of 19 subrays on one thread, and limits of the machine, for `roofline.sh`: the peak rates of
// arithmetic and of reading, and the time of surveys beside a tree, in a street and over hills of a raster. `--once
// NAME` runs one of the surveys once to warm the caches and once in the function `roofline_counted`, whose operations
// and bytes the script counts.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/height_field.hpp>

#include "report.hpp"
#include "scenes.hpp"
#include "surveys.hpp"

using namespace bench;

namespace {

constexpr PulseIndex pulses = 4'000;

template <class S>
double sum_of_echoes(const S& survey) {
  auto workspace = survey.workspace();
  double sum = 0;
  for (PulseIndex i = 0; i < survey.size(); ++i)
    for (const Echo& echo : survey(i, workspace).echoes) sum += echo.range;
  return sum;
}

template <class Source, class Shape>
auto survey_of(const Source& source, const Scene<Shape>& scene) {
  return Survey{source, SunflowerFootprint(19), scene, Receiver{}, FullWaveform{}};
}

template <class Real>
constexpr std::size_t lanes = 12 * 32 / sizeof(Real);  ///< of twelve vectors

/// Fused multiplications and additions in twelve vectors, each of which waits for its own only.
template <class Real>
void multiply(std::size_t rounds) {
  std::array<Real, lanes<Real>> sums{};
  for (std::size_t i = 0; i < rounds; ++i)
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] = std::fma(sums[k], Real{0.5}, Real{1});
  keep(sums);
}

/// Reads an array, eight sums at a time.
void read(const std::vector<std::uint64_t>& all) {
  std::array<std::uint64_t, 32> sums{};
  for (std::size_t i = 0; i + sums.size() <= all.size(); i += sums.size())
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += all[i + k];
  keep(sums);
}

}  // namespace

/// Function that `roofline.sh` counts.
[[gnu::noinline]] void roofline_counted(const std::function<double()>& work) { std::printf("%.9g\n", work()); }

int main(int count, char** words) {
  const auto wood = scene_of(tree());
  const auto town = street::scene(1);
  const Scene<HeightField> ground({{.geometry = std::make_shared<const HeightField>(hills(866))}});
  const std::pair<std::string, std::function<double()>> surveys[] = {
      {"tree", [survey = survey_of(tripod(pulses), wood)] { return sum_of_echoes(survey); }},
      {"street", [survey = survey_of(car(pulses), town)] { return sum_of_echoes(survey); }},
      {"hills", [survey = survey_of(airplane(pulses), ground)] { return sum_of_echoes(survey); }}};
  if (count == 3 && std::string(words[1]) == "--once") {
    for (const auto& [name, work] : surveys)
      if (name == words[2]) {
        keep(work());
        roofline_counted(work);
      }
    return 0;
  }

  Report report("roofline", count, words);
  constexpr std::size_t rounds = 100'000;
  const std::vector<std::uint64_t> near(1U << 15, 1), far(1U << 26, 1);
  std::vector<std::function<void()>> works{[] { multiply<float>(rounds); }, [] { multiply<double>(rounds); },
                                           [&] { read(near); }, [&] { read(far); }};
  for (const auto& survey : surveys) works.emplace_back([&work = survey.second] { keep(work()); });
  const std::vector<Times> times = report.by_turns(works);
  const auto per_ns = [&](std::size_t i, double amount) { return amount / (1e9 * median(times[i])); };
  report.heading("peak of one thread, per ns");
  report.row("operations in float", {{"", per_ns(0, 2.0 * lanes<float> * rounds)}});
  report.row("operations in double", {{"", per_ns(1, 2.0 * lanes<double> * rounds)}});
  report.row("bytes of the second-level cache", {{"", per_ns(2, 8.0 * static_cast<double>(near.size()))}});
  report.row("bytes of memory", {{"", per_ns(3, 8.0 * static_cast<double>(far.size()))}});
  report.heading("surveys of " + std::to_string(pulses) + " pulses of 19 subrays, ns a pulse");
  for (std::size_t i = 0; i < 3; ++i)
    report.row(surveys[i].first, {{"", 1e9 * median(times[4 + i]) / static_cast<double>(pulses)}});
}
