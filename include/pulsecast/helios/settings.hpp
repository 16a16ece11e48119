// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_SETTINGS_HPP
#define PULSECAST_HELIOS_SETTINGS_HPP

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

/// Settings of a survey document, as plain structs in SI units and radians. A program may change them before it builds
/// the survey. Templates, references and inheritance are resolved: each struct is complete. The comment of a member
/// names its attribute or element. A 0 may mean a default or none; `validate` refuses negative values there.
namespace PULSECAST_NAMESPACE::helios {

/// Random offset of the start of legs: `legRandomOffset`.
struct LegOffsetSettings {
  double mean = 0;         ///< along each axis; `legRandomOffsetMean` [m]
  double deviation = 0.1;  ///< along each axis; `legRandomOffsetStdev` [m]

  bool operator==(const LegOffsetSettings&) const = default;
};

/// `<survey>`. Its overrides of the scanner (`<FWFSettings>`, `<detectorSettings>`) and the platform (`<scannerMount>`,
/// noise) are stored there.
struct SurveySettings {
  std::string name{};                             ///< default: that of the file; `name`
  std::optional<std::uint64_t> seed{};            ///< `seed`
  std::optional<LegOffsetSettings> leg_offset{};  ///< `legRandomOffset`...
  ScannerSettings scanner{};                      ///< `scanner`
  PlatformSettings platform{};                    ///< `platform`, or `basePlatform` if that is interpolated
  SceneSettings scene{};                          ///< `scene`
  std::vector<LegSettings> legs{};                ///< `<leg>`, in this order

  bool operator==(const SurveySettings&) const = default;
};

/// True if the legs of such a platform lead to the start of the next one.
[[nodiscard]] constexpr bool legs_connect(PlatformKind kind) noexcept {
  return kind != PlatformKind::stationary && kind != PlatformKind::interpolated;
}

/// True if a moving platform stays in place in a leg.
[[nodiscard]] inline bool is_stationary(const SurveySettings& survey, std::size_t leg) {
  return legs_connect(survey.platform.kind) && stays_in_place(survey.legs, leg);
}

/// True if a leg only ends the one before it, without pulses: the last of several of a moving platform.
[[nodiscard]] inline bool only_ends(const SurveySettings& survey, std::size_t leg) {
  return legs_connect(survey.platform.kind) && leg > 0 && leg + 1 == survey.legs.size();
}

/// Pulse rate of the first leg that sets one; else the scanner's default, else 100 kHz [Hz].
[[nodiscard]] inline double first_pulse_rate(const SurveySettings& survey) {
  for (const LegSettings& leg : survey.legs)
    if (leg.scanner.pulse_rate > 0) return leg.scanner.pulse_rate;
  return survey.scanner.pulse_rates.empty() ? 100e3 : survey.scanner.pulse_rates.front();
}

}  // namespace PULSECAST_NAMESPACE::helios

#endif
