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
  std::optional<double> rotation_rate{};  ///< turns per second, in the limits of the file, or with its sign [Hz]
  std::optional<std::size_t> columns{};   ///< firing sequences a turn, one number of the file's
};

namespace detail {

/// Refuses keys of a map or list in a sensor's file that are unknown, and those that a map has twice.
inline void require_known(const CalibrationFile& file, const YAML::Node& map, const std::string& name,
                          const std::vector<std::string>& known, bool is_map = true) {
  if (is_map ? !map.IsMap() : !map.IsSequence()) file.fail(map, name, is_map ? " is no map" : " is no list");
  for (const auto& item : map) {
    const YAML::Node node = is_map ? item.first : YAML::Node(item);
    const std::string key = file.word(node, "a key");
    if (std::ranges::find(known, key) == known.end())
      file.fail(node, name, " has the key ", text::quoted(key), ", which is unknown", text::suggestion(key, known));
    if (is_map && !map[key].is(item.second)) file.fail(node, name, " has the key ", text::quoted(key), " twice");
  }
}

/// Section of a sensor's file: a map of known keys, of which it needs the first few, and the `source` of its numbers.
class SensorSection {
 public:
  SensorSection(const CalibrationFile& file, std::vector<std::string>& keys, const std::string& name,
                std::vector<std::string> known, std::size_t needed = 0)
      : file_(file), name_(name), map_(file.find(file.root(), name)) {
    keys.push_back(name);
    for (const std::string& key : known) keys.push_back(text::joined({name, ".", key}));
    if (!map_) return;
    known.push_back("source");
    require_known(file, *map_, name, known);
    for (std::size_t k = 0; k < needed; ++k) static_cast<void>(file.at(*map_, known[k]));
    if (file.word(file.at(*map_, "source"), "source").empty()) file.fail(*map_, name, ".source is empty");
  }

  /// Number of a key, from `low` to `high` in the unit of the key, or else `otherwise`; in SI units.
  [[nodiscard]] double number(const std::string& key, double unit, double low, double high, double otherwise) const {
    const std::optional<YAML::Node> node = map_ ? file_.find(*map_, key) : std::nullopt;
    return node ? unit * file_.number(*node, name_ + "." + key, low, high) : otherwise;
  }

  /// Numbers of a key in SI units: a list; one, `count` times; or `number` of them, evenly `from` one
  /// `to` another. Without the key, zeros. With a `count` of 0, any number of them.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, double unit, double low, double high,
                                            std::size_t count) const {
    const std::optional<YAML::Node> node = map_ ? file_.find(*map_, key) : std::nullopt;
    if (!node) return std::vector<double>(count);
    const std::string name = name_ + "." + key;
    std::vector<double> values;
    if (node->IsSequence()) {
      if (node->size() == 0) file_.fail(*node, name, " is an empty list");
      values = file_.numbers(*node, name, count > 0 ? count : node->size(), low, high);
    } else if (node->IsMap()) {
      require_known(file_, *node, name, {"from", "to", "number"});
      const double from = file_.number(file_.at(*node, "from"), name + ".from", low, high);
      const double to = file_.number(file_.at(*node, "to"), name + ".to", low, high);
      const double most = count > 0 ? static_cast<double>(count) : double{max_emitters};
      const double number = file_.number(file_.at(*node, "number"), name + ".number", count > 0 ? most : 2, most);
      if (number != std::floor(number)) file_.fail(*node, name, ".number is no whole number");
      for (double k = 0; k < number; ++k) values.push_back(from + k * (to - from) / (number - 1));
    } else {
      values.assign(std::max<std::size_t>(count, 1), file_.number(*node, name, low, high));
    }
    for (double& value : values) value *= unit;
    return values;
  }

 private:
  const CalibrationFile& file_;
  std::string name_;
  std::optional<YAML::Node> map_;
};

using namespace literals;

