// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/material/media.hpp>
#include <pulsecast/platform/pose_errors.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/scanner/any_source.hpp>
#include <pulsecast/scene/layered.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/sensor/velodyne.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

using BodyPose = Pose<frame::Body, frame::World>;

/// Pose after so many jumps: another one each time, above the floor.
BodyPose jump(int k) {
  return {rotation_about(axis::up, 0.7 * k), {3 * std::sin(k), 2.5 * std::cos(2 * k), 2 + std::sin(3 * k)}};
}

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
  return std::make_shared<const TriangleMesh<>>(MeshData{
      .vertices = {{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}}, .triangles = {{0, 1, 2}, {0, 2, 3}}});
}
std::shared_ptr<const TriangleMesh<>> wall_mesh() {
  return std::make_shared<const TriangleMesh<>>(
      MeshData{.vertices = {{6, -1, 0}, {6, 1, 0}, {6, 1, 2}, {6, -1, 2}}, .triangles = {{0, 1, 2}, {0, 2, 3}}});
}
const Scene<TriangleMesh<>> ground({{.geometry = floor_mesh()}, {.geometry = wall_mesh()}});

constexpr PulseIndex slots = 5002;
const Scanner scanner{.pulse_rate = 10_kHz, .pulses = slots, .laser = {.divergence = 3_mrad}};
const Mount downwards{.lever_arm = {0.1, 0.2, 0.3}, .boresight = rotation_about(axis::right, -40_deg)};
const Deflector mirror{PolygonMirror{.line_rate = 50, .sweep = 60_deg, .angle_min = -50_deg, .angle_max = 40_deg},
                       scanner};

/// The law for a source, whose pose jumps.
template <class Source>
std::string laws_of(const Source& source, BodyPose& pose) {
  return support::change_laws(Survey{source, SingleRay{}, ground, Receiver{}, FirstHit{}},
                              [&](int k) { pose = jump(k); });
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
  const Survey still{Platform{Live{&pose}, downwards, mirror}, SunflowerFootprint{7}, ground, Receiver{},
                     FullWaveform{}};
  CHECK(support::change_laws(still, [&](int k) { pose = jump(k); }) == "");

  using World = Scene<TriangleMesh<>>;
  World moving({{.geometry = floor_mesh()}, {.geometry = wall_mesh()}}), unused = moving;
  const Layered world{ground, moving};
  const auto place = [&](int k) {
    const std::vector<Placement> placements{{no_rotation, 1, {0, 0, 1 + std::sin(k)}}, {jump(k).rotation, 1, {}}};
    World next = moving.with_placements(placements, std::move(unused));
    unused = std::exchange(moving, std::move(next));
  };
  const Platform tripod{Tripod{.position = {0, 0, 4}}, downwards, mirror};
  CHECK(support::change_laws(Survey{tripod, SunflowerFootprint{7}, world, Receiver{}, FullWaveform{}}, place) == "");
  const LightPaths light{.scattering = {.orders = 2, .paths = 2},
                         .air = Media({{.medium = {.scattering = 1e-3, .backscatter = 1e-4}}}),
                         .volume_cells = 256};
  CHECK(support::change_laws(Survey{tripod, SingleRay{}, world, light, Receiver{.range_max = 50}, FullWaveform{}},
                             place) == "");
}

TEST_CASE("a scene that moves by itself is met from where the pose has jumped, with what the surfaces do then") {
  BodyPose pose;
  const auto motion = std::make_shared<const PartMotion>(SteadyMotion{.velocity = {1, 2, 0}, .angular_rate = 2});
  const MovingScene<TriangleMesh<>> scene({{.geometry = floor_mesh()}, {.geometry = wall_mesh(), .motion = motion}},
                                          {.to = 2});
  CHECK(support::change_laws(
            Survey{Platform{Live{&pose}, downwards, mirror}, SunflowerFootprint{7}, scene, Receiver{}, FullWaveform{}},
            [&](int k) { pose = jump(k); }) == "");
}

