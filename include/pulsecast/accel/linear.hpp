// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_ACCEL_LINEAR_HPP
#define PULSECAST_ACCEL_LINEAR_HPP

#include <pulsecast/accel/detail/sah.hpp>
#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Accelerator without a search structure: tests every primitive. Oracle for the others, and
/// efficient for a handful of primitives.
template <std::floating_point Real = float>
class Linear {
 public:
  /// Boxes [m]. @throws SettingError for coordinates beyond 1e18 m, or more than 4294967294 boxes
  explicit Linear(std::span<const Box> boxes) {
    const detail::BuildInput<Real> input(boxes);
    bounds_ = input.bounds;
    std::vector<PrimitiveIndex> primitives;
    primitives.reserve(input.primitives.size());
    for (const auto& boxed : input.primitives) primitives.push_back(boxed.primitive);
    primitives_ = std::move(primitives);
  }

  explicit Linear(DeserializeTag) {}
  void archive(auto& a) { a(bounds_, primitives_); }
  [[nodiscard]] bool is_consistent(std::size_t primitives) const noexcept {
    return std::all_of(primitives_.begin(), primitives_.end(), [&](PrimitiveIndex i) { return i < primitives; });
  }

  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::size_t memory() const noexcept { return primitives_.memory(); }
  [[nodiscard]] std::span<const PrimitiveIndex> order() const noexcept {
    return {primitives_.data(), primitives_.size()};
  }

  void closest(const auto&, const detail::LeafTest auto& test, auto&) const noexcept {
    if (!primitives_.empty()) test(std::span<const PrimitiveIndex>(primitives_.data(), primitives_.size()));
  }

 private:
  Box bounds_;
  SharedArray<PrimitiveIndex> primitives_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
