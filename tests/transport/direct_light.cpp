// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/transport/direct_light.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/material/microfacet.hpp>
#include <pulsecast/material/normalized_phong.hpp>
#include <pulsecast/material/retroreflector.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/motion.hpp>
#include <pulsecast/scene/moving_scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/survey.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/light.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

using BeamPose = Pose<frame::Beam, frame::World>;

std::vector<BeamPose> poses_from(const Vec3& place, std::uint64_t seed, std::size_t count) {
  support::Generator any(seed);
  std::vector<BeamPose> poses;
  for (std::size_t k = 0; k < count; ++k) poses.push_back({rotation_about(any.unit(), any.uniform(0, 2 * pi)), place});
  return poses;
}

/// Shells about the origin, white and black by turns, some beyond the gate, with holes between.
struct Shells {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const int sector = static_cast<int>(std::floor(40 * (ray.direction.x + ray.direction.z + 2)));
    if (sector % 4 == 0) return std::nullopt;
    return Hit{.range = sector % 4 == 1 ? 200.0 : 10.0 + sector % 7, .backscatter = sector % 4 == 2 ? 0.0 : 0.6};
  }
};

/// A foil about the pulse that scatters a third of the light, lets a half of it pass both ways, and absorbs the rest;
/// then what is behind.
struct Foil {
  double radius = 5, scattered = 1.0 / 3, passed = 0.5;
  DirectLight behind{};
  using Workspace = DirectLight::Workspace;
  std::size_t reflections(std::size_t subrays) const noexcept { return 2 * subrays; }
  Workspace workspace(std::size_t subrays) const { return behind.workspace(subrays); }
  template <class Map>
  TransportResult trace(const Map& map, const TransportInput& light, Workspace& w,
                        std::span<Reflection> reflections) const noexcept {
    TransportResult r = behind.trace(map, light, w, reflections);
    r.energy = r.energy.times(passed);
    r.energy.sent = light.energy();
    r.energy.received *= passed;  // on the way back, too
    for (Reflection& reflection : reflections.first(r.reflections)) reflection.power *= passed * passed;
    r.energy.absorbed += (1 - scattered - passed) * light.energy();
    r.energy.scattered += scattered * light.energy();
    for (std::size_t j = 0; j < light.subrays; ++j) {
      const double power = light.budget.power(light.beam.shares[j], scattered, radius);
      reflections[r.reflections++] = {.range = radius, .power = power, .object = 99};
      r.energy.received += power * light.emitter.laser.pulse_length;
    }
    return r;
  }
};

auto towards(const Rotation& turn, PulseIndex pulses = 1, double rate = 1) {
  return Platform{Tripod{}, Mount{}, Deflector{FixedBeam{turn}, Scanner{.pulse_rate = rate, .pulses = pulses}}};
}

/// Reports the velocity of its only reflection as the echo's width.
struct Doppler : support::LeastDetector {
  static constexpr bool reads_velocity = true;
  Detection detect(const DetectorInput& input, Workspace& w) const noexcept {
    const Detection d = support::LeastDetector::detect(input, w);
    if (!d.echoes.empty()) d.echoes[0].width = input.reflections[0].velocity;
    return d;
  }
};
/// The same, though it never said so.
struct Unasked : Doppler {
  static constexpr bool reads_velocity = false;
};

using Mesh = TriangleMesh<>;
std::shared_ptr<const Mesh> plate(double y) {
  return std::make_shared<const Mesh>(MeshData{.vertices = {{-50, y, -50}, {50, y, -50}, {50, y, 50}, {-50, y, 50}},
                                               .triangles = {{0, 1, 2}, {0, 2, 3}}});
}

}  // namespace

TEST_CASE("direct light keeps the laws of transports, in and out of the gate") {
  const Receiver gated{.range_min = 2, .range_max = 100};
  for (const Receiver& receiver :
       {Receiver{}, gated, Receiver{.range_min = 15}, Receiver{.visibility = 1, .range_min = 2}}) {
    CHECK(support::transport_laws(DirectLight{}, Shells{}, poses_from({}, 1, 200), receiver) == "");
    CHECK(support::transport_laws(DirectLight{}, support::LeastRayTarget{}, poses_from({0, 0, 30}, 2, 200), receiver) ==
          "");
    CHECK(support::transport_laws(DirectLight{}, support::LeastBundleTarget{}, poses_from({0, 0, 1}, 3, 200),
                                  receiver) == "");
  }
}

