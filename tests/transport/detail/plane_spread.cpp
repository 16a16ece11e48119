// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/transport/detail/plane_spread.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include <doctest/doctest.h>

#include "support/generators.hpp"
#include "support/light.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// Coat of a plane, by the tangents of the angles off the axis.
struct Coat {
  double reflectance = 0.5;
  std::uint16_t label = 1;
};
using Paint = std::function<Coat(double across, double up)>;

/// Plane that is met at a range on the axis, tilted about an axis across the beam [rad]; behind a step, `deeper` [m].
struct Slope {
  double range, tilt, about = 0, deeper = 0;
  Paint paint = [](double, double) { return Coat{}; };

  [[nodiscard]] Vec3 normal() const {
    return {std::sin(tilt) * std::cos(about), std::cos(tilt), std::sin(tilt) * std::sin(about)};
  }
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double along = dot(normal(), ray.direction);
    if (!(along > 0)) return {};
    const double behind = dot(ray.direction, {std::cos(about), 0, std::sin(about)}) > 0 ? deeper : 0;
    const double way = dot(normal(), range * axis::forward - ray.origin) / along + behind;
    const Vec3 p = ray.origin + way * ray.direction;
    const Coat coat = paint(p.x / p.y, p.z / p.y);
    return Hit{.range = way,
               .cos_incidence = along,
               .backscatter = coat.reflectance * along,
               .object = ObjectId{coat.label},
               .classification = coat.label};
  }
};

/// Paint on either side of a straight edge, at so many deviations of the beam from the axis.
Paint edge(const Laser& laser, double angle, double at, Coat inside, Coat outside) {
  const double deviation = laser.divergence.across / 4;
  return [=](double across, double up) {
    return (across * std::cos(angle) + up * std::sin(angle)) / deviation < at ? inside : outside;
  };
}

const Receiver vacuum{.visibility = std::numeric_limits<double>::infinity()};

/// Strongest echo of a pulse, and the number of those that reach a hundredth of it.
struct Seen {
  std::size_t echoes = 0;
  Echo strongest{};
  Outcome outcome{};
};

template <Footprint Pattern, class Map, Detector Instrument, class Light = DirectLight>
Seen pulse_on(const Map& map, const Laser& laser, const Pattern& footprint, const Instrument& detector,
              Light light = {}) {
  const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1, .laser = laser}}};
  const Survey survey{source, footprint, map, light, vacuum, detector};
  auto w = survey.workspace();
  Seen seen{.outcome = survey(0, w)};
  for (const Echo& echo : seen.outcome.echoes)
    if (echo.amplitude > seen.strongest.amplitude) seen.strongest = echo;
  for (const Echo& echo : seen.outcome.echoes) seen.echoes += echo.amplitude >= 0.01 * seen.strongest.amplitude ? 1 : 0;
  return seen;
}

/// Detector that finds every maximum.
template <EchoWidth Width = NoWidth>
FullWaveform<Width> waveform(EchoTiming timing = EchoTiming::true_range, double interval = 0.25e-9) {
  return FullWaveform<Width>{
      {.sample_interval = interval, .threshold = 1e-30, .window = 0, .returns_max = 255, .timing = timing}};
}

/// Echo of a plane by 100,000 rays: places relative to the plane's range on the axis [m], of the pulse's maximum.
struct Truth {
  double mean = 0, centroid = 0, peak = 0, spread = 0;
  std::size_t maxima = 0;
  bool bright = false;  // whether the coat that sends back the most at the maximum is of the label 2
};

/// Centre of what exceeds a tenth of the maximum [samples].
double centre(const std::vector<double>& y, std::size_t top) {
  const double level = 0.1 * y[top];
  std::size_t from = top, to = top;
  while (from > 0 && y[from - 1] > level) --from;
  while (to + 1 < y.size() && y[to + 1] > level) ++to;
  double sum = 0, first = 0;
  for (std::size_t k = from; k <= to; ++k) {
    sum += y[k] - level;
    first += (y[k] - level) * static_cast<double>(k);
  }
  return first / sum;
}

