// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_FIELDS_HPP
#define PULSECAST_HELIOS_DETAIL_XML_FIELDS_HPP

#include <pulsecast/helios/detail/xml/element.hpp>
#include <pulsecast/helios/detail/xml/output.hpp>
#include <pulsecast/helios/settings.hpp>

/// Elements, in the format of HELIOS++: what the tables of settings cannot say.
namespace PULSECAST_NAMESPACE::helios::xml {

/// Reads or writes settings that their table says all of.
template <class Settings>
void fields(FieldIo& io, Settings& settings) {
  settings.fields(io);
}

/// The element that is read, or written.
[[nodiscard]] inline XmlInput& input(FieldIo& io) { return static_cast<XmlInput&>(io); }
[[nodiscard]] inline XmlOutput& output(FieldIo& io) { return static_cast<XmlOutput&>(io); }

/// Reports the `SettingError` of a check; that of a writer is the fault itself.
template <class Check>
void valid(const FieldIo& io, const Check& check) {
  if (!io.reads()) return check();
  try {
    check();
  } catch (const SettingError& wrong) {
    io.fault("", wrong.what());
  }
}

}  // namespace PULSECAST_NAMESPACE::helios::xml

#endif
