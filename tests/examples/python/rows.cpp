// SPDX-FileCopyrightText: 2026 the pulsecast contributors
// SPDX-License-Identifier: MIT

// What the Python module does, in C++: reads a survey, runs it and keeps its points in memory. The tests hold the
// module's arrays against its rows, and bench/python.sh its time against the module's. Says the processors' time of the
// run, in user mode [s]. Usage: rows SURVEY.xml SEED THREADS OUT [ASSETS]..., where an empty OUT stands for no file.

#include <sys/resource.h>

#include <cstdint>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <vector>

#include <pulsecast/cloud.hpp>
#include <pulsecast/helios/document.hpp>
#include <pulsecast/run.hpp>

#include "../../../examples/pulsecast/loading.hpp"

using namespace pulsecast;

namespace {

/// Some members of a point, as the test reads them.
struct Row {
  double x, y, z, time, range;
  float intensity, cos_incidence;
  std::int64_t pulse;
  std::uint32_t object, return_number;
};

double user_seconds() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
}

}  // namespace

int main(int count, char** arguments) try {
  if (count < 5) throw std::invalid_argument("usage: rows SURVEY.xml SEED THREADS OUT [ASSETS]...");
  const std::vector<std::filesystem::path> assets(arguments + 5, arguments + count);
  const auto threads = static_cast<unsigned>(std::atoi(arguments[3]));
  const auto seed = static_cast<std::uint64_t>(std::atoll(arguments[2]));
  const helios::SurveyDocument document = helios::read_survey(arguments[1], {.assets = assets});
  const std::unique_ptr<helios::Simulation> simulation =
      load(document.survey, {.seed = seed, .assets = assets, .threads = threads});
  Cloud cloud;
  const double start = user_seconds();
  run(simulation->survey(), {.threads = threads}, [&](const EchoBatch& batch) { cloud(batch); });
  std::cout << user_seconds() - start << '\n';

  if (*arguments[4] == '\0') return 0;
  std::ofstream out(arguments[4], std::ios::binary);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3& p = cloud.points[i];
    const Echo& e = cloud.echoes[i];
    const Row row{p.x,
                  p.y,
                  p.z,
                  cloud.ticks[i].seconds(),
                  e.range,
                  static_cast<float>(e.amplitude),
                  static_cast<float>(e.cos_incidence),
                  static_cast<std::int64_t>(cloud.pulses[i]),
                  e.object,
                  e.number};
    out.write(reinterpret_cast<const char*>(&row), sizeof(row));
  }
  return out.flush() ? 0 : 1;
} catch (const std::exception& problem) {
  std::cerr << problem.what() << '\n';
  return 1;
}
