// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/adapters/mpi_laz.hpp>

#include <filesystem>

#include <doctest/doctest.h>

#include <pulsecast/adapters/laz.hpp>

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

TEST_CASE("LAZ files are those of one process, wherever chunks and blocks end") {
  for (const PulseIndex pulses : {PulseIndex{3000}, PulseIndex{45'000}, PulseIndex{150'000}}) {
    const Showers survey{pulses};
    expect_same_bytes(survey, "laz", written_alone<LazWriter>(survey, LasSettings{}, 1U), written_by_all<MpiLaz>(LasSettings{}, 1U), {""});
  }
}

TEST_CASE("an empty run leaves files without points") {
  const SharedFolder folder;
  const Showers survey{0};
  MpiLaz laz(mpi_team(), folder / "all.laz", {}, 1);
  const RunSummary summary = run(mpi_team(), survey, {}, laz);
  laz.close();
  CHECK(summary.complete);
  if (!mpi_team().first()) return;
  LazWriter writer(folder / "one.laz");
  writer.close();
  CHECK((content(folder / "all.laz") == content(folder / "one.laz")));
}

}  // namespace
}  // namespace pulsecast::adapters
