// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_CHUNK_HPP
#define PULSECAST_IO_DETAIL_LAZ_CHUNK_HPP

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include <pulsecast/io/detail/laz/coder.hpp>
#include <pulsecast/io/detail/laz/integers.hpp>
#include <pulsecast/io/detail/laz/point.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Compressor of a chunk of points of formats 6 to 8 with extra bytes, as LASzip from version 3 on.
/// Each attribute is a layer, left out if constant. Source: Isenburg 2013, LASzip; LASzip for LAS
/// 1.4 (native extension), specification; its files, items of version 3.
class LazChunk {
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
    layers.push_back(positions());
    layers.push_back(heights());
    layers.push_back(bytes<256>(&LazPoint::classification, [](auto& p, auto& before) {
      return (before.classification & 31U) << 1 | (p.first() && p.last() ? 1U : 0U);
    }));
    layers.push_back(bytes<64>(&LazPoint::flags, [](auto&, auto& before) { return before.flags; }));
    layers.push_back(intensities());
    layers.push_back(changes<2>(&LazPoint::angle));
    layers.push_back(bytes<256>(&LazPoint::user, [](auto&, auto& before) { return before.user / 4U; }));
    layers.push_back(changes<1>(&LazPoint::source));
    layers.push_back(times());
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
  /// State of the positions layer for others. Each scanner channel is predicted by itself.
  struct Step {
    const LazPoint* before;  ///< last point of this channel, or of any if there is none
    bool new_time;           ///< true if the time differs from that of `before`
    std::uint8_t out;        ///< error of the prediction in x and y: mean number of bits
    std::uint8_t told;       ///< channel for extra bytes: that of the point if new, else 0
  };

  /// Models by channel, initialized with the point before the channel's first.
  template <class Models>
  class Channels {
   public:
    [[nodiscard]] Models& of(std::uint8_t channel, const LazPoint& before) {
      if (!models_[channel]) models_[channel] = std::make_unique<Models>(before);
      return *models_[channel];
    }

   private:
    std::array<std::unique_ptr<Models>, 4> models_;
  };

  /// Kind of a return's place in its pulse: rows by number of returns, columns by return number.
  [[nodiscard]] static std::size_t kind(const LazPoint& p) noexcept {
    static constexpr std::array<std::string_view, 16> kinds{
        "0123453445555555", "1013333333333333", "2124444444433333", "3345444444444444",
        "4344544444444444", "5344454444444444", "3344445444444444", "4344444544444444",
        "4344444454444444", "5344444445444444", "5344444444544444", "5334444444455444",
        "5334444444455544", "5334444444445554", "5334444444444555", "5334444444444455"};
    return static_cast<std::size_t>(kinds[p.returns][p.number] - '0');
  }

  /// Context from a number of bits, rounded down to even and limited; plus 1 for an only return.
  [[nodiscard]] static std::size_t context(unsigned bits, unsigned most, const LazPoint& p) noexcept {
    return (bits < most ? bits & ~1U : most) + (p.only() ? 1U : 0U);
  }

