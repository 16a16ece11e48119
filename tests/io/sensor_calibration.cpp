// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/sensor_calibration.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <yaml-cpp/yaml.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/sensor/ouster.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include "support/file_errors.hpp"
#include "support/format_cases.hpp"
#include "support/generators.hpp"
#include "support/spoilt_text.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::contains;
using support::Generator;

/// File of a text, which lives as long as its folder.
std::filesystem::path file_of(const support::TemporaryFolder& folder, const std::string& text) {
  std::filesystem::remove(folder / "unit");
  std::ofstream(folder / "unit", std::ios::binary) << text;
  return folder / "unit";
}

std::string velodyne_text(const SpinningSensor& sensor) {
  const support::TemporaryFolder folder;
  write_velodyne_calibration(folder / "unit.yaml", sensor);
  return support::content(folder / "unit.yaml");
}

std::string ouster_text(const SpinningSensor& sensor, const PacketSettings& settings = {}) {
  const support::TemporaryFolder folder;
  write_ouster_metadata(folder / "unit.json", sensor, settings);
  return support::content(folder / "unit.json");
}

SpinningSensor velodyne_of(const std::string& text, const SpinningSensor& sheet) {
  const support::TemporaryFolder folder;
  return read_velodyne_calibration(file_of(folder, text), sheet);
}

SpinningSensor ouster_of(const std::string& text) {
  const support::TemporaryFolder folder;
  return read_ouster_metadata(file_of(folder, text));
}

/// Requires that a message has a part.
void check(const std::string& message, const std::string& part) {
  INFO(message);
  CHECK(message.find(part) != std::string::npos);
}

/// Text with the first `from` replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// Requires equal lasers, to `angle` [rad] and `distance` [m].
void check_same(const SpinningSensor& a, const SpinningSensor& b, double angle, double distance) {
  REQUIRE(a.lasers.size() == b.lasers.size());
  for (std::size_t k = 0; k < a.lasers.size(); ++k) {
    CHECK(std::fabs(a.lasers[k].elevation - b.lasers[k].elevation) <= angle);
    CHECK(std::fabs(a.lasers[k].azimuth - b.lasers[k].azimuth) <= angle);
    CHECK(std::fabs(a.lasers[k].height - b.lasers[k].height) <= distance);
    CHECK(a.lasers[k].delay == b.lasers[k].delay);
  }
  CHECK(std::fabs(a.exit_radius - b.exit_radius) <= distance);
}

/// Sensor whose lasers are a little off its data sheet.
SpinningSensor unit_of(SpinningSensor sensor, Generator& any, double height) {
  for (SensorLaser& laser : sensor.lasers) {
    laser.elevation += any.uniform(-0.01, 0.01);
    laser.azimuth += any.uniform(-0.06, 0.06);
    laser.height = height != 0 ? height : any.uniform(-0.02, 0.02);
  }
  return sensor;
}

TEST_CASE("a Velodyne calibration that is written reads back the same") {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const SpinningSensor sheet = seed % 2 == 0 ? velodyne_vlp_16(20) : velodyne_vlp_32c(20);
    const SpinningSensor unit = unit_of(sheet, any, 0);
    const SpinningSensor read = velodyne_of(velodyne_text(unit), sheet);
    check_same(read, unit, 0, 0);
    CHECK(read.rotation_rate == 20);
  }
}

