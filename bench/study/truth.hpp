// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/echo.hpp>
#include <pulsecast/pulse.hpp>

/// Echoes of a pulse by a dense quadrature of the beam. Of the library it takes vectors, the settings of a laser and
/// constants: rays, surfaces, received power, sum of the pulses and peaks are its own.
namespace tradeoff {

using namespace pulsecast;

/// Plane, or what is on either side of an edge in it. Two-sided, as all surfaces here; Lambert's law.
struct Plane {
  Vec3 point{}, normal{};  ///< a point of it, which is also one of the edge [m]; unit normal
  double reflectance = 0.5;
  Vec3 inwards{};     ///< unit vector in the plane, from the edge to the side that is there; 0 without an edge
  double beyond = 0;  ///< reflectance of the other side; 0 if there is none
};
struct Cylinder {
  Vec3 point{}, axis{};  ///< a point of its axis [m]; unit vector along it
  double radius = 0, reflectance = 0.5;
};
struct Sphere {
  Vec3 point{};  ///< centre [m]
  double radius = 0, reflectance = 0.5;
};
using Surface = std::variant<Plane, Cylinder, Sphere>;

/// Fog between two distances along the beam, which is narrow there.
struct Fog {
  double from = 0, to = 0;                                    ///< [m]
  double extinction = 0, backscatter = 0;                     ///< [1/m], [1/(m sr)]
  [[nodiscard]] double passed(double range) const noexcept {  ///< share of the light that is left, both ways
    return std::exp(-2 * extinction * std::clamp(range - from, 0.0, to - from));
  }
};

/// Answer of a surface to a ray: distance [m], and reflectance times the cosine of incidence.
struct Answer {
  double range = std::numeric_limits<double>::infinity(), backscatter = 0;
};

[[nodiscard]] inline Answer answer(const Plane& s, const Vec3& origin, const Vec3& ray) noexcept {
  const double facing = dot(ray, s.normal), range = dot(s.point - origin, s.normal) / facing;
  if (!(range > 0)) return {};
  const double inside = dot(origin + range * ray - s.point, s.inwards);
  const double reflectance = inside >= 0 ? s.reflectance : s.beyond;
  return reflectance > 0 ? Answer{range, reflectance * std::fabs(facing)} : Answer{};
}
[[nodiscard]] inline Answer answer(const Sphere& s, const Vec3& origin, const Vec3& ray) noexcept {
  const Vec3 to = s.point - origin;
  const double along = dot(to, ray), across = dot(to - along * ray, to - along * ray), r2 = s.radius * s.radius;
  if (across > r2) return {};
  const double half = std::sqrt(r2 - across);
  return {along - half, s.reflectance * half / s.radius};
}
[[nodiscard]] inline Answer answer(const Cylinder& s, const Vec3& origin, const Vec3& ray) noexcept {
  const auto flat = [&](const Vec3& v) { return v - dot(v, s.axis) * s.axis; };  // square to the axis
  const Vec3 to = flat(s.point - origin), way = flat(ray);
  const double slowness = length(way), along = dot(to, way) / slowness;
  const Vec3 off = to - (along / slowness) * way;
  if (dot(off, off) > s.radius * s.radius) return {};
  const double half = std::sqrt(s.radius * s.radius - dot(off, off));
  return {(along - half) / slowness, s.reflectance * slowness * half / s.radius};
}

/// Instrument as the truth needs it.
struct Instrument {
  Laser laser{};
  double diameter = 0.15, efficiency = 0.99;  ///< of the receiver [m]
  double threshold = 0;                       ///< of an echo [W]

