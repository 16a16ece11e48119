// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <memory>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/shape/height_field.hpp>

/// Common ground, flight and clock of the programs `needs_*.cpp`, which differ in the other types that they contain.
namespace needs {

using namespace pulsecast;
using namespace pulsecast::literals;

/// Hills of 320,000 triangles, 1 km by 1 km.
[[nodiscard]] inline Raster ground() {
  constexpr std::uint32_t cells = 400;
  Raster raster{.columns = cells + 1, .rows = cells + 1, .first = {-500, 500}, .pixel = {2.5, 2.5}};
  for (std::uint32_t r = 0; r <= cells; ++r)
    for (std::uint32_t c = 0; c <= cells; ++c)
      raster.heights.push_back(
          static_cast<float>(20 * std::sin(c / 36.0) * std::cos(r / 28.0) + 2 * std::sin(c / 3.0 + r / 4.0)));
  return raster;
}

inline constexpr StraightLine flight{.from = {0, -450, 1250}, .to = {0, 450, 1250}, .speed = 60};
inline constexpr OscillatingMirror mirror{.cycle_rate = 50_Hz, .half_angle = 20_deg};
inline constexpr Scanner laser{
    .pulse_rate = 100_kHz,
    .pulses = 100'000,
    .laser = {.wavelength = 1550_nm, .peak_power = 5000_W, .pulse_length = 4_ns, .divergence = 0.25_mrad}};
[[nodiscard]] inline Mount mount() { return {.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})}; }

/// Prints the processor time of a pulse on this thread [ns], and the sum of all ranges [m], by which programs are
/// compared.
template <class S>
int go(const S& survey) {
  auto workspace = survey.workspace();
  double sum = 0;
  timespec from{}, to{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &from);
  for (PulseIndex i = 0; i < survey.size(); ++i)
    for (const Echo& echo : survey(i, workspace).echoes) sum += echo.range;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &to);
  const double passed =
      static_cast<double>(to.tv_sec - from.tv_sec) * 1e9 + static_cast<double>(to.tv_nsec - from.tv_nsec);
  std::printf("%.1f %.9g\n", passed / static_cast<double>(survey.size()), sum);
  return 0;
}

}  // namespace needs
