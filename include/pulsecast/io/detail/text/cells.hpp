// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TEXT_CELLS_HPP
#define PULSECAST_IO_DETAIL_TEXT_CELLS_HPP

#include <array>
#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

#include <pulsecast/base/text.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Splitter of rows into cells.
class RowCells {
 public:
  RowCells() = default;

  /// Any of the characters `separators` ends a cell. If `joins_blanks` is set, blanks and tabs around cells do not
  /// count, and as separators several count as one.
  RowCells(std::string_view separators, bool joins_blanks) : joins_blanks_(joins_blanks) {
    for (const char c : separators) separates_[static_cast<unsigned char>(c)] = true;
  }

  /// Splits a row into `max_cells` cells at most, without the blanks around them. Valid as long as the row, until the
  /// next one.
  const std::vector<std::string_view>& split(std::string_view row,
                                             std::size_t max_cells = std::numeric_limits<std::size_t>::max()) {
    cells_.clear();
    const auto skip_blanks = [&](std::size_t at) {
      while (joins_blanks_ && at < row.size() && text::is_blank(row[at])) ++at;
      return at;
    };
    if (joins_blanks_) row = text::trimmed(row);
    for (std::size_t begin = 0; cells_.size() < max_cells;) {
      std::size_t end = begin;
      while (end < row.size() && !separates(row[end])) ++end;
      cells_.push_back(text::trimmed(row.substr(begin, end - begin)));
      begin = skip_blanks(end);
      if (begin == row.size()) break;
      if (separates(row[begin])) ++begin;  // not after separating blanks
      begin = skip_blanks(begin);
    }
    return cells_;
  }

  [[nodiscard]] const std::vector<std::string_view>& cells() const noexcept {
    return cells_;
  }  ///< of the row that was split last

 private:
  [[nodiscard]] bool separates(char c) const noexcept { return separates_[static_cast<unsigned char>(c)]; }

  std::array<bool, 256> separates_{};
  bool joins_blanks_ = true;
  std::vector<std::string_view> cells_;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
