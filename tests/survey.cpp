// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/survey.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/returns.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/result_buffer.hpp>
#include <pulsecast/scanner/channels.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/shape/transmissive_voxels.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/shape/voxel_grid.hpp>

#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"
#include "support/scenes.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

const double infinity = std::numeric_limits<double>::infinity();
const Receiver clear_air{.visibility = infinity};
const Vec3 utm{500000, 5400000, 300};

/// A beam that does not move in its instrument.
struct Fixed {
  Pose<frame::Beam, frame::Instrument> pose{};
  Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return pose; }
};

/// One pulse a second from a place, in a direction.
auto still(const Vec3& position, const Rotation& turn, PulseIndex pulses = 1, const Laser& laser = {}) {
  return Platform{Tripod{.position = position}, Mount{},
                  Deflector{Fixed{{turn, {}}}, Scanner{.pulse_rate = 1, .pulses = pulses, .laser = laser}}};
}

/// A tripod that scans all around it.
auto all_around(const Vec3& position, PulseIndex pulses) {
  return Platform{
      Tripod{.position = position, .heading = 0.3}, Mount{.lever_arm = {0.1, 0.2, 1.7}},
      Deflector{RotatingHead{.angular_rate = 1}, Deflector{PolygonMirror{.line_rate = 50, .sweep = 80_deg},
                                                           Scanner{.pulse_rate = 5_kHz, .pulses = pulses}}}};
}

/// A plane that answers for single rays.
struct Plane {
  Vec3 point{}, normal = axis::up;
  double reflectance = 0.5;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double along = dot(ray.direction, normal);
    const double range = dot(point - ray.origin, normal) / along;
    if (!(range > ray.near && range <= ray.far)) return std::nullopt;
    return Hit{range, std::fabs(along), reflectance * std::fabs(along), 9, 2};
  }
};

/// The same plane, which answers for bundles.
struct BundledPlane {
  Plane plane;
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    for (std::size_t j = 0; j < rays.size; ++j) hits[j] = plane.closest_hit(rays.ray(j)).value_or(Hit{});
  }
};

/// All pulses of a survey, and a checksum of what came back.
template <class S>
std::string checksum_of(const S& survey, const std::vector<PulseIndex>& order) {
  std::vector<std::string> sums(survey.size());
  auto workspace = survey.workspace();
  for (const PulseIndex i : order) {
    const Outcome o = survey(i, workspace);
    Shot shot = o.shot;
    shot.echoes = static_cast<std::uint32_t>(o.echoes.size());
    shot.samples = static_cast<std::uint32_t>(o.waveform.size());
    support::Checksum sum;
    sum.add(EchoBatch{{&shot, 1}, o.echoes, o.waveform, survey.sample_interval()});
    sums[i] = sum.hex();
  }
  support::Checksum all;
  for (const auto& s : sums) all.add(s);
  return all.hex();
}

std::vector<PulseIndex> in_order(PulseIndex n) {
  std::vector<PulseIndex> order(n);
  for (PulseIndex i = 0; i < n; ++i) order[i] = i;
  return order;
}

template <class Map>
concept TakesTemporary = std::is_constructible_v < Survey<decltype(still({}, no_rotation)), SingleRay, Map, FirstHit>,
decltype(still({}, no_rotation)), SingleRay, Map, Receiver, FirstHit > ;
static_assert(!TakesTemporary<Plane>, "a temporary map would be gone before the first pulse");
static_assert(std::is_constructible_v<Survey<decltype(still({}, no_rotation)), SingleRay, Plane, FirstHit>,
                                      decltype(still({}, no_rotation)), SingleRay, Plane&, Receiver, FirstHit>);

}  // namespace

TEST_CASE("a plane scanned from a tripod gives points on the plane within 0.1 mm at UTM coordinates") {
  support::Generator any(1);
  const auto check = [](const auto& survey, const Plane& plane, double tolerance) {
    auto workspace = survey.workspace();
    int points = 0;
    double worst = 0;
    for (PulseIndex i = 0; i < survey.size(); ++i) {
      const Outcome o = survey(i, workspace);
      if (o.shot.fate != Fate::returned || o.echoes[0].range > 500) continue;
      ++points;
      worst = std::fmax(worst, std::fabs(dot(point_of(o.shot, o.echoes[0]) - plane.point, plane.normal)));
    }
    CHECK(points > 500);
    CHECK(worst < tolerance);
  };
  for (int k = 0; k < 5; ++k) {
    const Plane plane{utm + any.point(1), normalize(any.unit() + 3.0 * axis::up)};
    const auto source = all_around(utm + Vec3{0, 0, 1}, 3000);
    check(Survey{source, SingleRay{}, plane, clear_air, FirstHit{}}, plane, 1e-7);
    check(Survey{source, SingleRay{}, plane, clear_air, FullWaveform{}}, plane, 1e-4);
  }
}

TEST_CASE("a shot tells what the pulse was") {
  const Plane plane{};
  const auto source = all_around({0, 0, 10}, 100);
  const Survey survey{source, SingleRay{}, plane, clear_air, FirstHit{}};
  auto workspace = survey.workspace();
  CHECK(survey.size() == 100);
  CHECK(survey.subrays() == 1);
  CHECK(survey.sample_interval() == 0);
  for (PulseIndex i = 0; i < 100; ++i) {
    const Shot shot = survey(i, workspace).shot;
    const auto pulse = source.pulse(i);
    CHECK(shot.index == i);
    CHECK(shot.tick == pulse->tick);
    CHECK(shot.origin == pulse->origin());
    CHECK(shot.direction == pulse->direction());
    CHECK(shot.scan_angle == pulse->scan_angle);
  }
}

TEST_CASE("a map of rays and a map of bundles give the same, bit for bit") {
  const Plane rays{utm};
  const BundledPlane bundles{rays};
  const auto source = all_around(utm + Vec3{0, 0, 1}, 1000);
  const auto order = in_order(1000);
  for (const std::size_t circles : {1U, 3U, 7U}) {  // 7 circles are more subrays than one bundle holds
    CAPTURE(circles);
    const RingFootprint footprint(circles);
    CHECK(checksum_of(Survey{source, footprint, rays, clear_air, FullWaveform{}}, order) ==
          checksum_of(Survey{source, footprint, bundles, clear_air, FullWaveform{}}, order));
  }
}

TEST_CASE("pulses may be asked in any order, with a workspace of any history") {
  const Plane plane{};
  const Survey survey{all_around({0, 0, 10}, 500), RingFootprint{}, plane, clear_air,
                      FullWaveform<MomentWidth>{WaveformSettings{.record_length = 50e-9}}};
  auto order = in_order(500);
  const std::string forwards = checksum_of(survey, order);
  std::reverse(order.begin(), order.end());
  CHECK(checksum_of(survey, order) == forwards);
  support::Generator any(3);
  for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[any.whole(i + 1)]);
  CHECK(checksum_of(survey, order) == forwards);
  const auto copy = survey;
  CHECK(checksum_of(copy, order) == forwards);
}

