// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <mutex>
#include <vector>

#include <doctest/doctest.h>
#include <pcl/io/vlp_grabber.h>

#include <pulsecast/io/pcap.hpp>
#include <pulsecast/io/velodyne_packets.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include "support/packets.hpp"
#include "support/temporary_folder.hpp"

// PCL's grabber of VLP-16 packets differs from the manual: it knows no heights of lasers; all firings of a sequence
// have one azimuth, that of the sequence's begin; and the azimuth of the second sequence of a block is half a gap
// later, by the packet's first gap, cut to 0.01 degree. It tells a sweep when azimuths wrap, and so never the last one.

namespace pulsecast::io {
namespace {

using support::SensorEchoes;

using Sweep = pcl::PointCloud<pcl::PointXYZI>::ConstPtr;

/// First sweeps of a capture file, as many. The grabber runs in threads of its own, and does not say when it has come
/// to the end of the file.
std::vector<Sweep> sweeps_of(const std::filesystem::path& path, std::size_t count) {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<Sweep> sweeps;
  pcl::VLPGrabber grabber(path.string());
  const std::function<pcl::HDLGrabber::sig_cb_velodyne_hdl_sweep_point_cloud_xyzi> take = [&](const Sweep& sweep) {
    const std::lock_guard lock(mutex);
    sweeps.push_back(sweep);
    changed.notify_one();
  };
  grabber.registerCallback(take);
  grabber.start();
  {
    std::unique_lock lock(mutex);
    REQUIRE(changed.wait_for(lock, std::chrono::minutes(2), [&] { return sweeps.size() >= count; }));
  }
  grabber.stop();
  return sweeps;
}

/// Point as the grabber tells it.
struct Expected {
  std::size_t sweep;
  double azimuth, elevation, range, intensity;  // [deg, deg, m]
  bool is_second;                               // of a block's two sequences
};

Expected expected_of(const Shot& shot, const Echo& echo, const SpinningSensor& sensor) {
  const PulseIndex sequence = shot.index / 16;
  const Tick start = sensor.sequence_start(sequence);
  return {static_cast<std::size_t>(sensor.rotation_rate * start.seconds()),
          sensor.heading(start) * 180 / pi,
          sensor.lasers[shot.index % 16].elevation * 180 / pi,
          echo.range,
          100 * echo.reflectance,
          sequence % 2 == 1};
}

void check(const pcl::PointXYZI& point, const Expected& expected) {
  const double level = std::hypot(double{point.x}, double{point.y}), range = std::hypot(level, double{point.z});
  CHECK(std::fabs(range - expected.range) <= 0.001 + 2e-5);  // half of a step; its numbers have 24 bits
  const double off = std::atan2(double{point.x}, double{point.y}) * 180 / pi - expected.azimuth;
  const double azimuth_error = off - 360 * std::round(off / 360);
  // half of a step; of a second sequence, half of the gap's rounding more, and less by up to one step that is cut off
  CHECK(azimuth_error <= (expected.is_second ? 0.01 : 0.005) + 1e-5);
  CHECK(azimuth_error >= (expected.is_second ? -0.02 : -0.005) - 1e-5);
  CHECK(std::fabs(std::asin(double{point.z} / range) * 180 / pi - expected.elevation) < 1e-5);
  CHECK(std::fabs(double{point.intensity} - expected.intensity) <= 0.5 + 1e-5);
}

TEST_CASE("PCL reads the points of a VLP-16 from a capture file, sweep by sweep") {
  for (const bool nanoseconds : {false, true}) {
    const support::TemporaryFolder folder;
    const SpinningSensor sensor = velodyne_vlp_16(20);
    support::Generator any(11);
    SensorEchoes all = SensorEchoes::any(sensor.source(1), 0, 16 * 2 * 3000, 1, any);  // some 6.6 sweeps
    PcapWriter file(folder / "vlp16.pcap", {.nanoseconds = nanoseconds});
    VelodynePackets packets(sensor, {}, std::ref(file));
    all.give(packets, any);
    packets.close();
    file.close();
    const auto sweeps = sweeps_of(folder / "vlp16.pcap", 6);
    REQUIRE(sweeps.size() == 6);
    std::vector<Expected> expected;
    for (const Shot& shot : all.shots)
      for (const Echo& echo : all.of(shot)) expected.push_back(expected_of(shot, echo, sensor));
    std::size_t told = 0;
    for (std::size_t n = 0; n < sweeps.size(); ++n)
      for (const pcl::PointXYZI& point : *sweeps[n]) {
        REQUIRE(told < expected.size());
        CHECK(expected[told].sweep == n);
        check(point, expected[told++]);
      }
    std::size_t whole = 0;
    for (const Expected& point : expected) whole += point.sweep < 6 ? 1 : 0;
    CHECK(told == whole);
    CHECK(told > 20'000);
  }
}

TEST_CASE("PCL reads dual returns of a VLP-16, the last first, and one that is both once") {
  const support::TemporaryFolder folder;
  const SpinningSensor sensor = velodyne_vlp_16(20);
  support::Generator any(12);
  const SensorEchoes all = SensorEchoes::any(sensor.source(1), 0, 16 * 2000, 3, any);
  PcapWriter file(folder / "vlp16.pcap");
  VelodynePackets packets(sensor, {.returns = PacketReturns::dual}, std::ref(file));
  all.give(packets, any);
  packets.close();
  file.close();
  const auto sweeps = sweeps_of(folder / "vlp16.pcap", 2);
  REQUIRE(sweeps.size() == 2);
  std::size_t told = 0;
  std::vector<pcl::PointXYZI> points;
  for (const auto& sweep : sweeps) points.insert(points.end(), sweep->begin(), sweep->end());
  for (const Shot& shot : all.shots) {
    if (shot.echoes == 0 || told == points.size()) continue;
    const auto echoes = all.of(shot);
    const auto sorted = support::by_strength(echoes);
    check(points[told++], expected_of(shot, echoes.back(), sensor));
    const Echo& other = sorted[sorted.front().range == echoes.back().range && sorted.size() > 1 ? 1 : 0];
    const auto steps = [](const Echo& echo) { return std::lround(echo.range / 0.002); };
    if (steps(other) == steps(echoes.back())) continue;
    REQUIRE(told < points.size());
    check(points[told++], expected_of(shot, other, sensor));
  }
  CHECK(told == points.size());
  CHECK(told > 10'000);
}

}  // namespace
}  // namespace pulsecast::io
