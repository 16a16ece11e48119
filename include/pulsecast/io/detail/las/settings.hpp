// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_SETTINGS_HPP
#define PULSECAST_IO_DETAIL_LAS_SETTINGS_HPP

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/scene/object_attributes.hpp>
#include <pulsecast/scene/point_colour.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Extra value of each point, after the standard ones.
struct LasExtra {
  std::string_view name, description;
  std::uint8_t type, size;  ///< type: 1 uint8, 5 uint32, 7 uint64, 9 float, 10 double; size [byte]
};

inline constexpr std::array las_extras{
    LasExtra{"Range", "from the instrument [m]", 10, 8},  // a float would err by 0.5 mm at 10 km
    LasExtra{"Amplitude", "received power at peak [dB]", 9, 4},
    LasExtra{"Reflectance", "re white Lambertian target [dB]", 9, 4},
    LasExtra{"EchoWidth", "standard deviation in time [ns]", 9, 4},
    LasExtra{"PulseIndex", "number of the pulse, from 0", 7, 8},
    LasExtra{"ObjectId", "number of the object met", 5, 4},
    LasExtra{"LightKind", "way of the light, 0: direct", 1, 1},  // last: left out unless requested
};

// sizes [byte]. Source: LAS 1.4 R15, Extra Bytes, Point Data Record Format 4.
inline constexpr std::size_t las_descriptor_size = 192, las_packet_size = 29;
inline constexpr std::size_t las_extras_size = [] {
  std::size_t size = 0;
  for (const LasExtra& extra : las_extras) size += extra.size;
  return size;
}();

/// Attribute's name as far as an Extra Bytes record has room: 31 bytes and a terminator, of whole UTF-8 characters.
[[nodiscard]] constexpr std::string_view las_extra_name(std::string_view name) noexcept {
  std::size_t size = name.size() > 31 ? 31 : name.size();
  while (size > 0 && size < name.size() && (static_cast<unsigned char>(name[size]) & 0xC0U) == 0x80U) --size;
  return name.substr(0, size);
}

}  // namespace PULSECAST_NAMESPACE::io::detail

namespace PULSECAST_NAMESPACE::io {

/// Version and point format of a LAS file.
enum class LasFormat : std::uint8_t {
  las_1_4,         ///< version 1.4, point format 6; 7 with colours, 8 with near infrared; 9 with waveforms
  las_1_4_legacy,  ///< version 1.4, point format 1, or 4 with waveforms: 5 returns, 32 classes, angles in whole degrees
  las_1_0,  ///< version 1.0, point format 1, for old readers: as above, but no waveforms, WKT and kind of GPS time
};

/// Meaning of the 16-bit intensity of a LAS file, which is linear in it.
enum class LasIntensity : std::uint8_t {
  reflectance,  ///< reflectance of the echo, independent of range
  amplitude,    ///< received power of the echo, as most instruments report it
  /// Received power times the squared share of the range in `intensity_range`: as of the surface there, but for the air
  range_normalized,
};

/// Epoch of the times of a LAS file. Source: ASPRS LAS 1.4 R15, global encoding, bit 0.
enum class GpsTime : std::uint16_t {
  week = 0,               ///< start of an unspecified GPS week
  adjusted_standard = 1,  ///< 1e9 s after the GPS epoch: 14 September 2011, 01:46:40 GPS time
};

/// Settings of a LAS or LAZ file.
struct LasSettings {
  using Date = std::chrono::year_month_day;  ///< date of creation

  LasFormat format = LasFormat::las_1_4;  ///< version and point format
  bool waveforms = false;                 ///< true to write waveforms to a .wdp file beside it
  bool light_kinds = false;               ///< true to write `Echo::kind` as an extra byte: `ReflectionKind` by number
  PointColours colours = {};   ///< colours of the points; an unknown one is black. Empty: points without colours
  bool near_infrared = false;  ///< true to write the near infrared of the colours, too
  /// Attributes of objects, one extra value of a point for each name; NaN where unknown. Null for none.
  std::shared_ptr<const ObjectAttributes> attributes = nullptr;
  double scale = 1e-4;              ///< step of the coordinates [m]
  std::optional<Vec3> offset = {};  ///< origin [m]; if empty, the multiple of 1e6 steps nearest to the first point
  std::string wkt = {};             ///< coordinate reference system as OGC well-known text; if empty, `epsg` counts
  std::uint16_t epsg = 0;           ///< EPSG code of a projected system in metres; 0 if unknown, and none is written
  GpsTime gps_time = GpsTime::adjusted_standard;       ///< epoch of times
  double start_time = 0;                               ///< time of the survey's tick 0 [s]
  LasIntensity intensity = LasIntensity::reflectance;  ///< meaning of the intensity
  /// Value stored as 65535, the maximum, and clipped above; if empty, a reflectance of 1, or the maximum amplitude [W]
  std::optional<double> intensity_full_scale = {};
  double intensity_range = 1;                  ///< range that intensities are normalized to [m]
  double amplitude_reference = 1e-9;           ///< reference power of amplitudes in dB [W]
  std::optional<Date> created = std::nullopt;  ///< date in the header; if empty, 0, for equal bytes of equal surveys

