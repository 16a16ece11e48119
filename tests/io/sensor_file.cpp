// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/sensor_file.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <yaml-cpp/yaml.h>

#include <pulsecast/io/ouster_packets.hpp>
#include <pulsecast/io/sensor_calibration.hpp>
#include <pulsecast/io/velodyne_packets.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/sensor/ouster.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include "support/data_folder.hpp"
#include "support/file_errors.hpp"
#include "support/laws.hpp"
#include "support/spoilt_text.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::io {
namespace {

using support::contains;
using support::Generator;

const std::filesystem::path root = support::data_folder.parent_path().parent_path();
const std::filesystem::path catalogue = root / "examples" / "catalogue" / "data" / "sensors";

std::filesystem::path file_of(const std::string& id) { return catalogue / (id + ".yaml"); }

/// What the data sheet of a sensor states, of which its file says nothing itself.
struct Stated {
  const char* id;
  double points;                                                  // a second
  double azimuth_min, azimuth_max, elevation_min, elevation_max;  // field of view [deg]
};

// Sources: those of the files. Points: lasers by the time of a firing sequence; of a flat scanner, the number of points
// of a scan by their rate. Of the QT128, whose maker states 864,000, half the lasers fire twice as often here.
constexpr std::array stated = std::to_array<Stated>({
    {"hesai_pandar40p", 720e3, -180, 180, -25, 15},
    {"hesai_pandar64", 1.152e6, -180, 180, -25, 15},
    {"hesai_qt128", 1.152e6, -180, 180, -52.64, 52.64},
    {"hesai_xt32", 640e3, -180, 180, -16, 15},
    {"hokuyo_urg_04lx", 682 * 10, -119.89, 119.54, 0, 0},
    {"hokuyo_utm_30lx", 1081 * 40, -135, 135, 0, 0},
    {"livox_avia", 240e3, -35.2, 35.2, -38.6, 38.6},
    {"livox_avia_repetitive", 240e3, -35.2, 35.2, -2.25, 2.25},
    {"livox_mid_360", 200e3, -180, 180, -7, 52},
    {"livox_mid_40", 100e3, -19.2, 19.2, -19.2, 19.2},
    {"livox_mid_70", 100e3, -35.2, 35.2, -35.2, 35.2},
    {"ouster_os0_128", 1310720, -180, 180, -45, 45},
    {"ouster_os0_32", 327680, -180, 180, -45, 45},
    {"ouster_os0_64", 655360, -180, 180, -45, 45},
    {"ouster_os1_128", 1310720, -180, 180, -21.2, 21.2},
    {"ouster_os1_32", 327680, -180, 180, -21.2, 21.2},
    {"ouster_os1_64", 655360, -180, 180, -21.2, 21.2},
    {"ouster_os2_128", 1310720, -180, 180, -11.25, 11.25},
    {"ouster_os2_32", 327680, -180, 180, -11.25, 11.25},
    {"ouster_os2_64", 655360, -180, 180, -11.25, 11.25},
    {"sick_lms511", 1141 * 25, -95, 95, 0, 0},
    {"sick_tim561", 811 * 15, -135, 135, 0, 0},
    {"slamtec_rplidar_a1", 4000, -180, 180, 0, 0},
    {"slamtec_rplidar_a2", 8000, -180, 180, 0, 0},
    {"velodyne_hdl_32e", 694e3, -180, 180, -30.67, 10.67},
    {"velodyne_hdl_64e", 1.333e6, -180, 180, -24.33, 2},
    {"velodyne_puck_hi_res", 289e3, -180, 180, -10, 10},
    {"velodyne_vlp_16", 289e3, -180, 180, -15, 15},
    {"velodyne_vlp_32c", 579e3, -180, 180, -25, 15},
    {"velodyne_vls_128", 2.4e6, -180, 180, -25, 15},
});

std::vector<std::string> ids() {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(catalogue)) all.push_back(entry.path().stem().string());
  std::ranges::sort(all);
  return all;
}

