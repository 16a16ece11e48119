// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_BASE_LANES_HPP
#define PULSECAST_BASE_LANES_HPP

#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/tick.hpp>
#include <pulsecast/base/vector_math.hpp>

/// Ticks, vectors and poses in SIMD batches of `simd::lane_count`. A lane has the same bits as if
/// all lanes held its tick or pose, so a motion's pose does not depend on the other lanes.
namespace PULSECAST_NAMESPACE {

/// Mask of all lanes.
[[nodiscard]] inline simd::Mask all_lanes() noexcept { return simd::Mask{} - 1; }
/// Mask of the first n lanes.
[[nodiscard]] inline simd::Mask first_lanes(std::size_t n) noexcept {
  simd::Mask mask{};
  for (std::size_t lane = 0; lane < simd::lane_count; ++lane) mask[lane] = lane < n ? -1 : 0;
  return mask;
}

namespace detail {

/// One number in all lanes, with its sign if it is zero.
[[nodiscard]] inline simd::Doubles in_all_lanes(double x) noexcept { return x - simd::Doubles{}; }

/// Rounding error of a product, unless a product of halves overflows or underflows. Source: Dekker
/// 1971, A floating-point technique for extending the available precision; halves of Veltkamp.
[[nodiscard, gnu::always_inline]] inline simd::Doubles product_error(const simd::Doubles& a, const simd::Doubles& b,
                                                                     const simd::Doubles& product) noexcept {
#if (defined(__FMA__) || defined(__aarch64__)) && __has_builtin(__builtin_elementwise_fma)  // of newer clang, which
  return __builtin_elementwise_fma(a, b, -product);                                         // lacks that of x86-64
#elif defined(__FMA__)
  if constexpr (sizeof(simd::Doubles) == 32) return __builtin_ia32_vfmaddpd256(a, b, -product);
#elif defined(__aarch64__)
  return vfmaq_f64(-product, a, b);
#endif
  constexpr double splitter = 0x1p27 + 1;
  const simd::Doubles a_far = splitter * a, a_high = a_far - (a_far - a), a_low = a - a_high;
  const simd::Doubles b_far = splitter * b, b_high = b_far - (b_far - b), b_low = b - b_high;
  return a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low);
}

}  // namespace detail

/// Times, one in each lane, as `Tick`.
struct TickLanes {
  simd::Doubles second{};    ///< whole parts, below 2^53 in magnitude [s]
  simd::Doubles fraction{};  ///< fractional parts, in [0, 1) [s]

  TickLanes() = default;
  TickLanes(const simd::Doubles& whole, const simd::Doubles& part) noexcept : second(whole), fraction(part) {}
  explicit TickLanes(const Tick& t) noexcept
      : second(detail::in_all_lanes(static_cast<double>(t.second))), fraction(detail::in_all_lanes(t.fraction)) {}

  /// Begins of every `step`-th slot from i on of a source of constant rate [Hz], as `Tick::of`.
  [[nodiscard]] static TickLanes of(PulseIndex i, double rate, PulseIndex step = 1) noexcept {
    const simd::Doubles n = simd::generate([&](std::size_t lane) { return static_cast<double>(i + lane * step); }),
                        zero{}, rates = zero + rate;
    const auto rest_of = [&](const simd::Doubles& whole) {
      const simd::Doubles product = whole * rates;
      return (n - product) - detail::product_error(whole, rates, product);
    };
    simd::Doubles whole = simd::floor(n / rates);
    simd::Doubles rest = rest_of(whole);  // exact, if `whole` is the right one of two candidates
    const auto over = rest < zero, short_of = rest >= rates;
    if (simd::bits(over | short_of) != 0) [[unlikely]] {
      whole = over ? whole - 1.0 : (short_of ? whole + 1.0 : whole);
      rest = rest_of(whole);
    }
    return normal(whole, rest / rates);
  }

  [[nodiscard]] Tick operator[](std::size_t lane) const noexcept {
    return {static_cast<std::int64_t>(second[lane]), fraction[lane]};
  }
  void set(std::size_t lane, const Tick& t) noexcept {
    second[lane] = static_cast<double>(t.second);
    fraction[lane] = t.fraction;
  }

