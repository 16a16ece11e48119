// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Bins: from 1 ps to 1 us, and waveforms of 10^7 of them.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/channels.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/survey.hpp>

#include "extremes/detectors.hpp"
#include "extremes/row.hpp"
#include "support/detect.hpp"

using namespace pulsecast;
using namespace pulsecast::extremes;

namespace {

const std::string quantity = "bins";

template <class Detector>
auto survey_of(const Laser& laser, const Wall& wall, const Detector& detector) {
  return Survey{Platform{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1, .laser = laser}}}, SingleRay{},
                wall, validation::vacuum, detector};
}

/// The energy of a record [J] and how many samples it has.
struct Record {
  std::size_t samples = 0;
  double energy = 0;

  explicit Record(const auto& detector, const auto& map, const Laser& laser) {
    const Survey survey{Platform{Tripod{}, Mount{}, Deflector{FixedBeam{}, Scanner{.pulses = 1, .laser = laser}}},
                        TwoRays{}, map, validation::vacuum, detector};
    auto workspace = survey.workspace();
    const Outcome outcome = survey(0, workspace);
    samples = outcome.waveform.size();
    for (const float power : outcome.waveform) energy += static_cast<double>(power);
    energy *= survey.sample_interval();
  }
};

}  // namespace

TEST_CASE("bins of all sizes before a wall") {
  struct Case {
    const char* name;
    double bin, pulse, amplitude, width;  // [s], [s], and what they may err by; widths are not asked for if 0
  };
  for (const auto& [name, bin, pulse, amplitude, width] : {Case{"1 ps, pulse of 4 ns", 1e-12, 4e-9, 1e-3, 0.01},
                                                           {"0.25 ns, pulse of 4 ns", 0.25e-9, 4e-9, 1e-3, 0.01},
                                                           {"1 ns, pulse of 4 ns", 1e-9, 4e-9, 0.03, 0.06},
                                                           {"4 ns, pulse of 4 ns", 4e-9, 4e-9, 0.6, 0},
                                                           {"1 us, pulse of 1 ms", 1e-6, 1e-3, 1e-3, 0.01}}) {
    const WaveformSettings settings{.sample_interval = bin, .threshold = 0};
    Errors errors;
    for (int k = 0; k < 10; ++k) {  // wherever the bins lie
      const Errors here = errors_at_wall(Laser{.pulse_length = pulse}, 100 + 0.05 * k * bin * speed_of_light, settings);
      errors.range = std::max(errors.range, here.range);
      errors.amplitude = std::max(errors.amplitude, here.amplitude);
      errors.width = std::max(errors.width, here.width);
    }
    const std::string bins = name + std::string(", wall at 100 m, all detectors and widths: ");
    row(quantity, bins + "largest error of the range [m]", 0, errors.range, 1e-9);
    row(quantity, bins + "largest error of the amplitude, as a share", 0, errors.amplitude, amplitude);
    if (width > 0)
      row(quantity, bins + "largest error of the width, as a share", 0, errors.width,
          width);  // else there are too few to fit
  }
}

TEST_CASE("bins that do not fit the pulse") {
  const Wall wall{100};
  const Laser laser{.pulse_length = 4e-9};
  const WaveformSettings coarse{.sample_interval = 1e-6}, fine{.sample_interval = 1e-13};
  refused(quantity, "1 us, pulse of 4 ns, FullWaveform", [&] { return survey_of(laser, wall, FullWaveform{coarse}); });
  refused(quantity, "1 us, pulse of 4 ns, AnalyticWaveform with a fitted width", [&] {
    return survey_of(laser, wall, AnalyticWaveform{coarse, GaussianFit{}});
  });
  refused(quantity, "1 us, pulse of 4 ns, AnalyticWaveform with a record", [&] {
    return survey_of(laser, wall, AnalyticWaveform{WaveformSettings{.sample_interval = 1e-6, .record_length = 1e-3}});
  });
  refused(quantity, "0.1 ps, pulse of 4 ns, FullWaveform", [&] { return survey_of(laser, wall, FullWaveform{fine}); });
  refused(quantity, "1 us, width of a pulse of 4 ns, FullWaveform", [&] {
    return FullWaveform{coarse, MomentWidth{}}.pulse_width(laser);
  });
  refused(quantity, "0.25 ns, the last of 3 channels with a pulse of 1 fs, FullWaveform", [&] {
    std::vector<Scanner> lasers(3, Scanner{.pulses = 1000});
    lasers[2].laser.pulse_length = 1e-15;
    std::vector<Deflector<FixedBeam, Scanner>> emitters;
    for (const Scanner& s : lasers) emitters.emplace_back(FixedBeam{}, s);
    return Survey{Platform{Tripod{}, Mount{}, Channels{emitters}}, SingleRay{}, wall, validation::vacuum,
                  FullWaveform{}};
  });
  refused(quantity, "0.01 fs", [] { return FullWaveform{WaveformSettings{.sample_interval = 1e-17}}; });
  refused(quantity, "1 us, in a record of 1e7 and 1 bins",
          [] { return FullWaveform{WaveformSettings{.sample_interval = 1e-6, .record_length = 10.000001}}; });

  // without samples, bins do not matter
  const Errors errors = [&] {
    Errors all;
    for (const double bin : {1e-16, 1e-6, 1.0}) {
      const WaveformSettings settings{.sample_interval = bin, .threshold = 0};
      const auto judge = [&](const auto& detector) {
        const auto echoes = validation::one_pulse(wall, SingleRay{}, laser, validation::vacuum, detector).echoes;
        all.add(detector, echoes, 100, from_wall(laser, 100), width_of(4e-9));
      };
      judge(FirstHit{});
      judge(AnalyticWaveform<>(settings));
      judge(AnalyticWaveform<MomentWidth>(settings));
    }
    return all;
  }();
  const std::string bins = "0.1 fs to 1 s, pulse of 4 ns, detectors without samples: ";
  row(quantity, bins + "largest error of the range [m]", 0, errors.range, 1e-9);
  row(quantity, bins + "largest error of the amplitude, as a share", 0, errors.amplitude, 1e-9);
  row(quantity, bins + "largest error of the width, as a share", 0, errors.width, 1e-9);
  const AnalyticWaveform detector{WaveformSettings{.sample_interval = 1}, MomentWidth{}};
  row(quantity, "1 s, width of a pulse of 4 ns, AnalyticWaveform with moments, of the right one", 1,
      detector.pulse_width(laser) / width_of(4e-9).moment, 1e-9);
}

