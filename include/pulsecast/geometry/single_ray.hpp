// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_SINGLE_RAY_HPP
#define PULSECAST_GEOMETRY_SINGLE_RAY_HPP

#include <span>

#include <pulsecast/geometry/bundle.hpp>

/// A single ray, and what it looks for: its closest hit, any, or all. Accelerators and shapes take
/// them as a `RayBundle` and its `ClosestHits`; the hit is the same to the last bit.
namespace PULSECAST_NAMESPACE {

/// Bundle of one ray without columns: 104 bytes. The hits hold the far end; there is no wavelength.
struct SingleRayPacket {
  static constexpr std::size_t capacity = 1, size = 1;  ///< as in `RayBundle`

  Vec3 origin{};                   ///< origin [m]
  Vec3 toward = axis::forward;     ///< direction, of length `direction_length`
  double direction_length = 1;     ///< 1 in the world, 1/scale in an instance
  double near = 0;                 ///< hits are farther, at least 0 [m]
  Tick tick{};                     ///< time
  std::uint64_t seed = 0;          ///< as in `BundleOrigin`
  PulseIndex pulse = 0;            ///< as in `BundleOrigin`
  std::uint32_t first_subray = 0;  ///< as in `BundleOrigin`

  SingleRayPacket() = default;
  /// A ray of the world, of a unit direction.
  explicit SingleRayPacket(const Ray& ray) noexcept
      : origin(ray.origin),
        toward(ray.direction),
        near(ray.near),
        tick(ray.tick),
        seed(ray.seed),
        pulse(ray.pulse),
        first_subray(ray.subray) {
    PULSECAST_ASSERT(!(near < 0));
  }

  [[nodiscard]] const Vec3& direction(std::size_t) const noexcept { return toward; }  ///< `toward`
  [[nodiscard]] double direction_min(int k) const noexcept {
    return std::isnan(toward[k]) ? detail::infinity : toward[k];
  }
  [[nodiscard]] double direction_max(int k) const noexcept {
    return std::isnan(toward[k]) ? -detail::infinity : toward[k];
  }
};

/// Bundle of a single ray up to a range [m], for shapes that take nothing else.
[[nodiscard]] inline RayBundle bundle_of(const SingleRayPacket& r, double far) noexcept {
  const Ray ray{r.origin, r.toward, r.near, far, r.tick, r.seed, r.pulse, r.first_subray};
  RayBundle rays = bundle_of(ray);
  rays.direction_length = r.direction_length;
  return rays;
}

/// Search for any hit of a single ray: ends at the first found, by a limit before every box.
struct AnyHit {
  double far;              ///< greatest range that counts [m]; minus infinity after the first hit
  bool found = false;      ///< true after the first hit
  std::uint64_t part = 0;  ///< part under test, in the upper half

  explicit AnyHit(double range) noexcept : far(range) {}  ///< up to a range [m]

  [[nodiscard]] bool done() const noexcept { return found; }  ///< true if no further test is of use
  void offer(std::size_t, double at, PrimitiveIndex) noexcept {
    if (!(at <= far)) return;
    found = true;
    far = -detail::infinity;
  }
  [[nodiscard]] double limit_of(std::size_t) const noexcept { return far; }
  [[nodiscard]] double limit(const SingleRayPacket&) const noexcept { return detail::limit_of(far); }
};

/// The closest hits of a single ray, up to `capacity` of them, by range and then by id, each once.
/// When full, `continue_after` makes room for the next. In 600 bytes; allocates nothing.
class AllHits {
 public:
  static constexpr std::size_t capacity = 32;  ///< greatest number of hits held

  /// A hit, ordered by range and then by id.
  struct Entry {
    double range;      ///< range of the hit [m]
    std::uint64_t id;  ///< part in the upper half, primitive in the lower

    friend bool operator==(const Entry&, const Entry&) = default;
    /// True if `a` comes first.
    friend bool operator<(const Entry& a, const Entry& b) noexcept {
      return a.range < b.range || (a.range == b.range && a.id < b.id);
    }
  };

  std::uint64_t part = 0;  ///< part under test, in the upper half

  /// No hits so far between two ranges [m].
  AllHits(double near, double far) noexcept : near_(near), limit_(far), far_(far), last_{near, ClosestHits::none} {}

  /// Hits so far, in order.
  [[nodiscard]] std::span<const Entry> hits() const noexcept { return {hits_.data(), size_}; }
  /// True if there may be more hits than are held.
  [[nodiscard]] bool full() const noexcept { return size_ == capacity; }

  /// Empties the buffer for the hits after those held. Returns the range to search from [m].
  double continue_after() noexcept {
    last_ = hits_[size_ - 1];
    size_ = 0;
    limit_ = far_;
    return std::nextafter(last_.range, -detail::infinity);  // or at the same range
  }

  /// Adds a hit with a primitive of the current part, if it is among the closest requested.
  void offer(std::size_t, double at, PrimitiveIndex primitive) noexcept {
    const Entry hit{at, part | primitive};
    if (!(at <= limit_) || !(last_ < hit)) return;
    std::size_t place = size_;
    while (place > 0 && hit < hits_[place - 1]) --place;
    if ((place > 0 && hits_[place - 1] == hit) || place == capacity) return;
    if (size_ < capacity) ++size_;
    std::copy_backward(&hits_[place], &hits_[size_ - 1], hits_.data() + size_);
    hits_[place] = hit;
    if (full()) limit_ = hits_[capacity - 1].range;
  }

  /// Offers the hits of a shape that has the closest only: `closest(ray, hit)` from each hit on.
  void offer_chain(SingleRayPacket ray, const auto& closest) noexcept {
    for (;;) {
      ClosestHit next(limit_);
      next.part = part;
      closest(ray, next);
      if (!next.met(0)) return;
      offer(0, next.range[0], next.primitive_of(0));
      ray.near = next.range[0];
    }
  }

  /// Offers the closest hit alone, of a shape whose hits are drawn from the ray's beginning on.
  void offer_first(SingleRayPacket ray, const auto& closest) noexcept {
    ray.near = near_;
    ClosestHit first(limit_);
    first.part = part;
    closest(ray, first);
    if (first.met(0)) offer(0, first.range[0], first.primitive_of(0));
  }

  [[nodiscard]] double limit_of(std::size_t) const noexcept { return limit_; }
  [[nodiscard]] double limit(const SingleRayPacket&) const noexcept { return detail::limit_of(limit_); }

 private:
  double near_, limit_, far_;
  Entry last_;  ///< the last hit before the requested ones
  std::size_t size_ = 0;
  std::array<Entry, capacity> hits_;
};

}  // namespace PULSECAST_NAMESPACE

#endif