Truth truth_of(const Slope& slope, const Laser& laser) {
  // full width at half maximum of u^2 e^-u: 3.39468 (numerically)
  const double tau = 0.5 * speed_of_light * laser.pulse_length / 3.394680670846503,
               deviation = laser.divergence.across / 4;
  constexpr int along = 1000, across = 100;
  struct Ray {
    double place, power;
    bool bright;
  };
  std::vector<Ray> rays;
  double sum = 0, first = 0, second = 0, nearest = 0, farthest = 0;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 9 * (i + 0.5) / along - 4.5, turn = (j + 0.5) / across + 0.618033988749895 * i,
                   v = 9 * (turn - std::floor(turn)) - 4.5;
      const double x = deviation * (u * std::cos(slope.about) - v * std::sin(slope.about)),
                   z = deviation * (u * std::sin(slope.about) + v * std::cos(slope.about));
      const Vec3 direction = Vec3{x, 1, z} / std::sqrt(1 + x * x + z * z);
      const double cosine = dot(slope.normal(), direction), range = slope.range * std::cos(slope.tilt) / cosine,
                   place = range - slope.range;
      const Coat coat = slope.paint(x, z);
      const double power = std::exp(-0.5 * (u * u + v * v)) * coat.reflectance * cosine / (range * range);
      rays.push_back({place, power, coat.label == 2});
      sum += power;
      first += power * place;
      second += power * place * place;
      nearest = std::min(nearest, place);
      farthest = std::max(farthest, place);
    }
  Truth truth;
  truth.mean = first / sum;
  truth.spread = std::sqrt(second / sum - truth.mean * truth.mean + 3 * tau * tau);
  const double step = std::max(tau / 20, truth.spread / 400), from = nearest - 3 * tau;
  const auto samples = [&](double length) { return static_cast<std::size_t>(length / step) + 2; };
  std::vector<double> light(samples(farthest - from + 30 * tau)), pulse(samples(25 * tau)), y(light.size());
  for (const Ray& ray : rays) {
    const double at = (ray.place - from) / step;
    const auto k = static_cast<std::size_t>(at);
    light[k] += ray.power * (1 - (at - static_cast<double>(k)));
    light[k + 1] += ray.power * (at - static_cast<double>(k));
  }
  const auto shape = [](double u) { return u > 0 ? u * u * std::exp(-u) : 0; };
  for (std::size_t k = 0; k < pulse.size(); ++k) pulse[k] = shape(static_cast<double>(k) * step / tau);
  for (std::size_t k = 0; k < light.size(); ++k)
    if (light[k] > 0)
      for (std::size_t j = 0; j < pulse.size() && k + j < y.size(); ++j) y[k + j] += light[k] * pulse[j];
  const auto top = static_cast<std::size_t>(std::max_element(y.begin(), y.end()) - y.begin());
  const double at = static_cast<double>(top) + 0.5 * (y[top - 1] - y[top + 1]) / (y[top - 1] - 2 * y[top] + y[top + 1]);
  truth.peak = from + at * step - 2 * tau;
  std::vector<double> fine(2500);
  for (std::size_t k = 0; k < fine.size(); ++k) fine[k] = shape(0.01 * static_cast<double>(k));
  truth.centroid = from + centre(y, top) * step - 0.01 * tau * centre(fine, 200);
  for (std::size_t k = 1; k + 1 < y.size(); ++k)
    truth.maxima += y[k] > y[k - 1] && y[k] >= y[k + 1] && y[k] > 0.01 * y[top] ? 1 : 0;
  double by_label[2] = {};
  for (const Ray& ray : rays) by_label[ray.bright ? 1 : 0] += ray.power * shape((from + at * step - ray.place) / tau);
  truth.bright = by_label[1] > by_label[0];
  return truth;
}

