// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_VOLUME_BINS_HPP
#define PULSECAST_TRANSPORT_DETAIL_VOLUME_BINS_HPP

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/scene/medium.hpp>
#include <pulsecast/transport/illumination.hpp>

namespace PULSECAST_NAMESPACE::detail {

/// Light that a medium scatters back, by range: a comb of reflections that stands for a continuous return. Its teeth are as far apart as
/// the samples of the detector, so that each sample sees them alike.
class VolumeBins {
 public:
  ObjectId object = 0;               ///< label of the reflections
  std::uint16_t classification = 0;  ///< label of the reflections

  /// Room for so many teeth.
  explicit VolumeBins(std::size_t capacity) : power_(capacity) {}

  /// Empties the comb; `spacing` is that of its teeth [m].
  void begin(double spacing) noexcept {
    spacing_ = spacing;
    end_ = 0;
  }
  /// Distance of the teeth [m].
  [[nodiscard]] double spacing() const noexcept { return spacing_; }

  /// Adds the power that returns from a range [m], to the two teeth beside it. Where they would be too many, every second is left out.
  void add(double range, double power) noexcept {
    if (!(power > 0) || power_.size() < 4) return;
    double at = range / spacing_;
    if (end_ == 0) origin_ = std::floor(at);
    for (; !has_room(at); at = range / spacing_) thin_out();
    const double tooth = std::floor(at), beyond = at - tooth;
    if (tooth < origin_) move_up(static_cast<std::size_t>(origin_ - tooth));
    const auto i = static_cast<std::size_t>(tooth - origin_);
    for (; end_ < i + 2; ++end_) power_[end_] = 0;
    power_[i] += (1 - beyond) * power;
    power_[i + 1] += beyond * power;
  }

  /// Calls `visit(range, power)` for all teeth.
  template <class Visitor>
  void visit(const Visitor& visit) const noexcept {
    for (std::size_t i = 0; i < end_; ++i)
      if (power_[i] > 0) visit((origin_ + static_cast<double>(i)) * spacing_, power_[i]);
  }

 private:
  /// Doubles the spacing, and keeps the range of the power's middle.
  void thin_out() noexcept {
    const double origin = std::floor(origin_ / 2);
    const std::size_t odd = origin_ - 2 * origin > 0 ? 1 : 0, count = end_ > 0 ? (end_ + odd) / 2 + 1 : 0;
    double carried = 0;  // of the tooth between, for the next one
    for (std::size_t k = 0; k < count; ++k) {
      const auto old = [&](std::size_t i) noexcept { return i >= odd && i - odd < end_ ? power_[i - odd] : 0.0; };
      const double even = old(2 * k), between = old(2 * k + 1);
      power_[k] = carried + even + between / 2;
      carried = between / 2;
    }
    origin_ = origin;
    end_ = count;
    spacing_ *= 2;
  }
  /// True if the teeth beside a place [spacings] fit in, with those that are there.
  [[nodiscard]] bool has_room(double at) const noexcept {
    const double last = std::max(at, origin_ + static_cast<double>(end_)), first = std::min(at, origin_);
    return last - first + 3 < static_cast<double>(power_.size());
  }
  /// Makes room for teeth before the first.
  void move_up(std::size_t count) noexcept {
    std::copy_backward(power_.begin(), power_.begin() + static_cast<std::ptrdiff_t>(end_),
                       power_.begin() + static_cast<std::ptrdiff_t>(end_ + count));
    std::fill_n(power_.begin(), count, 0.0);
    end_ += count;
    origin_ -= static_cast<double>(count);
  }

  std::vector<double> power_;
  double spacing_ = 1, origin_ = 0;  // origin: number of the first tooth
  std::size_t end_ = 0;              // number of teeth
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
