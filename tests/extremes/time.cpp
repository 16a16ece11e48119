// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Time of survey: pulse 1 to pulse 10^12, a year at 31 688 Hz. What an optic does with a pulse is held against exact
// turns.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/random.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fiber_array.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/oscillating_mirror.hpp>
#include <pulsecast/deflector/palmer_mirror.hpp>
#include <pulsecast/deflector/pattern_table.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/legs.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/pose_errors.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/platform/waypoints.hpp>
#include <pulsecast/scanner/channels.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/survey.hpp>

#include "extremes/row.hpp"

using namespace pulsecast;
using namespace pulsecast::extremes;
using namespace pulsecast::literals;

namespace {

__extension__ typedef unsigned __int128 Wide;
using Real = long double;

const std::string quantity = "time of survey";
constexpr std::uint64_t rate = 31688;           // [Hz]
constexpr PulseIndex late = 1'000'000'000'000;  // after a year
constexpr PulseIndex window = 20'000;           // pulses that are looked at
constexpr PulseIndex all = late + 2 * window;   // that the surveys have
constexpr double frequency = 48.8125;           // of clockworks, in whole sixteenths [Hz]
constexpr std::uint64_t sixteenths = 781;       // of it
constexpr Real turn = 6.283185307179586476925286766559L;
const Scanner scanner{.pulse_rate = rate, .pulses = all};

/// Whole turns of a clockwork of a frequency in sixteenths of a hertz when slot i begins, and the rest.
struct Turns {
  std::uint64_t whole;
  Real phase;
};
Turns turns(PulseIndex i, std::uint64_t n = sixteenths) {
  const Wide numerator = static_cast<Wide>(i) * n, denominator = static_cast<Wide>(rate) * 16;
  return {static_cast<std::uint64_t>(numerator / denominator),
          static_cast<Real>(static_cast<std::uint64_t>(numerator % denominator)) / static_cast<Real>(rate * 16)};
}

struct Direction {
  Real x, y, z;
};

Direction above(Real angle) { return {0, std::cos(angle), std::sin(angle)}; }

/// The largest error of the direction of some pulses from one on [rad].
template <class Source>
double worst(const Source& source, PulseIndex first, const std::function<Direction(PulseIndex)>& right_one) {
  Real worst = 0;
  for (PulseIndex i = first; i < first + window; ++i) {
    const auto pulse = source.pulse(i);
    REQUIRE(pulse);
    const Vec3 d = pulse->direction();
    const Direction r = right_one(i);
    worst = std::max(worst, std::hypot(std::hypot(d.x - r.x, d.y - r.y), d.z - r.z));
  }
  return static_cast<double>(worst);
}

/// A row at the first pulse and one after a year.
template <class Source>
void directions(const std::string& name, const Source& source, const std::function<Direction(PulseIndex)>& right_one) {
  row(quantity, name + ", 20 000 pulses from pulse 1: largest error [rad]", 0, worst(source, 1, right_one), 1e-11);
  row(quantity, name + ", 20 000 pulses from pulse 1e12: largest error [rad]", 0, worst(source, late, right_one),
      1e-11);
}

}  // namespace

TEST_CASE("the time of a pulse") {
  Real worst = 0;
  for (PulseIndex i = late; i < late + window; ++i) {
    const Tick tick = scanner.pulse(i)->tick;
    const Turns exact = turns(i, 16);
    worst = std::max(worst, std::fabs(static_cast<Real>(tick.second - static_cast<std::int64_t>(exact.whole)) +
                                      (static_cast<Real>(tick.fraction) - exact.phase)));
  }
  row(quantity, "20 000 pulses from pulse 1e12: largest error of the time [s]", 0, static_cast<double>(worst), 1e-15);
  refused(quantity, "2^53 pulses", [] { Scanner{.pulse_rate = 1e6, .pulses = PulseIndex{1} << 53}.validate(); });
  refused(quantity, "2^52 pulses at 1 Hz", [] { Scanner{.pulse_rate = 1, .pulses = PulseIndex{1} << 52}.validate(); });
}

