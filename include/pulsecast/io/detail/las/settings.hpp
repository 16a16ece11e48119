// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_SETTINGS_HPP
#define PULSECAST_IO_DETAIL_LAS_SETTINGS_HPP

#include <chrono>

#include <pulsecast/io/point_records.hpp>
#include <pulsecast/io/spatial_reference.hpp>

namespace PULSECAST_NAMESPACE::io {

struct LasSettings;

namespace detail {

/// Extra value that each point has.
struct LasUsualExtra {
  std::string_view name, description;  ///< texts for readers
  NumberType type;                     ///< number type
  const PointColumn* column;           ///< column
  double scale = 1;                    ///< number per unit of the column
};
inline constexpr std::array las_usual_extras{
    // a float would err by 0.5 mm at 10 km
    LasUsualExtra{"Range", "from the instrument [m]", NumberType::float64, column("range")},
    LasUsualExtra{"Amplitude", "received power at peak [dB]", NumberType::float32, column("intensity_level")},
    LasUsualExtra{"Reflectance", "re white Lambertian target [dB]", NumberType::float32, column("reflectance_level")},
    LasUsualExtra{"EchoWidth", "standard deviation in time [ns]", NumberType::float32, column("echo_width"), 1e9},
    LasUsualExtra{"PulseIndex", "number of the pulse, from 0", NumberType::uint64, column("pulse")},
    LasUsualExtra{"ObjectId", "number of the object met", NumberType::uint32, column("object")}};

// sizes [byte]. Source: LAS 1.4 R15, Extra Bytes, Point Data Record Format 4.
inline constexpr std::size_t las_descriptor_size = 192, las_packet_size = 29;

/// Text as far as an Extra Bytes record has room: `most` bytes, of whole UTF-8 characters.
[[nodiscard]] constexpr std::string_view las_cut(std::string_view text, std::size_t most = 31) noexcept {
  std::size_t size = std::min(text.size(), most);
  while (size > 0 && size < text.size() && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  return text.substr(0, size);
}

/// Description of the extra value of a column, with its unit.
[[nodiscard]] inline std::string las_description(const PointColumn& column) {
  const std::string unit = column.unit.empty() ? "" : text::joined({" [", column.unit, "]"});
  return text::joined({las_cut(column.description, 32 - unit.size()), unit});
}

/// Extra values of each point, in order.
[[nodiscard]] std::vector<PointField> las_extras(const LasSettings& settings);

}  // namespace detail

/// Version and point format of a LAS file.
enum class LasFormat : std::uint8_t {
  las_1_4,         ///< point format 6; 7 with colours, 8 with near infrared; 9 with waveforms
  las_1_4_legacy,  ///< point format 1, 4 with waveforms: 5 returns, 32 classes, whole degrees
  las_1_0,         ///< point format 1: as above, without waveforms, WKT, kind of GPS time
};

/// Meaning of the 16-bit intensity of a LAS file, which is linear in it.
enum class LasIntensity : std::uint8_t {
  reflectance,  ///< reflectance of the echo, independent of range
  amplitude,    ///< received power of the echo, as most instruments report it
  /// Received power times the squared ratio of the range to `intensity_range`
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
  bool light_kinds = false;               ///< true to write `Echo::kind` as an extra byte
  PointColours colours = {};              ///< colours, black if unknown. Empty: no colours
  bool near_infrared = false;             ///< true to write the near infrared of the colours, too
  /// Attributes of objects, an extra value for each name; NaN where unknown. Null for none.
  std::shared_ptr<const ObjectAttributes> attributes = nullptr;
  std::vector<PointField> columns = {};  ///< further extra values, see `layouts::columns`
  /// Values of `columns`, but for start time, reference power, colours and attributes of the file.
  PointSettings points = {};
  double scale = 1e-4;  ///< step of the coordinates [m, or unit of `reference`]
  /// Origin of the coordinates [as `scale`]; if empty, the multiple of 1e6 steps nearest to the first point
  std::optional<Vec3> offset = {};
  std::string wkt = {};                                ///< that of `reference`, unless empty
  std::uint16_t epsg = 0;                              ///< that of `reference`, unless 0
  GpsTime gps_time = GpsTime::adjusted_standard;       ///< epoch of times
  double start_time = 0;                               ///< time of the survey's tick 0 [s]
  LasIntensity intensity = LasIntensity::reflectance;  ///< meaning of the intensity
  /// Value stored as 65535, clipped above; empty: reflectance 1, or the maximum amplitude [W]
  std::optional<double> intensity_full_scale = {};
  double intensity_range = 1;                  ///< range that intensities are normalized to [m]
  double amplitude_reference = 1e-9;           ///< reference power of amplitudes in dB [W]
  std::optional<Date> created = std::nullopt;  ///< date in the header; if empty, 0
  SpatialReference reference = {};             ///< reference system of the file, as by `complete_reference`