/// Errors of the strongest echo against the truth, by the larger of 5 mm and a hundredth of the echo's spread: the
/// greatest of the ranges by `true_range`, by the centroid, and by the peak.
struct Errors {
  double mean = 0, centroid = 0, peak = 0;
  Seen seen{};
};
template <Footprint Pattern>
Errors errors_on(const Slope& slope, const Laser& laser, const Pattern& footprint, const Truth& truth) {
  const double allowed = std::max(0.005, 0.01 * truth.spread);
  const auto seen = [&](EchoTiming timing) {
    return pulse_on(slope, laser, footprint, waveform(timing, laser.pulse_length / 32));
  };
  const auto error = [&](const Seen& s, double place) {
    return std::fabs(s.strongest.range - slope.range - place) / allowed;
  };
  Errors e{.seen = seen(EchoTiming::peak)};
  e.peak = error(e.seen, truth.peak);
  e.mean = error(seen(EchoTiming::true_range), truth.mean);
  e.centroid = error(seen(EchoTiming::centroid), truth.centroid);
  return e;
}

struct Case {
  double range, divergence, pulse, tilt, waist = 0;
};
const std::vector<Case> cases{{400e3, 25.0 / 400e3, 15.6e-9, 20_deg},
                              {400e3, 25.0 / 400e3, 15.6e-9, 30_deg},
                              {400e3, 25.0 / 400e3, 15.6e-9, 45_deg},
                              {3000, 0.5e-3, 4e-9, 60_deg},
                              {3000, 0.5e-3, 4e-9, 70_deg},
                              {1000, 0.5e-3, 0.5e-9, 45_deg},
                              {1000, 0.5e-3, 0.5e-9, 60_deg},
                              {3000, 0.5e-3, 4e-9, 75_deg, 5e-3},
                              {3000, 1e-3, 0.5e-9, 72_deg},
                              {3000, 1e-3, 0.5e-9, 85_deg},
                              {3000, 1e-3, 1e-9, 76_deg},
                              {3000, 1e-3, 1e-9, 85_deg},
                              {3000, 0.5e-3, 0.5e-9, 81_deg},
                              {3000, 0.5e-3, 0.5e-9, 85_deg},
                              {100, 20e-3, 4e-9, 85_deg}};

Laser laser_of(const Case& c) {
  return {.pulse_length = c.pulse, .divergence = c.divergence, .waist_diameter = c.waist};
}

}  // namespace

TEST_CASE("a smooth plane gives one echo, of the place and width that a Gaussian beam's has") {
  std::size_t false_echoes = 0;
  for (const Case& c : cases)
    for (const double about : {0.0, 0.7, 2.1}) {
      const Laser laser = laser_of(c);
      const Slope slope{c.range, c.tilt, about};
      CAPTURE(c.range);
      CAPTURE(c.pulse);
      CAPTURE(c.tilt);
      CAPTURE(about);
      const auto check = [&](const auto& footprint) {
        const Seen raw = pulse_on(slope, laser, footprint, waveform(), DirectLight{.spread_planes = false});
        false_echoes += raw.echoes - 1;
        const Seen seen = pulse_on(slope, laser, footprint, waveform());
        CHECK(seen.echoes == 1);
        CHECK(!seen.outcome.unresolved);
        CHECK(seen.outcome.energy.received == doctest::Approx(raw.outcome.energy.received).epsilon(0.02));
        CHECK(pulse_on(slope, laser, footprint, AnalyticWaveform<>{{.threshold = 1e-30, .returns_max = 255}}).echoes ==
              1);
      };
      check(LatticeFootprint(19));
      check(LatticeFootprint(3));
      check(LatticeFootprint(7));
      check(LatticeFootprint(37));
      check(RingFootprint(3));
      check(SunflowerFootprint(19));
      if (c.tilt > 80_deg) continue;  // perspective
      const Seen seen = pulse_on(slope, laser, LatticeFootprint(19), waveform<MomentWidth>());
      // Source: variance of the echo, that of the pulse, 3 tau^2, and that of a Gaussian beam over a plane, (w/2
      // tan(tilt) 2/c)^2
      const double tau = c.pulse / 3.394680670846503,
                   across = 0.25 * c.divergence * c.range * std::tan(c.tilt) * 2 / speed_of_light;
      if (seen.outcome.spread)
        CHECK(seen.strongest.width == doctest::Approx(std::sqrt(3 * tau * tau + across * across)).epsilon(0.02));
      CHECK(std::fabs(seen.strongest.range - c.range) < 0.02 * across * speed_of_light / 2 + 1e-6 * c.range);
    }
  CHECK(false_echoes > 50);
}

