// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_PULSE_FORM_HPP
#define PULSECAST_IO_PULSE_FORM_HPP

#include <filesystem>

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/detector/pulse_form.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Reads a measured laser pulse: a text of two columns, time [ns] from any origin, ascending, and
/// power in any unit. `#` begins a comment, and a first row without numbers is a header. Powers
/// below 0, as of noise, count as 0. Throws a `FileError` with path and line at the first error.
[[nodiscard]] MeasuredPulse read_pulse_form(const std::filesystem::path& path);

}  // namespace PULSECAST_NAMESPACE::io

#if PULSECAST_DEFINES(IO_PULSE_FORM)
#include <algorithm>
#include <cmath>

#include <pulsecast/io/detail/text/table.hpp>

namespace PULSECAST_NAMESPACE::io {

PULSECAST_INLINE MeasuredPulse read_pulse_form(const std::filesystem::path& path) {
  TextTable table(path, "a laser pulse, time [ns] and power");
  std::vector<PulseSample> samples;
  bool first = true;
  while (table.next()) {
    if (table.text().starts_with('#')) continue;
    const std::vector<std::string_view>& cells = table.cells();
    if (cells.size() != 2)
      table.fail_here("has " + std::to_string(cells.size()) + " columns: expected time [ns] and power");
    const std::optional time = text::finite_number_in(cells[0]), power = text::finite_number_in(cells[1]);
    if (std::exchange(first, false) && !time && !power) continue;  // a header
    const auto fail = [&](std::size_t column, const char* expected) {
      table.fail_here(column, text::quoted(cells[column]) + ": expected a " + expected);
    };
    if (!time || !power) fail(time ? 1 : 0, "finite number");
    if (!(std::fabs(*time) <= 1e9)) fail(0, "time within 1e9 ns");
    if (!samples.empty() && !(*time * 1e-9 > samples.back().time))
      table.fail_here(0, "is not later than the row before");
    samples.push_back({*time * 1e-9, std::max(*power, 0.0)});
  }
  const bool lit = std::ranges::any_of(samples, [](const PulseSample& s) { return s.power > 0; });
  if (samples.size() < 2 || !lit)
    table.fail("has no pulse: expected two rows at least, of time [ns] and power, and some power above 0");
  return MeasuredPulse(std::move(samples));
}

}  // namespace PULSECAST_NAMESPACE::io

#endif

#endif
