// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Both single headers, and then headers of other rooms, which include those of the library one by one.

#include <pulsecast/pulsecast.hpp>
#include <pulsecast/pulsecast_io.hpp>

#include <pulsecast/helios/simulation.hpp>
#include <pulsecast/io/obj.hpp>

#include <cstddef>
#include <filesystem>
#include <string>

#include "scan.hpp"

std::string scan_before_rooms(const std::filesystem::path& obj, std::size_t& points) {
  return scan(io::read_obj(obj).mesh, points);
}
