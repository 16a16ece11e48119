// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/mpi/las.hpp>

#include <doctest/doctest.h>

#include <pulsecast/io/las.hpp>

#include "support/mpi_showers.hpp"

namespace pulsecast::mpi {
namespace {

using support::mpi_group;
using support::require_same_bytes;
using support::Showers;
using support::written_alone;
using support::written_by_all;

TEST_CASE("LAS files are those of one process, waveforms included") {
  const Showers dry, with_waveforms{60'000, 40};
  const io::LasSettings settings, waveforms{.waveforms = true}, old{.format = io::LasFormat::las_1_0, .scale = 1e-3};
  require_same_bytes(dry, "las", written_alone<io::LasWriter>(dry, settings), written_by_all<MpiLas>(settings), {""});
  require_same_bytes(dry, "las", written_alone<io::LasWriter>(dry, old), written_by_all<MpiLas>(old), {""});
  require_same_bytes(with_waveforms, "las", written_alone<io::LasWriter>(with_waveforms, waveforms),
                     written_by_all<MpiLas>(waveforms), {"", "wdp"});
  CHECK_THROWS_AS(MpiLas(mpi_group(), "never.las", {.intensity = io::LasIntensity::amplitude}), SettingError);
}

}  // namespace
}  // namespace pulsecast::mpi