TEST_CASE("a calibration of the data sheet's VLP-32C has the numbers of the ROS driver's file, with its signs") {
  const YAML::Node root = YAML::Load(velodyne_text(velodyne_vlp_32c()));
  CHECK(root["num_lasers"].as<int>() == 32);
  CHECK(root["distance_resolution"].as<double>() == 0.004);
  const auto number = [&](int k, const char* key) { return root["lasers"][k][key].as<double>(); };
  for (int k = 0; k < 32; ++k) CHECK(number(k, "laser_id") == k);
  // source: ros-drivers/velodyne, velodyne_pointcloud/params/VeloView-VLP-32C.yaml
  CHECK(std::fabs(number(0, "rot_correction") - -0.024434609527920613) < 1e-12);
  CHECK(std::fabs(number(0, "vert_correction") - -0.4363323129985824) < 1e-12);
  CHECK(std::fabs(number(1, "rot_correction") - 0.07330382858376185) < 1e-12);
  CHECK(std::fabs(number(3, "vert_correction") - -0.2729520417193932) < 1e-6);
  for (const char* key : {"dist_correction", "dist_correction_x", "dist_correction_y", "vert_offset_correction",
                          "horiz_offset_correction", "focal_distance", "focal_slope"})
    CHECK(number(5, key) == 0);
}

/// Calibration in the manner of a driver's file: of blocks and flow, with comments, lasers in any order, and keys that
/// are not needed.
std::string driver_file() {
  std::string text = "# Velodyne VLP-16\r\nnum_lasers: 16   # as on the label\r\nmodel: [a, {b: c}]\r\nlasers:\r\n";
  for (int k = 15; k >= 1; --k)
    text +=
        "- {dist_correction: 0.0, dist_correction_x: 0.0, dist_correction_y: 0.0, focal_distance: 0.0,\r\n  "
        "focal_slope: 0.0, "
        "horiz_offset_correction: 0.0, laser_id: " +
        std::to_string(k) + ", rot_correction: 0." + std::to_string(k + 10) +
        ", vert_correction: -2.5e-1, vert_offset_correction: +1e-2}\r\n";
  return text +
         "-\r\n  laser_id: 0\r\n  rot_correction: -.01\r\n  vert_correction: -0.2617993877991494\r\n  "
         "vert_offset_correction: 0.0112\r\n";
}

TEST_CASE("a calibration in the manner of a driver's file replaces the angles of the data sheet") {
  const SpinningSensor sensor = velodyne_of(driver_file(), velodyne_vlp_16());
  CHECK(sensor.lasers[0].azimuth == 0.01);
  CHECK(sensor.lasers[0].elevation == -0.2617993877991494);
  CHECK(sensor.lasers[0].height == 0.0112);
  CHECK(sensor.lasers[15].azimuth == -0.25);
  CHECK(sensor.lasers[3].azimuth == -0.13);
  CHECK(sensor.lasers[3].elevation == -0.25);
  CHECK(sensor.lasers[3].height == 0.01);
  CHECK(sensor.lasers[3].delay == velodyne_vlp_16().lasers[3].delay);
}

