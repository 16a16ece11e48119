// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/velodyne_packets.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include "support/generators.hpp"
#include "support/packets.hpp"

namespace pulsecast::io {
namespace {

using support::Generator;
using support::KeptPacket;
using support::PacketKeeper;
using support::packets_of;
using support::SensorEchoes;

/// Return of a pulse as a decoder has it.
struct Return {
  double time, azimuth, elevation, range;  // since the hour [s]; [deg]; [deg]; [m]
  double offset;                           // of the firing, since the packet's first [s]
  int reflectivity;
  bool is_interpolated;  // between azimuths of this packet
};

/// Place of a return: firing sequence since the first packet, laser, and 0 for the first of two blocks of the same
/// firings.
using Place = std::tuple<std::size_t, std::size_t, int>;

/// Elevation of a laser, and its azimuth from the head's [deg]. Source: VLP-16 user manual, table 9-1; VLP-32C user
/// manual, tables 9-2, 9-6.
std::pair<double, double> angles_of(std::size_t laser, bool vlp_16) {
  if (vlp_16) return {laser % 2 == 0 ? -15.0 + static_cast<double>(laser) : static_cast<double>(laser), 0};
  constexpr std::array<double, 32> elevations{-25,    -1,    -1.667, -15.639, -11.31, 0,     -0.667, -8.843,
                                              -7.254, 0.333, -0.333, -6.148,  -5.333, 1.333, 0.667,  -4,
                                              -4.667, 1.667, 1,      -3.667,  -3.333, 3.333, 2.333,  -2.667,
                                              -3,     7,     4.667,  -2.333,  -2,     15,    10.333, -1.333};
  constexpr std::array<int, 32> azimuths{14, -42, 14, -14, 14, -14, 42, -14, 14, -42, 14, -14, 42, -14, 42, -14,
                                         14, -42, 14, -42, 42, -14, 14, -14, 14, -14, 14, -42, 42, -14, 14, -14};
  return {elevations[laser], 0.1 * azimuths[laser]};
}

/// Decodes packets by the manuals alone: 9.3 for the layout, 9.4 for times and 9.5 for azimuths.
std::map<Place, Return> decoded(const std::vector<KeptPacket>& packets) {
  std::map<Place, Return> all;
  for (std::size_t n = 0; n < packets.size(); ++n) {
    const KeptPacket& packet = packets[n];
    REQUIRE(packet.payload.size() == 1206);
    const bool dual = packet.at<std::uint8_t>(1204) == 0x39, vlp_16 = packet.at<std::uint8_t>(1205) == 0x22;
    const std::size_t step = dual ? 2 : 1, per_block = vlp_16 ? 2 : 1, lasers = vlp_16 ? 16 : 32;
    const auto azimuth_of = [&](std::size_t block) { return 0.01 * packet.at<std::uint16_t>(block * 100 + 2); };
    for (std::size_t block = 0; block < 12; ++block) {
      REQUIRE(packet.at<std::uint16_t>(block * 100) == 0xEEFF);
      const std::size_t pair = block / step, pairs = 12 / step, from = pair + 1 < pairs ? pair : pair - 1;
      if (dual) REQUIRE(azimuth_of(block) == azimuth_of(pair * 2));
      double gap = azimuth_of((from + 1) * step) - azimuth_of(from * step);
      if (gap < 0) gap += 360;
      for (std::size_t point = 0; point < 32; ++point) {
        const std::size_t position = block * 100 + 4 + 3 * point, laser = point % lasers, half = point / lasers;
        const double distance = packet.at<std::uint16_t>(position) * (vlp_16 ? 0.002 : 0.004);
        if (distance == 0) continue;
        const auto [elevation, aside] = angles_of(laser, vlp_16);
        const double in_block =
            55.296e-6 * static_cast<double>(half) + 2.304e-6 * static_cast<double>(vlp_16 ? laser : laser / 2);
        const double block_time = 55.296e-6 * static_cast<double>(per_block);
        const double offset = block_time * static_cast<double>(pair) + in_block;
        all[{(n * pairs + pair) * per_block + half, laser, static_cast<int>(block % step)}] = {
            1e-6 * packet.at<std::uint32_t>(1200) + offset,
            azimuth_of(block) + gap * in_block / block_time + aside,
            elevation,
            distance,
            offset,
            packet.at<std::uint8_t>(position + 2),
            pair + 1 < pairs};
      }
    }
  }
  return all;
}

/// Returns that the manuals promise of the echoes of a pulse; two of them for dual returns.
std::vector<Echo> promised(std::span<const Echo> echoes, PacketReturns returns) {
  const std::vector<Echo> sorted = support::by_strength(echoes);
  if (returns == PacketReturns::strongest) return {sorted.front()};
  if (returns == PacketReturns::last) return {echoes.back()};
  const bool is_last = sorted.front().range == echoes.back().range;
  return {echoes.back(), sorted[is_last && sorted.size() > 1 ? 1 : 0]};
}

double wrapped(double degrees) { return degrees - 360 * std::round(degrees / 360); }

/// Requires that the decoder gives the echoes back, and nothing else.
void check_decoded(const SensorEchoes& all, const std::vector<KeptPacket>& packets, const SpinningSensor& sensor,
                   const PacketSettings& settings) {
  const auto returns = decoded(packets);
  const std::size_t lasers = sensor.lasers.size();
  const std::size_t per_packet = (lasers == 16 ? 24u : 12u) / (settings.returns == PacketReturns::dual ? 2 : 1);
  const double quantum = lasers == 16 ? 0.002 : 0.004;
  std::size_t compared = 0;
  std::optional<PulseIndex> base;
  for (const Shot& shot : all.shots) {
    if (shot.echoes == 0) continue;
    const PulseIndex sequence = shot.index / lasers;
    if (!base) base = sequence / per_packet * per_packet;
    const std::vector<Echo> expected = promised(all.of(shot), settings.returns);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const auto found = returns.find({sequence - *base, shot.index % lasers, static_cast<int>(k)});
      REQUIRE(found != returns.end());
      const Return& r = found->second;
      ++compared;
      CHECK(std::fabs(r.range - expected[k].range) <= quantum / 2 + 1e-9);
      CHECK(r.reflectivity == std::lround(100 * expected[k].reflectance));
      const double azimuth = std::atan2(shot.direction.x, shot.direction.y) * 180 / pi;
      CHECK(std::fabs(wrapped(r.azimuth - azimuth)) <= (r.is_interpolated ? 0.005 : 0.015) + 1e-9);
      CHECK(std::fabs(r.elevation - std::asin(shot.direction.z) * 180 / pi) < 1e-9);
      const Tick packet = sensor.sequence_start(sequence / per_packet * per_packet);
      const double since =
          static_cast<double>(shot.tick.second - packet.second) + (shot.tick.fraction - packet.fraction);
      CHECK(std::fabs(r.offset - since) < 0.01e-6);
      const double clock = std::fmod(settings.start_time, 3600) + shot.tick.seconds();
      CHECK(std::fabs(std::remainder(r.time - clock, 3600)) < 1e-6);
    }
  }
  CHECK(compared == returns.size());
}

TEST_CASE("the bytes of a packet are those of the manual") {
  const SpinningSensor sensor = velodyne_vlp_16();
  const SpinningSource source = sensor.source(1);
  SensorEchoes all;
  all.add(source, 0, {10.0});  // laser 0 of the first sequence
  all.add(source, 16 * 3 + 5,
          {2.5, 131.5});            // laser 5 of the second sequence of block 1; the farther is beyond 16 bits
  all.add(source, 16 * 24, {1.0});  // the next packet
  const auto packets = packets_of<VelodynePackets>(all, sensor, {.start_time = 7200.25});
  REQUIRE(packets.size() == 2);
  std::vector<std::uint8_t> expected(1206);
  const std::vector<unsigned> azimuths{0,   40,  80,  119, 159, 199,
                                       239, 279, 319, 358, 398, 438};  // 360 deg 10 Hz 110.592 us = 0.39813 deg
  for (std::size_t block = 0; block < 12; ++block) {
    expected[block * 100] = 0xFF;
    expected[block * 100 + 1] = 0xEE;
    expected[block * 100 + 2] = static_cast<std::uint8_t>(azimuths[block] & 0xFF);
    expected[block * 100 + 3] = static_cast<std::uint8_t>(azimuths[block] >> 8);
  }
  const auto put = [&](std::size_t position, const std::vector<std::uint8_t>& bytes) {
    std::copy(bytes.begin(), bytes.end(), expected.begin() + static_cast<std::ptrdiff_t>(position));
  };
  put(4, {0x88, 0x13, 50});                         // 5000 steps of 2 mm
  put(100 + 4 + 3 * (16 + 5), {0xE2, 0x04, 50});    // 1250 steps
  put(1200, {0x90, 0xD0, 0x03, 0x00, 0x37, 0x22});  // 250 000 us
  for (std::size_t k = 0; k < expected.size(); ++k) {
    CAPTURE(k);
    CHECK(packets[0].at<std::uint8_t>(k) == expected[k]);
  }
  CHECK(packets[0].port == 2368);
  CHECK(packets[0].time.second == 7200);
  CHECK(std::fabs(packets[0].time.fraction - (0.25 + 24 * 55.296e-6)) < 1e-12);
  CHECK(packets[1].at<std::uint32_t>(1200) == 251'327);
}

TEST_CASE("factory bytes tell the mode and the product") {
  for (const SpinningSensor& sensor : {velodyne_vlp_16(), velodyne_vlp_32c()}) {
    SensorEchoes all;
    all.add(sensor.source(1), 0, {2.0});
    for (const auto& [returns, mode] :
         {std::pair{PacketReturns::strongest, 0x37}, {PacketReturns::last, 0x38}, {PacketReturns::dual, 0x39}}) {
      const auto packets = packets_of<VelodynePackets>(all, sensor, {.returns = returns});
      CHECK(packets[0].at<std::uint8_t>(1204) == mode);
      CHECK(packets[0].at<std::uint8_t>(1205) == (sensor.lasers.size() == 16 ? 0x22 : 0x28));
    }
  }
}

TEST_CASE("a distance beyond 16 bits, and one that rounds to nothing, are no returns") {
  const SpinningSensor sensor = velodyne_vlp_16();
  const SpinningSource source = sensor.source(1);
  SensorEchoes all;
  all.add(source, 0, {131.07});
  all.add(source, 1, {131.0711});
  all.add(source, 2, {0.0009});
  const auto packets = packets_of<VelodynePackets>(all, sensor, {});
  CHECK(packets[0].at<std::uint16_t>(4) == 0xFFFF);
  CHECK(packets[0].at<std::uint16_t>(7) == 0);
  CHECK(packets[0].at<std::uint8_t>(9) == 0);
  CHECK(packets[0].at<std::uint16_t>(10) == 0);
}

TEST_CASE("a decoder by the manuals gives the echoes back, of all modes and rates") {
  for (std::uint64_t seed = 0; seed < 36; ++seed) {
    CAPTURE(seed);
    Generator any(seed);
    const double rate = std::array{5.0, 10.0, 20.0}[seed / 6 % 3];
    SpinningSensor sensor = seed % 2 == 0 ? velodyne_vlp_16(rate) : velodyne_vlp_32c(rate);
    sensor.start = any.uniform(0, 2 * pi);
    const PacketSettings settings{.returns = static_cast<PacketReturns>(seed / 2 % 3),
                                  .start_time = any.uniform(0, 2e9)};
    const PulseIndex first = any.whole(100'000);
    const SensorEchoes all = SensorEchoes::any(sensor.source(10), first, first + 20'000, 3, any);
    check_decoded(all, packets_of<VelodynePackets>(all, sensor, settings), sensor, settings);
  }
}

TEST_CASE("azimuths wrap at the end of the turn, and times at the top of the hour") {
  for (const SpinningSensor& sensor : {velodyne_vlp_16(20), velodyne_vlp_32c(20)}) {
    const double start_time = 1'700'000'000 - 1'700'000'000 % 3600 + 3599.96;
    const PacketSettings settings{.start_time = start_time};
    Generator any(5);
    const SensorEchoes all = SensorEchoes::any(sensor.source(1), 0, 30'000, 1, any);  // one turn and more
    const auto packets = packets_of<VelodynePackets>(all, sensor, settings);
    check_decoded(all, packets, sensor, settings);
    bool wraps_azimuth = false, wraps_time = false;
    for (std::size_t n = 0; n < packets.size(); ++n) {
      for (std::size_t block = 0; block < 12; ++block) CHECK(packets[n].at<std::uint16_t>(block * 100 + 2) < 36'000);
      for (std::size_t block = 1; block < 12; ++block)
        wraps_azimuth |= packets[n].at<std::uint16_t>(block * 100 + 2) < packets[n].at<std::uint16_t>(block * 100 - 98);
      CHECK(packets[n].at<std::uint32_t>(1200) < 3'600'000'000);
      if (n > 0) wraps_time |= packets[n].at<std::uint32_t>(1200) < packets[n - 1].at<std::uint32_t>(1200);
    }
    CHECK((wraps_azimuth && wraps_time));
  }
}

TEST_CASE("a head that has all but turned once is at 0 degrees, and a time just before the hour is at its top") {
  SpinningSensor sensor = velodyne_vlp_16();
  sensor.start = 2 * pi - 1e-6;
  SensorEchoes all;
  all.add(sensor.source(1), 0, {1.0});
  const auto packets = packets_of<VelodynePackets>(all, sensor, {.start_time = 3600 - 1e-7});
  CHECK(packets[0].at<std::uint16_t>(2) == 0);
  CHECK(packets[0].at<std::uint32_t>(1200) == 0);
}

TEST_CASE("missing slots are empty packets, and the packets of a part are those of the whole") {
  const SpinningSensor sensor = velodyne_vlp_16();
  const SpinningSource source = sensor.source(1);
  SensorEchoes whole, part;
  for (const PulseIndex slot : {PulseIndex{3}, PulseIndex{16 * 24 * 2 + 7}, PulseIndex{16 * 24 * 5 + 9}})
    whole.add(source, slot, {2.0});
  for (const PulseIndex slot : {PulseIndex{16 * 24 * 2 + 7}, PulseIndex{16 * 24 * 5 + 9}})
    part.add(source, slot, {2.0});
  const auto all = packets_of<VelodynePackets>(whole, sensor, {}), some = packets_of<VelodynePackets>(part, sensor, {});
  REQUIRE(all.size() == 6);
  REQUIRE(some.size() == 4);
  for (std::size_t n = 0; n < 4; ++n) CHECK(some[n].payload == all[n + 2].payload);
  for (const std::size_t n : {1u, 3u, 4u})
    for (std::size_t block = 0; block < 12; ++block)
      for (std::size_t byte = 4; byte < 100; ++byte) CHECK(all[n].at<std::uint8_t>(block * 100 + byte) == 0);
  CHECK(all[1].at<std::uint32_t>(1200) == 1327);  // 24 sequences of 55.296 us
}

TEST_CASE("closing twice passes nothing on twice, and a closed stream begins anew") {
  const SpinningSensor sensor = velodyne_vlp_16();
  SensorEchoes all;
  all.add(sensor.source(1), 100, {2.0});
  PacketKeeper kept;
  VelodynePackets packets(sensor, {}, std::ref(kept));
  packets.close();
  CHECK(kept.packets.empty());
  for (int k = 0; k < 2; ++k) {
    Generator any(1);
    all.give(packets, any);
    packets.close();
    packets.close();
  }
  REQUIRE(kept.packets.size() == 2);
  CHECK(kept.packets[0].payload == kept.packets[1].payload);
}

/// Room of 12 m by 8 m by 3 m, with a wide door in front.
struct Room {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    double nearest = 1e9;
    const auto wall = [&](double along, double from, double low, double high) {
      if (along != 0) nearest = std::min(nearest, ((along > 0 ? high : low) - from) / along);
    };
    wall(ray.direction.x, ray.origin.x, -5, 7);
    wall(ray.direction.y, ray.origin.y, -3, 5);
    wall(ray.direction.z, ray.origin.z, -1.2, 1.8);
    const Vec3 at = ray.origin + ray.direction * nearest;
    if (at.y > 4.999 && std::fabs(at.x) < 2) return std::nullopt;
    return Hit{.range = nearest, .backscatter = 0.4};
  }
};

/// Keeps shots and echoes of a run.
struct EchoKeeper {
  SensorEchoes all{};
  void operator()(const EchoBatch& batch) {
    for (Shot shot : batch.shots) {
      const auto echoes = batch.echoes_of(shot);
      shot.first_echo = static_cast<std::uint32_t>(all.echoes.size());
      all.echoes.insert(all.echoes.end(), echoes.begin(), echoes.end());
      all.shots.push_back(shot);
    }
  }
};

TEST_CASE("packets of a survey, run in steps, hold its echoes") {
  const Room room;
  for (const SpinningSensor& sensor : {velodyne_vlp_16(), velodyne_vlp_32c()}) {
    const PacketSettings settings{.start_time = 100};
    const Survey survey{Platform{Tripod{}, Mount{}, sensor.source(0.2)}, SingleRay{}, room, sensor.receiver(),
                        FirstHit{}};
    EchoKeeper truth;
    run(survey, {.threads = 1}, truth);
    PacketKeeper kept;
    VelodynePackets packets(sensor, settings, std::ref(kept));
    for (PulseIndex slot = 0; slot < survey.size(); slot += 7777)
      run(survey, {.threads = 2, .first = slot, .end = slot + 7777}, packets);
    packets.close();
    const std::size_t sequences = static_cast<std::size_t>(survey.size()) / sensor.lasers.size(),
                      each = sensor.lasers.size() == 16 ? 24 : 12;
    CHECK(kept.packets.size() == (sequences + each - 1) / each);
    check_decoded(truth.all, kept.packets, sensor, settings);
  }
}

TEST_CASE("pulses out of order, other sensors and settings out of range are refused") {
  const SpinningSensor sensor = velodyne_vlp_16();
  const auto take = [](const SensorPacket&) {};
  SensorEchoes all;
  for (const PulseIndex slot : {PulseIndex{500}, PulseIndex{500}}) all.add(sensor.source(1), slot, {2.0});
  VelodynePackets packets(sensor, {}, take);
  Generator any(1);
  CHECK_THROWS_WITH_AS(all.give(packets, any), doctest::Contains("Shot::index is 500"), SettingError);

  SpinningSensor other = sensor;
  other.lasers.pop_back();
  CHECK_THROWS_WITH_AS(VelodynePackets(other, {}, take), doctest::Contains("SpinningSensor::lasers"), SettingError);
  other = sensor;
  other.exit_radius = 0.04;
  CHECK_THROWS_WITH_AS(VelodynePackets(other, {}, take), doctest::Contains("SpinningSensor::exit_radius"),
                       SettingError);
  CHECK_THROWS_WITH_AS(VelodynePackets(sensor, {.start_time = -1}, take),
                       doctest::Contains("PacketSettings::start_time"), SettingError);
}

}  // namespace
}  // namespace pulsecast::io
