// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/mpi/rows.hpp>

#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/text_files.hpp>

#include "support/mpi_showers.hpp"

namespace pulsecast::mpi {
namespace {

using support::content;
using support::mpi_group;
using support::require_same_bytes;
using support::SharedFolder;
using support::Showers;
using support::written_alone;
using support::written_by_all;

TEST_CASE("texts are those of one process") {
  const Showers survey{50'000, 8};
  require_same_bytes(
      survey, "xyz", written_alone<io::XyzWriter>(survey, io::TextFileSettings{.start_time = 5}),
      written_by_all<MpiRows<io::XyzWriter, io::TextFileSettings>>(io::TextFileSettings{.start_time = 5}), {""});
  require_same_bytes(survey, "txt", written_alone<io::PulseTextWriter>(survey, io::TextFileSettings{}),
                     written_by_all<MpiRows<io::PulseTextWriter, io::TextFileSettings>>(io::TextFileSettings{}), {""});
  require_same_bytes(survey, "txt", written_alone<io::WaveformTextWriter>(survey, io::TextFileSettings{}),
                     written_by_all<MpiRows<io::WaveformTextWriter, io::TextFileSettings>>(io::TextFileSettings{}),
                     {""});
}

TEST_CASE("outputs may want one channel only") {
  const SharedFolder folder;
  const Showers survey{20'000};
  MpiRows<io::XyzWriter, io::TextFileSettings> rows(mpi_group(), folder / "all.xyz", {});
  rows.channel = 2;
  run(mpi_group(), survey, {.threads = 1}, rows);
  rows.close();
  if (!mpi_group().first()) return;
  io::XyzWriter writer(folder / "one.xyz");
  std::vector<Shot> shots;
  pulsecast::run(survey, {.threads = 1}, [&](EchoBatch batch) {
    shots.clear();
    for (const Shot& shot : batch.shots)
      if (shot.channel == 2) shots.push_back(shot);
    batch.shots = shots;
    writer(batch);
  });
  writer.close();
  CHECK((content(folder / "all.xyz") == content(folder / "one.xyz")));
}

}  // namespace
}  // namespace pulsecast::mpi
