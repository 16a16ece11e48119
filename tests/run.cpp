// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/run.hpp>

#include <array>
#include <atomic>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/cloud.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/platform/legs.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/pose_errors.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include "support/allocations.hpp"
#include "support/archetypes.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

/// The plane z = 0 with a step of 2 m at x = 0, so that some pulses come back twice.
struct Steps {
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    std::optional<Hit> nearest;
    for (const double height : {2.0, 0.0}) {
      const double range = (height - ray.origin.z) / ray.direction.z;
      if (!(range > ray.near && range <= ray.far)) continue;
      const double x = ray.origin.x + range * ray.direction.x;
      if (height > 0 && x > 0) continue;
      const double cosine = std::fabs(ray.direction.z);
      if (!nearest || range < nearest->range)
        nearest = Hit{range, cosine, 0.5 * cosine, static_cast<ObjectId>(height), 2};
    }
    return nearest;
  }
};

constexpr PulseIndex pulses_per_leg = 7000;

/// Two set-ups whose mirrors look up half of the time, and are closed for a part of it.
auto two_legs() {
  const auto leg = [](double x, double heading) {
    return Platform{
        Tripod{.position = {x, 0, 10}, .heading = heading}, Mount{},
        Deflector{PolygonMirror{.line_rate = 10, .sweep = 170_deg, .angle_min = -160_deg, .angle_max = 80_deg},
                  Scanner{.pulse_rate = 10_kHz, .pulses = pulses_per_leg, .laser = {.divergence = 3_mrad}}}};
  };
  return Legs(std::vector{leg(-20, 90_deg), leg(20, -80_deg)});
}

const Steps steps;
const auto waveforms = FullWaveform<MomentWidth>{WaveformSettings{.record_length = 20e-9}};

auto small_survey() { return Survey{two_legs(), RingFootprint{}, steps, Receiver{}, waveforms}; }

/// Many cheap pulses: as many as are asked for, straight down.
struct Rain {
  PulseIndex pulses = 100000;
  mutable std::atomic<PulseIndex>* asked = nullptr;  ///< the slot after the highest that was asked for
  PulseIndex size() const noexcept { return pulses; }
  Tick duration() const noexcept { return Tick::of(pulses, 1e5); }
  std::vector<Emitter> emitters() const { return std::vector<Emitter>(1); }
  std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
    if (asked)
      for (PulseIndex seen = *asked; seen < i + 1 && !asked->compare_exchange_weak(seen, i + 1);) continue;
    Pulse<frame::World> p;
    p.tick = Tick::of(i, 1e5);
    p.pose = {rotation_about(axis::right, -90_deg), {0.001 * static_cast<double>(i), 0, 10}};
    return p;
  }
};
static_assert(WorldSource<Rain>);

auto rain(PulseIndex pulses = 100000, std::atomic<PulseIndex>* asked = nullptr) {
  return Survey{Rain{pulses, asked}, SingleRay{}, steps, Receiver{}, FirstHit{}};
}

struct Spilled : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace

TEST_CASE("a run gives the same to the last bit on 1, 2, 3 and 7 threads, in pulse order") {
  const auto survey = small_survey();
  std::string first;
  for (const unsigned threads : {1U, 2U, 3U, 7U}) {
    CAPTURE(threads);
    support::LawfulSink sink;
    const RunSummary summary = run(survey, {.threads = threads}, sink);
    CHECK(sink.broken() == "");
    CHECK(summary.complete);
    CHECK(summary.slots == 2 * pulses_per_leg);
    CHECK(summary.echoes == sink.echoes());
    CHECK(summary.pulses() == sink.shots());
    CHECK(summary.rays == sink.shots() * 19);
    if (first.empty()) first = sink.checksum();
    CHECK(sink.checksum() == first);
  }
}

