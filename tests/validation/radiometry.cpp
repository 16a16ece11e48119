// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Received power against range, for targets that fill the footprint in both directions, in one, or in none. Nothing in
// the radar equation of a subray knows which: the exponents come out of how many subrays hit.

#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/laws.hpp"
#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::validation;

namespace {

/// A Gaussian beam cut into cells that shrink towards its axis by a tenth each, so that targets a ten-thousandth of its
/// size are sampled as finely as those that fill it.
class Lens {
 public:
  Lens() {
    std::vector<double> edges{0, 1e-6};
    while (edges.back() < 2.5) edges.push_back(edges.back() * 1.1);
    for (std::size_t k = 0; k + 1 < edges.size(); ++k)
      for (const int side : {-1, 1}) {
        places_.push_back(side * (k == 0 ? 0.5e-6 : std::sqrt(edges[k] * edges[k + 1])));
        // share of a Gaussian beam in a strip. Source: irradiance exp(-2 r^2 / w^2), integrated
        shares_.push_back(std::erf(std::sqrt(2.0) * edges[k + 1]) - std::erf(std::sqrt(2.0) * edges[k]));
      }
    const double sum = std::accumulate(shares_.begin(), shares_.end(), 0.0);
    for (double& share : shares_) share /= sum;
  }

  [[nodiscard]] std::size_t size() const noexcept { return places_.size() * places_.size(); }
  [[nodiscard]] Vec2 offset(std::size_t j) const noexcept {
    return {places_[j % places_.size()], places_[j / places_.size()]};
  }
  [[nodiscard]] double share(std::size_t j) const noexcept {
    return shares_[j % places_.size()] * shares_[j / places_.size()];
  }

 private:
  std::vector<double> places_, shares_;
};
static_assert(Footprint<Lens>);

struct Meadow {
  double range;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    return Hit{range / ray.direction.y, ray.direction.y, ray.direction.y, 0, 0};
  }
};

/// A white Lambertian cylinder across the beam, upright.
struct Wire {
  Vec3 centre;
  double radius;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double flat = std::hypot(ray.direction.x, ray.direction.y);
    const double aside = (centre.x * ray.direction.y - centre.y * ray.direction.x) / flat;
    if (!(std::fabs(aside) < radius)) return std::nullopt;
    const double depth = std::sqrt(radius * radius - aside * aside),
                 along = (centre.x * ray.direction.x + centre.y * ray.direction.y) / flat;
    return Hit{(along - depth) / flat, depth / radius, depth / radius, 0, 0};
  }
};

/// A white Lambertian sphere.
struct Ball {
  Vec3 centre;
  double radius;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double aside = length(cross(centre, ray.direction));
    if (!(aside < radius)) return std::nullopt;
    const double depth = std::sqrt(radius * radius - aside * aside);
    return Hit{dot(centre, ray.direction) - depth, depth / radius, depth / radius, 0, 0};
  }
};

constexpr Laser laser{.divergence = 1e-3};
constexpr double ranges[] = {10, 35, 120, 410, 1430, 5000};

/// Of the logarithm of power over that of range, by least squares.
template <class Power>
double slope(const Power& power) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const double range : ranges) {
    const double a = std::log(range), b = std::log(power(range));
    n += 1;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// The mean power of a target that is a little aside of the beam's axis, up to its own radius.
template <class Target>
double mean_power(double range, double radius) {
  static const Lens lens;
  support::Generator random(7);
  const int times = 8;
  double sum = 0;
  for (int k = 0; k < times; ++k)
    sum += one_pulse(Target{{random.uniform(-radius, radius), range, random.uniform(-radius, radius)}, radius}, lens,
                     laser)
               .power;
  return sum / times;
}

/// What a white surface that fills the footprint brings back [W]. Source: a disc on the axis of a Lambertian surface
/// holds sin^2 of half the angle that it subtends of what is scattered, by the cosine law; far off that is D^2 / (4
/// R^2), as in Winiwarter et al. 2022.
double extended(double range) {
  return laser.peak_power * std::pow(std::sin(std::atan(0.5 * vacuum.diameter / range)), 2) * vacuum.efficiency;
}

}  // namespace

TEST_CASE("the footprint for small targets keeps the law") { CHECK(support::footprint_laws(Lens{}) == ""); }

TEST_CASE("received power against range") {
  const SunflowerFootprint sunflower(2001);
  const double radius = 0.25e-3;  // a twentieth of the footprint's radius at 10 m
  row("meadow: exponent of power over range, 10 m to 5 km", -2,
      slope([&](double range) { return one_pulse(Meadow{range}, sunflower, laser).power; }), 0.01);
  row("wire: exponent of power over range, 10 m to 5 km", -3,
      slope([&](double range) { return mean_power<Wire>(range, radius); }), 0.01);
  row("small sphere: exponent of power over range, 10 m to 5 km", -4,
      slope([&](double range) { return mean_power<Ball>(range, radius); }), 0.01);
}

TEST_CASE("received power near by") {
  struct Case {
    const char* text;
    double range;
  };
  for (const Case& c :
       {Case{"half its diameter", 0.5 * vacuum.diameter}, {"its diameter", vacuum.diameter}, {"0.2 m", 0.2}})
    row(std::string("meadow before an aperture of 0.15 m, at ") + c.text + ": power, of what was sent",
        extended(c.range) / laser.peak_power,
        one_pulse(Meadow{c.range}, SunflowerFootprint(2001), laser).power / laser.peak_power, 1e-6);
}

TEST_CASE("received power at a range") {
  const double range = 1000, radius = 0.25e-3, w = 0.5e-3 * range;
  row("meadow at 1 km: power, of that by the radar equation", 1,
      one_pulse(Meadow{range}, SunflowerFootprint(2001), laser).power / extended(range), 1e-4);
  // a Gaussian beam's irradiance over the cosine of the surface, integrated: pi a / 2 of a cylinder's width, 2 pi a^2 /
  // 3 of a sphere's disc
  const double wire = extended(range) * std::sqrt(2 / pi) / w * pi * radius / 2;
  const double ball = extended(range) * 2 / (pi * w * w) * 2 * pi * radius * radius / 3;
  row("wire of 0.5 mm at 1 km: power, of that by the integral over its surface", 1,
      mean_power<Wire>(range, radius) / wire, 0.01);
  row("sphere of 0.5 mm at 1 km: power, of that by the integral over its surface", 1,
      mean_power<Ball>(range, radius) / ball, 0.01);
}