TEST_CASE("keys of calibrations are read and refused by the rules") {
  const SpinningSensor vlp = velodyne_vlp_16(), os1 = ouster_os1_64(1024, 10);
  const std::string velodyne = velodyne_text(vlp), ouster = ouster_text(os1);
  const auto read = [&](const std::string& text) {
    if (text.starts_with("lasers"))
      check_same(velodyne_of(text, vlp), vlp, 1e-11, 1e-12);
    else
      check_same(ouster_of(text), os1, 1e-11, 1e-12);
    return std::vector<std::string>{};
  };
  std::vector<test::FormatCase> lasers, metadata;
  for (const std::string_view key :
       {"laser_id", "rot_correction", "vert_correction", "vert_offset_correction", "num_lasers", "distance_resolution"})
    lasers.push_back({key, [&] { return read(velodyne); }});
  const auto more = [&](std::string_view row, const std::string& key) {
    lasers.push_back({row, [&, key] { return read(with(velodyne, "- {", "- {" + key + ", ")); }});
  };
  more("two_pt_correction_available", "two_pt_correction_available: false");
  more("min_intensity", "min_intensity: 0");
  more("max_intensity", "max_intensity: 255");
  lasers.push_back(
      {"dist_correction*", [&] { return read(with(velodyne, "dist_correction_x: 0.0", "dist_correction_x: 0.01")); }});
  lasers.push_back({"horiz_offset_correction", [&] {
                      return read(with(velodyne, "horiz_offset_correction: 0.0", "horiz_offset_correction: 0.026"));
                    }});
  lasers.push_back({"focal_*", [&] { return read(with(velodyne, "focal_slope: 0.0", "focal_slope: 1.1")); }});
  test::check_rules(io::detail::velodyne_rules, lasers);

  for (const std::string_view key :
       {"prod_line", "lidar_mode", "beam_altitude_angles", "beam_azimuth_angles", "lidar_origin_to_beam_origin_mm"})
    metadata.push_back({key, [&] { return read(ouster); }});
  const auto other = [&](std::string_view row, const std::string& from, const std::string& to) {
    metadata.push_back({row, [&, from, to] { return read(with(ouster, from, to)); }});
  };
  const std::string sections = "\"data_format\": {";
  other("lidar_to_sensor_transform", "[-1, 0, 0, 0, ", "[-1, 0, 0, 2, ");
  other("beam_to_lidar_transform", sections,
        "\"beam_to_lidar_transform\": [1, 0, 0, 15.806, 0, 1, 0, 0, 0, 0, 1, 3, 0, 0, 0, 1], " + sections);
  other("extrinsic", sections, "\"extrinsic\": [1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], " + sections);
  other("columns_per_frame", "\"columns_per_frame\": 1024", "\"columns_per_frame\": 512");
  other("pixels_per_column", "\"pixels_per_column\": 64", "\"pixels_per_column\": 128");
  other("column_window", "[0, 1023]", "[256, 767]");
  other("azimuth_window", sections,
        "\"config_params\": {\"lidar_mode\": \"1024x10\", \"azimuth_window\": [0, 180000]}, " + sections);
  other("signal_multiplier", sections, "\"signal_multiplier\": 2, " + sections);
  other("*", sections,
        "\"signal_multiplier\": 1, \"azimuth_window\": [0, 360000], \"status\": \"RUNNING\", "
        "\"beam_to_lidar_transform\": [1, 0, 0, 15.806, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], " +
            sections);
  test::check_rules(io::detail::ouster_rules, metadata);
}

TEST_CASE("damaged Velodyne calibrations are refused with path and line") {
  const support::TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    const FileError refusal = support::file_error(
        [&] { static_cast<void>(read_velodyne_calibration(file_of(folder, text), velodyne_vlp_16())); });
    CHECK(refusal.path() == (folder / "unit").string());
    return refusal.place() + ": " + refusal.problem();
  };
  const std::string sound = driver_file();
  check(error(with(sound, "num_lasers: 16", "num_lasers: 32")), "line 2: num_lasers is '32': expected 16");
  check(error(with(sound, "num_lasers: 16 ", "number: 16 ")), "has no num_lasers");
  check(error(with(sound, "rot_correction: -.01", "rot_correction: west")),
        "line 37: rot_correction is 'west': expected a number");
  check(error(with(sound, "rot_correction: -.01", "rot_correction: .nan")), "line 37");
  check(error(with(sound, "rot_correction: -.01", "rot_correction: 30")), "line 37");
  check(error(with(sound, "rot_correction: -.01", "rot_correction: [1]")), "rot_correction is a list or map");
  check(error(with(sound, "  rot_correction: -.01\r\n", "")), "line 36: has no rot_correction");
  check(error(with(sound, "laser_id: 0", "laser_id: 7")), "line 36: expected each laser_id once");
  check(error(with(sound, "laser_id: 0", "laser_id: 0.5")), "line 36: expected each laser_id once");
  check(error(with(sound, "laser_id: 0", "laser_id: 16")), "line 36: laser_id is '16': expected a number from 0 to 15");
  check(error(with(sound, "dist_correction: 0.0", "dist_correction: 1.3")),
        "line 5: dist_correction is '1.3': expected 0");
  check(error(with(sound, "dist_correction_x", "azimuth_correction")),
        "line 5: has the key 'azimuth_correction', which is unknown: expected a laser without it");
  check(error(with(sound, "lasers:\r\n-", "lasers: 5\r\nothers:\r\n-")), "line 4: lasers is no list of 16");
  check(error(with(sound, "lasers:\r\n-", "lasers:\r\n- 5\r\n-")), "lasers is no list of 16");
  check(error(sound + "distance_resolution: 0.004\n"), "line 40: distance_resolution is '0.004': expected 0.002");
  check(error(with(sound, "[a, {b: c}]", "[a, {b: c")), "is no YAML or JSON");
  check(error("- 1\n- 2\n"), "is no map");
  check(error(""), "is empty: expected a Velodyne calibration");
  check(error("\x01"), "is no map");
  check(error(std::string(2'000'000, ' ')), "is longer than 1 MiB");
  CHECK_THROWS_AS(static_cast<void>(velodyne_of(sound, ouster_os1_64())), SettingError);
}

