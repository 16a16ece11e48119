// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/platform/pose_errors.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scanner/any_source.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/scene/media.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/sensor/velodyne.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

using BodyPose = Pose<frame::Body, frame::World>;

/// Pose after so many jumps: another one each time, above the floor.
BodyPose jump(int k) { return {rotation_about(axis::up, 0.7 * k), {3 * std::sin(k), 2.5 * std::cos(2 * k), 2 + std::sin(3 * k)}}; }

/// Trajectory that refers to a pose, which the program sets between runs.
struct Live {
  const BodyPose* pose;
  BodyPose at(Tick) const noexcept { return *pose; }
};
/// As above, in lanes.
struct LiveInLanes {
  const BodyPose* pose;
  BodyPose at(Tick) const noexcept { return *pose; }
  simd::Mask poses(const TickLanes&, PoseLanes<frame::Body, frame::World>& poses) const noexcept {
    poses = PoseLanes(*pose);
    return all_lanes();
  }
};
static_assert(Trajectory<Live> && MovesInLanes<LiveInLanes>);

/// A floor of 100 m, and a wall of 2 m upon it.
std::shared_ptr<const TriangleMesh<>> floor_mesh() {
  return std::make_shared<const TriangleMesh<>>(
      MeshData{.vertices = {{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}}, .triangles = {{0, 1, 2}, {0, 2, 3}}});
}
std::shared_ptr<const TriangleMesh<>> wall_mesh() {
  return std::make_shared<const TriangleMesh<>>(
      MeshData{.vertices = {{6, -1, 0}, {6, 1, 0}, {6, 1, 2}, {6, -1, 2}}, .triangles = {{0, 1, 2}, {0, 2, 3}}});
}
const Scene<TriangleMesh<>> ground({{.geometry = floor_mesh()}, {.geometry = wall_mesh()}});

constexpr PulseIndex slots = 14'000;
const Scanner scanner{.pulse_rate = 10_kHz, .pulses = slots, .laser = {.divergence = 3_mrad}};
const Mount downwards{.lever_arm = {0.1, 0.2, 0.3}, .boresight = rotation_about(axis::right, -40_deg)};
const Deflector mirror{PolygonMirror{.lines_per_second = 50, .sweep = 60_deg, .angle_min = -50_deg, .angle_max = 40_deg}, scanner};

/// The law for a source, whose pose jumps.
template <class Source>
std::string laws_of(const Source& source, BodyPose& pose) {
  return support::change_laws(Survey{source, SingleRay{}, ground, Receiver{}, FirstHit{}}, [&](int k) { pose = jump(k); });
}

}  // namespace

TEST_CASE("a pose that jumps between runs is that of all their pulses, whatever the source") {
  BodyPose pose;
  const Platform platform{Live{&pose}, downwards, mirror};
  CHECK(laws_of(platform, pose) == "");
  CHECK(laws_of(Platform{LiveInLanes{&pose}, downwards, mirror}, pose) == "");
  CHECK(laws_of(Platform{Live{&pose}, downwards, Channels{std::vector{mirror, mirror, mirror}}}, pose) == "");
  CHECK(laws_of(WithPoseErrors{platform, PoseErrors{.position_noise = 1_cm, .angular_jitter = 1_mrad}}, pose) == "");
  CHECK(laws_of(Platform{Live{&pose}, Mount{}, velodyne_vlp_16().source(0.1)}, pose) == "");

  Scanner half = scanner;
  half.pulses = slots / 2;
  const Platform leg{LiveInLanes{&pose}, downwards, Deflector{FixedBeam{}, half}};
  using Either = AnySource<std::remove_const_t<decltype(platform)>, std::remove_const_t<decltype(leg)>>;
  CHECK(laws_of(Legs{std::vector{leg, leg}}, pose) == "");
  CHECK(laws_of(Either{platform}, pose) == "");
  CHECK(laws_of(Legs{std::vector{Either{leg}, Either{platform}}}, pose) == "");
}

TEST_CASE("a map that changes between runs is met by all their pulses, as it then is") {
  BodyPose pose;
  const Survey still{Platform{Live{&pose}, downwards, mirror}, SunflowerFootprint{7}, ground, Receiver{}, FullWaveform{}};
  CHECK(support::change_laws(still, [&](int k) { pose = jump(k); }) == "");

  using World = Scene<TriangleMesh<>>;
  World moving({{.geometry = floor_mesh()}, {.geometry = wall_mesh()}}), unused = moving;
  const Layered world{ground, moving};
  const auto place = [&](int k) {
    const std::vector<Similarity> placements{{no_rotation, 1, {0, 0, 1 + std::sin(k)}}, {jump(k).rotation, 1, {}}};
    World next = moving.with_placements(placements, std::move(unused));
    unused = std::exchange(moving, std::move(next));
  };
  const Platform tripod{Tripod{.position = {0, 0, 4}}, downwards, mirror};
  CHECK(support::change_laws(Survey{tripod, SunflowerFootprint{7}, world, Receiver{}, FullWaveform{}}, place) == "");
  const LightPaths light{
      .scattering = {.orders = 2, .paths = 2}, .air = Media({{.medium = {.scattering = 1e-3, .backscatter = 1e-4}}}), .volume_cells = 256};
  CHECK(support::change_laws(Survey{tripod, SingleRay{}, world, light, Receiver{.range_max = 50}, FullWaveform{}}, place) == "");
}

TEST_CASE("a scene that moves by itself is met from where the pose has jumped, with what the surfaces do then") {
  BodyPose pose;
  const auto motion = std::make_shared<const PartMotion>(SteadyMotion{.velocity = {1, 2, 0}, .rate = 2});
  const MovingScene<TriangleMesh<>> scene({{.geometry = floor_mesh()}, {.geometry = wall_mesh(), .motion = motion}}, {.to = 2});
  CHECK(support::change_laws(Survey{Platform{Live{&pose}, downwards, mirror}, SunflowerFootprint{7}, scene, Receiver{}, FullWaveform{}},
                             [&](int k) { pose = jump(k); }) == "");
}
