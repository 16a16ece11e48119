// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_LAS_HPP
#define PULSECAST_IO_LAS_HPP

#include <pulsecast/base/compiled.hpp>
#include <pulsecast/io/detail/las/writer.hpp>

namespace PULSECAST_NAMESPACE::io {

namespace detail {

/// Point records of a LAS file, uncompressed.
class LasRecords {
 public:
  static constexpr std::uint8_t format_bits = 0;  ///< flags in the header's point format
  /// Records about the points, before and after all others; empty: none.
  [[nodiscard]] static std::vector<std::byte> first_descriptor() { return {}; }
  [[nodiscard]] static std::vector<std::byte> descriptor(const LasLayout& /*layout*/) { return {}; }

  /// Begins the points at the file's position; `changed` says if `change` will be called.
  void begin(const OutputFile& file, const LasLayout& layout, bool /*changed*/) {
    begin_ = file.position();
    record_ = layout.record();
  }

  void write(OutputFile& file, std::span<const std::byte> record) { file.write(record); }

  /// Calls `change(bytes)` on all records, in blocks, and writes them back.
  template <class Change>
  void change(OutputFile& file, const Change& change) {
    las_in_blocks(file, begin_, record_, [&](std::uint64_t at, std::span<std::byte> some) {
      change(some);
      file.overwrite(at, some);
    });
  }

  void finish(OutputFile& /*file*/, const LasEncoder& /*encoder*/) {}
  [[nodiscard]] static LasExtendedRecords extended() noexcept { return {}; }  ///< those of LAZ and COPC

 private:
  std::uint64_t begin_ = 0;  // [byte]
  std::size_t record_ = 0;   // [byte]
};

#if defined(PULSECAST_COMPILED)  // which has these functions
#if PULSECAST_DEFINES(IO_LAS)
template class LasFileWriter<LasRecords>;
#else
extern template class LasFileWriter<LasRecords>;
#endif
#endif

}  // namespace detail

/// Writes points as LAS, in pulse order: see `detail::LasFileWriter`. Memory does not grow with them.
class LasWriter : public detail::LasFileWriter<detail::LasRecords> {
 public:
  /// @throws SettingError for settings out of range @throws FileError if the file cannot be made
  explicit LasWriter(std::filesystem::path path, LasSettings settings = {})
      : LasFileWriter(std::move(path), std::move(settings), {}) {}
};
static_assert(EchoSink<LasWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
