// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Time of a pulse of 19 subrays on one plane, from the slot to the echo in a LAS file [ns]: an airplane over level
// ground, `FullWaveform` with true-range timing, and with others. Rows are named sink/threads. The file is written to
// the system's folder for temporary files, and removed.

#include <cstddef>
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

int main(int count, char** words) {
  Report report("plane", count, words);
  constexpr PulseIndex pulses = 500'000;
  const auto plane = std::make_shared<const Mesh>(
      MeshData{.vertices = {{-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}},
               .triangles = {{0, 1, 2}, {0, 2, 3}}});
  const Scene<Mesh> ground({{.geometry = plane}});
  const FullWaveform by_true_ranges{{.timing = EchoTiming::true_range}};
  const Survey survey{airplane(pulses), SunflowerFootprint{19}, ground, Receiver{}, by_true_ranges};
  const Survey by_peaks{airplane(pulses), SunflowerFootprint{19}, ground, Receiver{}, FullWaveform{}};
  const Survey band_limited{airplane(pulses), SunflowerFootprint{19}, ground, Receiver{},
                            FullWaveform<NoWidth, BandLimitedReceiver<>>{}};
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "pulsecast_bench_plane.las";

  std::vector<std::string> names;
  std::vector<std::function<void()>> works;
  for (const unsigned threads : {1U, 2U}) {
    names.push_back("none/" + std::to_string(threads));
    works.emplace_back([&survey, threads] {
      run(survey, {.threads = threads}, [](const EchoBatch& batch) { keep(batch.echoes.size()); });
    });
    names.push_back("LAS/" + std::to_string(threads));
    works.emplace_back([&survey, &file, threads] {
      pulsecast::io::LasWriter writer(file, {});
      run(survey, {.threads = threads}, writer);
      writer.close();
    });
  }
  names.emplace_back("default timing, none/1");
  works.emplace_back(
      [&by_peaks] { run(by_peaks, {.threads = 1}, [](const EchoBatch& batch) { keep(batch.echoes.size()); }); });
  names.emplace_back("band-limited, none/1");
  works.emplace_back([&band_limited] {
    run(band_limited, {.threads = 1}, [](const EchoBatch& batch) { keep(batch.echoes.size()); });
  });
  const std::vector<Times> processor = report.by_turns(works, process_seconds),
                           wall = report.by_turns(works, wall_seconds);
  report.heading("19 subrays");
  for (std::size_t i = 0; i < works.size(); ++i)
    report.row(names[i],
               {{"processor", 1e9 * median(processor[i]) / pulses}, {"wall", 1e9 * median(wall[i]) / pulses}});
  std::filesystem::remove(file);
}