  void validate() const {
    if (waveforms && format == LasFormat::las_1_0)
      throw SettingError("LasSettings::waveforms", 1, "", "false for version 1.0, which has no waveforms");
    validate_colours();
    validate_extras();
    points.validate();
    require_positive("LasSettings::scale", scale, "m");
    for (int axis = 0; offset && axis < 3; ++axis) require_finite("LasSettings::offset", (*offset)[axis], "m");
    for (const std::string& text : {wkt, reference.wkt})
      require_within("LasSettings::wkt length", text.size(), 0, 65534, "bytes");
    reference.validate();
    if (epsg != 0) require_within("LasSettings::epsg", epsg, 1024, 32766, "");  // source: OGC GeoTIFF 1.1
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

  /// Names must remain different from each other.
  void validate_extras() const {
    const std::vector<PointField> all = detail::las_extras(*this);
    require_within("LasSettings, number of extra values", static_cast<double>(all.size()), 0,
                   65535 / detail::las_descriptor_size, "");
    for (auto extra = all.begin(); extra != all.end(); ++extra) {
      const std::string_view name = detail::las_cut(extra->name);
      const auto has_name = [&](auto& other) { return detail::las_cut(other.name) == name; };
      if (name.empty()) throw SettingError("LasSettings: the extra value ''", " has no name");
      if (std::any_of(all.begin(), extra, has_name))
        throw SettingError(text::joined({"LasSettings: the extra value '", extra->name, "'"}),
                           " is there twice: expected names that differ in their first 31 bytes");
    }
  }
};

namespace detail {

inline std::vector<PointField> las_extras(const LasSettings& s) {
  std::vector<PointField> all;
  for (const LasUsualExtra& usual : las_usual_extras)
    all.push_back({std::string(usual.name), usual.type, usual.column, usual.scale});
  if (s.light_kinds) all.push_back({"LightKind", NumberType::uint8, column("kind")});
  const auto add = [&](const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
  if (s.attributes) add(layouts::attributes(s.attributes->names()));
  add(s.columns);
  return all;
}

/// Settings of the values of the points of a file.
[[nodiscard]] inline PointSettings las_points(const LasSettings& s) {
  PointSettings points = s.points;
  points.start_time = s.start_time;
  points.power_reference = s.amplitude_reference;
  if (s.colours) points.colours = s.colours;
  if (s.attributes) points.attributes = *s.attributes;
  return points;
}

/// Offsets and limits of a file. Source: LAS 1.4 R15, Public Header Block, Point Data Record
/// Formats 1, 4, 6 to 9; LAS 1.0, Public Header Block, Point Data Start Signature.
struct LasLayout {
  explicit LasLayout(const LasSettings& s)
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
        max_returns(legacy ? 5 : 15),
        max_class(legacy ? 31 : 255) {
    columns.size = static_cast<std::uint32_t>(colour);
    if (colour_size > 0) columns = columns.with(layouts::deep_colours());
    if (colour_size == 6) columns.fields.pop_back();
    columns.size = static_cast<std::uint32_t>(extras);
    columns = columns.with(las_extras(s));
    const auto usual = columns.fields.begin() + (colour_size / 2);  // which `LasEncoder` stores
    columns.fields.erase(usual, usual + las_usual_extras.size());
  }

  /// Size of a point [byte].
  [[nodiscard]] std::size_t record() const noexcept { return columns.size; }

  bool legacy;                           ///< true for point formats older than version 1.4
  std::uint8_t minor, format;            ///< version 1.`minor`, point format
  std::size_t header;                    ///< size of the header [byte]
  std::size_t start_signature;           ///< size of the signature before the first point [byte]
  std::size_t colour, colour_size;       ///< offset and size of the colour in a point [byte]
  std::size_t packet, extras;            ///< offsets of wave packet and extra bytes [byte]
  std::uint32_t max_returns, max_class;  ///< limits of return numbers and classes
  PointLayout columns{};                 ///< colours and further extra values in a point
};

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE::io

#endif
