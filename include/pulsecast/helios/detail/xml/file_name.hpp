// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <string>

#include <pulsecast/helios/detail/xml/document.hpp>
#include <pulsecast/helios/detail/xml/element.hpp>

namespace pulsecast::helios::detail {

/// Whether a character may not stand in the name of a file.
[[nodiscard]] inline bool fits_no_name(unsigned char c) { return c == '/' || c == '\\' || c < ' ' || c == 0x7f; }

/// A text that becomes part of the name of a file or folder.
inline void fit_for_name(const XmlInput& io, const char* name, std::string& text) {
  if (std::none_of(text.begin(), text.end(), fits_no_name)) return;
  const std::string given = XmlInput::said(name, text);
  std::replace_if(text.begin(), text.end(), fits_no_name, '_');
  io.warn(name, given + " is taken as " + xml_quoted(text) + ": expected no slashes and no control characters in a part of a file name");
}

}  // namespace pulsecast::helios::detail
