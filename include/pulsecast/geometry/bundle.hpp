// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_GEOMETRY_BUNDLE_HPP
#define PULSECAST_GEOMETRY_BUNDLE_HPP

#include <algorithm>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/simd.hpp>
#include <pulsecast/geometry/ray.hpp>

namespace PULSECAST_NAMESPACE {

/// Number of a primitive in its geometry.
using PrimitiveIndex = std::uint32_t;

/// Properties shared by the rays of a bundle.
struct BundleOrigin {
  Vec3 origin{};                  ///< common origin of the rays [m]
  double direction_length = 1;    ///< 1 in the world, 1/scale in an instance
  double near = 0;                ///< hits are farther, at least 0 [m]
  double far = detail::infinity;  ///< hits are not beyond [m]
  std::size_t size = 0;           ///< rays in use, at most `RayBundle::capacity`

  double wavelength = 1.064e-6;    ///< wavelength of the light [m]
  Tick tick{};                     ///< departure of the pulse
  std::uint64_t seed = 0;          ///< key, with the next two, of random numbers in tracing
  PulseIndex pulse = 0;            ///< index of the pulse
  std::uint32_t first_subray = 0;  ///< number of ray 0 among the subrays of its pulse
};

/// Rays from one origin into a narrow cone: the subrays of a pulse, or some of them. Structure of
/// arrays, padded with idle lanes to a multiple of `lanes`. All directions have the same length: 1
/// in the world, 1/scale inside an instance, so that ranges are metres of the world everywhere.
struct RayBundle : BundleOrigin {
  static constexpr std::size_t capacity = 64;             ///< greatest number of rays
  static constexpr std::size_t lanes = simd::lane_count;  ///< divisor of `padded_size()`

  using Column = std::array<double, capacity>;  ///< one number per ray

  alignas(64) Column x, y, z;  ///< components of the directions; `padded_size()` are set
  Vec3 directions_min;         ///< minimum of each component of the directions but NaN, or infinity
  Vec3 directions_max;         ///< their maximum

  RayBundle() noexcept {}  // leaves the directions unset
  /// Leaves the directions unset.
  explicit RayBundle(const BundleOrigin& o) noexcept : BundleOrigin(o) {}
  /// Copies the directions in use only.
  RayBundle(const RayBundle& other) noexcept : RayBundle(static_cast<const BundleOrigin&>(other)) {
    copy_directions(other);
  }
  /// As above.
  RayBundle& operator=(const RayBundle& other) noexcept {
    static_cast<BundleOrigin&>(*this) = other;
    copy_directions(other);
    return *this;
  }

  /// Rays with the idle lanes: `size`, rounded up to a multiple of `lanes`.
  [[nodiscard]] std::size_t padded_size() const noexcept { return (size + lanes - 1) / lanes * lanes; }
  /// Direction of ray j.
  [[nodiscard]] Vec3 direction(std::size_t j) const noexcept { return {x[j], y[j], z[j]}; }
  /// Ray j.
  [[nodiscard]] Ray ray(std::size_t j) const noexcept {
    return {origin, direction(j), near, far, tick, seed, pulse, static_cast<std::uint32_t>(first_subray + j)};
  }
  /// Range that ray j has to be beyond to count [m].
  [[nodiscard]] double near_of(std::size_t) const noexcept { return near; }
  [[nodiscard]] double direction_min(int k) const noexcept { return directions_min[k]; }
  [[nodiscard]] double direction_max(int k) const noexcept { return directions_max[k]; }

  /// Sets the direction of ray j; `pad()` must follow.
  void set_direction(std::size_t j, const Vec3& d) noexcept {
    x[j] = d.x;
    y[j] = d.y;
    z[j] = d.z;
  }

