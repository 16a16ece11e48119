// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_VOLUME_PROFILE_HPP
#define PULSECAST_TRANSPORT_DETAIL_VOLUME_PROFILE_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Light that a medium scatters back, by range. Stretches between neighbours of the nodes, which are `a sinh(k / 16)` for an aperture of a
/// radius a, are added up; others are kept apart as long as there is room.
class VolumeProfile {
 public:
  ObjectId object = 0;               ///< label of the returns
  std::uint16_t classification = 0;  ///< label of the returns

  /// Distance of the nodes by the root of the squares of range and aperture: power by their inverse square is linear between them to 0.2 %.
  static constexpr double step = 0.0625;
  static constexpr std::size_t cells = 512;  ///< to 10^13 times the aperture

  /// Room for `capacity` other stretches.
  explicit VolumeProfile(std::size_t capacity) { parts_.reserve(capacity); }

  /// Greatest number of returns.
  [[nodiscard]] std::size_t size_max() const noexcept { return cells + parts_.capacity(); }

  /// Empties the profile; `aperture` is the radius [m]. All returns are within the gate.
  void begin(double aperture, const RangeGate& gate) noexcept {
    gate_ = gate;
    if (aperture != aperture_)
      for (std::size_t k = 0; k <= cells; ++k) nodes_[k] = aperture * std::sinh(step * static_cast<double>(k));
    aperture_ = aperture;
    parts_.clear();
    crowded_ = false;
    first_ = cells;
    end_ = 0;
  }

  /// Number of the cell that a range is in.
  [[nodiscard]] std::size_t cell_of(double range) const noexcept {
    const double place = range > 0 ? std::floor(std::asinh(range / aperture_) / step) : 0;
    auto k = static_cast<std::size_t>(std::min(place, static_cast<double>(cells - 1)));
    while (k + 1 < cells && nodes_[k + 1] <= range) ++k;
    return k;
  }
  /// Range at which a cell ends [m].
  [[nodiscard]] double end_of(std::size_t cell) const noexcept { return nodes_[cell + 1]; }

  /// Adds to a whole cell; densities of power in [W/m]. Returns the power [W].
  double add(std::size_t cell, double at_begin, double at_end) noexcept {
    if (first_ >= end_) first_ = end_ = cell;
    for (; end_ <= cell; ++end_) densities_[end_] = {};
    for (; first_ > cell;) densities_[--first_] = {};
    densities_[cell].begin += at_begin;
    densities_[cell].end += at_end;
    return 0.5 * (at_begin + at_end) * (nodes_[cell + 1] - nodes_[cell]);
  }
  /// Adds a stretch of ranges within a cell [m]. Returns the power [W]. If there is no room, cells take the light of all such stretches.
  double add(double begin, double end, double at_begin, double at_end) noexcept {
    const Part part{begin, end, {at_begin, at_end}};
    if (parts_.size() == parts_.capacity()) {
      for (const Part& other : parts_) spread(other);
      parts_.clear();
      crowded_ = true;
    }
    if (crowded_)
      spread(part);
    else
      parts_.push_back(part);
    return part.power();
  }

  /// Appends the returns in order of range.
  void append_to(std::vector<ContinuousReturn>& returns, ReflectionKind kind) noexcept {
    const auto nearer = [](const Part& a, const Part& b) { return a.from < b.from; };
    if (!std::is_sorted(parts_.begin(), parts_.end(), nearer)) std::sort(parts_.begin(), parts_.end(), nearer);
    auto part = parts_.begin();
    const auto append = [&](double from, double to, const Densities& by_range) {
      if (from < to && (by_range.begin > 0 || by_range.end > 0))
        returns.push_back({from, to, by_range.begin, by_range.end, object, classification, kind});
    };
    for (std::size_t k = first_; k < end_; ++k) {
      for (; part != parts_.end() && part->from < nodes_[k]; ++part) append(part->from, part->to, part->densities);
      const double from = std::max(nodes_[k], gate_.near), to = std::min(nodes_[k + 1], gate_.far), all = nodes_[k + 1] - nodes_[k];
      append(from, to, {densities_[k].begin * all / (to - from), densities_[k].end * all / (to - from)});
    }
    for (; part != parts_.end(); ++part) append(part->from, part->to, part->densities);
  }

 private:
  struct Densities {
    double begin = 0, end = 0;
  };
  struct Part {
    double from, to;
    Densities densities;
    [[nodiscard]] double power() const noexcept { return 0.5 * (densities.begin + densities.end) * (to - from); }
  };

  /// Spreads the light of a stretch over its cell.
  void spread(const Part& part) noexcept {
    const std::size_t k = cell_of(0.5 * (part.from + part.to));
    const double density = part.power() / (nodes_[k + 1] - nodes_[k]);
    add(k, density, density);
  }

  double aperture_ = 0;
  RangeGate gate_{};
  std::array<double, cells + 1> nodes_{};
  std::array<Densities, cells> densities_{};
  std::size_t first_ = cells, end_ = 0;  ///< cells in use
  std::vector<Part> parts_;
  bool crowded_ = false;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
