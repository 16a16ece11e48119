// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/platform/platform.hpp>

#include <cmath>
#include <limits>

#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include <doctest/doctest.h>

#include "support/aborts.hpp"
#include "support/archetypes.hpp"
#include "support/generators.hpp"
#include "support/laws.hpp"
#include "support/relative.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

static_assert(WorldSource<Platform<Tripod, Deflector<PolygonMirror, Scanner>>>);
static_assert(WorldSource<Platform<support::LeastTrajectory, support::LeastSource<frame::Instrument>>>);

template <class Path, class Source>
concept Carries = requires {
  typename Platform<Path, Source>;
};
static_assert(Carries<Tripod, Deflector<PolygonMirror, Scanner>>);
static_assert(!Carries<Tripod, Scanner>, "a platform carries an instrument, not a bare laser");
static_assert(!Carries<PolygonMirror, Deflector<PolygonMirror, Scanner>>, "a mirror is no trajectory");

/// Ten metres a second to the north, turning left by a quarter of a turn a second.
struct Spinning {
  Pose<frame::Body, frame::World> at(Tick t) const noexcept {
    return {rotation_about(axis::up, 90_deg * t.seconds()), {0, 10 * t.seconds(), 100}};
  }
};

/// A pose of the beam in the instrument that does not change.
struct Fixed {
  Pose<frame::Beam, frame::Instrument> pose{};
  Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return pose; }
};

struct Asks : support::LeastTrajectory {
  void validate() const { require_positive("Asks::value", -1, "m"); }
};

}  // namespace

TEST_CASE("the whole chain of a random platform is the product of its poses") {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const auto instrument_from_beam = any.pose<frame::Beam, frame::Instrument>(0.2);
    const auto body_from_instrument = any.pose<frame::Instrument, frame::Body>(2);
    const Platform platform{Spinning{}, Mount{body_from_instrument.position, body_from_instrument.rotation},
                            Deflector{Fixed{instrument_from_beam}, Scanner{.pulse_rate = 10, .pulses = 100}}};
    const PulseIndex i = any.whole(100);
    const auto p = platform.pulse(i);
    REQUIRE(p);
    const auto expected = Spinning{}.at(Tick::of(i, 10)) * body_from_instrument * instrument_from_beam;
    CHECK(length(p->origin() - expected.position) < 1e-12);
    CHECK(length(p->direction() - expected.direction(axis::forward)) < 1e-14);
    CHECK(length(p->pose.direction(axis::up) - expected.direction(axis::up)) < 1e-14);
  }
}

TEST_CASE("a scan angle is zero below the body, positive to its right, and does not depend on how the body is turned") {
  const auto scan_angle = [](const Rotation& beam, const Tripod& tripod) {
    return Platform{tripod, Mount{}, Deflector{Fixed{{beam, {}}}, Scanner{.pulses = 1}}}.pulse(0)->scan_angle;
  };
  for (const double heading : {0.0, 1.0, 3.0}) {
    const Tripod tripod{.heading = heading};
    const Rotation down = rotation_about(axis::right, -90_deg);
    CHECK(std::fabs(scan_angle(down, tripod)) < 1e-15);
    // about the body's forward axis, what is below moves to the left for a positive turn
    CHECK(scan_angle(rotation_about(axis::forward, -20_deg) * down, tripod) == support::relative(20_deg, 1e-14));
    CHECK(scan_angle(rotation_about(axis::forward, 20_deg) * down, tripod) == support::relative(-20_deg, 1e-14));
    CHECK(scan_angle(rotation_about(axis::up, -90_deg), tripod) == support::relative(90_deg, 1e-14));
    // a beam that looks ahead and down has the scan angle of what is below
    CHECK(std::fabs(scan_angle(rotation_about(axis::right, -45_deg), tripod)) < 1e-15);
    // a mount that is turned turns the beam with it
    const Mount rolled{.boresight = rotation_about(axis::forward, 20_deg)};
    const Platform platform{tripod, rolled, Deflector{Fixed{{down, {}}}, Scanner{.pulses = 1}}};
    CHECK(platform.pulse(0)->scan_angle == support::relative(-20_deg, 1e-14));
  }
}

