// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>
#include <variant>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/helios/detail/motion.hpp>
#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/detail/xml/fields.hpp>
#include <pulsecast/helios/settings.hpp>

/// `<dmotion>` and what it holds.
namespace pulsecast::helios::xml {

/// Whether a motion's axis or normal has a direction.
[[nodiscard]] inline bool has_direction(const Vec3& v) { return length(v) > 1e-9; }

/// A motion's axis or normal.
template <class Io>
void axis(Io& io, const char* name, Of<Io, Vec3>& v) {
  io.require({name});
  io.vector(name, v, 1e9);
}

/// Reports an axis or normal without a direction.
inline void check_axis(const XmlInput& io, const char* name, const Vec3& v) {
  if (!has_direction(v)) io.fault(name, std::string(name) + " is too short to have a direction");
}

template <class Io>
void fields(Io& io, Of<Io, MotionSettings>& motion) {
  enum class Kind { identity, translation, rotation, helical, reflection, glide_plane, rotoreflection };
  Kind kind = Kind::identity;
  if (std::holds_alternative<TranslationMotion>(motion.kind)) kind = Kind::translation;
  if (const auto* r = std::get_if<RotationMotion>(&motion.kind)) kind = r->glide ? Kind::helical : Kind::rotation;
  if (const auto* r = std::get_if<ReflectionMotion>(&motion.kind)) kind = r->shift ? Kind::glide_plane : Kind::reflection;
  if (std::holds_alternative<RotoreflectionMotion>(motion.kind)) kind = Kind::rotoreflection;
  io.require({"type"});
  io.choice("type", kind,
            {{"identity", Kind::identity},
             {"translation", Kind::translation},
             {"rotation", Kind::rotation},
             {"helical", Kind::helical},
             {"reflection", Kind::reflection},
             {"glideplane", Kind::glide_plane},
             {"rotsym", Kind::rotoreflection}});
  if constexpr (Io::reads) {
    if (kind == Kind::translation) motion.kind = TranslationMotion{};
    if (kind == Kind::rotation || kind == Kind::helical) motion.kind = RotationMotion{};
    if (kind == Kind::reflection || kind == Kind::glide_plane) motion.kind = ReflectionMotion{};
    if (kind == Kind::rotoreflection) motion.kind = RotoreflectionMotion{};
  }
  if (auto* m = std::get_if<TranslationMotion>(&motion.kind)) {
    io.require({"vec"});
    io.vector("vec", m->by, max_coordinate);
  } else if (auto* r = std::get_if<RotationMotion>(&motion.kind)) {
    axis(io, "axis", r->axis);
    io.require({"angle"});
    io.number("angle", r->angle, units::degree, -36000, 36000);
    if (kind == Kind::rotation) io.vector("center", r->center, max_coordinate);
    if (kind == Kind::helical) {
      io.require({"glide"});
      if constexpr (Io::reads) r->glide = 0;
      io.number("glide", *r->glide, units::one, -1e9, 1e9);
    }
    if constexpr (Io::reads) {
      if (!has_direction(r->axis) && r->angle == 0) {
        io.warn("axis", "axis is too short to have a direction, and angle is 0: the motion does nothing");
        motion.kind = NoMotion{};
      } else {
        check_axis(io, "axis", r->axis);
      }
    }
  } else if (auto* p = std::get_if<ReflectionMotion>(&motion.kind)) {
    axis(io, "ortho", p->normal);
    if constexpr (Io::reads) check_axis(io, "ortho", p->normal);
    if (kind == Kind::glide_plane) {
      io.require({"shift"});
      if constexpr (Io::reads) p->shift = Vec3{};
      io.vector("shift", *p->shift, max_coordinate);
      if constexpr (Io::reads)
        if (std::abs(dot(*p->shift, p->normal)) > 1e-6 * length(*p->shift) * length(p->normal))
          io.fault("shift", "shift is not along the plane: expected it at right angles to ortho");
    }
  } else if (auto* s = std::get_if<RotoreflectionMotion>(&motion.kind)) {
    axis(io, "axis", s->axis);
    if constexpr (Io::reads) check_axis(io, "axis", s->axis);
    io.require({"angle"});
    io.number("angle", s->angle, units::degree, -36000, 36000);
    io.vector("center", s->center, max_coordinate);
  }
  io.flag("selfMode", motion.about_itself);
  io.number("autoCRS", motion.shift_factor, units::one, -1e6, 1e6);
}

template <class Io>
void fields(Io& io, Of<Io, MotionSequenceSettings>& sequence) {
  io.require({"id", "loop"});
  io.text("id", sequence.id);
  io.whole("loop", sequence.loop, 0, 2'000'000'000);
  io.text("next", sequence.next);
  io.children("motion", sequence.motions, [](auto& inner, auto& motion) { fields(inner, motion); });
  if constexpr (Io::reads)
    if (const std::string problem = motion_problem(sequence); !problem.empty())
      io.report().fault(io.place(), "<dmotion id=" + xml_quoted(sequence.id) + "> cannot be done: expected " + problem);
}

}  // namespace pulsecast::helios::xml
