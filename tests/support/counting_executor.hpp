// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <utility>

#include <pulsecast/base/parallel.hpp>

namespace pulsecast::support {

/// Executor of the caller's thread that counts its calls.
class CountingExecutor {
 public:
  unsigned threads() const { return 2; }
  void for_each(std::size_t count, const IndexTask& task) {
    ++calls_;
    while (count-- > 0) task(count);
  }
  /// Calls since this was last asked.
  int calls() { return std::exchange(calls_, 0); }

 private:
  int calls_ = 0;
};

}  // namespace pulsecast::support
