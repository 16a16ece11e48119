// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_VOLUME_PROFILE_HPP
#define PULSECAST_TRANSPORT_DETAIL_VOLUME_PROFILE_HPP

#include <pulsecast/concepts.hpp>
#include <pulsecast/detector/radiometry.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Light that a medium scatters back, by range. Stretches between neighbouring nodes are added up;
/// others are kept apart as long as there is room.
class VolumeProfile {
 public:
  ObjectId object = 0;               ///< label of the returns
  std::uint16_t classification = 0;  ///< label of the returns

  static constexpr std::size_t cells = 512;

  /// Distance from a node to the next [m], where light has spread by `wide`, the root of the
  /// squares of range and aperture [m]: power by its inverse square is linear to 0.35 % there.
  /// Below a sixteenth of a pulse, of a length in range [m], only the mean counts.
  [[nodiscard]] static double step(double wide, double pulse) noexcept {
    return std::max(wide / 12, std::min(wide / 2, pulse / 16));
  }

  /// Room for `capacity` other stretches.
  explicit VolumeProfile(std::size_t capacity) { parts_.reserve(capacity); }

  /// Greatest number of returns.
  [[nodiscard]] std::size_t size_max() const noexcept { return cells + parts_.capacity() + 1; }

  /// Densities at the nodes of all light through a medium, the same for all pulses.
  struct Straight {
    LinkBudget budget{};
    double extinction = 0, backscatter = 0;
    std::size_t known = 0;                  ///< number of nodes
    std::array<double, cells + 1> density;  ///< [W/m]
    std::array<double, cells + 1> left;     ///< share that is there, on both ways
    std::array<double, cells + 1> power;    ///< of all cells before [W]
  };
  /// Those of a medium; none are known of another than before.
  [[nodiscard]] Straight& straight(const LinkBudget& budget, double extinction, double backscatter) noexcept {
    Straight& s = straight_;
    if (!(s.extinction == extinction && s.backscatter == backscatter && s.budget == budget)) {
      part_lit();
      forget();
      s.budget = budget;
      s.extinction = extinction;
      s.backscatter = backscatter;
      s.known = 0;
    }
    return s;
  }

  /// Empties the profile, for an aperture of a radius and a pulse of a length [m], within the gate.
  void begin(double aperture, double pulse, const RangeGate& gate) noexcept {
    gate_ = gate;
    if (aperture != aperture_ || pulse != pulse_) {
      for (std::size_t k = 0; k < cells; ++k) nodes_[k + 1] = nodes_[k] + step(std::hypot(nodes_[k], aperture), pulse);
      straight_.known = 0;
      forget();
    }
    aperture_ = aperture;
    pulse_ = pulse;
    parts_.clear();
    crowded_ = false;
    first_ = cells;
    end_ = 0;
    lit_ = {};
  }

  /// Number of the cell that a range is in.
  [[nodiscard]] std::size_t cell_of(double range) const noexcept {
    return std::min(first_not(cells, [&](std::size_t k) { return nodes_[k + 1] <= range; }), cells - 1);
  }
  /// Range at which a cell ends [m].
  [[nodiscard]] double end_of(std::size_t cell) const noexcept { return nodes_[cell + 1]; }

