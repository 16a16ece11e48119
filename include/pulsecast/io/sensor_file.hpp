// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_SENSOR_FILE_HPP
#define PULSECAST_IO_SENSOR_FILE_HPP

#include <pulsecast/base/suggestion.hpp>
#include <pulsecast/io/detail/packets/calibration_file.hpp>
#include <pulsecast/sensor/sensor_sheet.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings of a sensor, where its file gives a choice.
struct SensorFileSettings {
  std::optional<double> rotation_rate{};  ///< turns per second, in the limits of the file [Hz]
  std::optional<std::size_t> columns{};   ///< firing sequences a turn, one number of the file's
};

namespace detail {

/// Section of a sensor's file: a map of known keys, of which `source` says where the numbers are from.
class SensorSection {
 public:
  SensorSection(const CalibrationFile& file, const std::string& name, std::vector<std::string> known)
      : file_(file), name_(name), map_(file.find(file.root(), name)) {
    if (!map_) return;
    known.push_back("source");
    require_known(file, *map_, name, known);
    if (file.word(file.at(*map_, "source"), name_ + ".source").empty())
      file.fail(*map_, name_, ".source is empty: expected where the numbers are from");
  }

  /// Refuses keys that are unknown, or there twice.
  static void require_known(const CalibrationFile& file, const YAML::Node& map, const std::string& name,
                            const std::vector<std::string>& known) {
    if (!map.IsMap()) file.fail(map, name, " is no map");
    std::vector<std::string> seen;
    for (const auto& pair : map) {
      const std::string key = file.word(pair.first, "a key");
      if (std::ranges::find(known, key) == known.end())
        file.fail(pair.first, name, " has the key ", text::quoted(key), ", which is unknown",
                  text::suggestion(key, known));
      if (std::ranges::find(seen, key) != seen.end())
        file.fail(pair.first, name, " has the key ", text::quoted(key), " twice: expected it once");
      seen.push_back(key);
    }
  }

  [[nodiscard]] bool is_there() const noexcept { return map_.has_value(); }
  [[nodiscard]] std::optional<YAML::Node> find(const std::string& key) const {
    return map_ ? file_.find(*map_, key) : std::nullopt;
  }

  /// Number of a key, from `low` to `high` in the unit of the key, or else `otherwise`, both in SI units.
  [[nodiscard]] double number(const std::string& key, double unit, double low, double high, double otherwise) const {
    const std::optional<YAML::Node> node = find(key);
    return node ? unit * file_.number(*node, name_ + "." + key, low, high) : otherwise;
  }

  /// Numbers of a key in SI units: a list; one, `count` times; or `number` of them, even `from` one
  /// `to` another. Without the key, zeros. Of any number if `count` is 0.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, double unit, double low, double high,
                                            std::size_t count) const {
    const std::optional<YAML::Node> node = find(key);
    if (!node) return std::vector<double>(count);
    const std::string name = name_ + "." + key;
    std::vector<double> values(std::max<std::size_t>(count, 1));
    if (node->IsSequence()) {
      values = file_.numbers(*node, name, count > 0 ? count : node->size(), low, high);
    } else if (node->IsMap()) {
      require_known(file_, *node, name, {"from", "to", "number"});
      const auto of = [&](const char* end) { return file_.number(file_.at(*node, end), name + "." + end, low, high); };
      const double from = of("from"), to = of("to");
      values.resize(static_cast<std::size_t>(
          file_.number(file_.at(*node, "number"), name + ".number", 2, static_cast<double>(max_emitters))));
      if (count > 0 && values.size() != count) file_.fail(*node, name, " has not ", count, " numbers");
      for (std::size_t k = 0; k < values.size(); ++k)
        values[k] = from + static_cast<double>(k) * (to - from) / static_cast<double>(values.size() - 1);
    } else {
      std::ranges::fill(values, file_.number(*node, name, low, high));
    }
    if (values.empty()) file_.fail(*node, name, " is an empty list");
    for (double& value : values) value *= unit;
    return values;
  }