TEST_CASE(
    "the amplitude of an extended plate met squarely is that of the radar equation, and falls with the square of the "
    "range") {
  for (const double range : {10.0, 20.0, 40.0, 80.0}) {
    CAPTURE(range);
    const Plane plane{{0, range, 0}, axis::forward, 0.4};
    const auto source = still({}, no_rotation);
    const auto amplitude = [&](const auto& footprint, const auto& detector) {
      const Survey survey{source, footprint, plane, clear_air, detector};
      auto workspace = survey.workspace();
      const Outcome o = survey(0, workspace);
      REQUIRE(o.echoes.size() == 1);
      CHECK(o.energy.scattered == support::relative(0.4 * o.energy.sent, 1e-12));
      CHECK(o.echoes[0].reflectance == support::relative(0.4, 1e-4));
      return o.echoes[0].amplitude;
    };
    // P D^2 / (4 R^2 + D^2) rho eta. Source: Winiwarter et al. 2022, and the solid angle of a disc on the axis
    const double expected = 4 * 0.15 * 0.15 / (4 * range * range + 0.15 * 0.15) * 0.4 * 0.99;
    CHECK(amplitude(SingleRay{}, FirstHit{}) == support::relative(expected, 1e-13));
    CHECK(amplitude(SingleRay{}, FullWaveform{}) == support::relative(expected, 1e-4));
    // all subrays together bring back what a single one does
    CHECK(amplitude(RingFootprint{5}, FullWaveform{}) == support::relative(expected, 1e-4));
    CHECK(amplitude(SunflowerFootprint{100}, FullWaveform{}) == support::relative(expected, 1e-4));
  }
}

TEST_CASE(
    "a wire across the beam brings back power that falls with the cube of the range, and a small target with the "
    "fourth power") {
  // A strip or a disc smaller than the footprint: what it covers of the footprint shrinks with the range, once or
  // twice.
  struct Small {
    double range, half_width, half_height;
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
      const Vec3 p = ray.origin + ray.direction * (range / ray.direction.y);
      if (std::fabs(p.x) > half_width || std::fabs(p.z) > half_height) return std::nullopt;
      return Hit{range / ray.direction.y, 1, 1, 0, 0};
    }
  };
  const auto power = [](const Small& target) {
    const auto source = still({}, no_rotation, 1, Laser{.divergence = 4e-3});
    const Survey survey{source, SunflowerFootprint{50000}, target, clear_air, FullWaveform{}};
    auto workspace = survey.workspace();
    return survey(0, workspace).echoes[0].amplitude;
  };
  // the footprint has a radius of 0.4 m at 200 m, and twice that at 400 m; the Gaussian is flat to some percent over
  // the small target
  CHECK(power({200, 0.02, 10}) / power({400, 0.02, 10}) == support::relative(8, 0.05));
  CHECK(power({200, 0.06, 0.06}) / power({400, 0.06, 0.06}) == support::relative(16, 0.05));
}

TEST_CASE("the footprint lies right and up as seen along the beam, and turns with it") {
  struct OneSubray : support::LeastFootprint {
    Vec2 where{};
    Vec2 offset(std::size_t) const noexcept { return where; }
  };
  /// Sends back only what is on one side of a plane through the origin.
  struct HalfSpace {
    Vec3 inside;
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
      return dot(ray.direction, inside) > 1e-9 ? std::optional(Hit{10, 1, 1, 0, 0}) : std::nullopt;
    }
  };
  const auto meets = [](const Vec2& offset, const Rotation& beam, const Vec3& side) {
    const HalfSpace map{side};
    const Survey survey{still({}, beam), OneSubray{{}, offset}, map, clear_air, FirstHit{}};
    auto workspace = survey.workspace();
    return survey(0, workspace).shot.fate == Fate::returned;
  };
  CHECK(meets({1, 0}, no_rotation, axis::right));
  CHECK_FALSE(meets({-1, 0}, no_rotation, axis::right));
  CHECK(meets({0, 1}, no_rotation, axis::up));
  CHECK_FALSE(meets({0, -1}, no_rotation, axis::up));
  CHECK_FALSE(meets({0, 1}, no_rotation, axis::right));
  // the beam points down: the footprint's up is forward then
  const Rotation down = rotation_about(axis::right, -90_deg);
  CHECK(meets({0, 1}, down, axis::forward));
  CHECK_FALSE(meets({0, -1}, down, axis::forward));
  CHECK(meets({1, 0}, down, axis::right));
}

TEST_CASE("every pulse has one fate") {
  struct HalfMirror {
    Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return {}; }
    bool open(Tick t) const noexcept { return t.second % 2 == 0; }
  };
  const Plane near{{0, 10, 0}, axis::forward}, behind{{0, -10, 0}, axis::forward};
  const Platform source{Tripod{}, Mount{}, Deflector{HalfMirror{}, Scanner{.pulse_rate = 1, .pulses = 2}}};
  const auto fate = [&](const Plane& plane, const Receiver& receiver, const FirstHit& detector, PulseIndex i = 0) {
    const Survey survey{source, RingFootprint{}, plane, receiver, detector};
    auto workspace = survey.workspace();
    const Outcome o = survey(i, workspace);
    CHECK(o.shot.index == i);
    CHECK(o.echoes.empty() == (o.shot.fate != Fate::returned));
    return o.shot.fate;
  };
  CHECK(fate(near, clear_air, FirstHit{}) == Fate::returned);
  CHECK(fate(near, clear_air, FirstHit{}, 1) == Fate::blocked);
  CHECK(fate(behind, clear_air, FirstHit{}) == Fate::missed);
  CHECK(fate(near, Receiver{.range_min = 11}, FirstHit{}) == Fate::out_of_range);
  CHECK(fate(near, Receiver{.range_max = 9}, FirstHit{}) == Fate::out_of_range);
  CHECK(fate(near, clear_air, FirstHit{.threshold = 1}) == Fate::below_threshold);
  const Plane black{{0, 10, 0}, axis::forward, 0};
  CHECK(fate(black, clear_air, FirstHit{}) == Fate::absorbed);
  CHECK(fate(black, Receiver{.range_max = 9}, FirstHit{}) == Fate::out_of_range);
  CHECK(fate(near, Receiver{.visibility = 10}, FirstHit{}) == Fate::returned);
  CHECK(fate({{0, 2000, 0}, axis::forward}, Receiver{.visibility = 10}, FirstHit{}) ==
        Fate::absorbed);  // more decades of haze than a double has
}

