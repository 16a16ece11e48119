// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_ACCEL_DETAIL_SAH_HPP
#define PULSECAST_ACCEL_DETAIL_SAH_HPP

#include <pulsecast/base/parallel.hpp>
#include <pulsecast/base/shared_array.hpp>
#include <pulsecast/geometry/detail/bundle_interval.hpp>

/// Shared parts of the SAH builders. The cost of a node is the expected number of tests for a ray
/// that hits it; that hits a box inside with the ratio of surface areas. Source: Goldsmith & Salmon
/// 1987; MacDonald & Booth 1990. Binned: Wald 2007; Shevtsov, Soupikov & Kapustin 2007.
namespace PULSECAST_NAMESPACE::detail {

/// Cost of a primitive test, in traversal steps. Affects speed only.
inline constexpr double test_cost = 2;

/// Depth limit of the leaves, and so the size of a traversal stack.
inline constexpr std::size_t max_depth = 64;

/// Greatest coordinate accepted, so that sums and areas in any Real stay finite [m].
inline constexpr double max_coordinate = 1e18;

template <std::floating_point Real>
[[nodiscard]] double half_area(const BoundingBox<Real>& box) noexcept {
  const auto size = [&](int k) noexcept { return static_cast<double>(box.max[k]) - static_cast<double>(box.min[k]); };
  const double x = size(0), y = size(1), z = size(2);
  return x * y + y * z + z * x;
}

template <std::floating_point Real>
struct Boxed {
  BoundingBox<Real> box;
  PrimitiveIndex primitive;

  /// Corners of the box; the fourth lane is undefined.
  [[nodiscard]] simd::Vec4<Real> low() const noexcept { return simd::Vec4<Real>::from(box.min[0]); }
  [[nodiscard]] simd::Vec4<Real> high() const noexcept {
    static_assert(sizeof(Boxed) >= 7 * sizeof(Real), "one lane beyond the box is read");
    return simd::Vec4<Real>::from(box.max[0]);
  }
};

template <std::floating_point Real>
struct GrowingBox {
  simd::Vec4<Real> min{std::numeric_limits<Real>::max()}, max{-std::numeric_limits<Real>::max()};

  void extend(const simd::Vec4<Real>& low, const simd::Vec4<Real>& high) noexcept {
    min = simd::min(low, min);
    max = simd::max(high, max);
  }
  void extend(const GrowingBox& by) noexcept { extend(by.min, by.max); }
  [[nodiscard]] BoundingBox<Real> box() const noexcept { return {{min[0], min[1], min[2]}, {max[0], max[1], max[2]}}; }
  /// Half of the surface area, equal to that of `box()` up to rounding [m^2].
  [[nodiscard]] double half_area() const noexcept {
    const simd::Vec4<Real> size = max - min;
    const auto x = static_cast<double>(size[0]), y = static_cast<double>(size[1]), z = static_cast<double>(size[2]);
    return x * y + y * z + z * x;
  }
};

/// Equal slices of a box along each axis; their edges are the candidate splits of a build.
template <std::floating_point Real>
class Slices {
 public:
  Slices(const simd::Vec4<Real>& low, const simd::Vec4<Real>& high, std::size_t count) noexcept
      : count_(count), low_(low), last_(static_cast<Real>(count - 1)) {
    Real per_width[4] = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const Real extent = high[k] - low[k], slices = static_cast<Real>(count) / extent;
      valid_[k] = extent > 0 && slices <= std::numeric_limits<Real>::max();
      width_[k] = extent / static_cast<Real>(count);
      per_width[k] = valid_[k] ? slices : 0;
    }
    per_width_ = simd::Vec4<Real>::from(per_width[0]);
  }

  [[nodiscard]] std::size_t count() const noexcept { return count_; }

  /// True if the box is long enough along axis k to be sliced.
  [[nodiscard]] bool valid(std::size_t k) const noexcept { return valid_[k]; }

  /// Slice along each axis that holds a point, clamped to the box; 0 along axes not sliced.
  [[nodiscard]] std::array<std::uint32_t, 3> of(const simd::Vec4<Real>& point) const noexcept {
    using Four = simd::Vec4<Real>;
    const Four slice = simd::min(simd::max((point - low_) * per_width_, Four(0)), last_);
    const auto whole = [&](std::size_t k) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(slice[k])); };
    return {whole(0), whole(1), whole(2)};
  }

  /// True if coordinate x along axis k is in slice i > 0 or a later one, consistent with `of`.
  [[nodiscard]] bool reaches(std::size_t k, Real x, std::size_t i) const noexcept {
    return (x - low_[k]) * per_width_[k] >= static_cast<Real>(i);
  }

  [[nodiscard]] Real edge(std::size_t k, std::size_t i) const noexcept {
    return low_[k] + static_cast<Real>(i) * width_[k];
  }

 private:
  std::size_t count_;
  simd::Vec4<Real> low_, last_, per_width_;
  Real width_[3];
  bool valid_[3];
};

/// Bounds and number of the primitives in each slice of a box, along each axis.
template <std::floating_point Real>
struct Bins {
  static constexpr std::size_t max_slices = 16;

  GrowingBox<Real> boxes[3][max_slices];
  std::uint32_t counts[3][max_slices];

