// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/any_survey.hpp>

#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/base/thread_pool.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include "support/archetypes.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

using support::LeastRayTarget;

/// A mirror that is closed for a third of the time.
auto mirror() {
  return Platform{Tripod{.position = {0, 0, 10}}, Mount{},
                  Deflector{PolygonMirror{.line_rate = 10, .sweep = 120_deg, .angle_min = -60_deg, .angle_max = 20_deg},
                            Scanner{.pulse_rate = 10_kHz, .pulses = 5000, .laser = {.divergence = 3_mrad}}}};
}

const LeastRayTarget plane;

auto waveforms(const LeastRayTarget& map = plane) {
  return Survey{mirror(), RingFootprint{}, map, Receiver{}, FullWaveform{WaveformSettings{.record_length = 20e-9}}};
}
auto first_hits() { return Survey{mirror(), SingleRay{}, plane, Receiver{}, FirstHit{}}; }

/// A survey with what `run` needs, and nothing else, whose workspaces cannot be moved.
struct LeastSurvey {
  struct Workspace {
    Workspace() = default;
    Workspace(const Workspace&) = delete;
    Workspace& operator=(const Workspace&) = delete;
  };
  Workspace workspace() const { return {}; }
  PulseIndex size() const noexcept { return 100; }
  std::size_t subrays() const noexcept { return 1; }
  std::size_t recorded_subrays() const noexcept { return 0; }
  double sample_interval() const noexcept { return 0; }
  Outcome operator()(PulseIndex i, Workspace&) const noexcept {
    Outcome outcome;
    outcome.shot.index = i;
    outcome.shot.fate = i % 3 == 0 ? Fate::blocked : Fate::missed;
    return outcome;
  }
};
static_assert(PulseSurvey<LeastSurvey> && !SkipsBlocked<LeastSurvey> && !SimulatesInOrder<LeastSurvey>);
static_assert(PulseSurvey<AnySurvey> && SkipsBlocked<AnySurvey> && SimulatesInOrder<AnySurvey> &&
              IdentifiedSurvey<AnySurvey>);
static_assert(std::is_convertible_v<LeastSurvey, AnySurvey> && !std::is_convertible_v<int, AnySurvey>);
static_assert(std::is_copy_assignable_v<AnySurvey> && std::is_nothrow_move_constructible_v<AnySurvey>);

template <class S>
std::string checksum(const S& survey, const RunOptions& options = {.threads = 1}) {
  support::LawfulSink sink;
  run(survey, options, sink);
  CHECK(sink.broken() == "");
  return sink.checksum();
}

TEST_CASE("surveys of several kinds in one container give what they give alone, to the last bit") {
  const std::vector<AnySurvey> surveys{waveforms(), first_hits(), waveforms()};
  const std::vector<std::string> expected{checksum(waveforms()), checksum(first_hits()), checksum(waveforms())};
  CHECK(expected[0] != expected[1]);
  for (std::size_t k = 0; k < surveys.size(); ++k) {
    CAPTURE(k);
    for (const unsigned threads : {1U, 3U}) CHECK(checksum(surveys[k], {.threads = threads}) == expected[k]);
  }
  const RunOptions part{.threads = 1, .first = 17, .end = 4001, .stride = 7};
  CHECK(checksum(surveys[0], part) == checksum(waveforms(), part));
}

TEST_CASE("numbers of a survey are those of the survey inside, and single slots, too") {
  const auto survey = waveforms();
  const AnySurvey any = survey;
  CHECK(any.size() == survey.size());
  CHECK(any.subrays() == survey.subrays());
  CHECK(any.recorded_subrays() == survey.recorded_subrays());
  CHECK(any.sample_interval() == survey.sample_interval());
  AnySurvey::Workspace workspace = any.workspace();
  auto own = survey.workspace();
  for (PulseIndex i = 0; i < survey.size(); i += 13) {
    CAPTURE(i);
    CHECK(any.next_pulse(i) == survey.next_pulse(i));
    CHECK(any.slot_from(Tick::of(i, 1000)) == survey.slot_from(Tick::of(i, 1000)));
    const Outcome outcome = any(i, workspace), expected = survey(i, own);
    CHECK(outcome.shot.fate == expected.shot.fate);
    REQUIRE(outcome.echoes.size() == expected.echoes.size());
    if (!expected.echoes.empty()) CHECK(outcome.echoes[0].range == expected.echoes[0].range);
  }
}

TEST_CASE("a survey with what a run needs and no more will do") {
  const AnySurvey any = LeastSurvey{};
  CHECK(any.next_pulse(3) == 3);
  CHECK(any.slot_from(Tick::of(3, 1)) == 0);
  const RunSummary summary = run(any, {.threads = 2}), expected = run(LeastSurvey{}, {.threads = 2});
  CHECK(summary.slots == 100);
  CHECK(summary.count(Fate::blocked) == 34);
  CHECK(summary.fates == expected.fates);
}

TEST_CASE("what a survey refers to lives as long as its last copy") {
  auto map = std::make_shared<const LeastRayTarget>();
  const std::weak_ptr<const LeastRayTarget> watch = map;
  {
    AnySurvey first(waveforms(*map), map);
    map.reset();
    const AnySurvey copy = first;
    first = first_hits();
    CHECK_FALSE(watch.expired());
    CHECK(checksum(copy) == checksum(waveforms()));
  }
  CHECK(watch.expired());
}

TEST_CASE("copies share their workspaces in an executor, and others do not") {
  const AnySurvey survey = waveforms(), copy = survey, other = waveforms();
  CHECK(survey.identity() == copy.identity());
  CHECK(survey.identity() != other.identity());
  ThreadPool pool(2);
  const std::string expected = checksum(waveforms());
  for (const AnySurvey* each : {&survey, &copy, &other, &survey})
    CHECK(checksum(*each, {.executor = pool}) == expected);
}

}  // namespace