  /// Power from a surface of this backscatter, of the whole beam, in clear air [W]: the laser radar equation, with the
  /// solid angle of an aperture close by.
  [[nodiscard]] double power(double backscatter, double range) const noexcept {
    const double d2 = diameter * diameter;
    return laser.peak_power * efficiency * backscatter * d2 / (4 * range * range + d2);
  }
  /// Radius of the beam [m]. Source: ISO 11146-1:2005.
  [[nodiscard]] double radius(double range) const noexcept {
    return 0.5 * std::hypot(laser.waist_diameter, laser.divergence.across * (range - laser.waist_range));
  }
  /// Least distance of two surfaces that are two echoes [m]: half the length of a pulse.
  [[nodiscard]] double resolution() const noexcept { return 0.5 * speed_of_light * laser.pulse_length; }
};

/// Definition of an echo and its range.
struct EchoRule {
  double divisor = 3.394680670846503;  ///< full width at half maximum of the pulse by its time constant
  double window = 0.25;                ///< peaks this near are one [pulse lengths]
  bool by_mean = false;                ///< range: mean of the ranges between valleys, else that of the peak
};

/// Echo as it is compared: range [m], and intensity relative to a white surface at that range.
struct Point {
  double range, intensity;
};
using Points = std::vector<Point>;

/// Axes of a beam and its origin, in the frame of the scene.
struct Axes {
  Vec3 origin{}, across{1, 0, 0}, ahead{0, 1, 0}, above{0, 0, 1};
};

/// Light of a pulse by range.
struct Lit {
  std::vector<std::pair<double, double>> parts{};  ///< range [m], power if the pulse had no length [W]
};

/// Place in the beam, in units of its radius, and its share of the energy.
struct Place {
  Vec2 at;
  double share;
};

/// Quadrature of a Gaussian beam by about `points` places. With edges, all have the same energy: rings of equal energy,
/// each at its mean squared radius, have four times as many places as there are rings, turned by the golden angle from
/// ring to ring. Without edges they are on a square grid: its error falls exponentially for smooth functions. Source:
/// irradiance exp(-2 r^2 / w^2); Trefethen & Weideman 2014 for the grid.
[[nodiscard]] inline std::vector<Place> quadrature(std::size_t points, bool edges) {
  std::vector<Place> places;
  const double n = std::floor(std::sqrt(0.25 * static_cast<double>(points)));
  const auto integral = [](double q) { return q > 0 ? q - q * std::log(q) : 0; };  // of -log(q)
  for (double i = 0; i < n && edges; ++i) {
    const double q = 1 - i / n, radius = std::sqrt(0.5 * n * (integral(q) - integral(std::fmax(q - 1 / n, 0))));
    for (double k = 0; k < 4 * n; ++k) {
      const double turn = 2 * std::numbers::pi * (0.25 * k / n + i * (std::numbers::phi - 1));
      places.push_back({radius * Vec2(std::cos(turn), std::sin(turn)), 0.25 / (n * n)});
    }
  }
  constexpr double out = 2.8;  // radii, beyond which are 2e-7 of the energy
  const double step = 2 * out / std::sqrt(static_cast<double>(points));
  for (double x = -out; x <= out && !edges; x += step)
    for (double y = -out; y <= out; y += step)
      places.push_back({{std::cos(1.0) * x - std::sin(1.0) * y, std::sin(1.0) * x + std::cos(1.0) * y},
                        2 / std::numbers::pi * step * step * std::exp(-2 * (x * x + y * y))});
  return places;
}

/// Answer of a surface to a place in the beam, which keeps its place as the beam widens: rays of a beam with a waist
/// are not straight, so that a straight one is taken through the place at the surface's distance, found by iteration.
[[nodiscard]] inline Answer answer(const Surface& surface, const Instrument& instrument, const Axes& axes,
                                   const Vec2& place) noexcept {
  return std::visit(
      [&](const auto& s) {
        Answer found;
        double distance = length(s.point - axes.origin);
        for (int step = 0; step < (instrument.laser.from_a_point() ? 1 : 3); ++step) {
          const double slope = instrument.radius(distance) / distance;
          found =
              answer(s, axes.origin, normalize(axes.ahead + slope * (place.x * axes.across + place.y * axes.above)));
          if (found.range < std::numeric_limits<double>::infinity()) distance = found.range;
        }
        return found;
      },
      surface);
}

/// Light that comes back from the places of a quadrature.
[[nodiscard]] inline Lit light_of(const std::vector<Surface>& surfaces, const Fog& fog, const Instrument& instrument,
                                  const Axes& axes, const std::vector<Place>& places) {
  Lit lit;
  lit.parts.reserve(places.size());
  for (const auto& [place, share] : places) {
    Answer nearest;
    for (const Surface& surface : surfaces)
      if (const Answer a = answer(surface, instrument, axes, place); a.range < nearest.range) nearest = a;
    if (nearest.backscatter > 0)
      lit.parts.emplace_back(nearest.range,
                             share * instrument.power(nearest.backscatter, nearest.range) * fog.passed(nearest.range));
  }
  if (fog.to > fog.from) {  // a thin layer sends back as a white surface of pi times its backscatter; fog ends
    const double step = instrument.resolution() / 400;  // before the first surface
    for (double range = fog.from + step / 2; range < fog.to; range += step)
      lit.parts.emplace_back(range,
                             instrument.power(std::numbers::pi * fog.backscatter * step, range) * fog.passed(range));
  }
  return lit;
}

/// Echoes of the sum of pulses u^2 e^-u, one for each part of the light: on a grid of a two-hundredth of the time
/// constant, on which parts are shared out between neighbours, by the recurrence of its three moments. Peaks by the
/// parabola through three points.
[[nodiscard]] inline Points echoes_of(const Lit& lit, const Instrument& instrument, const EchoRule& rule) {
  if (lit.parts.empty()) return {};
  constexpr std::size_t steps = 200;
  const double tau = 0.5 * speed_of_light * instrument.laser.pulse_length / rule.divisor, h = 1.0 / steps,
               step = tau * h;  // [m], by half the way of light
  const auto [nearest, farthest] = std::minmax_element(lit.parts.begin(), lit.parts.end());
  const double first = nearest->first - 2 * step;
  std::vector<double> arriving(static_cast<std::size_t>((farthest->first - first) / step) + 30 * steps), sum;
  for (const auto& [range, power] : lit.parts) {
    const double at = (range - first) / step, whole = std::floor(at);
    const auto i = static_cast<std::size_t>(whole);
    arriving[i] += power * (whole + 1 - at);
    arriving[i + 1] += power * (at - whole);
  }
  double s0 = 0, s1 = 0, s2 = 0;
  const double fading = std::exp(-h), to_unit = std::exp(2.0) / 4;
  for (const double power : arriving) {
    s2 = fading * (s2 + 2 * h * s1 + h * h * s0);
    s1 = fading * (s1 + h * s0);
    s0 = fading * s0 + power;
    sum.push_back(to_unit * s2);
  }
  struct Peak {
    double at, height;       // [steps], [W]
    std::size_t begin, end;  // valleys [steps]
  };
  std::vector<Peak> peaks;
  const double window = rule.window * instrument.laser.pulse_length * 0.5 * speed_of_light / step;
  std::size_t valley = 0;
  for (std::size_t i = 1; i + 1 < sum.size(); ++i) {
    if (sum[i] <= sum[i - 1] && sum[i] < sum[i + 1]) {
      valley = i;
      if (!peaks.empty() && peaks.back().end == 0) peaks.back().end = i;
    }
    if (!(sum[i] > sum[i - 1] && sum[i] >= sum[i + 1] && sum[i] >= instrument.threshold)) continue;
    const double bend = sum[i - 1] - 2 * sum[i] + sum[i + 1], rise = 0.5 * (sum[i + 1] - sum[i - 1]);
    const Peak peak{static_cast<double>(i) - rise / bend, sum[i] - 0.5 * rise * rise / bend, valley, 0};
    if (!peaks.empty() && peak.at - peaks.back().at < window) {
      const Peak& higher = peak.height > peaks.back().height ? peak : peaks.back();
      peaks.back() = {higher.at, higher.height, peaks.back().begin, 0};
    } else {
      peaks.push_back(peak);
    }
  }
  Points points;
  for (const Peak& peak : peaks) {
    double range = first + peak.at * step - 2 * tau;
    if (rule.by_mean) {  // of what would peak between the valleys alone
      double weights = 0, ranges = 0;
      const std::size_t end = peak.end == 0 ? sum.size() : peak.end;
      for (std::size_t i = std::max(peak.begin, 2 * steps); i < end; ++i) {
        weights += arriving[i - 2 * steps];
        ranges += arriving[i - 2 * steps] * (first + step * static_cast<double>(i - 2 * steps));
      }
      if (weights > 0) range = ranges / weights;
    }
    points.push_back({range, peak.height / instrument.power(1, range)});
  }
  return points;
}

}  // namespace tradeoff
