// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_DIGEST_HPP
#define PULSECAST_IO_DETAIL_DIGEST_HPP

#include <memory>

#include <xxhash.h>

#include <pulsecast/io/input_file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// 128-bit hash of bytes; not safe against deliberate collisions.
struct Fingerprint {
  std::uint64_t low = 0, high = 0;  ///< halves of the hash
  friend bool operator==(const Fingerprint&, const Fingerprint&) = default;
};

/// Incremental hash by XXH3.
class Digest {
 public:
  Digest() { XXH3_128bits_reset(state_.get()); }

  /// Adds bytes; two adjoining runs count as one.
  void add(std::span<const std::byte> bytes) { XXH3_128bits_update(state_.get(), bytes.data(), bytes.size()); }
  /// Adds a number, as its eight bytes.
  void add(std::uint64_t number) { add(std::as_bytes(std::span(&number, 1))); }
  void add(const Fingerprint& other) {
    add(other.low);
    add(other.high);
  }
  /// Adds a text with its length, so that the boundary between texts matters.
  void add(std::string_view text) {
    add(std::uint64_t{text.size()});
    add(std::as_bytes(std::span(text)));
  }

  /// Adds the content of a file; of a folder, the content and names of all files below it. The path
  /// itself does not matter. @throws FileError if it cannot be read
  void add_content(const std::filesystem::path& path) {
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(path, ignored);
    if (std::filesystem::is_directory(status)) {
      const auto files = detail::files_in<std::filesystem::recursive_directory_iterator>(path);
      for (const std::filesystem::path& file : files) {
        add(std::string_view(file.lexically_relative(path).string()));
        add_file(file);
      }
      add(std::uint64_t{files.size()});
    } else if (std::filesystem::is_regular_file(status)) {
      add_file(path);
    } else {
      detail::fail(path, std::filesystem::exists(status) ? "is neither a file nor a folder" : "does not exist");
    }
  }

  [[nodiscard]] Fingerprint value() const {  ///< fingerprint of all bytes added
    const XXH128_hash_t all = XXH3_128bits_digest(state_.get());
    return {all.low64, all.high64};
  }

 private:
  void add_file(const std::filesystem::path& path) {
    std::error_code ignored;
    std::optional<MappedFile> file;
    if (std::filesystem::file_size(path, ignored) > 0) file.emplace(path);
    if (file) add(file->bytes());
    add(std::uint64_t{file ? file->bytes().size() : 0});
  }

  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_{XXH3_createState(), XXH3_freeState};
};

/// Fingerprint of the content of a file or folder. Throws a `FileError` if it cannot be read.
[[nodiscard]] inline Fingerprint content_fingerprint(const std::filesystem::path& path) {
  Digest digest;
  digest.add_content(path);
  return digest.value();
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
