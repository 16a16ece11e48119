// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/scene/motion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Where a motion takes a point, of a body with this centre.
Vec3 moved(const PartMotion& motion, double seconds, const Vec3& p, const Vec3& centre = {}) {
  return motion.at(Tick::of_seconds(seconds), centre).point(p);
}

/// A body, walked through its motions one by one: the plain way to do it.
class Walker {
 public:
  explicit Walker(const Vec3& centre) : start_(centre), centre_(centre) {}

  void walk(const SteadyMotion& m, double seconds) {
    const Rotation turn = rotation_about(m.axis, m.angular_rate * seconds);
    const Vec3 about = m.centre.value_or(centre_), spin = m.spin.value_or(m.angular_rate * normalize(m.axis));
    centre_ = about + turn * (centre_ - about) + seconds * m.velocity;
    if (length(spin) > 0) attitude_ = rotation_about(spin, length(spin) * seconds) * attitude_;
  }

  /// Until the time is over; gives what is left of it.
  double walk(const MotionSequence& sequence, double seconds) {
    for (std::uint64_t k = 0; k < sequence.times; ++k)
      for (const SteadyMotion& m : sequence.motions) {
        walk(m, std::min(seconds, m.duration));
        seconds -= m.duration;
        if (seconds <= 0) return 0;
      }
    return seconds;
  }

  Vec3 point(const Vec3& p) const { return centre_ + attitude_ * (p - start_); }

 private:
  Vec3 start_, centre_;
  Rotation attitude_ = no_rotation;
};

Vec3 walked(const std::vector<MotionSequence>& sequences, std::optional<std::size_t> again_from, double seconds,
            const Vec3& point, const Vec3& centre) {
  Walker walker(centre);
  for (std::size_t i = 0; i < sequences.size() && seconds > 0;) {
    seconds = walker.walk(sequences[i], seconds);
    if (++i == sequences.size() && again_from) i = *again_from;
  }
  return walker.point(point);
}

struct Plan {
  std::vector<MotionSequence> sequences;
  std::optional<std::size_t> again_from;
};

Plan any_plan(support::Generator& any) {
  Plan plan;
  for (std::uint64_t n = 1 + any.whole(3); plan.sequences.size() < n;) {
    MotionSequence sequence;
    sequence.times = 1 + any.whole(6);
    for (std::uint64_t m = 1 + any.whole(3); sequence.motions.size() < m;) {
      SteadyMotion motion{.duration = any.log_uniform(0.1, 3)};
      if (any.coin()) motion.velocity = any.point(2);
      if (any.coin()) {
        motion.axis = any.log_uniform(0.01, 100) * any.unit();
        motion.angular_rate = any.uniform(-3, 3);
      }
      if (any.coin()) motion.centre = any.point(5);
      if (any.whole(4) == 0) motion.spin = any.coin() ? Vec3{} : any.point(2);
      sequence.motions.push_back(motion);
    }
    plan.sequences.push_back(sequence);
  }
  if (any.coin()) plan.again_from = any.whole(plan.sequences.size());
  return plan;
}

std::vector<TimedPose> any_poses(support::Generator& any) {
  std::vector<TimedPose> poses;
  double time = any.coin() ? 0 : any.uniform(0, 2);
  for (std::uint64_t n = 1 + any.whole(6); poses.size() < n; time += any.log_uniform(0.01, 3))
    poses.push_back({time, any.point(10), any.rotation()});
  return poses;
}

}  // namespace

