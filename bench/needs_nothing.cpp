// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Makes the ground that the other programs scan, and scans nothing: what `needs.sh` subtracts from the size of the
// others.

#include "needs.hpp"

int main() {
  const pulsecast::MeshData mesh = needs::ground().mesh();
  std::printf("0 %.9g\n", mesh.vertices[mesh.triangles.back()[2]].z);
}
