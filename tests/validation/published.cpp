// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Echoes of roofs and spheres, and cross sections of targets, by single pulses: beside published figures and
// quadratures of the waveform.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

constexpr double circle = std::numbers::pi;
constexpr double light = 299'792'458;  // [m/s]

// ------------------------------------------------------------------------- waveforms by quadrature

/// Light that returns from a range.
struct Lit {
  double range, power;  ///< range [m]; power, of all light from a white wall that faces the beam
};

/// Outgoing pulse at a time since its peak, which is 1. Source: Carlsson, Steinvall & Letalick 2001, eq. 4.5, tau the
/// pulse length by 3.3947.
double outgoing(double t, double length) {
  const double u = t / (length / 3.3946806708) + 2;
  return u > 0 ? 0.25 * u * u * std::exp(2 - u) : 0;
}

/// Received power at evenly spaced times.
struct Curve {
  double first, step;     ///< time of the first sample, and between two [s]
  std::vector<double> y;  ///< power, of the peak of a white wall that faces the beam
};

Curve received(const std::vector<Lit>& lit, double length) {
  Curve c{2 * lit.front().range / light - 3 * length, length / 400, {}};
  for (double t = c.first; t < 2 * lit.back().range / light + 12 * length; t += c.step) {
    double sum = 0;
    for (const Lit& l : lit) sum += l.power * outgoing(t - 2 * l.range / light, length);
    c.y.push_back(sum);
  }
  return c;
}

double maximum(const Curve& c) { return *std::max_element(c.y.begin(), c.y.end()); }

/// Power at a time, linear between two samples.
double at(const Curve& c, double time) {
  const double x = (time - c.first) / c.step;
  if (!(x >= 0) || x + 1 >= static_cast<double>(c.y.size())) return 0;
  const auto i = static_cast<std::size_t>(x);
  return c.y[i] + (x - static_cast<double>(i)) * (c.y[i + 1] - c.y[i]);
}

/// Range of a curve's echo, without correction [m].
double reading(const Curve& c, EchoTiming timing, double threshold) {
  const auto range = [&](double sample) { return 0.5 * light * (c.first + sample * c.step); };
  const double top = maximum(c);
  double level = timing == EchoTiming::leading_edge ? threshold : 0.5 * top;
  std::size_t i = 0;
  if (timing == EchoTiming::peak) {
    while (c.y[i] < top) ++i;
    return range(static_cast<double>(i) + 0.5 * (c.y[i - 1] - c.y[i + 1]) / (c.y[i - 1] - 2 * c.y[i] + c.y[i + 1]));
  }
  if (timing == EchoTiming::centroid) {
    double sum = 0, first = 0;
    level = 0.1 * top;
    for (; i < c.y.size(); ++i) {
      const double above = std::max(c.y[i] - level, 0.0);
      sum += above;
      first += above * static_cast<double>(i);
    }
    return range(first / sum);
  }
  while (c.y[i + 1] < level) ++i;
  return range(static_cast<double>(i) + (level - c.y[i]) / (c.y[i + 1] - c.y[i]));
}

/// Timings that read the samples.
constexpr EchoTiming timings[] = {EchoTiming::leading_edge, EchoTiming::constant_fraction, EchoTiming::centroid,
                                  EchoTiming::peak};

const char* name_of(EchoTiming timing) {
  constexpr const char* names[]{"mean of true ranges", "maximum", "leading edge", "constant fraction",
                                "centre of gravity"};
  return names[static_cast<std::size_t>(timing)];
}

// ----------------------------------------------------------------------------------------- targets

/// A white roof that the beam's axis meets at a range, turned aside by an angle.
struct Roof {
  double range, angle;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double towards = std::cos(angle) * ray.direction.y + std::sin(angle) * ray.direction.x;
    return Hit{range * std::cos(angle) / towards, towards, towards, 0, 0};
  }
};

/// A Lambertian sphere on the beam's axis, whose front is at a range.
struct Ball {
  double range, radius, reflectance = 1;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const Vec3 centre{0, range + radius, 0};
    const double aside = length(cross(centre, ray.direction));
    if (!(aside < radius)) return std::nullopt;
    const double depth = std::sqrt(radius * radius - aside * aside);
    return Hit{dot(centre, ray.direction) - depth, depth / radius, reflectance * depth / radius, 0, 0};
  }
};

constexpr double far_off = 10'000;                       ///< range at which beams are all but parallel [m]
constexpr Laser one_metre{.divergence = 1.0 / far_off};  ///< beam whose footprint has a diameter of 1 m there
constexpr double deviation = 0.25;                       ///< of that footprint's light, along any axis [m]
const SunflowerFootprint sunflower(2001);

/// Power received from a white wall that fills the footprint [W].
double white_wall(const Laser& laser) {
  return laser.peak_power * std::pow(0.5 * vacuum.diameter / far_off, 2) * vacuum.efficiency;
}

