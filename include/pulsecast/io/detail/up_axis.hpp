// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_UP_AXIS_HPP
#define PULSECAST_IO_DETAIL_UP_AXIS_HPP

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Vertical axis of a file.
enum class UpAxis : std::uint8_t {
  z,  ///< coordinates unchanged
  y,  ///< (x, y, z) becomes (x, -z, y)
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
