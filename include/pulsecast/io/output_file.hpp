// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_OUTPUT_FILE_HPP
#define PULSECAST_IO_OUTPUT_FILE_HPP

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <memory>
#include <span>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <pulsecast/base/require.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Locks an open file exclusively until it is closed; false if locked already. True without locks.
[[nodiscard]] inline bool lock_alone(int file) noexcept {
  while (::flock(file, LOCK_EX | LOCK_NB) != 0)
    if (errno != EINTR) return errno != EWOULDBLOCK;
  return true;
}

/// True if a path still refers to an open file.
[[nodiscard]] inline bool stands_at(int file, const std::filesystem::path& path) noexcept {
  struct stat open {};
  struct stat named {};
  if (::fstat(file, &open) != 0 || ::stat(path.c_str(), &named) != 0) return false;
  return open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

/// Flushes an open file to its disk; true where there is nothing to flush, or no disk.
[[nodiscard]] inline bool sync_to_disk(int file) noexcept {
  struct stat status {};
  if (::fstat(file, &status) == 0 && status.st_size == 0) return true;
  return ::fsync(file) == 0 || errno == EINVAL || errno == EROFS;
}

/// Encoder of the bytes of a file before they are written, as a compressor.
class OutputEncoder {
 public:
  virtual ~OutputEncoder() = default;
  /// Appends the encoded `bytes` to `out`; `last` is true once, with the last, which may be none.
  virtual void encode(std::span<const std::byte> bytes, bool last, std::vector<std::byte>& out) = 0;
};

/// File under construction: written as `NAME.part`, and renamed by `commit()` when complete. Until
/// then, or if the program is killed, the final name keeps its former content. Destruction without
/// `commit()` removes the temporary file. Throws a `FileError` that names the final path at every
/// failure; after one to write, nothing can be written or committed. With an encoder, bytes pass
/// through it, a megabyte at a time, and cannot be read again or overwritten. The temporary file is
/// locked: a second of the same name is refused; on a file system without locks, it takes the name,
/// and the first fails at its commit. The content is on the disk before the renaming: a power cut
/// may lose the name, but leaves no incomplete file.
class OutputFile {
 public:
  /// Opens and locks the temporary file of `path`; with an `encoder`, bytes pass through it.
  explicit OutputFile(std::filesystem::path path, std::unique_ptr<OutputEncoder> encoder = nullptr)
      : path_(std::move(path)), encoder_(std::move(encoder)) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path_, ignored))
      throw FileError(path_.string(), "", "is a folder; expected the name of a file");
    buffer_.reserve(capacity);
    file_ = std::make_unique<Temporary>(temporary_name(path_));
    open_alone();
  }

  /// Piece of a file that others assemble: appended to `piece` until `commit()`.
  OutputFile(std::filesystem::path path, std::vector<std::byte>& piece) : path_(std::move(path)), piece_(&piece) {}

  /// Writes bytes, sooner or later. Errors: `FileError`.
  void write(std::span<const std::byte> bytes) {
    if (piece_ != nullptr) {
      position_ += bytes.size();
      return void(piece_->insert(piece_->end(), bytes.data(), bytes.data() + bytes.size()));
    }
    require_open();
    if (buffer_.size() + bytes.size() > capacity) flush();
    if (bytes.size() < capacity) {
      buffer_.insert(buffer_.end(), bytes.data(), bytes.data() + bytes.size());
    } else {
      hand_over(bytes, false);
    }
    position_ += bytes.size();
  }

  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }  ///< appends text

  /// Replaces bytes written before, from `position` [byte] on; writing then continues at the end.
  void overwrite(std::uint64_t position, std::span<const std::byte> bytes) {
    PULSECAST_ASSERT(!encoder_ && position + bytes.size() <= position_);
    require_open();
    flush();
    while (!bytes.empty())
      position += advance(bytes, ::pwrite(file_->number, bytes.data(), bytes.size(), static_cast<off_t>(position)));
  }

  /// Reads bytes from `position` [byte] on, also without a name; on any threads while none writes.
  void read(std::uint64_t position, std::span<std::byte> bytes) const {
    PULSECAST_ASSERT(!encoder_ && position + bytes.size() <= position_);
    require_open();
    const std::uint64_t passed_on = position_ - buffer_.size();
    while (!bytes.empty() && position < passed_on) {
      errno = 0;
      const std::uint64_t some = std::min<std::uint64_t>(bytes.size(), passed_on - position);
      const ssize_t count = ::pread(file_->number, bytes.data(), some, static_cast<off_t>(position));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) throw error("cannot be read again", errno, "what was written");
      bytes = bytes.subspan(static_cast<std::size_t>(count));
      position += static_cast<std::uint64_t>(count);
    }
    if (!bytes.empty()) std::memcpy(bytes.data(), buffer_.data() + (position - passed_on), bytes.size());
  }

  /// Removes the name of the temporary file, for what this object alone reads, and never commits.
  void forget_name() noexcept { file_->remove(); }

  /// Continues after bytes that others wrote to the temporary file; without an encoder.
  void continue_at(std::uint64_t position) {
    PULSECAST_ASSERT(!encoder_);
    require_open();
    flush();
    position_ = position;
    if (::lseek(file_->number, static_cast<off_t>(position), SEEK_SET) < 0)
      fail("cannot be written", errno, "a seekable file");
  }

  /// Name until `commit()`.
  [[nodiscard]] static std::filesystem::path temporary_name(const std::filesystem::path& path) {
    return path.string() + ".part";
  }

  /// Number of bytes written, before any encoding: offset of the next one.
  [[nodiscard]] std::uint64_t position() const noexcept { return position_; }
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }  ///< final name

  /// Completes the file under its final name, replacing any file of that name.
  void commit() {
    if (std::exchange(piece_, nullptr) != nullptr) return;
    require_open();
    flush(true);
    if (!stands_at(file_->number, file_->name)) {
      discard();
      throw FileError(path_.string(), "",
                      "cannot be completed: another program has replaced " + temporary_name(path_).string());
    }
    errno = 0;
    std::error_code failed;
    if (sync_to_disk(file_->number))
      std::filesystem::rename(file_->name, path_, failed);
    else
      failed = system_error(errno);
    if (failed)
      fail("cannot be completed", failed.value(),
           text::joined({"room for ", std::to_string(position_), " bytes and a replaceable name"}));
    file_->close();  // after the renaming, as it ends the lock; syncing has reported any error
  }

  /// Abandons the file and removes the bytes written: for writers that cannot write the rest.
  void discard() noexcept {
    file_.reset();
    piece_ = nullptr;
  }

 private:
  /// Open file, and its name. Destruction removes both.
  struct Temporary {
    std::filesystem::path name;
    int number = -1;  ///< descriptor; negative: closed

    explicit Temporary(std::filesystem::path its_name) : name(std::move(its_name)) {}
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    ~Temporary() {
      remove();
      close();
    }
    void remove() const noexcept {
      if (number >= 0 && stands_at(number, name)) ::unlink(name.c_str());
    }
    void close() noexcept {
      if (number >= 0) ::close(std::exchange(number, -1));
    }
  };

  static constexpr std::size_t capacity = std::size_t{1} << 20;  // calls cost little then [byte]

  [[nodiscard]] static std::error_code system_error(int number) {
    return {number != 0 ? number : EIO, std::generic_category()};
  }

  /// Opens the temporary file. Removes what a killed program left: its processes may still write.
  void open_alone() {
    const char* const name = file_->name.c_str();
    for (int tries = 0; tries < 100; ++tries) {
      file_->number = ::open(name, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      const bool is_new = file_->number >= 0;
      if (!is_new && errno == EEXIST) {
        file_->number = ::open(name, O_RDWR | O_CLOEXEC | O_NONBLOCK);
        if (file_->number < 0 && errno == ENOENT) continue;
      }
      if (file_->number < 0) fail("cannot be created", errno, "an existing, writable folder");
      const bool is_alone = lock_alone(file_->number);
      struct stat status {};
      if (is_alone && stands_at(file_->number, file_->name) && ::fstat(file_->number, &status) == 0) {
        if (is_new || S_ISCHR(status.st_mode)) return;
        if (S_ISREG(status.st_mode)) file_->remove();
      }
      file_->close();  // without its name, which is not ours
      if (!is_alone)
        throw FileError(path_.string(), "", text::joined({"is already being written: ", name, " is locked"}));
    }
    fail("cannot be created", EEXIST, text::joined({"no other file ", name}));
  }

  [[nodiscard]] FileError error(std::string_view what, int number, std::string_view expected) const {
    const std::string reason = system_error(number).message();
    return {path_.string(), "", text::joined({what, ": ", reason, "; expected ", expected})};
  }
  [[noreturn]] void fail(std::string_view what, int number, std::string_view expected) {
    discard();
    throw error(what, number, expected);
  }

  void require_open() const {
    if (!file_ || file_->number < 0)
      throw FileError(path_.string(), "", "cannot be written: it is already committed or discarded");
  }

  void put(std::span<const std::byte> bytes) {
    while (!bytes.empty()) advance(bytes, ::write(file_->number, bytes.data(), bytes.size()));
  }

  /// Removes from `bytes` what a call has written. Returns the number of bytes.
  std::size_t advance(std::span<const std::byte>& bytes, ssize_t written) {
    if (written < 0 && errno == EINTR) return 0;
    if (written <= 0)
      fail("cannot be written", written < 0 ? errno : 0,
           text::joined({"room for ", std::to_string(bytes.size()), " more bytes"}));
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    return static_cast<std::size_t>(written);
  }

  void hand_over(std::span<const std::byte> bytes, bool last) {
    if (!encoder_) return put(bytes);
    encoded_.clear();
    encoder_->encode(bytes, last, encoded_);
    put(encoded_);
  }

  void flush(bool last = false) {
    hand_over(buffer_, last);
    buffer_.clear();
  }

  std::filesystem::path path_;
  std::unique_ptr<Temporary> file_;
  std::unique_ptr<OutputEncoder> encoder_;
  std::vector<std::byte>* piece_ = nullptr;
  std::vector<std::byte> buffer_, encoded_;
  std::uint64_t position_ = 0;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
