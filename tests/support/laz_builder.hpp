// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <pulsecast/io/detail/laz/chunk.hpp>
#include <pulsecast/io/detail/laz/coder.hpp>
#include <pulsecast/io/detail/laz/integers.hpp>
#include <pulsecast/io/detail/laz/pointwise.hpp>

#include "support/las_builder.hpp"

namespace pulsecast::support {

/// Makes LAZ files of LAS files of `LasBuilder`, of point formats 0 to 3 and 6 to 10, good ones and others. What of
/// wave packets is compressed must be constant.
struct LazBuilder {
  std::size_t chunk_points = 50000;
  std::vector<std::size_t> chunks{};     ///< numbers of points of chunks that differ in them; empty for equal ones
  bool streamed = false;                 ///< the position of the chunk table stands at the end
  unsigned compressor = 0, version = 0;  ///< 0: by format
  std::string items{};                   ///< types of items, of one byte each; empty: by format

  [[nodiscard]] std::string bytes(const std::string& las) const {
    const auto whole = [&](std::size_t at, std::size_t size) {
      std::uint64_t value = 0;
      for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(las.at(at + i));
      return static_cast<std::size_t>(value);
    };
    const unsigned format = static_cast<unsigned>(whole(104, 1));
    const std::size_t record = whole(105, 2), begin = whole(96, 4);
    const std::string head = las.substr(0, begin), descriptor = descriptor_of(format, record);
    std::string file = head;
    LasBuilder::put(file, 104, 128 + format, 1);
    LasBuilder::put(file, 96, begin + 54 + descriptor.size(), 4);
    LasBuilder::put(file, 100, whole(100, 4) + 1, 4);
    std::string record_head(54, '\0');
    record_head.replace(2, 14, "laszip encoded");
    LasBuilder::put(record_head, 18, 22204, 2);
    LasBuilder::put(record_head, 20, descriptor.size(), 2);
    file += record_head + descriptor;
    const std::size_t table_at = file.size();
    file += std::string(8, '\xFF');

    std::vector<std::pair<std::size_t, std::size_t>> table;  // points and bytes
    for (std::size_t at = begin; at < las.size();) {
      const std::size_t wanted = chunks.empty() ? chunk_points : chunks.at(table.size());
      const std::size_t points = std::min(wanted, (las.size() - at) / record);
      const std::string records = las.substr(at, points * record);
      const std::string chunk = format < 6 ? pointwise(records, format, record) : layered(records, format, record);
      file += chunk;
      table.emplace_back(points, chunk.size());
      at += points * record;
    }
    const std::size_t position = file.size();
    if (!streamed) LasBuilder::put(file, table_at, position, 8);
    std::string table_head(8, '\0');
    LasBuilder::put(table_head, 4, table.size(), 4);
    file += table_head + coded(table);
    if (streamed) {
      file += std::string(8, '\0');
      LasBuilder::put(file, file.size() - 8, position, 8);
    }
    return file;
  }

 private:
  [[nodiscard]] static std::string text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  [[nodiscard]] static std::size_t standard_size(unsigned format) {
    LasBuilder las;
    las.format = format;
    return las.point_size();
  }

  [[nodiscard]] std::string descriptor_of(unsigned format, std::size_t record) const {
    static const std::vector<std::string> types{"\x06",         "\x06\x07",         "\x06\x08",    "\x06\x07\x08",
                                                "\x06\x07\x09", "\x06\x07\x08\x09", "\x0A",        "\x0A\x0B",
                                                "\x0A\x0C",     "\x0A\x0D",         "\x0A\x0C\x0D"};
    static constexpr std::size_t sizes[]{0, 2, 4, 8, 4, 8, 20, 8, 6, 29, 30, 6, 8, 29};
    std::string all = items.empty() ? types.at(format) : items;
    const std::size_t extra = record - standard_size(format);
    std::string d(34, '\0');
    LasBuilder::put(d, 0, compressor != 0 ? compressor : format < 6 ? 2 : 3, 2);
    LasBuilder::put(d, 4, 3, 1);
    LasBuilder::put(d, 12, chunks.empty() ? chunk_points : 0xFFFFFFFF, 4);
    LasBuilder::put(d, 16, ~std::uint64_t{0}, 8);
    LasBuilder::put(d, 24, ~std::uint64_t{0}, 8);
    const auto add = [&](std::size_t type, std::size_t size) {
      std::string item(6, '\0');
      LasBuilder::put(item, 0, type, 2);
      LasBuilder::put(item, 2, size, 2);
      LasBuilder::put(item, 4, version != 0 ? version : type == 9 ? 1 : format < 6 ? 2 : 3, 2);
      d += item;
    };
    for (const char type : all) add(static_cast<std::size_t>(type), sizes[static_cast<std::size_t>(type)]);
    if (extra > 0) add(format < 6 ? 0 : 14, extra);
    LasBuilder::put(d, 32, all.size() + (extra > 0 ? 1 : 0), 2);
    return d;
  }

  [[nodiscard]] static std::string pointwise(std::string records, unsigned format, std::size_t record) {
    const std::size_t colour = format == 2 ? 20 : format == 3 ? 28 : 0;
    auto* const bytes = reinterpret_cast<std::byte*>(records.data());
    io::detail::LazPointwise points(std::span(bytes, record), format % 2 == 1, colour, standard_size(format));
    io::detail::LazEncoder encoder;
    for (std::size_t at = record; at < records.size(); at += record) points.code(encoder, bytes + at);
    return records.substr(0, record) + text(std::move(encoder).finish());
  }

  [[nodiscard]] static std::string layered(const std::string& records, unsigned format, std::size_t record) {
    const std::size_t colour = format == 7 ? 6 : format == 8 || format == 10 ? 8 : 0;
    std::string chunk = text(io::detail::LazChunk(std::as_bytes(std::span(records)), record, colour).compressed());
    if (format >= 9)  // one layer for the 29 bytes of a wave packet
      chunk.erase(record + 4 + 4 * (9 + (format == 10 ? 2U : 0U)), 4 * 28);
    return chunk;
  }

  [[nodiscard]] std::string coded(const std::vector<std::pair<std::size_t, std::size_t>>& table) const {
    io::detail::LazEncoder encoder;
    io::detail::LazIntegers integers(32, 2);
    std::int32_t points = 0, size = 0;
    for (const auto& [p, s] : table) {
      if (!chunks.empty()) points = integers.code(encoder, points, static_cast<std::int32_t>(p), 0);
      size = integers.code(encoder, size, static_cast<std::int32_t>(s), 1);
    }
    return text(std::move(encoder).finish());
  }
};

}  // namespace pulsecast::support
