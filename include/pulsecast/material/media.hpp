// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_MEDIA_HPP
#define PULSECAST_MATERIAL_MEDIA_HPP

#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/material/weather.hpp>

namespace PULSECAST_NAMESPACE {

/// Box of all places.
[[nodiscard]] inline Box everywhere() noexcept { return {Vec3(-detail::infinity), Vec3(detail::infinity)}; }

/// Medium in a part of the air: fog, rain, smoke, dust.
struct MediumRegion {
  Medium medium{};                            ///< medium, of index 1
  Box bounds = everywhere();                  ///< place [m]
  std::array<std::size_t, 3> cells{1, 1, 1};  ///< numbers of equal cells along x, y and z
  SharedArray<float> densities{};             ///< factors of the coefficients by cell, x fastest; empty: 1
  Precipitation particles{};                  ///< particles of mean `medium`, hit one by one while few

  /// Rain or snow in a box.
  [[nodiscard]] static MediumRegion of(const Precipitation& drops, const Box& bounds = everywhere()) noexcept {
    return {.medium = drops.medium(), .bounds = bounds, .particles = drops};
  }

  void validate() const {
    medium.validate();
    require_within("MediumRegion::medium (index)", medium.index, 1, 1, "");
    particles.validate();
    if (bounds.empty()) throw SettingError("MediumRegion::bounds (volume)", 0, "m^3", "greater than 0");
    if (densities.empty()) return;
    const Vec3 size = bounds.size();
    require_finite("MediumRegion::bounds (size, with densities)", size.x + size.y + size.z, "m");
    double count = 1;
    for (const std::size_t along : cells) count *= static_cast<double>(along);
    require_within("MediumRegion::densities (number)", densities.size(), count, count, "");
    for (const float density : densities) require_not_negative("MediumRegion::densities", density, "");
  }
};

/// Media in the air, in boxes, each inside another or apart: the innermost counts. Copies share.
class Media {
 public:
  /// Clear air.
  Media() = default;
  /// @throws SettingError for values out of range, or boxes that overlap, none inside the other
  explicit Media(std::vector<MediumRegion> regions) {
    for (std::size_t i = 0; i < regions.size(); ++i) {
      regions[i].validate();
      for (std::size_t k = 0; k < i; ++k) require_nested(regions[k].bounds, regions[i].bounds, i);
    }
    outermost_first(regions);
    uniform_ = regions.size() == 1 && regions[0].densities.empty() && regions[0].bounds == everywhere();
    regions_ = std::make_shared<const std::vector<MediumRegion>>(std::move(regions));
  }

  /// True for clear air.
  [[nodiscard]] bool empty() const noexcept { return !regions_ || regions_->empty(); }

  /// True if there are particles in any region.
  [[nodiscard]] bool has_particles() const noexcept {
    return !empty() && std::any_of(regions_->begin(), regions_->end(),
                                   [](const MediumRegion& r) { return r.particles.density > 0; });
  }

  /// Calls `visit(from, to, region, density)` with the stretches of a ray between two ranges [m]
  /// that are in a medium, in their order.
  void along(const Vec3& origin, const Vec3& direction, double near, double far, const auto& visit) const noexcept {
    if (empty()) return;
    if (uniform_) return near < far ? visit(near, far, regions_->front(), 1.0) : void();
    for (double from = near; from < far;) {
      const MediumRegion* innermost = nullptr;
      double to = far;
      Passage here;
      for (const MediumRegion& region : *regions_) {
        const Passage p = passage(origin, direction, region.bounds);
        if (!(p.in < p.out) || !(from < p.out)) continue;
        if (p.in > from) {
          to = std::min(to, p.in);
        } else {
          innermost = &region;
          here = p;
        }
      }
      if (innermost) {
        to = std::min(to, here.out);
        if (innermost->densities.empty())
          visit(from, to, *innermost, 1.0);
        else
          along_cells(origin, direction, from, to, *innermost, visit);
      }
      if (!(to > from)) return;
      from = to;
    }
  }

