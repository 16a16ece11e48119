// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/helios/detail/settings/leg.hpp>
#include <pulsecast/helios/detail/settings/mount.hpp>
#include <pulsecast/helios/detail/settings/platform.hpp>
#include <pulsecast/helios/detail/settings/scanner.hpp>
#include <pulsecast/helios/detail/settings/scene.hpp>

/// What the documents of a survey say, as plain structs in SI units and radians that a program may change before it builds the survey from
/// them. Templates, references and inheritance are resolved: each struct says all that counts. After each field stands the attribute
/// or element that it is in a document. Where 0 stands for a default or for none, less is no setting: `validate` refuses it.
namespace pulsecast::helios {

/// By how much legs begin elsewhere than they should: `legRandomOffset`.
struct LegOffsetSettings {
  double mean = 0;         ///< along each axis; `legRandomOffsetMean` [m]
  double deviation = 0.1;  ///< along each axis; `legRandomOffsetStdev` [m]

  bool operator==(const LegOffsetSettings&) const = default;
};

/// `<survey>`. What it sets of the scanner (`<FWFSettings>`, `<detectorSettings>`) and the platform (`<scannerMount>`, noise) stands there.
struct SurveySettings {
  std::string name{};                             ///< the file's unless given; `name`
  std::optional<std::uint64_t> seed{};            ///< `seed`
  std::optional<LegOffsetSettings> leg_offset{};  ///< `legRandomOffset`...
  ScannerSettings scanner{};                      ///< `scanner`
  PlatformSettings platform{};                    ///< `platform`, or `basePlatform` if that is interpolated
  SceneSettings scene{};                          ///< `scene`
  std::vector<LegSettings> legs{};                ///< `<leg>`, in this order

  bool operator==(const SurveySettings&) const = default;
};

/// Whether legs of such a platform lead to the place where the next one begins.
[[nodiscard]] constexpr bool legs_connect(PlatformKind kind) noexcept {
  return kind != PlatformKind::stationary && kind != PlatformKind::interpolated;
}

/// Whether a platform that moves does not in a leg.
[[nodiscard]] inline bool is_stationary(const SurveySettings& survey, std::size_t leg) {
  return legs_connect(survey.platform.kind) && stays_in_place(survey.legs, leg);
}

/// Whether a leg only says where the one before it ends, and has no pulses: the last of several of a platform that moves.
[[nodiscard]] inline bool only_ends(const SurveySettings& survey, std::size_t leg) {
  return legs_connect(survey.platform.kind) && leg > 0 && leg + 1 == survey.legs.size();
}

/// Pulse rate of the first leg that sets one; the scanner's usual one if none does, and 100 kHz if it has none [Hz].
[[nodiscard]] inline double first_pulse_rate(const SurveySettings& survey) {
  for (const LegSettings& leg : survey.legs)
    if (leg.scanner.pulse_rate > 0) return leg.scanner.pulse_rate;
  return survey.scanner.pulse_rates.empty() ? 100e3 : survey.scanner.pulse_rates.front();
}

}  // namespace pulsecast::helios
