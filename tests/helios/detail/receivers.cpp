// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/helios/detail/receivers.hpp>

#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/helios/survey.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/survey.hpp>

#include "support/relative.hpp"

namespace pulsecast::helios {
namespace {

using support::relative;

/// A wall across y = 100 m, and to the right of x = 0 another before it, at 60 m.
struct Wall {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const double range = (ray.direction.x > 0 ? 60 : 100) / ray.direction.y;
    if (!(ray.direction.y > 0)) return std::nullopt;
    return Hit{.range = range, .cos_incidence = ray.direction.y, .backscatter = 0.5 * ray.direction.y};
  }
};

constexpr auto no_ground = [](const Vec2&) -> std::optional<double> { return std::nullopt; };

/// Beams straight ahead, a second at 1 kHz.
SurveySettings survey_of(const std::vector<ChannelSettings>& channels) {
  SurveySettings survey;
  survey.scanner = {.id = "s", .pulse_rates = {1000}, .channels = channels};
  survey.legs.push_back({.duration_max = 1});
  survey.legs.push_back({.duration_max = 0.5});
  return survey;
}

ReceiverUnit<RingFootprint, FullWaveform<>> receiver_of(const ChannelSettings& channel) {
  return {RingFootprint(static_cast<std::size_t>(channel.waveform.rings)), survey_receiver(channel),
          FullWaveform(survey_waveform(channel))};
}

auto build(const SurveySettings& survey, const Wall& wall) {
  return Survey(compile_survey(survey, no_ground).source,
                ReceiverGroups(survey.scanner).units(survey.scanner, receiver_of), wall, 3);
}

ChannelSettings ahead() {
  ChannelSettings channel;
  channel.optic = RotatingOptic{};
  channel.divergence = 5e-3;
  channel.visibility = 1e6;
  return channel;
}

TEST_CASE(
    "each channel has its own aperture, efficiency, range gate, threshold, noise, number of returns and subrays") {
  const ChannelSettings usual = ahead();
  std::vector<ChannelSettings> channels(8, usual);
  channels[1].receiver_diameter = 2 * usual.receiver_diameter;
  channels[2].efficiency = 0.5 * usual.efficiency;
  channels[3].range_max = 80;
  channels[4].received_power_min = 1;
  channels[5].accuracy = 0.5;
  channels[6].returns_max = 1;
  channels[7].waveform.rings = 1;
  const SurveySettings survey = survey_of(channels);
  const Wall wall;
  const auto run = build(survey, wall);
  CHECK(run.size() == 8 * 1500);
  auto w = run.workspace();
  const auto shot = [&](PulseIndex slot, std::size_t channel) {
    const Outcome out = run(8 * slot + channel, w);
    CHECK(out.shot.channel == channel);
    return out;
  };
  for (const PulseIndex slot : {PulseIndex{0}, PulseIndex{700}, PulseIndex{1000}, PulseIndex{1499}}) {  // in both legs
    CAPTURE(slot);
    REQUIRE(shot(slot, 0).echoes.size() == 2);
    const double near = shot(slot, 0).echoes[0].amplitude, far = shot(slot, 0).echoes[1].amplitude;
    CHECK(shot(slot, 0).echoes[1].range == relative(100, 1e-4));
    const double square = 0.25 * usual.receiver_diameter * usual.receiver_diameter,
                 disc = (60 * 60 + square) / (60 * 60 + 4 * square);
    CHECK(shot(slot, 1).echoes[0].amplitude == relative(4 * disc * near, 1e-9));
    CHECK(shot(slot, 2).echoes[1].amplitude == relative(0.5 * far, 1e-9));
    REQUIRE(shot(slot, 3).echoes.size() == 1);
    CHECK(shot(slot, 3).echoes[0].range == relative(60, 1e-4));
    CHECK(shot(slot, 4).shot.fate == Fate::below_threshold);
    CHECK(shot(slot, 5).echoes[1].range != relative(100, 1e-4));
    CHECK(shot(slot, 6).echoes.size() == 1);
    CHECK(shot(slot, 7).echoes.size() == 1);
  }
  CHECK(run.subrays() == (7 * RingFootprint(3).size() + 1) / 8);
}

TEST_CASE("channels that receive alike share a receiver, whatever they send, and give what a plain survey gives") {
  std::vector<ChannelSettings> channels(3, ahead());
  channels[1].average_power = 10;
  channels[2].wavelength = 532e-9;
  channels[2].beam_origin.position = {0, 5, 0};
  const SurveySettings survey = survey_of(channels);
  const Wall wall;
  int made = 0;
  const auto units = ReceiverGroups(survey.scanner).units(survey.scanner, [&](const ChannelSettings& c) {
    ++made;
    return receiver_of(c);
  });
  const Survey run(compile_survey(survey, no_ground).source, units, wall, 3);
  CHECK(made == 1);
  const Survey plain(compile_survey(survey, no_ground).source, RingFootprint(3), wall, survey_receiver(channels[0]),
                     FullWaveform(survey_waveform(channels[0])), 3);
  const auto collect = [](const auto& any) {
    std::vector<double> all;
    pulsecast::run(any, {.threads = 2}, [&](const EchoBatch& batch) {
      for (const Echo& echo : batch.echoes) all.insert(all.end(), {echo.range, echo.amplitude});
    });
    return all;
  };
  CHECK(collect(run).size() > 3 * 1500);
  CHECK(collect(run) == collect(plain));
  channels[2].waveform.duration_max = 1e-6;
  CHECK_FALSE(same_receiver(channels[0], channels[2]));
  CHECK(same_receiver(channels[0], channels[1]));
}

TEST_CASE("channels that differ in any property of their receivers share none") {
  const auto share = [](const auto& change) {
    ChannelSettings other = ahead();
    change(other);
    return same_receiver(ahead(), other);
  };
  CHECK(share([](ChannelSettings& c) { c.average_power *= 2; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.receiver_diameter *= 2; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.efficiency *= 0.5; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.visibility *= 0.5; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.accuracy += 1; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.errors.range_noise = "t"; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.range_min += 1; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.range_max = 7; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.returns_max += 1; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.returns_kept = KeptReturns::strongest; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.received_power_min += 1; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.pulse_length *= 2; }));
  CHECK_FALSE(share([](ChannelSettings& c) { c.waveform.rings += 1; }));
}

TEST_CASE("channels that do not fit together are refused") {
  std::vector<ChannelSettings> channels(2, ahead());
  channels[1].waveform.bin_size *= 2;
  const SurveySettings survey = survey_of(channels);
  const Wall wall;
  CHECK_THROWS_AS((void)build(survey, wall), SettingError);
  const auto legs = compile_survey(survey, no_ground).source;
  CHECK_THROWS_AS(Survey(legs, std::vector{receiver_of(channels[0])}, wall), SettingError);
}

TEST_CASE("channels with equal receivers are one group, and pulses carry its number, however many there are") {
  std::vector<ChannelSettings> channels(300, ahead());
  for (std::size_t k = 0; k < channels.size(); ++k) channels[k].accuracy = 0.001 * static_cast<double>(k % 3);
  const SurveySettings survey = survey_of(channels);
  const ReceiverGroups groups(survey.scanner);
  CHECK(groups.channels == std::vector<std::size_t>{0, 1, 2});
  const std::vector<Emitter> emitters = compile_survey(survey, no_ground).source.emitters();
  REQUIRE(emitters.size() == 300);
  for (std::size_t k = 0; k < 300; ++k) {
    CHECK(emitters[k].receiver == k % 3);
    CHECK(emitters[k].channel == k);
  }
}

}  // namespace

