// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCENE_DETAIL_SPECULAR_LOBES_HPP
#define PULSECAST_SCENE_DETAIL_SPECULAR_LOBES_HPP

#include <algorithm>
#include <cstddef>
#include <span>

#include <pulsecast/base/simd.hpp>
#include <pulsecast/echo.hpp>
#include <pulsecast/geometry/bundle.hpp>
#include <pulsecast/scene/material.hpp>

namespace pulsecast::detail {

/// Specular lobes of the surfaces that the rays of a bundle met, for evaluation by the register.
class SpecularLobes {
 public:
  /// Notes the surface of a hit, that of ray j of a bundle, whose backscatter `add_to` completes.
  void note(std::size_t j, const RayBundle& rays, const Backscatter& backscatter, Hit& hit) noexcept {
    if (!any_) begin(rays);
    cosine_[j] = hit.cos_incidence;
    lobe_[j] = backscatter.lobe;
    exponent_[j] = backscatter.exponent;
    reflectance_[j] = backscatter.reflectance;
    hit.backscatter = backscatter.rough(hit.cos_incidence);
  }

  /// Adds the lobes to the bundle's hits, as many as `size`.
  void add_to(std::span<Hit> hits, std::size_t size) const noexcept {
    if (any_) add(hits, size);
  }

 private:
  /// Sets the columns as for rays that meet no lobe.
  [[gnu::noinline]] void begin(const RayBundle& rays) noexcept {
    any_ = true;
    for (std::size_t k = 0; k < rays.padded_size(); k += simd::lane_count) {
      for (RayBundle::Column* column : {&cosine_, &lobe_, &exponent_}) simd::store(simd::Doubles{}, (*column)[k]);
      simd::store(simd::Doubles{} + 1.0, reflectance_[k]);
    }
  }

  // not inlined, with `begin`: the registers that they need would be spilled for surfaces without a lobe, too
  [[gnu::noinline]] void add(std::span<Hit> hits, std::size_t size) const noexcept {
    for (std::size_t j = 0; j < size; j += simd::lane_count) {
      const simd::Doubles lobes = Backscatter::specular(simd::load<simd::Doubles>(cosine_[j]), simd::load<simd::Doubles>(lobe_[j]),
                                                        simd::load<simd::Doubles>(exponent_[j]));
      for (std::size_t lane = 0; lane < std::min(simd::lane_count, size - j); ++lane) {
        Hit& hit = hits[j + lane];
        hit.backscatter = reflectance_[j + lane] * (hit.backscatter + lobes[lane]);
      }
    }
  }

  bool any_ = false;
  alignas(64) RayBundle::Column cosine_, lobe_, exponent_, reflectance_;  ///< set once there is a lobe; 0 and 1 for rays without
};

}  // namespace pulsecast::detail

#endif
