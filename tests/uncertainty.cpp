// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/uncertainty.hpp>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/oscillating_mirror.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/platform/pose_errors.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/sensor/velodyne.hpp>

#include <doctest/doctest.h>

#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// Ground that rises to the north-east, and a wall on it that faces south.
struct Yard {
  double slope = 0.1, wall = 8, height = 4;  ///< of the ground; the wall's north and height [m]

  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    Hit hit{detail::infinity, 0, 0, 0, 0};
    const Vec3 normal = normalize(Vec3{-slope, -slope, 1});
    const auto meet = [&](const Vec3& n, double range, ObjectId object) {
      const double cosine = std::fabs(dot(n, ray.direction));
      if (range > 0 && range < hit.range) hit = {range, cosine, cosine / pi, object, 0};
    };
    meet(normal, -dot(normal, ray.origin) / dot(normal, ray.direction), 1);
    const double north = (wall - ray.origin.y) / ray.direction.y;
    const Vec3 at = ray.origin + north * ray.direction;
    if (at.z < slope * (at.x + at.y) + height) meet(axis::forward, north, 2);
    return hit.range < detail::infinity ? std::optional(hit) : std::nullopt;
  }
};

/// Eigenvalues and vectors of a covariance, by rotations. Source: Jacobi 1846.
struct Axes {
  Matrix3 vectors{1.0};
  Vec3 values{};

  explicit Axes(const Covariance& c) {
    double m[3][3] = {{c.xx, c.xy, c.xz}, {c.xy, c.yy, c.yz}, {c.xz, c.yz, c.zz}};
    for (int sweep = 0; sweep < 30; ++sweep)
      for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
        if (m[p][q] == 0) continue;
        const double angle = 0.5 * std::atan2(2 * m[p][q], m[q][q] - m[p][p]), cosine = std::cos(angle),
                     sine = std::sin(angle);
        for (int k = 0; k < 3; ++k) {
          const double a = m[k][p], b = m[k][q], u = vectors[p][k], v = vectors[q][k];
          m[k][p] = cosine * a - sine * b;
          m[k][q] = sine * a + cosine * b;
          vectors[p][k] = cosine * u - sine * v;
          vectors[q][k] = sine * u + cosine * v;
        }
        for (int k = 0; k < 3; ++k) {
          const double a = m[p][k], b = m[q][k];
          m[p][k] = cosine * a - sine * b;
          m[q][k] = sine * a + cosine * b;
        }
      }
    values = {m[0][0], m[1][1], m[2][2]};
  }
};

/// Whether an error lies within the bounds of chi-square of 50 and 95 %, with the rank of its covariance.
struct Within {
  bool half, most;
};
Within within(const Covariance& stated, const Vec3& error) {
  constexpr double bounds[3][2] = {{0.454936423, 3.841458821}, {1.386294361, 5.991464547}, {2.365973884, 7.814727903}};
  const Axes axes(stated);
  const double greatest = std::max({axes.values.x, axes.values.y, axes.values.z});
  double square = 0;
  int rank = 0;
  for (int k = 0; k < 3; ++k) {
    if (!(axes.values[k] > 1e-8 * greatest)) continue;
    const double along = dot(Vec3(axes.vectors[k]), error);
    square += along * along / axes.values[k];
    ++rank;
  }
  return {square <= bounds[rank - 1][0], square <= bounds[rank - 1][1]};
}

/// Shares of the points of many surveys, each with errors drawn anew, whose errors are within the bounds.
struct Coverage {
  double half = 0, most = 0, points = 0, flagged = 0, flagged_most = 0;
};

