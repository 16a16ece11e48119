// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_PACKED_HEIGHTS_HPP
#define PULSECAST_SHAPE_PACKED_HEIGHTS_HPP

#include <optional>

#include <pulsecast/base/require.hpp>
#include <pulsecast/base/shared_array.hpp>

namespace PULSECAST_NAMESPACE {

/// Heights as whole numbers of 16 bits, in half the memory of `float`: the height of number n is
/// `offset` + `scale` (n - `zero`), rounded to `float`.
struct PackedHeights {
  std::vector<std::uint16_t> numbers{};    ///< by pixel, row by row from the north, if packed
  double scale = 1;                        ///< height of one step [m]
  double offset = 0;                       ///< height of the number `zero` [m]
  std::uint16_t zero = 0;                  ///< 32768 for signed numbers with 32768 added
  std::optional<std::uint16_t> missing{};  ///< number of missing heights

  void validate() const {
    require_positive("PackedHeights::scale", scale, "m");
    require_within("PackedHeights::offset", offset, -1e15, 1e15, "m");
    const double most = std::fabs(offset) + 65535 * scale;
    require_within("PackedHeights::scale (height of 65,535 steps)", most, 0, 1e15, "m");
  }

  /// True if `other` has the same height for each number.
  [[nodiscard]] bool same_scale(const PackedHeights& other) const noexcept {
    return scale == other.scale && offset == other.offset && zero == other.zero && missing == other.missing;
  }
};

namespace detail {

/// Heights of the numbers from 0 to a raster's greatest [m], rounded here only; NaN if missing.
[[nodiscard]] inline std::vector<float> height_table(const PackedHeights& packed) {
  std::size_t last = 0;
  for (const std::uint16_t number : packed.numbers) last = std::max<std::size_t>(last, number);
  std::vector<float> table;
  table.reserve(last + 1);
  for (std::size_t n = 0; n <= last; ++n) {
    const double steps = static_cast<double>(n) - packed.zero;
    table.push_back(packed.missing == n ? std::numeric_limits<float>::quiet_NaN()
                                        : static_cast<float>(packed.offset + packed.scale * steps));
  }
  return table;
}

/// Heights of pixels by their numbers, which are places in a table.
struct PackedPixels {
  const std::uint16_t* numbers;
  const float* table;

  [[nodiscard]] float operator[](std::size_t i) const noexcept { return table[numbers[i]]; }
};

/// Heights of the pixels of a raster [m]: one `float` each, or 16 bits that select one of a table.
class PixelHeights {
 public:
  PixelHeights() = default;
  PixelHeights(std::vector<float> heights, PackedHeights packed) {
    if (packed.numbers.empty()) {
      heights_ = std::move(heights);
      return;
    }
    const std::vector<float> all = height_table(packed);
    std::uint16_t least = std::numeric_limits<std::uint16_t>::max(), greatest = 0;
    for (const std::uint16_t number : packed.numbers) {
      if (packed.missing == number) continue;
      least = std::min(least, number);
      greatest = std::max(greatest, number);
    }
    // the table is short, as places count from the least; missing: the last, or between others
    std::vector<float> table;
    if (least <= greatest) table.assign(all.begin() + least, all.begin() + greatest + 1);
    std::size_t hole = table.size();
    if (packed.missing && *packed.missing > least && *packed.missing < greatest)
      hole = std::size_t{*packed.missing} - least;
    else if (packed.missing)
      table.push_back(std::numeric_limits<float>::quiet_NaN());
    for (std::uint16_t& number : packed.numbers)
      number = static_cast<std::uint16_t>(packed.missing == number ? hole : number - least);
    heights_ = std::move(table);
    numbers_ = std::move(packed.numbers);
  }

  void archive(auto& a) { a(heights_, numbers_); }
  /// True if there are `size` pixels, each with a height or a place in the table.
  [[nodiscard]] bool is_consistent(std::size_t size) const noexcept {
    if (!is_packed()) return heights_.size() == size;
    const auto in_table = [&](std::uint16_t n) noexcept { return n < heights_.size(); };
    return numbers_.size() == size && std::all_of(numbers_.begin(), numbers_.end(), in_table);
  }

  [[nodiscard]] bool is_packed() const noexcept { return !numbers_.empty(); }
  [[nodiscard]] std::size_t memory() const noexcept { return heights_.memory() + numbers_.memory(); }

  [[nodiscard]] const float* floats() const noexcept { return heights_.data(); }
  [[nodiscard]] PackedPixels packed() const noexcept { return {numbers_.data(), heights_.data()}; }

  /// Calls `work` with the heights of pixels by their index: a `const float*` or `PackedPixels`.
  decltype(auto) read(const auto& work) const { return is_packed() ? work(packed()) : work(floats()); }

 private:
  SharedArray<float> heights_;          ///< of the pixels, or the table
  SharedArray<std::uint16_t> numbers_;  ///< places in the table, if there is one
};

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE

#endif
