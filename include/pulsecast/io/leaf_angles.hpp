// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_LEAF_ANGLES_HPP
#define PULSECAST_IO_LEAF_ANGLES_HPP

#include <filesystem>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/shape/leaf_angles.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Reads a table of leaf projections: rows of `x, y, z, G`, a unit direction and its G, in any
/// order, without a header; `#` begins a comment. Only the angle to the vertical counts: equal ones
/// need equal G. Gaps between rows are at most 10 degrees. G times the plant area density is the
/// extinction coefficient: 1/2 for spherical leaf angles (Ross 1981). Tables of HELIOS++ hold this
/// G; its division by 2 pi is not repeated. Throws a `FileError` with path and line, or for a gap.
[[nodiscard]] LeafAngles read_leaf_angles(const std::filesystem::path& path);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_LEAF_ANGLES)
#include <algorithm>
#include <array>
#include <cmath>

#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/io/detail/text/table.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

struct LeafRow {
  LeafProjection projection;
  std::size_t line = 0;
};

[[nodiscard]] inline LeafRow leaf_row(TextTable& table) {
  const std::vector<std::string_view>& cells = table.cells();
  if (cells.size() != 4) table.fail_here("has ", cells.size(), " columns: expected x, y, z and G");
  std::array<double, 4> values{};
  for (std::size_t column = 0; column < 4; ++column) {
    const std::optional<double> value = text::finite_number_in(cells[column]);
    const bool is_g = column == 3;
    if (!value || *value < (is_g ? 0 : -1.001) || *value > (is_g ? 1 : 1.001))
      table.refuse(column, is_g ? "G, the mean projection of unit leaf area, from 0 to 1"
                                : "a component of a unit direction, from -1 to 1");
    values[column] = *value;
  }
  const Vec3 direction{values[0], values[1], values[2]};
  if (!(std::fabs(length(direction) - 1) <= 1e-3))
    table.fail_here("the direction has the length ", length(direction), ": expected 1, within 1e-3");
  const double zenith = std::atan2(std::hypot(direction.x, direction.y), std::fabs(direction.z));
  return {{zenith, values[3]}, table.line()};
}

}  // namespace detail

PULSECAST_INLINE LeafAngles read_leaf_angles(const std::filesystem::path& path) {
  constexpr double same = 5e-6, widest = 10 * pi / 180 + same;  // six decimals: some 2e-6
  const auto tenths = [](double angle) { return std::round(degrees(angle) * 10) / 10; };
  TextTable table(path, "a table of leaf projections, x,y,z,G");
  std::vector<detail::LeafRow> rows;
  while (table.next())
    if (!table.text().starts_with('#')) rows.push_back(detail::leaf_row(table));
  if (rows.empty()) table.fail("has no rows: expected a table of leaf projections, x,y,z,G");
  std::ranges::stable_sort(rows, {}, [](const detail::LeafRow& row) { return row.projection.zenith; });

  // beyond the outermost rows, their values hold
  rows.insert(rows.begin(), {{0, rows.front().projection.g}, rows.front().line});
  rows.push_back({{pi / 2, rows.back().projection.g}, rows.back().line});

  std::vector<LeafProjection> result;
  std::size_t line = 0;  // line of the last row
  for (const auto& [projection, row] : rows) {
    const LeafProjection last = result.empty() ? projection : result.back();
    const double step = projection.zenith - last.zenith;
    if (step > widest)
      table.fail("has no row between ", tenths(last.zenith), " and ", tenths(projection.zenith),
                 " degrees from the vertical: expected one every 10 degrees at least");
    if (step <= same && std::fabs(projection.g - last.g) > 1e-3)
      detail::fail_at(table.path(), std::max(row, line), "differs in G from line ", std::min(row, line),
                      ", at the same zenith angle: expected one G for each zenith angle");
    if (step <= same && !result.empty()) continue;
    // a midpoint, as rounded rows 10 degrees apart may exceed the gap that `LeafAngles` bridges
    if (step > widest / 2) result.push_back({last.zenith + step / 2, (last.g + projection.g) / 2});
    result.push_back(projection);
    line = row;
  }
  return LeafAngles::table(std::move(result));
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
