// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <memory>
#include <string>

#include <doctest/doctest.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <pulsecast/pulsecast.hpp>

#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// Adaptor to oneTBB, as docs/cookbook.md refers to it.
struct OneTbb {
  tbb::task_arena arena{4};
  unsigned threads() const { return static_cast<unsigned>(arena.max_concurrency()); }
  void for_each(std::size_t count, const IndexTask& task) {
    const auto all = [&] { tbb::parallel_for(std::size_t{0}, count, task, tbb::simple_partitioner{}); };
    arena.execute([&] { tbb::this_task_arena::isolate(all); });
  }
};
static_assert(Executor<OneTbb>);

/// A bumpy square of two triangles for each of n x n fields.
MeshData bumps(std::uint32_t n) {
  MeshData mesh;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j <= n; ++j)
      mesh.vertices.push_back({0.1 * i - 0.05 * n, 0.1 * j - 0.05 * n, (i * j) % 7 * 0.05});
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t k = i * (n + 1) + j;
      mesh.triangles.push_back({k, k + n + 1, k + 1});
      mesh.triangles.push_back({k + 1, k + n + 1, k + n + 2});
    }
  return mesh;
}

}  // namespace

TEST_CASE("oneTBB builds a mesh and runs a survey, and a survey in its sink, to the same bytes") {
  OneTbb tbb;
  const MeshData mesh = bumps(100);
  const Scene<TriangleMesh<>> of_one({{.geometry = std::make_shared<const TriangleMesh<>>(mesh, 1U)}});
  const Scene<TriangleMesh<>> of_tbb({{.geometry = std::make_shared<const TriangleMesh<>>(mesh, tbb)}});
  const Platform tripod{Tripod{}, Mount{.lever_arm = {0, 0, 1.7}},
                        Deflector{PolygonMirror{}, Scanner{.pulses = 20'000}}};
  const Survey plain{tripod, SingleRay{}, of_one, Receiver{}, FullWaveform{}};
  const Survey survey{tripod, SingleRay{}, of_tbb, Receiver{}, FullWaveform{}};
  support::LawfulSink expected;
  run(plain, {.threads = 1}, expected);
  CHECK(expected.echoes() > 1000);
  std::size_t batches = 0;
  support::LawfulSink sink;
  run(survey, {.executor = tbb}, sink, [&](const EchoBatch&) {
    support::LawfulSink inner;
    run(survey, {.executor = tbb}, inner);
    CHECK(inner.checksum() == expected.checksum());
    ++batches;
  });
  CHECK(batches > 3);
  CHECK(sink.broken() == "");
  CHECK(sink.checksum() == expected.checksum());
}
