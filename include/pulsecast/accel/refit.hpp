// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_ACCEL_REFIT_HPP
#define PULSECAST_ACCEL_REFIT_HPP

#include <pulsecast/accel/bvh.hpp>

namespace PULSECAST_NAMESPACE {

/// Trees over primitives that move, in reused memory. `refit` keeps the topology of a tree and
/// recomputes its boxes; `update` builds it anew where that is too slow, by the SAH cost of the
/// boxes; hits are the same. Source: Lauterbach et al. 2006 (refit, with the cost watched).
template <std::floating_point Real>
class BvhRefit {
 public:
  /// SAH cost at which a tree is made anew, by its cost when built.
  static constexpr double max_growth = 1.6;

  /// SAH cost of a tree: sum of the surfaces of its boxes, by the root's; 0 without surface.
  [[nodiscard]] static double cost(const Bvh<Real>& tree) noexcept {
    double sum = 0, root = 0;
    for (const Node& node : tree.nodes_) {
      GrowingBox around;
      for (std::size_t place = 0; place < node.count(); ++place) {
        const BoundingBox<Real> box = node.boxes.at(place);
        sum += detail::half_area(box);
        around.extend(corner(box.min), corner(box.max));
      }
      if (&node == tree.nodes_.begin()) root = around.half_area();
    }
    return relative(sum, root);
  }

  /// Sets `to` to the topology of `from` over boxes that have moved. `box_of(primitives)` returns
  /// the `Box` [m] around some primitives of `from.order()`; `bounds` hold all [m]. `to`, last set
  /// by this object or empty, gives its memory; without another owner nothing is allocated. False,
  /// `to` empty: the cost exceeds `max_growth`. @throws SettingError for boxes beyond 1e18 m
  [[nodiscard]] bool refit(const Bvh<Real>& from, const BvhRefit& state, const Box& bounds, const auto& box_of,
                           Bvh<Real>& to) {
    if (from.nodes_.empty()) {
      to = from;
      return true;
    }
    const SharedArray<Node> topology = from.nodes_;
    const SharedArray<PrimitiveIndex> order = from.primitives_;
    const std::size_t depth = from.depth_;
    built_cost_ = state.built_cost_ > 0 ? state.built_cost_ : cost(from);
    to.nodes_ = {};
    to.primitives_ = {};
    if (nodes_.size() != topology.size() || nodes_.memory().use_count() != 1)
      nodes_ = SharedBuffer<Node>(topology.size());
    // counting an owner down acquires what another thread did to the memory before
    static_cast<void>(SharedBuffer<Node>(nodes_));
    around_.resize(topology.size());
    return finish(topology.data(), order, depth, bounds, box_of, to);
  }

  /// Sets `to` to a tree over `boxes` [m], of one primitive a leaf: a refit `from`, a tree over as
  /// many boxes, or a new one, built by `workers`.
  void update(const Bvh<Real>& from, const BvhRefit& state, std::span<const Box> boxes, Bvh<Real>& to,
              const Workers& workers = {}) {
    Box bounds;
    for (const Box& box : boxes) bounds.extend(box);  // an empty box changes nothing
    const auto box_of = [&](const auto& primitives) noexcept { return boxes[primitives[0]]; };
    if (refit(from, state, bounds, box_of, to)) return;
    to = Bvh<Real>(boxes, workers, 1);
    nodes_ = {};
  }

  [[nodiscard]] std::size_t memory() const noexcept { return around_.capacity() * sizeof(GrowingBox); }

 private:
  using Node = typename Bvh<Real>::Node;
  using GrowingBox = detail::GrowingBox<Real>;

  static simd::Vec4<Real> corner(const Real (&at)[3]) noexcept { return {at[0], at[1], at[2]}; }
  static double relative(double sum, double root) noexcept { return root > 0 ? sum / root : 0; }

  /// Box relative to a centre, extended by the rounding of the greatest coordinate: no branch.
  static GrowingBox rounded(const Box& box, const Vec3& centre, const simd::Vec4<Real>& margin) noexcept {
    using Lanes = simd::Vec4<double>;
    const auto lanes = [](const Vec3& p) noexcept { return Lanes(p.x, p.y, p.z).template as<Real>(); };
    GrowingBox out;
    out.min = lanes(box.min - centre) - margin;
    out.max = lanes(box.max - centre) + margin;
    return out;
  }

  /// Computes all boxes, children first, and sets the tree unless its cost is too high.
  [[nodiscard]] bool finish(const Node* topology, const SharedArray<PrimitiveIndex>& order, std::size_t depth,
                            const Box& bounds, const auto& box_of, Bvh<Real>& to) {
    const double extent = std::max(max_norm(bounds.min), max_norm(bounds.max));
    if (!(extent <= detail::max_coordinate))
      throw_setting_error("Accelerator::boxes", extent, "m", "within 1e18 m of the origin");
    const Vec3 centre = bounds.centre();
    using Limits = std::numeric_limits<Real>;
    const double reach = max_norm(bounds.size()) * static_cast<double>(Limits::epsilon());
    const simd::Vec4<Real> margin(static_cast<Real>(reach) + Limits::min());
    double sum = 0;
    for (std::size_t i = nodes_.size(); i-- > 0;) {
      Node& node = nodes_[i] = topology[i];
      GrowingBox around;
      for (std::size_t place = 0; place < node.count(); ++place) {
        const std::size_t first = node.first[place], size = node.size[place];
        const GrowingBox box =
            size > 0 ? rounded(box_of(std::span(order.data() + first, size)), centre, margin) : around_[first];
        node.boxes.put(place, box.box());
        around.extend(box);
        sum += box.half_area();
      }
      around_[i] = around;
    }
    if (relative(sum, around_[0].half_area()) > max_growth * built_cost_) {
      built_cost_ = 0;
      return false;
    }
    to.bounds_ = bounds;
    to.centre_ = centre;
    to.nodes_ = nodes_;
    to.primitives_ = order;
    to.depth_ = depth;
    return true;
  }

  SharedBuffer<Node> nodes_;        ///< memory of the last tree
  double built_cost_ = 0;           ///< SAH cost of the topology when built; 0 before a refit
  std::vector<GrowingBox> around_;  ///< box of each node
};

}  // namespace PULSECAST_NAMESPACE

#endif