TEST_CASE("metadata of an OS1 that is written reads back the same") {
  for (std::uint64_t seed = 0; seed < 18; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const unsigned columns = std::array{512u, 1024u, 2048u}[seed % 3];
    SpinningSensor unit = unit_of(ouster_os1_64(columns, seed % 2 == 0 || columns == 2048 ? 10 : 20), any, 0.03618);
    unit.exit_radius = any.uniform(0.01, 0.02);
    const SpinningSensor read = ouster_of(ouster_text(unit));
    check_same(read, unit, 1e-11, 1e-12);
    CHECK(read.sequence_rate == unit.sequence_rate);
    CHECK(read.rotation_rate == unit.rotation_rate);
  }
}

TEST_CASE("metadata of an OS1 are JSON with the members that its decoders need") {
  SpinningSensor sensor = ouster_os1_64(2048);
  sensor.lasers[0].azimuth = 3.073 * pi / 180;  // angles and shifts of two lasers of a unit, from its metadata
  sensor.lasers[1].azimuth = -3.384 * pi / 180;
  for (const bool is_dual : {false, true}) {
    const std::string text = ouster_text(sensor, {.returns = is_dual ? PacketReturns::dual : PacketReturns::last});
    CHECK(contains(text, "{\n  \"prod_line\": \"OS-1-64\",\n  \"lidar_mode\": \"2048x10\",\n"));
    CHECK(contains(text, "\"beam_altitude_angles\": [21.2, 20.526984127, "));
    CHECK(contains(text,
                   "\"beam_azimuth_angles\": [3.073, -3.384, 0, "));  // to the right, as the manual's formula has it
    CHECK(contains(text, "\"lidar_origin_to_beam_origin_mm\": 15.806,\n"));
    CHECK(contains(text, "\"lidar_to_sensor_transform\": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1],\n"));
    CHECK(contains(text,
                   "\"columns_per_frame\": 2048,\n    \"columns_per_packet\": 16,\n    \"pixels_per_column\": 64,\n"));
    CHECK(contains(text, "\"column_window\": [0, 2047],\n    \"pixel_shift_by_row\": [36, 0, 19, "));
    CHECK(contains(text, is_dual ? "\"udp_profile_lidar\": \"RNG19_RFL8_SIG16_NIR16_DUAL\"\n"
                                 : "\"udp_profile_lidar\": \"LEGACY\"\n"));
  }
}

