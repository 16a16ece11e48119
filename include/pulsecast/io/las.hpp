// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <utility>
#include <vector>

#include <pulsecast/concepts.hpp>
#include <pulsecast/io/detail/las/writer.hpp>
#include <pulsecast/io/las_settings.hpp>
#include <pulsecast/io/output_file.hpp>

namespace pulsecast::io {

namespace detail {

/// The points of a LAS file, one record after another.
class LasRecords {
 public:
  static constexpr std::uint8_t format_bits = 0;        ///< that mark the point format in the header
  static constexpr std::uint32_t descriptor_count = 0;  ///< of the records of variable length that tell how points are to be read
  [[nodiscard]] static std::vector<std::byte> descriptors() { return {}; }

  /// Is called where the points begin, with the size of a record [byte], and whether `change` will be called.
  void begin(const OutputFile& file, std::size_t record, bool /*changed*/) {
    begin_ = file.position();
    record_ = record;
  }

  void write(OutputFile& file, std::span<const std::byte> record) { file.write(record); }

  /// Lets `change(bytes)` change all records, some at a time.
  template <class Change>
  void change(OutputFile& file, const Change& change) {
    las_in_blocks(file, begin_, record_, [&](std::uint64_t at, std::span<std::byte> some) {
      change(some);
      file.overwrite(at, some);
    });
  }

  void finish(OutputFile& /*file*/) {}

 private:
  std::uint64_t begin_ = 0;  // [byte]
  std::size_t record_ = 0;   // [byte]
};

}  // namespace detail

/// Writes points as LAS with extra bytes, in pulse order, as `detail::LasFileWriter` says; memory does not grow with their number.
class LasWriter : public detail::LasFileWriter<detail::LasRecords> {
 public:
  explicit LasWriter(std::filesystem::path path, LasSettings settings = {}) : LasFileWriter(std::move(path), std::move(settings), {}) {}
};
static_assert(EchoSink<LasWriter>);

}  // namespace pulsecast::io