  /// Adds to a whole cell; densities of power in [W/m]. Returns the power [W].
  double add(std::size_t cell, double at_begin, double at_end) noexcept {
    if (first_ >= end_) first_ = end_ = cell;
    for (; end_ <= cell; ++end_) begins_[end_] = ends_[end_] = 0;
    for (; first_ > cell; --first_) begins_[first_ - 1] = ends_[first_ - 1] = 0;
    begins_[cell] += at_begin;
    ends_[cell] += at_end;
    return 0.5 * (at_begin + at_end) * (nodes_[cell + 1] - nodes_[cell]);
  }
  /// Adds to whole cells a share of light that is known. Returns the power [W].
  double add(std::size_t first, std::size_t end, double share) noexcept {
    while (first < end && !(straight_.power[first + 1] > straight_.power[first])) ++first;
    if (!(first < end && share > 0)) return 0;
    if (lit_.share == 0) lit_ = {first, end, 0};
    if (first != lit_.first) {
      add_known(first, end, share);
    } else {
      add_known(end, lit_.end, lit_.share);
      add_known(lit_.end, end, share);
      lit_ = {first, std::min(end, lit_.end), lit_.share + share};
    }
    return share * (straight_.power[end] - straight_.power[first]);
  }
  /// Adds a stretch of ranges within a cell [m]. Returns the power [W]. Cells take the rest.
  double add(double begin, double end, double at_begin, double at_end) noexcept {
    const Part part{begin, end, at_begin, at_end};
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

  /// Writes the returns in order of range, from a number on; there is room for `size_max()` more.
  /// Returns the number after the last. Those of known light stay if the last pulse had as much.
  std::size_t write_to(std::vector<ContinuousReturn>& returns, std::size_t count, ReflectionKind kind) noexcept {
    if (parts_.empty() && first_ >= end_ && lit_.share == 0) return count;
    const auto nearer = [](const Part& a, const Part& b) { return a.from < b.from; };
    if (!std::is_sorted(parts_.begin(), parts_.end(), nearer)) std::sort(parts_.begin(), parts_.end(), nearer);
    const auto parts_from = [&](double range) {
      return std::lower_bound(parts_.begin(), parts_.end(), Part{range, 0, 0, 0}, nearer);
    };
    if ((first_ < end_ && first_ < lit_.end) || parts_from(nodes_[lit_.first]) != parts_from(nodes_[lit_.end]))
      part_lit();
    const std::size_t most = count + parts_.size() + (end_ > first_ ? end_ - first_ : 0) + lit_.end - lit_.first + 1;
    if (returns.size() < most) returns.resize(most);
    const auto append = [&](double from, double to, double at_begin, double at_end) noexcept {
      returns[count] = {from, to, at_begin, at_end, object, classification, kind};
      count += from < to && at_begin + at_end > 0 ? 1 : 0;
    };
    auto part = parts_.begin();
    const auto append_parts = [&](double before) noexcept {
      for (; part != parts_.end() && part->from < before; ++part)
        append(part->from, part->to, part->at_begin, part->at_end);
    };
    if (lit_.share > 0) {
      append_parts(nodes_[lit_.first]);
      if (count != written_at_ || lit_.first != written_.first || lit_.share != written_.share)
        written_.end = lit_.first;
      written_at_ = count;
      const auto density = [&](std::size_t k) noexcept { return lit_.share * straight_.density[k]; };
      for (std::size_t k = written_.end; k < lit_.end; ++k)
        returns[count + k - lit_.first] = {nodes_[k], nodes_[k + 1],  density(k), density(k + 1),
                                           object,    classification, kind};
      written_ = lit_;
      count += lit_.end - lit_.first;
    } else {
      forget();
    }
    for (std::size_t k = first_; k < end_; ++k) {
      append_parts(nodes_[k]);
      if (nodes_[k] >= gate_.near && nodes_[k + 1] <= gate_.far) {
        append(nodes_[k], nodes_[k + 1], begins_[k], ends_[k]);
        continue;
      }
      const double from = std::max(nodes_[k], gate_.near), to = std::min(nodes_[k + 1], gate_.far);
      const double denser = (nodes_[k + 1] - nodes_[k]) / (to - from);
      append(from, to, denser * begins_[k], denser * ends_[k]);
    }
    append_parts(infinity);
    return count;
  }
  /// Returns that were written are no longer there.
  void forget() noexcept { written_ = {}; }

 private:
  struct Part {
    double from, to, at_begin, at_end;
    [[nodiscard]] double power() const noexcept { return 0.5 * (at_begin + at_end) * (to - from); }
  };

  /// Known light in whole cells, of a share.
  struct Lit {
    std::size_t first = 0, end = 0;
    double share = 0;
  };

  /// Adds a share of known light to cells, one by one.
  void add_known(std::size_t first, std::size_t end, double share) noexcept {
    for (std::size_t k = first; k < end; ++k) add(k, share * straight_.density[k], share * straight_.density[k + 1]);
  }
  /// Adds the known light to its cells.
  void part_lit() noexcept {
    add_known(lit_.first, lit_.end, lit_.share);
    lit_ = {};
  }

  /// Spreads the light of a stretch over its cell.
  void spread(const Part& part) noexcept {
    const std::size_t k = cell_of(0.5 * (part.from + part.to));
    const double density = part.power() / (nodes_[k + 1] - nodes_[k]);
    add(k, density, density);
  }

  double aperture_ = 0, pulse_ = 0;
  RangeGate gate_{};
  std::array<double, cells + 1> nodes_{};
  std::array<double, cells> begins_{}, ends_{};  ///< densities at the ends of cells [W/m]
  std::size_t first_ = cells, end_ = 0;          ///< cells in use
  Straight straight_{};
  Lit lit_{}, written_{};       ///< of this pulse; as the returns were written last
  std::size_t written_at_ = 0;  ///< number of the first return that was written so
  std::vector<Part> parts_;
  bool crowded_ = false;
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
