// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <locale>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <pulsecast/adapters/output_file.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/version.hpp>

namespace pulsecast::adapters {

static_assert(std::endian::native == std::endian::little, "LAS files are little-endian, and are written as the numbers lie in memory");

/// What the times of a LAS file count from. Source: ASPRS LAS 1.4 R15, global encoding, bit 0.
enum class GpsTime : std::uint16_t {
  week = 0,               ///< the start of some GPS week
  adjusted_standard = 1,  ///< 1e9 s after the GPS epoch: 14 September 2011, 01:46:40 GPS time
};

struct LasSettings {
  using Date = std::chrono::year_month_day;

  double scale = 1e-4;                            ///< step of the coordinates [m]
  std::optional<Vec3> offset = std::nullopt;      ///< what they are relative to [m]; if empty, the multiple of 1e6 steps next to the first
  std::string wkt = {};                           ///< coordinate reference system in OGC well-known text; if empty, `epsg` counts
  std::uint16_t epsg = 0;                         ///< its code, if projected and in metres; 0 if it is not known, and none is written
  GpsTime gps_time = GpsTime::adjusted_standard;  ///< what times count from
  double start_time = 0;                          ///< when the survey's tick 0 is [s]
  double intensity_full_scale = 1;                ///< reflectance that is given the greatest intensity, 65535; what is more, is cut
  double amplitude_reference = 1e-9;              ///< power that amplitudes in dB are relative to [W]
  std::optional<Date> created = std::nullopt;     ///< in the header; if empty, 0 there, so that the same survey gives the same bytes