  /// Times as one number each, as `Tick::seconds` [s].
  [[nodiscard]] simd::Doubles seconds() const noexcept { return second + fraction; }

  /// Phases of an oscillation of constant frequency [Hz], as `Tick::phase`.
  [[nodiscard]] simd::Doubles phase(double frequency) const noexcept {
    const simd::Doubles zero{}, rate = zero + frequency, turns = rate * second;
    const simd::Doubles lost = detail::product_error(rate, second, turns);
    const simd::Doubles phase = (turns - simd::floor(turns)) + rate * fraction + lost;
    const simd::Doubles wrapped = phase - simd::floor(phase);
    return wrapped < 1.0 ? wrapped : zero;
  }

  [[nodiscard]] friend TickLanes operator+(const TickLanes& a, const Tick& b) noexcept {
    return normal(a.second + static_cast<double>(b.second), a.fraction + b.fraction);
  }

 private:
  [[nodiscard]] static TickLanes normal(const simd::Doubles& second, const simd::Doubles& fraction) noexcept {
    const auto below = fraction < 1.0;
    return {below ? second : second + 1.0, below ? fraction : fraction - 1.0};
  }
};

/// Vectors, one in each lane.
struct Vec3Lanes {
  simd::Doubles x{};  ///< first components
  simd::Doubles y{};  ///< second components
  simd::Doubles z{};  ///< third components

  Vec3Lanes() = default;
  Vec3Lanes(const simd::Doubles& x_, const simd::Doubles& y_, const simd::Doubles& z_) noexcept : x(x_), y(y_), z(z_) {}
  explicit Vec3Lanes(const Vec3& v) noexcept
      : x(detail::in_all_lanes(v.x)), y(detail::in_all_lanes(v.y)), z(detail::in_all_lanes(v.z)) {}

  [[nodiscard]] Vec3 operator[](std::size_t lane) const noexcept { return {x[lane], y[lane], z[lane]}; }
  void set(std::size_t lane, const Vec3& v) noexcept {
    x[lane] = v.x;
    y[lane] = v.y;
    z[lane] = v.z;
  }

