// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MATERIAL_SPECTRUM_HPP
#define PULSECAST_MATERIAL_SPECTRUM_HPP

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/search.hpp>
#include <pulsecast/base/shared_array.hpp>

namespace PULSECAST_NAMESPACE {

/// Reflectance at one wavelength.
struct SpectralSample {
  double wavelength = 0;   ///< wavelength [m]
  double reflectance = 0;  ///< reflectance, in [0, 1]
};

/// Reflectance over wavelength: linear between samples, constant beyond. Copies share the samples.
class Spectrum {
 public:
  /// At least one sample, in strictly ascending order of wavelength. @throws SettingError otherwise
  explicit Spectrum(const std::vector<SpectralSample>& samples) {
    if (samples.empty()) throw SettingError("Spectrum::samples (number)", 0, "", "at least 1");
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const std::string field = "Spectrum::samples[" + std::to_string(i) + "]";
      const double wavelength = samples[i].wavelength, last = i > 0 ? samples[i - 1].wavelength : 0;
      require_positive(field + ".wavelength", wavelength, "m");
      require_within(field + ".reflectance", samples[i].reflectance, 0, 1, "");
      if (!(wavelength > last))
        throw SettingError(field + ".wavelength", wavelength, "m",
                           "greater than that of the previous sample, " + text::to_text(last));
    }
    samples_ = samples;
  }

  explicit Spectrum(DeserializeTag) {}
  void archive(auto& a) { a(samples_); }
  [[nodiscard]] bool is_consistent() const noexcept { return !samples_.empty(); }

  /// Samples in ascending order of wavelength.
  [[nodiscard]] std::span<const SpectralSample> samples() const noexcept { return {samples_.data(), samples_.size()}; }
  [[nodiscard]] double shortest() const noexcept { return samples_[0].wavelength; }        ///< [m]
  [[nodiscard]] double longest() const noexcept { return samples_.end()[-1].wavelength; }  ///< [m]
  [[nodiscard]] std::size_t memory() const noexcept { return samples_.memory(); }

  /// Reflectance at a wavelength [m], a fraction.
  [[nodiscard]] double reflectance(double wavelength) const noexcept {
    const auto before = [&](std::size_t n) noexcept { return samples_[n].wavelength < wavelength; };
    const auto [i, k] = detail::neighbours(samples_.size(), before);
    if (i == k) return samples_[i].reflectance;
    const SpectralSample &below = samples_[i], &above = samples_[k];
    const double share = (wavelength - below.wavelength) / (above.wavelength - below.wavelength);
    return below.reflectance + share * (above.reflectance - below.reflectance);
  }

 private:
  SharedArray<SpectralSample> samples_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
