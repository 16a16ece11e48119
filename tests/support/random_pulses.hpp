// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <pulsecast/echo.hpp>

#include "support/generators.hpp"

namespace pulsecast::support {

/// Pulses at a constant rate with none, one or two echoes each, and numbers of all sizes.
struct RandomPulses {
  std::vector<Shot> shots;
  std::vector<Echo> echoes;

  explicit RandomPulses(std::size_t count, std::uint64_t seed, double rate = 1000) {
    Generator random(seed);
    for (PulseIndex i = 0; i < count; ++i) {
      const auto returned = static_cast<std::uint32_t>(random.whole(3));
      shots.push_back({.index = i,
                       .tick = Tick::of(i, rate),
                       .origin = random.point(1e3),
                       .direction = random.unit(),
                       .channel = static_cast<std::uint16_t>(random.whole(64)),
                       .first_echo = static_cast<std::uint32_t>(echoes.size()),
                       .echoes = returned});
      for (std::uint32_t e = 0; e < returned; ++e)
        echoes.push_back(
            {.range = random.log_uniform(1e-3, 1e6),
             .amplitude = random.log_uniform(1e-12, 1),
             .reflectance = random.log_uniform(1e-6, 1e3),
             .width = random.coin() ? random.log_uniform(1e-12, 1e-6) : std::numeric_limits<double>::quiet_NaN(),
             .object = static_cast<ObjectId>(random.whole(std::uint64_t{1} << 32)),
             .classification = static_cast<std::uint16_t>(random.whole(1 << 16)),
             .number = static_cast<std::uint8_t>(e + 1),
             .velocity = random.coin() ? random.normal() : std::numeric_limits<double>::quiet_NaN()});
    }
  }

  [[nodiscard]] EchoBatch batch() const { return {.shots = shots, .echoes = echoes, .samples = {}}; }
};

}  // namespace pulsecast::support