/// Of `pulses` pulses of each of the surveys `make(seed)`.
Coverage coverage_of(std::size_t surveys, PulseIndex pulses, const auto& make) {
  Coverage c;
  const auto first = make(0);
  const UncertaintyQuery uncertainty = uncertainty_of(first);
  for (std::uint64_t seed = 0; seed < surveys; ++seed) {
    const auto survey = make(seed);
    auto w = survey.workspace();
    for (PulseIndex k = 0; k < pulses; ++k) {
      const PulseIndex i = k * (survey.size() / pulses);
      const auto pulse = survey.source().pulse(i);
      if (!pulse) continue;
      const Outcome outcome = survey(i, w);
      // subrays are recorded by the reported pose
      const auto back = pulse->pose * pulse->reported.value_or(pulse->pose).inverse();
      Vec3 lit{};
      double power = 0;
      for (const SubrayRecord& subray : outcome.subrays) {
        if (!(subray.power > 0)) continue;
        lit += subray.power * (back.point(subray.point) - pulse->pose.position);
        power += subray.power;
      }
      for (const Echo& echo : outcome.echoes) {
        const PointUncertainty u = uncertainty(outcome.shot, echo);
        const Vec3 error = (point_of(outcome.shot, echo) - pulse->pose.position) - lit / power;
        const Within in = within(u.total(), error);
        (u.flags == 0 ? c.points : c.flagged) += 1;
        if (u.flags == 0) {
          c.half += in.half;
          c.most += in.most;
        } else {
          c.flagged_most += in.most;
        }
      }
    }
  }
  c.half /= std::max(1.0, c.points);
  c.most /= std::max(1.0, c.points);
  c.flagged_most /= std::max(1.0, c.flagged);
  return c;
}

/// Surveys of a scene in all; the environment variable PULSECAST_SURVEYS asks for another number.
std::size_t surveys() {
  const char* text = std::getenv("PULSECAST_SURVEYS");
  return text ? std::strtoul(text, nullptr, 10) : 200;
}

template <class Pattern>
auto judged(Pattern pattern) {
  return WithSubrayRecord{JudgedFootprint{std::move(pattern)}};
}

/// Checks a scene: its surveys are independent, the points of one are not.
void check(const char* name, const auto& make) {
  const double n = static_cast<double>(surveys());
  const Coverage c = coverage_of(surveys(), n > 1000 ? 100 : 20, make);
  const std::string text = std::string(name) + ": of " + std::to_string(c.points) + " points " +
                           std::to_string(100 * c.most) + " % within 95 %, " + std::to_string(100 * c.half) +
                           " % within 50 %; flagged " + std::to_string(c.flagged) + ", of these " +
                           std::to_string(100 * c.flagged_most) + " %";
  CAPTURE(text);
  MESSAGE(text);
  CHECK(c.points > 5 * n);
  CHECK(std::fabs(c.most - 0.95) < 0.01 + 4 * std::sqrt(0.0475 / n));
  CHECK(std::fabs(c.half - 0.5) < 0.02 + 4 * std::sqrt(0.25 / n));
}

}  // namespace

TEST_CASE("points of a tripod err as stated") {
  const Yard yard;
  check("tripod", [&](std::uint64_t seed) {
    const Laser laser{.wavelength = 1.55e-6, .peak_power = 100, .pulse_length = 2e-9, .divergence = 0.3e-3};
    return Survey{
        WithPoseErrors{Platform{Tripod{{5, -20, 3}}, Mount{},
                                Deflector{RotatingHead{.angular_rate = 0.5},
                                          Deflector{PolygonMirror{.line_rate = 20, .sweep = 0.3},
                                                    Scanner{.pulse_rate = 10e3, .pulses = 4000, .laser = laser}}}},
                       PoseErrors{.angular_jitter = 0.05_mrad,
                                  .seed = seed,
                                  .position_offset = 3_mm,
                                  .attitude_offset = {0.02_mrad, 0.02_mrad, 0.1_mrad}}},
        judged(LatticeFootprint{19}),
        yard,
        Receiver{.range_errors = {.deviation = 2_mm, .grows_with_incidence = true, .bias_deviation = 1_mm}},
        FullWaveform<>{},
        seed};
  });
}

TEST_CASE("points of an airplane with correlated pose errors err as stated") {
  const Yard yard;
  check("airplane", [&](std::uint64_t seed) {
    const Laser laser{.peak_power = 5e3, .pulse_length = 4e-9, .divergence = 0.25e-3};
    return Survey{
        WithPoseErrors{Platform{StraightLine{{-200, -300, 1000}, {200, 300, 1000}, 60},
                                Mount{.lever_arm = {0.2, -1, 0.5}, .boresight = rotation_about(axis::right, -90_deg)},
                                Deflector{OscillatingMirror{.cycle_rate = 50, .half_angle = 0.2},
                                          Scanner{.pulse_rate = 2e3, .pulses = 20000, .laser = laser}}},
                       PoseErrors{.position_noise = 5_mm,
                                  .attitude_noise = 0.01_mrad,
                                  .position_drift = {3_cm, 3_cm, 5_cm},
                                  .attitude_drift = {0.05_mrad, 0.05_mrad, 0.1_mrad},
                                  .drift_time = 3,
                                  .seed = seed,
                                  .lever_arm_deviation = 1_cm,
                                  .boresight_deviation = {0.02_mrad, 0.02_mrad, 0.07_mrad}}},
        judged(LatticeFootprint{19}),
        yard,
        Receiver{.range_min = 920, .range_max = 1100, .range_errors = {.scale_deviation = 1e-5}},
        FullWaveform<NoWidth, BandLimitedReceiver<>>{
            {.sample_interval = 1e-9, .threshold = 2e-8}, {}, BandLimitedReceiver<>{{.noise_power = 3e-13}}},
        seed};
  });
}