  /// Encodes change flags, x and y. Fills `steps_`.
  [[nodiscard]] std::vector<std::byte> positions() {
    struct Models {
      explicit Models(const LazPoint&) {}
      std::array<LazModel<128>, 8> news;
      LazModel<3> channel;
      std::array<LazModel<16>, 16> returns, number;
      LazModel<13> number_at_same_time;
      LazIntegers x{32, 2}, y{32, 22};
      std::array<LazMedian, 12> x_step, y_step;
    };
    Channels<Models> channels;
    std::array<const LazPoint*, 4> last_of_channel{};
    last_of_channel[points_[0].channel] = points_.data();
    LazEncoder encoder;
    steps_.reserve(points_.size());
    steps_.push_back({points_.data(), false, 0, points_[0].channel});
    bool new_time = false;  // of the last point
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const LazPoint &p = points_[i], &last = points_[i - 1];
      const LazPoint* const seen = std::exchange(last_of_channel[p.channel], &p);
      const LazPoint& before = seen ? *seen : last;
      const unsigned place = (last.first() ? 1U : 0U) | (last.last() ? 2U : 0U) | (new_time ? 4U : 0U);
      new_time = p.time != before.time;
      const unsigned up = (p.number - before.number) & 15U;
      const unsigned number = up < 2 ? up : up == 15 ? 2U : 3U;  // same, next, previous, other
      const auto bit = [](bool is, unsigned value) { return is ? value : 0U; };
      const unsigned news = number | bit(p.returns != before.returns, 4) | bit(p.angle != before.angle, 8) |
                            bit(new_time, 16) | bit(p.source != before.source, 32) | bit(p.channel != last.channel, 64);
      Models& of_last = channels.of(last.channel, last);
      encoder.encode(of_last.news[place], news);
      if (p.channel != last.channel) encoder.encode(of_last.channel, (p.channel - last.channel - 1U) & 3U);

      Models& m = channels.of(p.channel, before);
      if (p.returns != before.returns) encoder.encode(m.returns[before.returns], p.returns);
      if (number == 3 && new_time) encoder.encode(m.number[before.number], p.number);
      if (number == 3 && !new_time) encoder.encode(m.number_at_same_time, up - 2);

      const std::size_t series = 2 * kind(p) + (new_time ? 1 : 0);
      const std::int32_t dx = laz_step(before.x, p.x), dy = laz_step(before.y, p.y);
      m.x.encode(encoder, m.x_step[series].value(), dx, p.only() ? 1 : 0);
      m.x_step[series].add(dx);
      m.y.encode(encoder, m.y_step[series].value(), dy, context(m.x.last_length(), 20, p));
      m.y_step[series].add(dy);
      const auto out = static_cast<std::uint8_t>((m.x.last_length() + m.y.last_length()) / 2);
      steps_.push_back({&before, new_time, out, p.channel != last.channel ? p.channel : std::uint8_t{0}});
    }
    return std::move(encoder).finish();
  }

  /// Encodes all points but the first: `encode(encoder, models, point, step)` encodes one.
  template <class Models, class Encode>
  [[nodiscard]] std::vector<std::byte> layer(const Encode& encode) const {
    Channels<Models> channels;
    LazEncoder encoder;
    static_cast<void>(channels.of(points_[0].channel, points_[0]));
    for (std::size_t i = 1; i < points_.size(); ++i)
      encode(encoder, channels.of(points_[i].channel, *steps_[i].before), points_[i], steps_[i]);
    return std::move(encoder).finish();
  }

  /// Encodes a layer, or nothing if the value is constant.
  template <class Models, class Value, class Encode>
  [[nodiscard]] std::vector<std::byte> layer_of(Value LazPoint::*value, const Encode& encode) const {
    const auto same = [&](const LazPoint& p) { return p.*value == points_[0].*value; };
    if (std::all_of(points_.begin(), points_.end(), same)) return {};
    return layer<Models>(encode);
  }

  [[nodiscard]] std::vector<std::byte> heights() const {
    struct Models {
      explicit Models(const LazPoint& before) { last.fill(before.z); }
      LazIntegers z{32, 20};
      std::array<std::int32_t, 8> last;  // by number of returns to come, approximately
    };
    return layer<Models>([](auto& encoder, auto& m, auto& p, auto& step) {
      const unsigned to_come = p.returns > p.number ? p.returns - p.number : p.number - p.returns;
      std::int32_t& last = m.last[std::min(to_come, 7U)];
      m.z.encode(encoder, last, p.z, context(step.out, 18, p));
      last = p.z;
    });
  }

  /// Encodes a layer of bytes by models of `context(point, point before)`.
  template <std::size_t Symbols, class ContextOf>
  [[nodiscard]] std::vector<std::byte> bytes(std::uint8_t LazPoint::*value, const ContextOf& context) const {
    struct Models {
      explicit Models(const LazPoint&) {}
      std::array<LazModel<Symbols>, 64> of;
    };
    return layer_of<Models>(value, [&](auto& encoder, auto& m, auto& p, auto& step) {
      encoder.encode(m.of[context(p, *step.before)], p.*value);
    });
  }

  [[nodiscard]] std::vector<std::byte> intensities() const {
    struct Models {
      explicit Models(const LazPoint& before) { last.fill(before.intensity); }
      LazIntegers intensity{16, 4};
      std::array<std::uint16_t, 8> last;
    };
    return layer_of<Models>(&LazPoint::intensity, [](auto& encoder, auto& m, auto& p, auto& step) {
      const unsigned end = (p.first() ? 2U : 0U) | (p.last() ? 1U : 0U);
      std::uint16_t& last = m.last[end << 1 | (step.new_time ? 1U : 0U)];
      m.intensity.encode(encoder, last, p.intensity, end);
      last = p.intensity;
    });
  }

  /// Encodes a layer of values as changes; of two contexts, the second is for a new time.
  template <std::size_t Contexts, class Value>
  [[nodiscard]] std::vector<std::byte> changes(Value LazPoint::*value) const {
    struct Models {
      explicit Models(const LazPoint&) {}
      LazIntegers value{16, Contexts};
    };
    return layer_of<Models>(value, [&](auto& encoder, auto& m, auto& p, auto& step) {
      const Value before = step.before->*value;
      const std::size_t context = Contexts == 2 && step.new_time ? 1 : 0;
      if (p.*value != before) m.value.encode(encoder, before, p.*value, context);
    });
  }

  [[nodiscard]] std::vector<std::byte> times() const {
    struct Models {
      explicit Models(const LazPoint& before) : times(before.time) {}
      LazTimes times;
    };
    return layer_of<Models>(&LazPoint::time, [](auto& encoder, auto& m, auto& p, auto& step) {
      if (step.new_time) m.times.encode(encoder, p.time);
    });
  }

  void add_extra_bytes(std::vector<std::vector<std::byte>>& layers) const {
    const std::size_t begin = laz_point_size + colour_, extras = record_ - begin, count = points_.size();
    std::vector<std::uint8_t> columns(extras * count);  // contiguous for each byte
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < extras; ++k)
        columns[k * count + i] = std::to_integer<std::uint8_t>(records_[i * record_ + begin + k]);
    for (std::size_t k = 0; k < extras; ++k)
      layers.push_back(layer_by_told<ExtraByte>([&](std::size_t i) { return columns[k * count + i]; }));
  }

  /// Coder of an extra byte as its difference to the last one.
  struct ExtraByte {
    using Value = std::uint8_t;

    void encode(LazEncoder& encoder, Value before, Value now) {
      encoder.encode(steps, static_cast<std::uint8_t>(now - before));
    }
    LazModel<> steps;
  };

  /// Encodes a layer of the values at offset `at` of each record, or nothing if they are constant.
  template <class Models>
  [[nodiscard]] std::vector<std::byte> layer_at(std::size_t at) const {
    return layer_by_told<Models>([&](std::size_t i) {
      typename Models::Value value{};
      std::memcpy(&value, records_.data() + i * record_ + at, sizeof value);
      return value;
    });
  }

  /// Encodes a layer of a value of each point, or nothing if they are constant. As in all files of
  /// version 3, after a change of the scanner channel the last value is still that of the channel
  /// before, and is stored there, unless the channel is new.
  template <class Models, class ValueOf>
  [[nodiscard]] std::vector<std::byte> layer_by_told(const ValueOf& value) const {
    std::size_t same = 1;
    while (same < points_.size() && value(same) == value(0)) ++same;
    if (same == points_.size()) return {};
    std::array<std::unique_ptr<Models>, 4> models;
    std::array<typename Models::Value, 4> last{};
    models[steps_[0].told] = std::make_unique<Models>();
    last[steps_[0].told] = value(0);
    LazEncoder encoder;
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const std::size_t channel = steps_[i].told;
      std::size_t kept = steps_[i - 1].told;
      if (!models[channel]) {
        models[channel] = std::make_unique<Models>();
        last[channel] = last[kept];
        kept = channel;
      }
      const auto now = value(i);
      models[channel]->encode(encoder, last[kept], now);
      last[kept] = now;
    }
    return std::move(encoder).finish();
  }

  std::span<const std::byte> records_;
  std::size_t record_, colour_;  // sizes of a record and of its colour [byte]
  std::vector<LazPoint> points_;
  std::vector<Step> steps_;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
