// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_PAGE_DETAIL_COLUMNS_HPP
#define PULSECAST_PAGE_DETAIL_COLUMNS_HPP

#include <pulsecast/io/gzip.hpp>
#include <pulsecast/page/detail/json.hpp>
#include <pulsecast/page/detail/sample.hpp>

namespace PULSECAST_NAMESPACE::page {

/// Settings for the encoding of points.
struct PageColumnSettings {
  double position_step = 0;  ///< step of coordinates; 0: chosen from the extent by `page_step` [m]
  bool keys = false;         ///< write the sampling keys, too
  int effort = 6;            ///< compression level, 1 to 9

  void validate() const {
    require_not_negative("PageColumnSettings::position_step", position_step, "m");
    require_within("PageColumnSettings::effort", effort, 1, 9, "");
  }
};

/// Least step of 1, 2 or 5 times a power of ten, from `least` on, with 2^17 across an extent [m].
[[nodiscard]] inline double page_step(double extent, double least = 1e-4) noexcept {
  for (double power = least; power < 1e300; power *= 10)
    for (const double step : {power, 2 * power, 5 * power})
      if (extent <= step * 131'072) return step;
  return 1e300;
}

namespace detail {

/// Codes of one attribute of all points (0: no value), with their description for the page.
struct PageCodes {
  std::string name{};
  std::string_view kind{};                 ///< "linear", "logarithmic" or "listed"
  double offset = 0, step = 0;             ///< for linear and logarithmic codes
  std::vector<std::uint32_t> values{};     ///< for listed codes
  std::optional<double> per_pulse{};       ///< term added, times the number of the pulse
  bool differences = true;                 ///< store differences, of similar neighbours
  std::optional<std::string_view> unit{};  ///< unit, of a column that the page does not know
  std::vector<std::uint64_t> codes{};
};

/// Least and greatest of the finite values of `value(i)`; infinity and its negative without any.
template <class Value>
std::pair<double, double> extent_of(std::size_t count, const Value& value) {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t i = 0; i < count; ++i)
    if (const double v = value(i); std::isfinite(v)) {
      least = std::min(least, v);
      most = std::max(most, v);
    }
  return {least, most};
}

inline constexpr double max_page_code = 0x1p52;  // up to here, a double represents every integer

/// Linear codes of `value(i)`, `count` of them: 1 + steps above `from`, or the least value.
template <class Value>
PageCodes linear_codes(std::string name, std::size_t count, double step, const Value& value,
                       std::optional<double> from = {}) {
  const double least = extent_of(count, value).first;
  const double offset = from.value_or(std::isfinite(least) ? std::floor(least / step) * step : 0);
  PageCodes out{.name = std::move(name), .kind = "linear", .offset = offset, .step = step};
  out.codes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double code = 1 + std::round((value(i) - offset) / step);
    out.codes.push_back(std::isfinite(code) ? static_cast<std::uint64_t>(std::clamp(code, 1.0, max_page_code)) : 0);
  }
  return out;
}

/// Logarithmic codes: 1 + steps of the logarithm above the least value; 0 for others.
template <class Value>
PageCodes logarithmic_codes(std::string name, std::size_t count, double step, const Value& value) {
  const auto sound = [&](std::size_t i) { return value(i) > 0 ? value(i) : std::nan(""); };
  const double least = extent_of(count, sound).first, offset = std::isfinite(least) ? least : 1;
  PageCodes out{.name = std::move(name), .kind = "logarithmic", .offset = offset, .step = step, .differences = false};
  for (std::size_t i = 0; i < count; ++i) {
    const double code = 1 + std::round(std::log(sound(i) / least) / step);
    out.codes.push_back(std::isfinite(code) ? static_cast<std::uint64_t>(code) : 0);
  }
  return out;
}

/// Codes of few distinct whole values: 1 + the index in a list.
template <class Value>
PageCodes listed_codes(std::string name, std::size_t count, const Value& value) {
  std::vector<std::uint32_t> values;
  const auto whole = [&](std::size_t i) { return static_cast<std::uint32_t>(value(i)); };
  for (std::size_t i = 0; i < count; ++i)
    if (values.empty() || values.back() != whole(i)) values.push_back(whole(i));
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  PageCodes out{.name = std::move(name), .kind = "listed", .differences = false};
  for (std::size_t i = 0; i < count; ++i)
    out.codes.push_back(1 + std::uint64_t{pulsecast::detail::first_not(
                                values.size(), [&](std::size_t k) { return values[k] < whole(i); })});
  out.values = std::move(values);
  return out;
}

/// Step of a column: that of the page, or one of the extent of its values.
inline double step_of(const PagePoints& all, std::size_t column) noexcept {
  if (all.columns[column].step > 0) return all.columns[column].step;
  const auto value = [&](std::size_t i) { return all.value(i, column); };
  const auto [least, most] = extent_of(all.points.size(), value);
  return page_step(most > least ? most - least : 0, 1e-15);
}

/// True if a column has a value that says something.
inline bool says_something(const PagePoints& all, std::size_t column) noexcept {
  const std::optional<double>& plain = all.columns[column].plain;
  if (!plain) return true;
  for (std::size_t i = 0; i < all.points.size(); ++i) {
    const double v = all.value(i, column);
    if (std::isnan(*plain) ? !std::isnan(v) : v != *plain) return true;
  }
  return false;
}

/// Codes of a column of all points.
inline PageCodes codes_of(const PagePoints& all, std::size_t column) {
  const PageColumn& how = all.columns[column];
  const std::string& name = how.field.name;
  const std::size_t count = all.points.size();
  const auto value = [&all, column](std::size_t i) { return all.value(i, column); };
  if (how.coding == PageCoding::listed) return listed_codes(name, count, value);
  if (how.coding == PageCoding::logarithmic) return logarithmic_codes(name, count, how.step, value);
  PageCodes codes = linear_codes(name, count, step_of(all, column), value,
                                 how.coding == PageCoding::from_zero ? std::optional(0.0) : std::nullopt);
  codes.differences = how.coding == PageCoding::similar;
  if (how.further) codes.unit = how.field.column->unit;
  return codes;
}

/// Mean time between pulses [s].
inline double time_of_a_pulse(std::span<const PagePoint> points) {
  if (points.empty() || points.back().pulse <= points.front().pulse) return 0;
  const PagePoint &first = points.front(), &last = points.back();
  return (last.time - first.time) / static_cast<double>(last.pulse - first.pulse);
}

/// Replaces codes by differences to the previous one, with the sign in the lowest bit.
inline void make_differences(std::vector<std::uint64_t>& codes) {
  std::uint64_t before = 0;
  for (std::uint64_t& code : codes) {
    const std::uint64_t now = code;
    code = now >= before ? (now - before) * 2 : (before - now) * 2 - 1;
    before = now;
  }
}

/// JSON text after its length in four bytes, little-endian.
inline std::string with_length(const std::string& text) {
  std::string out;
  for (int k = 0; k < 4; ++k) out += static_cast<char>(text.size() >> 8 * k);
  return out + text;
}

/// Encoder of a block of columns: JSON header, and byte planes of all codes.
class PageBlock {
 public:
  explicit PageBlock(std::size_t count) { head_.begin_object().member("count", count).key("columns").begin_array(); }

