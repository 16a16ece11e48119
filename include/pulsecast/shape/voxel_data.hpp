// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_VOXEL_DATA_HPP
#define PULSECAST_SHAPE_VOXEL_DATA_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/base/vector.hpp>

namespace PULSECAST_NAMESPACE {

namespace detail {

/// Three numbers from -1 to 1, each within 5e-7; -1, 0 and 1 are exact.
class PackedVector {
 public:
  PackedVector() = default;
  explicit PackedVector(const std::array<float, 3>& v) noexcept {
    for (const float x : v)
      bits_ = bits_ << 21 | static_cast<std::uint64_t>(std::lround(std::clamp(x, -1.0F, 1.0F) * steps) + middle);
  }

  [[nodiscard]] Vec3 unpacked() const noexcept { return {part(42), part(21), part(0)}; }

 private:
  static constexpr double steps = 1048575;
  static constexpr std::int64_t middle = 1048576;

  double part(int shift) const noexcept {
    const auto number = static_cast<std::int64_t>(bits_ >> shift & 0x1FFFFF);
    return static_cast<double>(number - middle) / steps;
  }

  std::uint64_t bits_ = 0;
};

/// Reorders and converts a column of the data; empty for an empty column.
template <class To, class From>
[[nodiscard]] SharedArray<To> reordered(const From& column, std::span<const std::uint32_t> order) {
  std::vector<To> kept;
  if (column.empty()) return kept;
  kept.reserve(order.size());
  for (const std::uint32_t i : order) kept.push_back(To(column[i]));
  return kept;
}

}  // namespace detail

/// Data of a voxel grid: the occupied cells of a lattice of cubes, in any order, without
/// duplicates. Columns below `cells` have one entry per cell, or none.
struct VoxelData {
  Vec3 corner{};                                      ///< lower corner of the cell (0, 0, 0) [m]
  double edge = 1;                                    ///< edge of a cell [m]
  std::vector<std::array<std::uint32_t, 3>> cells{};  ///< cell coordinates along x, y and z
  std::vector<std::array<float, 3>> normals{};        ///< unit normal of the surface inside, or zero
  std::vector<float> densities{};                     ///< plant area density, at least 0 [m^2/m^3]
  std::vector<float> scales{};                        ///< edge of the cube inside by the cell's, in (0, 1]
  std::vector<std::array<float, 3>> shifts{};         ///< its centre from the cell's centre [cell edges]
  std::vector<std::uint16_t> materials{};             ///< index into the part's table

  /// Least edge of a lattice at a place [m]: coordinates there round by an eighth of it.
  [[nodiscard]] static double min_edge(const Vec3& place) noexcept {
    return 4 * std::numeric_limits<double>::epsilon() * max_norm(place);
  }

  /// Refuses invalid data, but for duplicate cells, which the grid finds. @throws SettingError
  void validate() const {
    constexpr double max_coordinate = 1e18;
    for (int k = 0; k < 3; ++k)
      if (!(std::fabs(corner[k]) <= max_coordinate))
        throw SettingError("VoxelData::corner", corner[k], "m", "within 1e18 m of the origin");
    require_positive("VoxelData::edge", edge, "m");
    if (!(edge >= min_edge(corner)))
      throw SettingError("VoxelData::edge", edge, "m",
                         "at least " + text::to_text(min_edge(corner)) + " at this distance from the origin");
    if (cells.empty()) throw SettingError("VoxelData::cells", 0, "", "at least one in number");
    if (cells.size() > 4294967294)
      throw SettingError("VoxelData::cells", count(cells), "", "at most 4294967294 in number");
    for (std::size_t i = 0; i < cells.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t at = cells[i][static_cast<std::size_t>(k)];
        if (!(std::fabs(corner[k] + edge * (at + 1.0)) <= max_coordinate))
          reject("cells", at, "a cell within 1e18 m of the origin", i);
      }
    require_entries("normals", normals);
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const double norm = std::hypot(normals[i][0], normals[i][1], normals[i][2]);
      if (!(norm == 0 || std::fabs(norm - 1) <= 1e-3)) reject("normals (length)", norm, "1, or 0 for no normal", i);
    }
    require_entries("densities", densities);
    for (std::size_t i = 0; i < densities.size(); ++i)
      if (!(densities[i] >= 0) || !std::isfinite(densities[i]))
        reject("densities", densities[i], "finite and at least 0", i);
    require_entries("scales", scales);
    for (std::size_t i = 0; i < scales.size(); ++i)
      if (!(scales[i] > 0 && scales[i] <= 1)) reject("scales", scales[i], "greater than 0 and at most 1", i);
    require_entries("shifts", shifts);
    for (std::size_t i = 0; i < shifts.size(); ++i) {
      const double room = (1 - (scales.empty() ? 1.0 : static_cast<double>(scales[i]))) / 2;
      for (const float shift : shifts[i])
        if (!(std::fabs(shift) <= room + 1e-6))
          reject("shifts", shift, "small enough that the cube is inside its cell", i);
    }
    require_entries("materials", materials);
  }

 private:
  static double count(const auto& column) noexcept { return static_cast<double>(column.size()); }

  [[noreturn]] static void reject(const char* field, double value, std::string allowed, std::size_t cell) {
    throw SettingError(std::string("VoxelData::") + field, value, "",
                       std::move(allowed) + "; see entry " + std::to_string(cell));
  }

  void require_entries(const char* field, const auto& column) const {
    if (column.empty() || column.size() == cells.size()) return;
    throw SettingError(std::string("VoxelData::") + field, count(column), "",
                       "as many as cells, " + std::to_string(cells.size()) + ", or none");
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
