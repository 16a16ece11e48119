// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_CHUNK_HPP
#define PULSECAST_IO_DETAIL_LAZ_CHUNK_HPP

#include <pulsecast/io/detail/laz/layers.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Compressor of a chunk of points of formats 6 to 8 with extra bytes, as LASzip from version 3 on.
/// Each attribute is a layer, left out if constant.
class LazChunk : private LazLayers {
 public:
  /// One or more whole records of `record` bytes, `colour` of which are a colour: 0, 6 or 8.
  LazChunk(std::span<const std::byte> records, std::size_t record, std::size_t colour = 0)
      : records_(records), record_(record), colour_(colour) {
    points_.reserve(records.size() / record);
    for (std::size_t at = 0; at < records.size(); at += record) points_.emplace_back(records.data() + at);
  }

  /// Chunk as in the file: first point uncompressed, number of points, sizes of the layers, layers.
  [[nodiscard]] std::vector<std::byte> compressed() {
    std::vector<std::vector<std::byte>> layers;
    layers.push_back(encoded([&](auto& encoder) { positions(encoder); }));
    layers.push_back(encoded([&](auto& encoder) { heights(encoder); }));
    layers.push_back(layer_of(&LazPoint::classification, [&](auto& encoder) { classes(encoder); }));
    layers.push_back(layer_of(&LazPoint::flags, [&](auto& encoder) { flags(encoder); }));
    layers.push_back(layer_of(&LazPoint::intensity, [&](auto& encoder) { intensities(encoder); }));
    layers.push_back(layer_of(&LazPoint::angle, [&](auto& encoder) { changes<2>(encoder, &LazPoint::angle); }));
    layers.push_back(layer_of(&LazPoint::user, [&](auto& encoder) {
      bytes<256>(encoder, &LazPoint::user, [](auto&, auto& before) { return before.user / 4U; });
    }));
    layers.push_back(layer_of(&LazPoint::source, [&](auto& encoder) { changes<1>(encoder, &LazPoint::source); }));
    layers.push_back(layer_of(&LazPoint::time, [&](auto& encoder) { times(encoder); }));
    if (colour_ > 0) layers.push_back(layer_at<LazColours>(laz_point_size));
    if (colour_ > 6) layers.push_back(layer_at<LazNearInfrared>(laz_point_size + 6));
    add_extra_bytes(layers);

    std::vector<std::byte> bytes(records_.begin(), records_.begin() + static_cast<std::ptrdiff_t>(record_));
    const auto add = [&](std::span<const std::byte> b) { bytes.insert(bytes.end(), b.begin(), b.end()); };
    const auto add_number = [&](std::size_t number) {
      const auto n = static_cast<std::uint32_t>(number);
      add(std::as_bytes(std::span(&n, 1)));
    };
    add_number(points_.size());
    for (const auto& layer : layers) add_number(layer.size());
    for (const auto& layer : layers) add(layer);
    return bytes;
  }

 private:
  [[nodiscard]] static std::vector<std::byte> encoded(const auto& encode) {
    LazEncoder encoder;
    encode(encoder);
    return std::move(encoder).finish();
  }

  /// Encodes a layer, or nothing if the value is constant.
  template <class Value>
  [[nodiscard]] std::vector<std::byte> layer_of(Value LazPoint::*value, const auto& encode) const {
    const auto same = [&](const LazPoint& p) { return p.*value == points_[0].*value; };
    if (std::all_of(points_.begin(), points_.end(), same)) return {};
    return encoded(encode);
  }

  void intensities(LazEncoder& encoder) {
    struct Models {
      explicit Models(const LazPoint& before) { last.fill(before.intensity); }
      LazIntegers intensity{16, 4};
      std::array<std::uint16_t, 8> last;
    };
    layer<Models>([&](auto& m, auto& p, auto& step) {
      const unsigned end = (p.first() ? 2U : 0U) | (p.last() ? 1U : 0U);
      std::uint16_t& last = m.last[end << 1 | (step.new_time ? 1U : 0U)];
      m.intensity.code(encoder, last, p.intensity, end);
      last = p.intensity;
    });
  }

  /// Encodes a layer of values as changes; of two contexts, the second is for a new time.
  template <std::size_t Contexts, class Value>
  void changes(LazEncoder& encoder, Value LazPoint::*value) {
    struct Models {
      explicit Models(const LazPoint&) {}
      LazIntegers value{16, Contexts};
    };
    layer<Models>([&](auto& m, auto& p, auto& step) {
      const Value before = step.before->*value;
      const std::size_t context = Contexts == 2 && step.new_time ? 1 : 0;
      if (p.*value != before) m.value.code(encoder, before, p.*value, context);
    });
  }

  void times(LazEncoder& encoder) {
    struct Models {
      explicit Models(const LazPoint& before) : times(before.time) {}
      LazTimes times;
    };
    layer<Models>([&](auto& m, auto& p, auto& step) {
      if (step.new_time) m.times.code(encoder, p.time);
    });
  }

  void add_extra_bytes(std::vector<std::vector<std::byte>>& layers) {
    const std::size_t begin = laz_point_size + colour_, extras = record_ - begin, count = points_.size();
    std::vector<std::uint8_t> columns(extras * count);  // contiguous for each byte
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < extras; ++k)
        columns[k * count + i] = std::to_integer<std::uint8_t>(records_[i * record_ + begin + k]);
    for (std::size_t k = 0; k < extras; ++k)
      layers.push_back(values_of<LazExtraByte>([&](std::size_t i) { return columns[k * count + i]; }));
  }

  /// Encodes a layer of the values at offset `at` of each record, or nothing if they are constant.
  template <class Models>
  [[nodiscard]] std::vector<std::byte> layer_at(std::size_t at) {
    return values_of<Models>([&](std::size_t i) {
      typename Models::Value value{};
      std::memcpy(&value, records_.data() + i * record_ + at, sizeof value);
      return value;
    });
  }

  /// Encodes a layer of a value of each point, or nothing if they are constant.
  template <class Models>
  [[nodiscard]] std::vector<std::byte> values_of(const auto& value) {
    std::size_t same = 1;
    while (same < points_.size() && value(same) == value(0)) ++same;
    if (same == points_.size()) return {};
    return encoded([&](auto& encoder) { values<Models>(encoder, value, [](std::size_t, auto&&) {}); });
  }

  std::span<const std::byte> records_;
  std::size_t record_, colour_;  // sizes of a record and of its colour [byte]
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