TEST_CASE("the energy of a pulse is spent to the last bit, each subray's by what became of it") {
  /// Quarters of the beam: nothing, a plate before the gate, a black plate, a white plate.
  struct Quarters {
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
      const bool right_half = ray.direction.x > 0, upper_half = ray.direction.z > 0;
      if (right_half && upper_half) return std::nullopt;
      if (right_half) return Hit{1, 1, 1, 0, 0};
      return Hit{10, 1, upper_half ? 0.0 : 1.0, 0, 0};
    }
  };
  const Quarters map;
  const Laser laser{.peak_power = 8, .pulse_length = 5e-9};
  const auto outcome = [&](double threshold) {
    const Survey survey{still({}, no_rotation, 1, laser), SunflowerFootprint{4000}, map, Receiver{.range_min = 2},
                        FirstHit{threshold}};
    auto workspace = survey.workspace();
    return survey(0, workspace);
  };
  const Outcome bright = outcome(0), faint = outcome(1);
  CHECK(bright.energy.sent == support::relative(40e-9, 1e-15));
  for (const auto term :
       {&EnergyLedger::missed, &EnergyLedger::out_of_range, &EnergyLedger::absorbed, &EnergyLedger::scattered})
    CHECK(bright.energy.share(term) == support::relative(0.25, 0.01));
  CHECK(bright.energy.cut == 0);
  CHECK(bright.shot.fate == Fate::returned);
  CHECK(faint.shot.fate == Fate::below_threshold);
  CHECK(faint.energy == bright.energy);
  const EnergyLedger& e = bright.energy;
  CHECK(e.missed + e.out_of_range + e.absorbed + e.scattered == support::relative(e.sent, 1e-12));
}

TEST_CASE("subrays that are recorded lie where they met the plane, with the power that they brought back") {
  const Plane plane{{0, 10, 0}, normalize(Vec3{0.3, 1, 0}), 0.5};
  const Rotation turn = rotation_about(axis::up, 10_deg);
  const auto check = [&](const Laser& laser) {
    const auto source = still(Vec3{1, 2, 3}, turn, 1, laser);
    const Survey plain{source, RingFootprint{6}, plane, clear_air, FullWaveform{}};
    const Survey survey{source, WithSubrayRecord{RingFootprint{6}}, plane, clear_air, FullWaveform{}};
    auto w = survey.workspace();
    auto plain_workspace = plain.workspace();
    const Outcome o = survey(0, w), without = plain(0, plain_workspace);
    CHECK(without.subrays.empty());
    REQUIRE(o.subrays.size() == survey.subrays());
    REQUIRE(o.echoes.size() == without.echoes.size());
    CHECK(o.echoes[0].amplitude == without.echoes[0].amplitude);
    double sum = 0;
    for (const SubrayRecord& hit : o.subrays) {
      CHECK(hit.object == 9);
      CHECK(std::fabs(dot(hit.point - plane.point, plane.normal)) < 1e-12);
      sum += hit.power;
    }
    CHECK(o.echoes[0].amplitude == support::relative(sum, 0.01));
    CHECK(length(o.subrays[0].point - point_of(o.shot, o.echoes[0])) < 0.01);
  };
  check(Laser{.divergence = 2_mrad});
  check(Laser{.divergence = 2_mrad, .waist_diameter = 8_mm, .waist_range = 4});
  const Plane behind{{0, -10, 0}, axis::forward};
  const Survey missing{still({}, no_rotation), WithSubrayRecord{RingFootprint{2}}, behind, clear_air, FirstHit{}};
  auto w = missing.workspace();
  const Outcome o = missing(0, w);
  REQUIRE(o.subrays.size() == 7);
  for (const SubrayRecord& hit : o.subrays) {
    CHECK_FALSE(hit.met());
    CHECK(hit.power == 0);
  }
}

TEST_CASE(
    "a beam with a waist is traced subray by subray, each with a name of its own, and lights what its hyperbola "
    "covers") {
  struct Curious {
    double half_width = 0, range = 0;
    mutable std::vector<std::uint32_t> seen;
    void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
      for (std::size_t j = 0; j < rays.size; ++j) {
        seen.push_back(rays.first_subray + static_cast<std::uint32_t>(j));
        const double t = range / rays.y[j], x = rays.origin.x + t * rays.x[j];
        hits[j] = std::fabs(x) < half_width ? Hit{t, 1, 1, 0, 0} : Hit{};
      }
    }
  };
  const Laser laser = {.divergence = 1_mrad, .waist_diameter = 20_mm, .waist_range = 30};
  for (const double range : {5.0, 30.0, 50.0, 500.0}) {
    CAPTURE(range);
    const double w = std::hypot(10e-3, 0.5e-3 * (range - 30));
    const Curious strip{0.5 * w, range, {}};
    const Survey survey{still({}, no_rotation, 1, laser), SunflowerFootprint{5000}, strip, clear_air, FirstHit{}};
    auto workspace = survey.workspace();
    const Outcome o = survey(0, workspace);
    // of a Gaussian beam, erf(sqrt(2) a / w) is inside of a strip of half width a
    CHECK(o.energy.share(&EnergyLedger::scattered) == support::relative(std::erf(std::sqrt(2.0) * 0.5), 0.003));
    REQUIRE(strip.seen.size() == 5000);
    for (std::uint32_t j = 0; j < 5000; ++j) REQUIRE(strip.seen[j] == j);
  }
}

TEST_CASE("of a beam that two plates share, both come back with what they cover") {
  /// A plate at 10 m on the right-hand side, and a wall at 20 m.
  struct Step {
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
      const bool plate = ray.direction.x > 0;
      return Hit{(plate ? 10 : 20) / ray.direction.y, 1, 1, plate ? 1U : 2U, 0};
    }
  };
  const Step step;
  const Survey survey{still({}, no_rotation), SunflowerFootprint{1000}, step, clear_air, FullWaveform{}};
  auto workspace = survey.workspace();
  const Outcome o = survey(0, workspace);
  REQUIRE(o.echoes.size() == 2);
  CHECK(o.echoes[0].range == support::relative(10, 1e-5));
  CHECK(o.echoes[1].range == support::relative(20, 1e-5));
  CHECK(o.echoes[0].reflectance == support::relative(0.5, 0.01));
  CHECK(o.echoes[1].reflectance == support::relative(0.5, 0.01));
  CHECK(o.echoes[0].object == 1);
  CHECK(o.echoes[1].object == 2);
}

