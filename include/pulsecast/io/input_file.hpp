// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <ios>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <pulsecast/base/error.hpp>

namespace pulsecast::io {

/// File read from beginning to end in blocks, as bytes or as lines; memory is independent of its size.
class InputFile {
 public:
  static constexpr std::size_t block_size = std::size_t{1} << 20;  ///< upper limit of a line, and of bytes taken at once [byte]

  /// `expected` content for error messages, as in "a point cloud". Throws a `FileError` if there is no such file, or it is empty.
  InputFile(const std::filesystem::path& path, std::string_view expected) : path_(path.string()) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) fail("does not exist: expected " + std::string(expected));
    if (!std::filesystem::is_regular_file(path, ignored)) fail("is a directory or device: expected " + std::string(expected));
    file_.open(path, std::ios::binary);
    if (!file_) fail("cannot be read");
    file_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(file_.tellg(), 0));
    if (size_ == 0) fail("is empty: expected " + std::string(expected));
    block_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(size_, block_size)));
    seek(0);
  }

  /// Path, for messages.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }          ///< size of the file [byte]
  [[nodiscard]] std::uint64_t position() const noexcept { return position_; }  ///< offset of the next byte
  [[nodiscard]] std::size_t line() const noexcept { return line_; }            ///< number of the line taken last, from 1
  [[nodiscard]] bool line_is_open() const noexcept { return line_is_open_; }   ///< true for a last line without end

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

  /// Next line without its end (LF or CR LF); empty at the end of the file. Valid until more is taken. Throws a `FileError` for a line
  /// longer than `block_size`.
  [[nodiscard]] std::optional<std::string_view> take_line() {
    std::optional<std::size_t> end = line_end();
    if (!end) {
      refill();
      end = line_end();
    }
    ++line_;
    line_is_open_ = !end;
    if (!end) {
      if (end_ - begin_ == block_size) fail_at_line("is longer than " + std::to_string(block_size) + " bytes");
      if (begin_ == end_) return std::nullopt;
    }
    std::string_view text = advance(end ? *end + 1 : end_ - begin_);
    if (end) text.remove_suffix(1);
    if (text.ends_with('\r')) text.remove_suffix(1);
    if (line_ == 1 && text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark of UTF-8
    return text;
  }

  /// Throws a `FileError` about the whole file.
  [[noreturn]] void fail(const std::string& problem) const { throw FileError(path_, "", problem); }
  /// Throws a `FileError` about the line taken last.
  [[noreturn]] void fail_at_line(const std::string& problem) const { throw FileError(path_, "line " + std::to_string(line_), problem); }
  /// Throws a `FileError` about a byte, from 0.
  [[noreturn]] void fail_at_byte(std::uint64_t byte, const std::string& problem) const {
    throw FileError(path_, "byte " + std::to_string(byte), problem);
  }

 private:
  /// Length of the next line in the block; empty without a line end.
  [[nodiscard]] std::optional<std::size_t> line_end() const noexcept {
    const void* found = begin_ == end_ ? nullptr : std::memchr(block_.data() + begin_, '\n', end_ - begin_);
    if (found == nullptr) return std::nullopt;
    return static_cast<std::size_t>(static_cast<const char*>(found) - block_.data()) - begin_;
  }

  [[nodiscard]] std::string_view advance(std::size_t bytes) noexcept {
    const std::string_view taken(block_.data() + begin_, bytes);
    begin_ += bytes, position_ += bytes;
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

}  // namespace pulsecast::io
