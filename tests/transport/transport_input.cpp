// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/transport/transport_input.hpp>

#include <optional>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/survey.hpp>

#include "support/archetypes.hpp"
#include "support/relative.hpp"

using namespace pulsecast;

namespace {

using BeamPose = Pose<frame::Beam, frame::World>;

/// Light as a transport was told of it.
struct Note {
  PulseIndex index = 0;
  std::uint64_t seed = 0;
  Emitter emitter{};
  std::size_t subrays = 0, record = 0;
  RangeGate gate{};
  double energy = 0, white = 0, expected_white = 0, last_share = 0;
  BeamPose pose{}, reported{};
};

struct Spy : support::LeastTransport {
  Note* note;
  explicit Spy(Note& to) : note(&to) {}
  template <class Map>
  TransportResult trace(const Map& map, const TransportInput& light, Workspace& w,
                        std::span<Reflection> reflections) const noexcept {
    *note = {light.index,
             light.seed,
             light.emitter,
             light.subrays,
             light.record.size(),
             light.gate,
             light.energy(),
             light.white_target.power(light.budget, 10),
             light.budget.power(1, 1, 10),
             light.beam.shares[light.subrays - 1],
             light.pulse.pose,
             light.reported()};
    return LeastTransport::trace(map, light, w, reflections);
  }
};

/// Two emitters by turns; the second one's pose is reported wrong.
struct ByTurns : support::LeastSource<frame::World> {
  std::vector<Emitter> emitters() const {
    return {{.laser = {.peak_power = 3, .pulse_length = 5e-9}},
            {.laser = {.divergence = 0.01}, .receiver = 1, .channel = 7}};
  }
  std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept {
    auto p = support::LeastSource<frame::World>::pulse(i);
    p->emitter = i % 2;
    if (i % 2 == 1) p->reported = BeamPose{no_rotation, {1, 2, 3}};
    return p;
  }
};

}  // namespace

TEST_CASE("a transport is told the pulse, its emitter, the beam and the receiver that hears it") {
  const std::vector<ReceiverUnit<RingFootprint, FirstHit>> units{
      {RingFootprint{2}, Receiver{.range_min = 2, .range_max = 50}, FirstHit{}},
      {RingFootprint{4}, Receiver{.diameter = 0.3}, FirstHit{}}};
  const support::LeastRayTarget map;
  Note note;
  const Survey survey{ByTurns{}, units, map, Spy{note}, 77};
  auto w = survey.workspace();
  CHECK(survey(4, w).shot.fate == Fate::missed);
  CHECK(note.index == 4);
  CHECK(note.seed == 77);
  CHECK(note.emitter == ByTurns{}.emitters()[0]);
  CHECK(note.subrays == RingFootprint{2}.size());
  CHECK(note.last_share == RingFootprint{2}.share(note.subrays - 1));
  CHECK(note.record == 0);
  CHECK(note.gate.near == 2);
  CHECK(note.gate.far == 50);
  CHECK(note.energy == support::relative(15e-9, 1e-15));
  CHECK(note.white == note.expected_white);
  CHECK(note.white == LinkBudget(units[0].receiver, note.emitter.laser).power(1, 1, 10));
  CHECK(note.reported.position == note.pose.position);
  CHECK(survey(3, w).energy.sent == Laser{}.energy());
  CHECK(note.emitter == ByTurns{}.emitters()[1]);
  CHECK(note.subrays == RingFootprint{4}.size());
  CHECK(note.white == note.expected_white);
  CHECK(note.white == LinkBudget(units[1].receiver, note.emitter.laser).power(1, 1, 10));
  CHECK(note.reported.position == Vec3{1, 2, 3});
}

TEST_CASE("a transport is given room for a record only if subrays are recorded") {
  const support::LeastRayTarget map;
  Note note;
  const Survey survey{
      support::LeastSource<frame::World>{}, WithSubrayRecord{RingFootprint{2}}, map, Spy{note}, Receiver{}, FirstHit{}};
  auto w = survey.workspace();
  CHECK(survey(1, w).subrays.size() == RingFootprint{2}.size());
  CHECK(note.record == RingFootprint{2}.size());
}
