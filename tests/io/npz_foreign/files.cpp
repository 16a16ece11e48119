// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Writes points as NPZ, PLY and PCD, and their records one after another, for NumPy and Open3D to read and compare.
// Usage: files FOLDER.

#include <filesystem>
#include <string>

#include <pulsecast/io/npz.hpp>
#include <pulsecast/io/pcd.hpp>
#include <pulsecast/io/ply.hpp>

#include "support/random_pulses.hpp"

using namespace pulsecast;
using namespace pulsecast::io;

int main(int count, char** words) {
  if (count != 2) return 2;
  const std::filesystem::path folder = words[1];
  PointLayout every_type = layouts::map();
  for (const NumberType type : {NumberType::int8, NumberType::int16, NumberType::int32})
    every_type = every_type.with({{"minus_" + std::to_string(size_of(type)), type, column("range"), -1}});
  every_type = every_type.with({{"velocity", NumberType::float64, column("radial_velocity")}});
  for (const std::size_t pulses : {0U, 1U, 30'000U}) {
    const std::string name = std::to_string(pulses);
    PointBuffer points(every_type);
    points(support::RandomPulses(pulses, pulses).batch());
    const auto write = [&](auto writer) {
      writer.add(points);
      writer.close();
    };
    write(NpzWriter(folder / (name + ".npz"), {.layout = every_type}));
    write(PlyWriter(folder / (name + ".ply"), {.layout = every_type}));
    for (const auto& [encoding, ending] :
         {std::pair{PcdEncoding::ascii, ".ascii.pcd"}, std::pair{PcdEncoding::binary, ".binary.pcd"},
          std::pair{PcdEncoding::binary_compressed, ".compressed.pcd"}})
      write(PcdWriter(folder / (name + ending), {.encoding = encoding, .layout = every_type}));
    OutputFile records(folder / (name + ".bin"));
    records.write(points.records());
    records.commit();
  }
}
