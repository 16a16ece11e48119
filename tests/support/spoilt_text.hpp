// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "support/generators.hpp"

namespace pulsecast::support {

/// A text that was spoilt so many times: bytes are changed, lost, doubled or cut off, and words come in that may mean
/// something there.
[[nodiscard]] inline std::string spoilt(std::string text, std::size_t times, std::span<const char* const> words,
                                        Generator& random) {
  const auto draw = [&random](std::size_t below) { return static_cast<std::size_t>(random.whole(below)); };
  for (; times > 0 && !text.empty(); --times) {
    const std::size_t at = draw(text.size());
    switch (draw(6)) {
      case 0:
        text[at] = static_cast<char>(draw(256));
        break;
      case 1:
        text.erase(at, 1 + draw(5));
        break;
      case 2:
        text.insert(at, words[draw(words.size())]);
        break;
      case 3:
        text.insert(at, text.substr(draw(text.size()), 1 + draw(40)));
        break;
      case 4:
        text.resize(at);
        break;
      default:
        text[at] = "0123456789 -./\n"[draw(15)];
    }
  }
  return text;
}

}  // namespace pulsecast::support
