// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/deflector/deflector.hpp>

#include <cmath>
#include <limits>

#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/scanner/scanner.hpp>

#include <doctest/doctest.h>

#include "support/aborts.hpp"
#include "support/archetypes.hpp"
#include "support/laws.hpp"

using namespace pulsecast;
using namespace pulsecast::literals;

namespace {

using Mirrored = Deflector<PolygonMirror, Scanner>;
using Headed = Deflector<RotatingHead, Mirrored>;

static_assert(InstrumentSource<Mirrored> && InstrumentSource<Headed>);
static_assert(InstrumentSource<Deflector<support::LeastOptic, support::LeastSource<frame::Beam>>>);
static_assert(InstrumentSource<Deflector<support::LeastHead, support::LeastSource<frame::Instrument>>>);

template <class Moving, class Source>
concept Deflects = requires {
  typename Deflector<Moving, Source>;
};
static_assert(Deflects<PolygonMirror, Scanner> && Deflects<RotatingHead, Mirrored>);
static_assert(!Deflects<RotatingHead, Scanner>, "a head turns an instrument, not a beam");
static_assert(!Deflects<PolygonMirror, Mirrored>, "a beam is deflected by one optic only");
static_assert(!Deflects<Scanner, PolygonMirror>, "the moving thing comes first");
static_assert(!Deflects<support::LeastTrajectory, Scanner>, "a trajectory carries an instrument, not a beam");

/// Leaves from one metre above the middle of the housing, to the right.
struct Periscope {
  Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept {
    return {rotation_about(axis::up, -90_deg), {0, 0, 1}};
  }
};

/// Lets every pulse of an even second out.
struct Chopper : support::LeastOptic {
  bool open(Tick t) const noexcept { return t.second % 2 == 0; }
};

struct ChoppingHead : support::LeastHead {
  bool open(Tick t) const noexcept { return t.second % 4 == 0; }
};

}  // namespace

TEST_CASE("a deflector sends each pulse where its optic is at that time") {
  const Mirrored device{PolygonMirror{.line_rate = 100, .sweep = 60_deg},
                        Scanner{.pulse_rate = 100_kHz, .pulses = 100000}};
  const auto p = device.pulse(250);  // a quarter of the first line
  REQUIRE(p);
  CHECK(p->tick == Tick{0, 0.0025});
  CHECK(length(p->direction() - Vec3{0, std::cos(30_deg), -std::sin(30_deg)}) < 1e-14);
}

TEST_CASE("a head turns what its instrument has deflected, not the other way round") {
  const Headed device{RotatingHead{.angular_rate = 90_deg}, Mirrored{PolygonMirror{.line_rate = 0.25, .sweep = 90_deg},
                                                                     Scanner{.pulse_rate = 1, .pulses = 4}}};
  // after one second the mirror looks 45 degrees down and the head has turned to the left
  const auto p = device.pulse(1);
  REQUIRE(p);
  CHECK(length(p->direction() - Vec3{-std::sqrt(0.5), 0, -std::sqrt(0.5)}) < 1e-15);
}

TEST_CASE("a head carries the place where the beam leaves around with it") {
  const Deflector device{RotatingHead{.angular_rate = 90_deg, .axis = axis::right},
                         Deflector{Periscope{}, Scanner{.pulse_rate = 1, .pulses = 4}}};
  const auto p = device.pulse(1);
  REQUIRE(p);
  CHECK(length(p->origin() + axis::forward) < 1e-15);  // what was above is behind
  CHECK(length(p->direction() - axis::right) < 1e-15);
}