TEST_CASE("a body may orbit without turning, or turn otherwise than it orbits") {
  const Vec3 own{10, 0, 5};
  const PartMotion cabin(SteadyMotion{.axis = axis::forward, .angular_rate = pi / 2, .centre = Vec3{}, .spin = Vec3{}});
  CHECK(length(moved(cabin, 1, own + Vec3{1, 2, 3}, own) - Vec3{5 + 1, 2, -10 + 3}) < 1e-14);
  const PartMotion moon(SteadyMotion{.angular_rate = pi / 2, .centre = Vec3{}, .spin = Vec3{pi, 0, 0}});
  CHECK(length(moved(moon, 1, own + Vec3{1, 2, 3}, own) - Vec3{1, 10 - 2, 5 - 3}) < 1e-14);
  const Box swept = cabin.swept({own, own}, {}, {0, 0}, {60, 0});
  CHECK(max_norm(swept.max) < length(own) + 1e-5);
}

TEST_CASE("a body stands before the start of the survey, and stays where a motion has ended") {
  const PartMotion motion(SteadyMotion{.velocity = {2, 0, 0}, .angular_rate = 0.1, .duration = 3});
  CHECK(moved(motion, -5, {1, 1, 1}) == Vec3{1, 1, 1});
  CHECK(length(moved(motion, 3, {}) - Vec3{6, 0, 0}) < 1e-14);
  CHECK(length(moved(motion, 1e9, {1, 0, 0}) - moved(motion, 3, {1, 0, 0})) < 1e-14);
}

TEST_CASE("a loop there and back is after a year as exact as in the first second") {
  const Vec3 utm{5e5, 5.4e6, 300};
  const PartMotion motion({{.motions = {{.velocity = {1.5, 0, 0.1}, .angular_rate = 0.3, .duration = 0.7},
                                        {.velocity = {-1.5, 0, -0.1}, .angular_rate = -0.3, .duration = 0.7}}}},
                          0);
  const double period = 0.7 + 0.7;
  const double passes = std::floor(3e7 / period);
  for (const double t : {0.0, 0.1, 0.69, 0.71, 1.3}) {
    const Tick late = Tick::of(static_cast<PulseIndex>(passes), 1 / period) + Tick::of_seconds(t);
    // 1 / period rounds: the very time since the start of the pass
    const double rest = std::fmod(std::fmod(static_cast<double>(late.second), period) + late.fraction, period);
    CHECK(length(motion.at(late, utm).point(utm + Vec3{3, 2, 1}) -
                 motion.at(Tick::of_seconds(rest), utm).point(utm + Vec3{3, 2, 1})) < 2e-8);
  }
}

TEST_CASE("a wheel has turned after a year as far as its clock says") {
  const PartMotion motion(SteadyMotion{.angular_rate = 2 * pi * 12.5});
  for (const double fraction : {0.0, 0.01, 0.33}) {
    const Tick late{31'536'000, fraction};
    CHECK(length(motion.at(late, {}).point({1, 0, 0}) - motion.at({0, fraction}, {}).point({1, 0, 0})) < 1e-12);
  }
}

TEST_CASE("any sequences and loops are where a walk through them step by step arrives") {
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Plan plan = any_plan(any);
    const PartMotion motion(plan.sequences, plan.again_from);
    const Vec3 centre = any.point(10), point = centre + any.point(3);
    for (int k = 0; k < 20; ++k) {
      const double t = any.coin() ? any.uniform(0, 20) : any.log_uniform(0.01, 500);
      CAPTURE(t);
      const Vec3 expected = walked(plan.sequences, plan.again_from, t, point, centre);
      REQUIRE(length(moved(motion, t, point, centre) - expected) < 1e-10 * (1 + length(expected)) * (1 + t));
    }
  }
}

TEST_CASE("far from the origin of the world, a motion is what it is near it") {
  const Vec3 utm{5e5, 5.4e6, 300};
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    Plan plan = any_plan(any);
    const PartMotion near(plan.sequences, plan.again_from);
    for (MotionSequence& s : plan.sequences)
      for (SteadyMotion& m : s.motions)
        if (m.centre) *m.centre = *m.centre + utm;
    const PartMotion far(plan.sequences, plan.again_from);
    const Vec3 centre = any.point(10), point = centre + any.point(3);
    const double t = any.uniform(0, 50);
    REQUIRE(length(moved(far, t, point + utm, centre + utm) - utm - moved(near, t, point, centre)) < 1e-6);
  }
}

