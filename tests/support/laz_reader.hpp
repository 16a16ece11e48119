// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

/// Reads what is compressed as LASzip does it. Plain and slow, written for the tests and checked by files that foreign
/// decoders read alike; shares nothing with the writer. Throws `std::runtime_error` at the first thing that is not as
/// it should be.
namespace pulsecast::support {

namespace detail {

inline void laz_expect(bool condition, const std::string& what) {
  if (!condition) throw std::runtime_error("not good LAZ: " + what);
}

/// A whole number of `n` bytes, the lowest first.
[[nodiscard]] inline std::uint64_t laz_whole(const std::string& bytes, std::size_t at, std::size_t n) {
  laz_expect(at + n <= bytes.size(), "the bytes end before " + std::to_string(at + n));
  std::uint64_t value = 0;
  for (std::size_t i = n; i-- > 0;) value = value * 256 + static_cast<unsigned char>(bytes[at + i]);
  return value;
}

}  // namespace detail

/// How often symbols came so far, and what shares of 2^15 they have until shares are taken anew.
class LazShares {
 public:
  explicit LazShares(std::size_t symbols) : counts_(symbols, 1), wait_((symbols + 6) / 2), next_wait_(wait_) { take(); }

  [[nodiscard]] std::uint64_t begin(std::size_t symbol) const { return begins_.at(symbol); }
  [[nodiscard]] std::size_t size() const { return counts_.size(); }

  void came(std::size_t symbol) {
    ++counts_.at(symbol);
    if (--wait_ > 0) return;
    std::uint64_t all = 0;
    for (const std::uint64_t count : counts_) all += count;
    if (all > 32768)
      for (std::uint64_t& count : counts_) count = (count + 1) / 2;
    take();
    next_wait_ = std::min<std::uint64_t>(next_wait_ * 5 / 4, (counts_.size() + 6) * 8);
    wait_ = next_wait_;
  }

 private:
  void take() {
    std::uint64_t all = 0, before = 0;
    for (const std::uint64_t count : counts_) all += count;
    begins_.clear();
    for (const std::uint64_t count : counts_) {
      begins_.push_back(2147483648U / all * before / 65536);
      before += count;
    }
  }

  std::vector<std::uint64_t> counts_, begins_;
  std::uint64_t wait_, next_wait_;
};

/// The same for a bit, in shares of 2^13.
struct LazBitShares {
  std::uint64_t zeros = 1, all = 2, zero_share = 4096, wait = 4, next_wait = 4, since = 0;

  void came(bool bit) {
    if (!bit) ++zeros;
    ++since;
    if (--wait > 0) return;
    all += since;
    since = 0;
    if (all > 8192) {
      all = (all + 1) / 2;
      zeros = (zeros + 1) / 2;
      if (zeros == all) ++all;
    }
    zero_share = 2147483648U / all * zeros / 262144;
    wait = next_wait = std::min<std::uint64_t>(next_wait * 5 / 4, 64);
  }
};

/// Symbols from bytes.
class LazDecoder {
 public:
  explicit LazDecoder(std::string bytes) : bytes_(std::move(bytes)) {
    for (int i = 0; i < 4; ++i) shift();
    length_ = 0xFFFFFFFF;
  }

  [[nodiscard]] std::size_t decode(LazShares& shares) {
    const std::uint64_t unit = length_ / 32768;
    std::size_t symbol = shares.size() - 1;
    while (shares.begin(symbol) * unit > value_) --symbol;
    const std::uint64_t begin = shares.begin(symbol) * unit;
    take(begin, symbol + 1 == shares.size() ? length_ : shares.begin(symbol + 1) * unit);
    shares.came(symbol);
    return symbol;
  }

  [[nodiscard]] bool decode(LazBitShares& shares) {
    const std::uint64_t border = length_ / 8192 * shares.zero_share;
    const bool bit = value_ >= border;
    take(bit ? border : 0, bit ? length_ : border);
    shares.came(bit);
    return bit;
  }

