// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#ifndef PULSECAST_IO_DETAIL_LAS_EXTRAS_HPP
#define PULSECAST_IO_DETAIL_LAS_EXTRAS_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <pulsecast/base/namespace.hpp>

namespace PULSECAST_NAMESPACE::io::detail {

/// Extra value of each point, after the standard ones.
struct LasExtra {
  std::string_view name, description;
  std::uint8_t type,
      size;  ///< data type of the Extra Bytes record: 1 uint8, 5 uint32, 7 uint64, 9 float, 10 double; size [byte]
};

inline constexpr std::array las_extras{
    LasExtra{"Range", "from the instrument [m]", 10, 8},  // a float would err by 0.5 mm at 10 km
    LasExtra{"Amplitude", "received power at peak [dB]", 9, 4},
    LasExtra{"Reflectance", "re white Lambertian target [dB]", 9, 4},
    LasExtra{"EchoWidth", "standard deviation in time [ns]", 9, 4},
    LasExtra{"PulseIndex", "number of the pulse, from 0", 7, 8},
    LasExtra{"ObjectId", "number of the object met", 5, 4},
    LasExtra{"LightKind", "way of the light, 0: direct", 1, 1},  // last: left out unless requested
};

// sizes [byte]. Source: LAS 1.4 R15, Extra Bytes, Point Data Record Format 4.
inline constexpr std::size_t las_descriptor_size = 192, las_packet_size = 29;
inline constexpr std::size_t las_extras_size = [] {
  std::size_t size = 0;
  for (const LasExtra& extra : las_extras) size += extra.size;
  return size;
}();

/// Attribute's name as far as an Extra Bytes record has room: 31 bytes and a terminator, without a part of a UTF-8
/// character.
[[nodiscard]] constexpr std::string_view las_extra_name(std::string_view name) noexcept {
  std::size_t size = name.size() > 31 ? 31 : name.size();
  while (size > 0 && size < name.size() && (static_cast<unsigned char>(name[size]) & 0xC0U) == 0x80U) --size;
  return name.substr(0, size);
}

}  // namespace PULSECAST_NAMESPACE::io::detail

#endif