TEST_CASE("points of a drone err as stated") {
  const Yard yard;
  check("drone", [&](std::uint64_t seed) {
    const Laser laser{.wavelength = 905e-9, .peak_power = 50, .pulse_length = 5e-9, .divergence = {2e-3, 0.5e-3}};
    return Survey{
        WithPoseErrors{Platform{StraightLine{{-20, -30, 40}, {20, 30, 45}, 5},
                                Mount{.boresight = rotation_about(axis::right, -80_deg)},
                                Deflector{PolygonMirror{.line_rate = 30, .sweep = 0.4},
                                          Scanner{.pulse_rate = 1e3, .pulses = 14000, .laser = laser}}},
                       PoseErrors{.position_noise = {1_cm, 1_cm, 2_cm},
                                  .attitude_noise = {0.3_mrad, 0.3_mrad, 1_mrad},
                                  .attitude_drift = 0.2_mrad,
                                  .drift_time = 2,
                                  .angular_jitter = {0.1_mrad, 0, 0.4_mrad},
                                  .seed = seed,
                                  .lever_arm_deviation = {2_mm, 2_mm, 5_mm},
                                  .latency_deviation = 1e-3}},
        judged(SunflowerFootprint{37}),
        yard,
        Receiver{.range_min = 10, .range_max = 120, .range_errors = {.deviation = 1.5_cm, .bias_deviation = 2_mm}},
        FullWaveform<NoWidth, BandLimitedReceiver<>>{{.sample_interval = 1e-9, .threshold = 1e-7},
                                                     {},
                                                     BandLimitedReceiver<>{{.noise_power = 1e-12, .shot_noise = true}}},
        seed};
  });
}

TEST_CASE("points of a car err as stated") {
  const Yard yard;
  check("car", [&](std::uint64_t seed) {
    const Laser laser{.wavelength = 1.55e-6, .peak_power = 300, .pulse_length = 3e-9, .divergence = 0.35e-3};
    return Survey{
        WithPoseErrors{Platform{StraightLine{{-30, 0, 2}, {30, 2, 5}, 12},
                                Mount{.lever_arm = {0, -0.5, 1}, .boresight = rotation_about(axis::up, 45_deg)},
                                Deflector{PolygonMirror{.line_rate = 100, .sweep = 0.5},
                                          Scanner{.pulse_rate = 5e3, .pulses = 25000, .laser = laser}}},
                       PoseErrors{.position_drift = {2_cm, 2_cm, 4_cm},
                                  .attitude_drift = {0.1_mrad, 0.1_mrad, 0.3_mrad},
                                  .drift_time = 1,
                                  .seed = seed,
                                  .boresight_deviation = 0.2_mrad}},
        judged(TurnedFootprint{LatticeFootprint{19}}),
        yard,
        Receiver{.range_errors = {.deviation_at_watt = 4e-5, .power_exponent = -0.4}},
        FullWaveform<>{},
        seed};
  });
}

TEST_CASE("points of a spinning sensor err as stated") {
  const Yard yard;
  SpinningSensor sensor = velodyne_vlp_16();
  check("spinning sensor", [&](std::uint64_t seed) {
    return Survey{WithPoseErrors{Platform{StraightLine{{-3, -10, 1.8}, {3, 0, 2.0}, 1.5},
                                          Mount{.lever_arm = {0, 0, 0.4}}, sensor.source(1)},
                                 PoseErrors{.position_noise = 2_mm,
                                            .attitude_noise = 0.5_mrad,
                                            .seed = seed,
                                            .position_offset = 1_cm,
                                            .attitude_offset = 1_mrad,
                                            .boresight_deviation = 2_mrad}},
                  WithSubrayRecord{SingleRay{}},
                  yard,
                  sensor.receiver(),
                  FirstHit{},
                  seed};
  });
}

