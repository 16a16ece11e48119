// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PAGE_DETAIL_SAMPLE_HPP
#define PULSECAST_PAGE_DETAIL_SAMPLE_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/echo.hpp>
#include <pulsecast/scene/point_colour.hpp>

namespace PULSECAST_NAMESPACE::page {

/// Point of a page: an echo with attributes of its shot.
struct PagePoint {
  Vec3 position{};                                ///< in the world [m]
  double time = 0;                                ///< since the survey's start [s]
  PulseIndex pulse = 0;                           ///< number of the pulse
  std::array<float, 3> to_instrument{};           ///< vector from the point to the origin of its pulse [m]
  float amplitude = 0, reflectance = 0;           ///< as in `Echo`, the amplitude in watts
  float width = 0;                                ///< as in `Echo` [s]
  float incidence = 0, scan_angle = 0;            ///< [rad]
  ObjectId object = 0;                            ///< as in `Echo`
  std::uint32_t key = 0;                          ///< for thinning: see `page_key`
  std::uint16_t classification = 0;               ///< as in `Echo`
  std::uint16_t leg = 0;                          ///< as in `Shot`
  std::uint8_t number = 1, returns = 1;           ///< number of the echo, total of its pulse
  std::uint16_t channel = 0;                      ///< as in `Shot`
  ReflectionKind kind = ReflectionKind::surface;  ///< as in `Echo`
  bool coloured = false;                          ///< true if its colour is known
  std::array<std::uint8_t, 3> colour{};           ///< red, green and blue, as displays take them (sRGB)
};

/// Pseudo-random number of an echo, independent of the rest of the cloud. Source: Appleby 2011, MurmurHash3, fmix64.
[[nodiscard]] constexpr std::uint32_t page_key(PulseIndex pulse, std::uint8_t number) noexcept {
  std::uint64_t h = pulse * 256 + number;
  h = (h ^ h >> 33) * 0xff51afd7ed558ccd;
  h = (h ^ h >> 33) * 0xc4ceb9fe1a85ec53;
  return static_cast<std::uint32_t>((h ^ h >> 33) >> 32);
}

/// Sink that keeps at most `most` points, those with the least keys, in pulse order: a uniform sample that depends on
/// the echoes alone. It skips points that are not finite. Memory: a little more than a hundred bytes per point kept.
class PageSample {
 public:
  /// `most` is from 2 to 2^27. `colours` is called for the points that are kept for the moment.
  explicit PageSample(std::size_t most, PointColours colours = {}) : most_(most), colours_(std::move(colours)) {
    require_within("PageSample::most", static_cast<double>(most), 2, 134'217'728, "");
  }

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) {
        ++seen_;
        const std::uint32_t key = page_key(shot.index, echo.number);
        if (thinned_ && key >= largest_key_) continue;
        const Vec3 position = point_of(shot, echo), back = shot.direction * -echo.range;
        if (!finite(position) || !finite(back)) continue;
        points_.push_back(
            {.position = position,
             .time = shot.tick.seconds(),
             .pulse = shot.index,
             .to_instrument = {static_cast<float>(back.x), static_cast<float>(back.y), static_cast<float>(back.z)},
             .amplitude = static_cast<float>(echo.amplitude),
             .reflectance = static_cast<float>(echo.reflectance),
             .width = static_cast<float>(echo.width),
             .incidence = static_cast<float>(std::acos(std::clamp(echo.cos_incidence, -1.0, 1.0))),
             .scan_angle = static_cast<float>(shot.scan_angle),
             .object = echo.object,
             .key = key,
             .classification = echo.classification,
             .leg = shot.leg,
             .number = echo.number,
             .returns = static_cast<std::uint8_t>(std::min<std::uint32_t>(shot.echoes, 255)),
             .channel = shot.channel,
             .kind = echo.kind});
        if (colours_) set_colour(colours_(batch, shot, echo), points_.back());
        if (points_.size() >= most_ + most_ / 4 + 1) thin();
      }
  }

  /// Points kept, in pulse order; valid until the next batch.
  [[nodiscard]] std::span<const PagePoint> points() {
    if (points_.size() > most_) thin();
    return points_;
  }

  [[nodiscard]] std::uint64_t seen() const noexcept { return seen_; }  ///< echoes so far
  /// Upper bound of the keys kept.
  [[nodiscard]] std::uint32_t largest_key() const noexcept { return largest_key_; }

 private:
  static void set_colour(const std::optional<PointColour>& colour, PagePoint& point) noexcept {
    if (!colour) return;
    const auto byte = [](std::uint16_t share) noexcept { return static_cast<std::uint8_t>((share + 128) / 257); };
    point.coloured = true;
    point.colour = {byte(colour->red), byte(colour->green), byte(colour->blue)};
  }

  /// Keeps the points with the least keys; of equal keys, the earliest.
  void thin() {
    keys_.clear();
    for (const PagePoint& point : points_) keys_.push_back(point.key);
    const auto last = keys_.begin() + static_cast<std::ptrdiff_t>(most_ - 1);
    std::nth_element(keys_.begin(), last, keys_.end());
    largest_key_ = *last;
    thinned_ = true;
    auto equal = 1 + std::count(keys_.begin(), last, largest_key_);  // number of them that stay
    std::erase_if(points_,
                  [&](const PagePoint& p) { return p.key > largest_key_ || (p.key == largest_key_ && equal-- <= 0); });
  }

  std::size_t most_;
  PointColours colours_;
  std::vector<PagePoint> points_;
  std::vector<std::uint32_t> keys_;
  std::uint64_t seen_ = 0;
  std::uint32_t largest_key_ = std::numeric_limits<std::uint32_t>::max();
  bool thinned_ = false;
};
static_assert(EchoSink<PageSample>);

}  // namespace PULSECAST_NAMESPACE::page

#endif