TEST_CASE("every sensor of the catalogue has its pattern: field of view and points a second") {
  REQUIRE(ids().size() == stated.size());
  for (const Stated& of : stated) {
    const std::string id = of.id;
    CAPTURE(id);
    const SensorSheet sheet = read_sensor(file_of(id));
    const double time = sheet.prisms.empty() ? (sheet.rotation_rate == 5.5 ? 2 : 0.2) : 1;  // whole turns
    const SensorSource source = sheet.source(time);
    double low = 90, high = -90, left = 180, right = -180, points = 0;
    for (PulseIndex i = 0; i < source.size(); ++i) {
      const auto pulse = source.pulse(i);
      if (!pulse || Tick::of_seconds(time) <= pulse->tick) continue;
      ++points;
      const Vec3 d = pulse->direction();
      const double azimuth = degrees(std::atan2(d.x, d.y)), elevation = degrees(std::asin(std::clamp(d.z, -1.0, 1.0)));
      low = std::min(low, elevation);
      high = std::max(high, elevation);
      left = std::min(left, azimuth);
      right = std::max(right, azimuth);
    }
    CHECK(std::fabs(points / time / of.points - 1) < 2e-3);
    const double near = of.azimuth_max < 180 ? 0.15 : 1.5;  // a turn ends somewhere between two pulses
    CHECK(std::fabs(left - of.azimuth_min) < near);
    CHECK(std::fabs(right - of.azimuth_max) < near);
    CHECK(std::fabs(low - of.elevation_min) < 0.17);
    CHECK(std::fabs(high - of.elevation_max) < 0.17);
  }
}

TEST_CASE("every sensor of the catalogue keeps the laws of sources, and finds slots by time as its sheet does") {
  for (const std::string& id : ids()) {
    CAPTURE(id);
    const SensorSheet sheet = read_sensor(file_of(id));
    const SensorSource source = sheet.source(0.1);
    CHECK(support::source_laws(source, 50) == "");
    CHECK(source.slot_from(Tick::of_seconds(0.03)) <= sheet.slot_from(Tick::of_seconds(0.03)));  // of lasers, sequences
    CHECK(sheet.rings().size() == sheet.lasers.size());
    const Platform robot{Tripod{}, Mount{}, source};
    CHECK(robot.slot_from(Tick::of_seconds(0.03)) == source.slot_from(Tick::of_seconds(0.03)));
  }
}

TEST_CASE("the catalogue says of every number of a beam, range, noise and turn whether it is known") {
  const std::vector<std::string> usual{
      "lasers.azimuth_deg",      "lasers.height_mm",   "lasers.delay_us",   "rotation.rate_hz",
      "rotation.exit_radius_mm", "beam.wavelength_nm", "beam.peak_power_w", "beam.pulse_length_ns",
      "beam.divergence_mrad",    "ranges.min_m",       "ranges.max_m",      "noise.deviation_mm"};
  for (const std::string& id : ids()) {
    CAPTURE(id);
    const YAML::Node sheet = YAML::LoadFile(file_of(id).string());
    for (const auto& section : sheet)
      if (section.second.IsMap()) CHECK(section.second["source"].as<std::string>().size() > 5);
    REQUIRE(sheet["left_out"].IsSequence());
    for (const auto& node : sheet["left_out"]) {  // of a key that is there, nothing is left out
      const std::string key = node.as<std::string>();
      CAPTURE(key);
      const std::string section = key.substr(0, key.find('.'));
      const bool whole = section == key;
      CHECK(
          std::ranges::any_of(usual, [&](const std::string& u) { return u == key || (whole && u.starts_with(key)); }));
      CHECK(!(whole ? sheet[section].IsDefined()
                    : sheet[section].IsDefined() && sheet[section][key.substr(key.find('.') + 1)].IsDefined()));
    }
    const auto is_left_out = [&](const std::string& key) {
      return std::ranges::any_of(sheet["left_out"].as<std::vector<std::string>>(), [&](const std::string& left) {
        return left == key || left == key.substr(0, key.find('.'));
      });
    };
    const bool turns = !sheet["prisms"].IsDefined(),
               many = sheet["lasers"]["elevation_deg"].IsMap() || sheet["lasers"]["elevation_deg"].size() > 1;
    for (const std::string key :
         {"beam.wavelength_nm", "beam.peak_power_w", "beam.pulse_length_ns", "beam.divergence_mrad", "ranges.min_m",
          "ranges.max_m", "noise.deviation_mm", "rotation.rate_hz", "lasers.height_mm"}) {
      CAPTURE(key);
      if ((key == "rotation.rate_hz" && !turns) || (key == "lasers.height_mm" && !(turns && many))) continue;
      const std::string section = key.substr(0, key.find('.'));
      const bool is_given = sheet[section].IsDefined() && sheet[section][key.substr(key.find('.') + 1)].IsDefined();
      CHECK(is_given != is_left_out(key));
    }
  }
}

