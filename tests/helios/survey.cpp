// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/survey.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/helios/detail/leg_paths.hpp>

#include "support/generators.hpp"
#include "support/relative.hpp"
#include "support/temporary_folder.hpp"

namespace pulsecast::helios {
namespace {

using support::relative;
using support::TemporaryFolder;

std::optional<double> flat(const Vec2&) { return 7; }

/// A survey of a rotating mirror and legs at these places.
SurveySettings survey_of(PlatformKind kind, const std::vector<Vec3>& places, double speed = 10) {
  SurveySettings s;
  s.scanner.pulse_rates = {1000};
  s.scanner.channels = {{.optic = RotatingOptic{}, .scan_angle_max = radians(60), .head_rate_max = radians(360)}};
  s.platform.kind = kind;
  for (const Vec3& place : places) {
    LegSettings leg;
    leg.platform.position = place;
    leg.platform.speed = speed;
    leg.scanner.scan_rate = 10;
    s.legs.push_back(leg);
  }
  return s;
}

Vec3 origin(const CompiledSurvey& compiled, PulseIndex i) { return compiled.source.pulse(i).value().pose.position; }

TEST_CASE("a tripod stands where each leg says, until the head has turned") {
  SurveySettings s = survey_of(PlatformKind::stationary, {{1, 2, 3}, {4, 5, 6}});
  for (LegSettings& leg : s.legs) {
    leg.scanner.head_rate = radians(90);
    leg.scanner.head_stop = radians(180);
  }
  s.platform.mount.position = {0, 0, 1.5};
  const CompiledSurvey compiled = compile_survey(s, flat);
  REQUIRE(compiled.legs.size() == 2);
  CHECK(compiled.legs[0].end == 2000);
  CHECK(compiled.legs[1].first == 2000);
  CHECK(compiled.legs[1].start.seconds() == 2);
  CHECK(length(origin(compiled, 0) - Vec3{1, 2, 4.5}) < 1e-12);
  CHECK(length(origin(compiled, 2000) - Vec3{4, 5, 7.5}) < 1e-12);
  CHECK(compiled.source.pulse(2000)->leg == 1);
  CHECK(compiled.source.pulse(2000)->tick.seconds() == 2);

  SUBCASE("on the ground, if it asks for that") {
    s.legs[0].platform.on_ground = true;
    CHECK(origin(compile_survey(s, flat), 0).z == relative(8.5, 1e-12));
    const auto none = [](const Vec2&) -> std::optional<double> { return std::nullopt; };
    CHECK_THROWS_WITH_AS((void)compile_survey(s, none), doctest::Contains("leg 0: onGround"), SettingError);
  }
  SUBCASE("not longer than it may") {
    s.legs[0].duration_max = 0.5;
    CHECK(compile_survey(s, flat).legs[0].end == 500);
  }
  SUBCASE("an inactive leg takes its time, and holds no pulses") {
    s.legs[0].scanner.active = false;
    const CompiledSurvey later = compile_survey(s, flat);
    CHECK(later.legs[0].end == 0);
    CHECK(later.legs[1].end == 2000);
    CHECK(later.source.pulse(0)->tick.seconds() == 2);
  }
  SUBCASE("a leg whose head begins where it stops ends at once") {
    s.legs[1].scanner.head_stop = s.legs[1].scanner.head_start;
    const CompiledSurvey none = compile_survey(s, flat);
    CHECK(none.legs[1].end == none.legs[1].first);
  }
  SUBCASE("nor of more pulses than can be counted") {
    s.legs[1].duration_max = 1e9;
    s.legs[1].scanner.pulse_rate = 1e8;
    s.legs[1].scanner.head_rate = 0;
    s.legs[1].scanner.head_stop = 0;
    CHECK_THROWS_WITH_AS((void)compile_survey(s, flat), doctest::Contains("leg 1 (pulses) is 1e+17"), SettingError);
  }
  SUBCASE("nor faster than a laser can be") {
    s.legs[1].scanner.pulse_rate = 1e13;
    s.legs[1].duration_max = 1;
    CHECK_THROWS_WITH_AS((void)compile_survey(s, flat),
                         doctest::Contains("leg 1: pulseFreq_hz is 1e+13 Hz, but must be from 0 to 1"), SettingError);
    s.legs[1].scanner.pulse_rate = -1;
    CHECK_THROWS_WITH_AS((void)compile_survey(s, flat), doctest::Contains("leg 1: pulseFreq_hz is -1"), SettingError);
  }
  SUBCASE("a leg that would never end is refused") {
    s.legs[1].scanner.head_rate = 0;
    s.legs[1].scanner.head_stop = 0;
    CHECK_THROWS_WITH_AS((void)compile_survey(s, flat), doctest::Contains("leg 1: maxDuration_s"), SettingError);
    s.legs[1].scanner.head_stop = 1;
    CHECK_THROWS_WITH_AS((void)compile_survey(s, flat),
                         doctest::Contains("leg 1: headRotateStop_deg: the leg never ends"), SettingError);
    s.legs[1].scanner.head_rate = -1;
    CHECK_THROWS_WITH_AS((void)compile_survey(s, flat), doctest::Contains("leg 1: headRotateStop_deg"), SettingError);
  }
}

TEST_CASE("a straight flight goes from leg to leg, and its lever arms turn with it") {
  SurveySettings s = survey_of(PlatformKind::linear_path, {{0, 0, 100}, {50, 0, 100}, {50, 30, 100}});
  s.platform.mount.position = {0, 2, -1};
  const CompiledSurvey compiled = compile_survey(s, flat);
  CHECK(compiled.legs[0].duration.seconds() == 5);
  CHECK(compiled.legs[1].duration.seconds() == 3);
  CHECK(compiled.legs[2].duration.seconds() == 0);
  // 60 degrees either side of what is swept is measured; the first pulse of a leg is straight ahead
  CHECK(length(origin(compiled, 0) - Vec3{2, 0, 99}) < 1e-9);
  CHECK(length(origin(compiled, compiled.legs[1].first) - Vec3{50, 2, 99}) < 1e-9);
  CHECK(length(compiled.source.pulse(0)->direction() - axis::right) < 1e-9);

  SUBCASE("a head that outlasts the way is told of") {
    s.legs[0].scanner.head_rate = radians(90);
    s.legs[0].scanner.head_stop = radians(900);
    const CompiledSurvey waits = compile_survey(s, flat);
    CHECK(waits.legs[0].duration.seconds() == 10);
    REQUIRE(waits.warnings.size() == 1);
    CHECK(waits.warnings[0].find(
              "leg 0: the platform arrives after 5 s, and stays for 5 s until the head has turned") == 0);
    s.legs[0].scanner.head_stop = 0;  // turns all the way
    CHECK(compile_survey(s, flat).legs[0].duration.seconds() == 5);
    CHECK(compile_survey(s, flat).warnings.empty());
  }
  SUBCASE("one leg alone has no end") {
    s.legs.resize(1);
    CHECK_THROWS_WITH_AS((void)compile_survey(s, flat), doctest::Contains("leg 0: maxDuration_s"), SettingError);
  }
  SUBCASE("what is wrong is told with the place where it stands") {
    s.legs[1].platform.speed = 0;
    SurveyBuildOptions options;
    options.leg_places = {"a.xml:3:5", "a.xml:7:5", "a.xml:9:5"};
    CHECK_THROWS_WITH_AS((void)compile_survey(s, flat, options), doctest::Contains("a.xml:7:5: leg 1: movePerSec_m"),
                         SettingError);
  }
  SUBCASE("the last leg says where the way ends, whatever the scanner could do there") {
    for (ChannelSettings& channel : s.scanner.channels) channel.scan_rate_min = 5;
    s.legs.back().scanner.scan_rate = 0;
    s.legs.back().duration_max = 4;
    const CompiledSurvey later = compile_survey(s, flat);
    CHECK(later.source.size() == compiled.source.size());
    CHECK(later.legs[2].duration.seconds() == 0);
  }
  SUBCASE("it must move") {
    s.legs[1].platform.speed = 0;
    CHECK_THROWS_WITH_AS((void)compile_survey(s, flat), doctest::Contains("leg 1: movePerSec_m"), SettingError);
  }
  SUBCASE("legs of one strip keep their numbers") {
    s.legs[0].strip = s.legs[1].strip = "a";
    const CompiledSurvey strips = compile_survey(s, flat);
    CHECK(strips.source.pulse(strips.legs[1].first)->leg == 1);
  }
}

TEST_CASE("a multicopter that stops is at each place when its leg begins; one that turns smoothly passes there") {
  SurveySettings s = survey_of(PlatformKind::multicopter, {{-60, 0, 40}, {0, 0, 40}, {0, 60, 40}}, 8);
  const CompiledSurvey stops = compile_survey(s, flat);
  for (std::size_t k = 0; k < 2; ++k)
    CHECK(length(stops.source.legs()[k].path().at({}).position - s.legs[k].platform.position) < 1e-6);
  CHECK(length(stops.source.legs()[1].path().at({}).direction(axis::forward) - axis::forward) < 1e-6);

  for (LegSettings& leg : s.legs) leg.platform.smooth_turn = true;
  const CompiledSurvey smooth = compile_survey(s, flat);
  double nearest = 1e9;
  for (double t = 0; t < smooth.legs[0].duration.seconds(); t += 0.01)
    nearest = std::min(
        nearest, length(smooth.source.legs()[0].path().at(Tick::of_seconds(t)).position - s.legs[1].platform.position));
  CHECK(nearest < 0.15);
  const auto end = smooth.source.legs()[0].path().at(smooth.legs[0].duration),
             begin = smooth.source.legs()[1].path().at({});
  CHECK(length(end.position - begin.position) < 0.02);  // one flight; legs end with a whole slot
  CHECK(length(smooth.source.legs()[1].path().at(smooth.legs[1].duration).position - s.legs[2].platform.position) <
        0.02);
}

TEST_CASE("a vehicle drives over the ground from leg to leg") {
  const SurveySettings s = survey_of(PlatformKind::ground_vehicle, {{0, 0, 0}, {40, 0, 0}, {40, 40, 0}}, 5);
  const CompiledSurvey compiled = compile_survey(s, flat);
  const auto at = [&](std::size_t k, double t) {
    return compiled.source.legs()[k].path().at(Tick::of_seconds(t)).position;
  };
  CHECK(length(at(0, 0) - Vec3{0, 0, 7}) < 1e-6);
  CHECK(length(at(1, 0) - Vec3{40, 0, 7}) ==
        relative((std::sqrt(2.0) - 1) * GroundVehicleSettings{}.turn_radius, 0.01));  // cut corner
  CHECK(length(at(1, compiled.legs[1].duration.seconds()) - Vec3{40, 40, 7}) < 0.1);
  CHECK(compiled.legs[2].end == compiled.legs[2].first);
  SUBCASE("where there is none, at the height of the leg") {
    const CompiledSurvey lost = compile_survey(s, [](const Vec2&) -> std::optional<double> { return std::nullopt; });
    CHECK(std::fabs(lost.source.legs()[0].path().at(Tick::of_seconds(3)).position.z) < 1e-9);
  }
}

TEST_CASE("a vehicle passes below a bridge from leg to leg, and notes what no vehicle drives over") {
  const auto bridge = [](const Vec2& p,
                         double near = std::numeric_limits<double>::infinity()) -> std::optional<double> {
    return p.x > 20 && p.x < 60 && near > 3 ? 6 : 0;
  };
  SurveySettings s =
      survey_of(PlatformKind::ground_vehicle, {{0, 0, 0}, {40, 0, 0}, {40, 0, 0}, {80, 0, 0}, {99, 0, 0}}, 5);
  s.legs[3].platform.speed = 4;  // a drive of its own
  const SurveyBuildOptions read{
      .leg_places = std::vector<std::string>(s.legs.size(), "survey.xml")};  // whose other notes its reader has
  const CompiledSurvey compiled = compile_survey(s, bridge, read);
  for (const auto& leg : compiled.legs)
    for (const double t : {0.0, 0.3, 0.6, 1.0}) {
      const Tick tick = Tick::of_seconds(t * leg.duration.seconds());
      CHECK(std::fabs(compiled.source.legs()[leg.number].path().at(tick).position.z) < 1e-9);
    }
  CHECK(compiled.warnings.empty());
  const auto notes = [&](const GroundHeight& ground) { return compile_survey(s, ground, read).warnings; };
  const auto slit = notes([](const Vec2& p) { return p.x > 10 && p.x < 10.5 ? std::nullopt : std::optional(100.0); });
  REQUIRE(slit.size() == 1);
  CHECK(slit[0].find("leg 0: no ground at x = 10") != std::string::npos);
  const auto wall = notes([](const Vec2& p) -> std::optional<double> { return p.x < 60 ? 0 : 9; });
  REQUIRE(wall.size() == 1);
  CHECK(wall[0].find("leg 2: ground steeper than 45 degrees") != std::string::npos);
  const auto sawtooth =
      notes([](const Vec2& p) -> std::optional<double> { return std::fmod(p.x + 100, 2) < 1 ? 0 : 5; });
  CHECK(std::any_of(sawtooth.begin(), sawtooth.end(),
                    [](const auto& w) { return w.find("leg 0: the vehicle takes ") != std::string::npos; }));
}

TEST_CASE(
    "a platform that moves stays where the next leg begins at the same place, for as long as it may, and looks as it "
    "came") {
  const std::vector<Vec3> places{{0, 0, 40}, {0, 0, 40}, {30, 0, 40}, {30, 0, 40}, {30, 0, 40}, {30, 30, 40}};
  for (const PlatformKind kind : {PlatformKind::linear_path, PlatformKind::multicopter, PlatformKind::ground_vehicle})
    for (const bool smooth : {false, true}) {
      CAPTURE(static_cast<int>(kind));
      CAPTURE(smooth);
      SurveySettings s = survey_of(kind, places, 5);
      for (LegSettings& leg : s.legs) leg.platform.smooth_turn = smooth;
      s.legs[0].duration_max = 2;
      s.legs[2].duration_max = 3;
      s.leg_offset = LegOffsetSettings{.mean = 0, .deviation = 0.5};
      const CompiledSurvey compiled = compile_survey(s, flat, {.seed = 3});
      CHECK(compiled.legs[0].duration.seconds() == 2);
      CHECK(compiled.legs[2].duration.seconds() == 3);
      CHECK(compiled.legs[3].duration.seconds() == 0);  // nobody says for how long
      CHECK(compiled.legs[0].end == 2000);
      const auto at = [&](std::size_t k, double t) { return compiled.source.legs()[k].path().at(Tick::of_seconds(t)); };
      for (const std::size_t k : {0U, 2U}) CHECK(at(k, 0).position == at(k, 1.7).position);
      for (std::size_t k = 0; k < 5; ++k) {
        CAPTURE(k);
        const auto end = at(k, compiled.legs[k].duration.seconds()), begin = at(k + 1, 0);
        CHECK(length(end.position - begin.position) < 0.01);  // legs end with a whole slot
        const bool jumps =
            kind != PlatformKind::multicopter && k == 3;  // it cannot turn on the spot, and leaves as if it had
        CHECK((jumps || length(end.direction(axis::forward) - begin.direction(axis::forward)) < 0.01));
      }
    }
}

TEST_CASE("a place is finite, whatever the platform, and may get its height from the ground") {
  for (const PlatformKind kind :
       {PlatformKind::stationary, PlatformKind::linear_path, PlatformKind::multicopter, PlatformKind::ground_vehicle})
    for (const double bad : {std::nan(""), HUGE_VAL}) {
      CAPTURE(static_cast<int>(kind));
      CAPTURE(bad);
      CHECK_THROWS_WITH_AS(LegPaths(survey_of(kind, {{0, 0, 9}, {bad, 0, 9}}), flat, {}),
                           doctest::Contains("leg 1: position"), SettingError);
    }
  SurveySettings s = survey_of(PlatformKind::stationary, {{0, 0, std::nan("")}});
  s.legs[0].platform.on_ground = true;
  CHECK(LegPaths(s, flat, {})[0].path.at({}).position == Vec3{0, 0, 7});
}

TEST_CASE("a multicopter that hovers before, between and after ways looks along them, or where it is told to") {
  SurveySettings s =
      survey_of(PlatformKind::multicopter, {{0, 0, 40}, {0, 0, 40}, {40, 0, 40}, {40, 0, 40}, {40, -40, 40}}, 5);
  const SurveyBuildOptions options;
  const auto looks = [&](std::size_t k) { return LegPaths(s, flat, options)[k].path.at({}).direction(axis::forward); };
  CHECK(length(looks(0) - axis::right) < 1e-9);
  CHECK(length(looks(2) + axis::forward) < 1e-9);
  CHECK(LegPaths(s, flat, options)[2].duration == 0);
  s.legs[0].platform.yaw_at_departure = radians(30);
  s.legs[2].platform.yaw_at_departure = radians(0);
  CHECK(length(looks(0) - rotation_about(axis::up, radians(30)) * axis::forward) < 1e-9);
  CHECK(length(looks(1) - rotation_about(axis::up, radians(30)) * axis::forward) < 1e-9);  // it turns as it begins
  CHECK(length(looks(2) - axis::forward) < 1e-9);
  const LegPaths paths(s, flat, options);
  CHECK(length(paths[1].path.at(Tick::of_seconds(paths[1].duration)).direction(axis::forward) - axis::forward) < 1e-6);
}

TEST_CASE("documents may give angles of many turns") {
  const auto directions = [](double more) {
    SurveySettings s = survey_of(PlatformKind::multicopter, {{0, 0, 40}, {0, 0, 40}, {40, 0, 40}, {40, 40, 40}}, 5);
    s.legs[0].platform.yaw_at_departure = radians(30) + more;
    s.legs[2].platform.yaw_at_departure = radians(-40) - more;
    s.legs[0].duration_max = 1;
    s.scanner.channels[0].beam_origin.rotation.turns = {{Axis::z, radians(20) + more}};
    s.platform.mount.rotation.turns = {{Axis::x, radians(-90) - more}, {Axis::z, radians(10) + more}};
    for (LegSettings& leg : s.legs) leg.scanner.head_start = leg.scanner.head_stop = radians(50) + more;
    const CompiledSurvey compiled = compile_survey(s, flat);
    std::vector<Vec3> all;
    for (PulseIndex i = 0; i < compiled.source.size(); i += 10)
      all.push_back(compiled.source.pulse(i).value().direction());
    return all;
  };
  const std::vector<Vec3> right = directions(0);
  REQUIRE(right.size() > 1000);
  for (const double turns : {1, -3, 9}) {
    CAPTURE(turns);
    const std::vector<Vec3> same = directions(turns * 2 * pi);
    REQUIRE(same.size() == right.size());
    double apart = 0;
    for (std::size_t i = 0; i < same.size(); ++i) apart = std::max(apart, length(same[i] - right[i]));
    CHECK(apart < 1e-9);
  }
}

TEST_CASE("a flight of smooth turns goes from place to place, however often its ways cross") {
  std::vector<Vec3> places;
  support::Generator any(1);
  for (int k = 0; k < 40; ++k) places.push_back({any.uniform(-300, 300), any.uniform(-300, 300), any.uniform(30, 60)});
  SurveySettings s = survey_of(PlatformKind::multicopter, places, 8);
  for (LegSettings& leg : s.legs) leg.platform.smooth_turn = true;
  const SurveyBuildOptions options;
  const LegPaths paths(s, flat, options);
  double way = 0, time = 0;
  for (std::size_t k = 0; k + 1 < places.size(); ++k) {
    CAPTURE(k);
    CHECK(paths[k].duration > 1);
    CHECK(std::fabs(paths[k].path.start.seconds() - time) < 1e-6);
    way += length(places[k + 1] - places[k]);
    time += paths[k].duration;
    double nearest = 1e9;  // to where the leg begins, until it begins
    const double since = k > 0 ? paths[k - 1].duration : 0;
    for (double t = -since; t <= 0; t += 0.02)
      nearest = std::min(nearest, length(paths[k].path.at(Tick::of_seconds(t)).position - places[k]));
    CHECK(nearest < 0.3);
  }
  CHECK(time > way / 8);
  CHECK(time < way / 8 + 40 * 5);
}

TEST_CASE("a vehicle parks as it came, or as it will leave, on the ground") {
  const SurveySettings s =
      survey_of(PlatformKind::ground_vehicle, {{0, 0, 0}, {0, 0, 0}, {0, 30, 0}, {0, 30, 0}, {0, 90, 0}}, 5);
  const auto slope = [](const Vec2& at) -> std::optional<double> { return 0.1 * at.y; };
  const SurveyBuildOptions options;
  const LegPaths paths(s, slope, options);
  for (const std::size_t k : {0U, 2U}) {
    CAPTURE(k);
    const auto pose = paths[k].path.at({}), later = paths[k].path.at(Tick::of_seconds(9)),
               leaves = paths[k + 1].path.at({});
    CHECK(pose.position == later.position);
    CHECK(length(pose.position - leaves.position) < 0.01);
    CHECK(std::fabs(pose.position.z - (k == 0 ? 0 : 3)) < 0.05);
    CHECK(pose.direction(axis::forward).z > 0.09);
  }
}

TEST_CASE("a platform that moves, and has but one leg, stays there") {
  for (const PlatformKind kind : {PlatformKind::linear_path, PlatformKind::multicopter, PlatformKind::ground_vehicle}) {
    SurveySettings s = survey_of(kind, {{3, 4, 7}}, 5);
    s.legs[0].duration_max = 2;
    const CompiledSurvey compiled = compile_survey(s, flat);
    CHECK(compiled.source.size() == 2000);
    CHECK(origin(compiled, 0) == Vec3{3, 4, 7});
    CHECK(compiled.source.pulse(1999)->pose.position == Vec3{3, 4, 7});
    s.legs[0].duration_max.reset();
    s.legs[0].scanner.head_rate = radians(90);
    s.legs[0].scanner.head_stop = radians(360);
    CHECK(compile_survey(s, flat).source.size() == 4000);
  }
  SurveySettings s = survey_of(PlatformKind::multicopter, {{0, 0, 40}});
  s.legs[0].duration_max = 1;
  s.legs[0].platform.yaw_at_departure = radians(90);
  CHECK(length(compile_survey(s, flat).source.pulse(0)->direction() + axis::right) < 1e-9);
}

TEST_CASE("an interpolated platform follows its file, with the columns that the leg names") {
  const TemporaryFolder folder;
  std::ofstream(folder / "way.trj") << "0,0,0,270,100,200,50\n2,0,0,270,120,200,50\n4,0,0,270,140,200,50\n";
  SurveySettings s = survey_of(PlatformKind::interpolated, {{}});
  s.platform.rotation_spec = RotationSpec::canonical;
  TrajectorySettings t{.file = folder / "way.trj", .columns = TrajectoryIndices{}};
  t.sync_clock = true;
  t.start = 1;
  s.legs[0].platform.trajectory = t;
  const CompiledSurvey compiled = compile_survey(s, flat);
  CHECK(compiled.legs[0].duration.seconds() == 3);
  CHECK(compiled.clock_start == 1);
  CHECK(length(origin(compiled, 0) - Vec3{110, 200, 50}) < 1e-9);
  CHECK(length(compiled.source.pulse(0)->direction() - axis::right) < 1e-9);
  s.legs[0].platform.trajectory->columns->roll = 0;
  CHECK_THROWS_WITH_AS((void)compile_survey(s, flat), doctest::Contains("leg 0: TrajectoryFormat::columns"),
                       SettingError);
  s.legs[0].platform.trajectory.reset();
  CHECK_THROWS_AS((void)compile_survey(s, flat), SettingError);
}

TEST_CASE(
    "what one leg says of the columns of a file, and what separates them, holds for all that follow it; others do not "
    "count") {
  const TemporaryFolder folder;
  std::ofstream(folder / "way.trj") << "100,200,50,0,1;5,fixed\n120,200,50,1,1;5,fixed\n140,200,50,2,1;5,float\n";
  SurveySettings s = survey_of(PlatformKind::interpolated, {{}, {}});
  const TrajectoryIndices columns{.time = 3, .x = 0, .y = 1, .z = 2};
  for (LegSettings& leg : s.legs)
    leg.platform.trajectory = TrajectorySettings{.file = folder / "way.trj", .position_only = true};
  s.legs[0].platform.trajectory->columns = columns;
  s.legs[0].platform.trajectory->separator = ',';
  s.legs[1].platform.trajectory->start = 1;
  const CompiledSurvey compiled = compile_survey(s, flat);
  CHECK(compiled.legs[0].duration.seconds() == 2);
  CHECK(length(origin(compiled, compiled.legs[1].first) - Vec3{120, 200, 50}) < 1e-9);
  s.legs[0].platform.trajectory->separator.reset();
  CHECK_THROWS_AS((void)compile_survey(s, flat), FileError);
}

TEST_CASE("legs end before a jump of their file, begin after it, or jump, with a note") {
  const TemporaryFolder folder;
  std::ofstream(folder / "way.trj") << "0,0,0,0,0,0,9\n2,0,0,0,20,0,9\n2,0,0,0,500,0,9\n4,0,0,0,500,20,9\n";
  SurveySettings s = survey_of(PlatformKind::interpolated, {{}, {}, {}});
  for (LegSettings& leg : s.legs)
    leg.platform.trajectory = TrajectorySettings{.file = folder / "way.trj", .columns = TrajectoryIndices{}};
  for (const bool position_only : {false, true}) {
    for (LegSettings& leg : s.legs) leg.platform.trajectory->position_only = position_only;
    s.legs[0].platform.trajectory->end = 2;
    s.legs[1].platform.trajectory->start = 2;
    const CompiledSurvey compiled = compile_survey(s, flat);
    const auto at = [&](std::size_t k, double t) { return compiled.source.legs()[k].path().at(Tick::of_seconds(t)); };
    CHECK(compiled.legs[0].duration.seconds() == 2);
    CHECK(compiled.legs[1].duration.seconds() == 2);
    CHECK(compiled.legs[2].duration.seconds() == 4);
    CHECK(length(at(0, 2).position - Vec3{20, 0, 9}) < 1e-12);
    CHECK(length(at(1, 0).position - Vec3{500, 0, 9}) < 1e-12);
    CHECK(length(at(2, 1.5).position - Vec3{15, 0, 9}) < 1e-12);
    CHECK(length(at(2, 2.5).position - Vec3{500, 5, 9}) < 1e-12);
    CHECK(length(origin(compiled, compiled.legs[1].first) - origin(compiled, compiled.legs[2].first + 2000)) < 1e-12);
    const auto notes = [&](const char* what) {
      return std::count_if(compiled.warnings.begin(), compiled.warnings.end(),
                           [&](const std::string& w) { return w.find(what) != std::string::npos; });
    };
    CHECK(notes("way.trj, line 3: repeats the time of the previous pose at another pose, the first of 1: a jump of the "
                "platform") == 1);
    CHECK(notes("a jump of the platform") == 1);
    if (!position_only) continue;
    CHECK(length(at(0, 2).direction(axis::forward) - axis::right) <
          1e-12);  // it looks where it goes, and not where it jumps
    CHECK(length(at(1, 0).direction(axis::forward) - axis::forward) < 1e-12);
  }
}

TEST_CASE("with the clock of a file, each leg has the time that the file gives its pose") {
  const TemporaryFolder folder;
  const double start = 388800.25;
  std::ofstream file(folder / "way.trj");
  file.precision(17);
  for (int i = 0; i <= 2000; ++i) file << start + 0.01 * i << ",0,0,0,0," << 50 * (0.01 * i) << ",9\n";
  file.close();
  const auto survey = [&](const std::vector<std::pair<double, double>>& spans, double rate) {
    SurveySettings s = survey_of(PlatformKind::interpolated, std::vector<Vec3>(spans.size()));
    s.scanner.pulse_rates = {rate};
    for (std::size_t k = 0; k < spans.size(); ++k) {
      TrajectorySettings t{.file = folder / "way.trj", .columns = TrajectoryIndices{}};
      t.start = start + spans[k].first;
      t.end = start + spans[k].second;
      s.legs[k].platform.trajectory = t;
    }
    s.legs[0].platform.trajectory->sync_clock = true;
    return s;
  };
  const auto off = [&](const CompiledSurvey&
                           compiled) {  // largest difference of a pulse's time and that of its place in the file [s]
    double most = 0;
    for (const auto& leg : compiled.legs) {
      const auto pulse = compiled.source.pulse(leg.first).value();
      most =
          std::fmax(most, std::fabs(*compiled.clock_start + pulse.tick.seconds() - start - pulse.pose.position.y / 50));
      CHECK(pulse.tick == leg.start);
      const auto& source = compiled.source.legs()[leg.number];
      const double end =
          source.path().at(source.recorded()).position.y / 50;  // also of the last record of a trajectory
      most =
          std::fmax(most, std::fabs(*compiled.clock_start + (leg.start + source.recorded()).seconds() - start - end));
    }
    return most;
  };
  CHECK(off(compile_survey(survey({{1, 2}, {5, 6}, {3, 3.5}}, 1000), flat)) < 1e-9);
  CHECK(off(compile_survey(survey({{5, 6}, {1, 2}}, 1000), flat)) < 1e-9);  // the clock starts with the earliest
  CHECK(compile_survey(survey({{5, 6}, {1, 2}}, 1000), flat).clock_start == start + 1);
  std::vector<std::pair<double, double>> strips;
  for (int i = 0; i < 100; ++i) strips.emplace_back(0.1003 * i, 0.1003 * (i + 1));
  CHECK(off(compile_survey(survey(strips, 1000), flat)) < 1e-9);
  SurveySettings own = survey({{1, 2}, {5, 6}}, 1000);
  own.legs[0].platform.trajectory->sync_clock = false;
  CHECK_FALSE(compile_survey(own, flat).clock_start.has_value());
  CHECK(compile_survey(own, flat).legs[1].start == Tick{1, 0});
}

TEST_CASE("a leg of whole slots has no slot more by the rounding of large times") {
  const TemporaryFolder folder;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CAPTURE(seed);
    support::Generator random(seed);
    const double rate = 1000.0 * static_cast<double>(1 + random.whole(300)),
                 start = std::round(random.log_uniform(1, 604800) * 10) / 10;
    const double slots = 100.0 * static_cast<double>(1 + random.whole(30)), extra = random.coin() ? 0.5 : 0;
    SurveySettings s = survey_of(PlatformKind::interpolated, {{}});
    s.scanner.pulse_rates = {rate};
    std::ofstream file(folder / "way.trj");
    file.precision(17);
    file << start << ",0,0,0,0,0,9\n" << start + (slots + extra) / rate << ",0,0,0,0,9,9\n";
    file.close();
    s.legs[0].platform.trajectory = TrajectorySettings{.file = folder / "way.trj", .columns = TrajectoryIndices{}};
    CHECK(compile_survey(s, flat).source.size() == static_cast<PulseIndex>(slots + (extra > 0 ? 1 : 0)));
  }
}

TEST_CASE("a flight or drive goes on in the next leg where it was when the last slot ended") {
  for (const PlatformKind kind : {PlatformKind::multicopter, PlatformKind::ground_vehicle}) {
    SurveySettings s = survey_of(kind, {{0, 0, 0}, {20, 0, 0}, {40, 5, 0}, {60, 0, 0}, {80, 5, 0}}, 12);
    s.scanner.pulse_rates = {130};
    for (LegSettings& leg : s.legs) leg.platform.smooth_turn = true;
    const CompiledSurvey compiled = compile_survey(s, flat);
    for (std::size_t k = 1; k < 4; ++k) {
      const auto& before = compiled.source.legs()[k - 1].path();
      const Vec3 end = before.at(compiled.legs[k - 1].duration).position,
                 begin = compiled.source.legs()[k].path().at({}).position;
      CHECK(length(end - begin) < 1e-12);
    }
  }
}

TEST_CASE("a gap in the rows of a file gets a note, within the legs that fly over it") {
  const TemporaryFolder folder;
  std::ofstream file(folder / "way.trj");
  for (const int start : {0, 100})
    for (int i = 0; i < 10; ++i) file << start + 0.1 * i << ",0,0,0,0," << i << ",9\n";
  file.close();
  SurveySettings s = survey_of(PlatformKind::interpolated, {{}});
  s.legs[0].platform.trajectory = TrajectorySettings{.file = folder / "way.trj", .columns = TrajectoryIndices{}};
  const CompiledSurvey compiled = compile_survey(s, flat);
  REQUIRE(compiled.warnings.size() == 1);
  CHECK(compiled.warnings[0].find("way.trj: no pose between 0.9 s and 100 s, the longest of 1 gaps") !=
        std::string::npos);
  CHECK(compiled.warnings[0].find("tStart, tEnd") != std::string::npos);
  s.legs[0].platform.trajectory->end = 0.9;
  CHECK(compile_survey(s, flat).warnings.empty());
}

TEST_CASE("the optic of a leg that teleports starts anew, as after a leg that is not active") {
  const TemporaryFolder folder;
  std::ofstream(folder / "way.trj") << "0,0,0,0,0,0,9\n1.015,0,0,0,0,0,9\n";
  SurveySettings s = survey_of(PlatformKind::interpolated, {{}, {}});
  s.scanner.channels[0].optic = ConicOptic{};
  for (LegSettings& leg : s.legs)
    leg.platform.trajectory = TrajectorySettings{.file = folder / "way.trj", .columns = TrajectoryIndices{}};
  const auto turned = [&] {
    const CompiledSurvey compiled = compile_survey(s, flat);
    return length(compiled.source.pulse(compiled.legs[1].first)->direction() - compiled.source.pulse(0)->direction());
  };
  CHECK(turned() > 0.1);
  s.legs[1].platform.trajectory->teleports = true;
  CHECK(turned() < 1e-12);
}

TEST_CASE("a leg has at most 1e9 records of its trajectory, and as many pulses as can be counted") {
  SurveySettings s = survey_of(PlatformKind::stationary, {{}, {}});
  for (LegSettings& leg : s.legs) leg.duration_max = 1e6;
  s.legs[1].scanner.trajectory_interval = 1e-9;
  const SurveyBuildOptions options{.leg_places = {"a.xml:3:5", "a.xml:4:5"}};
  CHECK_THROWS_WITH_AS((void)compile_survey(s, flat, options),
                       doctest::Contains("a.xml:4:5: leg 1: trajectoryTimeInterval_s (records) is 1e+15"),
                       SettingError);
  s.legs[1].scanner.active = false;
  CHECK_NOTHROW((void)compile_survey(s, flat, options));
  s.legs[1].scanner.active = true;
  s.legs[1].scanner.trajectory_interval = 1e-3;
  CHECK(compile_survey(s, flat, options).legs[1].trajectory_interval == 1e-3);
  s.legs[1].duration_max = 1e9;
  s.legs[1].scanner.pulse_rate = 1e8;
  CHECK_THROWS_WITH_AS((void)compile_survey(s, flat, options), doctest::Contains("a.xml:4:5: leg 1 (pulses) is 1e+17"),
                       SettingError);
}

TEST_CASE("settings of a program have the limits of a document's") {
  SurveySettings s = survey_of(PlatformKind::stationary, {{}, {}});
  for (LegSettings& leg : s.legs) leg.duration_max = 1;
  REQUIRE_NOTHROW((void)compile_survey(s, flat));
  const auto refused = [&](const auto& change, const char* says) {
    SurveySettings other = s;
    change(other);
    CHECK_THROWS_WITH_AS((void)compile_survey(other, flat), doctest::Contains(says), SettingError);
  };
  const auto scanner = [](SurveySettings& o) -> LegScannerSettings& { return o.legs[1].scanner; };
  const auto device = [](SurveySettings& o) -> ChannelSettings& { return o.scanner.channels[0]; };
  refused([&](SurveySettings& o) { scanner(o).vertical_angle_min = -40; },
          "leg 1: verticalAngleMin_deg is -2291.831180523293 deg, but must be from -360 to 360: given in degrees, not "
          "radians?");
  refused([&](SurveySettings& o) { scanner(o).pulse_rate = 1e12; }, "leg 1: pulseFreq_hz is 1e+12 Hz");
  refused([&](SurveySettings& o) { scanner(o).scan_rate = 1e3; },
          "leg 1: scanFreq_hz is 1000 Hz: expected less than pulseFreq_hz, 1000 Hz");
  refused([&](SurveySettings& o) { scanner(o).vertical_angle_min = scanner(o).vertical_angle_max = 0.5; },
          "leg 1: verticalAngleMin_deg: no");
  refused([&](SurveySettings& o) { o.legs[0].platform.position.y = 2e9; },
          "leg 0: y is 2e+09 m, but must be from -1000000000 to 1000000000");
  refused([&](SurveySettings& o) { device(o).efficiency = 1.5; }, "opticalEfficiency is 1.5, but must be from 0 to 1");
  refused([&](SurveySettings& o) { device(o).range_min = device(o).range_max = 5; },
          "rangeMax_m is not beyond rangeMin_m");
  refused([&](SurveySettings& o) { device(o).scan_rate_min = 1 + (device(o).scan_rate_max = 8); },
          "scanFreqMax_Hz is below");
  refused([&](SurveySettings& o) { device(o).errors.range = "1/0*THETA"; },
          "expr=\"1/0*THETA\" is not finite for any THETA");
  refused([&](SurveySettings& o) { o.scanner.channels.emplace_back(device(o)).wavelength = 1; },
          "channel 1: wavelength_nm is 1e+09 nm");
  refused([](SurveySettings& o) { o.platform.position_noise[1] = NoiseSettings{.clipped = true, .clip_low = 2}; },
          "clipMax is below clipMin");
  refused([](SurveySettings& o) { o.leg_offset = LegOffsetSettings{.deviation = -1}; }, "legRandomOffsetStdev is -1 m");
  refused([](SurveySettings& o) { o.scanner.channels.clear(); }, "scanner: channels (number) is 0");
}

TEST_CASE(
    "settings of a program get the notes of a document's, but those that were read from one do not get them again") {
  SurveySettings s = survey_of(PlatformKind::stationary, {{}});
  s.legs[0].duration_max = 0.1;
  LegScannerSettings& leg = s.legs[0].scanner;
  REQUIRE(compile_survey(s, flat).warnings.empty());
  leg.pulse_rate = 123;
  leg.head_rate = 30;
  leg.head_stop = 360;
  leg.scan_angle = radians(70);
  s.scanner.channels[0].waveform.bin_size = 9e-9;
  const std::vector<std::string> notes = compile_survey(s, flat).warnings;
  CHECK(notes ==
        std::vector<std::string>{
            "binSize_ns is 9 ns, and pulses are 4 ns long: it is limited to 4 ns; expected bins from 0.0004 ns to 4 ns",
            "leg 0: headRotateStop_deg is 20626.480625, 57.29578 turns: given in degrees, not radians?",
            "leg 0: headRotatePerSec_deg exceeds the scanner's maximum: it is limited to 360",
            "leg 0: pulseFreq_hz of 123 Hz is not one of the scanner's pulse rates",
            "leg 0: scanAngle_deg exceeds the scanner's maximum: it is limited to 60"});
  CHECK(compile_survey(s, flat, {.leg_places = {"a.xml:3:5"}}).warnings.empty());
}

TEST_CASE("a leg that is too slow to end, or too fast for its platform, is told by its speed") {
  using enum PlatformKind;
  for (const auto& [kind, speed] : {std::pair{linear_path, 1e-320},
                                    {linear_path, 1e-18},
                                    {multicopter, 1e-320},
                                    {multicopter, 2e3},
                                    {ground_vehicle, 1e-320},
                                    {ground_vehicle, 2e3}})
    CHECK_THROWS_WITH_AS((void)compile_survey(survey_of(kind, {{}, {20, 0, 0}}, speed), flat),
                         doctest::Contains("leg 0: movePerSec_m is "), SettingError);
  SurveySettings s = survey_of(stationary, {{}});
  s.legs[0].scanner.head_rate = 1e-300;
  s.legs[0].scanner.head_stop = 2;
  CHECK_THROWS_WITH_AS((void)compile_survey(s, flat), doctest::Contains("leg 0 (duration) is "), SettingError);
}

TEST_CASE("channels fire together, each from its own place") {
  SurveySettings s = survey_of(PlatformKind::stationary, {{}});
  s.legs[0].duration_max = 1;
  s.scanner.channels.push_back(s.scanner.channels[0]);
  s.scanner.channels[1].beam_origin.position = {0, 0, 0.3};
  s.scanner.channels[1].wavelength = 1550e-9;
  const CompiledSurvey compiled = compile_survey(s, flat);
  CHECK(compiled.source.size() == 2000);
  const auto a = compiled.source.pulse(20), b = compiled.source.pulse(21);
  REQUIRE((a && b));
  CHECK(a->tick == b->tick);
  const std::vector<Emitter> emitters = compiled.source.emitters();
  REQUIRE(emitters.size() == 2);
  CHECK(emitters[b->emitter].channel == 1);
  CHECK(b->pose.position.z == 0.3);
  CHECK(emitters[b->emitter].laser.wavelength == 1550e-9);
  CHECK(emitters[b->emitter].receiver == 0);
}

TEST_CASE("noise of the platform is reported alone, as the settings say, and can be left out") {
  SurveySettings s = survey_of(PlatformKind::stationary, {{1, 2, 3}});
  s.legs[0].duration_max = 10;
  s.legs[0].scanner.scan_rate = 0;
  s.platform.position_noise = {
      NoiseSettings{.deviation = 0.1}, NoiseSettings{.distribution = NoiseDistribution::uniform, .low = 1, .high = 3},
      NoiseSettings{.mean = 5, .deviation = 0, .clipped = true, .clip_low = 0, .clip_high = 2}};
  const CompiledSurvey compiled = compile_survey(s, flat, {.seed = 4});
  double sum = 0, squares = 0, least = 9, most = -9;
  for (PulseIndex i = 0; i < 10'000; ++i) {
    const auto p = compiled.source.pulse(i);
    CHECK(p->pose.position == Vec3(1, 2, 3));
    const Vec3 off = p->reported.value().position - p->pose.position;
    sum += off.x;
    squares += off.x * off.x;
    least = std::min(least, off.y);
    most = std::max(most, off.y);
    CHECK(off.z == 2);
  }
  CHECK(std::fabs(sum / 10'000) < 0.004);
  CHECK(std::sqrt(squares / 10'000) == relative(0.1, 0.03));
  CHECK(least == relative(1, 0.01));
  CHECK(most == relative(3, 0.01));
  CHECK_FALSE(compile_survey(s, flat, {.seed = 4, .platform_noise = false}).source.pulse(0)->reported);

  s.platform.position_noise = {NoiseSettings{.lifespan = 3}};
  s.platform.attitude_noise[2] = NoiseSettings{.mean = pi / 2, .deviation = 0};
  const CompiledSurvey turned = compile_survey(s, flat, {.seed = 4});
  const auto off = [&](PulseIndex i) { return turned.source.pulse(i)->reported->position.x; };
  CHECK(off(0) == off(2));
  CHECK(off(2) != off(3));
  CHECK(length(turned.source.pulse(0)->direction() - axis::forward) < 1e-12);
  CHECK(length(turned.source.pulse(0)->reported->direction(axis::forward) + axis::right) < 1e-12);
}

TEST_CASE("a mount that is reported wrongly moves points about the axes of the platform, whichever way the beam goes") {
  SurveySettings s = survey_of(PlatformKind::linear_path, {{0, 0, 500}, {0, 100, 500}});
  s.legs[0].scanner.scan_rate = 0;
  const double height = 500, error = 0.001;
  for (const double aside : {0.0, 27.0}) {  // beam down, and to the right [deg]
    s.platform.mount = {.position = {1, 2, 3},
                        .rotation = {.turns = {{Axis::x, radians(-90)}, {Axis::y, -radians(aside)}}}};
    const auto moved = [&](const MountErrorSettings& wrong) {
      s.platform.mount_error = wrong;
      const auto pulse = compile_survey(s, flat).source.pulse(7);
      REQUIRE((pulse && pulse->reported));
      const double range = height / std::cos(radians(aside));
      return pulse->reported->position + range * pulse->reported->direction(axis::forward) - pulse->pose.position -
             range * pulse->direction();
    };
    CAPTURE(aside);
    const double right = height * std::tan(radians(aside));
    const double sine = std::sin(error), versine = 1 - std::cos(error);
    const Vec3 front_up{0, height * sine, height * versine}, clockwise{-right * versine, -right * sine, 0},
        right_down{-right * versine - height * sine, 0, height * versine - right * sine};
    CHECK(length(moved({.pitch = error}) - front_up) < 1e-9);
    CHECK(length(moved({.heading = error}) - clockwise) < 1e-9);
    CHECK(length(moved({.roll = error}) - right_down) < 1e-9);
    CHECK(length(moved({.position = {0.1, 0.2, -0.3}}) - Vec3{0.1, 0.2, -0.3}) < 1e-9);
    CHECK(length(moved({.position = {0.1, 0, 0}, .pitch = error}) - front_up - Vec3{0.1, 0, 0}) < 1e-9);
  }
  CHECK_FALSE(compile_survey(s, flat, {.platform_noise = false}).source.pulse(7)->reported);
}

TEST_CASE("no two legs have the same noise") {
  SurveySettings s = survey_of(PlatformKind::stationary, {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}});
  for (LegSettings& leg : s.legs) leg.duration_max = 1;
  s.platform.position_noise[0] = s.platform.attitude_noise[2] =
      NoiseSettings{.deviation = 0.1, .lifespan = 100'000};  // as a drift
  const CompiledSurvey compiled = compile_survey(s, flat, {.seed = 4});
  const auto drawn = [&](std::size_t leg, PulseIndex i) {
    const auto p = compiled.source.pulse(compiled.legs[leg].first + i);
    return std::pair(p->reported->position.x, p->reported->direction(axis::forward).x);
  };
  for (std::size_t leg = 0; leg < 3; ++leg) {
    CHECK(drawn(leg, 0) == drawn(leg, 400));
    CHECK(drawn(leg, 0).first != drawn((leg + 1) % 3, 0).first);
    CHECK(drawn(leg, 0).second != drawn((leg + 1) % 3, 0).second);
  }
}

TEST_CASE("legs are beside where they should be by chance, alike for the same seed, or exact") {
  SurveySettings s = survey_of(PlatformKind::stationary, {{}});
  s.legs[0].duration_max = 1;
  s.leg_offset = LegOffsetSettings{.mean = 10, .deviation = 0};
  CHECK(length(origin(compile_survey(s, flat), 0) - Vec3{10, 10, 10}) < 1e-12);
  CHECK(length(origin(compile_survey(s, flat, {.leg_noise = false}), 0)) < 1e-12);
  s.leg_offset->deviation = 0.1;
  CHECK(origin(compile_survey(s, flat, {.seed = 5}), 0) == origin(compile_survey(s, flat, {.seed = 5}), 0));
  CHECK(origin(compile_survey(s, flat, {.seed = 5}), 0) != origin(compile_survey(s, flat, {.seed = 6}), 0));
}

TEST_CASE("errors of calibration are the same in all legs, and drifts are those of each") {
  SurveySettings s = survey_of(PlatformKind::stationary, {{1, 2, 3}, {1, 2, 3}});
  for (LegSettings& leg : s.legs) leg.duration_max = 1;
  const auto off = [&](std::size_t leg, std::uint64_t seed) {
    const CompiledSurvey compiled = compile_survey(s, flat, {.seed = seed});
    const auto p = compiled.source.pulse(compiled.legs[leg].first + 7);
    return p->reported->position - p->pose.position;
  };
  s.platform.pose_errors.lever_arm_deviation = {0, 0, 0.5};
  CHECK(length(off(0, 4) - off(1, 4)) < 1e-12);
  CHECK(length(off(0, 4) - off(0, 5)) > 1e-3);
  s.platform.pose_errors = {.position_drift = {0.5, 0, 0}};
  CHECK(length(off(0, 4) - off(1, 4)) > 1e-3);
  CHECK_FALSE(compile_survey(s, flat, {.platform_noise = false}).source.pulse(7)->reported);
}

TEST_CASE("a leg follows poses of the program by their name, from its start to its end") {
  SurveySettings s = survey_of(PlatformKind::interpolated, {{}});
  TrajectorySettings& trajectory = s.legs[0].platform.trajectory.emplace();
  trajectory.file = "drive";
  trajectory.start = 11;
  trajectory.end = 12.5;
  const SurveyBuildOptions options{
      .trajectories = {{"drive", {{10, {0, 0, 5}}, {12, {8, 0, 5}, rotation_about(axis::up, 1)}, {13, {8, 2, 5}}}}}};
  const CompiledSurvey compiled = compile_survey(s, flat, options);
  CHECK(compiled.legs[0].end == 1500);
  const auto at = [&](double time) { return compiled.source.legs()[0].path().at(Tick::of_seconds(time)); };
  CHECK(length(at(0).position - Vec3{4, 0, 5}) < 1e-12);
  CHECK(length(at(1.5).position - Vec3{8, 1, 5}) < 1e-12);
  CHECK(length(at(0.5).rotation * axis::forward - rotation_about(axis::up, 0.75) * axis::forward) < 1e-12);
  trajectory.start = 14;
  trajectory.end.reset();
  CHECK_THROWS_WITH_AS((void)compile_survey(s, flat, options), doctest::Contains("leg 0: tStart to tEnd"),
                       SettingError);
}

TEST_CASE("what is wrong with an optic names its leg") {
  SurveySettings s = survey_of(PlatformKind::stationary, {{}, {}});
  for (LegSettings& leg : s.legs) leg.duration_max = 1;
  s.scanner.channels[0].scan_rate_max = 9;
  s.legs[0].scanner.scan_rate = 5;
  CHECK_THROWS_WITH_AS((void)compile_survey(s, flat), doctest::Contains("leg 1: scanFreq_hz is 10 Hz"), SettingError);
}

TEST_CASE("what a scanner or a drone cannot is noted once") {
  SurveySettings s = survey_of(PlatformKind::multicopter, {{0, 0, 0}, {20, 0, 0}, {40, 0, 0}, {60, 0, 0}});
  s.scanner.channels[0].optic = OscillatingOptic{};
  for (LegSettings& leg : s.legs) leg.scanner.scan_rate = 400;
  s.platform.multicopter.yaw_speed = 0;
  s.platform.multicopter.pitch_offset = pi / 2;
  const CompiledSurvey compiled = compile_survey(s, flat);
  REQUIRE(compiled.warnings.size() == 3);
  CHECK(compiled.warnings[0] == "yaw_speed_deg is taken as 0.057");
  CHECK(compiled.warnings[1] == "pitch_offset_deg is taken as 85.944");
  CHECK(compiled.warnings[2].find("leg 0: scanFreq_hz of 400 is taken as 500") != std::string::npos);
  s.legs[0].scanner.active = false;
  CHECK(compile_survey(s, flat).warnings[2].find("leg 1: scanFreq_hz") != std::string::npos);
}

TEST_CASE("a survey of ten thousand legs is planned at once") {
  std::vector<Vec3> places;
  for (int i = 0; i < 10'000; ++i) places.push_back({i * 10.0, 0, 0});
  const CompiledSurvey compiled = compile_survey(survey_of(PlatformKind::linear_path, places), flat);
  CHECK(compiled.legs.size() == 10'000);
  CHECK(compiled.source.size() == 9'999'000);
}

/// A survey of one leg, on a tripod.
SurveySettings turning_head() {
  SurveySettings s;
  s.scanner.pulse_rates = {1000};
  s.scanner.channels = {{.optic = RotatingOptic{}, .scan_angle_max = radians(60), .head_rate_max = radians(360)}};
  LegSettings leg;
  leg.scanner.scan_rate = 10;
  leg.scanner.head_rate = leg.scanner.head_stop = radians(90);
  s.legs = {leg};
  return s;
}

TEST_CASE("what can be checked without a scene is") {
  SurveySettings s = turning_head();
  CHECK(check_without_scene(s).empty());
  SUBCASE("a leg that scans faster than the device can") {
    s.scanner.channels[0].scan_rate_max = 5;
    CHECK_THROWS_WITH_AS((void)check_without_scene(s), doctest::Contains("leg 0: scanFreq_hz"), SettingError);
    CHECK_THROWS_WITH_AS((void)check_without_scene(s, {"a.xml:3:5"}),
                         doctest::Contains("a.xml:3:5: leg 0: scanFreq_hz"), SettingError);
  }
  SUBCASE("a receiver that cannot be") {
    s.scanner.channels[0].receiver_diameter = -1;
    CHECK_THROWS_AS((void)check_without_scene(s), SettingError);
  }
  SUBCASE("bins that cannot be") {
    s.scanner.channels[0].waveform.bin_size = 0;
    CHECK_THROWS_AS((void)check_without_scene(s), SettingError);
  }
  SUBCASE("a leg on the ground, as there may be some") {
    s.legs[0].platform.on_ground = true;
    CHECK(check_without_scene(s).empty());
  }
  SUBCASE("a platform that arrives long before the head has turned") {
    s.platform.kind = PlatformKind::linear_path;
    s.legs.push_back(s.legs[0]);
    s.legs[1].platform.position = {7, 0, 0};
    REQUIRE(check_without_scene(s).size() == 1);
    CHECK(check_without_scene(s)[0].starts_with("leg 0: the platform arrives after 0.1 s"));
  }
}

}  // namespace
}  // namespace pulsecast::helios
