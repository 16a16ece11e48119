// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/ouster_packets.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/sensor/ouster.hpp>

#include "support/generators.hpp"
#include "support/packets.hpp"

namespace pulsecast::io {
namespace {

using support::Generator;
using support::KeptPacket;
using support::packets_of;
using support::SensorEchoes;

/// Return of a pulse as a decoder has it.
struct Return {
  std::uint64_t time;  // [ns]
  Vec3 point;          // in the sensor's frame, our axes [m]
  unsigned reflectivity, signal;
};

/// Frame, column, laser, and 0 for the first return.
using Place = std::tuple<unsigned, unsigned, std::size_t, int>;

/// Decodes packets by the firmware user manual alone: the lidar data packet format, and the calculation of coordinates.
std::map<Place, Return> decoded(const std::vector<KeptPacket>& packets, const SpinningSensor& sensor,
                                unsigned columns) {
  std::map<Place, Return> all;
  for (const KeptPacket& packet : packets) {
    const bool dual = packet.payload.size() == 16'640;
    if (!dual) REQUIRE(packet.payload.size() == 12'608);
    if (dual) REQUIRE(packet.at<std::uint16_t>(0) == 1);
    for (std::size_t c = 0; c < 16; ++c) {
      const std::size_t at = dual ? 32 + c * 1036 : c * 788;
      const auto time = packet.at<std::uint64_t>(at);
      const unsigned id = packet.at<std::uint16_t>(at + 8),
                     frame = dual ? packet.at<std::uint16_t>(2) : packet.at<std::uint16_t>(at + 10);
      const std::uint32_t encoder = dual ? id * (90'112 / columns) : packet.at<std::uint32_t>(at + 12);
      REQUIRE((dual ? packet.at<std::uint16_t>(at + 10) == 1 : packet.at<std::uint32_t>(at + 784) == 0xFFFFFFFF));
      REQUIRE(encoder == id * (90'112 / columns));
      for (std::size_t i = 0; i < 64; ++i)
        for (std::size_t k = 0; k < (dual ? 2u : 1u); ++k) {
          const std::size_t pixel = at + (dual ? 12 + 16 * i : 16 + 12 * i);
          const unsigned r = packet.at<std::uint32_t>(pixel + 4 * k) & (dual ? 0x7FFFF : 0xFFFFF);
          if (r == 0) continue;
          const double n = 15.806, turn = 2 * pi * (1 - encoder / 90'112.0), aside = -sensor.lasers[i].azimuth;
          const double up = sensor.lasers[i].elevation;
          const double x = (r - n) * std::cos(turn + aside) * std::cos(up) + n * std::cos(turn);
          const double y = (r - n) * std::sin(turn + aside) * std::cos(up) + n * std::sin(turn);
          const double z = (r - n) * std::sin(up);
          const Vec3 forward_left_up{-x, -y, z + 36.180};  // lidar_to_sensor_transform of the manual [mm]
          all[{frame, id, i, static_cast<int>(k)}] = {
              time, 1e-3 * Vec3{-forward_left_up.y, forward_left_up.x, forward_left_up.z},
              dual ? packet.at<std::uint8_t>(pixel + 4 * k + 3) : packet.at<std::uint8_t>(pixel + 4),
              packet.at<std::uint16_t>(dual ? pixel + 8 + 2 * k : pixel + 6)};
        }
    }
  }
  return all;
}

TEST_CASE("a decoder by the manual gives the echoes of an OS1 back, of all modes, columns and rates") {
  for (std::uint64_t seed = 0; seed < 18; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const unsigned columns = std::array{512u, 1024u, 2048u}[seed % 3];
    SpinningSensor sensor = ouster_os1_64(columns, seed % 2 == 0 || columns == 2048 ? 10 : 20);
    for (SensorLaser& laser : sensor.lasers) laser.azimuth = any.uniform(-0.06, 0.06);
    const PacketSettings settings{.returns = static_cast<PacketReturns>(seed / 6),
                                  .start_time = static_cast<double>(any.whole(2'000'000'000))};
    const PulseIndex first = any.whole(64 * 2048 * 40);
    const SensorEchoes all = SensorEchoes::any(sensor.source(100), first, first + 64 * 300, 3, any);
    const auto returns = decoded(packets_of<OusterPackets>(all, sensor, settings), sensor, columns);
    std::size_t compared = 0;
    for (const Shot& shot : all.shots) {
      if (shot.echoes == 0) continue;
      std::vector<Echo> expected = support::by_strength(all.of(shot));
      if (settings.returns == PacketReturns::last) expected = {all.of(shot).back()};
      expected.resize(std::min<std::size_t>(expected.size(), settings.returns == PacketReturns::dual ? 2 : 1));
      const PulseIndex sequence = shot.index / 64;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const auto found =
            returns.find({static_cast<unsigned>(sequence / columns), static_cast<unsigned>(sequence % columns),
                          shot.index % 64, static_cast<int>(k)});
        REQUIRE(found != returns.end());
        ++compared;
        const Return& r = found->second;
        CHECK(length(r.point - point_of(shot, expected[k])) <= 0.5e-3 + 1e-9);
        const std::uint64_t start =
            static_cast<std::uint64_t>(settings.start_time) + static_cast<std::uint64_t>(shot.tick.second);
        const double late =
            static_cast<double>(static_cast<std::int64_t>(r.time - start * 1'000'000'000)) - 1e9 * shot.tick.fraction;
        CHECK(std::fabs(late) <= 0.5 + 1e-6);
        CHECK(r.reflectivity == static_cast<unsigned>(std::lround(100 * expected[k].reflectance)));
        const double photon = 6.62607015e-34 * 299792458 / 865e-9;  // [J]
        CHECK(std::fabs(r.signal - std::min(65'535.0, expected[k].amplitude * 6e-9 / photon)) <= 0.5 + 1e-6);
      }
    }
    CHECK(compared == returns.size());
  }
}

TEST_CASE("the bytes of a column are those of the manual") {
  const SpinningSensor sensor = ouster_os1_64();
  SensorEchoes all;
  const SpinningSource source = sensor.source(1);
  all.add(source, 64 * (1024 + 3) + 2, {10.0, 20.0});  // third column of the second turn, third laser
  for (Echo& echo : all.echoes) echo.amplitude = echo.range == 10 ? 3e-10 : 1e-10;
  const double photon = 6.62607015e-34 * 299792458 / 865e-9;
  const auto signal = [&](double power) { return static_cast<unsigned>(std::lround(power * 6e-9 / photon)); };
  const auto single = packets_of<OusterPackets>(all, sensor, {.start_time = 5});
  REQUIRE(single.size() == 1);
  const std::size_t column = 3 * 788, pixel = column + 16 + 2 * 12;
  CHECK(single[0].port == 7502);
  CHECK(single[0].at<std::uint64_t>(column) == 5'100'292'969);  // 1027 / 10240 s
  CHECK(single[0].at<std::uint16_t>(column + 8) == 3);
  CHECK(single[0].at<std::uint16_t>(column + 10) == 1);
  CHECK(single[0].at<std::uint32_t>(column + 12) == 3 * 88);
  CHECK(single[0].at<std::uint32_t>(pixel) == 10'016);  // 10 m and 15.806 mm
  CHECK(single[0].at<std::uint8_t>(pixel + 4) == 50);
  CHECK(single[0].at<std::uint8_t>(pixel + 5) == 0);
  CHECK(single[0].at<std::uint16_t>(pixel + 6) == signal(3e-10));
  CHECK(single[0].at<std::uint32_t>(pixel + 8) == 0);
  CHECK(single[0].at<std::uint32_t>(15 * 788 + 784) == 0xFFFFFFFF);
  CHECK(single[0].time.second == 5);
  CHECK(std::fabs(single[0].time.fraction - 1040 / 10240.0) < 1e-12);

  const auto dual = packets_of<OusterPackets>(all, sensor, {.returns = PacketReturns::dual});
  const std::size_t dual_column = 32 + 3 * 1036, dual_pixel = dual_column + 12 + 2 * 16;
  CHECK(dual[0].at<std::uint16_t>(0) == 1);
  CHECK(dual[0].at<std::uint16_t>(2) == 1);
  CHECK(dual[0].at<std::uint16_t>(dual_column + 8) == 3);
  CHECK(dual[0].at<std::uint16_t>(dual_column + 10) == 1);
  CHECK(dual[0].at<std::uint32_t>(dual_pixel) == (10'016 | 50u << 24));
  CHECK(dual[0].at<std::uint32_t>(dual_pixel + 4) == (20'016 | 50u << 24));
  CHECK(dual[0].at<std::uint16_t>(dual_pixel + 8) == signal(3e-10));
  CHECK(dual[0].at<std::uint16_t>(dual_pixel + 10) == signal(1e-10));
  for (std::size_t k = 16'640 - 32; k < 16'640; ++k) CHECK(dual[0].at<std::uint8_t>(k) == 0);
}

TEST_CASE("a range beyond its bits is no return, and photons end at 16 bits") {
  const SpinningSensor sensor = ouster_os1_64();
  SensorEchoes all;
  all.add(sensor.source(1), 0, {1049.0});
  all.add(sensor.source(1), 1, {600.0});
  for (Echo& echo : all.echoes) echo.amplitude = 1;
  const auto single = packets_of<OusterPackets>(all, sensor, {}),
             dual = packets_of<OusterPackets>(all, sensor, {.returns = PacketReturns::dual});
  CHECK(single[0].at<std::uint32_t>(16) == 0);
  CHECK(single[0].at<std::uint32_t>(28) == 600'016);
  CHECK(single[0].at<std::uint16_t>(34) == 0xFFFF);
  CHECK(dual[0].at<std::uint32_t>(32 + 12 + 16) == 0);
}

TEST_CASE("sensors other than an OS1-64 that starts at encoder 0 are refused") {
  const auto take = [](const SensorPacket&) {};
  SpinningSensor sensor = ouster_os1_64();
  sensor.start = 0;
  CHECK_THROWS_WITH_AS(OusterPackets(sensor, {}, take), doctest::Contains("SpinningSensor::start"), SettingError);
  sensor = ouster_os1_64();
  sensor.sequence_rate = 10'000;
  CHECK_THROWS_WITH_AS(OusterPackets(sensor, {}, take), doctest::Contains("SpinningSensor::sequence_rate"),
                       SettingError);
  sensor = ouster_os1_64();
  sensor.rotation_rate = 0;
  CHECK_THROWS_WITH_AS(OusterPackets(sensor, {}, take), doctest::Contains("SpinningSensor::sequence_rate"),
                       SettingError);
  sensor.lasers.pop_back();
  CHECK_THROWS_WITH_AS(OusterPackets(sensor, {}, take), doctest::Contains("SpinningSensor::lasers"), SettingError);
}

}  // namespace
}  // namespace pulsecast::io
