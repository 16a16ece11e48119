// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>

namespace pulsecast::io {

/// What a LAS file is to its readers.
enum class LasFormat : std::uint8_t {
  las_1_4,         ///< version 1.4, point format 6, or 9 with waveforms
  las_1_4_legacy,  ///< version 1.4, point format 1, or 4 with waveforms: 5 returns, 32 classes, angles in whole degrees
  las_1_0,  ///< version 1.0, point format 1, for readers of long ago: as before, without waveforms, well-known text, kind of GPS time
};

/// What the 16-bit intensity of a LAS file stands for; it is linear in it.
enum class LasIntensity : std::uint8_t {
  reflectance,  ///< the echo's reflectance, which does not fall with range
  amplitude,    ///< the echo's received power, as most instruments have it
};

/// What the times of a LAS file count from. Source: ASPRS LAS 1.4 R15, global encoding, bit 0.
enum class GpsTime : std::uint16_t {
  week = 0,               ///< the start of some GPS week
  adjusted_standard = 1,  ///< 1e9 s after the GPS epoch: 14 September 2011, 01:46:40 GPS time
};

struct LasSettings {
  using Date = std::chrono::year_month_day;

  LasFormat format = LasFormat::las_1_4;
  bool waveforms = false;                         ///< whether they are written, to a file beside it that ends in .wdp
  double scale = 1e-4;                            ///< step of the coordinates [m]
  std::optional<Vec3> offset = std::nullopt;      ///< what they are relative to [m]; if empty, the multiple of 1e6 steps next to the first
  std::string wkt = {};                           ///< coordinate reference system in OGC well-known text; if empty, `epsg` counts
  std::uint16_t epsg = 0;                         ///< its code, if projected and in metres; 0 if it is not known, and none is written
  GpsTime gps_time = GpsTime::adjusted_standard;  ///< what times count from
  double start_time = 0;                          ///< when the survey's tick 0 is [s]
  LasIntensity intensity = LasIntensity::reflectance;
  std::optional<double> intensity_full_scale = {};  ///< what is given the greatest intensity, 65535, and all that is more; if empty, a
                                                    ///< reflectance of 1, or the greatest amplitude of the file [W]
  double amplitude_reference = 1e-9;                ///< power that amplitudes in dB are relative to [W]
  std::optional<Date> created = std::nullopt;       ///< in the header; if empty, 0 there, so that the same survey gives the same bytes

  void validate() const {
    if (waveforms && format == LasFormat::las_1_0)
      throw SettingError("LasSettings::waveforms", 1, "", "false with version 1.0, which knows none");
    require_positive("LasSettings::scale", scale, "m");
    for (int axis = 0; offset && axis < 3; ++axis) require_finite("LasSettings::offset", (*offset)[axis], "m");
    require_within("LasSettings::wkt length", static_cast<double>(wkt.size()), 0, 65534, "bytes");  // with its end, 16 bits count it
    if (epsg != 0) require_within("LasSettings::epsg", epsg, 1024, 32766, "");  // source: OGC GeoTIFF 1.1, the codes that are EPSG's
    require_finite("LasSettings::start_time", start_time, "s");
    if (intensity_full_scale)
      require_positive("LasSettings::intensity_full_scale", *intensity_full_scale, intensity == LasIntensity::amplitude ? "W" : "");
    require_positive("LasSettings::amplitude_reference", amplitude_reference, "W");
    if (created && !created->ok()) throw SettingError("LasSettings::created day", unsigned{created->day()}, "", "a day of its month");
  }
};

}  // namespace pulsecast::io