TEST_CASE("points of a satellite err as stated") {
  const Yard hill{.slope = 0.001};
  check("satellite", [&](std::uint64_t seed) {
    const Laser laser{.peak_power = 1e7, .pulse_length = 15e-9, .divergence = 25e-6};
    return Survey{
        WithPoseErrors{Platform{StraightLine{{0, -70e3, 500e3}, {0, 70e3, 500e3}, 7600},
                                Mount{.boresight = rotation_about(axis::right, -89.7_deg)},
                                Deflector{FixedBeam{}, Scanner{.pulse_rate = 40, .pulses = 700, .laser = laser}}},
                       PoseErrors{.position_noise = 5_cm,
                                  .attitude_noise = 1e-6,
                                  .position_drift = 10_cm,
                                  .attitude_drift = 5e-6,
                                  .drift_time = 5,
                                  .seed = seed,
                                  .boresight_deviation = 3e-6}},
        judged(LatticeFootprint{37}),
        hill,
        Receiver{.diameter = 0.8, .visibility = detail::infinity, .range_min = 499.85e3, .range_max = 500.15e3},
        FullWaveform<NoWidth, BandLimitedReceiver<>>{
            {.sample_interval = 1e-9, .threshold = 1e-9}, {}, BandLimitedReceiver<>{{.noise_power = 1e-14}}},
        seed};
  });
}

TEST_CASE("an airborne scanner states the closed form of the lidar equation") {
  // Source: Glennie 2007, for its magnitudes; derivatives of place + attitude (boresight beam range + lever arm),
  // written out
  const double position = 0.05, lever = 0.02, tilt = 0.005_deg, yaw = 0.007_deg, small = 0.001_deg,
               boresight_yaw = 0.004_deg;
  const double scan = 0.001_deg, range_noise = 8_mm;
  const Vec3 arm{0.3, -0.8, 0.2};
  const Rotation down = rotation_of(Matrix3{Vec3{0, 1, 0}, Vec3{0, 0, -1}, Vec3{-1, 0, 0}});  // scans across the flight
  const Yard plain{.slope = 0, .height = 0};
  for (const double heading : {0.0, 40.0, 215.0}) {
    const Vec3 way{std::sin(heading * 1_deg), std::cos(heading * 1_deg), 0};
    const Laser laser{.peak_power = 5e3};
    const Survey survey{WithPoseErrors{Platform{StraightLine{Vec3{5e5, 4e6, 1200} - 100.0 * way,
                                                             Vec3{5e5, 4e6, 1200} + 100.0 * way, 60},
                                                Mount{.lever_arm = arm, .boresight = down},
                                                Deflector{OscillatingMirror{.cycle_rate = 1, .half_angle = 20_deg},
                                                          Scanner{.pulse_rate = 20, .pulses = 60, .laser = laser}}},
                                       PoseErrors{.position_noise = position,
                                                  .attitude_noise = {tilt, tilt, yaw},
                                                  .angular_jitter = {scan, 0, 0},
                                                  .lever_arm_deviation = lever,
                                                  .boresight_deviation = {boresight_yaw, small, small}}},
                        SingleRay{}, plain, Receiver{.range_errors = {.deviation = range_noise}}, FirstHit{}};
    const UncertaintyQuery uncertainty = uncertainty_of(survey);
    for (PulseIndex i = 0; i < survey.size(); ++i) {
      const auto pulse = survey.source().truth().pulse(i);  // at the true place, as drawn errors move it by some 1e-4
      const double r = pulse->origin().z / -pulse->direction().z;
      const Shot shot{.index = i, .tick = pulse->tick, .origin = pulse->origin(), .direction = pulse->direction()};
      const PointUncertainty u = uncertainty(shot, Echo{.range = r, .amplitude = 1e-6});
      const double angle = survey.source().truth().source().moving().angle(pulse->tick);
      const double sine = std::sin(angle), cosine = std::cos(angle);
      const Vec3 beam{-r * sine, 0, -r * cosine}, p = beam + arm;  // in the body
      const double along = range_noise * range_noise, across = r * r * scan * scan;
      // boresight: about the scanner's right (north in the body), forward (down) and up (west)
      const double about_north = boresight_yaw * boresight_yaw, about_down = small * small, about_west = small * small;
      Covariance random, systematic;
      random.xx = position * position + tilt * tilt * p.z * p.z + yaw * yaw * p.y * p.y + along * sine * sine +
                  across * cosine * cosine;
      random.yy = position * position + tilt * tilt * p.z * p.z + yaw * yaw * p.x * p.x;
      random.zz =
          position * position + tilt * tilt * (p.x * p.x + p.y * p.y) + along * cosine * cosine + across * sine * sine;
      random.xy = -yaw * yaw * p.x * p.y;
      random.xz = -tilt * tilt * p.x * p.z + (along - across) * sine * cosine;
      random.yz = -tilt * tilt * p.y * p.z;
      systematic.xx = lever * lever + about_north * beam.z * beam.z;
      systematic.yy = lever * lever + about_down * beam.x * beam.x + about_west * beam.z * beam.z;
      systematic.zz = lever * lever + about_north * beam.x * beam.x;
      systematic.xz = -about_north * beam.x * beam.z;
      const Rotation back = conjugate(level(heading * 1_deg));
      const auto in_body = [&](const Covariance& c) { return c.in_axes([&](const Vec3& v) { return back * v; }); };
      const auto same = [&](const Covariance& found, const Covariance& expected) {
        const double size = std::max({expected.xx, expected.yy, expected.zz});
        for (const auto element :
             {&Covariance::xx, &Covariance::yy, &Covariance::zz, &Covariance::xy, &Covariance::xz, &Covariance::yz})
          CHECK(std::fabs(found.*element - expected.*element) < 1e-9 * size);
      };
      same(in_body(u.random), random);
      same(in_body(u.systematic), systematic);
      CHECK(u.flags == 0);
    }
  }
}