TEST_CASE("the same tick gives the same displacement, in any order and from a copy, and its rotation is unit") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Plan plan = any_plan(any);
    const PartMotion motion(plan.sequences, plan.again_from), copy(motion);
    std::vector<Displacement> forwards;
    for (int k = 0; k < 100; ++k) forwards.push_back(motion.at(Tick::of_seconds(0.37 * k), {1, 2, 3}));
    for (int k = 100; k-- > 0;) {
      const Displacement d = copy.at(Tick::of_seconds(0.37 * k), {1, 2, 3});
      const auto& before = forwards[static_cast<std::size_t>(k)];
      REQUIRE(d.rotation == before.rotation);
      REQUIRE(d.shift == before.shift);
      REQUIRE(std::fabs(length(d.rotation) - 1) < 1e-14);
    }
  }
}

TEST_CASE("a body passes its timed poses, straight and at constant rates between them, and rests after the last") {
  const PartMotion motion(
      std::vector<TimedPose>{{1, {10, 0, 0}}, {3, {10, 4, 0}, rotation_about(axis::up, pi / 2)}, {4, {0, 4, 0}}});
  const Vec3 p{1, 0, 0};
  CHECK(length(moved(motion, 0, p) - Vec3{11, 0, 0}) < 1e-14);  // before the first pose it is there
  CHECK(length(moved(motion, 1, p) - Vec3{11, 0, 0}) < 1e-14);
  CHECK(length(moved(motion, 2, p) - Vec3{10 + std::sqrt(0.5), 2 + std::sqrt(0.5), 0}) < 1e-14);
  CHECK(length(moved(motion, 3, p) - Vec3{10, 5, 0}) < 1e-14);
  CHECK(length(moved(motion, 3.5, p) - Vec3{5 + std::sqrt(0.5), 4 + std::sqrt(0.5), 0}) < 1e-14);
  CHECK(length(moved(motion, 4, p) - Vec3{1, 4, 0}) < 1e-14);
  CHECK(length(moved(motion, 1e6, p) - Vec3{1, 4, 0}) < 1e-14);
}

TEST_CASE("timed poses may come again, and then each time at the same place") {
  const std::vector<TimedPose> poses{{0, {0, 0, 0}}, {2, {8, 0, 0}, rotation_about(axis::up, 1)}};
  const PartMotion motion(poses, AfterLastPose::start_again);
  CHECK(length(moved(motion, 0.5, {}) - Vec3{2, 0, 0}) < 1e-14);
  CHECK(length(moved(motion, 2, {}) - Vec3{0, 0, 0}) < 1e-14);
  CHECK(length(moved(motion, 6.5, {1, 0, 0}) - moved(motion, 0.5, {1, 0, 0})) < 1e-14);
  CHECK(length(moved(motion, 2e7 + 0.5, {1, 0, 0}) - moved(motion, 0.5, {1, 0, 0})) < 1e-12);
}

TEST_CASE("between any timed poses the attitude is that of spherical interpolation") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const TimedPose a{0.5, any.point(100), any.rotation()},
        b{0.5 + any.log_uniform(0.01, 10), any.point(100), any.rotation()};
    const PartMotion motion(std::vector<TimedPose>{a, b});
    const double s = any.uniform();
    const Vec3 p = any.point(5);
    const Vec3 expected = a.position + s * (b.position - a.position) + slerp(a.rotation, b.rotation, s) * p;
    REQUIRE(length(moved(motion, a.time + s * (b.time - a.time), p, any.point(10)) - expected) < 1e-10);
  }
}

