// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <pulsecast/base/frame.hpp>

#include "street.hpp"

/// Physics of cars and robots in the streets: each keeps its lane and speed during a step.
namespace traffic {

using pulsecast::Tick;
using pulsecast::Vec2;
using pulsecast::Vec3;

/// Pose of a vehicle in the world.
using BodyPose = pulsecast::Pose<pulsecast::frame::Body, pulsecast::frame::World>;

/// Vehicle on a lane through the town, at whose end it begins anew.
struct Vehicle {
  Vec2 from{}, along{};  ///< begin [m] and direction of its lane
  double way = 0;        ///< driven since the begin [m]
  double speed = 0;      ///< [m/s]
  double time = 0;       ///< start of the step [s]
  BodyPose pose{};       ///< at that time

  /// Drives on to a time [s], at which the next step begins.
  void begin_step(double now) {
    way = std::fmod(way + speed * (now - time), 2 * street::half_size.x);
    time = now;
    const Vec2 at = from + way * along;
    pose = {pulsecast::level(pulsecast::heading_of({along.x, along.y, 0})), {at.x, at.y, street::height(at)}};
  }

  /// Pose at a time in the step.
  [[nodiscard]] BodyPose at(double seconds) const noexcept {
    return {pose.rotation, pose.position + (seconds - time) * speed * Vec3{along.x, along.y, 0}};
  }
};

/// Trajectory of a vehicle in the current step: the physics sets the vehicle between the runs, and the runs read it.
struct LivePath {
  const Vehicle* vehicle;  ///< must outlive the survey, and stay where it is

  [[nodiscard]] BodyPose at(Tick t) const noexcept { return vehicle->at(t.seconds()); }
};
static_assert(pulsecast::Trajectory<LivePath>);

/// Cars in both directions of both streets.
[[nodiscard]] inline std::vector<Vehicle> cars(std::size_t count, street::Dice dice) {
  std::vector<Vehicle> all;
  for (std::size_t k = 0; k < count; ++k) {
    const double sign = k % 4 < 2 ? 1 : -1, half = sign * street::half_size.x;
    const Vec2 north{0, sign}, east{sign, 0};
    Vehicle car = k % 2 == 0 ? Vehicle{{1.9 * sign, -half}, north} : Vehicle{{-half, -1.9 * sign}, east};
    car.way = dice.between(0, 2 * street::half_size.x);
    car.speed = dice.between(5, 13);
    car.begin_step(0);
    all.push_back(car);
  }
  return all;
}

/// Scene of cars, one a vehicle, at places of their own.
[[nodiscard]] inline street::Scene scene_of(const std::vector<Vehicle>& cars) {
  const street::Scene::Part car{std::make_shared<const street::Mesh>(street::car()),
                                pulsecast::material_table(street::materials()),
                                {},
                                0,
                                "car",
                                {}};
  std::vector<street::Scene::Part> parts(cars.size(), car);
  for (std::size_t k = 0; k < parts.size(); ++k) parts[k].object = static_cast<pulsecast::ObjectId>(1000 + k);
  return street::Scene(parts);
}

/// Placements of the cars at a time in the step [s].
inline void place(const std::vector<Vehicle>& cars, double seconds, std::vector<pulsecast::Placement>& placements) {
  placements.resize(cars.size());
  for (std::size_t k = 0; k < cars.size(); ++k) {
    const BodyPose pose = cars[k].at(seconds);
    placements[k] = {pose.rotation, 1, pose.position};
  }
}

}  // namespace traffic