  void validate() const {
    expect_positive("LasSettings::scale", scale, "m");
    for (int axis = 0; offset && axis < 3; ++axis) expect_finite("LasSettings::offset", (*offset)[axis], "m");
    expect_within("LasSettings::wkt length", static_cast<double>(wkt.size()), 0, 65534, "bytes");  // with its end, 16 bits count it
    if (epsg != 0) expect_within("LasSettings::epsg", epsg, 1024, 32766, "");  // source: OGC GeoTIFF 1.1, the codes that are EPSG's
    expect_finite("LasSettings::start_time", start_time, "s");
    expect_positive("LasSettings::intensity_full_scale", intensity_full_scale, "");
    expect_positive("LasSettings::amplitude_reference", amplitude_reference, "W");
    if (created && !created->ok()) throw SettingError("LasSettings::created day", unsigned{created->day()}, "", "a day of its month");
  }
};

namespace detail {

/// One of the values that stand after the standard ones in each point.
struct LasExtra {
  std::string_view name, description;
  std::uint8_t type, size;  ///< of data, in the words of the Extra Bytes record: 5 uint32, 7 uint64, 9 float, 10 double
};

inline constexpr std::array las_extras{
    LasExtra{"Range", "from the instrument [m]", 10, 8},  // a float would err by 0.5 mm at 10 km
    LasExtra{"Amplitude", "received power at peak [dB]", 9, 4},
    LasExtra{"Reflectance", "re white Lambertian target [dB]", 9, 4},
    LasExtra{"EchoWidth", "standard deviation in time [ns]", 9, 4},
    LasExtra{"PulseIndex", "number of the pulse, from 0", 7, 8},
    LasExtra{"ObjectId", "number of the object met", 5, 4},
};

// Sizes in bytes. Source: LAS 1.4 R15, Public Header Block, Variable Length Records, Point Data Record Format 6, Extra Bytes.
inline constexpr std::size_t las_header_size = 375, las_vlr_header_size = 54, las_point_size = 30, las_descriptor_size = 192;
inline constexpr std::size_t las_record_size = [] {
  std::size_t size = las_point_size;
  for (const LasExtra& extra : las_extras) size += extra.size;
  return size;
}();

/// Bytes that are filled in by their positions.
template <std::size_t Size>
struct LasBytes : std::array<std::byte, Size> {
  template <class Number>
  void put(std::size_t position, Number value) noexcept {
    std::memcpy(this->data() + position, &value, sizeof value);
  }
  void put_text(std::size_t position, std::string_view text) noexcept { std::memcpy(this->data() + position, text.data(), text.size()); }
};

/// To the nearest whole number, cut to [low, high]; what is not a number becomes `low`.
template <class Integer>
[[nodiscard]] Integer las_rounded(double value, double low, double high) noexcept {
  return static_cast<Integer>(std::nearbyint(std::fmin(std::fmax(value, low), high)));
}

/// A ratio of powers as a level [dB], at least -200: the level of nothing.
[[nodiscard]] inline float las_level(double ratio) noexcept { return static_cast<float>(ratio > 1e-20 ? 10 * std::log10(ratio) : -200.0); }

/// The well-known text of a reference system that is UTM on WGS 84, ETRS89 or NAD83; empty for any other code, as definitions are in a
/// register of thousands. Source: EPSG registry; OGC 01-009 (Coordinate Transformation Services), 7.
[[nodiscard]] inline std::string las_utm(std::uint16_t epsg) {
  struct Family {
    unsigned first, last;  // codes of its zones
    unsigned zone;         // the first
    std::string_view system, system_code, datum, datum_code, ellipsoid, flattening, ellipsoid_code;
    bool south = false;
  };
  static constexpr std::array<Family, 4> families{{
      {32601, 32660, 1, "WGS 84", "4326", "WGS_1984", "6326", "WGS 84", "298.257223563", "7030"},
      {32701, 32760, 1, "WGS 84", "4326", "WGS_1984", "6326", "WGS 84", "298.257223563", "7030", true},
      {25828, 25838, 28, "ETRS89", "4258", "European_Terrestrial_Reference_System_1989", "6258", "GRS 1980", "298.257222101", "7019"},
      {26901, 26923, 1, "NAD83", "4269", "North_American_Datum_1983", "6269", "GRS 1980", "298.257222101", "7019"},
  }};
  const auto family = std::find_if(families.begin(), families.end(), [&](const Family& f) { return epsg >= f.first && epsg <= f.last; });
  if (family == families.end()) return {};
  const unsigned zone = epsg - family->first + family->zone;
  const auto code = [](std::string_view number) { return "AUTHORITY[\"EPSG\",\"" + std::string(number) + "\"]"; };
  const auto quoted = [](std::string_view name) { return "[\"" + std::string(name) + "\","; };
  const std::string name = std::string(family->system) + " / UTM zone " + std::to_string(zone) + (family->south ? "S" : "N");
  return "PROJCS" + quoted(name) + "GEOGCS" + quoted(family->system) + "DATUM" + quoted(family->datum) + "SPHEROID" +
         quoted(family->ellipsoid) + "6378137," + std::string(family->flattening) + ',' + code(family->ellipsoid_code) + "]," +
         code(family->datum_code) + "],PRIMEM[\"Greenwich\",0," + code("8901") + "],UNIT[\"degree\",0.0174532925199433," + code("9122") +
         "]," + code(family->system_code) + "],PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0]," +
         "PARAMETER[\"central_meridian\"," + std::to_string(6 * static_cast<int>(zone) - 183) +
         "],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\"," +
         (family->south ? "10000000" : "0") + "],UNIT[\"metre\",1," + code("9001") + "],AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH]," +
         code(std::to_string(epsg)) + ']';
}

}  // namespace detail

/// Writes points as LAS 1.4, point format 6 with extra bytes, in pulse order; memory does not grow with their number.
/// Source of every field: ASPRS LAS Specification 1.4 R15. What it leaves open is decided so:
/// - coordinates are rounded to the nearest step; one that does not fit 32 bits, or is not finite, is a `FileError`;
/// - intensity is the reflectance, linear; the extra bytes Amplitude and Reflectance are levels [dB], -200 for nothing;
/// - return numbers and their count end at 15, as the format does: later returns are written as the 15th;
/// - classes end at 255; point source id is the leg plus 1, at most 65535; scanner channel is the channel's lowest two bits;
/// - scan angle counts from down, positive to the right of the flight; GPS time is that of the pulse, alike in all its returns;
/// - a reference system that is known by its code alone, and not one of UTM, is written as GeoTIFF keys and the WKT bit is left out: the
///   specification wants well-known text with this point format, but a code that readers understand is more than nothing;
/// - flags, scan direction, edge of flight line and user data are 0, for no field of an echo tells them.
/// Only `close()` makes the file: see `OutputFile`.
class LasWriter {
 public:
  explicit LasWriter(std::filesystem::path path, LasSettings settings = {})
      : settings_(validated(std::move(settings))), file_(std::move(path)), offset_(settings_.offset.value_or(Vec3{})) {
    if (settings_.wkt.empty()) settings_.wkt = detail::las_utm(settings_.epsg);
    file_.write(header());
    write_extra_bytes_record();
    if (!settings_.wkt.empty()) write_wkt_record();
    if (by_keys()) write_keys_record();
  }

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      if (shot.echoes != 0) write(shot, batch.echoes_of(shot));
    }
  }

  /// Enters numbers and bounds into the header and gives the file its name.
  void close() {
    file_.overwrite(0, header());
    file_.commit();
  }

 private:
  using Header = detail::LasBytes<detail::las_header_size>;
  using Record = detail::LasBytes<detail::las_record_size>;
  static constexpr std::uint32_t most_returns = 15;  // the format has four bits

  void write(const Shot& shot, std::span<const Echo> echoes) {
    Record record{};  // positions: LAS 1.4 R15, Point Data Record Format 6; then those of `las_extras`
    const std::uint32_t returns = std::min(shot.echoes, most_returns);
    record.put(15, static_cast<std::uint8_t>((shot.channel & 3U) << 4));
    record.put(18, detail::las_rounded<std::int16_t>(degrees(shot.scan_angle) / 0.006, -30000, 30000));
    record.put(20, static_cast<std::uint16_t>(std::min(shot.leg + 1U, 65535U)));
    record.put(22, settings_.start_time + shot.tick.seconds());
    record.put(50, shot.index);
    for (const Echo& echo : echoes) {
      const Vec3 point = point_of(shot, echo);
      if (points_ == 0 && !settings_.offset) choose_offset(point);
      const std::uint32_t number = std::clamp<std::uint32_t>(echo.number, 1, returns);
      record.put(0, coordinate(point.x, offset_.x, 0));
      record.put(4, coordinate(point.y, offset_.y, 1));
      record.put(8, coordinate(point.z, offset_.z, 2));
      record.put(12, detail::las_rounded<std::uint16_t>(echo.reflectance / settings_.intensity_full_scale * 65535, 0, 65535));
      record.put(14, static_cast<std::uint8_t>(number | returns << 4));
      record.put(16, static_cast<std::uint8_t>(std::min<unsigned>(echo.classification, 255)));
      record.put(30, echo.range);
      record.put(38, detail::las_level(echo.amplitude / settings_.amplitude_reference));
      record.put(42, detail::las_level(echo.reflectance));
      record.put(46, static_cast<float>(echo.width * 1e9));
      record.put(58, echo.object);
      file_.write(record);
      ++points_;
      ++points_by_return_[number - 1];
    }
  }

  /// Far from the origin numbers stay small this way, and the offset reads well: with steps of 0.1 mm it is a multiple of 100 m.
  void choose_offset(const Vec3& first) {
    const double unit = settings_.scale * 1e6;
    if (finite(first))
      offset_ = {std::nearbyint(first.x / unit) * unit, std::nearbyint(first.y / unit) * unit, std::nearbyint(first.z / unit) * unit};
  }

  [[nodiscard]] std::int32_t coordinate(double value, double offset, std::size_t axis) {
    const double steps = std::nearbyint((value - offset) / settings_.scale);
    if (!(steps >= std::numeric_limits<std::int32_t>::min() && steps <= std::numeric_limits<std::int32_t>::max()))
      misfit(value, offset, axis);
    const auto stored = static_cast<std::int32_t>(steps);
    least_[axis] = points_ == 0 ? stored : std::min(least_[axis], stored);
    most_[axis] = points_ == 0 ? stored : std::max(most_[axis], stored);
    return stored;
  }

  [[noreturn]] void misfit(double value, double offset, std::size_t axis) {
    file_.discard();
    std::ostringstream problem;
    problem.imbue(std::locale::classic());
    problem.precision(12);
    problem << "xyz"[axis] << " is " << value << " m, which does not fit 32 bits; expected " << offset << " m +- "
            << settings_.scale * std::numeric_limits<std::int32_t>::max() << " m (offset, and 2^31 steps of " << settings_.scale << " m)";
    throw FileError(file_.path().string(), "point " + std::to_string(points_ + 1), problem.str());
  }

  /// The header as of now. Positions: LAS 1.4 R15, Public Header Block; what is not put is 0, as the legacy numbers must be with format 6.
  [[nodiscard]] Header header() const {
    const std::size_t wkt_record = settings_.wkt.empty() ? 0 : detail::las_vlr_header_size + settings_.wkt.size() + 1;
    const std::size_t keys_record = by_keys() ? detail::las_vlr_header_size + 2 * keys_size : 0;
    const std::size_t extra_record = detail::las_vlr_header_size + detail::las_extras.size() * detail::las_descriptor_size;
    const unsigned wkt_bit = by_keys() ? 0 : 1U << 4;  // LAS 1.4 R15, Global Encoding: must be set with format 6
    Header h{};
    h.put_text(0, "LASF");
    h.put(6, static_cast<std::uint16_t>(static_cast<unsigned>(settings_.gps_time) | wkt_bit));
    h.put(24, std::uint8_t{1});
    h.put(25, std::uint8_t{4});
    h.put_text(26, "simulation");
    h.put_text(58, "pulsecast " PULSECAST_VERSION);
    if (settings_.created) {
      using std::chrono::sys_days;
      const std::chrono::year year = settings_.created->year();
      const auto day = sys_days{*settings_.created} - sys_days{year / std::chrono::January / 1};
      h.put(90, static_cast<std::uint16_t>(day.count() + 1));  // 1 January is day 1
      h.put(92, static_cast<std::uint16_t>(int{year}));
    }
    h.put(94, static_cast<std::uint16_t>(detail::las_header_size));
    h.put(96, static_cast<std::uint32_t>(detail::las_header_size + extra_record + wkt_record + keys_record));  // where the points begin
    h.put(100, std::uint32_t{settings_.wkt.empty() && !by_keys() ? 1U : 2U});                                  // variable length records
    h.put(104, std::uint8_t{6});                                                                               // point format
    h.put(105, static_cast<std::uint16_t>(detail::las_record_size));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double offset = offset_[static_cast<int>(axis)];
      h.put(131 + 8 * axis, settings_.scale);
      h.put(155 + 8 * axis, offset);
      if (points_ == 0) continue;
      h.put(179 + 16 * axis, most_[axis] * settings_.scale + offset);
      h.put(187 + 16 * axis, least_[axis] * settings_.scale + offset);
    }
    h.put(247, points_);
    for (std::size_t i = 0; i < most_returns; ++i) h.put(255 + 8 * i, points_by_return_[i]);
    return h;
  }

  /// Source: LAS 1.4 R15, Variable Length Records.
  void write_record_header(std::string_view user, std::uint16_t record, std::size_t size, std::string_view description) {
    detail::LasBytes<detail::las_vlr_header_size> h{};
    h.put_text(2, user);
    h.put(18, record);
    h.put(20, static_cast<std::uint16_t>(size));
    h.put_text(22, description);
    file_.write(h);
  }

  /// Source: LAS 1.4 R15, Extra Bytes.
  void write_extra_bytes_record() {
    write_record_header("LASF_Spec", 4, detail::las_extras.size() * detail::las_descriptor_size, "Extra Bytes");
    for (const detail::LasExtra& extra : detail::las_extras) {
      detail::LasBytes<detail::las_descriptor_size> descriptor{};
      descriptor.put(2, extra.type);
      descriptor.put_text(4, extra.name);
      descriptor.put_text(160, extra.description);
      file_.write(descriptor);
    }
  }

  /// Source: LAS 1.4 R15, OGC Coordinate System WKT.
  void write_wkt_record() {
    write_record_header("LASF_Projection", 2112, settings_.wkt.size() + 1, "OGC Coordinate System WKT");
    file_.write(std::string_view(settings_.wkt.c_str(), settings_.wkt.size() + 1));
  }

  /// Whether the reference system is known by its code alone.
  [[nodiscard]] bool by_keys() const noexcept { return settings_.wkt.empty() && settings_.epsg != 0; }

  /// A header and three keys: the model is projected, its code, and its unit, the metre. Source: OGC GeoTIFF 1.1, 7.1.2 and annex B; LAS
  /// 1.4 R15, GeoKeyDirectoryTag Record.
  void write_keys_record() {
    const std::array<std::uint16_t, keys_size> keys{1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, settings_.epsg, 3076, 0, 1, 9001};
    write_record_header("LASF_Projection", 34735, sizeof keys, "GeoTIFF GeoKeyDirectoryTag");
    detail::LasBytes<sizeof keys> bytes{};
    for (std::size_t i = 0; i < keys.size(); ++i) bytes.put(2 * i, keys[i]);
    file_.write(bytes);
  }

  static constexpr std::size_t keys_size = 16;

  LasSettings settings_;
  OutputFile file_;
  Vec3 offset_;
  std::array<std::int32_t, 3> least_{}, most_{};  // of the coordinates as stored
  std::uint64_t points_ = 0;
  std::array<std::uint64_t, most_returns> points_by_return_{};
};
static_assert(EchoSink<LasWriter>);

}  // namespace pulsecast::adapters