TEST_CASE("the phase of each optic") {
  const double tilt = 20_deg;
  directions("OscillatingMirror, triangle",
             Deflector{OscillatingMirror{.cycle_rate = frequency, .half_angle = tilt}, scanner}, [&](PulseIndex i) {
               const Real phase = turns(i).phase;
               return above(tilt * (phase < 0.5L ? 4 * phase - 1 : 3 - 4 * phase));
             });
  directions("OscillatingMirror, sine",
             Deflector{OscillatingMirror{.cycle_rate = frequency, .half_angle = tilt, .swing = Swing::sine}, scanner},
             [&](PulseIndex i) { return above(-tilt * std::cos(turn * turns(i).phase)); });
  directions("PalmerMirror", Deflector{PalmerMirror{.rotation_rate = frequency, .half_angle = tilt}, scanner},
             [&](PulseIndex i) {
               const Real angle = turn * turns(i).phase, off = tilt;
               return Direction{std::sin(off) * std::sin(angle), std::cos(off), std::sin(off) * std::cos(angle)};
             });
  const std::vector<double> tilts{0, 1_deg, 2_deg};
  // where a pulse and a line begin together, the tick may round to the end of the line before
  const PolygonMirror polygon{.line_rate = rate / 8.0, .sweep = 6_deg, .facet_tilts = tilts};
  directions("PolygonMirror of three facets, a line in eight pulses", Deflector{polygon, scanner}, [&](PulseIndex i) {
    const bool before = i % 8 == 0 && polygon.angle(Tick::of(i, rate)) > 0;
    const Real phase = before ? 1 : static_cast<Real>(i % 8) / 8, angle = static_cast<Real>(6_deg) * (2 * phase - 1);
    const Real aside = tilts[(i / 8 + (before ? 2 : 0)) % 3];
    return Direction{std::sin(aside), std::cos(aside) * std::cos(angle), std::cos(aside) * std::sin(angle)};
  });
  directions("FiberArray of 127 fibres at the pulse rate",
             Deflector{FiberArray{.fibers = 127, .fiber_rate = rate, .half_angle = tilt}, scanner},
             [&](PulseIndex i) { return above(tilt * (2 * static_cast<Real>(i % 127) / 126 - 1)); });
  std::vector<BeamAngles> entries;
  for (int k = 0; k < 1009; ++k) entries.push_back({0.5 * std::sin(k), 0.3 * std::cos(2 * k)});
  directions("PatternTable of 1009 entries at the pulse rate",
             Deflector{PatternTable{.entries = entries, .entry_rate = rate}, scanner}, [&](PulseIndex i) {
               const Real azimuth = entries[i % 1009].azimuth, elevation = entries[i % 1009].elevation;
               return Direction{std::cos(elevation) * std::sin(azimuth), std::cos(elevation) * std::cos(azimuth),
                                std::sin(elevation)};
             });
  directions("RotatingHead at half a turn a second",
             Deflector{RotatingHead{.angular_rate = pi}, Deflector{FixedBeam{}, scanner}}, [&](PulseIndex i) {
               const Real angle = turn * turns(i, 8).phase;
               return Direction{-std::sin(angle), std::cos(angle), 0};
             });
  const double apart =
      worst(Deflector{RotatingHead{.angular_rate = 10}, Deflector{FixedBeam{}, scanner}}, late, [&](PulseIndex i) {
        const Real angle = std::remainder(10 * static_cast<Real>(i) / rate, turn);
        return Direction{-std::sin(angle), std::cos(angle), 0};
      });
  row(quantity,
      "RotatingHead at 10 rad/s, the same: largest error, of what half a unit in the last place of its rate makes up",
      0, apart / (0x1p-50 * static_cast<double>(late) / rate), 2);
  // a thin end of glass before the beam, which turns: entered through the inclined face, left through the square one
  const double wedge = 0.3, index = 1.5;
  directions(
      "RisleyPrisms",
      Deflector{RisleyPrisms{.prisms = {{.wedge = wedge, .rotation_rate = frequency, .refractive_index = index}}},
                scanner},
      [&](PulseIndex i) {
        const Real inside =
            std::asin(std::sin(static_cast<Real>(wedge)) / index);  // from the normal of the inclined face
        const Real off = std::asin(index * std::sin(wedge - inside)), angle = turn * turns(i).phase;
        return Direction{-std::sin(off) * std::sin(angle), std::cos(off), -std::sin(off) * std::cos(angle)};
      });
  refused(quantity, "a mirror at 0 Hz", [] { OscillatingMirror{.cycle_rate = 0}.validate(); });
  refused(quantity, "a mirror at 1e13 Hz", [] { OscillatingMirror{.cycle_rate = 1e13}.validate(); });
  refused(quantity, "a cone at 1e13 Hz", [] { PalmerMirror{.rotation_rate = 1e13}.validate(); });
  refused(quantity, "a polygon at 1e13 Hz", [] { PolygonMirror{.line_rate = 1e13}.validate(); });
  refused(quantity, "fibres at 1e13 Hz", [] { FiberArray{.fiber_rate = 1e13}.validate(); });
  refused(quantity, "a table at 1e13 Hz", [] { PatternTable{.entries = {{}}, .entry_rate = 1e13}.validate(); });
  refused(quantity, "a head at 1e13 rad/s", [] { RotatingHead{.angular_rate = 1e13}.validate(); });
  refused(quantity, "a head that starts at 1e12 rad", [] { RotatingHead{.start = 1e12}.validate(); });
  refused(quantity, "a prism at 1e13 Hz", [] { RisleyPrisms{.prisms = {{.rotation_rate = 1e13}}}.validate(); });
  refused(quantity, "a prism that starts at 1e12 rad", [] { RisleyPrisms{.prisms = {{.start = 1e12}}}.validate(); });
}

