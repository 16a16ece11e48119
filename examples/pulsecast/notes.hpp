// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <iostream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "options.hpp"

/// Notes for the user, each printed once.
class Notes {
 public:
  explicit Notes(const Options& options) : quiet_(options.quiet), strict_(options.strict) {}

  /// Notes an oddity of the survey or its files: an error with `--strict`.
  void odd(const std::string& text) {
    if (!strict_) return say(text);
    if (told_.insert(text).second) {
      std::cerr << "error: " << text << '\n';
      ++errors_;
    }
  }
  void odd(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) odd(text);
  }

  /// Notes any other oddity or information.
  void say(const std::string& text) {
    if (!quiet_ && told_.insert(text).second) std::cerr << "note: " << text << '\n';
  }
  void say(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) say(text);
  }

  /// Throws if a note is an error.
  void require_none() const {
    if (errors_ > 0)
      throw std::invalid_argument("--strict treats notes as errors: " + std::to_string(errors_) + " of them");
  }

 private:
  bool quiet_, strict_;
  std::size_t errors_ = 0;
  std::set<std::string> told_;
};
