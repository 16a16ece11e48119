// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_FIELDS_HPP
#define PULSECAST_HELIOS_DETAIL_XML_FIELDS_HPP

#include <limits>
#include <string>
#include <type_traits>

#include <pulsecast/base/vector.hpp>
#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/settings.hpp>

/// Descriptions of all elements, here and in the headers that include this one: attributes with units and limits, and
/// children. The format is that of HELIOS++.
namespace PULSECAST_NAMESPACE::helios::xml {

/// Settings that are read into or written from.
template <class Io, class Settings>
using Of = std::conditional_t<Io::reads, Settings, const Settings>;

inline constexpr double any = std::numeric_limits<double>::infinity();
inline constexpr double max_coordinate = 1e9;  ///< maximum plausible coordinate [m]

/// Attributes `x`, `y` and `z`.
template <class Io>
void components(Io& io, Of<Io, Vec3>& v, double largest = max_coordinate) {
  io.number("x", v.x, units::metre, -largest, largest);
  io.number("y", v.y, units::metre, -largest, largest);
  io.number("z", v.z, units::metre, -largest, largest);
}

/// Child with the components of a direction.
template <class Io>
void direction(Io& io, const char* name, Of<Io, Vec3>& v) {
  if constexpr (!Io::reads)
    if (!(length(v) > 0)) io.fault(name, std::string(name) + " has no direction");
  io.child(name, [&](auto& inner) {
    if constexpr (Io::reads) {
      Vec3 found{};
      components(inner, found);
      if (length(found) > 0.1) {
        v = found;
      } else {
        inner.report().warn(inner.place(), "<" + std::string(name) + "> is shorter than 0.1 and has no effect");
      }
    } else {
      components(inner, length(v) > 0.1 ? v : normalize(v));
    }
  });
}

template <class Io>
void fields(Io& io, Of<Io, AxisTurn>& turn) {
  io.require({"axis", "angle_deg"});
  io.choice("axis", turn.axis, {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}});
  io.number("angle_deg", turn.angle, units::degree, -36000, 36000);
}

/// `rotations` and the `<rot>` children.
template <class Io>
void fields(Io& io, Of<Io, RotationList>& list) {
  io.choice("rotations", list.local, {{"global", false}, {"local", true}});
  io.children("rot", list.turns, [](auto& inner, auto& turn) { fields(inner, turn); });
}

template <class Io>
void fields(Io& io, Of<Io, MountSettings>& mount) {
  if constexpr (Io::reads) mount = {};
  components(io, mount.position);
  fields(io, mount.rotation);
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

#endif