  [[nodiscard]] friend Vec3Lanes operator+(const Vec3Lanes& a, const Vec3Lanes& b) noexcept {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  [[nodiscard]] friend Vec3Lanes operator*(const simd::Doubles& s, const Vec3Lanes& v) noexcept {
    return {s * v.x, s * v.y, s * v.z};
  }
  [[nodiscard]] friend simd::Doubles dot(const Vec3Lanes& a, const Vec3Lanes& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  [[nodiscard]] friend Vec3Lanes cross(const Vec3Lanes& a, const Vec3Lanes& b) noexcept {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
  }
  [[nodiscard]] friend Vec3Lanes normalize(const Vec3Lanes& v) noexcept { return (1.0 / simd::sqrt(dot(v, v))) * v; }
};

/// Rotations, one in each lane: unit quaternions.
struct RotationLanes {
  simd::Doubles w = detail::in_all_lanes(1);  ///< real parts
  simd::Doubles x{};                          ///< first imaginary parts
  simd::Doubles y{};                          ///< second imaginary parts
  simd::Doubles z{};                          ///< third imaginary parts

  RotationLanes() = default;
  RotationLanes(const simd::Doubles& w_, const simd::Doubles& x_, const simd::Doubles& y_,
                const simd::Doubles& z_) noexcept
      : w(w_), x(x_), y(y_), z(z_) {}
  explicit RotationLanes(const Rotation& r) noexcept
      : w(detail::in_all_lanes(r.w)),
        x(detail::in_all_lanes(r.x)),
        y(detail::in_all_lanes(r.y)),
        z(detail::in_all_lanes(r.z)) {}
  /// About a unit axis, by an angle [rad].
  [[nodiscard]] static RotationLanes about(const Vec3& axis, const simd::Doubles& angle) noexcept {
    const auto half = simd::sincos(simd::Doubles(0.5 * angle));
    return {half.cos, axis.x * half.sin, axis.y * half.sin, axis.z * half.sin};
  }

  [[nodiscard]] Rotation operator[](std::size_t lane) const noexcept {
    return detail::rotation_wxyz(w[lane], x[lane], y[lane], z[lane]);
  }
  void set(std::size_t lane, const Rotation& r) noexcept {
    w[lane] = r.w;
    x[lane] = r.x;
    y[lane] = r.y;
    z[lane] = r.z;
  }

  [[nodiscard, gnu::always_inline]] friend RotationLanes operator*(const RotationLanes& p,
                                                                   const RotationLanes& q) noexcept {
    return {p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z, p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
            p.w * q.y + p.y * q.w + p.z * q.x - p.x * q.z, p.w * q.z + p.z * q.w + p.x * q.y - p.y * q.x};
  }
  [[nodiscard, gnu::always_inline]] friend Vec3Lanes operator*(const RotationLanes& r, const Vec3Lanes& v) noexcept {
    const Vec3Lanes axis{r.x, r.y, r.z}, once = cross(axis, v), twice = cross(axis, once);
    return {v.x + (once.x * r.w + twice.x) * 2.0, v.y + (once.y * r.w + twice.y) * 2.0,
            v.z + (once.z * r.w + twice.z) * 2.0};
  }
  [[nodiscard]] friend RotationLanes normalize(const RotationLanes& r) noexcept {
    const simd::Doubles scale = 1.0 / simd::sqrt((r.w * r.w + r.x * r.x) + (r.y * r.y + r.z * r.z));
    return {r.w * scale, r.x * scale, r.y * scale, r.z * scale};
  }
};

/// Rigid transforms from frame `From` to frame `To`, one in each lane, as `Pose`.
template <class From, class To>
struct PoseLanes {
  RotationLanes rotation{};  ///< unit quaternions
  Vec3Lanes position{};      ///< origins of `From` in `To` [m]

  PoseLanes() = default;
  explicit PoseLanes(const RotationLanes& r, const Vec3Lanes& p = {}) noexcept : rotation(r), position(p) {}
  explicit PoseLanes(const Pose<From, To>& p) noexcept : rotation(p.rotation), position(p.position) {}

  [[nodiscard]] Pose<From, To> operator[](std::size_t lane) const noexcept { return {rotation[lane], position[lane]}; }
  void set(std::size_t lane, const Pose<From, To>& p) noexcept {
    rotation.set(lane, p.rotation);
    position.set(lane, p.position);
  }
};

/// Composition of the poses of each lane, the right one first.
template <class A, class B, class C>
[[nodiscard]] PoseLanes<A, C> operator*(const PoseLanes<B, C>& c_from_b, const PoseLanes<A, B>& b_from_a) noexcept {
  return PoseLanes<A, C>{c_from_b.rotation * b_from_a.rotation,
                         c_from_b.rotation * b_from_a.position + c_from_b.position};
}

/// True if in each of these lanes the pose is `rigid`, or not finite: a run reports NaN.
[[nodiscard]] bool rigid_lanes(const auto& poses, const simd::Mask& lanes) noexcept {
  for (std::size_t lane = 0; lane < simd::lane_count; ++lane)
    if (lanes[lane] != 0 && poses[lane].finite() && !poses[lane].rigid()) return false;
  return true;
}

namespace detail {
template <class From, class To, class Motion>
PoseLanes<From, To> lanes_of(simd::Mask (Motion::*poses)(const TickLanes&, PoseLanes<From, To>&) const noexcept);
}

/// Pose at one tick of a motion that `MovesInLanes`: its register of one.
template <class Motion>
[[nodiscard]] auto pose_in_lanes(const Motion& motion, Tick t) noexcept {
  decltype(detail::lanes_of(&Motion::poses)) poses;
  motion.poses(TickLanes(t), poses);
  return poses[0];
}

}  // namespace PULSECAST_NAMESPACE

#endif
