// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A user-defined map: balls in a row, without mesh or scene.
#include <cmath>
#include <iostream>
#include <optional>

#include <pulsecast/pulsecast.hpp>

using namespace pulsecast;
using namespace pulsecast::literals;

struct Balls {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    std::optional<Hit> nearest;
    for (std::uint32_t i = 0; i < 5; ++i) {
      const Vec3 to_centre = Vec3(3.0 * i - 6, 10, 1.7) - ray.origin;
      const double along = dot(to_centre, ray.direction);
      const double half_chord = std::sqrt(1 - dot(to_centre, to_centre) + along * along);
      const double range = along - half_chord;
      if (!(range >= ray.near && range <= ray.far) || (nearest && nearest->range < range)) continue;
      nearest = {.range = range, .cos_incidence = half_chord, .backscatter = 0.5 * half_chord, .object = i};
    }
    return nearest;
  }
};
static_assert(Target<Balls>);

int main() {
  const Balls balls;
  const Deflector mirror{PolygonMirror{.line_rate = 100_Hz, .angle_min = -60_deg, .angle_max = 60_deg},
                         Scanner{.pulses = 20'000}};
  const Platform platform{Tripod{}, Mount{.lever_arm = {0, 0, 1.7}, .boresight = rotation_about(axis::forward, 90_deg)},
                          mirror};
  const Survey survey{platform, LatticeFootprint{19}, balls, Receiver{}, FullWaveform{}};
  double sums[5] = {};
  int counts[5] = {};
  const RunSummary summary = run(survey, {}, [&](const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) {
        sums[echo.object] += echo.range;
        ++counts[echo.object];
      }
  });
  std::cout << summary.echoes << " echoes, " << summary.count(Fate::missed) << " pulses missed\n";
  for (int i = 0; i < 5; ++i) std::cout << counts[i] << ' ' << std::hexfloat << sums[i] << '\n';
}