TEST_CASE("channels and legs") {
  const Channels device{std::vector<Scanner>(16, Scanner{.pulse_rate = rate / 16.0, .pulses = all / 16})};
  const std::vector<Emitter> emitters = device.emitters();
  std::uint64_t wrong = 0;
  for (PulseIndex i = late; i < late + window; ++i) {
    const auto pulse = device.pulse(i);
    wrong +=
        pulse && emitters[pulse->emitter].channel == i % 16 && pulse->tick == Tick::of(i / 16, rate / 16.0) ? 0 : 1;
  }
  row(quantity, "Channels, 20 000 slots from 1e12: of a wrong channel or time", 0, static_cast<double>(wrong), 0);

  // strips of 10^6 seconds less a bit: starts are sums of what has no exact fraction
  constexpr PulseIndex each = 12'345'678'901;
  using Strip = Platform<Tripod, Deflector<FixedBeam, Scanner>>;
  const Legs strips{std::vector<Strip>(
      82, Strip{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulse_rate = rate, .pulses = each}}})};
  Real worst = 0;
  wrong = 0;
  for (PulseIndex i = late; i < late + window; ++i) {
    const auto pulse = strips.pulse(i);
    REQUIRE(pulse);
    wrong += pulse->leg == i / each ? 0 : 1;
    const Turns exact = turns(i, 16);
    worst = std::max(worst, std::fabs(static_cast<Real>(pulse->tick.second - static_cast<std::int64_t>(exact.whole)) +
                                      (static_cast<Real>(pulse->tick.fraction) - exact.phase)));
  }
  row(quantity, "Legs, 20 000 pulses from pulse 1e12: of a wrong leg", 0, static_cast<double>(wrong), 0);
  row(quantity, "Legs, 82 end to end, 20 000 pulses from pulse 1e12: largest error of the time [s]", 0,
      static_cast<double>(worst), 1e-13);
  const auto longest = [](double pulse_rate) {
    return Strip{Tripod{}, Mount{},
                 Deflector{FixedBeam{}, Scanner{.pulse_rate = pulse_rate, .pulses = PulseIndex{1} << 52}}};
  };
  refused(quantity, "Legs of 2^62 slots together", [&] { return Legs{std::vector<Strip>(1024, longest(1e9))}; });
  refused(quantity, "Legs of 1.8e15 s together", [&] { return Legs{std::vector<Strip>(2, longest(5))}; });
}

