// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_TRANSPORT_DETAIL_PLANE_SPREAD_HPP
#define PULSECAST_TRANSPORT_DETAIL_PLANE_SPREAD_HPP

#include <pulsecast/scanner/beam.hpp>
#include <pulsecast/transport/transport_input.hpp>

namespace PULSECAST_NAMESPACE {

/// Plane that all subrays of a beam met, in the frame of the beam.
class MetPlane {
 public:
  /// Fits a plane to the reflections of all subrays, in order, by least squares along the beam.
  MetPlane(const SubrayDirections& beam, std::span<const Reflection> reflections) noexcept {
    const double n = static_cast<double>(reflections.size());
    Vec3 mean{};
    for (std::size_t j = 0; j < reflections.size(); ++j) mean += point(beam, reflections, j) / n;
    double xx = 0, zz = 0, xz = 0, xy = 0, zy = 0;
    for (std::size_t j = 0; j < reflections.size(); ++j) {
      const Vec3 p = point(beam, reflections, j) - mean;
      xx += p.x * p.x;
      zz += p.z * p.z;
      xz += p.x * p.z;
      xy += p.x * p.y;
      zy += p.z * p.y;
    }
    const double determinant = xx * zz - xz * xz;
    across_ = (zz * xy - xz * zy) / determinant;
    up_ = (xx * zy - xz * xy) / determinant;
    ahead_ = mean.y - across_ * mean.x - up_ * mean.z;
  }

  /// Greatest distance of a reflection from the plane, along its ray [m]; NaN without a plane.
  [[nodiscard]] double farthest_from(const SubrayDirections& beam,
                                     std::span<const Reflection> reflections) const noexcept {
    double most = 0;
    for (std::size_t j = 0; j < reflections.size(); ++j) {
      const double range = range_of(exit_of(beam, j), {beam.x[j], beam.y[j], beam.z[j]});
      const double off = std::fabs(range - reflections[j].range);
      if (!(off <= most)) most = off;
    }
    return most;
  }

  /// Range of a subray [m], by its offset in the footprint; negative if it does not meet the plane.
  [[nodiscard, gnu::noinline]] double range_at(const Vec2& offset, const Emitter& emitter) const noexcept {
    const Vec2 scaled = emitter.footprint_scale * offset;
    return range_of(subray_exit(scaled, emitter.laser), subray_direction(scaled, emitter.laser.divergence));
  }

  /// Cosine of the incidence on the axis.
  [[nodiscard]] double cos_incidence() const noexcept { return 1 / std::sqrt(1 + across_ * across_ + up_ * up_); }

  /// Direction in the footprint in which ranges grow, as a unit offset; across, if they do not.
  [[nodiscard]] Vec2 farther(const Emitter& emitter) const noexcept {
    constexpr double small = 1e-3;
    const Vec2 way{range_at({small, 0}, emitter) - range_at({-small, 0}, emitter),
                   range_at({0, small}, emitter) - range_at({0, -small}, emitter)};
    const double size = std::hypot(way.x, way.y);
    return size > 0 ? way / size : Vec2{1, 0};
  }

 private:
  static Vec3 exit_of(const SubrayDirections& beam, std::size_t j) noexcept {
    return beam.from_a_point() ? Vec3{} : beam.exits[j];
  }
  static Vec3 point(const SubrayDirections& beam, std::span<const Reflection> reflections, std::size_t j) noexcept {
    return exit_of(beam, j) + reflections[j].range * Vec3{beam.x[j], beam.y[j], beam.z[j]};
  }
  [[nodiscard]] double range_of(const Vec3& exit, const Vec3& direction) const noexcept {
    return (ahead_ + across_ * exit.x + up_ * exit.z - exit.y) /
           (direction.y - across_ * direction.x - up_ * direction.z);
  }

