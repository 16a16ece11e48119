// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/adapters/mpi_rows.hpp>

#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/adapters/pulse_text.hpp>
#include <pulsecast/adapters/waveform_text.hpp>
#include <pulsecast/adapters/xyz.hpp>

#include "support/mpi_showers.hpp"

namespace pulsecast::adapters {
namespace {

using support::content;
using support::expect_same_bytes;
using support::mpi_team;
using support::SharedFolder;
using support::Showers;
using support::written_alone;
using support::written_by_all;

TEST_CASE("texts are those of one process") {
  const Showers survey{50'000, 8};
  expect_same_bytes(survey, "xyz", written_alone<XyzWriter>(survey, XyzSettings{.start_time = 5}),
                    written_by_all<MpiRows<XyzWriter, XyzSettings>>(XyzSettings{.start_time = 5}), {""});
  expect_same_bytes(survey, "txt", written_alone<PulseTextWriter>(survey, PulseTextSettings{}),
                    written_by_all<MpiRows<PulseTextWriter, PulseTextSettings>>(PulseTextSettings{}), {""});
  expect_same_bytes(survey, "txt", written_alone<WaveformTextWriter>(survey, WaveformTextSettings{}),
                    written_by_all<MpiRows<WaveformTextWriter, WaveformTextSettings>>(WaveformTextSettings{}), {""});
}

TEST_CASE("outputs may want one channel only") {
  const SharedFolder folder;
  const Showers survey{20'000};
  MpiRows<XyzWriter, XyzSettings> rows(mpi_team(), folder / "all.xyz", {});
  rows.channel = 2;
  run(mpi_team(), survey, {.threads = 1}, rows);
  rows.close();
  if (!mpi_team().first()) return;
  XyzWriter writer(folder / "one.xyz");
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
}  // namespace pulsecast::adapters
