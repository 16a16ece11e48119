// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of writing: million points per second of processor time, including that of the system, and bytes a point, by
// format. One batch, from an airplane over hills with waveforms of 80 samples a pulse, is written again and again to
// the system's folder for temporary files. The files are removed.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <pulsecast/io/gzip.hpp>
#include <pulsecast/io/las.hpp>
#include <pulsecast/io/laz.hpp>
#include <pulsecast/io/text_files.hpp>
#include <pulsecast/pulsecast.hpp>

#include "report.hpp"
#include "scenes.hpp"
#include "surveys.hpp"

using namespace bench;
using namespace pulsecast::io;

int main(int count, char** words) {
  Report report("write", count, words);
  const auto scene = scene_of(hills(100).mesh());
  const FullWaveform detector{{.record_length = 20_ns}};
  Recording recording;
  run(Survey{airplane(20'000), SunflowerFootprint{7}, scene, Receiver{}, detector}, {}, recording);
  const EchoBatch batch = recording.batch();

  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "pulsecast_bench_write";
  std::filesystem::create_directory(folder);
  std::vector<std::string> names;
  std::vector<std::function<void()>> works;
  const auto add = [&](const std::string& name, std::size_t batches, const auto& make) {
    if (!report.wanted(name)) return;
    names.push_back(name);
    works.emplace_back([&, batches, name, make] {
      auto writer = make(folder / name);
      for (std::size_t i = 0; i < batches; ++i) writer(batch);
      writer.close();
    });
  };
  constexpr std::size_t many = 20;  // so that what a file costs does not count
  const auto las = [&](LasFormat format, bool waveforms) {
    return
        [=](const std::filesystem::path& path) { return LasWriter(path, {.format = format, .waveforms = waveforms}); };
  };
  add("LAS 1.4 f6.las", many, las(LasFormat::las_1_4, false));
  add("LAS 1.4 f9.las", many, las(LasFormat::las_1_4, true));
  add("LAS 1.0.las", many, las(LasFormat::las_1_0, false));
  add("LAZ 1.4 f6.laz", many, [](const std::filesystem::path& path) { return LazWriter(path, {}, 1); });
  add("text.xyz", many, [](const std::filesystem::path& path) { return XyzWriter(path); });
  add("text.xyz.gz", many / 4, [](const std::filesystem::path& path) { return XyzWriter(gzip_file(path)); });
  add("waveforms.txt", many / 4, [](const std::filesystem::path& path) { return WaveformTextWriter(path); });

  const std::vector<Times> times = report.by_turns(works, process_seconds);
  report.heading(std::to_string(batch.echoes.size()) + " points in a batch");
  for (std::size_t i = 0; i < works.size(); ++i) {
    const bool fewer = names[i] == "text.xyz.gz" || names[i] == "waveforms.txt";
    const double points = static_cast<double>(batch.echoes.size() * (fewer ? many / 4 : many));
    auto bytes = static_cast<double>(std::filesystem::file_size(folder / names[i]));
    if (names[i] == "LAS 1.4 f9.las")
      bytes += static_cast<double>(std::filesystem::file_size(folder / "LAS 1.4 f9.wdp"));
    report.row(names[i], {{"Mpoints/s", points / median(times[i]) / 1e6},
                          {"MB/s", bytes / median(times[i]) / 1e6},
                          {"bytes/point", bytes / points}});
  }
  std::filesystem::remove_all(folder);
}
