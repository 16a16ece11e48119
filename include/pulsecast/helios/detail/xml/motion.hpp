// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_MOTION_HPP
#define PULSECAST_HELIOS_DETAIL_XML_MOTION_HPP

#include <pulsecast/helios/detail/motion.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>

/// `<dmotion>` and its children.
namespace PULSECAST_NAMESPACE::helios::xml {

[[nodiscard]] inline bool has_direction(const Vec3& v) { return length(v) > 1e-9; }

/// Axis or normal of a motion.
inline void axis(FieldIo& io, const char* name, Vec3& v) {
  io.require({name});
  io.vector(name, v, 1e9);
  if (!has_direction(v)) io.fault(name, std::string(name) + " is too short for a direction");
}

inline void angle(FieldIo& io, double& value) {
  io.require({"angle"});
  io.number("angle", value, units::degree, -36000, 36000);
}

inline void fields(FieldIo& /*io*/, NoMotion& /*motion*/) {}

inline void fields(FieldIo& io, TranslationMotion& motion) {
  io.require({"vec"});
  io.vector("vec", motion.by, FieldIo::max_coordinate);
}

inline void fields(FieldIo& io, RotationMotion& rotation) {
  io.require({"axis"});
  io.vector("axis", rotation.axis, 1e9);
  angle(io, rotation.angle);
  if (rotation.glide) {
    io.require({"glide"});
    io.number("glide", *rotation.glide, units::one, -1e9, 1e9);
  } else {
    io.vector("center", rotation.center, FieldIo::max_coordinate);
  }
  if (has_direction(rotation.axis)) return;
  if (rotation.angle != 0) return io.fault("axis", "axis is too short for a direction");
  io.warn("axis", "axis is too short for a direction, and angle is 0: the motion does nothing");
}

inline void fields(FieldIo& io, ReflectionMotion& plane) {
  axis(io, "ortho", plane.normal);
  if (!plane.shift) return;
  io.require({"shift"});
  io.vector("shift", *plane.shift, FieldIo::max_coordinate);
  if (std::abs(dot(*plane.shift, plane.normal)) > 1e-6 * length(*plane.shift) * length(plane.normal))
    io.fault("shift", "shift is not along the plane: expected it at right angles to ortho");
}

inline void fields(FieldIo& io, RotoreflectionMotion& motion) {
  axis(io, "axis", motion.axis);
  angle(io, motion.angle);
  io.vector("center", motion.center, FieldIo::max_coordinate);
}

inline void fields(FieldIo& io, MotionSettings& motion) {
  static const std::array<decltype(motion.kind), 7> kinds{NoMotion{},
                                                          TranslationMotion{},
                                                          RotationMotion{},
                                                          RotationMotion{.glide = 0},
                                                          ReflectionMotion{},
                                                          ReflectionMotion{.shift = Vec3{}},
                                                          RotoreflectionMotion{}};
  const auto* const rotation = std::get_if<RotationMotion>(&motion.kind);
  const auto* const plane = std::get_if<ReflectionMotion>(&motion.kind);
  const bool shifts = (rotation && rotation->glide) || (plane && plane->shift);
  std::size_t kind = 0;
  while (kinds[kind].index() != motion.kind.index()) ++kind;
  kind += shifts ? 1 : 0;
  io.require({"type"});
  io.choice("type", kind,
            {{"identity", 0},
             {"translation", 1},
             {"rotation", 2},
             {"helical", 3},
             {"reflection", 4},
             {"glideplane", 5},
             {"rotsym", 6}});
  if (io.reads()) motion.kind = kinds[kind];
  std::visit([&](auto& of_kind) { fields(io, of_kind); }, motion.kind);
  const auto* const turn = std::get_if<RotationMotion>(&motion.kind);
  if (io.reads() && turn && turn->angle == 0 && !has_direction(turn->axis)) motion.kind = NoMotion{};
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