/// Reads the lasers, and the prisms before them.
inline void read_lasers(const CalibrationFile& file, std::vector<std::string>& keys, SensorSheet& sheet) {
  const SensorSection lasers(file, keys, "lasers", {"elevation_deg", "azimuth_deg", "height_mm", "delay_us"});
  const std::vector<double> elevations = lasers.numbers("elevation_deg", 1_deg, -90, 90, 0);
  const std::size_t count = elevations.size();
  const std::vector<double> azimuths = lasers.numbers("azimuth_deg", 1_deg, -360, 360, count),
                            heights = lasers.numbers("height_mm", 1e-3, -1e3, 1e3, count),
                            delays = lasers.numbers("delay_us", 1e-6, 0, 1e9, count);
  for (std::size_t k = 0; k < count; ++k) sheet.lasers.push_back({elevations[k], azimuths[k], heights[k], delays[k]});

  const SensorSection prisms(file, keys, "prisms", {"wedge_deg", "rate_hz", "refractive_index", "start_deg"}, 2);
  const std::vector<double> wedges = prisms.numbers("wedge_deg", 1_deg, -85, 85, 0),
                            rates = prisms.numbers("rate_hz", 1, -1e6, 1e6, wedges.size()),
                            starts = prisms.numbers("start_deg", 1_deg, -360, 360, wedges.size());
  const double index = prisms.number("refractive_index", 1, 1, 5, Prism{}.refractive_index);
  for (std::size_t k = 0; k < wedges.size(); ++k)
    sheet.prisms.push_back({std::fabs(wedges[k]), rates[k], index, starts[k], wedges[k] < 0});
}

/// Reads what turns or sweeps, and the times at which the lasers fire.
inline void read_motion(const CalibrationFile& file, std::vector<std::string>& keys, const SensorFileSettings& settings,
                        SensorSheet& sheet) {
  const SensorSection rotation(file, keys, "rotation",
                               {"rate_hz", "start_deg", "exit_radius_mm", "azimuth_min_deg", "azimuth_max_deg"});
  const std::vector<double> rates = rotation.numbers("rate_hz", 1, -1e6, 1e6, 0);  // the usual one, and limits
  const double rate = rates.empty() ? sheet.rotation_rate : rates[0];
  static_cast<void>(rotation.numbers("rate_hz", 1, rate < 0 ? -1e6 : 0, rate < 0 ? 0 : 1e6, 0));  // of one sign
  if (const auto head = file.find(file.root(), "rotation"); head && !sheet.prisms.empty())
    file.fail(*head, "rotation has no effect on prisms");
  if (settings.rotation_rate && !sheet.prisms.empty())
    throw SettingError("SensorFileSettings::rotation_rate", " has no effect on prisms: expected none");
  const double turns = settings.rotation_rate.value_or(rate) * (rate < 0 && settings.rotation_rate <= 0 ? -1 : 1);
  const auto [low, high] =
      std::ranges::minmax(rates.empty() ? std::vector{0.0, 1e6} : rates, {}, [](double r) { return std::fabs(r); });
  require_within("SensorFileSettings::rotation_rate", turns, std::fabs(low), std::fabs(high), "Hz");
  sheet.rotation_rate = std::copysign(turns, rate);
  sheet.start = rotation.number("start_deg", 1_deg, -360, 360, 0);
  sheet.exit_radius = rotation.number("exit_radius_mm", 1e-3, 0, 1e3, 0);
  sheet.azimuth_min = rotation.number("azimuth_min_deg", 1_deg, -180, 0, -pi);
  sheet.azimuth_max = rotation.number("azimuth_max_deg", 1_deg, 0, 180, pi);
  const SensorSection sweeps(file, keys, "sweeps", {"rate_hz", "elevation_min_deg", "elevation_max_deg"}, 3);
  sheet.sweep_rate = sweeps.number("rate_hz", 1, 1e-3, 1e6, 0);
  sheet.elevation_min = sweeps.number("elevation_min_deg", 1_deg, -90, 90, 0);
  sheet.elevation_max = sweeps.number("elevation_max_deg", 1_deg, -90, 90, 0);

  const SensorSection firing(file, keys, "firing", {"period_us", "rate_hz", "columns", "rate_max_hz"});
  const std::vector<double> columns = firing.numbers("columns", 1, 1, 1e6, 0);
  if (std::ranges::any_of(columns, [](double c) { return c != std::floor(c); }))
    file.fail(file.at(file.at("firing"), "columns"), "firing.columns are no whole numbers");
  const double period = firing.number("period_us", 1e-6, 1e-3, 1e6, 0);
  const double fixed = firing.number("rate_hz", 1, 1, 1e9, 0);
  if ((columns.empty() || !sheet.prisms.empty() ? 0 : 1) + (period > 0 ? 1 : 0) + (fixed > 0 ? 1 : 0) != 1)
    file.fail(file.root(), "has no firing, or several: expected one of period_us, rate_hz and, on a head, columns");
  const double column = settings.columns ? static_cast<double>(*settings.columns) : columns.empty() ? 0 : columns[0];
  if (settings.columns && std::ranges::find(columns, column) == columns.end())
    throw SettingError("SensorFileSettings::columns", column, "", "a number of the file's firing.columns");
  const double most = firing.number("rate_max_hz", 1, columns.empty() ? 0 : columns[0] * std::fabs(rate), 1e12, 1e12);
  require_within("SensorFileSettings::columns times rotation_rate", column * turns, 0, most, "Hz");
  sheet.sequence_rate = column > 0 ? column * turns : period > 0 ? 1 / period : fixed;
}

}  // namespace detail