  void add(PageCodes column) {
    if (column.differences) make_differences(column.codes);
    std::uint64_t all = 0;
    for (const std::uint64_t code : column.codes) all |= code;
    int count = 0;
    for (; all != 0; all >>= 8, ++count)
      for (const std::uint64_t code : column.codes) planes_.push_back(static_cast<std::uint8_t>(code >> 8 * count));
    head_.begin_object().member("name", column.name).member("kind", column.kind);
    if (column.kind == "listed") {
      head_.key("values").array(column.values.size(), [&column](std::size_t i) { return column.values[i]; });
    } else {
      head_.member("offset", column.offset).member("step", column.step);
    }
    if (column.unit) head_.member("unit", *column.unit);
    if (column.per_pulse) head_.member("per_pulse", *column.per_pulse);
    head_.member("differences", column.differences).member("planes", count).end_object();
  }

  /// Bytes of the whole block; `effort` is the compression level, 1 to 9.
  [[nodiscard]] std::string finish(int effort) {
    head_.end_array().end_object();
    std::vector<std::byte> packed;
    io::detail::DeflateEncoder(effort, io::detail::DeflateEncoder::no_head, Z_FILTERED)
        .encode(std::as_bytes(std::span(planes_)), true, packed);
    return with_length(head_.text()).append(reinterpret_cast<const char*>(packed.data()), packed.size());
  }