TEST_CASE("receivers of the library's physics have its defaults, and noise that seldom is an echo") {
  ChannelSettings channel = ahead();
  channel.waveform.rings = 3;
  const auto unit = library_receiver_unit<NoWidth>(channel, survey_waveform(channel, 0, true), true);
  CHECK(unit.receiver.aerosols == AerosolModel::kim);
  CHECK(unit.detector.settings().timing == EchoTiming::peak);
  CHECK(unit.detector.settings().shape_divisor == PulseShape::divisor);
  double squares = 0;
  for (std::size_t j = 0; j < unit.footprint.size(); ++j)
    squares += unit.footprint.share(j) * dot(unit.footprint.offset(j), unit.footprint.offset(j));
  CHECK(squares == doctest::Approx(0.5));
  const WaveformSettings as_before = survey_waveform(channel);
  CHECK(as_before.timing == EchoTiming::true_range);
  CHECK(as_before.shape_divisor == 3.5);
  CHECK(survey_receiver(channel).aerosols == AerosolModel::kruse);
}

TEST_CASE("noise of the library's physics deviates by a sixth of the minimum power, in samples") {
  for (const double length : {1e-9, 4e-9, 20e-9})
    for (const double share : {1.0, 0.1}) {  // bin by pulse length
      ChannelSettings channel = ahead();
      channel.pulse_length = length;
      channel.waveform.bin_size = share * length;
      channel.received_power_min = 1e-9;
      auto unit = library_receiver_unit<NoWidth>(channel, survey_waveform(channel, 200e-9, true), true);
      const Emitter emitter{.laser = survey_laser(channel, {})};
      unit.detector.prepare(emitter.laser);
      auto w = unit.detector.workspace(1);
      double sum = 0, squares = 0;
      constexpr int pulses = 2000;
      const double range = 100, power = 100 * channel.received_power_min;
      for (std::uint64_t k = 0; k < pulses; ++k) {
        std::vector<Reflection> wall{{.range = range, .power = power}};
        const Detection found = unit.detector.detect({emitter, {90, 110}, wall, {.seed = 3, .pulse = k}}, w);
        const double at = (2 * range / speed_of_light - found.waveform_start) / (share * length);
        const auto peak = static_cast<std::size_t>(std::lround(at));
        REQUIRE(peak < found.waveform.size());
        sum += found.waveform[peak];
        squares += static_cast<double>(found.waveform[peak]) * found.waveform[peak];
      }
      const double mean = sum / pulses, deviation = std::sqrt(squares / pulses - mean * mean);
      CAPTURE(length);
      CAPTURE(share);
      CHECK(mean > 0.5 * power);  // on the pulse
      CHECK(deviation == relative(channel.received_power_min / 6, 4 / std::sqrt(2.0 * pulses)));
    }
}

