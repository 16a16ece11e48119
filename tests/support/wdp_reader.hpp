// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/las_reader.hpp"

namespace pulsecast::support {

/// A file of waveform packets, which the points of a LAS file refer to.
struct WdpFile {
  std::string bytes;  ///< all of it
};

/// Reads a `.wdp` file and checks its header; throws `std::runtime_error`. Written from the ASPRS LAS Specification 1.4
/// R15, Extended Variable Length Records; shares nothing with the writer.
[[nodiscard]] inline WdpFile read_wdp(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  detail::las_expect(stream.good(), "packets cannot be opened");
  WdpFile file{{std::istreambuf_iterator<char>(stream), {}}};
  const detail::LasInput in(file.bytes);
  detail::las_expect(in.whole(0, 2) == 0 && in.text(2, 16) == "LASF_Spec" && in.whole(18, 2) == 65535,
                     "header of packets");
  detail::las_expect(in.whole(20, 8) == in.size() - 60, "length of packets");
  return file;
}

/// The waveform of a point, as its descriptor says [W], as long as its packet. Throws if the point has none, or if it
/// does not fit.
[[nodiscard]] inline std::vector<double> waveform_of(const LasFile& las, const WdpFile& wdp, const LasPoint& point) {
  for (const LasWaveDescriptor& d : las.descriptors) {
    if (d.index != point.wave.descriptor) continue;
    detail::las_expect(d.bits == 8 || d.bits == 16 || d.bits == 32, "bits of a sample");
    const std::size_t width = d.bits / 8;
    detail::las_expect(point.wave.size == d.samples * width, "size of a packet");
    detail::las_expect(point.wave.offset >= 60 && point.wave.offset + point.wave.size <= wdp.bytes.size(),
                       "place of a packet");
    std::vector<double> samples;
    for (std::size_t i = 0; i < d.samples; ++i) {
      std::uint64_t number = 0;
      for (std::size_t k = width; k-- > 0;)
        number = number << 8 | static_cast<unsigned char>(wdp.bytes[point.wave.offset + i * width + k]);
      samples.push_back(d.offset + d.gain * static_cast<double>(number));
    }
    return samples;
  }
  throw std::runtime_error("not a good LAS file: a point without the descriptor of its packet");
}

}  // namespace pulsecast::support
