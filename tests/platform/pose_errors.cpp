// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/pose_errors.hpp>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/detector/radiometry.hpp>
#include <pulsecast/platform/legs.hpp>
#include <pulsecast/scanner/any_source.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include <doctest/doctest.h>

#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// North at 50 m/s, heading 30 degrees west of it: a crabbing aircraft.
struct Flight {
  Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    return {rotation_about(axis::up, 30_deg), {5e5, 5e6 + 50 * t.seconds(), 1000}};
  }
};

auto airplane(PulseIndex pulses = 2000) {
  return Platform{Flight{}, Mount{.lever_arm = {0.3, -1.2, 0.7}, .boresight = rotation_about(axis::right, -90_deg)},
                  Deflector{PolygonMirror{}, Scanner{.pulse_rate = 1_kHz, .pulses = pulses}}};
}

/// Where the beam is reported to start, less where it does [m].
Vec3 displacement(const Pulse<frame::World>& p) { return p.reported->position - p.pose.position; }

/// The angle between two directions, without loss where it is small [rad].
double angle_between(const Vec3& a, const Vec3& b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

const PoseErrors all{.position_noise = 2_cm,
                     .attitude_noise = 0.1_mrad,
                     .position_drift = 5_cm,
                     .attitude_drift = 0.2_mrad,
                     .drift_time = 0.5_s,
                     .angular_jitter = 0.05_mrad,
                     .lever_arm_error = {0.01, 0, 0},
                     .boresight_error = rotation_about(axis::up, 0.3_mrad),
                     .seed = 7};

}  // namespace

TEST_CASE("an instrument without errors reports where it is") {
  const WithPoseErrors platform{airplane(), {}};
  for (PulseIndex i = 0; i < platform.size(); i += 97) {
    const auto p = platform.pulse(i), truth = airplane().pulse(i);
    REQUIRE(p.has_value());
    CHECK(p->pose.position == truth->pose.position);
    CHECK(length(displacement(*p)) < 1e-8);
    CHECK(angle_between(p->reported->direction(axis::forward), p->direction()) < 1e-14);
  }
}

TEST_CASE("an error of the lever arm turns with the body") {
  const WithPoseErrors platform{airplane(), {.lever_arm_error = {0.1, 0.2, -0.3}}};
  const auto p = platform.pulse(500);
  const Vec3 expected = rotation_about(axis::up, 30_deg) * Vec3{0.1, 0.2, -0.3};
  CHECK(length(displacement(*p) - expected) < 1e-8);
  CHECK(angle_between(p->reported->direction(axis::forward), p->direction()) < 1e-14);
}

TEST_CASE("an error of the boresight turns the reported beam in the frame of the instrument") {
  const Rotation error = rotation_about(axis::up, 1_mrad);
  const WithPoseErrors platform{airplane(), {.boresight_error = error}};
  const auto p = platform.pulse(500);
  const auto inner = airplane().source().pulse(500);
  const Vec3 expected =
      rotation_about(axis::up, 30_deg) * (rotation_about(axis::right, -90_deg) * (error * inner->direction()));
  CHECK(length(p->reported->direction(axis::forward) - expected) < 1e-14);
  CHECK(p->pose.rotation == airplane().pulse(500)->pose.rotation);
}