TEST_CASE("metadata with sections are read, and what they lack is of the data sheet") {
  std::string altitudes, azimuths;
  for (int k = 0; k < 64; ++k) {
    altitudes += (k == 0 ? "" : ",\n ") + std::to_string(16 - k / 2) + ".25";
    azimuths += (k == 0 ? "" : ", ") + std::string(k % 2 == 0 ? "3.5" : "-1.5");
  }
  const SpinningSensor sensor = ouster_of(
      "{\"sensor_info\": {\"prod_line\": \"OS-1-64-U02\", \"status\": \"RUNNING\"},\n\"config_params\": "
      "{\"lidar_mode\": \"512x20\"},\n"
      "\"beam_intrinsics\":\n{\n\"beam_altitude_angles\": [" +
      altitudes + "], \"beam_azimuth_angles\": [" + azimuths +
      "]}, \"lidar_data_format\": {\"columns_per_frame\": 512}}");
  CHECK(sensor.sequence_rate == 512 * 20);
  CHECK(sensor.lasers[0].elevation == doctest::Approx(16.25 * pi / 180));
  CHECK(sensor.lasers[63].elevation == doctest::Approx(-15.25 * pi / 180));
  CHECK(sensor.lasers[2].azimuth == doctest::Approx(3.5 * pi / 180));
  CHECK(sensor.lasers[3].azimuth == doctest::Approx(-1.5 * pi / 180));
  CHECK(sensor.exit_radius == ouster_os1_64().exit_radius);
  CHECK(sensor.lasers[0].height == ouster_os1_64().lasers[0].height);
}

TEST_CASE("damaged metadata are refused with path and line") {
  const support::TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    const FileError refusal =
        support::file_error([&] { static_cast<void>(read_ouster_metadata(file_of(folder, text))); });
    CHECK(refusal.path() == (folder / "unit").string());
    return refusal.place() + ": " + refusal.problem();
  };
  const std::string sound = ouster_text(ouster_os1_64());
  check(error(with(sound, "OS-1-64", "OS-0-32")), "line 2: prod_line is 'OS-0-32': expected OS-1-64");
  check(error(with(sound, "prod_line", "line")), "has no prod_line");
  for (const char* mode : {"1000x10", "1024", "x10", "1024x", "1024x0", "1024x10x", "1024x-10", "99999999999x10"})
    check(error(with(sound, "1024x10", mode)), "line 3: lidar_mode is");
  check(error(with(sound, "[21.2, ", "[")), "line 5: beam_altitude_angles is no list of 64");
  check(error(with(sound, "[21.2, ", "[[21.2], ")), "line 5: beam_altitude_angles is a list or map");
  check(error(with(sound, "[21.2, ", "[91, ")),
        "line 5: beam_altitude_angles is '91': expected a number from -90 to 90");
  check(error(with(sound, "beam_azimuth_angles", "angles")), "has no beam_azimuth_angles");
  check(error(with(sound, "15.806", "-1")), "line 7: lidar_origin_to_beam_origin_mm is '-1'");
  check(error(with(sound, "[-1, 0, 0, 0", "[-1, 0, 0")), "line 8: lidar_to_sensor_transform is no list of 16");
  check(error("{\"sensor_info\": 5}"), "line 1: has no prod_line");
  check(error(sound.substr(0, sound.size() - 3)), "is no YAML or JSON");
}

TEST_CASE("a calibration that was spoilt is read or refused") {
  constexpr std::array words{"[",      "{", "}",      "- ", "&a ", "*a",  ": ",    "\"", "'",
                             "!!int ", "|", "<<: *a", "%",  "---", "...", "1e999", "~"};
  const std::array sound{driver_file(), velodyne_text(velodyne_vlp_16()), ouster_text(ouster_os1_64())};
  std::size_t read = 0, refused = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    const std::string text = support::spoilt(sound[seed % 3], 1 + random.whole(4), words, random);
    try {
      const SpinningSensor sensor = seed % 3 == 2 ? ouster_of(text) : velodyne_of(text, velodyne_vlp_16());
      sensor.validate();
      ++read;
    } catch (const FileError&) {
      ++refused;
    }
  }
  CHECK(read > 10);
  CHECK(refused > 50);
}

}  // namespace
}  // namespace pulsecast::io