/// Reads a data sheet in YAML, such as those of the catalogue, in `data/sensors`: docs/sensors.md has
/// their keys. A number that is left out is that of `SensorSheet`; a range without one has no limit.
/// @throws FileError with line and key @throws SettingError for settings that the file does not allow
[[nodiscard]] inline SensorSheet read_sensor(const std::filesystem::path& path,
                                             const SensorFileSettings& settings = {}) {
  using detail::SensorSection;
  const detail::CalibrationFile file(path, "a sensor's data sheet");
  detail::require_known(
      file, file.root(), "the sheet",
      {"name", "packets", "lasers", "firing", "rotation", "sweeps", "prisms", "beam", "ranges", "noise", "left_out"});
  SensorSheet sheet;
  std::vector<std::string> keys;  // known ones, as `beam` and `beam.wavelength_nm`
  sheet.name = file.word(file.at(file.root(), "name"), "name");
  if (const auto packets = file.find(file.root(), "packets")) sheet.packets = file.word(*packets, "packets");
  if (!sheet.packets.empty() && sheet.packets != "velodyne" && sheet.packets != "ouster")
    file.fail(file.at("packets"), "packets is ", text::quoted(sheet.packets), ": expected velodyne or ouster");
  detail::read_lasers(file, keys, sheet);
  detail::read_motion(file, keys, settings, sheet);
  const SensorSection beam(file, keys, "beam", {"wavelength_nm", "peak_power_w", "pulse_length_ns", "divergence_mrad"});
  sheet.beam.wavelength = beam.number("wavelength_nm", 1e-9, 100, 1e4, sheet.beam.wavelength);
  sheet.beam.peak_power = beam.number("peak_power_w", 1, 1e-6, 1e6, sheet.beam.peak_power);
  sheet.beam.pulse_length = beam.number("pulse_length_ns", 1e-9, 1e-3, 1e3, sheet.beam.pulse_length);
  sheet.beam.divergence = beam.number("divergence_mrad", 1e-3, 0, 500, sheet.beam.divergence.across);
  const SensorSection ranges(file, keys, "ranges", {"min_m", "max_m"});
  sheet.range_min = ranges.number("min_m", 1, 0, 1e6, 0);
  sheet.range_max = ranges.number("max_m", 1, sheet.range_min, 1e6, std::numeric_limits<double>::infinity());
  sheet.range_deviation = SensorSection(file, keys, "noise", {"deviation_mm"}).number("deviation_mm", 1e-3, 0, 1e6, 0);
  if (const auto left_out = file.find(file.root(), "left_out"))
    detail::require_known(file, *left_out, "left_out", keys, false);
  try {
    static_cast<void>(sheet.source(2 / sheet.sequence_rate));
  } catch (const SettingError& error) {
    file.fail(file.root(), error.what());
  }
  return sheet;
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