TEST_CASE("each term of the ledger is that of its own subrays") {
  const Shells map;
  const Receiver receiver{.range_max = 100};
  const Survey survey{towards(rotation_about(axis::up, 0.3)), WithSubrayRecord{SunflowerFootprint{500}}, map, receiver,
                      FirstHit{}};
  const Survey wide{
      Platform{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1, .laser = {.divergence = 0.3}}}},
      WithSubrayRecord{SunflowerFootprint{500}}, map, receiver, FirstHit{}};
  const auto check = [&](const auto& s) {
    auto w = s.workspace();
    const Outcome o = s(0, w);
    double missed = 0, out_of_range = 0, absorbed = 0, scattered = 0, received = 0;
    for (const SubrayRecord& subray : o.subrays) {
      const double sent = o.energy.sent / 500;
      const bool lit = subray.met() && subray.range <= 100;
      if (!lit) (subray.met() ? out_of_range : missed) += sent;
      if (lit) scattered += subray.scattered_share * sent;
      if (lit) absorbed += (1 - subray.scattered_share) * sent;
      received += subray.power * Laser{}.pulse_length;
    }
    CHECK(o.energy.sent == Laser{}.energy());
    CHECK(std::fabs(o.energy.missed - missed) <= 1e-9 * o.energy.sent);
    CHECK(std::fabs(o.energy.out_of_range - out_of_range) <= 1e-9 * o.energy.sent);
    CHECK(std::fabs(o.energy.absorbed - absorbed) <= 1e-9 * o.energy.sent);
    CHECK(std::fabs(o.energy.scattered - scattered) <= 1e-9 * o.energy.sent);
    CHECK(std::fabs(o.energy.received - received) <= 1e-9 * received);
    CHECK(o.energy.cut == 0);
    return std::array{missed, out_of_range, absorbed, scattered};
  };
  check(survey);
  for (const double term : check(wide)) CHECK(term > 0);
}

TEST_CASE("a grey wall is half scattered, half absorbed, whatever transport, and whether a scene or a map tells it") {
  struct Wall {
    std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
      const double cosine = ray.direction.y, range = (20 - ray.origin.y) / cosine;
      if (!(cosine > 0 && range > ray.near && range <= ray.far)) return std::nullopt;
      return Hit{.range = range, .cos_incidence = cosine, .backscatter = 0.5 * cosine};
    }
  };
  const auto halves = [](const TransportResult& result) {
    CHECK(result.energy.scattered == support::relative(result.energy.sent / 2, 1e-12));
    CHECK(result.energy.absorbed == support::relative(result.energy.sent / 2, 1e-12));
  };
  const Scene<Mesh> scene({{.geometry = plate(20), .materials = material_table({{.reflectance = 0.5}})}});
  for (const double turn : {0.0, 0.5}) {
    const auto pose = support::from_to({0, 0, 0}, {std::sin(turn), std::cos(turn), 0});
    halves(support::traced(DirectLight{}, scene, pose, RingFootprint{3}).result);
    halves(support::traced(LightPaths{}, scene, pose, RingFootprint{3}).result);
    halves(support::traced(DirectLight{}, Wall{}, pose, RingFootprint{3}).result);
  }
}

TEST_CASE("the ledger is that of light paths, by every law and at any incidence") {
  const SurfaceLaw laws[]{Lambert{}, DirectionIndependent{}, NormalizedPhong{0.4, 12.5}, Microfacet{0.3},
                          Retroreflector<>{70, 0.01}};
  support::Generator any(5);
  for (std::size_t k = 0; k < std::size(laws); ++k)
    for (int i = 0; i < 20; ++i) {
      CAPTURE(k);
      CAPTURE(i);
      const Scene<Mesh> scene({{.geometry = plate(20), .materials = material_table({{.law = laws[k]}})}});
      const auto pose = support::from_to({0, 0, 0}, {any.uniform(-1, 1), 1, any.uniform(-1, 1)});
      const EnergyLedger direct = support::traced(DirectLight{}, scene, pose, RingFootprint{3}).result.energy,
                         paths = support::traced(LightPaths{}, scene, pose, RingFootprint{3}).result.energy;
      CHECK(direct.scattered == support::relative(paths.scattered, 1e-14));
      CHECK(std::fabs(direct.absorbed - paths.absorbed) <= 1e-14 * direct.sent);
      CHECK(direct.received <= direct.scattered);
    }
}

