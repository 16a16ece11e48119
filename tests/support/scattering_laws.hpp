// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <pulsecast/base/units.hpp>
#include <pulsecast/material/scattering_law.hpp>

#include "support/generators.hpp"

namespace pulsecast::support {

/// Kinds of laws that break a law by their nature.
struct ScatteringExceptions {
  bool peaked = false;   ///< backscatter has a peak that other directions do not have
  bool loses = false;    ///< light that is hidden from all directions
  bool one_way = false;  ///< not reciprocal, as a coat that weakens light on its way in only
};

/// Integral over the hemisphere about a normal of a function of a direction.
template <class F>
double over_hemisphere(const Vec3& normal, const F& f, int steps = 200) {
  const Vec3 x = normalize(cross(normal, std::fabs(normal.z) < 0.9 ? axis::up : axis::right)), y = cross(normal, x);
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double z = (i + 0.5) / steps, r = std::sqrt(1 - z * z);  // equal areas
    for (int k = 0; k < 2 * steps; ++k) {
      const double turn = pi * (k + 0.5) / steps;
      sum += f(r * std::cos(turn) * x + r * std::sin(turn) * y + z * normal);
    }
  }
  return sum * pi / steps / steps;
}

/// Names a broken law of a `ScatteringLaw`; empty if it keeps all.
template <ScatteringLaw Law>
std::string scattering_laws(const Law& law, const ScatteringExceptions& except = {}, double wavelength = 1.064e-6) {
  Generator random(1);
  for (double cosine = 0; cosine <= 1; cosine += 1.0 / 64) {
    const double back = law.backscatter(cosine, wavelength), share = law.scattered_share(cosine, wavelength);
    if (!(back >= 0)) return "backscatter is negative";
    if (!(share >= 0 && share <= 1)) return "scattered_share is not a share";
    if (law.backscatter(cosine, wavelength) != back) return "backscatter is not pure";
  }
  if constexpr (ScattersBetween<Law>) {
    const Vec3 normal = random.unit();
    const auto outside = [&] {
      const Vec3 d = random.unit();
      return dot(d, normal) < 0 ? -d : d;
    };
    for (int k = 0; k < 1000; ++k) {
      const Vec3 a = outside(), b = outside();
      const double ab = law.scattered(a, b, normal, wavelength) / dot(b, normal),
                   ba = law.scattered(b, a, normal, wavelength) / dot(a, normal);
      if (!except.one_way && !(std::fabs(ab - ba) <= 1e-9 * std::max(ab, ba))) return "scattered is not reciprocal";
      const double cosine = dot(a, normal), back = law.backscatter(cosine, wavelength);
      if (!except.peaked && !(std::fabs(law.scattered(a, a, normal, wavelength) - back) <= 1e-12 * back))
        return "backscatter is not scattered(in, in)";
    }
    for (int k = 0; k < 5; ++k) {
      const Vec3 in = outside();
      const double share = law.scattered_share(dot(in, normal), wavelength),
                   all = over_hemisphere(
                       normal, [&](const Vec3&out) { return law.scattered(in, out, normal, wavelength) / pi; });
      if (!(all <= share * 1.005) || (!except.loses && !(all >= share * 0.995)))
        return "scattered does not integrate to scattered_share";
    }
  }
  if constexpr (SamplesDirections<Law>) {
    const Vec3 normal = random.unit();
    const Vec3 in = normal;
    double area = 0;
    constexpr int n = 512;
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) area += 1 / law.sample(in, normal, (i + 0.5) / n, (k + 0.5) / n).density / n / n;
    if (!(std::fabs(area / (2 * pi) - 1) < 0.01)) return "the density of sample does not integrate to 1";
  }
  return {};
}

}  // namespace pulsecast::support
