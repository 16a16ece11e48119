// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SCANNER_FOOTPRINT_HPP
#define PULSECAST_SCANNER_FOOTPRINT_HPP

#include <cstdlib>

#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE {

/// Single ray on the beam's axis, for sensors whose footprint does not matter.
struct SingleRay {
  [[nodiscard]] std::size_t size() const noexcept { return 1; }
  [[nodiscard]] Vec2 offset(std::size_t) const noexcept { return {0, 0}; }
  [[nodiscard]] double share(std::size_t) const noexcept { return 1; }
};

namespace detail {

/// Moves offsets of equal energy so that their mean is 0 and, if there are more than two, their
/// second moments are the beam's: a quarter of its squared radius across and up, none mixed. Slopes
/// then broaden an echo as a beam does. The map is the inverse square root of the covariance, the
/// closest to none. Source: two-by-two square root by the theorem of Cayley and Hamilton.
inline void match_moments(std::vector<Vec2>& offsets) noexcept {
  const double n = static_cast<double>(offsets.size());
  Vec2 sum{};
  for (const Vec2& offset : offsets) sum += offset;
  double across = 0, up = 0, mixed = 0;
  for (Vec2& offset : offsets) {
    offset -= sum / n;
    across += offset.x * offset.x / n;
    up += offset.y * offset.y / n;
    mixed += offset.x * offset.y / n;
  }
  const double root = std::sqrt(across * up - mixed * mixed);  // square root of the determinant
  if (offsets.size() < 3 || !(root > 0)) return;
  const double scale = 0.5 / (root * std::sqrt(across + up + 2 * root));
  for (Vec2& offset : offsets)
    offset = scale * Vec2{(up + root) * offset.x - mixed * offset.y, (across + root) * offset.y - mixed * offset.x};
}

}  // namespace detail

/// Second moments of a `RingFootprint`.
enum class RingMoments : std::uint8_t {
  within,  ///< of the beam within its 1/e^2 radius: 0.68 of the whole beam's
  whole,   ///< of the whole beam: circles are wider by 1.2, and slopes broaden echoes alike
};

/// Concentric circles about a central ray; circle i has floor(2 pi i) subrays. Each represents the
/// ring of the beam up to halfway to its neighbours, and its subrays share that energy. The
/// outermost ring ends at the 1/e^2 radius. Footprint of XML surveys. The beam extends beyond it,
/// so a `LatticeFootprint` of as many subrays has fewer errors (docs/tradeoff.md). Slopes broaden
/// an echo by 17 % less than a beam does, unless the moments are those of the whole beam. Source:
/// Winiwarter et al. 2022 for the numbers; the radii are our own, so that rings tile the footprint.
class RingFootprint {
 public:
  /// `circles` from 1 to 1000, the central ray included; 3 are 19 subrays. Throws a `SettingError`.
  explicit RingFootprint(std::size_t circles = 3, RingMoments moments = RingMoments::within) {
    require_within("RingFootprint::circles", circles, 1, 1000, "");
    const double n = static_cast<double>(circles);
    const auto subrays_on = [](std::size_t i) {
      return std::max<std::size_t>(1, static_cast<std::size_t>(2 * pi * static_cast<double>(i)));
    };
    std::size_t subrays = 0;
    for (std::size_t i = 0; i < circles; ++i) subrays += subrays_on(i);
    offsets_ = std::vector<Vec2>(subrays);
    shares_ = std::vector<double>(subrays);
    for (std::size_t i = 0, j = 0; i < circles; ++i) {
      const double radius = static_cast<double>(i) / (n - 0.5);
      const double inner = i == 0 ? 0 : radius - 0.5 / (n - 0.5), outer = radius + 0.5 / (n - 0.5);
      const std::size_t count = subrays_on(i);
      // share of a Gaussian beam between two radii. Source: exp(-2 r^2 / w^2), integrated
      const double ring = std::exp(-2 * inner * inner) - std::exp(-2 * outer * outer);
      for (std::size_t k = 0; k < count; ++k, ++j) {
        const double angle = 2 * pi * static_cast<double>(k) / static_cast<double>(count);
        offsets_[j] = {radius * std::sin(angle), radius * std::cos(angle)};
        shares_[j] = ring / static_cast<double>(count);
      }
    }
    double sum = 0, squares = 0;
    for (const double share : shares_) sum += share;
    for (std::size_t j = 0; j < subrays; ++j) {
      shares_[j] /= sum;
      squares += shares_[j] * dot(offsets_[j], offsets_[j]);
    }
    if (moments == RingMoments::whole && circles > 1)
      for (Vec2& offset : offsets_) offset *= std::sqrt(0.5 / squares);
  }

