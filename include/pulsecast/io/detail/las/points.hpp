// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_POINTS_HPP
#define PULSECAST_IO_DETAIL_LAS_POINTS_HPP

#include <pulsecast/io/detail/laz/reader.hpp>
#include <pulsecast/io/detail/reference_reader.hpp>

namespace PULSECAST_NAMESPACE::io {

/// What of LAS points is wanted beside their places.
struct LasWants {
  bool colours = true, objects = true;
};

/// Reader of the points of a LAS, LAZ or COPC file, versions 1.0 to 1.4, point formats 0 to 10. Points marked as
/// withheld (deleted) are skipped; bounds in the header are ignored. Coordinates in feet become metres. Throws a
/// `FileError` with path and byte. Source: ASPRS LAS 1.4 R15, and 1.0 to 1.3 for headers.
class LasPoints {
 public:
  /// True if the file begins with the LAS signature.
  [[nodiscard]] static bool is_las(InputFile& file) {
    file.seek(0);
    const bool is = file.take(4) == "LASF";
    file.seek(0);
    return is;
  }

  explicit LasPoints(InputFile file, const LasWants& wants = {}) : file_(std::move(file)) { read_header(wants); }

  /// Advances to the next point; false at the end.
  [[nodiscard]] bool next() {
    while (taken_ < count_) {
      if (laz_) {
        record_ = laz_->next(file_);
        at_ = laz_->at();
      } else {
        at_ = file_.position();
        record_ = file_.take(places_.record);
        if (record_.size() < places_.record)
          file_.fail_at_byte(at_, "unexpected end: the file has changed while it was read");
      }
      ++taken_;
      if (!tally()) return true;
    }
    return false;
  }

  /// Position of the current point, which should be in metres. Throws a `FileError` beyond 1e12.
  [[nodiscard]] Vec3 position() const {
    Vec3 p{};
    for (int k = 0; k < 3; ++k)
      p[k] = (detail::las_number<std::int32_t>(record_, 4 * static_cast<std::size_t>(k)) * scale_[k] + offset_[k]) *
             unit_[k];
    if (!is_within(p, 1e12)) fail_here("has a point beyond 1e12 m: expected coordinates up to 1e12 m");
    return p;
  }

  [[nodiscard]] bool has_normals() const noexcept { return false; }
  [[nodiscard]] Vec3 normal() const noexcept { return {}; }
  [[nodiscard]] bool has_colours() const noexcept { return places_.colour != 0; }

  /// Red, green and blue of the current point, from 0 to `max_colour`.
  [[nodiscard]] Vec3 colour() const noexcept {
    const auto [red, green, blue] = detail::las_number<std::array<std::uint16_t, 3>>(record_, places_.colour);
    return {red, green, blue};
  }
  static constexpr double max_colour = 65535;

  [[nodiscard]] bool has_class() const noexcept { return true; }
  [[nodiscard]] std::uint32_t classification() const noexcept {
    const auto at = static_cast<std::uint8_t>(record_[places_.format < 6 ? 15 : 16]);
    return places_.format < 6 && minor_ > 0 ? at & 31U : at;  // LAS 1.0 has no flags there
  }

  /// Object of the current point, by the extra bytes ObjectId.
  [[nodiscard]] bool has_object() const noexcept { return places_.object != 0; }
  [[nodiscard]] std::uint32_t object() const noexcept {
    std::uint32_t value = 0;
    std::memcpy(&value, record_.data() + places_.object, places_.object_size);
    return value;
  }

  /// Oddities that could still be read; complete after the last point.
  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> all = notes_;
    for (std::size_t k = 0; k < tallies_.size(); ++k)
      if (tallies_[k] > 0)
        all.push_back(
            detail::warning(path(), 0, tallies_[k], " of ", count_, " points are ", detail::las_rules[k].meaning));
    return all;
  }

  [[noreturn]] void fail_here(const std::string& problem) const { file_.fail_at_byte(at_, problem); }
  [[nodiscard]] const std::string& path() const noexcept { return file_.path(); }

 private:
  static_assert(std::endian::native == std::endian::little,
                "LAS files are little-endian, and are read as the numbers lie in memory");

