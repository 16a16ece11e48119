// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_CHECK_WITHOUT_SCENE_HPP
#define PULSECAST_HELIOS_DETAIL_CHECK_WITHOUT_SCENE_HPP

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/helios/detail/optics.hpp>
#include <pulsecast/helios/settings.hpp>
#include <pulsecast/helios/simulation.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/scanner/footprint.hpp>

/// Checks of a survey that need no scene.
namespace PULSECAST_NAMESPACE::helios {

PULSECAST_INLINE std::vector<std::string> check_without_scene(const SurveySettings& survey,
                                                              const std::vector<std::string>& leg_places) {
  const auto ground = [](const Vec2&) -> std::optional<double> { return 0; };
  std::vector<std::string> warnings = compile_survey(survey, ground, {.leg_places = leg_places}).warnings;
  for (const ChannelSettings& channel : survey.scanner.channels) {
    const Receiver receiver = survey_receiver(channel);
    receiver.validate();
    const std::string odd = air_warning(channel.wavelength, receiver);
    if (!odd.empty() && std::find(warnings.begin(), warnings.end(), odd) == warnings.end()) warnings.push_back(odd);
    survey_waveform(channel).validate();
    (void)RingFootprint(static_cast<std::size_t>(std::max(1, channel.waveform.rings)));
  }
  return warnings;
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