TEST_CASE("a step done again and again is a steady motion") {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Rotation turn = any.whole(4) == 0 ? no_rotation : rotation_about(any.unit(), any.log_uniform(1e-6, 3));
    const Pose<frame::World, frame::World> step{turn, any.point(1)};
    const double seconds = any.log_uniform(1e-5, 10);
    const PartMotion motion(steady_motion(step, seconds));
    const Vec3 p = any.point(10);
    Vec3 expected = p;
    for (int n = 1; n <= 30; ++n) {
      expected = step.point(expected);
      REQUIRE(length(moved(motion, n * seconds, p, any.point(100)) - expected) < 1e-7);
    }
  }
}

TEST_CASE("the velocity of a point is what a body does at that time") {
  const auto at = [](double seconds) { return Tick::of_seconds(seconds); };
  const PartMotion orbit(
      SteadyMotion{.velocity = {0, 0, 1}, .angular_rate = 2, .centre = Vec3{10, 0, 0}, .spin = Vec3{}, .duration = 5});
  // a Ferris wheel's cabin: every point of it moves as its centre does
  for (const double x : {-3.0, 0.0, 4.0})
    CHECK(length(orbit.velocity(at(0), {13, 0, 0}, {13 + x, 1, 0}) - Vec3{0, 6, 1}) < 1e-12);
  CHECK(orbit.velocity(at(6), {13, 0, 0}, {13, 0, 0}) == Vec3{});
  CHECK(orbit.velocity({-1, 0.5}, {13, 0, 0}, {13, 0, 0}) == Vec3{});
  const PartMotion poses({{1, {0, 0, 0}, no_rotation}, {3, {4, 0, 0}, rotation_about(axis::up, 1)}});
  CHECK(poses.velocity(at(0.5), {9, 9, 9}, {1, 2, 3}) == Vec3{});
  CHECK(length(poses.velocity(at(2), {9, 9, 9}, {2, 6, 7}) - Vec3{2 - 0.5 * 6, 0, 0}) < 1e-12);
}

TEST_CASE("the velocity of any motion is the difference quotient of its places") {
  std::size_t checked = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Plan plan = any_plan(any);
    const PartMotion motion =
        any.whole(4) == 0 ? PartMotion(any_poses(any)) : PartMotion(plan.sequences, plan.again_from);
    const Vec3 centre = any.point(5), p = centre + any.point(2);
    for (int k = 0; k < 10; ++k) {
      const double seconds = any.uniform(0.01, 20), h = 1e-5;
      CAPTURE(seconds);
      const Vec3 before = moved(motion, seconds - h, p, centre), now = moved(motion, seconds, p, centre);
      const Vec3 after = moved(motion, seconds + h, p, centre);
      if (length(after - 2.0 * now + before) > 1e-7) continue;  // a change of motion in between
      CHECK(length(motion.velocity(Tick::of_seconds(seconds), centre, now) - (after - before) / (2 * h)) < 1e-4);
      ++checked;
    }
  }
  CHECK(checked > 3000);
}

TEST_CASE("what a body sweeps is inside of the box, whatever it does and however long") {
  std::size_t close = 0, all = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const bool by_poses = any.whole(4) == 0;
    const Plan plan = any_plan(any);
    std::vector<TimedPose> poses = any_poses(any);
    const bool again = any.coin() && poses.back().time > 0;
    const PartMotion motion = by_poses ? PartMotion(poses, again ? AfterLastPose::start_again : AfterLastPose::rest)
                                       : PartMotion(plan.sequences, plan.again_from);
    const Box box = any.box(10, 0.01, 5);
    const auto corners = detail::corners(box);
    const double from = any.coin() ? any.uniform(-1, 10) : any.log_uniform(1, 1e4);
    const double span = any.log_uniform(1e-4, any.coin() ? 1 : 300);
    CAPTURE(from);
    CAPTURE(span);
    const Box swept = motion.swept(box, {}, Tick::of_seconds(from), Tick::of_seconds(from + span));
    Box passed;
    for (int k = 0; k < 200; ++k) {
      const double t = k == 0 ? from : k == 1 ? from + span : any.uniform(from, from + span);
      const Vec3 p =
          moved(motion, t, box.min + box.size() * Vec3{any.uniform(), any.uniform(), any.uniform()}, box.centre());
      const Vec3 corner = moved(motion, t, corners[any.whole(8)], box.centre());
      passed.extend(p);
      passed.extend(corner);
    }
    Box both = swept;
    both.extend(passed);
    REQUIRE(both == swept);
    ++all;
    close += max_norm(swept.size()) < 2 * max_norm(passed.size()) ? 1 : 0;
  }
  CHECK(close > all / 2);  // ... and mostly not much larger
}

