// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// The two waveform detectors against each other: on planes, and on a tree.

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>

#include "../../examples/tree.hpp"
#include "support/generators.hpp"
#include "validation/one_pulse.hpp"
#include "validation/table.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;
using namespace pulsecast::validation;

namespace {

struct Plane {
  double range, angle;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double towards = std::cos(angle) * ray.direction.y + std::sin(angle) * ray.direction.x;
    return towards > 0 ? std::optional(Hit{range * std::cos(angle) / towards, towards, towards, 0, 0}) : std::nullopt;
  }
};

/// How far the detectors are from each other on planes near and far, met at any angle up to 70 degrees.
struct Difference {
  double range = 0;  ///< largest [bins]
  double amplitude = 0;
  int unlike = 0;  ///< pulses of which they say another number of echoes
};

Difference on_planes(EchoTiming timing) {
  const Laser laser{.pulse_length = 4e-9, .divergence = 0.3e-3};
  const WaveformSettings settings{.threshold = 0, .timing = timing};
  const double bin = 0.5 * speed_of_light * settings.sample_interval;
  Difference worst;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    support::Generator any(seed);
    const Plane plane{any.log_uniform(1, 3000), any.uniform(0, 70_deg)};
    const auto a = one_pulse(plane, RingFootprint(5), laser, vacuum, AnalyticWaveform(settings)).echoes;
    const auto b = one_pulse(plane, RingFootprint(5), laser, vacuum, FullWaveform(settings)).echoes;
    worst.unlike += a.size() != b.size();
    for (std::size_t e = 0; e < a.size() && a.size() == b.size(); ++e) {
      worst.range = std::fmax(worst.range, std::fabs(a[e].range - b[e].range) / bin);
      worst.amplitude = std::fmax(worst.amplitude, std::fabs(a[e].amplitude / b[e].amplitude - 1));
    }
  }
  return worst;
}

Scene<TriangleMesh<>> tree() {
  const MeshData mesh = wood::broadleaf({}, wood::Dice(1, 1));
  return Scene<TriangleMesh<>>(
      {{.geometry = std::make_shared<const TriangleMesh<>>(mesh),
        .materials = material_table(std::vector<Material>(wood::shingle + 1, {.reflectance = 0.5}))}});
}

}  // namespace

TEST_CASE("two detectors on planes") {
  for (const EchoTiming timing : {EchoTiming::true_range, EchoTiming::peak}) {
    const std::string text = std::string("AnalyticWaveform against FullWaveform, 2000 planes, timed by ") +
                             (timing == EchoTiming::true_range ? "energy" : "peak") + ": ";
    const Difference d = on_planes(timing);
    row(Kind::second_implementation, text + "largest difference in range [bins]", 0, d.range, 0.1);
    row(Kind::second_implementation, text + "largest difference in amplitude [%]", 0, 100 * d.amplitude, 1);
    row(Kind::second_implementation, text + "pulses with another number of echoes", 0, d.unlike, 0.5);
  }
}

TEST_CASE("two detectors on a tree") {
  const auto scene = tree();
  const Box box = scene.bounds();
  const Vec3 centre = box.centre(), size = box.size();
  for (const double distance : {10.0, 30.0, 100.0, 300.0}) {
    const Laser laser{.pulse_length = 5e-9, .divergence = 0.3e-3};
    // rays at a grid over the tree as it is seen from the south
    const Vec3 eye{centre.x, centre.y - distance, centre.z};
    std::size_t pulses = 0, alike = 0;
    const AnalyticWaveform exact;
    const FullWaveform sampled;
    for (int row_ = 0; row_ < 100; ++row_)
      for (int column = 0; column < 100; ++column) {
        const Vec3 at = centre + Vec3{size.x * (0.01 * column - 0.495), 0, size.z * (0.01 * row_ - 0.495)};
        const Vec3 towards = normalize(at - eye);
        const double azimuth = std::atan2(towards.x, towards.y), elevation = std::asin(towards.z);
        const Platform source{Tripod{.position = eye}, Mount{},
                              Deflector{FixedBeam{aimed_at(azimuth, elevation)}, Scanner{.pulses = 1, .laser = laser}}};
        const Survey one{source, SunflowerFootprint(19), scene, Receiver{}, exact};
        const Survey other{source, SunflowerFootprint(19), scene, Receiver{}, sampled};
        auto w = one.workspace();
        auto v = other.workspace();
        const auto a = one(0, w).echoes, b = other(0, v).echoes;
        if (a.empty() && b.empty()) continue;
        ++pulses;
        alike += a.size() == b.size();
      }
    REQUIRE(pulses > 1000);
    row(Kind::second_implementation,
        "AnalyticWaveform against FullWaveform, a tree at " + std::to_string(static_cast<int>(distance)) +
            " m: pulses with the same number of echoes [%]",
        100, 100 * static_cast<double>(alike) / static_cast<double>(pulses), 2);
  }
}