TEST_CASE("white noise has the deviation that was asked for, and no memory") {
  const WithPoseErrors platform{airplane(20'000), {.position_noise = 2_cm, .attitude_noise = 0.1_mrad, .seed = 3}};
  double square = 0, product = 0, turned = 0;
  Vec3 before{};
  const double n = static_cast<double>(platform.size());
  for (PulseIndex i = 0; i < platform.size(); ++i) {
    const auto p = platform.pulse(i);
    const Tick t = p->tick;
    const Vec3 off = platform.reported(t).position - platform.truth().trajectory().at(t).position;
    square += dot(off, off);
    product += dot(off, before);
    const double angle = 2 * std::asin(length(cross(platform.reported(t).direction(axis::up), axis::up)) / 2);
    turned += angle * angle;
    before = off;
  }
  CHECK(std::sqrt(square / (3 * n)) == support::relative(2_cm, 0.02));
  CHECK(std::fabs(product / square) < 4 / std::sqrt(3 * n));
  CHECK(std::sqrt(turned / (2 * n)) == support::relative(0.1_mrad, 0.02));  // two of three axes tilt the vertical
}

TEST_CASE("a drift has the deviation that was asked for, and forgets itself in its time") {
  const WithPoseErrors platform{airplane(2'000'000), {.position_drift = 5_cm, .drift_time = 0.5_s, .seed = 11}};
  double square = 0, product = 0;
  int n = 0;
  for (double t = 0; t < 1999; t += 0.1, ++n) {
    const auto off = [&](double at) {
      const Tick tick = Tick::of_seconds(at);
      return platform.reported(tick).position - platform.truth().trajectory().at(tick).position;
    };
    square += dot(off(t), off(t));
    product += dot(off(t), off(t + 0.5));
  }
  CHECK(std::sqrt(square / (3 * n)) == support::relative(5_cm, 0.05));
  CHECK(product / square == doctest::Approx(std::exp(-1)).epsilon(0.06));
}

TEST_CASE("a drift is smooth from pulse to pulse") {
  const WithPoseErrors platform{airplane(), {.position_drift = 5_cm, .drift_time = 10_s}};
  for (PulseIndex i = 1; i < platform.size(); ++i)
    CHECK(length(displacement(*platform.pulse(i)) - displacement(*platform.pulse(i - 1))) < 1_mm);
}

TEST_CASE("jitter moves the beam and not what is reported of it") {
  const WithPoseErrors platform{airplane(20'000), {.angular_jitter = 1_mrad}};
  double square = 0;
  for (PulseIndex i = 0; i < platform.size(); ++i) {
    const auto p = platform.pulse(i), truth = airplane(20'000).pulse(i);
    CHECK(angle_between(p->reported->direction(axis::forward), truth->direction()) < 1e-14);
    const double off = angle_between(p->direction(), truth->direction());
    square += off * off;
  }
  CHECK(std::sqrt(square / (2 * static_cast<double>(platform.size()))) == support::relative(1_mrad, 0.02));
}

TEST_CASE("a platform that errs keeps the laws of a source, with everything switched on") {
  const WithPoseErrors platform{airplane(500), all};
  CHECK(support::source_laws(platform) == "");
  CHECK(support::source_laws(
            Legs{std::vector{platform, WithPoseErrors{airplane(300), {.position_noise = 1_m, .seed = 2}}}}) == "");
}

TEST_CASE("the seed decides") {
  PoseErrors other = all;
  other.seed = 8;
  const WithPoseErrors a{airplane(), all}, b{airplane(), all}, c{airplane(), other};
  CHECK(a.pulse(10)->reported->position == b.pulse(10)->reported->position);
  CHECK(a.pulse(10)->reported->position != c.pulse(10)->reported->position);
}

TEST_CASE("no two legs err alike, whatever they share; a platform alone errs as the first leg does") {
  using Strip = WithPoseErrors<Flight, Deflector<PolygonMirror, Scanner>>;
  using Any = AnySource<Strip, decltype(airplane())>;
  static_assert(DrawsByLeg<Strip> && DrawsByLeg<Any> && !DrawsByLeg<decltype(airplane())>);
  const PoseErrors one_kind[] = {
      {.position_noise = 1}, {.attitude_noise = 1e-3}, {.position_drift = 1}, {.angular_jitter = 1e-3}};
  for (const PoseErrors& errors : one_kind) {
    const Strip strip{airplane(100), errors};
    const Legs legs{std::vector{strip, strip, strip}};
    const Legs<Any> any{std::vector<Any>{strip, strip, airplane(100)}};
    const auto both = [](const auto& p) { return std::pair(p->reported->position, p->direction()); };
    const auto drawn = [&](const auto& p) {
      return std::pair(p->reported->position, p->reported->direction(axis::forward) - p->direction());
    };
    for (const PulseIndex i : {PulseIndex{0}, PulseIndex{99}}) {
      CHECK(both(legs.pulse(i)) == both(strip.pulse(i)));
      CHECK(drawn(legs.pulse(i)) != drawn(legs.pulse(100 + i)));
      CHECK(drawn(legs.pulse(100 + i)) != drawn(legs.pulse(200 + i)));
      CHECK(both(any.pulse(100 + i)) == both(legs.pulse(100 + i)));
    }
    CHECK(support::source_laws(legs) == "");
  }
}

TEST_CASE("an error of the boresight in single precision is made unit") {
  const WithPoseErrors platform{airplane(), {.boresight_error = Rotation{0.6F, 0.8F, 0, 0}}};
  CHECK(std::fabs(length(platform.pulse(0)->reported->rotation) - 1) < 1e-14);
}

TEST_CASE("errors that cannot be are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS((WithPoseErrors{airplane(), {.position_noise = -1}}), SettingError);
  CHECK_THROWS_AS((WithPoseErrors{airplane(), {.attitude_noise = nan}}), SettingError);
  CHECK_THROWS_AS((WithPoseErrors{airplane(), {.drift_time = 0}}), SettingError);
  CHECK_THROWS_AS((WithPoseErrors{airplane(), {.lever_arm_error = {nan, 0, 0}}}), SettingError);
  CHECK_THROWS_AS((WithPoseErrors{airplane(), {.boresight_error = {2, 0, 0, 0}}}), SettingError);
  CHECK_THROWS_AS((WithPoseErrors{airplane(2'000'000), {.position_drift = 1, .drift_time = 1e-9}}), SettingError);
}

namespace {

/// A curve to the left at 50 m/s, banked. The signs of its rotations alternate.
struct Curve {
  Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    const double angle = 0.2 * t.seconds(), sign = t.phase(50) < 0.5 ? 1 : -1;
    const Rotation attitude = rotation_about(axis::up, angle) * rotation_about(axis::forward, -0.4);
    return {sign * attitude, {5e5 + 250 * std::cos(angle), 5e6 + 250 * std::sin(angle), 1000}};
  }
};

auto in_curve(const PoseErrors& errors) {
  return WithPoseErrors{
      Platform{Curve{}, Mount{.lever_arm = {0.3, -1.2, 0.7}, .boresight = rotation_about({1, 2, 3}, 1.1)},
               Deflector{PolygonMirror{.line_rate = 1_Hz}, Scanner{.pulse_rate = 1_kHz, .pulses = 1000}}},
      errors};
}

/// Errors of one kind at a time, with different deviations by axis.
const std::vector<PoseErrors> each_kind{{.position_noise = {0.02, 0.03, 0.01}},
                                        {.attitude_noise = {1e-4, 2e-4, 0}},
                                        {.position_drift = {0.05, 0.01, 0.02}, .drift_time = 0.7},
                                        {.attitude_drift = {2e-4, 0, 5e-4}, .drift_time = 0.7},
                                        {.angular_jitter = 2e-4},
                                        {.angular_jitter = {1e-4, 0, 3e-4}},
                                        {.position_offset = {0.01, 0.02, 0.03}},
                                        {.attitude_offset = {3e-4, 1e-4, 2e-4}},
                                        {.lever_arm_deviation = {0.02, 0.01, 0.03}},
                                        {.boresight_deviation = {1e-4, 3e-4, 2e-4}},
                                        {.latency_deviation = 2e-3},  // over a change of sign
                                        {.position_noise = 0.02},
                                        {.attitude_noise = 1e-4},
                                        {.attitude_drift = 1e-4, .drift_time = 0.7},
                                        {.lever_arm_deviation = 0.03},
                                        {.boresight_deviation = 2e-4}};

}  // namespace

TEST_CASE("points err as a platform states of each kind of error, and of all together") {
  const auto with_seed = [](const PoseErrors& errors) {
    return [errors](std::uint64_t seed) {
      PoseErrors seeded = errors;
      seeded.seed = seed;
      return in_curve(seeded);
    };
  };
  for (std::size_t kind = 0; kind < each_kind.size(); ++kind) {
    CAPTURE(kind);
    CHECK(support::error_laws(with_seed(each_kind[kind]), (129 + 70 * kind) % 1000, 300) == "");
  }
  PoseErrors every = each_kind[0];
  every.attitude_drift = each_kind[3].attitude_drift;
  every.angular_jitter = each_kind[5].angular_jitter;
  every.attitude_offset = each_kind[7].attitude_offset;
  every.boresight_deviation = each_kind[9].boresight_deviation;
  every.latency_deviation = 1e-3;
  CHECK(support::error_laws(with_seed(every), 600, 300) == "");
}

TEST_CASE("errors of a known size are stated with their sign") {
  const WithPoseErrors platform =
      in_curve({.lever_arm_error = {0.01, -0.02, 0.03}, .boresight_error = -rotation_about({3, 1, 2}, 1e-5)});
  for (PulseIndex i = 0; i < platform.size(); i += 37) {
    const auto p = platform.pulse(i);
    const Vec3 ray{0, 300, 0}, point = p->pose.point(ray);
    Vec3 rest = p->reported->point(ray) - point;
    int stated = 0;
    platform.visit_errors(i, p->tick, [&](const PoseError<frame::World>& error) noexcept {
      rest -= support::detail::displaced(error, *p, point);
      stated += error.scope == ErrorScope::survey;
    });
    CHECK(stated == 2);
    CHECK(length(rest) < 5e-8);  // of 38 mm
  }
}

TEST_CASE("an error of each kind stays the same for as long as is stated") {
  for (std::size_t kind = 0; kind < each_kind.size(); ++kind) {
    CAPTURE(kind);
    PoseErrors errors = each_kind[kind];
    errors.seed = 5;
    const auto strip = in_curve(errors);
    const Legs legs{std::vector{strip, strip}};
    const auto off = [&](PulseIndex i) {
      const auto p = legs.pulse(i);
      return p->reported->point({0, 300, 0}) - p->pose.point({0, 300, 0});
    };
    ErrorScope scope{};
    legs.visit_errors(0, legs.pulse(0)->tick, [&](const auto& error) noexcept { scope = error.scope; });
    const double size = length(off(0)), change = length(off(1) - off(0)), anew = length(off(1000) - off(0));
    CHECK(size > 0);
    CHECK((change > 0.2 * size) == (scope == ErrorScope::pulse));
    CHECK((anew > 0.05 * size) == (scope != ErrorScope::survey));
  }
}

TEST_CASE("what is drawn once of poses and of ranges is independent, even of one seed") {
  const RangeErrors ranges{.bias_deviation = 1, .scale_deviation = 0.1};
  constexpr int seeds = 400;
  for (std::uint32_t receiver = 0; receiver < 3; ++receiver) {
    Vec3 by_bias{}, by_scale{};
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const WithPoseErrors platform{
          airplane(10), {.seed = seed, .position_offset = 1, .attitude_offset = 1e-3, .lever_arm_deviation = 1}};
      const auto body = platform.truth().trajectory().at({}), reported = platform.reported({});
      const RangeErrors drawn = ranges.drawn(seed, receiver);
      by_bias += drawn.bias * body.inverse().direction(reported.position - body.position);
      const Rotation turned = conjugate(body.rotation) * reported.rotation;
      by_scale += drawn.scale * 10.0 * Vec3{turned.x, turned.y, turned.z} * 2e3;
    }
    CAPTURE(receiver);
    CHECK(max_norm(by_bias) < 4 * std::sqrt(seeds));
    CHECK(max_norm(by_scale) < 4 * std::sqrt(seeds));
  }
}