TEST_CASE("what a body sweeps on a polygon of many turns and steps is inside of the box") {
  // Each pass turns about one point and then steps aside so that all in all it turns about another, the middle of the
  // polygon.
  for (const double all : {0.5, 1.5, 1.9, 2.1, 4.0, 2 * pi}) {
    CAPTURE(all);
    const int passes = 100;
    const double turn = -all / passes;
    const Vec3 middle{0, 100, 0};
    const PartMotion motion(
        {{.motions = {{.angular_rate = turn, .centre = Vec3{}, .duration = 1},
                      {.velocity = middle - rotation_about(axis::up, turn) * middle, .duration = 1}}}},
        0);
    const Vec3 start = middle + rotation_about(axis::up, all / 2) * Vec3{0, 100, 0};
    const Box swept = motion.swept({start, start}, {}, {0, 0}, {2 * passes, 0});
    Box passed;
    for (int k = 0; k <= 40 * passes; ++k) passed.extend(moved(motion, 0.05 * k, start, start));
    Box both = swept;
    both.extend(passed);
    CHECK(both == swept);
  }
}

TEST_CASE("the box that is swept is as large as it has to be where that is plain") {
  const Box box{{-1, -2, -3}, {1, 2, 3}};
  const Box rest = PartMotion(SteadyMotion{}).swept(box, {}, {0, 0}, {1000, 0});
  CHECK(length(rest.max - box.max) < 1e-5);
  const Box way = PartMotion(SteadyMotion{.velocity = {3, 0, 0}}).swept(box, {}, {10, 0}, {12, 0});
  CHECK(length(way.min - Vec3{29, -2, -3}) < 1e-5);
  CHECK(length(way.max - Vec3{37, 2, 3}) < 1e-5);
  const double radius = length(box.max);
  const Box spin = PartMotion(SteadyMotion{.angular_rate = 10}).swept(box, {}, {0, 0}, {1000, 0});
  CHECK(max_norm(spin.max) < radius + 1e-5);
  const PartMotion there_and_back(
      {{.motions = {{.velocity = {3, 0, 0}, .duration = 1}, {.velocity = {-3, 0, 0}, .duration = 1}}}}, 0);
  const Box year = there_and_back.swept(box, {}, {0, 0}, {31'536'000, 0});
  CHECK(year.max.x < 3 + radius + 1e-5);
  CHECK(year.min.x > -radius - 1e-5);
}

TEST_CASE("what a body sweeps after very many short motions is inside of the box") {
  const MotionSequence rests{.motions = {{.duration = 0.01}}, .times = 40},
      steps{.motions = {{.velocity = axis::right, .duration = 0.01}}, .times = 1000};
  const MotionSequence turn{.motions = {{.angular_rate = 2 * pi, .centre = Vec3{}, .duration = 1}}},
      way{.motions = {{.velocity = axis::right}}};
  const MotionSequence there{.motions = {{.velocity = axis::right, .duration = 1}}},
      back{.motions = {{.velocity = -axis::right, .duration = 1}}};
  const Vec3 start{10, 0, 0};
  const auto swept = [&](const PartMotion& motion, double seconds) {
    return motion.swept({start, start}, {}, {}, Tick::of_seconds(seconds));
  };
  CHECK(swept(PartMotion({steps}), 5.005).max.x > 15.0049);
  CHECK(swept(PartMotion({rests, turn}), 1.4).min.x < -9.999);
  CHECK(swept(PartMotion({rests, way}), 10).max.x > 19.5999);
  CHECK(swept(PartMotion({rests, there, back}, 1), 3).max.x > 10.9999);
}

