// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/make_simulation.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/accuracy.hpp>
#include <pulsecast/cloud.hpp>
#include <pulsecast/helios/scene.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/material/weather.hpp>
#include <pulsecast/run.hpp>

#include "support/laws.hpp"
#include "support/relative.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::helios {
namespace {

constexpr double height = 10;  // of the instrument above the plane [m]

/// A tripod, whose mirror sweeps to 50 degrees on either side of straight down, for two seconds at 1 kHz.
SurveySettings survey() {
  SurveySettings s;
  s.name = "plane";
  s.scanner.id = "mirror";
  s.scanner.pulse_rates = {1000};
  s.scanner.channels = {{.optic = RotatingOptic{}, .scan_angle_max = radians(50), .head_rate_max = radians(360)}};
  s.platform.mount.rotation = {{{Axis::x, radians(-90)}}};
  LegSettings leg;
  leg.platform.position = {0, 0, height};
  leg.scanner.scan_rate = 10;
  leg.duration_max = 2;
  s.legs = {leg};
  return s;
}

/// A square of 200 m at z = 0.
Simulation::Mesh plane() {
  return {.data = {.vertices = {{-100, -100, 0}, {100, -100, 0}, {100, 100, 0}, {-100, 100, 0}},
                   .triangles = {{0, 1, 2}, {0, 2, 3}}},
          .object = 7};
}

Cloud run(const Simulation& simulation, unsigned threads = 1) {
  Cloud cloud;
  pulsecast::run(simulation.survey(), {.threads = threads}, cloud);
  return cloud;
}

double farthest_from_plane(const Cloud& cloud) {
  double most = 0;
  for (const Vec3& p : cloud.points) most = std::max(most, std::fabs(p.z));
  return most;
}

TEST_CASE("each pulse that points down at a plane has one echo on it, on any number of threads") {
  const auto simulation = make_simulation(survey(), {.meshes = {plane()}});
  REQUIRE(simulation->compiled().source.size() == 2000);
  CHECK(simulation->repetitions() == 1);
  CHECK(simulation->warnings().empty());
  const Simulation::Scene scene = simulation->scene();
  CHECK_FALSE(scene.empty);
  CHECK(scene.parts == 1);
  CHECK(scene.moving == 0);
  CHECK(scene.triangles == 2);
  CHECK(scene.max == Vec3{100, 100, 0});
  const Cloud cloud = run(*simulation);
  CHECK(cloud.size() == 2000);
  CHECK(farthest_from_plane(cloud) < 0.05);  // obliquely, the echo of a footprint comes from before its middle
  CHECK(std::all_of(cloud.echoes.begin(), cloud.echoes.end(), [](const Echo& e) { return e.object == 7; }));
  const Cloud same = run(*simulation, 3);
  CHECK(same.points == cloud.points);
}

TEST_CASE("a leg that stays farther from the scene than the scanner measures gets a note") {
  SurveySettings s = survey();
  const auto notes = [&](double from, double range_max, double power) {
    s.legs[0].platform.position.z = from;
    s.scanner.channels[0].range_max = range_max;
    s.scanner.channels[0].average_power = power;
    return make_simulation(s, {.meshes = {plane()}})->warnings();
  };
  CHECK(notes(29, 30, 4).empty());
  REQUIRE(notes(31, 30, 4).size() == 1);
  CHECK(notes(31, 30, 4)[0].find("leg 0 is at least 31 m from the scene, and the scanner measures up to 30 m") == 0);
  // P D^2 eta / (4 R^2) is the threshold of 1e-13 W at 236 m, without the air's loss
  CHECK(notes(220, 1e9, 1e-6).empty());
  CHECK(notes(245, 1e9, 1e-6).size() == 1);
}

TEST_CASE("ideal receivers have no noise, and those of the survey keep it") {
  SurveySettings s = survey();
  s.scanner.channels[0].accuracy = 1;
  const auto simulation = make_simulation(s, {.seed = 3, .meshes = {plane()}});
  const Cloud noisy = run(*simulation);
  CHECK(farthest_from_plane(noisy) > 1);
  const auto ideal = simulation->with_receivers({.rings = 1, .ideal = true});
  CHECK(farthest_from_plane(run(*ideal)) < 0.05);
  CHECK(run(*simulation).points == noisy.points);
  CHECK(run(*ideal->with_receivers({})).points == noisy.points);
}

TEST_CASE("errors of a run are told apart: noise of ranges is the instrument's, late peaks of slopes the estimator's") {
  SurveySettings s = survey();
  s.scanner.channels[0].accuracy = 0.1;
  const auto errors = [&](bool library_physics, const ReceiverOverrides& overrides) {
    return make_simulation(s, {.seed = 3, .library_physics = library_physics, .meshes = {plane()}})
        ->with_receivers(overrides)
        ->errors({.clusters = 1000, .threads = 1});
  };
  const auto range = [](const RunErrors& e, std::size_t part) {
    return e.parts[part].all[ErrorFigure::range_68].value;
  };
  const RunErrors noisy = errors(false, {});
  CHECK(noisy.slots == 2000);
  CHECK(noisy.subrays >= 2000);
  REQUIRE(noisy.parts.size() == 4);
  CHECK(range(noisy, 0) < 1e-3);
  CHECK(range(noisy, 1) < 1e-9);  // the survey knows true ranges, too
  CHECK(range(noisy, 2) == support::relative(0.1, 0.05));
  CHECK(noisy.parts[3].name == "together");
  CHECK(range(noisy, 3) == support::relative(0.1, 0.05));
  const RunErrors peaks = errors(true, {.ideal = true});
  CHECK(range(peaks, 1) > 1e-8);
  CHECK(range(peaks, 2) == 0);
  CHECK(range(errors(false, {.rings = 1, .ideal = true}), 0) > 1.5 * range(noisy, 0));
}

TEST_CASE("an accuracy asked for is kept on a fence, where a single ray loses echoes, and no ring costs less") {
  MeshData slats;  // 5 cm wide, every 25 cm, 1 m above the plane
  for (int k = -40; k < 40; ++k) {
    const auto first = static_cast<std::uint32_t>(slats.vertices.size());
    const double x = 0.25 * k;
    slats.vertices.insert(slats.vertices.end(), {{x, -60, 1}, {x + 0.05, -60, 1}, {x + 0.05, 60, 1}, {x, 60, 1}});
    slats.triangles.insert(slats.triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
  }
  SurveySettings s = survey();
  s.scanner.channels[0].divergence = 5e-3;
  const auto simulation = make_simulation(s, {.seed = 3, .meshes = {plane(), {.data = slats}}});
  const auto lost = [&](const ReceiverOverrides& of) {
    ReceiverOverrides settings = of;
    settings.ideal = true;
    return simulation->with_receivers(settings)
        ->errors({.seed = 9, .clusters = 100'000})
        .parts.front()
        .all[ErrorFigure::lost]
        .value;
  };
  CHECK(lost({.rings = 1}) > 0.05);
  const SettingsChoice choice = simulation->choose({.range = 0.01, .echoes = 0.02}, {.seed = 1});
  CHECK(choice.reached);
  CHECK(choice.subrays >= 2000);
  const auto chosen = ReceiverOverrides::of(choice.values);
  REQUIRE(*chosen.rings > 1);
  CHECK(lost(chosen) <= 0.02);
  CHECK(lost({.rings = *chosen.rings - 1}) > 0.02);
  CHECK(!simulation->choose({.range = 1e-12}, {.clusters = 100}).reached);
  CHECK_THROWS_AS((void)simulation->choose({.range = -1}, {}), SettingError);
}

TEST_CASE("a repetition draws noise of its own, and a receiver without rings has its central ray") {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "wall.obj") << "v -5 50 0\nv 5 50 0\nv 0 50 9\nf 1 2 3\n";
  SurveySettings s = survey();
  s.scanner.channels[0].accuracy = 1;
  PartSettings part{.id = "1", .source = ObjSource{.files = {folder / "wall.obj"}}};
  part.swaps.push_back({.removes = true});
  s.scene.parts = {part};
  const auto simulation = make_simulation(s, {.seed = 3, .meshes = {plane()}});
  REQUIRE(simulation->repetitions() == 2);
  const Cloud first = run(*simulation);
  const auto second = simulation->repetition(1);
  CHECK(run(*second).points != first.points);
  CHECK(second->scene().parts == 1);
  CHECK(run(*simulation).points == first.points);
  CHECK(run(*second->repetition(0)).points == first.points);
  const RunSummary summary = pulsecast::run(simulation->with_receivers({.rings = 0})->survey(), {});
  CHECK(summary.rays == summary.pulses());
}

TEST_CASE("surveys and colours outlive their simulation") {
  auto simulation = make_simulation(survey(), {.seed = 3, .meshes = {plane()}});
  const Cloud before = run(*simulation);
  const AnySurvey kept = simulation->survey();
  const PointColours colours = simulation->points().colours;
  simulation.reset();
  std::size_t coloured = 0;
  Cloud after;
  pulsecast::run(kept, {.threads = 2}, after, [&](const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) coloured += colours(batch, shot, echo) ? 1 : 0;
  });
  CHECK(after.points == before.points);
  CHECK(coloured == after.size());
}

TEST_CASE("points of a survey state the errors that it says: accuracy, noise of the platform, a wrong mount") {
  SurveySettings s = survey();
  s.scanner.channels[0].accuracy = 0.01;
  s.platform.position_noise[2] = NoiseSettings{.deviation = 0.03};
  s.platform.attitude_noise[0] = NoiseSettings{.mean = 1e-3, .deviation = 2e-3, .lifespan = 10};
  const auto simulation = make_simulation(s, {.seed = 5, .uncertainty = true, .meshes = {plane()}});
  CHECK(!make_simulation(s, {.meshes = {plane()}})->points().uncertainty);
  const UncertaintyQuery uncertainty = simulation->points().uncertainty;
  REQUIRE(uncertainty);
  double squares = 0, stated = 0;
  std::size_t points = 0, promised = 0;
  pulsecast::run(simulation->survey(), {.threads = 1}, [&](const EchoBatch& batch) {
    for (const Shot& shot : batch.shots)
      for (const Echo& echo : batch.echoes_of(shot)) {
        const PointUncertainty u = uncertainty(shot, echo);
        const Vec3 right{1, 0, 0}, beam = echo.range * shot.direction;  // about which the beam is turned
        const Vec3 turned = cross(right, beam);
        CHECK(u.random.zz == doctest::Approx(0.03 * 0.03 + 0.01 * 0.01 * shot.direction.z * shot.direction.z));
        CHECK(u.systematic.zz == doctest::Approx(5e-6 * turned.z * turned.z).epsilon(0.02));
        squares += point_of(shot, echo).z * point_of(shot, echo).z;
        stated += u.total().zz;
        promised += u.flags == 0 ? 1 : 0;
        ++points;
      }
  });
  CHECK(squares / stated == doctest::Approx(1).epsilon(0.15));
  CHECK(promised == points);
}

TEST_CASE("points have the laser of their channel, for columns in photons") {
  SurveySettings s = survey();
  s.scanner.channels.push_back(s.scanner.channels[0]);
  s.scanner.channels[1].wavelength = 532e-9;
  s.scanner.channels[1].pulse_length = 1e-9;
  const std::vector<Laser> lasers = make_simulation(s, {.meshes = {plane()}})->points().lasers;
  REQUIRE(lasers.size() == 2);
  CHECK((lasers[0].wavelength == 1064e-9 && lasers[0].pulse_length == 4e-9));
  CHECK((lasers[1].wavelength == 532e-9 && lasers[1].pulse_length == 1e-9));
}

TEST_CASE("warnings of other receivers belong to their simulation") {
  const auto simulation = make_simulation(survey(), {.waveforms = true, .las_waveforms = true, .meshes = {plane()}});
  CHECK(simulation->warnings().empty());
  CHECK(simulation->with_receivers({.bin_size = 0.2505e-9})->warnings().size() == 1);
  CHECK(simulation->warnings().empty());
}

TEST_CASE("waveform noise has a quarter of the least received power as its deviation") {
  SurveySettings s = survey();
  s.legs[0].duration_max = 0.1;
  const auto simulation =
      make_simulation(s, {.seed = 3, .waveforms = true, .waveform_noise = true, .meshes = {plane()}});
  const double probable_error =
      0.6745 * 0.25 * s.scanner.channels[0].received_power_min;  // half of normal draws are within it
  std::size_t all = 0, within = 0;
  pulsecast::run(simulation->survey(), {}, [&](const EchoBatch& batch) {
    all += batch.samples.size();
    for (const float sample : batch.samples) within += std::fabs(static_cast<double>(sample)) < probable_error ? 1 : 0;
  });
  REQUIRE(all > 100'000);  // hardly any of which an echo reaches
  CHECK(static_cast<double>(within) / static_cast<double>(all) == doctest::Approx(0.5).epsilon(0.03));
}

TEST_CASE("waveforms are sampled and cut as LAS can hold them, with a warning for each") {
  SurveySettings s = survey();
  s.scanner.channels[0].waveform.bin_size = 0.2505e-9;
  const auto odd = [&](const Simulation::Settings& settings) { return make_simulation(s, settings)->warnings(); };
  CHECK(odd({.waveforms = true, .meshes = {plane()}}).empty());
  REQUIRE(odd({.waveforms = true, .las_waveforms = true, .meshes = {plane()}}).size() == 1);
  CHECK(odd({.waveforms = true, .las_waveforms = true, .meshes = {plane()}})[0] ==
        "survey 'plane': binSize_ns is 0.2505, and samples in LAS are whole picoseconds apart: it is taken as 0.25");
  s.scanner.channels[0].waveform.bin_size = 0.01e-9;
  const std::vector<std::string> cut =
      odd({.waveforms = true, .las_waveforms = true, .meshes = {plane()}, .place = "a.xml:9:3"});
  REQUIRE(cut.size() == 1);
  CHECK(cut[0].starts_with("a.xml:9:3: waveforms are cut after "));
  CHECK(cut[0].find("the maximum of LAS") != std::string::npos);
}

TEST_CASE("channels of different bins are sampled by the smallest") {
  SurveySettings s = survey();
  s.scanner.channels.push_back(s.scanner.channels[0]);
  s.scanner.channels[1].waveform.bin_size = 0.5e-9;
  const auto simulation = make_simulation(s, {.meshes = {plane()}});
  REQUIRE(simulation->warnings().size() == 1);
  CHECK(simulation->warnings()[0] ==
        "scanner 'mirror': its channels have bins of different size; all are sampled by the smallest");
  CHECK(run(*simulation).size() == 4000);
}

TEST_CASE("a provider may give parts that were made before, and what it gives counts") {
  const support::TemporaryFolder folder;
  std::ofstream(folder / "wall.obj") << "v -5 0 0\nv 5 0 0\nv 0 0 9\nf 1 2 3\n";
  SurveySettings s = survey();
  PartSettings part{.id = "1", .source = ObjSource{.files = {folder / "wall.obj"}}};
  part.swaps.push_back({.removes = true});
  s.scene.parts = {part};
  std::vector<int> runs;
  std::size_t built = 0;
  const PartProvider provider = [&](int run, const std::function<BuiltParts()>& build) {
    runs.push_back(run);
    BuiltParts parts = build();
    built = parts.parts.size();
    parts.warnings = {"odd"};
    return run == 0 ? parts : BuiltParts{};
  };
  const auto simulation = make_simulation(s, {.meshes = {plane()}}, provider);
  CHECK(simulation->repetitions() == 2);
  CHECK(built == 1);
  CHECK(simulation->scene().parts == 2);
  CHECK(simulation->warnings() == std::vector<std::string>{"odd"});
  const auto second = simulation->repetition(1);
  CHECK(runs == std::vector<int>{0, 1});
  CHECK(built == 0);
  CHECK(second->scene().parts == 1);
  CHECK(second->warnings().empty());
  CHECK(simulation->scene().parts == 2);
  CHECK(simulation->warnings() == std::vector<std::string>{"odd"});
  (void)simulation->with_receivers({.rings = 1});
  CHECK(runs.size() == 2);  // the scene is shared
}

TEST_CASE("light goes on from what passes it on, if the scene or the program says so, and else does not") {
  // a clear pane a metre above the plane
  Simulation::Mesh pane{.data = {.vertices = {{-100, -100, 1}, {100, -100, 1}, {100, 100, 1}, {-100, 100, 1}},
                                 .triangles = {{0, 1, 2}, {0, 2, 3}}},
                        .material = {.reflectance = 0, .smooth = SmoothInterface::pane()},
                        .object = 8};
  const auto through = [](const Cloud& cloud) {
    return std::count_if(cloud.echoes.begin(), cloud.echoes.end(),
                         [](const Echo& e) { return e.object == 7 && e.kind == ReflectionKind::glass; });
  };
  CHECK(run(*make_simulation(survey(), {.meshes = {plane(), pane}})).size() == 0);
  // straight down, the light that the pane mirrors into the aperture blinds the receiver for a while
  CHECK(through(run(*make_simulation(survey(), {.light_paths = true, .meshes = {plane(), pane}}))) > 1950);
  SurveySettings lit = survey();
  lit.scene.light = {{}};
  CHECK(through(run(*make_simulation(lit, {.meshes = {plane(), pane}}))) > 1950);
  lit.scene.light[0].passages = 0;
  CHECK(run(*make_simulation(lit, {.meshes = {plane(), pane}})).size() == 0);
  SurveySettings foggy = survey();
  foggy.scene.media = {{.absorption = 1}};
  CHECK(run(*make_simulation(foggy, {.meshes = {plane()}})).size() < 2000);
  foggy.scene.media.push_back({.absorption = 2});
  CHECK_THROWS_AS((void)make_simulation(foggy, {.meshes = {plane()}}), SettingError);
}

TEST_CASE(
    "haze dims the ground by its transmittance and hides none of it, with one echo of the air at most, on any number "
    "of threads") {
  // an airplane's height: farther than an atmosphere of a few thousand samples
  SurveySettings clear = survey();
  clear.legs[0].platform.position.z = 1000;
  clear.scanner.channels[0].returns_max = 4;
  clear.scene.light = {{}};
  SurveySettings hazy = clear;
  hazy.scene.media = {{.preset = MediumPreset::haze, .visibility = 23e3}};
  Simulation::Mesh ground = plane();
  for (Vec3& vertex : ground.data.vertices) vertex *= 20;
  const double extinction = haze(23e3, clear.scanner.channels[0].wavelength).extinction();
  for (const double range_min : {0.0, 200.0}) {
    CAPTURE(range_min);
    clear.scanner.channels[0].range_min = hazy.scanner.channels[0].range_min = range_min;
    const Cloud expected = run(*make_simulation(clear, {.meshes = {ground}}));
    REQUIRE(expected.size() == 2000);
    const auto simulation = make_simulation(hazy, {.meshes = {ground}});
    const Cloud cloud = run(*simulation);
    std::size_t on_ground = 0, of_air = 0;
    for (const Echo& echo : cloud.echoes) {
      if (echo.kind == ReflectionKind::air) {
        ++of_air;
        CHECK(echo.range < range_min + 2);  // where the whole pulse is in the haze
        continue;
      }
      const Echo& without = expected.echoes[std::min<std::size_t>(on_ground++, 1999)];
      CHECK(echo.object == 7);
      CHECK(std::fabs(echo.range - without.range) < 1e-3);
      CHECK(echo.amplitude == support::relative(without.amplitude * std::exp(-2 * extinction * without.range), 1e-3));
    }
    CHECK(on_ground == 2000);
    CHECK(of_air <= 2000);
    CHECK(run(*make_simulation(hazy, {.light_paths = true})).size() <= 2000);  // into the sky
    std::string first;
    for (const unsigned threads : {1U, 2U, 3U}) {
      support::LawfulSink sink;
      pulsecast::run(simulation->survey(), {.threads = threads}, sink);
      CHECK(sink.broken() == "");
      if (first.empty()) first = sink.checksum();
      CHECK(sink.checksum() == first);
    }
  }
}

}  // namespace
}  // namespace pulsecast::helios