  [[nodiscard]] std::size_t size() const noexcept { return offsets_.size(); }
  [[nodiscard]] Vec2 offset(std::size_t j) const noexcept { return offsets_[j]; }
  [[nodiscard]] double share(std::size_t j) const noexcept { return shares_[j]; }

 private:
  std::vector<Vec2> offsets_;
  std::vector<double> shares_;
};

/// Subrays of equal energy on a sunflower spiral: golden-angle steps, radii at the quantiles of a
/// Gaussian beam, mapped so that mean and second moments are the beam's. Source: Vogel 1979 for the
/// spiral; radius from inverting 1 - exp(-2 r^2 / w^2).
class SunflowerFootprint {
 public:
  /// `subrays` from 1 to 100,000. Throws a `SettingError`.
  explicit SunflowerFootprint(std::size_t subrays = 19) {
    require_within("SunflowerFootprint::subrays", subrays, 1, 100'000, "");
    offsets_ = std::vector<Vec2>(subrays);
    const double n = static_cast<double>(subrays);
    const double golden_angle = pi * (3 - std::sqrt(5.0));
    for (std::size_t j = 0; j < subrays; ++j) {
      const double energy_inside = (static_cast<double>(j) + 0.5) / n;
      const double radius = subrays == 1 ? 0 : std::sqrt(-0.5 * std::log1p(-energy_inside));
      const double angle = golden_angle * static_cast<double>(j);
      offsets_[j] = {radius * std::sin(angle), radius * std::cos(angle)};
    }
    detail::match_moments(offsets_);  // else slopes would be hit too near or too far
  }

  [[nodiscard]] std::size_t size() const noexcept { return offsets_.size(); }
  [[nodiscard]] Vec2 offset(std::size_t j) const noexcept { return offsets_[j]; }
  [[nodiscard]] double share(std::size_t) const noexcept { return 1 / static_cast<double>(offsets_.size()); }

 private:
  std::vector<Vec2> offsets_;
};

/// Subrays of equal energy on a lattice with a column and a row for each, at the quantiles of a
/// Gaussian beam, mapped so that the second moments are the beam's. Rows follow the order of the
/// multiples of the golden ratio: neighbours across are far apart up. Fewer errors than as many
/// subrays in rings, and as few as on a sunflower (docs/tradeoff.md). Source: Niederreiter 1992,
/// ch. 3, for the order; rows and columns from the normal distribution.
class LatticeFootprint {
 public:
  /// `subrays` from 1 to 100,000. Throws a `SettingError`.
  explicit LatticeFootprint(std::size_t subrays = 19) : offsets_(rows(subrays)) {
    for (std::size_t j = 0; j < subrays; ++j) offsets_[j].x = quantile(j, subrays);
    decorrelate_axes();
    detail::match_moments(offsets_);
  }

  [[nodiscard]] std::size_t size() const noexcept { return offsets_.size(); }
  [[nodiscard]] Vec2 offset(std::size_t j) const noexcept { return offsets_[j]; }
  [[nodiscard]] double share(std::size_t) const noexcept { return 1 / static_cast<double>(offsets_.size()); }

