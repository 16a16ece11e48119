// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_TEXT_TEXT_POINT_COLUMNS_HPP
#define PULSECAST_IO_DETAIL_TEXT_TEXT_POINT_COLUMNS_HPP

#include <optional>

#include <pulsecast/base/require.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Columns of a text file of points, counted from 0.
struct TextPointColumns {
  using Columns = std::array<std::size_t, 3>;

  std::string separators = {};                       ///< characters; if empty, as `TextPoints` finds
  Columns position{0, 1, 2};                         ///< columns of x, y and z
  std::optional<Columns> normal = Columns{3, 4, 5};  ///< columns of its x, y and z
  std::optional<Columns> colour = Columns{6, 7, 8};  ///< columns of red, green and blue
  static constexpr std::size_t max_column = 999;     ///< upper limit of a column

  void validate() const {
    for (const char c : separators)
      if (std::string_view("+-.#/\r\n").find(c) != std::string_view::npos || (c >= '0' && c <= '9') ||
          (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'))
        throw SettingError("TextPointColumns::separators (character code)", static_cast<unsigned char>(c), "",
                           "that of a character outside numbers, comments and line ends");
    for (const Columns& columns : {position, normal.value_or(position), colour.value_or(position)})
      for (const std::size_t column : columns) require_within("TextPointColumns::column", column, 0, max_column, "");
  }
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
