// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A program that holds one mesh, one flight and full waveforms of beams of 19 subrays.

#include "needs.hpp"

using namespace needs;

int main() {
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(ground().mesh())}});
  return go(Survey{Platform{flight, mount(), Deflector{mirror, laser}}, SunflowerFootprint{19}, scene, Receiver{},
                   FullWaveform{}});
}