TEST_CASE(
    "a run with every error switched on gives the same to the last bit on 1, 2 and 7 threads, and with an other seed "
    "not") {
  const auto survey = [](std::uint64_t seed) {
    const Platform flight{
        StraightLine{.from = {-30, 0, 50}, .to = {30, 5, 50}, .speed = 60},
        Mount{.boresight = rotation_about(axis::right, -90_deg)},
        Deflector{PolygonMirror{.line_rate = 20, .sweep = 40_deg}, Scanner{.pulse_rate = 10_kHz, .pulses = 10'000}}};
    const PoseErrors errors{.position_noise = 2_cm,
                            .attitude_noise = 0.1_mrad,
                            .position_drift = 5_cm,
                            .attitude_drift = 0.2_mrad,
                            .drift_time = 0.3_s,
                            .angular_jitter = 0.05_mrad,
                            .lever_arm_error = {0.01, 0, 0},
                            .boresight_error = rotation_about(axis::up, 0.3_mrad),
                            .seed = seed};
    const Receiver receiver{
        .range_errors = {.bias = 1_cm, .deviation = 5_mm, .deviation_per_metre = 1e-5, .grows_with_incidence = true}};
    return Survey{Legs{std::vector{WithPoseErrors{flight, errors}}}, RingFootprint{}, steps, receiver, waveforms, seed};
  };
  std::string first;
  for (const unsigned threads : {1U, 2U, 7U}) {
    CAPTURE(threads);
    support::LawfulSink sink;
    run(survey(1), {.threads = threads}, sink);
    CHECK(sink.echoes() > 5000);
    if (first.empty()) first = sink.checksum();
    CHECK(sink.checksum() == first);
  }
  support::LawfulSink other;
  run(survey(2), {}, other);
  CHECK(other.checksum() != first);
}

TEST_CASE("a run hands out what the survey says of each pulse, and nothing for blocked slots") {
  const auto survey = small_survey();
  auto workspace = survey.workspace();
  std::array<std::uint64_t, fate_count> fates{};
  PulseIndex next = 0;
  std::size_t double_echoes = 0;
  const RunSummary summary = run(survey, {.threads = 2}, [&](const EchoBatch& batch) {
    CHECK(batch.sample_interval == survey.sample_interval());
    for (const Shot& shot : batch.shots) {
      for (; next < shot.index; ++next) {
        REQUIRE(survey(next, workspace).shot.fate == Fate::blocked);
        ++fates[static_cast<std::size_t>(Fate::blocked)];
      }
      const Outcome o = survey(next++, workspace);
      ++fates[static_cast<std::size_t>(o.shot.fate)];
      REQUIRE(shot.fate == o.shot.fate);
      REQUIRE(shot.tick == o.shot.tick);
      REQUIRE(shot.leg == o.shot.leg);
      const auto echoes = batch.echoes_of(shot);
      REQUIRE(echoes.size() == o.echoes.size());
      for (std::size_t e = 0; e < echoes.size(); ++e) REQUIRE(support::detail::same(echoes[e], o.echoes[e]));
      double_echoes += echoes.size() > 1;
      const auto samples = batch.waveform_of(shot);
      REQUIRE(std::equal(samples.begin(), samples.end(), o.waveform.begin(), o.waveform.end()));
    }
  });
  fates[static_cast<std::size_t>(Fate::blocked)] += survey.size() - next;
  CHECK(summary.fates == fates);
  for (const Fate fate : {Fate::returned, Fate::blocked, Fate::missed}) CHECK(summary.count(fate) > 0);
  CHECK(double_echoes > 0);
}

namespace {

/// Every thousandth slot has a pulse, and the source knows which.
struct Drips : Rain {
  std::atomic<PulseIndex>* visits;
  std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
    ++*visits;
    return i % 1000 == 999 ? Rain::pulse(i) : std::nullopt;
  }
  PulseIndex next_pulse(PulseIndex i) const noexcept { return std::min(pulses, i / 1000 * 1000 + 999); }
};
static_assert(WorldSource<Drips> && SkipsBlocked<Drips>);

}  // namespace

TEST_CASE("a run counts the blocked slots that a survey passes over, and visits few of them") {
  std::atomic<PulseIndex> visits = 0;
  const Survey survey{Drips{{.pulses = 1'000'500}, &visits}, SingleRay{}, steps, Receiver{}, FirstHit{}};
  for (const RunOptions& options :
       {RunOptions{}, RunOptions{.first = 777, .end = 900'001, .stride = 7}, RunOptions{.stride = 5000}}) {
    CAPTURE(options.stride);
    visits = 0;
    PulseIndex shots = 0;
    const RunSummary summary = run(survey, options, [&](const EchoBatch& batch) {
      shots += batch.shots.size();
      for (const Shot& shot : batch.shots) CHECK(shot.index % 1000 == 999);
    });
    const RunSlots slots = options.slots(survey.size());
    PulseIndex pulses = 0;
    for (PulseIndex n = 0; n < slots.count; ++n) pulses += slots[n] % 1000 == 999;
    CHECK(summary.complete);
    CHECK(summary.slots == slots.count);
    CHECK(shots == pulses);
    CHECK(summary.pulses() == pulses);
    if (options.stride < 1000) CHECK(visits < 5000);
  }
}

TEST_CASE("a part of the pulses gives the part of the result") {
  const auto survey = small_survey();
  Cloud whole, middle, preview;
  run(survey, {.threads = 2}, whole);
  run(survey, {.threads = 2, .first = 3000, .end = 9001}, middle);
  const RunSummary summary = run(survey, {.threads = 3, .first = 1, .stride = 7}, preview);
  CHECK(summary.slots == (survey.size() - 1 + 6) / 7);
  std::vector<std::size_t> expected_middle, expected_preview;
  for (std::size_t k = 0; k < whole.size(); ++k) {
    if (whole.pulses[k] >= 3000 && whole.pulses[k] < 9001) expected_middle.push_back(k);
    if (whole.pulses[k] % 7 == 1) expected_preview.push_back(k);
  }
  REQUIRE(middle.size() == expected_middle.size());
  for (std::size_t k = 0; k < middle.size(); ++k) REQUIRE(middle.points[k] == whole.points[expected_middle[k]]);
  REQUIRE(preview.size() == expected_preview.size());
  for (std::size_t k = 0; k < preview.size(); ++k) REQUIRE(preview.points[k] == whole.points[expected_preview[k]]);
}

TEST_CASE("several sinks get the same, and a run without a sink counts all the same") {
  const auto survey = small_survey();
  support::LawfulSink a, b;
  Cloud cloud;
  const RunSummary with = run(survey, {.threads = 2}, a, b, cloud), without = run(survey, {.threads = 2});
  CHECK(a.checksum() == b.checksum());
  CHECK(cloud.size() == a.echoes());
  CHECK(with.echoes == without.echoes);
  CHECK(with.fates == without.fates);
}

TEST_CASE("a run accounts for all the energy that was sent, the same on any number of threads") {
  const auto survey = small_survey();
  const RunSummary one = run(survey, {.threads = 1}), three = run(survey, {.threads = 3});
  const double each = Laser{}.peak_power * Laser{}.pulse_length;
  CHECK(one.energy.sent == support::relative(each * static_cast<double>(one.pulses()), 1e-12));
  const EnergyLedger& e = one.energy;
  CHECK(e.missed + e.out_of_range + e.absorbed + e.scattered + e.cut == support::relative(e.sent, 1e-12));
  CHECK(e.share(&EnergyLedger::scattered) > 0.3);
  CHECK(e.share(&EnergyLedger::missed) > 0.1);
  CHECK(e.received > 0);
  CHECK(e.received < e.scattered);
  CHECK(one.energy == three.energy);
  CHECK(run(survey, {.threads = 1, .end = 0}).energy.share(&EnergyLedger::scattered) == 0);
}

TEST_CASE("a run hands on the subrays of a footprint that is recorded, in batches that stay small") {
  const auto recorded = Survey{two_legs(), WithSubrayRecord{RingFootprint{7}}, steps, Receiver{}, waveforms};
  const auto plain = Survey{two_legs(), RingFootprint{7}, steps, Receiver{}, waveforms};
  auto workspace = recorded.workspace();
  support::LawfulSink sink, plain_sink;
  const std::size_t n = recorded.subrays();
  std::size_t shots = 0;
  run(recorded, {.threads = 3}, sink, [&](const EchoBatch& batch) {
    REQUIRE(batch.subrays.size() == n * batch.shots.size());
    CHECK(batch.subrays.size() <= 65'536);
    for (std::size_t k = 0; k < batch.shots.size(); k += 97, ++shots) {
      const Outcome o = recorded(batch.shots[k].index, workspace);
      for (std::size_t j = 0; j < n; ++j) {
        REQUIRE(batch.subrays_of(k)[j].range == o.subrays[j].range);
        REQUIRE(batch.subrays_of(k)[j].power == o.subrays[j].power);
      }
    }
  });
  CHECK(shots > 50);
  run(plain, {.threads = 2}, plain_sink, [&](const EchoBatch& batch) { CHECK(batch.subrays.empty()); });
  CHECK(sink.echoes() == plain_sink.echoes());
}

TEST_CASE("a run of nothing is complete") {
  const auto survey = small_survey();
  for (const RunOptions& options :
       {RunOptions{.threads = 2, .first = 5, .end = 5}, RunOptions{.threads = 2, .first = survey.size()},
        RunOptions{.threads = 2, .first = 10, .end = 5}}) {
    support::LawfulSink sink;
    const RunSummary summary = run(survey, options, sink);
    CHECK(summary.complete);
    CHECK(summary.slots == 0);
    CHECK(sink.batches() == 0);
  }
}

namespace {

/// Allocations of a run; a thread needs one.
template <class Survey>
std::size_t allocations_of(const Survey& survey, const RunOptions& options) {
  const std::size_t before = support::allocations;
  const RunSummary summary = run(survey, options);
  CHECK(summary.complete);
  return support::allocations - before;
}

/// Executor of a user's: the tasks in reverse, one after the other.
struct Reverse {
  int calls = 0;
  unsigned threads() const { return 5; }
  void for_each(std::size_t count, const IndexTask& task) {
    ++calls;
    while (count-- > 0) task(count);
  }
};

/// Executor of a user's: one thread for each task.
struct ThreadPerTask {
  unsigned threads() const { return 4; }
  void for_each(std::size_t count, const IndexTask& task) const {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back([&task, i] { task(i); });
  }
};

static_assert(Executor<Reverse> && Executor<const ThreadPerTask> && !MemoryKeepingExecutor<Reverse>);
static_assert(!Executor<const Reverse>);

template <class Survey>
std::string checksum_of(const Survey& survey, const RunOptions& options) {
  support::LawfulSink sink;
  run(survey, options, sink);
  CHECK(sink.broken() == "");
  return sink.checksum();
}

}  // namespace

TEST_CASE("no more threads are started than there are chunks of work") {
  const auto survey = rain();
  for (const PulseIndex pulses : {0U, 1U, 256U}) {
    CAPTURE(pulses);
    CHECK(allocations_of(survey, {.threads = 64, .end = pulses}) ==
          allocations_of(survey, {.threads = 1, .end = pulses}));
  }
  CHECK(allocations_of(survey, {.threads = max_threads, .end = 257}) < 100);
}

TEST_CASE("a run on a pool allocates nothing after the first run over the survey or its copies") {
  ThreadPool pool(64);
  const RunOptions options{.threads = 64, .executor = pool, .end = 1};
  const auto survey = small_survey(), other = small_survey();
  const auto copy = survey;
  const bool counted = allocations_of(survey, options) > 0;  // not so under the thread sanitizer
  for (int k = 0; k < 3; ++k) {
    CHECK(allocations_of(survey, options) == 0);
    CHECK(allocations_of(copy, options) == 0);
  }
  if (counted) {
    CHECK(allocations_of(other, options) > 0);  // whose workspaces may differ
    pool.memory().clear();
    CHECK(allocations_of(other, options) > 0);
  }
  CHECK(allocations_of(other, options) == 0);
}

TEST_CASE("a loop of short runs on a pool allocates nothing after the first, whichever threads take their pulses") {
  ThreadPool pool(2);
  const auto survey = rain(500'000);
  std::size_t allocated = 0;
  for (PulseIndex first = 0; first < survey.size(); first += 5000) {
    const std::size_t now = allocations_of(survey, {.executor = pool, .first = first, .end = first + 5000});
    if (first > 0) allocated += now;
  }
  CHECK(allocated == 0);
}

namespace {

/// Executor that keeps memory, whose second worker comes when it is let in, into what the first one does; else when all
/// work is done.
struct LateWorker {
  ScratchMemory kept{};
  const IndexTask* late = nullptr;
  unsigned threads() const { return 2; }
  void for_each(std::size_t, const IndexTask& task) {
    late = &task;
    task(0);
    let_in();
  }
  void let_in() {
    if (const IndexTask* const task = std::exchange(late, nullptr)) (*task)(1);
  }
  ScratchMemory& memory() { return kept; }
};

}  // namespace

TEST_CASE("a worker that had no work in the first runs allocates nothing when it has some") {
  LateWorker executor;
  const auto survey = small_survey();
  std::size_t batches = 0, allocated = 0;
  for (int round = 0; round < 6; ++round) {
    const std::size_t before = support::allocations;
    run(survey, {.executor = executor}, [&](const EchoBatch&) {
      ++batches;
      if (round >= 4) executor.let_in();
    });
    if (round > 0) allocated += support::allocations - before;
  }
  CHECK(batches == 6 * 16);
  CHECK(allocated == 0);
}

TEST_CASE(
    "several surveys in turn on one pool allocate nothing after their first runs, and a survey that is gone leaves no "
    "workspace") {
  ThreadPool pool(2);
  const std::vector surveys{rain(), rain(), rain()};
  std::size_t allocated = 0;
  for (PulseIndex first = 0; first < 50'000; first += 1000)
    for (const auto& survey : surveys) {
      const std::size_t now = allocations_of(survey, {.executor = pool, .first = first, .end = first + 1000});
      if (first > 0) allocated += now;
    }
  CHECK(allocated == 0);
  using Memory = detail::WorkspaceMemory<std::remove_const_t<decltype(rain())>>;
  for (int k = 0; k < 5; ++k) {
    const auto passing = rain();
    run(passing, {.executor = pool, .end = 10});
  }
  std::size_t left = 0;
  const auto last = rain();
  for (const auto* survey : {&surveys[0], &surveys[1], &surveys[2], &last})
    while (pool.memory().take<Memory>(*survey)) ++left;
  CHECK(left == 3 * 2);
}

TEST_CASE("surveys of one type that follow each other on a pool do not see each other's workspaces") {
  ThreadPool pool(3);
  for (int round = 0; round < 2; ++round)
    for (const std::size_t rings : {2U, 7U, 3U}) {
      CAPTURE(rings);
      std::optional<Survey<decltype(two_legs()), RingFootprint, Steps, std::remove_const_t<decltype(waveforms)>>>
          survey;
      survey.emplace(two_legs(), RingFootprint{rings}, steps, Receiver{.efficiency = 0.1 * static_cast<double>(rings)},
                     waveforms);
      CHECK(checksum_of(*survey, {.executor = pool}) == checksum_of(*survey, {.threads = 1}));
    }
}

TEST_CASE("a run gives the same bytes on any executor") {
  const auto survey = small_survey();
  const std::string expected = checksum_of(survey, {.threads = 1});
  ThreadPool one(1), seven(7);
  Reverse reverse;
  const ThreadPerTask thread_per_task;
  for (const ExecutorRef executor :
       {ExecutorRef(one), ExecutorRef(seven), ExecutorRef(reverse), ExecutorRef(thread_per_task)})
    for (const unsigned threads : {0U, 2U, 3U, 64U}) {
      CAPTURE(threads);
      CHECK(checksum_of(survey, {.threads = threads, .executor = executor}) == expected);
    }
  CHECK(reverse.calls == 4);
}

TEST_CASE("two threads may run surveys on one pool at once") {
  ThreadPool pool(3);
  const auto survey = small_survey();
  const std::string expected = checksum_of(survey, {.threads = 1});
  std::array<std::array<std::string, 4>, 2> sums;
  {
    std::array<std::jthread, 2> callers;
    for (std::size_t k = 0; k < callers.size(); ++k)
      callers[k] = std::jthread([&, k] {
        for (std::string& sum : sums[k]) {
          support::LawfulSink sink;
          run(survey, {.executor = pool}, sink);
          sum = sink.checksum();
        }
      });
  }
  for (const auto& of_caller : sums)
    for (const std::string& sum : of_caller) CHECK(sum == expected);
}

TEST_CASE("a sink may run a survey on the pool that calls it") {
  ThreadPool pool(3);
  const auto survey = rain(20000), inner = rain(5000);
  const std::string expected = checksum_of(inner, {.threads = 1});
  std::size_t batches = 0;
  run(survey, {.executor = pool}, [&](const EchoBatch&) {
    support::LawfulSink sink;
    run(inner, {.executor = pool}, sink);
    CHECK(sink.checksum() == expected);
    ++batches;
  });
  CHECK(batches == 16);
}

TEST_CASE("a pool goes on after a sink that throws and after a stop") {
  ThreadPool pool(3);
  const auto survey = rain(200000);
  const std::string expected = checksum_of(survey, {.threads = 1});
  for (int round = 0; round < 2; ++round) {
    int calls = 0;
    const auto spill = [&](const EchoBatch&) {
      if (++calls == 3) throw Spilled("the third batch");
    };
    CHECK_THROWS_WITH_AS(run(survey, {.executor = pool}, spill), "the third batch", Spilled);
    CHECK(calls == 3);
    std::stop_source source;
    const RunSummary stopped =
        run(survey, {.executor = pool, .stop = source.get_token()}, [&](const EchoBatch&) { source.request_stop(); });
    CHECK_FALSE(stopped.complete);
    CHECK(checksum_of(survey, {.executor = pool}) == expected);
  }
}

TEST_CASE("more threads than a machine can have are refused, by name") {
  CHECK_THROWS_WITH_AS(run(rain(), {.threads = max_threads + 1}),
                       "RunOptions::threads is 1025, but must be from 0 to 1024", SettingError);
  CHECK(run(rain(1), {.threads = max_threads}).complete);
}

TEST_CASE("progress ascends, one call at a time, and reaches the total") {
  for (const unsigned threads : {1U, 4U}) {
    CAPTURE(threads);
    PulseIndex done = 0, calls = 0;
    std::uint64_t echoes = 0;
    std::atomic<int> inside = 0;
    RunOptions options{.threads = threads};
    options.progress = [&](const Progress& p) {
      CHECK(++inside == 1);
      CHECK(p.total == 100000);
      CHECK(p.done > done);
      CHECK(p.echoes >= echoes);
      done = p.done;
      echoes = p.echoes;
      ++calls;
      --inside;
    };
    support::LawfulSink sink;
    run(rain(), options, sink);
    CHECK(done == 100000);
    CHECK(echoes == sink.echoes());
    CHECK(calls == sink.batches());
  }
}

TEST_CASE("a run that is asked to stop ends early, with whole batches in order") {
  for (const unsigned threads : {1U, 2U, 7U}) {
    CAPTURE(threads);
    std::stop_source source;
    support::LawfulSink sink;
    const RunSummary summary =
        run(rain(200000), {.threads = threads, .stop = source.get_token()}, [&](const EchoBatch& batch) {
          sink(batch);
          if (sink.batches() == 3) source.request_stop();
        });
    CHECK(sink.broken() == "");
    CHECK_FALSE(summary.complete);
    CHECK(sink.first() == 0);
    CHECK(sink.batches() >= 3);
    CHECK(summary.slots == sink.shots());
    CHECK(summary.slots == *sink.last() + 1);
    CHECK(summary.slots < 200000);
    // what came before the stop is what a whole run gives
    support::LawfulSink whole;
    run(rain(200000), {.threads = 2, .end = summary.slots}, whole);
    CHECK(whole.checksum() == sink.checksum());
  }
}

TEST_CASE("a run that is stopped before it begins does nothing") {
  std::stop_source source;
  source.request_stop();
  support::LawfulSink sink;
  const RunSummary summary = run(rain(), {.threads = 3, .stop = source.get_token()}, sink);
  CHECK(sink.batches() == 0);
  CHECK(summary.slots == 0);
  CHECK_FALSE(summary.complete);
}

TEST_CASE("what a sink throws ends the run and comes out of it, and no sink is called again") {
  for (const unsigned threads : {1U, 2U, 7U}) {
    CAPTURE(threads);
    int calls = 0;
    std::string caught;
    try {
      run(rain(200000), {.threads = threads}, [&](const EchoBatch&) {
        if (++calls == 3) throw Spilled("the third batch");
      });
    } catch (const Spilled& s) {
      caught = s.what();
    }
    CHECK(caught == "the third batch");
    CHECK(calls == 3);
  }
}

TEST_CASE("what the progress callback throws comes out too") {
  for (const unsigned threads : {1U, 2U, 7U}) {
    CAPTURE(threads);
    support::LawfulSink sink;
    RunOptions options{.threads = threads};
    options.progress = [](const Progress& p) {
      if (p.done > 5000) throw Spilled("enough");
    };
    CHECK_THROWS_AS(run(rain(200000), options, sink), Spilled);
    CHECK(sink.broken() == "");
    CHECK(sink.shots() < 100000);
  }
}

namespace {

/// How far the workers get while the first batch is being delivered.
struct Ahead {
  double batches = 0;
  std::size_t batch_bytes = 0;  ///< of the largest
};

template <class Survey>
Ahead ahead_of_a_slow_sink(const Survey& survey, unsigned threads, const std::atomic<PulseIndex>& asked) {
  PulseIndex delivered = 0, farthest = 0, largest = 0;
  Ahead ahead;
  run(survey, {.threads = threads}, [&](const EchoBatch& batch) {
    if (delivered == 0) {  // the others get all the time that they could want
      PulseIndex seen = 0;
      for (int k = 0; k < 100000 && seen < survey.size(); ++k, std::this_thread::yield())
        if (asked > seen) {
          seen = asked;
          k = 0;
        }
    }
    farthest = std::max(farthest, asked - delivered);
    delivered += batch.shots.size();
    largest = std::max<PulseIndex>(largest, batch.shots.size());
    ahead.batch_bytes =
        std::max(ahead.batch_bytes, batch.shots.size_bytes() + batch.echoes.size_bytes() + batch.subrays.size_bytes());
  });
  CHECK(delivered == survey.size());
  ahead.batches = static_cast<double>(farthest) / static_cast<double>(largest);
  return ahead;
}

}  // namespace

TEST_CASE("workers run ahead of the sink by some megabytes, so that memory is bounded") {
  const unsigned threads = 3;
  std::atomic<PulseIndex> asked = 0;
  const Ahead ahead = ahead_of_a_slow_sink(rain(300000, &asked), threads, asked);
  CHECK(ahead.batches > 2 * threads + 2);
  CHECK((ahead.batches - threads - 1) * static_cast<double>(ahead.batch_bytes) <= 6 << 20);
}

TEST_CASE("workers run ahead of the sink by two batches each and two if batches are large") {
  const unsigned threads = 3;
  std::atomic<PulseIndex> asked = 0;
  const Survey survey{Rain{8000, &asked}, WithSubrayRecord{RingFootprint{7}}, steps, Receiver{}, FirstHit{}};
  const Ahead ahead = ahead_of_a_slow_sink(survey, threads, asked);
  CHECK(ahead.batch_bytes > 3 << 20);
  CHECK(ahead.batches > 1);
  CHECK(ahead.batches <= 2 * threads + 2);
}

TEST_CASE("a run refuses a stride of zero") { CHECK_THROWS_AS(run(rain(), {.stride = 0}), SettingError); }

namespace {

const double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A user's trajectory that loses its position, or its rotation, for a while after half a second.
struct Lost {
  double position = 0, rotation = 1;
  Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    if (t.seconds() < 0.5 || t.seconds() > 0.9) return {no_rotation, {0, 0, 5}};
    return {Rotation{rotation, 0, 0, 0}, {0, 0, 5 + position}};
  }
};

/// A user's map of the ground that answers some pulses with NaN, at one of their subrays.
struct Broken {
  PulseIndex from;
  bool range = false, backscatter = false;
  std::optional<Hit> closest_hit(const Ray& ray) const noexcept {
    const bool bad = ray.pulse >= from && ray.subray == 3;
    return Hit{.range = range && bad ? not_a_number : 5, .backscatter = backscatter && bad ? not_a_number : 0.5};
  }
};

/// Poses that are reported wrong.
struct Misreported : Rain {
  std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
    auto p = Rain::pulse(i);
    p->reported = p->pose;
    if (i >= 3000) p->reported->position.y = not_a_number;
    return p;
  }
};

/// Message that a run ends with, whatever the threads, after whole results of the pulses before.
template <class S>
std::string message_of(const S& survey, PulseIndex bad) {
  std::string first;
  for (const unsigned threads : {1U, 2U, 7U}) {
    support::LawfulSink sink;
    std::string message;
    try {
      run(survey, {.threads = threads}, sink);
    } catch (const std::runtime_error& error) {
      message = error.what();
    }
    CHECK(sink.broken() == "");
    CHECK(sink.shots() == bad);
    if (threads == 1) first = message;
    CHECK(message == first);
    CHECK(run(survey, {.threads = threads, .end = bad}).slots == bad);
  }
  return first;
}

}  // namespace

TEST_CASE("a pose of a user's own type that is not finite ends a run at its pulse, on any number of threads") {
  const Deflector still{FixedBeam{rotation_about(axis::right, -90_deg)}, Scanner{.pulse_rate = 65536, .pulses = 65536}};
  const support::LeastRayTarget plane;
  const char* const message =
      "pulse 32768 at 0.5 s has a pose that is not finite: check the trajectory, optic or pose errors";
  for (const Lost& lost : {Lost{.position = not_a_number}, Lost{.position = std::numeric_limits<double>::infinity()},
                           Lost{.rotation = not_a_number}})
    CHECK(message_of(Survey{Platform{lost, Mount{}, still}, SingleRay{}, plane, Receiver{}, FirstHit{}}, 32768) ==
          message);
  CHECK(message_of(Survey{Misreported{}, SingleRay{}, plane, Receiver{}, FirstHit{}}, 3000) ==
        "pulse 3000 at 0.03 s has a pose that is not finite: check the trajectory, optic or pose errors");
}

TEST_CASE("NaN from a user's own map ends a run at its pulse, on any number of threads") {
  for (const Broken& map : {Broken{5000, true, false}, Broken{5000, false, true}})
    CHECK(message_of(Survey{Rain{.pulses = 20000}, RingFootprint{}, map, Receiver{}, FirstHit{}}, 5000) ==
          "the map answered pulse 5000 at 0.05 s with NaN: check its ranges and backscatter, or the laws of its "
          "materials");
  const Broken whole{0};
  CHECK(run(Survey{Rain{.pulses = 3000}, RingFootprint{}, whole, Receiver{}, FirstHit{}}, {}).echoes == 3000);
}

TEST_CASE("the outcome of a pulse tells its error") {
  const support::LeastRayTarget plane;
  const Survey misreported{Misreported{}, SingleRay{}, plane, Receiver{}, FirstHit{}};
  auto v = misreported.workspace();
  CHECK(misreported(2999, v).error == PulseError::none);
  CHECK(misreported(3000, v).error == PulseError::pose);
  const Broken map{10, true, false};
  const Survey broken{Rain{}, RingFootprint{}, map, Receiver{}, FirstHit{}};
  auto w = broken.workspace();
  CHECK(broken(9, w).error == PulseError::none);
  CHECK(broken(10, w).error == PulseError::map);
}

namespace {

/// Keeps the shots that it gets, and says whether it reads empty ones.
struct ShotsOf {
  bool empty_shots;
  std::vector<Shot> shots{};
  bool reads_empty_shots() const noexcept { return empty_shots; }
  void operator()(const EchoBatch& batch) { shots.insert(shots.end(), batch.shots.begin(), batch.shots.end()); }
};
static_assert(ChoosesShots<ShotsOf> && ChoosesShots<Cloud> && !ChoosesShots<support::LeastSink>);

}  // namespace

TEST_CASE("shots without an echo are left out of a run whose sinks do not read them, and counted all the same") {
  const auto survey = small_survey();
  ShotsOf all{true}, beside{false}, few{false};
  Cloud cloud, expected;
  const RunSummary with = run(survey, {.threads = 2}, beside, all, expected),
                   without = run(survey, {.threads = 2}, few, cloud);
  CHECK(all.shots.size() == with.pulses());
  CHECK(beside.shots.size() == with.pulses());  // another sink of the run reads them
  CHECK(few.shots.size() < all.shots.size());
  std::erase_if(all.shots, [](const Shot& s) { return s.echoes == 0 && s.samples == 0; });
  REQUIRE(all.shots.size() == few.shots.size());
  for (std::size_t k = 0; k < few.shots.size(); ++k) REQUIRE(few.shots[k].index == all.shots[k].index);
  CHECK(cloud.points == expected.points);
  CHECK(with.fates == without.fates);
  CHECK(with.energy == without.energy);
  CHECK(with.echoes == without.echoes);
}