TEST_CASE("a transport of one's own may give two reflections a subray") {
  CHECK(support::transport_laws(Foil{}, Shells{}, poses_from({}, 4, 100), {.range_max = 100}) == "");
  const support::LeastRayTarget wall;  // 20 m below
  const Platform source{
      Tripod{.position = {0, 0, 20}}, Mount{},
      Deflector{FixedBeam{rotation_about(axis::right, -90_deg)}, Scanner{.pulses = 1, .laser = {.divergence = 1e-6}}}};
  const Receiver clear{.visibility = std::numeric_limits<double>::infinity()};
  const Survey survey{source, RingFootprint{3}, wall, Foil{}, clear, FullWaveform{{.timing = EchoTiming::true_range}}};
  auto w = survey.workspace();
  const Outcome o = survey(0, w);
  REQUIRE(o.echoes.size() == 2);
  CHECK(o.echoes[0].range == support::relative(5, 1e-9));
  CHECK(o.echoes[1].range == support::relative(20, 1e-9));
  CHECK(o.echoes[0].object == 99);
  CHECK(o.echoes[0].reflectance == support::relative(1.0 / 3, 1e-4));
  CHECK(o.echoes[1].reflectance == support::relative(0.25, 1e-4));
  CHECK(o.energy.scattered == support::relative((1.0 / 3 + 0.5) * o.energy.sent, 1e-12));
  CHECK(o.energy.absorbed == support::relative((1 - 1.0 / 3 - 0.5) * o.energy.sent, 1e-12));
  const Survey alone{source, RingFootprint{3}, wall, clear, FullWaveform{}};
  auto v = alone.workspace();
  CHECK(alone(0, v).echoes.size() == 1);
}

TEST_CASE("a survey given direct light by name, for one receiver or a list, is that without") {
  const support::LeastRayTarget plane;
  const Platform source{Tripod{.position = {0, 0, 20}}, Mount{},
                        Deflector{FixedBeam{rotation_about(axis::right, -1)}, Scanner{.pulses = 3}}};
  const std::vector<ReceiverUnit<RingFootprint, FullWaveform<>>> units{{RingFootprint{}, Receiver{}, FullWaveform{}}};
  const auto amplitude = [](const auto& survey) {
    auto w = survey.workspace();
    return survey(2, w).echoes[0].amplitude;
  };
  const double expected = amplitude(Survey{source, RingFootprint{}, plane, Receiver{}, FullWaveform{}, 5});
  CHECK(amplitude(Survey{source, RingFootprint{}, plane, DirectLight{}, Receiver{}, FullWaveform{}, 5}) == expected);
  CHECK(amplitude(Survey{source, units, plane, 5}) == expected);
  CHECK(amplitude(Survey{source, units, plane, DirectLight{}, 5}) == expected);
}

TEST_CASE("a velocity is that of the surface along the ray, positive away, in the world") {
  const Vec3 velocity{1, 3, -2};
  const auto drive = std::make_shared<const PartMotion>(SteadyMotion{.velocity = velocity});
  const MovingScene<Mesh> traffic({{.geometry = plate(30), .motion = drive}, {.geometry = plate(-30)}}, {.to = 2});
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const Rotation turn =
        rotation_about(axis::up, any.uniform(-0.6, 0.6)) * rotation_about(axis::right, any.uniform(-0.6, 0.6));
    const Survey survey{towards(turn, 3), SingleRay{}, traffic, Receiver{}, Doppler{}};
    auto w = survey.workspace();
    for (PulseIndex i = 0; i < 3; ++i) {
      const Outcome o = survey(i, w);
      REQUIRE(o.echoes.size() == 1);
      CHECK(o.echoes[0].width == support::relative(dot(velocity, o.shot.direction), 1e-12));
      CHECK(o.energy.scattered == o.energy.sent / 2);
    }
    const Survey silent{towards(turn), SingleRay{}, traffic, Receiver{}, Unasked{}};
    auto v = silent.workspace();
    CHECK(silent(0, v).echoes[0].width == 0);
  }
  const Survey back{towards(rotation_about(axis::up, 180_deg)), SingleRay{}, traffic, Receiver{}, Doppler{}};
  auto w = back.workspace();
  REQUIRE(back(0, w).echoes.size() == 1);
  CHECK(back(0, w).echoes[0].width == 0);  // what stands still
}

TEST_CASE("each subray of a spinning plate has the velocity of its place") {
  const double rate = 0.01;
  const auto spin = std::make_shared<const PartMotion>(
      SteadyMotion{.axis = axis::up, .angular_rate = rate, .centre = Vec3{0, 30, 0}});
  const MovingScene<Mesh> scene({{.geometry = plate(30), .motion = spin}}, {.to = 1});
  struct AllVelocities : Doppler {
    std::vector<Reflection>* seen = nullptr;
    Detection detect(const DetectorInput& input, Workspace&) const noexcept {
      seen->assign(input.reflections.begin(), input.reflections.end());
      return {};
    }
  };
  for (const double waist : {0.0, 0.01}) {  // in one bundle, and subray by subray
    std::vector<Reflection> seen;
    AllVelocities detector;
    detector.seen = &seen;
    const Laser laser{.divergence = 0.1, .waist_diameter = waist};
    const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1, .laser = laser}}};
    const Survey survey{source, WithSubrayRecord{RingFootprint{4}}, scene, Receiver{}, detector};
    auto w = survey.workspace();
    const Outcome o = survey(0, w);
    REQUIRE(seen.size() == RingFootprint{4}.size());
    for (std::size_t j = 0; j < seen.size(); ++j) {
      const SubrayRecord& subray = o.subrays[j];
      const Vec3 exit = subray_exit(RingFootprint{4}.offset(j), laser),
                 direction = (subray.point - exit) / subray.range;
      const double expected = dot(cross(rate * axis::up, subray.point - Vec3{0, 30, 0}), direction);
      CHECK(std::fabs(seen[j].velocity - expected) < 1e-12);
      CHECK(seen[j].kind == ReflectionKind::surface);
    }
  }
}

