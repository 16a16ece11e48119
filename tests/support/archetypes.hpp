// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <pulsecast/concepts.hpp>
#include <pulsecast/transport/transport_input.hpp>

/// The least model of each concept: what a user has to write, and nothing more.
namespace pulsecast::support {

struct LeastOptic {
  Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return {}; }
};

struct LeastHead {
  Pose<frame::Instrument, frame::Instrument> at(Tick) const noexcept { return {}; }
};

struct LeastTrajectory {
  Pose<frame::Body, frame::World> at(Tick) const noexcept { return {}; }
};

/// Ten pulses, one a second, of one emitter.
template <class Frame>
struct LeastSource {
  PulseIndex size() const noexcept { return 10; }
  Tick duration() const noexcept { return {10, 0}; }
  std::vector<Emitter> emitters() const { return std::vector<Emitter>(1); }
  std::optional<Pulse<Frame>> pulse(PulseIndex i) const noexcept {
    Pulse<Frame> p;
    p.tick = {static_cast<std::int64_t>(i), 0};
    return p;
  }
};

/// Offers all primitives to every bundle: the least that keeps the law.
class LeastAccelerator {
 public:
  explicit LeastAccelerator(std::span<const Box> boxes) {
    for (const Box& b : boxes) {
      bounds_.extend(b);
      all_.push_back(static_cast<PrimitiveIndex>(all_.size()));
    }
  }
  const Box& bounds() const noexcept { return bounds_; }
  std::size_t memory() const noexcept { return all_.size() * sizeof(PrimitiveIndex); }
  std::span<const PrimitiveIndex> order() const noexcept { return all_; }
  template <class Test>
  void closest(const RayBundle&, const Test& test, ClosestHits&) const noexcept {
    test(std::span<const PrimitiveIndex>(all_));
  }

 private:
  Box bounds_;
  std::vector<PrimitiveIndex> all_;
};

/// The unit disc about the origin, facing up.
class LeastGeometry {
 public:
  const Box& bounds() const noexcept { return bounds_; }
  std::size_t memory() const noexcept { return 0; }
  std::size_t material_count() const noexcept { return 1; }
  void closest(const RayBundle& rays, ClosestHits& nearest) const noexcept {
    for (std::size_t j = 0; j < rays.size; ++j) {
      const double range = -rays.origin.z / rays.z[j];
      if (!(range > rays.near && range <= rays.far)) continue;
      const Vec3 p = rays.origin + range * rays.direction(j);
      if (p.x * p.x + p.y * p.y <= 1) nearest.offer(j, range, 0);
    }
  }
  SurfaceInteraction surface(PrimitiveIndex, const RayBundle&, std::size_t) const noexcept { return {axis::up, 0}; }

 private:
  Box bounds_{{-1, -1, 0}, {1, 1, 0}};
};

/// The plane z = 0, white, as a map that answers for single rays.
struct LeastRayTarget {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double range = -ray.origin.z / ray.direction.z;
    if (!(range > ray.near && range <= ray.far)) return std::nullopt;
    Hit hit;
    hit.range = range;
    hit.cos_incidence = hit.backscatter = std::fabs(ray.direction.z);
    return hit;
  }
};

/// The same plane, as a map that answers for bundles.
struct LeastBundleTarget {
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    for (std::size_t j = 0; j < rays.size; ++j) hits[j] = LeastRayTarget{}.closest_hit(rays.ray(j)).value_or(Hit{});
  }
};

/// One subray with all the energy.
struct LeastFootprint {
  std::size_t size() const noexcept { return 1; }
  Vec2 offset(std::size_t) const noexcept { return {0, 0}; }
  double share(std::size_t) const noexcept { return 1; }
};

/// Light that meets nothing, whatever is there.
struct LeastTransport {
  struct Workspace {};
  std::size_t reflections(std::size_t) const noexcept { return 0; }
  Workspace workspace(std::size_t) const { return {}; }
  template <class Map>
  TransportResult trace(const Map&, const TransportInput& light, Workspace&, std::span<Reflection>) const noexcept {
    for (SubrayRecord& subray : light.record) subray = {};
    return {.energy = {.sent = light.energy(), .missed = light.energy()}};
  }
};

/// One echo for the nearest reflection.
struct LeastDetector {
  using Workspace = std::array<Echo, 1>;
  Workspace workspace(std::size_t) const { return {}; }
  Detection detect(const DetectorInput& input, Workspace& workspace) const noexcept {
    const Reflection* nearest = nullptr;
    for (const Reflection& r : input.reflections)
      if (!nearest || r.range < nearest->range) nearest = &r;
    if (!nearest) return {};
    workspace[0] = Echo{};
    workspace[0].range = nearest->range;
    workspace[0].amplitude = nearest->power;
    workspace[0].object = nearest->object;
    return {workspace, {}, 0};
  }
};

struct LeastSink {
  void operator()(const EchoBatch&) {}
};

}  // namespace pulsecast::support