  void read_header(const LasWants& wants) {
    constexpr std::array<std::size_t, 5> header_sizes{227, 227, 227, 235, 375};  // by minor version
    constexpr std::array<std::size_t, 11> sizes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
    constexpr std::array<std::size_t, 11> colours{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};

    const std::string bytes(file_.take(header_sizes.back()));
    if (bytes.size() < header_sizes.front())
      file_.fail_at_byte(bytes.size(), "the file ends: expected the 227 bytes of a LAS header");
    const auto major = detail::las_number<std::uint8_t>(bytes, 24);
    minor_ = detail::las_number<std::uint8_t>(bytes, 25);
    if (major != 1 || minor_ > 4)
      file_.fail_at_byte(24, "is LAS ", major, ".", minor_, ": expected a version from 1.0 to 1.4");
    const std::size_t header_size = detail::las_number<std::uint16_t>(bytes, 94), least = header_sizes[minor_];
    if (std::min(header_size, bytes.size()) < least)
      file_.fail_at_byte(94, "the header has ", std::min(header_size, bytes.size()), " bytes: expected at least ",
                         least);
    const auto mark = detail::las_number<std::uint8_t>(bytes, 104);  // from 128 on by LASzip
    const unsigned format = places_.format = mark & 127U;
    if (format >= sizes.size()) file_.fail_at_byte(104, "has the point format ", format, ": expected one from 0 to 10");
    places_.record = detail::las_number<std::uint16_t>(bytes, 105);
    places_.extras = sizes[format];
    places_.colour = wants.colours ? colours[format] : 0;
    if (places_.record < sizes[format])
      file_.fail_at_byte(105, "a point has ", places_.record, " bytes: expected at least the ", sizes[format],
                         " of format ", format);
    const std::uint64_t begin = detail::las_number<std::uint32_t>(bytes, 96);
    count_ = minor_ == 4 ? detail::las_number<std::uint64_t>(bytes, 247) : 0;
    const std::size_t count_at = count_ > 0 ? 247 : 107;
    const auto legacy_count = detail::las_number<std::uint32_t>(bytes, 107);
    if (count_ == 0) count_ = legacy_count;
    if (legacy_count != 0 && legacy_count != count_) ask("two numbers of points");
    if (begin < header_size || begin > file_.size())
      file_.fail_at_byte(96, "the points begin at byte ", begin, ": expected one from ", header_size,
                         " to the file's size of ", file_.size());
    if (count_ == 0) file_.fail_at_byte(107, "holds no point: expected at least one");
    if (mark < 128 && count_ > (file_.size() - begin) / places_.record)
      file_.fail_at_byte(count_at, "claims ", count_, " points of ", places_.record, " bytes from byte ", begin,
                         ": expected no more than fit into the file's ", file_.size(), " bytes");
    read_lattice(bytes);
    read_records(detail::las_number<std::uint32_t>(bytes, 100), header_size, 54, begin, wants);
    if (minor_ == 4)
      read_records(detail::las_number<std::uint32_t>(bytes, 243), detail::las_number<std::uint64_t>(bytes, 235), 60,
                   file_.size(), wants);
    read_units((bytes[6] & 16) != 0);
    if (mark >= 128)
      laz_.emplace(file_, descriptor_, begin, places_);
    else
      file_.seek(begin);
  }

  void read_lattice(const std::string& bytes) {
    scale_ = detail::las_number<Vec3>(bytes, 131);
    offset_ = detail::las_number<Vec3>(bytes, 155);
    for (int k = 0; k < 3; ++k) {
      const auto at = static_cast<std::size_t>(131 + 8 * k);
      if (!(scale_[k] > 0) || !std::isfinite(scale_[k]))
        file_.fail_at_byte(at, "the scale is ", scale_[k], ": expected one above 0");
      if (!std::isfinite(offset_[k]))
        file_.fail_at_byte(at + 24, "the offset is ", offset_[k], ": expected a finite one");
    }
  }

  void read_units(bool prefers_wkt) {
    const unsigned format = places_.format;
    if (format == 4 || format == 5 || format > 8) ask("waveforms");
    detail::ReferenceReader reader(path(), detail::HeightUnit::of_coordinates, notes_);
    SpatialReference found;
    if (!wkt_.empty() && (prefers_wkt || keys_.empty()))
      found = std::move(reader).by_text(wkt_);
    else if (!keys_.empty())
      found = std::move(reader).by_keys({keys_, key_numbers_, key_texts_});
    else if (scale_.x < 1e-5)
      ask("steps below 1e-5");
    unit_ = {found.unit, found.unit, found.vertical_unit};
  }

  void ask(std::string_view item) { keep_rule(detail::las_rules, path(), "item", item, notes_); }