TEST_CASE("a map is told the names of the random numbers that it may draw") {
  struct Curious {
    mutable std::vector<RandomKey> seen;
    mutable double wavelength = 0;
    void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
      for (std::size_t j = 0; j < rays.size; ++j) {
        seen.push_back({rays.seed, rays.pulse, rays.first_subray + static_cast<std::uint32_t>(j), Purpose::free_path});
        hits[j] = Hit{};
      }
      wavelength = rays.wavelength;
    }
  };
  const Curious map;
  const Survey survey{
      still({}, no_rotation, 6, Laser{.wavelength = 532_nm}), SunflowerFootprint{150}, map, clear_air, FirstHit{}, 77};
  auto workspace = survey.workspace();
  CHECK(survey(5, workspace).shot.fate == Fate::missed);
  REQUIRE(map.seen.size() == 150);
  for (std::uint32_t j = 0; j < 150; ++j) {
    CHECK(map.seen[j].seed == 77);
    CHECK(map.seen[j].pulse == 5);
    CHECK(map.seen[j].subray == j);
  }
  CHECK(map.wavelength == 532_nm);
}

TEST_CASE("the footprint follows the divergence and the waist of each pulse") {
  struct Beams : support::LeastSource<frame::World> {
    std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
      auto p = support::LeastSource<frame::World>::pulse(i);
      p->emitter = i % 4;
      return p;
    }
    std::vector<Emitter> emitters() const {
      return {{.laser = {.divergence = 0.01}},
              {.laser = {.divergence = 0.01, .waist_diameter = 2}},
              {.laser = {.divergence = 0.01, .waist_diameter = 2, .waist_range = 10}},
              {.laser = {.divergence = 0.2}}};
    }
  };
  /// A plate 10 m ahead, 0.06 m in radius.
  struct Plate {
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
      const Vec3 p = ray.origin + ray.direction * (10 / ray.direction.y);
      return std::hypot(p.x, p.z) < 0.06 ? std::optional(Hit{10, 1, 1, 0, 0}) : std::nullopt;
    }
  };
  const Plate plate;
  const Survey survey{Beams{}, WithSubrayRecord{RingFootprint{4}}, plate, clear_air, FirstHit{}};
  auto workspace = survey.workspace();
  for (const PulseIndex i : {0U, 1U, 2U, 0U, 3U, 4U, 2U, 1U, 3U, 7U, 5U, 0U}) {
    CAPTURE(i);
    const Outcome o = survey(i, workspace);
    const auto hits = std::count_if(o.subrays.begin(), o.subrays.end(), [](const Hit& hit) { return hit.met(); });
    CHECK(static_cast<std::size_t>(hits) == (i % 4 == 0 ? survey.subrays() : 1));
  }
}

TEST_CASE("a survey refuses a receiver and a detector that cannot be") {
  const Plane plane;
  const auto source = still({}, no_rotation);
  CHECK_THROWS_AS((Survey{source, SingleRay{}, plane, Receiver{.diameter = 0}, FirstHit{}}), SettingError);
  CHECK_THROWS_AS((Survey{source, SingleRay{}, plane, Receiver{}, FirstHit{.threshold = -1}}), SettingError);
}

