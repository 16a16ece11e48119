// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_DETECTOR_FIRST_HIT_HPP
#define PULSECAST_DETECTOR_FIRST_HIT_HPP

#include <pulsecast/detector/detail/pulse_sum.hpp>

namespace PULSECAST_NAMESPACE {

/// Detector of the nearest reflection at its exact range, without a waveform. It does not detect
/// fog, whose continuous returns have no power at any one range, but what fog leaves of surfaces.
struct FirstHit {
  using refinements = refines<tag::Validated>;
  double threshold = 0;  ///< minimum detectable power [W]

  void validate() const { require_not_negative("FirstHit::threshold", threshold, "W"); }

  struct Workspace {
    Echo echo;  ///< echo of the current pulse
  };

  [[nodiscard]] Workspace workspace(std::size_t) const { return {}; }

  [[nodiscard]] Detection detect(const DetectorInput& input, Workspace& workspace) const noexcept {
    const Reflection* first = nullptr;
    for (const Reflection& r : input.reflections)
      if (r.power >= threshold && (!first || r.range < first->range)) first = &r;
    if (!first) return {};
    workspace.echo = echo_from(*first, first->range, first->power);
    return {{&workspace.echo, 1}, {}, 0};
  }
};

}  // namespace PULSECAST_NAMESPACE

#endif