  void clear(std::size_t slices) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      std::fill_n(boxes[k], slices, GrowingBox<Real>());
      std::fill_n(counts[k], slices, 0U);
    }
  }
  void add(const Bins& others, std::size_t slices) noexcept {
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < slices; ++i) {
        boxes[k][i].extend(others.boxes[k][i]);
        counts[k][i] += others.counts[k][i];
      }
  }

  /// Bins of primitives from `begin` to `end` by their centres, times two, as are the slices.
  void fill(const Slices<Real>& slices, const Boxed<Real>* begin, const Boxed<Real>* end) noexcept {
    const auto put = [&](const Boxed<Real>& boxed, Bins& to) noexcept {
      const simd::Vec4<Real> low = boxed.low(), high = boxed.high();
      const auto of = slices.of(low + high);
      for (std::size_t k = 0; k < 3; ++k) {
        to.boxes[k][of[k]].extend(low, high);
        ++to.counts[k][of[k]];
      }
    };
    clear(slices.count());
    if (end - begin > 256) {  // two sets of bins in turn, as neighbours often share a slice
      Bins other;
      other.clear(slices.count());
      for (; end - begin > 1; begin += 2) {
        put(begin[0], *this);
        put(begin[1], other);
      }
      add(other, slices.count());
    }
    for (; begin != end; ++begin) put(*begin, *this);
  }
};

/// Calls act(i, begin, end) for the i-th chunk of an array, on several threads if there are
/// several. Results merged in chunk order do not depend on the number of threads.
inline constexpr std::size_t chunk_size = std::size_t{1} << 14;
[[nodiscard]] constexpr std::size_t chunk_count(std::size_t count) noexcept {
  return (count + chunk_size - 1) / chunk_size;
}
void for_each_chunk(std::size_t count, const Workers& workers, const auto& act) {
  const auto act_on = [&](std::size_t i) { act(i, i * chunk_size, std::min(count, (i + 1) * chunk_size)); };
  for_each_index(chunk_count(count), workers, act_on);
}

template <class T>
concept LeafTest = std::invocable<const T&, std::span<const PrimitiveIndex>>;

/// Indexable range of boxes: an array, or a generator.
template <class B>
concept BoxRange = requires(const B& boxes) {
  { boxes[boxes.size()] } -> std::convertible_to<Box>;
};

/// Non-owning, type-erased view of an indexable range of boxes, so that builders compile once. The
/// range must outlive it, and yield the same `Box` for an index every time.
class BoxRangeRef {
 public:
  template <BoxRange Boxes>
  BoxRangeRef(const Boxes& boxes)  // NOLINT(google-explicit-constructor): implicit from an array
      : boxes_(&boxes), size_(boxes.size()), copy_([](const void* all, std::size_t i, std::size_t end, Box* to) {
          for (; i < end; ++i) *to++ = (*static_cast<const Boxes*>(all))[i];
        }) {}

  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  /// Calls act(i, box) for the non-empty boxes of a chunk.
  void for_each(std::size_t begin, std::size_t end, const auto& act) const {
    constexpr std::size_t at_once = 64;
    std::array<Box, at_once> some;
    for (; begin < end; begin += at_once) {
      const std::size_t count = std::min(at_once, end - begin);
      copy_(boxes_, begin, begin + count, some.data());
      for (std::size_t i = 0; i < count; ++i)
        if (!some[i].empty()) act(begin + i, some[i]);
    }
  }

 private:
  const void* boxes_;
  std::size_t size_;
  void (*copy_)(const void* boxes, std::size_t begin, std::size_t end, Box* to);
};

/// The primitives with non-empty boxes, in coordinates relative to the centre of their bounds.
template <std::floating_point Real>
struct BuildInput {
  Box bounds;
  Vec3 centre{};
  SharedBuffer<Boxed<Real>> primitives;

  explicit BuildInput(const BoxRangeRef& boxes, const Workers& workers = 1) {
    constexpr std::size_t most = std::numeric_limits<PrimitiveIndex>::max() - 1;  // the next is no hit
    if (boxes.size() > most)
      throw SettingError("Accelerator::boxes", static_cast<double>(boxes.size()), "", "at most 4294967294 in number");
    struct ChunkBounds {
      Box bounds;
      std::size_t first = 0, met = 0;  // index of the first in `primitives`, and count
    };
    const SharedBuffer<ChunkBounds> all(chunk_count(boxes.size()));
    for_each_chunk(boxes.size(), workers, [&](std::size_t part, std::size_t begin, std::size_t end) {
      ChunkBounds own;
      boxes.for_each(begin, end, [&](std::size_t, const Box& box) {
        const double extent = std::fmax(max_norm(box.min), max_norm(box.max));
        if (!(extent <= max_coordinate))
          throw SettingError("Accelerator::boxes", extent, "m", "within 1e18 m of the origin");
        own.bounds.extend(box);
        ++own.met;
      });
      all[part] = own;
    });
    std::size_t met = 0;
    for (ChunkBounds& own : all) {
      bounds.extend(own.bounds);
      own.first = met;
      met += own.met;
    }
    if (met == 0) return;
    centre = bounds.centre();
    primitives = SharedBuffer<Boxed<Real>>(met);
    for_each_chunk(boxes.size(), workers, [&](std::size_t part, std::size_t begin, std::size_t end) {
      Boxed<Real>* to = primitives.data() + all[part].first;
      boxes.for_each(begin, end, [&](std::size_t i, const Box& box) {
        *to++ = {BoundingBox<Real>::around(box, centre), static_cast<PrimitiveIndex>(i)};
      });
    });
  }
};

}  // namespace PULSECAST_NAMESPACE::detail

#endif