TEST_CASE("the footprint on the surface adds what a plane spreads, if asked for") {
  const Yard yard;
  const Survey survey{
      Platform{Tripod{{0, -12, 2}}, Mount{},
               Deflector{FixedBeam{}, Scanner{.pulse_rate = 10, .pulses = 1, .laser = {.divergence = 5e-3}}}},
      JudgedFootprint{LatticeFootprint{19}}, yard, Receiver{}, AnalyticWaveform<>{}};
  auto w = survey.workspace();
  const Outcome outcome = survey(0, w);
  REQUIRE(outcome.echoes.size() == 1);
  const Echo& echo = outcome.echoes[0];
  const Covariance none = uncertainty_of(survey)(outcome.shot, echo).total();
  const Covariance spread = uncertainty_of(survey, {.footprint = true})(outcome.shot, echo).total();
  const double wide = 0.25 * 5e-3 * echo.range, cosine = echo.cos_incidence;
  CHECK(spread.xx - none.xx == support::relative(wide * wide, 1e-6));
  CHECK(spread.yy - none.yy == support::relative(wide * wide * (1 / (cosine * cosine) - 1), 1e-6));
  CHECK(spread.xx + spread.yy + spread.zz - none.xx - none.yy - none.zz ==
        support::relative(wide * wide * (1 + 1 / (cosine * cosine)), 1e-6));
}

TEST_CASE("a surface is judged by all subrays: one plane, evenly bright") {
  struct Bowl {  // sphere of a radius about the origin, seen from inside; or a step, or paint, north of it
    double radius = 1e9, step = 0, paint = 1;
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
      if (radius < 1e9) return Hit{radius, 1, 1 / pi, 1, 0};
      const bool east = ray.direction.x > 0;
      return Hit{(10 + (east ? step : 0)) / ray.direction.y, ray.direction.y, (east ? paint : 1) * ray.direction.y / pi,
                 1, 0};
    }
  };
  const auto judged_as = [](const Bowl& bowl, std::size_t subrays = 19, double waist = 0) {
    const Laser laser{.divergence = 2e-3, .waist_diameter = waist};
    const Survey survey{
        Platform{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulse_rate = 10, .pulses = 1, .laser = laser}}},
        JudgedFootprint{LatticeFootprint{subrays}}, bowl, Receiver{}, AnalyticWaveform<>{}};
    auto w = survey.workspace();
    return survey(0, w).shot.surface;
  };
  CHECK(judged_as({}) == MetSurface::smooth);
  CHECK(judged_as({.radius = 10}) == MetSurface::smooth);  // 2.5 mm of footprint at 10 m
  CHECK(judged_as({.radius = 0.05}) == MetSurface::smooth);
  CHECK(judged_as({.step = 1_mm}) == MetSurface::mixed);
  CHECK(judged_as({.step = 0.01_mm}) == MetSurface::smooth);
  CHECK(judged_as({.paint = 0.5}) == MetSurface::mixed);
  CHECK(judged_as({.paint = 0.98}) == MetSurface::smooth);
  for (std::size_t subrays = 5; subrays < 24; ++subrays)  // of which four are judged at a time
    for (const double waist : {0.0, 0.02}) {
      CAPTURE(subrays);
      CHECK(judged_as({}, subrays, waist) == MetSurface::smooth);
      CHECK(judged_as({.step = 10_mm}, subrays, waist) == MetSurface::mixed);
      CHECK(judged_as({.paint = 0.2}, subrays, waist) == MetSurface::mixed);
    }
  CHECK(judged_as({.step = 10_mm}, 3) == MetSurface::unjudged);  // three always lie on a plane
}

