// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_HELIOS_DETAIL_XML_FILE_NAME_HPP
#define PULSECAST_HELIOS_DETAIL_XML_FILE_NAME_HPP

#include <algorithm>
#include <string>

#include <pulsecast/helios/detail/xml/document.hpp>
#include <pulsecast/helios/detail/xml/element.hpp>

namespace PULSECAST_NAMESPACE::helios::detail {

/// True if a character is forbidden in a file name.
[[nodiscard]] inline bool fits_no_name(unsigned char c) { return c == '/' || c == '\\' || c < ' ' || c == 0x7f; }

/// Replaces forbidden characters in a part of a file or folder name, with a warning.
inline void fit_for_name(const XmlInput& io, const char* name, std::string& text) {
  if (std::none_of(text.begin(), text.end(), fits_no_name)) return;
  const std::string given = XmlInput::said(name, text);
  std::replace_if(text.begin(), text.end(), fits_no_name, '_');
  io.warn(name, given + " is taken as " + text::quoted(text) +
                    ": expected no slashes and no control characters in a part of a file name");
}

}  // namespace PULSECAST_NAMESPACE::helios::detail

#endif