TEST_CASE("a whole spinning head may be turned again, about another axis: the outer turn comes last") {
  const double spin = 10 * 360_deg, tilt = -15_deg, turn = 7_deg;
  const Deflector spinning{RotatingHead{.angular_rate = -spin},
                           Deflector{FixedBeam{aimed_at(0, tilt)}, Scanner{.pulse_rate = 20_kHz, .pulses = 40000}}};
  const Deflector nodding{RotatingHead{.angular_rate = turn, .axis = axis::right}, spinning};
  const Deflector panning{RotatingHead{.angular_rate = 3 * turn, .start = 1}, nodding};
  for (PulseIndex i = 0; i < 40000; i += 77) {
    CAPTURE(i);
    const double t = static_cast<double>(i) / 20e3, azimuth = spin * t, nod = turn * t, pan = 1 + 3 * turn * t;
    const Vec3 spun{std::cos(tilt) * std::sin(azimuth), std::cos(tilt) * std::cos(azimuth), std::sin(tilt)};
    const Vec3 nodded{spun.x, std::cos(nod) * spun.y - std::sin(nod) * spun.z,
                      std::sin(nod) * spun.y + std::cos(nod) * spun.z};
    const Vec3 panned{std::cos(pan) * nodded.x - std::sin(pan) * nodded.y,
                      std::sin(pan) * nodded.x + std::cos(pan) * nodded.y, nodded.z};
    CHECK(length(spinning.pulse(i)->direction() - spun) < 1e-12);
    CHECK(length(nodding.pulse(i)->direction() - nodded) < 1e-12);
    CHECK(length(panning.pulse(i)->direction() - panned) < 1e-12);
  }
  CHECK(support::source_laws(panning) == "");
  CHECK(support::wrapped_source_laws(panning, spinning) == "");
}

TEST_CASE("a closed optic blocks the slot, and so does a closed head or what is inside") {
  const Deflector chopped{Chopper{}, Scanner{.pulse_rate = 1, .pulses = 8}};
  const Deflector twice{ChoppingHead{}, chopped};
  CHECK(twice.size() == 8);
  for (PulseIndex i = 0; i < 8; ++i) {
    CAPTURE(i);
    CHECK(chopped.pulse(i).has_value() == (i % 2 == 0));
    CHECK(twice.pulse(i).has_value() == (i % 4 == 0));
  }
  CHECK(support::source_laws(twice) == "");
}

TEST_CASE("deflectors keep the laws of a source and the size and ticks of what they wrap") {
  const Mirrored inner{PolygonMirror{.line_rate = 77, .angle_min = -1, .angle_max = 0.5},
                       Scanner{.pulse_rate = 99999.5, .pulses = 1000000007}};
  const Headed outer{RotatingHead{.angular_rate = 0.1}, inner};
  CHECK(support::source_laws(inner) == "");
  CHECK(support::source_laws(outer) == "");
  CHECK(support::wrapped_source_laws(inner, inner.source()) == "");
  CHECK(support::wrapped_source_laws(outer, inner) == "");
}

TEST_CASE("an optic or a head that gives no rotation is a bug, which debug builds notice") {
  struct Stretched {
    double norm = 1;
    Pose<frame::Beam, frame::Instrument> at(Tick) const noexcept { return {Rotation{norm, 0, 0, 0}, {}}; }
  };
  struct StretchedHead {
    Pose<frame::Instrument, frame::Instrument> at(Tick) const noexcept { return {Rotation{1.17, 0, 0, 0}, {}}; }
  };
  const Scanner laser{.pulses = 1};
  CHECK(support::aborts([&] { (void)Deflector{Stretched{1.17}, laser}.pulse(0); }) == support::has_assertions);
  CHECK_FALSE(support::aborts([&] {
    (void)Deflector{Stretched{std::nan("")}, laser}.pulse(0);
  }));  // which a run reports
  CHECK(support::aborts([&] {
          (void)Deflector{StretchedHead{}, Mirrored{PolygonMirror{}, laser}}.pulse(0);
        }) == support::has_assertions);
  CHECK_FALSE(support::aborts([&] { (void)Deflector{Stretched{1 + 1e-7}, laser}.pulse(0); }));
}

TEST_CASE("a deflector refuses settings that cannot be, its own and those inside") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS((Mirrored{PolygonMirror{.line_rate = -1}, Scanner{}}), SettingError);
  CHECK_THROWS_AS((Mirrored{PolygonMirror{}, Scanner{.pulse_rate = nan}}), SettingError);
  CHECK_THROWS_AS((Headed{RotatingHead{.angular_rate = nan}, Mirrored{PolygonMirror{}, Scanner{}}}), SettingError);
}