TEST_CASE("air beyond what its extinction was measured for is told of") {
  ChannelSettings channel = ahead();
  channel.wavelength = 1064e-9;
  const auto warning = [&](bool library) { return air_warning(channel.wavelength, survey_receiver(channel, library)); };
  CHECK(warning(false).empty());
  channel.visibility = 2e3;
  CHECK(warning(false).find("2 km") != std::string::npos);
  CHECK(warning(true).empty());
  channel.wavelength = 10.6e-6;
  CHECK(warning(true).find("10600 nm") != std::string::npos);
}

TEST_CASE("noise of the range may depend on it by any formula that is finite where the scanner measures") {
  ChannelSettings c;
  c.accuracy = 0.01;
  CHECK(survey_receiver(c).range_errors.deviation_at(70) == relative(0.01, 1e-15));
  struct Case {
    const char* formula;
    double (*value)(double);
  };
  for (const Case& k : {Case{"1 + 0.002*t", [](double t) { return 1 + 0.002 * t; }},
                        {"t^2", [](double t) { return t * t; }},
                        {"sqrt(t)/10", [](double t) { return std::sqrt(t) / 10; }},
                        {"-3/t", [](double t) { return 3 / t; }}})
    for (const double range : {0.5, 1.0, 7.3, 120.0, 3333.0, 9.9e5}) {
      CAPTURE(k.formula);
      c.errors.range_noise = k.formula;
      const Receiver receiver = survey_receiver(c);
      CHECK_NOTHROW(receiver.validate());
      CHECK(receiver.range_errors.at(Echo{.range = range}, 1) == relative(0.01 * k.value(range), 1e-4));
    }
  c.errors.range_noise = "sqrt(t-5)";
  CHECK_THROWS_AS((void)survey_receiver(c), SettingError);
  c.range_min = 6;
  c.range_max = 10;
  CHECK(survey_receiver(c).range_errors.deviation_at(9) == relative(0.02, 1e-6));
  c.errors.range_noise = "1/(t-";
  CHECK_THROWS_AS((void)survey_receiver(c), std::invalid_argument);
}

TEST_CASE("echoes are sought in both ways of light, as documents count one") {
  ChannelSettings c;
  c.pulse_length = 4e-9;
  c.returns_max = 0;
  CHECK(survey_waveform(c).window == relative(2e-9, 1e-9));
  CHECK(survey_waveform(c).returns_max == 255);
  c.waveform.window = 3e-9;
  c.waveform.duration_max = 10e-9;
  c.returns_max = 4;
  CHECK(survey_waveform(c, 1e-6).window == relative(6e-9, 1e-9));
  CHECK(survey_waveform(c, 1e-6).record_length == relative(20e-9, 1e-9));
  CHECK(survey_waveform(c, 0).record_length == 0);
  CHECK(survey_waveform(c).returns_max == 4);
  CHECK(survey_waveform(c).returns_kept == KeptReturns::first);
  c.returns_kept = KeptReturns::strongest;
  CHECK(survey_waveform(c).returns_kept == KeptReturns::strongest);
}

}  // namespace pulsecast::helios