  [[nodiscard]] std::uint64_t decode_bits(unsigned count) {
    if (count > 19) {
      const std::uint64_t low = decode_bits(16);
      return decode_bits(count - 16) * 65536 + low;
    }
    const std::uint64_t unit = length_ >> count, value = value_ / unit;
    detail::laz_expect(value < std::uint64_t{1} << count, "bits beyond their number");
    take(value * unit, (value + 1) * unit);
    return value;
  }

  /// What the shares of all that was decoded ask for, by their logarithms [bit].
  [[nodiscard]] double information() const { return information_; }

  /// Nothing is left over: the bytes are as many as are needed.
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

 private:
  void shift() {
    detail::laz_expect(at_ < bytes_.size(), "a layer ends early");
    value_ = value_ * 256 + static_cast<unsigned char>(bytes_[at_++]);
    length_ *= 256;
  }

  void take(std::uint64_t begin, std::uint64_t end) {
    detail::laz_expect(value_ >= begin && value_ < end, "a value outside its interval");
    information_ += std::log2(static_cast<double>(length_) / static_cast<double>(end - begin));
    value_ -= begin;
    length_ = end - begin;
    while (length_ < 16777216) shift();
  }

  std::string bytes_;
  std::size_t at_ = 0;
  std::uint64_t value_ = 0, length_ = 0;
  double information_ = 0;
};

/// Whole numbers from what they differ by.
class LazNumbers {
 public:
  explicit LazNumbers(unsigned bits) : bits_(bits) {}

  [[nodiscard]] std::int64_t decode(LazDecoder& decoder, std::int64_t expected, unsigned context = 0) {
    length = static_cast<unsigned>(decoder.decode(lengths_.try_emplace(context, bits_ + 1).first->second));
    std::int64_t difference = 0;
    if (length == 0) {
      difference = decoder.decode(bit_) ? 1 : 0;
    } else if (length == 32) {
      difference = -2147483648LL;
    } else {
      const unsigned high = std::min(length, 8U), low = length - high;
      std::uint64_t place = decoder.decode(places_.try_emplace(length, std::size_t{1} << high).first->second);
      if (low > 0) place = (place << low) + decoder.decode_bits(low);
      const std::uint64_t half = std::uint64_t{1} << (length - 1);
      difference = static_cast<std::int64_t>(place) + (place < half ? 1 - 2 * static_cast<std::int64_t>(half) : 1);
    }
    return expected + difference;
  }

  unsigned length = 0;  ///< of the last difference [bit]

 private:
  unsigned bits_;
  std::map<unsigned, LazShares> lengths_, places_;
  LazBitShares bit_;
};

/// The middle of five.
struct LazMiddle {
  std::vector<std::int64_t> five{0, 0, 0, 0, 0};
  bool high = true;  ///< whether the greatest goes next

  [[nodiscard]] std::int64_t value() const { return five[2]; }
  void add(std::int64_t number) {
    const std::int64_t middle = value();
    five.erase(high ? five.end() - 1 : five.begin());
    five.push_back(number);
    std::sort(five.begin(), five.end());
    high = high ? number < middle : number <= middle;
  }
};

/// Times from how they go on.
class LazClock {
 public:
  explicit LazClock(std::uint64_t first) { series_[0].last = first; }

