// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_UNCERTAINTY_HPP
#define PULSECAST_UNCERTAINTY_HPP

#include <pulsecast/detector/timing_errors.hpp>
#include <pulsecast/scene/surface_query.hpp>
#include <pulsecast/survey.hpp>

/// Uncertainty of points: the errors that a survey draws, stated for each of its points.
namespace PULSECAST_NAMESPACE {

/// What the uncertainty of a point is made of.
struct UncertaintyOptions {
  /// True: also where a point lies in its footprint on the surface. Its slope is known in size, not in direction, and
  /// spreads it along the beam. Source: Schaer et al. 2007; Lichti & Gordon 2004.
  bool footprint = false;
};

namespace detail {

template <class Source>
inline constexpr bool states_own = !MeasuresBeam<Source> || StatesErrors<Source>;
/// True of a source without an instrument that measures its beam with errors that it does not state.
template <class Source>
inline constexpr bool states_all = states_own<Source>;
template <template <class...> class Wrapper, class... Parts>
inline constexpr bool states_all<Wrapper<Parts...>> = (states_own<Wrapper<Parts...>> && ... && states_all<Parts>);

/// Uncertainty of the echoes of a survey.
template <class Survey>
class SurveyUncertainty {
  using Source = std::remove_cvref_t<decltype(std::declval<const Survey&>().source())>;

 public:
  SurveyUncertainty(const Survey& survey, const UncertaintyOptions& options) : survey_(&survey), options_(options) {
    for (const Emitter& emitter : survey.source().emitters()) {
      const auto alike = std::ranges::find_if(emitters_, [&](const OfEmitter& e) {
        return e.emitter.laser == emitter.laser && e.emitter.receiver == emitter.receiver;
      });
      const auto& unit = survey.receivers()[emitter.receiver];
      const std::size_t number = emitters_.size();
      emitters_.push_back(
          {emitter,
           alike != emitters_.end() ? alike->timing : std::make_shared<const TimingErrors>(unit.detector, emitter),
           deviation_of(unit.footprint, emitter), unit.footprint.size() == 1});
      if (by_channel_.size() <= emitter.channel) by_channel_.resize(emitter.channel + 1U, none);
      std::size_t& known = by_channel_[emitter.channel];
      known = known == none || emitters_[known].emitter == emitter ? number : several;
    }
  }

  [[nodiscard]] PointUncertainty operator()(const Shot& shot, const Echo& echo) const noexcept {
    PointUncertainty u;
    const OfEmitter* const of = emitter_of(shot);
    if (!of) return u;
    const Vec3 beam = echo.range * shot.direction;
    if constexpr (StatesErrors<Source>)
      survey_->source().visit_errors(
          shot.index, shot.tick, [&](const PoseError<frame::World>& error) __attribute__((always_inline)) {
            Covariance& part = error.scope == ErrorScope::pulse ? u.random : u.systematic;
            const Vec3 arm = error.about ? (shot.origin - *error.about) + beam : beam;
            if (error.moved != Vec3{} || error.turned != Vec3{}) part.add(error.moved + cross(error.turned, arm));
            if (error.turned_any_way > 0 || error.moved_any_way > 0) {
              const double turned = error.turned_any_way * error.turned_any_way;
              part.add(error.moved_any_way * error.moved_any_way + turned * dot(arm, arm));
              part.add(arm, -turned);
            }
          });
    const RangeErrors& range = survey_->receivers()[of->emitter.receiver].receiver.range_errors;
    const double wide = of->deviation * beam_radius(of->emitter.laser, echo.range).x;
    const double steep = 1 / (echo.cos_incidence * echo.cos_incidence) - 1;  // square of the slope
    const TimingErrors::Error timing = of->timing->of(echo.amplitude, wide * std::sqrt(steep));
    const double noise = range.noise_of(echo), bias = timing.bias * timing.bias;
    u.random.add(shot.direction, noise * noise + timing.deviation * timing.deviation);
    const bool biased = 25 * bias > u.total().along(shot.direction);
    u.systematic.add(shot.direction, range.systematic_variance(echo, shot.channel) + bias);
    if (options_.footprint) {
      u.random.add(wide * wide);
      u.random.add(wide * shot.direction, steep - 1);
    }
    u.flags = flags_of(shot, echo, timing, of->single, biased);
    return u;
  }

 private:
  struct OfEmitter {
    Emitter emitter;
    std::shared_ptr<const TimingErrors> timing;
    double deviation;  // of the footprint, in radii of the beam
    bool single;       // true for a footprint of one ray
  };
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max(), several = none - 1;

  static double deviation_of(const auto& footprint, const Emitter& emitter) noexcept {
    double square = 0;
    for (std::size_t j = 0; j < footprint.size(); ++j)
      square += 0.5 * footprint.share(j) * dot(footprint.offset(j), footprint.offset(j));
    return emitter.footprint_scale * std::sqrt(square);
  }

  /// Emitter of a pulse: asked of the source where several share a channel, as of legs with different lasers.
  [[nodiscard]] const OfEmitter* emitter_of(const Shot& shot) const noexcept {
    const std::size_t number = shot.channel < by_channel_.size() ? by_channel_[shot.channel] : none;
    if (number < several) return &emitters_[number];
    const auto pulse = number == several ? survey_->source().pulse(shot.index) : std::nullopt;
    return pulse ? &emitters_[pulse->emitter] : nullptr;
  }

  static std::uint8_t flags_of(const Shot& shot, const Echo& echo, const TimingErrors::Error& timing, bool single,
                               bool biased) noexcept {
    unsigned flags = 0;
    if (!single && shot.surface != MetSurface::smooth) flags |= PointUncertainty::mixed;
    if (timing.weak) flags |= PointUncertainty::weak;
    if (echo.kind != ReflectionKind::surface) flags |= PointUncertainty::indirect;
    if (biased || timing.beyond) flags |= PointUncertainty::biased;
    if (!states_all<Source>) flags |= PointUncertainty::unstated;
    return static_cast<std::uint8_t>(flags);
  }

  const Survey* survey_;
  UncertaintyOptions options_;
  std::vector<OfEmitter> emitters_{};
  std::vector<std::size_t> by_channel_{};  // number of the only emitter of a channel, or `none`, or `several`
};

}  // namespace detail

/// Uncertainty of the points of a survey, which must outlive it: the covariance of the errors that the survey draws, to
/// first order. They are those of `WithPoseErrors`, of `RangeErrors`, of any source that `StatesErrors`, and of the
/// detector as it measures planes (`TimingErrors`). A bias or misalignment of a given size counts as one standard
/// deviation. Tells mixed footprints from smooth ones with a `JudgedFootprint`. Source: Glennie 2007 for the
/// propagation.
template <WorldSource Source, Footprint Footprint, Target Target, Detector Detector, Transport<Target> Transport>
[[nodiscard]] UncertaintyQuery uncertainty_of(const Survey<Source, Footprint, Target, Detector, Transport>& survey,
                                              const UncertaintyOptions& options = {}) {
  return detail::SurveyUncertainty(survey, options);
}

}  // namespace PULSECAST_NAMESPACE

#endif