/// Values of a key of a sheet as its file has them, with commas between; `otherwise` without it.
std::string words_of(const YAML::Node& sheet, const char* section, const char* key, const std::string& otherwise) {
  if (!sheet[section].IsDefined() || !sheet[section][key].IsDefined()) return otherwise;
  const YAML::Node node = sheet[section][key];
  std::string words = node.IsScalar() ? node.Scalar() : "";
  for (const auto& item : node) words += (words.empty() ? "" : ", ") + item.Scalar();
  return words;
}

TEST_CASE("the table of docs/sensors.md is that of the files") {
  std::string table;
  for (const std::string& id : ids()) {
    const YAML::Node sheet = YAML::LoadFile(file_of(id).string());
    const auto words = [&](const char* section, const char* key) { return words_of(sheet, section, key, "?"); };
    std::string firing = words("firing", "columns") + " a turn";
    if (sheet["firing"]["period_us"].IsDefined()) firing = "each " + words("firing", "period_us") + " µs";
    if (sheet["firing"]["rate_hz"].IsDefined()) firing = words("firing", "rate_hz") + " Hz";
    std::string left_out;
    for (const auto& key : sheet["left_out"]) left_out += (left_out.empty() ? "" : ", ") + key.Scalar();
    table += "| `" + id + "` | " + sheet["name"].Scalar() + " | " +
             std::to_string(read_sensor(file_of(id)).lasers.size()) + " | " + firing + " | " +
             (sheet["prisms"].IsDefined() ? "prisms: " + words("prisms", "rate_hz") : words("rotation", "rate_hz")) +
             " | " + words("ranges", "min_m") + " to " + words("ranges", "max_m") + " | " +
             words("noise", "deviation_mm") + " | " + words("beam", "wavelength_nm") + " | " +
             words("beam", "divergence_mrad") + " | " + left_out + " |\n";
  }
  const std::string page = support::content(root / "docs" / "sensors.md");
  INFO(table);
  CHECK(contains(page, table));
}

/// Requires equal sheets, but for rounding of units.
void check_same(const SpinningSensor& a, const SpinningSensor& b) {
  const auto same = [](double x, double y) { return std::fabs(x - y) <= 1e-15 * std::max(1.0, std::fabs(x)); };
  CHECK(a.name == b.name);
  REQUIRE(a.lasers.size() == b.lasers.size());
  for (std::size_t k = 0; k < a.lasers.size(); ++k) {
    CHECK(same(a.lasers[k].elevation, b.lasers[k].elevation));
    CHECK(same(a.lasers[k].azimuth, b.lasers[k].azimuth));
    CHECK(same(a.lasers[k].height, b.lasers[k].height));
    CHECK(same(a.lasers[k].delay, b.lasers[k].delay));
  }
  CHECK(same(a.sequence_rate, b.sequence_rate));
  CHECK(same(a.rotation_rate, b.rotation_rate));
  CHECK(same(a.start, b.start));
  CHECK(same(a.exit_radius, b.exit_radius));
  CHECK(same(a.beam.wavelength, b.beam.wavelength));
  CHECK(same(a.beam.peak_power, b.beam.peak_power));
  CHECK(same(1e9 * a.beam.pulse_length, 1e9 * b.beam.pulse_length));
  CHECK(same(a.beam.divergence.across, b.beam.divergence.across));
  CHECK(same(a.range_min, b.range_min));
  CHECK(same(a.range_max, b.range_max));
  CHECK(same(a.range_deviation, b.range_deviation));
}

TEST_CASE("the files of sensors that have a function say the same") {
  check_same(read_sensor(file_of("velodyne_vlp_16")), velodyne_vlp_16());
  check_same(read_sensor(file_of("velodyne_vlp_16"), {.rotation_rate = 20}), velodyne_vlp_16(20));
  check_same(read_sensor(file_of("velodyne_vlp_32c"), {.rotation_rate = 5}), velodyne_vlp_32c(5));
  for (const std::size_t columns : {512U, 1024U, 2048U}) {
    SensorSheet ouster = read_sensor(file_of("ouster_os1_64"), {.columns = columns});
    CHECK(ouster.beam.pulse_length == Laser{}.pulse_length);  // not published: typical of the class in the function
    ouster.beam.pulse_length = ouster_os1_64().beam.pulse_length;
    check_same(ouster, ouster_os1_64(columns));
    if (columns == 2048) continue;  // at 10 Hz only
    check_same(read_sensor(file_of("ouster_os1_64"), {.rotation_rate = 20, .columns = columns}), [&] {
      SpinningSensor sensor = ouster_os1_64(columns, 20);
      sensor.beam.pulse_length = Laser{}.pulse_length;
      return sensor;
    }());
  }
}

