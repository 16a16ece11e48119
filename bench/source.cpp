// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>

#include <pulsecast/deflector/risley_prisms.hpp>
#include <pulsecast/pulsecast.hpp>

#include "report.hpp"

// Time of slots without tracing, one thread: a run of nothing but blocked slots, and pulses made by a mirror on a head,
// and by prisms. `bench_source PART` does one part alone, a million slots, for counts of instructions: blocked, head,
// prisms, and the latter two asked one by one: head_alone, prisms_alone.

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

constexpr PulseIndex slots = 1'000'000;

/// Map in which nothing is met.
struct Void {
  std::optional<Hit> closest_hit(const Ray&) const noexcept { return {}; }
};

template <class Optic>
auto on_tripod(Optic optic) {
  return Platform{
      Tripod{}, Mount{},
      Deflector{RotatingHead{.angular_rate = 0.1}, Deflector{optic, Scanner{.pulse_rate = 300_kHz, .pulses = slots}}}};
}

const PolygonMirror open_mirror{.line_rate = 100, .sweep = 60_deg};
const PolygonMirror blind_mirror{.line_rate = 100, .sweep = 60_deg, .angle_min = 59.9_deg, .angle_max = 60_deg};
const RisleyPrisms prisms{.prisms = {{.rotation_rate = 100}, {.rotation_rate = -77}}};

std::uint64_t run_blocked() {
  const Void nothing;
  return run(Survey{on_tripod(blind_mirror), SingleRay{}, nothing, Receiver{}, FirstHit{}}, {.threads = 1})
      .count(Fate::blocked);
}

/// One, after the compiler had to make the whole pulse.
std::uint64_t used(const Pulse<frame::World>& pulse) {
  asm volatile("" : : "m"(pulse));
  return 1;
}

template <class Source>
std::uint64_t make_pulses(const Source& source) {
  std::uint64_t made = 0;
  for (PulseIndex i = 0; i < slots; i += simd::lane_count) {
    const auto pulses = source.pulse_lanes(i, simd::lane_count);
    for (std::size_t lane = 0; lane < pulses.size; ++lane)
      if (const auto pulse = pulses[lane]) made += used(*pulse);
  }
  return made;
}

template <class Source>
std::uint64_t make_one_by_one(const Source& source) {
  std::uint64_t made = 0;
  for (PulseIndex i = 0; i < slots; ++i)
    if (const auto pulse = source.pulse(i)) made += used(*pulse);
  return made;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view part = argc > 1 ? argv[1] : "";
  const auto row = [&](std::string_view name, const char* what, auto&& work) {
    if (!part.empty() && part != name) return;
    const double start = bench::thread_seconds();
    const std::uint64_t count = work();
    const double seconds = bench::thread_seconds() - start;
    if (count < slots / 2) std::exit(1);
    std::printf("%-44s %8.2f ns\n", what, 1e9 * seconds / static_cast<double>(slots));
  };
  row("blocked", "a blocked slot, mean over a sweep, in a run", [] { return run_blocked(); });
  row("head", "a pulse made by a mirror on a head", [] { return make_pulses(on_tripod(open_mirror)); });
  row("prisms", "a pulse made by two prisms on a head", [] { return make_pulses(on_tripod(prisms)); });
  row("head_alone", "a pulse made by a mirror on a head, alone",
      [] { return make_one_by_one(on_tripod(open_mirror)); });
  row("prisms_alone", "a pulse made by two prisms on a head, alone", [] { return make_one_by_one(on_tripod(prisms)); });
}
