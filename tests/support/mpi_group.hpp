// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <pulsecast/mpi/detail/output.hpp>

#include "support/temporary_folder.hpp"

namespace pulsecast::support {

/// All processes of a test: one, or those that mpirun has started.
inline mpi::MpiGroup& mpi_group() {
  static mpi::MpiSession session;
  static mpi::MpiGroup group;
  return group;
}

/// A temporary folder of all of them.
class SharedFolder {
 public:
  SharedFolder() {
    if (mpi_group().first()) own_.emplace();
    path_ = mpi_group().channel().from_first(own_ ? own_->path().string() : std::string());
  }
  ~SharedFolder() { (void)mpi_group().channel().gather(0); }

  [[nodiscard]] friend std::filesystem::path operator/(const SharedFolder& folder, std::string_view name) {
    return folder.path_ / name;
  }

 private:
  std::optional<TemporaryFolder> own_;
  std::filesystem::path path_;
};

}  // namespace pulsecast::support
