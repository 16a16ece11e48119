// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_INPUT_FILE_HPP
#define PULSECAST_IO_INPUT_FILE_HPP

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <ios>
#include <new>
#include <span>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <pulsecast/base/text.hpp>

namespace PULSECAST_NAMESPACE::io {

/// File read from beginning to end in blocks, as bytes or as lines; memory is independent of its size.
class InputFile {
 public:
  static constexpr std::size_t block_size = std::size_t{1} << 20;  ///< limit of a line, and of one `take` [byte]

  /// `expected` content for error messages, as in "a point cloud". Throws a `FileError` if there is no such file, or it
  /// is empty.
  InputFile(const std::filesystem::path& path, std::string_view expected) : path_(path.string()) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) fail("does not exist: expected " + std::string(expected));
    if (!std::filesystem::is_regular_file(path, ignored))
      fail("is a directory or device: expected " + std::string(expected));
    file_.open(path, std::ios::binary);
    if (!file_) fail("cannot be read");
    file_.seekg(0, std::ios::end);
    const std::streamoff end = file_.tellg();
    if (end < 0) fail("cannot be read");
    size_ = static_cast<std::uint64_t>(end);
    if (size_ == 0) fail("is empty: expected " + std::string(expected));
    block_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(size_, block_size)));
    seek(0);
  }

  [[nodiscard]] const std::string& path() const noexcept { return path_; }     ///< path, for messages
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }          ///< size of the file [byte]
  [[nodiscard]] std::uint64_t position() const noexcept { return position_; }  ///< offset of the next byte
  [[nodiscard]] std::size_t line() const noexcept { return line_; }           ///< number of the line taken last, from 1
  [[nodiscard]] bool line_is_open() const noexcept { return line_is_open_; }  ///< true for a last line without end

  /// Moves to any byte, and restarts the count of lines there.
  void seek(std::uint64_t byte) {
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(byte));
    position_ = byte;
    begin_ = end_ = line_ = 0;
  }

  /// Next bytes, at most `block_size`; fewer at the end of the file. Valid until more is taken.
  [[nodiscard]] std::string_view take(std::size_t bytes) {
    if (end_ - begin_ < bytes) refill();
    return advance(std::min(bytes, end_ - begin_));
  }

  /// Next line without its end (LF or CR LF); empty at the end of the file. Valid until more is taken. Throws a
  /// `FileError` for a line longer than `block_size`.
  [[nodiscard]] std::optional<std::string_view> take_line() {
    std::string_view rest = unread(), line = text::take_line(rest);
    if (rest.empty() && !unread().ends_with('\n')) {
      refill();
      rest = unread();
      line = text::take_line(rest);
    }
    const std::string_view taken = advance(unread().size() - rest.size());
    if (taken.empty()) return std::nullopt;
    ++line_;
    line_is_open_ = taken.back() != '\n';
    if (line_is_open_ && taken.size() == block_size)
      fail_at_line(text::joined({"is longer than ", std::to_string(block_size), " bytes"}));
    return line_ == 1 ? text::without_byte_order_mark(line) : line;
  }

  /// Rest of the file, without the byte order mark at its beginning.
  [[nodiscard]] std::string take_rest() {
    std::string rest;
    for (std::string_view bytes = take(block_size); !bytes.empty(); bytes = take(block_size))
      rest += position_ == bytes.size() ? text::without_byte_order_mark(bytes) : bytes;
    return rest;
  }

  /// Throws a `FileError` about the whole file.
  [[noreturn]] void fail(const std::string& problem) const { throw FileError(path_, "", problem); }
  /// Throws a `FileError` about the line taken last.
  [[noreturn]] void fail_at_line(const std::string& problem) const {
    throw FileError(path_, "line " + std::to_string(line_), problem);
  }
  /// `column` is counted from 0 here, from 1 in the message.
  [[noreturn]] void fail_at_column(std::size_t column, const std::string& problem) const {
    throw FileError(path_, text::joined({"line ", std::to_string(line_), ", column ", std::to_string(column + 1)}),
                    problem);
  }
  /// Throws a `FileError` about a byte, from 0.
  [[noreturn]] void fail_at_byte(std::uint64_t byte, const std::string& problem) const {
    throw FileError(path_, "byte " + std::to_string(byte), problem);
  }

 private:
  /// Part of the block that was not taken.
  [[nodiscard]] std::string_view unread() const noexcept { return {block_.data() + begin_, end_ - begin_}; }

  [[nodiscard]] std::string_view advance(std::size_t bytes) noexcept {
    const std::string_view taken(block_.data() + begin_, bytes);
    begin_ += bytes;
    position_ += bytes;
    return taken;
  }

  /// Moves the rest of the block to its beginning and fills it up.
  void refill() {
    end_ -= begin_;
    std::memmove(block_.data(), block_.data() + begin_, end_);
    begin_ = 0;
    file_.read(block_.data() + end_, static_cast<std::streamsize>(block_.size() - end_));
    if (file_.bad()) fail("cannot be read");
    end_ += static_cast<std::size_t>(file_.gcount());
  }

  std::string path_;
  std::ifstream file_;
  std::uint64_t size_ = 0, position_ = 0;
  std::vector<char> block_;
  std::size_t begin_ = 0, end_ = 0;  // unread part of the block
  std::size_t line_ = 0;
  bool line_is_open_ = false;
};

/// Memory-mapped file, read-only, aligned to a page. Its name may be reused for another file meanwhile; the file itself
/// must not be written to. Throws a `FileError` if it cannot be mapped, or is a pipe (without waiting for it).
class MappedFile {
 public:
  /// Maps a file; `expected` content for error messages, as in "an XML file", if any. @throws FileError
  explicit MappedFile(const std::filesystem::path& path, std::string_view expected = {}) {
    const auto fail = [&](std::string_view problem) {
      throw FileError(path.string(), "", text::joined({problem, expected.empty() ? "" : ": expected ", expected}));
    };
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

  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }  ///< content of the file
  /// Content of the file, as text.
  [[nodiscard]] std::string_view text() const noexcept {
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
  }

 private:
  struct Descriptor {
    int number;
    ~Descriptor() {
      if (number >= 0) ::close(number);
    }
  };

  std::span<const std::byte> bytes_;
};

namespace detail {
/// Regular files of a folder, sorted; by a `recursive_directory_iterator`, those of the folders below it, too.
/// @throws FileError if it cannot be read
template <class Iterator = std::filesystem::directory_iterator>
[[nodiscard]] std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error, ignored;
  for (Iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file(ignored)) files.push_back(entry->path());
  if (error) throw FileError(folder.string(), "", "cannot be read: " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}
}  // namespace detail

/// Calls a function that reads a file. Too little memory for what it holds is a `FileError`.
template <class Function>
decltype(auto) reading(const std::filesystem::path& path, const Function& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw FileError(path.string(), "", "takes more memory than there is: expected a smaller file, or more free memory");
  }
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
