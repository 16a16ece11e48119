// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PULSE_FORM_HPP
#define PULSECAST_IO_PULSE_FORM_HPP

#include <filesystem>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/detector/pulse_form.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Reads a measured laser pulse: a text of two columns, time [ns] from any origin and power in any unit, by increasing
/// time. `#` begins a comment, and a first row without numbers is a header. Powers below 0, such as noise about a
/// baseline, count as 0. Throws a `FileError` with path and line at the first error.
[[nodiscard]] MeasuredPulse read_pulse_form(const std::filesystem::path& path);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINITIONS
#include <pulsecast/io/detail/pulse_form_reader.hpp>
#endif

#endif
