// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A plane that a beam meets at any angle: the range of its echo, and how it widens.

#include <cmath>
#include <optional>
#include <string>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/full_waveform.hpp>

#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

constexpr double range = 1000;
constexpr Laser laser{.pulse_length = 4e-9, .divergence = 0.3e-3};
constexpr double w = 0.15e-3 * range;  ///< the beam's radius there [m]

/// A white plane that the beam's axis meets at `range`, turned aside by an angle.
struct Slope {
  double angle;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double towards = std::cos(angle) * ray.direction.y + std::sin(angle) * ray.direction.x;
    return towards > 0 ? std::optional(Hit{range * std::cos(angle) / towards, towards, towards, 0, 0}) : std::nullopt;
  }
};

template <class D>
void widths(const char* name, const D& detector) {
  // Source: tau is the pulse's length by 3.3947, Carlsson et al. 2001; t^2 exp(-t/tau) is a gamma distribution of order
  // 3
  const double pulse = std::sqrt(3.0) * 4e-9 / 3.3946806708;
  for (const int angle : {0, 20, 40, 60, 70, 80}) {
    const auto echoes = one_pulse(Slope{radians(angle)}, SunflowerFootprint(2001), laser, vacuum, detector).echoes;
    REQUIRE(echoes.size() == 1);
    // Source: variances of a convolution add up; the irradiance of a Gaussian beam has a standard deviation of w / 2
    // along the slope
    const double closed = std::sqrt(pulse * pulse + std::pow(2 * w * std::tan(radians(angle)) / speed_of_light, 2) / 4);
    row(std::string(name) + ", plane tilted by " + std::to_string(angle) + " degrees: echo width [ns]", closed * 1e9,
        echoes[0].width * 1e9, angle == 80 ? 0.02 : 0.01);
  }
}

/// The largest error of the range over all tilts, as a share of the footprint's diameter.
template <class D>
double worst_range(std::size_t circles, const D& detector) {
  double worst = 0;
  for (int angle = 0; angle <= 80; ++angle) {
    const auto echoes = one_pulse(Slope{radians(angle)}, RingFootprint(circles), laser, vacuum, detector).echoes;
    REQUIRE(echoes.size() == 1);
    worst = std::fmax(worst, std::fabs(echoes[0].range - range));
  }
  return worst / (2 * w);
}

}  // namespace

TEST_CASE("echo width of a tilted plane") {
  widths("AnalyticWaveform", AnalyticWaveform<MomentWidth>{});
  widths("FullWaveform", FullWaveform<MomentWidth>{});
}

TEST_CASE("range of a tilted plane is that of the pulse's energy") {
  const char* text = "plane tilted by 0 to 80 degrees: largest error of the range [footprints]";
  const WaveformSettings settings{.timing = EchoTiming::true_range};
  row(Kind::consistency, std::string("AnalyticWaveform, 62 subrays, ") + text, 0,
      worst_range(5, AnalyticWaveform{settings}), 0.05);
  row(Kind::consistency, std::string("FullWaveform, 62 subrays, ") + text, 0, worst_range(5, FullWaveform{settings}),
      0.05);
  row(Kind::consistency, std::string("AnalyticWaveform, 279 subrays, ") + text, 0,
      worst_range(10, AnalyticWaveform{settings}), 0.05);
  row(Kind::consistency, std::string("FullWaveform, 279 subrays, ") + text, 0, worst_range(10, FullWaveform{settings}),
      0.05);
}