 private:
  struct Passage {
    double in = -detail::infinity, out = detail::infinity;
  };

  static Passage passage(const Vec3& origin, const Vec3& direction, const Box& box) noexcept {
    Passage p;
    for (int k = 0; k < 3; ++k) {
      if (direction[k] == 0) {
        if (!(origin[k] >= box.min[k] && origin[k] < box.max[k])) return {0, 0};
        continue;
      }
      const double a = (box.min[k] - origin[k]) / direction[k];
      const double b = (box.max[k] - origin[k]) / direction[k];
      p.in = std::max(p.in, std::min(a, b));
      p.out = std::min(p.out, std::max(a, b));
    }
    return p;
  }

  /// Visits the cells of a region between two ranges inside it.
  static void along_cells(const Vec3& origin, const Vec3& direction, double from, double to, const MediumRegion& region,
                          const auto& visit) noexcept {
    std::size_t cell[3];
    double edge[3];
    const Vec3 start = origin + from * direction;
    const std::size_t* const cells = region.cells.data();
    for (int k = 0; k < 3; ++k) {
      edge[k] = (region.bounds.max[k] - region.bounds.min[k]) / static_cast<double>(cells[k]);
      const double place = std::floor((start[k] - region.bounds.min[k]) / edge[k]);
      cell[k] = static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(cells[k] - 1)));
    }
    while (from < to) {
      double end = to;
      int through = 3;  // axis of the face
      for (int k = 0; k < 3; ++k) {
        if (direction[k] == 0) continue;
        const auto face = static_cast<double>(cell[k] + (direction[k] > 0 ? 1 : 0));
        const double plane = region.bounds.min[k] + edge[k] * face;
        const double range = std::max(from, (plane - origin[k]) / direction[k]);
        if (range < end) {
          end = range;
          through = k;
        }
      }
      const std::size_t at = cell[0] + cells[0] * (cell[1] + cells[1] * cell[2]);
      const auto density = static_cast<double>(region.densities[at]);
      if (end > from && density > 0) visit(from, end, region, density);
      from = end;
      if (through == 3) return;
      const bool up = direction[through] > 0;
      if (up ? cell[through] + 1 == cells[through] : cell[through] == 0) return;
      up ? ++cell[through] : --cell[through];
    }
  }

  static bool inside(const Box& inner, const Box& outer) noexcept {
    for (int k = 0; k < 3; ++k)
      if (!(inner.min[k] >= outer.min[k] && inner.max[k] <= outer.max[k])) return false;
    return true;
  }
  static void require_nested(const Box& a, const Box& b, std::size_t number) {
    for (int k = 0; k < 3; ++k)
      if (!(a.min[k] < b.max[k] && b.min[k] < a.max[k])) return;
    if (inside(a, b) == inside(b, a))
      throw SettingError("Media (region)", static_cast<double>(number), "",
                         "one that is inside another, around it, or apart from it");
  }
  /// Sorts nested boxes, so that each comes after those that it is inside of.
  static void outermost_first(std::vector<MediumRegion>& regions) {
    std::vector<std::size_t> around(regions.size());
    for (std::size_t i = 0; i < regions.size(); ++i)
      for (std::size_t k = 0; k < regions.size(); ++k)
        around[i] += inside(regions[i].bounds, regions[k].bounds) ? 1 : 0;
    std::vector<MediumRegion> sorted;
    for (std::size_t depth = 0; depth <= regions.size(); ++depth)
      for (std::size_t i = 0; i < regions.size(); ++i)
        if (around[i] == depth) sorted.push_back(regions[i]);
    regions = std::move(sorted);
  }

  std::shared_ptr<const std::vector<MediumRegion>> regions_{};
  bool uniform_ = false;  ///< true if a single medium is everywhere
};

}  // namespace PULSECAST_NAMESPACE

#endif
