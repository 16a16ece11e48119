// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <span>
#include <vector>

#include <pulsecast/accel/sah.hpp>
#include <pulsecast/concepts.hpp>

namespace pulsecast {

/// No search at all: every primitive is tested. The oracle for the others, and right for a handful of primitives.
template <std::floating_point Real = float>
class Linear {
 public:
  explicit Linear(std::span<const Box> boxes) {
    const detail::BuildInput<Real> input(boxes);
    bounds_ = input.bounds;
    primitives_.reserve(input.primitives.size());
    for (const auto& boxed : input.primitives) primitives_.push_back(boxed.primitive);
  }

  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::size_t memory() const noexcept { return primitives_.capacity() * sizeof(PrimitiveIndex); }

  template <class Test>
  requires std::invocable<const Test&, std::span<const PrimitiveIndex>>
  void closest(const RayBundle&, const Test& test, Nearest&) const noexcept {
    if (!primitives_.empty()) test(std::span<const PrimitiveIndex>(primitives_));
  }

 private:
  Box bounds_;
  std::vector<PrimitiveIndex> primitives_;
};

static_assert(Accelerator<Linear<float>> && Accelerator<Linear<double>>);

}  // namespace pulsecast