 private:
  detail::JsonWriter head_;
  std::vector<std::uint8_t> planes_;
};

/// Step of coordinates from the settings; if 0, chosen from the extent of the points [m].
inline double position_step(std::span<const PagePoint> points, const PageColumnSettings& settings) {
  if (settings.position_step > 0) return settings.position_step;
  if (points.empty()) return 1e-3;
  Vec3 least = points.front().position, most = least;
  for (const PagePoint& p : points) {
    least = min(least, p.position);
    most = max(most, p.position);
  }
  return page_step(max_norm(most - least));
}

}  // namespace detail

/// Encodes points for a page: length of a JSON text in four bytes; the text; deflated bytes.
///
///     {"count":N,"columns":[{"name":"x","kind":"linear","offset":0,"step":0.001,"differences":true,"planes":2},...]}
///
/// These are the byte planes of each column in turn, lowest byte first. A value is offset + (code - 1) step, offset
/// exp((code - 1) step), or the (code - 1)th of `values`; code 0: none. Differences are to the previous code, doubled,
/// less one if negative. `per_pulse`, times the pulse's number, is added. Values are exact to half a step: that of the
/// settings for positions and origins of pulses (`from_x`), time 0.1 us, scan angle 0.05 deg, incidence 0.5 deg,
/// reflectance 0.002, width 1 ps. Amplitudes are exact to 1 %, integers exactly. A colour is 65536 red + 256 green +
/// blue. Further columns have their `unit`; real ones are exact to a 130,000th of their extent.
[[nodiscard]] inline std::string page_columns(const PagePoints& all, const PageColumnSettings& settings = {}) {
  settings.validate();
  using detail::linear_codes;
  const std::vector<PagePoint>& points = all.points;
  const double step = detail::position_step(points, settings), each = detail::time_of_a_pulse(points);
  detail::PageBlock block(points.size());
  const auto add = [&](const std::string& name, double step_of_values, const auto& value) {
    return linear_codes(name, points.size(), step_of_values, [&](std::size_t i) { return value(points[i]); });
  };
  using Point = const PagePoint&;
  for (int k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    block.add(add(axis, step, [k](Point p) { return p.position[k]; }));
    block.add(add("from_" + axis, step, [k](Point p) {
      return p.position[k] + static_cast<double>(p.to_instrument[static_cast<std::size_t>(k)]);
    }));
  }
  block.add(add("pulse", 1, [](Point p) { return static_cast<double>(p.pulse); }));
  detail::PageCodes times = add("time", 1e-7, [each](Point p) { return p.time - each * static_cast<double>(p.pulse); });
  times.per_pulse = each;
  block.add(std::move(times));
  for (std::size_t k = 0; k < all.columns.size(); ++k)
    if (detail::says_something(all, k)) block.add(detail::codes_of(all, k));
  if (settings.keys) {
    detail::PageCodes keys = add("key", 1, [](Point p) { return static_cast<double>(p.key); });
    keys.differences = false;
    block.add(std::move(keys));
  }
  return block.finish(settings.effort);
}

/// Encodes bytes in base64. Source: RFC 4648, section 4.
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

}  // namespace PULSECAST_NAMESPACE::page

#endif
