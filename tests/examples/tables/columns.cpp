// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Prints the columns of a point as the rows of docs/tables/columns.md.

#include <array>
#include <iostream>
#include <string_view>

#include <pulsecast/io/point_columns.hpp>

using namespace pulsecast::io;

int main() {
  constexpr std::array<std::string_view, 11> types{"",       "int8",    "uint8",   "int16", "uint16", "int32",
                                                   "uint32", "float32", "float64", "int64", "uint64"};
  constexpr std::array<std::string_view, 6> needs{"", "", "the surface", "the colour", "", "the uncertainty"};
  for (const PointColumn& column : point_columns)
    std::cout << "| `" << column.name << "` | " << column.unit << " | " << types[static_cast<std::size_t>(column.type)]
              << " | " << column.description << " | " << needs[static_cast<std::size_t>(column.needs)] << " |\n";
}