TEST_CASE("a survey refuses a footprint of one's own that is not a whole beam") {
  struct Pattern {
    std::vector<double> shares;
    Vec2 aside{};
    std::size_t size() const noexcept { return shares.size(); }
    Vec2 offset(std::size_t) const noexcept { return aside; }
    double share(std::size_t j) const noexcept { return shares[j]; }
  };
  const Plane plane;
  const auto survey = [&](const Pattern& pattern) {
    return Survey{still({}, no_rotation), pattern, plane, Receiver{}, FirstHit{}}.subrays();
  };
  CHECK(survey({{0.25, 0, 0.75}}) == 3);
  CHECK(survey({std::vector<double>(100'000, 1e-5)}) == 100'000);
  CHECK_THROWS_AS(survey({{}}), SettingError);
  CHECK_THROWS_AS(survey({{0.5, 0.25}}), SettingError);
  CHECK_THROWS_AS(survey({{1, 1}}), SettingError);
  CHECK_THROWS_AS(survey({{1.5, -0.5}}), SettingError);
  CHECK_THROWS_AS(survey({{std::nan("")}}), SettingError);
  CHECK_THROWS_AS(survey({{1}, {0, infinity}}), SettingError);
}

TEST_CASE("ranges err as the receiver is told, each echo on its own, and the same again") {
  const Plane plane{.point = {0, 0, -100}};
  const Receiver noisy{.range_errors = {.bias = 0.5, .deviation = 0.02}};
  const auto source = still({0, 0, 0}, rotation_about(axis::right, -90_deg), 20'000);
  const Survey survey{source, SingleRay{}, plane, noisy, FirstHit{}, 5}, again = survey;
  const Survey other{source, SingleRay{}, plane, noisy, FirstHit{}, 6};
  auto w = survey.workspace();
  double sum = 0, square = 0, unlike = 0;
  const double n = static_cast<double>(survey.size());
  for (PulseIndex i = 0; i < survey.size(); ++i) {
    const double error = survey(i, w).echoes.front().range - 100;
    CHECK(again(i, w).echoes.front().range == error + 100);
    unlike += other(i, w).echoes.front().range != error + 100 ? 1 : 0;
    sum += error;
    square += (error - 0.5) * (error - 0.5);
  }
  CHECK(std::fabs(sum / n - 0.5) < 4 * 0.02 / std::sqrt(n));
  CHECK(std::sqrt(square / n) == support::relative(0.02, 0.02));
  CHECK(unlike == n);
}

TEST_CASE("echoes stand in order of the ranges that are reported, each with its own error, whatever the noise") {
  /// A quarter of the beam each, half a metre apart for two of them and a metre for the others.
  struct Plates {
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
      const std::size_t k = (ray.direction.x > 0 ? 1 : 0) + (ray.direction.z > 0 ? 2 : 0);
      const double ranges[]{100, 100.5, 101.5, 102.5};
      return Hit{ranges[k] / ray.direction.y, 1, 0.2 * static_cast<double>(k + 1), static_cast<ObjectId>(k + 1), 0};
    }
  };
  const Plates plates;
  const auto survey_with = [&](const RangeErrors& errors) {
    return Survey{still({}, no_rotation, 1000),
                  SunflowerFootprint{100},
                  plates,
                  Receiver{.range_errors = errors},
                  FullWaveform{{.timing = EchoTiming::true_range}},
                  5};
  };
  const RangeErrors noise{.deviation = 0.3};
  const auto exact = survey_with({}), noisy = survey_with(noise);
  auto u = exact.workspace(), v = noisy.workspace();
  int overtaken = 0;
  for (PulseIndex i = 0; i < noisy.size(); ++i) {
    CAPTURE(i);
    const auto echoes = noisy(i, v).echoes, without = exact(i, u).echoes;
    REQUIRE(echoes.size() == 4);
    REQUIRE(without.size() == 4);
    for (std::size_t e = 0; e < 4; ++e) {
      const Echo &echo = echoes[e], &same = without[echo.object - 1];
      if (e > 0) CHECK(echoes[e - 1].range <= echo.range);
      CHECK(echo.number == e + 1);
      CHECK(same.number == echo.object);
      CHECK(echo.range ==
            same.range + noise.at(Echo{.range = same.range}, normal({5, i, same.number, Purpose::range_noise})));
      CHECK(echo.amplitude == same.amplitude);
      CHECK(echo.reflectance == same.reflectance);
    }
    const auto place = [&](ObjectId object) {
      return std::find_if(echoes.begin(), echoes.end(), [&](const Echo& echo) { return echo.object == object; });
    };
    overtaken += place(2) < place(1) ? 1 : 0;
  }
  // the difference of two errors is below -0.5 m with the probability of the normal distribution, 0.119
  CHECK(overtaken > 80);
  CHECK(overtaken < 160);
}

TEST_CASE("echoes whose errors lead out of the gate are not reported, and the others are those of a wider gate") {
  /// Two halves of the beam, 2 m apart.
  struct Plates {
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
      return Hit{(ray.direction.x > 0 ? 10 : 12) / ray.direction.y, 1, 0.5, ray.direction.x > 0 ? 1U : 2U, 0};
    }
  };
  const Plates plates;
  const RangeErrors noise{.deviation = 1};
  const auto survey_with = [&](double near, double far) {
    return Survey{still({}, no_rotation, 2000),
                  SunflowerFootprint{100},
                  plates,
                  Receiver{.range_min = near, .range_max = far, .range_errors = noise},
                  FullWaveform{{.record_length = 100_ns}},
                  5};
  };
  const auto open = survey_with(0, 100), gated = survey_with(9.5, 12.25);
  auto u = open.workspace(), v = gated.workspace();
  std::size_t all = 0, kept = 0;
  for (PulseIndex i = 0; i < gated.size(); ++i) {
    CAPTURE(i);
    const auto without = open(i, u), out = gated(i, v);
    std::size_t next = 0;
    for (const Echo& echo : without.echoes) {
      if (echo.range < 9.5 || echo.range > 12.25) continue;
      REQUIRE(next < out.echoes.size());
      CHECK(out.echoes[next].range == echo.range);
      CHECK(out.echoes[next].object == echo.object);
      CHECK(out.echoes[next].reflectance == echo.reflectance);
      ++next;
      CHECK(out.echoes[next - 1].number == next);
    }
    CHECK(out.echoes.size() == next);
    CHECK(out.shot.fate == (next > 0 ? Fate::returned : Fate::below_threshold));
    CHECK(out.waveform.size() == without.waveform.size());
    all += without.echoes.size();
    kept += next;
  }
  // the normal distribution from -0.5 to 2.25 of the near plate and from -2.5 to 0.25 of the far one: 0.6793 + 0.5925
  CHECK(all == 4000);
  CHECK(std::fabs(static_cast<double>(kept) - 2000 * (0.6793 + 0.5925)) < 4 * std::sqrt(2000 * (0.2179 + 0.2414)));
}

TEST_CASE("a scanner whose noise exceeds the distance of a wall reports nothing behind itself") {
  const Plane wall{.point = {0, 0.4, 0}, .normal = {0, -1, 0}};
  const Survey near{
      still({}, no_rotation, 2000), SingleRay{}, wall, Receiver{.range_errors = {.deviation = 0.5}}, FirstHit{}, 5};
  auto w = near.workspace();
  std::size_t reported = 0;
  for (PulseIndex i = 0; i < near.size(); ++i)
    for (const Echo& echo : near(i, w).echoes) {
      CHECK(echo.range >= 0);
      ++reported;
    }
  CHECK(std::fabs(static_cast<double>(reported) - 2000 * 0.7881) <
        4 * std::sqrt(2000 * 0.7881 * 0.2119));  // of the normal distribution
}

TEST_CASE("a range that a detector folds to before the gate is not reported") {
  const Plane far{.point = {0, 1800, 0}, .normal = {0, -1, 0}};
  const auto folding = [&](double gate) {
    return Survey{still({}, no_rotation, 1), SingleRay{}, far, Receiver{.range_min = gate},
                  MultiplePulsesInAir{100_kHz, FirstHit{}}};
  };
  const auto all_folded = folding(0), early = folding(400);
  auto a = all_folded.workspace(), b = early.workspace();
  REQUIRE(all_folded(0, a).echoes.size() == 1);
  CHECK(all_folded(0, a).echoes[0].range == support::relative(1800 - 0.5 * speed_of_light / 1e5, 1e-12));
  CHECK(early(0, b).echoes.empty());
}

TEST_CASE("the true pose casts the ray, and the reported one writes the point") {
  struct Mistaken {
    [[nodiscard]] PulseIndex size() const noexcept { return 1; }
    [[nodiscard]] Tick duration() const noexcept { return {1, 0}; }
    [[nodiscard]] std::vector<Emitter> emitters() const { return std::vector<Emitter>(1); }
    [[nodiscard]] std::optional<Pulse<frame::World>> pulse(PulseIndex) const noexcept {
      Pulse<frame::World> p;
      p.pose = {rotation_about(axis::right, -90_deg), {0, 0, 10}};
      p.reported = Pose<frame::Beam, frame::World>{no_rotation, {1, 2, 3}};
      return p;
    }
  };
  const Plane plane{.point = {0, 0, 0}};
  const Survey survey{Mistaken{}, SingleRay{}, plane, Receiver{}, FirstHit{}};
  auto w = survey.workspace();
  const Outcome out = survey(0, w);
  REQUIRE(out.echoes.size() == 1);
  CHECK(length(point_of(out.shot, out.echoes[0]) - Vec3{1, 12, 3}) < 1e-12);
}

namespace {

/// A plate, and another behind its left half.
struct TwoPlates {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    if (!(ray.direction.y > 0)) return std::nullopt;
    const Vec3 p = ray.origin + ray.direction * (100 - ray.origin.y) / ray.direction.y;
    const bool left = p.x < 0.01;
    return Hit{(left ? 103 : 100) / ray.direction.y, ray.direction.y, left ? 0.7 : 0.3, left ? 2U : 1U, 0};
  }
};

/// Pulses straight ahead, of emitters as listed.
struct Listed : support::LeastSource<frame::World> {
  std::vector<Emitter> table;
  std::vector<std::uint16_t> of_pulse = std::vector<std::uint16_t>(10);
  explicit Listed(std::vector<Emitter> emitters) : table(std::move(emitters)) {}

  std::vector<Emitter> emitters() const { return table; }
  std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
    auto p = support::LeastSource<frame::World>::pulse(i);
    p->emitter = of_pulse[i];
    return p;
  }
};

using Unit = ReceiverUnit<SunflowerFootprint, FullWaveform<>>;

void check_equal(const Outcome& a, const Outcome& b) {
  CHECK(a.shot.fate == b.shot.fate);
  CHECK(a.energy == b.energy);
  REQUIRE(a.echoes.size() == b.echoes.size());
  for (std::size_t e = 0; e < a.echoes.size(); ++e) CHECK(support::detail::same(a.echoes[e], b.echoes[e]));
  CHECK(std::equal(a.waveform.begin(), a.waveform.end(), b.waveform.begin(), b.waveform.end()));
}

}  // namespace