  /// Directions of a register of rays.
  struct Directions {
    simd::Doubles x, y, z;  ///< components of the directions of a register of rays
  };
  /// Sets all directions, those of the rays from j on to `directions(j)`, as `pad` leaves them.
  // always inlined, as matrices then stay in registers
  [[gnu::always_inline]] void set_directions(const auto& directions) noexcept {
    PULSECAST_ASSERT(size > 0 && size <= capacity && !(near < 0));
    Extremes of_x, of_y, of_z;
    const auto take = [&](std::size_t j, const Directions& d) noexcept {
      of_x.take(d.x, x[j]);
      of_y.take(d.y, y[j]);
      of_z.take(d.z, z[j]);
    };
    const std::size_t left = size % lanes, whole = size - left;
    for (std::size_t j = 0; j < whole; j += lanes) take(j, directions(j));
    if (left > 0) {
      const Directions d = directions(whole);
      take(whole, {filled(d.x, left), filled(d.y, left), filled(d.z, left)});
    }
    directions_min = {of_x.low[0], of_y.low[0], of_z.low[0]};
    directions_max = {of_x.high[0], of_y.high[0], of_z.high[0]};
    if (size == 1) return;
    directions_min = {simd::min(of_x.low), simd::min(of_y.low), simd::min(of_z.low)};
    directions_max = {simd::max(of_x.high), simd::max(of_y.high), simd::max(of_z.high)};
  }

  /// Fills the idle lanes with copies of the last ray, as readers of `padded_size()` rays expect,
  /// and finds `directions_min` and `directions_max`. To be called once the directions are set.
  void pad() noexcept {
    set_directions([this](std::size_t j) noexcept -> Directions {
      return {simd::load<simd::Doubles>(x[j]), simd::load<simd::Doubles>(y[j]), simd::load<simd::Doubles>(z[j])};
    });
  }

 private:
  /// Minimum and maximum of a column that is being set.
  struct Extremes {
    simd::Doubles low = simd::Doubles{} + detail::infinity, high = -low;
    [[gnu::always_inline]] void take(const simd::Doubles& d, double& to) noexcept {
      simd::store(d, to);
      low = simd::min(d, low);  // NaN fails every comparison
      high = simd::max(d, high);
    }
  };

  /// The first `number` lanes, and copies of the last of them.
  static simd::Doubles filled(const simd::Doubles& d, std::size_t number) noexcept {
    if (number == 1) return d[0] - simd::Doubles{};
    const auto lane = simd::generate([](std::size_t k) { return static_cast<double>(k); });
    return lane < static_cast<double>(number) ? d : d[number - 1] - simd::Doubles{};  // a zero keeps its sign
  }

  void copy_directions(const RayBundle& other) noexcept {
    for (std::size_t j = 0; j < padded_size(); ++j) set_direction(j, other.direction(j));
    directions_min = other.directions_min;
    directions_max = other.directions_max;
  }
};

/// Bundle whose rays begin at different ranges, such as where they leave a mirror. `near` is at
/// most their minimum. Triangles respect the ranges; other shapes may be hit before a ray begins.
struct StaggeredBundle : RayBundle {
  alignas(64) Column begin;  ///< ray j has no hits up to it; `padded_size()` are set [m]

  StaggeredBundle() noexcept {}
  explicit StaggeredBundle(const BundleOrigin& o) noexcept : RayBundle(o) {}  ///< as `RayBundle`
  /// Ranges of the rays of a register from j on [m].
  [[nodiscard]] auto near_of(std::size_t j) const noexcept { return simd::load<simd::Doubles>(begin[j]); }
};

/// Bundle of one ray.
[[nodiscard]] inline RayBundle bundle_of(const Ray& ray) noexcept {
  RayBundle rays;
  rays.origin = ray.origin;
  rays.near = ray.near;
  rays.far = ray.far;
  rays.size = 1;
  rays.tick = ray.tick;
  rays.seed = ray.seed;
  rays.pulse = ray.pulse;
  rays.first_subray = ray.subray;
  rays.set_direction(0, ray.direction);
  rays.pad();
  return rays;
}

namespace detail {
/// A range, or minus infinity for NaN.
[[nodiscard]] inline double limit_of(double at) noexcept { return at > -infinity ? at : -infinity; }

/// Hits that may need no further test, as `AnyHit` does after the first.
template <class Hits>
concept EndsEarly = requires(const Hits& hits) {
  { hits.done() }
  noexcept->std::same_as<bool>;
};
}  // namespace detail

/// Closest hit so far of each ray of a bundle, or of one ray. Of equal ranges the least id wins.
template <std::size_t capacity>
struct Closest {
  static constexpr std::uint64_t none = ~std::uint64_t{0};  ///< id of no hit

