// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/detector/analytic_waveform.hpp>
#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/pulsecast.hpp>
#include <pulsecast/transport/light_paths.hpp>

#include "../report.hpp"
#include "scenes.hpp"
#include "score.hpp"

/// Settings that are compared: the library's defaults with one knob turned, and those of XML surveys.
namespace tradeoff {

enum class DetectorKind : std::uint8_t { sampled, analytic, first_hit, received };

struct Setting {
  std::string name;
  Pattern footprint = lattice(19);
  DetectorKind detector = DetectorKind::sampled;
  double bin = 1.0 / 16;  ///< 0.25 ns of a pulse of 4 ns [pulse lengths]
  bool xml = false;       ///< echoes by the definition of XML surveys, and so the truth
  bool spread = true;     ///< light over smooth surfaces
  bool exact = false;     ///< traversed in `double`, in scenes that have such a map
  bool turned = false;    ///< by a random angle for each pulse
  double bandwidth = 0;   ///< of `received`, times the pulse length; 0 for that of the pulse
  bool noisy = false;     ///< of `received`: noise a tenth of the threshold before the filter
  double prominence = 0;  ///< of the threshold
};

/// Definitions of an echo: the library's, and that of XML surveys, which take peaks where light is followed.
[[nodiscard]] inline EchoRule rule_of(const Scenario& scenario, bool xml) {
  return xml ? EchoRule{.divisor = 3.5, .window = 0.5, .by_mean = !scenario.follows_light} : EchoRule{};
}

/// All settings, the default first.
[[nodiscard]] inline std::vector<Setting> all_settings() {
  std::vector<Setting> all{{.name = "lattice 19"}};
  for (const std::size_t n : {1U, 3U, 7U, 9U, 13U, 37U, 61U, 127U})
    all.push_back({"lattice " + std::to_string(n), lattice(n)});
  for (const std::size_t n : {7U, 19U, 37U, 127U}) all.push_back({"sunflower " + std::to_string(n), sunflower(n)});
  for (const std::size_t circles : {2U, 3U, 4U, 7U}) {
    const Pattern pattern = rings(circles);
    all.push_back({"rings " + std::to_string(pattern.size()), pattern});
  }
  all.push_back({.name = "lattice 19, turned", .turned = true});
  all.push_back({"single ray, first hit", lattice(1), DetectorKind::first_hit});
  for (const double bins : {80, 40, 8, 4, 2})
    all.push_back({.name = "bins of 1/" + std::to_string(static_cast<int>(bins)) + " pulse", .bin = 1 / bins});
  for (const std::size_t n : {7U, 19U, 37U, 127U})
    all.push_back({"analytic, lattice " + std::to_string(n), lattice(n), DetectorKind::analytic});
  all.push_back({.name = "prominence of the threshold", .prominence = 1});
  all.push_back({.name = "without spread", .spread = false});
  all.push_back({.name = "traversal in double", .exact = true});
  all.push_back({.name = "XML: rings 19, mean range", .footprint = rings(3), .xml = true});
  all.push_back({"receiver: bandwidth, rings 19 of whole moments",
                 {"rings", RingFootprint(3, RingMoments::whole)},
                 DetectorKind::received});
  all.push_back({.name = "receiver: bandwidth", .detector = DetectorKind::received});
  all.push_back({.name = "receiver: and noise", .detector = DetectorKind::received, .noisy = true});
  all.push_back(
      {.name = "receiver: noise, prominence", .detector = DetectorKind::received, .noisy = true, .prominence = 1});
  all.push_back({.name = "receiver: noise, 8 times the bandwidth",
                 .detector = DetectorKind::received,
                 .bandwidth = 8 * 0.44,
                 .noisy = true});
  return all;
}

/// Far finer than any setting, for scenes without a truth.
[[nodiscard]] inline Setting reference(bool xml, const Pattern& pattern) {
  return {"reference", pattern, DetectorKind::analytic, 1.0 / 16, xml};
}

/// Calls a function with the survey of a setting over a cluster.
template <class Function>
auto with_survey(const Scenario& scenario, const Cluster& cluster, const Setting& setting, const Function& function) {
  const Instrument& instrument = scenario.instrument;
  const double pulse = instrument.laser.pulse_length;
  const EchoRule rule = rule_of(scenario, setting.xml);
  const auto seed = static_cast<std::uint64_t>(&cluster - scenario.clusters.data());
  WaveformSettings settings{.sample_interval = setting.bin * pulse,
                            .threshold = instrument.threshold,
                            .prominence = setting.prominence * instrument.threshold,
                            .window = rule.window * pulse,
                            .returns_max = 255,
                            .timing = rule.by_mean ? EchoTiming::true_range : EchoTiming::peak,
                            .shape_divisor = rule.divisor};
  const Receiver receiver{.diameter = instrument.diameter,
                          .efficiency = instrument.efficiency,
                          .visibility = std::numeric_limits<double>::infinity(),
                          .range_min = scenario.gate.near,
                          .range_max = scenario.gate.far};
  const auto over = [&](const auto& map, const auto& light) {
    const auto with = [&](const auto& detector) {
      return function(Survey(setting.turned ? cluster.pulses.rolled(seed) : cluster.pulses, setting.footprint, map,
                             light, receiver, detector, seed));
    };
    switch (setting.detector) {
      case DetectorKind::analytic:
        return with(AnalyticWaveform<>(settings));
      case DetectorKind::first_hit:
        return with(FirstHit{});
      case DetectorKind::received: {
        ReceiverChain chain{.bandwidth = setting.bandwidth / pulse};
        if (setting.noisy)
          chain.noise_power = instrument.threshold / 10 / std::sqrt(chain.filter(pulse).noise_bandwidth());
        return with(FullWaveform<NoWidth, BandLimitedReceiver<>>(settings, {}, BandLimitedReceiver<>(chain)));
      }
      default:
        return with(FullWaveform<>(settings));
    }
  };
  const Fog& fog = scenario.fog;
  if (setting.exact) return over(*cluster.exact, DirectLight{setting.spread});
  const Scene<Mesh>& map = *cluster.map;
  if (!scenario.follows_light) return over(map, DirectLight{setting.spread});
  LightPaths light{.spread_planes = setting.spread};
  if (fog.to > fog.from)
    light.air = Media({{.medium = {.scattering = fog.extinction, .backscatter = fog.backscatter},
                        .bounds = {{-1e3, fog.from, -1e3}, {1e3, fog.to, 1e3}}}});
  return over(map, light);
}

/// Echoes of all pulses of a scenario, cluster by cluster.
using Results = std::vector<std::vector<Points>>;

[[nodiscard]] inline Results results_of(const Scenario& scenario, const Setting& setting) {
  Results all;
  for (const Cluster& cluster : scenario.clusters)
    all.push_back(with_survey(scenario, cluster, setting, [](const auto& survey) {
      std::vector<Points> found;
      auto workspace = survey.workspace();
      for (PulseIndex i = 0; i < survey.size(); ++i) {
        Points points;
        for (const Echo& echo : survey(i, workspace).echoes) points.push_back({echo.range, echo.reflectance});
        found.push_back(std::move(points));
      }
      return found;
    }));
  return all;
}

/// The truth of all pulses by a quadrature of so many points, of even planes four times as many, by both definitions.
[[nodiscard]] inline std::array<Results, 2> truth_of(const Scenario& scenario, std::size_t points) {
  std::array<Results, 2> all;
  all.fill(Results(scenario.clusters.size()));
  const auto& surfaces = scenario.clusters.front().surfaces;
  const auto* only = surfaces.size() == 1 ? std::get_if<Plane>(&surfaces.front()) : nullptr;
  const bool edges = !only || only->beyond > 0;
  const std::vector<Place> places = quadrature(edges ? points : 4 * points, edges);
  for (std::size_t c = 0; c < scenario.clusters.size(); ++c)
    for (const Axes& axes : scenario.clusters[c].axes) {
      const Lit lit = light_of(scenario.clusters[c].surfaces, scenario.fog, scenario.instrument, axes, places);
      for (const bool xml : {false, true})
        all[xml][c].push_back(echoes_of(lit, scenario.instrument, rule_of(scenario, xml)));
    }
  return all;
}

inline constexpr std::size_t timed_every = 16;  ///< clusters, of which one is timed

[[nodiscard]] inline std::size_t timed_pulses(const Scenario& scenario) {
  std::size_t pulses = 0;
  for (std::size_t c = 0; c < scenario.clusters.size(); c += timed_every) pulses += scenario.clusters[c].pulses.size();
  return pulses;
}

/// A go of a setting through the pulses that are timed.
[[nodiscard]] inline std::function<void()> work_of(const Scenario& scenario, const Setting& setting) {
  std::vector<std::function<void()>> works;
  for (std::size_t c = 0; c < scenario.clusters.size(); c += timed_every)
    works.push_back(with_survey(scenario, scenario.clusters[c], setting, [](const auto& survey) {
      return std::function<void()>([survey, workspace = survey.workspace()]() mutable {
        std::size_t echoes = 0;
        for (PulseIndex i = 0; i < survey.size(); ++i) echoes += survey(i, workspace).echoes.size();
        bench::keep(echoes);
      });
    }));
  return [works = std::move(works)] {
    for (const auto& work : works) work();
  };
}

}  // namespace tradeoff
