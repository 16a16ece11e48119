// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_LAYERS_HPP
#define PULSECAST_IO_DETAIL_LAZ_LAYERS_HPP

#include <memory>

#include <pulsecast/io/detail/laz/integers.hpp>
#include <pulsecast/io/detail/laz/point.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Points of a chunk in formats 6 to 10, and the layers that a coder of either direction codes. Source: Isenburg 2013,
/// LASzip; LASzip for LAS 1.4 (native extension), specification; its files, items of version 3.
class LazLayers {
 protected:
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

  /// What a point has unlike the one before in its channel.
  [[nodiscard]] static unsigned news_of(const LazPoint& p, const LazPoint& before, unsigned last_channel) noexcept {
    const unsigned up = (p.number - before.number) & 15U;
    const unsigned number = up < 2 ? up : up == 15 ? 2U : 3U;  // same, next, previous, other
    const auto bit = [](bool is, unsigned value) { return is ? value : 0U; };
    return number | bit(p.returns != before.returns, 4) | bit(p.angle != before.angle, 8) |
           bit(p.time != before.time, 16) | bit(p.source != before.source, 32) | bit(p.channel != last_channel, 64);
  }

  /// Codes change flags, x and y. Fills `steps_`.
  template <class Coder>
  void positions(Coder& coder) {
    struct Models {
      explicit Models(const LazPoint&) {}
      std::array<LazModel<128>, 8> news;
      LazModel<3> channel;
      std::array<LazModel<16>, 16> returns, number;
      LazModel<13> number_at_same_time;
      LazPlane<12> plane;
    };
    Channels<Models> channels;
    std::array<const LazPoint*, 4> last_of_channel{};
    last_of_channel[points_[0].channel] = points_.data();
    steps_.clear();
    steps_.reserve(points_.size());
    steps_.push_back({points_.data(), false, 0, points_[0].channel});
    bool new_time = false;  // of the last point
    for (std::size_t i = 1; i < points_.size(); ++i) {
      LazPoint& p = points_[i];
      const LazPoint& last = points_[i - 1];
      const unsigned place = (last.first() ? 1U : 0U) | (last.last() ? 2U : 0U) | (new_time ? 4U : 0U);
      unsigned news = 0;
      if constexpr (Coder::encodes)
        news = news_of(p, last_of_channel[p.channel] ? *last_of_channel[p.channel] : last, last.channel);
      Models& of_last = channels.of(last.channel, last);
      news = coder.code(of_last.news[place], news);
      const unsigned up = (news & 64U) == 0 ? 0 : 1 + coder.code(of_last.channel, (p.channel - last.channel - 1U) & 3U);
      p.channel = static_cast<std::uint8_t>((last.channel + up) & 3U);
      const LazPoint* const seen = std::exchange(last_of_channel[p.channel], &p);
      const LazPoint& before = seen ? *seen : last;
      new_time = (news & 16U) != 0;

      Models& m = channels.of(p.channel, before);
      const unsigned n = (news & 4U) == 0 ? before.returns : coder.code(m.returns[before.returns], p.returns);
      unsigned number = before.number + ((news & 3U) == 2 ? 15U : news & 3U);
      if ((news & 3U) == 3)
        number = new_time
                     ? coder.code(m.number[before.number], p.number)
                     : before.number + 2U + coder.code(m.number_at_same_time, (p.number - before.number - 2U) & 15U);
      p.returns = static_cast<std::uint8_t>(n);
      p.number = static_cast<std::uint8_t>(number & 15U);

      const std::size_t series = 2 * kind(p) + (new_time ? 1 : 0);
      m.plane.code(coder, series, p.only(), before, p);
      const auto out = static_cast<std::uint8_t>(m.plane.last_length());
      steps_.push_back({&before, new_time, out, up > 0 ? p.channel : std::uint8_t{0}});
    }
  }

  /// Codes all points but the first: `code(models, point, step)` codes one.
  template <class Models, class Code>
  void layer(const Code& code) {
    Channels<Models> channels;
    static_cast<void>(channels.of(points_[0].channel, points_[0]));
    for (std::size_t i = 1; i < points_.size(); ++i)
      code(channels.of(points_[i].channel, *steps_[i].before), points_[i], steps_[i]);
  }

  template <class Coder>
  void heights(Coder& coder) {
    struct Models {
      explicit Models(const LazPoint& before) { last.fill(before.z); }
      LazIntegers z{32, 20};
      std::array<std::int32_t, 8> last;  // by number of returns to come, approximately
    };
    layer<Models>([&](auto& m, auto& p, auto& step) {
      const unsigned to_come = p.returns > p.number ? p.returns - p.number : p.number - p.returns;
      std::int32_t& last = m.last[std::min(to_come, 7U)];
      p.z = last = m.z.code(coder, last, p.z, laz_context(step.out, 18, p.only()));
    });
  }

  /// Codes bytes by models of `context(point, point before)`.
  template <std::size_t Symbols, class Coder, class ContextOf>
  void bytes(Coder& coder, std::uint8_t LazPoint::*value, const ContextOf& context) {
    struct Models {
      explicit Models(const LazPoint&) {}
      std::array<LazModel<Symbols>, 64> of;
    };
    layer<Models>([&](auto& m, auto& p, auto& step) {
      p.*value = static_cast<std::uint8_t>(coder.code(m.of[context(p, *step.before)], p.*value));
    });
  }

  template <class Coder>
  void classes(Coder& coder) {
    bytes<256>(coder, &LazPoint::classification, [](auto& p, auto& before) {
      return (before.classification & 31U) << 1 | (p.first() && p.last() ? 1U : 0U);
    });
  }

  template <class Coder>
  void flags(Coder& coder) {
    bytes<64>(coder, &LazPoint::flags, [](auto&, auto& before) { return before.flags; });
  }

  /// Codes a value of each point but the first: `get(i)`, `put(i, value)`. After a change of the scanner channel, the
  /// last value is in version 4 that of the channel. In version 3 it is still that of the channel before, and is stored
  /// there, unless the channel is new.
  template <class Models, class Coder>
  void values(Coder& coder, const auto& get, const auto& put, bool is_version_4 = false) {
    const auto channel_of = [&](std::size_t i) { return is_version_4 ? points_[i].channel : steps_[i].told; };
    std::array<std::unique_ptr<Models>, 4> models;
    std::array<typename Models::Value, 4> last{};
    std::size_t kept = channel_of(0);
    models[kept] = std::make_unique<Models>();
    last[kept] = get(0);
    for (std::size_t i = 1; i < points_.size(); ++i) {
      const std::size_t channel = channel_of(i);
      if (!models[channel]) {
        models[channel] = std::make_unique<Models>();
        last[channel] = last[kept];
        kept = channel;
      }
      if (is_version_4) kept = channel;
      put(i, last[kept] = models[channel]->code(coder, last[kept], get(i)));
      kept = channel;
    }
  }

  std::vector<LazPoint> points_;
  std::vector<Step> steps_;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
