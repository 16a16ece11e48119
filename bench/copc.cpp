// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// Cost of a COPC file, beside LAZ: wall-clock and processor time of the writer alone, size, and peak memory of the
// program. An airplane flies over hills with trees, in strips of 500 m, with ten points a square metre; the points are
// made by formulas as they are written. Usage: copc FORMAT POINTS THREADS FILE; FORMAT is laz or copc. bench/copc.sh
// runs both in turns.

#include <sys/resource.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <pulsecast/base/random.hpp>
#include <pulsecast/io/copc.hpp>
#include <pulsecast/io/laz.hpp>

#include "report.hpp"

using namespace bench;
using namespace pulsecast;
using namespace pulsecast::io;

namespace {

/// Height of the ground [m].
double ground(double x, double y) { return 20 * std::sin(x / 90) * std::cos(y / 120) + 3 * std::sin(x / 11 + y / 17); }

/// Number from 0 to 1 by a counter.
double uniform(std::uint64_t i) {
  i = (i ^ i >> 31) * 0x9E3779B97F4A7C15;
  i = (i ^ i >> 29) * 0xBF58476D1CE4E5B9;
  return std::ldexp(static_cast<double>((i ^ i >> 32) >> 11), -53);
}

struct Batch {
  std::vector<Shot> shots;
  std::vector<Echo> echoes;
};

/// Adds a pulse: over trees three echoes, elsewhere one.
void add_pulse(Batch& batch, std::uint64_t index) {
  constexpr std::uint64_t of_line = 1000, of_strip = 4'000'000;  // pulses
  const std::uint64_t strip = index / of_strip, line = index % of_strip / of_line, place = index % of_line;
  const double x = 500 * static_cast<double>(strip) +
                   0.5 * (static_cast<double>(line % 2 == 0 ? place : of_line - 1 - place) + uniform(index));
  const double y = 0.25 * static_cast<double>(line) + 0.2 * uniform(index + 1);
  const Vec3 plane(500 * static_cast<double>(strip) + 250, y, 800);
  const bool tree = std::sin(x / 31) * std::sin(y / 23) > 0.4;
  const Vec3 to = Vec3(x, y, ground(x, y)) - plane;
  Shot shot{.index = index,
            .tick = Tick::of(index, 5e5),
            .origin = plane + Vec3(5e5, 5.6e6, 0),
            .direction = normalize(to),
            .scan_angle = std::atan2(to.x, -to.z),
            .leg = static_cast<std::uint16_t>(strip),
            .first_echo = static_cast<std::uint32_t>(batch.echoes.size()),
            .echoes = tree ? 3U : 1U};
  for (std::uint32_t k = 0; k < shot.echoes; ++k) {
    const double above = k + 1 == shot.echoes ? 0 : (20.0 - 9 * k) * uniform(3 * index + k);
    batch.echoes.push_back({.range = length(to) - above,
                            .amplitude = 1e-7 * (0.2 + uniform(5 * index + k)),
                            .reflectance = 0.2 + 0.2 * uniform(7 * index + k),
                            .width = 1e-9 * (1 + uniform(11 * index + k)),
                            .object = tree ? static_cast<ObjectId>(x / 10) : 0,
                            .classification = static_cast<std::uint16_t>(k + 1 == shot.echoes ? 2 : 5),
                            .number = static_cast<std::uint8_t>(k + 1)});
  }
  batch.shots.push_back(shot);
}

template <class Writer>
void write(Writer writer, std::uint64_t points, const std::string& format, const std::filesystem::path& path) {
  double wall = 0, processors = 0;
  const auto timed = [&](const auto& work) {
    const double wall_before = wall_seconds(), before = process_seconds();
    work();
    wall += wall_seconds() - wall_before;
    processors += process_seconds() - before;
  };
  std::uint64_t written = 0;
  Batch batch;
  for (std::uint64_t index = 0; written < points;) {
    batch.shots.clear();
    batch.echoes.clear();
    while (batch.echoes.size() < 20'000) add_pulse(batch, index++);
    timed([&] { writer(EchoBatch{batch.shots, batch.echoes, {}, 0}); });
    written += batch.echoes.size();
  }
  const double gathered = wall;
  timed([&] { writer.close(); });
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  std::printf(
      "%s %.0f points: %.1f s, %.1f s of them in close(), %.1f s of processors, %.2f bytes a point, %.0f MB memory\n",
      format.c_str(), static_cast<double>(written), wall, wall - gathered, processors,
      static_cast<double>(std::filesystem::file_size(path)) / static_cast<double>(written),
      static_cast<double>(usage.ru_maxrss) / 1024);
}

}  // namespace

int main(int count, char** words) {
  if (count != 5) return 2;
  const std::string format = words[1];
  const std::uint64_t points = std::strtoull(words[2], nullptr, 10);
  const auto threads = static_cast<unsigned>(std::strtoul(words[3], nullptr, 10));
  const std::filesystem::path path = words[4];
  if (format == "laz") write(LazWriter(path, {}, threads), points, format, path);
  if (format == "copc") write(CopcWriter(path, {}, threads), points, format, path);
}
