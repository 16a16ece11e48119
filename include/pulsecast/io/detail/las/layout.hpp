// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_LAYOUT_HPP
#define PULSECAST_IO_DETAIL_LAS_LAYOUT_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <pulsecast/io/detail/las/settings.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Extra value of each point, behind the standard ones.
struct LasExtra {
  std::string_view name, description;
  std::uint8_t type, size;  ///< data type of the Extra Bytes record: 1 uint8, 5 uint32, 7 uint64, 9 float, 10 double; size [byte]
};

inline constexpr std::array las_extras{
    LasExtra{"Range", "from the instrument [m]", 10, 8},  // a float would err by 0.5 mm at 10 km
    LasExtra{"Amplitude", "received power at peak [dB]", 9, 4},
    LasExtra{"Reflectance", "re white Lambertian target [dB]", 9, 4},
    LasExtra{"EchoWidth", "standard deviation in time [ns]", 9, 4},
    LasExtra{"PulseIndex", "number of the pulse, from 0", 7, 8},
    LasExtra{"ObjectId", "number of the object met", 5, 4},
    LasExtra{"LightKind", "way of the light, 0: direct", 1, 1},  // last: left out unless it is asked for
};

// sizes [byte]. Source: LAS 1.4 R15, Extra Bytes, Point Data Record Format 4.
inline constexpr std::size_t las_descriptor_size = 192, las_packet_size = 29;
inline constexpr std::size_t las_extras_size = [] {
  std::size_t size = 0;
  for (const LasExtra& extra : las_extras) size += extra.size;
  return size;
}();

/// Offsets and limits of a file. Source: LAS 1.4 R15, Public Header Block, Point Data Record Formats 1, 4, 6 and 9;
/// LAS 1.0, Public Header Block, Point Data Start Signature.
struct LasLayout {
  LasLayout(LasFormat file, bool with_waveforms, bool with_light_kinds) noexcept
      : legacy(file != LasFormat::las_1_4),
        minor(file == LasFormat::las_1_0 ? 0 : 4),
        format(legacy ? (with_waveforms ? 4 : 1) : (with_waveforms ? 9 : 6)),
        header(minor == 0 ? 227 : 375),
        start_signature(minor == 0 ? 2 : 0),
        packet(legacy ? 28 : 30),
        extras(packet + (with_waveforms ? las_packet_size : 0)),
        extra_count(las_extras.size() - (with_light_kinds ? 0 : 1)),
        max_returns(legacy ? 5 : 15),
        max_class(legacy ? 31 : 255) {}

  /// Size of a point [byte].
  [[nodiscard]] std::size_t record() const noexcept {
    return extras + las_extras_size - (extra_count < las_extras.size() ? las_extras.back().size : 0);
  }

  bool legacy;                           ///< true for point formats older than version 1.4
  std::uint8_t minor, format;            ///< version 1.`minor`, point format
  std::size_t header;                    ///< size of the header [byte]
  std::size_t start_signature;           ///< size of the signature between the last record and the first point [byte]
  std::size_t packet, extras;            ///< offsets of wave packet and extra bytes in a point [byte]
  std::size_t extra_count;               ///< number of extra values of a point
  std::uint32_t max_returns, max_class;  ///< limits of return numbers and classes
};

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
