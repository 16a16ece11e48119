// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_NPZ_HPP
#define PULSECAST_IO_NPZ_HPP

#include <exception>

#include <archive.h>
#include <archive_entry.h>

#include <pulsecast/io/detail/packed_points.hpp>

namespace PULSECAST_NAMESPACE::io {

/// Settings of an NPZ file.
struct NpzSettings {
  PointLayout layout = layouts::map();  ///< arrays: one a field, by its name
  PointSettings points{};               ///< values; set the origin for large coordinates

  void validate() const { detail::require_packable(layout, points); }
};

namespace detail {

/// Header of an array of one dimension, padded to 64 bytes. Source: NumPy, numpy.lib.format, 1.0.
[[nodiscard]] inline std::string npy_header(NumberType type, std::uint64_t count) {
  constexpr std::array<std::string_view, 11> types{"",    "|i1", "|u1", "<i2", "<u2", "<i4",
                                                   "<u4", "<f4", "<f8", "<i8", "<u8"};
  std::string text = text::joined({"{'descr': '", types[static_cast<std::size_t>(type)],
                                   "', 'fortran_order': False, 'shape': (", std::to_string(count), ",), }"});
  constexpr std::size_t preamble = 10, alignment = 64;  // [byte]
  text.resize((preamble + text.size()) / alignment * alignment + alignment - preamble, ' ');
  text.back() = '\n';
  const auto length = static_cast<std::uint16_t>(text.size());
  const std::array end{static_cast<char>(length & 0xFF), static_cast<char>(length >> 8)};
  return text::joined({{"\x93NUMPY\x01\x00", 8}, {end.data(), 2}, text});
}

/// Zip file without compression and without times, so that equal content gives equal bytes.
class StoredZip {
 public:
  explicit StoredZip(OutputFile& file) : file_(file) {
    if (!archive_ || !entry_) throw std::bad_alloc();
    check(archive_write_set_format_zip(archive_.get()));
    check(archive_write_zip_set_compression_store(archive_.get()));
    check(archive_write_set_bytes_per_block(archive_.get(), 0));  // no buffer, no padding
    check(archive_write_open(archive_.get(), this, nullptr, write_some, nullptr));
  }
  StoredZip(const StoredZip&) = delete;
  StoredZip& operator=(const StoredZip&) = delete;

  /// Begins an entry of a head and `size` bytes, to be passed to `put`.
  void begin(const std::string& name, std::string_view head, std::uint64_t size) {
    archive_entry_clear(entry_.get());
    archive_entry_set_pathname(entry_.get(), name.c_str());
    archive_entry_set_filetype(entry_.get(), AE_IFREG);
    archive_entry_set_perm(entry_.get(), 0644);
    archive_entry_set_size(entry_.get(), static_cast<la_int64_t>(head.size() + size));
    check(archive_write_header(archive_.get(), entry_.get()));
    put(std::as_bytes(std::span(head)));
  }

  void put(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {  // the library takes 2 GiB at a time
      const la_ssize_t written = archive_write_data(archive_.get(), bytes.data(), bytes.size());
      if (written <= 0) check(ARCHIVE_FATAL);
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }

  /// Adds an array for each column.
  void add(const PointLayout& layout, const FieldColumns& columns) {
    for (std::size_t k = 0; k < layout.fields.size(); ++k) {
      const auto& [name, type, column, scale, offset] = layout.fields[k];
      const std::vector<std::byte>& numbers = columns.all()[k];
      begin(name + ".npy", npy_header(type, numbers.size() / size_of(type)), numbers.size());
      put(numbers);
    }
  }

  void close() { check(archive_write_close(archive_.get())); }

 private:
  struct Free {
    void operator()(archive* zip) const noexcept { archive_write_free(zip); }
    void operator()(archive_entry* entry) const noexcept { archive_entry_free(entry); }
  };

  /// Passes bytes on to the file. No exception may pass the library, which is in C.
  static la_ssize_t write_some(archive*, void* self, const void* bytes, std::size_t size) noexcept {
    auto& zip = *static_cast<StoredZip*>(self);
    try {
      zip.file_.write(std::span(static_cast<const std::byte*>(bytes), size));
      return static_cast<la_ssize_t>(size);
    } catch (...) {
      zip.error_ = std::current_exception();
      return -1;
    }
  }

  /// Throws the error of the file, or else a `FileError` with that of the library.
  void check(int result) {
    if (result == ARCHIVE_OK) return;
    if (error_) std::rethrow_exception(error_);
    const char* const reason = archive_error_string(archive_.get());
    file_.discard();
    throw FileError(file_.path().string(), "",
                    std::string("cannot be written as zip: ") + (reason ? reason : "no reason given"));
  }

  OutputFile& file_;
  std::exception_ptr error_;
  std::unique_ptr<archive, Free> archive_{archive_write_new()};
  std::unique_ptr<archive_entry, Free> entry_{archive_entry_new()};
};

}  // namespace detail

/// Writes points as NPZ for NumPy: for each field an array of one dimension, `name.npy`, in a zip
/// file without compression. Equal points give equal bytes. Columns are held in memory until
/// `close()`, up to twice the size of the points. Times since a scan's start count from tick 0, but
/// in `add`. `close()` completes the file: see `OutputFile`. Limits: without memory in `close()`,
/// libarchive ends the process with status 1. Source: NumPy, numpy.savez.
class NpzWriter {
 public:
  /// Opens the file. @throws SettingError for settings out of range @throws FileError
  explicit NpzWriter(std::filesystem::path path, const NpzSettings& settings = {})
      : points_(validated(settings).layout, settings.points), columns_(points_.layout()), file_(std::move(path)) {}

