// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include <pulsecast/io/spatial_reference.hpp>

namespace pulsecast::support {

/// Another database of reference systems than that of the test program, or none, for a while.
class WithDatabase {
 public:
  using Database = decltype(io::detail::reference_database);

  explicit WithDatabase(Database database) : before_(std::exchange(io::detail::reference_database, database)) {}
  ~WithDatabase() { io::detail::reference_database = before_; }
  WithDatabase(const WithDatabase&) = delete;
  WithDatabase& operator=(const WithDatabase&) = delete;

 private:
  Database before_;
};

}  // namespace pulsecast::support