TEST_CASE("trajectories") {
  const auto error = [](const auto& path, Real position, PulseIndex i) {
    return std::fabs(static_cast<Real>(path.at(Tick::of(i, rate)).position.y) - position);
  };
  Real slow = 0, fast = 0, between = 0, smooth = 0;
  const StraightLine survey{.to = {0, 1e6, 0}, .speed = 0.0078125},
      orbit{.from = {0, -1e9, 0}, .to = {0, 1e9, 0}, .speed = 32};
  const auto begin = static_cast<double>(late / rate);  // a whole second, shortly before the pulse
  std::vector<TimedPose> points;
  for (int k = 0; k < 5; ++k) points.push_back({.time = begin + k, .position = {0, 32.0 * k, 0}});
  const Waypoints linear{points}, cubic{points, Interpolation::cubic};
  for (PulseIndex i = late; i < late + window; ++i) {
    const Turns t = turns(i, 16);
    const Real time = static_cast<Real>(t.whole) + t.phase,
               since = (static_cast<Real>(t.whole) - static_cast<Real>(begin)) + t.phase;
    slow = std::max(slow, error(survey, 0.0078125L * time, i));
    fast = std::max(fast, error(orbit, 32 * time - 1e9L, i));
    between = std::max(between, error(linear, 32 * since, i));
    smooth = std::max(smooth, error(cubic, 32 * since, i));
  }
  row(quantity, "StraightLine at 8 mm/s, 246 km on: largest error of the position [m]", 0, static_cast<double>(slow),
      1e-8);
  row(quantity, "StraightLine at 32 m/s, 1 000 000 km on: largest error of the position [m]", 0,
      static_cast<double>(fast), 1e-5);
  row(quantity, "Waypoints at 32 m/s after a year: largest error of the position [m]", 0, static_cast<double>(between),
      1e-12);
  row(quantity, "Waypoints, cubic, at 32 m/s after a year: largest error of the position [m]", 0,
      static_cast<double>(smooth), 1e-12);
  refused(quantity, "a waypoint at 1e16 s", [] { return Waypoints{{{.time = 1e16}}}; });
  refused(quantity, "a line that takes 1e16 s", [] { StraightLine{.to = {0, 1e8, 0}, .speed = 1e-8}.validate(); });
}

