// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_INPUT_FILE_HPP
#define PULSECAST_IO_INPUT_FILE_HPP

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <ios>
#include <new>
#include <span>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <pulsecast/base/text.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {
[[nodiscard]] inline std::string system_error() { return std::generic_category().message(errno); }

/// Throws a `FileError` about a whole file, of texts and numbers.
[[noreturn]] void fail(const std::filesystem::path& path, const auto&... problem) {
  throw FileError(path.string(), "", text::message(problem...));
}

/// Throws a `FileError` about a line.
[[noreturn]] void fail_at(const std::string& path, std::size_t line, const auto&... problem) {
  throw FileError(path, text::message("line ", line), text::message(problem...));
}

/// Warning about a line of a file, or all of it for line 0.
[[nodiscard]] std::string warning(std::string_view path, std::size_t line, const auto&... oddity) {
  return line > 0 ? text::message(path, ", line ", line, ": ", oddity...) : text::message(path, ": ", oddity...);
}
}  // namespace detail

/// File read from beginning to end in blocks, as bytes or lines; memory is independent of its size.
class InputFile {
 public:
  static constexpr std::size_t block_size = std::size_t{1} << 20;  ///< limit of a line or `take` [byte]

  static constexpr std::string_view cr_alone =
      "has lines that end in CR alone: expected LF or CR LF, as tr '\\r' '\\n' makes them";  ///< problem

  /// `expected` content for messages, as in "a point cloud". @throws FileError if missing or empty
  InputFile(const std::filesystem::path& path, std::string_view expected) : path_(path.string()) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) fail("does not exist: expected ", expected);
    if (!std::filesystem::is_regular_file(path, ignored)) fail("is a directory or device: expected ", expected);
    file_.open(path, std::ios::binary);
    if (!file_) fail("cannot be read");
    file_.seekg(0, std::ios::end);
    const std::streamoff end = file_.tellg();
    if (end < 0) fail("cannot be read");
    size_ = static_cast<std::uint64_t>(end);
    if (size_ == 0) fail("is empty: expected ", expected);
    block_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(size_, block_size)));
    seek(0);
  }

  [[nodiscard]] const std::string& path() const noexcept { return path_; }     ///< for messages
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }          ///< of the file [byte]
  [[nodiscard]] std::uint64_t position() const noexcept { return position_; }  ///< of the next byte
  [[nodiscard]] std::size_t line() const noexcept { return line_; }            ///< line taken last, from 1
  [[nodiscard]] bool line_is_open() const noexcept { return line_is_open_; }   ///< for a last line without end

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

  /// Next line without its end (LF or CR LF); empty at the end of the file. Valid until more is
  /// taken. @throws FileError for a line longer than `block_size`
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
    if (line_ == 1) check_first(line);
    if (line_is_open_ && taken.size() == block_size) fail_at_line("is longer than ", block_size, " bytes");
    return line_ == 1 ? text::without_byte_order_mark(line) : line;
  }

  /// Refuses a first line that holds others.
  void check_first(std::string_view line) const {
    if (line.find_first_not_of('\r', line.find('\r')) != line.npos) fail(cr_alone);
  }

  /// Rest of the file, without the byte order mark at its beginning.
  [[nodiscard]] std::string take_rest() {
    std::string rest;
    for (std::string_view bytes = take(block_size); !bytes.empty(); bytes = take(block_size))
      rest += position_ == bytes.size() ? text::without_byte_order_mark(bytes) : bytes;
    return rest;
  }

  /// Throws a FileError of a problem, at a place in this file.
  [[noreturn]] void fail(const auto&... problem) const { detail::fail(path_, problem...); }
  [[noreturn]] void fail_at_line(const auto&... problem) const { detail::fail_at(path_, line_, problem...); }
  /// `column` is counted from 0 here, from 1 in the message.
  [[noreturn]] void fail_at_column(std::size_t column, const auto&... problem) const {
    throw FileError(path_, text::message("line ", line_, ", column ", column + 1), text::message(problem...));
  }
  [[noreturn]] void fail_at_byte(std::uint64_t byte, const auto&... problem) const {
    throw FileError(path_, text::message("byte ", byte), text::message(problem...));
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
    const std::size_t wanted = block_.size() - end_;
    file_.read(block_.data() + end_, static_cast<std::streamsize>(wanted));
    const auto found = static_cast<std::size_t>(file_.gcount());
    const bool is_cut = found < wanted && position_ + end_ + found < size_;  // libc++ takes an error for the end
    if (file_.bad() || is_cut) fail("cannot be read");
    end_ += found;
  }

  std::string path_;
  std::ifstream file_;
  std::uint64_t size_ = 0, position_ = 0;
  std::vector<char> block_;
  std::size_t begin_ = 0, end_ = 0;  // unread part of the block
  std::size_t line_ = 0;
  bool line_is_open_ = false;
};

/// Memory-mapped file, read-only, aligned to a page; pipes are refused. Its name may be reused for
/// another file meanwhile; the file itself must not be written to.
class MappedFile {
 public:
  /// `expected` content for messages, as in "an XML file", if any. @throws FileError
  explicit MappedFile(const std::filesystem::path& path, std::string_view expected = {}) {
    const auto require = [&](bool fulfilled, std::string_view problem, bool is_of_system = false) {
      if (fulfilled) return;
      const std::string reason = is_of_system ? ": " + detail::system_error() : "";
      detail::fail(path, problem, reason, expected.empty() ? "" : ": expected ", expected);
    };
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    require(file >= 0 || errno != ENOENT, "does not exist");
    require(file >= 0, "cannot be read", true);
    struct stat status {};
    const bool is_file = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
    const std::size_t size = is_file ? static_cast<std::size_t>(status.st_size) : 0;
    void* const memory = size > 0 ? ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0) : nullptr;
    ::close(file);
    require(is_file, "is a directory or device");
    require(size > 0, "is empty");
    require(memory != MAP_FAILED, "cannot be mapped into memory", true);
    bytes_ = {static_cast<const std::byte*>(memory), size};
  }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile() { ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size()); }

  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }  ///< content
  [[nodiscard]] std::string_view text() const noexcept {                              ///< content, as text
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
  }

 private:
  std::span<const std::byte> bytes_;
};

namespace detail {
/// Regular files of a folder, sorted; by a `recursive_directory_iterator`, those of the folders
/// below it, too. @throws FileError if it cannot be read
template <class Iterator = std::filesystem::directory_iterator>
[[nodiscard]] std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error, ignored;
  for (Iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_regular_file(ignored)) files.push_back(entry->path());
  if (error) fail(folder, "cannot be read: ", error.message());
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
    detail::fail(path, "takes more memory than there is: expected a smaller file, or more free memory");
  }
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