  void operator()(const EchoBatch& batch) { columns_.add(points_.of(batch)); }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  /// Appends the points of a buffer. @throws SettingError for other fields @throws FileError
  void add(const PointBuffer& points) { columns_.add(points_.of(points)); }

  /// Writes the arrays, and gives the file its name. Throws a `FileError`.
  void close() {
    detail::StoredZip zip(file_);
    zip.add(points_.layout(), columns_);
    zip.close();
    file_.commit();
  }

 private:
  detail::PackedPoints points_;
  detail::FieldColumns columns_;
  OutputFile file_;
};
static_assert(EchoSink<NpzWriter>);

/// Writes waveforms as NPZ, with or without echoes: pulse k has `samples[first[k]:][:count[k]]` [W].
/// Further arrays of a number a pulse: `pulse`, its slot; `time` of emission by the clock, `start`,
/// the two-way time of its first sample, and `interval` of samples [s]; `origin_x`, y, z [m]; unit
/// `direction_x`, y, z. Samples are on the disk until `close()`, the rest in memory, 100 bytes a
/// pulse. `close()` completes the file: see `OutputFile`. Source: as `NpzWriter`.
class WaveformNpzWriter {
 public:
  /// `start_time` is the clock time at tick 0 [s]. @throws SettingError @throws FileError
  explicit WaveformNpzWriter(const std::filesystem::path& path, double start_time = 0)
      : start_time_(start_time), file_(path), samples_(path.string() + ".samples") {
    require_finite("WaveformNpzWriter::start_time", start_time, "s");
    samples_.forget_name();
  }

  void operator()(const EchoBatch& batch) {
    for (const Shot& shot : batch.shots) {
      if (shot.samples == 0) continue;
      const std::array<std::uint64_t, 3> wholes{samples_.position() / sizeof(float), shot.samples, shot.index};
      const std::array numbers{start_time_ + shot.tick.seconds(), shot.waveform_start, batch.sample_interval};
      const std::array vectors{shot.origin, shot.direction};
      static_assert(sizeof wholes + sizeof numbers + sizeof vectors == 12 * 8);
      std::memcpy(record_.data(), wholes.data(), sizeof wholes);
      std::memcpy(record_.data() + 24, numbers.data(), sizeof numbers);
      std::memcpy(record_.data() + 48, vectors.data(), sizeof vectors);
      columns_.add(record_);
      samples_.write(std::as_bytes(batch.waveform_of(shot)));
    }
  }
  [[nodiscard]] static bool reads_empty_shots() noexcept { return false; }  ///< see ChoosesShots

  /// Writes the arrays, and gives the file its name. @throws FileError
  void close() {
    detail::StoredZip zip(file_);
    zip.add(layout_, columns_);
    const std::uint64_t size = samples_.position();
    zip.begin("samples.npy", detail::npy_header(NumberType::float32, size / sizeof(float)), size);
    std::vector<std::byte> some;
    for (std::uint64_t at = 0; at < size; at += some.size()) {
      some.resize(static_cast<std::size_t>(std::min<std::uint64_t>(size - at, std::uint64_t{1} << 20)));
      samples_.read(at, some);
      zip.put(some);
    }
    zip.close();
    file_.commit();
  }

 private:
  [[nodiscard]] static PointLayout layout() {
    std::vector<PointField> fields;
    for (const char* name : {"first", "count", "pulse", "time", "start", "interval", "origin_x", "origin_y", "origin_z",
                             "direction_x", "direction_y", "direction_z"})
      fields.push_back({name, fields.size() < 3 ? NumberType::int64 : NumberType::float64});
    return PointLayout::packed(fields);
  }

  double start_time_;
  OutputFile file_, samples_;
  PointLayout layout_ = layout();
  detail::FieldColumns columns_{layout_};
  std::vector<std::byte> record_ = std::vector<std::byte>(layout_.size);  // of a pulse
};
static_assert(EchoSink<WaveformNpzWriter>);

}  // namespace PULSECAST_NAMESPACE::io

#endif
