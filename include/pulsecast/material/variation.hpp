// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_VARIATION_HPP
#define PULSECAST_MATERIAL_VARIATION_HPP

#include <pulsecast/base/random.hpp>
#include <pulsecast/material/material.hpp>

/// Variants of a material, for the primitives of one shape, or for copies of it with a table each.
namespace PULSECAST_NAMESPACE {

/// Variants of a material, named "leaf 1", "leaf 2" and so on. Shifts the reflectance of each, or
/// its spectrum, by a uniform random amount from minus to plus `range`, and clips it to [0, 1]; it
/// depends on the seed and the number. @throws SettingError for a bad material or `range`
[[nodiscard]] inline std::vector<Material> vary_reflectance(const Material& material, std::size_t variants,
                                                            double range, std::uint64_t seed) {
  material.validate();
  require_within("vary_reflectance (range)", range, 0, 1, "");
  std::vector<Material> all(variants, material);
  for (std::size_t i = 0; i < variants; ++i) {
    const double shift = range * (2 * uniform({.seed = seed, .pulse = i}) - 1);
    const auto shifted = [shift](double share) { return std::clamp(share + shift, 0.0, 1.0); };
    all[i].name += " " + std::to_string(i + 1);
    all[i].reflectance = shifted(material.reflectance);
    if (!material.spectrum) continue;
    const auto even = material.spectrum->samples();
    std::vector<SpectralSample> samples(even.begin(), even.end());
    for (SpectralSample& sample : samples) sample.reflectance = shifted(sample.reflectance);
    all[i].spectrum = std::make_shared<const Spectrum>(std::move(samples));
  }
  return all;
}

/// Material indices in turn: 0, 1, ..., materials - 1, 0, 1, ... For `MeshData::materials` and its
/// like. @throws SettingError for no materials
[[nodiscard]] inline std::vector<std::uint32_t> assign_round_robin(std::size_t primitives, std::uint32_t materials) {
  require_within("assign_round_robin (materials)", materials, 1, 4294967295.0, "");
  std::vector<std::uint32_t> all(primitives);
  for (std::size_t i = 0; i < primitives; ++i) all[i] = static_cast<std::uint32_t>(i % materials);
  return all;
}

/// Uniform random material indices, the same for a seed. @throws SettingError for no materials
[[nodiscard]] inline std::vector<std::uint32_t> assign_randomly(std::size_t primitives, std::uint32_t materials,
                                                                std::uint64_t seed) {
  require_within("assign_randomly (materials)", materials, 1, 4294967295.0, "");
  std::vector<std::uint32_t> all(primitives);
  for (std::size_t i = 0; i < primitives; ++i)
    all[i] = static_cast<std::uint32_t>(uniform({.seed = seed, .pulse = i, .subray = 1}) * materials);
  return all;
}

}  // namespace PULSECAST_NAMESPACE

#endif
