// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_PACKED_POINTS_HPP
#define PULSECAST_IO_DETAIL_PACKED_POINTS_HPP

#include <pulsecast/io/detail/text/output.hpp>
#include <pulsecast/io/point_records.hpp>

/// Points as point files hold them: PCD, PLY, NPZ, text.
namespace PULSECAST_NAMESPACE::io::detail {

/// @throws SettingError for layout or settings out of range, or names not unique or visible ASCII
inline void require_packable(const PointLayout& layout, const PointSettings& points) {
  layout.validate();
  points.validate();
  for (const PointField& field : layout.fields) {
    require_within("PointField::name (length)", field.name.size(), 1, 100, "");
    for (const char c : field.name)
      if (!(c > ' ' && c <= '~' && c != '/'))
        throw SettingError("PointField::name (character code)", static_cast<unsigned char>(c), "",
                           "that of a visible ASCII character but /");
    const auto same = static_cast<double>(std::ranges::count(layout.fields, field.name, &PointField::name));
    require_within("PointField::name (number of " + field.name + ")", same, 1, 1, "");
  }
}

/// Encoder of packed records, of echoes or of the records of a buffer.
class PackedPoints {
 public:
  /// Packs the fields of `layout`, which must be packable.
  PackedPoints(const PointLayout& layout, const PointSettings& settings)
      : encoder_(PointLayout::packed(layout.fields), settings) {}

  [[nodiscard]] const PointLayout& layout() const noexcept { return encoder_.layout(); }

  /// Records of the echoes of a batch, valid until the next call. Scans start at tick 0.
  [[nodiscard]] std::span<const std::byte> of(const EchoBatch& batch) {
    records_.clear();
    encoder_.encode(batch, records_);
    return records_;
  }

  /// Records of a buffer, valid until the next call. @throws SettingError for other fields
  [[nodiscard]] std::span<const std::byte> of(const PointBuffer& points) {
    const std::vector<PointField>&from = points.layout().fields, &to = layout().fields;
    const auto is_64 = [](NumberType type) { return type >= NumberType::int64; };
    const bool narrows = std::ranges::none_of(to, is_64, &PointField::type);
    for (std::size_t k = 0; k < std::max(from.size(), to.size()); ++k)
      if (k >= from.size() || k >= to.size() || !same_number(from[k], to[k], narrows))
        throw SettingError("PointBuffer::layout (index of a field)", static_cast<double>(k), "",
                           "of fields as those of the file");
    constexpr auto type = &PointField::type;
    if (points.layout().size == layout().size && std::ranges::equal(from, to, {}, type, type)) return points.records();
    records_.resize(points.size() * layout().size);
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t k = 0; k < to.size(); ++k) {
        std::byte* const at = records_.data() + i * layout().size + to[k].offset;
        const std::byte* const old = points.records().data() + i * points.layout().size + from[k].offset;
        if (from[k].type == to[k].type)
          std::memcpy(at, old, size_of(to[k].type));
        else
          store_number<double>(points.number(i, from[k]), at);
      }
    return records_;
  }

 private:
  /// `narrows`: 64-bit integers of `a` become doubles.
  [[nodiscard]] static bool same_number(const PointField& a, const PointField& b, bool narrows) {
    const NumberType type = narrows ? std::min(a.type, NumberType::float64) : a.type;
    return a.name == b.name && type == b.type && a.column == b.column && a.scale == b.scale;
  }

  PointEncoder encoder_;
  std::vector<std::byte> records_;
};

/// Columns of packed records: the numbers of each field one after another.
class FieldColumns {
 public:
  explicit FieldColumns(const PointLayout& packed) : all_(packed.fields.size()), layout_(packed) {}

  void add(std::span<const std::byte> records) {
    const std::size_t count = records.size() / layout_.size;
    for (std::size_t k = 0; k < all_.size(); ++k) {
      const std::size_t size = size_of(layout_.fields[k].type), begin = all_[k].size();
      all_[k].resize(begin + count * size);
      for (std::size_t i = 0; i < count; ++i)  // of no records, there is no pointer to add to
        std::memcpy(all_[k].data() + begin + i * size, &records[i * layout_.size + layout_.fields[k].offset], size);
    }
  }

  /// Numbers of each field of the layout.
  [[nodiscard]] const std::vector<std::vector<std::byte>>& all() const noexcept { return all_; }

 private:
  std::vector<std::vector<std::byte>> all_;
  PointLayout layout_;
};

/// Adds a number of a record to a row, in the shortest form that reads back the same; nan for NaN.
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
      const auto [end, error] = std::to_chars(digits.begin(), digits.end(), number);
      row.add(std::string_view(digits.begin(), end));
    }
  });
}

/// Text of a count, and blanks up to the longest, for headers written again with another count.
struct CountText {
  std::string digits, blanks;

  explicit CountText(std::uint64_t count) : digits(std::to_string(count)) {
    blanks.assign(std::numeric_limits<std::uint64_t>::digits10 + 1 - digits.size(), ' ');
  }
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