TEST_CASE("two emitters of different beams and receivers in one survey give what each gives in a survey of its own") {
  const Laser narrow{.peak_power = 5, .divergence = 0.2_mrad},
      wide{.wavelength = 532_nm, .pulse_length = 6_ns, .divergence = 3_mrad};
  const std::vector<Unit> units{
      {SunflowerFootprint{19},
       {.range_errors = {.deviation = 0.1}},
       FullWaveform{WaveformSettings{.record_length = 60_ns}}},
      {SunflowerFootprint{40}, {.diameter = 0.3, .range_max = 102}, FullWaveform{WaveformSettings{.returns_max = 1}}}};
  const auto device = [](const Laser& first, std::uint16_t first_receiver, const Laser& second,
                         std::uint16_t second_receiver) {
    std::vector<Scanner> lasers{
        {.pulse_rate = 10, .pulses = 200, .laser = first, .receiver = first_receiver},
        {.pulse_rate = 10, .pulses = 200, .delay = 0.05, .laser = second, .receiver = second_receiver}};
    return Platform{Tripod{}, Mount{},
                    Deflector{RotatingHead{.angular_rate = 0.01_deg}, Deflector{Fixed{}, Channels{lasers}}}};
  };
  const TwoPlates plates;
  const Survey both{device(narrow, 0, wide, 1), units, plates, 7};
  const Survey first{device(narrow, 0, narrow, 0), units[0].footprint, plates, units[0].receiver, units[0].detector, 7};
  const Survey second{device(wide, 0, wide, 0), units[1].footprint, plates, units[1].receiver, units[1].detector, 7};
  auto u = both.workspace();
  auto v = first.workspace();
  auto w = second.workspace();
  std::size_t echoes[2]{};
  for (PulseIndex k = 0; k < both.size(); ++k) {
    const PulseIndex i = k * 37 % both.size();  // also the same emitter twice in a row
    CAPTURE(i);
    const Outcome one = both(i, u);
    CHECK(one.shot.channel == i % 2);
    echoes[i % 2] += one.echoes.size();
    check_equal(one, i % 2 == 0 ? first(i, v) : second(i, w));
  }
  CHECK(echoes[0] >= 200);
  CHECK(echoes[1] > 50);  // of the near plate alone, which the beam leaves
  CHECK(both.subrays() == 29);
  CHECK(both.receivers().size() == 2);
}

TEST_CASE("each pulse is that of its emitter, whatever the table and the order") {
  const TwoPlates plates;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Unit> units;
    for (std::size_t k = 0; k < 1 + any.whole(3); ++k)
      units.push_back({SunflowerFootprint{1 + any.whole(30)},
                       {.diameter = any.uniform(0.05, 0.2), .range_errors = {.deviation = any.coin() ? 0.2 : 0}},
                       FullWaveform{WaveformSettings{.threshold = any.log_uniform(1e-12, 1e-9)}}});
    std::vector<Emitter> table(1 + any.whole(8));
    for (Emitter& emitter : table)
      emitter = {.laser = {.wavelength = any.coin() ? 532_nm : 1064_nm,
                           .peak_power = any.log_uniform(0.1, 100),
                           .divergence = any.coin() ? 1_mrad : any.log_uniform(1e-4, 1e-2),
                           .waist_diameter = any.coin() ? 0 : 0.02},
                 .footprint_scale = any.coin() ? 1 : any.uniform(0, 2),
                 .receiver = static_cast<std::uint16_t>(any.whole(units.size())),
                 .channel = static_cast<std::uint16_t>(any.whole(65536))};
    Listed source{table};
    for (std::uint16_t& emitter : source.of_pulse) emitter = static_cast<std::uint16_t>(any.whole(table.size()));
    const Survey survey{source, units, plates, seed};
    auto w = survey.workspace();
    for (int k = 0; k < 30; ++k) {
      const PulseIndex i = any.whole(10);
      Emitter emitter = table[source.of_pulse[i]];
      const Unit& unit = units[emitter.receiver];
      emitter.receiver = 0;
      const Survey alone{Listed{{emitter}}, unit.footprint, plates, unit.receiver, unit.detector, seed};
      auto v = alone.workspace();
      const Outcome of_many = survey(i, w);
      CHECK(of_many.shot.channel == emitter.channel);
      check_equal(of_many, alone(i, v));
    }
  }
}

TEST_CASE("twice the footprint is twice the divergence, to the bit") {
  const TwoPlates plates;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double across = any.log_uniform(1e-4, 1e-2), up = across * any.uniform(0.5, 2);
    const Emitter scaled{.laser = {.divergence = {across, up}}, .footprint_scale = 2},
        wide{.laser = {.divergence = {2 * across, 2 * up}}};
    const Survey a{Listed{{scaled}}, SunflowerFootprint{50}, plates, clear_air, FullWaveform{}};
    const Survey b{Listed{{wide}}, SunflowerFootprint{50}, plates, clear_air, FullWaveform{}};
    auto v = a.workspace();
    auto w = b.workspace();
    check_equal(a(3, v), b(3, w));
  }
}

TEST_CASE("the last of many emitters is refused as the first is") {
  const TwoPlates plates;
  const auto survey = [&](const std::vector<Emitter>& table) {
    return Survey{Listed{table}, SunflowerFootprint{}, plates, Receiver{}, FullWaveform{}}.subrays();
  };
  const double nan = std::nan("");
  CHECK(survey(std::vector<Emitter>(3000)) == 19);
  for (const std::size_t k : {0U, 1U, 1500U, 2999U})
    for (const Emitter& bad : {Emitter{.laser = {.pulse_length = 1e-15}},  // too short for the samples of the detector
                               Emitter{.laser = {.wavelength = 1}}, Emitter{.laser = {.peak_power = nan}},
                               Emitter{.laser = {.divergence = {1_mrad, 0}}}, Emitter{.laser = {.waist_range = nan}},
                               Emitter{.footprint_scale = -1}, Emitter{.footprint_scale = 1001},
                               Emitter{.footprint_scale = nan}, Emitter{.receiver = 1}}) {
      CAPTURE(k);
      std::vector<Emitter> table(3000);
      table[k] = bad;
      CHECK_THROWS_AS(survey(table), SettingError);
    }
  CHECK_THROWS_AS(survey({}), SettingError);
  CHECK_THROWS_AS(survey(std::vector<Emitter>(max_emitters + 1)), SettingError);
}

