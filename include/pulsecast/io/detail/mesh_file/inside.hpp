// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_INSIDE_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_INSIDE_HPP

#include <filesystem>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// True for a path that does not leave a folder by its words; links are followed.
[[nodiscard]] inline bool is_inside(const std::filesystem::path& folder, const std::filesystem::path& file) {
  const std::filesystem::path within =
      std::filesystem::absolute(file).lexically_normal().lexically_relative(std::filesystem::absolute(folder).lexically_normal());
  return !within.empty() && *within.begin() != "..";
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