/// Light of a Gaussian footprint on a white roof.
std::vector<Lit> on_roof(double angle) {
  std::vector<Lit> lit;
  constexpr int n = 400;
  double sum = 0;
  for (int k = -n; k <= n; ++k) {
    const double x = 5.0 * k / n;  // deviations
    lit.push_back({far_off + x * deviation * std::tan(angle), std::exp(-0.5 * x * x) * std::cos(angle)});
    sum += std::exp(-0.5 * x * x);
  }
  for (Lit& l : lit) l.power /= sum;
  return lit;
}

/// Light of a Gaussian footprint on a white sphere about its axis.
std::vector<Lit> on_ball(double radius) {
  std::vector<Lit> lit;
  constexpr int n = 2000;
  for (int k = 0; k < n; ++k) {
    const double r = (k + 0.5) / n * radius, cosine = std::sqrt(1 - r * r / (radius * radius));
    lit.push_back(
        {far_off + radius * (1 - cosine),
         r / (deviation * deviation) * std::exp(-0.5 * r * r / (deviation * deviation)) * radius / n * cosine});
  }
  return lit;
}

/// Standard deviation of two-way times [s].
double spread(const std::vector<Lit>& lit) {
  double sum = 0, first = 0, second = 0;
  for (const Lit& l : lit) {
    const double t = 2 * (l.range - far_off) / light;
    sum += l.power;
    first += l.power * t;
    second += l.power * t * t;
  }
  return std::sqrt(second / sum - first * first / sum / sum);
}

std::vector<Lit> lit_by(const Result& result) {
  std::vector<Lit> lit;
  for (const SubrayRecord& hit : result.subrays)
    if (hit.met()) lit.push_back({hit.range, hit.power});
  return lit;
}

// ---------------------------------------------------------------------------------- cross sections