  alignas(capacity > 1 ? 64 : 8) std::array<double, capacity> range;  ///< [m]; `far` without a hit
  /// Part in the upper half, primitive in the lower; `none` without a hit.
  alignas(capacity > 1 ? 64 : 8) std::array<std::uint64_t, capacity> id;
  std::uint64_t part = 0;  ///< part under test, in the upper half

  /// No hits so far of a bundle's rays.
  explicit Closest(const RayBundle& rays) noexcept requires(capacity == RayBundle::capacity) {
    for (std::size_t j = 0; j < rays.padded_size(); j += RayBundle::lanes) {
      std::fill_n(range.begin() + j, RayBundle::lanes, rays.far);
      std::fill_n(id.begin() + j, RayBundle::lanes, none);
    }
    for (std::size_t j = rays.size; j < rays.padded_size(); ++j)
      range[j] = -detail::infinity;  // an idle lane hits nothing
  }
  /// No hit so far of a single ray, up to a range [m].
  explicit Closest(double far) noexcept requires(capacity == 1) : range{far}, id{none} {}

  /// True if ray j has a hit.
  [[nodiscard]] bool met(std::size_t j) const noexcept { return id[slot(j)] != none; }
  /// Part that ray j hits.
  [[nodiscard]] std::uint32_t part_of(std::size_t j) const noexcept {
    return static_cast<std::uint32_t>(id[slot(j)] >> 32);
  }
  /// Primitive of that part that ray j hits.
  [[nodiscard]] PrimitiveIndex primitive_of(std::size_t j) const noexcept {
    return static_cast<PrimitiveIndex>(id[slot(j)]);
  }

  void offer(std::size_t j, double at, PrimitiveIndex primitive) noexcept {
    const std::uint64_t candidate = part | primitive;
    if (at < range[slot(j)] || (at == range[slot(j)] && candidate < id[slot(j)])) {
      range[slot(j)] = at;
      id[slot(j)] = candidate;
    }
  }

  [[nodiscard]] double limit_of(std::size_t j) const noexcept { return range[slot(j)]; }
  template <class Rays>
  [[nodiscard]] double limit(const Rays& rays) const noexcept {
    if constexpr (capacity > 1) {
      simd::Doubles last = simd::Doubles{} - detail::infinity;
      for (std::size_t j = 0; j < rays.size; j += simd::lane_count)
        last = simd::max(simd::load<simd::Doubles>(range[j]), last);
      return simd::max(last);
    } else {
      return detail::limit_of(range[0]);
    }
  }

 private:
  static constexpr std::size_t slot(std::size_t j) noexcept { return capacity > 1 ? j : 0; }
};

using ClosestHits = Closest<RayBundle::capacity>;  ///< of a bundle
using ClosestHit = Closest<1>;                     ///< of a single ray

/// Hits of a bundle or a single ray that a shape offers to. `limit_of(j)`: range up to which ray j
/// takes any [m], `limit(rays)`: that of all; `part` is the part under test, in the upper half.
template <class H, class Rays>
concept HitsOf = requires(H& hits, const Rays& rays, std::size_t j, double at, PrimitiveIndex i) {
  hits.part = std::uint64_t{};
  hits.offer(j, at, i);
  { hits.limit_of(j) } -> std::same_as<double>;
  { hits.limit(rays) } -> std::same_as<double>;
};

}  // namespace PULSECAST_NAMESPACE

#endif