TEST_CASE("a painted slope has the ranges and the label that a hundred thousand rays give") {
  struct Painted {
    double range, divergence, pulse, tilt, bright, dark;
  };
  for (const Painted& c : {Painted{1000, 0.5e-3, 4e-9, 55_deg, 0.6, 0.1},
                           {1000, 0.5e-3, 4e-9, 70_deg, 0.6, 0.1},
                           {1000, 0.5e-3, 1e-9, 20_deg, 0.6, 0.1},
                           {1000, 0.5e-3, 1e-9, 45_deg, 0.6, 0.1},
                           {400e3, 25 / 400e3, 15.6e-9, 5_deg, 0.5, 0.25},
                           {400e3, 25 / 400e3, 15.6e-9, 10_deg, 0.5, 0.25},
                           {400e3, 25 / 400e3, 15.6e-9, 20_deg, 0.5, 0.25},
                           {3000, 0.5e-3, 4e-9, 70_deg, 0.9, 0.05}}) {
    const Laser laser{.pulse_length = c.pulse, .divergence = c.divergence};
    Slope slope{c.range, c.tilt, 90_deg};
    slope.paint = edge(laser, 90_deg, 0.06, {c.bright, 2}, {c.dark, 11});  // between the lines of a lattice of 19
    const Truth truth = truth_of(slope, laser);
    REQUIRE(truth.maxima == 1);
    REQUIRE(truth.bright);
    const auto check = [&](const auto& footprint) {
      CAPTURE(c.range);
      CAPTURE(c.pulse);
      CAPTURE(c.tilt);
      CAPTURE(footprint.size());
      const Errors e = errors_on(slope, laser, footprint, truth);
      CHECK(e.seen.echoes == 1);
      CHECK(e.seen.strongest.classification == 2);
      CHECK(e.seen.strongest.object == ObjectId{2});
      CHECK(e.mean < 1);
      CHECK(e.centroid < 1);
      CHECK(e.peak < 1);
    };
    check(LatticeFootprint(19));
    check(LatticeFootprint(37));
    check(SunflowerFootprint(19));
    if (c.tilt > 10_deg) check(LatticeFootprint(7));
  }
}

TEST_CASE("whatever the paint on a slope, its echo is where a hundred thousand rays have it") {
  support::Generator any(11);
  std::size_t checked = 0, spread = 0;
  for (int k = 0; k < 150; ++k) {
    const Laser laser{.pulse_length = any.log_uniform(1e-9, 8e-9), .divergence = any.log_uniform(0.2e-3, 1e-3)};
    Slope slope{any.log_uniform(300, 3000), any.uniform(0, 80_deg), any.uniform(0, 2 * pi)};
    const Coat dark{any.uniform(0.02, 0.5), 11};  // one by one: compilers draw arguments in orders of their own
    const Coat bright{any.uniform(0.1, 0.9), 2};
    const double offset = any.uniform(-1, 1);
    slope.paint = edge(laser, any.uniform(0, 2 * pi), offset, bright, dark);
    const Truth truth = truth_of(slope, laser);
    const Errors e = k % 2 == 0 ? errors_on(slope, laser, LatticeFootprint(19), truth)
                                : errors_on(slope, laser, SunflowerFootprint(37), truth);
    CAPTURE(k);  // of seed 11
    CHECK((e.seen.echoes <= truth.maxima || e.seen.outcome.unresolved));
    if (truth.maxima != 1 || e.seen.outcome.unresolved) continue;
    ++checked;
    spread += e.seen.outcome.spread ? 1 : 0;
    const double allowed = e.seen.outcome.spread ? 1 : 2;  // the subrays of the footprint alone err by more
    CHECK(e.mean < allowed);
    CHECK(e.centroid < allowed);
    CHECK(e.peak < allowed);
  }
  CHECK(checked > 140);
  CHECK(spread > 80);
}

