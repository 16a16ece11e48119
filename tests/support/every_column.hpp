// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <pulsecast/io/point_records.hpp>

namespace pulsecast::support {

/// Two points with all columns of the table, and their records, to be compared with what a format has stored. Colour
/// and surface of the second are unknown.
struct EveryColumn {
  std::array<Shot, 1> shots{{{.index = (PulseIndex{1} << 40) + 7,
                              .tick = {3, 0.25},
                              .origin = {1, 2, 3},
                              .direction = {0.6, 0, -0.8},
                              .scan_angle = 0.125,
                              .leg = 2,
                              .channel = 1,
                              .echoes = 2}}};
  std::array<Echo, 2> echoes{{{.range = 10,
                               .amplitude = 2e-9,
                               .reflectance = 0.5,
                               .width = 1e-9,
                               .cos_incidence = 0.75,
                               .object = 70'000,
                               .classification = 6,
                               .velocity = -3},
                              {.range = 20, .amplitude = 1e-9, .number = 2, .kind = ReflectionKind::glass}}};
  io::PointSettings settings{
      .rings = {5, 11},
      .surfaces = [](const EchoBatch&, const Shot&, const Echo& echo) -> std::optional<SurfaceInteraction> {
        if (echo.number == 2) return std::nullopt;
        return SurfaceInteraction{.normal = {0.6, 0, 0.8}, .material_index = 3, .part = 7, .velocity = {1, 2, 3}};
      },
      .colours = [](const EchoBatch&, const Shot&, const Echo& echo) -> std::optional<PointColour> {
        if (echo.number == 2) return std::nullopt;
        return PointColour{65535, 32896, 899, 13107};
      }};
  std::vector<io::PointField> fields = io::layouts::columns(io::point_columns);

  [[nodiscard]] EchoBatch batch() const { return {.shots = shots, .echoes = echoes, .samples = {}}; }

  /// Records of the points, in the types of the table or, without 64-bit integers, in doubles.
  [[nodiscard]] io::PointBuffer records(bool int64 = true) const {
    const io::PointLayout layout = io::PointLayout::packed(fields);
    io::PointBuffer points(int64 ? layout : layout.without_int64(), settings);
    points(batch());
    return points;
  }
  [[nodiscard]] static std::string bytes(const io::PointBuffer& points) {
    return {reinterpret_cast<const char*>(points.records().data()), points.records().size()};
  }
};

}  // namespace pulsecast::support
