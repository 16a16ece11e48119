// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// error: static.assert.*Accelerator
#include <pulsecast/concepts.hpp>

using namespace pulsecast;

struct Slab {
  explicit Slab(std::span<const Box>) {}
  const Box& bounds() const noexcept { return bounds_; }
  std::size_t memory() const noexcept { return 0; }
  std::span<const PrimitiveIndex> order() const noexcept { return {}; }
#ifdef SHOULD_NOT_COMPILE
  void closest(const RayBundle&, const auto& test, ClosestHits&) const { test(std::span<const PrimitiveIndex>()); }
#else
  void closest(const RayBundle&, const auto& test, ClosestHits&) const noexcept { test(std::span<const PrimitiveIndex>()); }
#endif

 private:
  Box bounds_;
};
static_assert(Accelerator<Slab>);

int main() {}