 private:
  const CalibrationFile& file_;
  std::string name_;
  std::optional<YAML::Node> map_;
};

inline constexpr double degree = pi / 180;  // [rad]

inline void read_lasers(const CalibrationFile& file, SpinningSensor& sensor) {
  const SensorSection section(file, "lasers", {"elevation_deg", "azimuth_deg", "height_mm", "delay_us"});
  if (!section.find("elevation_deg"))
    file.fail(file.root(), "has no lasers.elevation_deg: expected that of each laser");
  const std::vector<double> elevations = section.numbers("elevation_deg", degree, -90, 90, 0);
  const std::size_t count = elevations.size();
  const std::vector<double> azimuths = section.numbers("azimuth_deg", degree, -360, 360, count),
                            heights = section.numbers("height_mm", 1e-3, -1e3, 1e3, count),
                            delays = section.numbers("delay_us", 1e-6, 0, 1e9, count);
  for (std::size_t k = 0; k < count; ++k) sensor.lasers.push_back({elevations[k], azimuths[k], heights[k], delays[k]});
}

/// Reads the sections of what moves, and of the times at which the lasers fire.
inline void read_motion(const CalibrationFile& file, const SensorFileSettings& settings, SensorSheet& sheet) {
  const SensorSection rotation(file, "rotation",
                               {"rate_hz", "rate_min_hz", "rate_max_hz", "turns", "start_deg", "exit_radius_mm",
                                "azimuth_min_deg", "azimuth_max_deg"});
  const double rate = rotation.number("rate_hz", 1, 1e-3, 1e6, sheet.rotation_rate);
  const bool any = !rotation.find("rate_hz");
  const double low = rotation.number("rate_min_hz", 1, 1e-3, rate, any ? 1e-3 : rate);
  const double high = rotation.number("rate_max_hz", 1, rate, 1e6, any ? 1e6 : rate);
  const double turns = settings.rotation_rate.value_or(rate);
  require_within("SensorFileSettings::rotation_rate", turns, low, high, "Hz");
  sheet.rotation_rate = turns;
  if (const auto way = rotation.find("turns")) {
    const std::string word = file.word(*way, "rotation.turns");
    if (word != "left" && word != "right")
      file.fail(*way, "rotation.turns is ", text::quoted(word), ": expected left or right, as seen from above");
    if (word == "left") sheet.rotation_rate = -turns;
  }
  sheet.start = rotation.number("start_deg", degree, -360, 360, 0);
  sheet.exit_radius = rotation.number("exit_radius_mm", 1e-3, 0, 1e3, 0);
  sheet.azimuth_min = rotation.number("azimuth_min_deg", degree, -180, 0, -pi);
  sheet.azimuth_max = rotation.number("azimuth_max_deg", degree, 0, 180, pi);

  const SensorSection sweeps(file, "sweeps", {"rate_hz", "elevation_min_deg", "elevation_max_deg"});
  sheet.sweep_rate = sweeps.number("rate_hz", 1, 1e-3, 1e6, 0);
  sheet.elevation_min = sweeps.number("elevation_min_deg", degree, -90, 90, 0);
  sheet.elevation_max = sweeps.number("elevation_max_deg", degree, -90, 90, 0);

  const SensorSection firing(file, "firing", {"period_us", "rate_hz", "columns"});
  const std::vector<double> columns = firing.numbers("columns", 1, 1, 1e6, 0);
  const double period = firing.number("period_us", 1e-6, 1e-3, 1e6, 0);
  sheet.sequence_rate = firing.number("rate_hz", 1, 1, 1e9, period > 0 ? 1 / period : 0);
  if ((columns.empty() ? 0 : 1) + (period > 0 ? 1 : 0) + (firing.find("rate_hz") ? 1 : 0) != 1)
    file.fail(file.root(), "has no firing, or several of its keys: expected one of period_us, rate_hz and columns");
  const double column = settings.columns ? static_cast<double>(*settings.columns) : columns.empty() ? 0 : columns[0];
  if (column > 0 && std::ranges::find(columns, column) == columns.end())
    throw SettingError("SensorFileSettings::columns", column, "", "a number of firing.columns in " + file.path());
  if (column > 0) sheet.sequence_rate = column * turns;
}

