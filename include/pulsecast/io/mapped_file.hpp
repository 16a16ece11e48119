// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <pulsecast/base/error.hpp>

namespace pulsecast::io {

/// Memory-mapped file, read-only, aligned to a page. Its name may be reused for another file meanwhile; the file itself must not be written
/// to. Throws a `FileError` if it cannot be mapped, or is a pipe (without waiting for it).
class MappedFile {
 public:
  /// Maps a file.
  explicit MappedFile(const std::filesystem::path& path) {
    const auto fail = [&](const std::string& problem) { throw FileError(path.string(), "", problem); };
    const auto system_error = [] { return std::generic_category().message(errno); };
    const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (file.number < 0) fail(errno == ENOENT ? "does not exist" : "cannot be read: " + system_error());
    struct stat status {};
    if (::fstat(file.number, &status) != 0 || !S_ISREG(status.st_mode)) fail("is a directory or device");
    const auto size = static_cast<std::size_t>(status.st_size);
    if (size == 0) fail("is empty");
    void* const memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number, 0);
    if (memory == MAP_FAILED) fail("cannot be mapped into memory: " + system_error());
    bytes_ = {static_cast<const std::byte*>(memory), size};
  }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile() { ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size()); }

  /// Content of the file.
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
  struct Descriptor {
    int number;
    ~Descriptor() {
      if (number >= 0) ::close(number);
    }
  };

  std::span<const std::byte> bytes_;
};

}  // namespace pulsecast::io