TEST_CASE("waveforms of ten million bins") {
  // the integral of a pulse of peak 1 is e^2 tau / 2
  const Laser laser{.pulse_length = 10e-9, .divergence = 1e-6};
  const TwoWalls walls{100, 1'400'000};
  const double tau = laser.pulse_length / 3.3946806708;
  const double energy = 0.5 * (from_wall(laser, 100) + from_wall(laser, 1'400'000)) * std::exp(2.0) / 2 * tau;
  const WaveformSettings settings{.sample_interval = 1e-9, .threshold = 0, .record_length = 10e-3};
  const Record full(FullWaveform{settings}, walls, laser), analytic(AnalyticWaveform{settings}, walls, laser);
  const double samples = std::ceil((2 * (1'400'000 - 100) / speed_of_light + 22 * tau) / 1e-9);
  row(quantity, "1e7 bins of 1 ns, walls at 100 m and 1400 km, FullWaveform: samples kept", samples,
      static_cast<double>(full.samples), 10);
  row(quantity, "1e7 bins of 1 ns, walls at 100 m and 1400 km, AnalyticWaveform: samples kept", samples,
      static_cast<double>(analytic.samples), 10);
  row(quantity, "1e7 bins of 1 ns, walls at 100 m and 1400 km, FullWaveform: energy, of the right one", 1,
      full.energy / energy, 1e-3);
  row(quantity, "1e7 bins of 1 ns, walls at 100 m and 1400 km, AnalyticWaveform: energy, of the right one", 1,
      analytic.energy / energy, 1e-3);

  const Record noisy(FullWaveform{settings, NoWidth{}, ReceiverNoise{.deviation = 1e-12, .background = 1e-9}}, walls,
                     laser);
  row(quantity, "1e7 bins of 1 ns, all of noise: samples kept", 1e7, static_cast<double>(noisy.samples), 0);
  row(quantity, "1e7 bins of 1 ns, all of noise: mean power, of background and echoes", 1,
      noisy.energy / (energy + 1e-9 * static_cast<double>(noisy.samples) * 1e-9), 1e-3);
}

TEST_CASE("the noise of a sample does not come again") {
  // echoes 2^32 bins apart: their samples' numbers agree in the lower 32 bits
  const double apart = 0x1p32 * 1e-12 * speed_of_light / 2;
  const Laser laser{.pulse_length = 1e-9, .divergence = 1e-9};
  const FullWaveform<> detector{WaveformSettings{.sample_interval = 1e-12, .threshold = 0.5e-9, .window = 100e-9},
                                NoWidth{}, ReceiverNoise{.deviation = 1e-10}};
  auto workspace = detector.workspace(2);
  std::vector<Reflection> reflections{{.range = 100, .power = 1e-9}, {.range = 100 + apart, .power = 1e-9}};
  const Detection detection = support::detect(detector, laser, reflections, workspace, {.seed = 1});
  REQUIRE(detection.echoes.size() == 2);
  row(quantity, "echoes 2^32 bins of 1 ps apart, with noise: how many have the same amplitude", 0,
      std::fabs(detection.echoes[0].amplitude / detection.echoes[1].amplitude - 1) < 1e-6 ? 1 : 0, 0);
}
