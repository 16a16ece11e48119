// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_SENSOR_CALIBRATION_HPP
#define PULSECAST_IO_SENSOR_CALIBRATION_HPP

#include <pulsecast/io/detail/packets/calibration_file.hpp>
#include <pulsecast/io/detail/packets/rules.hpp>
#include <pulsecast/io/ouster_packets.hpp>
#include <pulsecast/io/output_file.hpp>
#include <pulsecast/io/velodyne_packets.hpp>
#include <pulsecast/sensor/ouster.hpp>

/// Writers and readers of the files that describe a sensor's lasers to decoders.
namespace PULSECAST_NAMESPACE::io {

/// Writes the lasers of a VLP-16 or VLP-32C as a calibration of the ROS driver, in YAML: angles in
/// radians, heights in metres. As in the files of that driver, `rot_correction` is subtracted from
/// the azimuth, and `vert_offset_correction` is the manual's height. Source: ros-drivers/velodyne,
/// velodyne_pointcloud, params/. @throws SettingError for another sensor @throws FileError
inline void write_velodyne_calibration(const std::filesystem::path& path, const SpinningSensor& sensor) {
  sensor.validate();
  detail::VelodyneFormat::validate(sensor);
  OutputFile file(path);
  file.write("lasers:\n");
  for (std::size_t k = 0; k < sensor.lasers.size(); ++k) {
    const SensorLaser& laser = sensor.lasers[k];
    file.write(
        text::message("- {dist_correction: 0.0, dist_correction_x: 0.0, dist_correction_y: 0.0, "
                      "focal_distance: 0.0, focal_slope: 0.0, horiz_offset_correction: 0.0, laser_id: ",
                      k, ", rot_correction: ", 0 - laser.azimuth, ", vert_correction: ", laser.elevation,
                      ", vert_offset_correction: ", laser.height, "}\n"));
  }
  file.write(text::message("num_lasers: ", sensor.lasers.size(),
                           "\ndistance_resolution: ", detail::VelodyneFormat::distance_resolution(sensor), "\n"));
  file.commit();
}

/// Sensor of a data sheet with the angles and heights of a file as of `write_velodyne_calibration`,
/// whose corrections of distances and to the side must be 0, as packets have none. @throws
/// SettingError for the sheet of another sensor @throws FileError with the line of the first error
[[nodiscard]] inline SpinningSensor read_velodyne_calibration(const std::filesystem::path& path, SpinningSensor sheet) {
  detail::VelodyneFormat::validate(sheet);
  const detail::CalibrationFile file(path, "a Velodyne calibration");
  const std::size_t count = sheet.lasers.size();
  const auto all = static_cast<double>(count);
  file.number(file.at("num_lasers"), "num_lasers", all, all);
  if (const auto resolution = file.find("distance_resolution")) {
    const double own = detail::VelodyneFormat::distance_resolution(sheet);
    file.number(*resolution, "distance_resolution", own, own);
  }
  const YAML::Node lasers = file.at("lasers");
  if (!lasers.IsSequence() || lasers.size() != count) file.fail(lasers, "lasers is no list of ", count);
  std::vector<bool> is_known(count);
  for (const YAML::Node& laser : lasers) {
    const auto number = [&](const char* name, double most) {
      return file.number(file.at(laser, name), name, -most, most);
    };
    const double id = file.number(file.at(laser, "laser_id"), "laser_id", 0, all - 1);
    const auto k = static_cast<std::size_t>(id);
    if (static_cast<double>(k) != id || is_known[k]) file.fail(laser, "expected each laser_id once");
    is_known[k] = true;
    sheet.lasers[k].azimuth = 0 - number("rot_correction", pi);
    sheet.lasers[k].elevation = number("vert_correction", pi / 2);
    sheet.lasers[k].height = number("vert_offset_correction", 1);
    for (const auto& pair : laser) {
      const std::string name = file.word(pair.first, "a key");
      const FormatRule* const rule = rule_of(detail::velodyne_rules, name);
      if (!rule)
        file.fail(pair.first, "has the key ", text::quoted(name), ", which is unknown: expected a laser without it");
      if (rule->use == FormatUse::refused) file.require(pair.second, name, {0}, *rule);
    }
  }
  return sheet;
}

/// Writes the metadata of an OS1-64 with packets of these settings, in JSON: the form without
/// sections, which Ouster's software reads of all firmware. Azimuths are positive to the right, as
/// in the manual's formula. @throws SettingError for another sensor @throws FileError
inline void write_ouster_metadata(const std::filesystem::path& path, const SpinningSensor& sensor,
                                  const PacketSettings& settings = {}) {
  sensor.validate();
  detail::OusterFormat::validate(sensor);
  const std::size_t columns = detail::OusterFormat::frame_columns(sensor);
  std::vector<double> altitudes, azimuths, shifts;
  for (const SensorLaser& laser : sensor.lasers) {
    altitudes.push_back(laser.elevation * 180 / pi);
    azimuths.push_back(laser.azimuth * 180 / pi);
    shifts.push_back(std::nearbyint(laser.azimuth / (2 * pi) * static_cast<double>(columns)));
  }
  const double least = *std::min_element(shifts.begin(), shifts.end());
  for (double& shift : shifts) shift -= least;
  const auto list_of = [](const std::vector<double>& values) {  // rounded to 9 decimals
    std::string list;
    for (const double value : values)
      list += (list.empty() ? "[" : ", ") + text::to_text(std::nearbyint(value * 1e9) / 1e9);
    return list + "]";
  };
  using Format = detail::OusterFormat;
  const double lens_radius = std::nearbyint(1e12 * sensor.exit_radius) / 1e9, height = sensor.lasers.front().height;
  const bool is_dual = settings.returns == PacketReturns::dual;
  OutputFile file(path);
  file.write(text::message(
      "{\n  \"prod_line\": \"OS-1-64\",\n  \"lidar_mode\": \"", columns, "x", sensor.rotation_rate,
      "\",\n  \"udp_port_lidar\": ", Format::port, ",\n  \"beam_altitude_angles\": ", list_of(altitudes),
      ",\n  \"beam_azimuth_angles\": ", list_of(azimuths), ",\n  \"lidar_origin_to_beam_origin_mm\": ", lens_radius,
      ",\n  \"lidar_to_sensor_transform\": ", list_of({-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 1e3 * height, 0, 0, 0, 1}),
      ",\n  \"data_format\": {\n    \"columns_per_frame\": ", columns,
      ",\n    \"columns_per_packet\": ", Format::packet_columns, ",\n    \"pixels_per_column\": ", Format::lasers,
      ",\n    \"column_window\": [0, ", columns - 1, "],\n    \"pixel_shift_by_row\": ", list_of(shifts),
      ",\n    \"udp_profile_lidar\": \"", is_dual ? "RNG19_RFL8_SIG16_NIR16_DUAL" : "LEGACY", "\"\n  }\n}\n"));
  file.commit();
}

/// Sensor of a data sheet, of any Ouster with spinning lasers by its `name`, with the angles, lenses,
/// columns and rate of a unit's metadata, without or with sections. @throws FileError with the line
[[nodiscard]] inline SpinningSensor read_ouster_metadata(const std::filesystem::path& path,
                                                         SpinningSensor sensor = ouster_os1_64()) {
  const detail::CalibrationFile file(path, "the metadata of an Ouster sensor");
  const YAML::Node line = file.at("prod_line");
  const std::string model = file.word(line, "prod_line");
  if (!model.starts_with(sensor.name))
    file.fail(line, "prod_line is ", text::quoted(model), ": expected ", sensor.name);

  const YAML::Node mode = file.at("lidar_mode");
  const std::string word = file.word(mode, "lidar_mode");
  std::string_view rest = word;
  const auto columns = text::number_in<unsigned>(text::take_word(rest, "x"));
  const auto rate = text::number_in<unsigned>(rest);
  if ((columns != 512 && columns != 1024 && columns != 2048) || !rate || *rate < 1 || *rate > 100)
    file.fail(mode, "lidar_mode is ", text::quoted(word), ": expected columns and rate, as 1024x10");
  sensor.rotation_rate = *rate;
  sensor.sequence_rate = *columns * sensor.rotation_rate;

  const std::size_t count = sensor.lasers.size();
  const auto angles = [&](const char* name, double most) {
    return file.numbers(file.at(name), name, count, -most, most);
  };
  const std::vector<double> altitudes = angles("beam_altitude_angles", 90);
  const std::vector<double> azimuths = angles("beam_azimuth_angles", 180);
  for (std::size_t k = 0; k < count; ++k) {
    sensor.lasers[k].elevation = altitudes[k] * pi / 180;
    sensor.lasers[k].azimuth = azimuths[k] * pi / 180;
  }
  constexpr const char* lenses = "lidar_origin_to_beam_origin_mm";
  if (const auto radius = file.find(lenses)) sensor.exit_radius = 1e-3 * file.number(*radius, lenses, 0, 1000);
  constexpr const char* place = "lidar_to_sensor_transform";
  if (const auto transform = file.find(place))
    for (const double height = 1e-3 * file.numbers(*transform, place, 16, -1000, 1000)[11];
         SensorLaser & laser : sensor.lasers)
      laser.height = height;
  const double height = 1e3 * sensor.lasers.front().height;
  const double frame = *columns;
  for (const auto& [name, needed] : std::initializer_list<std::pair<const char*, std::vector<double>>>{
           {place, {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, height, 0, 0, 0, 1}},
           {"beam_to_lidar_transform", {1, 0, 0, 1e3 * sensor.exit_radius, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
           {"extrinsic", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
           {"columns_per_frame", {frame}},
           {"pixels_per_column", {static_cast<double>(count)}},
           {"column_window", {0, frame - 1}},
           {"azimuth_window", {0, 360000}},
           {"signal_multiplier", {1}}})
    if (const auto given = file.find(name)) file.require(*given, name, needed, *rule_of(detail::ouster_rules, name));
  return sensor;
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