 private:
  /// Quantile of column or row `i` of `number`; a standard deviation is half the beam's radius.
  /// Source: irradiance exp(-2 r^2 / w^2).
  static double quantile(std::size_t i, std::size_t number) noexcept {
    return 0.5 * normal_quantile((static_cast<double>(i) + 0.5) / static_cast<double>(number));
  }

  /// Exchanges the rows of two subrays, and then of others, whose exchange brings across and up
  /// nearest to independence: columns and rows stay nearly upright and level. Many are nearly so.
  void decorrelate_axes() noexcept {
    const std::size_t n = offsets_.size();
    double mixed = 0;
    for (const Vec2& offset : offsets_) mixed += offset.x * offset.y;
    for (int exchange = 0; exchange < 4 && n <= 64; ++exchange) {
      std::size_t first = 0, second = 0;
      double best = mixed;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
          const Vec2 apart = offsets_[i] - offsets_[j];
          const double then = mixed - apart.x * apart.y;
          if (!(std::fabs(then) < std::fabs(best))) continue;
          best = then;
          first = i;
          second = j;
        }
      std::swap(offsets_[first].y, offsets_[second].y);
      mixed = best;
    }
  }

  /// Offset up of the subray in each column.
  static std::vector<Vec2> rows(std::size_t subrays) {
    require_within("LatticeFootprint::subrays", subrays, 1, 100'000, "");
    struct Column {
      double multiple;
      std::size_t number;
    };
    const SharedBuffer<Column> columns(subrays);
    for (std::size_t j = 0; j < subrays; ++j) {
      const double m = (static_cast<double>(j) + 0.5) * 0.5 * (std::sqrt(5.0) - 1);
      columns[j] = {m - std::floor(m), j};
    }
    // no two multiples are equal; std::sort would be compiled in every translation unit
    std::qsort(columns.data(), subrays, sizeof(Column), [](const void* a, const void* b) {
      return static_cast<const Column*>(a)->multiple < static_cast<const Column*>(b)->multiple ? -1 : 1;
    });
    std::vector<Vec2> offsets(subrays);
    for (std::size_t k = 0; k < subrays; ++k) offsets[columns[k].number].y = quantile(k, subrays);
    return offsets;
  }

  std::vector<Vec2> offsets_;
};

/// Footprint that forwards every subray with its hit to the sinks (`EchoBatch::subrays`), for
/// studies of footprints: `WithSubrayRecord{RingFootprint{5}}`.
template <Footprint Pattern>
struct WithSubrayRecord : Pattern {
  using refinements = refines<tag::RecordsSubrays>;
  static constexpr bool recorded = true;  ///< as the concept RecordsSubrays describes
  explicit WithSubrayRecord(Pattern pattern) : Pattern(std::move(pattern)) {}  ///< of a footprint
};

/// Footprint that a survey turns about the axis of each pulse's beam, by a different angle for each
/// pulse: `TurnedFootprint{LatticeFootprint{}}`. A thin wire or edge is then hit by different
/// subrays from pulse to pulse, so that errors of neighbours do not repeat. For round beams only.
template <Footprint Pattern>
struct TurnedFootprint : Pattern {
  using refinements = refines<tag::RotatesPerPulse>;
  static constexpr bool rotates_per_pulse = true;  ///< as the concept RotatesPerPulse describes
  explicit TurnedFootprint(Pattern pattern) : Pattern(std::move(pattern)) {}  ///< of a footprint
};

/// Footprint whose surveys judge the surface that each pulse met, for `uncertainty_of`:
/// `JudgedFootprint{LatticeFootprint{}}`.
template <Footprint Pattern>
struct JudgedFootprint : Pattern {
  using refinements = refines<tag::JudgesSurfaces>;
  [[nodiscard]] constexpr bool judges_surfaces() const noexcept { return true; }
  explicit JudgedFootprint(Pattern pattern) : Pattern(std::move(pattern)) {}  ///< of a footprint
};

}  // namespace PULSECAST_NAMESPACE

#endif
