// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include <pulsecast/pulsecast.hpp>

#include "../../examples/tree.hpp"
#include "errors.hpp"
#include "pulses.hpp"

/// Errors of footprints of n subrays in the energy that a Gaussian beam sends past an edge, or onto a wire. No scene,
/// no pulses.
namespace tradeoff {

struct Quadrature {
  double edge, wire;  ///< root of the mean square error, of the energy of the beam [%]
};

/// Edges pass anywhere out to the beam's 1/e^2 radius, and so do the axes of wires, whose width is a fifth to three
/// fifths of it. In any direction, or within a degree of upright or level.
[[nodiscard]] inline Quadrature quadrature(const Pattern& pattern, bool upright) {
  constexpr int lines = 4000;
  wood::Dice dice(31, upright ? 1 : 0);
  const auto inside = [](double x) {
    return 0.5 * std::erfc(-std::sqrt(2.0) * x);
  };  // of a standard deviation of half a radius
  Mean edge, wire;
  for (int k = 0; k < lines; ++k) {
    const double aslant = dice.between(-1, 1), direction = upright ? (k % 2) * pi / 2 + aslant * pi / 180 : pi * aslant;
    const double at = dice.between(-1, 1), half = dice.between(0.1, 0.3), x = std::cos(direction),
                 y = std::sin(direction);
    double past = 0, on = 0;
    for (std::size_t j = 0; j < pattern.size(); ++j) {
      const double across = pattern.offset(j).x * x + pattern.offset(j).y * y;
      past += across < at ? pattern.share(j) : 0;
      on += std::fabs(across - at) < half ? pattern.share(j) : 0;
    }
    edge.add(100 * (past - inside(at)));
    wire.add(100 * (on - (inside(at + half) - inside(at - half))));
  }
  return {edge.rms(), wire.rms()};
}

/// Writes them to a CSV file for all kinds and numbers of subrays.
inline void write_quadrature(std::FILE* out) {
  std::fprintf(out, "footprint,subrays,upright_edge_percent,upright_wire_percent,any_edge_percent,any_wire_percent\n");
  const auto write = [&](const Pattern& pattern) {
    const Quadrature upright = quadrature(pattern, true), any = quadrature(pattern, false);
    std::fprintf(out, "%s,%zu,%.4g,%.4g,%.4g,%.4g\n", pattern.kind().c_str(), pattern.size(), upright.edge,
                 upright.wire, any.edge, any.wire);
  };
  for (std::size_t circles = 1; circles <= 10; ++circles) write(rings(circles));
  for (const auto make : {sunflower, lattice})
    for (const std::size_t subrays :
         {1U, 3U, 4U, 5U, 7U, 9U, 10U, 13U, 15U, 18U, 19U, 25U, 31U, 37U, 46U, 62U, 93U, 130U, 173U, 223U, 279U})
      write(make(subrays));
}

}  // namespace tradeoff
