// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_PULSE_ROWS_HPP
#define PULSECAST_PYTHON_DETAIL_PULSE_ROWS_HPP

#include <pybind11/numpy.h>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::python {

/// Pulse sent, as a row of a NumPy array. Signed, as NumPy makes fractions of unsigned numbers.
struct PulseRow {
  std::int64_t pulse;                            ///< number of the slot
  double time;                                   ///< departure, since the survey's start [s]
  double x, y, z;                                ///< origin in the world [m]
  double direction_x, direction_y, direction_z;  ///< unit direction in the world
  double scan_angle;                             ///< as in `Pulse` [rad]
  double waveform_start;                         ///< two-way travel time of the first sample [s]
  std::int64_t first_sample, first_point;        ///< indices into the other arrays
  std::uint32_t samples, points;                 ///< numbers of samples and points
  std::uint16_t leg;                             ///< number of the leg, from 0
  std::uint16_t channel;                         ///< number of the emitter, from 0
  std::uint8_t fate;                             ///< as in `Fate`
  std::uint8_t spare[3]{};                       ///< zeros outside the array
};

/// Declares the rows to NumPy, in one registry for all modules.
[[gnu::visibility("hidden")]] inline void bind_rows() {
  if (pybind11::detail::get_numpy_internals().get_type_info<PulseRow>(false)) return;
  PYBIND11_NUMPY_DTYPE(PulseRow, pulse, time, x, y, z, direction_x, direction_y, direction_z, scan_angle,
                       waveform_start, first_sample, first_point, samples, points, leg, channel, fate);
}

}  // namespace PULSECAST_NAMESPACE::python

#endif
