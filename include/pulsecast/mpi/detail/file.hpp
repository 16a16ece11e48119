// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_MPI_DETAIL_FILE_HPP
#define PULSECAST_MPI_DETAIL_FILE_HPP

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include <pulsecast/base/error.hpp>
#include <pulsecast/io/output_file.hpp>

namespace PULSECAST_NAMESPACE::mpi {

/// Temporary file of an `OutputFile` of the first process, which others write in disjoint ranges. Opened at the first
/// write. Throws a `FileError` that names the final path.
class MpiFile {
 public:
  explicit MpiFile(std::filesystem::path path) : path_(std::move(path)) {}
  MpiFile(const MpiFile&) = delete;
  MpiFile& operator=(const MpiFile&) = delete;
  ~MpiFile() {
    if (file_ >= 0) ::close(file_);
  }

  void write(std::uint64_t position, std::span<const std::byte> bytes) {
    if (file_ < 0 && !bytes.empty())
      file_ = ::open(io::OutputFile::temporary_name(path_).c_str(), O_WRONLY | O_CLOEXEC);
    while (!bytes.empty()) {
      const ssize_t written =
          file_ < 0 ? -1 : ::pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(position));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) fail(bytes.size());
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      position += static_cast<std::uint64_t>(written);
    }
  }

  /// Flushes to the disk and closes; the system may report write errors only now.
  void close() {
    if (file_ < 0) return;
    if (!io::sync_to_disk(file_)) fail(0);
    if (::close(std::exchange(file_, -1)) != 0) fail(0);
  }

  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

 private:
  [[noreturn]] void fail(std::size_t bytes) const {
    throw FileError(path_.string(), "",
                    "cannot be written by all processes: " + std::generic_category().message(errno) +
                        "; expected room for " + std::to_string(bytes) +
                        " more bytes in a folder that all machines share");
  }

  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace PULSECAST_NAMESPACE::mpi

#endif