TEST_CASE("a device of more than 256 channels tells each of them") {
  const TwoPlates plates;
  const Platform source{Tripod{}, Mount{},
                        Deflector{Fixed{}, Channels{std::vector<Scanner>(1000, Scanner{.pulses = 3})}}};
  const Survey survey{source, SingleRay{}, plates, Receiver{}, FirstHit{}};
  auto w = survey.workspace();
  for (PulseIndex i = 0; i < survey.size(); ++i) REQUIRE(survey(i, w).shot.channel == i % 1000);
}

TEST_CASE("receivers that do not fit together are refused") {
  const TwoPlates plates;
  const Listed source{std::vector<Emitter>(1)};
  const auto survey = [&](const auto& units) { return Survey{source, units, plates}; };
  const Unit usual{SunflowerFootprint{7}, Receiver{}, FullWaveform{}};
  Unit coarse = usual, few = usual, tiny = usual;
  coarse.detector = FullWaveform{WaveformSettings{.sample_interval = 1_ns}};
  few.footprint = SunflowerFootprint{3};
  tiny.receiver.diameter = 0;
  CHECK_THROWS_AS(survey(std::vector<Unit>{}), SettingError);
  CHECK_THROWS_AS(survey(std::vector{usual, coarse}), SettingError);
  CHECK_THROWS_AS(survey(std::vector{usual, tiny}), SettingError);
  CHECK(survey(std::vector{usual, few}).recorded_subrays() == 0);

  using RecordedUnit = ReceiverUnit<WithSubrayRecord<SunflowerFootprint>, FirstHit>;
  const RecordedUnit seven{WithSubrayRecord{SunflowerFootprint{7}}, Receiver{}, FirstHit{}},
      three{WithSubrayRecord{SunflowerFootprint{3}}, Receiver{}, FirstHit{}};
  CHECK(survey(std::vector{seven, seven}).recorded_subrays() == 7);
  CHECK_THROWS_AS(survey(std::vector{seven, three}), SettingError);
}

namespace {

/// Counts what it is asked for, and has an echo of the dark for each third pulse.
struct DarkCounts : support::LeastDetector {
  static constexpr bool runs_without_reflections = true;
  std::vector<DetectorInput>* asked = nullptr;
  Detection detect(const DetectorInput& input, Workspace& w) const noexcept {
    if (asked) asked->push_back(input);
    if (input.key.pulse % 3 != 0) return support::LeastDetector::detect(input, w);
    w[0] = Echo{.range = 3, .amplitude = 1e-9};
    return {w, {}, 0};
  }
};
struct DarkCountsOfLight : DarkCounts {
  static constexpr bool runs_without_reflections = false;
};

/// Pulses ahead, upwards, downwards; each fourth slot is blocked.
struct AllAround : support::LeastSource<frame::World> {
  PulseIndex size() const noexcept { return 120; }
  std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
    if (i % 4 == 3) return std::nullopt;
    Pulse<frame::World> p;
    p.tick = {static_cast<std::int64_t>(i), 0};
    p.pose.rotation = rotation_about(axis::right, i % 4 == 0 ? 0.5 : i % 4 == 1 ? -0.5 : -1.5);
    p.pose.position = {0, 0, 5};
    return p;
  }
};

}  // namespace

TEST_CASE(
    "a detector that listens always is asked for every pulse sent, also towards the sky; others are asked for light") {
  const Plane ground;
  const Receiver receiver{.range_min = 2, .range_max = 8};
  std::vector<DetectorInput> asked, asked_of_light;
  DarkCounts listening;
  listening.asked = &asked;
  DarkCountsOfLight usual;
  usual.asked = &asked_of_light;
  const Survey always{AllAround{}, SingleRay{}, ground, receiver, listening, 9};
  const Survey plain{AllAround{}, SingleRay{}, ground, receiver, FirstHit{}, 9};
  const Survey of_light{AllAround{}, SingleRay{}, ground, receiver, usual, 9};
  auto u = always.workspace();
  auto v = plain.workspace();
  auto w = of_light.workspace();
  std::size_t sent = 0, with_light = 0;
  for (PulseIndex i = 0; i < always.size(); ++i) {
    CAPTURE(i);
    const Outcome o = always(i, u), usually = plain(i, v);
    CHECK(of_light(i, w).echoes.size() == (usually.echoes.empty() ? 0 : 1));
    CHECK(o.energy == usually.energy);
    if (i % 4 == 3) {
      CHECK(o.shot.fate == Fate::blocked);
      CHECK(asked.size() == sent);
      continue;
    }
    ++sent;
    REQUIRE(asked.size() == sent);
    const DetectorInput& input = asked.back();
    CHECK(input.key.pulse == i);
    CHECK(input.key.seed == 9);
    CHECK(input.gate.near == 2);
    CHECK(input.gate.far == 8);
    CHECK(input.reflections.size() == usually.echoes.size());
    with_light += input.reflections.size();
    if (i % 3 == 0) {
      CHECK(o.shot.fate == Fate::returned);
      CHECK(o.echoes.size() == 1);
      CHECK(std::isfinite(o.echoes[0].reflectance));
    } else {
      CHECK(o.shot.fate == usually.shot.fate);
      CHECK(o.echoes.size() == usually.echoes.size());
    }
  }
  CHECK(sent == 90);
  CHECK(asked_of_light.size() == with_light);
  CHECK(with_light == 30);
}

TEST_CASE("a turned footprint is the same beam, turned by the number of the pulse and the seed; ellipses are refused") {
  /// All that is right of the axis.
  struct Half {
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
      return ray.direction.x > 0 ? std::optional(Hit{.range = 10 / ray.direction.y}) : std::nullopt;
    }
  };
  const Half half;
  const auto survey_of = [&](std::uint64_t seed, const Laser& laser = {}) {
    const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 500, .laser = laser}}};
    return Survey{source, WithSubrayRecord{TurnedFootprint{LatticeFootprint{20}}}, half, clear_air, FirstHit{}, seed};
  };
  const auto survey = survey_of(1), other = survey_of(2);
  auto v = survey.workspace(), u = other.workspace();
  double met = 0;
  int alike = 0;
  for (PulseIndex i = 0; i < survey.size(); ++i) {
    const double missed = survey(i, v).energy.share(&EnergyLedger::missed);
    CHECK(survey(i, v).energy.share(&EnergyLedger::missed) == missed);
    alike += other(i, u).energy.share(&EnergyLedger::missed) == missed ? 1 : 0;
    met += 1 - missed;
    for (const SubrayRecord& hit : survey(i, v).subrays)
      if (hit.met()) CHECK(hit.point.x > 0);  // points are those of the turned subrays
  }
  CHECK(met / 500 == support::relative(0.5, 0.02));
  CHECK(alike < 300);
  CHECK_THROWS_AS(survey_of(1, {.divergence = {1e-3, 2e-3}}), SettingError);
}

