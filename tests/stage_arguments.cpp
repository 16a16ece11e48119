// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#include <pulsecast/stage_arguments.hpp>

#include <concepts>

#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/survey.hpp>

#include <doctest/doctest.h>

#include "support/archetypes.hpp"

using namespace pulsecast;
using namespace pulsecast::support;

// The mistakes are in tests/compile_fail/mistakes.cpp.
namespace {

using Beams = LeastSource<frame::Beam>;
using Device = LeastSource<frame::Instrument>;
using Carried = LeastSource<frame::World>;

static_assert(detail::Deflectable<LeastOptic, Beams> && detail::Deflectable<LeastHead, Device>);
static_assert(!detail::Deflectable<LeastHead, Beams> && !detail::Deflectable<LeastOptic, Device> &&
              !detail::Deflectable<Beams, LeastOptic>);

static_assert(detail::Surveyable<Carried, LeastFootprint, LeastRayTarget&, LeastDetector>);
static_assert(detail::Surveyable<Carried, LeastFootprint, const LeastBundleTarget&, LeastDetector>);
static_assert(!detail::Surveyable<Carried, LeastFootprint, LeastRayTarget, LeastDetector>, "the map is a temporary");
static_assert(!detail::Surveyable<Carried, LeastFootprint, const LeastRayTarget, LeastDetector>,
              "the map is a temporary");
static_assert(!detail::Surveyable<Device, LeastFootprint, LeastRayTarget&, LeastDetector>);
static_assert(!detail::Surveyable<Carried, Device, LeastRayTarget&, LeastDetector>);
static_assert(!detail::Surveyable<Carried, LeastFootprint, LeastGeometry&, LeastDetector>);
static_assert(!detail::Surveyable<Carried, LeastFootprint, LeastRayTarget&, LeastOptic>);

using OwnSurvey = Survey<Carried, LeastFootprint, LeastRayTarget, LeastDetector>;
using Units = std::vector<ReceiverUnit<LeastFootprint, LeastDetector>>;
static_assert(
    std::constructible_from<OwnSurvey, Carried, LeastFootprint, const LeastRayTarget&, Receiver, LeastDetector>);
static_assert(!std::constructible_from<OwnSurvey, Carried, LeastFootprint, LeastRayTarget, Receiver, LeastDetector>);
static_assert(std::constructible_from<OwnSurvey, Carried, Units, LeastRayTarget&>);
static_assert(!std::constructible_from<OwnSurvey, Carried, Units, LeastRayTarget>);

}  // namespace

TEST_CASE("stages are deduced from right arguments, and from one of their own kind") {
  const Deflector device{LeastOptic{}, Beams{}};
  const Deflector turned{LeastHead{}, device};
  const Platform platform{LeastTrajectory{}, Mount{}, turned};
  const Platform placed{LeastTrajectory{}, {.lever_arm = {0, 0, 1}}, device};
  LeastRayTarget map;
  const Survey survey{platform, LeastFootprint{}, map, Receiver{}, LeastDetector{}};
  const Survey seeded{Carried{}, LeastFootprint{}, map, Receiver{}, LeastDetector{}, 7};
  const Survey of_units{Carried{}, Units(1), map, 7};
  const Survey copy{seeded};
  const Platform moved{Platform{platform}};
  static_assert(std::same_as<decltype(turned), const Deflector<LeastHead, Deflector<LeastOptic, Beams>>>);
  static_assert(std::same_as<decltype(moved), decltype(platform)> && std::same_as<decltype(copy), const OwnSurvey>);
  static_assert(std::same_as<decltype(of_units), const OwnSurvey>);
  CHECK(survey.size() == 10);
  CHECK(placed.mount().lever_arm.z == 1);
  CHECK(copy.identity() == seeded.identity());
}
