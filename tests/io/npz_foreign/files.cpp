// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Writes points as NPZ, and their records one after another, for NumPy to read and compare. Usage: files FOLDER.

#include <filesystem>
#include <string>

#include <pulsecast/io/npz.hpp>

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
    NpzWriter writer(folder / (name + ".npz"), {.layout = every_type});
    writer.add(points);
    writer.close();
    OutputFile records(folder / (name + ".bin"));
    records.write(points.records());
    records.commit();
  }
}
