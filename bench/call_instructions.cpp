// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Parts as those of instructions.cpp, of single calls of surveys. In a program of their own, as code that is added to a
// file changes what the compiler inlines in the rest of it.

#include <cstdio>
#include <memory>

#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/material/weather.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "scenes.hpp"
#include "surveys.hpp"

using namespace bench;

namespace {

/// Calls a survey for `count` slots with one workspace, each `step` slots after the one before, modulo its size; the
/// sum of the ranges.
template <class Survey>
double sum_of_calls(const Survey& survey, PulseIndex count, PulseIndex step = 1) {
  auto workspace = survey.workspace();
  double sum = 0;
  for (PulseIndex n = 0; n < count; ++n)
    for (const Echo& echo : survey(n * step % survey.size(), workspace).echoes) sum += echo.range;
  return sum;
}

/// A flight 100 m above the plane.
auto low_flight() {
  return Platform{
      StraightLine{.from = {0, -450, 100}, .to = {0, 450, 100}, .speed = 10},
      Mount{.boresight = extrinsic({{axis::right, -90_deg}, {axis::up, -90_deg}})},
      Deflector{OscillatingMirror{.cycle_rate = 50_Hz, .half_angle = 20_deg},
                Scanner{.pulse_rate = 100_kHz, .pulses = 1'000, .laser = {.wavelength = 905_nm, .peak_power = 500_W}}}};
}

}  // namespace

extern "C" {

/// Slots in order.
[[gnu::noinline]] double budget_calls_in_order(const Scene<Mesh>& street) {
  return sum_of_calls(Survey{car(6'007), SunflowerFootprint{7}, street, Receiver{}, FirstHit{}}, 6'000);
}

/// Slots out of order.
[[gnu::noinline]] double budget_calls_anyhow(const Scene<Mesh>& street) {
  return sum_of_calls(Survey{car(6'007), SunflowerFootprint{7}, street, Receiver{}, FirstHit{}}, 6'000, 1'999);
}

/// Receiver with a bandwidth and noise.
[[gnu::noinline]] double budget_noisy_receiver(const Scene<Mesh>& plane) {
  const ReceiverChain chain{
      .bandwidth = 200e6, .noise_power = 1e-13, .background = 1e-9, .shot_noise = true, .excess_noise = 3};
  const FullWaveform receiver{WaveformSettings{.threshold = 10e-9, .prominence = 5e-9}, NoWidth{},
                              BandLimitedReceiver{chain}};
  return sum_of_calls(Survey{low_flight(), SunflowerFootprint{7}, plane, Receiver{.range_max = 200}, receiver}, 20);
}

/// Plane seen through haze.
[[gnu::noinline]] double budget_haze(const Scene<Mesh>& plane) {
  const LightPaths light{.air = Media({{.medium = haze(2_km, 905_nm)}})};
  return sum_of_calls(
      Survey{low_flight(), SunflowerFootprint{7}, plane, light, Receiver{.range_max = 200}, FullWaveform{}}, 40);
}

}  // extern "C"

int main() {
  const auto town = street::scene(1);
  const auto plane = scene_of({.vertices = {{-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}},
                               .triangles = {{0, 1, 2}, {0, 2, 3}}});
  std::printf("calls_in_order %.9g\n", budget_calls_in_order(town));
  std::printf("calls_anyhow %.9g\n", budget_calls_anyhow(town));
  std::printf("noisy_receiver %.9g\n", budget_noisy_receiver(plane));
  std::printf("haze %.9g\n", budget_haze(plane));
}