  [[nodiscard]] std::uint64_t decode(LazDecoder& decoder) {
    Series& s = series_[now_];
    const auto go_on = [&](std::int64_t expected, unsigned context) {
      const auto step =
          static_cast<std::int32_t>(static_cast<std::uint32_t>(numbers_.decode(decoder, expected, context)));
      s.last += static_cast<std::uint64_t>(std::int64_t{step});
      return step;
    };
    int other = 0;
    if (s.usual == 0) {
      const std::size_t what = decoder.decode(first_);
      if (what == 0) {
        s.usual = go_on(0, 0);
        s.unusual = 0;
        return s.last;
      }
      other = static_cast<int>(what) - 1;
    } else {
      const int what = static_cast<int>(decoder.decode(multiples_));
      if (what <= 510) {
        const int multiple = what <= 500 ? what : 500 - what;
        const unsigned context = multiple == 1    ? 1
                                 : multiple == 0  ? 7
                                 : multiple < -9  ? 6
                                 : multiple < 0   ? 5
                                 : multiple < 10  ? 2
                                 : multiple < 500 ? 3
                                                  : 4;
        const auto product = static_cast<std::int32_t>(static_cast<std::uint32_t>(multiple * std::int64_t{s.usual}));
        const std::int32_t step = go_on(product, context);
        if (multiple == 1) s.unusual = 0;
        if ((multiple == 0 || multiple == 500 || multiple == -10) && ++s.unusual > 3) {
          s.usual = step;
          s.unusual = 0;
        }
        return s.last;
      }
      other = what - 511;
    }
    if (other > 0) {
      now_ = (now_ + static_cast<unsigned>(other)) % 4;
      return decode(decoder);
    }
    const auto before = static_cast<std::int32_t>(s.last >> 32);
    const auto high = static_cast<std::uint32_t>(numbers_.decode(decoder, before, 8));
    newest_ = now_ = (newest_ + 1) % 4;
    series_[now_] = {std::uint64_t{high} << 32 | decoder.decode_bits(32), 0, 0};
    return series_[now_].last;
  }

