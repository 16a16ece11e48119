// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
// mistake 1: the arguments are swapped
// mistake 2: at.Tick. of an optic, head or trajectory must be noexcept
// mistake 3: a sink must be callable with one batch
// mistake 4: a bare Scanner needs a deflector
// mistake 5: the map is a temporary
// mistake 6: optional member 'open' has another form here. it must be: bool open.Tick. const noexcept
// mistake 7: Executor: 'threads' is missing or has another form
// mistake 8: Executor: 'for_each' is missing or has another form
// mistake 9: Executor: a temporary. name it
// mistake 10: Platform.trajectory, mount, source.: the second argument must be a mount
// mistake 11: Platform.trajectory, mount, source.: the second argument must be a mount
// mistake 12: Transport, Survey's fourth argument: 'workspace' is missing
// mistake 13: Transport, Survey's fourth argument: 'reflections' is missing or has another form
// mistake 14: Transport, Survey's fourth argument: 'trace' is missing or has another form
// mistake 15: optional member 'next_open' is promised by `refinements`, but is missing
// error: MotionArgument<Stepping
// error: at.Tick. of an optic, head or trajectory must be const
// error: MotionArgument<Throwing
// error: takes an optic and a Scanner, or a head and a Deflector
// error: a bare Scanner needs a deflector
// error: the second argument must be a mount
// error: the map is a temporary
// error: the source must be a Platform
// error: the second argument must be a Footprint
// error: the map must be a Target
// error: the detector must be a Detector
// error: the first argument must be a survey
//
// Mistakes in the use of the stages: the first line with `error:` says in one sentence what to do. Those that show only
// in a run are in tests/mistakes.cpp.
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/scanner.hpp>

#ifndef MISTAKE
#define MISTAKE -1
#endif

using namespace pulsecast;

struct Nothing {
  std::optional<Hit> closest_hit(const Ray&) const noexcept { return std::nullopt; }
};

struct OwnOptic {
#if MISTAKE == 2
  Pose<frame::Beam, frame::Instrument> at(Tick) const { return {}; }
#else
  Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return {}; }
#endif
#if MISTAKE == 6
  bool open(Tick) const { return true; }
#else
  bool open(Tick) const noexcept { return true; }
#endif
#if MISTAKE == 15
  using refinements = refines<tag::Gated, tag::ForeseesOpening>;
  Tick next_opening(Tick t) const noexcept { return t; }
#endif
};
struct OwnThreads {
#if MISTAKE != 7
  unsigned threads() { return 1; }
#endif
#if MISTAKE == 8
  void for_each(std::size_t, void (*)(std::size_t)) {}
#else
  void for_each(std::size_t count, const IndexTask& task) {
    while (count-- > 0) task(count);
  }
#endif
};
struct OwnLight {
#if MISTAKE != 12
  int workspace(std::size_t) const { return 0; }
#endif
#if MISTAKE == 13
  int reflections(std::size_t) const noexcept { return 0; }
#else
  std::size_t reflections(std::size_t) const noexcept { return 0; }
#endif
  TransportResult trace(const Nothing&, const TransportInput&, int&, std::span<Reflection>) const
#if MISTAKE != 14
      noexcept
#endif
  {
    return {};
  }
};
struct Stepping {
  Pose<frame::Instrument, frame::Instrument> at(Tick) noexcept { return {}; }
};
struct Throwing {
  Pose<frame::Body, frame::World> at(Tick) const { return {}; }
};

int main() {
  const Nothing map;
  const Scanner scanner;
  const Deflector device{OwnOptic{}, scanner};
  const Deflector turned{RotatingHead{}, device};
  const Platform platform{Tripod{}, Mount{}, turned};
  const std::vector<ReceiverUnit<SingleRay, FirstHit>> receivers(1);
  const Survey survey{platform, SingleRay{}, map, Receiver{}, FirstHit{}};
  const Survey of_receivers{platform, receivers, map, 7};
  OwnThreads threads;
  run(survey, {.executor = threads}, [](const EchoBatch&) {});
  const Survey lit{platform, SingleRay{}, map, OwnLight{}, Receiver{}, FirstHit{}};
#if MISTAKE == 1
  const Deflector mistake{scanner, OwnOptic{}};
#elif MISTAKE == 3
  run(survey, {}, [](const Echo&) {});
#elif MISTAKE == 4
  const Platform mistake{Tripod{}, scanner};
#elif MISTAKE == 5
  const Survey mistake{platform, SingleRay{}, Nothing{}, Receiver{}, FirstHit{}};
#elif MISTAKE == 9
  run(survey, {.executor = OwnThreads{}}, [](const EchoBatch&) {});
#elif MISTAKE == 10
  const Platform mistake{Mount{}, Tripod{}, turned};
#elif MISTAKE == 11
  const Platform mistake{Tripod{}, turned, Mount{}};
#elif MISTAKE == 0
  const Deflector stepping{Stepping{}, device};
  const Deflector mirror_around_a_mirror{PolygonMirror{}, device};
  const Platform throwing{Throwing{}, Mount{}, device};
  const Platform bare{Tripod{}, Mount{}, scanner};
  const Platform without_mount{Tripod{}, device};
  const Survey of_a_temporary{platform, receivers, Nothing{}};
  const Survey without_platform{device, SingleRay{}, map, Receiver{}, FirstHit{}};
  const Survey without_footprint{platform, 1, map, Receiver{}, FirstHit{}};
  const Survey without_map{platform, SingleRay{}, scanner, Receiver{}, FirstHit{}};
  const Survey without_detector{platform, SingleRay{}, map, Receiver{}, Receiver{}};
  run(platform, {}, [](const EchoBatch&) {});
#endif
}