namespace {

/// Pulses of some emitters, in turn or at random, some of them blocked; the place jumps now and then.
struct Erratic {
  std::uint64_t seed;
  PulseIndex pulses;
  std::size_t emitter_count;

  PulseIndex size() const noexcept { return pulses; }
  Tick duration() const noexcept { return Tick::of(pulses, 1000); }
  std::vector<Emitter> emitters() const {
    std::vector<Emitter> all(emitter_count);
    for (std::size_t k = 0; k < emitter_count; ++k) {
      all[k].channel = static_cast<std::uint16_t>(k);
      all[k].laser.wavelength = 1e-6 * (1 + 0.1 * static_cast<double>(k));
      if (seed % 3 == 0) all[k].laser.waist_diameter = 0.01;
    }
    return all;
  }
  std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
    const auto draw = [&](std::uint32_t what, PulseIndex n) { return uniform({seed, n, what, Purpose::scene}); };
    if (draw(0, i) < 0.1 || draw(0, i / 40) < 0.2) return std::nullopt;
    const PulseIndex leg = i / 50;
    const double turn = 2 * pi * draw(1, leg) + 1e-3 * static_cast<double>(i % 50);
    const std::size_t emitter = draw(2, leg) < 0.7 ? i : static_cast<std::size_t>(draw(3, i) * 1000);
    Pulse<frame::World> p;
    p.tick = Tick::of(i, 1000);
    p.emitter = static_cast<std::uint16_t>(emitter % emitter_count);
    p.pose = {rotation_about(axis::up, turn) * rotation_about(axis::right, 0.05 * p.emitter - 0.3),
              Vec3{5 * draw(4, leg), 5 * draw(5, leg) + 1e-3 * static_cast<double>(i % 50), 5}};
    if (draw(6, leg) < 0.3) p.reported = {p.pose.rotation, p.pose.position + Vec3{0.1, 0, 0}};
    p.leg = static_cast<std::uint16_t>(leg);
    return p;
  }
};
static_assert(WorldSource<Erratic>);

/// Map that counts the rays that were traced together.
template <class Map>
struct Counted : Map {
  std::shared_ptr<std::atomic<std::size_t>> together = std::make_shared<std::atomic<std::size_t>>(0);
  using TracesSheaves = Counted;
  // as a using-declaration would bring in the constrained one of sheaves, too, which is better than that below
  void closest(const auto&... arguments) const noexcept requires requires(const Map& map) { map.closest(arguments...); }
  { Map::closest(arguments...); }
  void closest(const pulsecast::detail::RaySheaf& rays, double wavelength, std::span<Hit> hits) const noexcept {
    *together += rays.size;
    Map::closest(rays, wavelength, hits);
  }
};

/// Map that replaces the hits of bundles alone: nothing is met.
struct Emptied : Scene<TriangleMesh<>> {
  using Scene::closest;
  using Scene::Scene;
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    std::fill_n(hits.begin(), rays.size, Hit{});
  }
};
static_assert(pulsecast::detail::TracesSheaves<Scene<TriangleMesh<>>> && !pulsecast::detail::TracesSheaves<Emptied>);

}  // namespace

TEST_CASE("a map that inherits a scene and replaces its hits of bundles is asked for these by pulses of one ray") {
  support::Generator any(1);
  Scene<TriangleMesh<>>::Part part;
  part.geometry = std::make_shared<const TriangleMesh<>>(support::soup(any, 2000, 10));
  part.materials = material_table();
  const Erratic source{1, 600, 1};
  const Scene<TriangleMesh<>> full({part});
  const Emptied emptied({part});
  CHECK(run(Survey{source, SingleRay{}, full, Receiver{}, FirstHit{}}, {}).echoes > 100);
  CHECK(run(Survey{source, SingleRay{}, emptied, Receiver{}, FirstHit{}}, {}).echoes == 0);
}

TEST_CASE("pulses of one ray in order are those of single calls, to the bit, and many are traced together") {
  using Moving = MovingScene<TriangleMesh<>, VoxelGrid<TransmissiveVoxels>>;
  std::size_t together = 0, echoes = 0;
  std::array<std::size_t, fate_count> fates{};
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    std::vector<Moving::Part> parts;
    for (int k = 0; k < 4; ++k) {
      Moving::Part part;
      part.geometry = std::make_shared<const TriangleMesh<>>(support::soup(any, 200, 10));
      part.materials = material_table({{.reflectance = k == 0 ? 0 : any.uniform()}});
      part.placement = {any.rotation(), any.log_uniform(0.5, 2), any.point(10)};
      if (k > 2) part.motion = std::make_shared<const PartMotion>(SteadyMotion{.velocity = any.point(10)});
      parts.push_back(part);
    }
    VoxelData leaves{.edge = 2};
    for (std::uint32_t k = 0; k < 16; ++k) leaves.cells.push_back({k % 4, k / 4, 0});
    leaves.densities.assign(leaves.cells.size(), 0.3F);
    Moving::Part crown;
    crown.geometry = std::make_shared<const VoxelGrid<TransmissiveVoxels>>(leaves);
    crown.materials = material_table();
    crown.placement.translation = any.point(5);
    parts.push_back(crown);
    const Counted<Moving> map{Moving(parts, {.to = 1})};
    const Erratic source{seed, 600, seed % 4 == 0 ? 1 : 1 + any.whole(seed % 5 == 0 ? 200 : 9)};
    const Receiver receiver{.range_min = 3, .range_max = 25, .range_errors = {.deviation = any.coin() ? 0.05 : 0}};
    const Survey survey{source, SingleRay{}, map, receiver, FirstHit{.threshold = any.coin() ? 0 : 1e-4}, seed};
    auto alone = survey.workspace(), in_order = survey.workspace();
    const PulseIndex first = any.whole(300), end = first + 1 + any.whole(300);
    PulseIndex expected = first;
    survey.simulate_in_order(first, end, in_order, [&](const Outcome& b) {
      const Outcome a = survey(expected, alone);
      const auto sum = [](const Outcome& o) {
        ResultBuffer result;
        result.append(o);
        support::Checksum all;
        all.add(result.batch(0));
        return all.hex();
      };
      CHECK(b.shot.index == expected);
      CHECK(sum(a) == sum(b));
      CHECK(a.energy == b.energy);
      CHECK(a.shot.fate == b.shot.fate);
      CHECK(a.error == b.error);
      ++fates[static_cast<std::size_t>(a.shot.fate)];
      echoes += b.echoes.size();
      return expected += any.whole(20) == 0 ? 1 + any.whole(30) : 1;  // as after a blocked slot
    });
    CHECK(expected >= end);
    together += *map.together;
  }
  CHECK(together > 1000);
  CHECK(echoes > 300);
  for (const std::size_t count : fates) CHECK(count > 0);
}