TEST_CASE("sensors with packets go into the writers of packets") {
  for (const std::string& id : ids()) {
    CAPTURE(id);
    const SensorSheet sheet = read_sensor(file_of(id));
    if (sheet.packets == "velodyne") CHECK_NOTHROW(detail::VelodyneFormat::validate(sheet));
    if (sheet.packets == "ouster") CHECK_NOTHROW(detail::OusterFormat::validate(sheet));
    CHECK((sheet.packets.empty() || sheet.packets == "velodyne" || sheet.packets == "ouster"));
  }
}

TEST_CASE("metadata of a unit give the angles of any Ouster of the catalogue") {
  const support::TemporaryFolder folder;
  for (const std::string& id : ids()) {
    if (!id.starts_with("ouster")) continue;
    CAPTURE(id);
    const SensorSheet sheet = read_sensor(file_of(id));
    std::string altitudes, azimuths;
    for (std::size_t k = 0; k < sheet.lasers.size(); ++k) {
      altitudes += (k == 0 ? "" : ", ") + std::to_string(20 - static_cast<int>(k) / 4);
      azimuths += k == 0 ? "-1.5" : k % 2 == 0 ? ", -1.5" : ", 3";
    }
    std::filesystem::remove(folder / "unit.json");
    std::ofstream(folder / "unit.json") << "{\"prod_line\": \"" << sheet.name
                                        << "\", \"lidar_mode\": \"512x20\", \"beam_altitude_angles\": [" << altitudes
                                        << "], \"beam_azimuth_angles\": [" << azimuths << "]}";
    const SpinningSensor unit = read_ouster_metadata(folder / "unit.json", sheet);
    CHECK(unit.lasers.size() == sheet.lasers.size());
    CHECK(unit.lasers[5].elevation == doctest::Approx(radians(19)));
    CHECK(unit.lasers[1].azimuth == doctest::Approx(radians(3)));
    CHECK(unit.sequence_rate == 512 * 20);
    CHECK(unit.rotation_rate == 20);
    CHECK(unit.range_max == sheet.range_max);
    if (id != "ouster_os1_64")
      CHECK_THROWS_AS(static_cast<void>(read_ouster_metadata(folder / "unit.json")), FileError);
  }
}

TEST_CASE("numbers of manuals") {
  const SensorSheet hdl = read_sensor(file_of("velodyne_hdl_32e"));
  CHECK(hdl.lasers[15].elevation == 0);  // firing order 16
  CHECK(hdl.lasers[0].elevation == doctest::Approx(radians(-30.67)));
  CHECK(hdl.lasers[31].elevation == doctest::Approx(radians(10.67)));
  CHECK(hdl.lasers[31].delay == doctest::Approx(31 * 1.152e-6));
  const SensorSheet vls = read_sensor(file_of("velodyne_vls_128"));
  CHECK(3600 / vls.sequence_rate == doctest::Approx(0.19188));  // table 8-1, 600 turns a minute
  CHECK(vls.lasers[36].elevation == doctest::Approx(radians(-25)));
  CHECK(vls.lasers[127].delay == doctest::Approx(16 * 2.665e-6));
  const SensorSheet p40 = read_sensor(file_of("hesai_pandar40p"));
  const auto last = std::ranges::max_element(p40.lasers, {}, &SensorLaser::delay);
  CHECK(last->delay == doctest::Approx((54.67 - 3.62) * 1e-6));  // lasers 4 and 40
  CHECK(read_sensor(file_of("hesai_xt32")).lasers[1].delay == doctest::Approx(1.512e-6));
  const SensorSheet utm = read_sensor(file_of("hokuyo_utm_30lx"));
  CHECK(utm.rotation_rate == -40);
  CHECK(utm.receiver().range_max == 30);
  CHECK(read_sensor(file_of("slamtec_rplidar_a2")).rotation_rate == 10);
}