TEST_CASE("road marks, reflectance maps and retroreflectors on a slope are seen") {
  const Laser laser{.pulse_length = 4e-9, .divergence = 0.5e-3};
  const double deviation = laser.divergence.across / 4;
  const Paint mark = [=](double across, double) {
    return std::fabs(across / deviation - 0.7) < 0.2 ? Coat{0.9, 2} : Coat{0.1, 11};
  };
  const Paint map = [=](double across, double up) {
    return Coat{0.3 + 0.25 * std::sin(3 * across / deviation + 2 * up / deviation), 2};
  };
  const Paint reflector = [=](double across, double up) {
    return std::hypot(across / deviation + 0.4, up / deviation - 0.5) < 0.6 ? Coat{300, 2} : Coat{0.2, 11};
  };
  for (const Paint& paint : {mark, map, reflector})
    for (const double about : {0.3, 1.8}) {
      const Slope slope{1000, 65_deg, about, 0, paint};
      const Truth truth = truth_of(slope, laser);
      const Errors e = errors_on(slope, laser, LatticeFootprint(19), truth);
      CAPTURE(about);
      CHECK(e.seen.echoes == truth.maxima);
      if (truth.bright) CHECK(e.seen.strongest.classification == 2);
      CHECK(e.centroid < 1);
      CHECK(e.peak < 1);
    }
}

TEST_CASE("any smooth plane gives one echo, or the pulse is unresolved") {
  support::Generator any(12);
  std::size_t unresolved = 0;
  constexpr int pulses = 1500;
  for (int k = 0; k < pulses; ++k) {
    const Laser laser{.pulse_length = any.log_uniform(0.5e-9, 16e-9),
                      .divergence = any.log_uniform(0.1e-3, 3e-3),
                      .waist_diameter = k % 3 == 0 ? any.log_uniform(1e-3, 0.05) : 0};
    const Slope slope{any.log_uniform(10, 5000), any.uniform(0, 89_deg), any.uniform(0, 2 * pi)};
    const auto subrays = static_cast<std::size_t>(any.uniform(3, 60));
    const Seen seen = k % 2 == 0 ? pulse_on(slope, laser, LatticeFootprint(subrays), waveform())
                                 : pulse_on(slope, laser, SunflowerFootprint(subrays), waveform());
    CAPTURE(k);  // of seed 12
    CAPTURE(slope.range);
    CAPTURE(slope.tilt);
    unresolved += seen.outcome.unresolved ? 1 : 0;
    if (!seen.outcome.unresolved) CHECK(seen.echoes == 1);
  }
  CHECK(unresolved <= pulses / 100);
}

namespace {

/// Two planes that meet at an edge in the beam, or one that ends there, before the sky or a plane across the beam 30 m
/// behind.
struct Edge {
  enum class Behind { plane, sky, wall } behind;
  Slope slope;
  double angle, at, deviation;  // of the edge in the beam
  double other = 0;             // slope of the other plane across the edge, less that of the first
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double beyond =
        ray.direction.x * std::cos(angle) + ray.direction.z * std::sin(angle) - at * deviation * ray.direction.y;
    if (beyond <= 0) return slope.closest_hit(ray);
    if (behind == Behind::sky) return {};
    if (behind == Behind::wall) return Slope{slope.range + 30, 0}.closest_hit(ray);
    // y = range - tan(tilt) u - other (distance beyond the edge)
    const Vec3 first = slope.normal() / std::cos(slope.tilt), across{std::cos(angle), -at * deviation, std::sin(angle)};
    const Vec3 normal = first + other * across;
    const double along = dot(normal, ray.direction) / length(normal);
    if (!(along > 0)) return {};
    return Hit{.range = slope.range / dot(normal, ray.direction),
               .cos_incidence = along,
               .backscatter = 0.5 * along,
               .object = 1};
  }
};

}  // namespace

