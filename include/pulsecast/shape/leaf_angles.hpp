// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_LEAF_ANGLES_HPP
#define PULSECAST_SHAPE_LEAF_ANGLES_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/search.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE {

/// Mean projection of leaves at one zenith angle.
struct LeafProjection {
  double zenith = 0;  ///< angle between the direction and the vertical, in [0, pi/2] [rad]
  double g = 0;       ///< of unit leaf area onto the plane across the direction, in [0, 1]
};

/// Leaf inclination distribution of a plant, uniform in azimuth and equal for both sides. It gives
/// G, the mean projection of unit leaf area onto the plane across a direction (Ross 1981), whose
/// mean over all directions is always 1/2. Spherical by default. Copies share their table.
class LeafAngles {
 public:
  LeafAngles() = default;

  /// Inclinations of a sphere's surface: G is 1/2 in all directions.
  [[nodiscard]] static LeafAngles spherical() { return {}; }

  // Densities of inclination, 0: horizontal. Source: de Wit 1965; closed: Goel & Strebel 1984.

  /// Mostly horizontal.
  [[nodiscard]] static LeafAngles planophile() { return of_density({.second = 1}); }
  /// Mostly vertical.
  [[nodiscard]] static LeafAngles erectophile() { return of_density({.second = -1}); }
  /// Mostly oblique.
  [[nodiscard]] static LeafAngles plagiophile() { return of_density({.fourth = -1}); }
  /// Mostly either horizontal or vertical.
  [[nodiscard]] static LeafAngles extremophile() { return of_density({.fourth = 1}); }
  /// Uniform in inclination.
  [[nodiscard]] static LeafAngles uniform() { return of_density({}); }

  /// Inclinations of an ellipsoid's surface, horizontal axes `chi` times the vertical: 1 is
  /// spherical. Source: Campbell 1986, exact surface. @throws SettingError unless 1e-6 to 1e6
  [[nodiscard]] static LeafAngles ellipsoidal(double chi) {
    require_within("LeafAngles::ellipsoidal (chi)", chi, 1e-6, 1e6, "");
    LeafAngles made;
    made.chi_ = chi;
    const double e = std::sqrt(chi < 1 ? 1 - chi * chi : 1 - 1 / (chi * chi));  // eccentricity
    if (chi != 1) made.half_surface_ = chi + (chi < 1 ? std::asin(e) / e : std::atanh(e) / (e * chi));
    made.find_upright();
    return made;
  }

