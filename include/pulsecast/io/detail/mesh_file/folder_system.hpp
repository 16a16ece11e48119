// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_MESH_FILE_FOLDER_SYSTEM_HPP
#define PULSECAST_IO_DETAIL_MESH_FILE_FOLDER_SYSTEM_HPP

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <assimp/DefaultIOSystem.h>
#include <assimp/IOSystem.hpp>

#include <pulsecast/io/detail/mesh_file/inside.hpp>

/// Files that an importer of assimp may open.
namespace PULSECAST_NAMESPACE::io::detail {

/// Regular files of a folder and of those below it, for reading.
class FolderSystem : public Assimp::IOSystem {
 public:
  /// Calls `opened` with the size of each file [byte] before it is opened first.
  FolderSystem(std::filesystem::path folder, bool anywhere, std::function<void(std::uint64_t)> opened)
      : folder_(std::move(folder)), anywhere_(anywhere), opened_(std::move(opened)) {}

  /// First file that was refused, as it is outside; empty if there is none.
  [[nodiscard]] const std::string& refused() const noexcept { return refused_; }

  /// Files that the importer requested, existing or not.
  [[nodiscard]] const std::set<std::string>& looked_for() const noexcept { return looked_for_; }

  bool Exists(const char* file) const override { return is_open_to(found(file)); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* named, const char* mode) override {
    const std::string file = found(named);
    if (std::string_view(mode).find_first_of("wa+") != std::string_view::npos || !is_open_to(file)) return nullptr;
    std::error_code ignored;
    const auto size = std::filesystem::file_size(file, ignored);
    if (!ignored && opened_ && known_.insert(file).second) opened_(size);
    return files_.Open(file.c_str(), mode);
  }
  void Close(Assimp::IOStream* stream) override { files_.Close(stream); }

 private:
  /// Name as it is, or with its percent codes decoded, if there is no such file. Source: glTF 2.0, 3.6.1.1 (URIs).
  [[nodiscard]] std::string found(const char* file) const {
    looked_for_.insert(file);
    std::error_code ignored;
    return std::filesystem::exists(file, ignored) ? file : unescaped(file);
  }
  [[nodiscard]] bool is_open_to(const std::string& file) const {
    looked_for_.insert(file);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return false;
    if (anywhere_ || is_inside(folder_, file)) return true;
    if (refused_.empty()) refused_ = file;
    return false;
  }

  Assimp::DefaultIOSystem files_;
  std::filesystem::path folder_;
  bool anywhere_;
  std::function<void(std::uint64_t)> opened_;
  std::set<std::string> known_;  ///< files that were opened
  mutable std::set<std::string> looked_for_;
  mutable std::string refused_;
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
