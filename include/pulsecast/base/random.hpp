// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_RANDOM_HPP
#define PULSECAST_BASE_RANDOM_HPP

#include <array>

#include <pulsecast/base/exponential.hpp>
#include <pulsecast/base/tick.hpp>

namespace PULSECAST_NAMESPACE {

/// Purpose of a random number; numbers for different purposes are independent. Results depend on
/// the values: new ones come last. 128 to 255 are free for user models: `Purpose{128}`.
enum class Purpose : std::uint32_t {
  range_noise = 0,
  position_noise = 1,
  attitude_noise = 2,
  free_path = 3,
  receiver_noise = 4,
  scene = 5,  ///< generation of scenes
  position_drift = 6,
  attitude_drift = 7,
  angular_jitter = 8,
  beam_turn = 9,  ///< rotation of a footprint about its axis
  speckle = 10,   ///< phases of coherent light
  leaf_tilt = 11,
  scattering = 12,   ///< directions of light that is scattered on
  drops = 13,        ///< rain and snow in the beam
  calibration = 14,  ///< errors that are drawn once
  inertial_noise = 15,
};

/// Key of a random number: the same key gives the same number on any thread, in any order.
struct RandomKey {
  std::uint64_t seed = 0;            ///< seed of the user's choice
  PulseIndex pulse = 0;              ///< number of the pulse, or of another draw
  std::uint32_t subray = 0;          ///< number of the subray, or of another draw
  Purpose purpose = Purpose::scene;  ///< purpose of the draw
  std::uint32_t part = 0;            ///< part of the scene, below 2^24

  /// The same key for another purpose.
  [[nodiscard]] constexpr RandomKey with(Purpose other) const noexcept { return {seed, pulse, subray, other, part}; }
};

namespace detail {

[[nodiscard]] constexpr std::uint32_t low32(std::uint64_t word) noexcept { return static_cast<std::uint32_t>(word); }
[[nodiscard]] constexpr std::uint32_t high32(std::uint64_t word) noexcept { return low32(word >> 32); }

/// Philox4x32-10 generator: four random words. Source: Salmon, Moraes, Dror & Shaw 2011.
[[nodiscard]] constexpr auto philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) noexcept {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * counter[0];
    const std::uint64_t b = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {high32(b) ^ counter[1] ^ key[0], low32(b), high32(a) ^ counter[3] ^ key[1], low32(a)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

}  // namespace detail

/// Four random words of a key. Purposes are below 256; the part takes the bits above.
[[nodiscard]] constexpr std::array<std::uint32_t, 4> random_words(const RandomKey& k) noexcept {
  const std::uint32_t purpose = static_cast<std::uint32_t>(k.purpose) ^ k.part << 8;
  using namespace detail;
  return philox({low32(k.pulse), high32(k.pulse), k.subray, purpose}, {low32(k.seed), high32(k.seed)});
}

/// Uniform draw from the open interval (0, 1), so that its logarithm is finite; 52 random bits.
[[nodiscard]] constexpr double uniform(const RandomKey& key) noexcept {
  const auto words = random_words(key);
  const std::uint64_t bits = (std::uint64_t{words[0]} << 20) | (words[1] >> 12);
  return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

/// Quantile of the standard normal distribution, p in (0, 1); relative error about 1e-16. Source:
/// Wichura 1988, algorithm AS 241 (PPND16).
[[nodiscard]] inline double normal_quantile(double p) noexcept {
  using simd::detail::polynomial;
  const double q = p - 0.5;
  if (std::fabs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q *
           polynomial(r, 2.5090809287301226727e3, 3.3430575583588128105e4, 6.7265770927008700853e4,
                      4.5921953931549871457e4, 1.3731693765509461125e4, 1.9715909503065514427e3,
                      1.3314166789178437745e2, 3.3871328727963666080e0) /
           polynomial(r, 5.2264952788528545610e3, 2.8729085735721942674e4, 3.9307895800092710610e4,
                      2.1213794301586595867e4, 5.3941960214247511077e3, 6.8718700749205790830e2,
                      4.2313330701600911252e1, 1.0);
  }
  double r = std::sqrt(-std::log(q < 0 ? p : 1 - p));
  double x;
  if (r <= 5) {
    r -= 1.6;
    x = polynomial(r, 7.74545014278341407640e-4, 2.27238449892691845833e-2, 2.41780725177450611770e-1,
                   1.27045825245236838258e0, 3.64784832476320460504e0, 5.76949722146069140550e0,
                   4.63033784615654529590e0, 1.42343711074968357734e0) /
        polynomial(r, 1.05075007164441684324e-9, 5.47593808499534494600e-4, 1.51986665636164571966e-2,
                   1.48103976427480074590e-1, 6.89767334985100004550e-1, 1.67638483018380384940e0,
                   2.05319162663775882187e0, 1.0);
  } else {
    r -= 5;
    x = polynomial(r, 2.01033439929228813265e-7, 2.71155556874348757815e-5, 1.24266094738807843860e-3,
                   2.65321895265761230930e-2, 2.96560571828504891230e-1, 1.78482653991729133580e0,
                   5.46378491116411436990e0, 6.65790464350110377720e0) /
        polynomial(r, 2.04426310338993978564e-15, 1.42151175831644588870e-7, 1.84631831751005468180e-5,
                   7.86869131145613259100e-4, 1.48753612908506148525e-2, 1.36929880922735805310e-1,
                   5.99832206555887937690e-1, 1.0);
  }
  return q < 0 ? -x : x;
}

/// Draw from the standard normal distribution by inversion: the same with every standard library.
[[nodiscard]] inline double normal(const RandomKey& key) noexcept { return normal_quantile(uniform(key)); }

}  // namespace PULSECAST_NAMESPACE

#endif