inline void read_prisms(const CalibrationFile& file, SensorSheet& sheet) {
  const SensorSection section(file, "prisms", {"rate_hz", "wedge_deg", "refractive_index", "start_deg"});
  if (!section.is_there()) return;
  for (const double wedge : section.numbers("wedge_deg", degree, -85, 85, 0))
    sheet.prisms.push_back({.wedge = std::fabs(wedge), .inclined_exit = wedge < 0});
  const std::size_t count = sheet.prisms.size();
  const std::vector<double> rates = section.numbers("rate_hz", 1, -1e6, 1e6, count),
                            indices = section.numbers("refractive_index", 1, 1, 5, count),
                            starts = section.numbers("start_deg", degree, -360, 360, count);
  for (std::size_t k = 0; k < count; ++k) {
    Prism& prism = sheet.prisms[k];
    prism.rotation_rate = rates[k];
    if (section.find("refractive_index")) prism.refractive_index = indices[k];
    prism.start = starts[k];
  }
}

}  // namespace detail

/// Reads a sensor's data sheet, in YAML, as the catalogue has them in `data/sensors`: docs/sensors.md
/// lists them and the keys. Each section names its `source`. A number that is left out is that of
/// `SensorSheet`, but without noise, and with ranges without limits. @throws FileError with the line
/// and key of the first error @throws SettingError for settings that the file does not allow
[[nodiscard]] inline SensorSheet read_sensor(const std::filesystem::path& path,
                                             const SensorFileSettings& settings = {}) {
  const detail::CalibrationFile file(path, "a sensor's data sheet");
  detail::SensorSection::require_known(
      file, file.root(), "the sheet",
      {"name", "packets", "lasers", "firing", "rotation", "sweeps", "prisms", "beam", "ranges", "noise", "left_out"});
  SensorSheet sheet;
  sheet.name = file.word(file.at(file.root(), "name"), "name");
  if (const auto packets = file.find(file.root(), "packets")) sheet.packets = file.word(*packets, "packets");
  detail::read_lasers(file, sheet);
  detail::read_motion(file, settings, sheet);
  detail::read_prisms(file, sheet);

  const detail::SensorSection beam(file, "beam",
                                   {"wavelength_nm", "peak_power_w", "pulse_length_ns", "divergence_mrad"});
  Laser& laser = sheet.beam;
  laser.wavelength = beam.number("wavelength_nm", 1e-9, 100, 1e4, laser.wavelength);
  laser.peak_power = beam.number("peak_power_w", 1, 1e-6, 1e6, laser.peak_power);
  laser.pulse_length = beam.number("pulse_length_ns", 1e-9, 1e-3, 1e3, laser.pulse_length);
  laser.divergence = beam.number("divergence_mrad", 1e-3, 0, 500, laser.divergence.across);

  const detail::SensorSection ranges(file, "ranges", {"min_m", "max_m"});
  sheet.range_min = ranges.number("min_m", 1, 0, 1e6, 0);
  sheet.range_max = ranges.number("max_m", 1, sheet.range_min, 1e6, std::numeric_limits<double>::infinity());
  sheet.range_deviation =
      detail::SensorSection(file, "noise", {"deviation_mm"}).number("deviation_mm", 1e-3, 0, 1e6, 0);
  try {
    static_cast<void>(sheet.source(2 / sheet.sequence_rate));
  } catch (const SettingError& error) {
    file.fail(file.root(), error.what());
  }
  return sheet;
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
