// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/mpi/run.hpp>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <stop_token>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/cloud.hpp>
#include <pulsecast/io/text_files.hpp>

#include "support/mpi_showers.hpp"

namespace pulsecast::mpi {
namespace {

using support::mpi_group;
using support::Showers;

TEST_CASE("sinks of the first process get all, in pulse order") {
  const Showers survey{50'000, 3};
  Cloud expected, cloud;
  pulsecast::run(survey, {.threads = 1, .first = 100, .stride = 7}, expected);
  PulseIndex next = 0;
  std::vector<Progress> told;
  RunOptions options{.threads = 2, .first = 100, .stride = 7};
  options.progress = [&](const Progress& p) { told.push_back(p); };
  const RunSummary summary = run(mpi_group(), survey, options, cloud, [&](const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      CHECK(shot.index >= next);
      next = shot.index + 1;
    }
  });
  const RunSummary alone = pulsecast::run(survey, {.threads = 1, .first = 100, .stride = 7});
  CHECK(summary.slots == alone.slots);
  CHECK(summary.echoes == alone.echoes);
  CHECK(summary.fates == alone.fates);
  CHECK(summary.rays == alone.rays);
  CHECK(summary.energy.sent == alone.energy.sent);  // whole numbers
  CHECK(summary.complete);
  CHECK(cloud.size() == (mpi_group().first() ? expected.size() : 0));
  REQUIRE(told.empty() != mpi_group().first());
  if (!mpi_group().first()) return;
  CHECK(told.back().done == alone.slots);
  CHECK(told.back().total == alone.slots);
}

TEST_CASE("shots without echoes reach no process if no sink of a run reads them") {
  struct OfChoice {
    bool empty_shots;
    std::uint64_t empty = 0, echoes = 0;
    void operator()(const EchoBatch& batch) {
      for (const Shot& shot : batch.shots) (shot.echoes > 0 ? echoes : empty) += std::max(1U, shot.echoes);
    }
    [[nodiscard]] bool reads_empty_shots() const noexcept { return empty_shots; }
  };
  const Showers survey{50'000};
  for (const bool one : {false, true})
    for (const bool other : {false, true}) {
      CAPTURE(one);
      CAPTURE(other);
      OfChoice first{one}, second{other};
      const RunSummary summary = run(mpi_group(), survey, {.threads = 2}, first, second);
      CHECK(summary.count(Fate::missed) > 10'000);
      if (!mpi_group().first()) continue;
      for (const OfChoice& sink : {first, second}) {
        CHECK(sink.empty == (one || other ? summary.count(Fate::missed) : 0));
        CHECK(sink.echoes == summary.echoes);
      }
    }
  std::vector<MpiOutput*> outputs;
  for (const bool rows_of_pulses : {false, true}) {
    const support::SharedFolder folder;
    using Settings = io::TextFileSettings;
    MpiLas points(mpi_group(), folder / "points.las", {});
    MpiRows<io::XyzWriter, Settings> lines(mpi_group(), folder / "points.xyz", {});
    MpiRows<io::PulseTextWriter, Settings> pulses(mpi_group(), folder / "pulses.txt", {});
    outputs = {&points, &lines};
    if (rows_of_pulses) outputs.push_back(&pulses);
    std::uint64_t read = 0, unread = 0;
    const MpiSimulate simulate = [&](const RunOptions& part, const MpiPartSink& sink) {
      ++(sink.reads_empty_shots() ? read : unread);
      return pulsecast::run(survey, part, sink);
    };
    run_parts(mpi_group(), survey.size(), {.threads = 1}, simulate, outputs);
    CHECK((rows_of_pulses ? unread : read) == 0);
    points.close();
    lines.close();
    pulses.close();
  }
}

TEST_CASE("a pose that is not finite ends a run, as an exception of a sink does") {
  if (mpi_group().size() > 1) return;  // it ends all processes
  struct Lost : Showers {
    Outcome operator()(PulseIndex i, Workspace& w) const noexcept {
      Outcome outcome = Showers::operator()(i, w);
      if (i >= 9'000) outcome.error = PulseError::pose;
      return outcome;
    }
  };
  MpiGroup own;
  PulseIndex shots = 0;
  const auto count = [&](const EchoBatch& batch) { shots += batch.shots.size(); };
  CHECK_THROWS_AS(run(own, Lost{{50'000, 3}}, {.threads = 2}, count), std::runtime_error);
  CHECK(shots <= 9'000);
}

TEST_CASE("a run that is stopped leaves whole results up to some slot") {
  const Showers survey{400'000};
  std::stop_source source;
  RunOptions options{.threads = 1, .stop = source.get_token()};
  options.progress = [&](const Progress&) { source.request_stop(); };
  PulseIndex pulses = 0, last = 0;
  const RunSummary summary = run(mpi_group(), survey, options, [&](const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      ++pulses;
      last = shot.index;
    }
  });
  CHECK(!summary.complete);
  CHECK(summary.slots > 0);
  if (!mpi_group().first()) return;
  CHECK(pulses == summary.pulses());
  CHECK(last < summary.slots);
  CHECK(last + 2 >= summary.slots);
}

}  // namespace
}  // namespace pulsecast::mpi