TEST_CASE("an edge of a roof in the beam gives the echoes that twenty thousand rays give") {
  const Laser laser{.pulse_length = 4e-9, .divergence = 0.5e-3};
  std::size_t false_echoes = 0;
  for (const auto behind : {Edge::Behind::plane, Edge::Behind::sky, Edge::Behind::wall})
    for (const double tilt : {60_deg, 70_deg, 75_deg})
      for (const double angle : {0.7, 1.7})
        for (const double at : {-0.5, 0.1, 1.0}) {
          const Edge roof{behind, {3000, tilt, 0.7}, angle, at, laser.divergence.across / 4, -1.6 * std::tan(tilt)};
          const std::size_t truth =
              pulse_on(roof, laser, LatticeFootprint(20'011), waveform(), DirectLight{.spread_planes = false}).echoes;
          CAPTURE(static_cast<int>(behind));
          CAPTURE(tilt);
          CAPTURE(angle);
          CAPTURE(at);
          for (const std::size_t subrays : {std::size_t{19}, std::size_t{37}}) {
            false_echoes +=
                pulse_on(roof, laser, LatticeFootprint(subrays), waveform(), DirectLight{.spread_planes = false})
                    .echoes > truth;
            CHECK(pulse_on(roof, laser, LatticeFootprint(subrays), waveform()).echoes <= truth);
          }
        }
  CHECK(false_echoes > 20);
}

TEST_CASE("what does not part, single steps and dense footprints are left alone") {
  const Laser laser{.pulse_length = 4e-9, .divergence = 0.5e-3};
  const auto spread = [&](const Slope& slope, const auto& footprint) {
    return pulse_on(slope, laser, footprint, waveform()).outcome.spread;
  };
  CHECK(!spread({.range = 100, .tilt = 10_deg}, LatticeFootprint(19)));
  CHECK(!spread({.range = 100, .tilt = 0, .deeper = 3}, LatticeFootprint(19)));
  CHECK(pulse_on(Slope{.range = 100, .tilt = 0, .deeper = 3}, laser, LatticeFootprint(19), waveform()).echoes == 2);
  for (const double deeper : {1.5, 3.0, 30.0}) {  // three subrays are on a plane, whatever they met
    const Slope step{.range = 100, .tilt = 0, .deeper = deeper};
    const Seen seen = pulse_on(step, laser, LatticeFootprint(3), waveform());
    CHECK(!seen.outcome.spread);
    CHECK(seen.echoes == 2);
    CHECK(seen.strongest.range ==
          pulse_on(step, laser, LatticeFootprint(3), waveform(), DirectLight{.spread_planes = false}).strongest.range);
  }
  CHECK(!spread({.range = 3000, .tilt = 70_deg}, SingleRay{}));
  CHECK(spread({.range = 3000, .tilt = 60_deg}, LatticeFootprint(100)));
  CHECK(!spread({.range = 3000, .tilt = 60_deg}, LatticeFootprint(5000)));
  CHECK(!spread({.range = 1000, .tilt = 30_deg}, LatticeFootprint(19)));
  Slope painted{.range = 1000, .tilt = 50_deg};
  CHECK(!spread(painted, LatticeFootprint(19)));
  painted.paint = edge(laser, 0.3, 0.1, {0.6, 2}, {0.1, 11});
  CHECK(spread(painted, LatticeFootprint(19)));
}

TEST_CASE("light on a slope has the objects of its parts and keeps its ledger, through LightPaths and fog too") {
  // two halves of a slope of 70 degrees, 1000 m ahead, whose edge is off the axis
  const Vec3 half = 2.5 * Vec3{0, std::tan(70_deg), 1}, middle{0, 1000, 0};
  const support::LightScene scene(
      {support::rectangle(middle + 1.02 * half, 5.0 * axis::right, half, {.reflectance = 0.8, .classification = 2}, 2),
       support::rectangle(middle - 0.98 * half, 5.0 * axis::right, half, {.reflectance = 0.1, .classification = 11},
                          11)});
  const support::Lamp lamp{.laser = {.pulse_length = 4e-9, .divergence = 1e-3}};
  const auto place = [&](const auto& light, double& bright) {
    const auto seen = support::traced(light, scene, support::from_to({}, axis::forward), LatticeFootprint(19), lamp);
    CHECK(seen.result.spread);
    CHECK(std::fabs(seen.imbalance()) < 1e-9);
    double sum = 0, first = 0;
    bright = 0;
    for (const Reflection& r : seen.of(ReflectionKind::surface)) {
      CHECK(r.object == r.classification);
      CHECK((r.object == 2) == (r.range > 1000 + 0.02 * half.y));
      sum += r.power;
      first += r.power * (r.range - 1000);
      bright += r.object == 2 ? r.power : 0;
    }
    bright /= sum;
    return first / sum;
  };
  double share = 0, share_of_paths = 0, share_in_fog = 0;
  const double direct = place(DirectLight{}, share), paths = place(LightPaths{}, share_of_paths);
  const Medium fog{.scattering = 1e-3, .backscatter = 1e-5};
  const double in_fog = place(LightPaths{.air = Media({{.medium = fog}})}, share_in_fog);
  // Source: mean of |u| / 2 over a normal distribution of deviation 0.25 m tan(70 deg), 1 / sqrt(2 pi), weighted by the
  // reflectances
  CHECK(direct == doctest::Approx(0.7 / 0.9 * 2 * 0.25 * std::tan(70_deg) / std::sqrt(2 * pi)).epsilon(0.1));
  CHECK(share == doctest::Approx(0.8 / 0.9).epsilon(0.02));
  CHECK(paths == direct);
  CHECK(share_of_paths == share);
  CHECK(in_fog == doctest::Approx(direct).epsilon(0.01));
  CHECK(share_in_fog == doctest::Approx(share).epsilon(0.01));
}

TEST_CASE("runs count the pulses that were spread, and those that are unresolved") {
  const auto summary = [&](double tilt, double pulse, DirectLight light) {
    const Slope slope{3000, tilt};
    const Platform source{
        Tripod{}, Mount{},
        Deflector{FixedBeam{}, Scanner{.pulses = 100, .laser = {.pulse_length = pulse, .divergence = 0.5e-3}}}};
    return run(Survey{source, LatticeFootprint(19), slope, light, vacuum, FullWaveform{}}, {});
  };
  CHECK(summary(70_deg, 4e-9, {}).spread == 100);
  CHECK(summary(70_deg, 4e-9, {}).unresolved == 0);
  CHECK(summary(70_deg, 4e-9, {.spread_planes = false}).spread == 0);
  CHECK(summary(89_deg, 0.5e-9, {}).unresolved == 100);
}

TEST_CASE("a plane is found from the inverse ranges of its subrays, wherever it is") {
  support::Generator any(4);
  const LatticeFootprint footprint(19);
  for (int k = 0; k < 200; ++k) {
    const Emitter emitter{.laser = {.divergence = k % 2 == 0 ? 0.02 : 1e-3, .waist_diameter = k % 2 == 0 ? 0 : 1e-3}};
    const SubrayDirections beam(footprint, emitter);
    const Slope slope{any.log_uniform(1, 1e5), any.uniform(0, 1.4), any.uniform(0, 6)};
    std::vector<Reflection> met;
    for (std::size_t j = 0; j < footprint.size(); ++j) {
      const Ray ray{.origin = beam.from_a_point() ? Vec3{} : beam.exits[j],
                    .direction = {beam.x[j], beam.y[j], beam.z[j]}};
      met.push_back({.range = slope.closest_hit(ray)->range, .power = 1});
    }
    const MetPlane plane(beam, met);
    CAPTURE(k);
    CHECK(plane.range_at({}, emitter) == doctest::Approx(slope.range).epsilon(1e-8));
    CHECK(plane.farthest_from(beam, met) < 1e-8 * slope.range);
    met[7].range *= 1.01;
    CHECK(MetPlane(beam, met).farthest_from(beam, met) > 1e-3 * slope.range);
  }
}
