// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETAIL_USUAL_TYPES_HPP
#define PULSECAST_DETAIL_USUAL_TYPES_HPP

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/cloud.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/shape/triangle_mesh.hpp>
#include <pulsecast/survey.hpp>
#include <pulsecast/transport/echo_simulator.hpp>

/// Templates for usual arguments, which `pulsecast::compiled` has: a program that links it does not compile them.
#if PULSECAST_DEFINES(DETAIL_USUAL_TYPES)
#define PULSECAST_USUAL template
#else
#define PULSECAST_USUAL extern template
#endif

namespace PULSECAST_NAMESPACE {

PULSECAST_USUAL class TriangleMesh<>;
PULSECAST_USUAL class TriangleMesh<Bvh<float>, MaskTable>;
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
