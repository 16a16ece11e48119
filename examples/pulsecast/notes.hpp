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
  /// Appends them to `kept`, and prints none.
  explicit Notes(std::vector<std::string>& kept) : kept_(&kept) {}

  /// Prints a warning about the survey or its files: an error with `--strict`.
  void warn(const std::string& text) {
    if (!strict_) return note(text);
    if (printed_.insert(text).second) {
      std::cerr << "error: " << text << '\n';
      ++errors_;
    }
  }
  void warn(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) warn(text);
  }

  /// Prints any other note.
  void note(const std::string& text) {
    if (quiet_ || !printed_.insert(text).second) return;
    if (kept_ != nullptr)
      kept_->push_back(text);
    else
      std::cerr << "note: " << text << '\n';
  }
  void note(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) note(text);
  }

  /// Throws if a note is an error.
  void require_none() const {
    if (errors_ > 0)
      throw std::invalid_argument("--strict treats notes as errors: " + std::to_string(errors_) + " of them");
  }

 private:
  bool quiet_ = false, strict_ = false;
  std::vector<std::string>* kept_ = nullptr;
  std::size_t errors_ = 0;
  std::set<std::string> printed_;
};
