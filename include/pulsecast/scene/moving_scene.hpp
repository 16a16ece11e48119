// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include <pulsecast/scene/motion.hpp>
#include <pulsecast/scene/moving_index.hpp>
#include <pulsecast/scene/scene.hpp>

namespace pulsecast {

/// A scene of which some parts move: `MovingScene<TriangleMesh<>> scene(parts, {.to = 60})`. Each pulse meets every part where it is at the
/// pulse's own tick; a motion comes on top of the placement. Parts without a motion cost what they cost in a `Scene`, and a program whose
/// scenes all stand still holds none of this.
template <Geometry... Shapes>
class MovingScene {
 public:
  using Part = pulsecast::Part<Shapes...>;

  /// `time` should span the survey, and little more: the longer it is, the longer its windows get. At other times the answer is the same,
  /// but all moving parts are tested.
  MovingScene(std::vector<Part> parts, const MovingIndexSettings& time)
      : scene_(std::move(parts), Scene<Shapes...>::Motions::left_out),
        movers_(movers(scene_.parts())),
        index_(movers_.size(), time, [this](PrimitiveIndex i, const Tick& from, const Tick& to) { return swept(movers_[i], from, to); }) {
    bounds_ = scene_.bounds();
    bounds_.extend(index_.bounds());
  }

  /// Of all parts, wherever they come in the time.
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }
  [[nodiscard]] std::span<const Part> parts() const noexcept { return scene_.parts(); }

  /// Memory held, with all that parts share counted once [byte].
  [[nodiscard]] std::size_t memory() const {
    std::size_t bytes = scene_.memory() + index_.memory() + movers_.capacity() * sizeof(Mover);
    std::set<const void*> counted;
    for (const Mover& mover : movers_) {
      const PartMotion* motion = parts()[mover.part].motion.get();
      bytes += counted.insert(motion).second ? motion->memory() : 0;
    }
    return bytes;
  }

  /// Where a part is at a time.
  [[nodiscard]] Similarity placement(std::size_t part, const Tick& tick) const noexcept {
    const Part& moving = parts()[part];
    if (!moving.motion) return moving.placement;
    const auto before = [](const Mover& m, std::size_t p) { return m.part < p; };
    return moved(*std::lower_bound(movers_.begin(), movers_.end(), part, before), tick);
  }

  /// What each ray of the bundle meets first at its tick. The tie between parts goes to the first in the list, moving or not.
  void closest(const RayBundle& rays, std::span<Hit> hits) const noexcept {
    ClosestHits nearest = scene_.nearest(rays);
    const auto test = [&](PrimitiveIndex i) noexcept { scene_.closest_in(movers_[i].part, moved(movers_[i], rays.tick), rays, nearest); };
    index_.closest(rays, test, nearest);
    scene_.describe(rays, nearest, hits, [&](std::size_t part) noexcept { return placement(part, rays.tick); });
  }

  /// The height of the ground at a place, as of `Scene`; what moves is no ground.
  [[nodiscard]] std::optional<double> ground_height(const Vec2& at) const noexcept { return scene_.ground_height(at); }

 private:
  /// A part that moves.
  struct Mover {
    std::size_t part;
    Vec3 centre;  ///< of its box as placed [m]
  };

  static Box bounds_of(const Part& part) noexcept {
    return std::visit([](const auto& shape) noexcept { return shape->bounds(); }, part.geometry);
  }

  static std::vector<Mover> movers(std::span<const Part> parts) {
    std::vector<Mover> all;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (parts[i].motion) all.push_back({i, parts[i].placement.point(bounds_of(parts[i]).centre())});
    all.shrink_to_fit();
    return all;
  }

  Box swept(const Mover& mover, const Tick& from, const Tick& to) const noexcept {
    const Part& part = parts()[mover.part];
    const Box box = bounds_of(part);
    if (box.empty()) return box;
    std::array<Vec3, 8> corners = detail::corners(box);
    for (Vec3& corner : corners) corner = part.placement.point(corner);
    return part.motion->swept(corners, mover.centre, from, to);
  }

  Similarity moved(const Mover& mover, const Tick& tick) const noexcept {
    const Part& part = parts()[mover.part];
    const Displacement now = part.motion->at(tick, mover.centre);
    return {now.rotation * part.placement.rotation, part.placement.scale, now.point(part.placement.translation)};
  }

  Scene<Shapes...> scene_;     ///< of all parts; its index holds those that stand
  std::vector<Mover> movers_;  ///< by number of their part
  MovingIndex index_;
  Box bounds_;
};

}  // namespace pulsecast
