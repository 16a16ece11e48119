// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PYTHON_DETAIL_POINT_ROWS_HPP
#define PULSECAST_PYTHON_DETAIL_POINT_ROWS_HPP

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstdint>
#include <tuple>

#include <pulsecast/concepts.hpp>

namespace PULSECAST_NAMESPACE::python {

/// Echo as a row of a NumPy array, named as in point clouds. Numbers for calculation are signed, as NumPy makes
/// fractions of unsigned ones.
struct PointRow {
  double x, y, z;                  ///< position in the world [m]
  double time;                     ///< departure of its pulse, since the survey's start [s]
  double range;                    ///< range along the pulse's axis [m]
  float intensity;                 ///< received power at the echo's peak [W]
  float reflectance;               ///< as in `Echo`
  float echo_width;                ///< standard deviation in time; 0 if not requested, NaN if none was found [s]
  float cos_incidence;             ///< of the strongest contributor
  std::int64_t pulse;              ///< number of the pulse slot
  std::uint32_t object;            ///< of the strongest contributor
  std::uint16_t classification;    ///< of the strongest contributor
  std::uint16_t leg;               ///< number of the leg, from 0
  std::uint8_t return_number;      ///< return number, from 1 in order of range
  std::uint8_t number_of_returns;  ///< returns of its pulse, 255 if more
  std::uint16_t channel;           ///< number of the emitter, from 0
  std::uint8_t kind;               ///< way of its light, by number: `ReflectionKind`
  std::uint8_t spare[3]{};         ///< zeros outside the array, so that equal rows have equal bytes
};

/// Pulse sent, as a row of a NumPy array.
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

}  // namespace PULSECAST_NAMESPACE::python

// hidden, as pybind11's own names, so that modules of different builds can coexist
namespace PULSECAST_NAMESPACE {
namespace [[gnu::visibility("hidden")]] python {

/// Row of an echo.
[[nodiscard]] inline PointRow point_row(const Shot& s, const Echo& e) noexcept {
  const Vec3 p = point_of(s, e);
  return {p.x,
          p.y,
          p.z,
          s.tick.seconds(),
          e.range,
          static_cast<float>(e.amplitude),
          static_cast<float>(e.reflectance),
          static_cast<float>(e.width),
          static_cast<float>(e.cos_incidence),
          static_cast<std::int64_t>(s.index),
          e.object,
          e.classification,
          s.leg,
          e.number,
          static_cast<std::uint8_t>(std::min<std::uint32_t>(255, s.echoes)),
          s.channel,
          static_cast<std::uint8_t>(e.kind)};
}

/// Column of points: a member of their rows.
template <class T>
struct PointMember {
  using Number = T;     ///< type of its numbers
  const char* name;     ///< name in the arrays
  T PointRow::*member;  ///< number of a row
};
template <class T>
PointMember(const char*, T PointRow::*) -> PointMember<T>;

/// Columns of points, in order.
inline constexpr std::tuple point_members{PointMember{"x", &PointRow::x},
                                          PointMember{"y", &PointRow::y},
                                          PointMember{"z", &PointRow::z},
                                          PointMember{"time", &PointRow::time},
                                          PointMember{"range", &PointRow::range},
                                          PointMember{"intensity", &PointRow::intensity},
                                          PointMember{"reflectance", &PointRow::reflectance},
                                          PointMember{"echo_width", &PointRow::echo_width},
                                          PointMember{"cos_incidence", &PointRow::cos_incidence},
                                          PointMember{"pulse", &PointRow::pulse},
                                          PointMember{"object", &PointRow::object},
                                          PointMember{"classification", &PointRow::classification},
                                          PointMember{"leg", &PointRow::leg},
                                          PointMember{"return_number", &PointRow::return_number},
                                          PointMember{"number_of_returns", &PointRow::number_of_returns},
                                          PointMember{"channel", &PointRow::channel},
                                          PointMember{"kind", &PointRow::kind}};

/// Declares the rows to NumPy, in one registry for all modules.
inline void bind_rows() {
  if (pybind11::detail::get_numpy_internals().get_type_info<PointRow>(false)) return;
  PYBIND11_NUMPY_DTYPE(PointRow, x, y, z, time, range, intensity, reflectance, echo_width, cos_incidence, pulse, object,
                       classification, leg, return_number, number_of_returns, channel, kind);
  PYBIND11_NUMPY_DTYPE(PulseRow, pulse, time, x, y, z, direction_x, direction_y, direction_z, scan_angle,
                       waveform_start, first_sample, first_point, samples, points, leg, channel, fate);
}

}  // namespace gnu::visibility("hidden")]]python
}  // namespace PULSECAST_NAMESPACE

#endif
