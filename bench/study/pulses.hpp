// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
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

  /// The same, each rolled about its axis by a random angle.
  [[nodiscard]] Pulses rolled(std::uint64_t seed) const {
    std::vector<Pulse<frame::World>> all = *all_;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double turn = 2 * pi * uniform({.seed = seed, .pulse = i, .subray = 0, .purpose = Purpose{128}});
      all[i].pose.rotation = all[i].pose.rotation * rotation_about(axis::forward, turn);
    }
    return {std::move(all), emitters_};
  }

 private:
  std::shared_ptr<const std::vector<Pulse<frame::World>>> all_ =
      std::make_shared<const std::vector<Pulse<frame::World>>>();
  std::vector<Emitter> emitters_;
};

static_assert(WorldSource<Pulses>);

/// Runs of slots that follow each other, from everywhere in a survey: `each` slots with a pulse for which `wanted` is
/// true.
template <WorldSource Source, class Wanted>
[[nodiscard]] std::vector<Pulses> runs_of(const Source& source, std::size_t runs, std::size_t each, Wanted wanted) {
  std::vector<Pulses> all;
  for (std::size_t run = 0; run < runs; ++run) {
    std::vector<Pulse<frame::World>> pulses;
    const PulseIndex end = source.size() * (run + 1) / runs;
    for (PulseIndex i = source.size() * run / runs; i < end && pulses.size() < each; ++i)
      if (const auto pulse = source.pulse(i); pulse && wanted(*pulse)) pulses.push_back(*pulse);
    if (!pulses.empty()) all.emplace_back(std::move(pulses), source.emitters());
  }
  return all;
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