TEST_CASE("the errors of a pose") {
  const auto tripod = [](double duration) {
    return Platform{
        Tripod{}, Mount{},
        Deflector{FixedBeam{}, Scanner{.pulse_rate = rate, .pulses = static_cast<PulseIndex>(duration * rate)}}};
  };
  constexpr double year = 31'557'600, hour = 3600;
  const WithPoseErrors drifting{tripod(year), PoseErrors{.position_drift = 1, .drift_time = hour, .seed = 7}};

  // the same walk in extended precision, fifty steps an hour
  const Real kept = std::exp(-1 / 50.0L), fresh = std::sqrt(1 - kept * kept);
  const auto draw = [](std::uint64_t n) { return static_cast<Real>(normal({7, n, 0, Purpose::position_drift})); };
  Real drift = draw(0), worst = 0, squares = 0;
  const auto steps = static_cast<std::uint64_t>(year / hour * 50);
  for (std::uint64_t n = 1; n <= steps; ++n) {
    const Real before = drift;
    drift = kept * drift + fresh * draw(n);
    squares += drift * drift;
    if (n + 500 < steps) continue;
    for (int k = 0; k < 8; ++k) {  // eighths of a step of 72 s
      const Tick t{static_cast<std::int64_t>((n - 1) * 72 + static_cast<std::uint64_t>(9 * k)), 0};
      worst = std::max(
          worst, std::fabs(drifting.reported(t).position.x - (before + (drift - before) * static_cast<Real>(k) / 8)));
    }
  }
  row(quantity,
      "PoseErrors, a Gauss-Markov drift of 1 m and an hour, in the last ten hours of a year: largest error [m]", 0,
      static_cast<double>(worst), 1e-9);
  row(quantity, "PoseErrors, the same drift: its deviation over the year [m]", 1,
      static_cast<double>(std::sqrt(squares / static_cast<Real>(steps))), 0.05);
  refused(quantity, "a drift of 1 s through a year", [&] {
    return WithPoseErrors{tripod(year), PoseErrors{.position_drift = 1, .drift_time = 1}};
  });

  // moments in the upper half of a second; those of another second which differ in the bit that the second changes
  const WithPoseErrors noisy{tripod(year), PoseErrors{.position_noise = 1, .seed = 7}};
  std::uint64_t same = 0;
  for (int k = 0; k < 1000; ++k) {
    const double fraction = 0.5 + k / 4096.0,
                 other = std::bit_cast<double>(std::bit_cast<std::uint64_t>(fraction) ^ 2U);
    same += noisy.reported({31'000'000, fraction}).position == noisy.reported({31'000'001, other}).position ? 1 : 0;
    same += noisy.reported({31'000'000, fraction}).position == noisy.reported({31'000'001, fraction}).position ? 1 : 0;
  }
  row(quantity, "PoseErrors, white noise of 2000 pairs of moments in two seconds: how many are alike", 0,
      static_cast<double>(same), 0);
}

TEST_CASE("random numbers") {
  constexpr int n = 1'000'000;
  double sum = 0, squares = 0, neighbours = 0, before = 0;
  std::uint64_t same = 0;
  for (PulseIndex i = late; i < late + n; ++i) {
    const double x = normal({.seed = 3, .pulse = i}), wrapped = normal({.seed = 3, .pulse = i & 0xFFFFFFFF});
    sum += x;
    squares += x * x;
    neighbours += x * before;
    before = x;
    same += x == wrapped ? 1 : 0;
  }
  row(quantity, "normal numbers of 1e6 pulses from pulse 1e12: mean", 0, sum / n, 0.004);
  row(quantity, "normal numbers of 1e6 pulses from pulse 1e12: variance", 1, squares / n, 0.006);
  row(quantity, "normal numbers of 1e6 pulses from pulse 1e12: correlation of neighbours", 0, neighbours / n, 0.004);
  row(quantity, "normal numbers of 1e6 pulses from pulse 1e12: how many are those of a pulse 232 * 2^32 before", 0,
      static_cast<double>(same), 0);
}

TEST_CASE("a whole survey") {
  // a polygon across a flight over a plane: the range of each echo is height by cosine
  struct Plane {
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
      if (!(ray.direction.z < 0)) return std::nullopt;
      return Hit{.range = -ray.origin.z / ray.direction.z};
    }
  };
  const Mount down{.boresight = rotation_about(axis::right, -90_deg)};
  const Platform source{StraightLine{.from = {0, 0, 1000}, .to = {0, 4e9, 1000}, .speed = 64}, down,
                        Deflector{PolygonMirror{.line_rate = frequency, .sweep = 30_deg}, scanner}};
  const Plane plane;
  const Survey survey{source, SingleRay{}, plane, Receiver{}, FirstHit{}};
  auto workspace = survey.workspace();
  Real worst = 0;
  for (PulseIndex i = late; i < late + window; ++i) {
    const Outcome outcome = survey(i, workspace);
    REQUIRE(outcome.echoes.size() == 1);
    worst = std::max(worst, std::fabs(outcome.echoes[0].range -
                                      1000 / std::cos(static_cast<Real>(30_deg) * (2 * turns(i).phase - 1))));
  }
  row(quantity, "a survey from 1 km, 20 000 pulses from pulse 1e12: largest error of the range [m]", 0,
      static_cast<double>(worst), 1e-9);
}
