// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <zlib.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/base/units.hpp>
#include <pulsecast/page/detail/sample.hpp>

namespace pulsecast::page {

/// A text as JSON has it, quotes included, that may stand in HTML as well: of `<`, `>` and `&` only the codes are left.
/// Source: RFC 8259, section 7.
[[nodiscard]] inline std::string json_text(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 32 || code == 127 || std::string_view("\"\\<>&").find(c) != std::string_view::npos) {
      out += "\\u00";
      out += digits[code / 16];
      out += digits[code % 16];
    } else {
      out += c;
    }
  }
  return out + '"';
}

/// A number as JSON has it; what is not finite is `null`.
[[nodiscard]] inline std::string json_number(double value) { return std::isfinite(value) ? pulsecast::detail::to_text(value) : "null"; }

/// How the points of a page are written.
struct PageColumnSettings {
  double position_step = 0;  ///< of coordinates; 0 for one that suits the extent, see `page_step` [m]
  bool keys = false;         ///< the keys as well
  int effort = 6;            ///< of compression, from 1 to 9

  void validate() const {
    require_not_negative("PageColumnSettings::position_step", position_step, "m");
    require_within("PageColumnSettings::effort", effort, 1, 9, "");
  }
};

/// A step of coordinates that suits an extent [m]: the least of 1, 2 and 5 times a power of ten, at least 0.1 mm, of which 2^17 reach
/// across.
[[nodiscard]] inline double page_step(double extent) noexcept {
  for (double power = 1e-4; power < 1e300; power *= 10)
    for (const double step : {power, 2 * power, 5 * power})
      if (extent <= step * 131'072) return step;
  return 1e300;
}

namespace detail {

/// Codes of one attribute of all points; code 0 is left for what has no value. `text` says as JSON how to read them.
struct PageCodes {
  std::string text{};
  std::vector<std::uint64_t> codes{};
  bool differences = true;  ///< whether neighbours are alike
};

inline constexpr double max_page_code = 0x1p52;  // which a double of the page can tell from its neighbours

/// Values that are 1 + code times a step above their least.
template <class Value>
PageCodes linear_codes(std::string_view name, std::span<const PagePoint> points, double step, const Value& value) {
  double least = std::numeric_limits<double>::infinity();
  for (const PagePoint& p : points)
    if (const double v = value(p); std::isfinite(v)) least = std::min(least, v);
  const double offset = std::isfinite(least) ? std::floor(least / step) * step : 0;
  PageCodes out;
  out.codes.reserve(points.size());
  for (const PagePoint& p : points) {
    const double code = 1 + std::round((static_cast<double>(value(p)) - offset) / step);
    out.codes.push_back(std::isfinite(code) ? static_cast<std::uint64_t>(std::clamp(code, 1.0, max_page_code)) : 0);
  }
  out.text = "\"name\":" + json_text(name) + ",\"kind\":\"linear\",\"offset\":" + json_number(offset) + ",\"step\":" + json_number(step);
  return out;
}

/// Values whose logarithm is 1 + code times a step above the least; those that are not above zero have none.
template <class Value>
PageCodes logarithmic_codes(std::string_view name, std::span<const PagePoint> points, double step, const Value& value) {
  double least = std::numeric_limits<double>::infinity();
  const auto sound = [](double v) { return v > 0 && std::isfinite(v); };
  for (const PagePoint& p : points)
    if (const double v = value(p); sound(v)) least = std::min(least, v);
  PageCodes out{.differences = false};
  for (const PagePoint& p : points) {
    const double v = value(p);
    out.codes.push_back(sound(v) ? static_cast<std::uint64_t>(1 + std::round(std::log(v / least) / step)) : 0);
  }
  out.text = "\"name\":" + json_text(name) + ",\"kind\":\"logarithmic\",\"offset\":" + json_number(std::isfinite(least) ? least : 1) +
             ",\"step\":" + json_number(step);
  return out;
}

/// Values that are few; codes are 1 + their places in a list.
template <class Value>
PageCodes listed_codes(std::string_view name, std::span<const PagePoint> points, const Value& value) {
  std::vector<std::uint32_t> values;
  for (const PagePoint& p : points)
    if (values.empty() || values.back() != value(p)) values.push_back(value(p));
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  PageCodes out{.differences = false};
  for (const PagePoint& p : points)
    out.codes.push_back(1 + static_cast<std::uint64_t>(std::lower_bound(values.begin(), values.end(), value(p)) - values.begin()));
  out.text = "\"name\":" + json_text(name) + ",\"kind\":\"listed\",\"values\":[";
  for (const std::uint32_t v : values) out.text += (out.text.back() == '[' ? "" : ",") + std::to_string(v);
  out.text += ']';
  return out;
}

/// From pulse to pulse, on the whole [s].
inline double time_of_a_pulse(std::span<const PagePoint> points) {
  if (points.empty() || points.back().pulse <= points.front().pulse) return 0;
  return (points.back().time - points.front().time) / static_cast<double>(points.back().pulse - points.front().pulse);
}

/// Differences to the code before, signs in the last bit: small numbers where neighbours are alike.
inline void make_differences(std::vector<std::uint64_t>& codes) {
  std::uint64_t before = 0;
  for (std::uint64_t& code : codes) {
    const std::uint64_t now = code;
    code = now >= before ? (now - before) * 2 : (before - now) * 2 - 1;
    before = now;
  }
}

/// The deflated bytes, without head and sum. Source: RFC 1951.
inline void deflate_into(std::string& out, std::span<const std::uint8_t> bytes, int effort) {
  z_stream stream{};
  constexpr int no_head = -15, memory_level = 9;
  if (deflateInit2(&stream, effort, Z_DEFLATED, no_head, memory_level, Z_FILTERED) != Z_OK) throw std::bad_alloc();
  std::vector<Bytef> room(std::size_t{1} << 18);
  constexpr std::size_t most = std::size_t{1} << 30;  // at a time: zlib counts in 32 bits
  do {
    const auto part = bytes.first(std::min(bytes.size(), most));
    bytes = bytes.subspan(part.size());
    stream.next_in = const_cast<Bytef*>(part.data());
    stream.avail_in = static_cast<uInt>(part.size());
    do {
      stream.next_out = room.data();
      stream.avail_out = static_cast<uInt>(room.size());
      deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);  // cannot fail: the stream is whole, and there is room
      out.append(reinterpret_cast<const char*>(room.data()), room.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  } while (!bytes.empty());
  deflateEnd(&stream);
}

}  // namespace detail

/// The points as a page reads them: four bytes that say how long the JSON text is which follows, little-endian, and deflated bytes.
///
///     {"count":N,"columns":[{"name":"x","kind":"linear","offset":0,"step":0.001,"differences":true,"planes":2},...]}
///
/// The deflated bytes are, column by column, the lowest bytes of all codes, then the next ones, as many as there are planes. A value is
/// offset + (code - 1) step, offset exp((code - 1) step), or the (code - 1)th of the values; code 0 stands for none. Differences are to
/// the code before, twice their size, less one if negative. A column may say what is to be added `per_pulse`, times the pulse's number.
/// Values are right to half a step: positions to that of the settings, `from_x` and so on, where the pulse left, as well; times to 0.1 us,
/// scan angles to 0.05 and incidences to 0.5 degrees, reflectances to 0.002, widths to 1 ps; amplitudes to 1 %, and numbers are exact.
[[nodiscard]] inline std::string page_columns(std::span<const PagePoint> points, const PageColumnSettings& settings = {}) {
  settings.validate();
  double step = settings.position_step;
  if (step == 0 && !points.empty()) {
    Vec3 least = points.front().position, most = least;
    for (const PagePoint& p : points) least = min(least, p.position), most = max(most, p.position);
    step = page_step(max_norm(most - least));
  }
  if (step == 0) step = 1e-3;
  using detail::linear_codes, detail::logarithmic_codes, detail::listed_codes;
  using Point = const PagePoint&;
  std::string text;
  std::vector<std::uint8_t> planes;
  const auto add = [&](detail::PageCodes column) {
    if (column.differences) detail::make_differences(column.codes);
    std::uint64_t all = 0;
    for (const std::uint64_t code : column.codes) all |= code;
    int count = 0;
    for (; all != 0; all >>= 8, ++count)
      for (const std::uint64_t code : column.codes) planes.push_back(static_cast<std::uint8_t>(code >> 8 * count));
    text += (text.empty() ? "{" : ",{") + column.text + ",\"differences\":" + (column.differences ? "true" : "false") +
            ",\"planes\":" + std::to_string(count) + '}';
  };
  for (int k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    add(linear_codes(axis, points, step, [k](Point p) { return p.position[k]; }));
    add(linear_codes("from_" + axis, points, step,
                     [k](Point p) { return p.position[k] + static_cast<double>(p.to_instrument[static_cast<std::size_t>(k)]); }));
  }
  add(linear_codes("pulse", points, 1, [](Point p) { return static_cast<double>(p.pulse); }));
  const double each = detail::time_of_a_pulse(points);
  detail::PageCodes times = linear_codes("time", points, 1e-7, [each](Point p) { return p.time - each * static_cast<double>(p.pulse); });
  times.text += ",\"per_pulse\":" + json_number(each);
  add(std::move(times));
  add(linear_codes("return_number", points, 1, [](Point p) { return p.number; }));
  add(linear_codes("returns", points, 1, [](Point p) { return p.returns; }));
  add(linear_codes("leg", points, 1, [](Point p) { return p.leg; }));
  add(linear_codes("channel", points, 1, [](Point p) { return p.channel; }));
  add(linear_codes("scan_angle", points, 0.05, [](Point p) { return static_cast<double>(p.scan_angle) * 180 / pi; }));
  add(listed_codes("object", points, [](Point p) { return p.object; }));
  add(listed_codes("class", points, [](Point p) { return p.classification; }));
  detail::PageCodes column = linear_codes("reflectance", points, 0.002, [](Point p) { return p.reflectance; });
  column.differences = false;
  add(std::move(column));
  add(logarithmic_codes("amplitude", points, 0.02, [](Point p) { return p.amplitude; }));
  column = linear_codes("incidence", points, 0.5, [](Point p) { return static_cast<double>(p.incidence) * 180 / pi; });
  column.differences = false;
  add(std::move(column));
  if (std::any_of(points.begin(), points.end(), [](Point p) { return p.width != 0; }))
    add(linear_codes("width", points, 0.001, [](Point p) { return static_cast<double>(p.width) * 1e9; }));
  if (settings.keys) {
    column = linear_codes("key", points, 1, [](Point p) { return p.key; });
    column.differences = false;
    add(std::move(column));
  }
  text = "{\"count\":" + std::to_string(points.size()) + ",\"columns\":[" + text + "]}";
  std::string out;
  for (int k = 0; k < 4; ++k) out += static_cast<char>(static_cast<std::uint32_t>(text.size()) >> 8 * k);
  out += text;
  detail::deflate_into(out, planes, settings.effort);
  return out;
}

/// Bytes as text of 64 characters. Source: RFC 4648, section 4.
[[nodiscard]] inline std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= n ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

}  // namespace pulsecast::page
