// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/mpi/laz.hpp>

#include <filesystem>

#include <doctest/doctest.h>

#include <pulsecast/io/laz.hpp>

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

TEST_CASE("LAZ files are those of one process, wherever chunks and blocks end") {
  for (const PulseIndex pulses : {PulseIndex{3000}, PulseIndex{45'000}, PulseIndex{150'000}}) {
    const Showers survey{pulses};
    require_same_bytes(survey, "laz", written_alone<io::LazWriter>(survey, io::LasSettings{}, 1U),
                       written_by_all<MpiLaz>(io::LasSettings{}, 1U), {""});
  }
}

TEST_CASE("an empty run leaves files without points") {
  const SharedFolder folder;
  const Showers survey{0};
  MpiLaz laz(mpi_group(), folder / "all.laz", {}, 1);
  const RunSummary summary = run(mpi_group(), survey, {}, laz);
  laz.close();
  CHECK(summary.complete);
  if (!mpi_group().first()) return;
  io::LazWriter writer(folder / "one.laz");
  writer.close();
  CHECK((content(folder / "all.laz") == content(folder / "one.laz")));
}

}  // namespace
}  // namespace pulsecast::mpi
