// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/pulsecast.hpp>

namespace tradeoff {

using namespace pulsecast;

/// Pulses made beforehand: all settings of a scenario get the same ones, and no time includes making them.
class Pulses {
 public:
  Pulses() = default;
  Pulses(std::vector<Pulse<frame::World>> all, std::vector<Emitter> emitters)
      : all_(std::make_shared<const std::vector<Pulse<frame::World>>>(std::move(all))),
        emitters_(std::move(emitters)) {}

  [[nodiscard]] PulseIndex size() const noexcept { return all_->size(); }
  [[nodiscard]] Tick duration() const noexcept { return all_->back().tick; }
  [[nodiscard]] std::vector<Emitter> emitters() const { return emitters_; }
  [[nodiscard]] std::optional<Pulse<frame::World>> pulse(PulseIndex i) const noexcept { return (*all_)[i]; }

 private:
  std::shared_ptr<const std::vector<Pulse<frame::World>>> all_ =
      std::make_shared<const std::vector<Pulse<frame::World>>>();
  std::vector<Emitter> emitters_;
};

static_assert(WorldSource<Pulses>);

/// Consecutive slots, as in a survey, so that pulses share the contents of the caches.
inline constexpr std::size_t run_length = 32;

/// As many pulses of a survey: runs from everywhere in it, of those slots with a pulse for which `wanted` is true.
template <WorldSource Source, class Wanted>
[[nodiscard]] Pulses sampled(const Source& source, std::size_t count, Wanted wanted) {
  std::vector<Pulse<frame::World>> all;
  const std::size_t runs = count / run_length;
  for (std::size_t run = 0; run < runs; ++run) {
    const PulseIndex end = source.size() * (run + 1) / runs;
    for (PulseIndex i = source.size() * run / runs; i < end && all.size() < (run + 1) * run_length; ++i) {
      const auto pulse = source.pulse(i);
      if (!pulse || !wanted(*pulse)) continue;
      all.push_back(*pulse);
    }
  }
  return Pulses(std::move(all), source.emitters());
}

template <WorldSource Source>
[[nodiscard]] Pulses sampled(const Source& source, std::size_t count) {
  return sampled(source, count, [](const Pulse<frame::World>&) { return true; });
}

/// Any footprint, copied: all kinds are one type.
class Pattern {
 public:
  template <Footprint F>
  Pattern(std::string kind, const F& footprint) : kind_(std::move(kind)) {
    for (std::size_t j = 0; j < footprint.size(); ++j) {
      offsets_.push_back(footprint.offset(j));
      shares_.push_back(footprint.share(j));
    }
  }

  [[nodiscard]] const std::string& kind() const noexcept { return kind_; }
  [[nodiscard]] std::size_t size() const noexcept { return offsets_.size(); }
  [[nodiscard]] Vec2 offset(std::size_t j) const noexcept { return offsets_[j]; }
  [[nodiscard]] double share(std::size_t j) const noexcept { return shares_[j]; }

  /// The same, turned about the axis [rad].
  [[nodiscard]] Pattern turned(double angle) const {
    Pattern other = *this;
    const double c = std::cos(angle), s = std::sin(angle);
    for (Vec2& offset : other.offsets_) offset = {c * offset.x - s * offset.y, s * offset.x + c * offset.y};
    return other;
  }

 private:
  std::string kind_;
  std::vector<Vec2> offsets_;
  std::vector<double> shares_;
};

static_assert(Footprint<Pattern>);

[[nodiscard]] inline Pattern rings(std::size_t circles) { return {"rings", RingFootprint(circles)}; }
[[nodiscard]] inline Pattern sunflower(std::size_t subrays) { return {"sunflower", SunflowerFootprint(subrays)}; }
[[nodiscard]] inline Pattern lattice(std::size_t subrays) { return {"lattice", LatticeFootprint(subrays)}; }

}  // namespace tradeoff
