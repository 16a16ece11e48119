// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

// Included after the library, in whichever form.

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "../../support/temporary_folder.hpp"

namespace {

using namespace pulsecast;
using namespace pulsecast::literals;

/// Scans a mesh and writes LAS, LAZ and every text. Returns the bytes of all files; sets the number of points.
std::string scan(const MeshData& mesh, std::size_t& points) {
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(mesh)}});
  const Deflector sweeping{PolygonMirror{.line_rate = 100_Hz}, Scanner{.pulse_rate = 10_kHz, .pulses = 10'000}};
  const Platform platform{Tripod{}, Mount{}, Deflector{RotatingHead{.angular_rate = 360_deg}, sweeping}};
  const Survey survey{platform, WithSubrayRecord{LatticeFootprint{7}}, scene, Receiver{},
                      FullWaveform{{.record_length = 20_ns}}};
  const support::TemporaryFolder folder;
  io::LasWriter las(folder / "a.las", {.waveforms = true});
  io::LazWriter laz(folder / "a.laz");
  io::XyzWriter xyz(folder / "a.xyz");
  io::PulseTextWriter pulses(folder / "pulses.txt");
  io::SubrayTextWriter subrays(folder / "subrays.txt");
  io::WaveformTextWriter waveforms(folder / "waveforms.txt");
  points = run(survey, {.threads = 1}, las, laz, xyz, pulses, subrays, waveforms).echoes;
  las.close();
  laz.close();
  xyz.close();
  pulses.close();
  subrays.close();
  waveforms.close();
  std::string bytes;
  for (const char* name : {"a.las", "a.wdp", "a.laz", "a.xyz", "pulses.txt", "subrays.txt", "waveforms.txt"})
    bytes += support::content(folder / name);
  return bytes;
}

}  // namespace