/// Even light over the disc of a beam's 1/e^2 radius.
class EvenFootprint {
 public:
  [[nodiscard]] std::size_t size() const noexcept { return 200'000; }
  [[nodiscard]] double share(std::size_t) const noexcept { return 1.0 / 200'000; }
  [[nodiscard]] Vec2 offset(std::size_t j) const noexcept {
    const double r = std::sqrt((static_cast<double>(j) + 0.5) / 200'000),
                 turn = static_cast<double>(j) * circle * (3 - std::sqrt(5.0));
    return {r * std::cos(turn), r * std::sin(turn)};
  }
};
static_assert(Footprint<EvenFootprint>);

constexpr double range = 1000, divergence = 1e-3, reflectance = 0.3;
const Receiver lossy{.diameter = 0.1, .efficiency = 0.6, .visibility = vacuum.visibility};

/// Backscatter cross section by received power [m^2]. Source: the radar equation of Wagner et al. 2006, solved for it.
template <class Map, class Pattern>
double cross_section(const Map& map, const Pattern& footprint) {
  const Laser laser{.divergence = divergence};
  return one_pulse(map, footprint, laser, lossy).power * 4 * circle * std::pow(range, 4) * divergence * divergence /
         (laser.peak_power * lossy.diameter * lossy.diameter * lossy.efficiency);
}

/// A square plate of two triangles on the beam's axis, turned aside by an angle.
Scene<TriangleMesh<>> plate(double side, double angle) {
  const Vec3 across = 0.5 * side * Vec3{std::cos(angle), std::sin(angle), 0}, up = 0.5 * side * axis::up,
             centre{0, range, 0};
  const MeshData data{{centre - across - up, centre + across - up, centre + across + up, centre - across + up},
                      {{0, 1, 2}, {0, 2, 3}}};
  return Scene<TriangleMesh<>>(
      {{std::make_shared<const TriangleMesh<>>(data), material_table({Material{.reflectance = reflectance}}), {}, 1}});
}

}  // namespace

TEST_CASE("ranges of a roof by timings of its echo") {
  const double angle = circle / 4, length = one_metre.pulse_length;
  const Curve roof = received(on_roof(angle), length);
  for (const int part : {10, 20, 30}) {
    const double threshold = 1.0 / part;
    const auto simulated = [&](EchoTiming timing) {
      const FullWaveform detector{WaveformSettings{.threshold = threshold * white_wall(one_metre), .timing = timing}};
      const auto echoes = one_pulse(Roof{far_off, angle}, sunflower, one_metre, vacuum, detector).echoes;
      REQUIRE(echoes.size() == 1);
      return echoes[0].range - far_off;
    };
    const std::string head =
        "roof of 45 degrees, footprint of 1 m, threshold 1/" + std::to_string(part) + " of a wall's peak: ";
    double least = 1, most = -1, nearest = 1, farthest = -1;
    for (const EchoTiming timing : timings) {
      // corrected as instruments are, by a flat target of ten thresholds
      const double expected =
          reading(roof, timing, threshold) - reading(received({{far_off, 10 * threshold}}, length), timing, threshold);
      const double found = simulated(timing);
      if (part == 20) row(head + name_of(timing) + " [m]", expected, found, 0.002);
      least = std::min(least, expected);
      most = std::max(most, expected);
      nearest = std::min(nearest, found);
      farthest = std::max(farthest, found);
    }
    row(head + "greatest difference of these ranges [m]", most - least, farthest - nearest, 0.002);
    if (part != 20) continue;
    row(Kind::bound, head + name_of(EchoTiming::true_range) + " [m]", 0, simulated(EchoTiming::true_range), 0.002);
    row(Kind::published, "the same; about 0.4 in Wagner et al. 2004 [m]", 0.4, farthest - nearest, 0.05);
  }
}

TEST_CASE("range of a wall by timings of its echo") {
  for (const EchoTiming timing : timings)
    for (const double record : {0.0, 100e-9}) {
      const FullWaveform detector{
          WaveformSettings{.threshold = 0.1 * white_wall(one_metre), .timing = timing, .record_length = record}};
      const auto echoes = one_pulse(Roof{far_off, 0}, sunflower, one_metre, vacuum, detector).echoes;
      REQUIRE(echoes.size() == 1);
      row(Kind::bound,
          std::string("wall, ") + (record > 0 ? "waveform kept: " : "no waveform kept: ") + name_of(timing) + " [m]", 0,
          echoes[0].range - far_off, 0.001);
    }
}

TEST_CASE("times of light from slopes and spheres") {
  for (const int angle : {20, 45, 70}) {
    const auto lit = lit_by(one_pulse(Roof{far_off, angle * circle / 180}, sunflower, one_metre));
    // a Gaussian footprint on a plane is a Gaussian in time; slopes and spheres as in Jutzi & Stilla 2006, ISPRS
    // Archives 36-3
    row("slope of " + std::to_string(angle) + " degrees, footprint of 1 m: deviation of times [ns]",
        1e9 * 2 * std::tan(angle * circle / 180) * deviation / light, 1e9 * spread(lit), 0.005);
  }
  const Laser laser{.pulse_length = 1e-9, .divergence = one_metre.divergence};
  const double pulse = std::sqrt(3.0) * 1e-9 / 3.3946806708,
               interval = 1e-9 / 16;  // deviation of (t/tau)^2 exp(-t/tau): sqrt(3) tau
  for (const double radius : {0.25, 0.5, 1.0}) {
    char head[64];
    std::snprintf(head, sizeof head, "sphere of radius %g m, footprint of 1 m: ", radius);
    const FullWaveform<MomentWidth> detector{
        {.sample_interval = interval, .threshold = 1e-4 * white_wall(laser), .record_length = 100 * interval}};
    const Result found = one_pulse(Ball{far_off, radius}, sunflower, laser, vacuum, detector);
    REQUIRE(found.echoes.size() == 1);
    const auto lit = on_ball(radius);
    row(std::string(head) + "deviation of times [ns]", 1e9 * spread(lit), 1e9 * spread(lit_by(found)), 0.005);
    row(std::string(head) + "width of the echo [ns]", 1e9 * std::hypot(spread(lit), pulse), 1e9 * found.echoes[0].width,
        0.005);
    const Curve expected = received(lit, laser.pulse_length);
    double worst = 0;
    for (std::size_t i = 0; i < found.waveform.size(); ++i) {
      const double y = static_cast<double>(found.waveform[i]) / white_wall(laser);
      worst = std::max(worst, std::fabs(y - at(expected, found.waveform_start + static_cast<double>(i) * interval)));
    }
    row(std::string(head) + "greatest error of a sample, of the maximum", 0, worst / maximum(expected), 0.01);
  }
}

TEST_CASE("backscatter cross sections") {
  const EvenFootprint even;
  const double side = 0.1, area = side * side, radius = 0.05, w = 0.5 * divergence * range;
  // Source: Wagner et al. 2006: 4 pi / Omega rho A, Omega = pi of a Lambertian surface; A is the footprint's
  // if the surface fills it
  row("wall, reflectance 0.3, even light of 1 mrad, 1 km: cross section [m^2]",
      circle * reflectance * range * range * divergence * divergence, cross_section(plate(4, 0), even), 1e-4);
  row("plate of 0.1 m in that light: cross section [m^2]", 4 * reflectance * area, cross_section(plate(side, 0), even),
      2e-5);
  const double facing = 0.5;  // cosine: of the light that is met, and of that which is sent back
  row("the same, turned by 60 degrees: cross section [m^2]", 4 * reflectance * area * facing * facing,
      cross_section(plate(side, circle / 3), even), 2e-5);
  // the squared cosine integrated over the hemisphere's area: 2 pi a^2 / 3
  row("sphere of radius 0.05 m in that light: cross section [m^2]", 4 * reflectance * 2 * circle * radius * radius / 3,
      cross_section(Ball{range - radius, radius, reflectance}, even), 2e-5);
  const double inside =
      std::pow(std::erf(std::sqrt(0.5) * side / w), 2);  // of a Gaussian beam's light, in the plate's square
  row("plate of 0.1 m on the axis of a Gaussian beam: power, of that in even light of its 1/e^2 diameter",
      inside * circle * w * w / area,
      cross_section(plate(side, 0), SunflowerFootprint(100'000)) / (4 * reflectance * area), 0.01);
}
