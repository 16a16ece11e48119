// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/detector/adaptor.hpp>

#include <set>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include "support/archetypes.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

template <Detector Inner>
struct LastEcho : DetectorAdaptor<Inner> {
  Detection detect(const DetectorInput& input, auto& workspace) const noexcept {
    Detection all = this->inner.detect(input, workspace);
    if (all.echoes.empty()) return all;
    all.echoes = all.echoes.last(1);
    all.echoes[0].number = 1;
    return all;
  }
};
template <Detector Inner>
LastEcho(Inner) -> LastEcho<Inner>;

/// Has every optional member.
struct Everything : support::LeastDetector {
  static constexpr bool runs_without_reflections = true, reads_velocity = true;
  bool normal = false;
  void validate() const { throw SettingError("Everything", 1, "", "another"); }
  void validate(const Laser&) const { throw SettingError("Everything (laser)", 1, "", "another"); }
  void normalize() noexcept { normal = true; }
  double sample_interval() const noexcept { return 3e-9; }
};

template <class D>
concept Sampling = requires(const D d) {
  d.sample_interval();
};

/// A plate at 100 m, and another at 103 m behind its left half.
struct TwoPlates {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    return Hit{.range = (ray.direction.x < 0 ? 103 : 100) / ray.direction.y,
               .backscatter = 0.5,
               .object = ray.direction.x < 0 ? 2U : 1U};
  }
};

}  // namespace

static_assert(Detector<DetectorAdaptor<FirstHit>> && Detector<LastEcho<FullWaveform<MomentWidth>>>);
static_assert(RunsWithoutReflections<LastEcho<Everything>> && ReadsVelocity<LastEcho<Everything>> &&
              Sampling<LastEcho<Everything>>);
static_assert(Normalizable<LastEcho<Everything>> && !Normalizable<LastEcho<FirstHit>>);
static_assert(!RunsWithoutReflections<LastEcho<FirstHit>> && !ReadsVelocity<LastEcho<FirstHit>> &&
              !Sampling<LastEcho<FirstHit>>);

TEST_CASE("the last echo of a noisy detector has noise of its own for each of 9,000 pulses") {
  const TwoPlates plates;
  const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 9000}}};
  const FullWaveform noisy{WaveformSettings{.threshold = 1e-8}, NoWidth{}, ReceiverNoise{.deviation = 1e-10}};
  std::set<double> amplitudes;
  PulseIndex echoes = 0;
  run(Survey{source, RingFootprint{}, plates, Receiver{}, LastEcho{noisy}}, {.threads = 1},
      [&](const EchoBatch& batch) {
        for (const Echo& echo : batch.echoes) {
          ++echoes;
          amplitudes.insert(echo.amplitude);
          REQUIRE(echo.number == 1);
          REQUIRE(echo.object == 2);
        }
      });
  CHECK(echoes == 9000);
  CHECK(amplitudes.size() == 9000);
}

TEST_CASE("an adaptor alone changes nothing, and keeps the laws of what is inside") {
  const DetectorAdaptor<FullWaveform<>> outside{FullWaveform{WaveformSettings{.record_length = 20_ns}}};
  const std::vector<std::vector<Reflection>> cases{{{50, 1e-8}, {60, 2e-8}}, {}, {{70, 1e-9}}};
  CHECK(support::detector_laws(outside, Laser{}, cases) == "");
  CHECK(support::detector_laws(LastEcho{FirstHit{}}, Laser{}, cases) == "");
  const TwoPlates plates;
  const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 10}}};
  const Survey plain{source, RingFootprint{}, plates, Receiver{}, outside.inner};
  const Survey wrapped{source, RingFootprint{}, plates, Receiver{}, outside};
  support::LawfulSink a, b;
  run(plain, {.threads = 1}, a);
  run(wrapped, {.threads = 1}, b);
  CHECK(a.checksum() == b.checksum());
  CHECK(a.echoes() == 20);
}

TEST_CASE("an adaptor hands on validation, normalisation and the sample interval") {
  LastEcho<Everything> all;
  CHECK_THROWS_WITH_AS(all.validate(), "Everything is 1, but must be another", SettingError);
  CHECK_THROWS_WITH_AS(all.validate(Laser{}), "Everything (laser) is 1, but must be another", SettingError);
  all.normalize();
  CHECK(all.inner.normal);
  CHECK(all.sample_interval() == 3e-9);
  CHECK_NOTHROW(LastEcho{support::LeastDetector{}}.validate());
  CHECK_NOTHROW(LastEcho{support::LeastDetector{}}.validate(Laser{}));
  const TwoPlates plates;
  const Platform source{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1}}};
  const auto survey = [&](const auto& detector) {
    return Survey{source, SingleRay{}, plates, Receiver{}, detector}.sample_interval();
  };
  CHECK(survey(LastEcho{FullWaveform{}}) == FullWaveform{}.sample_interval());
  CHECK_THROWS_AS(survey(LastEcho{FirstHit{-1}}), SettingError);
  CHECK_THROWS_AS(survey(LastEcho{FullWaveform{WaveformSettings{.sample_interval = 1e-6}}}),
                  SettingError);  // not for this laser
}