TEST_CASE(
    "a scan angle is that of the beam from the vertical, with the roll of the body and whatever its heading and "
    "pitch") {
  struct Attitude {
    Rotation rotation;
    Pose<frame::Body, frame::World> at(Tick) const noexcept { return {rotation, {}}; }
  };
  const Rotation down = rotation_about(axis::right, -90_deg);
  const auto scan_angle = [&](const Rotation& body, double aside) {
    const Mount mount{.boresight = rotation_about(axis::forward, -aside) * down};
    return double(Platform{Attitude{body}, mount, Deflector{Fixed{}, Scanner{.pulses = 1}}}.pulse(0)->scan_angle);
  };
  // the nadir beam of a body that rolls to its right looks to the left
  CHECK(scan_angle(rotation_about(axis::forward, 15_deg), 0) == support::relative(-15_deg, 1e-14));
  CHECK(scan_angle(rotation_about(axis::forward, 15_deg), 20_deg) == support::relative(5_deg, 1e-14));
  CHECK(std::fabs(scan_angle(rotation_about(axis::right, 40_deg), 0)) < 1e-15);
  // forward straight up or down has no heading
  for (const double pitch : {-90_deg, 90_deg})
    CHECK(std::isfinite(scan_angle(rotation_about(axis::right, pitch), 10_deg)));
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    CAPTURE(seed);
    support::Generator any(seed);
    const double heading = any.uniform(-3, 3), pitch = any.uniform(-1.4, 1.4), roll = any.uniform(-3, 3),
                 aside = any.uniform(-3, 3);
    const Rotation rolled = rotation_about(axis::forward, roll), nosed = rotation_about(axis::right, pitch) * rolled;
    const Vec3 beam = nosed * (rotation_about(axis::forward, -aside) * (down * axis::forward));
    CHECK(scan_angle(rotation_about(axis::up, heading) * nosed, aside) ==
          support::relative(std::atan2(beam.x, -beam.z), 1e-12));
    CHECK(std::fabs(std::sin(scan_angle(rotation_about(axis::up, heading) * rolled, aside) - (aside - roll))) < 1e-12);
  }
}

TEST_CASE("a blocked slot stays blocked on a platform") {
  const Platform platform{
      Tripod{}, Mount{},
      Deflector{PolygonMirror{.line_rate = 1, .angle_min = 0}, Scanner{.pulse_rate = 4, .pulses = 4}}};
  CHECK_FALSE(platform.pulse(0));
  CHECK_FALSE(platform.pulse(1));
  CHECK(platform.pulse(2));
  CHECK(platform.pulse(3));
}

TEST_CASE("a platform keeps the laws of a source and the size and ticks of what it carries") {
  const Deflector device{RotatingHead{.angular_rate = 0.1},
                         Deflector{PolygonMirror{.line_rate = 77, .angle_min = -1, .angle_max = 0.5},
                                   Scanner{.pulse_rate = 1e6 / 7, .pulses = 100000007}}};
  const Platform platform{Spinning{}, Mount{.lever_arm = {0.1, -0.2, 0.3}}, device};
  CHECK(support::source_laws(platform) == "");
  CHECK(support::wrapped_source_laws(platform, device) == "");
}

TEST_CASE("a mount refuses what is not a place or not a rotation") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_NOTHROW(Mount{}.validate());
  CHECK_THROWS_AS((Mount{.lever_arm = {0, nan, 0}}.validate()), SettingError);
  CHECK_THROWS_AS((Mount{.boresight = Rotation{1, 1, 0, 0}}.validate()), SettingError);
  CHECK_THROWS_AS((Mount{.boresight = Rotation{nan, 0, 0, 0}}.validate()), SettingError);
}

TEST_CASE("a mount of single precision becomes unit on its platform") {
  const Rotation rounded{0.6F, 0.8F, 0, 0};
  const Platform platform{Tripod{}, Mount{.boresight = rounded}, support::LeastSource<frame::Instrument>{}};
  CHECK(length(platform.mount().boresight) == support::relative(1, 1e-15));
  CHECK(std::fabs(length(rounded) - 1) > 1e-9);
}

TEST_CASE("a trajectory that gives no place or no rotation is a bug, which debug builds notice") {
  struct Own {
    Pose<frame::Body, frame::World> pose{};
    Pose<frame::Body, frame::World> at(Tick) const noexcept { return pose; }
  };
  const auto aborts = [](const Rotation& rotation, const Vec3& position) {
    return support::aborts([&] {
      (void)Platform{Own{{rotation, position}}, Mount{}, Deflector{PolygonMirror{}, Scanner{.pulses = 1}}}.pulse(0);
    });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(aborts({1.17, 0, 0, 0}, {}) == support::has_assertions);
  CHECK_FALSE(aborts({nan, 0, 0, 0}, {}));  // which a run reports
  CHECK_FALSE(aborts(no_rotation, {0, nan, 0}));
  CHECK_FALSE(aborts({0.6F, 0.8F, 0, 0}, {}));
}

TEST_CASE("a platform asks its mount and its trajectory whether they can be") {
  const support::LeastSource<frame::Instrument> source;
  CHECK_THROWS_AS((Platform{Tripod{}, Mount{.boresight = Rotation{2, 0, 0, 0}}, source}), SettingError);
  CHECK_THROWS_AS((Platform{Asks{}, Mount{}, source}), SettingError);
}

TEST_CASE("a motion or source that replaces a member of the library's is asked by that member") {
  struct Leaning : Tripod {
    Pose<frame::Body, frame::World> at(Tick) const noexcept { return {rotation_about(axis::forward, 0.5), {1, 2, 3}}; }
  };
  struct Late : Scanner {
    std::optional<Pulse<frame::Beam>> pulse(PulseIndex i) const noexcept {
      auto p = Scanner::pulse(i);
      p->tick = p->tick + Tick{5, 0};
      return p;
    }
  };
  const Platform leaning{Leaning{}, Mount{}, Deflector{FixedBeam{}, Late{{.pulses = 10}}}};
  CHECK(leaning.pulse(3)->origin() == Vec3{1, 2, 3});
  CHECK(leaning.pulse(3)->tick == Tick::of(3, 100e3) + Tick{5, 0});
}
