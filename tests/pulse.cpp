// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/pulse.hpp>

#include <cmath>
#include <concepts>

#include <doctest/doctest.h>

#include "support/generators.hpp"

using namespace pulsecast;

TEST_CASE("a pulse leaves where its pose is, along the pose's forward") {
  Pulse<frame::World> p;
  p.pose = {rotation_about(axis::up, -pi / 2), {1, 2, 3}};
  CHECK(p.origin() == Vec3{1, 2, 3});
  CHECK(length(p.direction() - axis::right) < 1e-15);
}

TEST_CASE("a pulse seen from a surrounding frame has another pose and is otherwise the same") {
  Pulse<frame::Beam> inner;
  inner.tick = {8, 0.25};
  inner.emitter = 300;
  inner.pose.position = {0, 1, 0};
  const Pose<frame::Beam, frame::Instrument> outer_from_inner{rotation_about(axis::up, pi / 2), {10, 0, 0}};
  const Pulse outer(outer_from_inner, inner);
  static_assert(std::same_as<decltype(outer), const Pulse<frame::Instrument>>);
  CHECK(length(outer.origin() - Vec3{9, 0, 0}) < 1e-15);
  CHECK(length(outer.direction() + axis::right) < 1e-15);
  CHECK(outer.tick == Tick{8, 0.25});
  CHECK(outer.emitter == 300);
}

TEST_CASE("transforming twice is transforming by the composed pose") {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    Pulse<frame::Beam> p;
    p.pose = any.pose<frame::Beam, frame::Beam>(0.1);
    const auto instrument_from_beam = any.pose<frame::Beam, frame::Instrument>(1);
    const auto body_from_instrument = any.pose<frame::Instrument, frame::Body>(1);
    const Pulse twice(body_from_instrument, Pulse(instrument_from_beam, p));
    const Pulse once(body_from_instrument * instrument_from_beam, p);
    CHECK(length(twice.origin() - once.origin()) < 1e-14);
    CHECK(length(twice.direction() - once.direction()) < 1e-14);
  }
}
