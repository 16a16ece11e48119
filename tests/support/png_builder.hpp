// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pulsecast::support {

/// A whole number of 32 bits, the greatest byte first.
[[nodiscard]] inline std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (const unsigned shift : {24U, 16U, 8U, 0U}) bytes += static_cast<char>(number >> shift & 255U);
  return bytes;
}

/// A chunk of a PNG file, with its checksum. Source: ISO/IEC 15948, 5.3 and annex D.
[[nodiscard]] inline std::string png_chunk(std::string_view type, std::string_view data) {
  const std::string body = std::string(type) + std::string(data);
  std::uint32_t sum = 0xFFFFFFFF;
  for (const char byte : body) {
    sum ^= static_cast<unsigned char>(byte);
    for (int k = 0; k < 8; ++k) sum = (sum & 1U) != 0 ? 0xEDB88320U ^ sum >> 1 : sum >> 1;
  }
  return big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(~sum);
}

/// A zlib stream of blocks that are not compressed. Source: RFC 1950; RFC 1951, 3.2.4.
[[nodiscard]] inline std::string stored(std::string_view data) {
  std::string stream = "\x78\x01";
  std::uint32_t a = 1, b = 0;
  for (const char byte : data) {
    a = (a + static_cast<unsigned char>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  do {
    const std::string_view block = data.substr(0, 65535);
    data.remove_prefix(block.size());
    const auto size = static_cast<std::uint32_t>(block.size());
    stream += static_cast<char>(data.empty() ? 1 : 0);
    for (const std::uint32_t number : {size, ~size})
      stream += {static_cast<char>(number & 255U), static_cast<char>(number >> 8 & 255U)};
    stream += block;
  } while (!data.empty());
  return stream + big_endian(b << 16 | a);
}

/// A PNG file of grey pixels of 8 or 16 bits, row by row.
[[nodiscard]] inline std::string grey_png(std::uint32_t columns, std::uint32_t rows, unsigned bits,
                                          const std::vector<std::uint16_t>& pixels) {
  std::string image;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (i % columns == 0) image += '\0';  // no filter
    if (bits == 16) image += static_cast<char>(pixels[i] >> 8);
    image += static_cast<char>(pixels[i] & 255);
  }
  const std::string header = big_endian(columns) + big_endian(rows) + static_cast<char>(bits) + std::string(4, '\0');
  return "\x89PNG\r\n\x1A\n" + png_chunk("IHDR", header) + png_chunk("IDAT", stored(image)) + png_chunk("IEND", "");
}

}  // namespace pulsecast::support