TEST_CASE("the settings of a file are chosen in its limits") {
  CHECK(read_sensor(file_of("sick_lms511"), {.rotation_rate = 50, .columns = 1080}).sequence_rate == 54e3);
  CHECK(read_sensor(file_of("velodyne_hdl_32e"), {.rotation_rate = 17.5}).rotation_rate == 17.5);  // not known: any
  const auto refused = [](const char* id, const SensorFileSettings& settings, const char* part) {
    CHECK_THROWS_WITH_AS(static_cast<void>(read_sensor(file_of(id), settings)), doctest::Contains(part), SettingError);
  };
  refused("velodyne_vlp_16", {.rotation_rate = 21},
          "SensorFileSettings::rotation_rate is 21 Hz, but must be from 5 to 20");
  refused("hesai_qt128", {.rotation_rate = 20}, "SensorFileSettings::rotation_rate");
  refused("ouster_os0_32", {.columns = 1000},
          "SensorFileSettings::columns is 1000, but must be a number of the file's firing.columns");
  refused("velodyne_vlp_16", {.columns = 1800}, "SensorFileSettings::columns");
  refused("ouster_os0_32", {.columns = 0}, "SensorFileSettings::columns is 0, but must be a number of");
  refused("velodyne_vlp_16", {.columns = 0}, "SensorFileSettings::columns is 0, but must be a number of");
  refused("livox_mid_40", {.rotation_rate = 33}, "SensorFileSettings::rotation_rate has no effect on prisms");
  refused("hesai_pandar64", {.rotation_rate = 2e6}, "SensorFileSettings::rotation_rate is 2e+06 Hz");
  refused("velodyne_vlp_16", {.rotation_rate = std::nan("")}, "SensorFileSettings::rotation_rate is nan");
}

TEST_CASE("a rate of rotation is chosen without a sign, or with that of the file") {
  for (const std::string& id : ids()) {
    CAPTURE(id);
    const SensorSheet sheet = read_sensor(file_of(id));
    if (!sheet.prisms.empty()) continue;
    const double rate = sheet.rotation_rate;
    CHECK(read_sensor(file_of(id), {.rotation_rate = rate}).rotation_rate == rate);
    CHECK(read_sensor(file_of(id), {.rotation_rate = std::fabs(rate)}).rotation_rate == rate);
    if (rate > 0) CHECK_THROWS_AS(static_cast<void>(read_sensor(file_of(id), {.rotation_rate = -rate})), SettingError);
  }
}

TEST_CASE("columns times turns a second are at most what a device can do") {
  const auto refused = [](const char* id, const SensorFileSettings& settings, const char* part) {
    CHECK_THROWS_WITH_AS(static_cast<void>(read_sensor(file_of(id), settings)), doctest::Contains(part), SettingError);
  };
  for (const std::string& id : ids())
    if (id.starts_with("ouster"))
      refused(id.c_str(), {.rotation_rate = 20, .columns = 2048},
              "SensorFileSettings::columns times rotation_rate is 40960 Hz, but must be from 0 to 20480");
  CHECK(read_sensor(file_of("ouster_os2_64"), {.rotation_rate = 10, .columns = 2048}).sequence_rate == 20480);
  CHECK(read_sensor(file_of("ouster_os2_64"), {.rotation_rate = 20, .columns = 1024}).sequence_rate == 20480);
  refused("sick_lms511", {.rotation_rate = 100}, "SensorFileSettings::columns times rotation_rate is 216000 Hz");
  CHECK(read_sensor(file_of("sick_lms511"), {.rotation_rate = 100, .columns = 540}).sequence_rate == 54e3);
}

const std::string sound =
    "name: any\nlasers:\n  source: manual\n  elevation_deg: [1, 2]\n  delay_us: [0, 3]\nfiring:\n  source: manual\n"
    "  period_us: 50\nrotation:\n  source: manual\n  rate_hz: 10\nbeam:\n  source: manual\n  wavelength_nm: 905\n";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST_CASE("a number that is left out is the library's, without noise and without limits of ranges") {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "any.yaml") << sound;
  const SensorSheet sheet = read_sensor(folder / "any.yaml");
  CHECK(sheet.beam.wavelength == doctest::Approx(905e-9));
  CHECK(sheet.beam.divergence == Laser{}.divergence);
  CHECK(sheet.range_deviation == 0);
  CHECK(sheet.range_min == 0);
  CHECK(sheet.range_max == std::numeric_limits<double>::infinity());
  CHECK(sheet.packets.empty());
  CHECK(sheet.lasers[1].delay == doctest::Approx(3e-6));
}

