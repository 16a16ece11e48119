// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PULSECAST_HPP
#define PULSECAST_PULSECAST_HPP

/// The contract, the pipeline, and the models of most surveys: triangle meshes, mirrors and heads, tripods and straight
/// lines, every footprint, two detectors, a cloud in memory. Include all else by name: other shapes, accelerators and
/// optics, moving parts, trajectories by waypoints or by planners, pose errors, the analytic detector.

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
#include <pulsecast/version.hpp>

#if defined(PULSECAST_COMPILED)
#include <pulsecast/detail/usual_types.hpp>
#endif

#endif
