// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

#include <string_view>

#include <pulsecast/io/npz.hpp>
#include <pulsecast/version.hpp>

#include "parts.hpp"

namespace fs = std::filesystem;
using namespace pulsecast;

namespace {

std::unique_ptr<PointFile> point_arrays(const fs::path& path, const io::PointLayout& layout,
                                        const io::PointSettings& points) {
  return std::make_unique<WrittenFile<io::NpzWriter>>(path, io::NpzSettings{.layout = layout, .points = points});
}

std::unique_ptr<PointFile> waveform_arrays(const fs::path& path, double start_time) {
  return std::make_unique<WrittenFile<io::WaveformNpzWriter>>(path, start_time);
}

}  // namespace

extern "C" [[gnu::visibility("default")]] const void* pulsecast_part(const char* version) {
  static constexpr ArraysPart functions{&point_arrays, &waveform_arrays};
  return std::string_view(version) == PULSECAST_VERSION ? &functions : nullptr;
}
