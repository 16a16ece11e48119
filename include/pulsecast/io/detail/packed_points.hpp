// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PACKED_POINTS_HPP
#define PULSECAST_IO_DETAIL_PACKED_POINTS_HPP

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <pulsecast/base/require.hpp>
#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/point_records.hpp>

/// Points as point files hold them: PCD, PLY, NPZ, text.
namespace PULSECAST_NAMESPACE::io::detail {

static_assert(std::endian::native == std::endian::little, "point files are written as the numbers lie in memory");

/// Throws a `SettingError` for a layout or settings out of range, and unless names are unique, and valid in a header.
inline void require_packable(const PointLayout& layout, const PointSettings& points) {
  layout.validate();
  points.validate();
  for (const PointField& field : layout.fields) {
    require_within("PointField::name (length)", static_cast<double>(field.name.size()), 1, 100, "");
    for (const char c : field.name)
      if (!(c > ' ' && c <= '~' && c != '/'))
        throw SettingError("PointField::name (character code)", static_cast<unsigned char>(c), "",
                           "that of a visible ASCII character but /");
    const auto same = std::ranges::count_if(layout.fields, [&](const PointField& f) { return f.name == field.name; });
    require_within("PointField::name (number of " + field.name + ")", static_cast<double>(same), 1, 1, "");
  }
}

/// Encoder of packed records, of echoes or of the records of a buffer.
class PackedPoints {
 public:
  /// Packs the fields of `layout`, which must be packable.
  PackedPoints(const PointLayout& layout, const PointSettings& settings)
      : encoder_(PointLayout::packed(layout.fields), settings) {}

  [[nodiscard]] const PointLayout& layout() const noexcept { return encoder_.layout(); }

  /// Records of the echoes of a batch, valid until the next call. Times since a scan's start count from tick 0.
  [[nodiscard]] std::span<const std::byte> of(const EchoBatch& batch) {
    records_.clear();
    encoder_.encode(batch, records_);
    return records_;
  }

  /// Records of a buffer, valid until the next call. @throws SettingError for a buffer of other fields
  [[nodiscard]] std::span<const std::byte> of(const PointBuffer& points) {
    const std::vector<PointField>&from = points.layout().fields, &to = layout().fields;
    const bool narrows = std::ranges::none_of(to, [](const PointField& f) { return f.type >= NumberType::int64; });
    for (std::size_t k = 0; k < std::max(from.size(), to.size()); ++k)
      if (k >= from.size() || k >= to.size() || !same_number(from[k], to[k], narrows))
        throw SettingError("PointBuffer::layout (index of a field)", static_cast<double>(k), "",
                           "of fields as those of the file");
    if (points.layout().size == layout().size && std::ranges::equal(from, to, {}, &PointField::type, &PointField::type))
      return points.records();
    records_.resize(points.size() * layout().size);
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t k = 0; k < to.size(); ++k) {
        std::byte* const at = records_.data() + i * layout().size + to[k].offset;
        if (from[k].type == to[k].type)
          std::memcpy(at, points.records().data() + i * points.layout().size + from[k].offset, size_of(to[k].type));
        else
          store_number<double>(points.number(i, from[k]), at);
      }
    return records_;
  }

 private:
  /// `narrows`: 64-bit integers of `a` become doubles.
  [[nodiscard]] static bool same_number(const PointField& a, const PointField& b, bool narrows) {
    const bool same_type =
        a.type == b.type || (narrows && a.type >= NumberType::int64 && b.type == NumberType::float64);
    return a.name == b.name && same_type && a.column == b.column && a.scale == b.scale;
  }

  PointEncoder encoder_;
  std::vector<std::byte> records_;
};

/// Columns of packed records: the numbers of each field one after another.
class FieldColumns {
 public:
  explicit FieldColumns(const PointLayout& packed) : columns_(packed.fields.size()), layout_(packed) {}

  void add(std::span<const std::byte> records) {
    const std::size_t count = records.size() / layout_.size;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const std::size_t size = size_of(layout_.fields[k].type), begin = columns_[k].size();
      columns_[k].resize(begin + count * size);
      for (std::size_t i = 0; i < count; ++i)
        std::memcpy(columns_[k].data() + begin + i * size, records.data() + i * layout_.size + layout_.fields[k].offset,
                    size);
    }
  }

  /// Numbers of each field of the layout.
  [[nodiscard]] const std::vector<std::vector<std::byte>>& all() const noexcept { return columns_; }

 private:
  std::vector<std::vector<std::byte>> columns_;
  PointLayout layout_;
};

/// Adds a number of a record to a row of text: in the shortest form that reads back the same; nan for NaN.
inline void add_number(TextRow& row, NumberType type, const std::byte* from) {
  visit_number_type(type, [&]<class Number>() {
    Number number;
    std::memcpy(&number, from, sizeof number);
    if constexpr (std::is_integral_v<Number>) {
      row.add(number);
    } else if (std::isnan(number)) {
      row.add(std::string_view("nan"));
    } else {
      std::array<char, 32> digits;
      row.add(std::string_view(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr));
    }
  });
}

/// Text of a count, and blanks up to the length of the longest: for headers that are written again with another count.
struct CountText {
  std::string digits, blanks;

  explicit CountText(std::uint64_t count) : digits(std::to_string(count)) {
    blanks.assign(std::numeric_limits<std::uint64_t>::digits10 + 1 - digits.size(), ' ');
  }
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