TEST_CASE("an archive of a run without motions is noticed") {
  PartMotion motion(SteadyMotion{.angular_rate = 1, .duration = 1});
  CHECK(motion.is_consistent());
  const auto empty = [](auto& runs, auto&...) { runs[0].end = runs[0].first; };
  motion.archive(empty);
  CHECK_FALSE(motion.is_consistent());
}

TEST_CASE("timed poses and steps of single precision move rigidly") {
  const Rotation rounded{0.6F, 0.8F, 0, 0};
  const PartMotion poses(std::vector<TimedPose>{{0, {}, rounded}, {1, axis::right, rounded}}),
      step(steady_motion({rounded, axis::right}, 1));
  for (const PartMotion& motion : {poses, step})
    for (const double t : {0.0, 0.5, 1.0, 2.0})
      CHECK(std::fabs(length(motion.at(Tick::of_seconds(t), {}).rotation) - 1) < 1e-14);
}

TEST_CASE("a motion refuses what cannot be") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](const SteadyMotion& m) {
    CHECK_THROWS_AS(PartMotion{m}, SettingError);
    CHECK_THROWS_AS((PartMotion{{{.motions = {m}}}, 0}), SettingError);
  };
  refused({.velocity = {nan, 0, 0}, .duration = 1});
  refused({.axis = {0, 0, 0}, .duration = 1});
  refused({.angular_rate = infinity, .duration = 1});
  refused({.centre = Vec3{nan, 0, 0}, .duration = 1});
  refused({.spin = Vec3{0, infinity, 0}, .duration = 1});
  for (const double bad : {0.0, -1.0, 1e-7, nan}) refused({.duration = bad});
  const SteadyMotion second{.duration = 1}, endless{};
  CHECK_NOTHROW(PartMotion({{.motions = {second}}, {.motions = {second, endless}}}));
  CHECK_THROWS_AS(PartMotion({{.motions = {endless}}, {.motions = {second}}}), SettingError);
  CHECK_THROWS_AS(PartMotion({{.motions = {endless, second}}}), SettingError);
  CHECK_THROWS_AS(PartMotion({{.motions = {endless}, .times = 2}}), SettingError);
  CHECK_THROWS_AS(PartMotion({{.motions = {endless}}}, 0), SettingError);
  CHECK_THROWS_AS(PartMotion({{.motions = {second}}}, 1), SettingError);
  CHECK_THROWS_AS(PartMotion({{.motions = {second}, .times = 0}}), SettingError);
  CHECK_THROWS_AS(PartMotion(std::vector<MotionSequence>(1)), SettingError);
  CHECK_THROWS_AS(PartMotion(std::vector<MotionSequence>{}), SettingError);
  CHECK_THROWS_AS(PartMotion(std::vector<TimedPose>{}), SettingError);
  CHECK_THROWS_AS(PartMotion(std::vector<TimedPose>{{1}, {1}}), SettingError);
  CHECK_THROWS_AS(PartMotion(std::vector<TimedPose>{{-1}}), SettingError);
  CHECK_THROWS_AS(PartMotion(std::vector<TimedPose>{{0}}, AfterLastPose::start_again), SettingError);
  CHECK_THROWS_AS(PartMotion(std::vector<TimedPose>{{0, {nan, 0, 0}}}), SettingError);
  CHECK_THROWS_AS(PartMotion(std::vector<TimedPose>{{0, {}, Rotation{2, 0, 0, 0}}}), SettingError);
  CHECK_THROWS_AS((void)steady_motion({}, 0), SettingError);
  CHECK_THROWS_AS((void)steady_motion({Rotation{2, 0, 0, 0}, {}}, 1), SettingError);
}
