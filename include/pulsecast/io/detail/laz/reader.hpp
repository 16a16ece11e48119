// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAZ_READER_HPP
#define PULSECAST_IO_DETAIL_LAZ_READER_HPP

#include <pulsecast/io/detail/las/rules.hpp>
#include <pulsecast/io/detail/laz/layers.hpp>
#include <pulsecast/io/detail/laz/pointwise.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Where values are in the records of a LAS file [byte]; 0: nowhere.
struct LasPlaces {
  unsigned format = 0;                      ///< point format
  std::size_t record = 0;                   ///< size of a record
  std::size_t extras = 0;                   ///< offset of the extra bytes
  std::size_t colour = 0;                   ///< offset of red, green and blue, if wanted
  std::size_t object = 0, object_size = 0;  ///< of the extra bytes with the number of the object, if wanted
};

/// Number in bytes, from the lowest byte on.
template <class Number>
[[nodiscard]] Number las_number(const auto& bytes, std::size_t at) noexcept {
  Number value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Decoder of the records of a LAZ file, a chunk at a time. Source: LASzip specification.
class LazReader : private LazLayers {
 public:
  /// `descriptor`: of the record "laszip encoded"; the points begin at byte `begin`. @throws FileError
  LazReader(InputFile& file, std::string_view descriptor, std::uint64_t begin, const LasPlaces& places)
      : places_(places), record_(places.record) {
    read_table(file, begin, read_descriptor(file, descriptor));
  }

  /// Next record: position, returns, flags and class, and what `LasPlaces` has. @throws FileError
  [[nodiscard]] std::string_view next(InputFile& file) {
    if (place_ == count_) next_chunk(file);
    if (is_layered_) {
      points_[place_].put_place(record_.data());
      if (!colours_.empty()) std::memcpy(record_.data() + places_.colour, &colours_[place_], sizeof colours_[place_]);
      for (std::size_t k = 0; k < places_.object_size; ++k)
        record_[places_.object + k] = std::byte{objects_[k * count_ + place_]};
    } else if (place_ > 0) {
      pointwise_->code(decoder_, record_.data());
      require_end(file, decoder_);
    }
    ++place_;
    return {reinterpret_cast<const char*>(record_.data()), record_.size()};
  }

  [[nodiscard]] std::uint64_t at() const noexcept { return at_; }  ///< byte at which the current chunk begins

 private:
  struct Chunk {
    std::uint32_t points, size;
  };
  static constexpr std::uint32_t any_number = 0xFFFFFFFF;              // of points in chunks
  static constexpr std::uint32_t max_points = std::uint32_t{1} << 22;  // in a chunk of layers
  static constexpr std::uint32_t max_size = std::uint32_t{1} << 30;    // of a chunk [byte]

  [[nodiscard]] static std::vector<std::byte> bytes_at(InputFile& file, std::uint64_t at, std::uint64_t size) {
    std::vector<std::byte> bytes;
    file.seek(at);
    while (bytes.size() < size) {
      const auto rest = std::min<std::uint64_t>(size - bytes.size(), InputFile::block_size);
      const auto some = std::as_bytes(std::span(file.take(static_cast<std::size_t>(rest))));
      if (some.empty()) file.fail_at_byte(file.position(), "unexpected end: expected the rest of the points");
      bytes.insert(bytes.end(), some.begin(), some.end());
    }
    return bytes;
  }

  void require_end(const InputFile& file, const LazDecoder& decoder) const {
    if (decoder.is_beyond_end()) file.fail_at_byte(at_, "the chunk of points ends early: expected an undamaged file");
  }

  /// Number of points in a chunk.
  [[nodiscard]] std::uint32_t read_descriptor(const InputFile& file, std::string_view bytes) {
    static constexpr std::array<std::string_view, 11> items_of{"6", "67", "68", "678", "679", "6789",
                                                               ":", ":;", ":<", ":=",  ":<="};  // types from '0'
    const std::size_t items = bytes.size() < 34 ? 0 : las_number<std::uint16_t>(bytes, 32);
    if (items == 0 || bytes.size() < 34 + 6 * items)
      file.fail("has no whole record 'laszip encoded': expected one that describes its compressed points");
    std::vector<std::string> none;
    const auto compressor = las_number<std::uint16_t>(bytes, 0);
    keep_rule(las_rules, file.path(), "compression", text::message("LAZ compressor ", compressor), none);
    is_layered_ = compressor == 3;
    std::string types;
    std::size_t size = 0;
    for (std::size_t at = 34; at < 34 + 6 * items; at += 6) {
      const auto version = las_number<std::uint16_t>(bytes, at + 4);
      types += static_cast<char>('0' + std::min<unsigned>(las_number<std::uint16_t>(bytes, at), 79));
      size += las_number<std::uint16_t>(bytes, at + 2);
      const std::string_view kind = types.back() == '9' ? "LAZ wave packet of version " : "LAZ item of version ";
      keep_rule(las_rules, file.path(), "compression", text::message(kind, version), none);
      is_version_4_ = version == 4;
      if (is_layered_ != (version > 2)) types.clear();
    }
    std::string expected(items_of[places_.format]);
    if (places_.extras < places_.record) expected += is_layered_ ? '>' : '0';
    if (types != expected || size != places_.record || las_number<std::uint16_t>(bytes, 2) != 0)
      file.fail("is compressed by other items than those of point format ", places_.format,
                ": expected LAZ as by laszip");
    return las_number<std::uint32_t>(bytes, 12);
  }

  void read_table(InputFile& file, std::uint64_t begin, std::uint32_t points_of_chunk) {
    const std::uint64_t last = file.size() - std::min<std::uint64_t>(file.size(), 8);
    auto table = las_number<std::uint64_t>(bytes_at(file, begin, 8), 0);
    if (table == ~std::uint64_t{0}) table = las_number<std::uint64_t>(bytes_at(file, last, 8), 0);  // a stream
    at_ = begin + 8;
    if (table < at_ || table > last)
      file.fail_at_byte(begin, "has its chunk table at byte ", table,
                        ": expected one behind the points; laszip repairs files");
    const auto head = bytes_at(file, table, 8);
    const std::uint32_t chunks = las_number<std::uint32_t>(head, 4);
    if (las_number<std::uint32_t>(head, 0) != 0 || chunks > (table - at_) / places_.record)
      file.fail_at_byte(table, "has a chunk table of ", chunks,
                        " chunks: expected one of version 0 that fits the file");
    const auto bytes = bytes_at(file, table + 8, std::min<std::uint64_t>(last - table, 16 * std::uint64_t{chunks}));
    LazDecoder decoder(bytes);
    LazIntegers integers(32, 2);  // contexts: numbers of points, sizes
    std::int32_t points = 0, size = 0;
    for (std::uint64_t i = 0, end = at_; i < chunks; ++i) {
      if (points_of_chunk == any_number) points = integers.code(decoder, points, 0, 0);
      size = integers.code(decoder, size, 0, 1);
      const auto is = static_cast<std::uint32_t>(size);
      if (is < places_.record || is > table - end || is > max_size || decoder.is_beyond_end())
        file.fail_at_byte(table, "has a chunk of ", is, " bytes: expected whole ones that fit the file, up to ",
                          max_size);
      end += is;
      chunks_.push_back({points_of_chunk == any_number ? static_cast<std::uint32_t>(points) : points_of_chunk, is});
    }
  }

  void next_chunk(InputFile& file) {
    if (chunk_ > 0) at_ += chunks_[chunk_ - 1].size;
    if (chunk_ == chunks_.size()) file.fail_at_byte(at_, "has fewer points in its chunks than its header claims");
    const Chunk chunk = chunks_[chunk_++];
    bytes_ = bytes_at(file, at_, chunk.size);
    place_ = 0;
    const std::span<const std::byte> rest = std::span(bytes_).subspan(places_.record);
    if (is_layered_) return read_layers(file, rest);
    count_ = chunk.points;
    if (count_ == 0) file.fail_at_byte(at_, "has a chunk without a point: expected at least one");
    std::copy_n(bytes_.begin(), places_.record, record_.begin());
    decoder_ = LazDecoder(rest);
    const unsigned f = places_.format;
    pointwise_.emplace(record_, f == 1 || f == 3, f == 2 ? 20 : f == 3 ? 28 : 0, places_.extras);
  }

  /// Decodes the layers that are needed of a chunk, behind its first record.
  void read_layers(const InputFile& file, std::span<const std::byte> rest) {
    static constexpr std::array<std::size_t, 5> others{0, 1, 2, 1, 3};  // colours, near infrared, wave packets
    const std::size_t extra_layers = 9 + others[places_.format - 6];
    const std::size_t layers = extra_layers + places_.record - places_.extras;
    count_ = rest.size() < 4 + 4 * layers ? 0 : las_number<std::uint32_t>(rest, 0);
    if (count_ == 0 || count_ > max_points)
      file.fail_at_byte(at_, "has a chunk of ", count_, " points: expected from 1 to ", max_points);
    std::vector<std::size_t> ends{4 + 4 * layers};
    for (std::size_t k = 0; k < layers; ++k) ends.push_back(ends.back() + las_number<std::uint32_t>(rest, 4 + 4 * k));
    if (ends.back() > rest.size())
      file.fail_at_byte(at_, "has layers of ", ends.back(), " bytes in a chunk of ", rest.size(), ": expected no more");
    const auto decode = [&](std::size_t layer, const auto& code) {
      if (layer > 1 && ends[layer] == ends[layer + 1]) return;  // constant
      LazDecoder decoder(rest.subspan(ends[layer], ends[layer + 1] - ends[layer]));
      code(decoder);
      require_end(file, decoder);
    };
    points_.assign(count_, LazPoint(bytes_.data()));
    decode(0, [&](auto& decoder) { positions(decoder); });
    decode(1, [&](auto& decoder) { heights(decoder); });
    decode(2, [&](auto& decoder) { classes(decoder); });
    decode(3, [&](auto& decoder) { flags(decoder); });
    const auto decode_values = [&]<class Models>(std::size_t layer, typename Models::Value* to) {
      decode(layer, [&](auto& decoder) {
        values<Models>(
            decoder, [&](std::size_t i) { return to[i]; }, [&](std::size_t i, auto value) { to[i] = value; },
            is_version_4_);
      });
    };
    if (places_.colour > 0) {
      colours_.assign(count_, las_number<LazColours::Value>(bytes_, places_.colour));
      decode_values.template operator()<LazColours>(9, colours_.data());
    }
    objects_.resize(places_.object_size * count_);
    for (std::size_t k = 0; k < places_.object_size; ++k) {
      std::fill_n(objects_.data() + k * count_, count_, std::to_integer<std::uint8_t>(bytes_[places_.object + k]));
      decode_values.template operator()<LazExtraByte>(extra_layers + places_.object - places_.extras + k,
                                                      objects_.data() + k * count_);
    }
  }

  LasPlaces places_;
  bool is_layered_ = false, is_version_4_ = false;
  std::vector<Chunk> chunks_;
  std::size_t chunk_ = 0, place_ = 0, count_ = 0;  // next chunk; next point, and number of points, of the current one
  std::uint64_t at_ = 0;
  std::vector<std::byte> bytes_, record_;  // of the current chunk; current record
  std::optional<LazPointwise> pointwise_;
  LazDecoder decoder_;
  std::vector<LazColours::Value> colours_;
  std::vector<std::uint8_t> objects_;  // for each byte, of all points
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
