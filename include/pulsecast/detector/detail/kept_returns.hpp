// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_DETAIL_KEPT_RETURNS_HPP
#define PULSECAST_DETECTOR_DETAIL_KEPT_RETURNS_HPP

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE {

/// Returns that are kept where a pulse has more than an instrument reports.
enum class KeptReturns : std::uint8_t {
  first,      ///< the nearest; those of the air only where there is room, so that no target is lost to fog or rain
  strongest,  ///< those of the greatest amplitude; the nearest of equals
};

}  // namespace PULSECAST_NAMESPACE

#endif
