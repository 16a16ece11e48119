// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_SHAPE_MASK_HPP
#define PULSECAST_SHAPE_MASK_HPP

#include <pulsecast/material/image.hpp>

namespace PULSECAST_NAMESPACE {

/// Outline of a surface in a picture: a bit a pixel, 0 in a hole; without pixels, there is none.
/// Where the two triangles of a quad meet, a ray along the border of two pixels may find a
/// different one in each: a mask and its complement may both be hit.
struct Mask {
  std::uint32_t width = 0, height = 0;  ///< size [pixel]
  std::vector<std::uint64_t> bits{};    ///< row by row from the top left, from the lowest bit of a word up

  /// Pixels whose channel, by number, is at least a share of its full value, in [0, 1].
  [[nodiscard]] static Mask of(const Image& image, std::uint32_t channel, double cutoff = 0.5) {
    image.validate();
    require_within("Mask::of (channel)", channel, 0, image.channels - 1.0, "");
    require_within("Mask::of (cutoff)", cutoff, 0, 1, "");
    const std::size_t pixels = std::size_t{image.width} * image.height;
    Mask mask{image.width, image.height, std::vector<std::uint64_t>((pixels + 63) / 64)};
    for (std::size_t i = 0; i < pixels; ++i) {
      const bool solid = image.samples[i * image.channels + channel] >= cutoff * 255;
      mask.bits[i / 64] |= std::uint64_t{solid} << i % 64;
    }
    return mask;
  }

  /// Share of the pixels that are solid; 1 without pixels.
  [[nodiscard]] double solid_share() const noexcept {
    const std::size_t pixels = std::size_t{width} * height;
    std::size_t solid = 0;
    for (std::size_t i = 0; i < pixels; ++i) solid += bits[i / 64] >> i % 64 & 1;
    return pixels == 0 ? 1 : static_cast<double>(solid) / static_cast<double>(pixels);
  }

  void validate() const {
    require_within("Mask::width", width, 0, 65536, "pixel");
    require_within("Mask::height", height, width == 0 ? 0 : 1, width == 0 ? 0 : 65536, "pixel");
    const std::size_t words = (std::size_t{width} * height + 63) / 64;
    require_within("Mask::bits (number of words)", bits.size(), words, words);
  }
};

namespace detail {

/// Masks of the materials of a mesh, immutable.
class MaskTable {
 public:
  MaskTable() = default;
  /// One a material; those beyond have none. @throws SettingError as `Mask::validate`
  explicit MaskTable(std::span<const Mask> masks) {
    std::size_t words = 0;
    for (const Mask& mask : masks) {
      mask.validate();
      words += mask.bits.size();
    }
    const SharedBuffer<Frame> frames(words > 0 ? masks.size() : 0);
    const SharedBuffer<std::uint64_t> bits(words);
    std::size_t first = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      frames[i] = {masks[i].width, masks[i].height, first};
      std::copy(masks[i].bits.begin(), masks[i].bits.end(), bits.data() + first);
      first += masks[i].bits.size();
    }
    frames_ = frames;
    bits_ = bits;
  }

  void archive(auto& a) { a(frames_, bits_); }
  [[nodiscard]] bool is_consistent() const {
    return std::all_of(frames_.begin(), frames_.end(), [&](const Frame& frame) {
      const std::size_t words = (std::size_t{frame.width} * frame.height + 63) / 64;
      return frame.first <= bits_.size() && words <= bits_.size() - frame.first &&
             (frame.width == 0) == (frame.height == 0);
    });
  }
  [[nodiscard]] std::size_t memory() const noexcept { return frames_.memory() + bits_.memory(); }

  [[nodiscard]] bool empty() const noexcept { return frames_.empty(); }
  /// True if a material has holes.
  [[nodiscard]] bool covers(std::uint32_t material) const noexcept {
    return material < frames_.size() && frames_[material].width > 0;
  }
  /// True if the surface of a material that has holes is solid at texture coordinates.
  [[nodiscard]] bool solid(std::uint32_t material, const Vec2& texture) const noexcept {
    const Frame& frame = frames_[material];
    const std::size_t i = texel_at(frame.width, frame.height, texture);
    return (bits_[frame.first + i / 64] >> i % 64 & 1) != 0;
  }

 private:
  struct Frame {
    std::uint32_t width, height;  ///< size [pixel]
    std::uint64_t first;          ///< its first word
  };

  SharedArray<Frame> frames_;        ///< by material; empty if no material has holes
  SharedArray<std::uint64_t> bits_;  ///< of all masks
};

struct NoMasks {
  NoMasks() = default;
  explicit NoMasks(std::span<const Mask> masks) {
    if (!masks.empty())
      throw_setting_error("MeshData::masks (number)", static_cast<double>(masks.size()), "",
                          "0 in a TriangleMesh; a MaskedMesh has holes");
  }
  void archive(auto&) {}
  [[nodiscard]] static constexpr std::size_t memory() noexcept { return 0; }
  [[nodiscard]] static constexpr bool empty() noexcept { return true; }
};

}  // namespace detail

}  // namespace PULSECAST_NAMESPACE

#endif
