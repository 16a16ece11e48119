// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_LAYOUT_HPP
#define PULSECAST_IO_DETAIL_LAS_LAYOUT_HPP

#include <cstddef>
#include <cstdint>

#include <pulsecast/io/detail/las/extras.hpp>
#include <pulsecast/io/detail/las/settings.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Offsets and limits of a file. Source: LAS 1.4 R15, Public Header Block, Point Data Record Formats 1, 4, 6 to 9;
/// LAS 1.0, Public Header Block, Point Data Start Signature.
struct LasLayout {
  explicit LasLayout(const LasSettings& s) noexcept
      : legacy(s.format != LasFormat::las_1_4),
        minor(s.format == LasFormat::las_1_0 ? 0 : 4),
        format(legacy            ? (s.waveforms ? 4 : 1)
               : s.waveforms     ? 9
               : s.near_infrared ? 8
               : s.colours       ? 7
                                 : 6),
        header(minor == 0 ? 227 : 375),
        start_signature(minor == 0 ? 2 : 0),
        colour(legacy ? 28 : 30),
        colour_size(format == 7   ? 6
                    : format == 8 ? 8
                                  : 0),
        packet(colour + colour_size),
        extras(packet + (s.waveforms ? las_packet_size : 0)),
        extra_count(las_extras.size() - (s.light_kinds ? 0 : 1)),
        attributes(extras + las_extras_size - (s.light_kinds ? 0 : las_extras.back().size)),
        attribute_count(s.attributes ? s.attributes->names().size() : 0),
        max_returns(legacy ? 5 : 15),
        max_class(legacy ? 31 : 255) {}

  /// Size of a point [byte].
  [[nodiscard]] std::size_t record() const noexcept { return attributes + sizeof(double) * attribute_count; }

  bool legacy;                           ///< true for point formats older than version 1.4
  std::uint8_t minor, format;            ///< version 1.`minor`, point format
  std::size_t header;                    ///< size of the header [byte]
  std::size_t start_signature;           ///< size of the signature between the last record and the first point [byte]
  std::size_t colour, colour_size;       ///< offset and size of red, green, blue and near infrared in a point [byte]
  std::size_t packet, extras;            ///< offsets of wave packet and extra bytes in a point [byte]
  std::size_t extra_count;               ///< number of extra values of a point, without attributes
  std::size_t attributes;                ///< offset of the attributes in a point [byte]
  std::size_t attribute_count;           ///< number of attributes of a point
  std::uint32_t max_returns, max_class;  ///< limits of return numbers and classes
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