  void validate() const {
    if (waveforms && format == LasFormat::las_1_0)
      throw SettingError("LasSettings::waveforms", 1, "", "false for version 1.0, which has no waveforms");
    validate_colours();
    if (attributes) validate_attributes();
    require_positive("LasSettings::scale", scale, "m");
    for (int axis = 0; offset && axis < 3; ++axis) require_finite("LasSettings::offset", (*offset)[axis], "m");
    require_within("LasSettings::wkt length", static_cast<double>(wkt.size()), 0, 65534, "bytes");  // and a terminator
    if (epsg != 0) require_within("LasSettings::epsg", epsg, 1024, 32766, "");  // EPSG codes; source: OGC GeoTIFF 1.1
    require_finite("LasSettings::start_time", start_time, "s");
    require_positive("LasSettings::intensity_range", intensity_range, "m");
    if (intensity == LasIntensity::range_normalized && !intensity_full_scale)
      throw SettingError("LasSettings::intensity_full_scale", 0, "W", "given, for intensities normalized by range");
    if (intensity_full_scale)
      require_positive("LasSettings::intensity_full_scale", *intensity_full_scale,
                       intensity == LasIntensity::reflectance ? "" : "W");
    require_positive("LasSettings::amplitude_reference", amplitude_reference, "W");
    if (created && !created->ok())
      throw SettingError("LasSettings::created day", unsigned{created->day()}, "", "a valid date");
  }

 private:
  void validate_colours() const {
    if (colours && format != LasFormat::las_1_4)
      throw SettingError("LasSettings::colours", static_cast<double>(format), "",
                         "empty, unless the format is 0: LAS 1.4 with point format 7 or 8");
    if (colours && waveforms)
      throw SettingError("LasSettings::colours", 1, "", "empty with waveforms, which are written without colours");
    if (near_infrared && !colours) throw SettingError("LasSettings::near_infrared", 1, "", "false without colours");
  }

  /// Names must remain different from each other and from those of the other extra values.
  void validate_attributes() const {
    const std::size_t count = attributes->names().size();
    require_within("LasSettings::attributes, number of names", static_cast<double>(count), 0,
                   65535 / detail::las_descriptor_size - detail::las_extras.size(), "");
    std::vector<std::string_view> known;
    for (const detail::LasExtra& extra : detail::las_extras) known.push_back(extra.name);
    for (const std::string& name : attributes->names()) {
      const std::string_view cut = detail::las_extra_name(name);
      if (cut.empty() || std::find(known.begin(), known.end(), cut) != known.end())
        throw SettingError(("LasSettings::attributes, length of name '" + name + "'").c_str(),
                           static_cast<double>(name.size()), "bytes",
                           "above 0, and names that differ in their first 31 bytes from others and from Range, "
                           "Amplitude, Reflectance, EchoWidth, PulseIndex, ObjectId, LightKind");
      known.push_back(cut);
    }
  }
};

namespace detail {

/// Offsets and limits of a file. Source: LAS 1.4 R15, Public Header Block, Point Data Record Formats 1, 4, 6 to 9;
/// LAS 1.0, Public Header Block, Point Data Start Signature.
struct LasLayout {
  explicit LasLayout(const LasSettings& s) noexcept
      : legacy(s.format != LasFormat::las_1_4),
        minor(s.format == LasFormat::las_1_0 ? 0 : 4),
        format(legacy            ? (s.waveforms ? 4 : 1)
               : s.waveforms     ? 9
               : s.near_infrared ? 8
               : s.colours       ? 7
                                 : 6),
        header(minor == 0 ? 227 : 375),
        start_signature(minor == 0 ? 2 : 0),
        colour(legacy ? 28 : 30),
        colour_size(format == 7   ? 6
                    : format == 8 ? 8
                                  : 0),
        packet(colour + colour_size),
        extras(packet + (s.waveforms ? las_packet_size : 0)),
        extra_count(las_extras.size() - (s.light_kinds ? 0 : 1)),
        attributes(extras + las_extras_size - (s.light_kinds ? 0 : las_extras.back().size)),
        attribute_count(s.attributes ? s.attributes->names().size() : 0),
        max_returns(legacy ? 5 : 15),
        max_class(legacy ? 31 : 255) {}

  /// Size of a point [byte].
  [[nodiscard]] std::size_t record() const noexcept { return attributes + sizeof(double) * attribute_count; }

  bool legacy;                           ///< true for point formats older than version 1.4
  std::uint8_t minor, format;            ///< version 1.`minor`, point format
  std::size_t header;                    ///< size of the header [byte]
  std::size_t start_signature;           ///< size of the signature between the last record and the first point [byte]
  std::size_t colour, colour_size;       ///< offset and size of red, green, blue and near infrared in a point [byte]
  std::size_t packet, extras;            ///< offsets of wave packet and extra bytes in a point [byte]
  std::size_t extra_count;               ///< number of extra values of a point, without attributes
  std::size_t attributes;                ///< offset of the attributes in a point [byte]
  std::size_t attribute_count;           ///< number of attributes of a point
  std::uint32_t max_returns, max_class;  ///< limits of return numbers and classes
};

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE::io

#endif