  /// G by zenith angle, in any order without duplicates; linear in between, constant beyond the
  /// ends.
  /// @throws SettingError for values out of range, duplicates, or gaps of more than 10 degrees
  [[nodiscard]] static LeafAngles table(std::vector<LeafProjection> entries) {
    constexpr double widest = 10 * pi / 180 * (1 + 1e-6);
    for (const LeafProjection& entry : entries) {
      require_within("LeafProjection::zenith", entry.zenith, 0, pi / 2 * (1 + 1e-6), "rad");
      require_within("LeafProjection::g", entry.g, 0, 1, "");
    }
    std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.zenith < b.zenith; });
    double reached = 0;
    for (std::size_t i = 0; i < entries.size(); reached = entries[i++].zenith) {
      if (i > 0 && entries[i].zenith == reached) throw SettingError("LeafProjection::zenith", reached, "rad", "unique");
      require_no_hole(reached, entries[i].zenith, widest);
    }
    require_no_hole(reached, pi / 2, widest);
    return of_entries(std::move(entries));
  }

  /// G for light along a direction of any length but 0, z being vertical; within 1e-6.
  [[nodiscard]] double projection(const Vec3& direction) const noexcept {
    const double level = std::hypot(direction.x, direction.y), steep = std::fabs(direction.z);
    if (table_.empty()) return std::hypot(chi_ * steep, level) / (std::hypot(steep, level) * half_surface_);
    using Entry = LeafProjection;
    return detail::interpolated(table_, std::atan2(level, steep), &Entry::zenith, &Entry::g);
  }

  /// Cosine of incidence of a Lambertian surface across the light that sends back as the leaves do,
  /// per leaf area hit: their mean squared cosine by the mean cosine. 2/3 for spherical ones.
  [[nodiscard]] double incidence_cosine(const Vec3& direction) const noexcept {
    const double up = direction.z * direction.z / dot(direction, direction);
    const double mean_square = upright_ * up + 0.5 * (1 - upright_) * (1 - up);
    const double mean = projection(direction);
    return mean > 0 ? std::min(mean_square / mean, 1.0) : 1;
  }

  [[nodiscard]] std::size_t memory() const noexcept { return table_.memory(); }

  void archive(auto& a) { a(chi_, half_surface_, upright_, table_); }

 private:
  /// Zenith intervals of the table of G: linear interpolation is within 2e-7 of the integral.
  static constexpr std::size_t intervals = 2048;

  static void require_no_hole(double from, double to, double widest) {
    if (to - from > widest)
      throw SettingError("LeafProjection::zenith", from, "rad", "followed by another within 0.1745 rad");
  }

  /// Density of the inclination t: 2 / pi (1 + second cos 2t + fourth cos 4t).
  struct Density {
    double second = 0, fourth = 0;
    double operator()(double t) const noexcept {
      return 2 / pi * (1 + second * std::cos(2 * t) + fourth * std::cos(4 * t));
    }
  };

  static LeafAngles of_density(const Density& density) {
    const Nodes nodes;
    std::vector<LeafProjection> entries(intervals + 1);
    for (std::size_t i = 0; i <= intervals; ++i) {
      const double zenith = pi / 2 * static_cast<double>(i) / intervals;
      entries[i] = {zenith, projection(density, zenith, nodes)};
    }
    return of_entries(std::move(entries));
  }

  static LeafAngles of_entries(std::vector<LeafProjection> ascending) {
    LeafAngles made;
    made.table_ = SharedArray<LeafProjection>(std::move(ascending));
    made.find_upright();
    return made;
  }

  /// Finds the mean squared vertical component of the leaves' normals from G, by Simpson's rule:
  /// 1/3 and 16/3 of the integral of G times Legendre's polynomial of degree 2 over the zenith
  /// angle's cosine. Source: Funk-Hecke theorem; with the cosine's magnitude, it is 1/8.
  void find_upright() noexcept {
    constexpr int steps = 4096;
    double sum = 0;
    for (int i = 0; i <= steps; ++i) {
      const double u = static_cast<double>(i) / steps;
      const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
      sum += weight * projection({std::sqrt(1 - u * u), 0, u}) * (1.5 * u * u - 0.5);
    }
    upright_ = std::clamp((1 + 16 * sum / (3 * steps)) / 3, 0.0, 1.0);
  }

  /// Nodes and weights of a quadrature over [0, 1], exact for polynomials up to degree 47. Source:
  /// Gauss-Legendre; nodes by Newton's method (Press et al. 2007, section 4.6).
  struct Nodes {
    static constexpr std::size_t size = 24;
    std::array<double, size> at, weight;

    Nodes() noexcept {
      for (std::size_t i = 0; i < size; ++i) {
        double x = std::cos(pi * (static_cast<double>(i) + 0.75) / (size + 0.5)), slope = 0;
        for (int step = 0; step < 8; ++step) {
          double p = 1, before = 0;
          for (std::size_t n = 0; n < size; ++n) {
            const double k = static_cast<double>(n);
            before = std::exchange(p, ((2 * k + 1) * x * p - k * before) / (k + 1));
          }
          slope = size * (x * p - before) / (x * x - 1);
          x -= p / slope;
        }
        at[i] = (1 - x) / 2;
        weight[i] = 1 / ((1 - x * x) * slope * slope);
      }
    }
  };

  /// G at a zenith angle: integral over inclinations of density times mean projection, at any
  /// azimuth. Source: Ross 1981; Goel & Strebel 1984. Leaves below pi/2 - zenith show one side.
  static double projection(const Density& density, double zenith, const Nodes& nodes) noexcept {
    const double c = std::cos(zenith), s = std::sin(zenith), one_sided = pi / 2 - zenith;
    double sum = 0;
    for (std::size_t i = 0; i < Nodes::size; ++i) {
      const double u = nodes.at[i];
      const double lying = one_sided * u;
      sum += nodes.weight[i] * one_sided * density(lying) * c * std::cos(lying);
      if (s == 0) continue;
      const double standing = one_sided + zenith * u * u;  // grows as the root of the rest
      const double cos_t = std::cos(standing), sin_t = std::sin(standing);
      const double turn = std::acos(std::min(c * cos_t / (s * sin_t), 1.0));  // azimuth seen edge-on
      const double facing = c * cos_t * (1 - 2 / pi * turn) + 2 / pi * s * sin_t * std::sin(turn);
      sum += nodes.weight[i] * 2 * zenith * u * density(standing) * facing;
    }
    return sum;
  }

  double chi_ = 1, half_surface_ = 2;  ///< shape of the ellipsoid; a sphere unless there is a table
  double upright_ = 1.0 / 3;           ///< mean squared vertical component of the normals
  SharedArray<LeafProjection> table_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