  double ahead_ = 0, across_ = 0, up_ = 0;  ///< place on the axis [m], and its slopes
};

inline constexpr std::size_t slope_subrays_max = 32'768;  ///< most subrays that light is spread to

namespace detail {

/// Time constant of a pulse, as of a `PulseShape`, in metres of range.
[[nodiscard]] inline double pulse_constant(const Laser& laser) noexcept {
  return 0.5 * speed_of_light * laser.pulse_length / 3.4;
}

/// First reflections of a pulse, from surfaces that the beam met directly.
[[nodiscard]] inline std::span<const Reflection> direct_ones(std::span<const Reflection> reflections) noexcept {
  std::size_t n = 0;
  while (n < reflections.size() && reflections[n].kind == ReflectionKind::surface) ++n;
  return reflections.first(n);
}

/// Smooth surface that a pulse met obliquely.
struct Slope {
  double spread = 0;   ///< deviation of the ranges of a Gaussian beam; 0 if there is none [m]
  Vec2 farther{1, 0};  ///< direction across the footprint in which ranges grow, as a unit offset
  double range = 0;    ///< range on the axis of a plane; 0 for another surface [m]
};

/// Plane that all subrays met, within a tenth of the pulse's deviation.
[[nodiscard, gnu::noinline]] inline Slope met_plane(const TransportInput& light,
                                                    std::span<const Reflection> met) noexcept {
  if (met.size() != light.subrays) return {};
  const MetPlane plane(light.beam, met);
  if (!(plane.farthest_from(light.beam, met) < 0.1 * std::sqrt(3.0) * pulse_constant(light.emitter.laser))) return {};
  if (met.size() == 3)  // which are always on a plane: it is the surface if they met it at its incidence
    for (const Reflection& r : met)
      if (!(std::fabs(r.cos_incidence - plane.cos_incidence()) < 2 * light.beam.spread)) return {};
  const Vec2 farther = plane.farther(light.emitter);
  const double begin = plane.range_at(-2.0 * farther, light.emitter);  // 4 deviations
  const double end = plane.range_at(2.0 * farther, light.emitter);
  if (!(begin > 0 && end > begin)) return {};
  return {(end - begin) / 8, farther, plane.range_at({}, light.emitter)};
}

/// Smooth surface of several planes, or one that ends in the beam. Of the subrays that met
/// something so obliquely that one plane of that incidence would spread their light by more than
/// the pulse's time constant, successive ones met it alike: a tenth of all subrays or more.
[[nodiscard, gnu::noinline]] inline Slope met_facets(const TransportInput& light,
                                                     std::span<const Reflection> met) noexcept {
  const double tau = pulse_constant(light.emitter.laser);
  std::size_t pairs = 0;
  const Reflection* last = nullptr;
  Slope slope;
  for (const Reflection& r : met) {
    const Vec2 radius = beam_radius(light.emitter.laser, r.range);  // twice the deviation
    const double wide = 0.5 * light.emitter.footprint_scale * std::max(radius.x, radius.y);
    const double cosine = r.cos_incidence, spread = wide * std::sqrt(1 - cosine * cosine) / cosine;
    if (!(spread > tau)) continue;
    if (last && std::fabs(cosine - last->cos_incidence) < 2 * light.beam.spread &&
        std::fabs(r.range - last->range) < 8 * spread) {
      ++pairs;
      slope.spread = std::max(slope.spread, spread);
    }
    last = &r;
  }
  return pairs < 2 || 10 * pairs < light.subrays ? Slope{} : slope;
}

/// True if subrays on a plane have the same labels, and powers by share within a tenth.
[[nodiscard, gnu::noinline]] inline bool alike(const TransportInput& light, std::span<const Reflection> met) noexcept {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (std::size_t j = 0; j < met.size(); ++j) {
    if (met[j].object != met[0].object || met[j].classification != met[0].classification) return false;
    const double strength = met[j].power * met[j].range * met[j].range * met[j].range / light.beam.shares[j];
    least = std::min(least, strength);
    most = std::max(most, strength);
  }
  return most < 1.1 * least;
}

/// Place of a subray in a row [deviations], and the width of the beam that it stands for.
struct RowPlace {
  double along, width;
};

/// Sets subrays in a row along a slope, at the places `place(j)`; across, they follow the multiples
/// of the golden ratio. Those off the row are farther off: on a plane, they lie nearer along it.
inline void set_row(SubrayDirections& row, std::size_t size, const Emitter& emitter, const Slope& slope,
                    const auto& place) noexcept {
  const Divergence& divergence = emitter.laser.divergence;
  const Vec2 deviation = 0.25 * emitter.footprint_scale * Vec2{divergence.across, divergence.up};
  const Vec2 farther = slope.farther, aside{-farther.y, farther.x};
  const auto square = [&](const Vec2& at) noexcept { return dot(at * deviation, at * deviation); };
  const auto share = [&](const RowPlace& at) noexcept { return std::exp(-0.5 * at.along * at.along) * at.width; };
  double sum = 0;
  for (std::size_t j = 0; j < size; ++j) sum += share(place(static_cast<double>(j)));
  row.assign(size, emitter, [&](std::size_t j) noexcept -> SubrayDirections::Subray {
    const RowPlace at = place(static_cast<double>(j));
    const double m = (static_cast<double>(j) + 0.5) * 0.5 * (std::sqrt(5.0) - 1);
    const double across = normal_quantile(m - std::floor(m));
    const Vec2 on = at.along * farther, off = on + across * aside;
    const double longer = 0.5 * slope.range * (square(off) - square(on));
    return {0.5 * (off - longer / slope.spread * farther), share(at) / sum};
  });
}

/// Sets subrays for an even plane, nearest to each other where the waveform has its maximum, and
/// `number` of them; returns how many there should be.
[[nodiscard, gnu::noinline]] inline double set_even_row(SubrayDirections& row, std::size_t& number, const Slope& plane,
                                                        const Emitter& emitter) noexcept {
  constexpr double reach = 4, smooth = 2;  // deviations; places over which the distances settle
  const double r = plane.spread / pulse_constant(emitter.laser), ss = r * r + 3;
  const double most = (3 - 3 / ss) / r - 5 * plane.spread / plane.range;  // its pulse begins at the maximum
  const double half = reach + std::fabs(most), wanted = std::sqrt(half * ss * r / (3 * 0.55 * 0.55));
  const double side = std::floor(std::clamp(wanted, 128.0, 0.5 * slope_subrays_max - 1)), step = half / (side * side);
  number = static_cast<std::size_t>(2 * side + 1);
  set_row(row, number, emitter, plane, [&](double j) noexcept -> RowPlace {
    const double n = j - side, q = std::sqrt(n * n + smooth * smooth);
    return {most + step * n * q, step * (q + n * n / q)};
  });
  return 2 * wanted;
}

/// True if neighbours in a row of subrays send back the same labels, and powers on a smooth curve.
[[nodiscard]] inline bool sends_evenly(const SubrayDirections& row, std::size_t size, std::span<const Reflection> met,
                                       double noise) noexcept {
  if (met.size() < size) return false;
  for (std::size_t j = 1; j < size; ++j)
    if (met[j].object != met[0].object || met[j].classification != met[0].classification) return false;
  const auto strength = [&](std::size_t j) noexcept { return met[j].power / row.shares[j]; };
  for (std::size_t j = 2; j < size; ++j)
    if (!(std::fabs(strength(j - 2) - 2 * strength(j - 1) + strength(j)) < 2 * noise * strength(j - 1))) return false;
  return true;
}

}  // namespace detail

/// Span of the ranges of direct reflections, in deviations of the pulse.
[[nodiscard]] inline double span_of_ranges(const TransportInput& light,
                                           std::span<const Reflection> reflections) noexcept {
  simd::Doubles nearest = simd::Doubles{} + std::numeric_limits<double>::infinity(), farthest{};
  const std::size_t n = reflections.size();
  std::size_t j = n % simd::lane_count;
  for (const Reflection& r : reflections.first(j)) {
    nearest = simd::min(r.range - simd::Doubles{}, nearest);
    farthest = simd::max(r.range - simd::Doubles{}, farthest);
  }
  for (; j < n; j += simd::lane_count) {
    const simd::Doubles range = simd::generate([&](std::size_t lane) noexcept { return reflections[j + lane].range; });
    nearest = simd::min(range, nearest);
    farthest = simd::max(range, farthest);
  }
  return (simd::max(farthest) - simd::min(nearest)) / (std::sqrt(3.0) * detail::pulse_constant(light.emitter.laser));
}

/// Spreads the light of a pulse over the smooth surface that its subrays met obliquely, if they
/// did: the pulse is traced again, by as many subrays as make one echo of a plane. `span` is that
/// of the ranges. `trace(light)` sets the reflections anew, and returns the result.
///
/// On a plane, only places along the slope matter: the subrays are a row along it. Derived for
/// pulses of a `PulseShape`, in units of its tau, with the echo's deviation s. Each pulse begins as
/// the square of time, so the slope of a sum of pulses a distance d apart errs by up to d^2 / 12 of
/// its height (Source: formula of Euler and Maclaurin). The slope of the echo is x / s^2 of its
/// height at x from its maximum: if d grows as the root of 12 x / s^2, it is the only one.
///
/// Where neighbours in the row send back other powers or labels, or the surface is not one plane,
/// the row is even, and longer, as paint across the slope is then a sum over neighbours. Errors
/// measured: docs/physics.md. Beyond its room, false echoes are left, and the pulse is unresolved.
void spread_over_plane(const TransportInput& light, double span, std::span<const Reflection> reflections,
                       SubrayDirections& row, TransportResult& result, const auto& trace) noexcept {
  const double tau = detail::pulse_constant(light.emitter.laser);
  // two pulses are two echoes if they are 2 tau apart, or 1.15 deviations, as few subrays may be
  const bool part = span > std::min(2.0, 0.38 * static_cast<double>(light.subrays - 1));
  const auto met = [&] { return detail::direct_ones(reflections.first(result.reflections)); };
  if (!part && (met().size() != light.subrays || detail::alike(light, met()))) return;
  detail::Slope slope = detail::met_plane(light, met());
  const bool plane = slope.spread > 0;
  if (!plane && part) slope = detail::met_facets(light, met());
  if (!(slope.spread > 0)) return;
  const double r = slope.spread / tau, s = std::sqrt(r * r + 3);
  if (static_cast<double>(light.subrays) >= 20 * s * s * s) return;  // dense enough
  const auto trace_row = [&](std::size_t size) noexcept {
    result = trace(light.by(row, size));
    result.spread = true;
  };
  if (plane && part) {
    std::size_t size = 0;
    const double wanted = detail::set_even_row(row, size, slope, light.emitter);
    const bool room = wanted < 1.27 * slope_subrays_max;  // the factor 0.55 becomes 0.7
    trace_row(size);
    result.unresolved = !room || 16 * slope.spread > slope.range;
    if (detail::sends_evenly(row, size, met(), std::min(0.1, 0.5 / (s * std::sqrt(s))))) return;
  }
  constexpr double most = slope_subrays_max;
  const double size = std::ceil(std::min(1024 * r * s, most)), width = 8 / size;
  const auto place = [&](double j) noexcept -> detail::RowPlace { return {width * (j + 0.5) - 4, width}; };
  detail::set_row(row, static_cast<std::size_t>(size), light.emitter, slope, place);
  trace_row(static_cast<std::size_t>(size));
  result.unresolved = s > 16;
}

}  // namespace PULSECAST_NAMESPACE

#endif
