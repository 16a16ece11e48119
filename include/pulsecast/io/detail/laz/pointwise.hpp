// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_POINTWISE_HPP
#define PULSECAST_IO_DETAIL_LAZ_POINTWISE_HPP

#include <memory>

#include <pulsecast/io/detail/laz/integers.hpp>
#include <pulsecast/io/detail/laz/point.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Fields of a point in formats 0 to 5, as in its record. Source: LAS 1.4 R15, Point Data Record Format 0.
struct LazOldPoint {
  std::int32_t x = 0, y = 0, z = 0;
  std::uint16_t intensity = 0;
  std::uint8_t bits = 0;  ///< return number, number of returns, scan direction, edge of flight line
  std::uint8_t classification = 0, angle = 0, user = 0;
  std::uint16_t source = 0;
};
static_assert(sizeof(LazOldPoint) == 20);

/// Coder of the records of a chunk of formats 0 to 3 with extra bytes, one after another: items of version 2. Source:
/// Isenburg 2013, LASzip, 4 (POINT10, GPSTIME11, RGB12, BYTE); for models and contexts, files and laz-perf.
class LazPointwise {
 public:
  /// First record of a chunk, with time, and colour at `colour` if not 0; extra bytes from `extras` on.
  LazPointwise(std::span<const std::byte> first, bool has_time, std::size_t colour, std::size_t extras)
      : time_(has_time), colour_(colour), extras_(extras), last_(first.begin(), first.end()), steps_(last_.size()) {
    if (has_time) times_ = std::make_unique<LazTimes>(get<std::int64_t>(last_.data() + 20), true);
  }

  /// Codes a record in its place.
  template <class Coder>
  void code(Coder& coder, std::byte* record) {
    put(record, code_point(coder, get<LazOldPoint>(last_.data()), get<LazOldPoint>(record)));
    if (time_) put(record + 20, times_->code(coder, get<std::int64_t>(record + 20)));
    using Colour = LazColours::Value;
    if (colour_ > 0)
      put(record + colour_, colours_.code(coder, get<Colour>(last_.data() + colour_), get<Colour>(record + colour_)));
    for (std::size_t k = extras_; k < last_.size(); ++k)
      record[k] = std::byte{
          steps_[k].code(coder, std::to_integer<std::uint8_t>(last_[k]), std::to_integer<std::uint8_t>(record[k]))};
    std::copy_n(record, last_.size(), last_.begin());
  }

 private:
  /// Models of a byte by another, made when they are needed.
  struct Bytes {
    template <class Coder>
    std::uint8_t code(Coder& coder, std::uint8_t context, unsigned value) {
      auto& model = of[context];
      if (!model) model = std::make_unique<LazModel<>>();
      return static_cast<std::uint8_t>(coder.code(*model, value));
    }
    std::array<std::unique_ptr<LazModel<>>, 256> of;
  };

  template <class Value>
  [[nodiscard]] static Value get(const std::byte* bytes) noexcept {
    Value value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
  static void put(std::byte* bytes, const auto& value) noexcept { std::memcpy(bytes, &value, sizeof value); }

  /// Kind of a return's place in its pulse: rows by number of returns, columns by return number.
  [[nodiscard]] static std::size_t kind(unsigned bits) noexcept {
    static constexpr std::array<std::string_view, 8> kinds{"fedcba98", "e0136aa9", "d1247bba", "c3458ccb",
                                                           "b6789ddc", "aabcdeed", "9abcdefe", "89abcdef"};
    const char digit = kinds[bits >> 3 & 7U][bits & 7U];
    return static_cast<std::size_t>(digit < 'a' ? digit - '0' : digit - 'a' + 10);
  }

  /// Codes what differs from the point before: flags say which fields do; coordinates always.
  template <class Coder>
  [[nodiscard]] LazOldPoint code_point(Coder& coder, const LazOldPoint& before, LazOldPoint p) {
    const auto bit = [](bool is, unsigned value) { return is ? value : 0U; };
    unsigned changed = bit(p.bits != before.bits, 32) | bit(p.intensity != intensity_[kind(p.bits)], 16) |
                       bit(p.classification != before.classification, 8) | bit(p.angle != before.angle, 4) |
                       bit(p.user != before.user, 2) | bit(p.source != before.source, 1);
    changed = coder.code(changed_, changed);
    p.bits = (changed & 32U) != 0 ? bits_.code(coder, before.bits, p.bits) : before.bits;
    const std::size_t series = kind(p.bits);
    std::uint16_t& intensity = intensity_[series];
    if ((changed & 16U) != 0)
      intensity = static_cast<std::uint16_t>(
          intensities_.code(coder, intensity, p.intensity, std::min<std::size_t>(series, 3)));
    p.intensity = intensity;
    p.classification =
        (changed & 8U) != 0 ? classes_.code(coder, before.classification, p.classification) : before.classification;
    const unsigned turn =
        (changed & 4U) == 0 ? 0
                            : coder.code(angles_[p.bits >> 6 & 1U], static_cast<std::uint8_t>(p.angle - before.angle));
    p.angle = static_cast<std::uint8_t>(before.angle + turn);
    p.user = (changed & 2U) != 0 ? users_.code(coder, before.user, p.user) : before.user;
    p.source = (changed & 1U) != 0 ? static_cast<std::uint16_t>(sources_.code(coder, before.source, p.source, 0))
                                   : before.source;
    const unsigned returns = p.bits >> 3 & 7U, number = p.bits & 7U;
    const bool only = returns == 1;
    plane_.code(coder, series, only, before, p);
    std::int32_t& height = height_[returns > number ? returns - number : number - returns];
    p.z = height = z_.code(coder, height, p.z, laz_context(plane_.last_length(), 18, only));
    return p;
  }

  bool time_;
  std::size_t colour_, extras_;
  std::vector<std::byte> last_;  // record before
  LazModel<64> changed_;
  Bytes bits_, classes_, users_;
  std::array<LazModel<>, 2> angles_;
  LazIntegers intensities_{16, 4}, sources_{16, 1}, z_{32, 20};
  LazPlane<16> plane_;
  std::array<std::uint16_t, 16> intensity_{};  // last ones by kind
  std::array<std::int32_t, 8> height_{};       // last ones by number of returns to come
  std::unique_ptr<LazTimes> times_;
  LazColours colours_;
  std::vector<LazExtraByte> steps_;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
