// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_MOTION_HPP
#define PULSECAST_HELIOS_DETAIL_XML_MOTION_HPP

#include <cmath>
#include <string>
#include <variant>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/helios/detail/motion.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>
#include <pulsecast/helios/settings.hpp>

/// `<dmotion>` and its children.
namespace PULSECAST_NAMESPACE::helios::xml {

/// True if a motion's axis or normal has a direction.
[[nodiscard]] inline bool has_direction(const Vec3& v) { return length(v) > 1e-9; }

/// Axis or normal of a motion.
inline void axis(FieldIo& io, const char* name, Vec3& v) {
  io.require({name});
  io.vector(name, v, 1e9);
}

/// Reports an axis or normal without a direction.
inline void check_axis(const FieldIo& io, const char* name, const Vec3& v) {
  if (!has_direction(v)) io.fault(name, std::string(name) + " is too short for a direction");
}

enum class MotionKind { identity, translation, rotation, helical, reflection, glide_plane, rotoreflection };

inline MotionKind kind_of(const MotionSettings& motion) {
  if (std::holds_alternative<TranslationMotion>(motion.kind)) return MotionKind::translation;
  if (const auto* r = std::get_if<RotationMotion>(&motion.kind))
    return r->glide ? MotionKind::helical : MotionKind::rotation;
  if (const auto* r = std::get_if<ReflectionMotion>(&motion.kind))
    return r->shift ? MotionKind::glide_plane : MotionKind::reflection;
  return std::holds_alternative<RotoreflectionMotion>(motion.kind) ? MotionKind::rotoreflection : MotionKind::identity;
}

/// Sets the kind of a motion before it is read. Identities keep their kind.
inline void set_kind(MotionSettings& motion, MotionKind kind) {
  if (kind == MotionKind::translation) motion.kind = TranslationMotion{};
  if (kind == MotionKind::rotation || kind == MotionKind::helical) motion.kind = RotationMotion{};
  if (kind == MotionKind::reflection || kind == MotionKind::glide_plane) motion.kind = ReflectionMotion{};
  if (kind == MotionKind::rotoreflection) motion.kind = RotoreflectionMotion{};
}

/// Rotation; false if it has no effect: the axis has no direction and the angle is 0.
inline bool rotation_fields(FieldIo& io, RotationMotion& rotation, MotionKind kind) {
  axis(io, "axis", rotation.axis);
  io.require({"angle"});
  io.number("angle", rotation.angle, units::degree, -36000, 36000);
  if (kind == MotionKind::rotation) io.vector("center", rotation.center, FieldIo::max_coordinate);
  if (kind == MotionKind::helical) {
    io.require({"glide"});
    if (io.reads()) rotation.glide = 0;
    io.number("glide", *rotation.glide, units::one, -1e9, 1e9);
  }
  if (!has_direction(rotation.axis) && rotation.angle == 0) {
    io.warn("axis", "axis is too short for a direction, and angle is 0: the motion does nothing");
    return false;
  }
  check_axis(io, "axis", rotation.axis);
  return true;
}

inline void reflection_fields(FieldIo& io, ReflectionMotion& plane, MotionKind kind) {
  axis(io, "ortho", plane.normal);
  check_axis(io, "ortho", plane.normal);
  if (kind != MotionKind::glide_plane) return;
  io.require({"shift"});
  if (io.reads()) plane.shift = Vec3{};
  io.vector("shift", *plane.shift, FieldIo::max_coordinate);
  if (std::abs(dot(*plane.shift, plane.normal)) > 1e-6 * length(*plane.shift) * length(plane.normal))
    io.fault("shift", "shift is not along the plane: expected it at right angles to ortho");
}

inline void fields(FieldIo& io, MotionSettings& motion) {
  MotionKind kind = kind_of(motion);
  io.require({"type"});
  io.choice("type", kind,
            {{"identity", MotionKind::identity},
             {"translation", MotionKind::translation},
             {"rotation", MotionKind::rotation},
             {"helical", MotionKind::helical},
             {"reflection", MotionKind::reflection},
             {"glideplane", MotionKind::glide_plane},
             {"rotsym", MotionKind::rotoreflection}});
  if (io.reads()) set_kind(motion, kind);
  if (auto* m = std::get_if<TranslationMotion>(&motion.kind)) {
    io.require({"vec"});
    io.vector("vec", m->by, FieldIo::max_coordinate);
  } else if (auto* r = std::get_if<RotationMotion>(&motion.kind)) {
    const bool does_something = rotation_fields(io, *r, kind);
    if (io.reads() && !does_something) motion.kind = NoMotion{};
  } else if (auto* p = std::get_if<ReflectionMotion>(&motion.kind)) {
    reflection_fields(io, *p, kind);
  } else if (auto* s = std::get_if<RotoreflectionMotion>(&motion.kind)) {
    axis(io, "axis", s->axis);
    check_axis(io, "axis", s->axis);
    io.require({"angle"});
    io.number("angle", s->angle, units::degree, -36000, 36000);
    io.vector("center", s->center, FieldIo::max_coordinate);
  }
  io.flag("selfMode", motion.about_itself);
  io.number("autoCRS", motion.shift_factor, units::one, -1e6, 1e6);
}

inline void fields(FieldIo& io, MotionSequenceSettings& sequence) {
  sequence.fields(io);
  io.children("motion", sequence.motions, [](FieldIo& inner, MotionSettings& motion) { fields(inner, motion); });
  if (const std::string problem = motion_problem(sequence); !problem.empty())
    io.fault("", "<dmotion id=" + text::quoted(sequence.id) + "> is not supported: expected " + problem);
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

#endif
