// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/mpi/run.hpp>
#include <pulsecast/run.hpp>

#include "support/mpi_group.hpp"
#include "support/temporary_folder.hpp"

// Tests that run as they are, in one process, and under mpirun in several, all of which do all of them and must find
// the same.
namespace pulsecast::support {

using mpi::MpiOutput;

/// Pulses that bring back something by their number alone: nothing for a long time, then up to three echoes, with
/// waveforms.
struct Showers {
  struct Workspace {
    std::vector<Echo> echoes;
    std::vector<float> waveform;
  };

  PulseIndex pulses = 80'000;
  std::size_t samples = 0;  ///< of a waveform

  [[nodiscard]] Workspace workspace() const { return {}; }
  [[nodiscard]] PulseIndex size() const noexcept { return pulses; }
  [[nodiscard]] std::size_t subrays() const noexcept { return 1; }
  [[nodiscard]] std::size_t recorded_subrays() const noexcept { return 0; }
  [[nodiscard]] double sample_interval() const noexcept { return 1e-9; }

  [[nodiscard]] Outcome operator()(PulseIndex i, Workspace& w) const noexcept {
    const std::uint64_t mixed = (i + 1) * 0x9e3779b97f4a7c15U;
    const auto bits = [&](int from, std::uint64_t below) { return (mixed >> from) % below; };
    w.echoes.clear();
    w.waveform.clear();
    const std::uint64_t echoes = i < 3000 ? 0 : bits(40, 4);
    for (std::uint64_t k = 0; k < echoes; ++k)
      w.echoes.push_back({.range = 100 + 7 * static_cast<double>(k) + 1e-3 * static_cast<double>(bits(20, 4000)),
                          .amplitude = 1e-9 * static_cast<double>(1 + bits(12, 1000)),
                          .reflectance = 1e-3 * static_cast<double>(bits(30, 1000)),
                          .object = static_cast<ObjectId>(bits(8, 50)),
                          .classification = static_cast<std::uint16_t>(bits(50, 9)),
                          .number = static_cast<std::uint8_t>(k + 1)});
    if (echoes > 0)
      for (std::size_t s = 0; s < samples; ++s)
        w.waveform.push_back(1e-9F * static_cast<float>((s * 7 + bits(33, 100)) % 50));
    Outcome outcome{};
    outcome.shot = {.index = i,
                    .tick = Tick::of(i, 1e5),
                    .origin = {6e5 + 1e-2 * static_cast<double>(i), 5e6, 1000},
                    .direction = {std::sin(1e-5 * static_cast<double>(i)), 0, -std::cos(1e-5 * static_cast<double>(i))},
                    .leg = static_cast<std::uint16_t>(i / 50'000),
                    .channel = static_cast<std::uint8_t>(i % 3),
                    .fate = i % 11 == 0  ? Fate::blocked
                            : echoes > 0 ? Fate::returned
                                         : Fate::missed,
                    .waveform_start = 5e-7};
    if (outcome.shot.fate == Fate::blocked) return outcome;
    outcome.energy.sent = 1;
    outcome.echoes = w.echoes;
    outcome.waveform = w.waveform;
    return outcome;
  }
};

/// A file as one process writes it, and as all do.
template <class Survey>
void require_same_bytes(const Survey& survey, const std::string& name,
                        const std::function<void(const std::filesystem::path&)>& alone,
                        const std::function<std::unique_ptr<MpiOutput>(const std::filesystem::path&)>& shared,
                        const std::vector<std::string>& endings) {
  for (const unsigned threads : {1U, 2U}) {
    const SharedFolder folder;
    const std::filesystem::path one = folder / ("one." + name), all = folder / ("all." + name);
    if (mpi_group().first()) alone(one);
    {
      const auto output = shared(all);
      // in two runs, as a strip of two legs is
      const RunSummary first = run(mpi_group(), survey, {.threads = threads, .end = survey.size() / 3}, *output);
      const RunSummary second = run(mpi_group(), survey, {.threads = threads, .first = survey.size() / 3}, *output);
      CHECK(first.complete);
      CHECK(first.slots + second.slots == survey.size());
      output->close();
    }
    if (!mpi_group().first()) continue;
    INFO(name, ", ", mpi_group().size(), " processes, ", threads, " threads");
    for (const std::string& ending : endings) {
      const auto with = [&](std::filesystem::path path) {
        return ending.empty() ? path : path.replace_extension(ending);
      };
      const std::string expected = content(with(one));
      CHECK(expected.size() > 1000);
      CHECK((content(with(all)) == expected));
      CHECK(!std::filesystem::exists(with(all).string() + ".part"));
    }
  }
}

template <class Writer, class Survey, class... Arguments>
auto written_alone(const Survey& survey, const Arguments&... arguments) {
  return [=](const std::filesystem::path& path) {
    Writer writer(path, arguments...);
    pulsecast::run(survey, {.threads = 1}, writer);
    writer.close();
  };
}

template <class Output, class... Arguments>
auto written_by_all(const Arguments&... arguments) {
  return [=](const std::filesystem::path& path) { return std::make_unique<Output>(mpi_group(), path, arguments...); };
}

}  // namespace pulsecast::support