 private:
  struct Series {
    std::uint64_t last = 0;
    std::int32_t usual = 0;
    int unusual = 0;
  };
  std::array<Series, 4> series_{};
  unsigned now_ = 0, newest_ = 0;
  LazShares first_{5}, multiples_{515};
  LazNumbers numbers_{32};
};

/// A chunk taken apart.
struct LazReadChunk {
  std::string records;
  std::size_t points = 0;
  std::vector<std::size_t> layers;  ///< their sizes [byte]
  std::vector<double> information;  ///< what the models ask for in each [bit]
  std::size_t size = 0;             ///< of all of it [byte]
};

namespace detail {

/// What a number of returns and a return number share with others, by both.
inline constexpr std::array<std::array<int, 16>, 16> laz_return_kinds{
    {{0, 1, 2, 3, 4, 5, 3, 4, 4, 5, 5, 5, 5, 5, 5, 5},
     {1, 0, 1, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3, 3},
     {2, 1, 2, 4, 4, 4, 4, 4, 4, 4, 4, 3, 3, 3, 3, 3},
     {3, 3, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
     {4, 3, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
     {5, 3, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4},
     {3, 3, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4, 4},
     {4, 3, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4, 4},
     {4, 3, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4, 4},
     {5, 3, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4, 4},
     {5, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 4, 4, 4, 4, 4},
     {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 4, 4, 4},
     {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4, 4},
     {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 4},
     {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5},
     {5, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5}}};

/// Reader of one chunk: all that is learnt is kept by channel and by what it depends on.
class LazChunkReader {
 public:
  LazChunkReader(const std::string& bytes, std::size_t at, std::size_t record, std::size_t colour)
      : colour_(colour), p_(open(bytes, at, record)) {
    last_of_.emplace(p_.channel, p_);
    first_before_.emplace(p_.channel, p_);
    told_ = p_.channel;
    extras_of_[told_] = chunk_.records.substr(30, record - 30);
  }

  [[nodiscard]] LazReadChunk read() {
    for (std::size_t i = 1; i < chunk_.points; ++i) next_point();
    for (std::size_t i = 0; i < decoders_.size(); ++i) {
      laz_expect(decoders_[i].at_end(), "bytes are left over in layer " + std::to_string(i));
      chunk_.information.push_back(decoders_[i].information());
    }
    return std::move(chunk_);
  }

 private:
  struct Point {
    std::int64_t x, y, z, intensity, angle, source, r, n, flags, channel, kind, user;
    std::uint64_t time;
    bool new_time;
  };

  static std::int64_t as_signed(std::uint64_t value, unsigned bits) {
    return static_cast<std::int64_t>(value << (64 - bits)) >> (64 - bits);
  }

  /// Takes layers and the first point, which is not compressed.
  Point open(const std::string& bytes, std::size_t at, std::size_t record) {
    const std::size_t begin = at, layer_count = 9 + layers_of_colour() + record - 30 - colour_;
    chunk_.records = bytes.substr(at, record);
    chunk_.points = laz_whole(bytes, at + record, 4);
    laz_expect(chunk_.points > 0, "a chunk without a point");
    at += record + 4;
    for (std::size_t i = 0; i < layer_count; ++i, at += 4) chunk_.layers.push_back(laz_whole(bytes, at, 4));
    const std::string still(4, '\0');  // in place of a layer that is left out
    for (const std::size_t size : chunk_.layers) {
      laz_expect(at + size <= bytes.size(), "a layer ends beyond the file");
      decoders_.emplace_back(size > 0 ? bytes.substr(at, size) : still);
      at += size;
    }
    chunk_.size = at - begin;
    const std::string& b = chunk_.records;
    const std::int64_t byte_14 = std::int64_t(laz_whole(b, 14, 1)), byte_15 = std::int64_t(laz_whole(b, 15, 1));
    return {.x = as_signed(laz_whole(b, 0, 4), 32),
            .y = as_signed(laz_whole(b, 4, 4), 32),
            .z = as_signed(laz_whole(b, 8, 4), 32),
            .intensity = std::int64_t(laz_whole(b, 12, 2)),
            .angle = as_signed(laz_whole(b, 18, 2), 16),
            .source = std::int64_t(laz_whole(b, 20, 2)),
            .r = byte_14 % 16,
            .n = byte_14 / 16,
            .flags = byte_15 % 16 + byte_15 / 64 * 16,
            .channel = byte_15 / 16 % 4,
            .kind = std::int64_t(laz_whole(b, 16, 1)),
            .user = std::int64_t(laz_whole(b, 17, 1)),
            .time = laz_whole(b, 22, 8),
            .new_time = false};
  }

  std::int64_t symbol(std::size_t layer, std::size_t symbols, const std::string& what, std::int64_t channel,
                      std::int64_t context) {
    return static_cast<std::int64_t>(
        decoders_[layer].decode(shares_.try_emplace({what, channel, context}, symbols).first->second));
  }

  std::int64_t number(std::size_t layer, unsigned bits, const std::string& what, std::int64_t expected,
                      std::int64_t context, unsigned* length = nullptr) {
    LazNumbers& n = numbers_.try_emplace({what, p_.channel}, bits).first->second;
    const std::int64_t value = n.decode(decoders_[layer], expected, static_cast<unsigned>(context));
    if (length != nullptr) *length = n.length;
    return as_signed(static_cast<std::uint64_t>(value), bits);
  }

  void next_point() {
    const Point last = p_;
    const std::int64_t end = (last.r == 1 ? 1 : 0) + (last.r >= last.n ? 2 : 0) + (last.new_time ? 4 : 0);
    const std::int64_t news = symbol(0, 128, "news", last.channel, end);
    std::int64_t channel = last.channel;
    if ((news & 64) != 0) channel = (channel + 1 + symbol(0, 3, "channel", channel, 0)) % 4;
    first_before_.try_emplace(channel, last);
    const Point before = last_of_.try_emplace(channel, last).first->second;
    p_ = before;
    p_.channel = channel;
    p_.new_time = (news & 16) != 0;
    returns(before, news);
    place(before);
    values(before, news);
    LazClock& clock = clocks_.try_emplace(channel, first_before_.at(channel).time).first->second;
    if (p_.new_time) p_.time = clock.decode(decoders_[8]);
    last_of_.insert_or_assign(channel, p_);
    extra_bytes((news & 64) != 0 ? channel : 0);  // so it is in version 3
  }

  void returns(const Point& before, std::int64_t news) {
    if ((news & 4) != 0) p_.n = symbol(0, 16, "n", p_.channel, before.n);
    if (const std::int64_t how = news & 3; how == 1) {
      p_.r = (before.r + 1) % 16;
    } else if (how == 2) {
      p_.r = (before.r + 15) % 16;
    } else if (how == 3) {
      p_.r = p_.new_time ? symbol(0, 16, "r", p_.channel, before.r)
                         : (before.r + 2 + symbol(0, 13, "r, same time", p_.channel, 0)) % 16;
    }
  }

  void place(const Point& before) {
    const int returns = laz_return_kinds[static_cast<std::size_t>(p_.n)][static_cast<std::size_t>(p_.r)];
    const std::int64_t kind = 2 * returns + (p_.new_time ? 1 : 0);
    const std::int64_t only = p_.n == 1 ? 1 : 0;
    LazMiddle &mx = middles_[{'x', p_.channel, kind}], &my = middles_[{'y', p_.channel, kind}];
    unsigned x_bits = 0, y_bits = 0;
    const std::int64_t dx = number(0, 32, "x", mx.value(), only, &x_bits);
    mx.add(dx);
    const std::int64_t dy = number(0, 32, "y", my.value(), only + (x_bits < 20 ? x_bits / 2 * 2 : 20), &y_bits);
    my.add(dy);
    p_.x = as_signed(static_cast<std::uint64_t>(before.x + dx), 32);
    p_.y = as_signed(static_cast<std::uint64_t>(before.y + dy), 32);

    const unsigned bits = (x_bits + y_bits) / 2;
    const std::pair key{p_.channel, std::min<std::int64_t>(std::abs(p_.n - p_.r), 7)};
    std::int64_t& height = heights_.try_emplace(key, first_before_.at(p_.channel).z).first->second;
    height = number(1, 32, "z", height, only + (bits < 18 ? bits / 2 * 2 : 18));
    p_.z = height;
  }

  void values(const Point& before, std::int64_t news) {
    const std::int64_t first = p_.r == 1 ? 1 : 0, at_last = p_.r >= p_.n ? 1 : 0;
    if (chunk_.layers[2] > 0) p_.kind = symbol(2, 256, "class", p_.channel, before.kind % 32 * 2 + first * at_last);
    if (chunk_.layers[3] > 0) p_.flags = symbol(3, 64, "flags", p_.channel, before.flags);
    if (chunk_.layers[4] > 0) {
      const std::int64_t which = 2 * first + at_last;
      const std::pair key{p_.channel, 2 * which + (p_.new_time ? 1 : 0)};
      std::int64_t& intensity = intensities_.try_emplace(key, first_before_.at(p_.channel).intensity).first->second;
      intensity = number(4, 16, "intensity", intensity, which) & 65535;
      p_.intensity = intensity;
    }
    if ((news & 8) != 0) p_.angle = number(5, 16, "angle", before.angle, p_.new_time ? 1 : 0);
    if (chunk_.layers[6] > 0) p_.user = symbol(6, 256, "user", p_.channel, before.user / 4);
    if ((news & 32) != 0) p_.source = number(7, 16, "source", before.source, 0) & 65535;
  }

  [[nodiscard]] std::size_t layers_of_colour() const { return colour_ == 0 ? 0 : colour_ == 6 ? 1 : 2; }

  /// Decodes colour and extra bytes, learnt by `told`, and puts down the point.
  void extra_bytes(std::int64_t told) {
    const std::int64_t told_before = std::exchange(told_, told);
    const bool known = extras_of_.try_emplace(told, extras_of_.at(told_before)).second == false;
    std::string& extras = extras_of_.at(known ? told_before : told);
    if (colour_ > 0 && chunk_.layers[9] > 0) colours(extras, told);
    if (colour_ > 6 && chunk_.layers[10] > 0) near_infrared(extras, told);
    const std::size_t begin = 9 + layers_of_colour();
    for (std::size_t k = 0; k + colour_ < extras.size(); ++k)
      if (chunk_.layers[begin + k] > 0)
        extras[colour_ + k] =
            static_cast<char>(extras[colour_ + k] + symbol(begin + k, 256, "extra " + std::to_string(k), told, 0));
    const auto put = [&](std::uint64_t value, int n) {
      for (; n > 0; --n, value >>= 8) chunk_.records.push_back(static_cast<char>(value));
    };
    for (const std::int64_t c : {p_.x, p_.y, p_.z}) put(static_cast<std::uint64_t>(c), 4);
    put(static_cast<std::uint64_t>(p_.intensity), 2);
    put(static_cast<std::uint64_t>(p_.r + 16 * p_.n), 1);
    put(static_cast<std::uint64_t>(p_.flags % 16 + 16 * p_.channel + p_.flags / 16 * 64), 1);
    put(static_cast<std::uint64_t>(p_.kind), 1);
    put(static_cast<std::uint64_t>(p_.user), 1);
    put(static_cast<std::uint64_t>(p_.angle), 2);
    put(static_cast<std::uint64_t>(p_.source), 2);
    put(p_.time, 8);
    chunk_.records += extras;
  }

  /// Steps of a byte, from the one that is expected; the sum is kept within a byte, if `expected` is given.
  void step(std::string& extras, std::size_t byte, std::size_t layer, std::int64_t told, int expected = 0) {
    const int from = std::min(255, std::max(0, static_cast<unsigned char>(extras[byte]) + expected));
    extras[byte] = static_cast<char>(from + symbol(layer, 256, "colour " + std::to_string(byte), told, 0));
  }

  /// Bytes 0 to 5 are red, green and blue, the low byte of each first.
  void colours(std::string& extras, std::int64_t told) {
    const std::string old = extras;
    const std::int64_t changed = symbol(9, 128, "colour changes", told, 0);
    const auto change_of = [&](std::size_t byte) {
      return int{static_cast<unsigned char>(extras[byte])} - static_cast<unsigned char>(old[byte]);
    };
    if ((changed & 1) != 0) step(extras, 0, 9, told);
    if ((changed & 2) != 0) step(extras, 1, 9, told);
    if ((changed & 64) == 0) {
      for (const std::size_t byte : {2U, 3U, 4U, 5U}) extras[byte] = extras[byte % 2];
      return;
    }
    for (const std::size_t low : {0U, 1U}) {
      if ((changed >> (2 + low) & 1) != 0) step(extras, 2 + low, 9, told, change_of(low));
      if ((changed >> (4 + low) & 1) != 0) step(extras, 4 + low, 9, told, (change_of(low) + change_of(2 + low)) / 2);
    }
  }

  void near_infrared(std::string& extras, std::int64_t told) {
    const std::int64_t changed = symbol(10, 4, "near infrared changes", told, 0);
    if ((changed & 1) != 0) step(extras, 6, 10, told);
    if ((changed & 2) != 0) step(extras, 7, 10, told);
  }

  std::size_t colour_;  ///< its size in a record [byte]
  LazReadChunk chunk_;
  std::vector<LazDecoder> decoders_;  ///< of the layers
  std::map<std::tuple<std::string, std::int64_t, std::int64_t>, LazShares> shares_;
  std::map<std::pair<std::string, std::int64_t>, LazNumbers> numbers_;
  std::map<std::tuple<char, std::int64_t, std::int64_t>, LazMiddle> middles_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> heights_, intensities_;
  std::map<std::int64_t, LazClock> clocks_;
  Point p_;
  std::map<std::int64_t, Point> last_of_, first_before_;  ///< by channel; the point with which a channel began
  std::map<std::int64_t, std::string> extras_of_;
  std::int64_t told_ = 0;  ///< channel that the extra bytes were learnt by
};

}  // namespace detail

/// Reads the chunk that begins at some byte, with records of so many bytes, `colour` of them for a colour: 0, 6 and 8
/// with the point formats 6, 7 and 8.
[[nodiscard]] inline LazReadChunk read_laz_chunk(const std::string& bytes, std::size_t at, std::size_t record,
                                                 std::size_t colour = 0) {
  return detail::LazChunkReader(bytes, at, record, colour).read();
}

/// A LAZ file, and the LAS file that it is when it is not compressed.
struct LazFile {
  std::string las;
  std::vector<LazReadChunk> chunks;
};

/// Checks the record on the compression that begins at some byte: items of the point format, and points of a chunk.
inline void check_laz_record(const std::string& bytes, std::size_t at, std::uint64_t chunk) {
  using detail::laz_expect;
  using detail::laz_whole;
  const std::size_t d = at + 54, record = laz_whole(bytes, 105, 2), format = laz_whole(bytes, 104, 1) - 128;
  const std::uint64_t colour = format == 7 ? 6 : format == 8 ? 8 : 0, items = colour > 0 ? 3 : 2;
  laz_expect(laz_whole(bytes, at + 20, 2) == 34 + 6 * items, "size of the record");
  laz_expect(laz_whole(bytes, d, 2) == 3 && laz_whole(bytes, d + 2, 2) == 0, "layered chunks by the arithmetic coder");
  laz_expect(laz_whole(bytes, d + 8, 4) == 0 && laz_whole(bytes, d + 12, 4) == chunk, "options and points of a chunk");
  laz_expect(laz_whole(bytes, d + 32, 2) == items, "number of items");
  laz_expect(laz_whole(bytes, d + 34, 6) == 10 + (30ULL << 16) + (3ULL << 32), "POINT14, version 3");
  if (colour > 0)
    laz_expect(laz_whole(bytes, d + 40, 6) == 4 + format + (colour << 16) + (3ULL << 32),
               "RGB14 or RGBNIR14, version 3");
  laz_expect(laz_whole(bytes, d + 28 + 6 * items, 6) == 14 + ((record - 30 - colour) << 16) + (3ULL << 32),
             "BYTE14, version 3");
}

/// Reads a LAZ file of point formats 6 to 8, and checks what it says of its compression: record, chunk table, places
/// and sizes.
[[nodiscard]] inline LazFile read_laz(const std::string& bytes) {
  using detail::laz_expect;
  using detail::laz_whole;
  const std::size_t format = laz_whole(bytes, 104, 1) - 128, colour = format == 7 ? 6 : format == 8 ? 8 : 0;
  laz_expect(bytes.substr(0, 4) == "LASF" && format >= 6 && format <= 8, "signature and point format");
  const std::size_t record = laz_whole(bytes, 105, 2), begin = laz_whole(bytes, 96, 4),
                    descriptors = laz_whole(bytes, 100, 4);
  LazFile file;
  file.las = bytes.substr(0, 375);
  std::size_t at = 375, described = 0;
  for (std::size_t i = 0; i < descriptors; ++i) {
    const std::size_t size = 54 + laz_whole(bytes, at + 20, 2);
    if (bytes.compare(at + 2, 15, std::string("laszip encoded\0", 15)) == 0 && laz_whole(bytes, at + 18, 2) == 22204) {
      laz_expect(++described == 1, "one record");
      check_laz_record(bytes, at, 50000);
    } else {
      file.las += bytes.substr(at, size);
    }
    at += size;
  }
  laz_expect(described == 1 && at == begin, "records of variable length");
  file.las[104] = static_cast<char>(format);
  const auto put = [&](std::size_t place, std::size_t value) {
    for (std::size_t i = 0; i < 4; ++i) file.las[place + i] = static_cast<char>(value >> (8 * i));
  };
  put(96, file.las.size());
  put(100, descriptors - 1);

  const std::size_t table = laz_whole(bytes, begin, 8), count = laz_whole(bytes, table + 4, 4);
  laz_expect(laz_whole(bytes, table, 4) == 0, "version of the chunk table");
  std::vector<std::size_t> sizes;
  if (count > 0) {
    LazDecoder decoder(bytes.substr(table + 8));
    LazNumbers numbers(32);
    for (std::size_t i = 0; i < count; ++i)
      sizes.push_back(static_cast<std::size_t>(numbers.decode(decoder, i == 0 ? 0 : std::int64_t(sizes.back()), 1)));
    laz_expect(decoder.at_end(), "something stands behind the chunk table");
  } else {
    laz_expect(bytes.size() == table + 8, "something stands behind an empty chunk table");
  }
  at = begin + 8;
  for (std::size_t i = 0; i < count; ++i) {
    file.chunks.push_back(read_laz_chunk(bytes, at, record, colour));
    laz_expect(file.chunks.back().size == sizes[i], "size of chunk " + std::to_string(i));
    laz_expect(i + 1 == count || file.chunks.back().points == 50000, "points of chunk " + std::to_string(i));
    file.las += file.chunks.back().records;
    at += sizes[i];
  }
  laz_expect(at == table, "the chunks end where their table begins");
  return file;
}

}  // namespace pulsecast::support