TEST_CASE("damaged sheets are refused with path, line and key") {
  const support::TemporaryFolder folder;
  const auto check = [&](const std::string& text, const std::string& part) {
    std::filesystem::remove(folder / "unit");
    std::ofstream(folder / "unit", std::ios::binary) << text;
    const FileError refusal = support::file_error([&] { static_cast<void>(read_sensor(folder / "unit")); });
    const std::string message = refusal.place() + ": " + refusal.problem();
    INFO(message);
    CHECK(refusal.path() == (folder / "unit").string());
    CHECK(contains(message, part));
  };
  check(with(sound, "name: any\n", ""), "has no name");
  check(with(sound, "beam:", "beams:"),
        "line 12: the sheet has the key 'beams', which is unknown; did you mean 'beam'?");
  check(with(sound, "wavelength_nm", "wavelength"), "line 14: beam has the key 'wavelength', which is unknown");
  check(with(sound, "  source: manual\n  wave", "  wave"), "line 13: has no source");
  check(with(sound, "  source: manual\n  wave", "  source: ''\n  wave"), "beam.source is empty");
  check(with(sound, "905", "west"), "line 14: beam.wavelength_nm is 'west': expected a number from 100 to 10000");
  check(with(sound, "905", "[905]"), "beam.wavelength_nm is a list or map");
  check(with(sound, "905", "-905"), "beam.wavelength_nm is '-905'");
  check(with(sound, "[0, 3]", "[0, 3, 6]"), "line 5: lasers.delay_us is no list of 2");
  check(with(sound, "[1, 2]", "[]"), "line 4: lasers.elevation_deg is an empty list");
  check(with(sound, "[1, 2]", "[1, 91]"), "line 4: lasers.elevation_deg is '91': expected a number from -90 to 90");
  check(with(sound, "[1, 2]", "{from: 1, to: 2, number: 3, of: 1}"), "elevation_deg has the key 'of'");
  check(with(sound, "[1, 2]", "{from: 1, to: 2}"), "has no number");
  check(with(sound, "[1, 2]", "{from: 1, to: 2, number: 1}"), "lasers.elevation_deg.number is '1'");
  check(with(sound, "[1, 2]", "{from: 1, to: 2, number: 2.5}"), "elevation_deg.number is no whole number");
  check(with(sound, "[0, 3]", "{from: 1, to: 2, number: 3}"), "lasers.delay_us.number is '3': expected 2");
  check(with(sound, "  elevation_deg: [1, 2]\n", ""), "SpinningSensor::lasers (number)");
  check(with(sound, "period_us: 50\n", "period_us: 50\n  rate_hz: 1000\n"), "expected one of period_us, rate_hz and");
  check(with(sound, "  period_us: 50\n", ""), "expected one of period_us, rate_hz and, on a head, columns");
  check(with(sound, "rate_hz: 10", "rate_hz: west"), "rotation.rate_hz is 'west'");
  check(with(sound, "rate_hz: 10", "rate_hz: 10\n  azimuth_max_deg: 90"), "SensorSheet::lasers (number with sweeps");
  check(with(sound, "[0, 3]", "[3, 0]"), "Channels::channels");
  check(with(sound, "[0, 3]", "[0, 51]"), "Scanner::delay");
  check(sound + "prisms: 5\n", "prisms is no map");
  check(sound + "prisms: {source: manual, wedge_deg: [1, 2], rate_hz: [1]}\n", "prisms.rate_hz is no list of 2");
  check(with(sound, "905", "905\n  wavelength_nm: 1064"), "line 15: beam has the key 'wavelength_nm' twice");
  check(sound + "beam: {source: manual}\n", "line 15: the sheet has the key 'beam' twice");
  check(with(sound, "[1, 2]", "{from: 1, to: 2, number: 2, to: 3}"), "lasers.elevation_deg has the key 'to' twice");
  check(sound + "packets: velodine\n", "line 15: packets is 'velodine': expected velodyne or ouster");
  check(sound + "left_out: [noise, beam.peak_power]\n",
        "line 15: left_out has the key 'beam.peak_power', which is unknown; did you mean 'beam.peak_power_w'?");
  check(sound + "left_out: {noise: all}\n", "left_out is no list");
  check(sound + "left_out: noise\n", "left_out is no list");
  check(sound + "left_out: [[noise]]\n", "a key is a list or map");
  check(with(sound, "period_us: 50", "columns: [1024, 1080.5]"), "line 8: firing.columns are no whole numbers");
  check(with(sound, "period_us: 50", "columns: [1024]\n  rate_max_hz: 10000"),
        "line 9: firing.rate_max_hz is '10000': expected a number from 10240");
  check(with(sound, "rate_hz: 10", "rate_hz: []"), "line 11: rotation.rate_hz is an empty list");
  check(with(sound, "rate_hz: 10", "rate_hz: [10, -5, 20]"),
        "line 11: rotation.rate_hz is '-5': expected a number from 0");
  check(with(sound, "rate_hz: 10", "rate_hz: [-10, 5]"),
        "line 11: rotation.rate_hz is '5': expected a number from -1e");
  check(with(sound, "rate_hz: 10", "rate_hz: 10\n  azimuth_min_deg: -180\n  azimuth_max_deg: 179"),
        "SensorSheet::lasers (number with sweeps");
  const std::string prisms = "prisms: {source: manual, wedge_deg: [-18, 18], rate_hz: [100, -70]}\n";
  const std::string still = with(sound, "rotation:\n  source: manual\n  rate_hz: 10\n", "");
  check(still + "prisms: {source: manual, wedge_deg: [-18, 18]}\n", "line 12: has no rate_hz");
  check(still + "prisms: {source: manual, rate_hz: [100, -70]}\n", "line 12: has no wedge_deg");
  check(still + with(prisms, "[-18, 18]", "[-80, 80]"), "Prism::wedge reflects all beams");
  check(with(still, "[0, 3]", "[0, 3]\n  height_mm: 5") + prisms, "SensorLaser::height has no effect");
  check(sound + prisms, "rotation has no effect on prisms");
  check(with(still, "period_us: 50", "columns: [1024]") + prisms, "expected one of period_us, rate_hz and, on a head");
  const std::string one = with(with(sound, "[1, 2]", "0"), "  delay_us: [0, 3]\n", "");
  const std::string sweeps = "sweeps: {source: manual, rate_hz: 1000, elevation_min_deg: -7, elevation_max_deg: 52}\n";
  check(one + with(sweeps, ", elevation_min_deg: -7", ""), "line 14: has no elevation_min_deg");
  check(one + with(sweeps, ", elevation_max_deg: 52", ""), "line 14: has no elevation_max_deg");
  check(one + with(sweeps, "rate_hz: 1000, ", ""), "line 14: has no rate_hz");
  check(with(one, "rate_hz: 10", "rate_hz: 10\n  azimuth_max_deg: 90") + sweeps,
        "SensorSheet::azimuth_max has no effect");
  check(with(one, "rate_hz: 10", "rate_hz: 10\n  start_deg: 90") + sweeps, "SpinningSensor::start has no effect");
  check("- 1\n- 2\n", "is no map");
  check("# nothing\n", "is no map");
  check("name: [a", "is no YAML or JSON");
  check("", "is empty: expected a sensor's data sheet");
}

TEST_CASE("a sheet that was spoilt is read or refused") {
  constexpr std::array words{"[",
                             "{",
                             "}",
                             "- ",
                             "&a ",
                             "*a",
                             ": ",
                             "'",
                             "!!int ",
                             "|",
                             "<<: *a",
                             "---",
                             "1e999",
                             "~",
                             "columns: [3, 4]",
                             "{from: 1, to: 2, number: 9}"};
  std::vector<std::string> texts{sound};
  for (const char* id : {"velodyne_vlp_16", "livox_avia", "sick_lms511", "livox_mid_360", "ouster_os1_64"})
    texts.push_back(support::content(file_of(id)));
  std::size_t read = 0, refused = 0;
  const support::TemporaryFolder folder;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    CAPTURE(seed);
    Generator random(seed);
    std::ofstream(folder / "unit", std::ios::binary)
        << support::spoilt(texts[seed % texts.size()], 1 + random.whole(4), words, random);
    try {
      read_sensor(folder / "unit").validate();
      ++read;
    } catch (const FileError&) {
      ++refused;
    }
  }
  CHECK(read > 50);
  CHECK(refused > 50);
}

}  // namespace
}  // namespace pulsecast::io
