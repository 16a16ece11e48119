// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

/// Binary FBX files of assimp 5.2, whose lists of nodes lack the ends that the format, and its own reader, ask for.
/// Source of the layout: A. Gessler, FBX binary file format specification, 2013.
namespace pulsecast::support {

class FbxLists {
 public:
  /// The file with an end of 25 zeros after each list.
  [[nodiscard]] static std::string ended(const std::string& file) {
    FbxLists lists(file);
    std::string made = file.substr(0, 27);
    lists.at_ = 27;
    while (lists.number(0) != 0) lists.node(made);
    return made + file.substr(lists.at_);
  }

 private:
  explicit FbxLists(const std::string& file) : file_(file) {}

  /// Number of the head of the node here: 0 its end, 1 the number of its properties, 2 their size.
  [[nodiscard]] std::uint64_t number(std::size_t which) const {
    std::uint64_t value = 0;
    std::memcpy(&value, file_.data() + at_ + 8 * which, 8);
    return value;
  }

  void node(std::string& made) {
    const std::size_t begin = made.size(), end = number(0),
                      head = 25 + static_cast<unsigned char>(file_[at_ + 24]) + number(2);
    made.append(file_, at_, head);
    at_ += head;
    const bool has_list = at_ < end;
    while (at_ < end && number(0) != 0) node(made);
    if (has_list) made.append(25, '\0');
    at_ = end;
    const std::uint64_t size = made.size();
    std::memcpy(made.data() + begin, &size, 8);
  }

  const std::string& file_;
  std::size_t at_ = 0;
};

}  // namespace pulsecast::support
