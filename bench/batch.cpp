// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Batches of poses: 4,096 sensors of 2,000 rays each in a street of some 50,000 triangles. Prints the median time of a batch on all
// threads.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <vector>

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scene/run_batch.hpp>

#include "scenes.hpp"

using namespace bench;

namespace {

/// 16 rays from 15° below to 15° above the horizon, at each of 125 azimuths.
std::vector<Ray> lidar() {
  std::vector<Ray> rays;
  for (int column = 0; column < 125; ++column)
    for (int channel = 0; channel < 16; ++channel) {
      const Rotation turn = rotation_about(axis::up, 2 * pi * column / 125) * rotation_about(axis::right, 2_deg * (channel - 7.5));
      rays.push_back({.direction = turn * axis::forward});
    }
  return rays;
}

/// Poses along both streets, 1.8 m above the ground, with headings all around.
std::vector<Pose<frame::Instrument, frame::World>> places(std::size_t count) {
  std::vector<Pose<frame::Instrument, frame::World>> all;
  for (std::size_t p = 0; p < count; ++p) {
    const double along = -60 + 120 * static_cast<double>(p) / static_cast<double>(count);
    const Vec2 at = p % 2 == 0 ? Vec2{2, along} : Vec2{along, 2};
    all.push_back({rotation_about(axis::up, 0.37 * static_cast<double>(p)), street::on(at) + Vec3{0, 0, 1.8}});
  }
  return all;
}

}  // namespace

int main() {
  const street::Scene scene = street::scene(1);
  const std::vector<Ray> rays = lidar();
  const auto poses = places(4096);
  std::vector<float> ranges(poses.size() * rays.size());
  std::vector<double> seconds;
  for (int round = 0; round < 5; ++round) {
    const auto began = std::chrono::steady_clock::now();
    run_batch(scene, poses, rays, ranges);
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
  }
  std::sort(seconds.begin(), seconds.end());
  const auto met = std::count_if(ranges.begin(), ranges.end(), [](float range) { return std::isfinite(range); });
  std::printf("%zu poses of %zu rays: %.2f s, %.2f million rays a second on %u threads; %.1f %% meet something\n", poses.size(),
              rays.size(), seconds[2], static_cast<double>(ranges.size()) / seconds[2] / 1e6, thread_count(0),
              100 * static_cast<double>(met) / static_cast<double>(ranges.size()));
}
