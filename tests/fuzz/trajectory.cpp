// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/io/trajectory.hpp>

#include <cmath>
#include <cstddef>

#include <pulsecast/platform/waypoints.hpp>

#include "fuzz/fuzz.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

namespace {

void check(const TrajectoryTable& table) {
  fuzz::expect(!table.poses.empty() && table.poses.front().time == 0);
  for (std::size_t i = 0; i < table.poses.size(); ++i) {
    const TimedPose& pose = table.poses[i];
    fuzz::expect(i == 0 || pose.time >= table.poses[i - 1].time);
    fuzz::expect(std::fabs(table.start_time + pose.time) <= 1.000001e12 && max_norm(pose.position) <= 1e12);
    fuzz::expect(std::fabs(length(pose.rotation) - 1) <= 1e-9);
  }
  const Waypoints path(table.poses);
  for (const double share : {0.0, 0.3, 1.0}) {
    const auto pose = path.at(Tick::of_seconds(share * path.duration().seconds()));
    fuzz::expect(finite(pose.position) && std::fabs(length(pose.rotation) - 1) <= 1e-9);
  }
}

}  // namespace

/// What can be read moves a platform, and can be written and read again, unless its times are too close to each other
/// to be told apart.
FUZZ_TARGET(trajectory) {
  const std::filesystem::path path = fuzz::file(data, size, "flight.txt"), again = path.parent_path() / "again.txt";
  for (const TrajectoryFormat& format : {csv_format(), helios_format(), helios_output_format(), tum_format()})
    fuzz::may_refuse([&] {
      const TrajectoryTable table = read_trajectory(path, format);
      fuzz::expect(table.poses.size() <= size);
      check(table);
      write_trajectory(again, table.poses, format, table.start_time);
      const TrajectoryTable same = read_trajectory(again, format);
      check(same);
      fuzz::expect(same.poses.size() <= table.poses.size());
    });
  fuzz::may_refuse([&] { check(read_trajectory(path, csv_format(), {.start = 1, .end = 2.5})); });
}