namespace {

/// Rangefinder at 100 Hz that looks along x towards a wall at 100 m, from where the program has driven it.
struct Rangefinder {
  BodyPose pose{rotation_about(axis::up, -90_deg), {}};
  Scene<TriangleMesh<>> wall{
      {{.geometry = std::make_shared<const TriangleMesh<>>(
            MeshData{.vertices = {{100, -9, -9}, {100, 9, -9}, {100, 0, 9}}, .triangles = {{0, 1, 2}}})}}};
  Platform<Live, Deflector<FixedBeam, Scanner>> platform{
      Live{&pose}, Mount{}, {FixedBeam{}, {.pulse_rate = 100_Hz, .pulses = 1000}}};
  Survey<decltype(platform), SingleRay, Scene<TriangleMesh<>>, FirstHit> survey{platform, SingleRay{}, wall, Receiver{},
                                                                                FirstHit{}};
};

/// A survey of a user's: only what a run requires.
template <class Of>
struct LeastSurvey {
  const Of& of;
  PulseIndex size() const noexcept { return of.size(); }
  std::size_t subrays() const noexcept { return of.subrays(); }
  std::size_t recorded_subrays() const noexcept { return 0; }
  double sample_interval() const noexcept { return 0; }
  auto workspace() const { return of.workspace(); }
  Outcome operator()(PulseIndex i, typename Of::Workspace& w) const noexcept { return of(i, w); }
};

}  // namespace

TEST_CASE(
    "a rangefinder that drives 2 m a step reads 100, 98, 96 and so on, by runs and by single calls, step by step or "
    "slot 0 again") {
  Rangefinder r;
  const LeastSurvey<decltype(r.survey)> least{r.survey};
  static_assert(PulseSurvey<decltype(least)> && !SimulatesInOrder<decltype(least)> &&
                SimulatesInOrder<decltype(r.survey)>);
  ThreadPool pool(2);
  auto workspace = r.survey.workspace();
  for (int time = 0; time < 5; ++time)
    for (const bool again : {false, true})
      for (PulseIndex step = 0; step < 45; ++step) {
        const PulseIndex slot = again ? 0 : step;
        r.pose.position.x = 2 * static_cast<double>(step);
        std::vector<double> read;
        const auto add = [&](const EchoBatch& batch) {
          for (const Echo& echo : batch.echoes) read.push_back(echo.range);
        };
        run(r.survey, {.executor = pool, .first = slot, .end = slot + 1}, add);
        run(r.survey, {.threads = 1, .first = slot, .end = slot + 1}, add);
        run(least, {.executor = pool, .first = slot, .end = slot + 1}, add);
        read.push_back(r.survey(slot, workspace).echoes[0].range);
        REQUIRE(read.size() == 4);
        for (const double range : read)
          REQUIRE(range == doctest::Approx(100 - 2 * static_cast<double>(step)).epsilon(1e-12));
      }
}

TEST_CASE("no pulse of a VLP-16 that jumps between 600 runs leaves from an older place") {
  const SpinningSensor sensor = velodyne_vlp_16();
  BodyPose pose;
  const Platform platform{Live{&pose}, Mount{}, sensor.source(600 / 60.0 + 1)};
  const Survey survey{platform, SingleRay{}, ground, sensor.receiver(), FirstHit{}};
  ThreadPool pool(2);
  PulseIndex slot = 0;
  std::size_t pulses = 0, stale = 0;
  for (std::size_t step = 0; step < 600; ++step) {
    pose.position = {50.0 * static_cast<double>(step % 7), 0, 2};
    const PulseIndex end = sensor.slot_from(Tick::of(step + 1, 60));
    run(survey, {.executor = pool, .first = std::exchange(slot, end), .end = end}, [&](const EchoBatch& batch) {
      pulses += batch.shots.size();
      for (const Shot& shot : batch.shots) stale += length(shot.origin - pose.position) > 1;
    });
  }
  CHECK(pulses > 2'800'000);
  CHECK(stale == 0);
}
