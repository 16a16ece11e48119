// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PULSECAST_HPP
#define PULSECAST_PULSECAST_HPP

/// The contract, the pipeline, and the models of most surveys: triangle meshes, mirrors and heads, tripods and straight
/// lines, every footprint, two detectors, a cloud in memory. Include all else by name: other shapes, accelerators and
/// optics, moving parts, trajectories by waypoints or by planners, pose errors, the analytic detector.

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/base/error.hpp>
#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/random.hpp>
#include <pulsecast/base/rotation_list.hpp>
#include <pulsecast/base/tick.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/cloud.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/fixed_beam.hpp>
#include <pulsecast/deflector/oscillating_mirror.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/radiometry.hpp>
#include <pulsecast/echo.hpp>
#include <pulsecast/material/material.hpp>
#include <pulsecast/material/spectrum.hpp>
#include <pulsecast/platform/legs.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/straight_line.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/pulse.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/channels.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/part.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/survey.hpp>
#include <pulsecast/transport/direct_light.hpp>
#include <pulsecast/transport/echo_simulator.hpp>
#include <pulsecast/version.hpp>

// Templates for usual arguments, which `pulsecast::compiled` has: a program that links it does not compile them.
#if defined(PULSECAST_COMPILED)
#if PULSECAST_DEFINES(PULSECAST)
#define PULSECAST_USUAL template
#else
#define PULSECAST_USUAL extern template
#endif
namespace PULSECAST_NAMESPACE {

PULSECAST_USUAL class TriangleMesh<>;
PULSECAST_USUAL class TriangleMesh<Bvh<float>, detail::MaskTable>;
PULSECAST_USUAL class Scene<TriangleMesh<>>;
PULSECAST_USUAL class EchoSimulator<SingleRay, Scene<TriangleMesh<>>, FirstHit>;
PULSECAST_USUAL class EchoSimulator<SingleRay, Scene<TriangleMesh<>>, FullWaveform<>>;
PULSECAST_USUAL class EchoSimulator<LatticeFootprint, Scene<TriangleMesh<>>, FirstHit>;
PULSECAST_USUAL class EchoSimulator<LatticeFootprint, Scene<TriangleMesh<>>, FullWaveform<>>;

namespace detail {
using TripodScanner = Platform<Tripod, Deflector<RotatingHead, Deflector<PolygonMirror, Scanner>>>;
using TripodSurvey = Survey<TripodScanner, LatticeFootprint, Scene<TriangleMesh<>>, FullWaveform<>>;
}  // namespace detail
PULSECAST_USUAL class Platform<Tripod, Deflector<RotatingHead, Deflector<PolygonMirror, Scanner>>>;
PULSECAST_USUAL class Survey<detail::TripodScanner, LatticeFootprint, Scene<TriangleMesh<>>, FullWaveform<>>;
PULSECAST_USUAL RunSummary run(const detail::TripodSurvey&, const RunOptions&, Cloud&);

}  // namespace PULSECAST_NAMESPACE

#undef PULSECAST_USUAL
#endif

#endif