namespace {

/// A scene, and the number of times that it was asked for hits.
struct Asked {
  const Scene<Mesh>& scene;
  std::size_t& times;
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    ++times;
    scene.closest(rays, hits);
  }
};
/// The same, with its answers about cones.
struct AskedFirst : Asked {
  bool misses_cone(const RayCone& cone) const noexcept { return scene.misses_cone(cone); }
};
static_assert(!MissesCones<Asked> && MissesCones<AskedFirst>);

/// A mirror that sweeps around, past a plate that fills a tenth of the turn.
auto sweep(PulseIndex pulses, const Laser& laser) {
  return Platform{Tripod{}, Mount{},
                  Deflector{PolygonMirror{.line_rate = 10, .sweep = 180_deg},
                            Scanner{.pulse_rate = 2000, .pulses = pulses, .laser = laser}}};
}

const Scene<Mesh>& a_plate() {
  static const Scene<Mesh> scene(
      {{.geometry = std::make_shared<const Mesh>(MeshData{.vertices = {{-3, 8, -2}, {3, 8, -2}, {3, 8, 2}, {-3, 8, 2}},
                                                          .triangles = {{0, 1, 2}, {0, 2, 3}}})}});
  return scene;
}

bool same(const Outcome& a, const Outcome& b) {
  if (a.shot.fate != b.shot.fate || !(a.energy == b.energy) || a.error != b.error || a.echoes.size() != b.echoes.size())
    return false;
  for (std::size_t k = 0; k < a.echoes.size(); ++k)
    if (!support::detail::same(a.echoes[k], b.echoes[k])) return false;
  return true;
}

}  // namespace

TEST_CASE("pulses beside a scene give the same, whether their cones are tested or their subrays traced") {
  for (const std::size_t subrays : {2U, 19U, 100U}) {
    CAPTURE(subrays);
    std::size_t plainly = 0, asked = 0;
    const Asked plain{a_plate(), plainly};
    const AskedFirst first{{a_plate(), asked}};
    const Survey all{sweep(2000, {.divergence = 0.1}), SunflowerFootprint(subrays), plain, Receiver{}, FullWaveform{}};
    const Survey few{sweep(2000, {.divergence = 0.1}), SunflowerFootprint(subrays), first, Receiver{}, FullWaveform{}};
    auto v = all.workspace();
    auto w = few.workspace();
    std::size_t returned = 0, missed = 0;
    for (PulseIndex i = 0; i < all.size(); ++i) {
      const PulseIndex slot = i < 1000 ? i : 7 * i % all.size();  // in order, then not
      const Outcome expected = all(slot, v), outcome = few(slot, w);
      CAPTURE(slot);
      REQUIRE(same(outcome, expected));
      returned += expected.shot.fate == Fate::returned ? 1 : 0;
      missed += expected.shot.fate == Fate::missed ? 1 : 0;
    }
    CHECK(returned > 20);
    CHECK(missed > 500);
    CHECK(asked < plainly / 4);  // pulses that follow a miss are not traced
    CHECK(asked >= returned);
  }
}

TEST_CASE("subrays that are recorded, those of a beam that leaves no point, and single rays are traced") {
  std::size_t asked = 0;
  const AskedFirst map{{a_plate(), asked}};
  const Survey recorded{sweep(500, {}), WithSubrayRecord{SunflowerFootprint(3)}, map, Receiver{}, FirstHit{}};
  const Survey single{sweep(500, {}), SunflowerFootprint(1), map, Receiver{}, FirstHit{}};
  const Survey wide{sweep(500, {.waist_diameter = 0.5}), SunflowerFootprint(2), map, Receiver{}, FirstHit{}};
  auto v = recorded.workspace();
  auto u = single.workspace();
  auto w = wide.workspace();
  std::size_t sent = 0;
  for (PulseIndex i = 0; i < 500; ++i) {
    const Outcome one = recorded(i, v), other = wide(i, w), alone = single(i, u);
    if (one.shot.fate == Fate::blocked) continue;
    sent += 4;  // one bundle, one ray, and two of different exits
    REQUIRE(one.subrays.size() == 3);
    if (one.shot.fate == Fate::missed) CHECK_FALSE(one.subrays[2].met());
    CHECK(other.shot.fate != Fate::blocked);
    CHECK(alone.shot.fate != Fate::blocked);
  }
  CHECK(asked == sent);
}
