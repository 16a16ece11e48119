// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/mpi/detail/stream.hpp>

#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/io/gzip.hpp>
#include <pulsecast/io/text_files.hpp>

#include "support/mpi_showers.hpp"

namespace pulsecast::mpi {
namespace {

using support::mpi_group;
using support::require_same_bytes;
using support::Showers;

TEST_CASE("a stream of text is compressed by the first process, as if it had made it") {
  const Showers survey{30'000};
  const auto all = [](const std::filesystem::path& path) -> std::unique_ptr<MpiOutput> {
    const auto file = mpi_group().first() ? std::make_shared<io::OutputFile>(io::gzip_file(path)) : nullptr;
    return std::make_unique<MpiStream<io::XyzWriter>>(
        mpi_group(), [](io::OutputFile piece) { return io::XyzWriter(std::move(piece)); },
        [file](const MpiMessage& bytes) { file->write(bytes.rest()); }, [file] { file->commit(); });
  };
  const auto one = [&](const std::filesystem::path& path) {
    io::XyzWriter writer(io::gzip_file(path));
    pulsecast::run(survey, {.threads = 1}, writer);
    writer.close();
  };
  require_same_bytes(survey, "xyz.gz", one, all, {""});
}

TEST_CASE("batches come out as they went in") {
  const std::vector<Shot> shots{{.index = 7, .echoes = 2}, {.index = 9, .samples = 3}};
  const std::vector<Echo> echoes{{.range = 3}, {.range = 4, .object = 5}};
  const std::vector<float> samples{1, 2, 3};
  const std::vector<SubrayRecord> subrays(2);
  std::vector<std::byte> bytes;
  MpiBatchWriter writer(io::OutputFile("piece", bytes));
  writer({shots, echoes, samples, 0.5, subrays});
  writer({});
  writer.close();
  int batches = 0;
  for_each_batch(MpiMessage(bytes), [&](const EchoBatch& batch) {
    if (++batches == 2) {
      CHECK(batch.shots.empty());
      return;
    }
    REQUIRE(batch.shots.size() == 2);
    REQUIRE(batch.echoes.size() == 2);
    CHECK(batch.shots[0].index == 7);
    CHECK(batch.shots[1].samples == 3);
    CHECK(batch.echoes[1].range == 4);
    CHECK(batch.echoes[1].object == 5);
    CHECK(std::vector(batch.samples.begin(), batch.samples.end()) == samples);
    CHECK(batch.sample_interval == 0.5);
    CHECK(batch.subrays.size() == 2);
  });
  CHECK(batches == 2);
}

}  // namespace
}  // namespace pulsecast::mpi
