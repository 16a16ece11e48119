// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_GZIP_HPP
#define PULSECAST_IO_GZIP_HPP

#include <new>

#include <zlib.h>

#include <pulsecast/io/output_file.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings of gzip compression.
struct GzipSettings {
  int level = 1;  ///< effort, from 1, fast, to 9, small

  void validate() const { require_within("GzipSettings::level", level, 1, 9, ""); }
};

namespace detail {

/// Compressor by zlib: by default to one gzip member without name or time, so that equal input
/// gives equal output. Sources: RFC 1951, RFC 1952.
class DeflateEncoder final : public OutputEncoder {
 public:
  static constexpr int gzip = 15 + 16;  ///< window of 32 kB; plus 16 selects the gzip format
  static constexpr int no_head = -15;   ///< window of 32 kB, without header and checksum

  explicit DeflateEncoder(int level, int window_bits = gzip, int strategy = Z_DEFAULT_STRATEGY) {
    constexpr int memory_level = 9;  // maximum, 256 kB, for speed
    if (deflateInit2(&stream_, level, Z_DEFLATED, window_bits, memory_level, strategy) != Z_OK) throw std::bad_alloc();
  }
  DeflateEncoder(const DeflateEncoder&) = delete;
  DeflateEncoder& operator=(const DeflateEncoder&) = delete;
  ~DeflateEncoder() override { deflateEnd(&stream_); }

  void encode(std::span<const std::byte> bytes, bool last, std::vector<std::byte>& out) override {
    constexpr std::size_t most = std::size_t{1} << 30;  // limit of zlib's 32-bit counts
    do {
      const std::span<const std::byte> part = bytes.first(std::min(bytes.size(), most));
      bytes = bytes.subspan(part.size());
      stream_.next_in = reinterpret_cast<z_const Bytef*>(const_cast<std::byte*>(part.data()));
      stream_.avail_in = static_cast<uInt>(part.size());
      do {
        stream_.next_out = reinterpret_cast<Bytef*>(room_.data());
        stream_.avail_out = static_cast<uInt>(room_.size());
        // cannot fail: the stream is valid, and there is room
        deflate(&stream_, last && bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
        out.insert(out.end(), room_.begin(), room_.end() - stream_.avail_out);
      } while (stream_.avail_out == 0);
    } while (!bytes.empty());
  }

 private:
  std::vector<std::byte> room_ = std::vector<std::byte>(std::size_t{1} << 18);
  z_stream stream_{};
};

}  // namespace detail

/// File compressed by gzip on the fly, for any writer that takes an `OutputFile`:
///
///     XyzWriter writer(gzip_file("points.xyz.gz"));
///
/// Limits: one thread. Text takes 3 times as long at level 1, and 12 times at 6, for a tenth less.
[[nodiscard]] inline OutputFile gzip_file(std::filesystem::path path, const GzipSettings& how = {}) {
  return OutputFile(std::move(path), std::make_unique<detail::DeflateEncoder>(validated(how).level));
}

}  // namespace PULSECAST_NAMESPACE::io

#endif
