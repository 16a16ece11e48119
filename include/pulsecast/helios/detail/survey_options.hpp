// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_SURVEY_OPTIONS_HPP
#define PULSECAST_HELIOS_DETAIL_SURVEY_OPTIONS_HPP

#include <functional>

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/spatial_reference.hpp>

namespace PULSECAST_NAMESPACE::helios {

/// Options for compiling a survey to pulses.
struct SurveyBuildOptions {
  std::uint64_t seed = 0;      ///< seed of leg offsets and noise
  bool platform_noise = true;  ///< true: platform noise as in the survey; false: none
  bool leg_noise = true;       ///< true: random leg offsets as in the survey; false: none
  /// Place of each leg in its document, as in `survey.xml:12:5`. If empty, as for settings of a
  /// program, the notes of `read_survey` are given with the others.
  std::vector<std::string> leg_places{};
  io::MapProjector projector{};  ///< of trajectories by longitude and latitude

  /// Name of a leg for messages.
  [[nodiscard]] std::string leg_name(std::size_t k) const {
    return (k < leg_places.size() ? leg_places[k] + ": leg " : "leg ") + std::to_string(k);
  }
};

/// Height of any `Ground` [m]; of a `LevelledGround`, the level nearest to a height.
class GroundHeight {
 public:
  template <Ground G>
  requires(!std::same_as<G, GroundHeight>) GroundHeight(G ground)
      : height_([ground = std::move(ground)](const Vec2& at, [[maybe_unused]] double near) -> std::optional<double> {
          if constexpr (LevelledGround<G>)
            return ground(at, near);
          else
            return ground(at);
        }) {}

  [[nodiscard]] std::optional<double> operator()(const Vec2& at,
                                                 double near = std::numeric_limits<double>::infinity()) const {
    return height_(at, near);
  }

 private:
  std::function<std::optional<double>(const Vec2&, double)> height_;
};

static_assert(LevelledGround<GroundHeight>);

}  // namespace PULSECAST_NAMESPACE::helios

#endif