TEST_CASE("points say why they may err more than stated") {
  const Yard yard;
  const auto flags = [&](const auto& footprint, double wavelength_power, const auto& detector) {
    const Survey survey{
        Platform{Tripod{{0, -12, 2}}, Mount{},
                 Deflector{FixedBeam{}, Scanner{.pulse_rate = 10,
                                                .pulses = 1,
                                                .laser = {.peak_power = wavelength_power, .divergence = 1e-3}}}},
        footprint, yard, Receiver{}, detector};
    auto w = survey.workspace();
    const Outcome outcome = survey(0, w);
    REQUIRE(outcome.echoes.size() == 1);
    return uncertainty_of(survey)(outcome.shot, outcome.echoes[0]).flags;
  };
  CHECK(flags(JudgedFootprint{LatticeFootprint{19}}, 100, AnalyticWaveform<>{{.timing = EchoTiming::true_range}}) == 0);
  CHECK(flags(LatticeFootprint{19}, 100, AnalyticWaveform<>{{.timing = EchoTiming::true_range}}) ==
        PointUncertainty::mixed);
  CHECK(flags(SingleRay{}, 100, FirstHit{}) == 0);
}

namespace {

/// Laser on a fixed mount that states given errors.
struct Stating : Deflector<FixedBeam, Scanner> {
  PoseError<frame::Instrument> error;
  void visit_errors(PulseIndex, Tick, const auto& visit) const noexcept { visit(error); }
};

}  // namespace

TEST_CASE("all parts of one stated error add to the uncertainty of a point, whichever are there") {
  const Yard yard;
  for (int parts = 0; parts < 32; ++parts) {
    CAPTURE(parts);
    PoseError<frame::Instrument> error;
    if (parts & 1) error.moved = {0.01, -0.02, 0.03};
    if (parts & 2) error.turned = {3e-3, 1e-3, -2e-3};
    if (parts & 4) error.moved_any_way = 0.02;
    if (parts & 8) error.turned_any_way = 1e-3;
    if (parts & 16) error.about = Vec3{3, -2, 1};
    const Mount mount{.lever_arm = {0, 0, 0.5}, .boresight = rotation_about(axis::up, 0.3)};
    const Stating source{{FixedBeam{}, Scanner{.pulse_rate = 10, .pulses = 1}}, error};
    const Survey survey{Platform{Tripod{{0, -12, 2}}, mount, source}, SingleRay{}, yard, Receiver{}, FirstHit{}};
    auto w = survey.workspace();
    const Outcome outcome = survey(0, w);
    REQUIRE(outcome.echoes.size() == 1);
    Covariance expected;
    survey.source().visit_errors(0, {}, [&](const PoseError<frame::World>& e) noexcept {
      support::detail::add_to(expected, e, *survey.source().pulse(0), point_of(outcome.shot, outcome.echoes[0]));
    });
    const Covariance stated = uncertainty_of(survey)(outcome.shot, outcome.echoes[0]).random;
    for (const auto member :
         {&Covariance::xx, &Covariance::yy, &Covariance::zz, &Covariance::xy, &Covariance::xz, &Covariance::yz})
      CHECK(std::fabs(stated.*member - expected.*member) < 1e-12);
  }
}
