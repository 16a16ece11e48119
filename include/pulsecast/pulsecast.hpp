// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

/// Everything but the adapters.

#include <pulsecast/accel/bvh.hpp>
#include <pulsecast/accel/kd_tree.hpp>
#include <pulsecast/accel/linear.hpp>
#include <pulsecast/accel/sah.hpp>
#include <pulsecast/base/error.hpp>
#include <pulsecast/base/expect.hpp>
#include <pulsecast/base/frame.hpp>
#include <pulsecast/base/lanes.hpp>
#include <pulsecast/base/random.hpp>
#include <pulsecast/base/tick.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/base/vector.hpp>
#include <pulsecast/cloud.hpp>
#include <pulsecast/concepts.hpp>
#include <pulsecast/deflector/deflector.hpp>
#include <pulsecast/deflector/polygon_mirror.hpp>
#include <pulsecast/deflector/rotating_head.hpp>
#include <pulsecast/detector/echo_width.hpp>
#include <pulsecast/detector/first_hit.hpp>
#include <pulsecast/detector/full_waveform.hpp>
#include <pulsecast/detector/pulse_shape.hpp>
#include <pulsecast/detector/radiometry.hpp>
#include <pulsecast/echo.hpp>
#include <pulsecast/geometry/box.hpp>
#include <pulsecast/geometry/bundle.hpp>
#include <pulsecast/geometry/bundle_interval.hpp>
#include <pulsecast/geometry/ray.hpp>
#include <pulsecast/geometry/triangle.hpp>
#include <pulsecast/platform/legs.hpp>
#include <pulsecast/platform/platform.hpp>
#include <pulsecast/platform/pose_errors.hpp>
#include <pulsecast/platform/tripod.hpp>
#include <pulsecast/pulse.hpp>
#include <pulsecast/run.hpp>
#include <pulsecast/scanner/footprint.hpp>
#include <pulsecast/scanner/scanner.hpp>
#include <pulsecast/scene/material.hpp>
#include <pulsecast/scene/part.hpp>
#include <pulsecast/scene/scene.hpp>
#include <pulsecast/scene/triangle_mesh.hpp>
#include <pulsecast/survey.hpp>
#include <pulsecast/version.hpp>
