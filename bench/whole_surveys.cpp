// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Time of a pulse of 19 subrays in whole runs, from the slot to the echo [ns]: an airplane over level ground, with and
// without a LAS file, on one thread and on two, with true-range timing and others; and a tripod in a street, with a
// beam from a point, one with a waist, whose subrays are traced one by one, and with all subrays recorded. The file is
// written to the system's folder for temporary files, and removed.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <pulsecast/detector/band_limited_receiver.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/pulsecast.hpp>

#include "report.hpp"
#include "scenes.hpp"
#include "surveys.hpp"

using namespace bench;

namespace {

constexpr PulseIndex pulses = 100'000;

template <Footprint Pattern>
std::uint64_t street_echoes(const Pattern& footprint, const street::Scene& map, double waist_diameter) {
  const Laser laser{.divergence = 0.3_mrad, .waist_diameter = waist_diameter};
  const Platform source{Tripod{.position = {1.2, 0, street::height({1.2, 0})}}, Mount{.lever_arm = {0, 0, 1.7}},
                        Deflector{RotatingHead{.angular_rate = 0.5},
                                  Deflector{PolygonMirror{.line_rate = 50, .sweep = 80_deg},
                                            Scanner{.pulse_rate = 20_kHz, .pulses = pulses, .laser = laser}}}};
  return run(Survey{source, footprint, map, Receiver{}, FullWaveform{}}, {.threads = 1}).echoes;
}

}  // namespace

int main(int count, char** words) {
  Report report("whole_surveys", count, words);
  const Scene<Mesh> ground = scene_of({.vertices = {{-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}},
                                       .triangles = {{0, 1, 2}, {0, 2, 3}}});
  const auto over = [&](const auto& detector) {
    return Survey{airplane(pulses), SunflowerFootprint{19}, ground, Receiver{}, detector};
  };
  const auto survey = over(FullWaveform{{.timing = EchoTiming::true_range}});
  const auto by_peaks = over(FullWaveform{});
  const auto band_limited = over(FullWaveform<NoWidth, BandLimitedReceiver<>>{});
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "pulsecast_bench_whole_surveys.las";

  std::vector<std::string> names;
  std::vector<std::function<void()>> works;
  const auto add = [&](const std::string& name, std::function<void()> work) {
    if (!report.wanted(name)) return;
    names.push_back(name);
    works.push_back(std::move(work));
  };
  const auto to_nothing = [](const EchoBatch& batch) { keep(batch.echoes.size()); };
  for (const unsigned threads : {1U, 2U}) {
    const std::string on = threads == 1 ? ", 1 thread" : ", 2 threads";
    add("plane, no file" + on, [&survey, &to_nothing, threads] { run(survey, {.threads = threads}, to_nothing); });
    add("plane, LAS" + on, [&survey, &file, threads] {
      pulsecast::io::LasWriter writer(file, {});
      run(survey, {.threads = threads}, writer);
      writer.close();
    });
  }
  add("plane, default timing", [&] { run(by_peaks, {.threads = 1}, to_nothing); });
  add("plane, band-limited", [&] { run(band_limited, {.threads = 1}, to_nothing); });

  const street::Scene town = street::scene(1);
  const auto cone = [&] { return street_echoes(RingFootprint{3}, town, 0); };
  const auto waist = [&] { return street_echoes(RingFootprint{3}, town, 7_mm); };
  const auto recorded = [&] { return street_echoes(WithSubrayRecord{RingFootprint{3}}, town, 0); };
  const auto echoes = static_cast<double>(cone());
  if (static_cast<double>(recorded()) != echoes || std::fabs(static_cast<double>(waist()) - echoes) > 0.01 * echoes) {
    std::printf("beams with waists or records give other echoes\n");
    std::exit(1);
  }
  add("street, a cone from a point", [&] { keep(cone()); });
  add("street, a waist of 7 mm", [&] { keep(waist()); });
  add("street, all subrays recorded", [&] { keep(recorded()); });

  const std::vector<Times> processor = report.by_turns(works, process_seconds),
                           wall = report.by_turns(works, wall_seconds);
  report.heading("a pulse of 19 subrays, from the slot to the echo or file");
  for (std::size_t i = 0; i < works.size(); ++i)
    report.row(names[i],
               {{"ns of processors", 1e9 * median(processor[i]) / pulses}, {"ns", 1e9 * median(wall[i]) / pulses}});
  std::filesystem::remove(file);
}