  /// Reads `count` variable-length records with a header of `head` bytes, from byte `at` up to `end`.
  void read_records(std::uint32_t count, std::uint64_t at, std::size_t head, std::uint64_t end, const LasWants& wants) {
    for (; count > 0 && at < end && end - at >= head; --count) {
      if (file_.position() != at) file_.seek(at);
      const std::string header(file_.take(head));
      if (header.size() < head) return;
      const std::string user = header.substr(2, 16).c_str();
      const std::string name = text::message(user, ' ', detail::las_number<std::uint16_t>(header, 18));
      const std::uint64_t size =
          head == 54 ? detail::las_number<std::uint16_t>(header, 20) : detail::las_number<std::uint64_t>(header, 20);
      const std::string body(
          file_.take(static_cast<std::size_t>(std::min<std::uint64_t>(size, InputFile::block_size))));
      if (user == "LASF_Projection" || name == "lascompatible 22204" || name == "liblas 2112") ask(name);
      if (name == "LASF_Projection 2112" || name == "liblas 2112") wkt_ = body.c_str();
      if (name == "LASF_Projection 34735") keys_ = numbers_of<std::uint16_t>(body);
      if (name == "LASF_Projection 34736") key_numbers_ = numbers_of<double>(body);
      if (name == "LASF_Projection 34737") key_texts_ = body;
      if (name == "laszip encoded 22204") descriptor_ = body;
      if (name == "LASF_Spec 4" && wants.objects) find_objects(body);
      at += head + std::min(size, file_.size());
    }
  }

  template <class Number>
  [[nodiscard]] static std::vector<Number> numbers_of(std::string_view bytes) {
    std::vector<Number> all(bytes.size() / sizeof(Number));
    std::memcpy(all.data(), bytes.data(), all.size() * sizeof(Number));
    return all;
  }

  /// Finds the extra bytes ObjectId. Source: LAS 1.4 R15, Extra Bytes.
  void find_objects(std::string_view descriptors) {
    constexpr std::array<std::size_t, 11> sizes{0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};  // by type; of tuples, in tens
    std::size_t at = places_.extras;
    for (; descriptors.size() >= 192; descriptors.remove_prefix(192)) {
      const auto type = static_cast<std::uint8_t>(descriptors[2]), options = static_cast<std::uint8_t>(descriptors[3]);
      const std::size_t size = type == 0 ? options : sizes[(type - 1U) % 10 + 1] * ((type - 1U) / 10 + 1);
      const bool is_number = (type == 1 || type == 3 || type == 5) && (options & 24U) == 0;  // without scale and offset
      const bool is_object = descriptors.substr(4, 9) == std::string_view("ObjectId", 9) && at + size <= places_.record;
      if (is_object && !is_number) ask("other extra bytes ObjectId");
      if (is_object && is_number) {
        places_.object = at;
        places_.object_size = size;
      }
      at += size;
    }
  }

  /// Counts what is noted of the current point, by the first rows of the rules. True if it is withheld; LAS 1.0 has no
  /// such bits.
  [[nodiscard]] bool tally() noexcept {
    const auto bits = static_cast<std::uint8_t>(record_[15]);
    const bool is_new = places_.format >= 6, is_old = !is_new && minor_ > 0;
    const bool is_withheld = is_new ? (bits & 4U) != 0 : is_old && (bits & 128U) != 0;
    const std::uint32_t kind = classification();
    tallies_[0] += is_withheld ? 1 : 0;
    if (is_withheld) return true;
    tallies_[1] += (is_new ? (bits & 1U) != 0 : is_old && (bits & 32U) != 0) ? 1 : 0;
    tallies_[2] += kind == 7 ? 1 : 0;
    tallies_[3] += kind == 18 && is_new ? 1 : 0;
    return false;
  }

  InputFile file_;
  unsigned minor_ = 0;
  detail::LasPlaces places_;
  Vec3 scale_{}, offset_{}, unit_{1, 1, 1};
  std::uint64_t count_ = 0, taken_ = 0;
  std::array<std::uint64_t, 4> tallies_{};    // withheld, synthetic, low noise, high noise
  std::uint64_t at_ = 0;                      // offset of the current point, or its chunk [byte]
  std::string wkt_, key_texts_, descriptor_;  // bodies of records
  std::vector<std::uint16_t> keys_;
  std::vector<double> key_numbers_;
  std::vector<std::string> notes_;
  std::optional<detail::LazReader> laz_;
  std::string_view record_;
};

}  // namespace PULSECAST_NAMESPACE::io

#endif
