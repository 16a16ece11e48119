// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// A program that holds one mesh, one flight and ranges: the least there is.

#include "needs.hpp"

using namespace needs;

int main() {
  const Scene<TriangleMesh<>> scene({{.geometry = std::make_shared<const TriangleMesh<>>(ground().mesh())}});
  return go(Survey{Platform{flight, mount(), Deflector{mirror, laser}}, SingleRay{}, scene, Receiver{}, FirstHit{}});
}
